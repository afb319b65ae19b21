"""Runs of experiments: data sets, folds, jobs, the directory of a run, and the back-ends that do the jobs.

Begin with :mod:`tmd.evaluation.runs.experiment`.
"""
