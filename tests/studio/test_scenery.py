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


@pytest.mark.parametrize(("aspect", "covered"), [(1.1, 0.0), (3.0, 0.0), (0.5, 0.6), (0.8, 0.0), (0.3, 0.6)])
def test_the_whole_room_is_in_view(kitchen: Corpus, aspect: float, covered: float) -> None:
    scenery, look = furnished(kitchen)
    eye, target = (np.array(place) for place in scenery.overview(FOV, aspect, covered))
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    for pose in look.first.poses.values():
        seen = np.array(pose.position) - eye
        depth = seen @ forward * tan(FOV / 2)
        assert depth > 0
        assert abs(seen @ right) <= depth * aspect
        assert (2 * covered - 1) * depth <= seen @ up <= depth


def test_what_is_seen_first_along_a_ray(kitchen: Corpus) -> None:
    scenery, look = furnished(kitchen)
    eye, _ = scenery.overview(FOV, 1.0)

    def towards(name: str) -> tuple[str, str] | None:
        middle = look.first.poses[name].apply((0.0, 0.0, look.still.blueprints[name].model.high[2] / 2))
        return scenery.first_hit(eye, [there - here for there, here in zip(middle, eye, strict=True)])

    assert towards("pot1") == ("pot1", "")
    assert towards("plate1") == ("cupboard1", "door") and towards("fork1") == ("fork1", "")
    assert scenery.first_hit(eye, (-1.0, 0.0, 0.0)) is None and scenery.first_hit(eye, (0.0, 0.0, 1.0)) is None
    aside = look.first.poses["pot1"]
    scenery.move({"pot1": type(aside)((5.0, 5.0, 0.0))}, {}, {})
    assert towards("pot1") != ("pot1", "")
