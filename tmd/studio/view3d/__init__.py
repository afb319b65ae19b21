"""What the browser's 3D view shows: the room, its objects, the robot, and plans that play.

Begin with :mod:`tmd.studio.view3d.scenery`.
"""
