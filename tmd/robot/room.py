"""The floor and the three low walls around the fixtures; the fourth side is open to the camera."""

from __future__ import annotations

from tmd.robot.layout import Room
from tmd.robot.model import Model

WALL_HEIGHT = 1.7
TILE = 0.6


def build_room(room: Room) -> str:
    """The room as URDF text, in the world's frame."""
    model = Model("room", 1000.0)
    (x0, y0), (x1, y1) = room.low, room.high
    model.slab((x0 - 2.0, y0 - 2.0, -0.1), (x1 + 2.0, y1 + 2.0, 0.0), "sand")
    across, along = int((y1 - y0) / TILE), int((x1 - x0) / TILE)
    for row in range(along):
        for column in range(across):
            if (row + column) % 2 == 0:
                low = (x0 + row * TILE, y0 + column * TILE, 0.0)
                model.slab(low, (low[0] + TILE, low[1] + TILE, 0.0005), "cream", solid=False)
    thick = 0.08
    model.slab((x1, y0 - thick, 0.0), (x1 + thick, y1 + thick, WALL_HEIGHT), "#e9e4d8")
    for edge, sign in ((y1, 1), (y0, -1)):
        low, high = sorted((edge, edge + sign * thick))
        model.slab((x0, low, 0.0), (x1, high, WALL_HEIGHT), "#dfe5e2")
    return model.text()
