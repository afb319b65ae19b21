"""A library as JSON, and back.

Profiles repeat: most objects of a class are in the same states. Each distinct one is written once, and named by its
place in a list.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from tmd.inference.learned.dataclass_json import plain, restored
from tmd.language.clause import Clause
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.model import Instruction
from tmd.veil.library import Library
from tmd.veil.profiles import Profile
from tmd.veil.template import Template


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
