"""A robot that carries out predictions made in experiments.

This package stands above experiments and robot, which do not import each other. Begin with
:mod:`tmd.robot_trials.trials`, which ``tmd experiment --robot`` calls. It reads the predictions of a
finished run, lets the robot carry out one for each environment, and leaves records and films in the run's directory,
where the report finds them.
"""
