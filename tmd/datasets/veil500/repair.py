"""Putting back the action that the exporter of VEIL-500 lost, and counting what is executable.

The exporter merged the last, unclosed segment of a recording into the group before it and lost that segment's
first action. This shows as one step of the last group that cannot be executed because a single fact is
missing. ``repair`` puts back the one instruction that gives that fact. Whether it is what the person did
cannot be known.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace

from tmd.datasets.veil500.compile import compile_environment
from tmd.datasets.veil500.data import Point, VeilData, VeilGroup
from tmd.datasets.veil500.environment import VeilEnvironment
from tmd.pddl.forced_execution import ForcedExecution
from tmd.pddl.model import GroundAtom, Instruction, Problem
from tmd.pddl.task import Bits, Cube, Task

HANDS = 2
"""How many things the two-handed variant lets the robot hold."""


@dataclass(frozen=True, slots=True)
class Repaired:
    """A demonstration after repair.

    Attributes:
        point: With the inserted instruction, or the same one.
        inserted: What was put back, if anything.
        step: Before which step, counted from 0 over all groups.
    """

    point: Point
    inserted: Instruction | None = None
    step: int | None = None


@dataclass(frozen=True, slots=True)
class Executability:
    """The number of demonstrations that can be executed as a whole, and of single steps that cannot."""

    points: int
    executable: int
    steps: int
    failing: int


class Repairer:
    """A repairer of demonstrations, with one literal simulator for each environment.

    Args:
        data: The data set.
    """

    def __init__(self, data: VeilData) -> None:
        self._simulators: dict[tuple[str, int], ForcedExecution] = {}
        recorded: dict[tuple[str, int], list[Instruction]] = defaultdict(list)
        for point in data.points:
            recorded[point.key] += point.instructions
        for key, environment in data.environments.items():
            instructions = [*recorded[key], *_candidates(environment)]
            self._simulators[key] = ForcedExecution(compile_environment(environment), instructions)

    def simulator(self, point: Point) -> ForcedExecution:
        """Return the simulator of a demonstration's environment."""
        return self._simulators[point.key]

    def repair(self, point: Point) -> Repaired:
        """Insert at most one instruction, before the first step that fails under the literal rules.

        Only if that step lies in the last group, misses exactly one fact, and the instruction that gives the
        fact is executable there.
        """
        simulator = self.simulator(point)
        done = simulator.run(point.instructions)
        step = done.first_failure
        before_last = sum(len(group.instructions) for group in point.groups[:-1])
        if step is None or step < before_last:
            return Repaired(point)
        state = done.states[step]
        missing = _single_missing(simulator.precondition(point.instructions[step]), state, done.task)
        fix = _giving(missing, simulator.problem) if missing else None
        if fix is None or not simulator.step(state, fix)[1]:
            return Repaired(point)
        last = point.groups[-1]
        place = step - before_last
        instructions = (*last.instructions[:place], fix, *last.instructions[place:])
        groups = (*point.groups[:-1], VeilGroup(last.segments, instructions))
        return Repaired(replace(point, groups=groups), fix, step)

    def executability(self, points: Sequence[Point], *, two_hands: bool = False) -> Executability:
        """Execute demonstrations by force and count what was not executable.

        Args:
            points: The demonstrations.
            two_hands: Count grasping a third thing as not executable.
        """
        executable = failing = steps = 0
        for point in points:
            done = self._simulators[point.key].run(point.instructions)
            failures = set(done.failures)
            if two_hands:
                holding = sum(1 << n for n, atom in enumerate(done.task.atoms) if atom.predicate == "holding")
                for step, instruction in enumerate(point.instructions):
                    full = (done.states[step] & holding).bit_count() >= HANDS
                    if instruction.name == "grasp" and full:
                        failures.add(step)
            executable += not failures
            failing += len(failures)
            steps += len(point.instructions)
        return Executability(len(points), executable, steps, failing)


def repaired(data: VeilData) -> VeilData:
    """Return the data set with every demonstration repaired where possible."""
    repairer = Repairer(data)
    return replace(data, points=tuple(repairer.repair(point).point for point in data.points))


def _candidates(environment: VeilEnvironment) -> list[Instruction]:
    """Return everything that a repair may put back."""
    openable = ("microwave", "fridgeleftdoor", "fridgerightdoor")
    verbs = ("moveto", "grasp", "release")
    found = [Instruction(verb, (thing.pddl,)) for thing in environment.objects for verb in verbs]
    return found + [Instruction("open", (o.pddl,)) for o in environment.objects if o.pddl in openable]


def _single_missing(cubes: Sequence[Cube], state: Bits, task: Task) -> tuple[GroundAtom, bool] | None:
    """Return the only literal that keeps one of the cubes from holding, as an atom and whether it should be true."""
    for cube in cubes:
        absent, present = cube.positive & ~state, cube.negative & state
        if absent.bit_count() + present.bit_count() == 1:
            return task.names(absent | present)[0], bool(absent)
    return None


def _giving(missing: tuple[GroundAtom, bool], problem: Problem) -> Instruction | None:
    """Return the instruction that makes a literal hold."""
    atom, positive = missing
    if atom.predicate == "near" and positive:
        return Instruction("moveto", atom.args[1:])
    if atom.predicate == "holding":
        return Instruction("grasp" if positive else "release", atom.args[1:])
    if atom.predicate == "is" and positive:
        doors = (f.args[0] for f in problem.init if f.predicate == "swings" and f.args[1:] == atom.args)
        return next((Instruction("open", (door,)) for door in sorted(doors)), None)
    return None
