"""YAML that remembers where everything stands: a fault is reported with file, line and column.

Only plain data is accepted: no tags, no aliases (an alias can blow a small file up), no key twice. ``on``,
``off``, ``yes`` and ``no`` are words, as in YAML 1.2, because they are words of our domains.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, ParamSpec, Protocol, TypeVar

import yaml
from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from tmd.diagnostics import Location, TmdError
from tmd.pddl.reading.syntax import Report, nearest, read_text

MAX_BYTES = 10_000_000
"""Larger files are refused: no environment or class file comes near."""

P = ParamSpec("P")
S = TypeVar("S")
T = TypeVar("T")
Model = TypeVar("Model", bound=BaseModel)


class _Mark(Protocol):
    """A place as both of PyYAML's parsers give it: counted from 0."""

    line: int
    column: int


if TYPE_CHECKING:
    from yaml import SafeLoader as _Base
else:  # libyaml's scanner where PyYAML was built with it: ten times as fast, the same places and words
    _Base = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class _Loader(_Base):
    """The safe loader with YAML 1.2's idea of a truth value."""


_Loader.yaml_implicit_resolvers = {
    first: [(tag, regexp) for tag, regexp in resolvers if tag != "tag:yaml.org,2002:bool"]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
_Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile(r"^(?:true|false)$"), list("tf"))


