"""Items that hold something: cups, bowls, pots, and food as it is bought.

An item's +x looks to the front: the long handles of pots point there, those of cups point back, out of the way of a
hand that takes the cup round its body.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

from tmd.robot.assets.appearance import Appearance, Parts
from tmd.robot.assets.features import Frame, Grasp, Grip, Opening
from tmd.robot.assets.fittings import DOWN, INTO, LEFT, TIP
from tmd.robot.assets.urdf_builder import ROOT, UrdfModel
from tmd.robot.sim.pose import Vector

# The fingers are opened by so much more than the width of a thing.
CLEARANCE = 0.02
WIDEST = 0.085
# Radians that a lid opens.
WIDE = 1.75
_AXES: tuple[Vector, ...] = ((-1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0))


def grasp(model: UrdfModel, position: Vector, approach: Vector, across: Vector, width: float) -> None:
    """Offer a grasp of something ``width`` wide."""
    model.grasps.append(Grasp(Frame(position, approach, across), min(width + CLEARANCE, WIDEST)))


def post_grasps(model: UrdfModel, heights: tuple[float, ...], width: tuple[float, float], top: float) -> None:
    """Add grasps of an upright body: from the sides at some heights, and from above.

    ``width`` is that along x and along y, ``top`` the height of the body.
    """
    for height in heights:
        for approach in _AXES:
            across: Vector = (-approach[1], approach[0], 0.0)
            grasp(model, (0.0, 0.0, height), approach, across, width[1] if approach[0] else width[0])
    for steep in (0.7, 0.45):
        level = math.sqrt(1 - steep * steep)
        grasp(model, (0.0, 0.0, max(heights)), (-level, 0.0, -steep), LEFT, width[1])
    over = max(top - 0.012, TIP + 0.006)
    grasp(model, (0.0, 0.0, over), DOWN, LEFT, width[1])
    grasp(model, (0.0, 0.0, over), DOWN, (1.0, 0.0, 0.0), width[0])


def bar_grasps(model: UrdfModel, places: Iterable[Vector], width: float) -> None:
    """Add grasps of a level bar along x: from its end, from above, and slanting between the two."""
    slant = math.sqrt(0.5)
    for place in places:
        grasp(model, place, DOWN, LEFT, width)
        grasp(model, place, INTO, LEFT, width)
        grasp(model, place, (-slant, 0.0, -slant), LEFT, width)


def rim_grasps(model: UrdfModel, radius: float, top: float, wall: float, angles: Iterable[float]) -> None:
    """Add grasps of a wall from above, one finger inside."""
    for angle in angles:
        across: Vector = (math.cos(angle), math.sin(angle), 0.0)
        place = ((radius - wall / 2) * across[0], (radius - wall / 2) * across[1], top - 0.004)
        grasp(model, place, DOWN, across, wall + 0.015)


def contents(model: UrdfModel, radius: float, floor: float, rim: float) -> None:
    """Add the contents of a vessel, invisible at first: a filling up to half its depth, and something on top of it."""
    level = (floor + rim) / 2
    model.opening = Opening((0.0, 0.0, rim), radius, level)
    model.link("content")
    model.cylinder((0.0, 0.0, (floor + level) / 2), radius, level - floor, "water", link="content", solid=False)
    model.link("topping")
    for index in range(3):
        angle = index * 2 * math.pi / 3
        at = (radius * 0.4 * math.cos(angle), radius * 0.4 * math.sin(angle), level)
        model.ball(at, min(radius * 0.55, 0.025), "vanilla", link="topping")
    model.contents = ["content", "topping"]


def round_body(model: UrdfModel, look: Appearance, radius: float, height: float, wall: float, floor: float) -> None:
    """Add a hollow round body with a bottom."""
    model.cylinder((0.0, 0.0, floor / 2), radius * 0.96, floor, look.colour)
    model.tube(radius, wall, floor, height, look.colour)


def cup(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a cup, mug or glass, narrow enough for a hand round its body; depth beyond the width is the handle's."""
    depth, width, height = look.size
    radius = width / 2
    round_body(model, look, radius, height, 0.005, 0.006)
    model.tube(radius + 0.0006, 0.001, height * 0.62, height * 0.74, look.accent)
    handle = depth > width + 0.01
    if handle:
        end = -radius - (depth - width)
        for level in (height * 0.3, height * 0.75):
            model.slab((end, -0.006, level - 0.006), (-radius + 0.006, 0.006, level + 0.006), look.colour)
        model.slab((end, -0.006, height * 0.3), (end + 0.01, 0.006, height * 0.75), look.colour)
    contents(model, radius - 0.007, 0.006, height)
    post_grasps(model, (height * 0.5, height * 0.7), (width, width), height)
    if handle:  # no finger on the handle's side, no palm over it
        model.grasps = [g for g in model.grasps if g.tool.approach[0] < 0.1 and abs(g.tool.across[0]) < 0.1]
    rim_grasps(model, radius, height, 0.005, (math.pi / 2, 0.0, -math.pi / 2))


