"""Edits of an environment: other places and states, more or fewer things; checked before they are used."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from tmd.diagnostics import TmdError
from tmd.files import make_directory, write_text
from tmd.world.classes import ROOT, StateValue, Vertex
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder
from tmd.world.shape import NAME

# Characters that the name of an environment may have.
_LONGEST = 60
# Objects that an environment may have here.
_MOST = 200


@dataclass(frozen=True, slots=True)
class StateChange:
    """A state that a part of an object may be given; ``part`` is ``root`` for the object itself."""

    part: str
    state: str
    value: StateValue

    def __str__(self) -> str:
        where = "" if self.part == ROOT else f"{self.part}: "
        value = "" if self.value is True else "not " if self.value is False else f" {self.value}"
        name = self.state.replace("_", " ")
        return f"{where}{value}{name}" if self.value is False else f"{where}{name}{value}"


class EditedEnvironment:
    """An environment file that is being changed; the file that it was read from stays as it is.

    Args:
        path: The file.
        folder: The domain.

    Raises:
        TmdError: It is a PDDL problem, or wrong.
    """

    def __init__(self, path: Path, folder: DomainFolder) -> None:
        if path.suffix != ".yaml":
            raise TmdError(f"{path.name} is a PDDL problem, which cannot be changed here", hint="edit the file")
        self._folder = folder
        self._read = load_environment(path)
        dumped = {
            name: entry.model_dump(by_alias=True, exclude_defaults=True, mode="json")
            for name, entry in self._read.objects.items()
        }
        self._objects: dict[str, dict[str, Any]] = dumped

    def classes(self) -> list[str]:
        """Return the classes of things that can be added."""
        return sorted({entry["class"] for entry in self._objects.values()})

    def changes(self, name: str) -> list[StateChange]:
        """Return the states that an object and its parts can be given, other than those that they have."""
        entry = self._entry(name)
        found = []
        for part, vertex in self._folder.classes.get(entry["class"]).vertices.items():
            own = entry.get("states", {}) if part == ROOT else entry.get("parts", {}).get(part, {})
            for state, usual in vertex.states.items():
                now = own.get(state, usual)
                found += [StateChange(part, state, value) for value in _values(vertex, usual) if value != now]
        return found

    def change(self, name: str, change: StateChange) -> None:
        """Give an object, or a part of it, a state."""
        entry = self._entry(name)
        if change.part == ROOT:
            entry.setdefault("states", {})[change.state] = change.value
        else:
            entry.setdefault("parts", {}).setdefault(change.part, {})[change.state] = change.value

    def put(self, name: str, relation: str, place: str) -> None:
        """Put an object somewhere else: *in* the fridge, *on* the table."""
        self._entry(place)
        entry = self._entry(name)
        entry["at"] = f"{relation} {place}"
        entry.pop("position", None)
        entry.pop("yaw", None)

    def add(self, kind: str, relation: str, place: str) -> str:
        """Add a thing of a class, and return its name."""
        self._entry(place)
        if len(self._objects) >= _MOST:
            raise TmdError(f"an environment has at most {_MOST} objects here")
        name = next(name for n in range(1, _MOST + 2) if (name := f"{kind}{n}") not in self._objects)
        self._objects[name] = {"class": kind, "at": f"{relation} {place}"}
        return name

    def remove(self, name: str) -> None:
        """Take an object away.

        Raises:
            TmdError: Something stands on or in it.
        """
        self._entry(name)
        there = sorted(other for other, entry in self._objects.items() if entry.get("at", "").split()[1:] == [name])
        if there:
            raise TmdError(f"{', '.join(there)} would be nowhere", hint=f"put what is at {name} somewhere else first")
        del self._objects[name]

    def write(self, directory: Path, name: str) -> Path:
        """Write it into a directory, and return the file.

        Raises:
            TmdError: An environment cannot have that name, or the file cannot be written.
        """
        if not re.fullmatch(NAME, name) or len(name) > _LONGEST:
            hint = "a name begins with a lower-case letter and has lower-case letters, digits and _, at most 60"
            raise TmdError(f"an environment cannot be called {name[:_LONGEST]!r}", hint=hint)
        said: Mapping[str, Any] = {
            "name": name, "domain": self._read.domain, "about": self._read.about, "objects": self._objects,
            "facts": list(self._read.facts),
        }  # fmt: skip
        if self._read.room:
            said = {**said, "room": [list(corner) for corner in self._read.room]}
        path = directory / f"{name}.yaml"
        make_directory(directory)
        write_text(path, yaml.safe_dump(dict(said), sort_keys=False, allow_unicode=True, width=120))
        return path

    def _entry(self, name: str) -> dict[str, Any]:
        if name not in self._objects:
            raise TmdError(f"there is no object '{name}'")
        return self._objects[name]


def _values(vertex: Vertex, usual: StateValue) -> list[StateValue]:
    """Return the values that a state may have: true and false, or the settings that the part offers."""
    if isinstance(usual, bool):
        return [True, False]
    return [fact[2] for fact in vertex.facts if fact[:2] == ("offers", "self")] if isinstance(usual, str) else []
