"""The energy of a grounding and its minimisation (sections IV and VI of the paper).

Begin with :class:`tmd.inference.goal_pass.Inference`. :mod:`~tmd.inference.forward_pass` is the paper's Algorithm 1,
and :mod:`~tmd.inference.goal_pass` the same over steps with goals. Both use the :mod:`~tmd.inference.proposers` and
the :mod:`~tmd.inference.energy`; the presets are in :mod:`~tmd.inference.config`. :mod:`~tmd.inference.policy`
proposes what people would do next, and :mod:`~tmd.inference.weight_learning` fits weights.
"""
