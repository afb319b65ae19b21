"""Items that hold nothing: cutlery, packets, soft things. Handles point to the front, +x."""

from __future__ import annotations

import math

from tmd.robot.assets.appearance import Appearance, Parts
from tmd.robot.assets.features import Frame, Grip
from tmd.robot.assets.fittings import TIP
from tmd.robot.assets.urdf_builder import UrdfModel
from tmd.robot.assets.vessels import WIDE, bar_grasps, grasp, post_grasps

_LOW = TIP + 0.004


def utensil(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a spoon, fork, knife or scoop that lies: a raised handle in front, its head behind.

    Spoon and scoop have a short head and a high handle: the head gets into a jar while the handle stays above the rim.
    """
    length, width, height = look.size
    head = min(0.045 if look.kind in ("spoon", "scoop") else 0.06, length * 0.35)
    x, y = length / 2, width / 2
    low, high = -x, -x + head
    match look.kind:
        case "spoon":
            model.slab((low + 0.004, -y + 0.004, 0.0), (high - 0.004, y - 0.004, 0.006), look.colour)
            model.slab((low, -y, 0.006), (high, y, 0.012), look.colour)
        case "scoop":
            model.cylinder(((low + high) / 2, 0.0, 0.004), y - 0.004, 0.008, look.colour)
            model.tube(y, 0.004, 0.006, 0.022, look.colour, centre=((low + high) / 2, 0.0))
        case "fork":
            model.slab((high - 0.02, -y, 0.0), (high, y, 0.008), look.colour)
            for place in (-1.5, -0.5, 0.5, 1.5):
                middle, half = place * width / 4, width / 12
                model.slab((low, middle - half, 0.0), (high - 0.02, middle + half, 0.008), look.colour)
        case "knife":
            model.slab((low, -y, 0.0), (high + 0.02, y, 0.008), look.colour)
    model.slab((-x + head - 0.004, -0.006, height - 0.012), (x, 0.006, height), look.accent)
    model.slab((-x + head - 0.004, -0.006, 0.0), (-x + head + 0.004, 0.006, height), look.accent)
    model.slab((x - 0.02, -0.012, 0.0), (x - 0.012, 0.012, height - 0.012), look.accent)
    bar_grasps(model, [(x - 0.035, 0.0, max(height - 0.006, _LOW)), (0.02, 0.0, max(height - 0.006, _LOW))], 0.012)
    if look.kind in ("spoon", "scoop"):
        model.link("content")
        model.ball((-x + head / 2, 0.0, height), width * 0.42, "white", link="content")
        model.contents = ["content"]


def block(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a box: a packet, a book, a folded towel; taken across its width."""
    depth, width, height = look.size
    model.slab((-depth / 2, -width / 2, 0.0), (depth / 2, width / 2, height), look.colour)
    model.box((0.0, 0.0, height), (depth * 0.62, width * 0.62, 0.002), look.accent, solid=False)
    for side in (-1, 1):
        model.box((0.0, side * width / 2, height / 2), (depth * 0.7, 0.002, height * 0.4), look.accent, solid=False)
    if width <= 0.07:
        for shift in (0.0, depth / 4):
            grasp(model, (shift, 0.0, max(height - 0.012, _LOW)), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0), width)
        for steep in (0.0, 0.45, 0.7):
            approach = (-math.sqrt(1 - steep * steep), 0.0, -steep)
            grasp(model, (depth / 4, 0.0, max(height / 2, _LOW)), approach, (0.0, 1.0, 0.0), width)
    if depth <= 0.07:
        grasp(model, (0.0, 0.0, max(height - 0.012, _LOW)), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0), depth)


