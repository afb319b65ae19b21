"""Skills that take things and put them down."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from math import cos, degrees, hypot, pi, sin

import numpy as np

from tmd.robot.assets.features import Frame, Grasp
from tmd.robot.assets.fittings import DOWN, INTO, TIP
from tmd.robot.parameters import CONTACT, GRASP, MOTOR
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.skills.results import SkillError, SkillPhase
from tmd.robot.skills.robot_context import Cell
from tmd.robot.skills.stance_search import Links, Option, follow, reach, reach_for, with_room

# Metres between the fingers of a hand that is about to take something.
_OPEN = 0.08
# Fingers that open less than this (cosine) along the y axis of a thing with a bar are above and below the bar.
_ALONG = 0.7
# Angles to straight down at which what lies is taken.
_LEANS = (0.0, 0.6, -0.6, 1.1, -1.1)
# Metres and radians between grips that count as one.
_ALIKE = (0.03, 0.5)


def pick(cell: Cell, item: str, attempt: int) -> str:
    """Take ``item`` into a free hand.

    Raises:
        SkillError: It cannot be reached, or the fingers close on nothing.
    """
    options = pick_options(cell, item)
    cell.need_free_hand()
    body = cell.scene.bodies[item]
    start = cell.sim.pose(body)
    lies_by_bar = cell.tilt(item) > CONTACT.upright and any(map(_of_bar, cell.scene.grasps(item)))
    for side in cell.free():
        cell.robot.open_gripper(side, GRASP.bar if lies_by_bar else _OPEN)
    chosen = reach(cell, item, options, cell.sim.pose(body), cell.front(item), attempt)
    side = chosen.side
    cell.robot.close_gripper(side)
    if not cell.robot.touches(side, body):
        cell.unfit_grips.setdefault(item, []).append(start.inverse() * chosen.poses[-1])
        cell.robot.open_gripper(side)
        _leave(cell, side, None, chosen.ignore)
        cell.fold()
        raise SkillError(SkillPhase.CONTACT, f"the {side} hand closed and does not touch {item}")
    below = cell.support(item)
    cell.robot.hold(side, body)
    cell.in_hand[side] = item
    x, y, z = cell.scene.entry(*below) if below is not None else (0.0, 0.0, -1.0)
    _leave(cell, side, (-x, -y, -z), cell.links(item))  # the way it is taken out
    cell.moment()
    cell.fold()
    if cell.gap(side, item) > 0.03:
        raise SkillError(SkillPhase.EFFECT, f"{item} slipped out of the {side} hand")
    return f"{item} is in the {side} hand"


def pick_options(cell: Cell, item: str) -> list[Option]:
    """Return ways to take an item with a free hand, the nearest hand first."""
    here = cell.sim.pose(cell.scene.bodies[item])
    links = cell.links(item)
    _, high = cell.scene.size(item)
    # a vessel or a bottle is taken from the side before from above, for it will be tipped; a small thing from above
    upright = 1.0 if cell.scene.holds_contents(item) or high[2] > GRASP.tall else -1.0
    ordered = sorted(cell.scene.grasps(item), key=lambda g: upright * abs(round(g.tool.approach[2], 3)))
    poses = [here * grasp.tool.pose() for grasp in ordered]
    if cell.tilt(item) > CONTACT.upright:
        poses = [_above_ground(cell, item, tool) for tool in _lying(cell, item, poses)]
    poses.sort(key=lambda tool: _held_badly(cell, item, here.inverse() * tool))
    entry = _sideways(cell, item)
    return [
        Option(side, (start, tool), links, number)
        for number, tool in enumerate(poses)
        for start in _starts(tool, entry)
        for side in _nearest_first(cell, here)
    ]


def _held_badly(cell: Cell, item: str, grip: Pose) -> bool:
    """Return whether it was held like this when something could not be done with it."""
    known = cell.unfit_grips.get(item, ())
    return any(grip.distance(other) < _ALIKE[0] and grip.angle(other) < _ALIKE[1] for other in known)


def _above_ground(cell: Cell, item: str, tool: Pose) -> Pose:
    """Return a grasp from above so high that the finger tips do not reach into the ground."""
    x, y, z = tool.position
    lowest = max(cell.sim.extents(cell.scene.bodies[item])[0][2], 0.0) + TIP + GRASP.above_ground
    down = tool.rotate((1.0, 0.0, 0.0))[2] < -GRASP.steep
    return Pose((x, y, max(z, lowest)), tool.orientation) if down else tool


def _lying(cell: Cell, item: str, usual: Sequence[Pose]) -> list[Pose]:
    """Return tool poses for a thing that lies or leans: across its axis, and the usual ones about the fingers' axis.

    Turned so, the fingers meet the same two sides, and the hand comes from where there is room: from above first.
    """
    here = cell.sim.pose(cell.scene.bodies[item])
    low, high = cell.scene.size(item)
    axis = np.array(here.rotate((0.0, 0.0, 1.0)))
    across = np.cross(axis, (0.0, 0.0, 1.0))
    found: list[Pose] = []
    if np.linalg.norm(across) > 0.2:
        across /= np.linalg.norm(across)
        ax, ay, az = (float(value) for value in across)
        if _width(cell, item, here.inverse().rotate((ax, ay, az))) <= GRASP.widest:
            floor = cell.sim.extents(cell.scene.bodies[item])[0][2] + TIP + GRASP.above_ground
            for share in (0.5, 0.35, 0.65, 0.2, 0.8):
                x, y, z = here.apply((0.0, 0.0, low[2] + share * (high[2] - low[2])))
                down = Frame((x, y, max(z, floor)), DOWN, (ax, ay, az)).pose()
                found += [down * Pose.about((0.0, 1.0, 0.0), angle) for angle in _LEANS]
    found += _across(cell, item)
    turns = [number * pi / 4 for number in range(8)]
    bars = [here * grasp.tool.pose() for grasp in cell.scene.grasps(item) if _of_bar(grasp)]
    length = here.rotate((1.0, 0.0, 0.0))
    rolled = [tool.spun(Pose.about(length, angle)) for tool in bars for angle in turns]
    found += [tool * Pose.about((0.0, 1.0, 0.0), angle) for tool in (*usual, *rolled) for angle in turns]
    kept = [tool for tool in found if tool.rotate((1.0, 0.0, 0.0))[2] < 0.3]
    return sorted(kept, key=lambda tool: round(tool.rotate((1.0, 0.0, 0.0))[2], 1))[: GRASP.most_lying]


def _across(cell: Cell, item: str) -> list[Pose]:
    """Return tool poses from above across each level side of a thing that the fingers get round, its middle first."""
    here = cell.sim.pose(cell.scene.bodies[item])
    low, high = cell.scene.size(item)
    middle = [(a + b) / 2 for a, b in zip(low, high, strict=True)]
    spans = [b - a for a, b in zip(low, high, strict=True)]
    sides = [here.rotate(unit) for unit in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]
    level = [side for side in range(3) if abs(sides[side][2]) < GRASP.level]
    found = []
    for side in level:
        if spans[side] > GRASP.widest:
            continue
        x, y, _ = sides[side]
        length = hypot(x, y)
        along = [other for other in level if other != side]
        for share in (0.0, -0.15, 0.15, -0.3, 0.3) if along else (0.0,):
            at = list(middle)
            if along:
                at[along[0]] += share * spans[along[0]]
            down = Frame(here.apply((at[0], at[1], at[2])), DOWN, (x / length, y / length, 0.0)).pose()
            found += [down * Pose.about((0.0, 1.0, 0.0), angle) for angle in _LEANS]
    return found


def _of_bar(grasp: Grasp) -> bool:
    """Return whether it is a grasp of a bar along x, taken from its end, round which the hand may be anywhere."""
    return grasp.opening < GRASP.bar and grasp.tool.approach == INTO


def _width(cell: Cell, item: str, along: Vector) -> float:
    """Return the width of an item along a level direction of its own frame; round things are as wide as in y."""
    low, high = cell.scene.size(item)
    depth, width = high[0] - low[0], high[1] - low[1]
    if cell.scene.opening(item) is not None or abs(depth - width) < 0.01:
        return width
    return abs(along[0]) * depth + abs(along[1]) * width


def _sideways(cell: Cell, item: str) -> Vector | None:
    """Return the direction in which the hand enters the niche or the cupboard that an item is in."""
    place = cell.support(item)
    entry = cell.scene.entry(*place) if place is not None else (0.0, 0.0, -1.0)
    return None if abs(entry[2]) > 0.5 else entry


def _starts(tool: Pose, entry: Vector | None) -> list[Pose]:
    """Return the starts of a straight way to a thing: outside of its niche if the fingers pass it, or close."""
    close = tool * Pose((-GRASP.approach, 0.0, 0.0))
    if entry is None:
        return [close]
    across = sum(a * b for a, b in zip(tool.rotate((0.0, 1.0, 0.0)), entry, strict=True))
    outside = tool.moved([-GRASP.approach_in_niche * value for value in entry])
    return [close] if abs(across) > GRASP.max_opening_along else [outside, close]


def place(cell: Cell, item: str, target: str, relation: str, attempt: int, *, filled: bool = False) -> str:
    """Put ``item`` down on, in or next to ``target``, upright.

    A ``filled`` item is to be filled there by a stream from a spout, so it goes below that and nowhere else; any vessel
    goes there if there is room.

    Raises:
        SkillError: It is not held, there is no room, the place cannot be reached, or the item ends up elsewhere, or
            falls over.
    """
    side = cell.holding(item)
    below, others = place_options(cell, side, item, target, relation)
    nothing_lost = not cell.scene.shown(item) or cell.spills_from(item) is None
    if others and nothing_lost and not filled and not with_room(cell, (*below, *others)):
        others = laid_options(cell, side, item, target, relation)
    if filled and not below and cell.scene.spouts(cell.whole(target)):
        raise SkillError(SkillPhase.PRECONDITION, f"there is no room for {item} below {_occupied(cell, item, target)}")
    if not below and not others:
        told = _standing_there(cell, item, target, relation)
        raise SkillError(SkillPhase.PRECONDITION, f"there is no room for {item} {relation} {target}{told}")
    groups = [group for group in ((below,) if filled and below else (below, others)) if group]
    for options in groups:
        focus = options[0].poses[-1] * cell.in_tool(side, item)
        try:
            _reach_best(cell, item, options, focus, target, relation, attempt)
        except SkillError as error:
            if error.stage not in (SkillPhase.STANCE, SkillPhase.PATH) or options is groups[-1]:
                raise
        else:
            break
    return _put_down(cell, side, item, target, relation)


def _put_down(cell: Cell, side: str, item: str, target: str, relation: str) -> str:
    _release(cell, side, item)
    cell.moment()
    _leave(cell, side, None, cell.links(item))
    cell.fold()
    cell.settle()
    now = cell.support(item)
    if now != (target, relation):
        where = f"{now[1]} {now[0]}" if now else "nowhere"
        raise SkillError(SkillPhase.EFFECT, f"{item} was put down, and is {where}")
    if cell.fallen(item):
        raise SkillError(SkillPhase.EFFECT, f"{item} was put down, and leans by {degrees(cell.tilt(item)):.0f} degrees")
    return f"{item} is {relation} {target}"


def _occupied(cell: Cell, item: str, target: str) -> str:
    """Return the spout that an item is to be filled at, and what stands below it."""
    whole = cell.whole(target)
    frame = cell.sim.pose(cell.scene.bodies[whole])
    for part, at in cell.scene.spouts(whole).items():
        x, y, z = frame.apply(at)
        for other in cell.scene.items():
            low, high = cell.sim.extents(cell.scene.bodies[other])
            if other != item and low[2] < z and low[0] - 0.1 < x < high[0] + 0.1 and low[1] - 0.1 < y < high[1] + 0.1:
                return f"{part}: {other} is in the way"
    return next(iter(cell.scene.spouts(whole)))


def _standing_there(cell: Cell, item: str, target: str, relation: str) -> str:
    there = [other for other in cell.scene.items() if other != item and cell.support(other) == (target, relation)]
    return f": {', '.join(there[:4])} {'stands' if len(there) == 1 else 'stand'} there" if there else ""


def _reach_best(
    cell: Cell, item: str, options: Sequence[Option], focus: Pose, target: str, relation: str, attempt: int
) -> None:
    """Bring a thing to its place, best so that the empty hand gets away, and gets at it again."""
    if cell.side_of(cell.whole(target)) is not None:  # into what is in the other hand, which holds it out
        side = options[0].side

        def options_now() -> list[Option]:
            below, others = place_options(cell, side, item, target, relation)
            return [*below, *others]

        reach_for(cell, target, options_now, focus, attempt, stop=2)
        return
    fitting = with_room(cell, options)
    again = _to_be_taken_again(cell, item, fitting, cell.scene.entry(target, relation)) or fitting
    away = [
        replace(option, poses=(*option.poses, option.poses[-1] * Pose((-GRASP.retreat, 0.0, 0.0)))) for option in again
    ]
    for chosen in (away, again, fitting):
        try:
            reach(cell, f"{relation} {target}", chosen, focus, cell.front(target), attempt, stop=2)
        except SkillError as error:
            if error.stage is not SkillPhase.STANCE or chosen is fitting:
                raise
        else:
            return


def place_options(cell: Cell, side: str, item: str, target: str, relation: str) -> tuple[list[Option], list[Option]]:
    """Return ways to put an item down with the hand that holds it: where a stream runs into it, and elsewhere."""
    grip = cell.in_tool(side, item).inverse()
    back = tuple(-value * GRASP.approach for value in cell.scene.entry(target, relation))
    links = cell.links(item)
    found: tuple[list[Option], list[Option]] = ([], [])
    every = cell.scene.support(target, relation, item, cell.in_hand.values())
    unfit = cell.unfit_spots.get(item, ())
    fit = [spot for spot in every if all(spot.pose.distance(other) > GRASP.unfit for other in unfit)] or every
    spots = [*(spot for spot in fit if spot.outlet), *[spot for spot in fit if not spot.outlet][:6]]
    heights = GRASP.upright_heights if cell.scene.stands(item) else GRASP.release_heights
    for fall, (number, spot), turn in product(heights, enumerate(spots), range(GRASP.headings)):
        stood = spot.pose * Pose.flat(0.0, 0.0, fall, 2 * pi * turn / GRASP.headings)
        tool = stood * grip
        found[not spot.outlet].append(Option(side, (tool.moved(back), tool), links, number))
    return found


def laid_options(cell: Cell, side: str, item: str, target: str, relation: str) -> list[Option]:
    """Return ways to let go of an item just above a place, as it is held, with the hand straight above it.

    It lies there, or falls over, and can be taken in another way: as it is held it can be put down upright nowhere.
    """
    grip = cell.in_tool(side, item)
    low, high = cell.scene.size(item)
    links = cell.links(item)
    found = []
    for number, spot in enumerate(cell.scene.support(target, relation, item, cell.in_hand.values())[:6]):
        x, y, z = spot.pose.position
        for turn in range(GRASP.headings):
            angle = 2 * pi * turn / GRASP.headings
            down = Frame((x, y, z), DOWN, (cos(angle), sin(angle), 0.0)).pose()
            held = down * grip
            lowest = min(held.apply(corner)[2] for corner in product(*zip(low, high, strict=True)))
            middle = held.apply(tuple((a + b) / 2 for a, b in zip(low, high, strict=True)))
            tool = down.moved((x - middle[0], y - middle[1], z - lowest + GRASP.release_heights[-1]))
            found.append(Option(side, (tool.moved((0.0, 0.0, GRASP.approach)), tool), links, number))
    return found


def _to_be_taken_again(cell: Cell, item: str, options: Sequence[Option], entry: Vector) -> list[Option]:
    """Select ways to put a thing into a niche or a cupboard after which a grasp points the way the hand enters."""
    if abs(entry[2]) > 0.5:
        return []
    grasps = [grasp.tool.pose().rotate((1.0, 0.0, 0.0)) for grasp in cell.scene.grasps(item)]

    def along(option: Option) -> float:
        stood = option.poses[-1] * cell.in_tool(option.side, item)
        return max(sum(a * b for a, b in zip(stood.rotate(each), entry, strict=True)) for each in grasps)

    return [option for option in options if along(option) > GRASP.min_alignment]


def drop(cell: Cell, item: str, target: str, attempt: int) -> str:
    """Let go of ``item`` over ``target``: it is put down if that can be reached, and otherwise falls on the floor.

    Raises:
        SkillError: As :func:`place`.
    """
    if target != "floor":
        return place(cell, item, target, "on", attempt)
    side = cell.holding(item)
    cell.robot.raise_torso(0.0)
    _release(cell, side, item)
    cell.moment()
    cell.fold()
    now = cell.support(item)
    if now != (target, "on"):
        where = f"{now[1]} {now[0]}" if now else "nowhere"
        raise SkillError(SkillPhase.EFFECT, f"{item} was let go of, and is {where}")
    return f"{item} is on the floor"


def _gap_to_let_go(cell: Cell, side: str, item: str) -> float:
    """Return the gap of a hand that lets go: as wide as possible, or small if a finger is behind a bar."""
    _, across, _ = cell.in_tool(side, item).inverse().rotate((0.0, 1.0, 0.0))
    behind = abs(across) < _ALONG and any(map(_of_bar, cell.scene.grasps(item)))
    return GRASP.bar if behind else MOTOR.gripper_gap


def _release(cell: Cell, side: str, item: str) -> None:
    wide = _gap_to_let_go(cell, side, item)
    cell.robot.let_go(side)
    cell.in_hand.pop(side, None)
    cell.robot.open_gripper(side, wide)  # a finger that still touches it would drag it along
    cell.settle()


def _leave(cell: Cell, side: str, away: Vector | None, ignore: Links) -> None:
    """Draw the hand back: along ``away``, or the way it points; a little if there is no room for more.

    If that is not possible either, it is left to the planner of the next motion.
    """
    here = cell.robot.tool(side)
    for share in (1.0, 0.5):
        back = here * Pose((-GRASP.approach * share, 0.0, 0.0))
        goal = back if away is None else here.moved([value * GRASP.lift * share for value in away])
        try:
            follow(cell, side, (goal,), ignore)
        except SkillError:
            continue
        return


def _nearest_first(cell: Cell, pose: Pose) -> list[str]:
    """Return the free arms, first the one on whose side a thing is."""
    _, left, _ = cell.robot.base_link().inverse().apply(pose.position)
    order = ("left", "right") if left > 0 else ("right", "left")
    return [side for side in order if side in cell.free()]
