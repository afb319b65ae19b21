"""SAS+ by Fast Downward's translator, which is under the GPL and therefore a process of its own."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

from tmd.diagnostics import MissingToolError, TmdError
from tmd.export.planned_problem import Planned
from tmd.pddl.writer import format_domain, format_problem

_LIMIT = 600.0
"""Seconds after which the translator is stopped: a guard, no part of the result."""


def format_sas(source: Planned) -> str:
    """The problem as Fast Downward's translator writes it.

    Raises:
        MissingToolError: Fast Downward is not installed.
        TmdError: The translator refuses the problem.
    """
    with tempfile.TemporaryDirectory(prefix="tmd-sas-") as name:
        directory = Path(name)
        (directory / "domain.pddl").write_text(format_domain(source.portable.domain), encoding="utf-8")
        (directory / "problem.pddl").write_text(format_problem(source.portable), encoding="utf-8")
        done = subprocess.run(
            [sys.executable, str(_driver()), "--translate", "domain.pddl", "problem.pddl"],
            cwd=directory,
            capture_output=True,
            text=True,
            timeout=_LIMIT,
            check=False,
        )
        written = directory / "output.sas"
        if done.returncode or not written.is_file():
            told = [line for line in (done.stderr + done.stdout).splitlines() if line.strip()]
            raise TmdError(f"Fast Downward's translator failed: {told[-1] if told else f'exit {done.returncode}'}")
        return written.read_text(encoding="utf-8")


def _driver() -> Path:
    spec = find_spec("up_fast_downward")
    if spec is None or spec.origin is None:
        raise MissingToolError("Fast Downward is not installed", hint="pip install up-fast-downward")
    return Path(spec.origin).parent / "downward" / "fast-downward.py"
