"""Nouns of one environment: the things and substances that a noun may name."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from enum import StrEnum
from functools import cached_property
from itertools import combinations, islice

from tmd.goals.grounder import Grounder, Moments
from tmd.goals.reading.facts import Facts
from tmd.goals.sources.actions import participle, told_nouns
from tmd.goals.sources.table import GoalTable
from tmd.goals.words import ends_as, is_idle, is_noun, is_relation, state_words, words_of
from tmd.language.clause import NounPhrase, Quantifier
from tmd.language.lexicon.lexicon import section, singular
from tmd.language.lexicon.names import split_name, words_in_name
from tmd.language.lexicon.nouns import ALIAS, NAME, WORDNET, Match, number_in_name, same
from tmd.pddl.ground_formula import FALSE, TRUE, conjunction, disjunction
from tmd.pddl.model import Formula, GroundAtom
from tmd.pddl.task import Bits
from tmd.world.world import CONTAINED, World

_SLIP_LENGTH = 5
"""Shorter words are never taken for misspelt ones."""
_SLIP_RATIO = 0.8
"""Least likeness of a misspelt word."""
_MOST_CHOICES = 200
"""Maximum number of ways of choosing two of many things."""


class Mode(StrEnum):
    """The number of candidates of a noun phrase that are meant."""

    ANY = "any"
    ALL = "all"
    NUMBER = "number"
    NONE = "none"


@dataclass(frozen=True, slots=True)
class Referent:
    """The meaning of a noun phrase.

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

    def only(self, names: Iterable[str]) -> Referent:
        """Return the same with fewer candidates."""
        return replace(self, names=tuple(names))


@dataclass(frozen=True, slots=True)
class Bound:
    """The meaning of a noun of an earlier clause.

    Attributes:
        names: Objects or constants.
        containers: The vessels of a substance.
        every: A later pronoun means all of them: "If a bottle is empty, throw it away."
    """

    names: tuple[str, ...]
    containers: tuple[str, ...] = ()
    every: bool = False


