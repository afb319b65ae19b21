"""Getting a hand somewhere: where to stand, how high, with which arm, and the way there.

A skill offers *options*: sequences of tool poses any of which would do. Each is tried from where the robot stands,
then from places round what is to be reached, nearest to its front first; the first one that has postures for all
its poses and a way to the first of them is taken.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice, pairwise
from math import atan2, ceil, cos, hypot, pi, sin, sqrt

from tmd.robot.cell import Cell
from tmd.robot.hand import HandChecker
from tmd.robot.motion import DEEPEST, between, plan_arm, plan_base, plan_poses
from tmd.robot.outcome import SkillError, Stage
from tmd.robot.pose import Pose

Base = tuple[float, float, float]
Links = frozenset[tuple[int, int | None]]

DISTANCES = (0.62, 0.54, 0.70, 0.80, 0.48, 0.90)
"""Metres from the base to what is to be reached, best first."""
SWINGS = (0.0, 0.3, -0.3, 0.6, -0.6, 0.9, -0.9, 1.2, -1.2)
"""Radians off the front."""
TURNS = (0.0, 0.35, -0.35)
"""Radians that the base is turned away from what it faces, so that a shoulder does."""
ABOVE_HAND = (0.10, 0.32, -0.1)
"""Metres from the hand's height to the shoulder's, best first."""
MOST_QUESTIONS = 800
"""So many postures are asked for before a search ends."""
MOST_TRIES = 6
"""So many stances are driven to before a skill gives up."""
_REACH = (0.25, 0.95)
"""Metres from the shoulder to the wrist's tool that are worth asking about."""
_POSTURES = 8
"""So many postures of one pose are looked at."""
_BACK = -0.25
"""Least cosine between the way the hand points and the way from the shoulder to it."""
_SHOULDER = 0.188
_SHOULDER_HEIGHT = 0.790675


@dataclass(frozen=True, slots=True)
class Option:
    """One way to do something with a hand.

    Attributes:
        side: The arm.
        poses: Of the tool in the world: the first is reached freely, the others one after the other in straight lines.
        ignore: (body, link) that the hand may touch at the first pose and on the way along the others.
        spot: What was chosen with it, for the skill.
    """

    side: str
    poses: tuple[Pose, ...]
    ignore: Links
    spot: int = 0


@dataclass(frozen=True, slots=True)
class Candidate:
    """An option from a place to stand."""

    option: Option
    base: Base
    torso: float


def reach(
    cell: Cell,
    options: Sequence[Option],
    focus: Pose,
    front: float | None,
    attempt: int,
    *,
    stop: int | None = None,
) -> Option:
    """Bring a hand through the poses of one of the ``options``.

    Args:
        cell: Robot and scene.
        options: What would do, best first.
        focus: What is to be reached.
        front: The heading of the side it is reached from, where it has one.
        attempt: How often this was tried before; later tries begin farther down the list.
        stop: Go only to so many of the poses; the others must be possible from there.

    Raises:
        SkillError: None can be reached (stance), there is no way (path), or the robot did not get there (execution).
    """
    if not options:
        raise SkillError(Stage.STANCE, f"no hand fits in at {_place(focus)}")
    fitting = with_room(cell, options)
    if not fitting:
        raise SkillError(Stage.STANCE, f"no hand fits in at {_place(focus)}: {len(options)} ways were tried")
    found = candidates(cell, fitting, focus, front)
    last = SkillError(Stage.STANCE, f"no place to stand reaches {_place(focus)}: {len(fitting)} ways were tried")
    for candidate in islice(found, 2 * attempt, 2 * attempt + MOST_TRIES):
        try:
            _take(cell, candidate, stop)
        except SkillError as error:
            last = error
        else:
            return candidate.option
    raise last


def with_room(cell: Cell, options: Sequence[Option]) -> list[Option]:
    """The options whose poses have room for the hand and for what it holds, wherever the robot stands."""
    checkers: dict[tuple[str, Links], HandChecker] = {}
    found = []
    for option in options:
        key = option.side, option.ignore
        if key not in checkers:
            checkers[key] = HandChecker(cell.robot, *key)
        depths = checkers[key].depth(option.poses)
        if not depths[-1] and max(depths) <= DEEPEST:
            found.append(option)
    return found


def candidates(cell: Cell, options: Sequence[Option], focus: Pose, front: float | None) -> Iterator[Candidate]:
    """Options from places to stand for which all poses have postures without collisions."""
    here = cell.robot.base()
    asked = 0
    heights = _heights(cell, sum(option.poses[-1].position[2] for option in options) / max(1, len(options)))
    for base in stances(cell, focus, front):
        near = [(torso, o) for torso in heights for o in options if _near_enough(o, base, torso)]
        if not near or (base != here and cell.robot.collides(base=base)):
            continue
        for torso in heights:
            for option in (o for t, o in near if t == torso):
                asked += 1
                if _possible(cell, option, base, torso):
                    yield Candidate(option, base, torso)
                    break
        if asked > MOST_QUESTIONS:
            return


