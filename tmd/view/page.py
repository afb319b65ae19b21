"""The page on a plan: one file that loads nothing, with a few lines of script that it does not need."""

from __future__ import annotations

import re
from base64 import b64encode
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from hashlib import sha256

from tmd import __version__
from tmd.goals.wording import Wording
from tmd.language.clause import Clause, print_clause
from tmd.pddl.model import GroundAtom, Problem
from tmd.pddl.semantics import apply
from tmd.pddl.validator import Verdict, validate
from tmd.pddl.writer import format_formula
from tmd.records.run import MARKS
from tmd.view.candidates import candidates
from tmd.view.clauses import lit_sentence
from tmd.view.goals import ShownGoal, followed, outcome
from tmd.view.markup import data, style, templates
from tmd.view.state_graph import StateGraph, object_rows
from tmd.view.subject import PlannedStep, Subject

# A plan with more steps than this has them folded.
FEW = 60
# Characters that a text may have, and a page may not.
_UNFIT = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ud800-\udfff]")


@dataclass(frozen=True, slots=True)
class Page:
    """A page, and whether what it shows works."""

    html: str
    verdict: Verdict


def render(subject: Subject) -> Page:
    """Write the page; the same subject gives the same page."""
    steps, verdict = shown_steps(subject.problem, subject.steps)
    goals = followed(subject.goals, subject.problem, [step.instruction for step in subject.steps])
    script = data("page.js")
    said = subject.said
    wording = Wording(subject.problem)
    html = (
        templates()
        .get_template("page.html.j2")
        .render(
            subject=subject,
            verdict=verdict,
            outcome=outcome(verdict, goals, subject.problem.goal),
            goals=goals,
            doubts=subject.doubts,
            in_words=wording.fact,
            done=wording.instruction,
            ticks=_ticks(goals),
            marks=MARKS,
            pddl=format_formula,
            steps=steps,
            folded=len(steps) > FEW,
            sentence="" if said is None else lit_sentence(said.parsed, said.meant, said.unseen),
            notation=print_clause,
            notes=_notes,
            candidates=_candidates(subject, verdict),
            rows=object_rows([step.planned.instruction for step in steps], subject.problem, 0, wording, "#step-"),
            graphs=_graphs(subject.problem, steps),
            version=__version__,
            style=style() + data("page.css"),
            script=script,
            digest=b64encode(sha256(script.encode()).digest()).decode(),
        )
    )
    return Page(_UNFIT.sub("\N{REPLACEMENT CHARACTER}", html), verdict)


def _ticks(goals: Sequence[ShownGoal]) -> dict[int, list[tuple[str, str]]]:
    """Map steps to a sign and the words of each goal that holds, or ends, after them."""
    found: defaultdict[int, list[tuple[str, str]]] = defaultdict(list)
    for shown in goals:
        if shown.since:
            found[shown.since].append(("✓", shown.words))
        if shown.until:
            found[shown.until].append(("no longer", shown.words))
    return found


def _graphs(problem: Problem, steps: Sequence[ShownStep]) -> list[tuple[str, str]]:
    """Return the drawing of the first state, and that of the last one that is reached, each with a title."""
    states = [problem.init]
    for step in steps:
        states.append(states[-1] - set(step.removed) | set(step.added))
    graph = StateGraph(problem, states, [name for step in steps for name in step.planned.instruction.args])
    begin = "At the beginning"
    first = begin, graph.svg(states[0], title=begin)
    end = "At the end; what the plan changed is marked" if steps else ""
    return [first, (end, graph.svg(states[-1], states[0], title=end))] if steps else [first]


def _candidates(subject: Subject, verdict: Verdict) -> str:
    """Return the table of all plans; the first is the one that is shown."""
    if not subject.plans and not subject.refusals:
        return ""
    others = [validate(subject.problem, plan.instructions).reason for plan in subject.plans[1:]]
    return candidates(subject.plans, [verdict.reason, *others], subject.refusals)


def _notes(clause: Clause) -> tuple[str, ...]:
    """Return the parts of a clause that have no column in the table of clauses."""
    said = (("condition", clause.condition), ("duration", clause.duration), ("purpose", clause.purpose))
    quantities = [f"{count} {name}" for name, count in clause.quantities.items()]
    return (*quantities, *(f"{word}: {' '.join(value.split())}" for word, value in said if value))


@dataclass(frozen=True, slots=True)
class ShownStep:
    """A step as it is shown.

    Attributes:
        added: The facts that hold after it and did not before, sorted.
        removed: The facts that held before it and do not after, sorted.
        broken: Why it cannot be done; empty where it can.
        reached: Whether the plan gets there at all.
    """

    number: int
    planned: PlannedStep
    added: tuple[GroundAtom, ...] = ()
    removed: tuple[GroundAtom, ...] = ()
    broken: str = ""
    reached: bool = True


def shown_steps(problem: Problem, steps: Sequence[PlannedStep]) -> tuple[list[ShownStep], Verdict]:
    """Return every step of a plan that begins in ``problem``, and whether the plan works."""
    verdict = validate(problem, [step.instruction for step in steps])
    return list(_shown(problem, steps, verdict)), verdict


def _shown(problem: Problem, steps: Sequence[PlannedStep], verdict: Verdict) -> Iterator[ShownStep]:
    state = problem.init
    for number, step in enumerate(steps, start=1):
        if verdict.step is None or number < verdict.step:
            after = apply(step.instruction, state, problem)
            yield ShownStep(number, step, tuple(sorted(after - state)), tuple(sorted(state - after)))
            state = after
        elif number == verdict.step:
            yield ShownStep(number, step, broken=verdict.reason)
        else:
            yield ShownStep(number, step, reached=False)
