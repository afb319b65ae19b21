"""Weights: what each factor of the energy counts for. A text file with a name and a number on each line."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib import resources
from pathlib import Path

from tmd.diagnostics import Location, TmdError
from tmd.pddl.reading.syntax import nearest, read_text

NAMES = (
    *("env", "nl", "sim", "pcc", "dscpl", "inpr", "para", "trim", "cons"),
    *("cover", "words", "generated", "unasked"),
    *("latent_dscpl", "latent_inpr", "latent_para", "latent_cons"),
)
"""The factors that are weighed. Δ_jmp is not among them: its weight is infinite (section VI-F)."""
OURS = ("cover", "words", "generated", "unasked")
"""Those of them that are not in the paper."""
_RENAMED = {"original": "paper", "hand_set": "paper_extended", "generating": "policy", "stating": "goals"}


@dataclass(frozen=True, slots=True)
class Weights:
    """A number for each of :data:`NAMES`; what is not named weighs nothing."""

    values: Mapping[str, float]

    def __getitem__(self, name: str) -> float:
        return self.values.get(name, 0.0)

    def __iter__(self) -> Iterator[str]:
        return iter(NAMES)


def parse_weights(text: str, file: str = "<text>") -> Weights:
    """Read weights: ``name value`` a line, ``#`` begins a comment.

    Raises:
        TmdError: A line is none, a name is unknown or said twice, or a value is not a finite number.
    """
    values: dict[str, float] = {}
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.split("#", 1)[0].split()
        place = Location(file, number, 1)
        if not words:
            continue
        if len(words) != 2:
            raise TmdError("a line of weights is a name and a number", location=place, source=line)
        name, value = words
        if name not in NAMES:
            raise TmdError(f"there is no factor '{name}'", location=place, source=line, hint=nearest(name, NAMES))
        if name in values:
            raise TmdError(f"'{name}' has a weight already", location=place, source=line)
        try:
            values[name] = float(value)
        except ValueError:
            raise TmdError(f"'{value}' is not a number", location=place, source=line) from None
        if not math.isfinite(values[name]):
            raise TmdError(f"the weight of '{name}' is not finite", location=place, source=line)
    return Weights(values)


def read_weights(path: Path) -> Weights:
    """The weights in a file.

    Raises:
        TmdError: As :func:`parse_weights`, or the file cannot be read.
    """
    return parse_weights(read_text(path), str(path))


def named_weights(name: str) -> Weights:
    """The weights that come with the package: those of a preset (:mod:`tmd.inference.config`), or ``nearest``.

    Raises:
        TmdError: There are none of that name.
    """
    if name in _RENAMED:
        raise TmdError(f"the weights '{name}' are now called '{_RENAMED[name]}'")
    folder = resources.files("tmd.inference") / "data"
    known = sorted(f.name.removesuffix(".txt") for f in folder.iterdir() if f.name.endswith(".txt"))
    if name not in known:
        raise TmdError(f"there are no weights '{name}'", hint=nearest(name, known))
    return parse_weights((folder / f"{name}.txt").read_text(encoding="utf-8"), f"{name}.txt")


def format_weights(weights: Weights) -> str:
    """The text of a weights file; reading it gives the same weights."""
    return "".join(f"{name} {weights[name]!r}\n" for name in NAMES)
