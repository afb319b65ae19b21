"""Sentence tests: requests with the condition that must hold when all is done.

A file of them is JSON Lines, ``*.sentences.jsonl`` beside the problems of a domain or anywhere else::

    {"id": "k1-01", "domain": "kitchen", "environment": "kitchen1", "text": "Fill the mug.",
     "goal": "(contains mug1 water)"}

``goal`` is ``null`` where the request is impossible or unsafe there and must be refused. Other keys are ignored.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from tmd.diagnostics import Location, TmdError
from tmd.pddl.reading.syntax import read_text, split_lines

SUFFIX = ".sentences.jsonl"
_TEXTS = ("id", "domain", "environment", "text")


@dataclass(frozen=True, slots=True)
class SentenceTest:
    """A request with the condition that must hold in the end; ``None`` where it must be refused."""

    id: str
    domain: str
    environment: str
    text: str
    goal: str | None
    kinds: tuple[str, ...] = ()
    location: Location | None = None


def read_sentences(path: Path) -> list[SentenceTest]:
    """Read a file of sentence tests.

    Raises:
        TmdError: The file cannot be read, or a line is not a sentence test; with its place.
    """
    found: dict[str, SentenceTest] = {}
    for number, line in enumerate(split_lines(read_text(path)), start=1):
        if not line.strip():
            continue
        test = _read_line(line, Location(str(path), number, 1))
        if test.id in found:
            raise TmdError(
                f"the id '{test.id}' stands in this file twice",
                location=test.location,
                hint="give each an id of its own",
            )
        found[test.id] = test
    return list(found.values())


def domain_sentences(directory: Path) -> list[SentenceTest]:
    """Return the sentence tests beside the problems of a domain.

    Raises:
        TmdError: There are none, or a file of them is wrong.
    """
    paths = sorted(directory.glob(f"*{SUFFIX}"))
    if not paths:
        raise TmdError(
            f"there are no sentence tests in {directory}", hint=f"write one, such as my{SUFFIX}; see docs/goals.md"
        )
    return [test for path in paths for test in read_sentences(path)]


_FORM = 'write {"id": …, "domain": …, "environment": …, "text": …, "goal": "(…)" or null}'


def _read_line(line: str, place: Location) -> SentenceTest:
    try:
        data = json.loads(line)
    except json.JSONDecodeError as error:
        where = Location(place.file, place.line, error.colno)
        raise TmdError(f"the line is not valid JSON: {error.msg}", location=where, hint=_FORM, source=line) from None
    except RecursionError:
        raise TmdError("the line is nested too deeply", location=place, hint=_FORM) from None
    except ValueError:  # Python reads no number of more than 4,300 digits
        raise TmdError("a number of the line has too many digits", location=place, hint=_FORM) from None
    if not isinstance(data, dict):
        raise TmdError("a sentence test is a JSON object", location=place, hint=_FORM)
    for key in _TEXTS:
        if not isinstance(data.get(key), str):
            raise TmdError(f"the key '{key}' is missing or is not a text", location=place, hint=_FORM)
    goal = data.get("goal", 0)
    if goal is not None and not isinstance(goal, str):
        raise TmdError("the key 'goal' is missing, or is neither a text nor null", location=place, hint=_FORM)
    kinds = data.get("kind", [])
    listed = tuple(k for k in kinds if isinstance(k, str)) if isinstance(kinds, list) else ()
    name, domain, environment, text = (data[key] for key in _TEXTS)
    return SentenceTest(name, domain, environment, text, goal, listed, place)
