"""Things that come as files, a mesh or a URDF, with what ``objects.yaml`` says beside them.

A mesh is turned and scaled, and put with the middle of its underside at the origin. What touches are convex pieces,
for that is what simulators are quick with: its hull, or, of a vessel, the pieces that V-HACD divides it into (Mamou and
Ghorbel 2009). Where it can be taken is measured on it. The copies are kept in the user's cache, one for each content.

A URDF stays as it is but for names: a joint gets that of the link that it moves, and the root link is called ``root``,
as in all models of the scene.
"""

from __future__ import annotations

import hashlib
import math
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tmd.diagnostics import MissingToolError, TmdError, install_extra
from tmd.files import make_directory, read_bytes, write_bytes
from tmd.pddl.reading.syntax import nearest
from tmd.robot.assets.appearance import rows
from tmd.robot.assets.features import Frame, Grasp, Grip
from tmd.robot.assets.fittings import DOWN, LEFT, TIP
from tmd.robot.assets.urdf_builder import ROOT, UrdfLink, UrdfModel
from tmd.robot.assets.vessels import CLEARANCE, WIDEST, contents, grasp, rim_grasps
from tmd.robot.pr2.kinematics import Tree, angles, faults_of, origin, set_origin, shape_points
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.sim.urdf_files import CUBE, cache_directory, end_of, find_mesh, mesh_advice, mesh_library, read_urdf
from tmd.world.shape import GraspEntry, HandleEntry, RegionEntry, Shape

if TYPE_CHECKING:
    import trimesh

Array = NDArray[np.float64]
_ADVICE = install_extra("meshes")
# Metres: what is smaller or larger is in other units.
_SMALLEST, _LARGEST = 0.01, 6.0
# For V-HACD: a mug then keeps its hollow, with walls that are a millimetre too thick.
_PIECES = {"maxConvexHulls": 32, "resolution": 100_000, "maxNumVerticesPerCH": 32}
# Metres: what is at most so wide fits between the fingers; formats with short numbers round 7 cm up.
_NARROW = 0.0701
# Metres for a unit, the largest first, and the size of what is carried: which of them a mesh is given in is a guess.
_UNITS = {"inch": 0.0254, "centimetre": 0.01, "millimetre": 0.001, "micrometre": 1e-6}
_CARRIED = (0.02, 0.6)
# Metres from a handle to what the fingers meet there, at most.
_BESIDE = 0.02
# Metres: a wall of so much is taken at its rim.
_RIM = 0.02
# Metres from the tool's frame back to the palm.
_PALM = 0.05
# Formats of the simulator.
_READ = (".obj", ".stl", ".dae")
_MESHES = "name an OBJ, STL, PLY or GLB file"
# N or N·m that hold a joint where it is left, as in the scene's own kinds; of a button: its spring.
_FRICTION = {"door": 1.2, "flap": 1.2, "drawer": 5.0, "slide": 4.0, "lid": 0.03, "knob": 0.12, "button": 6.0}
_SLIDES = ("drawer", "slide", "button")


class ModelFault(Exception):  # noqa: N818 - it becomes a TmdError as soon as its place is known
    """A fault of a file, or of its entry in ``objects.yaml``; ``path`` leads to the fault within the shape.

    ``others`` are further faults of the same file.
    """

    def __init__(self, path: Sequence[str | int], message: str, hint: str | None = None) -> None:
        super().__init__(message)
        self.path, self.message, self.hint = tuple(path), message, hint
        self.others: tuple[ModelFault, ...] = ()


def _refuse(faults: Iterable[ModelFault]) -> None:
    """Raise the first fault, with the others; do nothing where there is none."""
    found = list(faults)
    if found:
        found[0].others = tuple(found[1:])
        raise found[0]


# ---------------------------------------------------------------------- meshes


