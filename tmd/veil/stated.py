"""What a clause says shall hold when it is done: its relations as facts of an environment. Not in the paper.

*Put the pot on the stove* says ``(at pot1 stove1_burner2 on)``, or so of another burner; *take some coffee in a
cup* says ``(contains cup1 coffee)``; *put a on b*, in a world of blocks, ``(on a b)``. Which facts say a relation
shows in the facts themselves, so no domain has to declare it: both things stand in it, and either the relation's
name does, as a constant or as the predicate, or the fact joins a thing to a constant of the domain.
"""

from __future__ import annotations

from collections.abc import Collection

from tmd.language.clause import Clause, Relation
from tmd.pddl.model import GroundAtom
from tmd.pddl.task import Bits, Cube
from tmd.veil.world import World

PLACES = {
    **{name: frozenset({name}) for name in ("in", "on", "next_to", "under", "behind", "above", "below")},
    "into": frozenset({"in"}),
    "inside": frozenset({"in"}),
    "onto": frozenset({"on"}),
    "on_top_of": frozenset({"on"}),
    "beside": frozenset({"next_to"}),
    "to": frozenset({"in", "on"}),
    "with": frozenset({"with"}),
}
"""The relations that say how things shall be, and what domains call them. *from* says how they were."""
_NAMES = frozenset(name for names in PLACES.values() for name in names)
_MOST = 64
"""A statement that so many facts would fulfil says too little to plan for."""


def stated(clause: Clause, world: World, state: Bits) -> list[tuple[Cube, ...]]:
    """For each relation of ``clause`` the facts of which one shall hold.

    Left out are relations that hold already (*take the cup in the sink* says which cup), and those that no
    instruction can bring about.
    """
    found = []
    for relation in resolved_relations(clause):
        cubes = tuple(Cube(1 << bit, 0) for bit in _bits(relation, world, state))
        if 0 < len(cubes) <= _MOST and not any(cube.holds(state) for cube in cubes):
            found.append(cubes)
    return found


def resolved_relations(clause: Clause) -> list[Relation]:
    """The relations of a clause with pronouns replaced by what they most likely mean."""

    def meant(name: str | None) -> str | None:
        likeliest = clause.antecedents.get(name or "", ())
        return likeliest[0] if likeliest else name

    return [Relation(r.relation, meant(r.source), meant(r.target) or r.target) for r in clause.relations]


def _bits(relation: Relation, world: World, state: Bits) -> list[int]:
    names = PLACES.get(relation.relation)
    if names is None or relation.source is None:
        return []
    for sources in _readings(relation.source, world, state):
        for targets in _readings(relation.target, world, state):
            found = [
                bit
                for bit, atom in enumerate(world.task.atoms)
                if _says(atom, names, sources, targets, world.profiles.constants)
            ]
            if found:
                return found
    return []


def _readings(noun: str, world: World, state: Bits) -> list[frozenset[str]]:
    """What a noun may mean: first each constant of the domain, then the likeliest things with their parts."""
    matches = world.mentions.of(noun, state)
    things = [match.name for match in matches if match.score == matches[0].score]
    parts = [part for thing in things for _, part in world.profiles.parts.get(thing, ())]
    return [*(frozenset({name}) for name in world.mentions.constants(noun)), frozenset([*things, *parts])]


def _says(
    atom: GroundAtom,
    names: Collection[str],
    sources: Collection[str],
    targets: Collection[str],
    constants: Collection[str],
) -> bool:
    """Whether ``atom`` says that one of ``sources`` is so related to one of ``targets``."""
    words = {atom.predicate, *atom.args} & _NAMES
    if words and not words & set(names):
        return False
    args = [argument for argument in atom.args if argument not in _NAMES]
    if len(args) != 2:
        return False
    first, second = args
    if words:
        return first in sources and second in targets
    joined = (first in sources and second in targets) or (first in targets and second in sources)
    return joined and (first in constants) != (second in constants)
