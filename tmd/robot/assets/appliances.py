"""Kitchen appliances, each on its own base with a side board for what stands next to it."""

from __future__ import annotations

import math

from tmd.robot.assets import fittings
from tmd.robot.assets.appearance import Appearance, Parts, rows
from tmd.robot.assets.fittings import DOOR, DOWN, INTO, button, door, fronts, knob, tap_lever
from tmd.robot.assets.furniture import ROOM, WALL, chamber
from tmd.robot.assets.urdf_builder import ROOT, UrdfModel


def cooker(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a stove with an oven: burners on top in two columns, the first two in front, and knobs in front."""
    x, y0, y1, height = fittings.beside_board(look)
    model.slab((-x, y0 + 0.01, 0.0), (x - 0.06, y1, 0.08), "dark_grey")
    model.slab((-x, y0, 0.08), (x, y1, height - 0.015), look.colour)
    model.slab((-x, y0, height - 0.015), (x, y1, height), "black")
    model.slab((x, y0 + 0.06, 0.2), (x + 0.012, y1 - 0.06, height - 0.16), "black", solid=False)
    model.box((x + 0.03, (y0 + y1) / 2, height - 0.19), (0.015, y1 - y0 - 0.12, 0.015), look.accent, solid=False)
    _hob(model, parts, x, (y0, y1), height, height - 0.06)
    fittings.side_board(model, look, height)


def hotplate(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a camping stove on a table."""
    x, y0, y1, height = fittings.beside_board(look)
    stand, step = height - 0.08, 0.05
    fittings.legs(model, (-x + 0.03, x - 0.03), (y0 + 0.03, y1 - 0.03), stand - 0.03, 0.04, "walnut")
    model.slab((-x, y0, stand - 0.03), (x, y1, stand), "oak")
    model.slab((-x + step, y0 + 0.02, stand), (x - 0.01, y1 - 0.02, height), look.colour)
    _hob(model, parts, x - 0.01, (y0 + 0.02, y1 - 0.02), height, stand + 0.04)
    fittings.side_board(model, look, stand)


def heater(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a plate on a stand that heats what stands on it, with its knob in front."""
    depth, width, height = look.size
    x, y, stand = depth / 2, width / 2, height - 0.1
    fittings.legs(model, (-x + 0.03, x - 0.03), (-y + 0.03, y - 0.03), stand - 0.03, 0.04, "walnut")
    model.slab((-x, -y, stand - 0.03), (x, y, stand), "oak")
    front, half, back = x - 0.03, y - 0.06, -x + 0.05
    model.slab((back, -half, stand), (front, half, height - 0.008), look.colour)
    model.slab((back + 0.02, -half + 0.02, height - 0.008), (front - 0.02, half - 0.02, height - 0.004), look.accent)
    for part, said in parts.of("burner"):
        model.link(part, part=part)
        model.slab((back + 0.06, -half + 0.06, height - 0.004), (front - 0.06, half - 0.06, height), said.colour,
                   link=part)  # fmt: skip
        model.lamp(part, "active", part, "glow", said.colour)
    spots = [(a, b, yaw) for a, b, _ in rows(front, 2 * half - 0.2, (0.15, 0.3)) for yaw in (0.0, 1.05)]
    model.region("on", (back, -half, height), (front, half, height + ROOM), DOWN, spots, overhang=math.inf)
    for part, said in parts.of("knob"):
        knob(model, part, said, (front, half - 0.1, (stand + height) / 2))


def _hob(model: UrdfModel, parts: Parts, front: float, sides: tuple[float, float], top: float, knobs: float) -> None:
    """Add burners to a top and knobs before it."""
    burners, middle, width = parts.of("burner"), (sides[0] + sides[1]) / 2, sides[1] - sides[0]
    columns = 2 if len(burners) > 1 else 1
    deep = len(burners) > columns
    for index, (part, look) in enumerate(burners):
        radius, column, row = look.size[1] / 2, index % columns, index // columns
        side = 0.0 if columns == 1 else (2 * column - 1) * width / 4
        x, y = front - (0.11 + 0.2 * row if deep else 0.15), middle + side
        model.link(part, part=part, origin=(x, y, top))
        model.cylinder((0.0, 0.0, 0.004), radius, 0.008, look.colour, link=part)
        model.lamp(part, "active", part, "glow", look.colour)
        outwards = 1.0 if column or columns == 1 else -1.0
        low, high = (-radius, -radius, 0.008), (radius, radius, ROOM)
        spots = [(0.0, 0.0, outwards * yaw) for yaw in (1.05, 0.0, 0.5, 1.57)]
        model.region("on", low, high, DOWN, spots, part=part, link=part, overhang=math.inf)
    dials = parts.of("knob")
    for index, (part, look) in enumerate(dials):
        knob(model, part, look, (front, sides[0] + (index + 0.5) * width / len(dials), knobs))


def sink(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a sink with a shallow basin in a cabinet, the tap behind it and its lever beside it."""
    x, y0, y1, height = fittings.beside_board(look)
    floor = height - 0.08
    model.slab((-x, y0 + 0.01, 0.0), (x - 0.07, y1, 0.1), "dark_grey")
    model.slab((-x, y0, 0.1), (x - 0.02, y1, floor - 0.01), look.colour)
    fronts(model, x - 0.02, (y0, 0.12), (y1, floor - 0.03), 2, look.colour, "dark_steel")
    left, end, front, back = y0 + 0.05, y1 - 0.13, x - 0.05, x - 0.43
    model.slab((back, left, floor - 0.01), (front, end, floor), look.accent)
    for low, high in (
        ((front, y0), (x, y1)), ((-x, y0), (back, y1)), ((back, y0), (front, left)), ((back, end), (front, y1))
    ):  # fmt: skip
        model.slab((low[0], low[1], floor - 0.01), (high[0], high[1], height), look.accent)
    model.cylinder((back + 0.2, (left + end) / 2, floor + 0.001), 0.025, 0.002, "dark_grey", solid=False)
    spots = rows(x, end - left - 0.24, (0.23, 0.26), 0.07, middle=(left + end) / 2)
    spots.sort(key=lambda spot: -abs(spot[1] - (left + end) / 2))  # the middle last: what is to be filled goes there
    turned = [(a, b, c + 0.8) for a, b, c in spots]
    model.region("in", (back, left, floor), (front, end, height + 0.4), DOWN, [*spots, *turned])
    middle, spout = (left + end) / 2, height + 0.40
    for part, said in parts.of("tap"):
        model.link(part, part=part)
        foot = back - 0.04
        model.cylinder((foot, middle, (height + spout) / 2), 0.014, spout - height, said.colour, link=part)
        model.cylinder((foot + 0.12, middle, spout), 0.012, 0.26, said.colour, axis="x", link=part)
        model.cylinder((foot + 0.24, middle, spout - 0.025), 0.014, 0.05, said.colour, link=part)
        _stream(model, part, (foot + 0.24, middle), floor, spout - 0.05)
    for part, said in parts.of("tap_handle", "knob"):
        tap_lever(model, part, said, (x - 0.16, y1 - 0.065, height))
    fittings.side_board(model, look, height)


def _stream(
    model: UrdfModel, part: str, at: tuple[float, float], low: float, high: float, colour: str = "water"
) -> None:
    """Add a stream of liquid, straight down from the spout and visible while the part is active."""
    model.spouts[part] = (*at, high)
    name = f"{part}_stream"
    model.link(name, part=part)
    model.cylinder((*at, (low + high) / 2), 0.007, high - low, colour, link=name, solid=False)
    model.lamp(part, "active", name, colour, None)


def microwave(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a microwave oven on a stand: its door opens to the left, the buttons are on the right."""
    x, y0, y1, height = fittings.beside_board(look)
    stand = height - 0.42
    low, high, panel = y0 + 0.02, y1 - 0.02, 0.15
    for side in (y0, y1 - 0.04):
        model.slab((-x, side, 0.0), (x, side + 0.04, stand - 0.03), "walnut")
    model.slab((-x, y0, 0.25), (x, y1, 0.28), "oak")
    model.slab((-x, y0, stand - 0.03), (x, y1, stand), "oak")
    front, split, floor = x - 0.03 - DOOR, high - panel, stand + 0.03
    chamber(model, (front - 0.4, low, stand), (front, split, height), look.colour, "cream", (floor,), (0.16, 0.2))
    model.slab((front - 0.4, split, stand), (front + DOOR, high, height), look.accent)
    model.box((front + DOOR, split + panel / 2, height - 0.06), (0.003, 0.09, 0.04), "dark_grey", solid=False)
    model.link("display")
    model.box((front + DOOR + 0.001, split + panel / 2, height - 0.06), (0.003, 0.08, 0.03), "black", link="display",
              solid=False)  # fmt: skip
    model.lamp(ROOT, "active", "display", "lamp", "black")
    model.link("light")
    model.box((front - 0.2, (low + split) / 2, height - WALL - 0.006), (0.1, 0.1, 0.01), "grey", link="light",
              solid=False)  # fmt: skip
    model.lamp(ROOT, "active", "light", "lamp", "grey")
    for part, said in parts.of("door", "latched_door"):
        door(model, part, said, (front, low, stand), (front, split, height), height=floor + 0.17,
             latched=said.kind == "latched_door", window=True)  # fmt: skip
    for index, (part, said) in enumerate(parts.of("button")):
        button(model, part, said, (front + DOOR, split + panel / 2 + 0.01, height - 0.17 - 0.13 * index))
    fittings.side_board(model, look, stand)


def fridge(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a fridge above a freezer; with a dispenser, a panel with niche and button beside the door."""
    x, y0, y1, height = fittings.beside_board(look)
    base = 0.70
    niches = parts.of("niche")
    split = y1 - 0.32 if niches else y1
    front, middle = x - DOOR, base + (height - base) / 2
    model.slab((-x, y0, 0.0), (front, y1, base - WALL), look.colour)
    model.slab((front, y0 + 0.003, 0.05), (x, y1 - 0.003, base - WALL - 0.01), look.colour)
    model.box((x + 0.03, y0 + 0.3, base - 0.1), (0.015, 0.3, 0.015), look.accent, solid=False)
    back = front - 0.42
    model.slab((-x, y0, base - WALL), (back, y1, height), look.colour)
    chamber(model, (back, y0, base - WALL), (front, split, height), look.colour, "white", (base, middle))
    for part, said in parts.of("door", "latched_door"):
        door(model, part, said, (front, y0, base - WALL), (front, split, height), height=0.98,
             latched=said.kind == "latched_door", window=False)  # fmt: skip
    for part, said in niches:
        floor, roof = 0.78, 1.06
        model.slab((back, split, base - WALL), (x, y1, floor), look.colour)
        model.slab((back, split, roof), (x, y1, height), look.colour)
        model.slab((back, split, floor), (x - 0.24, y1, roof), "dark_grey")
        for low, high in ((split, split + 0.015), (y1 - 0.015, y1)):
            model.slab((x - 0.24, low, floor), (x, high, roof), look.colour)
        model.link(part, part=part)
        middle_y = (split + y1) / 2
        model.cylinder((x - 0.12, middle_y, roof - 0.015), 0.018, 0.03, said.accent, link=part)
        _stream(model, part, (x - 0.12, middle_y), floor, roof - 0.03)
        model.region("in", (x - 0.24, split + 0.015, floor), (x, y1 - 0.015, roof - 0.03), INTO,
                     [(x - 0.12, middle_y, yaw) for yaw in (0.0, 0.5, -0.5)], part=part, link=part,
                     overhang=math.inf)  # fmt: skip
    for part, said in parts.of("button"):
        button(model, part, said, (x, (split + y1) / 2, 1.1))
    fittings.side_board(model, look, 0.82)


def coffee_maker(model: UrdfModel, look: Appearance, parts: Parts) -> None:
    """Build a coffee maker on a stand: a plate for one cup, the spout above it, a slot for the pod on top."""
    x, y0, y1, height = fittings.beside_board(look)
    stand = height - 0.44
    model.slab((-x, y0 + 0.02, 0.0), (x - 0.02, y1, stand - 0.03), "cream")
    fronts(model, x - 0.02, (y0 + 0.02, 0.05), (y1, stand - 0.06), 1, "cream", "dark_steel")
    model.slab((-x, y0, stand - 0.03), (x, y1, stand), "oak")
    middle, front, half = (y0 + y1) / 2, x - 0.03, 0.13
    back, plate, head = front - 0.34, stand + 0.03, height - 0.09
    at = front - 0.07  # a spoon must get over a cup that stands there, with a hand that stays outside
    model.slab((back, middle - half, stand), (front, middle + half, plate), look.colour)
    model.cylinder((at, middle, plate), 0.055, 0.002, look.accent, solid=False)
    model.slab((back, middle - half, plate), (front - 0.22, middle + half, height), look.colour)
    # the head is a slim arm: what is tipped into a cup below it comes from its sides
    slot, arm, rim, end = 0.034, 0.05, height - 0.03, front - 0.02
    model.slab((front - 0.22, middle - arm, head), (end, middle + arm, rim), look.colour)
    for low, high in (
        ((at + slot, middle - arm), (end, middle + arm)),
        ((front - 0.22, middle - arm), (at - slot, middle + arm)),
        ((at - slot, middle - arm), (at + slot, middle - slot)),
        ((at - slot, middle + slot), (at + slot, middle + arm)),
    ):
        model.slab((*low, rim), (*high, height), look.colour)
    model.slab((at - slot, middle - slot, rim), (at + slot, middle + slot, rim + 0.001), "black", solid=False)
    model.region("on", (front - 0.22, middle - half, plate), (front, middle + half, head - 0.03), INTO,
                 [(at, middle, yaw) for yaw in (0.0, 0.5, -0.5)], overhang=math.inf)  # fmt: skip
    model.region("in", (at - slot, middle - slot, rim), (at + slot, middle + slot, height + 0.06), DOWN,
                 [(at, middle, 0.0)], overhang=math.inf)  # fmt: skip
    for part, said in parts.of("spout"):
        model.link(part, part=part)
        model.cylinder((at, middle, head - 0.012), 0.02, 0.024, said.accent, link=part)
        _stream(model, part, (at, middle), plate, head - 0.024, "chocolate")
    for part, said in parts.of("button"):
        button(model, part, said, (end, middle, head + 0.03))
    fittings.side_board(model, look, stand)
