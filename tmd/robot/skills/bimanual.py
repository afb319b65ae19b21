"""Holding a thing out for the other hand, which then opens, fills or empties it.

The base stays where it is. The arm that holds the thing brings it to places in front of the robot, upright, with
different sides to the front, until the other arm can do what it is to do with it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from itertools import islice, product
from math import cos, pi, sin, tau

from tmd.robot.pr2.arm_motion import plan_arm
from tmd.robot.pr2.quick_checks import Wrists
from tmd.robot.sim.pose import Pose
from tmd.robot.skills.results import SkillError, SkillPhase
from tmd.robot.skills.robot_context import Cell
from tmd.robot.skills.stance_search import Accept, Option, candidates, get_to, reach, with_room

_TURNS = 8
# Places to hold a thing out: metres up, ahead, and to the side of the arm that holds it; and the number of its turn.
_PLACES = tuple(product(product((0.8, 1.1, 0.95), (0.5, 0.6), (0.1, 0.22, 0.0)), range(_TURNS)))
# Places that follow each other are not alike.
_STRIDE = 29
_POSTURES = 4
# Maximum number of places thought through at one stand.
_MOST_ASKED = 16
# Metres that the robot goes back, and radians that it turns.
_STANDS = ((0.0, 0.0), *product((0.4, 0.6, 0.0), (pi / 2, -pi / 2, pi, 0.0)))
# Maximum number of places tried from one stand, and in all.
_MOST_HERE, _MOST = 4, 24


def reach_for(
    cell: Cell,
    name: str,
    options: Callable[[], Sequence[Option]],
    focus: Pose,
    attempt: int,
    *,
    stop: int | None = None,
    front: float | None = None,
    accept: Accept | None = None,
) -> Option:
    """Bring a hand through the poses of an option for ``name``; if that is held, it is held out.

    ``options`` makes them for its present pose. The other arguments are those of
    :func:`tmd.robot.skills.stance_search.reach`; by default ``front`` is that of the whole, and ``accept`` is not
    called for a thing that is held out.

    Raises:
        SkillError: As :func:`tmd.robot.skills.stance_search.reach`.
    """
    item = cell.whole(name)
    side = cell.side_of(item)
    if side is None:
        side_of_it = cell.front(name) if front is None else front
        return reach(cell, name, options(), focus, side_of_it, attempt, stop=stop, accept=accept)
    home, torso = cell.robot.base(), cell.robot.torso()
    last = SkillError(SkillPhase.STANCE, f"the {side} hand cannot hold {item} out for the other one")
    for _ in islice(_held_out(cell, side, item, options), 2 * attempt, 2 * attempt + _MOST):
        try:
            return reach(cell, name, options(), focus, None, 0, stop=stop, stay=True)
        except SkillError as error:
            last = error
    with suppress(SkillError):  # another try begins from here as well, and not from wherever this one ended
        get_to(cell, home, torso)
    raise last


def _held_out(cell: Cell, side: str, item: str, options: Callable[[], Sequence[Option]]) -> Iterator[None]:
    """Hold a thing out here, then turned away from what the robot stands before, then farther back."""
    x, y, theta = cell.robot.base()
    for back, turn in dict.fromkeys(_STANDS):
        base = (x - back * cos(theta), y - back * sin(theta), theta + turn)
        cell.look_on(f"a place where the {side} hand can hold {item} out for the other one")
        if (back or turn) and cell.robot.collides(base=base):
            continue
        try:
            get_to(cell, base, cell.robot.torso())
        except SkillError:
            continue
        for goal in islice(_places(cell, side, item, options), _MOST_HERE):
            path = plan_arm(cell.robot, side, goal, rng=cell.rng)
            if path is not None and cell.robot.move_arm(side, path):
                yield


def _places(cell: Cell, side: str, item: str, options: Callable[[], Sequence[Option]]) -> Iterator[tuple[float, ...]]:
    """Yield positions of the arm that holds a thing from which the other arm can do its part."""
    robot = cell.robot
    grip, start = cell.in_tool(side, item), cell.sim.pose(cell.scene.bodies[item])
    base, torso = robot.base(), robot.torso()
    now = options()
    asked = 0
    for number in range(len(_PLACES)):
        cell.look_on(f"how the {side} hand can hold {item} out for the other one")
        (up, ahead, aside), turn = _PLACES[number * _STRIDE % len(_PLACES)]
        x, y, _ = robot.base_link().apply((ahead, aside if side == "left" else -aside, 0.0))
        there = Pose.flat(x, y, up + torso / 2, turn * tau / _TURNS)
        shift = there * start.inverse()
        moved = [tuple(shift * pose for pose in option.poses) for option in now]
        near = Wrists(robot, [option.side for option in now], moved).within(base, torso)
        if not any(robot.solve(now[i].side, moved[i][-1]) for i in near):
            continue
        goals = [
            g
            for g in robot.solve(side, there * grip.inverse())[::_POSTURES][:_POSTURES]
            if not robot.collides(side=side, arm=g)
        ]
        for goal in goals[:1]:
            asked += 1
            with robot.as_if(dict(zip(robot.arm_joints[side], goal, strict=True))):
                fitting = with_room(cell, options())
                possible = next(candidates(cell, fitting, there, None, stay=True), None)
            if possible is not None:
                yield goal
        if asked > _MOST_ASKED:
            return
