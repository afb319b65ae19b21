"""Furniture: things to put other things on or into. All fronts are at +x; see :mod:`tmd.robot.assets.fittings`."""

from __future__ import annotations

from tmd.robot.assets.appearance import Appearance, Parts, rows
from tmd.robot.assets.features import Frame, Grip
from tmd.robot.assets.fittings import BAR, DOOR, DOWN, INTO, STAND_OFF, UP, bar_handle, door, fronts, legs
from tmd.robot.assets.urdf_builder import ROOT, UrdfModel

WALL = 0.02
# Distances of things from a front edge.
ROWS = (0.13, 0.29)
# Allowed overhang of a handle over a front edge.
OVERHANG = 0.06
# Of a basket and a bin: a hand that holds a thing gets to its floor.
DEEP = 0.2
# The height above a surface that still counts as on it.
ROOM = 0.6


def surface(model: UrdfModel, front: float, width: float, top: float, depth: float) -> None:
    """Let things stand on a whole top."""
    low, high = (front - depth, -width / 2, top), (front, width / 2, top + ROOM)
    fitting = tuple(row for row in ROWS if row + 0.05 <= depth) or (depth / 2,)
    model.region("on", low, high, DOWN, rows(front, width - 0.16, fitting), overhang=OVERHANG)


def counter(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a kitchen counter: a closed body with a worktop."""
    depth, width, height = look.size
    x, y = depth / 2, width / 2
    model.slab((-x, -y + 0.01, 0.0), (x - 0.08, y - 0.01, 0.1), "dark_grey")
    model.slab((-x, -y, 0.1), (x - 0.03, y, height - 0.04), look.colour)
    model.slab((-x, -y, height - 0.04), (x, y, height), look.accent)
    fronts(model, x - 0.03, (-y, 0.12), (y, height - 0.06), max(2, round(width / 0.45)), look.colour, "dark_steel")
    surface(model, x, width, height, depth)


def table(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a table on four legs."""
    depth, width, height = look.size
    x, y = depth / 2, width / 2
    model.slab((-x, -y, height - 0.035), (x, y, height), look.colour)
    legs(model, (-(x - 0.06), x - 0.06), (-(y - 0.06), y - 0.06), height - 0.035, 0.05, look.accent)
    model.slab((-x + 0.08, -y + 0.08, height - 0.1), (x - 0.08, y - 0.08, height - 0.035), look.accent)
    surface(model, x, width, height, depth)


def shelf(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build an open bookcase whose top is used; the boards below are decoration."""
    depth, width, height = look.size
    x, y = depth / 2, width / 2
    model.slab((-x, -y, height - 0.025), (x, y, height), look.colour)
    for side in (-1, 1):
        edge = side * (y - 0.0125)
        model.box((0.0, edge, (height - 0.025) / 2), (depth, 0.025, height - 0.025), look.colour)
    model.slab((-x, -y + 0.025, 0.0), (-x + 0.02, y - 0.025, height - 0.025), look.accent)
    model.slab((-x, -y, height), (-x + 0.02, y, height + 0.12), look.accent)
    for level in (0.06, height * 0.38, height * 0.7):
        model.slab((-x + 0.02, -y + 0.025, level), (x - 0.01, y - 0.025, level + 0.02), look.colour)
    colours = ("red", "navy", "sage", "orange", "teal", "cream", "violet")
    for level, shift in ((0.08, 0), (height * 0.38 + 0.02, 3)):
        for index in range(7):
            left = -y + 0.08 + index * 0.045 + (0.4 if shift else 0.0) * (width - 0.6)
            tall = 0.16 + 0.02 * ((index * 5 + shift) % 4)
            model.slab((-0.04, left, level), (x - 0.06, left + 0.04, level + tall), colours[(index + shift) % 7],
                       solid=False)  # fmt: skip
    surface(model, x, width, height, depth - 0.02)


def chamber(
    model: UrdfModel, low: tuple[float, float, float], high: tuple[float, float, float], colour: str, inside: str,
    levels: tuple[float, ...], spots: tuple[float, ...] = (0.09, 0.13, 0.17, 0.21),
) -> None:  # fmt: skip
    """Add a hollow with an open front between two corners (outside measures).

    ``levels`` are the tops of the floor and of the boards, upwards; ``spots`` the distances of things from the front.
    """
    model.slab(low, (high[0], high[1], levels[0]), inside)
    model.slab((low[0], low[1], high[2] - WALL), high, colour)
    model.slab((low[0], low[1], levels[0]), (low[0] + WALL, high[1], high[2] - WALL), inside)
    model.slab((low[0] + WALL, low[1], levels[0]), (high[0], low[1] + WALL, high[2] - WALL), colour)
    model.slab((low[0] + WALL, high[1] - WALL, levels[0]), (high[0], high[1], high[2] - WALL), colour)
    ceilings = (*(level - 0.015 for level in levels[1:]), high[2] - WALL)
    middle, width = (low[1] + high[1]) / 2, high[1] - low[1] - 2 * WALL
    for floor, ceiling in zip(levels, ceilings, strict=True):
        if floor != levels[0]:
            model.slab((low[0] + WALL, low[1] + WALL, floor - 0.015), (high[0] - 0.01, high[1] - WALL, floor), inside)
        # a hand gets to what stands clear of the sides: there only what finds no other room
        clear, every = (rows(high[0], width - margin, spots, middle=middle) for margin in (0.3, 0.2))
        model.region(
            "in", (low[0] + WALL, low[1] + WALL, floor), (high[0], high[1] - WALL, ceiling), INTO,
            [*clear, *(spot for spot in every if spot not in clear)],
        )  # fmt: skip


def cupboard(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a cupboard: two levels behind a door, a closed body below."""
    depth, width, height = look.size
    x, y = depth / 2 - DOOR, width / 2
    base = 0.70
    model.slab((-depth / 2, -y, 0.0), (x, y, base - WALL), look.colour)
    fronts(model, x, (-y, 0.09), (y, base - 0.04), 2, look.colour, look.accent)
    middle = base + (height - base) / 2
    levels = (base, middle) if height - base > 0.55 else (base,)
    chamber(model, (-depth / 2, -y, base - WALL), (x, y, height), look.colour, "cream", levels)
    for part, said in parts.of("door", "latched_door"):
        door(model, part, said, (x, -y, base - WALL), (x, y, height), height=min(0.98, middle),
             latched=said.kind == "latched_door", window=False)  # fmt: skip


def drawer(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a chest whose top drawer slides; the whole is the drawer."""
    depth, width, height = look.size
    x, y = depth / 2 - DOOR, width / 2
    low, high = height - 0.2, height - 0.03
    model.slab((-depth / 2, -y, 0.0), (x, y, low), look.colour)
    model.slab((-depth / 2, -y, high), (x + DOOR, y, height), look.colour)
    for side in (-1, 1):
        model.box((-DOOR / 2, side * (y - 0.01), (low + high) / 2), (depth - DOOR, 0.02, high - low), look.colour)
    model.slab((-depth / 2, -y + 0.02, low), (-depth / 2 + 0.02, y - 0.02, high), look.colour)
    for level in (0.08, (low + 0.08) / 2):
        model.slab((x, -y + 0.01, level), (x + 0.012, y - 0.01, level + (low - 0.08) / 2 - 0.01), look.colour,
                   solid=False)  # fmt: skip
        model.box((x + 0.025, 0.0, level + (low - 0.08) / 4), (0.02, 0.16, 0.014), look.accent, solid=False)
    _tray(model, ROOT, "tray", (x, y), (low, high), depth - DOOR - 0.03, look)


def desk(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a desk on four legs, with a drawer under its top."""
    depth, width, height = look.size
    x, y, top, under = depth / 2, width / 2, height - 0.035, height - 0.2
    half = min(0.34, y - 0.1)
    model.slab((-x, -y, top), (x, y, height), look.colour)
    legs(model, (-(x - 0.06), x - 0.06), (-(y - 0.06), y - 0.06), top, 0.05, look.accent)
    drawers = parts.of("sliding_drawer")
    model.slab((-x + 0.035, -half, under), (-x + 0.055, half, top), look.colour)
    for sign in (-1, 1):
        model.box((-DOOR / 2, sign * (half + 0.01), (under + top) / 2), (depth - 0.11, 0.02, top - under), look.colour)
    for part, said in drawers:
        _tray(model, part, part, (x - 0.06, half), (under, top), depth - 0.16, said)
    surface(model, x, width, height, depth)


def chest(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a chest of drawers: things stand on it, and its drawers are parts, the first uppermost."""
    depth, width, height = look.size
    x, y, drawers = depth / 2 - DOOR, width / 2, parts.of("sliding_drawer")
    high = height - 0.03
    low = high - 0.19 * len(drawers)
    model.slab((-depth / 2, -y, 0.0), (x, y, low), look.colour)
    model.slab((-depth / 2, -y, high), (x + DOOR, y, height), look.colour)
    if drawers:
        model.slab((-depth / 2, -y + 0.02, low), (-depth / 2 + 0.02, y - 0.02, high), look.colour)
        for side in (-1, 1):
            model.box((-DOOR / 2, side * (y - 0.01), (low + high) / 2), (depth - DOOR, 0.02, high - low), look.colour)
    fronts(model, x, (-y, 0.05), (y, low - 0.02), 2, look.colour, look.accent)
    for index, (part, said) in enumerate(drawers):
        roof = high - 0.19 * index
        _tray(model, part, part, (x, y), (roof - 0.19, roof), depth - DOOR - 0.03, said)
    surface(model, x + DOOR, width, height, depth)


def _tray(
    model: UrdfModel, part: str, link: str, front: tuple[float, float], between: tuple[float, float], inner: float,
    look: Appearance,
) -> None:  # fmt: skip
    """Add a drawer that slides out of a body.

    ``front``: x of the body's front and half of its width, ``between``: lower and upper height, ``inner``: depth.
    """
    (x, y), (low, high) = front, between
    model.link(link, part=part, kind="prismatic", axis=(1.0, 0.0, 0.0), limits=(0.0, inner - 0.02), friction=5.0,
               mass=2.0)  # fmt: skip
    wall, floor, rim = y - 0.028, low + 0.02, low + 0.10
    model.slab((x - inner, -wall, floor - 0.012), (x, wall, floor), "pine", link=link)
    model.slab((x, -y + 0.01, low + 0.004), (x + DOOR, y - 0.01, high - 0.004), look.colour, link=link)
    model.slab((x - inner, -wall, floor), (x - inner + 0.012, wall, rim), "pine", link=link)
    for sign in (-1, 1):
        model.box((x - inner / 2, sign * (wall - 0.006), (floor + rim) / 2), (inner, 0.012, rim - floor), "pine",
                  link=link)  # fmt: skip
    spots = rows(x, 2 * wall - 0.2, (0.15, 0.29))
    model.region("in", (x - inner, -wall, floor), (x, wall, high), DOWN, spots, part=part, link=link)
    face, middle = x + DOOR, (low + high) / 2
    bar_handle(model, link, (face + STAND_OFF, 0.0, middle), 0.2, look.accent, upright=False, face=face)
    tool = Frame((face + STAND_OFF, 0.0, middle), INTO, UP)
    model.grips.append(Grip(part, "drawer", link, tool, BAR + 0.04, 0.0, inner - 0.04))


def basket(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build an open box on the floor or on legs: things are dropped into it from above."""
    depth, width, height = look.size
    x, y, floor = depth / 2, width / 2, max(height - DEEP, 0.02)
    model.slab((-x, -y, 0.0), (x, y, floor), look.accent)
    for sign in (-1, 1):
        model.box((sign * (x - 0.008), 0.0, (floor + height) / 2), (0.016, width, height - floor), look.colour)
        model.box((0.0, sign * (y - 0.008), (floor + height) / 2), (depth - 0.032, 0.016, height - floor), look.colour)
    spots = rows(x, width - 0.25, (depth * 0.35, depth * 0.65))
    model.region("in", (-x + 0.016, -y + 0.016, floor), (x - 0.016, y - 0.016, height + 0.1), DOWN, spots,
                 heap=True)  # fmt: skip


def seat(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a sofa or an armchair: a seat that things lie on, a back and two arms."""
    depth, width, height = look.size
    x, y, back, arm = depth / 2, width / 2, 0.22, 0.16
    for sign in (-1, 1):
        model.box((0.0, sign * (y - arm / 2), height * 0.7), (depth, arm, height * 1.4), look.colour)
    model.slab((-x, -y + arm, 0.0), (-x + back, y - arm, height * 1.9), look.colour)
    model.slab((-x + back, -y + arm, 0.0), (x, y - arm, height - 0.1), look.colour)
    seats = max(1, round((width - 2 * arm) / 0.7))
    each = (width - 2 * arm) / seats
    for index in range(seats):
        left = -y + arm + index * each
        model.slab((-x + back, left + 0.002, height - 0.1), (x - 0.01, left + each - 0.002, height), look.accent)
    wide = width - 2 * arm
    model.region(
        "on", (-x + back, -wide / 2, height), (x, wide / 2, height + ROOM), DOWN,
        rows(x, max(wide - 0.2, 0.0), (0.17, 0.24, 0.31)),
    )  # fmt: skip
