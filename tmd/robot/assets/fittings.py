"""Parts that furniture and appliances share: doors, buttons, knobs, handles, side boards.

All are given in the frame of the whole: +x is the front.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from tmd.robot.assets.appearance import Appearance, rows
from tmd.robot.assets.features import Frame, Grip
from tmd.robot.assets.urdf_builder import ROOT, UrdfModel
from tmd.robot.sim.pose import Vector

INTO, DOWN, LEFT, UP = (-1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
# Width of a side board.
SIDE = 0.34
# Width of handle bars.
BAR = 0.018
# From a door's face to the middle of its handle: the finger tips reach 18 mm beyond the tool.
STAND_OFF = 0.05
# Thickness of doors.
DOOR = 0.02
# Reach of the finger tips beyond the tool's frame.
TIP = 0.018
WIDE_OPEN = 1.57
# Way of buttons.
BUTTON = 0.012
_FAST = {"knob": 0.12, "door": 1.2}


def bar_handle(
    model: UrdfModel, link: str, centre: Vector, length: float, colour: str, *, upright: bool, face: float
) -> None:
    """Add a bar in front of a face at x = ``face``, on two posts."""
    x, y, z = centre
    size = (BAR, BAR, length) if upright else (BAR, length, BAR)
    model.box(centre, size, colour, link=link)
    for side in (-1, 1):
        shift = side * (length / 2 - BAR / 2)
        at = (y, z + shift) if upright else (y + shift, z)
        model.slab((face, at[0] - BAR / 2, at[1] - BAR / 2), (x, at[0] + BAR / 2, at[1] + BAR / 2), colour, link=link)


def door(
    model: UrdfModel,
    part: str,
    look: Appearance,
    low: Vector,
    high: Vector,
    *,
    height: float,
    latched: bool,
    window: bool,
    part_of: str | None = None,
) -> None:
    """Add a door before an opening, hinged at its −y edge, with its handle at the +y edge.

    ``low`` and ``high`` are corners of the opening; x of ``low`` is that of the door's back. ``height`` is that of the
    handle's middle. A ``latched`` door has no handle: it is pushed shut at its edge. ``window`` adds a dark window.
    ``part_of`` is the part that it opens, if not itself.
    """
    x, y0, y1 = low[0], low[1], high[1]
    hinge = (x, y0, 0.0)
    opens = part if part_of is None else part_of
    model.link(
        part, part=opens, kind="revolute", origin=hinge, axis=(0.0, 0.0, -1.0), limits=(0.0, 1.9),
        friction=_FAST["door"], mass=3.0,
    )  # fmt: skip
    width = y1 - y0
    model.slab((0.001, 0.002, low[2]), (DOOR, width, high[2]), look.colour, link=part)
    if window:
        edge = 0.05
        model.slab((DOOR, edge, low[2] + edge), (DOOR + 0.008, width - edge - 0.03, high[2] - edge), "black",
                   link=part, solid=False)  # fmt: skip
    at = width - 0.035
    if latched:
        tool = Frame((DOOR + TIP, at - 0.03, height), INTO, LEFT)
        model.grips.append(Grip(opens, "flap", part, tool, 0.0, 0.0, WIDE_OPEN))
        return
    bar_handle(model, part, (DOOR + STAND_OFF, at, height), 0.2, look.accent, upright=True, face=DOOR)
    tool = Frame((DOOR + STAND_OFF, at, height), INTO, LEFT)
    model.grips.append(Grip(opens, "door", part, tool, BAR + 0.04, 0.0, WIDE_OPEN))


def button(model: UrdfModel, part: str, look: Appearance, face: Vector) -> None:
    """Add a button that is pressed towards −x and comes back."""
    depth, width, height = look.size
    model.link(
        part, part=part, kind="prismatic", origin=(face[0] + depth, face[1], face[2]), axis=INTO,
        limits=(0.0, BUTTON), spring=6.0, mass=0.03,
    )  # fmt: skip
    model.box((-depth / 2, 0.0, 0.0), (depth, width, height), look.colour, link=part)
    model.grips.append(Grip(part, "button", part, Frame((TIP, 0.0, 0.0), INTO, LEFT), 0.0, 0.0, BUTTON))


def knob(model: UrdfModel, part: str, look: Appearance, face: Vector) -> None:
    """Add a knob to a front face: a disc with a bar for the fingers, turned about x."""
    depth, width, _ = look.size
    model.link(
        part, part=part, kind="revolute", origin=face, axis=(-1.0, 0.0, 0.0), limits=(0.0, math.pi * 0.75),
        friction=_FAST["knob"], mass=0.05,
    )  # fmt: skip
    model.cylinder((0.006, 0.0, 0.0), width / 2, 0.012, look.accent, axis="x", link=part)
    model.box((depth / 2, 0.0, 0.0), (depth, 0.012, width), look.colour, link=part)
    model.box((depth, 0.0, width / 2 - 0.006), (0.002, 0.006, 0.01), "red", link=part, solid=False)
    tool = Frame((max(depth - 0.012, TIP + 0.004), 0.0, 0.0), INTO, LEFT)
    model.grips.append(Grip(part, "knob", part, tool, 0.05, 0.0, math.pi * 0.75, settings(look.settings)))


def settings(names: tuple[str, ...]) -> tuple[tuple[str, float], ...]:
    """Return the angles of a knob's settings, evenly over three eighths of a turn."""
    last = max(len(names) - 1, 1)
    return tuple((name, round(index / last * math.pi * 0.7, 4)) for index, name in enumerate(names))


