"""``tmd test --json``: what became of each sentence test, and how many of each kind there are."""

from __future__ import annotations

from enum import StrEnum

from pydantic import Field

from tmd.records.json_record import JsonRecord


class Outcome(StrEnum):
    """What became of a sentence test."""

    RIGHT = "right"
    WRONG = "wrong"
    """A plan was presented, and the condition does not hold at its end."""
    REFUSED = "refused"
    """No plan for what can be done."""
    IMPOSSIBLE_REFUSED = "impossible_refused"
    IMPOSSIBLE_PLANNED = "impossible_planned"

    @property
    def passed(self) -> bool:
        """Whether it is as it should be."""
        return self in (Outcome.RIGHT, Outcome.IMPOSSIBLE_REFUSED)


class SentenceSummary(JsonRecord):
    """How many there are of each outcome; ``wrong_warned`` are those of the wrong ones that came with a warning."""

    n: int
    right: int
    wrong: int
    wrong_warned: int
    refused: int
    impossible: int
    impossible_refused: int


class SentenceCase(JsonRecord):
    """What became of one test."""

    id: str
    outcome: Outcome
    plan: tuple[str, ...] = Field(description="The instructions of the first plan, as PDDL.")
    goals: tuple[str, ...] = Field(description="The goals of its steps, as PDDL.")
    warnings: tuple[str, ...]
    reason: str = Field(description="Why there is no plan, or why it is wrong; empty otherwise.")


class SentenceReport(JsonRecord):
    """All tests."""

    WHAT = "what tmd test --json prints"
    REMAKE = "make it again with tmd test --json"

    summary: SentenceSummary
    cases: tuple[SentenceCase, ...]
