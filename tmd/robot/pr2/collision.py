"""Collision checks of a robot in configurations other than the present one.

Two phases. Boxes around links are moved in numpy, for a whole batch of configurations: most are free after that. Only
where boxes overlap are the joints set in the simulator and distances asked for, link by link; afterwards everything
is put back to the bit. No step is made, so physics does not notice.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, TypeAlias

import numpy as np

from tmd.robot.parameters import CONTACT
from tmd.robot.pr2.kinematics import Array, Tree, motion, shape_points
from tmd.robot.pr2.urdf import TOOL, RobotDescription
from tmd.robot.sim.pose import Pose, Vector

if TYPE_CHECKING:
    from tmd.robot.sim.simulator import Simulator

# The robot's link (a tool frame stands for what that hand holds), what it touches (body, link), and how deep.
Collision: TypeAlias = tuple[str, int, int, float]
# Bodies and links that may be touched; None: all links of the body.
Ignored: TypeAlias = Collection[tuple[int, int | None]]


@dataclass(frozen=True, slots=True)
class Held:
    """A body in a hand; ``grip`` is the body's frame in the tool frame."""

    body: int
    side: str
    grip: Pose


@dataclass(frozen=True, slots=True)
class LinkBox:
    """A box in the frame of a link: centre and half of the edges, (3,) each."""

    centre: Array
    half: Array


# Microseconds of comparing boxes, about: for a batch, and for each configuration in it.
_BATCH_WORK = (130, 8)


class CollisionModel(Protocol):
    """The part of a robot that collision checking needs; attributes as those of :class:`~tmd.robot.pr2.pr2.Pr2`."""

    sim: Simulator
    tree: Tree
    boxes: dict[str, LinkBox]
    model: RobotDescription
    body: int
    index: dict[str, int]
    joint_index: dict[str, int]
    movable: list[int]

    def positions(self) -> dict[str, float]:
        """Return the positions of all joints that move, by name."""

    def helds(self) -> list[Held]:
        """Return what the hands hold."""


