"""URDF files: reading one, finding the meshes that it names, and where copies with changes are kept."""

from __future__ import annotations

import logging
import math
import os
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Iterator
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
# The attributes that are numbers, by the elements that have them, and how many each has.
_NUMBERS = {
    "origin": {"xyz": 3, "rpy": 3},
    "axis": {"xyz": 3},
    "limit": {"lower": 1, "upper": 1},
    "mass": {"value": 1},
    "inertia": dict.fromkeys(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), 1),
    "box": {"size": 3},
    "cylinder": {"radius": 1, "length": 1},
    "sphere": {"radius": 1},
    "mesh": {"scale": 3},
}
# Those of them that are lengths.
_LENGTHS = ("size", "radius", "length")


def cube() -> str:
    """Return the text of :data:`CUBE`."""
    return (Path(__file__).parent / "data" / CUBE).read_text(encoding="ascii")


def read_urdf(path: Path) -> ET.Element:
    """Parse the ``<robot>`` of a URDF or SRDF.

    Raises:
        TmdError: The file cannot be read, or is not a URDF.
    """
    try:
        data = read_bytes(path)
        root = ET.fromstring(data)
    except OSError as error:
        raise TmdError(f"{path} cannot be read: {error.strerror or error}", hint="name a URDF file") from error
    except (ET.ParseError, LookupError, ValueError) as error:  # an encoding may be unknown
        if b"<xacro:" in data:
            raise _to_expand(path) from error
        raise TmdError(f"{path} is not valid XML: {error}", hint="name a URDF file") from error
    if any(map(_is_macro, root.iter())):
        raise _to_expand(path)
    if root.tag != "robot":
        raise TmdError(f"{path} is not a URDF: its root is <{root.tag}>, not <robot>", hint="name a URDF file")
    wrong = list(dict.fromkeys(fault for each in root if each.tag in ("link", "joint") for fault in _wrong(each)))
    if wrong:
        more = f"; {len(wrong) - 1} more of this kind" if len(wrong) > 1 else ""
        hint = "write numbers with blanks between them: metres, radians, kilograms, no formulas"
        raise TmdError(f"{path}: {wrong[0]}{more}", hint=hint)
    return root


def _to_expand(path: Path) -> TmdError:
    target = f"{path.name.partition('.')[0]}_expanded.urdf"
    return TmdError(f"{path} is a xacro, not a URDF", hint=f"expand it: xacro {path.name} > {target}")


def _is_macro(element: ET.Element) -> bool:
    """Return whether xacro is still to compute an element, or an attribute of it."""
    return "xacro" in element.tag or any("${" in value or "$(" in value for value in element.attrib.values())


def _wrong(owner: ET.Element) -> Iterator[str]:
    """Yield what is wrong with the numbers of a link or joint."""
    for element in owner.iter():
        for name, count in _NUMBERS.get(element.tag, {}).items():
            text = element.get(name, "" if name in _LENGTHS else None)
            if text is None:
                continue
            said = f"the {owner.tag} '{owner.get('name')}': {name}=\"{text}\" of <{element.tag}>"
            values = [_number(word) for word in text.split()]
            if len(values) != count or not all(map(math.isfinite, values)):
                yield f"{said} is not {f'{count} numbers' if count > 1 else 'a number'}"
            elif (name in _LENGTHS and min(values) <= 0) or (element.tag == "mass" and values[0] < 0):
                yield f"{said} is too small"


def _number(word: str) -> float:
    """Return the number that a word is, or NaN."""
    try:
        return float(word)
    except ValueError:
        return math.nan


def find_mesh(source: Path, name: str) -> Path | None:
    """Return a mesh file named in a URDF: beside it, or in any folder above it for names of packages and models."""
    name = name.replace("\\", "/")
    path = Path(name.removeprefix("file://"))
    candidates = iter([path if path.is_absolute() else source.resolve().parent / path])
    if name.startswith(("package://", "model://")):
        whole = Path(name.partition("://")[2])
        shorter = Path(*whole.parts[1:])
        candidates = (folder / each for folder in source.resolve().parents for each in (whole, shorter))
    with suppress(OSError):  # a name may be too long
        return next((candidate for candidate in candidates if candidate.is_file()), None)
    return None


def mesh_advice(path: Path, name: str) -> str:
    """Return where a mesh of a URDF is looked for, as advice."""
    if "://" in name:
        return f"put the folder '{name.partition('://')[2].partition('/')[0]}' beside the URDF or beside a folder above"
    beside = (path.parent / name).parent
    alike = [
        each for each in (beside.iterdir() if beside.is_dir() else ()) if each.name.lower() == Path(name).name.lower()
    ]
    return f"there is {alike[0].name}: say that" if alike else "put the meshes where the URDF names them"


def mesh_library() -> ModuleType:
    """Import trimesh.

    Raises:
        MissingToolError: It is not installed.
    """
    try:
        import trimesh
    except ImportError as error:
        raise MissingToolError("reading meshes needs the package trimesh", hint=install_extra("meshes")) from error
    logging.getLogger("trimesh").setLevel(logging.CRITICAL)  # it prints what it raises as well
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
