"""Skills that hold one thing over another: tip, dip, squeeze."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import acos, cos, degrees, hypot, pi

from tmd.robot.assets.features import Region
from tmd.robot.parameters import CONTACT, GRASP, POURING
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.skills.results import SkillError, SkillPhase
from tmd.robot.skills.robot_context import Cell
from tmd.robot.skills.stance_search import Option, reach_for, with_room

# Force of fingers that squeeze a bottle, in N·m.
_SQUEEZE = 40.0


@dataclass(frozen=True, slots=True)
class Mouth:
    """The place at which contents leave a thing that is tipped, in the thing's frame.

    ``out`` must point down for contents to leave; ``turn`` is the axis of tipping, ``both`` allows it either way.
    """

    at: Vector
    out: Vector
    turn: Vector
    both: bool = False


def mouths(cell: Cell, item: str, side: str) -> list[Mouth]:
    """Return the mouths of what is held, best first.

    It is the rim of what has an opening, on either side of the wrist, away from the hand and towards it; the far end of
    a long flat thing; the underside of a packet that hangs from the hand; and else the edge of the top.
    """
    low, high = cell.scene.size(item)
    size = [b - a for a, b in zip(low, high, strict=True)]
    middle = [(a + b) / 2 for a, b in zip(low, high, strict=True)]
    longest = max(range(3), key=lambda axis: size[axis])
    tool = cell.in_tool(side, item).inverse()
    opening = cell.scene.opening(item)
    if opening is not None:  # its handle may make it longer than high
        x, y, top = opening.centre
        out = opening.radius + POURING.wall
        return [_rim((x - out, y - out), (x + out, y + out), top, axis) for axis in _axes(tool, (x, y))]
    if longest == 2 or size[longest] < 2.2 * size[2]:
        if tool.rotate((1.0, 0.0, 0.0))[2] < -0.7 and not cell.scene.holds_contents(item):
            return [Mouth((middle[0], middle[1], low[2]), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0))]
        return [_rim(low, high, high[2], axis) for axis in _axes(tool, middle)]
    far = high if tool.position[longest] < middle[longest] else low
    at, turn = list(middle), [0.0, 0.0, 0.0]
    at[longest] = far[longest] - 0.015 * (1 if far is high else -1)
    turn[longest] = 1.0
    return [Mouth((at[0], at[1], high[2]), (0.0, 0.0, 1.0), (turn[0], turn[1], turn[2]), both=True)]


def _rim(low: Sequence[float], high: Sequence[float], top: float, axis: Vector) -> Mouth:
    """Return the point of the rim that is lowest when a vessel is tipped about ``axis``."""
    at = [(a + b) / 2 + (b - a) / 2 * share for a, b, share in zip(low[:2], high[:2], (axis[1], -axis[0]), strict=True)]
    return Mouth((at[0], at[1], top), (0.0, 0.0, 1.0), axis)


def _axes(tool: Pose, middle: Sequence[float]) -> list[Vector]:
    """Return axes: to either side by a roll of the wrist, then away from the hand and towards it."""
    x, y = middle[0] - tool.position[0], middle[1] - tool.position[1]
    if hypot(x, y) < 0.01:  # the hand is above: how it is turned decides
        x, y, _ = tool.rotate((0.0, 1.0, 0.0))
    size = hypot(x, y) or 1.0
    x, y = x / size, y / size
    return [(x, y, 0.0), (-x, -y, 0.0), (-y, x, 0.0), (y, -x, 0.0)]


def tip(cell: Cell, item: str, target: str, attempt: int, *, squeezed: bool = False) -> str:
    """Hold ``item`` over ``target`` and tip it.

    Raises:
        SkillError: It is not held, cannot be held there, or its mouth was not over the target.
    """
    side = cell.holding(item)
    _refuse_fallen(cell, target)
    known = mouths(cell, item, side)

    def options() -> list[Option]:
        found: list[Option] = []
        for room in POURING.heights:
            found += with_room(cell, tip_options(cell, item, target, known, *room, closed=squeezed))
            if len(found) >= POURING.max_ways:
                break
        return found

    body = cell.scene.bodies[item]

    def leaving() -> Vector:
        """Return the point over which contents run out as the thing is held: the lowest of its mouths."""
        here = cell.sim.pose(body)
        return min((here.apply(how.at) for how in known), key=lambda point: point[2])

    with cell.leaning(item, lambda: _beside(cell, leaving(), target) <= POURING.mouth_offset):
        chosen = reach_for(cell, target, options, Pose(_overs(cell, target, POURING.heights[0][0])[0]), attempt)
        how = known[chosen.spot]
        if squeezed:
            cell.robot.close_gripper(side, _SQUEEZE)
        here = cell.sim.pose(body)
        tilt = acos(max(-1.0, min(1.0, here.rotate(how.out)[2])))  # between the mouth and straight up
        beside = _beside(cell, leaving(), target)
        cell.load(target)
        cell.moment()
        _go_back(cell, chosen.side)
    said = (
        f"{item} was tipped by {degrees(tilt):.0f} degrees, its mouth {100 * beside:.1f} cm beside the rim of {target}"
    )
    if tilt < POURING.runs_out_from or beside > POURING.mouth_offset:
        raise SkillError(SkillPhase.EFFECT, said)
    return said.replace("its mouth 0.0 cm beside the rim of", "its mouth over")


def tip_options(
    cell: Cell, item: str, target: str, known: Sequence[Mouth], height: float, near: float, *, closed: bool
) -> list[Option]:
    """Return ways to tip what is held over a rim, and as near to its edge; ``spot`` of an option: number of its mouth.

    Before a niche a thing is tipped outside, as far as nothing runs out: a ``closed`` one all the way, since nothing
    runs out until it is squeezed.
    """
    side = cell.holding(item)
    grip = cell.in_tool(side, item).inverse()
    spills = None if closed else cell.spills_from(item)
    options = []
    for angle, over, (index, how), number in product(
        POURING.tilts, _overs(cell, target, height), enumerate(known), range(GRASP.headings)
    ):
        stood = _heading(number)
        x, y, _ = stood.rotate(how.at)
        nearer = near / max(hypot(x, y), 0.01)
        at = (over[0] - x * nearer, over[1] - y * nearer, over[2])
        for turned in (angle, -angle) if how.both else (angle if how.out[2] > 0 else POURING.swing,):
            poses = tuple(
                _over_rim(stood, how, at, turned * k / POURING.stages) * grip for k in range(POURING.stages + 1)
            )
            outside = before(cell, target, poses[0])
            options.append(Option(side, (*outside, *poses), cell.links(item), index))
            shares = (1.0,) if closed else POURING.outside_shares
            if outside and spills is not None:  # what is in it must not run out before it is there
                shares = tuple(k for k in shares if abs(turned) * k < POURING.outside_margin * spills or k == 1.0)
                if shares == (1.0,):
                    continue
            if outside:
                inside = [_over_rim(stood, how, at, turned * k) * grip for k in shares]
                (end,) = before(cell, target, inside[0])
                start = outside[0].moved((0.0, 0.0, end.position[2] - outside[0].position[2]))
                options.append(Option(side, (start, end, *inside), cell.links(item), index))
    return options


def before(cell: Cell, target: str, first: Pose) -> tuple[Pose, ...]:
    """Return the start of a straight way to ``first``, outside of the niche or cupboard of ``target``; else nothing."""
    place = cell.support(target)
    x, y, z = cell.scene.entry(*place) if place is not None else (0.0, 0.0, -1.0)
    if abs(z) > 0.5:
        return ()
    return (first.moved((-x * GRASP.approach_in_niche, -y * GRASP.approach_in_niche, 0.0)),)


def dip(cell: Cell, item: str, target: str, attempt: int) -> str:
    """Dip ``item`` into ``target`` and bring it out again.

    Raises:
        SkillError: It is not held, cannot be brought there, or did not get in.
    """
    _refuse_fallen(cell, target)
    how = _head(cell, item, cell.holding(item))
    body = cell.scene.bodies[item]
    focus = Pose(_overs(cell, target, POURING.dip_heights[0])[0])
    with cell.leaning(item, lambda: _beside(cell, cell.sim.pose(body).apply(how.at), target) <= 0.0):
        chosen = reach_for(cell, target, lambda: dip_options(cell, item, target), focus, attempt)
        at = cell.sim.pose(body).apply(how.at)
        beside, below = _beside(cell, at, target), _rim_height(cell, target) - at[2]
        cell.load(item)
        cell.moment()
        _go_back(cell, chosen.side)
    lost = cell.leant(item)
    if lost is not None and lost[0] > lost[1]:  # held like this it does not stay level
        cell.unfit_grips.setdefault(item, []).append(cell.in_tool(chosen.side, item).inverse())
    said = f"the end of {item} was {100 * below:.1f} cm below the rim of {target}"
    if below < POURING.dipped_from or beside > 0.0:
        raise SkillError(SkillPhase.EFFECT, said)
    return said


def _head(cell: Cell, item: str, side: str) -> Mouth:
    """Return the part of a held thing that is dipped: the underside of its far end."""
    mouth = mouths(cell, item, side)[0]
    low, _ = cell.scene.size(item)
    x, y, _ = mouth.at
    short = 1.0 - POURING.head_offset / max(hypot(x, y), POURING.head_offset)
    return replace(mouth, at=(x * short, y * short, low[2]))


def dip_options(cell: Cell, item: str, target: str) -> list[Option]:
    """Return ways to bring the end of what is held below a rim and not through it."""
    side = cell.holding(item)
    how, grip = _head(cell, item, side), cell.in_tool(side, item).inverse()
    ignore = cell.links(item) | {(cell.scene.place(target)[0], -1)}  # its lid may not be touched
    (over,) = _overs(cell, target, -POURING.dip_depth)
    ways = list(product(POURING.dip_leans, range(GRASP.headings)))
    inside = [_held_at(_leaning(_heading(number), how, lean), how, over, 0.0) for lean, number in ways]
    touched = _depths(cell, item, target, inside)
    options = []
    for height, (index, there) in product(POURING.dip_heights, enumerate(inside)):
        if touched[index] <= POURING.rim_penetration:
            up = height + POURING.dip_depth
            # above the rim it is level again: what slides off it before falls back
            lean, number = ways[index]
            above = (over[0], over[1], over[2] + up)
            turning = [
                _held_at(_leaning(_heading(number), how, share * lean), how, above, 0.0) * grip
                for share in POURING.level_shares
            ]
            poses = (*turning, there * grip)
            options.append(Option(side, (*before(cell, target, poses[0]), *poses), ignore, index))
    return options


def _heading(number: int) -> Pose:
    return Pose.flat(0.0, 0.0, 0.0, 2 * pi * number / GRASP.headings)


def _depths(cell: Cell, item: str, target: str, poses: Sequence[Pose]) -> list[float]:
    """Return how deep a thing would be in another one at some poses, in metres; it stays in place, to the bit."""
    body, other = cell.scene.bodies[item], cell.scene.place(target)[0]
    motion = cell.sim.motion(body)
    found = []
    try:
        for pose in poses:
            cell.sim.set_pose(body, pose)
            found.append(max((-each.distance for each in cell.sim.closest(body, other, 0.0)), default=0.0))
    finally:
        cell.sim.set_motion(body, motion)
    return found


def _go_back(cell: Cell, side: str) -> None:
    """Bring what was tipped or dipped back the way it came, and tuck the arms."""
    # the same postures: others for the same poses may lead to where the arm would have to turn over
    came_back = cell.robot.move_arm(side, cell.way_in[side][-2::-1])
    if not cell.fold() and not came_back:
        raise SkillError(SkillPhase.EXECUTION, f"the {side} hand did not get back the way it came")


def _refuse_fallen(cell: Cell, target: str) -> None:
    """Refuse to put something into a thing that lies on its side."""
    if cell.scene.is_item(target) and cell.scene.stands(target) and cell.tilt(target) > CONTACT.upright:
        told = f"{target} leans by {degrees(cell.tilt(target)):.0f} degrees"
        raise SkillError(SkillPhase.PRECONDITION, f"{told}: nothing can be put into it")


def _overs(cell: Cell, target: str, height: float) -> list[Vector]:
    """Return points over a rim, or over different places of a basin, at a height above it; best first."""
    if cell.scene.is_item(target):
        opening = cell.scene.opening(target)
        x, y, _ = cell.centre(target)
        if opening is not None:
            x, y, _ = cell.sim.pose(cell.scene.bodies[target]).apply(opening.centre)
        return [(x, y, (cell.top(target) if height > 0 else _rim_height(cell, target)) + height)]
    basin = _basin(cell, target)
    if basin is None:
        x, y, _ = cell.centre(target)
        return [(x, y, cell.top(target) + height)]
    frame, region = basin
    places = dict.fromkeys((x, y) for x, y, _, _ in region.spots)
    points = [frame.apply((x, y, region.low[2] + POURING.basin_depth + height)) for x, y in places]
    return points[: POURING.basin_places]


def _basin(cell: Cell, target: str) -> tuple[Pose, Region] | None:
    """Return the region that is filled from above, and its frame."""
    for whole, region in cell.scene.regions(target, "in"):
        if region.entry[2] < -0.5:
            return cell.scene.frame(whole, region.link), region
    return None


def _rim_height(cell: Cell, target: str) -> float:
    """Return the height of the rim of a vessel, or of its top."""
    opening = cell.scene.opening(target) if cell.scene.is_item(target) else None
    if opening is None:
        return cell.top(target)
    return cell.sim.pose(cell.scene.bodies[target]).apply(opening.centre)[2]


def _held_at(stood: Pose, how: Mouth, at: Vector, angle: float) -> Pose:
    """Return the thing's frame when it is turned by ``angle`` about its tipping axis, with its mouth at a point."""
    turned = stood * Pose.about(how.turn, angle)
    offset = turned.rotate(how.at)
    return Pose((at[0] - offset[0], at[1] - offset[1], at[2] - offset[2]), turned.orientation)


