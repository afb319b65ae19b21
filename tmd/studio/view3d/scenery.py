"""3D view of one visitor: the room, its objects and the robot."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tmd.robot.assets.urdf_builder import ROOT
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.video.symbolic_renderer import Picture
from tmd.studio.environment_view import Look
from tmd.studio.view3d.meshes import Figure
from tmd.studio.view3d.performance import Moment

if TYPE_CHECKING:
    import viser

# Of the selected object, which has lines and a label as well.
ORANGE = (230, 159, 0)
# Metres: the height of the robot's eyes.
_EYE = 1.35
# Radians: how far the view of the whole room looks down.
_ELEVATION = 0.66
# Radians: how far beside the robot the view of one object is.
_ASIDE = 0.7
# Metres: the robot's height, half its width, and how far beside the furniture it may stand.
_TALL, _WIDE, _BESIDE = 1.4, 0.4, 0.9
# How much of the view the room takes.
_FILL = 0.94
# Metres: the distances that the room may be seen from.
_LEAST, _MOST = 2.0, 60.0
# Pixels: of a letter of a name, and of its line; how many lines a name goes up at most.
_LETTER, _ROW, _LIFTS = 7.5, 17, 6
# How bright the room is on a dark page.
_DARK = 0.28
# The link of the robot that is where the robot is.
BASE = "base_footprint"
# The root link of an object's URDF.
_ROOT = "root"

# A place to look from, and the point that is looked at.
Aim = tuple[Vector, Vector]


class Scenery:
    """The 3D view of one visitor.

    ``figure`` is ``None`` where the robot's model is not installed. ``pointed`` is called with the name of an object
    that was clicked. ``number`` is that of the scene among those of one view, so that no two have nodes of one name:
    what the browser still does for a node that is removed, it does to the new one of that name.
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        look: Look,
        figure: Figure | None,
        pointed: Callable[[str], None],
        *,
        dark: bool = False,
        number: int = 0,
    ) -> None:
        self._root = f"/{number}"
        self._scene = scene
        self._look = look
        self._figure = figure
        self._pointed = pointed
        self._dark = dark
        self._frames: dict[str, viser.FrameHandle] = {}
        self._links: dict[tuple[str, str], viser.GlbHandle | viser.MeshHandle] = {}
        self._robot: dict[str, viser.GlbHandle] = {}
        self._marks: list[viser.LineSegmentsHandle | viser.LabelHandle] = []
        self._named: dict[str, viser.LabelHandle] = {}
        self._base = look.first.robot
        self._poses: dict[str, Pose] = {}
        self._colours: dict[tuple[str, str], tuple[float, ...]] = {}
        self._build()
        self.draw(look.first)

    def _build(self) -> None:
        scene, look = self._scene, self._look
        scene.set_up_direction("+z")
        scene.configure_default_lights(enabled=True, cast_shadow=False)
        for piece in look.room:
            scene.add_glb(f"{self._root}/room/{piece.link}", piece.glb(_DARK if self._dark else 1.0))
        for name, parts in look.objects.items():
            self._frames[name] = scene.add_frame(f"{self._root}/objects/{name}", show_axes=False)
            coloured = {link for owner, link in look.first.colours if owner == name}
            for piece in parts:
                path = f"{self._root}/objects/{name}/{piece.link}"
                node: viser.GlbHandle | viser.MeshHandle
                if piece.link in coloured:
                    mesh = piece.mesh
                    node = scene.add_mesh_simple(path, mesh.vertices, mesh.faces, flat_shading=True, side="double")
                else:
                    node = scene.add_glb(path, piece.glb())
                node.on_click(lambda _, name=name: self._pointed(name))  # type: ignore[misc]
                place = name, ROOT if piece.link == _ROOT else piece.link
                self._links[place] = node
        for piece in self._figure.pieces if self._figure else ():
            self._robot[piece.link] = scene.add_glb(f"{self._root}/robot/{piece.link}", piece.glb())

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
        self._base = picture.robot

    def replay(self, moment: Moment) -> None:
        """Show a moment of a simulation."""
        for name, pose in moment.objects.items():
            self._move(self._frames[name], pose)
        for place, pose in moment.links.items():
            if place in self._links:
                self._move(self._links[place], pose)
        for place, colour in moment.colours.items():
            self.paint(place, colour)
        for link, pose in self._figure.links(moment.joints).items() if self._figure else ():
            self._move(self._robot[link], pose)
            if link == BASE:
                self._base = pose

    def _move(self, node: viser.SceneNodeHandle, pose: Pose) -> None:
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

    def names(self, camera: viser.CameraHandle | None) -> None:
        """Show the names of all objects as a camera sees them, none over another; hide them without a camera.

        The nearest come first; a name that is in the way goes up, and one that finds no place is left out.
        """
        places = {} if camera is None else self._free_places(camera)
        for name, label in self._named.items():
            label.visible = name in places
        for name, place in places.items():
            if name in self._named:
                self._named[name].position = place
            else:
                self._named[name] = self._scene.add_label(
                    f"{self._root}/names/{name}", name, position=place, anchor="bottom-center"
                )

    def _free_places(self, camera: viser.CameraHandle) -> dict[str, Vector]:
        """Return the places of the names that find one."""
        eye = np.asarray(camera.position)
        forward = np.asarray(camera.look_at) - eye
        right = np.cross(forward, np.asarray(camera.up_direction))
        up = np.cross(right, forward)
        forward, right, up = (axis / max(float(np.linalg.norm(axis)), 1e-6) for axis in (forward, right, up))
        pixel = 2 * np.tan(camera.fov / 2) / max(camera.image_height, 1)
        tops = {name: self._top(name) - eye for name in self._frames}
        taken: list[tuple[float, float, float]] = []
        found = {}
        for name, top in sorted(tops.items(), key=lambda each: float(each[1] @ forward)):
            metres = float(top @ forward) * pixel
            if metres <= 0:
                continue
            x, y, half = float(top @ right) / metres, float(top @ up) / metres, len(name) * _LETTER / 2 + 4
            for high in np.arange(_LIFTS) * _ROW + y:
                if all(abs(x - other) >= half + wide or abs(high - at) >= _ROW for other, at, wide in taken):
                    taken.append((x, float(high), half))
                    found[name] = _vector(eye + top + up * (high - y) * metres)
                    break
        return found

    def _top(self, name: str) -> NDArray[np.float64]:
        """Return the middle of the upper side of an object's box in the world."""
        corners = self._corners(name, self._poses[self._frames[name].name])
        return np.array((*corners[:, :2].mean(axis=0), corners[:, 2].max() + 0.03))

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
        path = f"{self._root}/objects/{name}/selected"
        self._marks = [
            self._scene.add_line_segments(path, _edges(low, high), ORANGE, thickness=3.0, thickness_units="screen"),
            self._scene.add_label(f"{self._root}/objects/{name}/name", name, position=(0.0, 0.0, high[2] + 0.08)),
        ]

    def eyes(self) -> Aim:
        """Return the place of the robot's camera, and the point that it looks at."""
        return self._base.apply((0.2, 0.0, _EYE)), self._base.apply((0.9, 0.0, 1.0))

    def behind(self) -> Aim:
        """Return a place behind and above the robot, and the point in front of it."""
        return self._base.apply((-1.6, 0.5, 2.3)), self._base.apply((0.7, 0.0, 0.7))

    def near(self, names: Iterable[str]) -> Aim | None:
        """Return a place beside the robot that the first of some objects is seen from, and its middle; or ``None``."""
        name = next((each for each in names if each in self._frames), None)
        if name is None:
            return None
        corners = self._corners(name, self._poses[self._frames[name].name])
        middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
        away = np.array(self._base.position) - middle
        turned = np.arctan2(away[1], away[0]) + _ASIDE
        distance = 0.9 + 2 * float(np.linalg.norm(corners[0] - middle))
        level, high = distance * np.cos(_ELEVATION), distance * np.sin(_ELEVATION)
        return _vector(middle + np.array((level * np.cos(turned), level * np.sin(turned), high))), _vector(middle)

    def overview(self, fov: float, aspect: float) -> Aim:
        """Return the nearest place, from the open side of the room, from where everything is seen; and what to look at.

        In view are all objects and the robot, where it begins and where it may stand beside them.

        ``fov`` is the angle between the lower and the upper edge of the view, in radians; ``aspect`` is its width
        divided by its height.
        """
        points = np.concatenate([self._corners(name, self._look.first.poses[name]) for name in self._frames])
        points = np.concatenate((points, self._standing(points)))
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
                shifts = np.linspace(least, most, 50)  # as far from the upper edge as from the lower one
                shift = shifts[np.abs((high - shifts[:, None]) / half).max(axis=1).argmin()]
                break
        eye = middle - distance * forward + shift * up
        return _vector(eye), _vector(eye + distance * forward)

    def _standing(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the corners of the robot's box, where it begins and beside the furniture, to the left and right."""
        x, y, _ = self._look.first.robot.position
        room, (low, high) = self._look.still.room, (points.min(axis=0), points.max(axis=0))
        left, right = max(low[1] - _BESIDE, room.low[1]), min(high[1] + _BESIDE, room.high[1])
        begins = product((x - _WIDE, x + _WIDE), (y - _WIDE, y + _WIDE), (0.0, _TALL))
        return np.array([*begins, *product((low[0], high[0]), (left, right), (0.0, _TALL))])

    def _corners(self, name: str, pose: Pose) -> NDArray[np.float64]:
        """Return the corners of an object's box in the world, where the object has a pose."""
        model = self._look.still.blueprints[name].model
        return np.array([pose.apply(corner) for corner in product(*zip(model.low, model.high, strict=True))])


def _vector(values: NDArray[np.float64]) -> Vector:
    x, y, z = values.tolist()
    return x, y, z


def _edges(low: tuple[float, ...], high: tuple[float, ...]) -> NDArray[np.float64]:
    """Return the twelve edges of a box: (12, 2, 3)."""
    corners = [[(low, high)[(index >> axis) & 1][axis] for axis in range(3)] for index in range(8)]
    pairs = [(one, one | 1 << axis) for one in range(8) for axis in range(3) if not one & 1 << axis]
    return np.array([[corners[one], corners[other]] for one, other in pairs])
