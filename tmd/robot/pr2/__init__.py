"""The PR2: its model, kinematics, inverse kinematics, collision checking, and the motion of arms and base.

Begin with :mod:`tmd.robot.pr2.pr2`.
"""
