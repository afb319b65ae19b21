"""Corrections of a proposed plan: edits, the first broken step after each, and repair by a planner.

Steps are counted from 1, clauses from 0, as in a session. Between two edits a plan may be one that cannot be carried
out; it can be saved when it can.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import accumulate

from tmd.diagnostics import TmdError
from tmd.grounded import Grounded
from tmd.inference.ranking import Choice, PlanStep, RankedPlan
from tmd.language.clause import Clause
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.model import Instruction
from tmd.pddl.semantics import bind, get_constraints
from tmd.pddl.task import Bits
from tmd.pddl.validator import validate
from tmd.planning.backends import IN_PROCESS, make
from tmd.planning.result import Filled, Unreachable
from tmd.studio.demonstrations.clause_spans import clean, cut
from tmd.studio.demonstrations.session import MAX_STEPS, DemonstratedStep, EditedSteps
from tmd.view.panels import require_object
from tmd.world.demonstration import Demonstration, Segment
from tmd.world.world import World


class Correction(EditedSteps):
    """A plan under correction.

    ``proposed`` is the plan that was proposed for ``text``, each instruction with its clause; ``steps`` is what it was
    made already.

    Attributes:
        proposed: The plan as it was proposed.

    Raises:
        TmdError: The environment has no such instruction as one of ``steps``.
    """

    def __init__(
        self,
        world: World,
        text: str,
        proposed: Sequence[DemonstratedStep],
        lexicon: Lexicon | None = None,
        steps: Sequence[DemonstratedStep] | None = None,
    ) -> None:
        self.proposed: tuple[DemonstratedStep, ...] = tuple(proposed)
        super().__init__(world, text, lexicon, self.proposed)
        if steps is not None:
            for step in steps:
                bind(world.task.problem, step.instruction)
            self._add(tuple(steps))

    def delete(self, step: int) -> None:
        """Leave a step out.

        Raises:
            TmdError: There is no such step.
        """
        self._known(step)
        self._add(self.steps[: step - 1] + self.steps[step:])

    def insert(self, step: int, instruction: Instruction) -> None:
        """Put an instruction in, so that it becomes the step of that number, for the clause of the step behind it.

        ``step`` counts from 1; one more than there are steps appends it.

        Raises:
            TmdError: The environment has no such instruction, or the plan no such place.
        """
        bind(self.world.task.problem, instruction)
        if not 0 < step <= len(self.steps) + 1:
            raise TmdError(f"there is no place {step}", hint=f"the plan has {len(self.steps)} steps")
        if len(self.steps) >= MAX_STEPS:
            raise TmdError(f"a plan has at most {MAX_STEPS} steps", hint="delete some")
        self._put_in(step, [instruction])

    def move(self, step: int, to: int) -> None:
        """Make a step the one of another number; those between move up or down.

        Raises:
            TmdError: The plan has no step of one of the numbers.
        """
        self._known(step)
        self._known(to)
        kept = [*self.steps[: step - 1], *self.steps[step:]]
        kept.insert(to - 1, self.steps[step - 1])
        self._add(tuple(kept))

    def swap(self, old: str, new: str, step: int | None = None) -> int:
        """Take another object instead of ``old``, and its parts instead of those of ``old``.

        The object ``old`` is in the plan; ``new`` takes its place in one ``step``, or in all where none is given.

        Returns:
            How many steps changed.

        Raises:
            TmdError: There is no such object or step, or an instruction cannot have it. Nothing changed.
        """
        if step is not None:
            self._known(step)
        names = self._replaced(old, new)
        places = range(len(self.steps)) if step is None else [step - 1]
        changed = {n: _renamed(self.steps[n], names) for n in places}
        changed = {n: s for n, s in changed.items() if s != self.steps[n]}
        for other in changed.values():
            bind(self.world.task.problem, other.instruction)
        if changed:
            self._add(tuple(changed.get(n, s) for n, s in enumerate(self.steps)))
        return len(changed)

    def broken(self) -> tuple[int, str] | None:
        """Return the number of the first step that does not apply, from 1, and why; ``None`` where all do."""
        return self._played()[1]

    def repair(self) -> tuple[Instruction, ...]:
        """Let the planner put in what is missing before the first step that does not apply.

        Returns:
            What was put in; nothing where nothing was broken. A later step may be broken still.

        Raises:
            TmdError: Nothing leads there, or nothing was found; nothing was put in.
        """
        state, found = self._played()
        if found is None:
            return ()
        needed = what_it_needs(self.instructions[found[0] - 1], state, self.world)
        self._put_in(found[0], needed)
        return needed

    def segments(self) -> tuple[Segment, ...]:
        """Return the pieces of the text with the corrected steps of each.

        Raises:
            TmdError: A step does not apply.
        """
        broken = self.broken()
        if broken is not None:
            step, why = broken
            raise TmdError(f"step {step}, {self.instructions[step - 1]}, does not apply: {why}")
        return super().segments()

    def _put_in(self, step: int, instructions: Sequence[Instruction]) -> None:
        """Insert instructions before the step of that number, for its clause, or for the last one at the end."""
        beside = self.steps[step - 1 : step] or self.steps[-1:]
        owner = beside[0].clause if beside else 0
        added = tuple(DemonstratedStep(instruction, owner) for instruction in instructions)
        self._add(self.steps[: step - 1] + added + self.steps[step - 1 :])

    def _played(self) -> tuple[Bits, tuple[int, str] | None]:
        """Return the state before the first step that does not apply, its number and why; or the last state."""
        state = self.world.task.init
        for number, step in enumerate(self.steps, start=1):
            after = self._after(step.instruction, state)
            if isinstance(after, str):
                return state, (number, after)
            state = after
        return state, None

    def _replaced(self, old: str, new: str) -> Mapping[str, str]:
        """Map ``old`` and its parts to ``new`` and its parts."""
        for name in (old, new):
            require_object(name, self.world)
        parts = self.world.profiles.parts
        theirs = dict(parts.get(new, ()))
        return {old: new} | {part: theirs[short] for short, part in parts.get(old, ()) if short in theirs}


def what_it_needs(instruction: Instruction, state: Bits, world: World) -> tuple[Instruction, ...]:
    """Return the instructions that the planner needs in ``state`` so that ``instruction`` applies.

    Raises:
        TmdError: Nothing leads there, or nothing was found.
    """
    operator = world.task.by_instruction.get(instruction)
    if operator is None:
        raise TmdError(f"{instruction} can never be done here", hint="take another object")
    answer = make(IN_PROCESS, world.task).fill(state, get_constraints([operator])[0])
    if not isinstance(answer, Filled):
        why = answer.reason if isinstance(answer, Unreachable) else f"the planner gave up at {answer.limit}"
        raise TmdError(f"nothing makes {instruction} possible: {why}")
    return answer.plan


def steps_of(
    plan: RankedPlan, clauses: Sequence[Clause], text: str, lexicon: Lexicon | None = None
) -> list[DemonstratedStep]:
    """Return the steps of a plan that was proposed for ``clauses``, each with the number of its piece of the text."""
    pieces = cut(clean(text), lexicon)
    starts = [piece.start for piece in pieces]
    owners = [max((n for n, start in enumerate(starts) if start <= c.span.start), default=0) for c in clauses]
    return [DemonstratedStep(step.instruction, owners[step.clause]) for step in plan.steps]


def as_corrected(grounded: Grounded, saved: Demonstration) -> Grounded | None:
    """Return the plans for the text of a saved correction, the corrected one first; ``None`` if it does not work.

    It has an energy only if inference found it as well.
    """
    verdict = validate(grounded.world.task.problem, saved.instructions)
    if not verdict.valid:
        return None
    pairs = list(zip(grounded.plans, grounded.verdicts, strict=True))
    others = [pair for pair in pairs if pair[0].instructions != saved.instructions]
    same = (plan for plan in grounded.plans if plan.instructions == saved.instructions)
    plans, verdicts = zip((next(same, None) or _by_hand(grounded, saved), verdict), *others, strict=True)
    return replace(grounded, plans=plans, verdicts=verdicts)


def _by_hand(grounded: Grounded, saved: Demonstration) -> RankedPlan:
    """Return a saved correction as a plan without energy, for the goals of the best plan."""
    task = grounded.world.task
    starts = [clause.span.start for clause in grounded.parsed.clauses] or [0]
    steps: list[list[PlanStep]] = [[] for _ in starts]
    for segment in saved.segments:
        owner = max((n for n, start in enumerate(starts) if start < segment.end), default=0)
        steps[owner] += [PlanStep(instruction, owner, latent=False) for instruction in segment.instructions]
    ends = list(accumulate(map(len, steps)))
    goals = grounded.plans[0].goals if grounded.plans else ()
    placed = tuple(
        replace(each, first=ends[each.clause] - len(steps[each.clause]), last=ends[each.clause]) for each in goals
    )
    choices = tuple(Choice(saved.id, tuple(each), {}, {}) for each in steps)
    return RankedPlan(choices, task.trace(task.init, saved.instructions)[-1], goals=placed)


def _renamed(step: DemonstratedStep, names: Mapping[str, str]) -> DemonstratedStep:
    name, args = step.instruction
    return DemonstratedStep(
        Instruction(name, tuple(names.get(argument, argument) for argument in args)), step.clause, step.marked
    )
