"""What there is in a scene: objects and their parts by name, the bodies and links that they are, and their regions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tmd.errors import TmdError
from tmd.robot.features import Region
from tmd.robot.layout import Footprint
from tmd.robot.model import ROOT
from tmd.robot.pose import Pose, Vector
from tmd.robot.shapes import Blueprint
from tmd.world.environment import Environment

if TYPE_CHECKING:
    from tmd.robot.simulator import Simulator

FLOOR = "floor"


class Inventory:
    """The objects of an environment as bodies of a simulator.

    Args:
        sim: The simulator.
        environment: What there is.
        blueprints: How each object is built.
        parts: The parts of each object.

    Attributes:
        bodies: The body of every object (parts are links of it), and of the floor.
    """

    def __init__(
        self, sim: Simulator, environment: Environment, blueprints: dict[str, Blueprint], parts: dict[str, list[str]]
    ) -> None:
        self.sim = sim
        self.environment = environment
        self.blueprints = blueprints
        self.bodies: dict[str, int] = {}
        self._owners: dict[int, str] = {}
        self._parts = parts
        self._spelled = {meant: said for said, meant in environment.called.items()}

    def keep(self, name: str, body: int) -> None:
        """A body was loaded for an object."""
        self.bodies[name] = body
        self._owners[body] = name

    def index(self) -> None:
        """All bodies are loaded: names of parts and numbers of links are looked up once."""
        self._places: dict[str, tuple[str, str]] = {FLOOR: (FLOOR, ROOT)}
        self._links: dict[tuple[str, str], int] = {(FLOOR, ROOT): -1}
        self._named: dict[tuple[int, int], str] = {}
        for name, blueprint in self.blueprints.items():
            body, model = self.bodies[name], blueprint.model
            self._links[name, ROOT] = -1
            for joint in self.sim.joints(body).values():
                self._links[name, joint.link_name] = joint.index
            self._places[name] = (name, ROOT)
            for part in self._parts[name]:
                self._places[self.named(name, part)] = (name, part)
            for link, part in model.link_parts.items():
                self._named[body, self._links[name, link]] = self.named(name, part)
        for said, meant in self.environment.called.items():
            if said not in self._places:
                self._places[said] = self.where(meant)

    def named(self, whole: str, part: str) -> str:
        """The name of a part of an object; of the object itself where no part is given."""
        usual = f"{whole}_{part}"
        return self._spelled.get(usual, usual) if part else whole

    def place(self, name: str) -> tuple[int, int]:
        """The body and link (−1: the root) of an object or part.

        Raises:
            TmdError: There is no such thing.
        """
        whole, part = self.where(name)
        if whole == FLOOR:
            return self.bodies[FLOOR], -1
        return self.bodies[whole], self.link(whole, self.blueprints[whole].model.part_links.get(part, ROOT))

    def link(self, whole: str, link: str) -> int:
        """The number of a link of an object."""
        return self._links[whole, link]

    def owner(self, body: int, link: int = -1) -> str | None:
        """The object or part that a link belongs to; None for the robot and others that are not of the scene."""
        return self._named.get((body, link), self._owners.get(body))

    def whole(self, name: str) -> str:
        """The object that an object or part belongs to."""
        return self.where(name)[0]

    def where(self, name: str) -> tuple[str, str]:
        """The object, and the part of it (``ROOT``: the whole), that a name means.

        Raises:
            TmdError: There is no such thing.
        """
        if name not in self._places:
            raise TmdError(f"there is no '{name}' in the scene of {self.environment.name}")
        return self._places[name]

    def is_item(self, name: str) -> bool:
        """Whether it can be carried."""
        return name in self.blueprints and self.blueprints[name].sort == "item"

    def items(self) -> list[str]:
        """All items, in file order."""
        return [name for name in self.blueprints if self.is_item(name)]

    def names(self) -> list[str]:
        """All objects and parts, in file order."""
        return [name for name in self._places if name != FLOOR]

    def holds_contents(self, item: str) -> bool:
        """Whether it is a vessel: what is in it is seen."""
        return bool(self.blueprints[item].model.contents)

    def size(self, item: str) -> tuple[Vector, Vector]:
        """The item's box, lower and upper corner, in its own frame."""
        model = self.blueprints[item].model
        return (model.low[0], model.low[1], model.low[2]), (model.high[0], model.high[1], model.high[2])

    def footprint(self, item: str) -> Footprint:
        """The item's rectangle on what it stands on."""
        low, high = self.size(item)
        return (low[0], low[1], high[0], high[1])

    def regions(self, name: str, relation: str | None = None) -> list[tuple[str, Region]]:
        """The regions of an object or part, each with the object; those of one relation if it is given."""
        whole, part = self.where(name)
        if whole == FLOOR:
            return []
        regions = self.blueprints[whole].model.regions
        return [(whole, r) for r in regions if r.part == part and relation in (None, r.relation)]

    def frame(self, whole: str, link: str) -> Pose:
        """Where a link of an object is now."""
        return self.sim.pose(self.bodies[whole], self.link(whole, link))

    def entry(self, name: str, relation: str) -> Vector:
        """The direction in which the gripper comes in there: (0, 0, −1) is from above."""
        for whole, region in self.regions(name, relation):
            return self.frame(whole, region.link).rotate(region.entry)
        return (0.0, 0.0, -1.0)
