"""What the robot can do: pick and place, work doors and knobs, pour and dip, and where it stands for that.

Begin with :mod:`tmd.robot.skills.performer`; ``skills.yaml`` of a domain says which skill does which action.
"""
