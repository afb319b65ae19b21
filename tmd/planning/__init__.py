"""Planning: the cheapest missing instructions, or the reason why there are none.

Begin with :mod:`tmd.planning.gap_filler` (the gaps of a plan) and :mod:`~tmd.planning.backends` (planners by name, for
gaps and for whole problems). :mod:`~tmd.planning.search` are the searches in this process,
:mod:`~tmd.planning.fast_downward` and :mod:`~tmd.planning.kairos` planners that read PDDL text,
:mod:`~tmd.planning.up_planners` those of unified-planning, and :mod:`~tmd.planning.processes` how all of them are run.
:mod:`~tmd.planning.unsolvable` proves that there is no plan.
"""
