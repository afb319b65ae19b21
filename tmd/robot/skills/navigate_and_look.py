"""Skills without hands: look, drive, wait."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice, product
from math import atan2, cos, degrees, dist, sin

from tmd.robot.monitor.observation import REACH
from tmd.robot.parameters import BASE_MOTION, STANCE
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.sim.simulator import STEPS_PER_SECOND
from tmd.robot.skills.pick_and_place import pick_options
from tmd.robot.skills.results import SkillError, SkillPhase
from tmd.robot.skills.robot_context import Base, Cell
from tmd.robot.skills.stance_search import candidates, get_to, stances

_SHIFTS = (0.15, 0.3, 0.45)
_SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1), (0.7, 0.7), (-0.7, 0.7), (0.7, -0.7), (-0.7, -0.7))
_FARTHER = (*STANCE.distances, 1.1)


def look(cell: Cell, name: str) -> str:
    """Turn the head, and if need be the base, until a thing is in view.

    Raises:
        SkillError: It is not seen from anywhere.
    """
    if name in cell.in_hand.values():
        return f"{name} is in a hand"
    point = cell.centre(name)
    if seen := _seen(cell, name, point):
        return seen
    tried = 0
    for base, torso in _lookouts(cell, name, point):
        tried += 1
        try:
            get_to(cell, base, torso)
        except SkillError:
            continue
        if seen := _seen(cell, name, point):
            return seen
    raise SkillError(SkillPhase.EFFECT, f"{name} is not in view from {tried} places")


def _lookouts(cell: Cell, name: str, point: Vector) -> Iterator[tuple[Base, float]]:
    """Yield places from which nothing hides a thing, the nearest ones first: what the robot is near to stays near."""
    robot = cell.robot
    x, y, _ = here = robot.base()
    low = robot.torso()
    body, _ = cell.scene.place(name)
    steps = [(dx, dy) for size in _SHIFTS for dx, dy in _SIDES for dx, dy in [(size * dx, size * dy)]]
    bases: list[Base] = [(x, y, atan2(point[1] - y, point[0] - x))]
    bases += [(x + dx, y + dy, atan2(point[1] - y - dy, point[0] - x - dx)) for dx, dy in steps]
    bases += [base for base in stances(cell, Pose(point), cell.front(name)) if base != here]
    found = 0
    free = robot.free_bases(bases)
    hidden: list[tuple[Base, float]] = []
    for base in (base for base, possible in zip(bases, free, strict=True) if possible):
        eye = (robot.base_link(base) * robot.base_link().inverse() * robot.eye()).position
        for torso in (low, 0.3):
            above = (eye[0], eye[1], eye[2] + torso - low)
            hits = [cell.sim.ray(_past_robot(above, spot), spot) for spot in _spots(cell, name, point)]
            if any(hit is None or hit.body in (body, robot.body) for hit in hits):
                found += 1
                yield base, torso
                break
        else:
            hidden.append((base, low))
        if found == BASE_MOTION.max_lookouts:
            return
    yield from hidden[: BASE_MOTION.max_lookouts - found]  # the robot itself may have been in the way of a ray


def _past_robot(eye: Vector, spot: Vector) -> Vector:
    """Return the start of a ray: not the eye, since the robot stands elsewhere now, and may stand there."""
    share = min(BASE_MOTION.head_radius / max(dist(eye, spot), 1e-6), 0.9)
    x, y, z = (a + share * (b - a) for a, b in zip(eye, spot, strict=True))
    return (x, y, z)


def _spots(cell: Cell, name: str, point: Vector) -> tuple[Vector, ...]:
    """Return the points of a thing that are looked at: its middle, its top, two corners of its box."""
    low, high = cell.sim.extents(*cell.scene.place(name))
    middle = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2)
    return point, (*middle, high[2] - 0.005), (low[0], low[1], high[2]), (high[0], high[1], high[2])


def _seen(cell: Cell, name: str, point: Vector) -> str:
    cell.robot.look_at(point)
    body, _ = cell.scene.place(name)
    for spot in _spots(cell, name, point):
        if cell.robot.sees(spot, body):
            pan = degrees(cell.robot.positions()["head_pan_joint"])
            return f"{name} is in view, {dist(cell.robot.eye().position, spot):.1f} m away, pan {pan:.0f}"
    return ""


def drive(cell: Cell, name: str, attempt: int) -> str:
    """Go and stand before a thing, if it can be where it can be taken.

    Raises:
        SkillError: There is no place, or no way.
    """
    last = SkillError(SkillPhase.STANCE, f"there is no place to stand before {name}")
    focus = Pose(cell.centre(name))
    options = pick_options(cell, name) if cell.scene.is_item(name) and cell.free() else []
    found = list(islice(candidates(cell, options, focus, cell.front(name), BASE_MOTION.brief_budget), 2 + attempt))
    places: list[tuple[Base, float]] = [(c.base, c.torso) for c in found[attempt:]]
    clear = _stances_before(cell, name)
    if not (places or clear) and cell.fold():  # one hand is at what the other holds
        clear = _stances_before(cell, name)
    here = cell.robot.torso()
    places += [(base, here) for base in clear]
    for base, torso in places:
        cell.look_on(f"the way to {name}")
        try:
            get_to(cell, base, torso)
        except SkillError as error:
            last = error
            continue
        cell.robot.look_at(focus.position)
        if cell.reach(name) <= REACH:
            return f"{name} is {cell.reach(name):.2f} m away"
        last = SkillError(SkillPhase.EFFECT, f"{name} is {cell.reach(name):.2f} m away")
    raise last


def _stances_before(cell: Cell, name: str) -> list[Base]:
    """Return some places with room to stand near a thing, as the arms are now.

    If none is before a part, a door that stands open, they are before its whole.
    """
    clear: list[Base] = []
    for each in dict.fromkeys((name, cell.whole(name))):
        around = stances(cell, Pose(cell.centre(each)), cell.front(each), _FARTHER)
        near = (b for b in around if cell.reach(name, b) <= REACH and not cell.robot.collides(base=b))
        clear = clear or list(islice(near, BASE_MOTION.max_stances))
    return clear


def step_back(cell: Cell, door: str) -> None:
    """Make room for a door that is about to open, as little as is needed, if there is any behind the robot."""
    x, y, theta = cell.robot.base()
    for away, turn in dict.fromkeys(
        (away, turn if away else 0.0) for away, turn in product(BASE_MOTION.steps_back, BASE_MOTION.steps_aside)
    ):
        base = (x - away * cos(theta + turn), y - away * sin(theta + turn), theta)
        if (away and cell.robot.collides(base=base)) or cell.sweeps(door, base):
            continue
        try:
            get_to(cell, base, cell.robot.torso())
        except SkillError:
            continue
        return


def wait(cell: Cell, seconds: float) -> str:
    """Let time pass."""
    cell.sim.step(round(seconds * STEPS_PER_SECOND))
    return f"{seconds:g} s went by"
