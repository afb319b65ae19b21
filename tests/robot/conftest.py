"""Worlds for the tests of the robot: boxes on a floor."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tmd.robot.sim.simulator import Simulator

URDF = """<robot name="box"><link name="box">
<inertial><origin xyz="{offset}" rpy="0.3 0 0"/><mass value="{mass}"/>
<inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0 0 {half}"/><geometry><box size="{size}"/></geometry></collision>
<visual><origin xyz="0 0 {half}"/><geometry><box size="{size}"/></geometry></visual>
</link></robot>"""


@pytest.fixture
def sim() -> Iterator[Simulator]:
    pytest.importorskip("pybullet", reason="needs the extra robot")
    from tmd.robot.sim.simulator import Simulator

    with Simulator() as world:
        yield world


@pytest.fixture
def box(sim: Simulator, tmp_path: Path) -> Callable[..., int]:
    """Loads a box; its frame is at the middle of its underside."""
    from tmd.robot.sim.simulator import Pose

    def load(
        size: tuple[float, float, float],
        place: tuple[float, float, float],
        mass: float = 0.0,
        offset: str = "0 0 0",
        yaw: float = 0.0,
    ) -> int:
        path = tmp_path / f"{len(list(tmp_path.iterdir()))}.urdf"
        words = " ".join(map(str, size))
        path.write_text(URDF.format(size=words, half=size[2] / 2, mass=mass or 1.0, offset=offset))
        return sim.load(path, Pose.flat(*place, yaw), fixed=mass == 0)

    return load
