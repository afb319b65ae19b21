"""Captions under pictures: the instruction, the words of the request, and the checked facts."""

from __future__ import annotations

import importlib.util
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tmd.diagnostics import MissingToolError, install_extra
from tmd.files import write_bytes

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw
    from PIL.ImageFont import FreeTypeFont, ImageFont

    Font: TypeAlias = FreeTypeFont | ImageFont

Pixels: TypeAlias = NDArray[np.uint8]
Mark: TypeAlias = Literal["expected", "measured", "inferred", "assumed", "missing"]

# Of the caption under a picture 640 pixels wide; others have it in proportion.
HEIGHT = 128
_USUAL = 640
_PAPER, _INK, _PALE = "#1d2127", "#f3f1ec", "#a3a9b3"
_COLOURS = {
    "expected": "#a3a9b3", "measured": "#6fcf7c", "inferred": "#6db3f2", "assumed": "#e6b450", "missing": "#ff7b6b",
}  # fmt: skip
_BADGES = {"ok": "#6fcf7c", "failed": "#ff7b6b", "mismatch": "#ff7b6b", "stopped": "#ff7b6b"}
_COLUMNS = 4
_GAP = 10
_REMEMBERED = 1_000
"""Maximum number of texts whose width is kept: each picture of a film says almost what the one before it said."""


@dataclass(frozen=True, slots=True)
class Caption:
    """One caption.

    Attributes:
        number: Its place in the plan.
        said: Its purpose.
        facts: Each fact with its mark.
        note: Measurements, or the reason of a failure.
        badge: One word at the right: ``ok``, ``failed``; empty while it is being done.
    """

    title: str
    number: str = ""
    said: str = ""
    facts: tuple[tuple[str, Mark], ...] = ()
    note: str = ""
    badge: str = ""


def pillow() -> None:
    """Refuse to go on without Pillow.

    Raises:
        MissingToolError: It is not installed.
    """
    if importlib.util.find_spec("PIL") is None:
        raise MissingToolError("pictures need the package Pillow, which is not installed", hint=install_extra("robot"))


def write_picture(path: Path, image: Image, kind: str, **options: Any) -> None:  # noqa: ANN401 - as Pillow has them
    """Write a picture as a ``PNG`` or ``JPEG`` file.

    Raises:
        OutputError: It cannot be written.
    """
    data = BytesIO()
    image.save(data, kind, **options)
    write_bytes(path, data.getvalue())


def caption_height(width: int) -> int:
    """Return the pixels under a picture of this width; even, as films need it."""
    return 2 * round(HEIGHT * width / _USUAL / 2)


def under(picture: Pixels, caption: Caption) -> Pixels:
    """Return the picture (height, width, 3) with its caption under it: ``caption_height(width)`` pixels higher."""
    from PIL import Image

    height, width, _ = picture.shape
    whole = Image.new("RGB", (width, height + caption_height(width)), _PAPER)
    whole.paste(Image.fromarray(picture), (0, 0))
    _write(whole, height, caption)
    return np.asarray(whole, dtype=np.uint8)


def filmstrip(pictures: Sequence[Pixels]) -> Image:
    """Arrange pictures of one size, in reading order, on one sheet of at most four columns."""
    from PIL import Image

    columns = min(_COLUMNS, max(1, math.ceil(math.sqrt(len(pictures)))))
    rows = math.ceil(len(pictures) / columns)
    height, width, _ = pictures[0].shape
    sheet = Image.new("RGB", (columns * (width + _GAP) + _GAP, rows * (height + _GAP) + _GAP), "#f3f1ec")
    for index, picture in enumerate(pictures):
        row, column = divmod(index, columns)
        sheet.paste(Image.fromarray(picture), (_GAP + column * (width + _GAP), _GAP + row * (height + _GAP)))
    return sheet


