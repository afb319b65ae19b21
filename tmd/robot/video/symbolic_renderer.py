"""A scene without a simulator: places and looks of everything in a symbolic state.

The shapes, the places and the colours are those of the simulated scene (:mod:`tmd.robot.scene.scene`). The predicates
are read as ``skills.yaml`` says: what the sensor *support* sees is where an item stands, what *joint* sees is a door,
and so on. A picture is made from the one before it, so that what did not change stays where it was.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import atan2

from tmd.pddl.model import State
from tmd.robot.assets.features import mixed
from tmd.robot.assets.urdf_builder import ROOT
from tmd.robot.scene.catalogue import FLOOR, Catalogue, built, free_spots
from tmd.robot.scene.placement import Placing
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.skills.skill_file import Skills
from tmd.world.environment import Environment
from tmd.world.folder import DomainFolder

Colour = tuple[float, float, float, float]
INVISIBLE: Colour = (0.0, 0.0, 0.0, 0.0)
# Metres from a front, or from an item on the floor, to the middle of the robot.
_BEFORE = 0.6
# Places of held things in the robot's frame: in the right hand, in the left.
HANDS = ((0.62, -0.17, 0.95), (0.62, 0.17, 0.95))
_SENSES = ("held", "support", "joint", "setting", "reach")


@dataclass(frozen=True, slots=True)
class Rest:
    """The place of an item: its support, and the pose in the frame of the link that carries it.

    ``link`` is ``None`` for the floor; an item in a hand is at the robot, and ``whole`` is empty.
    """

    at: tuple[str, str]
    whole: str
    link: str | None
    pose: Pose


@dataclass(frozen=True, slots=True)
class Picture:
    """The look of a scene.

    Attributes:
        poses: Of every object.
        joints: Positions of the joints that are not at 0, by object and link; radians or metres.
        colours: Of the links that show a state or a content, by object and link.
        robot: Its pose.
        rests: The place of each item.
        near: The things near the robot.
    """

    poses: Mapping[str, Pose]
    joints: Mapping[tuple[str, str], float]
    colours: Mapping[tuple[str, str], Colour]
    robot: Pose
    rests: Mapping[str, Rest]
    near: frozenset[str] = frozenset()


class Still(Catalogue):
    """Draws the states of an environment; ``skills`` gives the visible meaning of its predicates.

    Attributes:
        room: The places of fixtures and walls.

    Raises:
        TmdError: A shape makes no sense, or something does not fit where it should be.
    """

    def __init__(self, environment: Environment, folder: DomainFolder, skills: Skills) -> None:
        super().__init__(environment, *built(environment, folder))
        placing = Placing(environment, self.blueprints, self.names(), None)
        self.room = placing.room
        self._skills = skills
        self._by_sense = {
            sense: {name for name, each in (*skills.seen.items(), *skills.confirmed.items()) if each == sense}
            for sense in _SENSES
        }
        self._start = self._now = Picture(placing.poses, {}, {}, Pose((0.0, 0.0, 0.0)), {})

    def first(self, state: State) -> Picture:
        """Return the environment as it is at the start."""
        start = replace(self._start, joints=self._joints(state))
        self._now = start
        rests: dict[str, Rest] = {}
        for item, at in self._supports(state).items():
            whole, link = self._carrier(*at)
            frame = self.frame(whole, link) if link is not None else Pose((0.0, 0.0, 0.0))
            rests[item] = Rest(at, whole, link, frame.inverse() * start.poses[item])
        return self.draw(state, replace(start, rests=rests))

    def draw(self, state: State, before: Picture) -> Picture:
        """Return the look of ``state`` after the picture ``before``."""
        held = self._held(state)
        near = frozenset(atom.args[1] for atom in state if atom.predicate in self._by_sense["reach"])
        robot = self._stand(sorted(near - before.near - set(held)), before)
        joints, colours = self._joints(state), self.colours(state)
        self._now = replace(before, joints=joints, colours=colours, robot=robot, near=near)
        supports = self._supports(state)
        rests: dict[str, Rest] = {}
        for item in self.items():
            if item in held:
                hand = Pose(HANDS[min(held.index(item), 1)])
                rests[item] = Rest(("", "held"), "", None, hand)
            elif item in supports:
                rests[item] = self._rest(item, supports[item], before, held)
            elif item in before.rests:
                rests[item] = before.rests[item]
            self._put(item, rests.get(item), robot)
        for item in self.items():  # what stands in something that was moved went along
            self._put(item, rests.get(item), robot)
        self._now = replace(self._now, rests=rests)
        return self._now

    # what is where

    def frame(self, whole: str, link: str) -> Pose:
        """Return the pose of a link of an object in the picture that is being drawn."""
        return self._now.poses[whole] * self.within(whole, link, self._now)

    def within(self, whole: str, link: str, picture: Picture) -> Pose:
        """Return the pose of a link in the frame of its object."""
        joints = {name: position for (owner, name), position in picture.joints.items() if owner == whole}
        return self.blueprints[whole].model.frame(link, joints)

    def pose_of(self, item: str) -> Pose:
        """Return the pose of an object."""
        return self._now.poses[item]

    def top_of(self, item: str) -> float:
        """Return the height of its highest point."""
        return self._now.poses[item].position[2] + self.size(item)[1][2]

    def _rest(self, item: str, at: tuple[str, str], before: Picture, held: list[str]) -> Rest:
        known = before.rests.get(item)
        if known is not None and known.at == at:
            return known
        thing, relation = at
        whole, link = self._carrier(thing, relation)
        frame = self.frame(whole, link) if link is not None else Pose((0.0, 0.0, 0.0))
        spots = free_spots(self, self.room, thing, relation, item, held)
        pose = spots[0].pose if spots else self._above(whole)
        return Rest(at, whole, link, frame.inverse() * pose)

    def _above(self, whole: str) -> Pose:
        """Return a pose on top, if there is no place left, or none of a shape."""
        if whole == FLOOR:
            return Pose((-1.0, 0.0, 0.0))
        x, y, _ = self._now.poses[whole].position
        return Pose((x, y, self.top_of(whole)), self._now.poses[whole].orientation)

    def _carrier(self, thing: str, relation: str) -> tuple[str, str | None]:
        """Return the object, and the link of it, that carries what is at a thing."""
        whole, part = self.where(thing)
        if whole == FLOOR:
            return FLOOR, None
        regions = self.regions(thing, relation)
        return whole, regions[0][1].link if regions else self.blueprints[whole].model.part_links.get(part, ROOT)

    def _put(self, item: str, rest: Rest | None, robot: Pose) -> None:
        if rest is None:
            return
        if rest.at[1] == "held":
            pose = robot * rest.pose
        else:
            pose = self.frame(rest.whole, rest.link) * rest.pose if rest.link is not None else rest.pose
        self._now = replace(self._now, poses={**self._now.poses, item: pose})

    def _stand(self, approached: list[str], before: Picture) -> Pose:
        """Return a pose in front of what the robot is near to now and was not before."""
        if not approached:
            return before.robot
        whole = self.whole(approached[0])
        here = before.poses.get(whole)
        if here is None:
            return before.robot
        carrier = whole
        while carrier in before.rests and before.rests[carrier].link is not None:
            carrier = before.rests[carrier].whole
        if carrier not in self.blueprints or self.is_item(carrier):
            return _facing(here.position, before.robot)
        fixture = before.poses[carrier]
        side = fixture.inverse().apply(here.position)[1] if carrier != whole else 0.0
        front = self.blueprints[carrier].look.size[0] / 2 + _BEFORE
        x, y, _ = fixture.apply((front, side, 0.0))
        return Pose.flat(x, y, 0.0, atan2(*reversed(fixture.rotate((-1.0, 0.0, 0.0))[:2])))

    # what it looks like

    def _supports(self, state: State) -> dict[str, tuple[str, str]]:
        return {
            atom.args[0]: (atom.args[1], atom.args[2])
            for atom in sorted(state)
            if atom.predicate in self._by_sense["support"] and self.is_item(atom.args[0])
        }

    def _held(self, state: State) -> list[str]:
        return sorted(atom.args[1] for atom in state if atom.predicate in self._by_sense["held"])

    def _joints(self, state: State) -> dict[tuple[str, str], float]:
        opened = {atom.args[0] for atom in state if atom.predicate in self._by_sense["joint"]}
        settings = {atom.args[0]: atom.args[1] for atom in sorted(state) if atom.predicate in self._by_sense["setting"]}
        joints: dict[tuple[str, str], float] = {}
        for name in self.names():
            whole, part = self.where(name)
            grip = self.grip(whole, part)
            if grip is not None and grip.kind != "button":
                setting = dict(grip.settings).get(settings.get(name, ""))
                position = setting if setting is not None else grip.open if name in opened else grip.closed
                joints[whole, grip.link] = position
        return joints

    def colours(self, state: State) -> dict[tuple[str, str], Colour]:
        """Return the colours of the links that show a state or a content."""
        contents: dict[str, list[str]] = {}
        for atom in sorted(state):
            if atom.predicate == self._skills.contents and len(atom.args) == 2:
                contents.setdefault(atom.args[0], []).append(atom.args[1])
        signs = {(atom.predicate, atom.args[0]) for atom in state if atom.predicate in self._skills.signs}
        colours: dict[tuple[str, str], Colour] = {}
        for whole, blueprint in self.blueprints.items():
            inside = contents.get(whole, [])
            for link, group in zip(blueprint.model.contents, (inside[:1], inside[1:]), strict=False):
                colours[whole, link] = mixed(group) if group else INVISIBLE
            for lamp in blueprint.model.lamps:
                lit = (lamp.predicate, self.named(whole, lamp.part)) in signs
                colours[whole, lamp.link] = lamp.on if lit else lamp.off
        return colours


def _facing(point: Vector, robot: Pose) -> Pose:
    """Return a pose before a point on the floor, on the side where the robot is."""
    dx, dy = robot.position[0] - point[0], robot.position[1] - point[1]
    away = max((dx * dx + dy * dy) ** 0.5, 1e-6)
    return Pose.flat(point[0] + dx / away * _BEFORE, point[1] + dy / away * _BEFORE, 0.0, atan2(-dy, -dx))
