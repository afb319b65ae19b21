"""The file of a predefined library, ``templates.yaml``: what it holds, and reading it.

What it means, and how it is used, is in :mod:`tmd.evaluation.models.predefined_templates`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict

from tmd.diagnostics import TmdError
from tmd.pddl.model import Domain, Instruction, TypedName, Universe, hierarchy
from tmd.pddl.reading.syntax import nearest
from tmd.world.folder import DomainFolder
from tmd.world.yaml_positions import YamlSource

FILE = "templates.yaml"
"""The library's name in a domain's folder."""


def _listed(value: object) -> object:
    return [value] if isinstance(value, str) else value


def _split(value: object) -> object:
    return [step.strip() for step in value.split(",")] if isinstance(value, str) else value


_Steps = Annotated[tuple[str, ...], BeforeValidator(_split)]
"""Actions or facts, with commas between: YAML's own lists give the question mark another meaning."""
_Words = Annotated[tuple[str, ...], BeforeValidator(_listed)]
"""A list of words, or one word."""
_Path = tuple[str | int, ...]
"""Keys and indices from the root of the file."""


class TemplateKind(BaseModel):
    """The objects that a variable may be.

    Attributes:
        called: Names, with or without their numbers, any of which will do; empty for all. VEIL-500 needs them: its
            classes are not types.
        words: Nouns for such objects, beside those that the environment and the lexicon know; they go before what
            is merely similar, or what something may contain.
    """

    model_config = ConfigDict(defer_build=True, extra="forbid", frozen=True)

    types: _Words
    called: _Words = ()
    words: _Words = ()

    def has(self, name: str, objects: Universe) -> bool:
        """Return whether the object ``name`` is of this kind."""
        names = {name, re.sub(r"[_\d]+\Z", "", name)}
        return objects.is_a(name, self.types) and (not self.called or not names.isdisjoint(self.called))


@dataclass(frozen=True, slots=True)
class PredefinedTemplate:
    """One entry of a library, as the module's docstring describes it.

    Attributes:
        relations: The ways in which the first of them may be related to the second; empty if it does not matter.
        says: Words of which the clause has one; empty if it does not matter.
        each: Whether it is used for all nouns that fit.
        variables: The kind of each variable, in the order in which those that no noun names are chosen.
    """

    source: str
    verbs: tuple[str, ...]
    objects: tuple[str, ...]
    relations: tuple[str, ...]
    says: tuple[str, ...]
    each: bool
    variables: Mapping[str, TemplateKind]
    where: tuple[Instruction, ...]
    instructions: tuple[Instruction, ...]

    @property
    def weight(self) -> tuple[int, bool]:
        """The part of a clause that it covers: words, then whether their relation matters."""
        return len(self.objects) + bool(self.says), bool(self.relations)


@dataclass(frozen=True, slots=True)
class PredefinedLibrary:
    """The content of a file: the templates in order, and its kinds, whose words hold for every template."""

    templates: tuple[PredefinedTemplate, ...]
    kinds: tuple[TemplateKind, ...] = ()


def load_templates(folder: DomainFolder) -> PredefinedLibrary:
    """Return the library of a domain.

    Raises:
        TmdError: There is none, or something in it is wrong; with file, line and column.
    """
    path = folder.path / FILE
    if not path.is_file():
        raise TmdError(f"the domain '{folder.name}' has no {FILE}", hint="write one, or leave the model out")
    source = YamlSource(path)
    entries = source.load(_File)
    reader = _Reader(source, folder.domain, entries.verbs)
    for name, kind in entries.kinds.items():
        reader.check_kind(("kinds", name), kind)
    templates = tuple(
        reader.template(("templates", number), entry, entries.kinds, folder.name)
        for number, entry in enumerate(entries.templates)
    )
    return PredefinedLibrary(templates, tuple(entries.kinds.values()))


class _TemplateEntry(BaseModel):
    model_config = ConfigDict(defer_build=True, extra="forbid")

    verb: _Words
    objects: _Words = ()
    relation: _Words = ()
    says: _Words = ()
    each: bool = False
    variables: dict[str, _Words] = {}
    where: _Steps = ()
    instructions: _Steps


class _File(BaseModel):
    model_config = ConfigDict(defer_build=True, extra="forbid")

    kinds: dict[str, TemplateKind] = {}
    verbs: dict[str, _Words] = {}
    templates: list[_TemplateEntry]


