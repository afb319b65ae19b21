"""A policy: a learned distribution over the next instruction, given the words of a clause and the sequence so far.

Begin with :mod:`~tmd.inference.policy.model`. :mod:`~tmd.inference.policy.features` and
:mod:`~tmd.inference.policy.menu` say what it sees, and :mod:`~tmd.inference.policy.learning` fits it.
"""
