"""The objects of a scene and their parts as the bodies and links of a simulator."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tmd.robot.assets.shapes import Blueprint
from tmd.robot.assets.urdf_builder import ROOT
from tmd.robot.scene.catalogue import FLOOR, Catalogue
from tmd.robot.sim.pose import Pose, Vector
from tmd.world.environment import Environment

if TYPE_CHECKING:
    from tmd.robot.sim.simulator import Simulator

__all__ = ["FLOOR", "Inventory"]


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
