"""Whole experiments, and a robot that carries out predictions made in them.

This package stands above experiments and robot, which do not import each other. Begin with
:mod:`tmd.robot_trials.experiment`, which ``tmd experiment`` calls. :mod:`~tmd.robot_trials.trials` reads the
predictions of a finished run, lets the robot carry out one for each environment, and leaves records and films in the
run's directory, where the report finds them.
"""
