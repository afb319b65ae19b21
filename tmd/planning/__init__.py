"""Planning: the cheapest missing instructions, or the reason why there are none.

Begin with :mod:`tmd.planning.gap_filler` (the gaps of a plan) and :mod:`~tmd.planning.backends` (whole problems, by the
best planner at hand). :mod:`~tmd.planning.search` are the searches in this process, :mod:`~tmd.planning.up_planners`
the planners of unified-planning, and :mod:`~tmd.planning.unsolvable` proves that there is no plan.
"""
