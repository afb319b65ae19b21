"""What really happens in a simulation, read from pybullet alone: poses, tilts, joints, contacts, what is held.

Nothing of the program's own senses is used: neither what the monitor measures, nor what a skill reports, nor what the
robot believes to hold. What objects look like (sizes, rims, spouts, the limits of joints) is taken from the models that
were built.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import acos

import numpy as np
import pybullet
from numpy.typing import NDArray

from tmd.pddl.model import GroundAtom
from tmd.robot.monitor.listeners import Title
from tmd.robot.session import SimulationSession
from tmd.robot.sim.simulator import Simulator
from tmd.robot.skills.results import ExecutedStep

EVERY = 8
"""Steps of the physics between two frames."""
NEAR = 0.005
"""Metres within which two things touch: collision shapes have margins."""

Array = NDArray[np.float64]
Box = tuple[Array, Array]


@dataclass(frozen=True, slots=True)
class Frame:
    """One moment.

    Attributes:
        tick: Of the simulation.
        places: The frame of each item's root: position and rotation matrix.
        joints: The position of each joint of the scene that moves, by body and number.
        held: The items that the robot's body is tied to by a constraint.
    """

    tick: int
    places: dict[str, tuple[Array, Array]]
    joints: dict[tuple[int, int], float]
    held: tuple[str, ...]

    def tilt(self, item: str) -> float:
        """Radians between the item's z axis and the vertical."""
        return acos(float(np.clip(self.places[item][1][2, 2], -1.0, 1.0)))

    def point(self, item: str, local: Sequence[float]) -> Array:
        """A point of an item's frame in the world."""
        position, turn = self.places[item]
        found: Array = position + turn @ np.array(local)
        return found


@dataclass(frozen=True, slots=True)
class Step:
    """An instruction that is over: its frames, what the run says of it, and where everything is.

    Attributes:
        title: Which instruction.
        told: What the run says.
        frames: From its begin to its end.
        boxes: Round each link that can be touched, by object: the world at its end.
        touching: For each item the objects and links that it touches.
        hands: For each item how far it is from the nearest hand, in metres.
        base: x and y of the robot.
        knobs: Joints of knobs and doors, as in a frame.
    """

    title: Title
    told: ExecutedStep
    frames: tuple[Frame, ...]
    boxes: dict[tuple[str, int], Box]
    touching: dict[str, frozenset[tuple[str, int]]]
    hands: dict[str, float]
    base: tuple[float, float]


@dataclass
class Worst:
    """The worst of a run.

    Attributes:
        jump: Metres that an item moved in one step of the physics.
        depth: Metres that two things were in each other.
        overrun: Share of its way by which a joint was beyond its limits.
        where: What each is about.
    """

    jump: float = 0.0
    depth: float = 0.0
    overrun: float = 0.0
    where: dict[str, str] = field(default_factory=dict)

    def note(self, kind: str, value: float, about: str) -> None:
        """Keep the greatest value."""
        if value > getattr(self, kind):
            setattr(self, kind, value)
            self.where[kind] = about


