"""The objects of a scene and their parts by name, without a simulator."""

from __future__ import annotations

from tmd.diagnostics import TmdError
from tmd.robot.assets.features import Grip, Opening, Region
from tmd.robot.assets.shapes import Blueprint, Shapes
from tmd.robot.assets.urdf_builder import ROOT
from tmd.robot.scene.furniture_layout import Footprint
from tmd.robot.sim.pose import Pose, Vector
from tmd.world.classes import ROOT as CLASS_ROOT
from tmd.world.environment import Environment
from tmd.world.folder import DomainFolder

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