def _write(whole: Image, top: int, caption: Caption) -> None:
    from PIL import ImageDraw

    draw = ImageDraw.Draw(whole)
    unit = whole.width / _USUAL
    left, right = 14 * unit, whole.width - 14 * unit
    bold, plain, small = _font(round(20 * unit)), _font(round(15 * unit)), _font(round(14 * unit))

    def at(row: float) -> float:
        return top + row * unit

    x = left
    if caption.number:
        draw.text((x, at(10)), caption.number, _PALE, bold)
        x += _width(caption.number, bold) + 10 * unit
    if caption.badge:
        width = _width(caption.badge, bold)
        draw.text((right - width, at(10)), caption.badge, _BADGES.get(caption.badge, _PALE), bold)
        end = right - width - 12 * unit
    else:
        end = right
    draw.text((x, at(10)), _fitted(caption.title, bold, end - x), _INK, bold)
    draw.text((left, at(37)), _fitted(caption.said, small, right - left), _PALE, small)
    rows = _facts(draw, caption.facts, plain, unit, (left, right, at(60)))
    free = 3 - rows
    lines = _wrapped(caption.note, small, right - left, max(1, free))
    for index, line in enumerate(lines[: max(0, free)]):
        colour = _COLOURS["missing"] if caption.badge in ("failed", "mismatch", "stopped") else _PALE
        draw.text((left, at(60 + 21 * (rows + index))), line, colour, small)


def _facts(
    draw: ImageDraw, facts: Sequence[tuple[str, Mark]], font: Font, unit: float, place: tuple[float, float, float]
) -> int:
    """Draw facts beside each other on at most two rows; return the rows that were used."""
    left, right, top = place
    x, row, step, gap = left, 0, 20 * unit, 18 * unit
    for index, (fact, mark) in enumerate(facts):
        rest = len(facts) - index
        # on the last row there must be room for the words that tell of the others
        spare = _width(f"and {rest} more", font) + gap if rest > 1 else 0.0
        wide = step + _width(fact, font)
        if row == 0 and x > left and x + wide > right:
            x, row = left, 1
        elif row == 1 and x + wide + spare > right:
            draw.text((x, top + 21 * unit), f"and {rest} more", _PALE, font)
            return 2
        text = _fitted(fact, font, right - x - step - (spare if row else 0.0))
        _mark(draw, (x, top + 21 * unit * row + 2 * unit), mark, 13 * unit)
        draw.text((x + step, top + 21 * unit * row), text, _COLOURS[mark] if mark != "measured" else _INK, font)
        x += step + _width(text, font) + gap
    return row + 1 if facts else 0


def _mark(draw: ImageDraw, place: tuple[float, float], mark: Mark, size: float) -> None:
    """Draw a ring, a tick, three dots, a question mark or a cross, since not every font has them."""
    x, y = place
    colour, width = _COLOURS[mark], max(1, round(size / 5))

    def line(*points: tuple[float, float]) -> None:
        draw.line([(x + a * size, y + b * size) for a, b in points], colour, width, joint="curve")

    if mark == "expected":
        draw.ellipse((x + 0.1 * size, y + 0.2 * size, x + 0.8 * size, y + 0.9 * size), outline=colour, width=width)
    elif mark == "measured":
        line((0.0, 0.6), (0.35, 0.95), (0.95, 0.15))
    elif mark == "inferred":  # therefore
        for a, b in ((0.5, 0.25), (0.15, 0.85), (0.85, 0.85)):
            dot = 0.14 * size
            draw.ellipse((x + a * size - dot, y + b * size - dot, x + a * size + dot, y + b * size + dot), fill=colour)
    elif mark == "assumed":
        line((0.2, 0.3), (0.35, 0.12), (0.65, 0.12), (0.8, 0.32), (0.5, 0.55), (0.5, 0.7))
        dot = 0.1 * size
        at = (x + 0.5 * size, y + 0.95 * size)
        draw.ellipse((at[0] - dot, at[1] - dot, at[0] + dot, at[1] + dot), fill=colour)
    else:
        line((0.1, 0.2), (0.85, 0.95))
        line((0.85, 0.2), (0.1, 0.95))


@lru_cache(_REMEMBERED)
def _width(text: str, font: Font) -> float:
    """Return how wide a text is."""
    return font.getlength(text)


def _fitted(text: str, font: Font, width: float) -> str:
    """Cut the text with dots if it is too wide."""
    if _width(text, font) <= width:
        return text
    while text and _width(text + "…", font) > width:
        text = text[:-1]
    return text.rstrip() + "…"


def _wrapped(text: str, font: Font, width: float, most: int) -> list[str]:
    """Wrap the text to at most ``most`` lines; the rest is cut."""
    lines: list[str] = []
    words = text.split()
    while words and len(lines) < most:
        count = len(words) if len(lines) == most - 1 else 1
        while count < len(words) and _width(" ".join(words[: count + 1]), font) <= width:
            count += 1
        lines.append(_fitted(" ".join(words[:count]), font, width))
        words = words[count:]
    return lines


@cache
def _font(size: int) -> Font:
    """Return Pillow's own font."""
    from PIL import ImageFont

    return ImageFont.load_default(size)
