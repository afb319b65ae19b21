"""Contents of the browser's 3D view: the room, its objects, the robot, and plans that play.

Begin with :mod:`tmd.studio.view3d.scenery`.
"""
