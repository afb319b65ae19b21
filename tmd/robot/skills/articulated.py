"""Skills that work joints: doors, drawers, lids, knobs and buttons."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import copysign, cos, degrees, pi, sin

from tmd.robot.assets.fittings import TIP
from tmd.robot.parameters import ARTICULATION
from tmd.robot.pr2.quick_checks import HandChecker
from tmd.robot.scene.scene import Handle
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.sim.simulator import Simulator
from tmd.robot.skills.results import SkillError, SkillPhase
from tmd.robot.skills.robot_context import Base, Cell
from tmd.robot.skills.stance_search import Accept, Links, Option, follow, reach, reach_for

_PULLED, _PUSHED = 0, 1
# Radians by which the hand is turned about the way a finger points.
_ROLLS = (0.0, pi / 2)
# A lid's tab is taken from the front, or from a side: then the hand points along the hinge, and only rolls.
_SIDES = (
    Pose((0.0, 0.0, 0.0)),
    Pose((0.0, 0.0, 0.0), (0.5, 0.5, 0.5, 0.5)),
    Pose((0.0, 0.0, 0.0), (0.5, -0.5, -0.5, 0.5)),
)


def swing(cell: Cell, name: str, attempt: int, *, opened: bool) -> str:
    """Open or close a door, a drawer or a lid by its handle.

    Raises:
        SkillError: It has none, cannot be reached, or does not move.
    """
    cell.need_free_hand()
    if opened:
        _refuse_to_spill(cell, name)
    for _ in range(ARTICULATION.stages):
        _swing_somehow(cell, name, attempt, _goals(cell, name, opened))
        if cell.is_open(name) == opened:
            return cell.how_open(name)
    raise SkillError(SkillPhase.EFFECT, f"{cell.how_open(name)} after it was moved")


def _refuse_to_spill(cell: Cell, name: str) -> None:
    """Refuse to open what lies as long as something is in it."""
    if not cell.scene.is_item(name) or not cell.scene.shown(name):
        return
    limit, tilt = cell.spills_when_open_from(name), cell.tilt(name)
    if limit is not None and tilt > limit:
        told = f"{name} leans by {degrees(tilt):.0f} degrees: what is in it would run out"
        raise SkillError(SkillPhase.PRECONDITION, told)


def _swing_somehow(cell: Cell, name: str, attempt: int, goals: Sequence[Sequence[float]]) -> None:
    last = SkillError(SkillPhase.STANCE, f"{name} cannot be moved any farther")
    for each in goals:
        try:
            _swing(cell, name, attempt, each)
        except SkillError as error:
            if error.stage not in (SkillPhase.STANCE, SkillPhase.PATH):
                raise
            last = error
        else:
            return
    raise last


def _goals(cell: Cell, name: str, opened: bool) -> list[tuple[float, ...]]:
    """Return goals of how far open a thing may be at the end, best first.

    If no place lets a hand get all the way, a part of it is done from here, and the rest from elsewhere.
    """
    now, door = cell.way(name), _handle(cell, name).kind == "door"
    if not opened:
        return [(0.0,), *([tuple(now - piece for piece in ARTICULATION.partial_shares if now > piece)] if door else [])]
    wide: list[tuple[float, ...]] = [(part,) for part in ARTICULATION.open_shares]
    further = tuple(now + piece for piece in ARTICULATION.partial_shares if now + piece < ARTICULATION.open_shares[2])
    return [*wide, further] if door else wide


def _swing(cell: Cell, name: str, attempt: int, goals: Sequence[float]) -> None:
    handle = _handle(cell, name)
    for side in cell.free():
        cell.robot.open_gripper(side, handle.opening)
    chosen = reach_for(
        cell, name, lambda: swing_options(cell, name, goals), handle.grasp, attempt, stop=2,
        front=_aside(cell, name, handle), accept=_out_of_its_way(cell, name, handle),
    )  # fmt: skip
    _pull(cell, name, _handle(cell, name), chosen)
    cell.moment()
    cell.retire(chosen.side, chosen.ignore, lid=handle.kind == "lid")


def _aside(cell: Cell, name: str, handle: Handle) -> float | None:
    """Return the heading from which a door is best opened: its front, and somewhat off the side of its hinges."""
    front = cell.front(name)
    if front is None or handle.kind != "door":
        return front
    x, y, _ = (a - b for a, b in zip(_closed_grasp(cell, name, handle), handle.origin, strict=True))
    across = -sin(front) * x + cos(front) * y
    return front + copysign(ARTICULATION.bearing, across)


def _closed_grasp(cell: Cell, name: str, handle: Handle) -> Vector:
    start = cell.sim.joint_position(handle.body, handle.index)
    cell.sim.set_joint(handle.body, handle.index, handle.closed)
    shut = _handle(cell, name).grasp.position
    cell.sim.set_joint(handle.body, handle.index, start)
    return shut


def _out_of_its_way(cell: Cell, name: str, handle: Handle) -> Accept:
    """Return a check whether a door passes the robot, which remembers its answers."""
    known: dict[tuple[Base, float, str], bool] = {}

    def accept(option: Option, base: Base) -> bool:
        key = base, option.part, option.side
        if key not in known:
            known[key] = not cell.sweeps(name, base, goal=_end(handle, option.part), side=option.side)
        return known[key]

    return accept


def swing_options(cell: Cell, name: str, goals: Sequence[float]) -> list[Option]:
    """Return ways to open or close something with a free hand; ``spot`` of an option: whether it is pulled or pushed.

    ``goals`` are shares of the whole way (1 is as far as it goes), best first.
    """
    handle, hands = _handle(cell, name), cell.free()
    start = cell.sim.joint_position(handle.body, handle.index)
    # what is in a drawer is no longer there when the hand is where it was
    ignore: Links = frozenset({(handle.body, handle.index), *((body, None) for body in cell.in_drawer(handle))})
    options = []
    for part in goals:
        goal = _end(handle, part)
        tools = _tools(cell, name, handle, start, goal)
        ways = list(_ways(handle, tools, goal - start))
        if handle.kind == "door" and part < cell.way(name):
            pushed = {share: tool * Pose((-TIP, 0.0, 0.0)) for share, tool in tools.items()}
            ways += _ways(handle, pushed, goal - start, ARTICULATION.pushes)
        found = [Option(side, poses, ignore, spot, part) for spot, poses in ways for side in hands]
        options += _beside(cell, handle, goal, found) if handle.kind == "lid" else found
    return options


def _beside(cell: Cell, handle: Handle, goal: float, options: Sequence[Option]) -> list[Option]:
    """Return the ways along which a lid does not swing into the hand that lifts it."""
    start = cell.sim.joint_position(handle.body, handle.index)
    kept = list(options)
    for side in sorted({option.side for option in options}):
        checker = HandChecker(cell.robot, side, only=(handle.body, handle.index))
        for number in range(ARTICULATION.waypoints + 1):
            cell.sim.set_joint(handle.body, handle.index, start + number / ARTICULATION.waypoints * (goal - start))
            mine = [option for option in kept if option.side == side]
            depths = checker.depth([option.poses[1 + number] for option in mine])
            struck = [
                option for option, depth in zip(mine, depths, strict=True) if depth > ARTICULATION.lid_penetration
            ]
            kept = [option for option in kept if all(option is not other for other in struck)]
    cell.sim.set_joint(handle.body, handle.index, start)
    return kept


def _end(handle: Handle, part: float) -> float:
    return handle.closed + part * (handle.open - handle.closed)


def _ways(
    handle: Handle, tools: Mapping[float, Pose], way: float, headings: Sequence[tuple[float, float]] | None = None
) -> Iterator[tuple[int, tuple[Pose, ...]]]:
    """Yield tool poses that move a handle (before it, at it, and along), each with whether it is pushed."""
    pushes = handle.kind == "flap" or headings is not None
    if headings is None:
        headings = ARTICULATION.pushes if pushes else ARTICULATION.pulls if handle.turns else ARTICULATION.pulls[:1]
    held = (
        [(side, heading) for heading in ARTICULATION.lifts for side in _SIDES]
        if handle.kind == "lid"
        else [(_SIDES[0], heading) for heading in headings]
    )
    for side, (lead, follows) in held:
        turned = [_turned(tool * side, handle, (share - lead) * way * follows, pushes) for share, tool in tools.items()]
        yield _PUSHED if pushes else _PULLED, (turned[0] * Pose((-ARTICULATION.approach, 0.0, 0.0)), *turned)


def _tools(cell: Cell, name: str, handle: Handle, start: float, goal: float) -> dict[float, Pose]:
    """Return the tool at the handle for shares of the way, if the hand turned with it."""
    found = {}
    for number in range(ARTICULATION.waypoints + 1):
        share = number / ARTICULATION.waypoints
        cell.sim.set_joint(handle.body, handle.index, start + share * (goal - start))
        found[share] = _handle(cell, name).grasp
    cell.sim.set_joint(handle.body, handle.index, start)
    return found


def _turned(tool: Pose, handle: Handle, angle: float, pushes: bool) -> Pose:
    """Return ``tool`` turned back about the joint's axis: through the handle, or through the finger tips that push."""
    tips = TIP if pushes else 0.0
    turned = Pose(tool.apply((tips, 0.0, 0.0)), tool.orientation).spun(Pose.about(handle.axis, -angle))
    return turned * Pose((-tips, 0.0, 0.0))


