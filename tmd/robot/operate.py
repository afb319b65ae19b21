"""Skills that work joints: doors, drawers, lids, knobs and buttons."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import cos, pi, sin

from tmd.robot.cell import Cell
from tmd.robot.fittings import TIP
from tmd.robot.outcome import SkillError, Stage
from tmd.robot.pose import Pose
from tmd.robot.reach import Links, Option, follow, reach
from tmd.robot.scene import Handle
from tmd.robot.simulator import Simulator

BEFORE = 0.09
TRAVEL = 0.012
"""Metres that a finger goes on beyond the surface of a button."""
_ROUND = 0.02
"""Metres from the fingers to the lid between them."""
PRESSED = 0.5
"""A button is pressed from this share of its way on."""
_WAYPOINTS = 8
_PUSHES = ((0.5, 1.0), (0.75, 1.0), (0.3, 1.0), (1.0, 1.0), (0.0, 0.5))
"""How a flap, or a door that is to be shut, is pushed."""
_PARTS = (1.0, 0.8, 0.65)
"""How far a door is opened, as a part of its way."""
_PULLS = ((0.0, 1.0), (0.0, 0.5), (0.0, 0.0), (0.5, 1.0), (1.0, 1.0), (0.5, 0.5))
"""How a handle is held: at which part of its way the hand is square to it, and how far it keeps its heading."""
_PULLED, _PUSHED = 0, 1


def swing(cell: Cell, name: str, attempt: int, *, opened: bool) -> str:
    """Open or close a door, a drawer or a lid by its handle.

    Raises:
        SkillError: It has none, cannot be reached, or does not move.
    """
    handle = _handle(cell, name)
    start = cell.sim.joint_position(handle.body, handle.index)
    hands = cell.free()
    if not hands:
        raise SkillError(Stage.PRECONDITION, "both hands are full")
    ignore: Links = frozenset({(handle.body, handle.index)})
    options = []
    for part in _PARTS if opened else (1.0,):
        goal = start + part * ((handle.open if opened else handle.closed) - start)
        tools = _tools(cell, name, handle, start, goal)
        options += [
            Option(side, poses, ignore, spot) for spot, poses in _ways(handle, tools, goal - start) for side in hands
        ]
        if not opened and handle.turns and handle.kind == "door":
            pushed = {share: tool * Pose((-TIP, 0.0, 0.0)) for share, tool in tools.items()}
            ways = _ways(handle, pushed, goal - start, _PUSHES)
            options += [Option(side, poses, ignore, _PUSHED) for _, poses in ways for side in hands]
    for side in hands:
        cell.robot.open_gripper(side, handle.opening)
    middle = options[0].poses[len(options[0].poses) // 2]
    chosen = reach(cell, options, middle, cell.front(name), attempt, stop=2)
    _pull(cell, name, handle, chosen)
    cell.retire(chosen.side, ignore)
    if cell.is_open(name) != opened:
        raise SkillError(Stage.EFFECT, f"{cell.how_open(name)} after it was pulled")
    return cell.how_open(name)


def _ways(
    handle: Handle, tools: Mapping[float, Pose], way: float, headings: Sequence[tuple[float, float]] | None = None
) -> Iterator[tuple[int, tuple[Pose, ...]]]:
    """Tool poses that move a handle, each with whether it is pushed: before it, at it, and along."""
    pushes = handle.kind == "flap" or headings is not None
    if headings is None:
        headings = _PUSHES if pushes else _PULLS if handle.turns else _PULLS[:1]
    for lead, follows in headings:
        turned = [_turned(tool, handle, (share - lead) * way * follows, pushes) for share, tool in tools.items()]
        yield _PUSHED if pushes else _PULLED, (turned[0] * Pose((-BEFORE, 0.0, 0.0)), *turned)


def _tools(cell: Cell, name: str, handle: Handle, start: float, goal: float) -> dict[float, Pose]:
    """The tool at the handle for shares of the way, if the hand turned with it."""
    found = {}
    for number in range(_WAYPOINTS + 1):
        share = number / _WAYPOINTS
        cell.sim.set_joint(handle.body, handle.index, start + share * (goal - start))
        found[share] = _handle(cell, name).grasp
    cell.sim.set_joint(handle.body, handle.index, start)
    return found


def _turned(tool: Pose, handle: Handle, angle: float, pushes: bool) -> Pose:
    """``tool`` turned back about the joint's axis: through the handle, or through the finger tips that push."""
    x, y, z = handle.axis
    half = -angle / 2
    back = Pose((0.0, 0.0, 0.0), (x * sin(half), y * sin(half), z * sin(half), cos(half)))
    turned = (back * Pose((0.0, 0.0, 0.0), tool.orientation)).orientation
    tips = TIP if pushes else 0.0
    return Pose(tool.apply((tips, 0.0, 0.0)), turned) * Pose((-tips, 0.0, 0.0))


