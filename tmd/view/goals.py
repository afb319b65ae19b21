"""Goals of a text in words, when a plan reaches them, and doubts about the plan."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from tmd.goals.wording import Wording, names_in
from tmd.inference.ranking import RankedPlan, StepGoal
from tmd.language.clause import Parsed
from tmd.pddl.model import TRUE, Formula, GroundAtom, Instruction, Problem, State, universe
from tmd.pddl.semantics import holds
from tmd.pddl.task import Bits, Operator
from tmd.pddl.validator import Verdict, validate
from tmd.view.meaning import meanings
from tmd.world.world import World

# A note on a step without a goal begins with this where its instructions were guessed.
GUESS = "a guess"


@dataclass(frozen=True, slots=True)
class ShownGoal:
    """The goal of a step as it is shown.

    Attributes:
        words: The goal in words, at most 200 characters; empty without a goal.
        since: After how many steps of the plan it comes to hold, for good if it holds in the end; ``None`` for never.
        until: Where it was reached and does not hold in the end, the number of the step that undid it.
        reached: Whether it holds when its own part of the plan is done.
        rivals: Other candidate goals that there are plans for, in words, the likeliest first.
    """

    goal: StepGoal
    words: str
    since: int | None = None
    until: int | None = None
    reached: bool = False
    rivals: tuple[str, ...] = ()

    @property
    def asked(self) -> bool:
        """Return whether there is something that a state shows."""
        return self.goal.formula not in (None, TRUE)

    @property
    def told(self) -> str:
        """The words, or why there are none: *nothing is done: the condition does not hold*."""
        goal = self.goal
        if self.asked:
            return self.words
        if goal.formula is not None or goal.note.startswith(GUESS):
            return goal.note
        return f"nothing is done: {goal.note or 'it only says what comes first'}"

    @property
    def standing(self) -> str:
        """Time when it holds: *already so*, *holds after step 3*, *already so since step 3, until step 7*, …."""
        if not self.asked:
            return ""
        if not self.reached:
            return "not reached"
        if self.goal.already:
            since = f"already so since step {self.since}" if self.since else "already so"
        else:
            since = f"holds after step {self.since}"
        return since + (f", until step {self.until}" if self.until else "")

    @property
    def sign(self) -> str:
        """A tick for what holds in the end or held when it was asked for, a cross for what was not reached."""
        if not self.asked:
            return "?" if self.goal.note.startswith(GUESS) else "–"
        return "✓" if self.reached else "✗"


def in_words(goals: Iterable[StepGoal], problem: Problem) -> list[ShownGoal]:
    """Return the goals in words."""
    wording = Wording(problem)
    return [ShownGoal(goal, _words(goal.formula, wording), rivals=_rivals(goal, wording)) for goal in goals]


def _rivals(goal: StepGoal, wording: Wording) -> tuple[str, ...]:
    """Return the other candidate goals that there are plans for and that are put otherwise."""
    own = _words(goal.formula, wording)
    others = dict.fromkeys(_words(other.formula, wording) for other in goal.others if other.planned)
    return tuple(words for words in others if words and words != own)


def _words(formula: Formula | None, wording: Wording) -> str:
    return "" if formula in (None, TRUE) else wording.goal(formula)


def followed(goals: Sequence[StepGoal], problem: Problem, plan: Iterable[Instruction]) -> list[ShownGoal]:
    """Return the goals in words, each with where in ``plan`` it comes to hold.

    What follows an instruction that cannot be executed is left out.
    """
    states = validate(problem, plan, trace=True).trace if goals else ()
    return [_placed(shown, states, problem) for shown in in_words(goals, problem)]


def _placed(shown: ShownGoal, states: Sequence[State], problem: Problem) -> ShownGoal:
    goal = shown.goal
    if goal.formula is None or not shown.asked:
        return shown
    objects = universe(problem)
    true = [holds(goal.formula, state, objects) for state in states]
    if goal.last >= len(true) or not true[goal.last]:
        return shown
    place = len(true) - 1 if true[-1] else goal.last
    since = next((before + 1 for before in reversed(range(place)) if not true[before]), 0)
    until = next((after for after in range(place, len(true)) if not true[after]), None)
    return ShownGoal(goal, shown.words, since, until, reached=True)


def all_reached(goals: Iterable[ShownGoal]) -> bool:
    """Return whether every goal was reached, and nothing was guessed."""
    return all(shown.reached if shown.asked else not shown.goal.note.startswith(GUESS) for shown in goals)


def outcome(verdict: Verdict, goals: Sequence[ShownGoal], goal: Formula = TRUE) -> str:
    """Return the outcome of a plan in a few words; an executable plan need not reach its goals.

    ``goals`` are those of a text, from :func:`followed`; ``goal`` is that of the problem, for a plan without a text.
    """
    if not verdict.valid:
        return "✗ does not work"
    if goals:
        return "✓ reaches its goals" if all_reached(goals) else "✗ executable, but not all of its goals are reached"
    return "✓ executable" if goal == TRUE else "✓ reaches its goal"


def doubts(parsed: Parsed, plan: RankedPlan, world: World) -> list[str]:
    """Return the doubts about a plan, a line each: objects that it does not touch, and facts that it leaves."""
    wording = Wording(world.task.problem)
    left = [f"left at the end, not asked for: {wording.fact(atom)}" for atom in left_behind(plan, world)]
    return [
        *(f"'{noun}' was named, and no step touches {names}" for noun, names in not_touched(parsed, plan, world)),
        *left,
    ]


def left_behind(plan: RankedPlan, world: World) -> list[GroundAtom]:
    """Return the facts that a plan made true, nobody asked for, and one step with the same object takes back.

    A step with that thing is one that names it, or a part of the same whole, and nothing else. What follows from a
    goal is asked for with it: no step takes it back without undoing the goal. Nor does a step take back what it only
    exchanges for something else that is new.
    """
    task, wholes, constants = world.task, world.profiles.wholes, world.profiles.constants

    def thing(args: Iterable[str]) -> str | None:
        names = {wholes.get(name, name) for name in args if name not in constants}
        return names.pop() if len(names) == 1 else None

    objects, end, reached = universe(task.problem), task.decode(plan.state), _reached(plan, world)
    alone = {operator: name for operator in task.operators if (name := thing(operator.instruction.args)) is not None}

    def takes_back(operator: Operator, bit: Bits) -> bool:
        after = operator.apply(plan.state)
        if after & bit or after & ~plan.state & ~task.init:
            return False
        state = task.decode(after)
        return all(holds(formula, state, objects) for formula in reached)

    found = []
    for atom in task.names(plan.state & ~task.init):
        name, bit = thing(atom.args), 1 << task.index[atom]
        ends = any(takes_back(operator, bit) for operator, other in alone.items() if other == name)
        if ends and all(holds(formula, end - {atom}, objects) for formula in reached):  # none of them requires it
            found.append(atom)
    return sorted(found)


def _reached(plan: RankedPlan, world: World) -> list[Formula]:
    """Return the goals that hold when the plan is done."""
    end, objects = world.task.decode(plan.state), universe(world.task.problem)
    return [goal.formula for goal in plan.goals if goal.formula is not None and holds(goal.formula, end, objects)]


def not_touched(parsed: Parsed, plan: RankedPlan, world: World) -> list[tuple[str, str]]:
    """Return the nouns of which a plan touches nothing, with likely meanings, where something was to be done.

    A thing that a goal names is not among them, if the goal is reached.
    """
    idle = {goal.clause for goal in plan.goals if goal.already or goal.formula in (None, TRUE)}
    asked = {name for formula in _reached(plan, world) for name in names_in(formula)}
    found: dict[tuple[str, str], None] = {}
    for clause, meant in enumerate(meanings(parsed, plan, world)):
        for noun, names in meant.items():
            things = [name.strip("()") for name in names if name.strip("()") not in world.profiles.constants]
            useless = clause not in idle and all(name.startswith("(") for name in names)
            if useless and noun and things and not asked & set(things):
                found[noun.replace("_", " "), ", ".join(things)] = None
    return list(found)