def _pull(cell: Cell, name: str, handle: Handle, option: Option) -> None:
    side = option.side
    if option.spot == _PUSHED:
        with cell.pushed(side, handle):
            follow(cell, side, option.poses[2:], option.ignore)
        return
    if cell.loose(handle):  # the fingers stand round its edge and do not press
        if cell.gap(side, name) > ARTICULATION.lid_gap:
            raise SkillError(SkillPhase.CONTACT, f"the {side} hand is {100 * cell.gap(side, name):.1f} cm from {name}")
    else:
        cell.robot.close_gripper(side)
        if not cell.robot.touches(side, handle.body, handle.index):
            raise SkillError(SkillPhase.CONTACT, f"the {side} hand closed and does not touch the handle of {name}")
    try:
        with cell.gripped(side, handle):
            follow(cell, side, option.poses[2:], option.ignore)
    finally:
        cell.robot.open_gripper(side, handle.opening)


def push(cell: Cell, name: str, attempt: int) -> str:
    """Press a button with closed fingers.

    Raises:
        SkillError: It cannot be reached, or does not go down.
    """
    handle = _handle(cell, name)
    hands = cell.need_free_hand()
    button: Links = frozenset({(handle.body, handle.index)})

    def options() -> list[Option]:
        touch = _handle(cell, name).grasp
        before = touch * Pose((-ARTICULATION.approach, 0.0, 0.0))
        return [
            Option(side, (_rolled(before, roll), _rolled(touch, roll)), button, number)
            for number, roll in enumerate(_ROLLS)
            for side in hands
        ]

    for side in hands:
        cell.robot.open_gripper(side, 0.0)
    share = 0.0

    def note_depth(sim: Simulator) -> None:
        nonlocal share
        at = sim.joint_position(handle.body, handle.index)
        share = max(share, (at - handle.closed) / (handle.open - handle.closed))

    chosen = reach_for(cell, name, options, handle.grasp, attempt)
    held = cell.side_of(cell.whole(name)) is not None
    depth, touch = ARTICULATION.button_share * abs(handle.open - handle.closed), handle.grasp
    if held:  # it has come along with the other hand, and may be pressed a little already
        touch = _handle(cell, name).grasp
        depth -= abs(cell.sim.joint_position(handle.body, handle.joint) - handle.closed)
    beyond = touch * Pose((max(depth, 0.0), 0.0, 0.0))
    # a finger tip is wider than the buttons of what fits into a hand
    ignore: Links = button | {(handle.body, None)} if held else button
    roll = _ROLLS[chosen.spot]
    cell.sim.add_watcher(note_depth)
    try:
        with cell.pushed(chosen.side, handle):
            follow(cell, chosen.side, (_rolled(beyond, roll),), ignore)
            if cell.robot.kinematic:
                cell.sim.tick()  # the joint went along after others were told: all see it at its deepest
        touched = cell.robot.touches(chosen.side, handle.body, handle.index)
        cell.moment()
    finally:
        cell.sim.remove_watcher(note_depth)
    cell.come_back(handle)
    cell.retire(chosen.side, ignore)
    if not touched:
        raise SkillError(SkillPhase.CONTACT, f"the finger does not touch {name}")
    if share < ARTICULATION.pressed_share:
        raise SkillError(SkillPhase.EFFECT, f"{name} went down {100 * share:.0f} % of its way")
    return f"{name} went down {100 * min(share, 1.0):.0f} % of its way"