@dataclass(frozen=True, slots=True)
class Memory:
    """The earlier clauses, as far as later ones need to know of them.

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


class Nouns(Facts):
    """The nouns of one environment.

    Args:
        world: The environment.
        table: The meanings of adjectives and groups.
        grounder: Grounds their conditions.
        guess: Whether likeness of meaning alone may lead from a noun to a thing.
    """

    def __init__(self, world: World, table: GoalTable, grounder: Grounder, *, guess: bool = False) -> None:
        super().__init__(world, table, grounder)
        self.mentions = world.mentions
        self.lexicon = world.mentions.lexicon
        self.guess = guess
        self._having: dict[str, tuple[str, ...]] = {}

    @cached_property
    def places(self) -> frozenset[str]:
        """The constants that are things as objects are: of a type that objects here have as well, as the floor is."""
        types = self.mentions.types
        common = {kind for name in self.world.profiles.objects for kind in types.get(name, ())}
        return frozenset(name for name in self.world.profiles.constants if types.get(name, ("",))[0] in common)

    def is_group(self, noun: str) -> bool:
        """Return whether a noun means all things of some classes."""
        return is_noun(noun, "everything") or noun in self.table.groups or bool(self._group(noun))

    def things(
        self, noun: str, state: Bits, *, place: bool = False, types: tuple[str, ...] | None = None
    ) -> tuple[str, ...]:
        """Return the objects that ``noun`` may mean: the likeliest reading only; never by likeness of meaning alone.

        As a ``place`` a noun is not a group: rubbish goes in the trash, and is not what the trash is. With ``types`` it
        is the likeliest of the readings that fit them.
        """
        if is_noun(noun, "everything") and noun not in self.mentions.kinds.values():
            return self.world.profiles.objects
        head, _, vague = noun.rpartition("_")
        if head and vague in section("vague_heads") and (of_head := self.things(head, state, place=place, types=types)):
            return of_head
        if ends_as(noun, "thing"):  # "flammable things", of whatever class
            return self._all_that_are(split_name(noun)[:-1], Moments(state, state))
        group = self._group(noun) if not (place and noun in self.lexicon.nouns) else ()
        if group:
            return group
        return self._one_thing(noun, state, types)

    def _one_thing(self, noun: str, state: Bits, types: tuple[str, ...] | None) -> tuple[str, ...]:
        ranked = self.mentions.ranked(noun)
        if ranked and ranked[0].name in self.places and ranked[0].how != WORDNET:
            return (ranked[0].name,)  # the floor, which is no substance that things contain
        if not self.guess and all(m.how == WORDNET for m in ranked):
            # what such a likeness contains is no more sure than itself
            return self._called_after(noun) or self._with_part(noun)
        best = self._likeliest(noun, state, types)
        if best is None:
            return ()
        best = self._explained(noun, self._numbered(noun, self._told_apart(noun, best, state)), state)
        return tuple(best) or self._called_after(noun) or (self._siblings(noun) if self.guess else ())

    def _with_part(self, noun: str) -> tuple[str, ...]:
        """Return the things that a part is only told of: rooms, for *doors*, where ``door_open`` is said of rooms."""
        known = self._having.get(noun)
        if known is None:
            known = self._having[noun] = self._told_with_part(noun)
        return known

    def _told_with_part(self, noun: str) -> tuple[str, ...]:
        facts = {
            name: [f for f in self.facts_about(name) if self.tells_of(noun, f, name)]
            for name in self.world.profiles.objects
        }
        having = tuple(n for n, told in facts.items() if any(f.predicate not in self.grounder.changing for f in told))
        having = having or tuple(n for n, told in facts.items() if told)
        owner, _, part = noun.rpartition("_")
        if owner and not having:  # "the attic door"
            having = tuple(m.name for m in self.mentions.ranked(owner) if m.name in self._with_part(part))
        return having

    @cached_property
    def _told(self) -> Mapping[str, frozenset[str]]:
        return told_nouns(self.world.domain)

    def speaks_of(self, predicate: str, noun: str) -> bool:
        """Return whether a predicate, or an action that changes it, has a noun in its name."""
        return split_name(noun)[-1] in words_in_name(predicate) or noun in self._told.get(predicate, ())

    def tells_of(self, noun: str, fact: GroundAtom, name: str) -> bool:
        """Return whether a fact speaks of a part of a thing by its name, or by that of an action."""
        return _tells_of(noun, fact, name) or (len(fact.args) == 1 and noun in self._told.get(fact.predicate, ()))

    def is_only_told_of(self, noun: str) -> bool:
        """Return whether a noun names nothing itself, but a part that facts about other things speak of."""
        return all(m.how == WORDNET for m in self.mentions.ranked(noun)) and bool(self._with_part(noun))

    def _all_that_are(self, adjectives: Sequence[str], moments: Moments) -> tuple[str, ...]:
        objects = self.world.profiles.objects
        return tuple(n for n in objects if all(self.is_so(word, n, moments) for word in adjectives))

    def _group(self, noun: str) -> tuple[str, ...]:
        people = section("people") if is_noun(noun, "people") else frozenset()
        classes = self.table.groups.get(noun, people)
        return tuple(n for n in self.world.profiles.objects if not self._kinds(n).isdisjoint(classes))

    def _explained(self, noun: str, names: Iterable[str], state: Bits) -> list[str]:
        return [name for name in names if self.guess or not self.unexplained(noun, name, state)]

    def _likeliest(self, noun: str, state: Bits, types: tuple[str, ...] | None) -> list[str] | None:
        """Return the objects of the best match; ``None`` where the domain knows that it is nothing that is here."""
        matches = self._matches(noun, state)
        # "crate 1" is crate1, also where another thing of that kind fits better
        whole = bool(matches) and split_name(matches[0].name) == split_name(noun)
        matches = matches if whole and number_in_name(noun) is not None else self._fitting(matches, types)
        best = [m.name for m in matches if (m.score, m.how) == (matches[0].score, matches[0].how)]
        how = matches[0].how if matches else ""
        if how == NAME and not self.guess and self._of_another_class(noun, best):
            return None
        if how == CONTAINED and not self._of_that_kind(noun, self.contents(best[0], state)):
            return None
        return best

    def _fitting(self, matches: list[Match], types: tuple[str, ...] | None) -> list[Match]:
        if types is None:
            return matches
        fitting = [m for m in matches if self.grounder.fits(m.name, types)]
        return [m for m in fitting if self.grounder.is_a(m.name, types)] or fitting or matches

    def _matches(self, noun: str, state: Bits) -> list[Match]:
        return [m for m in self.mentions.of(noun, state) if self.guess or m.how != WORDNET]

    def _numbered(self, noun: str, names: Iterable[str]) -> list[str]:
        """Return the names with the number of a noun, if it has one and they have: *channel 7* is not any channel."""
        wanted = number_in_name(noun)
        numbers = {name: split_name(name)[-1] for name in names}
        if wanted is None or not all(number.isdigit() for number in numbers.values()):
            return list(numbers)
        return [name for name, number in numbers.items() if int(number) == wanted]

    def _of_that_kind(self, noun: str, substances: Iterable[str]) -> bool:
        """Return whether substances are no other kind than said: *raspberry milk* is not milk."""
        kinds = {word for name in self.world.profiles.constants for word in split_name(name)[:-1]}
        told = kinds & set(split_name(noun)[:-1]) if noun not in self.lexicon.nouns else set()
        return not told or any(told <= set(split_name(name)) for name in substances)

    def _of_another_class(self, noun: str, names: Iterable[str]) -> bool:
        """Return whether a class that a noun names has nothing here: a *floor lamp* is not a ceiling lamp."""
        return "_" in noun and noun in self.mentions.classes and not any(noun in self._kinds(name) for name in names)

    def _told_apart(self, noun: str, names: list[str], state: Bits) -> list[str]:
        """Return those of several things that the modifiers of a compound mean: *Ann's bed*, *coffee cup*."""
        modifiers = split_name(noun)[:-1]  # a noun may be no word at all: "é", "²"
        if not modifiers or len(names) < 2:
            return names
        if noun in self.lexicon.nouns:
            return self._aliased(noun, names)
        alike = {word for modifier in modifiers for word in state_words(modifier)}  # the upper drawer is the top one
        called = [n for n in names if any(alike & _words_of_name(kind) for kind in self._kinds(n))]
        return called or self._described(modifiers, names, Moments(state, state))

    def _aliased(self, noun: str, names: list[str]) -> list[str]:
        """Return the things with an alias in their names: ``upper_drawer: [top_drawer]``, cabinet1_top_drawer."""
        aliases = (split_name(alias) for alias in self.lexicon.nouns[noun])
        whole = [set(alias) for alias in aliases if len(alias) > 1]
        return [n for n in names if any(alias <= set(split_name(n)) for alias in whole)] or names

    def _described(self, modifiers: Collection[str], names: list[str], moments: Moments) -> list[str]:
        owners = self._called("_".join(modifiers))
        for word in modifiers:
            said = {name: self.is_so(word, name, moments) for name in names}
            if any(so is not None for so in said.values()):  # "the free hook"
                return [n for n, so in said.items() if so]
        # where names say which one of its kind a thing is ("red_block"), there is no yellow one
        contrary = set(modifiers) & section("keep_adjectives") and all(map(self._modified, names))
        return list(self.related_now(names, "of", owners, moments)) or ([] if contrary else names)

    def unexplained(self, noun: str, name: str, state: Bits) -> list[str]:
        """Return the modifiers of a compound that say nothing of a thing: *tea*, of a jar of coffee.

        A modifier may be a part of its name, the name of its class or whole, something that it holds or may hold, what
        it belongs to, a state that it is in, or the room.
        """
        modifiers = [word for word in split_name(noun)[:-1] if not _says_nothing(word)]
        whole = singular("".join(split_name(noun))) == singular("".join(split_name(name)))  # "Mr Smith" is mrsmith
        if not modifiers or whole or noun in self.mentions.classes or self._is_declared(noun):
            return []
        called = self._words_about(name)
        left = [w for w in modifiers if called.isdisjoint(state_words(w)) and not _is_slip(w, sorted(called))]
        moments = Moments(state, state)
        if left and self._belongs("_".join(left), name, moments):
            return []
        return [w for w in left if not self._is_about(w, name, called, moments)]

    def _is_about(self, modifier: str, name: str, called: Collection[str], moments: Moments) -> bool:
        """Return whether a modifier is a synonym of a word for a thing, or says what it belongs to or how it is."""
        alike = any(same(modifier, other) for other in called)
        if alike or self._belongs(modifier, name, moments):
            return True
        return not self.is_constant(name) and bool(self.is_so(modifier, name, moments))

    def _is_declared(self, noun: str) -> bool:
        """Return whether the lexicon says what a noun means here."""
        return noun in self.lexicon.nouns and any(m.how == ALIAS for m in self.mentions.ranked(noun))

    def _words_about(self, name: str) -> set[str]:
        """Return the words in the names of a thing, of its class, of its whole, and of all that it may hold."""
        held = (a for fact in self.facts_about(name) for a in fact.args if self.is_constant(a))
        kinds = (*self._kinds(name), *self.world.profiles.unit(name), *held)
        return {word for kind in kinds for word in _words_of_name(kind)}

    def _belongs(self, modifier: str, name: str, moments: Moments) -> bool:
        """Return whether a thing holds, may hold or is related to what a modifier names; a substance: comes from it."""
        named = self._called(modifier)
        if self.is_constant(name):
            return any(not self.is_constant(n) or n in self.turns_into(name) for n in named)
        return bool(self.related_now((name,), "of", named, moments))

    def holders(self, noun: str, contents: Iterable[str], moments: Moments) -> tuple[str, ...]:
        """Return of everything that ``noun`` may mean what holds some of ``contents`` now: *the bag of crisps*."""
        names = (m.name for m in self._matches(noun, moments.now))
        return self.related_now(names, "of", tuple(contents), moments)

    def too_few(self, phrase: NounPhrase, substances: Collection[str], state: Bits) -> tuple[str, ...]:
        """Return the things that hold ``substances``, where more were counted: *two eggs*, and there is one."""
        called = [m.name for m in self.mentions.of(phrase.name, state) if m.how == NAME and self.is_supply(m.name)]
        holding = tuple(n for n in called if not set(substances).isdisjoint(self.contents(n, state)))
        return holding if phrase.quantifier is Quantifier.NUMBER and len(holding) < (phrase.number or 1) else ()

    def _siblings(self, noun: str) -> tuple[str, ...]:
        """Return, for a guess, things of the same parent: where there is no kettle, other vessels."""
        declared = {t.name: t.parent for t in self.world.domain.types}
        parents = [declared[name] for name in (noun, *self.lexicon.nouns.get(noun, ())) if name in declared]
        broad = set(declared.values()) - set(declared) | {declared.get(parent, "") for parent in parents}
        return tuple(n for n in self.world.profiles.objects if self._kinds(n).intersection(parents) - broad)

    def _called_after(self, noun: str) -> tuple[str, ...]:
        """Return objects with the noun in their names: *the peas* for ``pea_seeds``, where nothing is a pea.

        Where a compound is a class of the domain its first part alone is none: *coffee* is no coffee table.
        """
        if any(m.how != WORDNET for m in self.mentions.ranked(noun)):
            return ()
        compounds = {kind for kind in self.mentions.classes if noun in split_name(kind)[:-1]}
        named = (n for n in self.world.profiles.objects if noun in split_name(n)[:-1])
        return tuple(n for n in named if compounds.isdisjoint(self._kinds(n)))

    def _kinds(self, name: str) -> frozenset[str]:
        return frozenset((*self.mentions.types.get(name, ()), self.mentions.kinds.get(name, ""), name))

    def constants(self, noun: str, types: tuple[str, ...], state: Bits) -> tuple[str, ...]:
        """Return the constants of ``types`` that ``noun`` may mean, or what the things it names contain at first."""
        ranked = (m for m in self.mentions.ranked(noun) if self.is_constant(m.name))
        fitting = [m for m in ranked if self.grounder.is_a(m.name, types)]
        named = [m.name for m in fitting if m.how == NAME and m.score == fitting[0].score]
        known = named or self._aliases(fitting)
        if known:
            chosen = self._explained(noun, named or self._first_forms(known), state)
            return tuple(self._numbered(noun, chosen)) if self._of_that_kind(noun, known) else ()
        return self.contained(self.things(noun, state), types, state)

    def contained(self, things: Iterable[str], types: tuple[str, ...], state: Bits) -> tuple[str, ...]:
        """Return the constants of some types in some things."""
        inside = (c for thing in things for c in self.contents(thing, state))
        return tuple(dict.fromkeys(c for c in inside if self.grounder.is_a(c, types)))

    def _first_forms(self, constants: list[str]) -> list[str]:
        """Return the constants but for what others of them turn into: noodles, and no cooked ones."""
        later = {other for one in constants for other in self.turns_into(one)}
        return [name for name in constants if name not in later] or constants

    def _aliases(self, matches: Iterable[Match]) -> list[str]:
        return [m.name for m in matches if m.how == ALIAS or (self.guess and m.how == WORDNET)]

    def _called(self, noun: str) -> list[str]:
        """Return what a noun may mean by its name or by the words of the domain."""
        return [m.name for m in self.mentions.ranked(noun) if m.how in (NAME, ALIAS)]

    def substances(self, noun: str) -> tuple[str, ...]:
        """Return all constants that a noun may mean by its name or by the words of the domain."""
        return tuple(
            n for n in dict.fromkeys((*self._called(noun), *self.lexicon.nouns.get(noun, ()))) if self.is_constant(n)
        )

    def narrowed(
        self, names: tuple[str, ...], phrase: NounPhrase, moments: Moments
    ) -> tuple[tuple[str, ...], list[str]]:
        """Return the candidates that adjectives leave, and the adjectives that nothing explains."""
        unknown: list[str] = []
        for word in phrase.attributes:
            said = {name: self.is_so(word, name, moments) for name in names}
            if any(so is not None for so in said.values()):
                names = tuple(n for n in names if said[n])
                names = self._changeable(word, names, moments) if is_noun(phrase.name, "everything") else names
                continue
            named = tuple(n for n in names if word in split_name(n))
            if named or self._contrary(word, names):
                names = named
            elif not is_idle(word):
                unknown.append(word)
        return names, unknown

    def _contrary(self, word: str, names: tuple[str, ...]) -> bool:
        """Return whether names say which one each thing is, so that a word that none has leaves none."""
        return word in section("keep_adjectives") and len(names) > 1 and all(map(self._modified, names))

    def _changeable(self, word: str, names: tuple[str, ...], moments: Moments) -> tuple[str, ...]:
        """Return those that may be otherwise, or of which another one of the class may.

        *Everything that is empty* is not the pillow, which nothing can fill.
        """
        kinds = self.mentions.kinds
        states = {name: self.attribute(word, name, moments) for name in self.world.profiles.objects}
        other = {kinds.get(name, name) for name, f in states.items() if f not in (None, TRUE, FALSE)}
        said = {word, *state_words(word)}

        def stated(name: str) -> bool:
            static = (fact for fact in self.facts_about(name) if fact in self.world.task.static)
            return any(not said.isdisjoint(words_in_name(fact.predicate)) for fact in static)

        kept = tuple(n for n in names if states[n] != TRUE or kinds.get(n, n) in other or stated(n))
        return kept if other else names

    def _modified(self, name: str) -> bool:
        """Return whether the name of an object says which one of its kind it is: ``red_block``."""
        return len([word for word in split_name(name) if not word.isdigit()]) > 1


