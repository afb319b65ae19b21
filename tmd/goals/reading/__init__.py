"""One clause as a PDDL goal: the row that fits, its slots filled, its noun phrases quantified.

Begin with :mod:`tmd.goals.reading.goal_reader`; it finds the rows that fit, and asks
:mod:`~tmd.goals.reading.referents` what the noun phrases mean, and :mod:`~tmd.goals.reading.requirements` what they ask
for besides; :mod:`~tmd.goals.reading.noun_phrases` has the single nouns.
"""
