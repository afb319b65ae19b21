"""Environments: objects with their places and states.

An environment is a YAML file::

    name: kitchen1
    domain: kitchen
    about: One line for people.
    objects:
      counter1: {class: counter, position: [0.0, 1.9, 0.0], yaw: -90}
      mug1: {class: mug, at: on counter1, states: {contains: [water]}}
      stove1:
        class: stove
        parts:
          knob2: {set_to: high}
    room: [[-2.4, -2.4], [2.4, -2.4], [2.4, 2.4], [-2.4, 2.4]]   # where its walls meet; without it, around the fixtures
    facts: []   # any further atoms, e.g. `found pr2 mug1`

Positions are metres in the room's frame (x forward, y left, z up), yaw is degrees about z: with 0 the front looks along
x. The parts of an object are objects as well,
named ``stove1_knob2``.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, TypeAlias

from pydantic import BaseModel, ConfigDict, Field, PrivateAttr

from tmd.diagnostics import TmdError
from tmd.pddl.reading.syntax import Report
from tmd.world.classes import StateValue
from tmd.world.shape import NAME
from tmd.world.yaml_positions import YamlSource

Position = tuple[float, float, float]
Metres: TypeAlias = Annotated[float, Field(ge=-100.0, le=100.0)]
Corner: TypeAlias = tuple[Metres, Metres]


class ObjectEntry(BaseModel):
    """One object, as an environment file has it."""

    model_config = ConfigDict(defer_build=True, extra="forbid")
    class_name: str = Field(alias="class", pattern=NAME)
    at: str | None = None
    states: dict[str, StateValue] = {}
    parts: dict[str, dict[str, StateValue]] = {}
    position: Position | None = None
    yaw: float | None = Field(default=None, ge=-360.0, le=360.0)


class Environment(BaseModel):
    """An environment as its file has it; :func:`tmd.world.compile.compile_problem` gives it its meaning.

    ``room`` has the corners of the walls, in order.
    """

    model_config = ConfigDict(defer_build=True, extra="forbid")
    name: str = Field(pattern=NAME)
    domain: str
    about: str = ""
    objects: dict[str, ObjectEntry]
    facts: list[str] = []
    room: list[Corner] = Field(default=[], min_length=3, max_length=100)
    _source: YamlSource = PrivateAttr()

    @property
    def source(self) -> YamlSource:
        """The file."""
        return self._source


def load_room(path: Path) -> Environment:
    """Read an environment of which the robot's scene can be built.

    Raises:
        TmdError: As :func:`load_environment`, or it is a PDDL problem.
    """
    if path.suffix == ".pddl":
        raise TmdError(
            f"{path}: a PDDL problem does not say where things stand, so there is no scene of it",
            hint="give an environment (YAML)",
        )
    return load_environment(path)


def load_environment(path: Path, report: Report | None = None) -> Environment:
    """Read an environment file; ``report`` takes its faults.

    Raises:
        TmdError: It cannot be read or is not an environment; with file, line and column.
    """
    source = YamlSource(path, report)
    environment = source.load(Environment)
    environment._source = source
    for name in environment.objects:
        if not re.match(NAME, name):
            hint = "use lower-case letters, digits and _"
            source.fault(source.error(("objects", name), f"'{name}' cannot name an object", hint, "bad-name"))
    return environment