class Recorder:
    """Watches a run: give it to the simulation as a watcher, and to the run as a listener.

    Args:
        session: The simulation; nothing was done yet.

    Attributes:
        steps: The instructions that are over.
        worst: The worst of the run.
        start: The first frame.
    """

    def __init__(self, session: SimulationSession) -> None:
        self._client = session.sim.client
        scene = session.cell.scene
        self.session = session
        self.bodies = {name: scene.bodies[name] for name in scene.blueprints}
        self.floor = scene.bodies["floor"]
        self.items = [name for name, blueprint in scene.blueprints.items() if blueprint.sort == "item"]
        self.models = {name: blueprint.model for name, blueprint in scene.blueprints.items()}
        self.robot = session.cell.robot.body
        self._names = {body: name for name, body in self.bodies.items()}
        self._inertial = {name: self._root(body) for name, body in self.bodies.items()}
        self._links = {name: self._solid(body) for name, body in (*self.bodies.items(), ("floor", self.floor))}
        self.moving = {
            (body, joint): self._limits(body, joint)
            for body in self.bodies.values()
            for joint in range(pybullet.getNumJoints(body, physicsClientId=self._client))
            if self._limits(body, joint) is not None
        }
        self._hands = [
            joint
            for joint in range(pybullet.getNumJoints(self.robot, physicsClientId=self._client))
            if b"gripper" in pybullet.getJointInfo(self.robot, joint, physicsClientId=self._client)[12]
        ]
        self._kinematic = session.cell.robot.kinematic
        self._frames: list[Frame] = []
        self._before: dict[str, Array] = {}
        self._last_steps = session.sim.steps
        self.steps: list[Step] = []
        self.worst = Worst()
        self.start = self.frame(session.sim.ticks)
        session.sim.add_watcher(self._watch)

    # pybullet

    def _root(self, body: int) -> tuple[Array, Array]:
        """The frame of the mass in the frame of the root."""
        info = pybullet.getDynamicsInfo(body, -1, physicsClientId=self._client)
        return np.array(info[3]), _matrix(info[4])

    def _solid(self, body: int) -> list[int]:
        links = range(-1, pybullet.getNumJoints(body, physicsClientId=self._client))
        return [k for k in links if pybullet.getCollisionShapeData(body, k, physicsClientId=self._client)]

    def _limits(self, body: int, joint: int) -> tuple[float, float] | None:
        info = pybullet.getJointInfo(body, joint, physicsClientId=self._client)
        return None if info[2] == pybullet.JOINT_FIXED or info[8] >= info[9] else (info[8], info[9])

    def link(self, name: str, link: str) -> int:
        """The number of a link of an object; −1 for its root."""
        body = self.bodies[name]
        for joint in range(pybullet.getNumJoints(body, physicsClientId=self._client)):
            if pybullet.getJointInfo(body, joint, physicsClientId=self._client)[12].decode() == link:
                return joint
        return -1

    def place(self, name: str) -> tuple[Array, Array]:
        """The root's frame of an object in the world."""
        position, turn = pybullet.getBasePositionAndOrientation(self.bodies[name], physicsClientId=self._client)
        rotation = _matrix(turn)
        shift, own = self._inertial[name]
        root = rotation @ own.T
        return np.array(position) - root @ shift, root

    def frame(self, tick: int) -> Frame:
        """The world now."""
        joints = {key: pybullet.getJointState(*key, physicsClientId=self._client)[0] for key in self.moving}
        return Frame(tick, {name: self.place(name) for name in self.items}, joints, self._tied())

    def _tied(self) -> tuple[str, ...]:
        found = []
        for index in range(pybullet.getNumConstraints(physicsClientId=self._client)):
            number = pybullet.getConstraintUniqueId(index, physicsClientId=self._client)
            info = pybullet.getConstraintInfo(number, physicsClientId=self._client)
            if info[0] == self.robot and info[4] == pybullet.JOINT_FIXED and info[2] in self._names:
                found.append(self._names[info[2]])
        return tuple(sorted(found))

    def _near(self, one: int, other: int, within: float, **links: int) -> list[tuple[int, float]]:
        """The links of ``other`` that are within a distance, each with it."""
        points = pybullet.getClosestPoints(one, other, within, physicsClientId=self._client, **links) or ()
        return [(point[4], point[8]) for point in points]

    # what it is told

    def _watch(self, sim: Simulator) -> None:
        stepped, self._last_steps = sim.steps > self._last_steps, sim.steps
        if stepped and not self._kinematic:
            self._jumps()
        if self._kinematic or sim.ticks % EVERY == 0:
            frame = self.frame(sim.ticks)
            self._frames.append(frame)
            for key, (low, high) in self.moving.items():
                beyond = max(low - frame.joints[key], frame.joints[key] - high) / (high - low)
                self.worst.note("overrun", beyond, f"{self._names[key[0]]} joint {key[1]} at tick {sim.ticks}")
        if not self._kinematic and sim.ticks % (6 * EVERY) == 0:
            self._depths(sim.ticks)

    def _jumps(self) -> None:
        for name in self.items:
            now = np.array(pybullet.getBasePositionAndOrientation(self.bodies[name], physicsClientId=self._client)[0])
            if name in self._before:
                self.worst.note("jump", float(np.linalg.norm(now - self._before[name])), name)
            self._before[name] = now

    def _depths(self, tick: int) -> None:
        for point in pybullet.getContactPoints(physicsClientId=self._client) or ():
            names = [self._names.get(body, "robot" if body == self.robot else "floor") for body in point[1:3]]
            if "robot" in names or any(name in self.items for name in names):
                self.worst.note("depth", -point[8], f"{names[0]} and {names[1]} at tick {tick}")

    def begin(self, title: Title, expected: Sequence[GroundAtom]) -> None:
        """An instruction begins."""
        self._frames = self._frames[-1:]

    def end(self, title: Title, step: ExecutedStep) -> None:
        """It is over."""
        now = self.frame(self.session.sim.ticks)
        self._frames.append(now)
        self.steps.append(self.look(title, step))
        self._frames = [now]

    def look(self, title: Title, step: ExecutedStep) -> Step:
        """Where everything is now."""
        boxes = {
            (name, link): self._box(body, link) for name, body in self.bodies.items() for link in self._links[name]
        }
        everything = {**self.bodies, "floor": self.floor}
        touching = {
            item: frozenset(
                (name, link)
                for name, body in everything.items()
                if name != item
                for link, distance in self._near(self.bodies[item], body, NEAR)
                if distance <= NEAR
            )
            for item in self.items
        }
        hands = {
            item: min(
                (
                    distance
                    for link in self._hands
                    for _, distance in self._near(self.robot, self.bodies[item], 0.05, linkIndexA=link)
                ),
                default=1.0,
            )
            for item in self.items
        }
        x, y = self._base()
        return Step(title, step, tuple(self._frames), boxes, touching, hands, (x, y))

    def _box(self, body: int, link: int) -> Box:
        low, high = pybullet.getAABB(body, link, physicsClientId=self._client)
        return np.array(low), np.array(high)

    def _base(self) -> tuple[float, float]:
        for joint in range(pybullet.getNumJoints(self.robot, physicsClientId=self._client)):
            if pybullet.getJointInfo(self.robot, joint, physicsClientId=self._client)[12] == b"base_link":
                state = pybullet.getLinkState(
                    self.robot, joint, computeForwardKinematics=1, physicsClientId=self._client
                )
                return state[4][0], state[4][1]
        raise AssertionError("a PR2 has a base_link")


def _matrix(turn: Sequence[float]) -> Array:
    return np.array(pybullet.getMatrixFromQuaternion(turn), dtype=float).reshape(3, 3)
