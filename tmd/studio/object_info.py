"""Facts about one object: its parts, its states, and the edges of its object graph."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tmd.diagnostics import TmdError
from tmd.pddl.model import GroundAtom
from tmd.pddl.reading.syntax import nearest
from tmd.pddl.task import Bits
from tmd.world.world import PART_OF, World


@dataclass(frozen=True, slots=True)
class About:
    """One object in one state. Facts are sorted; :class:`~tmd.view.wording.Wording` puts them into words.

    Attributes:
        name: The object.
        kind: Its class.
        whole: What it is a part of, if of anything.
        parts: Its parts.
        states: What is so now of it alone: *mug1 is hot*.
        relations: What is so now of it and another object: *mug1 is on counter1*.
        edges: What never changes between it and another object: *stove1_knob1 controls stove1_burner1*.
    """

    name: str
    kind: str
    whole: str | None
    parts: tuple[str, ...]
    states: tuple[GroundAtom, ...]
    relations: tuple[GroundAtom, ...]
    edges: tuple[GroundAtom, ...]


def about(name: str, world: World, state: Bits) -> About:
    """Return the facts about ``name`` in ``state``.

    ``whole`` and ``parts`` record that two objects belong together; edges that hold both ways add nothing, and are
    left out.

    Raises:
        TmdError: There is no such object.
    """
    require_object(name, world)
    profiles, static = world.profiles, world.task.static
    states, relations = _divided(name, world.task.names(state), world)
    _, edges = _divided(name, static, world)
    return About(
        name,
        world.mentions.kinds.get(name, ""),
        profiles.wholes.get(name),
        tuple(part for _, part in profiles.parts.get(name, ())),
        states,
        relations,
        tuple(e for e in edges if e.predicate != PART_OF and e._replace(args=e.args[::-1]) not in static),
    )


def require_object(name: str, world: World) -> None:
    """Make sure that an environment has an object.

    Raises:
        TmdError: It has none of that name.
    """
    known = world.objects.types_of
    if name not in known:
        raise TmdError(f"there is no object '{name}'", hint=nearest(name, list(known), what="objects"))


def _divided(
    name: str, atoms: Iterable[GroundAtom], world: World
) -> tuple[tuple[GroundAtom, ...], tuple[GroundAtom, ...]]:
    """Divide the atoms that mention ``name`` into those of it alone and those of another object as well."""
    alone: list[GroundAtom] = []
    shared: list[GroundAtom] = []
    for atom in sorted(atoms):
        if name in atom.args:
            others = any(a != name and a not in world.profiles.constants for a in atom.args)
            (shared if others else alone).append(atom)
    return tuple(alone), tuple(shared)
