"""The mesh that boxes are drawn by."""

from __future__ import annotations

from collections.abc import Sequence

# The mesh that boxes are drawn by: a unit cube with a normal for every face. Boxes drawn as boxes are shaded round.
CUBE = "cube.obj"


def cube() -> str:
    """Return the text of :data:`CUBE`."""
    lines: list[str] = []
    faces: list[tuple[list[float], list[int]]] = []
    for axis in range(3):
        for sign in (-1, 1):
            first = len(lines) + 1
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                corner = [0.0, 0.0, 0.0]
                corner[axis] = 0.5 * sign
                corner[(axis + 1) % 3], corner[(axis + 2) % 3] = 0.5 * a, 0.5 * b
                lines.append(f"v {_words(corner)}")
            order = range(first, first + 4) if sign > 0 else range(first + 3, first - 1, -1)
            normal = [0.0, 0.0, 0.0]
            normal[axis] = float(sign)
            faces.append((normal, list(order)))
    lines += [f"vn {_words(normal)}" for normal, _ in faces]
    for number, (_, (a, b, c, d)) in enumerate(faces, start=1):
        lines.append(f"f {a}//{number} {b}//{number} {c}//{number}")
        lines.append(f"f {a}//{number} {c}//{number} {d}//{number}")
    return "\n".join([*lines, ""])


def _words(values: Sequence[float]) -> str:
    return " ".join(f"{value:.1f}" for value in values)
