"""Fault injection: the simulation is changed while the robot works, and the monitor must notice.

A fault acts on bodies and joints only, once in a run; what PDDL believes is never touched. Where in the plan it
comes about is drawn from the places where it can.
"""

from __future__ import annotations

from collections.abc import Collection, Hashable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from enum import StrEnum

from numpy.random import Generator

from tmd.pddl.model import GroundAtom, Instruction
from tmd.robot.pr2.pr2 import ARMS
from tmd.robot.pr2.trajectory_following import hold
from tmd.robot.scene.scene import Handle, Spot
from tmd.robot.sim.pose import Pose
from tmd.robot.sim.simulator import Simulator
from tmd.robot.skills.performer import RobotPerformer
from tmd.robot.skills.robot_context import Cell
from tmd.robot.skills.skill_file import Skills, SkillTask


class InjectedFault(StrEnum):
    """The kinds of faults."""

    SLIP = "slip"
    """What was just taken falls out of the hand."""
    STUCK = "stuck"
    """A door, a drawer or a lid does not move at the first try."""
    MOVED = "moved"
    """A thing that is taken later is put elsewhere while the robot does something else."""
    MISSED = "missed"
    """What carries a button shifts just before the finger is there, which then presses beside it."""


_SKILLS = {InjectedFault.SLIP: ("pick",), InjectedFault.STUCK: ("open", "close"), InjectedFault.MISSED: ("push",)}
_NEEDED = {
    InjectedFault.SLIP: "nothing is taken",
    InjectedFault.STUCK: "no door, drawer or lid is moved",
    InjectedFault.MOVED: "nothing is taken for the first time after an instruction that it has no part in",
    InjectedFault.MISSED: "no button is pressed",
}
_TRIED = {
    InjectedFault.SLIP: "what was to be taken was not held",
    InjectedFault.STUCK: "what was to be moved has no joint",
    InjectedFault.MOVED: "nothing that is taken later stood open, or there was no other surface with room",
    InjectedFault.MISSED: "there was no room to shift what carries the button, or no finger came near",
}
_HELD_FOR = (0.03, 0.25)
"""Metres that a thing is carried before it slips."""
_SHIFT = (0.04, 0.06)
"""Metres that a button shifts: more than its radius and less than the room between neighbours."""
_NEAR = 0.02
"""The finger is this near to where it presses when the button shifts."""
_LOCK = 1e5
"""Newtons or newton metres that hold a joint that is stuck."""
_FALL = 0.005
"""Metres between the heights that are tried for a thing that falls without physics."""


@dataclass(frozen=True, slots=True)
class Happening:
    """A fault that came about.

    Attributes:
        tick: The simulation's step.
        text: What was done to the world.
    """

    tick: int
    text: str


def opportunities(fault: InjectedFault, plan: Sequence[Instruction], skills: Skills) -> list[int]:
    """The indexes of the instructions of ``plan`` during which a fault can come about, as far as the plan tells."""
    tasks = [skills.task(instruction) for instruction in plan]
    if fault is not InjectedFault.MOVED:
        return [index for index, task in enumerate(tasks) if task.skill in _SKILLS[fault]]
    return [index for index in range(len(plan)) if _taken_later(index, plan, tasks)]


def _taken_later(index: int, plan: Sequence[Instruction], tasks: Sequence[SkillTask]) -> list[str]:
    """What is first taken after an instruction that it has nothing to do with, in the order of taking."""
    before = {task.object for task in tasks[: index + 1] if task.skill == "pick"}
    later = dict.fromkeys(task.object for task in tasks[index + 1 :] if task.skill == "pick")
    return [item for item in later if item not in before and item not in plan[index].args]


