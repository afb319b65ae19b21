"""Films and pictures of a run: the camera, captions, film files, and scenes drawn without a simulator.

Begin with :mod:`tmd.robot.video.film`.
"""
