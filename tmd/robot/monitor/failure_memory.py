"""Ways round what could not be done.

Where no place to stand and no way of the arm does, the same is not tried for ever: it counts as impossible as long
as the things that it names are where they are. The planner then looks for another way to the same end: what is in a
cupboard is taken out first, what is in one hand is put down and taken anew.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

from tmd.pddl.model import GroundAtom, Instruction, State
from tmd.pddl.task import Bits, ConditionalEffect, Cube, Operator, Task
from tmd.robot.skills.results import SkillPhase
from tmd.robot.skills.skill_file import Skills

TRIES = {SkillPhase.PRECONDITION: 1, SkillPhase.STANCE: 1, SkillPhase.PATH: 2}
"""So often something is tried before a way round it is looked for, by the stage at which it fails.

Another try finds another path, and no other place to stand. What failed at other stages was within reach.
"""

DROP = 6
"""What lands on the floor is hard to take from there: letting go of it costs as much as six other instructions."""


@dataclass(frozen=True, slots=True)
class Setback:
    """What could not be reached.

    Attributes:
        instruction: What was tried.
        facts: Where things were.
        lasting: It is not tried again while all these facts hold. Else it is once one of them has changed, even if it
            is then as before: what was put down is a little elsewhere, and held in another way.
        hands: What was in the hands.
    """

    instruction: Instruction
    facts: frozenset[GroundAtom]
    lasting: bool = False
    hands: frozenset[GroundAtom] = frozenset()


class Setbacks:
    """What could not be done so far in a run.

    Args:
        seen: Which sensor sees which predicate (``seen`` of ``skills.yaml``).

    Attributes:
        standing: Those that keep the robot from trying again, in order.
    """

    def __init__(self, seen: Mapping[str, str]) -> None:
        self._seen = seen
        self._failures: Counter[Instruction] = Counter()
        self._known: set[Setback] = set()
        self.standing: list[Setback] = []

    def failed(self, instruction: Instruction, state: State, stage: SkillPhase) -> None:
        """Take note that an instruction failed."""
        self._failures[instruction] += 1
        if stage not in TRIES or self._failures[instruction] < TRIES[stage]:
            return
        hands = frozenset(atom for atom in state if self._seen.get(atom.predicate) == "held")
        for lasting, facts in product((False, True), self._situations(instruction, state)):
            setback = Setback(instruction, facts or hands, lasting, hands)
            if setback.facts and setback not in self._known:
                del self._failures[instruction]
                self._known.add(setback)
                self.standing.append(setback)
                return

    def observed(self, state: State) -> None:
        """Forget what may be tried again, as things are now."""
        self.standing = [setback for setback in self.standing if setback.lasting or setback.facts <= state]

    def with_free_hands(self, state: State) -> list[Setback]:
        """The same, if it may also be tried again once something else that was in a hand is put down."""
        return [
            setback if setback.lasting else replace(setback, facts=setback.facts | setback.hands)
            for setback in self.standing
            if setback.lasting or setback.hands <= state
        ]

    def _situations(self, instruction: Instruction, state: State) -> Iterator[frozenset[GroundAtom]]:
        """What might be changed: where the things are that it names, then what else is at them."""
        sensors = {atom: self._seen.get(atom.predicate) for atom in state}
        held = {atom for atom, sensor in sensors.items() if sensor == "held" and atom.args[-1] in instruction.args}
        at = {atom for atom, sensor in sensors.items() if sensor == "support"}
        yield frozenset(held | {atom for atom in at if atom.args[0] in instruction.args})
        yield frozenset(atom for atom in at if atom.args[1] in instruction.args)


def without(task: Task, setbacks: Sequence[Setback]) -> Task:
    """The task in which what could not be done is not tried again.

    Each setback that does not last is a fluent of its own. It holds in the initial state, forbids the instruction, and
    ends with what ends one of the facts.
    """
    passing = [setback for setback in setbacks if not setback.lasting]
    first = len(task.atoms)
    names = [GroundAtom("setback", (str(number),)) for number in range(len(passing))]
    marks = {setback: 1 << first + number for number, setback in enumerate(passing)}
    forbidden: dict[Instruction, list[Cube]] = {}
    for setback in setbacks:
        cube = Cube(marks[setback] if setback in marks else task.encode(setback.facts))
        forbidden.setdefault(setback.instruction, []).append(cube)
    operators = []
    for operator in task.operators:
        cubes = forbidden.get(operator.instruction, ())
        operator = replace(operator, forbidden=(*operator.forbidden, *cubes)) if cubes else operator
        for setback, mark in marks.items():
            operator = _ending(operator, task.encode(setback.facts), mark)
        operators.append(operator)
    return replace(
        task,
        atoms=(*task.atoms, *names),
        init=task.init | sum(marks.values()),
        operators=tuple(operators),
        index={**task.index, **{name: first + number for number, name in enumerate(names)}},
        by_instruction={operator.instruction: operator for operator in operators},
    )


def _ending(operator: Operator, facts: Bits, mark: Bits) -> Operator:
    """The operator that takes a mark away where it ends one of the facts."""
    ends = mark if operator.delete & facts else 0
    also = [ConditionalEffect(each.condition, 0, mark) for each in operator.conditional if each.delete & facts]
    if not ends and not also:
        return operator
    return replace(operator, delete=operator.delete | ends, conditional=(*operator.conditional, *also))


def careful(task: Task, skills: Skills) -> Task:
    """The task in which letting go of a thing costs more than to put it down somewhere."""
    drops = {name for name, entry in skills.entries.items() if entry.skill == "drop"}
    operators = tuple(
        replace(operator, cost=operator.cost * DROP) if operator.instruction.name in drops else operator
        for operator in task.operators
    )
    return replace(task, operators=operators, by_instruction={o.instruction: o for o in operators})
