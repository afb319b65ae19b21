"""The verb clause of the paper, as templates, policy and factors see it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol


class VerbClause(Protocol):
    """A verb clause C = (ν, [obj], ρ) (section III-A).

    :class:`tmd.language.clause.Clause` is one; a reader without a grammar may make its own.
    """

    @property
    def verb(self) -> str:
        """The verb ν: its stem with its particle, such as ``turn_on``."""
        ...

    @property
    def text(self) -> str:
        """The clause as written."""
        ...

    def resolved(self) -> tuple[str, ...]:
        """Return the language-objects, with each pronoun replaced by its antecedents; each once."""
        ...

    def resolved_relations(self) -> Sequence[tuple[str, str | None, str]]:
        """Return the entries of the relation matrix ρ, resolved likewise: relation, source, target."""
        ...
