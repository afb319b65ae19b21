"""What the noun phrases of a clause mean in one environment: candidates, filtered by adjectives and relations."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import cached_property

from tmd.goals.grounder import Grounder, Moments
from tmd.goals.sources.table import LOCATED, PREPOSITIONS, RELATION, GoalTable, state_words
from tmd.language.clause import NounPhrase, Quantifier
from tmd.language.lexicon.lexicon import section
from tmd.language.lexicon.nouns import ALIAS, NAME, WORDNET, split_name, words_in_name
from tmd.pddl.ground_formula import FALSE, TRUE, disjunction, negation
from tmd.pddl.model import Atom, Formula, GroundAtom
from tmd.pddl.task import Bits
from tmd.veil.world import CONTAINED, World

INVERSE = {"under": "on", "underneath": "on", "below": "on", "beneath": "on"}
"""Relations said the other way round: what is under the pot is what the pot stands on."""
PART_OF = frozenset({"of", "on", "in", "at", "from"})
"""Relations that a part may have to its whole."""
_CONTENTS = frozenset({"of", "with", "containing"})
EVERYTHING = section("whole_words") | {"nothing", "thing"}
_ANYTHING = frozenset({"item", "object", "thing", "stuff"})
"""Nouns that say nothing of what a thing is."""


class Mode(StrEnum):
    """How many of the candidates of a noun phrase are meant."""

    ANY = "any"
    ALL = "all"
    NUMBER = "number"
    NONE = "none"


@dataclass(frozen=True, slots=True)
class Referent:
    """What a noun phrase may mean.

    Attributes:
        noun: The noun, for messages.
        names: The candidates.
        mode: How many of them.
        number: The number, where one was said.
        definite: One particular thing is meant.
        loose: Candidates of which the goal can never hold are not meant: *everything*, *the rubbish*.
        each: Said of each one by itself.
    """

    noun: str
    names: tuple[str, ...]
    mode: Mode = Mode.ANY
    number: int = 1
    definite: bool = False
    loose: bool = False
    each: bool = False


@dataclass(frozen=True, slots=True)
class Bound:
    """What a noun of an earlier clause turned out to mean: objects, and for a substance what contains it."""

    names: tuple[str, ...]
    containers: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Memory:
    """What later clauses need to know of earlier ones.

    Attributes:
        bound: The nouns that were spoken of, the latest last.
        recent: Objects that were spoken of, the latest first.
        first: The state before the text.
        left: The things that the text says to leave as they are.
    """

    bound: Mapping[str, Bound] = field(default_factory=dict)
    recent: tuple[str, ...] = ()
    first: Bits = 0
    left: tuple[str, ...] = ()


class Nouns:
    """The nouns of one environment.

    Args:
        world: The environment.
        table: What adjectives and groups mean.
        grounder: Grounds their conditions.
        guess: Whether likeness of meaning alone may lead from a noun to a thing.
    """

    def __init__(self, world: World, table: GoalTable, grounder: Grounder, *, guess: bool = False) -> None:
        self.world = world
        self.table = table
        self.grounder = grounder
        self.guess = guess
        self._of_object: dict[str, tuple[GroundAtom, ...]] = {}
        for atom in (*world.task.atoms, *sorted(world.task.static)):
            for name in dict.fromkeys(atom.args):
                self._of_object[name] = (*self._of_object.get(name, ()), atom)

    @cached_property
    def places(self) -> frozenset[str]:
        """The constants that are things as objects are: of a type that objects here have as well, as the floor is."""
        mentions, constants = self.world.mentions, self.world.profiles.constants
        common = {kind for name in self.world.profiles.objects for kind in mentions.types.get(name, ())}
        return frozenset(name for name in constants if mentions.types.get(name, ("",))[0] in common)

    def things(
        self, noun: str, state: Bits, *, place: bool = False, types: tuple[str, ...] | None = None
    ) -> tuple[str, ...]:
        """The objects that ``noun`` may mean: the likeliest reading only; never by likeness of meaning alone.

        As a ``place`` a noun is not a group: rubbish goes in the trash, and is not what the trash is. With ``types`` it
        is the likeliest of the readings that fit them.
        """
        if noun in EVERYTHING:
            return self.world.profiles.objects
        if noun.endswith("_thing"):
            whole, words = self.world.profiles.objects, split_name(noun)[:-1]
            moments = Moments(state, state)
            said = {n: [self.attribute(word, n, moments) for word in words] for n in whole}
            return tuple(n for n in whole if all(f and self.grounder.truth(f, state) for f in said[n]))
        if noun in self.table.groups and not (place and noun in self.world.mentions.lexicon.nouns):
            classes = self.table.groups[noun]
            found = [n for n in self.world.profiles.objects if any(c in self._kinds(n) for c in classes)]
            if found:
                return tuple(found)
        named = [m for m in self.world.mentions.ranked(noun)[:1] if m.name in self.places and m.how in (NAME, ALIAS)]
        if named:
            return (named[0].name,)  # the floor, which is no substance that things contain
        matches = [m for m in self.world.mentions.of(noun, state) if self.guess or m.how != WORDNET]
        if not self.guess and all(m.how == WORDNET for m in self.world.mentions.ranked(noun)):
            return self._called_after(noun)  # what such a likeness contains is no more sure than itself
        if types is not None:
            fitting = [m for m in matches if self.grounder.fits(m.name, types)]
            matches = [m for m in fitting if self.grounder.is_a(m.name, types)] or fitting or matches
        best = [m.name for m in matches if m.score == matches[0].score and m.how == matches[0].how]
        if not self.guess and matches and matches[0].how == NAME and self._of_another_class(noun, best):
            return ()
        if matches and matches[0].how == CONTAINED and not self._of_that_kind(noun, self.contents(best[0], state)):
            return ()
        best = self._numbered(noun, self._told_apart(noun, best, state))
        return tuple(best) or self._called_after(noun) or (self._siblings(noun) if self.guess else ())

    def _numbered(self, noun: str, names: Iterable[str]) -> list[str]:
        """The names with the number of a noun, if it has one and they have: *channel 7* is not a channel of four."""
        *_, last = split_name(noun)
        found = list(names)
        numbers = {name: split_name(name)[-1] for name in found}
        if not last.isdigit() or not all(number.isdigit() for number in numbers.values()):
            return found
        return [name for name, number in numbers.items() if int(number) == int(last)]

    def _of_that_kind(self, noun: str, substances: Iterable[str]) -> bool:
        """Whether substances are no other kind than said: *raspberry milk* is not milk, where syrup is *raspberry*."""
        kinds = {word for name in self.world.profiles.constants for word in split_name(name)[:-1]}
        told = kinds & set(split_name(noun)[:-1]) if noun not in self.world.mentions.lexicon.nouns else set()
        return not told or any(told <= set(split_name(name)) for name in substances)

    def _of_another_class(self, noun: str, names: list[str]) -> bool:
        """Whether a class that a noun names has nothing here: a *floor lamp* is not a ceiling lamp."""
        classes = self.world.mentions.classes
        return "_" in noun and noun in classes and not any(noun in self._kinds(name) for name in names)

    def _told_apart(self, noun: str, names: list[str], state: Bits) -> list[str]:
        """Of things that share only the head of a compound those that its modifiers mean: *Ann's bed*, *coffee cup*."""
        modifiers = split_name(noun)[:-1]  # a noun may be no word at all: "é", "²"
        if not modifiers or len(names) < 2:
            return names
        declared = self.world.mentions.lexicon.nouns.get(noun)
        if declared is not None:  # "upper_drawer: [top_drawer]" in the lexicon means cabinet1_top_drawer
            whole = [set(split_name(alias)) for alias in declared if len(split_name(alias)) > 1]
            return [n for n in names if any(words <= set(split_name(n)) for words in whole)] or names
        alike = {word for modifier in modifiers for word in state_words(modifier)}  # the upper drawer is the top one
        called = [n for n in names if any(alike & set(split_name(kind)) for kind in self._kinds(n))]
        if called:
            return called
        owners = [m.name for m in self.world.mentions.ranked("_".join(modifiers)) if m.how in (NAME, ALIAS)]
        now = self.related_now(Referent(noun, tuple(names)), "of", owners, state, Moments(state, state))
        for word in modifiers:
            said = {name: self.attribute(word, name, Moments(state, state)) for name in names}
            if any(formula is not None for formula in said.values()):  # "the free hook"
                now = tuple(n for n, formula in said.items() if formula and self.grounder.truth(formula, state))
                return list(now)
        if not now and split_name(noun)[-1] in _ANYTHING:  # "perishable items": nothing tells which of all things
            return []
        # where names say which one of its kind a thing is ("red_block"), there is no yellow one
        contrary = set(modifiers) & section("keep_adjectives") and all(map(self._modified, names))
        return list(now) or ([] if contrary else names)

    def holders(self, noun: str, contents: Iterable[str], state: Bits, moments: Moments) -> tuple[str, ...]:
        """Of everything that ``noun`` may mean what holds some of ``contents`` now: *the bag of crisps*."""
        names = tuple(m.name for m in self.world.mentions.of(noun, state) if self.guess or m.how != WORDNET)
        return self.related_now(Referent(noun, names), "of", tuple(contents), state, moments)

    def too_few(self, phrase: NounPhrase, substances: Collection[str], state: Bits) -> tuple[str, ...]:
        """The things called so that hold ``substances``, where more were counted: *two eggs*, and there is one."""
        called = [
            m.name for m in self.world.mentions.of(phrase.name, state) if m.how == NAME and self.is_supply(m.name)
        ]
        holding = tuple(n for n in called if not set(substances).isdisjoint(self.contents(n, state)))
        return holding if phrase.quantifier is Quantifier.NUMBER and len(holding) < (phrase.number or 1) else ()

    def _siblings(self, noun: str) -> tuple[str, ...]:
        """For a guess: where there is no kettle, but the domain knows what one is, other vessels."""
        declared = {t.name: t.parent for t in self.world.task.problem.domain.types}
        names = (noun, *self.world.mentions.lexicon.nouns.get(noun, ()))
        parents = [declared[name] for name in names if name in declared]
        broad = set(declared.values()) - set(declared) | {declared.get(parent, "") for parent in parents}
        return tuple(
            n for n in self.world.profiles.objects if any(p in self._kinds(n) and p not in broad for p in parents)
        )

    def _called_after(self, noun: str) -> tuple[str, ...]:
        """Objects with the noun in their names: *the peas* for ``pea_seeds``, where nothing is a pea.

        Where a compound is a class of the domain its first part alone is none: *coffee* is no coffee table.
        """
        if any(m.how != WORDNET for m in self.world.mentions.ranked(noun)):
            return ()
        compounds = {kind for kind in self.world.mentions.classes if noun in split_name(kind)[:-1]}
        return tuple(
            n
            for n in self.world.profiles.objects
            if noun in split_name(n)[:-1] and not compounds.intersection(self._kinds(n))
        )

    def is_group(self, noun: str) -> bool:
        """Whether a noun means all things of some classes."""
        return noun in EVERYTHING or noun in self.table.groups

    def _kinds(self, name: str) -> tuple[str, ...]:
        return (*self.world.mentions.types.get(name, ()), self.world.mentions.kinds.get(name, ""), name)

    def constants(self, noun: str, types: tuple[str, ...], state: Bits) -> tuple[str, ...]:
        """The constants of ``types`` that ``noun`` may mean, or what the things it names contain at first."""
        ranked = [m for m in self.world.mentions.ranked(noun) if m.name in self.world.profiles.constants]
        fitting = [m for m in ranked if self.grounder.is_a(m.name, types)]
        named = [m.name for m in fitting if m.how == NAME and m.score == fitting[0].score]
        if named:
            return tuple(self._numbered(noun, named)) if self._of_that_kind(noun, named) else ()
        aliases = [m.name for m in fitting if m.how == ALIAS or (self.guess and m.how == WORDNET)]
        if aliases:
            later = {other for one in aliases for other in self.turns_into(one)}
            fresh = [name for name in aliases if name not in later] or aliases
            return tuple(self._numbered(noun, fresh)) if self._of_that_kind(noun, aliases) else ()
        contents: dict[str, None] = {}
        for thing in self.things(noun, state):
            contents.update(dict.fromkeys(c for c in self.contents(thing, state) if self.grounder.is_a(c, types)))
        return tuple(contents)

    def substances(self, noun: str) -> tuple[str, ...]:
        """All constants that a noun may mean by its name or by the words of the domain."""
        called = [m.name for m in self.world.mentions.ranked(noun) if m.how in (NAME, ALIAS)]
        names = (*called, *self.world.mentions.lexicon.nouns.get(noun, ()))
        return tuple(name for name in dict.fromkeys(names) if name in self.world.profiles.constants)

    def facts_about(self, name: str) -> tuple[GroundAtom, ...]:
        """The atoms that may hold in which ``name`` stands."""
        return self._of_object.get(name, ())

    def turns_into(self, constant: str) -> tuple[str, ...]:
        """The constants that a fact that never changes leads to from ``constant``: what ramen cooks into."""
        return tuple(
            atom.args[1]
            for atom in self._of_object.get(constant, ())
            if atom in self.world.task.static and len(atom.args) == 2 and atom.args[0] == constant
        )

    def contents(self, thing: str, state: Bits) -> tuple[str, ...]:
        """The constants that stand beside ``thing`` in facts of two that hold now and may change."""
        found: dict[str, None] = {}
        changing = {atom.predicate for atom in self.world.task.atoms}
        for atom in self._of_object.get(thing, ()):
            pair = len(atom.args) == 2 and atom.args[0] == thing and atom.args[1] in self.world.profiles.constants
            if pair and atom.predicate in changing and self.grounder.holds(atom, state):
                found[atom.args[1]] = None
        return tuple(found)

    def is_supply(self, thing: str) -> bool:
        """Whether a thing has what it contains from the start, and never anything else: a bottle of syrup."""
        constants = self.world.profiles.constants
        facts = [a for a in self.facts_about(thing) if len(a.args) == 2 and a.args[0] == thing]
        inside = {a.args[1] for a in facts if a.args[1] in constants}
        return len(inside) == 1 and set(self.contents(thing, self.world.task.init)) == inside

    def attribute(self, word: str, name: str, moments: Moments) -> Formula | None:
        """That ``name`` is as an adjective says; ``None`` for an adjective that nothing here explains."""
        if word.startswith("not_"):
            inner = self.attribute(word.removeprefix("not_"), name, moments)
            return None if inner is None else negation(inner)
        if word in self.table.attributes:
            return self.grounder.ground(self.table.attributes[word], {"?x": name}, ("?x",), moments)
        return self.state_of(state_words(word), name)

    def state_of(self, words: Iterable[str], name: str) -> Formula | None:
        """That ``name`` is in a state for which one of ``words`` stands in a predicate or is a constant.

        Words with a minus say that it is not in such a state. ``None`` where no fact here has such a word.
        """
        listed = list(words)
        plain = [word for word in listed if not word.startswith("-")]
        contrary = [word[1:] for word in listed if word.startswith("-")]
        for candidate in (name, *self._relatives(name)):
            for wanted, positive in ((plain, True), (contrary, False)):
                for word in wanted:
                    atoms = [a for a in self._of_object.get(candidate, ()) if self._says_state(a, word, candidate)]
                    if any(a not in self.world.task.index for a in atoms):
                        return TRUE if positive else FALSE
                    if atoms:
                        found = disjunction(Atom(a.predicate, a.args) for a in atoms)
                        return found if positive else negation(found)
        return None

    def _relatives(self, name: str) -> tuple[str, ...]:
        return tuple(other for level in range(2) for other in self.grounder.relatives(name, level))

    def _says_state(self, atom: GroundAtom, word: str, name: str) -> bool:
        others = [a for a in atom.args if a != name]
        if word in others and word in self.world.profiles.constants and len(others) == 1:
            return True
        return word in words_in_name(atom.predicate) and all(a in self.world.profiles.constants for a in others)

    def related(self, relation: str, name: str, target: str, moments: Moments) -> Formula:
        """That ``name`` stands in a relation to ``target``: as the table says it, or as the facts themselves do."""
        if relation in PART_OF and self.world.profiles.wholes.get(name) == target:
            return TRUE  # "the button on the microwave"
        if relation in INVERSE and not self._declared(relation):
            return self.related(INVERSE[relation], target, name, moments)
        for row in self.table.of("be"):
            direct, places = row.direct, row.places
            if direct is None or len(places) != 1:
                continue
            said = relations_said(relation, places[0].prepositions)
            if not said:
                continue
            found = disjunction(
                self.grounder.ground(
                    row.condition,
                    {direct.variable: name, places[0].variable: target, RELATION: one},
                    (direct.variable, places[0].variable),
                    moments,
                )
                for one in said
            )
            if found != FALSE:
                return found
        return self._related_by_facts(relation, name, target)

    def _declared(self, relation: str) -> bool:
        return any(relations_said(relation, s.prepositions) for row in self.table.of("be") for s in row.places)

    def _related_by_facts(self, relation: str, name: str, target: str) -> Formula:
        """Facts that have both, and the relation's name as a constant or in the predicate."""
        words = {group for group, members in PREPOSITIONS.items() if relation in members} | {relation}
        things = target not in self.world.profiles.constants and name not in self.world.profiles.constants
        places = words & {"from", "where", "to", "at"} or (words & _CONTENTS and things)
        ordered = things and not words & (_CONTENTS | {"where"})
        ends = (target, *(other for level in range(3) for other in self.grounder.relatives(target, level)))
        for end in ends:
            found = []
            for atom in self._of_object.get(name, ()):
                if end not in atom.args or (atom not in self.world.task.index and atom not in self.world.task.static):
                    continue
                if atom.predicate in self.grounder.reflexive:
                    continue
                if ordered and atom.args.index(name) > atom.args.index(end):
                    continue  # (on a b) says where a is, not where b is
                if self._names_relation(atom, words, places=bool(places), name=name, end=end):
                    found.append(atom)
            if found:
                return disjunction(Atom(a.predicate, a.args) for a in found)
        return FALSE

    def _names_relation(self, atom: GroundAtom, words: set[str], *, places: bool, name: str, end: str) -> bool:
        others = [a for a in atom.args if a not in (name, end)]
        if any(a in PREPOSITIONS for a in others):
            return places or any(a in words for a in others)
        parts = words_in_name(atom.predicate)
        synonyms = {w for word in words for w in PREPOSITIONS.get(word, ())} | words
        if parts & synonyms:
            return True
        known = {w for members in PREPOSITIONS.values() for w in members}
        if parts & LOCATED:
            return places or bool(words & {"in", "on"})
        if parts & known:
            return places
        contents = end in self.world.profiles.constants or name in self.world.profiles.constants
        if words & _CONTENTS:
            return contents and not others
        joins = bool(words & {"to", "of"}) and not contents  # "the door to the hall"
        return places and (atom in self.world.task.index or joins)

    def narrowed(
        self, referent: Referent, phrase: NounPhrase, state: Bits, moments: Moments
    ) -> tuple[Referent, list[str]]:
        """The referent without candidates that the adjectives leave out; and the adjectives that nothing explains."""
        names = referent.names
        unknown: list[str] = []
        for word in phrase.attributes:
            said = {name: self.attribute(word, name, moments) for name in names}
            if all(formula is None for formula in said.values()):
                named = tuple(n for n in names if word in split_name(n))
                contrary = word in section("keep_adjectives")
                others = contrary and len(names) > 1 and all(self._modified(n) for n in names)
                names = named if named or others else names
                if not named and not others:
                    unknown.append(word)
                continue
            names = tuple(n for n in names if (f := said[n]) is not None and self.grounder.truth(f, state))
            if phrase.name in EVERYTHING:  # "everything that is empty": not the pillow, which nothing can fill
                kinds = self.world.mentions.kinds
                states = {name: self.attribute(word, name, moments) for name in self.world.profiles.objects}
                other = {kinds.get(name, name) for name, f in states.items() if f not in (None, TRUE, FALSE)}
                if other:  # but the bottle, of which another one is full
                    names = tuple(n for n in names if said[n] != TRUE or kinds.get(n, n) in other)
        return replace(referent, names=names), unknown

    def _modified(self, name: str) -> bool:
        """Whether the name of an object says which one of its kind it is: ``red_block``."""
        return len([word for word in split_name(name) if not word.isdigit()]) > 1

    def related_now(
        self, referent: Referent, relation: str, targets: Sequence[str], state: Bits, moments: Moments
    ) -> tuple[str, ...]:
        """The candidates that stand in a relation to one of ``targets`` now."""
        return tuple(
            name
            for name in referent.names
            if any(
                name != target and self.grounder.truth(self.related(relation, name, target, moments), state)
                for target in targets
            )
        )


def relations_said(relation: str, allowed: Sequence[str]) -> tuple[str, ...]:
    """The prepositions of a pattern that a said one stands for; *to* and *at* leave open which."""
    exact = tuple(p for p in allowed if relation in PREPOSITIONS[p])
    if exact:
        return exact
    if relation in PREPOSITIONS["to"]:
        return tuple(p for p in allowed if p in ("in", "on"))
    return ()


def mode_of(phrase: NounPhrase, *, group: bool, thing: bool, place: bool = False) -> tuple[Mode, int]:
    """How many are meant: plurals and groups of things mean all of them, unless *some* was said.

    Of plural places one is enough: *on the chairs*, *on one of the burners*.
    """
    match phrase.quantifier:
        case Quantifier.ALL:
            return Mode.ALL, 0
        case Quantifier.NUMBER:
            return (Mode.NUMBER, phrase.number or 1) if thing else (Mode.ANY, 1)
        case Quantifier.NONE:
            return Mode.NONE, 0
        case Quantifier.SOME:
            return Mode.ANY, 1
    many = (phrase.plural or group) and thing and not place
    return (Mode.ALL, 0) if many else (Mode.ANY, 1)