def tap_lever(model: UrdfModel, part: str, look: Appearance, foot: Vector) -> None:
    """Add a lever on a post, turned about z; off lies along the front."""
    _, length, height = look.size
    model.link(
        part, part=part, kind="revolute", origin=foot, axis=UP, limits=(0.0, math.pi * 0.75),
        friction=_FAST["knob"], mass=0.05,
    )  # fmt: skip
    model.cylinder((0.0, 0.0, height / 2), 0.012, height, look.colour, link=part)
    model.box((0.0, 0.0, height), (0.016, length, 0.02), look.accent, link=part)
    tool = Frame((0.0, 0.0, height), DOWN, (1.0, 0.0, 0.0))
    model.grips.append(Grip(part, "knob", part, tool, 0.05, 0.0, math.pi * 0.75, settings(look.settings)))


def beside_board(look: Appearance) -> tuple[float, float, float, float]:
    """Return front (x), right and left side (y) and height of a body with a side board."""
    depth, width, height = look.size
    return depth / 2, -width / 2, width / 2 - SIDE, height


def side_board(model: UrdfModel, look: Appearance, top: float) -> None:
    """Add a board on the +y side, for things next to an appliance."""
    front, _, low, _ = beside_board(look)
    back, high = -front, look.size[1] / 2
    model.slab((back, low, top - 0.03), (front, high, top), "oak")
    model.slab((back, high - 0.03, 0.0), (front, high, top - 0.03), "oak")
    model.slab((back, low, 0.0), (back + 0.02, high - 0.03, top - 0.03), "oak")
    spots = rows(front, high - low - 0.18, (0.12, 0.28), 0.06, middle=(low + high) / 2)
    model.region("next_to", (back, low, top), (front, high, top + 0.4), DOWN, spots, part=ROOT)


def legs(
    model: UrdfModel, ends: Sequence[float], sides: Sequence[float], height: float, thick: float, colour: str
) -> None:
    """Add four legs at two places along x and two along y."""
    for side in sides:
        for end in ends:
            model.box((end, side, height / 2), (thick, thick, height), colour)


def fronts(model: UrdfModel, face: float, low: tuple[float, float], high: tuple[float, float], count: int, colour: str,
           accent: str) -> None:  # fmt: skip
    """Paint door fronts on a solid body, without function."""
    width = (high[0] - low[0]) / count
    for index in range(count):
        left = low[0] + index * width
        model.slab((face, left + 0.01, low[1]), (face + 0.016, left + width - 0.01, high[1]), colour, solid=False)
        model.box((face + 0.022, left + width - 0.05, high[1] - 0.08), (0.012, 0.012, 0.1), accent, solid=False)