class CollisionChecker:
    """Collision checks for configurations that differ in some joints.

    Use it as a context: when it is left, the robot is where it was. The other bodies must not move meanwhile.

    Args:
        robot: The robot.
        vary: Names of the joints that the configurations give, in order; each below the one before.
        positions: Of other joints, if not the present ones.
        arm: Check only the links of this arm (and what it holds); else all links.
        helds: The contents of the hands; None: what the robot holds.
        ignore: (body, link) that may be touched.
        margin: Metres to keep away.
    """

    def __init__(
        self,
        robot: CollisionModel,
        vary: Sequence[str],
        *,
        positions: Mapping[str, float] | None = None,
        arm: str | None = None,
        helds: Sequence[Held] | None = None,
        ignore: Ignored = (),
        margin: float = 0.0,
    ) -> None:
        self._robot = robot
        self.sim = robot.sim
        self._margin = margin
        self._ignore = frozenset(ignore)
        self._vary = tuple(vary)
        everything = robot.helds() if helds is None else helds
        self._helds = [held for held in everything if arm in (None, held.side)]
        self._others = [held for held in everything if held not in self._helds]
        self._undo = ExitStack()
        # Allowed depths of pairs in each other; other pairs may not touch.
        self.allowed: dict[tuple[str, int, int], float] = {}
        self._ends: list[tuple[Array, Array, dict[tuple[str, int, int], float]]] = []
        tree = robot.tree
        top = tree.root if arm is None else f"{arm[0]}_shoulder_pan_link"
        below = [name for name in tree.below(top) if name in robot.boxes]
        self._positions = robot.positions() | dict(positions or {})
        frames = tree.forward(self._positions, tree.links, {tree.root: np.eye(4)})
        self._chain(tree, frames, below)
        self._links = below
        self._boxes = [robot.boxes[name] for name in below]
        for held in self._helds:
            self._add_held(held, tree, frames)
        self._centres = np.array([box.centre for box in self._boxes])
        self._halves = np.array([box.half for box in self._boxes])
        self._places = {
            held.body: Pose.from_matrix(frames[f"{held.side[0]}_{TOOL}"]) * held.grip for held in self._others
        }
        self._obstacles = self._find_obstacles()
        self._lower = np.array([lower for _, _, lower, _ in self._obstacles]).reshape(-1, 3)
        self._upper = np.array([upper for _, _, _, upper in self._obstacles]).reshape(-1, 3)
        self._pairs = self._self_pairs(frames)

    def __enter__(self) -> CollisionChecker:
        sim, body, joints = self.sim, self._robot.body, self._robot.movable
        positions, velocities = sim.joint_states(body, joints)
        for held in (*self._helds, *self._others):
            self._undo.callback(sim.set_motion, held.body, sim.motion(held.body))
        self._undo.callback(sim.set_joints, body, joints, positions, velocities)
        self._set(self._positions)
        for moved_along, place in self._places.items():
            sim.set_pose(moved_along, place)
        return self

    def __exit__(self, *_: object) -> None:
        self._undo.close()

    # set-up

    def _chain(self, tree: Tree, frames: Mapping[str, Array], below: Sequence[str]) -> None:
        """Split the tree at the joints that vary: the links between two of them are rigid."""
        carriers = [next(link for link in tree.links.values() if link.joint == joint) for joint in self._vary]
        self._carriers = carriers
        self._fixed = []  # from the frame of one varying link to the joint of the next
        previous = np.eye(4)
        for link in carriers:
            self._fixed.append(np.linalg.inv(previous) @ frames[link.parent] @ link.origin)
            previous = frames[link.name]
        self._rank = {tree.root: -1}
        names = {link.name: index for index, link in enumerate(carriers)}
        for name, link in tree.links.items():
            self._rank[name] = names.get(name, self._rank[link.parent])
        self._groups = [self._rank[name] + 1 for name in below]
        tops = [np.eye(4), *(frames[link.name] for link in carriers)]
        self._inverse = [np.linalg.inv(top) for top in tops]
        self._relative = [self._inverse[group] @ frames[name] for group, name in zip(self._groups, below, strict=True)]

    def _add_held(self, held: Held, tree: Tree, frames: Mapping[str, Array]) -> None:
        tool = f"{held.side[0]}_{TOOL}"
        group = self._rank[tool] + 1
        self._links = [*self._links, tool]
        self._groups.append(group)
        self._relative.append(self._inverse[group] @ frames[tool] @ held.grip.homogeneous())
        self._boxes.append(box_of(self.sim, held.body))

    def _find_obstacles(self) -> list[tuple[int, int, Vector, Vector]]:
        sim = self.sim
        taken = {self._robot.body, *(held.body for held in self._helds)}
        found = []
        for body in sim.bodies():
            if body in taken or (body, None) in self._ignore:
                continue
            if body in self._places:  # in the other hand: it goes where the robot goes
                low, high = moved(box_of(sim, body), self._places[body].homogeneous()[None])
                found.append((body, -1, tuple(low[0]), tuple(high[0])))
                continue
            for link in sim.solid_links(body):
                if (body, link) not in self._ignore:
                    found.append((body, link, *sim.extents(body, link)))
        return found

    def _self_pairs(self, frames: Mapping[str, Array]) -> list[tuple[int, int | str]]:
        """Return pairs of own links to check: a mover's number, and a mover's number or a resting link's name."""
        result = list(self._moving_pairs())
        resting = dict.fromkeys(other for _, other in result if isinstance(other, str))
        boxes = [moved(self._robot.boxes[name], frames[name][None]) for name in resting]
        self._resting = tuple(np.array([box[end][0] for box in boxes]).reshape(-1, 3) for end in (0, 1))
        place = {name: len(self._links) + row for row, name in enumerate(resting)}
        self._first = np.array([mover for mover, _ in result], dtype=int)
        self._second = np.array([o if isinstance(o, int) else place[o] for _, o in result], dtype=int)
        return result

    def _moving_pairs(self) -> Iterator[tuple[int, int | str]]:
        """Yield the pairs of links that may touch: not neighbours, and not what is held with its hand."""
        number = {name: index for index, name in enumerate(self._links)}
        below = self._robot.tree.below
        hands = {f"{held.side[0]}_{TOOL}": set(below(f"{held.side[0]}_wrist_flex_link")) for held in self._helds}
        for index, name in enumerate(self._links):
            for other in self._robot.boxes:
                second = number.get(other, -1)
                if name in hands:
                    near = other in hands[name]
                else:
                    near = (name, other) in self._robot.model.disabled or 0 <= second <= index
                # two movers of one group never move against one another
                rigid = self._vary and second >= 0 and self._groups[second] == self._groups[index]
                if not near and not rigid:
                    yield index, second if second >= 0 else other

    def allow(self, ends: Sequence[tuple[Array, float]], near: Array | None = None) -> bool:
        """Allow what is near at the ends of a way to be as near as it is there; return False if an end is too deep.

        Args:
            ends: Configurations, each with how deep it may be in something, in metres.
            near: Distance of each joint from an end within which that holds; what touches there is apart elsewhere, so
                that it is neither dragged along nor pushed on. None: it holds all the way.
        """
        self.allowed.clear()
        self._ends.clear()
        for end, deepest in ends:
            found = {(name, body, link): depth + 1e-3 for name, body, link, depth in self.collisions(end.tolist())}
            if any(depth > deepest + 1e-3 for depth in found.values()):
                return False
            if near is not None:
                self._ends.append((end, near, found))
            for pair, depth in found.items():
                elsewhere = depth if near is None else min(depth, -CONTACT.apart)
                self.allowed[pair] = max(self.allowed.get(pair, -np.inf), elsewhere)
        return True

    def touching(self) -> bool:
        """Return whether anything at the ends given to :meth:`allow` is nearer than it should be elsewhere."""
        return any(depth > -CONTACT.apart for _, _, pairs in self._ends for depth in pairs.values())

    # checks

    def frames(self, configurations: Array) -> Array:
        """Return the frames of the checked links in the world: (n, links, 4, 4) for configurations (n, joints)."""
        count = len(configurations)
        frame = np.broadcast_to(np.eye(4), (count, 4, 4))
        tops = [frame]
        for index, link in enumerate(self._carriers):
            frame = frame @ self._fixed[index] @ motion(link, configurations[:, index])
            tops.append(frame)
        result: Array = np.stack(tops, axis=1)[:, self._groups] @ np.array(self._relative)
        return result

    def collisions(self, configuration: Sequence[float]) -> list[Collision]:
        """Return everything that one configuration touches, deepest first."""
        batch = np.asarray(configuration, dtype=float).reshape(1, -1)
        frames = self.frames(batch)
        pairs = self._candidates(frames)[0]
        found = self._narrow(batch[0], frames[0], pairs, every=True)
        return sorted(found, key=lambda each: (-each[3], each[:3]))

    def free(self, configurations: Array, closer: float = 0.0) -> bool:
        """Return whether none of (n, joints) touches anything, with a margin that is smaller by ``closer`` metres."""
        frames = self.frames(configurations)
        candidates = self._candidates(frames)
        busy = [index for index, pairs in enumerate(candidates) if pairs]
        # the middle first: neighbours tell the same
        for index in sorted(busy, key=lambda each: _spread(each, len(candidates))):
            if self._narrow(configurations[index], frames[index], candidates[index], every=False, closer=closer):
                return False
        return True

    def each_free(self, configurations: Array) -> list[bool]:
        """Return for each of (n, joints) whether it touches nothing."""
        frames = self.frames(configurations)
        return [
            not self._narrow(configuration, frame, pairs, every=False)
            for configuration, frame, pairs in zip(configurations, frames, self._candidates(frames), strict=True)
        ]

    def apart(self, configurations: Array) -> list[bool]:
        """Return for each of (n, joints) whether not even boxes overlap: then it is free, else nothing is known."""
        return [not pairs for pairs in self._candidates(self.frames(configurations))]

    def _candidates(self, frames: Array) -> list[list[tuple[int, int, int]]]:
        """Return for each configuration the pairs that may touch: (mover, body, link)."""
        self.sim.work += _BATCH_WORK[0] + _BATCH_WORK[1] * len(frames)
        centres = (frames[..., :3, :3] @ self._centres[:, :, None])[..., 0] + frames[..., :3, 3]
        halves = (np.abs(frames[..., :3, :3]) @ self._halves[:, :, None])[..., 0] + self._margin
        lower, upper = centres - halves, centres + halves
        result: list[list[tuple[int, int, int]]] = [[] for _ in range(len(frames))]
        near = np.all((lower[:, :, None] <= self._upper) & (upper[:, :, None] >= self._lower), axis=3)
        for row, mover, obstacle in np.argwhere(near):
            body, link, *_ = self._obstacles[obstacle]
            result[row].append((int(mover), body, link))
        low, high = (
            np.concatenate([own, np.broadcast_to(rest, (len(frames), *rest.shape))], axis=1)
            for own, rest in zip((lower, upper), self._resting, strict=True)
        )
        meeting = np.all(
            (lower[:, self._first] <= high[:, self._second]) & (upper[:, self._first] >= low[:, self._second]), axis=2
        )
        for row, pair in np.argwhere(meeting):
            mover, other = self._pairs[pair]
            name = self._links[other] if isinstance(other, int) else other
            result[row].append((mover, self._robot.body, self._robot.index[name]))
        return result

    def _narrow(
        self,
        configuration: Array,
        frames: Array,
        pairs: Sequence[tuple[int, int, int]],
        *,
        every: bool,
        closer: float = 0.0,
    ) -> list[Collision]:
        if not pairs:
            return []
        self._set(dict(zip(self._vary, configuration, strict=True)))
        allowed = self._allowed_at(configuration)
        first = len(self._links) - len(self._helds)
        for held, frame in zip(self._helds, frames[first:], strict=True):
            self.sim.set_pose(held.body, Pose.from_matrix(frame))
        found = []
        for mover, body, link in pairs:
            name = self._links[mover]
            if mover >= first:
                points = self.sim.closest(self._helds[mover - first].body, body, self._margin, other_link=link)
            else:
                points = self.sim.closest(self._robot.body, body, self._margin, self._robot.index[name], link)
            depth = max((-point.distance for point in points), default=-np.inf)
            if depth > allowed.get((name, body, link), CONTACT.touch - self._margin) + closer:
                found.append((name, body, link, float(depth)))
                if not every:
                    break
        return found

    def _allowed_at(self, configuration: Array) -> dict[tuple[str, int, int], float]:
        """Return the allowed depths of pairs in a configuration: more near the ends of a way."""
        found = self.allowed
        for end, near, pairs in self._ends:
            if np.all(np.abs(configuration - end) <= near):
                found = found | {pair: max(depth, found.get(pair, -np.inf)) for pair, depth in pairs.items()}
        return found

    def _set(self, positions: Mapping[str, float]) -> None:
        joints = [self._robot.joint_index[name] for name in positions]
        self.sim.set_joints(self._robot.body, joints, [float(value) for value in positions.values()])


