"""The searches in this process: cheapest plans by landmark cuts, and any plan, over flat lists of integers.

Begin with :mod:`tmd.planning.search.in_process`; :mod:`~tmd.planning.search.kernel` is the search itself, compiled by
:mod:`~tmd.planning.search.numba_build` where numba is there.
"""
