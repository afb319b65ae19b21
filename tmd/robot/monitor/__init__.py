"""Execution and its monitor: an instruction is carried out, its effects are read back and compared with PDDL.

Begin with :mod:`tmd.robot.monitor.executor`.
"""
