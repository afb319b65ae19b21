"""Sentence tests, run: does each request end in what was asked?"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from tmd.diagnostics import TmdError
from tmd.grounded import Grounded
from tmd.pddl.model import Problem
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.semantics import holds
from tmd.readers.interface import Usage
from tmd.records.grounding import ModelUse
from tmd.records.sentence_test import KindSummary, Outcome, SentenceCase, SentenceReport, SentenceSummary
from tmd.short_repr import short_repr
from tmd.world.sentence_file import SentenceTest

_EFFORTS = ("prompt_tokens", "completion_tokens", "seconds", "cached", "corrections")


@short_repr(lambda result: f"{result.test.id}: {result.outcome} {result.reason}".strip())
@dataclass(frozen=True, slots=True)
class SentenceResult:
    """A sentence test with what came out.

    Attributes:
        plan: The instructions of the first plan, as PDDL.
        goals: The goals of its steps, as PDDL.
        usage: The effort of the language model; ``None`` where none was asked.
    """

    test: SentenceTest
    outcome: Outcome
    plan: tuple[str, ...] = ()
    goals: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    reason: str = ""
    usage: Usage | None = None


def judge(test: SentenceTest, grounded: Grounded, problem: Problem) -> SentenceResult:
    """Judge a test whose text was grounded in ``problem``.

    Raises:
        TmdError: The goal of the test is not a condition of the domain; with the test's place.
    """
    wanted = None
    if test.goal is not None:
        try:
            wanted = with_goal(problem, test.goal, "goal").goal
        except TmdError as error:
            raise TmdError(
                f"the goal of '{test.id}': {error.message}", location=test.location, hint=error.hint
            ) from None
    valid = [(plan, verdict) for plan, verdict in zip(grounded.plans, grounded.verdicts, strict=True) if verdict.valid]
    if not valid:
        outcome = Outcome.REFUSED if wanted is not None else Outcome.IMPOSSIBLE_REFUSED
        return SentenceResult(test, outcome, (), (), grounded.warnings, grounded.reason, grounded.usage)
    plan = valid[0][0]
    steps = tuple(i.pddl() for i in plan.instructions)
    goals = tuple(str(goal) for goal in plan.goals if goal.formula is not None)
    if wanted is None:
        outcome, reason = Outcome.IMPOSSIBLE_PLANNED, "it must be refused"
    elif holds(wanted, grounded.world.task.decode(plan.state), problem):
        outcome, reason = Outcome.RIGHT, ""
    else:
        outcome, reason = Outcome.WRONG, f"{test.goal} does not hold at the end"
    return SentenceResult(test, outcome, steps, goals, grounded.warnings, reason, grounded.usage)


def summary(results: Iterable[SentenceResult]) -> SentenceSummary:
    """Count the tests of each outcome."""
    return SentenceSummary(**_counts(list(results)))


def _counts(results: Sequence[SentenceResult]) -> dict[str, Any]:
    counts = {outcome: sum(r.outcome is outcome for r in results) for outcome in Outcome}
    found: dict[str, Any] = {
        "n": len(results),
        "right": counts[Outcome.RIGHT],
        "wrong": counts[Outcome.WRONG],
        "wrong_warned": sum(r.outcome is Outcome.WRONG and bool(r.warnings) for r in results),
        "refused": counts[Outcome.REFUSED],
        "impossible": counts[Outcome.IMPOSSIBLE_REFUSED] + counts[Outcome.IMPOSSIBLE_PLANNED],
        "impossible_refused": counts[Outcome.IMPOSSIBLE_REFUSED],
    }
    used = [r.usage for r in results if r.usage is not None]
    if used:
        found |= {name: round(sum(getattr(u, name) for u in used), 3) for name in _EFFORTS}
    return found


def by_kind(results: Sequence[SentenceResult]) -> dict[str, list[SentenceResult]]:
    """Return the results of each kind of test; a test may have several kinds."""
    kinds = sorted({kind for result in results for kind in result.test.kinds})
    return {kind: [result for result in results if kind in result.test.kinds] for kind in kinds}


def report(results: Sequence[SentenceResult], reader: str) -> SentenceReport:
    """Return all results, for programs."""
    kinds = tuple(KindSummary(kind=kind, **_counts(own)) for kind, own in by_kind(results).items())
    cases = tuple(map(_case, results))
    return SentenceReport(summary=summary(results), kinds=kinds, reader=reader, cases=cases)


def _case(result: SentenceResult) -> SentenceCase:
    model = {} if result.usage is None else {"model": ModelUse.copied(result.usage)}
    return SentenceCase.copied(result, id=result.test.id, **model)