class YamlSource:
    """One YAML file: its text, its data and the place of every node.

    Args:
        path: The file.
        report: Takes the faults of what the file says; without it the first one is raised.

    Raises:
        TmdError: The file cannot be read, is not UTF-8, or is not YAML of the accepted kind.
    """

    def __init__(self, path: Path, report: Report | None = None) -> None:
        self.path = path
        self.report = report
        self.text = _read(path)
        self._lines = self.text.splitlines()
        try:
            self._refuse_aliases()
            self._root: yaml.Node | None = yaml.compose(self.text, Loader=_Loader)
        except yaml.MarkedYAMLError as error:
            raise self._from_yaml(error) from None
        except yaml.YAMLError as error:
            place = Location(str(path), 1, 1)
            raise TmdError(f"not YAML: {error}".replace("\n", " "), location=place, code="yaml-syntax") from None
        except RecursionError:
            hint = "a YAML file here needs four levels"
            raise TmdError(f"{path}: nested too deeply", hint=hint, code="nested-too-deeply") from None
        self._refuse_twins()

    def load(self, model: type[Model]) -> Model:
        """The file as ``model``.

        Raises:
            TmdError: With the place of the first key that does not fit.
        """
        if self._root is None:
            raise TmdError(f"{self.path}: the file is empty", code="empty-file")
        try:
            return model.model_validate(self._data())
        except yaml.MarkedYAMLError as error:
            raise self._from_yaml(error) from None
        except ValidationError as error:
            first, *others = self._from_model(error)
            for other in others if self.report is not None else ():
                self.fault(other)
            raise first from None

    def _data(self) -> object:
        """What the nodes stand for, without reading the text again."""
        loader = _Loader("")
        try:
            return loader.construct_document(self._root)
        finally:
            loader.dispose()

    def error(
        self, path: Sequence[str | int], message: str, hint: str | None = None, code: str = "bad-value"
    ) -> TmdError:
        """An error at the node that ``path`` (keys and indices from the root) leads to."""
        location = self.locate(path)
        return TmdError(message, location=location, hint=hint, source=self._line(location.line), code=code)

    def fault(self, error: TmdError) -> None:
        """Raise ``error``, or report it and return."""
        if self.report is None:
            raise error
        self.report(error)

    def recover(self, otherwise: S, read: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> S | T:
        """What ``read`` returns; where it fails and faults are reported, ``otherwise``."""
        if self.report is None:
            return read(*arguments, **named)
        try:
            return read(*arguments, **named)
        except TmdError as error:
            self.report(error)
            return otherwise

    def locate(self, path: Sequence[str | int]) -> Location:
        """Where the node that ``path`` leads to begins; the deepest node that exists where it breaks off."""
        node, mark = self._root, None
        for part in path:
            step = _child(node, part)
            if step is None:
                break
            node, mark = step
        if mark is None:
            mark = node.start_mark if node is not None else None
        return self._place(mark)

    def _from_model(self, error: ValidationError) -> list[TmdError]:
        """The faults; an unknown key goes before the key that is missed because of it."""
        faults = error.errors(include_url=False)
        unknown = [fault for fault in faults if fault["type"] == "extra_forbidden"]
        missed = {fault["loc"][:-1] for fault in unknown}
        known = [f for f in faults if f not in unknown and not (f["type"] == "missing" and f["loc"][:-1] in missed)]
        return [self._from_fault(fault, faults) for fault in (*unknown, *known)]

    def _from_fault(self, fault: ErrorDetails, faults: Sequence[ErrorDetails]) -> TmdError:
        path = tuple(part for part in fault["loc"] if isinstance(part, str | int))
        where = ".".join(map(str, path)) or "the file"
        if fault["type"] != "extra_forbidden":
            return self.error(path, f"{where}: {fault['msg']}")
        missing = [str(f["loc"][-1]) for f in faults if f["type"] == "missing" and f["loc"][:-1] == path[:-1]]
        hint = nearest(str(path[-1]), missing, what="missing")
        return self.error(path, f"unknown key '{where}'", hint, "unknown-key")

    def _line(self, number: int) -> str | None:
        return self._lines[number - 1] if 0 < number <= len(self._lines) else None

    def _from_yaml(self, error: yaml.MarkedYAMLError) -> TmdError:
        mark = error.problem_mark or error.context_mark
        problem = (error.problem or error.context or "not YAML").replace("\n", " ")
        place = self._place(mark)
        code = "yaml-tag" if "could not determine a constructor" in problem else "yaml-syntax"
        return TmdError(f"not YAML: {problem}", location=place, source=self._line(place.line), code=code)

    def _refuse_aliases(self) -> None:
        for event in yaml.parse(self.text, Loader=_Loader):
            if isinstance(event, yaml.AliasEvent):
                place = self._place(event.start_mark)
                source = self._line(place.line)
                hint = "write the value out"
                raise TmdError("aliases are not accepted", location=place, hint=hint, source=source, code="yaml-alias")

    def _refuse_twins(self) -> None:
        waiting: list[yaml.Node] = [self._root] if self._root is not None else []
        while waiting:
            node = waiting.pop()
            if isinstance(node, yaml.SequenceNode):
                waiting.extend(node.value)
            if isinstance(node, yaml.MappingNode):
                seen: set[str] = set()
                for key, value in node.value:
                    if key.value in seen:
                        place = self._place(key.start_mark)
                        message = f"the key '{key.value}' stands here twice"
                        source, hint = self._line(place.line), "remove one of the two"
                        raise TmdError(message, location=place, hint=hint, source=source, code="duplicate-key")
                    seen.add(key.value)
                    waiting.append(value)

    def _place(self, mark: _Mark | None) -> Location:
        line, column = (mark.line + 1, mark.column + 1) if mark is not None else (1, 1)
        return Location(str(self.path), line, column)


def _child(node: yaml.Node | None, part: str | int) -> tuple[yaml.Node, yaml.Mark] | None:
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            if key.value == str(part):
                return value, key.start_mark
    if isinstance(node, yaml.SequenceNode) and isinstance(part, int) and part < len(node.value):
        return node.value[part], node.value[part].start_mark
    return None


def _read(path: Path) -> str:
    if path.is_file() and path.stat().st_size > MAX_BYTES:
        message = f"{path}: larger than {MAX_BYTES // 1_000_000} MB"
        raise TmdError(message, hint="this is not a file of tmd", code="too-large")
    return read_text(path)
