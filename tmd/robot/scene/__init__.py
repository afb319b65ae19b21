"""An environment as a physical scene: which object stands where, what supports it, and which handles it has.

Begin with :mod:`tmd.robot.scene.scene`.
"""
