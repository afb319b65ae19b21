"""Robot and scene together: the context of skills, and the measurements of the monitor."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field
from math import acos, cos, degrees, hypot, inf, sin
from pathlib import Path

import numpy as np

from tmd.pddl.model import GroundAtom
from tmd.robot.parameters import ARTICULATION, BASE_MOTION, CONTACT, GRASP, INSTRUCTION_TIME
from tmd.robot.pr2.arm_motion import plan_line, tuck
from tmd.robot.pr2.base_motion import plan_base
from tmd.robot.pr2.collision import Ignored
from tmd.robot.pr2.pr2 import ARMS, Pr2
from tmd.robot.scene.scene import FLOOR, Handle, Scene
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.sim.simulator import STEPS_PER_SECOND, WELD_FORCE, Simulator
from tmd.robot.skills.results import SkillError, SkillPhase

# Pose of the robot's base: x, y in metres, heading in radians.
Base = tuple[float, float, float]
# Metres that it is moved across the plane of its fingers, where they stand on both sides of a lid.
_PAST = tuple((0.0, 0.0, away) for away in (0.1, -0.1, 0.05, -0.05))
# Samples for a way of the arm where there is no other place to tuck it.
_LONG = 2000
_NEARBY = 300
# Steps between two looks at what leans.
_LEANING_EVERY = 8
# Radians below which nothing leans.
_LEVEL = 0.05


def _nothing(*_: object) -> None: ...


@dataclass(eq=False)
class Cell:
    """One robot in one scene.

    Attributes:
        in_hand: The item in each arm.
        over_rim: For things that may lean now, whether nothing is lost where the mouth is.
        unfit_spots: Poses of items when something could not be done with them.
        unfit_grips: Tool poses in the item's frame then, or when its contents were lost.
        way_in: Positions of each arm on its last straight way.
        until: The simulation's count of work at which an instruction is given up.
        moment: Called at the event of an instruction: a press, a pour, a turn.
        rejected: Called with ways that were rejected, when something fails and the reason is looked for: what is where
            it cannot be, the things that it would be in, positions of the robot's joints, and the arm and pose of a
            hand that is in something wherever the robot stands.
    """

    sim: Simulator
    robot: Pr2
    scene: Scene
    rng: np.random.Generator
    in_hand: dict[str, str] = field(default_factory=dict)
    over_rim: dict[str, Callable[[], bool]] = field(default_factory=dict)
    unfit_spots: dict[str, list[Pose]] = field(default_factory=dict)
    unfit_grips: dict[str, list[Pose]] = field(default_factory=dict)
    way_in: dict[str, list[tuple[float, ...]]] = field(default_factory=dict)
    until: float = inf
    moment: Callable[[], None] = _nothing
    rejected: Callable[[str, frozenset[str], Mapping[str, float], tuple[str, Pose] | None], None] = _nothing
    _leant: dict[str, float] = field(default_factory=dict)
    _loaded: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.sim.add_watcher(self._watch_leaning)
        self.robot.keeps_level = self._keeps_level

    def _keeps_level(self, side: str) -> bool | None:
        """Return True for a full thing, False for one that can hold something, None for what lies in the hand."""
        item = self.in_hand.get(side)
        if item is None or self.tilt(item) > CONTACT.upright or self.robot.held(side) is None:
            return None
        full = bool(self.scene.shown(item)) or item in self._loaded
        return full and self.spills_from(item) is not None if full or self.scene.stands(item) else None

    def look_on(self, doing: str) -> None:
        """Limit the cost of what is being looked for.

        Raises:
            SkillError: The instruction has used up its budget.
        """
        if self.sim.work > self.until:
            raise SkillError(SkillPhase.TIME, f"given up after about {INSTRUCTION_TIME:.0f} s of computing: {doing}")

    # what the monitor measures

    def seconds(self) -> float:
        """Return the simulated seconds since the scene was made."""
        return self.sim.steps / STEPS_PER_SECOND

    def tilt(self, item: str) -> float:
        """Return the radians between an item's upright axis and the vertical."""
        return acos(max(-1.0, min(1.0, self.sim.pose(self.scene.bodies[item]).rotate((0.0, 0.0, 1.0))[2])))

    def fallen(self, item: str) -> bool:
        """Return whether an item that should stand leans or lies; not on the floor, in a heap, or behind a door."""
        if not self.scene.is_item(item) or not self.scene.stands(item) or self.tilt(item) <= CONTACT.upright:
            return False
        place = None if item in self.in_hand.values() else self.support(item)
        if place is None or place == (FLOOR, "on") or any(region.heap for _, region in self.scene.regions(*place)):
            return False
        return not self._shut_in(place)

    def _shut_in(self, place: tuple[str, str]) -> bool:
        whole, relation = self.whole(place[0]), place[1]
        parts = (self.scene.named(whole, grip.part) for grip in self.scene.blueprints[whole].model.grips)
        return relation == "in" and any(self.is_open(part) is False for part in parts)

    def _watch_leaning(self, sim: Simulator) -> None:
        """Remember how far vessels with contents leaned."""
        if sim.ticks % _LEANING_EVERY and not self.robot.kinematic:
            return
        for item in dict.fromkeys((*self.scene.filled(), *sorted(self._loaded & set(self.scene.items())))):
            tilt = self.tilt(item)
            if tilt <= self._leant.get(item, _LEVEL) or (item in self.over_rim and self.over_rim[item]()):
                continue
            if self.spills_from(item) is not None:  # shut: however it leans, nothing gets out
                self._leant[item] = tilt

    @contextmanager
    def leaning(self, item: str, over_rim: Callable[[], bool]) -> Iterator[None]:
        """Let an item lean where nothing is lost by it, as long as the context is open."""
        self.over_rim[item] = over_rim
        try:
            yield
        finally:
            del self.over_rim[item]

    def load(self, item: str) -> None:
        """Watch how far an item leans from now on, since something is in it."""
        self._loaded.add(item)
        self._leant.pop(item, None)

    def leant(self, item: str) -> tuple[float, float] | None:
        """Return the maximum lean of a vessel since :meth:`reset_leant`, and its angle of spilling, in radians.

        None for a thing that cannot spill: it is closed, or holds nothing.
        """
        limit = self.spills_from(item)
        return None if limit is None else (self._leant.get(item, 0.0), limit)

    def reset_leant(self) -> None:
        """Forget how far things leaned."""
        self._leant.clear()
        self._loaded.clear()

    def spills_from(self, item: str) -> float | None:
        """Return the lean from which an item spills, in radians; None if it is closed, or cannot hold anything."""
        if not self.scene.is_item(item):
            return None
        handle = self.scene.handle(item)
        if handle is not None and handle.kind == "lid" and self.way(item) <= ARTICULATION.shut_to:
            return None
        return self.spills_when_open_from(item)

    def spills_when_open_from(self, item: str) -> float | None:
        """Return the same, once an item is open; None if it cannot hold anything."""
        opening = self.scene.opening(item)
        if opening is not None:
            return max(opening.spills_from, CONTACT.repose)
        return CONTACT.repose if self.scene.holds_contents(item) else None

    def stream(self, item: str) -> tuple[bool, str] | None:
        """Return whether the stream of an outlet runs into a vessel, with the numbers; None without an outlet."""
        opening, place = self.scene.opening(item) if self.scene.is_item(item) else None, self.support(item)
        spouts = self.scene.spouts(self.whole(place[0])) if place is not None else {}
        if opening is None or place is None or not spouts:
            return None
        pose, whole = self.sim.pose(self.scene.bodies[item]), self.sim.pose(self.scene.bodies[self.whole(place[0])])
        rim = pose.apply(opening.centre)
        away = {}
        for part, at in spouts.items():
            x, y, z = whole.apply(at)
            away[part] = hypot(x - rim[0], y - rim[1]) if z > rim[2] else inf
        part = min(away, key=lambda name: away[name])
        tilt = self.tilt(item)
        told = (
            f"the stream of {part} is {100 * away[part]:.1f} cm from the middle of the opening of {item}, which is "
            f"{200 * opening.radius:.1f} cm wide"
        )
        if tilt > CONTACT.upright:
            return False, f"{told}, and it leans by {degrees(tilt):.0f} degrees"
        return away[part] <= opening.radius - CONTACT.stream, told

    def held(self) -> Sequence[str]:
        """Return the items that are really in the hands: each is still at the gripper."""
        return [self.in_hand[side] for side in ARMS if side in self.in_hand and self._still_held(side)]

    def _still_held(self, side: str) -> bool:
        body = self.scene.bodies[self.in_hand[side]]
        return self.robot.held(side) == body and self.gap(side, self.in_hand[side]) < 0.03

    def gap(self, side: str, item: str) -> float:
        """Return the distance of the item from the gripper's surface, in metres; at most 1."""
        found = self.sim.closest(self.robot.body, self.scene.place(item)[0], 1.0)
        hand = {self.robot.index[name] for name in self.robot.tree.below(f"{side[0]}_gripper_palm_link")}
        return min((c.distance for c in found if c.link in hand), default=1.0)

    def support(self, item: str) -> tuple[str, str] | None:
        """Return the support of an item and the relation (on, in, next to); ``None`` for other things."""
        return self.scene.supported(item) if self.scene.is_item(item) else None

    def loose(self, handle: Handle) -> bool:
        """Return whether it is the lid of a thing that nothing holds: a hand that presses would move the thing."""
        return handle.kind == "lid" and self.scene.is_item(self.scene.owner(handle.body) or "")

    def is_open(self, name: str) -> bool | None:
        """Return whether a door, drawer or lid is open; ``None`` without one, or if it is neither open nor shut."""
        handle = self.scene.handle(name)
        if handle is None or handle.kind in ("knob", "button"):
            return None
        way = self.way(name)
        return True if way >= ARTICULATION.open_from else False if way <= ARTICULATION.shut_to else None

    def ajar(self, name: str) -> bool:
        """Return whether a door, a drawer or a lid is neither open nor shut."""
        handle = self.scene.handle(name)
        return handle is not None and handle.kind not in ("knob", "button") and self.is_open(name) is None

    def has_joint(self, name: str) -> bool:
        """Return whether it has a joint by which it is opened, shut or set."""
        handle = self.scene.handle(name)
        return handle is not None and handle.kind != "button"

    def way(self, name: str) -> float:
        """Return the position of a joint on its way from closed (0) to open (1)."""
        handle = self.scene.handle(name)
        assert handle is not None
        at = self.sim.joint_position(handle.body, handle.joint)
        return (at - handle.closed) / (handle.open - handle.closed)

    def setting(self, name: str) -> str | None:
        """Return the setting of a knob; ``None`` without one, or between two."""
        handle = self.scene.handle(name)
        if handle is None or not handle.settings:
            return None
        at = self.sim.joint_position(handle.body, handle.joint)
        angles = sorted(handle.settings.values())
        step = min((b - a for a, b in itertools.pairwise(angles)), default=1.0)
        name_, angle = min(handle.settings.items(), key=lambda pair: (abs(pair[1] - at), pair[0]))
        return name_ if abs(angle - at) <= ARTICULATION.setting_share * step else None

    def reach(self, name: str, base: Sequence[float] | None = None) -> float:
        """Return the distance on the floor from the robot's base, or another one, to a thing or its whole, in metres.

        Its doors and drawers, which may stand open, do not count. A thing in something is as near as that.
        """
        x, y, _ = base or self.robot.base()
        body, _ = self.scene.place(name)
        low, high = self.sim.extents(body, -1 if -1 in self.sim.solid_links(body) else None)
        own = hypot(max(low[0] - x, 0.0, x - high[0]), max(low[1] - y, 0.0, y - high[1]))
        place = self.support(self.whole(name))
        return own if place is None or place[1] != "in" else min(own, self.reach(place[0], base))

    def measured(self, atom: GroundAtom, sensor: str) -> str:
        """Return the numbers behind a fact."""
        name = atom.args[-1] if sensor in ("held", "reach") else atom.args[0]
        match sensor:
            case "held":
                gaps = ", ".join(f"{side} {100 * self.gap(side, name):.1f} cm" for side in ARMS)
                return f"{name} is this far from the hands: {gaps}"
            case "one_hand" | "two_hands":
                return f"{len(self.held())} hands hold something"
            case "support":
                place, at = self.support(name), self.sim.pose(self.scene.bodies[name]).position
                side = self.side_of(name)
                where = f"{place[1]} {place[0]}" if place else f"in the {side} hand" if side else "nowhere"
                leans = f" and leans by {degrees(self.tilt(name)):.0f} degrees" if self.fallen(name) else ""
                return f"{name} is {where}{leans}, at {at[0]:.2f} {at[1]:.2f} {at[2]:.2f}"
            case "joint":
                return self.how_open(name)
            case "setting":
                handle = self.scene.handle(name)
                assert handle is not None
                return (
                    f"{name} is turned by {np.degrees(self.sim.joint_position(handle.body, handle.joint)):.0f} degrees"
                )
            case _:
                return f"{name} is {self.reach(name):.2f} m away"

    # what hands do

    def settle(self) -> None:
        """Let time pass until nothing that may fall moves for a quarter of a second, for at most four seconds.

        A thing that topples passes a point at which it hardly moves: it must neither move nor turn, several times.
        """
        loose = [self.scene.bodies[item] for item in self.scene.items() if item not in self.in_hand.values()]
        before, still = [self.sim.pose(body) for body in loose], 0
        for _ in range(CONTACT.settle_checks):
            self.sim.step(12)
            now = [self.sim.pose(body) for body in loose]
            moved = any(
                a.distance(b) > CONTACT.still[0] or a.angle(b) > CONTACT.still[1]
                for a, b in zip(now, before, strict=True)
            )
            still = 0 if moved else still + 1
            if still == CONTACT.settled_after:
                return
            before = now

    def fold(self) -> bool:
        """Tuck the arms, stepping back as far as is needed for that; return whether they are tucked."""
        if tuck(self.robot):
            return True
        x, y, theta = self.robot.base()
        pressed = {(body, link) for _, body, link, _ in self.robot.collides() if body != self.robot.body}
        for away in BASE_MOTION.tuck_steps_back:
            back = (x - away * cos(theta), y - away * sin(theta), theta)
            path = plan_base(self.robot, back, ignore=pressed, rng=self.rng, budget=_NEARBY)
            if path is not None and self.robot.drive(path) and tuck(self.robot):
                return True
        return tuck(self.robot, _LONG)

    def retire(self, side: str, ignore: Ignored, *, lid: bool = False) -> None:
        """Draw a hand back the way it points, and tuck the arms.

        A hand that let go of a ``lid`` may leave it across: any other way would take along the thing below.
        """
        here = self.robot.tool(side)
        back: list[tuple[Vector, Ignored]] = [((-away, 0.0, 0.0), ignore) for away in ARTICULATION.retreats]
        across: list[tuple[Vector, Ignored]] = [(away, ()) for away in _PAST]  # without pushing the lid
        for away, touched in (*back[:2], *(across if lid else ()), *back[2:]):
            path = plan_line(self.robot, side, here, here * Pose(away), ignore=touched)
            if path is not None:
                self.robot.move_arm(side, path)
                break
        self.fold()

    @contextmanager
    def gripped(self, side: str, handle: Handle) -> Iterator[None]:
        """Hold a handle: by two pins under physics; in the kinematic mode the joint follows the hand."""
        if self.robot.kinematic:
            with self._following(handle, lambda: self.robot.tool(side)):
                yield
            return
        palm = self.robot.index[f"{side[0]}_gripper_palm_link"]
        apart = (-GRASP.knob_pin_offset, GRASP.knob_pin_offset) if handle.kind == "knob" else (0.0,)
        points = [self.robot.tool(side).apply((0.0, y, 0.0)) for y in apart]
        force = GRASP.lid_force if self.loose(handle) else WELD_FORCE
        pins = [self.sim.pin(self.robot.body, palm, handle.body, handle.index, point, force) for point in points]
        try:
            yield
        finally:
            for pin in pins:
                self.sim.unweld(pin)

    def pushed(self, side: str, handle: Handle) -> AbstractContextManager[None]:
        """Push with a finger: by contact under physics; in the kinematic mode the joint goes with the finger."""
        if not self.robot.kinematic:
            return nullcontext()
        return self._following(handle, lambda: self.robot.tool(side))

    def come_back(self, handle: Handle) -> None:
        """Let a button come back in the kinematic mode, as its spring does under physics."""
        if self.robot.kinematic:
            self.sim.set_joint(handle.body, handle.index, handle.closed)

    @contextmanager
    def _following(self, handle: Handle, tool: Callable[[], Pose]) -> Iterator[None]:
        start, at = tool(), self.sim.joint_position(handle.body, handle.index)
        frame = self.sim.pose(handle.body, handle.index)
        inside = [(body, frame.inverse() * self.sim.pose(body)) for body in self.in_drawer(handle)]
        low, high = sorted((handle.closed, handle.open, *handle.settings.values()))[:: max(1, len(handle.settings) + 1)]

        def follow(sim: Simulator) -> None:
            moved = at + _along(handle, start, tool())
            sim.set_joint(handle.body, handle.index, min(max(moved, low), high))
            for body, pose in inside:
                sim.set_pose(body, sim.pose(handle.body, handle.index) * pose)

        self.sim.add_watcher(follow)
        try:
            yield
        finally:
            self.sim.remove_watcher(follow)

    def in_drawer(self, handle: Handle) -> list[int]:
        """Return the bodies that move with a drawer because they are in it."""
        if handle.kind != "drawer":
            return []
        places = {item: self.scene.supported(item) for item in self.scene.items()}
        return [
            self.scene.bodies[item]
            for item, place in places.items()
            if place is not None and self.scene.place(place[0])[0] == handle.body
        ]

    def spring(self, name: str) -> None:
        """Let a door that has been unlatched swing open, for at most two seconds."""
        if self.is_open(name) is None:
            return
        self.scene.spring_open(name)
        for _ in range(20):
            self.sim.step(24)
            if self.way(name) > 0.98:
                break
        self.scene.calm(name)

    def sweeps(
        self, name: str, base: tuple[float, float, float], *, goal: float | None = None, side: str | None = None
    ) -> bool:
        """Return whether a door would touch the robot at ``base`` on its way.

        ``goal`` is the final position of its joint; None: open. The arm of ``side`` is not checked: it moves the door.
        """
        handle = self.scene.handle(name)
        if handle is None:
            return False
        start = self.sim.joint_position(handle.body, handle.index)
        end = handle.open if goal is None else goal
        arm = self.robot.tree.below(f"{side[0]}_shoulder_pan_link") if side else ()
        own = {self.robot.index[link] for link in arm}
        helds = [held for held in self.robot.helds() if held.side != side]
        with self.robot.as_if(self.robot.elsewhere(base)):
            try:
                for share in np.linspace(0.0, 1.0, 2 + int(abs(end - start) / ARTICULATION.sweep_step)):
                    self.sim.set_joint(handle.body, handle.index, start + float(share) * (end - start))
                    for body in (self.robot.body, *(held.body for held in helds)):
                        near = self.sim.closest(body, handle.body, ARTICULATION.sweep_margin, other_link=handle.index)
                        if any(body != self.robot.body or each.link not in own for each in near):
                            return True
            finally:
                self.sim.set_joint(handle.body, handle.index, start)
        return False

    def how_open(self, name: str) -> str:
        """Return in words how far a joint is open."""
        way = min(max(self.way(name), 0.0), 1.0)
        neither = ", which is neither open nor shut" if self.ajar(name) else ""
        return f"{name} is {100 * way:.0f} % open{neither}"

    # what skills ask

    def side_of(self, item: str) -> str | None:
        """Return the arm that holds an item."""
        self._forget_lost()
        return next((side for side in ARMS if self.in_hand.get(side) == item), None)

    def free(self) -> list[str]:
        """Return the arms that hold nothing."""
        self._forget_lost()
        return [side for side in ARMS if side not in self.in_hand]

    def need_free_hand(self) -> list[str]:
        """Return the arms that hold nothing.

        Raises:
            SkillError: There are none.
        """
        if not (hands := self.free()):
            raise SkillError(SkillPhase.PRECONDITION, "both hands are full")
        return hands

    def holding(self, item: str) -> str:
        """Return the arm that holds an item.

        Raises:
            SkillError: None does.
        """
        side = self.side_of(item)
        if side is None:
            raise SkillError(SkillPhase.PRECONDITION, f"{item} is not in a hand")
        return side

    def links(self, *names: str) -> frozenset[tuple[int, int | None]]:
        """Return all links of the bodies of some things, as ``ignore`` of motion planners."""
        return frozenset((self.scene.place(name)[0], None) for name in names)

    def _forget_lost(self) -> None:
        for side in [side for side in self.in_hand if not self._still_held(side)]:
            self.robot.let_go(side)
            del self.in_hand[side]

    def whole(self, name: str) -> str:
        """Return the object that a part belongs to; an object itself."""
        body, _ = self.scene.place(name)
        return self.scene.owner(body) or name

    def centre(self, name: str) -> Vector:
        """Return the middle of the box round a thing."""
        low, high = self.sim.extents(*self.scene.place(name))
        return ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2)

    def top(self, name: str) -> float:
        """Return the height of the highest point of a thing."""
        _, high = self.sim.extents(*self.scene.place(name))
        return high[2]

    def front(self, name: str) -> float | None:
        """Return the heading of the side from which a thing is reached, in the world; ``None`` for a free thing."""
        item = self.whole(name)
        seen = set()
        while self.scene.is_item(item) and item not in seen:
            seen.add(item)
            place = self.scene.supported(item)
            if place is None:
                return None
            item = self.whole(place[0])
        if item not in self.scene.bodies or item == FLOOR:
            return None
        return self.sim.pose(self.scene.bodies[item]).yaw()

    def in_tool(self, side: str, item: str) -> Pose:
        """Return the item's frame in the tool's."""
        return self.robot.tool(side).inverse() * self.sim.pose(self.scene.bodies[item])


def make_cell(sim: Simulator, scene: Scene, *, seed: int, kinematic: bool, urdf: Path | None = None) -> Cell:
    """Put a robot, the packaged PR2 or that of ``urdf``, in the middle of a scene.

    Raises:
        MissingToolError: The robot's model is not installed.
        TmdError: ``urdf`` is not a PR2.
    """
    rng = np.random.default_rng(seed)
    robot = Pr2(sim, urdf=urdf, kinematic=kinematic, rng=rng)
    return Cell(sim, robot, scene, rng)


def _along(handle: Handle, start: Pose, now: Pose) -> float:
    """Return the motion of a joint when the hand at its handle moves from ``start`` to ``now``."""
    axis = np.array(handle.axis)
    shift = np.array(now.position) - np.array(start.position)
    if not handle.turns:
        return float(axis @ shift)
    arms = [np.array(pose.position) - np.array(handle.origin) for pose in (start, now)]
    if handle.kind == "knob":  # the hand is on the axis: what turns is its y axis
        arms = [np.array(pose.rotate((0.0, 1.0, 0.0))) for pose in (start, now)]
    before, after = (arm - axis * (axis @ arm) for arm in arms)
    return float(np.arctan2(axis @ np.cross(before, after), before @ after))