def mesh_model(name: str, shape: Shape, path: Path, colour: str, mass: float) -> UrdfModel:
    """Build a thing in one piece from a mesh; ``mass`` in kilograms.

    Raises:
        ModelFault: The file is not a mesh, or its entry does not fit.
        MissingToolError: A package that reads or divides meshes is not installed.
    """
    mesh = _standing(path, shape)
    low, high = (_vector(corner) for corner in mesh.bounds)
    solid = shape.solid if shape.solid is not None else not shape.holds
    if not solid and not mesh.is_watertight:
        hint = "close its holes; or say `solid: true`, if nothing goes into it"
        raise ModelFault(("mesh",), f"{path} is not closed: nothing is inside or outside of it", hint)
    hollow = _hollow(mesh) if shape.holds else None
    seen, solids = _copies(path, shape, mesh, solid=solid)
    model = UrdfModel(name, mass)
    model.mesh(seen, solids, low, high, colour)
    if hollow is not None:
        radius, floor, outer, wall = hollow
        contents(model, radius, floor, high[2])
    if shape.grasps:
        _said_grasps(model, shape.grasps)
    else:
        _measured_grasps(model, mesh, shape.scale)
        if hollow is not None and wall <= _RIM:
            rim_grasps(model, outer, high[2], wall, (math.pi / 2, 0.0, -math.pi / 2))
    for index, region in enumerate(shape.regions):
        if region.link is not None:
            raise ModelFault(("regions", index, "link"), "a mesh has no links", "leave `link` out")
        _region(model, index, region, ROOT)
    return model


def read_mesh(path: Path) -> trimesh.Trimesh:
    """Read the triangles of a file, all of its pieces together.

    Raises:
        ModelFault: It is not a mesh.
        MissingToolError: trimesh is not installed.
    """
    library = mesh_library()
    if read_bytes(path).startswith(b"version https://git-lfs"):
        raise ModelFault(("mesh",), f"{path} is a pointer of Git LFS, not the file", "run `git lfs pull`")
    if path.suffix[1:].lower() not in library.available_formats():
        raise ModelFault(("mesh",), f"{path} is not a mesh: {path.suffix or 'such'} files are not read", _MESHES)
    try:
        mesh: Any = library.load(path, force="mesh")
        if len(mesh.faces) == 0 or not np.isfinite(mesh.vertices).all():
            raise ValueError("it has no triangles whose corners are numbers")
        if mesh.vertices.shape[1] != 3 or not 0 <= mesh.faces.min() <= mesh.faces.max() < len(mesh.vertices):
            raise ValueError("a triangle has a corner that is not there")
    except Exception as error:  # its readers raise whatever a damaged file leads to
        told = " ".join(str(error).split())[:120] or type(error).__name__
        raise ModelFault(("mesh",), f"{path} is not a mesh: {told}", _MESHES) from error
    return mesh  # type: ignore[no-any-return]  # trimesh.load gives whatever the file holds


def _standing(path: Path, shape: Shape) -> trimesh.Trimesh:
    """Return the mesh in metres, upright, with the middle of its underside at the origin."""
    if not path.is_file():
        raise ModelFault(("mesh",), f"there is no file {path}", "its path is read from the folder of objects.yaml")
    mesh: Any = read_mesh(path)
    mesh.apply_scale(shape.scale)
    mesh.apply_transform(Pose.turned(*map(math.radians, shape.turn)).homogeneous())
    extents = np.asarray(mesh.bounds[1] - mesh.bounds[0])
    size = " × ".join(f"{side:.3g}" for side in extents)
    if np.linalg.svd(mesh.vertices - mesh.vertices.mean(axis=0), compute_uv=False)[-1] < 1e-9:
        raise ModelFault(("mesh",), f"{path} has no thickness: it is {size} m large", "give it another side")
    if not _SMALLEST <= extents.max() <= _LARGEST:
        raise ModelFault(("mesh",), f"{path} is {size} m large", _unit(mesh, shape.scale))
    bottom = mesh.vertices[:, 2].min()
    foot = mesh.vertices[mesh.vertices[:, 2] < bottom + 0.05 * extents[2]]
    middle = (foot.min(axis=0) + foot.max(axis=0)) / 2
    mesh.apply_translation((-middle[0], -middle[1], -bottom))
    return mesh  # type: ignore[no-any-return]  # as read_mesh gave it