def _over_rim(stood: Pose, how: Mouth, over: Vector, angle: float) -> Pose:
    """Return :func:`_held_at` raised by as much as the thing reaches below its mouth: it comes down as it is tipped."""
    below = max(0.0, how.at[2] * cos(angle))
    return _held_at(stood, how, (over[0], over[1], over[2] + below), angle)


def _leaning(stood: Pose, how: Mouth, angle: float) -> Pose:
    """Return the frame with the mouth's end lower than the rest, by ``angle``."""
    x, y, _ = how.turn
    # across the long side; towards the mouth
    towards = 1.0 if x * how.at[0] + y * how.at[1] > 0 else -1.0
    return stood * Pose.about((-y * towards, x * towards, 0.0), angle)


def _beside(cell: Cell, point: Vector, target: str) -> float:
    """Return the distance of a point from the opening of ``target``, its basin or its box, on the floor plan."""
    opening = cell.scene.opening(target) if cell.scene.is_item(target) else None
    if opening is not None:
        x, y, _ = cell.sim.pose(cell.scene.bodies[target]).apply(opening.centre)
        return max(hypot(point[0] - x, point[1] - y) - opening.radius, 0.0)
    low, high = cell.sim.extents(*cell.scene.place(target))
    basin = None if cell.scene.is_item(target) else _basin(cell, target)
    if basin is not None:
        frame, region = basin
        point, low, high = frame.inverse().apply(point), region.low, region.high
    return max(low[0] - point[0], point[0] - high[0], low[1] - point[1], point[1] - high[1], 0.0)
