"""A plan step by step: what each instruction changes, drawn before and after, up to where the plan breaks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from tmd.pddl.model import GroundAtom, Instruction, Problem, State
from tmd.pddl.semantics import apply
from tmd.pddl.validator import Verdict, validate
from tmd.view.object_graph import Anatomy, GraphChanges, anatomy, draw
from tmd.view.subject import PlannedStep

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
    """Draws for as long as there is room."""

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
