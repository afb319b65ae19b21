"""The skills of the robot: pick and place, doors and knobs, pouring and dipping, and the search for stances.

Begin with :mod:`tmd.robot.skills.performer`; ``skills.yaml`` of a domain says which skill does which action.
"""
