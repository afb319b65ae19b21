"""What learning has proposed so far, on disk: after a kill it goes on where it was.

JSON Lines, one for each example of each round: ``{"round", "example", "plans": [[factors, loss], …]}``. Numbers are
written so that they read back the same, hence what is learned does not depend on interruptions.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tmd.diagnostics import OutputError
from tmd.files import make_directory

Vector = NDArray[np.float64]
"""A number for each of :data:`~tmd.inference.weights.NAMES`."""
Proposed = list[tuple[Vector, float]]
"""Plans, cheapest first: the factors of each before they are weighed, and its loss."""


class Journal:
    """Proposals by round and example.

    A line that was cut off by a kill is dropped, and what comes after it as well.

    Args:
        path: The file; made when there is something to write.
        part: What the lines are about, where several learners share a file.
    """

    def __init__(self, path: Path, part: str = "") -> None:
        self.path = path
        self.part = part
        self._known: dict[tuple[int, int], Proposed] = {}
        if path.is_file():
            self._load()

    def read(self, number: int, example: int) -> Proposed | None:
        """What was proposed for an example in a round, if it was."""
        return self._known.get((number, example))

    def write(self, number: int, example: int, proposed: Sequence[tuple[Vector, float]]) -> None:
        """Add a line.

        Raises:
            OutputError: It cannot be written.
        """
        plans = [[vector.tolist(), loss] for vector, loss in proposed]
        line = json.dumps({"part": self.part, "round": number, "example": example, "plans": plans})
        make_directory(self.path.parent)
        try:
            with self.path.open("a", encoding="utf-8") as file:
                file.write(line + "\n")
        except OSError as error:
            raise OutputError(f"{self.path}: cannot be written: {error.strerror}") from None

    def _load(self) -> None:
        whole = 0
        text = self.path.read_bytes()
        for line in text.splitlines(keepends=True):
            try:
                entry = json.loads(line) if line.endswith(b"\n") else None
                if entry is None:
                    break
                plans = [(np.array(vector, dtype=np.float64), float(loss)) for vector, loss in entry["plans"]]
                if entry["part"] == self.part:
                    self._known[entry["round"], entry["example"]] = plans
            except (ValueError, KeyError, TypeError):
                break
            whole += len(line)
        if whole < len(text):
            with self.path.open("r+b") as file:
                file.truncate(whole)
