"""Meanings of the nouns of a text: the objects that a plan uses for them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

from tmd.inference.ranking import RankedPlan
from tmd.language.clause import PERSONS, Clause, Parsed, Quantifier
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.world.world import World, run

# For every language-object of a clause, and ``""`` for an elided one, what it was grounded to; empty for nothing. In
# brackets stands what a noun would mean here most likely, where the plan has nothing to do with it: ``(milk1)``.
Meaning: TypeAlias = Mapping[str, tuple[str, ...]]


def meanings(parsed: Parsed, plan: RankedPlan, world: World) -> list[Meaning]:
    """Return the meanings of each clause's nouns in a ranked plan.

    A clause may have several of the plan's choices (*when you have taken the cup, …* is two steps) or none (*leave the
    door open* asks for nothing to be done), and they need not be in the order of the clauses.
    """
    owners = [goal.clause for goal in plan.goals] or range(len(plan.choices))
    choices = [[step.instruction for step in choice.steps] for choice in plan.choices]
    return meanings_in(parsed.clauses, zip(owners, choices, strict=True), world)


def meanings_in(
    clauses: Sequence[Clause], parts: Iterable[tuple[int, Sequence[Instruction]]], world: World
) -> list[Meaning]:
    """Return the meanings of each clause's nouns, given a plan in parts, each with the place of its clause."""
    served: dict[int, list[Instruction]] = {}
    begun: dict[int, Bits] = {}
    state = world.task.init
    for owner, instructions in parts:
        begun.setdefault(owner, state)
        served.setdefault(owner, []).extend(instructions)
        state = run(world, state, instructions)
    return [
        meaning(clause, served.get(number, ()), world, begun.get(number, world.task.init))
        for number, clause in enumerate(clauses)
    ]


def meaning(clause: Clause, instructions: Iterable[Instruction], world: World, state: Bits) -> Meaning:
    """Return the meanings of a clause's nouns in ``state``, given the instructions that serve it."""
    instructions = tuple(instructions)
    used = dict.fromkeys(argument for instruction in instructions for argument in instruction.args)
    used.update(dict.fromkeys(world.profiles.wholes[name] for name in list(used) if name in world.profiles.wholes))
    used.update(dict.fromkeys(_touched(instructions, world, state)))
    names = [name for name in clause.objects if name not in PERSONS]
    names += [""] if clause.antecedents.get("") else []
    return {name: _grounded(clause.meant(name), used, world, state, several=_several(clause, name)) for name in names}


def _touched(instructions: Iterable[Instruction], world: World, state: Bits) -> list[str]:
    """Return the constants, substances say, of the facts that the instructions change."""
    changed = world.task.names(run(world, state, instructions) ^ state)
    return sorted({argument for atom in changed for argument in atom.args} & world.profiles.constants)


def _several(clause: Clause, name: str) -> bool:
    """Return whether a noun of a clause may name more than one thing."""
    phrase = clause.phrases.get(name)
    return phrase is not None and (phrase.plural or phrase.quantifier is Quantifier.ALL)


def _grounded(
    nouns: Iterable[str], used: Mapping[str, None], world: World, state: Bits, *, several: bool
) -> tuple[str, ...]:
    """Return for each noun an object that is used, else a substance that is, else the likeliest object.

    Of several things, return all that are used and that the noun names as well as the first.
    """
    found: dict[str, None] = {}
    for noun in nouns:
        objects = world.mentions.meant(Clause("", (noun,)), used, state)
        if several:
            matches = [match for match in world.mentions.of(noun, state) if match.name in used]
            objects = tuple(match.name for match in matches if match.score == matches[0].score) or objects
        constants = world.mentions.constants(noun)
        substance = next((c for c in constants if c in used), None) or (noun if noun in constants else None)
        if substance is not None and not any(name in used for name in objects):
            objects = (substance,)
        found.update(dict.fromkeys(name if name in used else f"({name})" for name in objects))
    return tuple(found)
