"""What a person says, turned into plans that a robot may safely execute.

The main path is :func:`tmd.ground.ground`; the semantics of every instruction is PDDL (:mod:`tmd.pddl`).
"""

__version__ = "0.1.0"