class _Reader:
    """A reader that checks entries against the domain."""

    def __init__(self, source: YamlSource, domain: Domain, verbs: Mapping[str, Sequence[str]]) -> None:
        self.source = source
        self.verbs = verbs
        self.hierarchy = hierarchy(domain)
        self.types = [t.name for t in domain.types]
        self.constants = {c.name: c.types for c in domain.constants}
        self.actions = {a.name: a.parameters for a in domain.actions}
        self.predicates = {p.name: p.parameters for p in domain.predicates}

    def check_kind(self, at: _Path, entry: TemplateKind) -> None:
        """Refuse a kind of the file that is a type, or is of types that are not there."""
        if self.hierarchy.known(str(at[-1])):
            raise self.source.error(at, f"'{at[-1]}' is a type of the domain", "give the kind another name")
        for place, name in enumerate(entry.types):
            if not self.hierarchy.known(name):
                raise self._unknown((*at, "types", place), "type", name, self.types)

    def template(
        self, at: _Path, entry: _TemplateEntry, kinds: Mapping[str, TemplateKind], folder: str
    ) -> PredefinedTemplate:
        """Return a template whose variables, facts and instructions all fit together."""
        for key in ("verb", "instructions"):
            if not getattr(entry, key):
                raise self.source.error((*at, key), f"'{key}' is empty", "a template has at least one")
        variables = {
            name: self._variable((*at, "variables", name), words, kinds) for name, words in entry.variables.items()
        }
        for place, name in enumerate(entry.objects):
            if name not in variables:
                raise self._unknown((*at, "objects", place), "variable", name, list(variables))
        if entry.relation and len(entry.objects) < 2:
            raise self.source.error((*at, "relation"), "a relation is between two objects", "write objects: [x, y]")
        where = [
            self._applied((*at, "where", n), text, variables, self.predicates, "predicate")
            for n, text in enumerate(entry.where)
        ]
        instructions = [
            self._applied((*at, "instructions", n), text, variables, self.actions, "action")
            for n, text in enumerate(entry.instructions)
        ]
        return PredefinedTemplate(
            f"{folder}/{FILE}:{self.source.locate(at).line}",
            tuple(dict.fromkeys(verb for name in entry.verb for verb in self.verbs.get(name, (name,)))),
            entry.objects,
            entry.relation,
            entry.says,
            entry.each,
            variables,
            tuple(where),
            tuple(instructions),
        )

    def _variable(self, at: _Path, words: Sequence[str], kinds: Mapping[str, TemplateKind]) -> TemplateKind:
        """Return one kind of the file's own, or some types."""
        if len(words) == 1 and words[0] in kinds:
            return kinds[words[0]]
        for place, name in enumerate(words):
            if not self.hierarchy.known(name):
                raise self._unknown((*at, place), "type or kind", name, [*kinds, *self.types])
        return TemplateKind(types=tuple(words))

    def _applied(
        self,
        at: _Path,
        text: str,
        variables: Mapping[str, TemplateKind],
        signatures: Mapping[str, tuple[TypedName, ...]],
        what: str,
    ) -> Instruction:
        """Return an action or a predicate with its arguments."""
        name, *args = text.lower().split() or [""]
        if name not in signatures:
            raise self._unknown(at, what, name, list(signatures))
        parameters = signatures[name]
        if len(args) != len(parameters):
            wanted = " ".join((name, *(p.name for p in parameters)))
            raise self.source.error(
                at, f"'{text}' has {len(args)} arguments, '{name}' takes {len(parameters)}", f"write {wanted}"
            )
        for arg, parameter in zip(args, parameters, strict=True):
            given = variables[arg[1:]].types if arg[1:] in variables and arg[0] == "?" else self.constants.get(arg)
            if given is None and arg.startswith("?"):
                raise self._unknown(at, "variable", arg[1:], list(variables))
            if given is None:
                raise self._unknown(at, "constant", arg, list(self.constants), "variables begin with ?")
            if not self.hierarchy.accepts(parameter.types, given):
                raise self.source.error(
                    at,
                    f"'{text}': '{arg}' is of type {' or '.join(given)}",
                    f"'{name}' takes {' or '.join(parameter.types)} here",
                )
        return Instruction(name, tuple(args))

    def _unknown(self, at: _Path, what: str, name: str, known: Sequence[str], otherwise: str | None = None) -> TmdError:
        return self.source.error(at, f"unknown {what} '{name}'", nearest(name, known) or otherwise)
