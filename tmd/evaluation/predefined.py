"""Predefined Templates: the baseline of section VII with a library that people wrote (after Guadarrama et al.).

The library of a domain is ``templates.yaml`` in the domain's folder::

    kinds:                       # types of the domain; of those, what is called so; nouns for it
      cup: {types: item, called: [mug, glass], words: [beaker]}
    verbs:                       # verbs that share templates, beside the synonyms of the domain's lexicon
      place: [place, put, set]

    templates:
      - verb: place
        objects: [x, y]          # the variables that nouns of the clause name
        relation: [in, into]     # if given: in the clause, the first is related to the second in one of these ways
        says: [water]            # if given: one of the clause's nouns is one of these words, and names no variable
        each: true               # once for each noun, or related pair, that fits; otherwise once for the first
        variables: {x: cup, y: cupboard, d: door}
        where: guards ?d ?y      # facts of the environment, as it is at first, that tie the variables
        instructions: find ?x, moveto ?x, grasp ?x, moveto ?y, open ?d, keep ?x ?y in, close ?d

Verbs and templates are many to many: a verb has several templates, a template several verbs (and their synonyms).
For a clause the template that says most of it is used. A variable that no noun names stands for the first object
that fits. The state of the environment decides only what a noun may mean (*the water* is what holds water): not which
template is used, and nothing checks that a sequence can be executed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Self

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict

from tmd.errors import TmdError
from tmd.evaluation.dataset import Dataset, Example
from tmd.evaluation.prediction import Prediction, by_clause
from tmd.language import parse
from tmd.language.clause import Clause
from tmd.language.lexicon import Lexicon
from tmd.language.nouns import WORDNET
from tmd.pddl.hierarchy import Universe, hierarchy
from tmd.pddl.model import Domain, GroundAtom, Instruction, TypedName
from tmd.pddl.syntax import nearest
from tmd.pddl.task import Bits
from tmd.veil.instantiate import replace
from tmd.veil.library import run
from tmd.veil.mentions import CONTAINED
from tmd.veil.world import World
from tmd.world.folder import DomainFolder, find_domain
from tmd.world.yaml_source import YamlSource

FILE = "templates.yaml"
"""The library's name in a domain's folder."""
_LOOSE = (CONTAINED, WORDNET)
"""How a noun means an object only if the library's own words say nothing."""
_OF = "of"
"""The relation of *a cup of water*: what is related to the one is related to the other."""


@dataclass(frozen=True, slots=True)
class Kind:
    """What a variable may stand for.

    Attributes:
        types: Types of the domain, any of which will do.
        called: Names, with or without their numbers, any of which will do; empty for all. VEIL-500 needs them: its
            classes are no types.
        words: Nouns for such objects, besides those that the environment and the lexicon know; they go before what
            is merely similar, or what something may contain.
    """

    types: tuple[str, ...]
    called: tuple[str, ...] = ()
    words: tuple[str, ...] = ()

    def has(self, name: str, objects: Universe) -> bool:
        """Whether the object ``name`` is of this kind."""
        names = {name, re.sub(r"[_\d]+\Z", "", name)}
        return objects.is_a(name, self.types) and (not self.called or not names.isdisjoint(self.called))


@dataclass(frozen=True, slots=True)
class PredefinedTemplate:
    """One entry of a library, as the module's docstring describes it.

    Attributes:
        source: Where it stands: folder, file and line.
        verbs: The verbs it serves.
        objects: The variables that nouns name.
        relations: The ways in which the first of them may be related to the second; empty if it does not matter.
        says: Words of which the clause has one; empty if it does not matter.
        each: Whether it is used for all nouns that fit.
        variables: The kind of each variable, in the order in which those that no noun names are chosen.
        where: Facts that hold of the objects.
        instructions: The sequence.
    """

    source: str
    verbs: tuple[str, ...]
    objects: tuple[str, ...]
    relations: tuple[str, ...]
    says: tuple[str, ...]
    each: bool
    variables: Mapping[str, Kind]
    where: tuple[Instruction, ...]
    instructions: tuple[Instruction, ...]

    @property
    def weight(self) -> tuple[int, bool]:
        """How much of a clause it accounts for: words, then whether their relation matters."""
        return len(self.objects) + bool(self.says), bool(self.relations)


@dataclass(frozen=True, slots=True)
class PredefinedLibrary:
    """What is in a file: the templates in their order, and its kinds, whose words hold for every template."""

    templates: tuple[PredefinedTemplate, ...]
    kinds: tuple[Kind, ...] = ()