class FaultyPerformer:
    """A robot in whose world one thing goes wrong.

    Args:
        performer: The robot.
        fault: What goes wrong.
        rng: Draws where, and the numbers.
        plan: What will be performed, apart from repairs.

    Attributes:
        log: What came about; empty as long as nothing has.
    """

    def __init__(
        self, performer: RobotPerformer, fault: InjectedFault, rng: Generator, plan: Sequence[Instruction]
    ) -> None:
        self.log: list[Happening] = []
        self._performer = performer
        self._fault = fault
        self._rng = rng
        self._plan = tuple(plan)
        self._possible = opportunities(fault, plan, performer.skills)
        self._from = self._possible[int(rng.integers(len(self._possible)))] if self._possible else len(self._plan)
        self._next = 0

    @property
    def clock(self) -> int:
        """The robot's."""
        return self._performer.clock

    def missing(self) -> str:
        """Return the reason why no fault came about; empty where one did."""
        if self.log:
            return ""
        if not self._possible:
            return f"'{self._fault}' cannot come about in this plan: {_NEEDED[self._fault]}"
        drawn = self._plan[self._from]
        if self._next <= self._from:
            return f"'{self._fault}' was drawn for instruction {self._from + 1}, {drawn}, which was not reached"
        return (
            f"'{self._fault}' did not come about from instruction {self._from + 1}, {drawn}, on: {_TRIED[self._fault]}"
        )

    def situation(self) -> Hashable:
        """The robot's."""
        return self._performer.situation()

    def idle(self, instruction: Instruction) -> bool:
        """The robot's."""
        return self._performer.idle(instruction)

    def perform(self, instruction: Instruction, gains: Collection[GroundAtom], attempt: int) -> str:
        """Do it, and perhaps let something go wrong; see :class:`tmd.robot.monitor.executor.Performer`."""
        index = self._index(instruction, attempt)
        if self.log or index is None or index < self._from or index not in self._possible:
            return self._performer.perform(instruction, gains, attempt)
        with self._trouble(index):
            return self._performer.perform(instruction, gains, attempt)

    def _index(self, instruction: Instruction, attempt: int) -> int | None:
        """Where in the plan an instruction stands; ``None`` for a repair."""
        if attempt and self._next and instruction == self._plan[self._next - 1]:
            return self._next - 1
        if self._next < len(self._plan) and instruction == self._plan[self._next]:
            self._next += 1
            return self._next - 1
        return None

    def _trouble(self, index: int) -> AbstractContextManager[None]:
        cell = self._performer.cell
        tasks = [self._performer.skills.task(instruction) for instruction in self._plan]
        match self._fault:
            case InjectedFault.SLIP:
                return _slipping(cell, tasks[index].object, float(self._rng.uniform(*_HELD_FOR)), self.log)
            case InjectedFault.STUCK:
                return _stuck(cell, tasks[index].object, self.log)
            case InjectedFault.MISSED:
                way = float(self._rng.uniform(*_SHIFT)) * (1 if self._rng.random() < 0.5 else -1)
                return _shifting(cell, tasks[index].object, way, self.log)
            case InjectedFault.MOVED:
                return _moved(cell, _taken_later(index, self._plan, tasks), self._rng, self.log)


# slip


@contextmanager
def _slipping(cell: Cell, item: str, way: float, log: list[Happening]) -> Iterator[None]:
    slip = _Slip(cell, item, way, log)
    cell.sim.add_watcher(slip)
    try:
        yield
    finally:
        cell.sim.remove_watcher(slip)
        slip.end()


class _Slip:
    """Lets a thing fall that was carried for ``way`` metres, or, at the end, however far it was carried."""

    def __init__(self, cell: Cell, item: str, way: float, log: list[Happening]) -> None:
        self.cell = cell
        self.item = item
        self.body = cell.scene.bodies[item]
        self.way = way
        self.log = log
        self.start: Pose | None = None

    def __call__(self, sim: Simulator) -> None:
        if self.log or self._side() is None:
            return
        here = sim.pose(self.body)
        self.start = self.start or here
        if here.distance(self.start) >= self.way:
            self._fall()

    def end(self) -> None:
        """Let it fall now if it has not, and come to rest."""
        if not self.log and self._side() is not None:
            self._fall()
        if self.log:
            self.cell.settle()

    def _side(self) -> str | None:
        return next((side for side in ARMS if self.cell.robot.held(side) == self.body), None)

    def _fall(self) -> None:
        robot, sim, side = self.cell.robot, self.cell.sim, self._side()
        assert side is not None
        robot.let_go(side)
        fingers = robot.finger_groups[side]
        wide = robot.fingers(0.08)
        hold(sim, robot.body, fingers, wide)
        if robot.kinematic:
            sim.set_joints(robot.body, fingers.joints, wide)
            _lower(self.cell, self.body)
        self.log.append(Happening(sim.ticks, f"{self.item} slipped out of the {side} hand"))


def _lower(cell: Cell, body: int) -> None:
    """Put a body straight down on what is below it, as if it fell."""
    others = [other for other in cell.sim.bodies() if other not in (body, cell.robot.body)]
    while True:
        here = cell.sim.pose(body)
        x, y, z = here.position
        cell.sim.set_pose(body, Pose((x, y, z - _FALL), here.orientation))
        if z < 0 or any(cell.sim.closest(body, other, 0.0) for other in others):
            cell.sim.set_pose(body, here)
            return


def _is_within(sim: Simulator, body: int, others: Sequence[int]) -> bool:
    """Whether a body is in another one by more than what touches is."""
    return any(c.distance < -_FALL for other in others for c in sim.closest(body, other, 0.0))


# stuck


@contextmanager
def _stuck(cell: Cell, name: str, log: list[Happening]) -> Iterator[None]:
    handle = cell.scene.handle(name)
    if handle is None:
        yield
        return
    stuck = _Stuck(cell, handle)
    cell.sim.drive_joint(handle.body, handle.index, stuck.at, _LOCK)
    cell.sim.add_watcher(stuck)
    log.append(Happening(cell.sim.ticks, f"a joint is stuck: {cell.how_open(name)}"))
    try:
        yield
    finally:
        cell.sim.remove_watcher(stuck)
        cell.scene.calm(name)