def bowl(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a bowl or a deep plate: a foot, a wall, and an ear in front for the fingers."""
    depth, width, height = look.size
    radius, ear = width / 2, height - 0.008
    foot = 0.012
    model.cylinder((0.0, 0.0, foot / 2), radius * 0.97, foot, look.colour)
    model.tube(radius, 0.007, foot, height, look.colour)
    model.tube(radius + 0.0006, 0.0015, height - 0.012, height - 0.004, look.accent)
    end = radius + depth - width
    model.slab((radius - 0.008, -0.011, ear - 0.007), (end, 0.011, ear + 0.007), look.accent)
    contents(model, radius - 0.01, foot, height)
    bar_grasps(model, [(end - 0.016, 0.0, ear)], 0.022)
    rim_grasps(model, radius, height, 0.007, (math.pi / 2, -math.pi / 2, math.pi))


def pot(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a pot with a long handle."""
    depth, width, height = look.size
    radius, end, level = width / 2, depth - width / 2, height - 0.008
    round_body(model, look, radius, height, 0.005, 0.008)
    model.slab((radius - 0.008, -0.011, level - 0.008), (end, 0.011, level + 0.008), look.accent)
    model.box((-radius - 0.008, 0.0, level), (0.02, 0.05, 0.012), look.accent)
    contents(model, radius - 0.008, 0.008, height)
    bar_grasps(model, [(end - 0.03, 0.0, level), (end - 0.055, 0.0, level)], 0.022)
    rim_grasps(model, radius, height, 0.005, (math.pi / 2, -math.pi / 2))


def kettle(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a kettle with a loop over its opening; the spout points to the front."""
    _, width, height = look.size
    radius, body = width / 2, height - 0.09
    round_body(model, look, radius, body, 0.006, 0.008)
    for side in (-1, 1):
        model.box((side * (radius - 0.012), 0.0, (body + height) / 2), (0.014, 0.02, height - body), look.accent)
    model.box((0.0, 0.0, height - 0.009), (2 * radius - 0.01, 0.022, 0.018), look.accent)
    model.box((radius + 0.022, 0.0, body - 0.022), (0.06, 0.024, 0.024), look.colour)
    contents(model, radius - 0.009, 0.008, body)
    bar_grasps(model, [(0.0, 0.0, height - 0.009), (0.03, 0.0, height - 0.009)], 0.022)


def carafe(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a coffee pot with an upright handle in front."""
    depth, width, height = look.size
    radius, bar = width / 2, depth - width / 2 - 0.01
    round_body(model, look, radius, height, 0.005, 0.008)
    for level in (height * 0.25, height * 0.9):
        model.slab((radius - 0.008, -0.01, level - 0.008), (bar, 0.01, level + 0.008), look.accent)
    model.slab((bar - 0.01, -0.01, height * 0.25 - 0.008), (bar + 0.01, 0.01, height * 0.9 + 0.008), look.accent)
    model.box((-radius - 0.004, 0.0, height - 0.012), (0.03, 0.03, 0.016), look.colour)
    contents(model, radius - 0.008, 0.008, height)
    slant = math.sqrt(0.5)
    for level in (height * 0.6, height * 0.75):
        grasp(model, (bar, 0.0, level), INTO, LEFT, 0.02)
        grasp(model, (bar, 0.0, level), (-slant, 0.0, -slant), LEFT, 0.02)
    rim_grasps(model, radius, height, 0.005, (math.pi / 2, -math.pi / 2))


def jar(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a jar or tub with a lid on a hinge."""
    _, width, height = look.size
    radius = width / 2
    round_body(model, look, radius, height - 0.012, 0.004, 0.006)
    model.tube(radius + 0.0006, 0.001, height * 0.3, height * 0.6, look.accent)
    contents(model, radius - 0.006, 0.006, height - 0.012)
    lid(model, look, radius, height)
    post_grasps(model, (height * 0.5, height * 0.35), (width, width), height)


def carton(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a carton of milk or juice: square, with a flap for a lid."""
    depth, width, height = look.size
    x, y, top = depth / 2, width / 2, height - 0.012
    model.slab((-x, -y, 0.0), (x, y, top - 0.02), look.colour)
    model.slab((-x, -y, top - 0.02), (x, y, top), look.accent)
    for side in (-1, 1):
        model.box((0.0, side * (y + 0.0005), height * 0.4), (depth * 0.7, 0.001, height * 0.35), look.accent,
                  solid=False)  # fmt: skip
    model.box((x + 0.0005, 0.0, height * 0.4), (0.001, width * 0.7, height * 0.35), look.accent, solid=False)
    lid(model, look, min(x, y) * 0.9, height, aside=True)
    model.opening = Opening((0.0, 0.0, top), min(x, y) - 0.004, top / 2)
    post_grasps(model, (height * 0.5, height * 0.35), (depth, width), height)


def lid(model: UrdfModel, look: Appearance, radius: float, height: float, *, aside: bool = False) -> None:
    """Add a lid with a tab by which it is lifted: in front with the hinge behind, or (``aside``) on the left.

    A thing that is opened in a hand has it aside: the hand that holds it from the front is not in the way of the other.
    """

    def at(out: float, across: float, up: float) -> Vector:
        return (-across, out, up) if aside else (out, across, up)

    def size(out: float, across: float, up: float) -> Vector:
        return (across, out, up) if aside else (out, across, up)

    model.link(
        "lid", kind="revolute", origin=at(-radius, 0.0, height - 0.012), axis=at(0.0, -1.0, 0.0), limits=(0.0, WIDE),
        friction=0.03, mass=0.01,
    )  # fmt: skip
    model.cylinder(at(radius, 0.0, 0.0065), radius, 0.011, look.accent, link="lid")
    model.box(at(2 * radius + 0.010, 0.0, 0.0065), size(0.026, 0.02, 0.009), look.accent, link="lid")
    # far enough out for a hand from the side
    tool = Frame(at(2 * radius + 0.016, 0.0, 0.0065), at(-1.0, 0.0, 0.0), at(0.0, 1.0, 0.0))
    model.grips.append(Grip(ROOT, "lid", "lid", tool, 0.04, 0.0, WIDE))


def sugar_bowl(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build an open bowl, narrow enough to be taken round its body."""
    _, width, height = look.size
    round_body(model, look, width / 2, height, 0.005, 0.008)
    model.tube(width / 2 + 0.0006, 0.001, height * 0.6, height * 0.7, look.accent)
    contents(model, width / 2 - 0.007, 0.008, height)
    post_grasps(model, (height * 0.55,), (width, width), height)


def bottle(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a bottle: body, shoulder, neck."""
    _, width, height = look.size
    radius, shoulder = width / 2, height * 0.68
    model.cylinder((0.0, 0.0, shoulder / 2), radius, shoulder, look.colour)
    model.cylinder((0.0, 0.0, shoulder + 0.012), radius * 0.7, 0.024, look.colour)
    model.cylinder((0.0, 0.0, (shoulder + 0.024 + height) / 2), radius * 0.36, height - shoulder - 0.024, look.accent)
    model.cylinder((0.0, 0.0, shoulder * 0.5), radius + 0.0006, shoulder * 0.4, look.accent, solid=False)
    post_grasps(model, (height * 0.35, height * 0.5), (width, width), height)


def capped_bottle(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a bottle whose cap opens on a hinge."""
    bottle(model, replace(look, size=(look.size[0], look.size[1], look.size[2] - 0.012)), parts)
    lid(model, look, look.size[1] * 0.22, look.size[2])
