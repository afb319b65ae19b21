"""An environment as a physical world: its bodies, what can be taken, opened and put on, and what is visible."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from numpy.random import Generator

from tmd.diagnostics import TmdError
from tmd.robot.assets.features import Grasp, mixed
from tmd.robot.assets.urdf_builder import ROOT
from tmd.robot.scene.catalogue import FLOOR, Handle, Inventory, Spot, boxes_meet, built, free_spots, supported
from tmd.robot.scene.furniture_layout import Room, build_room
from tmd.robot.scene.placement import Placing
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.sim.urdf_files import CUBE, cube
from tmd.world.classes import ROOT as CLASS_ROOT
from tmd.world.environment import Environment
from tmd.world.folder import DomainFolder

if TYPE_CHECKING:
    from tmd.robot.sim.simulator import Simulator

__all__ = ["FLOOR", "OVERLAP", "SETTLE", "Handle", "Scene", "Spot"]

# Steps of physics before the scene is ready.
SETTLE = 240
# Metres that two things may be in each other.
OVERLAP = 0.002
# Ticks between two looks at where lids are.
_LIDS_EVERY = 4
# Radians, or metres, that a lid has moved when somebody moved it.
_LID_MOVED = 0.01
_OPENED, _SET_TO, _CONTAINS = "opened", "set_to", "contains"


class Scene(Inventory):
    """All objects of an environment in a simulator, settled by ``settle`` steps of physics.

    ``rng`` moves things by millimetres, so that no two seeds see quite the same scene; without it, places are exact.

    Attributes:
        room: The places of fixtures and walls.
        placed: The pose of every object before physics began.

    Raises:
        TmdError: A shape makes no sense, something does not fit where it should be, or things overlap.
    """

    def __init__(
        self,
        sim: Simulator,
        environment: Environment,
        folder: DomainFolder,
        *,
        rng: Generator | None = None,
        settle: int = SETTLE,
    ) -> None:
        super().__init__(sim, environment, *built(environment, folder))
        self._states = {
            name: {
                vertex.name: dict(vertex.states) for vertex in folder.classes.get(entry.class_name).vertices.values()
            }
            for name, entry in environment.objects.items()
        }
        self._shown: dict[str, tuple[str, ...]] = {}
        # The friction of the joints of items, and where each was when it was last seen to have moved.
        self._lids: dict[tuple[int, str], tuple[float, float]] = {}
        with tempfile.TemporaryDirectory(prefix="tmd-scene-") as directory:
            self._load(Path(directory), rng)
        self.index()
        for name in self.bodies:
            if name != FLOOR:
                self._start(name)
        self._refuse_overlaps()
        sim.add_watcher(self._hold_lids)
        if settle:
            sim.step(settle)

    # ------------------------------------------------------------------ building

    def _load(self, directory: Path, rng: Generator | None) -> None:
        placing = Placing(self.environment, self.blueprints, self.names(), rng)
        self.room: Room = placing.room
        self.placed: dict[str, Pose] = placing.poses
        (directory / CUBE).write_text(cube())
        floor = directory / "room.urdf"
        floor.write_text(build_room(self.room))
        self.keep(FLOOR, self.sim.load(floor, Pose((0.0, 0.0, 0.0)), fixed=True))
        for name, blueprint in self.blueprints.items():
            path = directory / f"{blueprint.class_name}.urdf"
            if not path.exists():
                path.write_text(blueprint.urdf)
            pose = self.placed[name]
            if blueprint.sort == "item":
                # a hair above what it stands on, so that nothing starts inside it
                x, y, z = pose.position
                pose = Pose((x, y, z + 0.001), pose.orientation)
            self.keep(name, self.sim.load(path, pose, fixed=blueprint.sort != "item", own_inertia=True))

    def _start(self, name: str) -> None:
        body, model, entry = self.bodies[name], self.blueprints[name].model, self.environment.objects[name]
        for link in model.links.values():
            if link.spring:
                self.sim.drive_joint(body, link.name, 0.0, link.spring)
            elif link.kind in ("revolute", "prismatic"):
                self.sim.brake_joint(body, link.name, link.friction)
                if self.blueprints[name].sort == "item":
                    self._lids[body, link.name] = (link.friction, math.inf)
        for vertex, usual in self._states[name].items():
            part = ROOT if vertex == CLASS_ROOT else vertex
            states = {**usual, **(entry.states if part == ROOT else entry.parts.get(part, {}))}
            grip = self.grip(name, part)
            if grip is not None and grip.kind != "button":
                setting = dict(grip.settings).get(str(states.get(_SET_TO)))
                position = setting if setting is not None else grip.open if states.get(_OPENED) is True else grip.closed
                self.sim.set_joint(body, grip.link, position)
            whole = self.named(name, part)
            for predicate, value in states.items():
                self.sign(whole, predicate, value is True)
            contained = states.get(_CONTAINS, [])
            if part == ROOT and model.contents:
                one = [contained] if isinstance(contained, str) else []
                self.show(name, contained if isinstance(contained, list) else one)

    def _refuse_overlaps(self) -> None:
        names = list(self.bodies)
        extents = {name: self.sim.extents(self.bodies[name]) for name in names}
        for index, one in enumerate(names):
            for other in names[index + 1 :]:
                if not boxes_meet(extents[one], extents[other]):
                    continue
                near = self.sim.closest(self.bodies[one], self.bodies[other], 0.0)
                depth = max((-c.distance for c in near), default=0.0)
                if depth > OVERLAP:
                    guilty = other if self.environment.objects[other].position or one == FLOOR else one
                    both = f"'{other}' and the floor or a wall" if one == FLOOR else f"'{one}' and '{other}'"
                    message = f"{both} are in each other by {depth * 1000:.0f} mm"
                    hint = "give other positions, or leave them out: then places are found"
                    raise self.environment.source.error(("objects", guilty, "position"), message, hint, "overlap")

    # ------------------------------------------------------------------ where things may stand, and stand

    def support(self, name: str, relation: str, item: str | None = None, held: Collection[str] = ()) -> list[Spot]:
        """Return free places: see :func:`tmd.robot.scene.catalogue.free_spots`."""
        return free_spots(self, self.room, name, relation, item, held)

    def supported(self, item: str) -> tuple[str, str] | None:
        """Return what an item is at: see :func:`tmd.robot.scene.catalogue.supported`."""
        return supported(self, item)

    # ------------------------------------------------------------------ what can be taken and worked

    def grasps(self, item: str) -> Sequence[Grasp]:
        """Return the grasps of an item: ``Grasp.tool.pose()`` is in the item's frame."""
        return self.blueprints[item].model.grasps

    def spring_open(self, name: str) -> None:
        """Let a door that has been unlatched swing open by itself."""
        handle = self.handle(name)
        if handle is None:
            raise TmdError(f"'{name}' has no joint")
        self.sim.drive_joint(handle.body, handle.joint, handle.open, 2.0, 1.2)

    def calm(self, name: str) -> None:
        """Leave a joint to its own friction again, after :meth:`spring_open` or a drive."""
        whole, part = self.where(name)
        grip = self.grip(whole, part)
        if grip is not None:
            self.sim.brake_joint(self.bodies[whole], grip.link, self.blueprints[whole].model.links[grip.link].friction)

    def _hold_lids(self, sim: Simulator) -> None:
        """Keep the lids of items where they were left.

        A brake lets a lid of ten grams on a carton that hangs on a heavy arm creep by three degrees a second, for the
        solver does not get to the end of so light a thing. A motor that holds its place with no more than the friction
        does not; what moves it farther than that moves its place as well.
        """
        if sim.ticks % _LIDS_EVERY:
            return
        for (body, joint), (friction, place) in self._lids.items():
            now = sim.joint_position(body, joint)
            if abs(now - place) > _LID_MOVED:
                self._lids[body, joint] = friction, now
                sim.drive_joint(body, joint, now, friction)

    # ------------------------------------------------------------------ what it shows

    def show(self, name: str, substances: Sequence[str]) -> None:
        """Show the contents of a vessel: the first substance fills it, the others lie on top."""
        whole, _ = self.where(name)
        model, body = self.blueprints[whole].model, self.bodies[whole]
        groups = [list(substances[:1]), list(substances[1:])]
        self._shown[name] = tuple(substances)
        for link, group in zip(model.contents, groups, strict=False):
            colour = mixed(group) if group else (0.0, 0.0, 0.0, 0.0)
            self.sim.colour(body, self.link(whole, link), colour)

    def shown(self, name: str) -> tuple[str, ...]:
        """Return the visible contents of a vessel."""
        return self._shown.get(name, ())

    def filled(self) -> list[str]:
        """Return the items with visible contents, in file order."""
        return [name for name in self.blueprints if self._shown.get(name) and self.is_item(name)]

    def sign(self, name: str, predicate: str, on: bool) -> None:
        """Show a state, if there is a sign for it: a burner glows, the tap runs, the microwave is lit."""
        whole, part = self.where(name)
        if whole == FLOOR:
            return
        for lamp in self.blueprints[whole].model.lamps:
            if lamp.part == part and lamp.predicate == predicate:
                self.sim.colour(self.bodies[whole], self.link(whole, lamp.link), lamp.on if on else lamp.off)

    def viewpoint(self) -> tuple[Vector, Vector]:
        """Return eye and target of a camera that sees the whole room."""
        return (self.room.low[0] - 0.9, 0.0, 3.4), (0.5, 0.0, 0.4)