class PredefinedTemplates:
    """The row of the table.

    Args:
        domains: The directory of all domains, if not the usual one.
    """

    def __init__(self, domains: Path | None = None) -> None:
        self.domains = domains
        self.libraries_: dict[str, PredefinedLibrary] = {}

    def fit(self, examples: Sequence[Example], data: Dataset, random: np.random.Generator) -> Self:
        """Nothing is learned; the library is read anew.

        Raises:
            TmdError: There is none, or it is wrong.
        """
        self.libraries_ = {}
        for example in examples[:1]:
            self._library(data.world(example.environment))
        return self

    def predict(self, example: Example, data: Dataset, random: np.random.Generator) -> Prediction:
        """The template of each clause, one after the other.

        Raises:
            TmdError: The domain has no library, or a wrong one.
        """
        world = data.world(example.environment)
        library = self._library(world)
        state = world.task.init
        done: list[tuple[Clause, tuple[Instruction, ...], str | None]] = []
        for clause in parse(example.demonstration.text, data.lexicon).clauses:
            said, source = serve(library, clause, world, state, data.lexicon)
            done.append((clause, said, source))
            state = run(world, state, said)
        return by_clause(done)

    def _library(self, world: World) -> PredefinedLibrary:
        name = world.task.problem.domain.name
        if name not in self.libraries_:
            self.libraries_[name] = load_templates(find_domain(name, self.domains))
        return self.libraries_[name]


def serve(
    library: PredefinedLibrary, clause: Clause, world: World, state: Bits, lexicon: Lexicon
) -> tuple[tuple[Instruction, ...], str | None]:
    """The instructions for ``clause`` and the template they come from; nothing, from ``None``, where none fits.

    Of the templates that fit it is the one of most :attr:`~PredefinedTemplate.weight`, then the first of the file.
    """
    verb = lexicon.canonical_verb(clause.verb)
    own = [t for t in library.templates if any(lexicon.canonical_verb(v) == verb for v in t.verbs)]
    for template in sorted(own, key=lambda t: t.weight, reverse=True):
        found = [replace(template.instructions, g) for g in _groundings(template, library.kinds, clause, world, state)]
        if found:
            chosen = dict.fromkeys(found if template.each else found[:1])
            return tuple(i for instructions in chosen for i in instructions), template.source
    return (), None


def _groundings(
    template: PredefinedTemplate, kinds: Sequence[Kind], clause: Clause, world: World, state: Bits
) -> Iterator[Mapping[str, str]]:
    """The objects of the variables, for each way to read the clause as the template, in order of mention."""
    nouns = list(clause.resolved())
    spoken = None
    if template.says:
        spoken = next((n for n in nouns if _among(n, template.says)), None)
        if spoken is None:
            return
        nouns.remove(spoken)
    for first in _beginnings(template, clause, nouns):
        grounding = None if spoken in first else _ground(template, kinds, first, nouns, world, state)
        if grounding is not None:
            yield grounding


