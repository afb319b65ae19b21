"""PDDL: its model, its semantics, reading, writing, grounding and validating.

Begin with :mod:`tmd.pddl.model`, the terms, and :mod:`~tmd.pddl.semantics`: what holds, and what an instruction does.
:mod:`~tmd.pddl.reading` parses and checks text, :mod:`~tmd.pddl.grounding` makes a :class:`~tmd.pddl.task.Task` of
bit sets from a problem, :mod:`~tmd.pddl.validator` executes plans.
"""
