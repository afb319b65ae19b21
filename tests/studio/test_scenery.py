"""The view of the whole room: everything is in it, however wide or narrow the window is."""

from __future__ import annotations

from io import BytesIO
from itertools import combinations
from math import tan
from pathlib import Path
from typing import Any
from unittest.mock import MagicMock

import numpy as np
import pytest
import trimesh

from tmd.studio.environment_view import Look, open_setting
from tmd.studio.view3d.scenery import Scenery
from tmd.world.corpus import Corpus

FOV = 1.3


def node(path: str, *_: object, **__: object) -> MagicMock:
    made = MagicMock()
    made.name = path
    return made


def furnished(
    kitchen: Corpus, environment: str | Path = "kitchen1", *, dark: bool = False
) -> tuple[Scenery, Look, MagicMock]:
    """The scenery of a kitchen; what draws it does nothing."""
    setting = open_setting(kitchen, kitchen.world(environment), kitchen.file(environment))
    assert setting.look is not None
    scene = MagicMock()
    for each in (scene.add_glb, scene.add_mesh_simple, scene.add_frame, scene.add_label):
        each.side_effect = node
    return Scenery(scene, setting.look, None, lambda _: None, dark=dark), setting.look, scene


@pytest.mark.parametrize("aspect", [1.1, 3.0, 0.5, 0.8, 0.3])
def test_the_whole_room_is_in_view(kitchen: Corpus, aspect: float) -> None:
    scenery, look, _ = furnished(kitchen)
    for pose in look.first.poses.values():
        assert in_view(scenery, aspect, pose.position)


def in_view(scenery: Scenery, aspect: float, place: tuple[float, float, float]) -> bool:
    """Whether the view of the whole room shows a place."""
    eye, target = (np.array(each) for each in scenery.overview(FOV, aspect))
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    seen = np.array(place) - eye
    depth = float(seen @ forward) * tan(FOV / 2)
    return depth > 0 and abs(seen @ right) <= depth * aspect and abs(seen @ np.cross(right, forward)) <= depth


def test_the_robot_is_in_view_of_a_room_with_little_in_it(kitchen: Corpus, tmp_path: Path) -> None:
    """Where it begins, and beside the only table."""
    small = tmp_path / "small.yaml"
    small.write_text("name: small\ndomain: kitchen\nobjects: {table1: {class: table, position: [2.5, 0, 0]}}\n")
    scenery, _, _ = furnished(kitchen, small)
    for place in ((0.0, 0.0, 1.3), (2.5, 1.2, 1.3), (2.5, -1.2, 1.3)):
        assert in_view(scenery, 0.9, place)


def test_the_room_is_as_dark_as_the_page(kitchen: Corpus) -> None:
    def brightness(*, dark: bool) -> float:
        scene = furnished(kitchen, dark=dark)[2]
        room = [call.args[1] for call in scene.add_glb.call_args_list if call.args[0].startswith("/0/room/")]
        meshes: list[Any] = [trimesh.load(BytesIO(glb), file_type="glb", force="mesh") for glb in room]
        return max(float(mesh.visual.vertex_colors[:, :3].mean()) for mesh in meshes)

    assert brightness(dark=True) < 80 < 150 < brightness(dark=False)


def test_names_are_not_over_one_another(kitchen: Corpus) -> None:
    scenery, look, scene = furnished(kitchen)
    eye, target = scenery.overview(FOV, 1.2)
    camera = MagicMock(position=eye, look_at=target, up_direction=(0.0, 0.0, 1.0), fov=FOV, image_height=700)
    scenery.names(camera)
    shown = {call.args[1]: call.kwargs["position"] for call in scene.add_label.call_args_list}
    assert len(shown) > 0.8 * len(look.first.poses)
    forward = (np.array(target) - eye) / np.linalg.norm(np.array(target) - eye)
    right = np.cross(forward, (0.0, 0.0, 1.0)) / np.linalg.norm(np.cross(forward, (0.0, 0.0, 1.0)))
    boxes = []
    for name, place in shown.items():
        seen = np.array(place) - eye
        pixels = 700 / (seen @ forward * 2 * tan(FOV / 2))
        boxes.append((seen @ right * pixels, seen @ np.cross(right, forward) * pixels, 7 * len(name)))
    for (x, y, wide), (a, b, broad) in combinations(boxes, 2):
        assert abs(x - a) > (wide + broad) / 2 or abs(y - b) > 14


def test_the_camera_looks_at_the_robot_and_at_an_object(kitchen: Corpus) -> None:
    scenery, look, _ = furnished(kitchen)
    robot = np.array(look.first.robot.position)
    for eye, target in (scenery.behind(), scenery.eyes()):
        assert np.linalg.norm((np.array(eye) - robot)[:2]) < 3
        assert np.linalg.norm((np.array(target) - robot)[:2]) < 2
    aim = scenery.near(["pr2", "kettle1"])
    assert aim is not None
    assert np.linalg.norm(np.array(aim[1]) - look.first.poses["kettle1"].position) < 0.3
    assert aim[0][2] > aim[1][2]
    assert scenery.near(["pr2"]) is None
