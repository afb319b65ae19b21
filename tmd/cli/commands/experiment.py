"""``tmd experiment``: train, predict, score, print the table."""

from __future__ import annotations

import logging
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tmd.cli.options import OUTPUT, PATH, NumberRange, name_list, seed_option
from tmd.cli.output import emit
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.evaluation.runs.config import ExperimentConfig


@contextmanager
def progress_bar(what: str) -> Iterator[Callable[[int, int], None]]:
    """Show a bar once there is progress; yields a function of the number of parts done and of all parts."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    bar = Progress(*columns, console=Console(stderr=True))
    task = bar.add_task(what, total=None)

    def tell(done: int, total: int) -> None:
        with suppress(OSError):  # the run goes on where nobody can read it
            bar.update(task, completed=done, total=total)
            bar.start()

    try:
        yield tell
    finally:
        if bar.live.is_started:
            with suppress(OSError):
                bar.stop()


@contextmanager
def warnings_shown() -> Iterator[None]:
    """Show the user what a run warns of meanwhile, such as a damaged part."""
    from tmd.evaluation.runs.run_directory import LOG

    log, handler = logging.getLogger(LOG), logging.StreamHandler()
    handler.setLevel(logging.WARNING)
    log.addHandler(handler)
    try:
        yield
    finally:
        log.removeHandler(handler)


_PIECE = re.compile(r"\s*(\d{1,4})\s*(?:-\s*(\d{1,4})\s*)?")


def numbers(ctx: click.Context, param: click.Parameter, value: str | None) -> tuple[int, ...] | None:
    """Parse an option of numbers: each number once, in ascending order (a callback of :mod:`click`).

    Raises:
        click.BadParameter: It says anything else.
    """
    if value is None:
        return None
    found: set[int] = set()
    for piece in value.split(","):
        match = _PIECE.fullmatch(piece)
        if match is None:
            raise click.BadParameter(f"'{piece}' is neither a number nor a range such as 1-8", ctx, param)
        first, last = int(match[1]), int(match[2] or match[1])
        if last < first:
            raise click.BadParameter(f"the range {piece.strip()} runs backwards", ctx, param)
        found.update(range(first, last + 1))
    return tuple(sorted(found))


@click.command("experiment", short_help="Train, predict, score, print the table.")
@click.option("--task", required=True, metavar="NAME|all", help="The task, such as ramen.")
@click.option(
    "--data", type=click.Choice(["bundled", "veil500"]), default="bundled", show_default=True, help="The data set."
)
@click.option(
    "--veil500",
    type=PATH,
    envvar="VEIL500_DIR",
    metavar="DIR",
    help="Where VEIL-500 is; $VEIL500_DIR by default.",
)
@click.option(
    "--domain", default="kitchen", show_default=True, metavar="NAME|FILE", help="The domain of the bundled data."
)
@click.option(
    "--train-tasks", callback=name_list(), metavar="A,B", help="Training tasks; by default those of the protocol."
)
@click.option("--train-environments", callback=numbers, metavar="1-8", help="Train in these environments only.")
@click.option("--test-environments", callback=numbers, metavar="9,10", help="Test in these environments only.")
@click.option(
    "--drop-sentences",
    type=NumberRange(0, 1, max_open=True),
    default=0.0,
    metavar="P",
    help="Leave each sentence of a test text out with this probability.",
)
@click.option("--models", callback=name_list(), metavar="A,B", help="The rows of the table; the usual ones by default.")
@seed_option
@click.option("--jobs", type=click.IntRange(1), help="Processes; one for each processor by default.")
@click.option("--scheduler", metavar="tcp://HOST:PORT", help="Work on the cluster of this dask scheduler.")
@click.option(
    "--step",
    type=click.Choice(["all", "robot", "report"]),
    default="all",
    show_default=True,
    help="The whole run; or only what the robot does, or only the report, from what is done.",
)
@click.option(
    "--robot",
    type=click.Choice(["physics", "kinematic", "off"]),
    help="Let a simulated PR2 carry out one prediction for each environment in the end, and film it; off by default.",
)
@click.option(*OUTPUT, "out", required=True, type=PATH, metavar="DIR", help="The run's directory.")
@click.pass_obj
def experiment(
    roots: Roots,
    /,
    scheduler: str | None,
    jobs: int | None,
    models: tuple[str, ...] | None,
    veil500: Path | None,
    step: str,
    robot: str | None,
    **settings: Any,  # noqa: ANN401 - fields of ExperimentConfig
) -> None:
    """Compare models on a task by cross-validation, or on environments that were held out.

    A run that was stopped goes on where it was when the same command is given again.
    """
    if step == "robot" and robot == "off":
        raise click.UsageError("--step robot and --robot off do not go together")

    from joblib import cpu_count

    from tmd.evaluation.runs.config import ExperimentConfig

    veil = settings["data"] == "veil500"
    named = settings["domain"]
    folder = None if veil else roots.folder(named)
    if folder and folder.name != named:  # it was written as a path
        roots, settings["domain"] = replace(roots, domains=folder.path.parent), folder.name
    config = ExperimentConfig(
        veil500=veil500 if veil else None,
        models=models or (),
        domains=roots.domains,
        problems=roots.problems,
        backend="joblib" if scheduler is None else "dask",
        scheduler=scheduler,
        jobs=jobs or max(1, int(cpu_count())),  # on a cluster, fewer than the machine has
        **settings,
    )
    _run(config, step, robot or ("kinematic" if step == "robot" else "off"))


def _run(config: ExperimentConfig, step: str, robot: str) -> None:
    from tmd.evaluation.report.report import REPORT, print_table
    from tmd.evaluation.runs.experiment import run_experiment

    with warnings_shown(), progress_bar(f"{config.task}, {config.data} data") as progress:
        metrics = run_experiment(config, collect_only=step != "all", progress=progress)
    print_table(metrics)
    if robot != "off" and step != "report":
        _trials(config, robot)
    emit(f"report: {config.out / REPORT}\n")


def _trials(config: ExperimentConfig, mode: str) -> None:
    from tmd.robot_trials.trials import carry_out_predictions

    with progress_bar(f"the robot, {mode}") as progress:
        trials = carry_out_predictions(config, "physics" if mode == "physics" else "kinematic", progress=progress)
    if trials.skipped:
        emit(f"the robot did nothing: {trials.skipped}\n", error=True)
    for trial in trials.found:
        why = f": {trial.reason}" if trial.reason else ""
        emit(f"robot in {trial.asked.environment}: {trial.status.replace('_', ' ')}{why}\n")