def link_boxes(root: ET.Element) -> dict[str, LinkBox]:
    """Return boxes around the collision shapes of a URDF's links, without links with cylinders or spheres."""
    result = {}
    for link in root.findall("link"):
        shapes = link.findall("collision")
        if shapes and all({"mesh", "box"} & {each.tag for each in shape.iterfind("geometry/*")} for shape in shapes):
            points = np.vstack([shape_points(each) for each in shapes])
            low, high = points.min(axis=0), points.max(axis=0)
            result[link.get("name", "")] = LinkBox((low + high) / 2, (high - low) / 2)
    return result


def box_of(sim: Simulator, body: int) -> LinkBox:
    """Return a box round a body, in the frame of its root."""
    lower, upper = sim.extents(body)
    corners = np.array(
        [[x, y, z] for x in (lower[0], upper[0]) for y in (lower[1], upper[1]) for z in (lower[2], upper[2])]
    )
    back = sim.pose(body).inverse().homogeneous()
    inside = corners @ back[:3, :3].T + back[:3, 3]
    low, high = inside.min(axis=0), inside.max(axis=0)
    return LinkBox((low + high) / 2, (high - low) / 2)


def moved(box: LinkBox, frames: Array) -> tuple[Array, Array]:
    """Return the least and the greatest corner of boxes round ``box`` at (n, 4, 4) frames: (n, 3) each."""
    centre = frames[:, :3, :3] @ box.centre + frames[:, :3, 3]
    half = np.abs(frames[:, :3, :3]) @ box.half
    return centre - half, centre + half


def _spread(index: int, count: int) -> int:
    """Return a rank that takes far apart numbers first: the bits of the number, mirrored."""
    bits = max(1, (count - 1).bit_length())
    return int(format(index, f"0{bits}b")[::-1], 2)
