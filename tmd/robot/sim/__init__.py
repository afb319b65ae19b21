"""pybullet behind one class: the connection, its bodies, poses, and what it draws with.

Begin with :mod:`tmd.robot.sim.simulator`.
"""
