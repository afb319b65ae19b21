"""Fixtures of a living room: television, player, lamps, window, bin. Fronts are at +x."""

from __future__ import annotations

import math

from tmd.robot.assets import fittings
from tmd.robot.assets.appearance import Appearance, Parts
from tmd.robot.assets.features import Frame, Grip
from tmd.robot.assets.fittings import BAR, DOWN, INTO, LEFT, STAND_OFF, UP, bar_handle, button, door, fronts, knob
from tmd.robot.assets.furniture import basket
from tmd.robot.assets.urdf_builder import ROOT, UrdfModel


def tv(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a television on its stand, with a bar of buttons below the screen."""
    x, y0, y1, height = fittings.beside_board(look)
    stand = 0.7
    model.slab((-x, y0, 0.0), (x - 0.02, y1, stand), look.accent)
    fronts(model, x - 0.02, (y0, 0.05), (y1, stand - 0.03), 2, look.accent, "dark_steel")
    middle, back, half = (y0 + y1) / 2, -0.02, (y1 - y0) / 2 - 0.02
    model.slab((back - 0.06, middle - half, stand + 0.06), (back, middle + half, height), look.colour)
    model.slab((back - 0.08, middle - 0.2, stand), (x - 0.06, middle + 0.2, stand + 0.02), look.colour)
    bar = x - 0.06
    model.slab((back - 0.06, middle - 0.32, stand + 0.02), (bar, middle + 0.32, stand + 0.1), look.colour)
    for part, said in parts.of("screen"):
        model.link(part, part=part)
        model.slab((back, middle - half + 0.03, stand + 0.12), (back + 0.01, middle + half - 0.03, height - 0.03),
                   said.colour, link=part)  # fmt: skip
        model.lamp(ROOT, "active", part, "screen", said.colour)
    for part, said in parts.of("speaker"):
        model.link(part, part=part)
        model.slab(
            (bar, middle - 0.3, stand + 0.03), (bar + 0.008, middle - 0.24, stand + 0.09), said.colour, link=part
        )
    for index, (part, said) in enumerate(parts.of("button")):
        button(model, part, said, (bar, middle - 0.18 + 0.11 * index, stand + 0.06))
    fittings.side_board(model, look, stand)


def player(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a console or player on a stand: a tray on top takes a disc from above, with buttons in front beside it."""
    x, y0, y1, height = fittings.beside_board(look)
    stand = height - 0.16
    model.slab((-x, y0, 0.0), (x - 0.02, y1, stand - 0.03), "walnut")
    fronts(model, x - 0.02, (y0, 0.05), (y1, stand - 0.06), 1, "walnut", "dark_steel")
    model.slab((-x, y0, stand - 0.03), (x, y1, stand), "oak")
    front, back, left, end = x - 0.04, x - 0.34, y0 + 0.03, y1 - 0.03
    floor, wall, slot = height - 0.03, 0.012, left + 0.25
    model.slab((back, left, stand), (front, slot, floor), look.colour)
    model.slab((back, slot, stand), (front, end, height), look.colour)
    model.slab((back, left, floor), (back + wall, slot, height), look.colour)
    model.slab((front - wall, left, floor), (front, slot, height), look.colour)
    model.slab((back + wall, left, floor), (front - wall, left + wall, height), look.colour)
    model.slab((back + wall, left + wall, floor), (front - wall, slot, floor + 0.001), "black", solid=False)
    middle = (left + wall + slot) / 2
    drives = parts.of("disc_drive")
    part = drives[0][0] if drives else "drive_lamp"
    model.link(part, part=part if drives else ROOT)
    model.ball((front, slot + 0.03, height - 0.03), 0.008, "dark_grey", link=part)
    model.lamp(part if drives else ROOT, "active", part, "lamp", "dark_grey")
    model.link("power_lamp")
    model.ball((front, slot + 0.06, height - 0.03), 0.008, "dark_grey", link="power_lamp")
    model.lamp(ROOT, "active", "power_lamp", "screen", "dark_grey")
    model.region("in", (back + wall, left + wall, floor), (front - wall, slot, height + 0.08), DOWN,
                 [(front - depth_in, middle, 0.0) for depth_in in (0.1, 0.14, 0.18)])  # fmt: skip
    gap = (end - slot) / (len(parts.of("button")) + 1)
    for index, (name, said) in enumerate(parts.of("button")):
        button(model, name, said, (front, slot + gap * (index + 1), stand + 0.07))
    fittings.side_board(model, look, stand)


def lamp(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a lamp on a small cabinet, or (a tall one) on a pole above it, with its switch or knob in front."""
    x, y0, y1, height = fittings.beside_board(look)
    stand = 0.7
    model.slab((-x, y0, 0.0), (x, y1, stand), look.colour)
    middle, foot = (y0 + y1) / 2, 0.09
    model.slab((x - 0.2, middle - 0.07, stand), (x - 0.03, middle + 0.07, stand + foot), look.accent)
    model.cylinder((x - 0.14, middle, (stand + foot + height) / 2), 0.012, height - stand - foot, look.accent)
    model.link("shade")
    model.cylinder((x - 0.14, middle, height), 0.12, 0.18, "cream", link="shade", solid=False)
    model.lamp(ROOT, "active", "shade", "lamp", "cream")
    for part, said in parts.of("button"):
        button(model, part, said, (x - 0.03, middle, stand + 0.05))
    for part, said in parts.of("knob"):
        knob(model, part, said, (x - 0.03, middle, stand + 0.05))
    fittings.side_board(model, look, stand)


def ceiling_lamp(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a lamp that hangs from an arm high up; its switch is on a post."""
    depth, width, height = look.size
    x, y = depth / 2, width / 2
    model.slab((-x, -y, 0.0), (x, y, 1.15), look.colour)
    model.box((-x + 0.02, 0.0, (1.15 + height) / 2), (0.03, 0.03, height - 1.15), look.accent)
    model.box((-x + 0.4, 0.0, height), (0.8, 0.03, 0.03), look.accent, solid=False)
    model.link("shade")
    model.ball((-x + 0.78, 0.0, height - 0.1), 0.14, "cream", link="shade")
    model.lamp(ROOT, "active", "shade", "lamp", "cream")
    for part, said in parts.of("button"):
        button(model, part, said, (x, 0.0, 0.95))


def window(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a window: below a sash on hinges, above it a curtain or blind that slides sideways."""
    x, y0, y1, height = fittings.beside_board(look)
    sill, beam = 0.72, 1.06
    front = x - 0.16
    back = front - 0.1
    model.slab((back, y0, 0.0), (front, y1, sill), look.colour)
    model.slab((back, y0, height - 0.05), (front, y1, height), look.colour)
    for low, high in ((y0, y0 + 0.05), (y1 - 0.05, y1)):
        model.slab((back, low, sill), (front, high, height - 0.05), look.colour)
    model.slab((back, y0 + 0.05, beam - 0.02), (front, y1 - 0.05, beam + 0.02), look.colour)
    model.slab((back, y0 + 0.05, beam + 0.02), (back + 0.02, y1 - 0.05, height - 0.05), "light_blue")
    sash = Appearance("door", look.size, "light_blue", "steel", 1.0)
    door(model, "sash", sash, (front, y0 + 0.02, sill), (front, y1 - 0.02, beam), height=0.9, latched=False,
         window=False, part_of=ROOT)  # fmt: skip
    for part, said in parts.of("curtain"):
        way = (y1 - y0) * 0.4
        low = y1 - 0.04 - (y1 - y0) * 0.55
        model.link(part, part=part, kind="prismatic", axis=(0.0, -1.0, 0.0), limits=(0.0, way), friction=4.0, mass=1.0)
        for index in range(6):
            left = low + index * (y1 - 0.04 - low) / 6
            model.box((front + 0.1 + 0.008 * (index % 2), left + (y1 - 0.04 - low) / 12, (beam + height) / 2),
                      (0.02, (y1 - 0.04 - low) / 6, height - beam - 0.01), said.colour, link=part)  # fmt: skip
        face, at = front + 0.12, low + 0.1
        bar_handle(model, part, (face + STAND_OFF, at, beam + 0.06), 0.1, said.accent, upright=True, face=face)
        tool = Frame((face + STAND_OFF, at, beam + 0.06), INTO, LEFT)
        model.grips.append(Grip(part, "slide", part, tool, BAR + 0.04, 0.0, way - 0.02))
    model.slab((back, y0, sill - 0.05), (front, y1, sill), "cream", solid=False)
    fittings.side_board(model, look, sill)


# A stop: an arm in front of the bin does not get to a lid that leans back.
_LIFTED = math.radians(80)


def bin_(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a bin, with or without a lid that is lifted by its rim, and a button in front of what runs in it."""
    depth, width, height = look.size
    basket(model, look, Parts({}))
    for part, said in parts.of("lid"):
        x = depth / 2
        model.link(
            part, part=part, kind="revolute", origin=(-x, 0.0, height + 0.002), axis=(0.0, -1.0, 0.0),
            limits=(0.0, _LIFTED), friction=1.6, mass=0.3,
        )  # fmt: skip
        model.slab((0.0, -width / 2, 0.0), (depth, width / 2, 0.015), said.colour, link=part)
        bar = depth + STAND_OFF
        model.box((bar, 0.0, 0.0075), (BAR, 0.14, 0.015), said.accent, link=part)
        for side in (-1, 1):
            model.box((depth + STAND_OFF / 2, side * 0.062, 0.0075), (STAND_OFF, BAR, 0.015), said.accent, link=part)
        tool = Frame((bar, 0.0, 0.0075), INTO, UP)
        model.grips.append(Grip(part, "lid", part, tool, BAR + 0.04, 0.0, _LIFTED))
    for part, said in parts.of("button"):
        button(model, part, said, (depth / 2, width / 2 - 0.1, height - 0.08))
