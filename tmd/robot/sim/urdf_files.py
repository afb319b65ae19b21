"""URDF files: reading one, finding the meshes that it names, and where copies with changes are kept."""

from __future__ import annotations

import os
import tempfile
import xml.etree.ElementTree as ET
from contextlib import suppress
from functools import cache
from pathlib import Path
from types import ModuleType

from tmd import files
from tmd.diagnostics import MissingToolError, OutputError, TmdError, install_extra
from tmd.files import make_directory, read_bytes

# The mesh that boxes are drawn by, beside this module: a unit cube with a normal for every face. Boxes drawn as boxes
# are shaded round.
CUBE = "cube.obj"


def cube() -> str:
    """Return the text of :data:`CUBE`."""
    return (Path(__file__).parent / "data" / CUBE).read_text(encoding="ascii")


def read_urdf(path: Path) -> ET.Element:
    """Parse the ``<robot>`` of a URDF or SRDF.

    Raises:
        TmdError: The file cannot be read, or is not a URDF.
    """
    try:
        root = ET.fromstring(read_bytes(path))
    except OSError as error:
        raise TmdError(f"{path} cannot be read: {error.strerror or error}", hint="name a URDF file") from error
    except ET.ParseError as error:
        raise TmdError(f"{path} is not valid XML: {error}", hint="name a URDF file") from error
    if any("xacro" in each.tag for each in root.iter()):
        target = f"{path.name.partition('.')[0]}_expanded.urdf"
        raise TmdError(f"{path} is a xacro, not a URDF", hint=f"expand it: xacro {path.name} > {target}")
    if root.tag != "robot":
        raise TmdError(f"{path} is not a URDF: its root is <{root.tag}>, not <robot>", hint="name a URDF file")
    return root


def find_mesh(source: Path, name: str) -> Path | None:
    """Return a mesh file named in a URDF: beside it, or in any folder above it for ``package://`` names."""
    path = Path(name.removeprefix("file://"))
    if not name.startswith("package://"):
        found = path if path.is_absolute() else source.resolve().parent / path
        return found if found.is_file() else None
    whole = Path(name.removeprefix("package://"))
    shorter = Path(*whole.parts[1:])
    candidates = (folder / each for folder in source.resolve().parents for each in (whole, shorter))
    return next((candidate for candidate in candidates if candidate.is_file()), None)


def mesh_library() -> ModuleType:
    """Import trimesh.

    Raises:
        MissingToolError: It is not installed.
    """
    try:
        import trimesh
    except ImportError as error:
        raise MissingToolError("reading meshes needs the package trimesh", hint=install_extra("meshes")) from error
    return trimesh


def end_of(joint: ET.Element, end: str) -> str:
    """Return the link at an end, ``parent`` or ``child``, of a joint."""
    found = joint.find(end)
    return "" if found is None else found.get("link", "")


@cache
def cache_directory(name: str) -> Path:
    """Return a directory of the user's cache, or a temporary one where that cannot be written."""
    folder = files.cache_directory(name)
    with suppress(OutputError):
        if folder is not None and os.access(make_directory(folder), os.W_OK):
            return folder
    return Path(tempfile.mkdtemp(prefix=f"tmd-{name}-"))
