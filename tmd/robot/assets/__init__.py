"""What things look like and are made of: builders of URDF models by kind of shape.

Begin with :mod:`tmd.robot.assets.kinds`, the table of all kinds.
"""
