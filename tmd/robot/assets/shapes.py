"""The kinds of shapes, and from the classes of a domain to blueprints of objects.

A class says ``shape: {kind: …}`` in ``objects.yaml``, or names a file (:mod:`tmd.robot.assets.model_files`); what it
leaves open is the kind's own. The parts of a class say
their kinds too, and the whole's kind has places for them. A class that says nothing is a plain cabinet or a small
box, by its PDDL type.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from tmd.diagnostics import TmdError
from tmd.files import real
from tmd.pddl.reading.syntax import nearest
from tmd.robot.assets.appearance import Appearance, Parts, ShapeKind
from tmd.robot.assets.features import PALETTE
from tmd.robot.assets.kinds import KINDS
from tmd.robot.assets.urdf_builder import ROOT as URDF_ROOT
from tmd.robot.assets.urdf_builder import UrdfModel
from tmd.world.classes import ROOT, Classes
from tmd.world.folder import DomainFolder
from tmd.world.shape import Shape

_PLAIN = {"item": "block", "part": "plain_part", "fixture": "counter"}
# Limits of a size, as shares of the kind's own.
LEAST, MOST = 0.5, 2.5


@dataclass(frozen=True, slots=True)
class Blueprint:
    """The model of the objects of a class; ``sort`` is ``fixture`` or ``item``, ``urdf`` the model as text."""

    class_name: str
    sort: str
    look: Appearance
    model: UrdfModel
    urdf: str


class Shapes:
    """The blueprints of a domain's classes.

    Raises:
        TmdError: (From the methods.) A shape makes no sense; with its place in ``objects.yaml``.
    """

    def __init__(self, folder: DomainFolder) -> None:
        self.folder = folder
        self.classes: Classes = folder.classes
        self._known: dict[str, Blueprint] = {}

    def blueprint(self, class_name: str) -> Blueprint:
        """Return the blueprint of a class."""
        if class_name not in self._known:
            self._known[class_name] = self._blueprint(class_name)
        return self._known[class_name]

    def _blueprint(self, class_name: str) -> Blueprint:
        vertices = self.classes.get(class_name).vertices
        sort = self.sort(class_name)
        for name, vertex in vertices.items():
            if vertex.shape is not None and vertex.shape.file is not None:
                if name == ROOT and sort != "part":
                    return self._of_file(class_name, sort, vertex.shape)
                called = class_name if name == ROOT else name
                message = (
                    f"'{called}' is a part, and the shape of a part is not a file: it is a link of its whole's URDF"
                )
                part = None if name == ROOT else name
                key = "mesh" if vertex.shape.mesh else "urdf"
                raise self._error(vertex.class_name, class_name, part, (key,), message, "say `urdf:` for the whole")
        look = self._look(class_name, vertices[ROOT].shape, sort, class_name, None)
        parts = Parts({})
        for name, vertex in vertices.items():
            if name != ROOT:
                part_look = self._look(vertex.class_name, vertex.shape, "part", class_name, name)
                # a door without a colour has that of the object it closes
                plain = vertex.shape is None or vertex.shape.colour is None
                if plain and part_look.kind in ("door", "latched_door", "lid"):
                    part_look = replace(part_look, colour=look.colour)
                parts.looks[name] = part_look
        kind = KINDS[look.kind]
        if vertices[ROOT].shape is not None:
            self._check_parts(class_name, kind, look, parts)
        if kind.build is None:
            raise AssertionError(f"{look.kind} is not a whole object")
        model = UrdfModel(class_name, look.mass)
        kind.build(model, look, parts)
        return Blueprint(class_name, sort, look, model, model.text())

    def _of_file(self, class_name: str, sort: str, shape: Shape) -> Blueprint:
        """Build an object whose shape is a mesh or a URDF beside ``objects.yaml``."""
        from tmd.robot.assets.model_files import ModelFault, mesh_model, urdf_model

        key = "mesh" if shape.mesh else "urdf"
        usual = KINDS[_PLAIN[sort]].default
        self._check_colours(class_name, class_name, None, shape)
        parts = [name for name in self.classes.get(class_name).vertices if name != ROOT]
        folder = self.classes.source.path.parent
        file = folder / (shape.file or "")
        try:
            if not real(file).is_relative_to(real(folder)):
                raise ModelFault((key,), f"{shape.file} is not in the folder of the domain", "put the file there")
            model = (
                mesh_model(class_name, shape, file, shape.colour or usual.colour, shape.mass or usual.mass)
                if shape.mesh
                else urdf_model(class_name, shape, file, parts, shape.mass)
            )
        except ModelFault as fault:
            for other in fault.others:
                error = self._error(class_name, class_name, None, other.path, other.message, other.hint)
                self.classes.source.fault(error)
            raise self._error(class_name, class_name, None, fault.path, fault.message, fault.hint) from None
        if sort == "item" and not model.grasps:
            hint = "say under `grasps:` where a hand takes it"
            raise self._error(class_name, class_name, None, (key,), "no hand can take it", hint)
        sides = [2 * max(abs(model.low[axis]), abs(model.high[axis])) for axis in (0, 1)]
        size = shape.size or (sides[0], sides[1], model.high[2])
        look = Appearance(key, size, shape.colour or usual.colour, usual.accent, model.links[URDF_ROOT].mass)
        return Blueprint(class_name, sort, look, model, model.text())

    def sort(self, class_name: str) -> str:
        """Return ``item``, ``part`` or ``fixture``, by the types above the class."""
        return next((sort for sort in ("item", "part") if self.classes.is_below(class_name, sort)), "fixture")

    def _look(self, class_name: str, shape: Shape | None, sort: str, whole: str, part: str | None) -> Appearance:
        if shape is None:
            return KINDS[_PLAIN[sort]].default
        assert shape.kind is not None, "files are built otherwise"
        kind = KINDS.get(shape.kind)
        if kind is None:
            known = sorted(name for name, each in KINDS.items() if each.sort == sort)
            hint = nearest(shape.kind, known) or f"a {sort} can be: {', '.join(known)}"
            raise self._error(class_name, whole, part, ("kind",), f"there is no shape '{shape.kind}'", hint)
        if kind.sort != sort:
            article = {"item": "an item"}
            own, wanted = (article.get(word, f"a {word}") for word in (kind.sort, sort))
            message = f"'{shape.kind}' is the shape of {own}, but {part or class_name} is {wanted}"
            raise self._error(class_name, whole, part, ("kind",), message, None)
        self._check_colours(class_name, whole, part, shape)
        usual = kind.default
        if shape.size is not None:
            for word, given, normal in zip(("depth", "width", "height"), shape.size, usual.size, strict=True):
                if not LEAST * normal <= given <= MOST * normal:
                    message = f"a {shape.kind} cannot have a {word} of {given:g} m"
                    hint = f"between {LEAST * normal:.3g} and {MOST * normal:.3g} m, {normal:g} m is usual"
                    raise self._error(class_name, whole, part, ("size",), message, hint)
        return Appearance(
            shape.kind, shape.size or usual.size, shape.colour or usual.colour, shape.accent or usual.accent,
            shape.mass or usual.mass, shape.settings or usual.settings,
        )  # fmt: skip

    def _check_colours(self, class_name: str, whole: str, part: str | None, shape: Shape) -> None:
        said: dict[tuple[str | int, ...], str | None] = {("colour",): shape.colour, ("accent",): shape.accent}
        for index, lamp in enumerate(shape.lamps):
            said |= {("lamps", index, "on"): lamp.on, ("lamps", index, "off"): lamp.off}
        for key, colour in said.items():
            if colour is not None and not colour.startswith("#") and colour not in PALETTE:
                hint = nearest(colour, sorted(PALETTE)) or "write a colour of docs/scenes.md or '#rrggbb'"
                raise self._error(class_name, whole, part, key, f"there is no colour '{colour}'", hint)

    def _check_parts(self, class_name: str, kind: ShapeKind, look: Appearance, parts: Parts) -> None:
        left = dict(kind.takes)
        for name, part in parts.looks.items():
            if part.kind == "plain_part":
                continue
            if left.get(part.kind, 0) <= 0:
                most = dict(kind.takes).get(part.kind, 0)
                room = f"has room for {most} only" if most else "has no place for it"
                message = f"the part '{name}' is a {part.kind}, and a {look.kind} {room}"
                takes = ", ".join(f"{count} {each}" for each, count in kind.takes) or "no parts"
                raise self._error(class_name, class_name, None, ("kind",), message, f"a {look.kind} takes {takes}")
            left[part.kind] -= 1

    def _error(
        self, owner: str, whole: str, part: str | None, key: Sequence[str | int], message: str, hint: str | None
    ) -> TmdError:
        """Return an error at the shape's entry: at the part, the class, or the ancestor that it comes from."""
        entries = self.classes.entries.classes
        if part is not None:
            for name in self.classes.line(whole):
                entry = entries.get(name)
                if entry is not None and part in entry.parts and entry.parts[part].shape is not None:
                    return self.classes.source.error(("classes", name, "parts", part, "shape", *key), message, hint)
        for name in self.classes.line(owner):
            entry = entries.get(name)
            if entry is not None and entry.shape is not None:
                return self.classes.source.error(("classes", name, "shape", *key), message, hint)
        return self.classes.source.error(("classes", owner), message, hint)
