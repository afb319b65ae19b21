"""A whole experiment, from its configuration to the page: what ``tmd experiment`` does."""

from __future__ import annotations

from tmd.evaluation.report.report import write_report
from tmd.evaluation.runs.config import ExperimentConfig
from tmd.evaluation.runs.experiment import Progress, collect, run
from tmd.evaluation.runs.trial_records import Trials
from tmd.records.metrics import Metrics
from tmd.robot_trials.pages import write_pages
from tmd.robot_trials.run import Mode, run_trials


def run_experiment(
    config: ExperimentConfig, *, collect_only: bool = False, progress: Progress | None = None
) -> Metrics:
    """Train, predict and score, or what is left of it, and write the report.

    Args:
        config: The run. A share of one (``config.shard``) is done by :func:`tmd.evaluation.runs.experiment.work`.
        collect_only: Train nothing: compute everything anew from what is done.
        progress: Is told the number of parts done and of all parts.

    Returns:
        What ``metrics.json`` has; ``report.html`` is beside it in ``config.out``.

    Raises:
        TmdError: The configuration, the data, the directory or the cluster cannot be used, or parts are missing.
    """
    metrics = collect(config) if collect_only else run(config, progress)
    write_pages(config)
    write_report(config.out)
    return metrics


def carry_out_predictions(config: ExperimentConfig, mode: Mode, *, progress: Progress | None = None) -> Trials:
    """Let a simulated PR2 carry out one prediction for each environment of a finished run, and add it to the report.

    Args:
        config: The run.
        mode: How the robot moves, ``kinematic`` or ``physics``.
        progress: Is told the number of trials done and of all trials.

    Returns:
        What came of it; where no trial could be made, why.

    Raises:
        OutputError: The run's directory cannot be written.
        WorkerLostError: A process that simulated was killed.
        TmdError: The directory holds no finished run.
    """
    trials = run_trials(config, mode, progress)
    write_pages(config, carried_out=True)
    write_report(config.out)
    return trials