def rotate(cell: Cell, name: str, setting: str, attempt: int) -> str:
    """Turn a knob to a setting.

    Raises:
        SkillError: It has no such setting, cannot be reached, or does not turn.
    """
    handle = _handle(cell, name)
    if setting not in handle.settings:
        raise SkillError(SkillPhase.PRECONDITION, f"{name} has no setting {setting}")
    hands = cell.need_free_hand()
    ignore: Links = frozenset({(handle.body, handle.index)})
    start = cell.sim.joint_position(handle.body, handle.index)
    goal = handle.settings[setting]
    tools = _tools(cell, name, handle, start, goal)
    options = []
    for number, roll in enumerate((0.0, pi)):
        poses = [_rolled(tool, roll) for tool in tools.values()]
        before = poses[0] * Pose((-ARTICULATION.approach, 0.0, 0.0))
        options += [Option(side, (before, *poses), ignore, number) for side in hands]
    for side in hands:
        cell.robot.open_gripper(side, handle.opening)
    chosen = reach(cell, name, options, handle.grasp, cell.front(name), attempt, stop=2)
    _pull(cell, name, handle, chosen)
    cell.moment()
    cell.retire(chosen.side, ignore)
    if cell.setting(name) != setting:
        raise SkillError(SkillPhase.EFFECT, f"{name} was turned, and is at {cell.setting(name) or 'no setting'}")
    return f"{name} is at {setting}"


def _handle(cell: Cell, name: str) -> Handle:
    handle = cell.scene.handle(name)
    if handle is None:
        raise SkillError(SkillPhase.PRECONDITION, f"{name} has nothing to work it by")
    return handle


def _rolled(tool: Pose, angle: float) -> Pose:
    """Return the tool turned about the way it points."""
    return tool * Pose.about((1.0, 0.0, 0.0), angle)
