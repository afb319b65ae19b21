"""The filmstrip of a run: one sheet, of which a page shows one picture for each instruction."""

from __future__ import annotations

import math
import struct
from base64 import b64encode
from dataclasses import dataclass

# How :func:`tmd.robot.video.captions.filmstrip` lays a sheet out; a test holds the two together.
_COLUMNS, _GAP = 4, 10
_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_HEADER = struct.Struct(">8x4x4sII")
# Pixels along an edge; no sheet is larger.
_LARGEST = 50_000


@dataclass(frozen=True, slots=True)
class Strip:
    """A filmstrip.

    Attributes:
        address: The sheet as a ``data:`` address.
        width: Of the sheet in pixels.
        height: Of the sheet.
        tile_width: Of one picture; 0 where the sheet is not laid out for the number of pictures.
        tile_height: Of one picture.
        tiles: The left and upper edge of each picture, in order.
    """

    address: str
    width: int
    height: int
    tile_width: int = 0
    tile_height: int = 0
    tiles: tuple[tuple[int, int], ...] = ()


def read_strip(data: bytes, count: int) -> Strip | None:
    """Return a sheet of ``count`` pictures.

    Args:
        data: The PNG file.
        count: How many instructions were carried out.

    Returns:
        The strip; without tiles where the sheet cannot be of so many pictures, and ``None`` for what is not a PNG.
    """
    if len(data) < _HEADER.size or not data.startswith(_SIGNATURE):
        return None
    kind, width, height = _HEADER.unpack_from(data)
    if kind != b"IHDR" or not (0 < width <= _LARGEST and 0 < height <= _LARGEST):
        return None
    address = f"data:image/png;base64,{b64encode(data).decode()}"
    columns = min(_COLUMNS, max(1, math.ceil(math.sqrt(count))))
    rows = max(1, math.ceil(count / columns))
    tile, rest = divmod(width - _GAP, columns)
    tall, left = divmod(height - _GAP, rows)
    if count < 1 or rest or left or tile <= _GAP or tall <= _GAP:
        return Strip(address, width, height)
    places = [divmod(index, columns) for index in range(count)]
    tiles = tuple((_GAP + column * tile, _GAP + row * tall) for row, column in places)
    return Strip(address, width, height, tile - _GAP, tall - _GAP, tiles)
