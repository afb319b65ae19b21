"""Goals: a clause becomes a PDDL condition that must hold when it is done.

Begin with :mod:`tmd.goals.reading.goal_reader`, which reads one clause; :mod:`~tmd.goals.text_constraints` reads what
must not be done meanwhile. :mod:`~tmd.goals.sources` says what verbs bring about, :mod:`~tmd.goals.tables` puts these
sources in order, and :mod:`~tmd.goals.grounder` instantiates their conditions. :mod:`~tmd.goals.clause_goal` has what
comes out. A reader (:mod:`tmd.readers`) follows a whole request, clause by clause.
"""
