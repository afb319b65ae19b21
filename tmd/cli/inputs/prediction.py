"""A plan that a model predicted, from the directory of an experiment."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeAlias

from tmd.diagnostics import Location, TmdError
from tmd.pddl.model import Instruction, Problem
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.reading.syntax import nearest, read_text
from tmd.veil.roots import Roots

_Row: TypeAlias = dict[str, Any]


def prediction(
    roots: Roots, run: Path, example: str | None, model: str | None
) -> tuple[Problem, tuple[Instruction, ...]]:
    """The environment and the predicted plan of one example of a run on the bundled data.

    Args:
        roots: Where domains and problems are.
        run: The directory of the run.
        example: Which example; the only one by default.
        model: Which row predicted it; the only one by default.

    Raises:
        TmdError: This is not a run, its data are not the bundled ones, or there is no such prediction.
    """
    config = _config(run)
    rows = _chosen(_predictions(run / "predictions.jsonl"), example, model)
    row = rows[0]
    file = str(run / "predictions.jsonl")
    plan = tuple(parse_instruction(text, file=file, line=row["line"]) for text in row["predicted"])
    _, world = roots.world(row["environment"], config.get("domain"))
    return world.task.problem, plan


def _config(run: Path) -> _Row:
    path = run / "config.json"
    if not path.is_file() or not (run / "predictions.jsonl").is_file():
        raise TmdError(
            f"{run} is no directory of a finished run",
            hint="it has config.json and predictions.jsonl of tmd experiment",
        )
    config = _object(read_text(path), path, 1)
    if config.get("data", "bundled") != "bundled":
        raise TmdError(f"{run} is a run on {config['data']}; only plans in bundled environments are exported")
    return config


def _predictions(path: Path) -> list[_Row]:
    found = []
    for number, line in enumerate(read_text(path).splitlines(), start=1):
        if line.strip():
            row = _object(line, path, number)
            if not {"id", "model", "environment", "predicted"} <= set(row):
                raise TmdError("this line is not a prediction", location=Location(str(path), number, 1))
            found.append({**row, "line": number})
    return found


def _object(text: str, path: Path, line: int) -> _Row:
    try:
        value = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise TmdError(f"this is not valid JSON: {error}", location=Location(str(path), line, 1)) from error
    if not isinstance(value, dict):
        raise TmdError("this is not a JSON object", location=Location(str(path), line, 1))
    return value


def _chosen(rows: Sequence[_Row], example: str | None, model: str | None) -> list[_Row]:
    """The one prediction that is meant."""
    left = _filtered(list(rows), "model", "--model", model)
    left = _filtered(left, "id", "--example", example)
    if not left:
        raise TmdError("the run has no predictions")
    return left


def _filtered(rows: list[_Row], key: str, option: str, value: str | None) -> list[_Row]:
    known = list(dict.fromkeys(str(row[key]) for row in rows))
    if value is None:
        if len(known) > 1:
            raise TmdError(f"the run has predictions of several: give {option}", hint=nearest("", known, what=key))
        return rows
    if value not in known:
        raise TmdError(f"the run has no prediction with {option} {value}", hint=nearest(value, known, what=f"{key}s"))
    return [row for row in rows if row[key] == value]
