"""What was learned as JSON and arrays, and back: dataclasses by their fields, libraries, policies."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, Field, fields, is_dataclass
from enum import Enum
from functools import cache
from types import NoneType, UnionType
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np

from tmd.inference.policy.features import Features, Syntax
from tmd.inference.policy.policy import Reward
from tmd.language.clause import Clause
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.model import Instruction
from tmd.veil.library import Library
from tmd.veil.profiles import Profile
from tmd.veil.template import Template

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


def library_to_json(library: Library) -> dict[str, Any]:
    """What :func:`library_from_json` makes the same library of."""
    profiles = _Profiles()
    templates = [_template(t, profiles) for verb in library.verbs() for t in library.templates(verb)]
    return {"unaligned": [list(pair) for pair in library.unaligned], "templates": templates, "profiles": profiles.all}


def library_from_json(data: Mapping[str, Any], lexicon: Lexicon) -> Library:
    """The library.

    Raises:
        KeyError, TypeError, ValueError, IndexError: It is none.
    """
    profiles = [_profile(lines) for lines in data["profiles"]]
    library = Library(lexicon, [(source, text) for source, text in data["unaligned"]])
    for entry in data["templates"]:
        library.add(_read_template(entry, profiles))
    return library


class _Profiles:
    """The distinct profiles, numbered as they come."""

    def __init__(self) -> None:
        self.all: list[list[Any]] = []
        self._numbers: dict[tuple[Any, ...], int] = {}

    def number(self, profile: Profile) -> int:
        key = tuple(profile.items())
        if key not in self._numbers:
            self._numbers[key] = len(self.all)
            self.all.append([[*name, value] for name, value in profile.items()])
        return self._numbers[key]


def _profile(lines: Sequence[Sequence[Any]]) -> Profile:
    return {tuple(line[:-1]): line[-1] for line in lines}


def _template(template: Template, profiles: _Profiles) -> dict[str, Any]:
    return {
        "source": template.source,
        "clause": plain(template.clause),
        "environment": template.environment,
        "instructions": [[i.name, *i.args] for i in template.instructions],
        "variables": {
            z: [name, template.classes[z], profiles.number(template.profiles[z]), profiles.number(template.ends[z])]
            for z, name in template.grounding.items()
        },
        "wanted": {z: [list(types) for types in wanted] for z, wanted in template.wanted.items()},
        "links": [[a, b, *sorted(names)] for (a, b), names in template.links.items()],
        "mentions": dict(template.mentions),
        "subjects": [[kind, profiles.number(profile)] for kind, profile in template.subjects],
    }


def _read_template(data: Mapping[str, Any], profiles: Sequence[Profile]) -> Template:
    variables = data["variables"]
    return Template(
        source=data["source"],
        clause=restored(Clause, data["clause"]),
        environment=data["environment"],
        instructions=tuple(Instruction(name, tuple(args)) for name, *args in data["instructions"]),
        grounding={z: entry[0] for z, entry in variables.items()},
        classes={z: entry[1] for z, entry in variables.items()},
        wanted={z: tuple(tuple(types) for types in wanted) for z, wanted in data["wanted"].items()},
        profiles={z: profiles[entry[2]] for z, entry in variables.items()},
        links={(a, b): frozenset(names) for a, b, *names in data["links"]},
        mentions=dict(data["mentions"]),
        ends={z: profiles[entry[3]] for z, entry in variables.items()},
        subjects=tuple((kind, profiles[number]) for kind, number in data["subjects"]),
    )


def reward_to_json(reward: Reward) -> dict[str, Any]:
    """All but the weights."""
    features = reward.features
    return {
        "words": list(features.words),
        "properties": [list(name) for name in features.properties],
        "shapes": [[name, list(kinds)] for name, kinds in features.syntax.shapes],
        "needs": [[name, place, list(earlier)] for (name, place), earlier in features.syntax.needs.items()],
        "longest": features.syntax.longest,
        "before": reward.before,
        "after": reward.after,
    }


def reward_from_json(data: Mapping[str, Any], weights: bytes) -> Reward:
    """The same again.

    Raises:
        KeyError, TypeError, ValueError: It is none.
    """
    syntax = Syntax(
        tuple((name, tuple(kinds)) for name, kinds in data["shapes"]),
        {(name, place): tuple(earlier) for name, place, earlier in data["needs"]},
        data["longest"],
    )
    features = Features(data["words"], (tuple(name) for name in data["properties"]), syntax)
    theta = np.load(io.BytesIO(weights), allow_pickle=False)
    if theta.shape != (features.size,) or theta.dtype != np.float64:
        raise ValueError("the weights are of another policy")
    return Reward(features, theta, float(data["before"]), float(data["after"]))


def weights_bytes(reward: Reward) -> bytes:
    """The weights as a ``.npy`` file."""
    buffer = io.BytesIO()
    np.save(buffer, reward.theta, allow_pickle=False)
    return buffer.getvalue()
