"""Meshes for the browser: one GLB file for each link of a URDF that moves or changes colour; the PR2 as a figure."""

from __future__ import annotations

import io
import xml.etree.ElementTree as ET
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tmd.robot.assets.features import robot_colour
from tmd.robot.pr2.kinematics import Array, Tree, origin
from tmd.robot.pr2.urdf import ARM, HEAD, TORSO, TUCKED, prepare
from tmd.robot.sim.pose import Pose
from tmd.robot.sim.urdf_files import CUBE

if TYPE_CHECKING:
    import trimesh

_GREY = (0.7, 0.7, 0.72, 1.0)
# Metres: how high it is lifted.
_TORSO = 0.15
# Radians: it looks down a little.
_NOD = 0.35
# Radians: an arm that holds something in front of the body, where a scene without a simulator draws what is held.
_HOLDING = {
    "right": (-0.621, -0.466, -1.799, -2.015, -2.906, -1.293, -1.169),
    "left": (0.621, -0.466, 1.799, -2.015, 2.906, -1.293, 1.169),
}


@dataclass(frozen=True, slots=True)
class MeshPiece:
    """Visible mesh of a link and of the links that are fixed to it.

    Attributes:
        link: The link; its frame is the piece's.
        mesh: Its triangles, with their colours.
    """

    link: str
    mesh: trimesh.Trimesh

    def glb(self, brightness: float = 1.0) -> bytes:
        """Return the mesh as binary glTF, its colours times ``brightness``."""
        buffer = io.BytesIO()
        mesh: Any = self.mesh.copy()
        colours = mesh.visual.vertex_colors.copy()
        colours[:, :3] = colours[:, :3] * brightness
        mesh.visual.vertex_colors = colours
        mesh.export(buffer, file_type="glb")
        return buffer.getvalue()


def pieces(
    root: ET.Element, apart: Collection[str] = (), paint: Callable[[str], tuple[float, ...]] | None = None
) -> list[MeshPiece]:
    """Return the pieces of a URDF.

    Args:
        root: The parsed ``<robot>``; mesh files by absolute paths.
        apart: Links that are separate pieces although they are fixed to others.
        paint: The colour of a link: red, green, blue and alpha from 0 to 1; those of the URDF without it.

    Returns:
        One for every link that moves, or is ``apart``, and has something to show; in the order of the file.
    """
    import trimesh

    tree = Tree(root) if root.find("joint") is not None else None
    links = {link.get("name", ""): link for link in root.findall("link")}
    materials = {m.get("name", ""): m for m in root.findall("material")}
    groups: dict[str, list[trimesh.Trimesh]] = {}
    for name, element in links.items():
        carrier, frame = _carrier(tree, name, apart)
        for visual in element.findall("visual"):
            mesh = _mesh(visual, paint(name) if paint else _colour(visual, materials))
            if mesh is not None:
                mesh.apply_transform(frame @ origin(visual.find("origin")))
                groups.setdefault(carrier, []).append(mesh)
    together: Any = trimesh.util.concatenate
    return [MeshPiece(name, together(groups[name])) for name in links if name in groups]


def _carrier(tree: Tree | None, name: str, apart: Collection[str]) -> tuple[str, Array]:
    """Return the link whose piece a link is in, and where it is in that link's frame."""
    frame = np.eye(4)
    while tree is not None and name in tree.links and tree.links[name].kind == "fixed" and name not in apart:
        frame = tree.links[name].origin @ frame
        name = tree.links[name].parent
    return name, frame


def _mesh(visual: ET.Element, rgba: tuple[float, ...]) -> trimesh.Trimesh | None:
    import trimesh

    shape = next(iter(visual.find("geometry") or ()), None)
    if shape is None:
        return None
    mesh: Any
    if shape.tag == "mesh":
        scale = np.array([float(word) for word in shape.get("scale", "1 1 1").split()])
        path = shape.get("filename", "")
        mesh = trimesh.creation.box((1.0, 1.0, 1.0)) if path == CUBE else trimesh.load(Path(path), force="mesh")
        mesh.apply_scale(scale)
    elif shape.tag == "cylinder":
        mesh = trimesh.creation.cylinder(float(shape.get("radius", "0")), float(shape.get("length", "0")), sections=24)
    elif shape.tag == "sphere":
        mesh = trimesh.creation.icosphere(2, float(shape.get("radius", "0")))
    else:
        size = [float(word) for word in shape.get("size", "1 1 1").split()]
        mesh = trimesh.creation.box(size)
    if shape.tag == "box" or shape.get("filename") == CUBE:
        mesh.unmerge_vertices()  # edges stay sharp
    colour = (np.array(rgba) * 255).astype(np.uint8)
    mesh.visual = trimesh.visual.ColorVisuals(mesh, vertex_colors=np.tile(colour, (len(mesh.vertices), 1)))
    return mesh  # type: ignore[no-any-return]  # trimesh.load gives whatever the file holds


def _colour(visual: ET.Element, materials: Mapping[str, ET.Element]) -> tuple[float, ...]:
    material = visual.find("material")
    if material is None:
        return _GREY
    colour = material.find("color")
    if colour is None and material.get("name") in materials:
        colour = materials[material.get("name", "")].find("color")
    return _GREY if colour is None else tuple(float(word) for word in colour.get("rgba", "").split())


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
            angles = _HOLDING[side] if index < held else TUCKED[side]
            positions |= {f"{side[0]}_{joint}": angle for joint, angle in zip(ARM, angles, strict=True)}
        return positions
