"""Search for a stance: the place, the torso height, the arm, and the way there, to bring a hand somewhere.

A skill offers *options*: sequences of tool poses any of which would do. Each is tried from where the robot stands,
then from places round what is to be reached, nearest to its front first; the first one that has postures for all
its poses and a way to the first of them is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import chain, islice, product
from math import atan2, ceil, cos, hypot, pi, sin, tau

from tmd.robot.parameters import ARM_MOTION, STANCE
from tmd.robot.pr2.arm_motion import dense, plan_arm, plan_level, plan_poses
from tmd.robot.pr2.base_motion import plan_base
from tmd.robot.pr2.quick_checks import HandChecker, Wrists
from tmd.robot.sim.pose import Pose
from tmd.robot.skills import obstruction
from tmd.robot.skills.results import SkillError, SkillPhase
from tmd.robot.skills.robot_context import Base, Cell

Links = frozenset[tuple[int, int | None]]
Accept = Callable[["Option", Base], bool]

_FINE_SWINGS = tuple(sign * 0.15 * step for step in range(10) for sign in ((1, -1) if step else (1,)))
_FAR_SWINGS = tuple(sign * 0.3 * step for step in range(5, 11) for sign in (1, -1))
_COARSE = 4.0
# Ways or places that are looked at to say what is in the way.
_EXPLAINED = 8
# Samples for a way of the arm where there is no other stance to try.
_LONG = 2000
_SHOULDER_HEIGHT = 0.790675


@dataclass(frozen=True, slots=True)
class Option:
    """One way to do something with a hand.

    Attributes:
        side: The arm.
        poses: Of the tool in the world: the first is reached freely, the others one after the other in straight lines.
        ignore: (body, link) that the hand may touch at the first pose and on the way along the others.
        spot: A number for the skill.
        part: Share of a door's whole way at the end.
    """

    side: str
    poses: tuple[Pose, ...]
    ignore: Links
    spot: int = 0
    part: float = 1.0


@dataclass(frozen=True, slots=True)
class StanceCandidate:
    """An option from a place to stand."""

    option: Option
    base: Base
    torso: float


def reach(
    cell: Cell,
    what: str,
    options: Sequence[Option],
    focus: Pose,
    front: float | None,
    attempt: int,
    *,
    stop: int | None = None,
    stay: bool = False,
    accept: Accept | None = None,
) -> Option:
    """Bring a hand through the poses of one of the ``options``.

    Args:
        cell: Robot and scene.
        what: Name of the goal for messages.
        options: Alternatives, best first.
        focus: Pose of the goal.
        front: The heading of the side it is reached from, if it has one.
        attempt: Number of earlier tries; later tries begin farther down the list.
        stop: Number of poses to go to; the others must be possible from there.
        stay: Neither the base nor the torso may move.
        accept: Returns whether an option from a base will do.

    Raises:
        SkillError: None can be reached (stance), there is no way (path), the robot did not get there (execution), or
            looking for it takes too long (time).
    """
    if not options:
        raise SkillError(SkillPhase.STANCE, f"no hand fits in at {what}")
    fitting = with_room(cell, options)
    if not fitting:
        raise SkillError(
            SkillPhase.STANCE, f"no hand fits in at {what}, {len(options)} ways were tried{_in_the_way(cell, options)}"
        )
    found = candidates(cell, fitting, focus, front, what=what, stay=stay, accept=accept)
    said: list[SkillError] = []
    failed: list[StanceCandidate] = []
    closed: list[Base] = []
    tried_before = list(islice(found, 2 * attempt))
    for candidate in _timely(chain(found, tried_before), said):
        cell.look_on(f"the way to {what}")
        # the same arm in nearly the same place fails again
        alike = (each.base for each in failed if each.option is candidate.option)
        if any(_close(candidate.base, base) for base in (*alike, *closed)):
            continue
        try:
            get_to(cell, candidate.base, candidate.torso)
        except SkillError as error:
            said.append(error)
            closed.append(candidate.base)
        else:
            try:
                _take(cell, what, candidate.option, stop)
            except SkillError as error:
                said.append(error)
                failed.append(candidate)
            else:
                return candidate.option
        if len(failed) + len(closed) >= STANCE.max_tries:
            break
    if not said:
        raise SkillError(SkillPhase.STANCE, _unreached(cell, what, fitting, focus, front, stay=stay))
    if said[-1].stage is not SkillPhase.PATH or not failed:
        raise said[-1]
    # nothing else is left: look longer for a way from the best stance
    get_to(cell, failed[0].base, failed[0].torso)
    _take(cell, what, failed[0].option, stop, budget=_LONG)
    return failed[0].option


def _timely(found: Iterator[StanceCandidate], said: Sequence[SkillError]) -> Iterator[StanceCandidate]:
    """Pass candidates on; if they take too long, the error names the last failure as well."""
    try:
        yield from found
    except SkillError as error:
        if error.stage is not SkillPhase.TIME or not said:
            raise
        raise SkillError(SkillPhase.TIME, f"{error.reason}; before that, {said[-1].reason}") from error


def _in_the_way(cell: Cell, options: Sequence[Option]) -> str:
    ways = [(option.side, option.poses[-1:], option.ignore) for option in options]
    told = obstruction.of_hand(cell, ways[:: max(1, len(ways) // _EXPLAINED)])
    return f": {told}" if told else ""


def _unreached(
    cell: Cell, what: str, options: Sequence[Option], focus: Pose, front: float | None, *, stay: bool
) -> str:
    said = f"no place to stand reaches {what}, {len(options)} ways were tried"
    here = cell.robot.base()
    usual = [here] if stay else list(stances(cell, focus, front, STANCE.distances[:2]))
    free = [base for base, clear in zip(usual, cell.robot.free_bases(usual), strict=True) if clear or base == here]
    if not free:
        told = obstruction.of_stances(cell, usual[:_EXPLAINED])
        return f"{said}: there is no room to stand{', ' if told else ''}{told}"
    pose = options[0].poses[-1]
    near = sorted(free, key=lambda base: hypot(base[0] - focus.position[0], base[1] - focus.position[1]))
    told = obstruction.of_arm(cell, options[0].side, pose, near[:_EXPLAINED], options[0].ignore)
    return f"{said}: {told or 'its whole way is nowhere free'}"


def with_room(cell: Cell, options: Sequence[Option]) -> list[Option]:
    """Return the options whose poses have room for the hand and for what it holds, wherever the robot stands."""
    checkers: dict[tuple[str, Links], HandChecker] = {}
    found = []
    for option in options:
        key = option.side, option.ignore
        if key not in checkers:
            checkers[key] = HandChecker(cell.robot, *key)
        depths = checkers[key].depth(option.poses)
        if not depths[-1] and max(depths) <= ARM_MOTION.start_penetration:
            found.append(option)
    return found


def candidates(
    cell: Cell,
    options: Sequence[Option],
    focus: Pose,
    front: float | None,
    patience: int = STANCE.search_budget,
    *,
    what: str = "it",
    stay: bool = False,
    accept: Accept | None = None,
) -> Iterator[StanceCandidate]:
    """Yield options from places to stand for which all poses have postures without collisions.

    The search ends when its checks have cost more than ``patience``.
    """
    if not options:
        return
    here = cell.robot.base()
    left = patience
    hand = sum(option.poses[-1].position[2] for option in options) / len(options)
    heights = [cell.robot.torso()] if stay else _heights(cell, hand)
    wrists = Wrists(cell.robot, [o.side for o in options], [o.poses for o in options])
    for base in [here] if stay else _free(cell, focus, front):
        cell.look_on(f"a place to stand for {what}")
        near = {torso: wrists.within(base, torso) for torso in heights}
        for torso, numbers in near.items():
            for option in (options[number] for number in numbers):
                if accept is not None and not accept(option, base):
                    continue
                possible, price = _possible(cell, option, base, torso)
                left -= price
                if possible:
                    yield StanceCandidate(option, base, torso)
                    break
        if left < 0:
            return


def _free(cell: Cell, focus: Pose, front: float | None) -> Iterator[Base]:
    """Yield places to stand where the robot touches nothing: the usual ones, then many more between them."""
    here = cell.robot.base()
    usual = list(stances(cell, focus, front))
    yield from (base for base, free in zip(usual, cell.robot.free_bases(usual), strict=True) if free or base == here)
    distances = STANCE.fine_distances
    if focus.position[2] < STANCE.low:
        distances = (*STANCE.low_fine_distances, *(d for d in distances if d > max(STANCE.low_fine_distances)))
    swings = _FINE_SWINGS if front is not None else (*_FINE_SWINGS, *_FAR_SWINGS)
    closer = list(_round(cell, focus, front, distances, swings, STANCE.fine_turns))
    yield from (base for base, free in zip(closer, cell.robot.free_bases(closer), strict=True) if free)


def _close(one: Base, other: Base) -> bool:
    return hypot(one[0] - other[0], one[1] - other[1]) < STANCE.alike


def stances(
    cell: Cell, focus: Pose, front: float | None, distances: Sequence[float] = STANCE.distances
) -> Iterator[Base]:
    """Yield places to stand: here, then round the focus."""
    x, y, z = focus.position
    if z < STANCE.low:
        distances = (*STANCE.low_distances, *(d for d in distances if d > STANCE.low_distances[-1]))
    here = cell.robot.base()
    if hypot(here[0] - x, here[1] - y) < 1.05:
        yield here
    swings = STANCE.bearings if front is not None else (*STANCE.bearings, 1.6, -1.6, 2.2, -2.2, pi)
    yield from _round(cell, focus, front, distances, swings, STANCE.turns)


def _round(
    cell: Cell,
    focus: Pose,
    front: float | None,
    distances: Sequence[float],
    swings: Sequence[float],
    turns: Sequence[float],
) -> Iterator[Base]:
    """Yield places round the focus; without a front, the robot's own side is the front."""
    x, y, _ = focus.position
    here = cell.robot.base()
    middle = front if front is not None else atan2(here[1] - y, here[0] - x)
    for swing, distance, turn in product(swings, distances, turns):
        angle = middle + swing
        yield x + distance * cos(angle), y + distance * sin(angle), _wrapped(angle + pi + turn)


