"""The prediction of a model for one example: the instructions, and their origin where it is known."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from tmd.evaluation.runs.dataset import Example, Worlds
from tmd.language import parse
from tmd.language.clause import Clause
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.world.world import World, run

Made: TypeAlias = tuple[tuple[Instruction, ...], str | None]
"""The instructions for a clause, and the demonstration or template they were made from."""


@dataclass(frozen=True, slots=True)
class Served:
    """The instructions for one clause.

    Attributes:
        latent: The instructions that were left unsaid (I_il); they come first.
        said: The instructions for the clause itself (I_i).
        source: The demonstration or template they were made from; ``None`` where nothing was.
        factors: The weighed factors of the energy, by name; empty for models without any.
    """

    text: str
    verb: str
    latent: tuple[Instruction, ...] = ()
    said: tuple[Instruction, ...] = ()
    source: str | None = None
    factors: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Prediction:
    """The answer of a model for one example.

    ``served`` has what was done for each clause; empty for a model that does not work by clauses. Together that is
    ``instructions``, unless the model changes the sequence as a whole afterwards.
    """

    instructions: tuple[Instruction, ...] = ()
    served: tuple[Served, ...] = ()


def by_clause(clauses: Sequence[Clause], made: Iterable[Made]) -> Prediction:
    """Return a prediction from what was made for each clause."""
    pairs = zip(clauses, made, strict=True)
    served = tuple(Served(clause.text, clause.verb, said=said, source=source) for clause, (said, source) in pairs)
    return Prediction(tuple(i for s in served for i in s.said), served)


def from_state(example: Example, data: Worlds, serve: Callable[[Clause, World, Bits], Made]) -> Prediction:
    """Return a prediction clause by clause; ``serve`` is given the state after the clauses before."""
    world = data.world(example.environment)
    state, made = world.task.init, []
    clauses = parse(example.demonstration.text, data.lexicon).clauses
    for clause in clauses:
        made.append(serve(clause, world, state))
        state = run(world, state, made[-1][0])
    return by_clause(clauses, made)
