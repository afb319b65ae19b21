"""Dataclasses and named tuples as JSON values, and back, by their fields: a field that is new is not forgotten."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, Field, fields, is_dataclass
from enum import Enum
from functools import cache
from types import NoneType, UnionType
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints

_T = TypeVar("_T")


def plain(value: Any) -> Any:  # noqa: ANN401 - any value of JSON
    """What :func:`restored` makes the same value of; fields of a dataclass that have their default are left out."""
    if is_dataclass(value):
        pairs = ((field, getattr(value, field.name)) for field in fields(value))
        return {field.name: plain(part) for field, part in pairs if part != _default(field)}
    if isinstance(value, Mapping):
        return {key: plain(part) for key, part in value.items()}
    if isinstance(value, tuple):
        return [plain(part) for part in value]
    return value.value if isinstance(value, Enum) else value


def restored(kind: type[_T], data: Any) -> _T:  # noqa: ANN401 - any value of JSON
    """The value of type ``kind``.

    Raises:
        KeyError, TypeError, ValueError, AttributeError: It is none.
    """
    found: _T = _restored(kind, data)
    return found


def _restored(kind: Any, data: Any) -> Any:  # noqa: ANN401 - a type, and what JSON has for it
    if is_dataclass(kind) and isinstance(kind, type):
        hints = _hints(kind)
        return kind(**{name: _restored(hints[name], part) for name, part in data.items()})
    origin, parts = get_origin(kind), get_args(kind)
    if origin in (Union, UnionType):
        return None if data is None else _restored(next(part for part in parts if part is not NoneType), data)
    if origin is tuple:
        return tuple(_restored(parts[0], part) for part in data)
    if origin is Mapping:
        return {key: _restored(parts[1], part) for key, part in data.items()}
    if isinstance(kind, type) and issubclass(kind, tuple):
        return kind(*(_restored(hint, part) for hint, part in zip(_hints(kind).values(), data, strict=True)))
    return kind(data) if isinstance(kind, type) and issubclass(kind, Enum) else data


@cache
def _hints(kind: type) -> dict[str, Any]:
    return get_type_hints(kind)


def _default(field: Field[Any]) -> Any:  # noqa: ANN401 - of any type
    return field.default_factory() if field.default_factory is not MISSING else field.default
