"""The energy of a grounding and its minimisation (sections IV and VI of the paper).

Begin with :mod:`tmd.inference.algorithm1`, the paper's inference, and :mod:`~tmd.inference.goal_directed`, which asks
every clause for its goal. Both use the :mod:`~tmd.inference.proposers` and the :mod:`~tmd.inference.energy`; the
presets are in :mod:`~tmd.inference.config`. :mod:`~tmd.inference.policy` proposes what people would do next,
:mod:`~tmd.inference.weight_learning` fits weights, and :mod:`~tmd.inference.learned` keeps all that was learned.
"""
