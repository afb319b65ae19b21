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

from collections.abc import Iterator, Mapping, Sequence
from typing import Self

import numpy as np

from tmd.evaluation.models.prediction import Made, Prediction, from_state
from tmd.evaluation.models.template_file import PredefinedLibrary, PredefinedTemplate, TemplateKind, load_templates
from tmd.evaluation.runs.dataset import Dataset, Example
from tmd.language.clause import Clause
from tmd.language.lexicon.lexicon import Lexicon
from tmd.language.lexicon.nouns import WORDNET
from tmd.library.template import replace
from tmd.pddl.model import GroundAtom
from tmd.pddl.task import Bits
from tmd.world.world import CONTAINED, World

_LOOSE = (CONTAINED, WORDNET)
"""How a noun means an object only if the library's own words say nothing."""
_OF = "of"
"""The relation of *a cup of water*: what is related to the one is related to the other."""


class PredefinedTemplates:
    """The row of the table."""

    def fit(self, examples: Sequence[Example], data: Dataset, random: np.random.Generator) -> Self:
        """Learn nothing; read the library of the domain.

        Raises:
            TmdError: There is none, or it is wrong.
        """
        self.library_ = load_templates(data.folder)
        return self

    def predict(self, example: Example, data: Dataset, random: np.random.Generator) -> Prediction:
        """Return the template of each clause, one after the other."""
        return from_state(
            example, data, lambda clause, world, state: serve(self.library_, clause, world, state, data.lexicon)
        )


def serve(library: PredefinedLibrary, clause: Clause, world: World, state: Bits, lexicon: Lexicon) -> Made:
    """Return the instructions for ``clause`` and the template they come from; nothing, from ``None``, where none fits.

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
    template: PredefinedTemplate, kinds: Sequence[TemplateKind], clause: Clause, world: World, state: Bits
) -> Iterator[Mapping[str, str]]:
    """Yield the objects of the variables, for each way to read the clause as the template, in order of mention."""
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
    """Yield the nouns that the template's first variables may have: related ones, else any one."""
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
    kinds: Sequence[TemplateKind],
    first: Sequence[str],
    nouns: Sequence[str],
    world: World,
    state: Bits,
) -> Mapping[str, str] | None:
    """Return an object for each variable: of ``first``, then of other nouns, then any that fits; or else ``None``."""
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
    """Return whether ``noun``, or what is left of it without its modifiers, is one of ``words``."""
    return noun in words or noun.rpartition("_")[2] in words


def _meant(noun: str, kinds: Sequence[TemplateKind], world: World, state: Bits) -> Iterator[str]:
    """Yield the objects that ``noun`` may mean, likeliest first."""
    matches = world.mentions.of(noun, state)
    yield from (match.name for match in matches if match.how not in _LOOSE)
    for kind in kinds:
        if _among(noun, kind.words):
            yield from (name for name in world.profiles.objects if kind.has(name, world.objects))
    yield from (match.name for match in matches if match.how in _LOOSE)


def _fits(template: PredefinedTemplate, variable: str, name: str, grounding: Mapping[str, str], world: World) -> bool:
    """Return whether ``variable`` may stand for the object ``name``, the others being as in ``grounding``."""
    if name in grounding.values() or not template.variables[variable].has(name, world.objects):
        return False
    facts = replace(template.where, {**grounding, f"?{variable}": name})
    settled = (f for f in facts if not any(a.startswith("?") for a in f.args))
    return all(GroundAtom(*fact) in world.task.problem.init for fact in settled)
