"""The prediction of a model for one example: the instructions, and their origin where it is known."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from tmd.language.clause import Clause
from tmd.pddl.model import Instruction


@dataclass(frozen=True, slots=True)
class Served:
    """The instructions for one clause.

    Attributes:
        text: The words of the clause.
        verb: Its verb.
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

    Attributes:
        instructions: The whole sequence, as it is scored.
        served: For each clause what was done for it; empty for a model that does not work by clauses. Together
            they are ``instructions``, unless the model changes the sequence as a whole afterwards.
    """

    instructions: tuple[Instruction, ...] = ()
    served: tuple[Served, ...] = ()


def by_clause(done: Iterable[tuple[Clause, tuple[Instruction, ...], str | None]]) -> Prediction:
    """Return a prediction from what was done for each clause, and the template each time."""
    served = tuple(Served(clause.text, clause.verb, said=said, source=source) for clause, said, source in done)
    return Prediction(tuple(i for s in served for i in s.said), served)
