"""The view of the whole room: everything is in it, however wide or narrow the window is."""

from __future__ import annotations

from math import tan
from unittest.mock import MagicMock

import numpy as np
import pytest

from tmd.studio.environment_view import Look, open_setting
from tmd.studio.view3d.scenery import Scenery
from tmd.world.corpus import Corpus

FOV = 1.3


def node(path: str, *_: object, **__: object) -> MagicMock:
    made = MagicMock()
    made.name = path
    return made


def furnished(kitchen: Corpus) -> tuple[Scenery, Look]:
    """The scenery of a kitchen; what draws it does nothing."""
    setting = open_setting(kitchen, kitchen.world("kitchen1"), kitchen.file("kitchen1"))
    assert setting.look is not None
    scene = MagicMock(add_glb=node, add_mesh_simple=node, add_frame=node)
    return Scenery(scene, setting.look, None, lambda _: None), setting.look


@pytest.mark.parametrize("aspect", [1.1, 3.0, 0.5, 0.8, 0.3])
def test_the_whole_room_is_in_view(kitchen: Corpus, aspect: float) -> None:
    scenery, look = furnished(kitchen)
    eye, target = (np.array(place) for place in scenery.overview(FOV, aspect))
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    for pose in look.first.poses.values():
        seen = np.array(pose.position) - eye
        depth = seen @ forward * tan(FOV / 2)
        assert depth > 0
        assert abs(seen @ right) <= depth * aspect
        assert abs(seen @ up) <= depth