def get_to(cell: Cell, base: Base, torso: float) -> None:
    """Drive to ``base`` with the arms tucked.

    Raises:
        SkillError: There is no way, or the robot did not get there.
    """
    here = cell.robot.base()
    if hypot(base[0] - here[0], base[1] - here[1]) > 0.01 or abs(_wrapped(base[2] - here[2])) > 0.01:
        cell.fold()
        if abs(cell.robot.torso() - torso) > 0.005 and not _sticks(cell, torso):
            _lift(cell, torso)  # there it may be below a shelf
        _drive(cell, base)
    if abs(cell.robot.torso() - torso) > 0.005:
        _lift(cell, torso)


def _drive(cell: Cell, base: Base) -> None:
    """Drive; slowly in little room, where the robot must be exact."""
    for away, pace in STANCE.clearances:
        path = plan_base(cell.robot, base, rng=cell.rng, clearance=away)
        if path is None:
            continue
        if not cell.robot.drive(path, pace=pace):
            raise SkillError(SkillPhase.EXECUTION, f"the base did not get to {base[0]:.2f} {base[1]:.2f}")
        return
    told = obstruction.of_base_path(cell, base)
    raise SkillError(SkillPhase.PATH, f"no way to {base[0]:.2f} {base[1]:.2f} for the base{': ' if told else ''}{told}")


