"""The table of all kinds of shapes: what builds them, how they look, and the parts they have places for."""

from __future__ import annotations

from tmd.robot.assets.appearance import Appearance, Builder, ShapeKind
from tmd.robot.assets.appliances import coffee_maker, cooker, fridge, heater, hotplate, microwave, sink
from tmd.robot.assets.furniture import basket, chest, counter, cupboard, desk, drawer, seat, shelf, table
from tmd.robot.assets.living_room_fixtures import bin_, ceiling_lamp, lamp, player, tv, window
from tmd.robot.assets.things import block, egg, remote, sack, strapped, tin, utensil
from tmd.robot.assets.vessels import bottle, bowl, capped_bottle, carafe, carton, cup, jar, kettle, pot, sugar_bowl

_Size = tuple[float, float, float]
_Takes = tuple[tuple[str, int], ...]


def _fixture(build: Builder, kind: str, size: _Size, colour: str, accent: str, takes: _Takes = ()) -> ShapeKind:
    return ShapeKind("fixture", Appearance(kind, size, colour, accent, 20.0), build, takes)


def _item(
    build: Builder, kind: str, size: _Size, colour: str, accent: str, mass: float, takes: _Takes = ()
) -> ShapeKind:  # fmt: skip
    return ShapeKind("item", Appearance(kind, size, colour, accent, mass), build, takes)


def _part(kind: str, size: _Size, colour: str, accent: str, settings: tuple[str, ...] = ()) -> ShapeKind:
    return ShapeKind("part", Appearance(kind, size, colour, accent, 0.1, settings))


