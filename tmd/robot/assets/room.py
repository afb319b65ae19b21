"""The floor and low walls: those of the environment, or three around the fixtures and an open side for the camera."""

from __future__ import annotations

import math

from tmd.robot.assets.urdf_builder import UrdfModel
from tmd.robot.scene.furniture_layout import Room

WALL_HEIGHT = 1.7
THICK = 0.08
TILE = 0.8
_FAR, _SIDE = "#e9e4d8", "#dfe5e2"


def build_room(room: Room) -> str:
    """Return the room as URDF text, in the world's frame."""
    model = UrdfModel("room", 1000.0)
    (x0, y0), (x1, y1) = room.low, room.high
    west, south = x0 - 2.0, y0 - 2.0
    rows, columns = math.ceil((x1 - west) / TILE), math.ceil((y1 + 2.0 - south) / TILE)
    middle = (west + rows * TILE / 2, south + columns * TILE / 2, -0.05)
    model.box(middle, (rows * TILE, columns * TILE, 0.1), "sand", seen=False)
    # tiles of two colours beside each other: one on top of another would flicker
    for row in range(rows):
        for column in range(columns):
            corner = (west + row * TILE, south + column * TILE)
            colour = "#d8cdb8" if (row + column) % 2 else "#e6dfd0"
            model.slab((*corner, -0.02), (corner[0] + TILE, corner[1] + TILE, 0.0), colour, solid=False)
    if not room.corners:
        model.slab((x1, y0 - THICK, 0.0), (x1 + THICK, y1 + THICK, WALL_HEIGHT), _FAR)
        model.slab((x0, y1, 0.0), (x1, y1 + THICK, WALL_HEIGHT), _SIDE)
        model.slab((x0, y0 - THICK, 0.0), (x1, y0, WALL_HEIGHT), _SIDE)
        return model.text()
    for (ax, ay), (bx, by) in room.walls():
        length, yaw = math.dist((ax, ay), (bx, by)), math.atan2(by - ay, bx - ax)
        out = (math.sin(yaw), -math.cos(yaw))
        centre = ((ax + bx) / 2 + out[0] * THICK / 2, (ay + by) / 2 + out[1] * THICK / 2, WALL_HEIGHT / 2)
        size = (length + 2 * THICK, THICK, WALL_HEIGHT)
        # a wall between the camera and the room is there, and is not drawn
        model.box(centre, size, _FAR if out[0] > 0.7 else _SIDE, turn=(0.0, 0.0, yaw), seen=out[0] > -0.3)
    return model.text()
