"""The PR2 as a figure: its meshes, and where its links are for given joint positions. No simulator is needed."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from functools import cached_property

import numpy as np

from tmd.robot.assets.colours import robot_colour
from tmd.robot.pr2.ik import ArmKinematics
from tmd.robot.pr2.kinematics import Tree
from tmd.robot.pr2.urdf import HEAD, TORSO, TUCKED, prepare
from tmd.robot.sim.pose import Pose
from tmd.robot.video.symbolic_renderer import HANDS
from tmd.studio.view3d.meshes import MeshPiece, pieces

# Metres: how high it is lifted.
_TORSO = 0.15
# Radians: it looks down a little.
_NOD = 0.35
# From where the posture of an arm that holds something is sought.
_OUT = (0.0, 0.3, 0.0, -1.2, 0.0, -0.6, 0.0)


class Figure:
    """The packaged PR2.

    Attributes:
        pieces: What is seen of it.

    Raises:
        MissingToolError: The robot's model is not installed.
    """

    def __init__(self) -> None:
        model = prepare()
        root = ET.fromstring(model.urdf.read_bytes())
        self._tree = Tree(root)
        self.pieces: tuple[MeshPiece, ...] = tuple(pieces(root, paint=robot_colour))

    def links(self, positions: Mapping[str, float]) -> dict[str, Pose]:
        """Return the pose of each piece in the world, or in the robot's frame without positions of the base joints."""
        frames = self._tree.forward(positions, self._tree.links, {self._tree.root: np.eye(4)})
        return {piece.link: Pose.from_matrix(frames[piece.link]) for piece in self.pieces}

    def posture(self, held: int) -> dict[str, float]:
        """Return the joint positions of the robot with a number of things in its hands, the right one first."""
        positions = {TORSO: _TORSO, HEAD[1]: _NOD}
        for index, side in enumerate(("right", "left")):
            joints, arm = self._arms[side]
            positions |= dict(zip(joints, arm if index < held else TUCKED[side], strict=True))
        return positions

    @cached_property
    def _arms(self) -> dict[str, tuple[tuple[str, ...], tuple[float, ...]]]:
        """The postures that hold something: in front of the body, as a scene without a simulator draws it."""
        frames = self._tree.forward({TORSO: _TORSO}, self._tree.links, {self._tree.root: np.eye(4)})
        up = Pose.from_matrix(frames["base_link"])
        found = {}
        for side, place in zip(("right", "left"), HANDS, strict=True):
            arm = ArmKinematics(self._tree, side)
            tool = up.inverse() * Pose((place[0] - 0.03, place[1], place[2] + 0.05))
            seed = _OUT if side == "left" else tuple(-v if i in (0, 2, 4) else v for i, v in enumerate(_OUT))
            solved = arm.solve(tool, _TORSO, seed)
            found[side] = (arm.joints, solved[0] if solved else TUCKED[side])
        return found