def _unit(mesh: trimesh.Trimesh, scale: float) -> str:
    """Return the unit in which the mesh would be something that a hand takes, as advice."""
    sides = sorted(map(float, mesh.extents))
    for name, unit in _UNITS.items():
        if _CARRIED[0] <= sides[-1] * unit <= _CARRIED[1] and sides[0] * unit <= _NARROW:
            size = " × ".join(f"{100 * side * unit:.3g}" for side in mesh.extents)
            return f"say `scale: {scale * unit:g}` if its unit is the {name}: then it is {size} cm large"
    return "say by `scale:` how many metres its unit is"


def _copies(path: Path, shape: Shape, mesh: trimesh.Trimesh, *, solid: bool) -> tuple[Path, list[Path]]:
    """Write the mesh as it stands, and its convex pieces, as OBJ files into the user's cache."""
    said = repr((shape.scale, shape.turn, solid, sorted(_PIECES.items())))
    digest = hashlib.sha256(path.read_bytes() + b"\0" + said.encode() + Path(__file__).read_bytes()).hexdigest()[:20]
    folder = cache_directory("meshes") / digest
    seen = folder / "seen.obj"
    if not seen.is_file():  # written last: where it is, everything is
        make_directory(folder)
        for number, piece in enumerate(_convex(mesh, solid=solid)):
            write_bytes(folder / f"piece{number:02d}.obj", _obj(piece))
        write_bytes(seen, _obj(mesh))
    return seen, sorted(folder.glob("piece*.obj"))


def _convex(mesh: trimesh.Trimesh, *, solid: bool) -> list[trimesh.Trimesh]:
    """Return convex pieces that make up the mesh."""
    try:
        if solid:
            return [mesh.convex_hull]
        from trimesh import Trimesh
        from trimesh.decomposition import convex_decomposition

        return [Trimesh(**piece, process=False) for piece in convex_decomposition(mesh, **_PIECES)]
    except ImportError as error:
        raise MissingToolError(f"dividing meshes needs the package {error.name}", hint=_ADVICE) from error


def _obj(mesh: trimesh.Trimesh) -> bytes:
    """Return an OBJ file without normals, so that edges are drawn sharp."""
    text = mesh.export(
        file_type="obj", include_normals=False, include_color=False, include_texture=False, digits=6, header=None
    )
    return str(text).encode()


def _cut(mesh: trimesh.Trimesh, height: float) -> Array:
    """Return where the mesh meets a level plane: line segments (n, 2, 2), x and y of both ends."""
    lines: Array = mesh_library().intersections.mesh_plane(mesh, (0.0, 0.0, 1.0), (0.0, 0.0, height))
    return lines[:, :, :2]


def _radius(mesh: trimesh.Trimesh, height: float) -> float:
    """Return the distance from the axis to the nearest wall at a height."""
    pieces = _cut(mesh, height)
    start, way = pieces[:, 0], pieces[:, 1] - pieces[:, 0]
    length = np.maximum((way**2).sum(axis=1), 1e-18)
    share = np.clip(-(start * way).sum(axis=1) / length, 0.0, 1.0)
    return float(np.linalg.norm(start + share[:, None] * way, axis=1).min()) if len(pieces) else 0.0


def _bottom(mesh: trimesh.Trimesh) -> float:
    """Return the height of the uppermost surface over the middle of the underside."""
    corners = np.asarray(mesh.triangles)[np.abs(mesh.face_normals[:, 2]) > 1e-9]
    # beside the axis: a vertex may lie on it, as of a lathe
    points = np.full((len(corners), 3), (1e-7, 1e-7, 0.0))
    weights = mesh_library().triangles.points_to_barycentric(corners * (1.0, 1.0, 0.0), points)
    over = np.all(weights >= -1e-9, axis=1)
    if not over.any():
        message = "it has no bottom: nothing is over the middle of its underside"
        raise ModelFault(("holds",), message, "close it there, or leave `holds` out")
    return float((weights * corners[:, :, 2]).sum(axis=1)[over].max())


