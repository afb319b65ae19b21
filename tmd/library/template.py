"""Instruction templates: a demonstrated sequence with its objects replaced by variables (section V)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from tmd.language.clause import Clause
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.short_repr import short_repr
from tmd.world.verb_clause import VerbClause
from tmd.world.world import Mentions, Profile, Profiles, World, shared


@short_repr(lambda template: f"{template.source}: " + ", ".join(map(str, template.instructions)))
@dataclass(frozen=True, slots=True)
class Template:
    """One entry of the library, D_s = (C_s, E_s, I_s, ξ_s).

    Attributes:
        clause: C_s, the clause it served.
        instructions: I_s: instructions whose objects are variables ``?z1``, ``?z2`` …; constants of the domain
            (relations, settings) stay.
        grounding: ξ_s: the object that each variable stood for.
        profiles: E_s, as far as it matters: the states of each of those objects when the sequence began.
        links: For each two variables, the static relations between their objects.
        mentions: For each noun of the clause, the variable it meant.
        ends: The states of each of the objects when the sequence was done.
        subjects: The objects that the clause speaks of: class, and states when the sequence was done.
    """

    source: str
    clause: Clause
    environment: str
    instructions: tuple[Instruction, ...]
    grounding: Mapping[str, str]
    classes: Mapping[str, str]
    wanted: Mapping[str, tuple[tuple[str, ...], ...]]
    profiles: Mapping[str, Profile]
    links: Mapping[tuple[str, str], frozenset[str]]
    mentions: Mapping[str, str]
    ends: Mapping[str, Profile]
    subjects: tuple[tuple[str, Profile], ...]


def generalise(
    source: str,
    clause: Clause,
    environment: str,
    instructions: Sequence[Instruction],
    states: tuple[Bits, Bits],
    profiles: Profiles,
    mentions: Mentions,
) -> Template:
    """Replace the objects of ``instructions`` by variables and record what they stood for."""
    before, after = states
    names: dict[str, str] = {}
    for instruction in instructions:
        for argument in instruction.args:
            if argument not in profiles.constants:
                names.setdefault(argument, f"?z{len(names) + 1}")
    grounding = {variable: name for name, variable in names.items()}
    kinds = mentions.kinds
    generalised = tuple(Instruction(i.name, tuple(names.get(a, a) for a in i.args)) for i in instructions)
    return Template(
        source=source,
        clause=clause,
        environment=environment,
        instructions=generalised,
        grounding=grounding,
        classes={variable: kinds.get(name, "") for variable, name in grounding.items()},
        wanted={variable: _wanted(generalised, variable, profiles) for variable in grounding},
        profiles={variable: profiles.of(name, before) for variable, name in grounding.items()},
        links={
            (a, b): profiles.links[grounding[a], grounding[b]]
            for a in grounding
            for b in grounding
            if (grounding[a], grounding[b]) in profiles.links
        },
        mentions=_meant(clause, names, mentions, before),
        ends={variable: profiles.of(name, after) for variable, name in grounding.items()},
        subjects=tuple((kinds[name], profiles.of(name, after)) for name in mentions.meant(clause, names, before)),
    )


def _meant(clause: Clause, names: Mapping[str, str], mentions: Mentions, state: Bits) -> dict[str, str]:
    """Return for each noun the variable of the object that it most likely meant, among those that were used."""
    found: dict[str, str] = {}
    for noun in clause.resolved():
        for match in mentions.of(noun, state):
            if match.name in names and names[match.name] not in found.values():
                found[noun] = names[match.name]
                break
    return found


def _wanted(instructions: Sequence[Instruction], variable: str, profiles: Profiles) -> tuple[tuple[str, ...], ...]:
    """Return the types of every parameter that ``variable`` fills in ``instructions``, each once."""
    schemas = {action.name: action for action in profiles.task.problem.domain.actions}
    found: dict[tuple[str, ...], None] = {}
    for instruction in instructions:
        if instruction.name in schemas:
            parameters = schemas[instruction.name].parameters
            for argument, parameter in zip(instruction.args, parameters, strict=False):
                if argument == variable:
                    found[parameter.types] = None
    return tuple(found)


@dataclass(frozen=True, slots=True)
class Instantiation:
    """A template with objects of the new environment.

    Attributes:
        template: D_s.
        instructions: replace(I_s, Z(s), ξ).
        grounding: ξ, the object of each variable.
        profiles: The states of those objects where the sequence would begin.
    """

    template: Template
    instructions: tuple[Instruction, ...]
    grounding: Mapping[str, str]
    profiles: Mapping[str, Profile]


def instantiate(
    template: Template, clause: VerbClause, world: World, state: Bits, *, pair_nouns: bool = False
) -> Instantiation | None:
    """Map the variables of ``template`` for ``clause`` in ``state``; ``None`` where one has no object at all."""
    grounding: dict[str, str] = {}
    _settle(grounding, _by_language(template, clause, world, state))
    if pair_nouns:
        _settle(grounding, _by_order(template, clause, grounding, world, state))
    profiles = {name: world.profiles.of(name, state) for name in grounding.values()}
    for variable in template.grounding:
        if variable not in grounding:
            chosen = _by_states(template, variable, grounding, world, state)
            if chosen is None:
                return None
            grounding[variable] = chosen
            profiles[chosen] = world.profiles.of(chosen, state)
    return Instantiation(
        template,
        replace(template.instructions, grounding),
        grounding,
        {variable: profiles[name] for variable, name in grounding.items()},
    )


def replace(instructions: Sequence[Instruction], grounding: Mapping[str, str]) -> tuple[Instruction, ...]:
    """Return the instructions with each variable replaced by its object: the paper's *replace*."""
    return tuple(Instruction(i.name, tuple(grounding.get(a, a) for a in i.args)) for i in instructions)