class _Stuck:
    """Keeps a joint that is set along with the hand, and what is on its link, where they are."""

    def __init__(self, cell: Cell, handle: Handle) -> None:
        self.kinematic = cell.robot.kinematic
        self.handle = handle
        self.at = cell.sim.joint_position(handle.body, handle.index)
        places = {item: cell.support(item) for item in cell.scene.items()}
        link = handle.body, handle.index
        aboard = [item for item, place in places.items() if place and cell.scene.place(place[0]) == link]
        self.aboard = [(cell.scene.bodies[item], cell.sim.pose(cell.scene.bodies[item])) for item in aboard]

    def __call__(self, sim: Simulator) -> None:
        if not self.kinematic or sim.joint_position(self.handle.body, self.handle.index) == self.at:
            return
        sim.set_joint(self.handle.body, self.handle.index, self.at)
        for body, pose in self.aboard:
            sim.set_pose(body, pose)
        # who sets the joint was perhaps added later: from now on this comes after it
        sim.remove_watcher(self)
        sim.add_watcher(self)


# missed


@contextmanager
def _shifting(cell: Cell, name: str, way: float, log: list[Happening]) -> Iterator[None]:
    handle = cell.scene.handle(name)
    if handle is None:
        yield
        return
    shift = _Shift(cell, name, handle, way, log)
    cell.sim.add_watcher(shift)
    try:
        yield
    finally:
        cell.sim.remove_watcher(shift)


class _Shift:
    """Shifts what carries a button, with all that stands on it, when a finger is almost there."""

    def __init__(self, cell: Cell, name: str, handle: Handle, way: float, log: list[Happening]) -> None:
        self.cell = cell
        self.name = name
        self.handle = handle
        self.way = way
        self.log = log
        self.done = False

    def __call__(self, sim: Simulator) -> None:
        if self.done or all(self.cell.robot.tool(side).distance(self.handle.grasp) > _NEAR for side in ARMS):
            return
        self.done = True
        whole = self.cell.scene.whole(self.name)
        bodies = [self.handle.body, *(self.cell.scene.bodies[item] for item in _load(self.cell, whole))]
        before = [sim.pose(body) for body in bodies]
        for way in (self.way, -self.way):
            by = before[0].rotate((0.0, way, 0.0))
            for body, pose in zip(bodies, before, strict=True):
                sim.set_pose(body, _beside(pose, by))
            if not _is_within(sim, bodies[0], [other for other in sim.bodies() if other not in bodies]):
                sim.wake()
                text = f"{whole} was shifted by {100 * abs(way):.0f} cm when the finger was almost at {self.name}"
                self.log.append(Happening(sim.ticks, text))
                return
        for body, pose in zip(bodies, before, strict=True):
            sim.set_pose(body, pose)


def _beside(pose: Pose, by: tuple[float, float, float]) -> Pose:
    x, y, z = (a + b for a, b in zip(pose.position, by, strict=True))
    return Pose((x, y, z), pose.orientation)


def _load(cell: Cell, whole: str) -> list[str]:
    """The items that stand on, in or next to an object, or on such an item."""
    places = {item: place[0] for item in cell.scene.items() if (place := cell.support(item))}
    found: list[str] = []
    more = True
    while more:
        carriers = {whole, *found}
        new = [i for i, place in places.items() if i not in carriers and cell.whole(place) in carriers]
        found += new
        more = bool(new)
    return found


# moved


@contextmanager
def _moved(cell: Cell, items: Sequence[str], rng: Generator, log: list[Happening]) -> Iterator[None]:
    for number in rng.permutation(len(items)):
        text = _move(cell, items[int(number)], rng)
        if text:
            log.append(Happening(cell.sim.ticks, text))
            break
    yield


def _move(cell: Cell, item: str, rng: Generator) -> str:
    """Put a thing that stands open on another surface on which things stand; says so, or nothing if it cannot be."""
    here = cell.support(item) if cell.scene.is_item(item) and cell.side_of(item) is None else None
    if here is None or here[1] == "in" or _load(cell, item):
        return ""
    body = cell.scene.bodies[item]
    before = cell.sim.pose(body)
    for target in _surfaces(cell, here[0], rng):
        for spot in _roomy(cell, item, cell.scene.support(target, "on", item))[:3]:
            cell.sim.set_pose(body, spot.pose)
            others = [other for other in cell.sim.bodies() if other != body]
            if _is_within(cell.sim, body, others):
                continue
            cell.sim.wake()
            cell.settle()
            return f"{item} was moved from {here[0]} to {target}"
    cell.sim.set_pose(body, before)
    return ""


def _roomy(cell: Cell, item: str, spots: Sequence[Spot]) -> list[Spot]:
    """The spots with those first that are far from other items: what is moved shall not bar the way to others."""
    others = [cell.sim.pose(cell.scene.bodies[other]) for other in cell.scene.items() if other != item]
    return sorted(spots, key=lambda spot: -min((spot.pose.distance(other) for other in others), default=0.0))


def _surfaces(cell: Cell, without: str, rng: Generator) -> list[str]:
    """Objects on which something stands, in random order."""
    places = (cell.support(item) for item in cell.scene.items())
    known = sorted({place[0] for place in places if place and place[1] == "on"} - {without, "floor"})
    free = [name for name in known if cell.scene.whole(name) == name and not cell.scene.is_item(name)]
    return [free[int(number)] for number in rng.permutation(len(free))]