def _hollow(mesh: trimesh.Trimesh) -> tuple[float, float, float, float]:
    """Return radius and floor of the contents of a vessel, and radius and thickness of its wall, in metres."""
    top, floor = float(mesh.bounds[1][2]), _bottom(mesh)
    level = floor + 0.8 * (top - floor)
    if floor > 0.6 * top:
        message = f"it holds nothing: over the middle of its underside it is closed at {100 * floor:.1f} cm"
        raise ModelFault(("holds",), message, "turn its opening up by `turn:`, or leave `holds` out")
    radius = min(_radius(mesh, floor + share * (level - floor)) for share in (0.1, 0.5, 1.0))
    if radius < 0.008:
        raise ModelFault(("holds",), "it holds nothing: the middle of its underside is not in a hollow", None)
    rim = top - 0.004
    outer = float(np.abs(_cut(mesh, rim)[:, :, 1]).max())
    return radius - 0.002, max(floor, 0.001), outer, outer - _radius(mesh, rim)


def _measured_grasps(model: UrdfModel, mesh: trimesh.Trimesh, scale: float) -> None:
    """Add grasps of what is narrow enough: from the sides and slanting, and from above; ``scale`` was applied."""
    top, least = model.high[2], TIP + 0.004
    for height in dict.fromkeys((max(0.5 * top, least), max(0.7 * top, least))):
        points = _cut(mesh, min(height, top - 0.002)).reshape(-1, 2)
        for approach in ((-1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)):
            along, aside = points @ approach[:2], points @ (-approach[1], approach[0])
            passed = np.abs(aside[along <= TIP])  # what the fingers go along, from both sides of the axis
            width = 2 * float(passed.max()) if len(passed) else math.inf
            if width > _NARROW or along.min() < -_PALM:
                continue
            across: Vector = (-approach[1], approach[0], 0.0)
            grasp(model, (0.0, 0.0, height), approach, across, width)
            for steep in (0.7, 0.45):
                level = math.sqrt(1 - steep * steep)
                grasp(model, (0.0, 0.0, height), (level * approach[0], level * approach[1], -steep), across, width)
    over = max(top - 0.012, TIP + 0.006)
    points = _cut(mesh, min(over, top - 0.002)).reshape(-1, 2)
    for axis, across in ((1, LEFT), (0, (1.0, 0.0, 0.0))):
        width = 2 * float(np.abs(points[:, axis]).max())
        if width <= _NARROW:
            grasp(model, (0.0, 0.0, over), DOWN, across, width)
    if not model.grasps:
        hint = f"{_unit(mesh, scale)}, or say under `grasps:` where it is narrow enough to be taken"
        raise ModelFault(
            ("mesh",), f"no hand fits round it: it is wider than {100 * _NARROW:.0f} cm on all sides", hint
        )


# ---------------------------------------------------------------------- what is said beside a file


def _said_grasps(model: UrdfModel, entries: Sequence[GraspEntry]) -> None:
    for index, entry in enumerate(entries):
        if entry.width > WIDEST - CLEARANCE / 2:
            message = f"no hand takes what is {100 * entry.width:.1f} cm wide"
            raise ModelFault(("grasps", index, "width"), message, f"{100 * WIDEST - 1:.1f} cm at most")
        tool = _frame(("grasps", index), entry.at, entry.approach, entry.across)
        model.grasps.append(Grasp(tool, min(entry.width + CLEARANCE, WIDEST)))