_DOORS = (("door", 1), ("latched_door", 1))
_ALL = (
    _fixture(counter, "counter", (0.6, 1.75, 0.86), "sage", "granite"),
    _fixture(table, "table", (0.75, 1.25, 0.74), "oak", "walnut"),
    _fixture(shelf, "shelf", (0.42, 1.15, 0.88), "pine", "oak"),
    _fixture(cupboard, "cupboard", (0.46, 0.7, 1.5), "sage", "dark_steel", _DOORS),
    _fixture(drawer, "drawer", (0.52, 0.66, 0.9), "pine", "dark_steel"),
    _fixture(desk, "desk", (0.65, 1.3, 0.76), "oak", "dark_steel", (("sliding_drawer", 1),)),
    _fixture(chest, "chest", (0.52, 0.8, 0.95), "pine", "dark_steel", (("sliding_drawer", 3),)),
    _fixture(basket, "basket", (0.45, 0.6, 0.5), "sand", "oak"),
    _fixture(seat, "seat", (0.85, 1.9, 0.42), "teal", "light_blue"),
    _fixture(cooker, "cooker", (0.6, 1.2, 0.86), "white", "steel", (("burner", 4), ("knob", 4))),
    _fixture(hotplate, "hotplate", (0.55, 1.04, 0.86), "red", "steel", (("burner", 2), ("knob", 2))),
    _fixture(heater, "heater", (0.55, 0.7, 0.86), "white", "dark_grey", (("burner", 1), ("knob", 1))),
    _fixture(sink, "sink", (0.6, 1.24, 0.86), "sage", "steel", (("tap", 1), ("tap_handle", 1), ("knob", 1))),
    _fixture(microwave, "microwave", (0.55, 1.04, 1.16), "steel", "dark_steel", (*_DOORS, ("button", 2))),
    _fixture(fridge, "fridge", (0.62, 1.02, 1.5), "white", "steel", (*_DOORS, ("niche", 1), ("button", 1))),
    _fixture(coffee_maker, "coffee_maker", (0.5, 0.8, 1.08), "red", "steel", (("spout", 1), ("button", 1))),
    _fixture(bin_, "bin", (0.36, 0.36, 0.66), "dark_grey", "black", (("lid", 1), ("button", 1))),
    _fixture(tv, "tv", (0.5, 1.5, 1.32), "black", "walnut", (("screen", 1), ("speaker", 1), ("button", 5))),
    _fixture(player, "player", (0.48, 0.9, 0.9), "navy", "steel", (("disc_drive", 1), ("button", 3))),
    _fixture(lamp, "lamp", (0.42, 0.76, 1.15), "walnut", "dark_steel", (("button", 1), ("knob", 1))),
    _fixture(ceiling_lamp, "ceiling_lamp", (0.16, 0.3, 2.2), "cream", "dark_steel", (("button", 1),)),
    _fixture(window, "window", (0.5, 1.4, 1.7), "white", "steel", (("curtain", 1),)),
    _item(cup, "cup", (0.095, 0.068, 0.09), "white", "blue", 0.25),
    _item(cup, "glass", (0.064, 0.064, 0.12), "glass", "light_blue", 0.2),
    _item(bowl, "bowl", (0.185, 0.14, 0.065), "cream", "terracotta", 0.35),
    _item(bowl, "plate", (0.225, 0.18, 0.036), "white", "navy", 0.35),
    _item(pot, "pot", (0.28, 0.16, 0.12), "steel", "black", 0.7),
    _item(kettle, "kettle", (0.2, 0.15, 0.21), "red", "black", 0.7),
    _item(carafe, "carafe", (0.17, 0.11, 0.15), "steel", "black", 0.6),
    _item(jar, "jar", (0.07, 0.068, 0.1), "brown", "red", 0.4),
    _item(jar, "tub", (0.07, 0.07, 0.085), "vanilla", "light_blue", 0.4),
    _item(carton, "carton", (0.066, 0.066, 0.19), "white", "blue", 0.6),
    _item(sugar_bowl, "sugar_bowl", (0.068, 0.068, 0.07), "cream", "pink", 0.3),
    _item(bottle, "bottle", (0.06, 0.06, 0.19), "raspberry", "white", 0.35),
    _item(utensil, "spoon", (0.18, 0.032, 0.04), "steel", "dark_steel", 0.06),
    _item(utensil, "scoop", (0.19, 0.042, 0.042), "steel", "teal", 0.12),
    _item(utensil, "fork", (0.18, 0.028, 0.026), "steel", "dark_steel", 0.06),
    _item(utensil, "knife", (0.2, 0.022, 0.026), "steel", "walnut", 0.08),
    _item(block, "block", (0.1, 0.06, 0.05), "orange", "cream", 0.15),
    _item(block, "packet", (0.12, 0.065, 0.045), "orange", "yellow", 0.1),
    _item(block, "folded", (0.16, 0.065, 0.05), "light_blue", "white", 0.15),
    _item(egg, "egg", (0.046, 0.046, 0.065), "cream", "light_blue", 0.07),
    _item(tin, "pod", (0.048, 0.048, 0.04), "black", "orange", 0.03),
    _item(tin, "tin", (0.066, 0.066, 0.12), "red", "steel", 0.3),
    _item(capped_bottle, "capped_bottle", (0.06, 0.06, 0.21), "dark_green", "yellow", 0.4),
    _item(strapped, "strapped", (0.3, 0.26, 0.15), "terracotta", "cream", 0.3),
    _item(remote, "remote", (0.16, 0.05, 0.026), "black", "grey", 0.1, (("button", 6),)),
    _item(sack, "sack", (0.25, 0.27, 0.12), "dark_grey", "yellow", 0.15),
    _part("plain_part", (0.05, 0.05, 0.05), "grey", "grey"),
    _part("door", (0.02, 0.5, 0.5), "sage", "dark_steel"),
    _part("latched_door", (0.02, 0.5, 0.5), "steel", "dark_steel"),
    _part("sliding_drawer", (0.5, 0.66, 0.19), "pine", "dark_steel"),
    _part("lid", (0.36, 0.36, 0.02), "grey", "steel"),
    _part("curtain", (0.02, 0.5, 0.6), "raspberry", "steel"),
    _part("screen", (0.01, 0.9, 0.5), "dark_grey", "black"),
    _part("speaker", (0.01, 0.06, 0.06), "grey", "black"),
    _part("disc_drive", (0.1, 0.2, 0.1), "dark_grey", "black"),
    _part("button", (0.035, 0.032, 0.032), "green", "white"),
    _part("knob", (0.045, 0.044, 0.044), "black", "steel", ("off", "low", "high")),
    _part("tap_handle", (0.02, 0.08, 0.06), "steel", "blue", ("off", "high")),
    _part("burner", (0.16, 0.16, 0.01), "black", "grey"),
    _part("tap", (0.2, 0.03, 0.3), "steel", "steel"),
    _part("niche", (0.2, 0.3, 0.3), "dark_grey", "steel"),
    _part("spout", (0.04, 0.04, 0.03), "steel", "black"),
)
KINDS = {kind.default.kind: kind for kind in _ALL}
