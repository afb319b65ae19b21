"""The record of date, time and machine of a run, in a file beside what decides nothing else."""

from __future__ import annotations

import os
import platform
import shlex
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from time import monotonic

from tmd.diagnostics import TmdError
from tmd.evaluation.runs.config import ExperimentConfig
from tmd.files import write_text
from tmd.format.json_layout import lay_out
from tmd.pddl.reading.syntax import read_text
from tmd.records.provenance import Provenance

PROVENANCE = "provenance.json"


def read_provenance(run: Path) -> Provenance | None:
    """Return the provenance of a run; ``None`` where none was kept.

    Raises:
        TmdError: It is damaged.
    """
    path = run / PROVENANCE
    return Provenance.from_text(read_text(path), str(path)) if path.is_file() else None


@contextmanager
def recorded(config: ExperimentConfig) -> Iterator[None]:
    """Add the time that is spent meanwhile to the run's provenance, whether the work ends or is stopped."""
    before = 0.0
    with suppress(TmdError):
        earlier = read_provenance(config.out)
        before = earlier.seconds if earlier else 0.0
    began = monotonic()
    try:
        yield
    finally:
        found = Provenance(
            command=command_of(config),
            date=datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
            seconds=round(before + monotonic() - began, 1),
            machine=f"{platform.system()} {platform.machine()}, {os.cpu_count()} processors",
            python=f"{platform.python_implementation()} {platform.python_version()}",
            revision=revision(),
        )
        with suppress(TmdError):  # the files that matter report what is wrong with the directory
            write_text(config.out / PROVENANCE, lay_out(found.to_value()) + "\n")


def command_of(config: ExperimentConfig) -> str:
    """Return the command that makes the run; what has its default is left out."""
    usual = ExperimentConfig(config.task, config.out)
    words = ["tmd"]
    for name in ("domains", "problems"):
        if value := getattr(config, name):
            words += [f"--{name}", str(value)]
    words += ["experiment", "--task", config.task]
    for name in (
        *("data", "veil500", "domain", "train_tasks", "train_environments", "test_environments"),
        *("drop_sentences", "models", "seed", "scheduler", "jobs"),
    ):
        value = getattr(config, name)
        if value != getattr(usual, name):
            given = ",".join(map(str, value)) if isinstance(value, tuple) else str(value)
            words += [f"--{name.replace('_', '-')}", given]
    return shlex.join([*words, "--out", str(config.out)])


def revision() -> str:
    """Return the revision of the checkout, if this is one."""
    here = Path(__file__).resolve().parent
    try:
        found = subprocess.run(
            ["git", "describe", "--always", "--dirty"], cwd=here, capture_output=True, text=True, timeout=10
        )
    except (OSError, subprocess.TimeoutExpired):
        return "unknown"
    return found.stdout.strip() or "unknown"