def _frame(path: Sequence[str | int], at: Vector, approach: Vector, across: Vector) -> Frame:
    """Return a tool frame of directions of any length; ``across`` is made square to ``approach``."""
    x, y = np.array(approach), np.array(across)
    for key, direction in (("approach", x), ("across", y)):
        if np.linalg.norm(direction) < 1e-6:
            raise ModelFault((*path, key), f"{key}: (0, 0, 0) is not a direction")
    x, y = x / np.linalg.norm(x), y / np.linalg.norm(y)
    if abs(float(x @ y)) > 0.2:
        raise ModelFault((*path, "across"), "the fingers cannot open along the way that the hand comes",
                         "give directions at a right angle")  # fmt: skip
    y -= float(x @ y) * x
    return Frame(at, _vector(x), _vector(y / np.linalg.norm(y)))


def _region(model: UrdfModel, index: int, entry: RegionEntry, link: str) -> None:
    for axis, (low, high) in enumerate(zip(entry.low, entry.high, strict=True)):
        if low >= high:
            raise ModelFault(
                ("regions", index, "high"), f"the region is empty along {'xyz'[axis]}", "low is below high"
            )
    spots: Sequence[tuple[float, float, float]] = [(x, y, math.radians(yaw)) for x, y, yaw in entry.spots]
    if not spots:
        depth, width = entry.high[0] - entry.low[0], entry.high[1] - entry.low[1]
        behind = [min(0.12, depth / 2) + 0.16 * row for row in range(1 + int(max(depth - 0.24, 0.0) / 0.16))]
        middle = (entry.low[1] + entry.high[1]) / 2
        spots = rows(entry.high[0], max(width - 0.12, 0.0), tuple(behind), 0.06, middle)
    entrance = np.array(entry.entry)
    if np.linalg.norm(entrance) < 1e-6:
        raise ModelFault(("regions", index, "entry"), "entry: (0, 0, 0) is not a direction")
    entrance = entrance / np.linalg.norm(entrance)
    model.region(entry.relation, entry.low, entry.high, _vector(entrance), spots, part=entry.part or ROOT, link=link,
                 heap=entry.heap)  # fmt: skip


# ---------------------------------------------------------------------- URDF


@dataclass(slots=True)
class _Source:
    """A URDF that is being read: its file, what is parsed, the names that its links have in the model."""

    path: Path
    root: ET.Element
    tree: Tree | None
    first: str
    # The link that each joint moves.
    moved: dict[str, str] = field(default_factory=dict)

    def link(self, name: str) -> str:
        """Return a link's name in the model."""
        return ROOT if name == self.first else name


class _FileModel(UrdfModel):
    """A model whose text is that of a file."""

    def __init__(self, name: str, mass: float) -> None:
        super().__init__(name, mass)
        self.element = ET.Element("robot")

    def text(self) -> str:
        """Return the URDF."""
        return '<?xml version="1.0"?>\n' + ET.tostring(self.element, encoding="unicode") + "\n"


def urdf_model(name: str, shape: Shape, path: Path, parts: Sequence[str], mass: float | None) -> UrdfModel:
    """Build a thing with links and joints from a URDF.

    ``parts`` are those of the class, ``mass`` that of the root link, if not that of the file.

    Raises:
        ModelFault: The file is not a URDF, a mesh of it is missing, or its entry does not fit.
        MissingToolError: A package that reads meshes is not installed.
    """
    source = _read(path)
    model = _FileModel(name, mass or 0.2)
    _find_meshes(source)
    _move_root(source, shape)
    _links(model, source, mass)
    for part, name_ in shape.parts.items():
        _check_part(("parts", part), part, parts)
        model.part_links[part] = _known_link(source, ("parts", part), name_)
        model.link_parts[model.part_links[part]] = part
    for index, handle in enumerate(shape.handles):
        _handle(model, source, index, handle, parts)
    for index, region in enumerate(shape.regions):
        _check_part(("regions", index, "part"), region.part, parts)
        link = region.link if region.link is not None else source.first
        _region(model, index, region, _known_link(source, ("regions", index, "link"), link))
    for index, lamp in enumerate(shape.lamps):
        _check_part(("lamps", index, "part"), lamp.part, parts)
        link = _known_link(source, ("lamps", index, "link"), lamp.link)
        model.lamp(lamp.part or ROOT, lamp.predicate, link, lamp.on, lamp.off)
    model.contents = [_known_link(source, ("contents", i), link) for i, link in enumerate(shape.contents)]
    _said_grasps(model, shape.grasps)
    if abs(model.low[2]) > 0.02:
        z = model.low[2]
        hint = f"say `origin: {{xyz: [0, 0, {-z:.3f}]}}`"
        raise ModelFault(("urdf",), f"{path}: its lowest point is at z = {z:.3f} m, and not on the floor", hint)
    if (largest := max(high - low for low, high in zip(model.low, model.high, strict=True))) > _LARGEST:
        hint = 'its lengths are metres; a mesh has `scale="0.001 0.001 0.001"` if its unit is the millimetre'
        raise ModelFault(("urdf",), f"{path} is {largest:.3g} m large", hint)
    model.element = _renamed(model, source)
    return model


