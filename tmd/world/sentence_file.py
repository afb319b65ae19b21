"""Sentence tests: requests with the condition that must hold when all is done.

A file of them is JSON Lines, ``*.sentences.jsonl`` beside the problems of a domain or anywhere else::

    {"id": "k1-01", "domain": "kitchen", "environment": "kitchen1", "text": "Fill the mug.",
     "goal": "(contains mug1 water)"}

``goal`` is ``null`` where the request is impossible or unsafe there and must be refused. Other keys are ignored.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pydantic import ConfigDict

from tmd.diagnostics import Location, TmdError
from tmd.json_record import JsonRecord
from tmd.pddl.reading.syntax import read_text, split_lines

SUFFIX = ".sentences.jsonl"


class SentenceTest(JsonRecord):
    """A request with the condition that must hold in the end; ``None`` where it must be refused."""

    model_config = ConfigDict(extra="ignore")
    WHAT = "a sentence test"
    REMAKE = ""
    REPAIR = 'write {"id": …, "domain": …, "environment": …, "text": …, "goal": "(…)" or null}'

    id: str
    domain: str
    environment: str
    text: str
    goal: str | None
    kind: Any = None
    _location: Location | None = None

    @property
    def location(self) -> Location | None:
        """The place where it was read."""
        return self._location

    @property
    def kinds(self) -> tuple[str, ...]:
        """The words of ``kind``, by which results are counted."""
        return tuple(k for k in self.kind if isinstance(k, str)) if isinstance(self.kind, list) else ()


def read_sentences(path: Path) -> list[SentenceTest]:
    """Read a file of sentence tests.

    Raises:
        TmdError: The file cannot be read, or a line is not a sentence test; with its place.
    """
    found: dict[str, SentenceTest] = {}
    for number, line in enumerate(split_lines(read_text(path)), start=1):
        if not line.strip():
            continue
        test = SentenceTest.from_text(line, str(path), number)
        test._location = Location(str(path), number, 1)
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