def _beginnings(template: PredefinedTemplate, clause: Clause, nouns: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """The nouns that the template's first variables may have: related ones, else any one."""
    if not template.objects:
        yield ()
    elif not template.relations:
        yield from ((noun,) for noun in nouns)
    for relation in clause.relations:
        if relation.relation in template.relations:
            parts = [r.target for r in clause.relations if r.relation == _OF and r.source == relation.source]
            for source in (relation.source or "", *parts):
                for a in clause.meant(source):
                    yield from ((a, b) for b in clause.meant(relation.target))


def _ground(
    template: PredefinedTemplate,
    kinds: Sequence[Kind],
    first: Sequence[str],
    nouns: Sequence[str],
    world: World,
    state: Bits,
) -> Mapping[str, str] | None:
    """An object for each variable, or ``None``: those of ``first``, then of other nouns, then what fits first."""
    grounding: dict[str, str] = {}
    left = [noun for noun in nouns if noun not in first]
    for place, variable in enumerate(template.objects):
        offered = first[place : place + 1] or tuple(left)
        named = ((noun, name) for noun in offered for name in _meant(noun, kinds, world, state))
        chosen = next(((n, o) for n, o in named if _fits(template, variable, o, grounding, world)), None)
        if chosen is None:
            return None
        noun, grounding[f"?{variable}"] = chosen
        left = [other for other in left if other != noun]
    for variable in template.variables:
        if f"?{variable}" not in grounding:
            there = (o for o in world.profiles.objects if _fits(template, variable, o, grounding, world))
            found = next(there, None)
            if found is None:
                return None
            grounding[f"?{variable}"] = found
    return grounding


def _among(noun: str, words: Sequence[str]) -> bool:
    """Whether ``noun``, or what is left of it without its modifiers, is one of ``words``."""
    return noun in words or noun.rpartition("_")[2] in words


def _meant(noun: str, kinds: Sequence[Kind], world: World, state: Bits) -> Iterator[str]:
    """The objects that ``noun`` may mean, likeliest first."""
    matches = world.mentions.of(noun, state)
    yield from (match.name for match in matches if match.how not in _LOOSE)
    for kind in kinds:
        if _among(noun, kind.words):
            yield from (name for name in world.profiles.objects if kind.has(name, world.objects))
    yield from (match.name for match in matches if match.how in _LOOSE)


def _fits(template: PredefinedTemplate, variable: str, name: str, grounding: Mapping[str, str], world: World) -> bool:
    """Whether ``variable`` may stand for the object ``name``, the others being as in ``grounding``."""
    if name in grounding.values() or not template.variables[variable].has(name, world.objects):
        return False
    facts = replace(template.where, {**grounding, f"?{variable}": name})
    settled = (f for f in facts if not any(a.startswith("?") for a in f.args))
    return all(GroundAtom(*fact) in world.task.problem.init for fact in settled)


def load_templates(folder: DomainFolder) -> PredefinedLibrary:
    """The library of a domain.

    Raises:
        TmdError: There is none, or something in it is wrong; with file, line and column.
    """
    path = folder.path / FILE
    if not path.is_file():
        raise TmdError(f"the domain '{folder.name}' has no {FILE}", hint="write one, or leave the model out")
    source = YamlSource(path)
    entries = source.load(_File)
    reader = _Reader(source, folder.domain, entries.verbs)
    kinds = {name: reader.kind(("kinds", name), entry) for name, entry in entries.kinds.items()}
    templates = tuple(
        reader.template(("templates", number), entry, kinds, folder.name)
        for number, entry in enumerate(entries.templates)
    )
    return PredefinedLibrary(templates, tuple(kinds.values()))


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


class _KindEntry(BaseModel):
    model_config = ConfigDict(extra="forbid")

    types: _Words
    called: _Words = ()
    words: _Words = ()


class _TemplateEntry(BaseModel):
    model_config = ConfigDict(extra="forbid")

    verb: _Words
    objects: _Words = ()
    relation: _Words = ()
    says: _Words = ()
    each: bool = False
    variables: dict[str, _Words] = {}
    where: _Steps = ()
    instructions: _Steps


class _File(BaseModel):
    model_config = ConfigDict(extra="forbid")

    kinds: dict[str, _KindEntry] = {}
    verbs: dict[str, _Words] = {}
    templates: list[_TemplateEntry]


class _Reader:
    """Checks entries against the domain."""

    def __init__(self, source: YamlSource, domain: Domain, verbs: Mapping[str, Sequence[str]]) -> None:
        self.source = source
        self.verbs = verbs
        self.hierarchy = hierarchy(domain)
        self.types = [t.name for t in domain.types]
        self.constants = {c.name: c.types for c in domain.constants}
        self.actions = {a.name: a.parameters for a in domain.actions}
        self.predicates = {p.name: p.parameters for p in domain.predicates}

    def kind(self, at: _Path, entry: _KindEntry) -> Kind:
        """A kind of the file's own."""
        if self.hierarchy.known(str(at[-1])):
            raise self.source.error(at, f"'{at[-1]}' is a type of the domain", "give the kind another name")
        for place, name in enumerate(entry.types):
            if not self.hierarchy.known(name):
                raise self._unknown((*at, "types", place), "type", name, self.types)
        return Kind(entry.types, entry.called, entry.words)

    def template(self, at: _Path, entry: _TemplateEntry, kinds: Mapping[str, Kind], folder: str) -> PredefinedTemplate:
        """A template whose variables, facts and instructions all fit together."""
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

    def _variable(self, at: _Path, words: Sequence[str], kinds: Mapping[str, Kind]) -> Kind:
        """One kind of the file's own, or some types."""
        if len(words) == 1 and words[0] in kinds:
            return kinds[words[0]]
        for place, name in enumerate(words):
            if not self.hierarchy.known(name):
                raise self._unknown((*at, place), "type or kind", name, [*kinds, *self.types])
        return Kind(tuple(words))

    def _applied(
        self,
        at: _Path,
        text: str,
        variables: Mapping[str, Kind],
        signatures: Mapping[str, tuple[TypedName, ...]],
        what: str,
    ) -> Instruction:
        """An action or a predicate with its arguments."""
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
