"""Reading PDDL, with every fault at its place: tokens, nested groups, sections, and what the checks find.

Begin with :mod:`tmd.pddl.reading.reader`.
"""
