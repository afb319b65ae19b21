"""The page on a plan: one file that loads nothing, with a few lines of script that it does not need."""

from __future__ import annotations

import re
from base64 import b64encode
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from hashlib import sha256

from tmd import __version__
from tmd.language.clause import Clause, print_clause
from tmd.pddl.model import GroundAtom, Instruction, Problem, State
from tmd.pddl.semantics import apply
from tmd.pddl.validator import Verdict, validate
from tmd.pddl.writer import format_formula
from tmd.records.run import MARKS
from tmd.view.candidates import candidates
from tmd.view.clauses import lit_sentence
from tmd.view.goals import ShownGoal, followed, outcome
from tmd.view.markup import data, style, templates
from tmd.view.object_graph import Anatomy, GraphChanges, anatomy, draw
from tmd.view.pictures import Strip
from tmd.view.subject import PlannedStep, Subject
from tmd.view.wording import Wording

# A plan with more steps than this has them folded.
FEW = 60
# Characters that a text may have, and a page may not.
_UNFIT = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ud800-\udfff]")


@dataclass(frozen=True, slots=True)
class Page:
    """A page, and whether what it shows works.

    Attributes:
        html: The page.
        verdict: What the validator says of the plan.
    """

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
            undrawn=next((step.number for step in steps if step.reached and not step.drawn), None),
            sentence="" if said is None else lit_sentence(said.parsed, said.meant, said.unseen),
            notation=print_clause,
            notes=_notes,
            candidates=_candidates(subject, verdict),
            picture=_picture,
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


def _picture(strip: Strip | None, place: int) -> str:
    """Return the style that shows one picture of the sheet at any size; empty where there is none."""
    if strip is None or place >= len(strip.tiles):
        return ""
    x, y = strip.tiles[place]
    across, down = strip.width - strip.tile_width, strip.height - strip.tile_height
    size = f"{100 * strip.width / strip.tile_width:.4f}% {100 * strip.height / strip.tile_height:.4f}%"
    return (
        f"aspect-ratio:{strip.tile_width}/{strip.tile_height};background-size:{size};"
        f"background-position:{100 * x / across:.4f}% {100 * y / down:.4f}%"
    )


# Characters of drawings on a page; the steps after that have none.
BUDGET = 6_000_000


@dataclass(frozen=True, slots=True)
class Drawing:
    """An object before and after a step; ``after`` is empty where the step cannot be done."""

    name: str
    before: str
    after: str


@dataclass(frozen=True, slots=True)
class ShownStep:
    """A step as it is shown.

    Attributes:
        number: Its place in the plan, from 1.
        planned: The step.
        added: The facts that hold after it and did not before, sorted.
        removed: The facts that held before it and do not after, sorted.
        drawings: The objects that it names, as far as something about them changes.
        others: Further objects that change.
        broken: Why it cannot be done; empty where it can.
        reached: Whether the plan gets there at all.
        drawn: Whether there was room for drawings.
    """

    number: int
    planned: PlannedStep
    added: tuple[GroundAtom, ...] = ()
    removed: tuple[GroundAtom, ...] = ()
    drawings: tuple[Drawing, ...] = ()
    others: tuple[Drawing, ...] = ()
    broken: str = ""
    reached: bool = True
    drawn: bool = True


@dataclass
class _Sheet:
    """Drawings of a page, up to a limit of characters."""

    graph: Anatomy
    left: int = BUDGET
    full: bool = field(default=False, init=False)

    def draw(self, names: Sequence[str], before: State, after: State | None) -> tuple[Drawing, ...]:
        """Return the named objects, each only once the sheet is full."""
        found = []
        for name in names:
            if self.full:
                break
            drawing = self._drawing(name, before, after)
            self.left -= len(drawing.before) + len(drawing.after)
            self.full = self.left < 0
            found.append(drawing)
        return tuple(found)

    def _drawing(self, name: str, before: State, after: State | None) -> Drawing:
        if after is None:
            return Drawing(name, draw(self.graph, before, name), "")
        first = draw(self.graph, before, name, GraphChanges(removed=before - after))
        return Drawing(name, first, draw(self.graph, after, name, GraphChanges(added=after - before)))


def shown_steps(
    problem: Problem, steps: Sequence[PlannedStep], budget: int = BUDGET
) -> tuple[list[ShownStep], Verdict]:
    """Return every step of a plan, and whether the plan works.

    Args:
        problem: Where it begins.
        steps: The plan.
        budget: How many characters the drawings may have.
    """
    verdict = validate(problem, [step.instruction for step in steps])
    sheet = _Sheet(anatomy(problem), budget)
    return list(_shown(problem, steps, verdict, sheet)), verdict


def _shown(problem: Problem, steps: Sequence[PlannedStep], verdict: Verdict, sheet: _Sheet) -> Iterator[ShownStep]:
    state = problem.init
    for number, step in enumerate(steps, start=1):
        if verdict.step is None or number < verdict.step:
            after = apply(step.instruction, state, problem)
            yield _done(number, step, state, after, sheet)
            state = after
        elif number == verdict.step:
            drawings = sheet.draw(_named(sheet.graph, step.instruction), state, None)
            yield ShownStep(number, step, drawings=drawings, broken=verdict.reason, drawn=not sheet.full)
        else:
            yield ShownStep(number, step, reached=False)


def _done(number: int, step: PlannedStep, before: State, after: State, sheet: _Sheet) -> ShownStep:
    added, removed = sorted(after - before), sorted(before - after)
    changed = dict.fromkeys(thing for atom in (*added, *removed) for thing in sheet.graph.things(atom))
    named = [name for name in _named(sheet.graph, step.instruction) if name in changed] or list(changed)
    drawings = sheet.draw(named, before, after)
    others = sheet.draw([name for name in changed if name not in named], before, after)
    return ShownStep(number, step, tuple(added), tuple(removed), drawings, others, drawn=not sheet.full)


def _named(graph: Anatomy, instruction: Instruction) -> list[str]:
    """Return the objects among the arguments, wholes for parts."""
    return graph.things(GroundAtom(instruction.name, instruction.args))
