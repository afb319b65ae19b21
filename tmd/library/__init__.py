"""The library of verbs, environments and instructions (section V of the paper).

Begin with :mod:`tmd.library.library`: demonstrations (:mod:`tmd.world.demonstration`), aligned with clauses
(:mod:`~tmd.library.clause_alignment`), become templates (:mod:`~tmd.library.template`) that can be instantiated in any
:class:`~tmd.world.world.World`.
"""