def _read(path: Path) -> _Source:
    if not path.is_file():
        raise ModelFault(("urdf",), f"there is no file {path}", "its path is read from the folder of objects.yaml")
    try:
        root = read_urdf(path)
    except TmdError as error:
        raise ModelFault(("urdf",), error.message, error.hint) from error
    _refuse(ModelFault(("urdf",), f"{path}{end}", hint) for end, hint in faults_of(root))
    joints = root.findall("joint")
    for joint in joints:
        if joint.find("mimic") is not None:
            message = f"{path}: the joint '{joint.get('name')}' mimics another one"
            raise ModelFault(("urdf",), message, "the simulator does not let joints do that")
    tree = Tree(root) if joints else None
    first = tree.root if tree is not None else root.findall("link")[0].get("name", "")
    if first != "root" and any(link.get("name") == "root" for link in root.findall("link")):
        raise ModelFault(("urdf",), f"{path}: a link that is not the root is called 'root'", "call it something else")
    moved = {joint.get("name", ""): end_of(joint, "child") for joint in joints if joint.get("type") != "fixed"}
    return _Source(path, root, tree, first, moved)


def _find_meshes(source: _Source) -> None:
    """Name the meshes by absolute paths; files that the simulator cannot read are copied as OBJ."""
    meshes = [(each, find_mesh(source.path, each.get("filename", ""))) for each in source.root.iter("mesh")]
    lost = dict.fromkeys(each.get("filename", "") for each, found in meshes if found is None)
    told = ((f"its mesh {name or 'without a name'} is missing", mesh_advice(source.path, name)) for name in lost)
    _refuse(ModelFault(("urdf",), f"{source.path}: {message}", hint) for message, hint in told)
    for mesh, found in meshes:
        assert found is not None
        try:
            read = read_mesh(found)
        except ModelFault as fault:
            raise ModelFault(("urdf",), f"{source.path}: {fault.message}", fault.hint) from None
        if found.suffix.lower() not in _READ:
            folder = cache_directory("meshes")
            data = _obj(read)
            found = folder / f"{hashlib.sha256(data).hexdigest()[:20]}.obj"
            if not found.is_file():
                write_bytes(found, data)
        mesh.set("filename", str(found.resolve()))


def _move_root(source: _Source, shape: Shape) -> None:
    """Make the root's frame that of the thing, by moving everything that is given in it."""
    roll, pitch, yaw = map(math.radians, shape.origin.rpy)
    shift = Pose(shape.origin.xyz) * Pose.turned(roll, pitch, yaw)
    for link in source.root.findall("link"):
        if link.get("name") == source.first:
            for each in (*link.findall("visual"), *link.findall("collision"), *link.findall("inertial")):
                set_origin(each, shift.homogeneous() @ origin(each.find("origin")))
    for joint in source.root.findall("joint"):
        if end_of(joint, "parent") == source.first:
            set_origin(joint, shift.homogeneous() @ origin(joint.find("origin")))
    source.tree = Tree(source.root) if source.tree is not None else None