def egg(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build an egg in its stand, so that it does not roll."""
    _, width, height = look.size
    radius = width / 2
    model.cylinder((0.0, 0.0, 0.009), radius * 0.95, 0.018, look.accent)
    model.cylinder((0.0, 0.0, (0.018 + height) / 2), radius * 0.8, height - 0.018, look.colour, seen=False)
    model.ball((0.0, 0.0, height - radius), radius, look.colour)
    model.ball((0.0, 0.0, height - radius * 1.35), radius * 0.98, look.colour)
    post_grasps(model, (max(height * 0.6, _LOW),), (2 * radius, 2 * radius), height)


def tin(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build an upright cylinder: a tin, a pod."""
    _, width, height = look.size
    model.cylinder((0.0, 0.0, height / 2), width / 2, height, look.colour)
    model.cylinder((0.0, 0.0, height), width / 2 * 0.85, 0.002, look.accent, solid=False)
    post_grasps(model, (max(height * 0.55, _LOW),), (width, width), height)


def strapped(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build something wide and soft, or flat (a pillow, a blanket, a box of pizza), taken by a strap on top."""
    depth, width, height = look.size
    body = height - 0.04
    x, y = depth / 2, width / 2
    model.slab((-x, -y, 0.0), (x, y, body), look.colour)
    for side in (-1, 1):
        model.box((0.0, side * y * 0.6, body), (depth * 0.96, 0.02, 0.004), look.accent, solid=False)
        model.box((side * 0.045, 0.0, body + 0.014), (0.014, 0.022, 0.028), look.accent)
    model.box((0.0, 0.0, height - 0.006), (0.104, 0.022, 0.012), look.accent)
    bar_grasps(model, [(0.0, 0.0, height - 0.006), (0.02, 0.0, height - 0.006)], 0.022)


def remote(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a remote control, taken by its near end: the other hand has room above the buttons at its far one."""
    depth, width, height = look.size
    model.slab((-depth / 2, -width / 2, 0.0), (depth / 2, width / 2, height), look.colour)
    end = depth / 2 - 0.02
    for steep in (0.7, 0.45, 0.9, 0.0):
        approach = (-math.sqrt(1 - steep * steep), 0.0, -steep)
        grasp(model, (end, 0.0, max(height / 2, _LOW)), approach, (0.0, 1.0, 0.0), width)
    grasp(model, (end, 0.0, max(height - 0.012, _LOW)), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0), width)
    buttons = parts.of("button")
    for index, (part, said) in enumerate(buttons):
        column, row = index % 2, index // 2
        place = (0.035 * row - depth * 0.36, 0.013 * (2 * column - 1), height + 0.006)
        model.link(
            part, part=part, kind="prismatic", origin=place, axis=(0.0, 0.0, -1.0), limits=(0.0, 0.003), spring=3.0,
            mass=0.003,
        )  # fmt: skip
        model.box((0.0, 0.0, -0.003), (0.014, 0.014, 0.006), said.colour, link=part)
        tool = Frame((0.0, 0.0, TIP), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0))
        model.grips.append(Grip(part, "button", part, tool, 0.0, 0.0, 0.003))


def sack(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a garbage bag with a stiff rim and a flap: things go in while it is open; carried by an ear at either side.

    The flap's tab is in front: one hand holds the bag, and the other lifts the tab.
    """
    depth, width, height = look.size
    ear = 0.05
    x, y, rim = depth / 2, width / 2 - ear, height - 0.012
    model.slab((-x, -y, 0.0), (x, y, 0.008), look.colour)
    for side in (-1.0, 1.0):
        model.box((0.0, side * (y - 0.004), rim / 2), (2 * x, 0.008, rim), look.colour)
        model.box((side * (x - 0.004), 0.0, rim / 2), (0.008, 2 * y - 0.016, rim), look.colour)
    level, slant = rim * 0.6, math.sqrt(0.5)
    for side in (-1.0, 1.0):
        model.box((0.0, side * (y + ear / 2), level), (0.022, ear + 0.004, 0.016), look.accent)
        for across, down in ((0.0, 1.0), (1.0, 0.0), (slant, slant)):
            grasp(model, (0.0, side * (y + ear - 0.016), level), (0.0, -side * across, -down), (1.0, 0.0, 0.0), 0.022)
    model.region("in", (-x + 0.008, -y + 0.008, 0.008), (x - 0.008, y - 0.008, height + 0.15), (0.0, 0.0, -1.0),
                 [(-0.055, 0.0, 0.0), (0.055, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.57)],
                 overhang=math.inf, heap=True)  # fmt: skip
    model.link(
        "lid", kind="revolute", origin=(-x, 0.0, rim + 0.001), axis=(0.0, -1.0, 0.0), limits=(0.0, WIDE),
        friction=0.06, mass=0.02,
    )  # fmt: skip
    model.slab((0.0, -y, 0.0), (2 * x, y, 0.01), look.colour, link="lid")
    tab = 2 * x + TIP + 0.005  # the finger tips stand round it, and end before the flap
    model.box(((2 * x + tab + 0.01) / 2, 0.0, 0.005), (tab + 0.01 - 2 * x, 0.02, 0.01), look.accent, link="lid")
    tool = Frame((tab, 0.0, 0.005), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    model.grips.append(Grip("", "lid", "lid", tool, 0.04, 0.0, WIDE))
