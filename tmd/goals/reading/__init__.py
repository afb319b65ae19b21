"""One clause as a PDDL goal: the row that fits, its slots filled, its noun phrases quantified.

Begin with :mod:`tmd.goals.reading.reader`; it asks :mod:`~tmd.goals.reading.reader` which rows fit,
:mod:`~tmd.goals.reading.referents` what nouns mean, and :mod:`~tmd.goals.reading.referents` what else was said.
"""
