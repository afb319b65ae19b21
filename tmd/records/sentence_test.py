"""``tmd test --json``: the outcome of each sentence test, and the number of each kind."""

from __future__ import annotations

from enum import StrEnum

from pydantic import Field

from tmd.json_record import JsonRecord
from tmd.records.grounding import ModelUse


class Outcome(StrEnum):
    """Outcome of a sentence test."""

    RIGHT = "right"
    # A plan was presented, and the condition does not hold at its end.
    WRONG = "wrong"
    # No plan for what can be done.
    REFUSED = "refused"
    IMPOSSIBLE_REFUSED = "impossible_refused"
    IMPOSSIBLE_PLANNED = "impossible_planned"

    @property
    def passed(self) -> bool:
        """Return whether it is as it should be."""
        return self in (Outcome.RIGHT, Outcome.IMPOSSIBLE_REFUSED)


class SentenceSummary(JsonRecord):
    """Numbers of tests by outcome; ``wrong_warned`` are the wrong ones that came with a warning.

    The last five are of the language model, and are left out where none was asked.
    """

    n: int
    right: int
    wrong: int
    wrong_warned: int
    refused: int
    impossible: int
    impossible_refused: int
    prompt_tokens: int = 0
    completion_tokens: int = 0
    seconds: float = 0.0
    cached: int = 0
    corrections: int = 0


class SentenceCase(JsonRecord):
    """Result of one test."""

    id: str
    outcome: Outcome
    plan: tuple[str, ...] = Field(description="The instructions of the first plan, as PDDL.")
    goals: tuple[str, ...] = Field(description="The goals of its steps, as PDDL.")
    warnings: tuple[str, ...]
    reason: str = Field(description="Why there is no plan, or why it is wrong; empty otherwise.")
    model: ModelUse | None = Field(None, description="The effort of the language model; left out where none read it.")


class KindSummary(SentenceSummary):
    """The tests of one kind."""

    kind: str


class SentenceReport(JsonRecord):
    """All tests."""

    WHAT = "what tmd test --json prints"
    REMAKE = "make it again with tmd test --json"

    summary: SentenceSummary
    kinds: tuple[KindSummary, ...] = Field(description="The same for the tests of each kind; a test may have several.")
    reader: str
    cases: tuple[SentenceCase, ...]