def stances(cell: Cell, focus: Pose, front: float | None, distances: Sequence[float] = DISTANCES) -> Iterator[Base]:
    """Where to stand: here, then round the focus."""
    x, y, _ = focus.position
    here = cell.robot.base()
    if hypot(here[0] - x, here[1] - y) < 1.05:
        yield here
    middle = front if front is not None else atan2(here[1] - y, here[0] - x)
    swings = SWINGS if front is not None else (*SWINGS, 1.6, -1.6, 2.2, -2.2, pi)
    for swing in swings:
        for distance in distances:
            angle = middle + swing
            place = x + distance * cos(angle), y + distance * sin(angle)
            for turn in TURNS:
                yield (*place, _wrapped(angle + pi + turn))


def get_to(cell: Cell, base: Base, torso: float) -> None:
    """Drive to ``base`` with the arms tucked.

    Raises:
        SkillError: There is no way, or the robot did not get there.
    """
    here = cell.robot.base()
    if hypot(base[0] - here[0], base[1] - here[1]) > 0.01 or abs(_wrapped(base[2] - here[2])) > 0.01:
        cell.fold()
        path = plan_base(cell.robot, base, rng=cell.rng)
        if path is None:
            raise SkillError(Stage.PATH, f"no way to {base[0]:.2f} {base[1]:.2f} for the base")
        if not cell.robot.drive(path):
            raise SkillError(Stage.EXECUTION, f"the base did not get to {base[0]:.2f} {base[1]:.2f}")
    if abs(cell.robot.torso() - torso) > 0.005 and not cell.robot.raise_torso(torso):
        raise SkillError(Stage.EXECUTION, f"the torso did not get to {torso:.2f} m")


def follow(cell: Cell, side: str, poses: Sequence[Pose], ignore: Links) -> None:
    """Move the tool through ``poses`` in straight lines.

    Raises:
        SkillError: The arm cannot, or did not.
    """
    path = plan_poses(cell.robot, side, dense([cell.robot.tool(side), *poses]), ignore=ignore)
    if path is None:
        raise SkillError(Stage.PATH, f"the {side} hand cannot go straight to {_place(poses[-1])}")
    if not cell.robot.move_arm(side, path):
        raise SkillError(Stage.EXECUTION, f"the {side} hand did not get to {_place(poses[-1])}")


def dense(poses: Sequence[Pose]) -> list[Pose]:
    """``poses`` with others in between, 1 cm and 0.05 rad apart at most."""
    found = [poses[0]]
    for start, end in pairwise(poses):
        pieces = max(1, ceil(max(start.distance(end) / 0.01, start.angle(end) / 0.05) - 1e-9))
        found += [between(start, end, k / pieces) for k in range(1, pieces + 1)]
    return found


def _take(cell: Cell, candidate: Candidate, stop: int | None) -> None:
    option, side = candidate.option, candidate.option.side
    get_to(cell, candidate.base, candidate.torso)
    rows = plan_poses(cell.robot, side, dense(option.poses), ignore=option.ignore)
    if rows is None:
        raise SkillError(Stage.PATH, f"the {side} hand cannot go straight to {_place(option.poses[-1])} from here")
    path = plan_arm(cell.robot, side, rows[0], rng=cell.rng)
    if path is None:
        raise SkillError(Stage.PATH, f"no way for the {side} hand to {_place(option.poses[0])}")
    if not cell.robot.move_arm(side, path):
        raise SkillError(Stage.EXECUTION, f"the {side} hand did not get to {_place(option.poses[0])}")
    if option.poses[1:stop]:
        follow(cell, side, option.poses[1:stop], option.ignore)


def _possible(cell: Cell, option: Option, base: Base, torso: float) -> bool:
    """Whether there is a posture for the last pose, and a motion through all of them."""
    robot, side = cell.robot, option.side
    found = robot.solve(side, option.poses[-1], base=base, torso=torso)[:_POSTURES]
    if not any(robot.clear(side, found, base=base, torso=torso, ignore=option.ignore)):
        return False
    poses = dense(option.poses)
    return plan_poses(robot, side, poses, ignore=option.ignore, base=base, torso=torso) is not None


def _near_enough(option: Option, base: Base, torso: float) -> bool:
    """Whether all poses are at arm's length from the shoulder."""
    x, y, theta = base
    out = -_SHOULDER if option.side == "right" else _SHOULDER
    shoulder = (
        x - 0.05 * cos(theta) - out * sin(theta),
        y - 0.05 * sin(theta) + out * cos(theta),
        _SHOULDER_HEIGHT + torso,
    )
    return all(_handy(pose, shoulder) for pose in option.poses)


def _handy(pose: Pose, shoulder: tuple[float, float, float]) -> bool:
    """Whether a hand can be there: not too far, and not pointing back at the shoulder."""
    x, y, z = (a - b for a, b in zip(pose.position, shoulder, strict=True))
    away = sqrt(x * x + y * y + z * z)
    if not _REACH[0] < away < _REACH[1]:
        return False
    ahead = pose.rotate((1.0, 0.0, 0.0))
    return (x * ahead[0] + y * ahead[1] + z * ahead[2]) / away > _BACK


def _heights(cell: Cell, hand: float) -> list[float]:
    """Torso heights: as it is, then those that suit a hand at a height."""
    here = cell.robot.torso()
    found = [here]
    for above in ABOVE_HAND:
        height = min(max(hand + above - _SHOULDER_HEIGHT, 0.012), 0.3)
        if all(abs(height - other) > 0.04 for other in found):
            found.append(height)
    return found


def _wrapped(angle: float) -> float:
    return (angle + pi) % (2 * pi) - pi


def _place(pose: Pose) -> str:
    return " ".join(f"{value:.2f}" for value in pose.position)
