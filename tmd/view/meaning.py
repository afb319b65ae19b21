"""What the nouns of a text came to mean: the objects that a plan uses for them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

from tmd.energy.plans import RankedPlan
from tmd.language.clause import PERSONS, Clause, Parsed
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.veil.world import World

Meaning: TypeAlias = Mapping[str, tuple[str, ...]]
"""For every language-object of a clause, and ``""`` for an elided one, what it was grounded to; empty for nothing."""


def meanings(parsed: Parsed, plan: RankedPlan, world: World) -> list[Meaning]:
    """What each clause's nouns mean in a ranked plan."""
    served = [[step.instruction for step in choice.steps] for choice in plan.choices]
    return meanings_in(parsed.clauses, served, world)


def meanings_in(clauses: Sequence[Clause], served: Sequence[Iterable[Instruction]], world: World) -> list[Meaning]:
    """What each clause's nouns mean, given the instructions that serve it; they are executed one after the other."""
    found: list[Meaning] = []
    state = world.task.init
    for number, clause in enumerate(clauses):
        instructions = list(served[number]) if number < len(served) else []
        found.append(meaning(clause, instructions, world, state))
        state = after(instructions, world, state)
    return found


def meaning(clause: Clause, instructions: Iterable[Instruction], world: World, state: Bits) -> Meaning:
    """What a clause's nouns mean in ``state``, given the instructions that serve it."""
    used = dict.fromkeys(argument for instruction in instructions for argument in instruction.args)
    names = [name for name in clause.objects if name not in PERSONS]
    names += [""] if clause.antecedents.get("") else []
    return {name: _grounded(clause.meant(name), used, world, state) for name in names}


def _grounded(nouns: Iterable[str], used: Mapping[str, None], world: World, state: Bits) -> tuple[str, ...]:
    """Objects for the nouns; a substance where a noun names no object, or where the plan uses none of those."""
    found: dict[str, None] = {}
    for noun in nouns:
        objects = world.mentions.meant(Clause("", (noun,)), used, state)
        constants = world.mentions.constants(noun)
        if constants and not any(name in used for name in objects):
            objects = tuple(constants[:1])
        found.update(dict.fromkeys(objects))
    return tuple(found)


def after(instructions: Iterable[Instruction], world: World, state: Bits) -> Bits:
    """The state after the instructions, up to the first that the world does not know."""
    for instruction in instructions:
        operator = world.task.by_instruction.get(instruction)
        if operator is None:
            return state
        state = operator.apply(state)
    return state