def _links(model: UrdfModel, source: _Source, mass: float | None) -> None:
    """Add links and joints with their boxes, and masses where the file has none."""
    frames = {source.first: np.eye(4)}
    if source.tree is not None:
        frames = source.tree.forward({}, source.tree.links, frames)
    elements = {link.get("name", ""): link for link in source.root.findall("link")}
    for name in frames:
        element, called = elements[name], source.link(name)
        if called != ROOT and source.tree is not None:
            joint = source.tree.links[name]
            kind = "revolute" if joint.kind == "continuous" else joint.kind
            model.links[called] = UrdfLink(
                called, source.link(joint.parent), kind, _vector(joint.origin[:3, 3]), _vector(joint.axis),
                joint.lower, joint.upper, 1.0 if kind == "revolute" else 5.0, 0.0, 0.1, angles(joint.origin),
            )  # fmt: skip
        try:
            points = [shape_points(each) for each in element.findall("collision")]
        except ValueError:
            message = f"{source.path}: a <collision> of '{name}' has no mesh, box, cylinder or sphere"
            raise ModelFault(("urdf",), message, "say one of these; a capsule is a cylinder and two spheres") from None
        if points:
            cloud = np.vstack(points)
            model.links[called].boxes += [(_vector(each.min(axis=0)), _vector(each.max(axis=0))) for each in points]
            everywhere = cloud @ frames[name][:3, :3].T + frames[name][:3, 3]
            for axis in range(3):
                model.low[axis] = min(model.low[axis], float(everywhere[:, axis].min()))
                model.high[axis] = max(model.high[axis], float(everywhere[:, axis].max()))
        _weigh(model, element, called, mass)
    if not math.isfinite(model.low[0]):
        raise ModelFault(("urdf",), f"{source.path} has no collision shapes", "add <collision> to its links")


def _weigh(model: UrdfModel, element: ET.Element, called: str, mass: float | None) -> None:
    """Add a mass and inertia where the file has none, or where the entry gives another mass."""
    inertial = element.find("inertial")
    given = None if inertial is None else inertial.find("mass")
    own = 0.0 if given is None else float(given.get("value", "0"))
    if own > 0 and not (mass and called == ROOT):
        model.links[called].mass = own
        return
    if inertial is not None:
        element.remove(inertial)
    if called == ROOT and mass:
        model.links[ROOT].mass = mass
    element.extend(ET.fromstring(f"<all>{''.join(model.physics(model.links[called]))}</all>"))


def _check_part(path: Sequence[str | int], part: str | None, parts: Sequence[str]) -> None:
    if part is not None and part not in parts:
        hint = nearest(part, list(parts)) or "the class lists its `parts:`"
        raise ModelFault(path, f"the class has no part '{part}'", hint)


def _known_link(source: _Source, path: Sequence[str | int], name: str) -> str:
    names = [link.get("name", "") for link in source.root.findall("link")]
    if name not in names:
        hint = nearest(name, names) or f"it has the links {', '.join(names)}"
        raise ModelFault(path, f"{source.path.name} has no link '{name}'", hint)
    return source.link(name)


