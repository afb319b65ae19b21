"""Proofs that a goal cannot be reached: mutexes, invariants, and relaxed reachability.

Begin with :mod:`tmd.planning.unsolvability.proofs`.
"""