def _by_language(template: Template, clause: VerbClause, world: World, state: Bits) -> Iterator[tuple[str, str]]:
    """Rules 1 and 2: pairs of variable and object, in order of authority."""
    for relation, source, target in clause.resolved_relations():
        for their_relation, their_source, their_target in template.clause.resolved_relations():
            if relation == their_relation:
                yield from _pair(template, their_source, source, world, state)
                yield from _pair(template, their_target, target, world, state)
    for noun in clause.resolved():
        if noun in template.mentions:
            yield from _pair(template, noun, noun, world, state)


def _settle(grounding: dict[str, str], pairs: Iterator[tuple[str, str]]) -> None:
    """Take up each pair whose variable is free and whose object is not taken."""
    for variable, name in pairs:
        if variable not in grounding and name not in grounding.values():
            grounding[variable] = name


def _by_order(
    template: Template, clause: VerbClause, grounding: Mapping[str, str], world: World, state: Bits
) -> Iterator[tuple[str, str]]:
    """Yield the extension: nouns of one clause only, paired in order of mention where the types allow it."""
    ours = [noun for noun in clause.resolved() if noun not in template.mentions]
    theirs = [
        noun
        for noun, variable in template.mentions.items()
        if variable not in grounding and noun not in clause.resolved()
    ]
    for noun in ours:
        for other in theirs:
            pairs = list(_pair(template, other, noun, world, state))
            if pairs:
                yield from pairs
                theirs.remove(other)
                break


def _pair(
    template: Template, theirs: str | None, ours: str | None, world: World, state: Bits
) -> Iterator[tuple[str, str]]:
    variable = template.mentions.get(theirs) if theirs is not None else None
    if variable is None or ours is None:
        return
    for match in world.mentions.of(ours, state):
        if _fits(template, variable, match.name, world):
            yield variable, match.name
            return


def _by_states(
    template: Template, variable: str, grounding: Mapping[str, str], world: World, state: Bits
) -> str | None:
    """Rule 3, with its ties broken."""
    before = template.profiles[variable]
    taken = set(grounding.values())
    joints = _joints(template, variable, grounding)
    best: tuple[tuple[int, int, bool, bool], str] | None = None
    for name in world.profiles.objects:
        if name in taken or not _fits(template, variable, name, world):
            continue
        rank = (
            shared(before, world.profiles.of(name, state)),
            _joined_alike(joints, name, world),
            world.mentions.kinds[name] == template.classes[variable],
            name == template.grounding[variable],
        )
        if best is None or rank > best[0]:
            best = rank, name
    return best[1] if best else None


_Joint = tuple[str, frozenset[str], frozenset[str]]
"""An object already chosen, with the edges of the template to it and from it."""


def _joints(template: Template, variable: str, grounding: Mapping[str, str]) -> list[_Joint]:
    """Return the objects already chosen for what the template joins to ``variable``: few of them."""
    none: frozenset[str] = frozenset()
    joints = [
        (chosen, template.links.get((variable, other), none), template.links.get((other, variable), none))
        for other, chosen in grounding.items()
    ]
    return [joint for joint in joints if joint[1] or joint[2]]


def _joined_alike(joints: Sequence[_Joint], name: str, world: World) -> int:
    """Return how many edges to objects already chosen are as in the template."""
    links, none = world.profiles.links, frozenset[str]()
    return sum(
        len(links.get((name, chosen), none) & to) + len(links.get((chosen, name), none) & back)
        for chosen, to, back in joints
    )


def _fits(template: Template, variable: str, name: str, world: World) -> bool:
    """Return whether every instruction of the template accepts ``name`` for ``variable``."""
    return all(world.objects.is_a(name, types) for types in template.wanted[variable])
