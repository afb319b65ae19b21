"""Recording of joints, base and things during a run, at a given rate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from tmd.pddl.model import GroundAtom
from tmd.robot.monitor.listeners import Title
from tmd.robot.pr2.urdf import BASE_JOINTS
from tmd.robot.session import TICK, SimulationSession
from tmd.robot.sim.pose import Pose
from tmd.robot.sim.simulator import STEPS_PER_SECOND, Simulator
from tmd.robot.skills.results import ExecutedStep


@dataclass(frozen=True, slots=True)
class Sample:
    """The scene at one moment.

    Attributes:
        time: Seconds of simulated time. A kinematic stride counts as a fifteenth of a second.
        number: The place in the plan, from 1, of the instruction that is being done; 0 between two of them.
        instruction: That instruction; empty between two of them.
        base: Of the robot: x, y in metres and theta in radians.
        joints: Positions of the robot's joints that move, without those of the base; radians or metres.
        velocities: Theirs; all 0 if joints are set and not driven.
        objects: The poses of items.
        object_joints: Positions of doors, drawers, lids, knobs and buttons.
    """

    time: float
    number: int
    instruction: str
    base: tuple[float, float, float]
    joints: Mapping[str, float]
    velocities: Mapping[str, float]
    objects: Mapping[str, Pose]
    object_joints: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Recorded:
    """The subject of a recording.

    Attributes:
        fixtures: The poses of the furniture.
        rate: Samples a second.
        robot: The robot's URDF, which has the joints of the samples.
    """

    environment: str
    fixtures: Mapping[str, Pose]
    rate: float
    robot: Path


class SampleWriter(Protocol):
    """Receiver of a growing recording."""

    def open(self, what: Recorded) -> None:
        """Receive the subject."""
        ...

    def write(self, sample: Sample) -> None:
        """Receive the next sample; times never go back."""
        ...


class StateRecorder:
    """Samples a simulation ``rate`` times a second, and at the beginning and the end of each instruction.

    It is a listener of the run, and a watcher of its clock.
    """

    def __init__(self, session: SimulationSession, rate: float, writer: SampleWriter) -> None:
        self._session, self._writer, self._period = session, writer, 1 / rate
        scene, robot, sim = session.cell.scene, session.cell.robot, session.sim
        names = [name for name in robot.positions() if name not in BASE_JOINTS]
        own = robot.model.own_joints
        self._indices = [robot.joint_index[name] for name in names]
        self._joints = [own.get(name, (name, 1.0, 0.0)) for name in names]
        self._handles = [
            (name, scene.bodies[whole], scene.link(whole, grip.link))
            for whole, blueprint in scene.blueprints.items()
            for grip in blueprint.model.grips
            for name in (scene.named(whole, grip.part),)
        ]
        self._steps, self._time = sim.steps, 0.0
        self._due, self._last = 0.0, -1.0
        self._title: Title | None = None
        fixtures = {name: scene.pose_of(name) for name in scene.blueprints if not scene.is_item(name)}
        writer.open(Recorded(scene.environment.name, fixtures, rate, robot.model.source))
        sim.add_watcher(self._watch)
        self._sample()

    def begin(self, title: Title, expected: Sequence[GroundAtom]) -> None:
        """Sample at the beginning of an instruction."""
        self._title = title
        self._sample()

    def end(self, title: Title, step: ExecutedStep) -> None:
        """Sample at its end."""
        self._sample()
        self._title = None

    def _watch(self, sim: Simulator) -> None:
        self._time += 1 / STEPS_PER_SECOND if sim.steps > self._steps else TICK
        self._steps = sim.steps
        if self._time >= self._due - 1e-9:
            self._sample()
            self._due = max(self._due + self._period, self._time)

    def _sample(self) -> None:
        sim, cell, title = self._session.sim, self._session.cell, self._title
        positions, velocities = sim.joint_states(cell.robot.body, self._indices)
        joints = [
            (name, sign * p + shift, sign * v)
            for (name, sign, shift), p, v in zip(self._joints, positions, velocities, strict=True)
        ]
        self._writer.write(
            Sample(
                round(self._time, 6),
                title.number if title is not None else 0,
                str(title.instruction) if title is not None else "",
                cell.robot.base(),
                {name: position for name, position, _ in joints},
                {name: velocity for name, _, velocity in joints},
                {item: cell.scene.pose_of(item) for item in cell.scene.items()},
                {name: sim.joint_position(body, joint) for name, body, joint in self._handles},
            )
        )
