"""Instruction templates: a demonstrated sequence with its objects replaced by variables (section V)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tmd.language.clause import Clause
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.veil.mentions import Mentions
from tmd.veil.profiles import Profile, Profiles


@dataclass(frozen=True, slots=True)
class Template:
    """One entry of the library, D_s = (C_s, E_s, I_s, ξ_s).

    Attributes:
        source: The demonstration it comes from.
        clause: C_s, the clause it served.
        environment: The name of the environment it was made in.
        instructions: I_s: instructions whose objects are variables ``?z1``, ``?z2`` …; constants of the domain
            (relations, settings) stay.
        grounding: ξ_s: the object that each variable stood for.
        classes: The kind of each of those objects.
        wanted: The types that the instructions want of each variable.
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
    """Replace the objects of ``instructions`` by variables and record what they stood for.

    Args:
        source: Where the sequence comes from.
        clause: The clause that it served.
        environment: The name of the environment.
        instructions: What was done for the clause.
        states: The states in which the sequence began and ended.
        profiles: The states of the environment's objects.
        mentions: The nouns of the environment's objects.
    """
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
    """For each noun the variable of the object it most likely meant, among those that were used."""
    found: dict[str, str] = {}
    for noun in clause.resolved():
        for match in mentions.of(noun, state):
            if match.name in names and names[match.name] not in found.values():
                found[noun] = names[match.name]
                break
    return found


def _wanted(instructions: Sequence[Instruction], variable: str, profiles: Profiles) -> tuple[tuple[str, ...], ...]:
    """The types of every parameter that ``variable`` stands for in ``instructions``, each once."""
    schemas = {action.name: action for action in profiles.task.problem.domain.actions}
    found: dict[tuple[str, ...], None] = {}
    for instruction in instructions:
        if instruction.name in schemas:
            parameters = schemas[instruction.name].parameters
            for argument, parameter in zip(instruction.args, parameters, strict=False):
                if argument == variable:
                    found[parameter.types] = None
    return tuple(found)
