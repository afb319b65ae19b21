"""The object classes of VEIL-500 (``Objects.xml``): which states they declare and what they are good for."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from tmd.datasets.veil500.xml import Element, read_xml
from tmd.diagnostics import DataError

IGNORED_STATES = frozenset({"Color"})
"""Declared by nearly every class, set by no action and no environment."""


@dataclass(frozen=True, slots=True)
class VeilObjectClass:
    """A class: its states with their values at the start, in file order, and its affordances."""

    name: str
    states: Mapping[str, bool] = field(default_factory=dict)
    affordances: frozenset[str] = frozenset()


def class_of(object_name: str) -> str:
    """Return the class that an object's name says: ``Mug_1`` is a Mug, ``Counter1_1`` a Counter."""
    return re.sub(r"[_\d]+\Z", "", object_name)


def is_true(value: str) -> bool:
    """Return a state's value as a Boolean: ``True`` and positive whole numbers are true, all else is false."""
    value = value.strip()
    return value == "True" or (value.isdecimal() and int(value) > 0)


def read_classes(path: Path) -> dict[str, VeilObjectClass]:
    """Return the classes of ``Objects.xml``. Blocks about one class add up; the first default of a state counts.

    Raises:
        DataError: The file is missing, broken or without classes.
    """
    root = read_xml(path, "objects")
    states: dict[str, dict[str, bool]] = {}
    affordances: dict[str, set[str]] = {}
    for block in root.all("object"):
        declared = _states(block)
        offered = [element.text.strip() for element in block.walk() if element.tag == "affordance"]
        for name in (element.text.strip() for element in block.all("name")):
            own = states.setdefault(name, {})
            for state, value in declared:
                own.setdefault(state, value)
            affordances.setdefault(name, set()).update(offered)
    if not states:
        raise DataError(
            "no object class in the file",
            location=root.location,
            hint="copy Objects.xml again from the release",
        )
    return {name: VeilObjectClass(name, own, frozenset(affordances[name])) for name, own in states.items()}


def _states(block: Element) -> list[tuple[str, bool]]:
    """Return all ``stateName``/``default`` pairs of a block, wherever they stand."""
    found = []
    for element in block.walk():
        for name, default in zip(element.all("stateName"), element.all("default"), strict=False):
            state = name.text.strip()
            if state not in IGNORED_STATES:
                found.append((state, is_true(default.text)))
    return found
