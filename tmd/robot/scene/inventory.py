"""The objects of a scene and their parts as the bodies and links of a simulator."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tmd.robot.assets.shapes import Blueprint
from tmd.robot.assets.urdf_builder import ROOT
from tmd.robot.scene.catalogue import FLOOR, Catalogue
from tmd.robot.sim.pose import Pose, Vector
from tmd.world.environment import Environment

if TYPE_CHECKING:
    from tmd.robot.sim.simulator import Simulator


@dataclass(frozen=True, slots=True)
class Handle:
    """The place to work a joint at, in its current pose.

    Attributes:
        kind: ``door``, ``flap`` (a door without a handle: pushed), ``drawer``, ``lid``, ``slide`` (a curtain), ``knob``
            or ``button``.
        index: The joint's number, also that of the link that moves.
        grasp: The tool in the world with the fingers at the handle. Of a button and a flap: the closed tips touch it.
        opening: Gap of the fingers before they close; 0 means closed.
        origin: A point of the joint's axis in the world.
        axis: The joint's axis in the world: of turning, or of sliding.
        turns: Whether it turns (radians) or slides (metres).
        closed: Position when closed, off or not pressed.
        open: Position when open or pressed.
        settings: Of a knob: the position of each setting.
    """

    kind: str
    body: int
    joint: str
    index: int
    grasp: Pose
    opening: float
    origin: Vector
    axis: Vector
    turns: bool
    closed: float
    open: float
    settings: Mapping[str, float]


class Inventory(Catalogue):
    """The objects of an environment as bodies of a simulator.

    Attributes:
        bodies: The body of every object (parts are links of it), and of the floor.
    """

    def __init__(
        self, sim: Simulator, environment: Environment, blueprints: dict[str, Blueprint], parts: dict[str, list[str]]
    ) -> None:
        super().__init__(environment, blueprints, parts)
        self.sim = sim
        self.bodies: dict[str, int] = {}
        self._owners: dict[int, str] = {}

    def keep(self, name: str, body: int) -> None:
        """Register the body of an object."""
        self.bodies[name] = body
        self._owners[body] = name

    def index(self) -> None:
        """Look up the numbers of links, once all bodies are loaded."""
        self._links: dict[tuple[str, str], int] = {(FLOOR, ROOT): -1}
        self._named: dict[tuple[int, int], str] = {}
        for name, blueprint in self.blueprints.items():
            body, model = self.bodies[name], blueprint.model
            self._links[name, ROOT] = -1
            for joint in self.sim.joints(body).values():
                self._links[name, joint.link_name] = joint.index
            for link, part in model.link_parts.items():
                self._named[body, self._links[name, link]] = self.named(name, part)

    def place(self, name: str) -> tuple[int, int]:
        """Return the body and link (−1: the root) of an object or part.

        Raises:
            TmdError: There is no such thing.
        """
        whole, part = self.where(name)
        if whole == FLOOR:
            return self.bodies[FLOOR], -1
        return self.bodies[whole], self.link(whole, self.blueprints[whole].model.part_links.get(part, ROOT))

    def link(self, whole: str, link: str) -> int:
        """Return the number of a link of an object."""
        return self._links[whole, link]

    def owner(self, body: int, link: int = -1) -> str | None:
        """Return the object or part that a link belongs to; None for the robot and others outside of the scene."""
        return self._named.get((body, link), self._owners.get(body))

    def frame(self, whole: str, link: str) -> Pose:
        """Return the pose of a link of an object now."""
        return self.sim.pose(self.bodies[whole], self.link(whole, link))

    def handle(self, name: str) -> Handle | None:
        """Return the current handle of an object or part; None if it has none."""
        whole, part = self.where(name)
        grip = self.grip(whole, part) if whole != FLOOR else None
        if grip is None:
            return None
        link, frame = self.blueprints[whole].model.links[grip.link], self.frame(whole, grip.link)
        return Handle(
            grip.kind,
            self.bodies[whole],
            grip.link,
            self.link(whole, grip.link),
            frame * grip.tool.pose(),
            grip.opening,
            frame.position,
            frame.rotate(link.axis),
            link.kind == "revolute",
            grip.closed,
            grip.open,
            dict(grip.settings),
        )

    def entry(self, name: str, relation: str) -> Vector:
        """Return the direction in which the gripper enters there: (0, 0, −1) is from above."""
        for whole, region in self.regions(name, relation):
            return self.frame(whole, region.link).rotate(region.entry)
        return (0.0, 0.0, -1.0)

    def pose_of(self, item: str) -> Pose:
        """Return the pose of an object now."""
        return self.sim.pose(self.bodies[item])

    def top_of(self, item: str) -> float:
        """Return the height of its highest point now."""
        return self.sim.extents(self.bodies[item])[1][2]
