"""The view of the whole room: everything is in it, however wide or narrow the window is."""

from __future__ import annotations

from math import tan
from unittest.mock import MagicMock

import numpy as np
import pytest

from tmd.studio.environment_view import open_setting
from tmd.studio.view3d.scenery import Scenery
from tmd.veil.corpus import Corpus

FOV = 1.3


@pytest.mark.parametrize(("aspect", "covered"), [(1.1, 0.0), (3.0, 0.0), (0.5, 0.6), (0.8, 0.0), (0.3, 0.6)])
def test_the_whole_room_is_in_view(kitchen: Corpus, aspect: float, covered: float) -> None:
    setting = open_setting(kitchen, kitchen.world("kitchen1"), kitchen.file("kitchen1"))
    assert setting.look is not None
    scenery = Scenery(MagicMock(), setting.look, None, lambda _: None)  # what draws is not asked
    eye, target = (np.array(place) for place in scenery.overview(FOV, aspect, covered))
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    for pose in setting.look.first.poses.values():
        seen = np.array(pose.position) - eye
        depth = seen @ forward * tan(FOV / 2)
        assert depth > 0
        assert abs(seen @ right) <= depth * aspect
        assert (2 * covered - 1) * depth <= seen @ up <= depth
