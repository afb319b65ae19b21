"""The objects of a scene and their parts: by name, and as the bodies and links of a simulator."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tmd.diagnostics import TmdError
from tmd.robot.assets.features import Grip, Opening, Region
from tmd.robot.assets.shapes import Blueprint, Shapes
from tmd.robot.assets.urdf_builder import ROOT
from tmd.robot.scene.furniture_layout import Footprint
from tmd.robot.sim.pose import Pose, Vector
from tmd.world.classes import ROOT as CLASS_ROOT
from tmd.world.environment import Environment
from tmd.world.folder import DomainFolder

if TYPE_CHECKING:
    from tmd.robot.sim.simulator import Simulator

FLOOR = "floor"
# A thing that is so many times as high as wide falls over.
TALL = 1.2


def built(environment: Environment, folder: DomainFolder) -> tuple[dict[str, Blueprint], dict[str, list[str]]]:
    """Return the blueprint of each object of an environment, and the names of its parts.

    Raises:
        TmdError: A shape makes no sense; with its place in ``objects.yaml``.
    """
    shapes = Shapes(folder)
    classes = {name: entry.class_name for name, entry in environment.objects.items()}
    parts = {
        name: [vertex for vertex in folder.classes.get(kind).vertices if vertex != CLASS_ROOT]
        for name, kind in classes.items()
    }
    return {name: shapes.blueprint(kind) for name, kind in classes.items()}, parts


class Catalogue:
    """The objects of an environment, their blueprints, and the names of their parts."""

    def __init__(self, environment: Environment, blueprints: dict[str, Blueprint], parts: dict[str, list[str]]) -> None:
        self.environment = environment
        self.blueprints = blueprints
        self._places: dict[str, tuple[str, str]] = {FLOOR: (FLOOR, ROOT)}
        for name in blueprints:
            self._places[name] = (name, ROOT)
            for part in parts[name]:
                self._places[self.named(name, part)] = (name, part)

    @staticmethod
    def named(whole: str, part: str) -> str:
        """Return the name of a part of an object; of the object itself if no part is given."""
        return f"{whole}_{part}" if part else whole

    def whole(self, name: str) -> str:
        """Return the object that an object or part belongs to."""
        return self.where(name)[0]

    def where(self, name: str) -> tuple[str, str]:
        """Return the object, and the part of it (``ROOT``: the whole), that a name means.

        Raises:
            TmdError: There is no such thing.
        """
        if name not in self._places:
            raise TmdError(f"there is no '{name}' in the scene of {self.environment.name}")
        return self._places[name]

    def is_item(self, name: str) -> bool:
        """Return whether it can be carried."""
        return name in self.blueprints and self.blueprints[name].sort == "item"

    def items(self) -> list[str]:
        """Return all items, in file order."""
        return [name for name in self.blueprints if self.is_item(name)]

    def names(self) -> list[str]:
        """Return all objects and parts, in file order."""
        return [name for name in self._places if name != FLOOR]

    def holds_contents(self, item: str) -> bool:
        """Return whether it is a vessel with visible contents."""
        return bool(self.blueprints[item].model.contents)

    def opening(self, item: str) -> Opening | None:
        """Return the rim of a vessel; None for a thing that holds nothing or is closed."""
        return self.blueprints[item].model.opening if item in self.blueprints else None

    def spouts(self, whole: str) -> dict[str, Vector]:
        """Return where streams leave an object, in its own frame, by the full name of the part."""
        if whole not in self.blueprints:
            return {}
        return {self.named(whole, part): place for part, place in self.blueprints[whole].model.spouts.items()}

    def stands(self, item: str) -> bool:
        """Return whether it is to be put down upright: vessels, and tall things."""
        model = self.blueprints[item].model
        if model.contents and model.opening is None:
            return False  # a spoon
        depth, width, height = (high - low for low, high in zip(model.low, model.high, strict=True))
        return model.opening is not None or bool(model.regions) or height > TALL * max(depth, width)

    def size(self, item: str) -> tuple[Vector, Vector]:
        """Return the item's box, lower and upper corner, in its own frame."""
        model = self.blueprints[item].model
        return (model.low[0], model.low[1], model.low[2]), (model.high[0], model.high[1], model.high[2])

    def footprint(self, item: str) -> Footprint:
        """Return the item's rectangle on its support."""
        low, high = self.size(item)
        return (low[0], low[1], high[0], high[1])

    def grip(self, whole: str, part: str) -> Grip | None:
        """Return the grip of a part in the frame of its link; None if it has none."""
        return next((g for g in self.blueprints[whole].model.grips if g.part == part), None)

    def frame(self, whole: str, link: str) -> Pose:
        """Return the pose of a link of an object now."""
        raise NotImplementedError

    def pose_of(self, item: str) -> Pose:
        """Return the pose of an object now."""
        raise NotImplementedError

    def top_of(self, item: str) -> float:
        """Return the height of the highest point of an object now."""
        raise NotImplementedError

    def regions(self, name: str, relation: str | None = None) -> list[tuple[str, Region]]:
        """Return the regions of an object or part, of one relation if it is given, each with the object."""
        whole, part = self.where(name)
        if whole == FLOOR:
            return []
        regions = self.blueprints[whole].model.regions
        return [(whole, r) for r in regions if r.part == part and relation in (None, r.relation)]


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
