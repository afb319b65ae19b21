"""The verb-environment-instruction library (section V of the paper).

Begin with :mod:`tmd.veil.library`: from demonstrations (:mod:`~tmd.veil.demonstration`), aligned with the clauses
(:mod:`~tmd.veil.clause_alignment`), to templates (:mod:`~tmd.veil.template`) that can be instantiated in any
:class:`~tmd.veil.world.World`. :mod:`~tmd.veil.corpus` and :mod:`~tmd.veil.roots` find the files.
"""
