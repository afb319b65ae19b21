"""Whole experiments (:mod:`tmd.robot_trials.experiment`), and a robot that carries out predictions made in them.

This package stands above experiments and robot, which do not import each other. It reads the predictions of a finished
run (:mod:`tmd.robot_trials.choice`), lets the robot carry out one for each environment
(:mod:`tmd.robot_trials.perform`), and leaves records and films in the run's directory (:mod:`tmd.robot_trials.run`),
where the report finds them. For the same reason it writes a page on each prediction that the report
shows (:mod:`tmd.robot_trials.pages`).
"""
