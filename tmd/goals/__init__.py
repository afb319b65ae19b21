"""What was said, as PDDL goals: a clause becomes a condition that must hold when it is done.

Begin with :mod:`tmd.goals.reading.goal_reader` (one clause) and :mod:`tmd.goals.text_following` (a whole text, clause
by clause); :mod:`~tmd.goals.text_constraints` has what must not be done meanwhile. :mod:`~tmd.goals.sources` says what
verbs bring about, :mod:`~tmd.goals.grounder` turns conditions into bit sets, and :mod:`~tmd.goals.clause_goal` has what
comes out: goals, refusals, and what later clauses must keep.
"""
