"""Builders of URDF models by kind of shape: geometry, colours and features of furniture and things.

Begin with :mod:`tmd.robot.assets.kinds`, the table of all kinds.
"""