def _handle(model: UrdfModel, source: _Source, index: int, entry: HandleEntry, parts: Sequence[str]) -> None:
    path = ("handles", index)
    _check_part((*path, "part"), entry.part, parts)
    if entry.joint not in source.moved:
        hint = nearest(entry.joint, list(source.moved)) or f"it has the joints {', '.join(source.moved) or 'none'}"
        raise ModelFault((*path, "joint"), f"{source.path.name} has no joint '{entry.joint}' that moves", hint)
    link = model.links[source.moved[entry.joint]]
    slides = link.kind == "prismatic"
    if slides != (entry.kind in _SLIDES):
        does = "slides" if slides else "turns"
        raise ModelFault((*path, "kind"), f"'{entry.joint}' {does}, and a {entry.kind} does not")
    if entry.kind == "knob" and not entry.settings:
        raise ModelFault(path, "a knob has settings", "say `settings: {off: 0.0, high: 1.5}`")
    opened = _opened(link, path, entry)
    force = entry.friction if entry.friction is not None else _FRICTION[entry.kind]
    if entry.kind == "button":
        link.spring = force
    else:
        link.friction = force
    part = entry.part or ROOT
    if part != ROOT:
        model.part_links.setdefault(part, link.name)
        model.link_parts[link.name] = part
    opening = 0.0 if entry.kind in ("flap", "button") else min(entry.width + 2 * CLEARANCE, WIDEST)
    tool = _frame(path, entry.at, entry.approach, entry.across)
    _check_near(link, source, path, entry)
    settings = tuple(entry.settings.items())
    model.grips.append(Grip(part, entry.kind, link.name, tool, opening, entry.closed, opened, settings))


def _opened(link: UrdfLink, path: tuple[str | int, ...], entry: HandleEntry) -> float:
    """Return the position of a joint at which it is open; it and all others that are given are within its limits."""
    opened = entry.open
    if opened is None:
        if not math.isfinite(link.upper):
            raise ModelFault(path, f"'{entry.joint}' has no limits", "say the position that is `open`")
        opened = link.upper if abs(link.upper - entry.closed) >= abs(link.lower - entry.closed) else link.lower
    settings = ((f"settings.{name}", value) for name, value in entry.settings.items())
    for key, value in (("closed", entry.closed), ("open", opened), *settings):
        if not link.lower - 1e-6 <= value <= link.upper + 1e-6:
            message = f"{key}: {value:g} is beyond the limits of '{entry.joint}', {link.lower:g} to {link.upper:g}"
            raise ModelFault((*path, *key.split(".")), message)
    return opened


def _check_near(link: UrdfLink, source: _Source, path: tuple[str | int, ...], entry: HandleEntry) -> None:
    """Check that a handle is at its link."""
    away = [
        np.maximum(np.maximum(low - np.array(entry.at), entry.at - np.array(high)), 0.0) for low, high in link.boxes
    ]
    beside = min((float(np.linalg.norm(each)) for each in away), default=math.inf)
    if beside > _BESIDE:
        message = f"the hand would be {100 * beside:.1f} cm beside '{link.name or source.first}'"
        hint = "`at` is the middle of the bar or the button, in the frame of the link that moves"
        raise ModelFault((*path, "at"), message if math.isfinite(beside) else f"'{link.name}' has no <collision>", hint)


def _renamed(model: UrdfModel, source: _Source) -> ET.Element:
    """Return the file with the names of the model, and with joints that stay where they are left."""
    whole = ET.Element("robot", name=model.name)
    whole.extend(source.root.findall("material"))
    for link in source.root.findall("link"):
        called = source.link(link.get("name", ""))
        link.set("name", called or "root")
        for box in [each for each in link.findall("visual/geometry") if each.find("box") is not None]:
            size = box[0].get("size", "")  # drawn as the scene's own boxes are: its own are shaded round
            box.remove(box[0])
            ET.SubElement(box, "mesh", filename=CUBE, scale=size)
        if link.find("contact") is None:
            link.insert(0, ET.fromstring('<contact><lateral_friction value="0.8"/></contact>'))
        whole.append(link)
    for material in whole.iter("material"):
        if material.find("color") is not None and material.find("specular") is None:
            ET.SubElement(material, "specular", rgb="0 0 0")
    for joint in source.root.findall("joint"):
        child = end_of(joint, "child")
        joint.set("name", child)
        joint.find("parent").set("link", source.link(end_of(joint, "parent")) or "root")  # type: ignore[union-attr]
        for old in joint.findall("dynamics"):
            joint.remove(old)
        ET.SubElement(joint, "dynamics", damping="0.0005", friction="0")
        whole.append(joint)
    return whole


def _vector(values: Sequence[float] | Array) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