def _lift(cell: Cell, torso: float) -> None:
    if _sticks(cell, torso) and not (cell.fold() and not _sticks(cell, torso)):
        told = obstruction.of_posture(cell, torso) or "something is in the way"
        raise SkillError(SkillPhase.PATH, f"{told} of the arms with the torso at {torso:.2f} m")
    if not cell.robot.raise_torso(torso):
        raise SkillError(SkillPhase.EXECUTION, f"the torso did not get to {torso:.2f} m")


def _sticks(cell: Cell, torso: float) -> bool:
    """Return whether the arms, or what they hold, would be in something on the way of the torso."""
    here = cell.robot.torso()
    steps = ceil(abs(torso - here) / STANCE.torso_step)
    heights = [here + (torso - here) * step / steps for step in range(1, steps + 1)]
    return any(
        depth > ARM_MOTION.start_penetration for height in heights for *_, depth in cell.robot.collides(torso=height)
    )


def follow(cell: Cell, side: str, poses: Sequence[Pose], ignore: Links) -> None:
    """Move the tool through ``poses`` in straight lines.

    Raises:
        SkillError: The arm cannot, or did not.
    """
    whole = dense([cell.robot.tool(side), *poses])
    path = plan_poses(cell.robot, side, whole, ignore=ignore)
    if path is None:
        told = obstruction.of_straight(cell, side, whole, ignore)
        raise SkillError(SkillPhase.PATH, f"the {side} hand cannot go straight on: {told}")
    if not cell.robot.move_arm(side, path):
        place = " ".join(f"{value:.2f}" for value in poses[-1].position)
        raise SkillError(SkillPhase.EXECUTION, f"the {side} hand did not get to {place}{_held_up(cell)}")
    cell.way_in[side] = path


