"""A template in a new environment: which object each variable stands for (section V-A of the paper).

The three rules, in their order:

1. Where both clauses have the same relation, the variables of the template's two nouns stand for the objects of
   the new clause's two nouns.
2. A noun that both clauses share is mapped as it was.
3. Every variable left stands for the object that shares the most states with the one it stood for.

Between 2 and 3 an extension of the paper may be asked for (``pair_nouns``): nouns that only one of the clauses has
are paired in order of mention, so that what was shown for *take the ramen* serves *take the syrup* as well.

A variable is only ever mapped to an object that is there and of a type its instructions accept. Rule 3 leaves
many ties (four burners that are all off); they go, in this order, to the object that is joined to the objects
already chosen by the same edges as before (the knob of *that* burner), to one of the same class, to one of the
same name, and to the first in the environment.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from tmd.language.clause import Clause, Relation
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.veil.profiles import Profile, shared
from tmd.veil.template import Template
from tmd.veil.world import World


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
    template: Template, clause: Clause, world: World, state: Bits, *, pair_nouns: bool = False
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
    """The instructions with each variable replaced by its object: the paper's *replace*."""
    return tuple(Instruction(i.name, tuple(grounding.get(a, a) for a in i.args)) for i in instructions)


def resolved_relations(clause: Clause) -> list[Relation]:
    """The relations of a clause with pronouns replaced by what they most likely mean."""

    def meant(name: str | None) -> str | None:
        likeliest = clause.antecedents.get(name or "", ())
        return likeliest[0] if likeliest else name

    return [Relation(r.relation, meant(r.source), meant(r.target) or r.target) for r in clause.relations]


def _by_language(template: Template, clause: Clause, world: World, state: Bits) -> Iterator[tuple[str, str]]:
    """Rules 1 and 2: pairs of variable and object, in order of authority."""
    for ours in resolved_relations(clause):
        for theirs in resolved_relations(template.clause):
            if ours.relation == theirs.relation:
                yield from _pair(template, theirs.source, ours.source, world, state)
                yield from _pair(template, theirs.target, ours.target, world, state)
    for noun in clause.resolved():
        if noun in template.mentions:
            yield from _pair(template, noun, noun, world, state)


def _settle(grounding: dict[str, str], pairs: Iterator[tuple[str, str]]) -> None:
    """Take up each pair whose variable is free and whose object is not taken."""
    for variable, name in pairs:
        if variable not in grounding and name not in grounding.values():
            grounding[variable] = name


def _by_order(
    template: Template, clause: Clause, grounding: Mapping[str, str], world: World, state: Bits
) -> Iterator[tuple[str, str]]:
    """The extension: nouns of one clause only, paired in order of mention where the types allow it."""
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
    best: tuple[tuple[int, int, bool, bool], str] | None = None
    for name in world.profiles.objects:
        if name in taken or not _fits(template, variable, name, world):
            continue
        rank = (
            shared(before, world.profiles.of(name, state)),
            _joined_alike(template, variable, name, grounding, world),
            world.mentions.kinds[name] == template.classes[variable],
            name == template.grounding[variable],
        )
        if best is None or rank > best[0]:
            best = rank, name
    return best[1] if best else None


def _joined_alike(template: Template, variable: str, name: str, grounding: Mapping[str, str], world: World) -> int:
    """How many edges to objects already chosen are as they were in the template."""
    count = 0
    for other, chosen in grounding.items():
        for ours, theirs in (((name, chosen), (variable, other)), ((chosen, name), (other, variable))):
            count += len(world.profiles.links.get(ours, frozenset()) & template.links.get(theirs, frozenset()))
    return count


def _fits(template: Template, variable: str, name: str, world: World) -> bool:
    """Whether every instruction of the template accepts ``name`` for ``variable``."""
    return all(world.objects.is_a(name, types) for types in template.wanted[variable])
