"""``tmd experiment``: train, predict, score, and print the table."""

from __future__ import annotations

import os
from pathlib import Path

import click

from tmd.cli.output import emit
from tmd.cli.ranges import numbers
from tmd.cli.roots import Roots


@click.command("experiment", short_help="Train, predict, score, print the table.")
@click.option("--task", required=True, metavar="NAME|all", help="The task, such as ramen.")
@click.option(
    "--data", type=click.Choice(["bundled", "veil500"]), default="bundled", show_default=True, help="The data set."
)
@click.option(
    "--veil500",
    type=click.Path(path_type=Path),
    envvar="VEIL500_DIR",
    metavar="DIR",
    help="Where VEIL-500 is; $VEIL500_DIR by default.",
)
@click.option("--domain", default="kitchen", show_default=True, help="The domain of the bundled data.")
@click.option("--train-environments", callback=numbers, metavar="1-8", help="Train in these environments only.")
@click.option("--test-environments", callback=numbers, metavar="9,10", help="Test in these environments only.")
@click.option("--models", metavar="A,B", help="The rows of the table; the usual ones by default.")
@click.option("--jobs", type=click.IntRange(1), help="Processes; one for each processor by default.")
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True, help="Of everything random.")
@click.option("--out", required=True, type=click.Path(path_type=Path), metavar="DIR", help="The run's directory.")
@click.pass_obj
def command(
    roots: Roots,
    task: str,
    data: str,
    veil500: Path | None,
    domain: str,
    train_environments: tuple[int, ...] | None,
    test_environments: tuple[int, ...] | None,
    models: str | None,
    jobs: int | None,
    seed: int,
    out: Path,
) -> None:
    """Compare models on a task by cross-validation, or on environments that were held out.

    A run that was stopped goes on where it was when the same command is given again.
    """
    from tmd.cli.progress import progress_bar
    from tmd.evaluation.experiment import DEFAULT_MODELS, ExperimentConfig, run
    from tmd.evaluation.report import print_table, write_report

    config = ExperimentConfig(
        task=task,
        out=out,
        data=data,
        veil500=veil500 if data == "veil500" else None,
        train_environments=train_environments,
        test_environments=test_environments,
        models=_names(models) if models else DEFAULT_MODELS,
        jobs=jobs or os.cpu_count() or 1,
        seed=seed,
        domain=domain,
        domains=roots.domains,
        problems=roots.problems,
    )
    with progress_bar(f"{task}, {data} data") as progress:
        metrics = run(config, progress)
    report = write_report(out)
    print_table(metrics)
    emit(f"report: {report}\n")


def _names(models: str) -> tuple[str, ...]:
    names = tuple(dict.fromkeys(name.strip() for name in models.split(",") if name.strip()))
    if not names:
        raise click.UsageError("--models names no model")
    return names
