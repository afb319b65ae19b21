"""3D view of one visitor: the room, its objects and the robot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tmd.robot.assets.urdf_builder import ROOT
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.video.symbolic_renderer import Picture
from tmd.studio.environment_view import Look
from tmd.studio.view3d.meshes import Figure

if TYPE_CHECKING:
    from viser import (
        FrameHandle,
        GlbHandle,
        LabelHandle,
        LineSegmentsHandle,
        MeshHandle,
        SceneApi,
        SceneNodeHandle,
    )

# Of the selected object, which has lines and a label as well.
ORANGE = (230, 159, 0)
# Metres: the height of the robot's eyes.
_EYE = 1.35
# Radians: how far the view of the whole room looks down.
_ELEVATION = 0.66
# How much of the view the room takes.
_FILL = 0.94
# Metres: the distances that the room may be seen from.
_LEAST, _MOST = 2.0, 60.0
# The root link of an object's URDF.
_ROOT = "root"


class Scenery:
    """The 3D view of one visitor.

    Args:
        scene: Where it is drawn.
        look: The environment.
        figure: The robot; ``None`` where its model is not installed.
        pointed: Called with the name of an object that was clicked.
    """

    def __init__(self, scene: SceneApi, look: Look, figure: Figure | None, pointed: Callable[[str], None]) -> None:
        self._scene = scene
        self._look = look
        self._figure = figure
        self._pointed = pointed
        self._frames: dict[str, FrameHandle] = {}
        self._links: dict[tuple[str, str], GlbHandle | MeshHandle] = {}
        self._robot: dict[str, GlbHandle] = {}
        self._marks: list[LineSegmentsHandle | LabelHandle] = []
        self._named: list[LabelHandle] = []
        self._poses: dict[str, Pose] = {}
        self._colours: dict[tuple[str, str], tuple[float, ...]] = {}
        self._build()
        self.draw(look.first)

    def _build(self) -> None:
        scene, look = self._scene, self._look
        scene.set_up_direction("+z")
        scene.configure_default_lights(enabled=True, cast_shadow=False)
        for piece in look.room:
            scene.add_glb(f"/room/{piece.link}", piece.glb())
        for name, parts in look.objects.items():
            self._frames[name] = scene.add_frame(f"/objects/{name}", show_axes=False)
            coloured = {link for owner, link in look.first.colours if owner == name}
            for piece in parts:
                path = f"/objects/{name}/{piece.link}"
                node: GlbHandle | MeshHandle
                if piece.link in coloured:
                    mesh = piece.mesh
                    node = scene.add_mesh_simple(path, mesh.vertices, mesh.faces, flat_shading=True, side="double")
                else:
                    node = scene.add_glb(path, piece.glb())
                node.on_click(lambda _, name=name: self._pointed(name))  # type: ignore[misc]
                place = name, ROOT if piece.link == _ROOT else piece.link
                self._links[place] = node
        for piece in self._figure.pieces if self._figure else ():
            self._robot[piece.link] = scene.add_glb(f"/robot/{piece.link}", piece.glb())

    def draw(self, picture: Picture) -> None:
        """Show a symbolic state."""
        for name, pose in picture.poses.items():
            self._move(self._frames[name], pose)
        for (name, link), node in self._links.items():
            self._move(node, self._look.still.within(name, link, picture))
        for place, colour in picture.colours.items():
            self.paint(place, colour)
        held = sum(rest.at[1] == "held" for rest in picture.rests.values())
        if self._figure is not None:
            for link, pose in self._figure.links(self._figure.posture(held)).items():
                self._move(self._robot[link], picture.robot * pose)

    def move(
        self, objects: Mapping[str, Pose], links: Mapping[tuple[str, str], Pose], robot: Mapping[str, Pose]
    ) -> None:
        """Show poses that a simulation went through.

        Args:
            objects: Of objects, in the world.
            links: Of the links of objects, in the frames of their objects.
            robot: Of the robot's links, in the world.
        """
        for name, pose in objects.items():
            self._move(self._frames[name], pose)
        for place, pose in links.items():
            if place in self._links:
                self._move(self._links[place], pose)
        for link, pose in robot.items():
            if link in self._robot:
                self._move(self._robot[link], pose)

    def _move(self, node: SceneNodeHandle, pose: Pose) -> None:
        """Move a node, unless it is there: what does not move costs nothing."""
        if self._poses.get(node.name) == pose:
            return
        self._poses[node.name] = pose
        x, y, z, w = pose.orientation
        node.position = pose.position
        node.wxyz = (w, x, y, z)

    def paint(self, place: tuple[str, str], colour: tuple[float, float, float, float]) -> None:
        """Give a link, named by its object and its own name, a colour; none where alpha is 0."""
        node = self._links.get(place)
        if node is None or self._colours.get(place) == colour:
            return
        self._colours[place] = colour
        node.visible = colour[3] > 0
        node.color = tuple(round(255 * part) for part in colour[:3])  # type: ignore[union-attr]

    def names(self, *, shown: bool) -> None:
        """Show the names of all objects, or hide them."""
        for old in self._named:
            old.remove()
        self._named = []
        for name in self._frames if shown else ():
            high = self._look.still.blueprints[name].model.high
            self._named.append(
                self._scene.add_label(f"/objects/{name}/called", name, position=(0.0, 0.0, high[2] + 0.03))
            )

    def mark(self, name: str | None) -> None:
        """Draw lines around an object, and its name above it; nothing for ``None``."""
        for old in self._marks:
            old.remove()
        self._marks = []
        if name is None or name not in self._frames:
            return
        model = self._look.still.blueprints[name].model
        low = tuple(v - 0.01 for v in model.low)
        high = tuple(v + 0.01 for v in model.high)
        path = f"/objects/{name}/selected"
        self._marks = [
            self._scene.add_line_segments(path, _edges(low, high), ORANGE, thickness=3.0, thickness_units="screen"),
            self._scene.add_label(f"/objects/{name}/name", name, position=(0.0, 0.0, high[2] + 0.08)),
        ]

    def eyes(self, picture: Picture) -> tuple[Vector, Vector]:
        """Return the place of the robot's camera, and the point that it looks at."""
        robot = picture.robot
        return robot.apply((0.2, 0.0, _EYE)), robot.apply((0.9, 0.0, 1.0))

    def overview(self, fov: float, aspect: float) -> tuple[Vector, Vector]:
        """Return the nearest place, from the open side of the room, from where everything is seen; and what to look at.

        Args:
            fov: Radians that are seen from the lower to the upper edge of the view.
            aspect: The view's width divided by its height.
        """
        points = np.concatenate([self._corners(name) for name in self._frames])
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        forward = np.array((np.cos(_ELEVATION), 0.0, -np.sin(_ELEVATION)))
        up = np.array((np.sin(_ELEVATION), 0.0, np.cos(_ELEVATION)))
        across, high, deep = np.abs((points - middle)[:, 1]), (points - middle) @ up, (points - middle) @ forward
        distance, shift = _MOST, 0.0
        for distance in np.geomspace(_LEAST, _MOST, 200):
            half = (deep + distance) * np.tan(fov / 2)  # metres from the middle of the view to its edge, at each point
            if half.min() <= 0 or (across > _FILL * half * aspect).any():
                continue
            least, most = (high - _FILL * half).max(), (high + _FILL * half).min()
            if least <= most:
                shift = (least + most) / 2
                break
        eye = middle - distance * forward + shift * up
        return _vector(eye), _vector(eye + distance * forward)

    def _corners(self, name: str) -> NDArray[np.float64]:
        """Return the corners of an object's box in the world."""
        model, pose = self._look.still.blueprints[name].model, self._look.first.poses[name]
        box = [(model.low[i], model.high[i]) for i in range(3)]
        return np.array([pose.apply((x, y, z)) for x in box[0] for y in box[1] for z in box[2]])


def _vector(values: NDArray[np.float64]) -> Vector:
    x, y, z = values.tolist()
    return x, y, z


def _edges(low: tuple[float, ...], high: tuple[float, ...]) -> NDArray[np.float64]:
    """Return the twelve edges of a box: (12, 2, 3)."""
    corners = [[(low, high)[(index >> axis) & 1][axis] for axis in range(3)] for index in range(8)]
    pairs = [(one, one | 1 << axis) for one in range(8) for axis in range(3) if not one & 1 << axis]
    return np.array([[corners[one], corners[other]] for one, other in pairs])
