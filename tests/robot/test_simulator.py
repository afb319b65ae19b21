"""The world: frames are those of the URDF, time is counted, what is welded stays, what rests sleeps."""

from __future__ import annotations

import importlib
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pybullet", reason="needs the extra robot")

from tmd.diagnostics import MissingToolError, TmdError
from tmd.robot.sim.simulator import Pose, Simulator, pybullet, window_opens

Box = Callable[..., int]


def test_poses_are_those_of_the_urdf_frames(sim: Simulator, box: Box) -> None:
    body = box((0.1, 0.2, 0.3), (1, 2, 3), mass=0.5, offset="0.02 0.01 0.2", yaw=0.5)
    assert sim.pose(body).distance(Pose.flat(1, 2, 3, 0.5)) < 1e-9
    assert sim.pose(body).angle(Pose.flat(1, 2, 3, 0.5)) < 1e-7
    lower, upper = sim.extents(body)
    assert 2.9 < lower[2] <= 3 < 3.3 <= upper[2] < 3.4
    sim.set_pose(body, Pose.flat(0, 0, 1, -1.0))
    assert sim.pose(body).distance(Pose.flat(0, 0, 1)) < 1e-9
    assert sim.pose(body).yaw() == pytest.approx(-1.0)


def test_bodies_fall_and_rest(sim: Simulator, box: Box) -> None:
    floor = box((4, 4, 0.1), (0, 0, -0.1))
    body = box((0.1, 0.1, 0.1), (0, 0, 0.2), mass=0.3)
    seen: list[int] = []
    sim.add_watcher(lambda world: seen.append(world.steps))
    sim.step(240)
    assert seen == list(range(1, 241))
    assert sim.pose(body).position[2] == pytest.approx(0, abs=2e-3)
    points = pybullet().getContactPoints(body, floor, physicsClientId=sim.client)
    assert sum(point[9] for point in points) == pytest.approx(0.3 * 9.81, rel=0.05)


def test_a_sleeping_body_falls_when_it_is_moved_or_let_go(sim: Simulator, box: Box) -> None:
    box((4, 4, 0.1), (0, 0, -0.1))
    lower, upper = box((0.2, 0.2, 0.2), (0, 0, 0), mass=1), box((0.1, 0.1, 0.1), (0, 0, 0.2), mass=0.3)
    sim.step(1200)
    sim.set_pose(lower, Pose.flat(1, 0, 0.5))
    sim.wake()
    sim.step(240)
    assert sim.pose(lower).position[2] == pytest.approx(0, abs=3e-3)
    assert sim.pose(upper).position[2] == pytest.approx(0, abs=3e-3)


def test_a_weld_holds_and_lets_go(sim: Simulator, box: Box) -> None:
    post = box((0.1, 0.1, 1.0), (0, 0, 0))
    body = box((0.1, 0.1, 0.1), (0.2, 0, 0.8), mass=0.5, offset="0.01 0 0.03")
    handle = sim.weld(post, -1, body)
    before = sim.pose(body)
    sim.step(480)
    assert sim.pose(body).distance(before) < 1e-3
    sim.unweld(handle)
    sim.step(240)
    assert sim.pose(body).position[2] < 0


def test_distances_and_rays(sim: Simulator, box: Box) -> None:
    near, far = box((0.2, 0.2, 0.2), (0, 0, 0)), box((0.2, 0.2, 0.2), (0.5, 0, 0))
    (point,) = sim.closest(near, far, 0.5)[:1]
    assert point.distance == pytest.approx(0.3, abs=2e-3)
    assert sim.closest(near, far, 0.2) == []
    hit = sim.ray((2, 0, 0.1), (-2, 0, 0.1))
    assert hit is not None
    assert hit.body == far
    assert hit.position[0] == pytest.approx(0.6, abs=1e-6)
    assert sim.ray((2, 1, 0.1), (-2, 1, 0.1)) is None


def test_a_picture_shows_what_is_there(sim: Simulator, box: Box) -> None:
    body = box((0.5, 0.5, 0.5), (0, 0, 0))
    sim.colour(body, -1, (1, 0, 0, 1))
    image = sim.picture((2, 0, 1), (0, 0, 0.2), 64, 48, shadow=False)
    assert (image.shape, image.dtype) == ((48, 64, 3), np.uint8)
    red, green, _ = image[24, 32].astype(int)
    assert red > 80
    assert green < 40


def test_a_file_that_is_no_urdf_is_named(sim: Simulator, tmp_path: Path) -> None:
    path = tmp_path / "broken.urdf"
    path.write_text("<robot")
    with pytest.raises(TmdError, match=r"broken\.urdf"):
        sim.load(path, Pose((0, 0, 0)), fixed=True)


def test_without_pybullet_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(name: str) -> None:
        raise ImportError(name)

    pybullet.cache_clear()
    monkeypatch.setattr(importlib, "import_module", fail)
    with pytest.raises(MissingToolError, match=r"tell-me-dave\[robot\]"):
        pybullet()


def test_a_window_without_a_display_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    window_opens.cache_clear()
    with pytest.raises(MissingToolError, match="--video"):
        Simulator(gui=True)
    window_opens.cache_clear()


def test_nothing_is_printed() -> None:
    code = "from tmd.robot.sim.simulator import Simulator\nwith Simulator() as s: s.picture((1, 1, 1), (0, 0, 0), 8, 8)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert (run.stdout, run.stderr) == ("", "")