def _words_of_name(name: str) -> set[str]:
    """Return the words of a name, and the singulars of those that are plurals: a ``chips_packet`` is a chip packet."""
    words = split_name(name)
    return {*words, *map(singular, words)}


def _tells_of(noun: str, fact: GroundAtom, name: str) -> bool:
    """Return whether a fact speaks of a part of a thing: ``door_open``, ``has_door``; ``in_hold`` of what is in it."""
    parts = split_name(fact.predicate)
    words = {singular(word) for word in parts}
    if is_relation(parts[0], "place"):  # "on_table", of one thing, says where it is
        return len(fact.args) == 2 and fact.args[1] == name and words == {parts[0], noun}
    return len(fact.args) == 1 and noun in words and len(words) > 1 and all(map(_is_state, words - {noun}))


def _is_state(word: str) -> bool:
    """Return whether a word beside a noun in the name of a predicate says how that is: ``door_open``, ``bed_made``."""
    listed = words_of("part_states") | section("end_states") | section("drop_adjectives")
    return word in listed or participle(word) is not None


def _says_nothing(word: str) -> bool:
    """Return whether a modifier need not be explained: *nice*, *second*, *kitchen*."""
    return len(word) == 1 or is_idle(word) or word in words_of("ordinals") or word in words_of("rooms")


def _is_slip(word: str, called: Sequence[str]) -> bool:
    """Return whether a word is another one misspelt."""
    return len(word) >= _SLIP_LENGTH and bool(get_close_matches(word, called, 1, _SLIP_RATIO))


def so_many_of(parts: Sequence[Formula], number: int) -> Formula:
    """Return that some number of conditions hold."""
    return disjunction(conjunction(way) for way in islice(combinations(parts, number), _MOST_CHOICES))


def mode_of(phrase: NounPhrase, *, group: bool, thing: bool, place: bool = False) -> tuple[Mode, int]:
    """Return how many are meant: plurals and groups of things mean all of them, unless *some* was said.

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
