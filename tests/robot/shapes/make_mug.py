"""Makes ``mug.obj``, a mug as CAD programs give them: millimetres, y is up, the handle is at +x.

``python -m tests.robot.shapes.make_mug`` writes it again.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh

OUTER, INNER, FLOOR, HEIGHT, SIDES = 33.0, 29.0, 6.0, 92.0, 24
"""Radii, thickness of the bottom and height, in millimetres."""


def mug() -> trimesh.Trimesh:
    """A round body with a wall of 4 mm, and a handle of three bars."""
    profile = [(0, 0), (OUTER - 2, 0), (OUTER, 4), (OUTER, HEIGHT), (INNER, HEIGHT), (INNER, FLOOR), (0, FLOOR)]
    body = trimesh.creation.revolve(np.array(profile, dtype=float), sections=SIDES)
    bars = [((46, 0, 25), (30, 9, 9)), ((46, 0, 70), (30, 9, 9)), ((57, 0, 47.5), (9, 9, 54))]
    handle = [trimesh.creation.box(size, transform=trimesh.transformations.translation_matrix(at)) for at, size in bars]
    whole = trimesh.util.concatenate([body, *handle])
    whole.apply_transform(trimesh.transformations.rotation_matrix(-np.pi / 2, (1, 0, 0)))  # z up to y up
    return whole


if __name__ == "__main__":
    (Path(__file__).parent / "mug.obj").write_text(mug().export(file_type="obj", include_normals=False, digits=3))
