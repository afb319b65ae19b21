"""From a problem to its ground task: instantiated actions, relaxed reachability, bit sets.

Begin with :mod:`tmd.pddl.grounding.ground_task`.
"""
