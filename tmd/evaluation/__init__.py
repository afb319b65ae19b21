"""Experiments: data sets, models to compare, metrics, cross-validation, and the report of a run.

Begin with :mod:`tmd.evaluation.runs.experiment`, which runs one. :mod:`~tmd.evaluation.models` has what is compared,
:mod:`~tmd.evaluation.metrics` and :mod:`~tmd.evaluation.summary` how, :mod:`~tmd.evaluation.report` what is shown
of it. :mod:`~tmd.evaluation.sentence_tests` is ``tmd test``, and :mod:`~tmd.evaluation.learn` is ``tmd learn``.
"""
