"""``tmd parse --json``: the clauses of a text, and the pieces without a clause."""

from __future__ import annotations

from pydantic import Field

from tmd.json_record import JsonRecord
from tmd.language.clause import (
    Clause,
    Condition,
    Mood,
    NounPhrase,
    Parsed,
    Quantifier,
    Relation,
    Skipped,
    Span,
    clause_json,
)

# Where a piece of text begins and ends: characters from 0, the end is the first after it.
Place = tuple[int, int]


class PhraseRecord(JsonRecord):
    """Form of a noun phrase; usual values are left out."""

    quantifier: Quantifier = Quantifier.PLAIN
    number: int | None = None
    definite: bool = False
    plural: bool = False
    each: bool = False
    other: bool = False
    attributes: tuple[str, ...] = ()
    either: tuple[str, ...] = ()


# A relation, what stands in it, and what it stands in it to.
Related = tuple[str, str | None, str]


class _Verb(JsonRecord):
    verb: str
    objects: tuple[str, ...]
    relations: tuple[Related, ...]


class _Written(_Verb):
    text: str


class _Said(JsonRecord):
    """Optional parts of a clause."""

    antecedents: dict[str, tuple[str, ...]] = Field(default_factory=dict)
    together: dict[str, int] = Field(default_factory=dict)
    quantities: dict[str, str] = Field(default_factory=dict)
    condition: str | None = None
    duration: str | None = None
    purpose: str | None = None
    setting: str | None = None
    result: str | None = None
    direct: tuple[str, ...] = ()
    phrases: dict[str, PhraseRecord] = Field(default_factory=dict)
    conditions: tuple[ConditionRecord, ...] = ()
    mood: Mood = Mood.DO
    otherwise: bool = False
    implied: bool = False
    alternative: bool = False
    stated: tuple[Related, ...] = ()
    heading: bool = False


class InnerClause(_Said, _Verb):
    """Clause of a condition, without a place in the text."""

    def clause(self, text: str = "", place: Place = (0, 0)) -> Clause:
        """Return the clause."""
        return _clause(self, text, place)


class ConditionRecord(JsonRecord):
    """A condition, and how it was read."""

    word: str
    text: str
    clauses: tuple[InnerClause, ...]
    negated: bool = False

    def condition(self) -> Condition:
        """Return the condition."""
        return Condition(self.word, tuple(clause.clause() for clause in self.clauses), self.negated, self.text)


class ClauseRecord(_Said, _Written):
    """A clause of a text, with its place there."""

    span: Place

    @classmethod
    def of(cls, clause: Clause) -> ClauseRecord:
        """Return the clause as a record."""
        return cls.model_validate({**clause_json(clause), "span": clause.span})

    def clause(self) -> Clause:
        """Return the clause."""
        return _clause(self, self.text, self.span)


def _clause(record: InnerClause | ClauseRecord, text: str, place: Place) -> Clause:
    plain = set(_Said.model_fields) - {"phrases", "conditions", "stated"}
    return Clause(
        record.verb,
        record.objects,
        tuple(Relation(*relation) for relation in record.relations),
        Span(*place),
        text,
        phrases={name: NounPhrase(name, **dict(phrase)) for name, phrase in record.phrases.items()},
        conditions=tuple(condition.condition() for condition in record.conditions),
        stated=tuple(Relation(*relation) for relation in record.stated),
        **{name: getattr(record, name) for name in plain},
    )


class SkippedRecord(JsonRecord):
    """A piece of text that no clause accounts for."""

    text: str
    span: Place
    reason: str


class ParsedRecord(JsonRecord):
    """The clauses of a text; ``constraints`` are what must not be done or must stay, left out where there are none."""

    WHAT = "what tmd parse --json prints"
    REMAKE = "make it again with tmd parse --json"

    clauses: tuple[ClauseRecord, ...]
    constraints: tuple[ClauseRecord, ...] = ()
    skipped: tuple[SkippedRecord, ...]

    @classmethod
    def of(cls, parsed: Parsed) -> ParsedRecord:
        """Return a parsed text as a record."""
        constraints = {"constraints": tuple(map(ClauseRecord.of, parsed.constraints))} if parsed.constraints else {}
        return ParsedRecord(
            clauses=tuple(map(ClauseRecord.of, parsed.clauses)),
            skipped=tuple(SkippedRecord(text=s.text, span=s.span, reason=s.reason) for s in parsed.skipped),
            **constraints,
        )

    def parsed(self, text: str) -> Parsed:
        """Return the clauses of ``text``."""
        return Parsed(
            text,
            tuple(record.clause() for record in self.clauses),
            tuple(Skipped(piece.text, Span(*piece.span), piece.reason) for piece in self.skipped),
            tuple(record.clause() for record in self.constraints),
        )