def _take(cell: Cell, what: str, option: Option, stop: int | None, budget: int = 300) -> None:
    side = option.side
    whole = dense(option.poses)
    rows = plan_poses(cell.robot, side, whole, ignore=option.ignore)
    if rows is None:
        told = obstruction.of_straight(cell, side, whole, option.ignore)
        raise SkillError(SkillPhase.PATH, f"the {side} hand cannot go straight to {what} from here: {told}")
    path = _level(cell, option, whole) or plan_arm(cell.robot, side, rows[0], rng=cell.rng, budget=budget)
    if path is None:
        told = obstruction.of_arm_path(cell, side, rows[0])
        level = cell.robot.keeps_level(side)
        upright = f" with {cell.in_hand[side]} upright" if level else ""
        raise SkillError(SkillPhase.PATH, f"no way for the {side} hand to {what}{upright}{': ' if told else ''}{told}")
    if not cell.robot.move_arm(side, path):
        raise SkillError(SkillPhase.EXECUTION, f"the {side} hand did not get to {what}{_held_up(cell)}")
    if option.poses[1:stop]:
        follow(cell, side, option.poses[1:stop], option.ignore)


def _level(cell: Cell, option: Option, whole: Sequence[Pose]) -> list[tuple[float, ...]] | None:
    """Return a straight way to the first pose for what is carried upright, from whose end the others can be reached."""
    if cell.robot.keeps_level(option.side) is None:
        return None
    path = plan_level(cell.robot, option.side, option.poses[0], ignore=option.ignore)
    if path is None or plan_poses(cell.robot, option.side, whole, ignore=option.ignore, arm=path[-1]) is None:
        return None
    return path


def _held_up(cell: Cell) -> str:
    told = obstruction.of_posture(cell)
    return f": {told}" if told else ""


def _possible(cell: Cell, option: Option, base: Base, torso: float) -> tuple[bool, int]:
    """Return whether there are a posture for the last pose and a motion through all, and the cost of this check."""
    robot, side = cell.robot, option.side
    found = robot.solve(side, option.poses[-1], base=base, torso=torso)
    if not found:
        return False, STANCE.prices[0]
    spread = found[:: -(-len(found) // STANCE.max_postures)]  # neighbours touch the same
    if not any(robot.clear(side, spread, base=base, torso=torso, ignore=option.ignore)):
        return False, STANCE.prices[1]
    poses = dense(option.poses, _COARSE)  # what lies in between is looked at once the robot is there
    rows = plan_poses(robot, side, poses, ignore=option.ignore, base=base, torso=torso)
    return rows is not None, STANCE.prices[2]


def _heights(cell: Cell, hand: float) -> list[float]:
    """Return torso heights: the present one, then those that suit a hand at a height."""
    here = cell.robot.torso()
    found = [here]
    for above in STANCE.shoulder_above_hand:
        height = min(max(hand + above - _SHOULDER_HEIGHT, 0.012), 0.3)
        if all(abs(height - other) > 0.04 for other in found):
            found.append(height)
    return found


def _wrapped(angle: float) -> float:
    return (angle + pi) % (2 * pi) - pi


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
