"""YAML files as pydantic models: a fault is reported with file, line and column.

:mod:`tmd.yaml_nodes` says what is accepted as YAML.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeVar

import yaml
from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from tmd.diagnostics import Location, TmdError
from tmd.json_record import expectation
from tmd.pddl.reading.syntax import Report, Reporting, nearest, read_text
from tmd.yaml_nodes import Loader, compose, from_yaml

Model = TypeVar("Model", bound=BaseModel)


class YamlSource(Reporting):
    """One YAML file: its text, its data and the place of every node.

    ``report`` takes the faults of what the file says; without it the first one is raised.

    ``left_out`` are the keys whose values :meth:`load` left out.

    Raises:
        TmdError: The file cannot be read, is not UTF-8, or is not YAML of the accepted kind.
    """

    def __init__(self, path: Path, report: Report | None = None) -> None:
        self.path = path
        self.report = report
        self.left_out: set[str | int] = set()
        self.text = read_text(path)
        self._lines = self.text.splitlines()
        self._root = compose(self.text, str(path))

    def load(self, model: type[Model], optional: Sequence[str] = ()) -> Model:
        """Return the file as ``model``.

        Where faults are reported, the values of ``optional`` keys that do not fit, and unknown keys, are left out.

        Raises:
            TmdError: With the place of the first key that does not fit.
        """
        if self._root is None:
            raise TmdError(
                f"{self.path}: the file is empty", code="empty-file", hint="see docs/domains.md for what belongs in it"
            )
        loader = Loader("")  # constructs the values of the nodes, without reading the text again
        data: Any = None
        try:
            data = loader.construct_document(self._root)
            return model.model_validate(data)
        except yaml.YAMLError as error:
            raise from_yaml(error, self.text, str(self.path)) from None
        except ValidationError as error:
            first, *others = self._from_model(error)
            for other in others if self.report is not None else ():
                self.fault(other)
            if self.report is not None and self._leave_out(data, error, optional):
                self.fault(first)
                return model.model_validate(data)
            raise first from None
        finally:
            loader.dispose()

    def _leave_out(self, data: Any, error: ValidationError, optional: Sequence[str]) -> bool:  # noqa: ANN401
        """Leave out unknown keys, and values of ``optional`` keys with faults; return whether that is all."""
        for fault in error.errors(include_url=False):
            path = fault["loc"]
            unknown = len(path) - 1 if optional and fault["type"] == "extra_forbidden" else None
            last = next((index for index, part in enumerate(path) if part in optional), unknown)
            if last is None:
                return False
            owner = data
            for part in path[:last]:
                owner = owner.get(part, {})
            owner.pop(path[last], None)
            self.left_out.add(path[last])
        return True

    def error(
        self, path: Sequence[str | int], message: str, hint: str | None = None, code: str = "bad-value"
    ) -> TmdError:
        """Return an error at the node that ``path`` (keys and indices from the root) leads to."""
        location = self.locate(path)
        source = self._lines[location.line - 1] if location.line <= len(self._lines) else None
        return TmdError(message, location=location, hint=hint, source=source, code=code)

    def locate(self, path: Sequence[str | int]) -> Location:
        """Return the place of the node that ``path`` leads to, or of the deepest node that exists."""
        node, mark = self._root, None
        for part in path:
            step = _child(node, part)
            if step is None:
                break
            node, mark = step
        if mark is None and node is not None:
            mark = node.start_mark
        line, column = (mark.line + 1, mark.column + 1) if mark is not None else (1, 1)
        return Location(str(self.path), line, column)

    def _from_model(self, error: ValidationError) -> list[TmdError]:
        """Return the faults; an unknown key goes before the key that is missed because of it."""
        faults = error.errors(include_url=False)
        unknown = [fault for fault in faults if fault["type"] == "extra_forbidden"]
        missed = {fault["loc"][:-1] for fault in unknown}
        known = [f for f in faults if f not in unknown and not (f["type"] == "missing" and f["loc"][:-1] in missed)]
        return [self._from_fault(fault, faults) for fault in (*unknown, *known)]

    def _from_fault(self, fault: ErrorDetails, faults: Sequence[ErrorDetails]) -> TmdError:
        path = tuple(part for part in fault["loc"] if isinstance(part, str | int))
        where = ".".join(map(str, path)) or "the file"
        if fault["type"] != "extra_forbidden":
            said = expectation(fault, "a mapping")
            if fault["type"] == "string_pattern_mismatch":
                said = "should be a colour" if "#" in fault["ctx"]["pattern"] else "should be a name"
            if fault["type"] == "missing" and isinstance(path[-1], int):
                return self.error(path, f"{where}: the value is missing", "write as many values as belong there")
            return self.error(path, f"{where}: {said}", _HINTS.get(fault["type"]))
        missing = [str(f["loc"][-1]) for f in faults if f["type"] == "missing" and f["loc"][:-1] == path[:-1]]
        hint = nearest(str(path[-1]), missing, what="missing")
        return self.error(path, f"unknown key '{where}'", hint, "unknown-key")


_MAPPING = "write `key: value`, a line each, further in than the line above"
_HINTS = {
    "missing": "see docs/domains.md for what belongs there",
    **dict.fromkeys(("float_type", "float_parsing"), "write one number, such as 0.5"),
    **dict.fromkeys(("bool_type", "bool_parsing"), "write true or false"),
    "invalid_key": "a key is a word; a number has a point, not a comma",
    "string_type": "put it into quotes",
    "list_type": "write [a, b], or a line with `- ` for each",
    "tuple_type": "write [a, b], or a line with `- ` for each",
    "dict_type": _MAPPING,
    "model_type": _MAPPING,
    "model_attributes_type": _MAPPING,
    "mapping_type": _MAPPING,
    "string_pattern_mismatch": "a name has small letters, digits and _, a letter first; a colour is like '#a0c4ff'",
}


def _child(node: yaml.Node | None, part: str | int) -> tuple[yaml.Node, yaml.Mark] | None:
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            if key.value == str(part):
                return value, key.start_mark
    if isinstance(node, yaml.SequenceNode) and isinstance(part, int) and part < len(node.value):
        return node.value[part], node.value[part].start_mark
    return None
