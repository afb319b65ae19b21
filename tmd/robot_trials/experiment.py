"""The driver of ``tmd experiment``: a whole experiment, from its configuration to the report."""

from __future__ import annotations

from typing import get_args

from tmd.diagnostics import OptionError
from tmd.evaluation.report.report import write_report
from tmd.evaluation.runs.config import ExperimentConfig
from tmd.evaluation.runs.experiment import Progress, collect, run
from tmd.evaluation.runs.finished_run import Trials
from tmd.pddl.reading.syntax import nearest
from tmd.records.metrics import Metrics
from tmd.robot_trials.trials import Mode, run_trials


def run_experiment(
    config: ExperimentConfig, *, collect_only: bool = False, progress: Progress | None = None
) -> Metrics:
    """Train, predict and score, or what is left of it, and write the report.

    Args:
        config: The run.
        collect_only: Train nothing: recompute everything from finished parts.
        progress: Called with the number of parts done and of all parts.

    Returns:
        The contents of ``metrics.json``; ``report.html`` is beside it in ``config.out``.

    Raises:
        TmdError: The configuration, the data, the directory or the cluster cannot be used, or parts are missing.
    """
    metrics = collect(config) if collect_only else run(config, progress)
    write_report(config.out)
    return metrics


def carry_out_predictions(config: ExperimentConfig, mode: Mode, *, progress: Progress | None = None) -> Trials:
    """Let a simulated PR2 carry out one prediction for each environment of a finished run, and add it to the report.

    Args:
        config: The run.
        mode: Motion of the robot, ``kinematic`` or ``physics``.
        progress: Called with the number of trials done and of all trials.

    Returns:
        The trials, or the reason why none could be made.

    Raises:
        OutputError: The run's directory cannot be written.
        WorkerLostError: A process that simulated was killed.
        OptionError: There is no such motion.
        TmdError: The directory does not hold a finished run.
    """
    if mode not in get_args(Mode):
        raise OptionError(f"there is no mode '{mode}'", hint=nearest(mode, get_args(Mode), what="modes"))
    trials = run_trials(config, mode, progress)
    write_report(config.out)
    return trials
