"""The PR2 in a simulated world: its joints, its hands, its head.

In the default mode everything moves under physics: motors follow trajectories, and what is held is welded to the palm.
In the kinematic mode joints are set along the same paths, and what is held goes along. Both use the same motors to
keep still, so a world can be stepped in either.

Speeds are generous: the base makes 1 m/s and 1.5 rad/s (as the real one), arm joints 2 rad/s, and the torso 0.15 m/s,
ten times what the real one does. Motors are stronger than the real ones, whose arms are balanced by springs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from math import asin, atan2, hypot, pi
from pathlib import Path

import numpy as np

from tmd.robot.assets.features import robot_colour
from tmd.robot.parameters import MOTOR
from tmd.robot.pr2.collision import Collision, CollisionChecker, Held, Ignored, LinkBox, link_boxes
from tmd.robot.pr2.ik import ArmKinematics
from tmd.robot.pr2.kinematics import Array, Tree
from tmd.robot.pr2.trajectory_following import JointGroup, hold, jump, run, unwound
from tmd.robot.pr2.urdf import BASE_JOINTS, HEAD, TOOL, TORSO, prepare
from tmd.robot.sim.pose import Pose
from tmd.robot.sim.simulator import Simulator

ARMS = ("right", "left")
_TORSO_START = 0.15
_TOUCHING = 0.002
# Microseconds of the inverse kinematics of a pose, about.
_SOLVE_WORK = 350
# Half of the angle of view, radians: to the sides, up and down.
_VIEW = (0.75, 0.6)


class Pr2:
    """The robot, with tucked arms and open hands; ``rng`` is for planners that it calls itself.

    It is loaded into ``sim``, from ``urdf`` where that is not the packaged one. With ``kinematic`` joints are set
    instead of driven. ``pose`` is that of the base: x, y, theta.

    Attributes:
        boxes: Boxes around its solid links, by link name.
        index: Link numbers by name.
        joint_index: Joint numbers by name.
        movable: The numbers of all joints that move.
        keeps_level: Whether what a hand holds must stay upright on its way (True), should if possible (False) or need
            not (None). Set by :class:`tmd.robot.skills.robot_context.Cell`.

    Raises:
        MissingToolError: pybullet or the robot's package is not installed.
        TmdError: ``urdf`` is not a PR2.
    """

    arms = ARMS

    def __init__(
        self,
        sim: Simulator,
        *,
        urdf: Path | None = None,
        kinematic: bool = False,
        pose: tuple[float, float, float] = (0.0, 0.0, 0.0),
        rng: np.random.Generator,
    ) -> None:
        self.sim = sim
        self.kinematic = kinematic
        self.rng = rng
        self.model = prepare(urdf)
        self.tree = Tree(self.model.root)
        origin = Pose((0.0, 0.0, 0.0))
        self.body = sim.load(self.model.urdf, origin, fixed=True, own_inertia=True, sleeps=False)
        joints = sim.joints(self.body)
        self.joint_index = {name: joint.index for name, joint in joints.items()}
        self.index = {joint.link_name: joint.index for joint in joints.values()} | {self.tree.root: -1}
        self.movable = [joint.index for joint in joints.values() if joint.kind != "fixed"]
        self._movable_names = [name for name, joint in joints.items() if joint.kind != "fixed"]
        self.arm_kinematics = {side: ArmKinematics(self.tree, side) for side in ARMS}
        self.arm_joints = {side: self.arm_kinematics[side].joints for side in ARMS}
        self._held: dict[str, tuple[int, int, Pose]] = {}
        self.keeps_level: Callable[[str], bool | None] = lambda side: None
        self._gaps: list[tuple[float, float]] = []
        self._make_groups()
        self._set_up(pose)
        self.boxes = self._find_boxes()
        for name, index in self.index.items():
            sim.colour(self.body, index, robot_colour(name))

    def _make_groups(self) -> None:
        def group(names: Sequence[str], speed: float, force: float, stride: float, tolerance: float) -> JointGroup:
            count = len(names)
            joints = tuple(self.joint_index[name] for name in names)
            return JointGroup(joints, (speed,) * count, (force,) * count, (stride,) * count, tolerance)

        base = tuple(self.joint_index[name] for name in BASE_JOINTS)
        self.base_group = JointGroup(base, (1.0, 1.0, 1.5), (5e3, 5e3, 5e3), (0.05, 0.05, 0.1), 0.005, window=72)
        self.torso_group = group([TORSO], 0.15, 5e4, 0.02, 0.003)
        self.head_group = group(HEAD, 3.0, 100.0, 0.2, 0.02)
        self.arm_groups = {side: group(self.arm_joints[side], 2.0, 500.0, 0.1, 0.01) for side in ARMS}
        fingers = {side: [f"{side[0]}_{name}" for name in self.model.fingers] for side in ARMS}
        self.finger_groups = {side: group(fingers[side], MOTOR.finger_speed, 60.0, 0.05, 0.03) for side in ARMS}

    def _set_up(self, pose: tuple[float, float, float]) -> None:
        starts: list[tuple[JointGroup, Sequence[float]]] = [
            (self.base_group, pose),
            (self.torso_group, (_TORSO_START,)),
            (self.head_group, (0.0, 0.3)),
        ]
        starts += [(self.arm_groups[side], self.model.tucked[side]) for side in ARMS]
        starts += [(self.finger_groups[side], self.fingers(0.04)) for side in ARMS]
        for group, positions in starts:
            self.sim.set_joints(self.body, group.joints, positions)
            hold(self.sim, self.body, group, positions)
        rest = set(self.movable) - {joint for group, _ in starts for joint in group.joints}
        for joint in sorted(rest):
            self.sim.drive_joint(self.body, joint, 0.0, 100.0)

    def _find_boxes(self) -> dict[str, LinkBox]:
        known = link_boxes(self.model.root)
        names = {index: name for name, index in self.index.items()}
        for link in self.sim.solid_links(self.body):
            if names[link] not in known:  # a mesh that only the simulator reads: its box, turned back
                lower, upper = np.array(self.sim.extents(self.body, link))
                frame = self.sim.pose(self.body, link).homogeneous()
                centre = frame[:3, :3].T @ ((lower + upper) / 2 - frame[:3, 3])
                known[names[link]] = LinkBox(centre, np.abs(frame[:3, :3].T) @ ((upper - lower) / 2))
        return {name: box for name, box in known.items() if name in self.tree.links}

    # where it is

    def positions(self) -> dict[str, float]:
        """Return the positions of all joints that move, by name."""
        return dict(zip(self._movable_names, self.sim.joint_states(self.body, self.movable)[0], strict=True))

    def _where(self, group: JointGroup) -> tuple[float, ...]:
        return tuple(self.sim.joint_states(self.body, group.joints)[0])

    def base(self) -> tuple[float, float, float]:
        """Return the pose of the base: x, y, and theta in (−π, π]."""
        x, y, theta = self._where(self.base_group)
        return x, y, pi - (pi - theta) % (2 * pi)

    def torso(self) -> float:
        """Return the height of the torso joint, 0 to 0.31."""
        return self._where(self.torso_group)[0]

    def arm(self, side: str) -> tuple[float, ...]:
        """Return the seven joint positions of an arm."""
        return self._where(self.arm_groups[side])

    def tool(self, side: str) -> Pose:
        """Return the tool frame of a hand in the world: +x out of the hand, fingers open along ±y."""
        return self.sim.pose(self.body, self.index[f"{side[0]}_{TOOL}"])

    def gap(self, side: str) -> float:
        """Return the metres between the finger tips, from their poses."""
        tips = [self.sim.pose(self.body, self.index[f"{side[0]}_gripper_{finger}_finger_tip_link"]) for finger in "lr"]
        across = self.tool(side).inverse()
        left, right = (across.apply(tip.position)[1] for tip in tips)
        return max(0.0, left - right - self.model.tip_offset)

    # motion

    def _go(self, group: JointGroup, path: Sequence[Sequence[float]], endless: Sequence[int] = ()) -> bool:
        rows = unwound(np.array([self._where(group), *path], dtype=float), endless)
        if self.kinematic:
            jump(self.sim, self.body, group, rows, self._carry)
            return True
        return run(self.sim, self.body, group, rows)

    def drive(self, path: Sequence[tuple[float, float, float]], *, pace: float = 1.0) -> bool:
        """Drive the base through (x, y, theta), each turn the short way.

        Corners are rounded, by up to 5 cm at full speed, unless they are given twice. ``pace`` is the share of the full
        speed. Return whether it arrived, to 5 mm and 5 mrad, within its budget of steps.
        """
        group = replace(self.base_group, speeds=tuple(pace * speed for speed in self.base_group.speeds))
        return self._go(group, path, endless=(2,))

    def raise_torso(self, height: float) -> bool:
        """Move the torso to ``height`` (0 to 0.31); return whether it arrived, to 3 mm."""
        link = self.tree.links["torso_lift_link"]
        return self._go(self.torso_group, [(min(max(height, link.lower), link.upper),)])

    def move_arm(self, side: str, path: Sequence[Sequence[float]]) -> bool:
        """Move an arm through joint positions; return whether it arrived, to 0.01 rad, within its budget of steps."""
        return self._go(self.arm_groups[side], path, endless=self.arm_kinematics[side].endless)

    def fingers(self, gap: float) -> tuple[float, ...]:
        """Return the positions of a hand's finger joints for a gap between its tips, within their limits."""
        if not self._gaps:
            low, high = self.model.finger_range
            for angle in np.linspace(low, high, 200):
                positions = {f"r_{name}": float(angle) for name in self.model.fingers}
                below = self.tree.below("r_gripper_palm_link")[1:]
                frames = self.tree.forward(positions, below, {"r_gripper_palm_link": np.eye(4)})
                tips = [frames[f"r_gripper_{finger}_finger_tip_link"][:3, 3] for finger in "lr"]
                self._gaps.append((float(np.linalg.norm(tips[0] - tips[1])) - self.model.tip_offset, float(angle)))
        gaps, angles = zip(*self._gaps, strict=True)
        return (float(np.interp(gap if gap > 0 else -1.0, gaps, angles)),) * len(self.model.fingers)

    def open_gripper(self, side: str, gap: float = 0.08) -> bool:
        """Open a hand until its tips are ``gap`` apart; return whether they are."""
        return self._go(self.finger_groups[side], [self.fingers(gap)])

    def close_gripper(self, side: str, force: float = MOTOR.grip_force) -> float:
        """Close a hand until both fingers meet something, or each other; return the gap left, in metres.

        ``force`` is the maximum of each finger joint, in N·m.
        """
        group = self.finger_groups[side]
        angles = np.array(self._where(group))
        names = self.model.fingers
        left, right = (np.array([name.startswith(f"gripper_{finger}_") for name in names]) for finger in "lr")
        stride = 0.02 if self.kinematic else MOTOR.finger_speed / 240
        stopped = {"l": False, "r": False}
        while not all(stopped.values()):
            for finger, mask in (("l", left), ("r", right)):
                if not stopped[finger]:
                    angles[mask] = np.maximum(angles[mask] - stride, self.model.finger_range[0])
            if self.kinematic:
                self.sim.set_joints(self.body, group.joints, angles.tolist())
                self.sim.tick()
            else:
                self._squeeze(group, angles, force)
                self.sim.step()
            for finger, mask in (("l", left), ("r", right)):
                stopped[finger] = stopped[finger] or self._finger_stops(side, finger, angles, mask)
        if self.kinematic:
            hold(self.sim, self.body, group, angles.tolist())
        else:
            for _ in range(24):
                self._squeeze(group, angles, force)
                self.sim.step()
        return self.gap(side)

    def _squeeze(self, group: JointGroup, angles: Array, force: float) -> None:
        """Push the fingers to ``angles``; the tips follow their fingers, as by the linkage of the real hand."""
        actual = np.clip(self._where(group), *self.model.finger_range)
        follow = len(group.joints) // 2 - 1
        targets = [angles[0], angles[1], *[actual[0], actual[1]] * follow]
        forces = [force, force, *[10 * force] * (2 * follow)]
        self.sim.drive_joints(self.body, group.joints, targets, [0.0] * len(targets), forces, 0.1)

    def _finger_stops(self, side: str, finger: str, angles: Array, mask: Array) -> bool:
        """Return whether a finger is closed, or meets something: seen by its lag, or by its contacts if it is set."""
        if angles[mask].max() <= self.model.finger_range[0]:
            return True
        if not self.kinematic:
            actual = np.array(self._where(self.finger_groups[side]))
            return bool((actual - angles)[mask][0] > MOTOR.finger_lag)
        links = [self.index[f"{side[0]}_gripper_{finger}_finger{part}_link"] for part in ("", "_tip")]
        others = [body for body in self.sim.bodies() if body != self.body]
        return any(self.sim.closest(self.body, body, 0.0, link) for body in others for link in links)

    # hands

    def touches(self, side: str, body: int, link: int | None = None) -> bool:
        """Return whether the palm or a finger of a hand is within 2 mm of a body, or of one of its links."""
        names = [name for name in self.tree.below(f"{side[0]}_gripper_palm_link") if name in self.boxes]
        return any(self.sim.closest(self.body, body, _TOUCHING, self.index[name], link) for name in names)

    def hold(self, side: str, body: int) -> None:
        """Weld a body to the palm as it is now."""
        self.let_go(side)
        grip = self.tool(side).inverse() * self.sim.pose(body)
        self._held[side] = body, self.sim.weld(self.body, self.index[f"{side[0]}_gripper_palm_link"], body), grip

    def let_go(self, side: str) -> None:
        """Undo :meth:`hold`; the fingers stay where they are."""
        if side in self._held:
            self.sim.unweld(self._held.pop(side)[1])

    def held(self, side: str) -> int | None:
        """Return the body that a hand holds."""
        return self._held[side][0] if side in self._held else None

    def helds(self) -> list[Held]:
        """Return what the hands hold, as it lies in them now."""
        return [
            Held(body, side, self.tool(side).inverse() * self.sim.pose(body))
            for side, (body, _, _) in sorted(self._held.items())
        ]

    def _carry(self) -> None:
        for side, (body, _, grip) in sorted(self._held.items()):
            self.sim.set_pose(body, self.tool(side) * grip)

    # the head

    def eye(self) -> Pose:
        """Return the pose of the cameras in the world, which look along +x."""
        return self.sim.pose(self.body, self.index["head_tilt_link"]) * Pose(self.model.eye)

    def look_at(self, point: Sequence[float]) -> bool:
        """Turn the head to a point; return whether it is then in the middle of the view, to 0.1 rad."""
        torso = self.sim.pose(self.body, self.index["torso_lift_link"])
        pan_link, tilt_link = (self.tree.links[name] for name in ("head_pan_link", "head_tilt_link"))
        x, y, z = (a - b for a, b in zip(torso.inverse().apply(point), pan_link.origin[:3, 3], strict=True))
        pan = min(max(atan2(y, x), pan_link.lower), pan_link.upper)
        ahead, up = hypot(x, y) - tilt_link.origin[0, 3], z - tilt_link.origin[2, 3]
        tilt = asin(min(1.0, self.model.eye[2] / max(hypot(ahead, up), self.model.eye[2]))) - atan2(up, ahead)
        self._go(self.head_group, [(pan, min(max(tilt, tilt_link.lower), tilt_link.upper))])
        ahead, left, up = self.eye().inverse().apply(point)
        return ahead > 0 and atan2(hypot(left, up), ahead) < 0.1

    def sees(self, point: Sequence[float], body: int) -> bool:
        """Return whether a point of a body is in the view of the cameras, and nothing else is in between."""
        ahead, left, up = self.eye().inverse().apply(point)
        if ahead <= 0 or abs(atan2(left, ahead)) > _VIEW[0] or abs(atan2(up, ahead)) > _VIEW[1]:
            return False
        hit = self.sim.ray(self.eye().position, point)
        return hit is None or hit.body == body

    # what would be

    def solve(
        self,
        side: str,
        tool: Pose,
        *,
        base: tuple[float, float, float] | None = None,
        torso: float | None = None,
        seed: Sequence[float] | None = None,
    ) -> list[tuple[float, ...]]:
        """Return arm positions that bring a tool frame to a pose of the world; nothing moves.

        They are within the joint limits, nearest to ``seed`` (None: where the arm is) first, without a collision check.
        ``base`` and ``torso`` are the present ones if None.
        """
        kinematics = self.arm_kinematics[side]
        self.sim.work += _SOLVE_WORK
        inside = self.base_link(base).inverse() * tool
        return kinematics.solve(inside, self.torso() if torso is None else torso, seed or self.arm(side))

    def base_link(self, base: tuple[float, float, float] | None = None) -> Pose:
        """Return the frame base_link for a pose of the base; None: the present one."""
        x, y, theta = self.base() if base is None else base
        return Pose.flat(x, y, float(self.tree.links["base_link"].origin[2, 3]), theta)

    def tool_at(
        self,
        side: str,
        arm: Sequence[float],
        *,
        base: tuple[float, float, float] | None = None,
        torso: float | None = None,
    ) -> Pose:
        """Return the tool frame in the world for positions of an arm; nothing moves."""
        height = self.torso() if torso is None else torso
        frame = self.arm_kinematics[side].tool(height, np.array([arm], dtype=float))[0]
        return self.base_link(base) * Pose.from_matrix(frame)

    def elsewhere(self, base: tuple[float, float, float] | None = None, torso: float | None = None) -> dict[str, float]:
        """Return joint positions for :class:`CollisionChecker`: those of a base and a torso."""
        result = {} if base is None else dict(zip(BASE_JOINTS, base, strict=True))
        return result if torso is None else result | {TORSO: torso}

    def collides(
        self,
        *,
        side: str | None = None,
        arm: Sequence[float] | None = None,
        base: tuple[float, float, float] | None = None,
        torso: float | None = None,
        ignore: Ignored = (),
        margin: float = 0.0,
    ) -> list[Collision]:
        """Return what the robot would touch: (robot link, body, link, depth), deepest first; nothing moves.

        ``side`` restricts the check to one arm, with what it holds, at positions ``arm`` (None: the present ones).
        ``base`` and ``torso`` are the present ones if None. (body, link) of ``ignore`` may be touched, link None: all
        of the body; ``margin`` is in metres. A tool frame stands for what that hand holds.
        """
        if arm is not None and side is None:
            raise ValueError("whose arm?")
        positions = self.elsewhere(base, torso)
        if side is not None and arm is not None:
            positions |= dict(zip(self.arm_joints[side], arm, strict=True))
        with CollisionChecker(self, (), positions=positions, arm=side, ignore=ignore, margin=margin) as checker:
            return checker.collisions(())

    @contextmanager
    def as_if(self, positions: Mapping[str, float]) -> Iterator[None]:
        """Put some joints, with all that they carry, elsewhere for a while; afterwards all is back, to the bit."""
        helds = self.helds()
        with CollisionChecker(self, (), positions=positions, helds=helds):
            for held in helds:
                self.sim.set_pose(held.body, self.tool(held.side) * held.grip)
            yield

    def free_bases(self, bases: Sequence[tuple[float, float, float]]) -> list[bool]:
        """Return for many poses of the base whether the robot as it is would touch nothing there."""
        if not bases:
            return []
        with CollisionChecker(self, BASE_JOINTS) as checker:
            return checker.each_free(np.array(bases, dtype=float))

    def clear(
        self,
        side: str,
        arms: Sequence[Sequence[float]],
        *,
        base: tuple[float, float, float] | None = None,
        torso: float | None = None,
        ignore: Ignored = (),
    ) -> list[bool]:
        """Return for many positions of one arm whether they touch nothing, much faster than by :meth:`collides`."""
        if not arms:
            return []
        positions = self.elsewhere(base, torso)
        with CollisionChecker(self, self.arm_joints[side], positions=positions, arm=side, ignore=ignore) as checker:
            return checker.each_free(np.array(arms, dtype=float))
