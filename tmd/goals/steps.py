"""The clauses of a text in the order of doing, with the conditions they depend on."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

from tmd.language.clause import Clause, Condition, Mood

GUARDS = frozenset({"if", "unless", "in_case", "provided_that", "whether", "as_long_as"})
EARLIER = frozenset(
    {"when", "once", "after", "whenever", "as_soon_as", "now_that", "by_the_time", "the_moment", "since"}
)
PARTINGS = frozenset({"leave", "go"})
LATER = frozenset({"before", "until", "till", "to", "with"})


class Role(StrEnum):
    """What a step is to the clause it comes from."""

    MAIN = "main"
    EARLIER = "earlier"
    """Done first: *when you have taken the cup out*."""
    LATER = "later"
    """Done afterwards: *before you put the noodles in*, *until it is hot*, *to warm it up*."""


@dataclass(frozen=True, slots=True)
class GoalStep:
    """One thing to be done.

    Attributes:
        clause: What.
        number: The clause of the text that it belongs to, counted from 0.
        role: What it is to that clause.
        guards: Conditions of which it depends whether it is done.
        otherwise: It is done where the guards of the step before it did not hold.
        optional: It may be left out where it is not understood: *when they are done*.
        awaited: It is waited for, not asked for: *until it boils*.
        besides: It must hold together with what the same clause asks for: *with its door open*.
    """

    clause: Clause
    number: int
    role: Role = Role.MAIN
    guards: tuple[Condition, ...] = ()
    otherwise: bool = False
    optional: bool = False
    awaited: bool = False
    besides: bool = False


def in_order(clauses: Sequence[Clause]) -> tuple[GoalStep, ...]:
    """The steps of a text in the order of doing; what is to be kept is not a step."""
    heading = next((clause for clause in clauses if clause.heading), None)
    if heading is not None and not heading.implied:
        clauses = [replace(c, verb=heading.verb) if c.implied and c is not heading else c for c in clauses]
    ordered = sorted(enumerate(clauses), key=lambda pair: pair[1].heading)
    if len(ordered) > 1 and ordered[-1][1].text.rstrip(" .!").endswith(" first"):
        ordered.insert(-2, ordered.pop())  # "put the milk in the mug. Rinse it first."
    return tuple(step for number, clause in ordered for step in _steps(clause, number))


def _steps(clause: Clause, number: int) -> Iterator[GoalStep]:
    guards = tuple(c for c in clause.conditions if c.word in GUARDS)
    if clause.mood is Mood.KEEP:
        if clause.result and clause.result != "alone":
            yield GoalStep(replace(clause, verb="be", mood=Mood.DO), number, Role.MAIN, guards, clause.otherwise)
        elif guards:
            yield GoalStep(
                clause, number, Role.MAIN, guards, clause.otherwise
            )  # "if it is there, leave it, otherwise …"
        return
    for condition in clause.conditions:
        if condition.word in EARLIER and not condition.negated:
            for inner in condition.clauses:
                awaited = inner.verb == "be"
                yield GoalStep(inner, number, Role.EARLIER, guards, clause.otherwise, optional=True, awaited=awaited)
    yield GoalStep(clause, number, Role.MAIN, guards, clause.otherwise, optional=clause.heading)
    if clause.duration and not clause.verb.startswith("wait"):
        # "put the noodles in for three minutes" asks for what time brings about, where a domain says what that is
        waiting = Clause("wait", span=clause.span, text=clause.text)
        yield GoalStep(waiting, number, Role.LATER, guards, clause.otherwise, optional=True)
    for condition in clause.conditions:
        if condition.word in LATER and not condition.negated:
            for inner in condition.clauses:
                # "before you leave" says when, and is nothing to be done where nobody knows how
                said = condition.word
                yield GoalStep(
                    inner,
                    number,
                    Role.LATER,
                    guards,
                    clause.otherwise,
                    optional=said not in ("before", "with") or inner.verb in PARTINGS,
                    awaited=said in ("until", "till"),
                    besides=said == "with",
                )
