"""Sentence tests: requests with the condition that must hold when all is done.

A file of them is JSON Lines, ``*.sentences.jsonl`` beside the problems of a domain or anywhere else::

    {"id": "k1-01", "domain": "kitchen", "environment": "kitchen1", "text": "Fill the mug.",
     "goal": "(contains mug1 water)"}

``goal`` is ``null`` where the request is impossible or unsafe there and must be refused. Other keys are let pass.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from tmd.diagnostics import Location, TmdError
from tmd.grounded import Grounded
from tmd.pddl.model import Problem
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.reading.syntax import read_text, split_lines
from tmd.pddl.semantics import holds
from tmd.pddl.writer import format_formula
from tmd.records.sentence_test import Outcome, SentenceCase, SentenceReport, SentenceSummary

SUFFIX = ".sentences.jsonl"
_TEXTS = ("id", "domain", "environment", "text")


@dataclass(frozen=True, slots=True)
class SentenceTest:
    """One request, with the condition that must hold in the end; ``None`` where it must be refused."""

    id: str
    domain: str
    environment: str
    text: str
    goal: str | None
    kinds: tuple[str, ...] = ()
    location: Location | None = None


@dataclass(frozen=True, slots=True)
class SentenceResult:
    """A sentence test with what came out.

    Attributes:
        test: The test.
        outcome: What became of it.
        plan: The instructions of the first plan, as PDDL.
        goals: The goals of its steps, as PDDL.
        warnings: What the plan comes with.
        reason: Why there is no plan, or why it is wrong.
    """

    test: SentenceTest
    outcome: Outcome
    plan: tuple[str, ...] = ()
    goals: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    reason: str = ""


def read_sentences(path: Path) -> list[SentenceTest]:
    """Read a file of sentence tests.

    Raises:
        TmdError: The file cannot be read, or a line is not a sentence test; with its place.
    """
    found: dict[str, SentenceTest] = {}
    for number, line in enumerate(split_lines(read_text(path)), start=1):
        if not line.strip():
            continue
        test = _read_line(line, Location(str(path), number, 1))
        if test.id in found:
            raise TmdError(
                f"the id '{test.id}' stands in this file twice",
                location=test.location,
                hint="give each an id of its own",
            )
        found[test.id] = test
    return list(found.values())


def domain_sentences(directory: Path) -> list[SentenceTest]:
    """The sentence tests beside the problems of a domain.

    Raises:
        TmdError: There are none, or a file of them is wrong.
    """
    paths = sorted(directory.glob(f"*{SUFFIX}"))
    if not paths:
        raise TmdError(
            f"there are no sentence tests in {directory}", hint=f"write one, such as my{SUFFIX}; see docs/goals.md"
        )
    return [test for path in paths for test in read_sentences(path)]


_FORM = 'write {"id": …, "domain": …, "environment": …, "text": …, "goal": "(…)" or null}'


def _read_line(line: str, place: Location) -> SentenceTest:
    try:
        data = json.loads(line)
    except json.JSONDecodeError as error:
        where = Location(place.file, place.line, error.colno)
        raise TmdError(f"the line is not valid JSON: {error.msg}", location=where, hint=_FORM, source=line) from None
    except RecursionError:
        raise TmdError("the line is nested too deeply", location=place, hint=_FORM) from None
    except ValueError:  # Python reads no number of more than 4,300 digits
        raise TmdError("a number of the line has too many digits", location=place, hint=_FORM) from None
    if not isinstance(data, dict):
        raise TmdError("a sentence test is a JSON object", location=place, hint=_FORM)
    for key in _TEXTS:
        if not isinstance(data.get(key), str):
            raise TmdError(f"the key '{key}' is missing or is not a text", location=place, hint=_FORM)
    goal = data.get("goal", 0)
    if goal is not None and not isinstance(goal, str):
        raise TmdError("the key 'goal' is missing, or is neither a text nor null", location=place, hint=_FORM)
    kinds = data.get("kind", [])
    listed = tuple(k for k in kinds if isinstance(k, str)) if isinstance(kinds, list) else ()
    name, domain, environment, text = (data[key] for key in _TEXTS)
    return SentenceTest(name, domain, environment, text, goal, listed, place)


def judge(test: SentenceTest, grounded: Grounded, problem: Problem) -> SentenceResult:
    """What became of a test whose text was grounded in ``problem``.

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
        return SentenceResult(test, outcome, warnings=grounded.warnings, reason=grounded.reason)
    plan = valid[0][0]
    steps = tuple(i.pddl() for i in plan.instructions)
    goals = tuple(" ".join(format_formula(g.formula).split()) for g in plan.goals if g.formula is not None)
    if wanted is None:
        return SentenceResult(test, Outcome.IMPOSSIBLE_PLANNED, steps, goals, grounded.warnings, "it must be refused")
    end = grounded.world.task.decode(plan.state)
    right = holds(wanted, end, problem)
    reason = "" if right else f"{test.goal} does not hold at the end"
    return SentenceResult(test, Outcome.RIGHT if right else Outcome.WRONG, steps, goals, grounded.warnings, reason)


def summary(results: Iterable[SentenceResult]) -> SentenceSummary:
    """How many there are of each outcome."""
    listed = list(results)
    counts = {outcome: sum(r.outcome is outcome for r in listed) for outcome in Outcome}
    return SentenceSummary(
        n=len(listed),
        right=counts[Outcome.RIGHT],
        wrong=counts[Outcome.WRONG],
        wrong_warned=sum(r.outcome is Outcome.WRONG and bool(r.warnings) for r in listed),
        refused=counts[Outcome.REFUSED],
        impossible=counts[Outcome.IMPOSSIBLE_REFUSED] + counts[Outcome.IMPOSSIBLE_PLANNED],
        impossible_refused=counts[Outcome.IMPOSSIBLE_REFUSED],
    )


def report(results: Sequence[SentenceResult]) -> SentenceReport:
    """All results, for programs."""
    keys = ("outcome", "plan", "goals", "warnings", "reason")
    cases = [SentenceCase(id=r.test.id, **{key: getattr(r, key) for key in keys}) for r in results]
    return SentenceReport(summary=summary(results), cases=tuple(cases))
