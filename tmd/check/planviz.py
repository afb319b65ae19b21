"""Checking ``*.planviz.json``: what VS Code's PDDL extension leaves out where it draws a plan.

It lies beside the domain and has its name: ``domain.planviz.json``. ``excludeActions`` lists patterns of action names
that are not drawn, ``ignoreActionParameters`` patterns of parameters that are not written. Further keys are let be.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tmd.diagnostics import Location, TmdError
from tmd.pddl.reading.reader import read_domain
from tmd.pddl.reading.syntax import Report, read_text, split_lines

SUFFIX = "planviz.json"
_SLOW = re.compile(r"\)\s*[+*{]")
"""A group that is repeated can take a search for ever: no action is looked for then."""


def check_planviz(path: Path, report: Report) -> None:
    """Check one file; the domain beside it is asked for its actions, where it can be read.

    Raises:
        TmdError: It is not a JSON object.
    """
    text = read_text(path)
    try:
        said = json.loads(text)
    except json.JSONDecodeError as error:
        place = Location(str(path), error.lineno, error.colno)
        raise TmdError(f"not JSON: {error.msg}", location=place, code="json-syntax") from None
    except RecursionError:
        place = Location(str(path), 1, 1)
        raise TmdError("nested too deeply", location=place, code="nested-too-deeply") from None
    except ValueError:  # Python reads no number of more than 4,300 digits
        place = Location(str(path), 1, 1)
        raise TmdError("a number has too many digits", location=place, code="json-syntax") from None
    if not isinstance(said, dict):
        raise TmdError(f"{SUFFIX} is a JSON object", location=Location(str(path), 1, 1), code="bad-value")
    actions = _actions(path)
    for pattern, wrong in _patterns(said):
        code, message = ("bad-value", wrong) if wrong else _fault(pattern, actions)
        if message:
            report(TmdError(message, location=_place(path, text, pattern), code=code))


def _actions(path: Path) -> list[str] | None:
    """The actions of the domain of the same name; ``None`` where there is none, or it has faults of its own."""
    name = path.name.removesuffix(SUFFIX).rstrip(".") or "domain"
    try:
        return [action.name for action in read_domain(path.with_name(f"{name}.pddl")).actions]
    except TmdError:
        return None


def _patterns(said: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Each pattern of action names, with what is wrong with the form of its entry."""
    excluded = said.get("excludeActions", [])
    ignored = said.get("ignoreActionParameters", [])
    for key, entries in (("excludeActions", excluded), ("ignoreActionParameters", ignored)):
        if not isinstance(entries, list):
            yield key, f"{key} is a list"
            continue
        for entry in entries:
            if key == "excludeActions":
                yield (entry, "") if isinstance(entry, str) else (key, f"{key} is a list of patterns")
            elif isinstance(entry, dict) and all(isinstance(entry.get(k), str) for k in ("action", "parameterPattern")):
                yield entry["action"], ""
            else:
                yield key, f"{key} has entries with action and parameterPattern"


def _fault(pattern: str, actions: list[str] | None) -> tuple[str, str]:
    """The kind and the message of what is wrong with a pattern; no message where nothing is."""
    try:
        known = re.compile(pattern, re.IGNORECASE)
    except re.error as error:
        return "bad-value", f"'{pattern}' is not a pattern: {error}"
    if _SLOW.search(pattern):
        return "", ""
    if actions is not None and not any(known.search(action) for action in actions):
        return "unknown-action", f"no action of the domain is named like '{pattern}'"
    return "", ""


def _place(path: Path, text: str, word: str) -> Location:
    """Where a word stands; the beginning of the file where that cannot be told."""
    quoted = json.dumps(word)
    for number, line in enumerate(split_lines(text), start=1):
        if quoted in line:
            return Location(str(path), number, line.index(quoted) + 1)
    return Location(str(path), 1, 1)
