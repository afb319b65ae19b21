"""The poses of all objects of an environment: positions that it gives, else free places."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from math import radians

from numpy.random import Generator

from tmd.diagnostics import TmdError
from tmd.robot.assets.features import Region
from tmd.robot.assets.shapes import Blueprint
from tmd.robot.assets.urdf_builder import ROOT
from tmd.robot.scene.furniture_layout import Footprint, Room, apart, arrange, floor_spots, inside, room_of
from tmd.robot.sim.pose import Pose
from tmd.world.environment import Environment

# Between items, the first that fits.
GAPS = (0.1, 0.07, 0.05)
# Turns of things that do not fit with their front to the front, in radians.
TURNS = (0.0, 0.8, -0.8, 1.57, -1.57)
# Items from this height on stand behind the lower ones.
TALL = 0.12
JITTER = 0.003
_OPEN = "opened"
# Footprint of the robot.
_ROBOT: Footprint = (-0.35, -0.35, 0.35, 0.35)


class Placing:
    """The poses of all objects of an environment.

    ``names`` are all objects and parts, with a shape or without; ``rng`` moves items by millimetres.

    Attributes:
        room: The fixtures' poses and the walls.

    Raises:
        TmdError: Something does not fit where it should be; with its place in the environment's file.
    """

    def __init__(
        self,
        environment: Environment,
        blueprints: Mapping[str, Blueprint],
        names: Collection[str],
        rng: Generator | None,
    ) -> None:
        self._environment = environment
        self._names = names
        self._blueprints = blueprints
        self._rng = rng
        self.room = self._room()
        self.poses: dict[str, Pose] = dict(self.room.poses)
        self._footprints: dict[str, Footprint] = {n: _footprint(b) for n, b in blueprints.items()}
        self._standing: list[tuple[str, str]] = []
        for tall in (True, False):
            for name, blueprint in blueprints.items():
                if blueprint.sort == "item" and (blueprint.model.high[2] >= TALL) == tall:
                    self._place(name)
        self.poses = {name: self.poses[name] for name in blueprints}

    def _room(self) -> Room:
        sizes: dict[str, tuple[float, float]] = {}
        given: dict[str, Pose] = {}
        for name, blueprint in self._blueprints.items():
            if blueprint.sort == "item":
                continue
            entry = self._environment.objects[name]
            if entry.position is None:
                if entry.yaw is not None:
                    message = f"'{name}' has a yaw and no position"
                    raise self._error(name, message, "say its `position:` too, or leave the yaw out", "yaw")
                sizes[name] = (blueprint.look.size[0], blueprint.look.size[1])
            else:
                given[name] = _facing_the_middle(entry.position[0], entry.position[1])
                if entry.yaw is not None:
                    given[name] = Pose.flat(entry.position[0], entry.position[1], 0.0, radians(entry.yaw))
        room = arrange(sizes)
        if self._environment.room:
            return self._walled(Room({**room.poses, **given}, room.low, room.high))
        if not given:
            return room
        far = [0.0, 0.0]
        for name, pose in given.items():
            x0, y0, x1, y1 = _footprint(self._blueprints[name])
            corners = [pose.apply((x, y, 0.0)) for x in (x0, x1) for y in (y0, y1)]
            for axis in (0, 1):
                reach = max(abs(corner[axis]) for corner in corners) + 0.05
                far[axis] = max(far[axis], abs(pose.position[axis]) + 0.6, reach)
        low = (min(room.low[0], -far[0]), min(room.low[1], -far[1]))
        high = (max(room.high[0], far[0]), max(room.high[1], far[1]))
        return Room({**room.poses, **given}, low, high)

    def _walled(self, arranged: Room) -> Room:
        source = self._environment.source
        try:
            empty = room_of(self._environment.room)
        except ValueError as error:
            raise source.error(
                ("room",), f"this is not a room: {error}", "give its corners in order, in metres"
            ) from None
        if not empty.holds(Pose((0.0, 0.0, 0.0)), _ROBOT):
            hint = "the robot starts at x = 0, y = 0; a room around that has space for it"
            raise source.error(("room",), "the robot does not fit into the room where it starts", hint, "no-room")
        for name, pose in arranged.poses.items():
            if not empty.holds(pose, _footprint(self._blueprints[name])):
                x, y, _ = pose.position
                message = f"'{name}' is not within the walls of the room at {x:.2f} {y:.2f}"
                hint = "give it a `position:` and a `yaw:` within them, or move the walls"
                said = self._environment.objects[name].position is not None
                raise self._error(name, message, hint, "position" if said else None)
        return Room(arranged.poses, empty.low, empty.high, empty.corners)

    def _place(self, name: str) -> None:
        entry = self._environment.objects[name]
        if entry.position is not None:
            x, y, z = entry.position
            self.poses[name] = Pose.flat(x, y, z, radians(entry.yaw or 0.0))
            if self.room.corners and not self.room.holds(self.poses[name], self._footprints[name]):
                message = f"'{name}' is not within the walls of the room"
                raise self._error(name, message, "give another position, or move the walls", "position")
            self._standing.append((name, ""))
            return
        relation, where = (entry.at or "on floor").split()
        own = self._footprints[name]
        if where == "floor":
            taken = [(self.poses[n], self._footprints[n]) for n, w in self._standing if w == "floor"]
            taken += [(p, self._footprints[n]) for n, p in self.room.poses.items()]
            spots = floor_spots(self.room, taken, own)
            if not spots:
                raise self._error(name, f"there is no room left on the floor for '{name}'", None)
            turned = Pose.flat(*spots[0].position, radians(entry.yaw)) if entry.yaw is not None else spots[0]
            self.poses[name] = self._shifted(turned)
            self._standing.append((name, where))
            return
        whole, part = self._split(name, where)
        for gap in GAPS:
            pose = self._free(name, whole, part, relation, gap)
            if pose is not None:
                self.poses[name] = self._shifted(pose)
                self._standing.append((name, where))
                return
        if not any(r.part == part and r.relation == relation for r in self._blueprints[whole].model.regions):
            message = f"nothing can be {relation} '{where}': its shape has no such place"
            raise self._error(name, message, "say a fitting `shape:` in objects.yaml (docs/scenes.md)")
        hint = "make it larger by `size:` in objects.yaml, or put things elsewhere"
        raise self._error(name, f"'{name}' finds no room {relation} '{where}'", hint)

    def _free(self, name: str, whole: str, part: str, relation: str, gap: float) -> Pose | None:
        """Return the first free spot; tall things take the rear row first, low ones the front row."""
        blueprint, own = self._blueprints[name], self._footprints[name]
        high, said = blueprint.model.high[2], self._environment.objects[name].yaw
        for region in self._blueprints[whole].model.regions:
            if region.part != part or region.relation != relation or region.low[2] + high > region.high[2]:
                continue
            frame = self._frame(whole, region)
            spots = list(region.spots)
            if high >= TALL:
                spots.sort(key=lambda spot: spot[0])
            for turned in TURNS if said is None else TURNS[:1]:
                for x, y, z, yaw in spots:
                    pose = frame * Pose.flat(x, y, z, yaw + turned)
                    if said is not None:
                        pose = Pose.flat(*pose.position, radians(said))
                    if inside(pose, own, region.low, region.high, frame, region.overhang) and all(
                        apart(pose, own, self.poses[other], self._footprints[other], gap)
                        for other, _ in self._standing
                        if abs(self.poses[other].position[2] - pose.position[2]) < 0.25
                    ):
                        return pose
        return None

    def _frame(self, whole: str, region: Region) -> Pose:
        """Return the region's frame at the start: a drawer may be open."""
        model, pose = self._blueprints[whole].model, self.poses[whole]
        frame = pose * model.frame(region.link)
        link = model.links[region.link]
        if link.kind == "prismatic" and self._environment.objects[whole].states.get(_OPEN) is True:
            way = next((g.open for g in model.grips if g.link == region.link), 0.0)
            x, y, z = link.axis
            frame = frame * Pose((x * way, y * way, z * way))
        return frame

    def _shifted(self, pose: Pose) -> Pose:
        if self._rng is None:
            return pose
        dx, dy = (float(value) for value in self._rng.uniform(-JITTER, JITTER, 2))
        return pose.moved((dx, dy, 0.0))

    def _split(self, name: str, where: str) -> tuple[str, str]:
        for whole in self._blueprints:
            if where == whole:
                return whole, ROOT
            model, part = self._blueprints[whole].model, where.removeprefix(f"{whole}_")
            if part != where and part in (*model.part_links, *(region.part for region in model.regions)):
                return whole, part
        if where in self._names:
            message = f"'{where}', where '{name}' is to be, has no shape of its own in the scene"
            raise self._error(name, message, "say a fitting `shape:` in objects.yaml (docs/scenes.md)")
        raise self._error(name, f"there is no '{where}' that '{name}' could be at", None)

    def _error(self, name: str, message: str, hint: str | None, key: str | None = "at") -> TmdError:
        path = ("objects", name) if key is None else ("objects", name, key)
        return self._environment.source.error(path, message, hint, "no-room")


def _footprint(blueprint: Blueprint) -> Footprint:
    model = blueprint.model
    return (model.low[0], model.low[1], model.high[0], model.high[1])


def _facing_the_middle(x: float, y: float) -> Pose:
    """Return the pose of a fixture that looks along the axis that leads most straight to the middle of the room."""
    if abs(x) >= abs(y):
        return Pose.flat(x, y, 0.0, 3.141592653589793 if x > 0 else 0.0)
    return Pose.flat(x, y, 0.0, -1.5707963267948966 if y > 0 else 1.5707963267948966)