def _pull(cell: Cell, name: str, handle: Handle, option: Option) -> None:
    """Close the hand on the handle and move it along."""
    side = option.side
    if option.spot == _PUSHED:
        with cell.pushed(side, handle):
            follow(cell, side, option.poses[2:], option.ignore)
        return
    if handle.kind == "lid":  # on a thing that nothing holds: the fingers stand round its edge and do not press
        if cell.gap(side, name) > _ROUND:
            raise SkillError(Stage.CONTACT, f"the {side} hand is {100 * cell.gap(side, name):.1f} cm from {name}")
    else:
        cell.robot.close_gripper(side)
        if not cell.robot.touches(side, handle.body, handle.index):
            raise SkillError(Stage.CONTACT, f"the {side} hand closed and does not touch the handle of {name}")
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
    hands = cell.free()
    if not hands:
        raise SkillError(Stage.PRECONDITION, "both hands are full")
    ignore: Links = frozenset({(handle.body, handle.index)})
    touch = handle.grasp
    before, beyond = touch * Pose((-BEFORE, 0.0, 0.0)), touch * Pose((TRAVEL, 0.0, 0.0))
    options = [
        Option(side, (_rolled(before, roll), _rolled(touch, roll)), ignore) for roll in (0.0, pi / 2) for side in hands
    ]
    for side in hands:
        cell.robot.open_gripper(side, 0.0)
    farthest = _Farthest(handle)
    chosen = reach(cell, options, touch, cell.front(name), attempt)
    roll = 0.0 if chosen.poses[-1].angle(touch) < 0.1 else pi / 2
    cell.sim.add_watcher(farthest)
    try:
        with cell.pushed(chosen.side, handle):
            follow(cell, chosen.side, (_rolled(beyond, roll),), ignore)
        touched = cell.robot.touches(chosen.side, handle.body, handle.index)
    finally:
        cell.sim.remove_watcher(farthest)
    cell.come_back(handle)
    cell.retire(chosen.side, ignore)
    if not touched:
        raise SkillError(Stage.CONTACT, f"the finger does not touch {name}")
    if farthest.share < PRESSED:
        raise SkillError(Stage.EFFECT, f"{name} went down {100 * farthest.share:.0f} % of its way")
    return f"{name} went down {100 * farthest.share:.0f} % of its way"


class _Farthest:
    """Remembers how far a joint was moved at most."""

    def __init__(self, handle: Handle) -> None:
        self.handle = handle
        self.share = 0.0

    def __call__(self, sim: Simulator) -> None:
        at = sim.joint_position(self.handle.body, self.handle.index)
        self.share = max(self.share, (at - self.handle.closed) / (self.handle.open - self.handle.closed))


def rotate(cell: Cell, name: str, setting: str, attempt: int) -> str:
    """Turn a knob to a setting.

    Raises:
        SkillError: It has no such setting, cannot be reached, or does not turn.
    """
    handle = _handle(cell, name)
    if setting not in handle.settings:
        raise SkillError(Stage.PRECONDITION, f"{name} has no setting {setting}")
    hands = cell.free()
    if not hands:
        raise SkillError(Stage.PRECONDITION, "both hands are full")
    ignore: Links = frozenset({(handle.body, handle.index)})
    start = cell.sim.joint_position(handle.body, handle.index)
    goal = handle.settings[setting]
    tools = _tools(cell, name, handle, start, goal)
    options = []
    for number, roll in enumerate((0.0, pi)):
        poses = [_rolled(tool, roll) for tool in tools.values()]
        before = poses[0] * Pose((-BEFORE, 0.0, 0.0))
        options += [Option(side, (before, *poses), ignore, number) for side in hands]
    for side in hands:
        cell.robot.open_gripper(side, handle.opening)
    chosen = reach(cell, options, handle.grasp, cell.front(name), attempt, stop=2)
    _pull(cell, name, handle, chosen)
    cell.retire(chosen.side, ignore)
    if cell.setting(name) != setting:
        raise SkillError(Stage.EFFECT, f"{name} was turned, and is at {cell.setting(name) or 'no setting'}")
    return f"{name} is at {setting}"


def _handle(cell: Cell, name: str) -> Handle:
    handle = cell.scene.handle(name)
    if handle is None:
        raise SkillError(Stage.PRECONDITION, f"{name} has nothing to work it by")
    return handle


def _rolled(tool: Pose, angle: float) -> Pose:
    """The tool turned about the way it points."""
    return tool * Pose((0.0, 0.0, 0.0), (sin(angle / 2), 0.0, 0.0, cos(angle / 2)))
