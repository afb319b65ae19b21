"""The words the parser knows: own lists, word forms, WordNet's verbs behind them, and what a domain adds.

A domain's ``lexicon.yaml`` is read by :mod:`tmd.language.lexicon.file`.
"""

from __future__ import annotations

import difflib
import gzip
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property, lru_cache
from importlib.resources import files

from tmd.diagnostics import Location
from tmd.short_repr import short_repr

TYPO_LENGTH = 4
"""Shorter words are never corrected."""
_TYPO_RATIO = 0.83
"""Least :func:`difflib.SequenceMatcher.ratio` of a correction."""
_NOUN_TYPO_RATIO = 0.8
"""The same where a noun of the domain may be meant: one wrong letter of five."""
_DOER_TYPO_RATIO = 0.9
"""The same where the word could be made of a known one with -er: one letter more or less, of six."""


@cache
def _wordnet_verbs() -> tuple[Mapping[str, str], dict[str, str], frozenset[str]]:
    """Return (stem -> flag, irregular form -> stem, verbs with a particle)."""
    flags: dict[str, str] = {}
    irregular: dict[str, str] = {}
    phrasal = set()
    for line in data_text("wordnet_verbs.txt").splitlines():
        if line.startswith("#"):
            continue
        head, *rest = line.split()
        if "_" in head:
            phrasal.add(head)
        else:
            flags[head] = rest[0]
            for form in rest[1:]:
                irregular.setdefault(form, head)
    return flags, irregular, frozenset(phrasal)


@cache
def _english() -> frozenset[str]:
    return frozenset(data_text("wordnet_words.txt.gz").split())


@cache
def compound_nouns() -> frozenset[str]:
    """Return the things that WordNet knows by several words: ``sports_car``."""
    words = (word.rpartition(".")[0] for word in data_text("wordnet_nouns.txt.gz").split())
    return frozenset(word for word in words if "_" in word)


@short_repr(lambda declared: f"{declared.pattern}: {declared.condition}")
@dataclass(frozen=True, slots=True)
class Declared:
    """A pattern or an adjective with the PDDL condition that it was given, as written, and its place."""

    pattern: str
    condition: str
    location: Location | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class SharedPredicate:
    """A predicate in the rows of a base lexicon, with the conditions that may express it in a domain.

    Attributes:
        name: Its name: ``held``.
        terms: Its arguments: variables, or names that must be given just so.
        forms: The conditions, tried in this order; the first one that a domain has the predicates for is used.
        location: The place at which it was declared.
    """

    name: str
    terms: tuple[str, ...]
    forms: tuple[Declared, ...]
    location: Location | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Base:
    """Meanings that a lexicon takes from the base lexicons it includes (:mod:`tmd.goals.tables`).

    Attributes:
        goals: Rows over shared predicates.
        attributes: Adjectives over shared predicates.
        predicates: The shared predicates, those of the lexicon itself first.
        types: For a type that the rows name, the types that may be it in a domain; those of the lexicon itself first.
        place: Before which of the rows of the lexicon these rows are tried; behind all where it is ``None``.
        restored: As for :class:`Lexicon`, over shared predicates.
    """

    goals: tuple[Declared, ...] = ()
    attributes: tuple[Declared, ...] = ()
    predicates: tuple[SharedPredicate, ...] = ()
    types: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    place: int | None = None
    restored: tuple[Declared, ...] = ()


@dataclass(frozen=True, slots=True)
class PhraseRow:
    """A turn of phrase with plainer words (:mod:`tmd.language.syntax.phrases`).

    Attributes:
        id: Its name.
        pattern: The compiled pattern, over ``word<tab>CLASS`` and a blank for each token.
        triggers: Words of which the sentence must have one; empty if it must have none.
        replacement: The elements of the replacement, each with the name that it says again, if it does.
        verbs: Names of kept words of which the verb is wanted.
        deeds: Those of them that must be something to be done here.
        note: Why the words that disappear ask for nothing; empty where they do.
        examples: Sentences on which it must fire, each with its place.
    """

    id: str
    pattern: re.Pattern[str]
    triggers: frozenset[str]
    replacement: tuple[tuple[str, str], ...]
    verbs: frozenset[str]
    deeds: frozenset[str]
    note: str
    examples: tuple[tuple[str, Location], ...]


@short_repr(lambda lexicon: f"of {len(lexicon.verbs)} verb(s), {len(lexicon.nouns)} noun(s)")
@dataclass(frozen=True, eq=False)
class Lexicon:
    """Built-in words plus those of a domain.

    Attributes:
        verbs: Further verbs.
        phrasal: Further verbs with a particle, each with the verb it means (``turn_on`` itself, or
            another): ``{"fire_up": "turn_on"}``.
        nouns: What a noun may mean here: names of classes, objects or substances, likeliest first.
        verb_synonyms: Verb to the verb whose templates serve it as well.
        goals: What verbs with their slots mean, as conditions of the domain (:mod:`tmd.goals.sources.table`).
        attributes: What adjectives mean, as conditions of ``?x``.
        groups: Nouns that mean all things of some classes: ``{"rubbish": ("wrapper", "can")}``.
        restored: Conditions of ``?x`` that no plan leaves behind unless the request asks for them; ``None`` where the
            base lexicons say it.
        source: The file it came from.
        base: What verbs and adjectives mean by the base lexicons that it includes.
        included: The files of these base lexicons, in order.
        places: Where a word of a section was declared: ``("verb_synonyms", "get")``.
        names: The words in names of types and constants of the domain that are long enough for slips.
        kinds: Last words of names of types and constants of the domain: nouns, even if they are verbs as well.
        compounds: Such names with a particle inside: their words together are one noun ("the volume down button").
        phrases: Turns of phrase of the domain.
    """

    verbs: frozenset[str] = frozenset()
    phrasal: Mapping[str, str] = field(default_factory=dict)
    nouns: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    verb_synonyms: Mapping[str, str] = field(default_factory=dict)
    goals: tuple[Declared, ...] = ()
    attributes: tuple[Declared, ...] = ()
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    restored: tuple[Declared, ...] | None = None
    source: str = ""
    base: Base = field(default_factory=Base)
    included: tuple[str, ...] = ()
    places: Mapping[tuple[str, str], Location] = field(default_factory=dict)
    names: frozenset[str] = frozenset()
    kinds: frozenset[str] = frozenset()
    compounds: frozenset[tuple[str, ...]] = frozenset()
    phrases: tuple[PhraseRow, ...] = ()

    def canonical_verb(self, verb: str) -> str:
        """Return the verb whose templates serve ``verb``: itself unless the domain names a synonym."""
        return self.verb_synonyms.get(verb, self.phrasal.get(verb, verb))

    def names_thing(self, word: str) -> bool:
        """Return whether the domain has things of that name."""
        return word in self.kinds or word in self.nouns or word in self.groups

    @cached_property
    def goal_verbs(self) -> frozenset[str]:
        """The verbs that have a declared meaning."""
        rows = (*self.goals, *self.base.goals)
        return frozenset(verb for row in rows for verb in row.pattern.partition(" ")[0].split("|"))

    def is_deed(self, verb: str) -> bool:
        """Return whether a noun means what is done to a thing ("a wash"): as a verb it is known, and as a thing not."""
        doable = verb in section("treatments") or verb in self.verbs or verb in self.goal_verbs
        return doable and not self.names_thing(verb)

    def own(self, section: str, word: str) -> bool:
        """Return whether the file itself, and no base lexicon, declares a word of a section."""
        place = self.places.get((section, word))
        return place is None or place.file == self.source

    @cached_property
    def _own_verbs(self) -> frozenset[str]:
        named = {verb.partition("_")[0] for verb in self.goal_verbs}
        return section("verbs") | section("noun_verbs") | section("lead_verbs") | self.verbs | named

    @cached_property
    def _own_nouns(self) -> frozenset[str]:
        heads = {part for noun in (*self.nouns, *self.groups) for part in (noun, noun.rpartition("_")[2])}
        return section("nouns") | frozenset(heads) | self.kinds

    @cached_property
    def _phrasal(self) -> Mapping[str, bool]:
        """Verb with particle -> whether the particle is one even before a noun."""
        moving = section("intransitive") | section("chain_verbs")
        table = {name: False for name in _wordnet_verbs()[2] if name.partition("_")[0] not in moving}
        table.update((entry.rstrip("!"), entry.endswith("!")) for entry in sections()["phrasal"])
        table.update((name, table.get(name, False)) for name in self.goal_verbs if "_" in name)
        table.update((name, True) for name in self.phrasal)
        return table

    @lru_cache(maxsize=1 << 14)  # noqa: B019 - there are few lexicons, and they stay
    def verb(self, word: str) -> tuple[str, str, int] | None:
        """Return (stem, form, strength) if a word can be a verb.

        Strength 3 is a verb of the own list, 2 one that is a noun as well, 1 more often a noun.
        """
        if word in pairs("spellings"):
            return pairs("spellings")[word], "base", 3
        listed = _wordnet_verbs()[0]
        found = self._stem(word)
        if found is None:
            return self._undoing(word)
        stem, form = found
        noun = singular(word) in self._own_nouns or stem in self._own_nouns
        if stem in self.verbs:
            return stem, form, 2 if noun and form == "base" else 3
        if stem in section("noun_verbs") or (word in section("keep_adjectives") and stem not in section("verbs")):
            return stem, form, 1
        if stem in section("verbs"):
            return stem, form, 2 if noun else 3
        return stem, form, 1 if noun or listed.get(stem) == "nv" else 2

    def _stem(self, word: str) -> tuple[str, str] | None:
        """Return the stem and the form of a verb of the own list or of WordNet."""
        listed, irregular, _ = _wordnet_verbs()
        return verb_stem(word, lambda verb: verb in self._own_verbs or verb in listed, irregular)

    def _undoing(self, word: str) -> tuple[str, str, int] | None:
        """Return a verb with a prefix that undoes it: "unmute"; "unwashed" is an adjective."""
        return next(((prefix + stem, form, 2) for prefix, stem, form in self._undone(word) if form != "ed"), None)

    def is_undone(self, word: str) -> bool:
        """Return whether a word says that something has not been done, or is not so any more: "unweighed"."""
        return any(form == "ed" for _, _, form in self._undone(word))

    def _undone(self, word: str) -> Iterator[tuple[str, str, str]]:
        """Yield prefixes that undo what the rest of a word says, with the stem and the form of that verb."""
        for prefix in filter(word.startswith, sorted(section("undoing"))):
            found = self._stem(word.removeprefix(prefix))
            if found is not None:
                yield prefix, *found

    def particle(self, stem: str, particle: str) -> bool | None:
        """Return whether verb and particle belong together; ``True`` even before a noun, ``None`` not at all."""
        return self._phrasal.get(f"{stem}_{particle}")

    @lru_cache(maxsize=1 << 14)  # noqa: B019 - there are few lexicons, and they stay
    def is_noun(self, word: str) -> bool:
        """Return whether the own lists or the domain know a noun, in any number."""
        return word in self._own_nouns or singular(word) in self._own_nouns

    def knows(self, word: str) -> bool:
        """Return whether a word is in any list, WordNet's included."""
        return (
            not _closed_words().isdisjoint((word, singular(word), positive(word)))
            or not _english().isdisjoint((word, singular(word)))
            or self.is_noun(word)
            or self.verb(word) is not None
            or not section("drop_adjectives").isdisjoint(comparative_root(word))
            or self._is_doer(word)
        )

    def is_part(self, word: str) -> bool:
        """Return whether a word may be part of a joined name: of two letters, only function words are."""
        if word in section("affixes"):
            return False
        return word in _closed_words() or (len(word) > 2 and self.knows(word) and (len(word) > 3 or word in _english()))

    def _is_doer(self, word: str) -> bool:
        """Return whether a word is made of a known one with -er."""
        return word.endswith("er") and word[:-2] in self._own_nouns | self._own_verbs

    @lru_cache(maxsize=1 << 14)  # noqa: B019 - there are few lexicons, and they stay
    def correct(self, word: str) -> str | None:
        """Return the known word that a typo was meant to be, or ``None``.

        Only words that are in no list are corrected, and only to a word with the same first letter that is
        alike enough (:data:`_TYPO_RATIO`).
        """
        if len(word) < TYPO_LENGTH:
            return None
        group = self._by_initial.get(word[0], ())
        if self.knows(word):
            return self._doer_slip(word, group)
        # each pair of neighbouring letters changed, but for the first
        swaps = {word[:i] + word[i + 1] + word[i] + word[i + 2 :] for i in range(1, len(word) - 1)}
        if swapped := swaps.intersection(group):
            return min(swapped)
        if word.endswith("s") and not word.endswith("ss") and (stem := self.correct(word[:-1])):
            return stem + ("es" if stem.endswith("s") else "s")
        if (named := self._named_by(word)) is not None:
            return named
        if swapped := swaps & _english():
            return min(swapped)
        nouns = sorted(self._own_nouns.intersection(group))
        near = difflib.get_close_matches(word, group, 1, _TYPO_RATIO)
        near = near or difflib.get_close_matches(word, nouns, 1, _NOUN_TYPO_RATIO)
        # "soapy" is not a slip of "soap": letters get lost at the end, endings are not made up
        return near[0] if near and not word.startswith(near[0]) else None

    def _named_by(self, word: str) -> str | None:
        """Return the word in a name of the domain that a word of no list is a slip of, or the beginning of."""
        alike = sorted(name for name in self.names if name[0] == word[0])
        begun = [name for name in alike if name.startswith(word)]
        near = difflib.get_close_matches(word, alike, 1, _NOUN_TYPO_RATIO)
        return begun[0] if len(begun) == 1 else next(iter(near), None)

    def _doer_slip(self, word: str, group: tuple[str, ...]) -> str | None:
        """Return the noun meant by a word that is known only by its ending -er: "wraper" is a wrapper."""
        if not self._is_doer(word) or self.is_noun(word) or word in _english():
            return None
        nouns = sorted(self._own_nouns.intersection(group))
        return next(iter(difflib.get_close_matches(word, nouns, 1, _DOER_TYPO_RATIO)), None)

    @cached_property
    def _by_initial(self) -> Mapping[str, tuple[str, ...]]:
        table: dict[str, list[str]] = {}
        listed = (section(name) for name in sections()["correctable"])
        words = self._own_nouns.union(self.verbs, *listed)
        for word in sorted(words):
            if "_" not in word and len(word) >= TYPO_LENGTH:
                table.setdefault(word[0], []).append(word)
        return {initial: tuple(group) for initial, group in table.items()}


@cache
def _closed_words() -> frozenset[str]:
    return frozenset().union(*(section(name) for name in sections()["closed"]))


@cache
def builtin() -> Lexicon:
    """Return the lexicon without a domain."""
    return Lexicon()


def data_text(name: str) -> str:
    """Return a data file of the language package as text; ``.gz`` is unpacked."""
    raw = (files("tmd.language") / "data" / name).read_bytes()
    return (gzip.decompress(raw) if name.endswith(".gz") else raw).decode("utf-8")


@cache
def sections() -> Mapping[str, tuple[str, ...]]:
    """Return every section of ``data/words.txt`` in the order of the file."""
    found: dict[str, list[str]] = {}
    current: list[str] = []
    for line in data_text("words.txt").splitlines():
        if line.startswith("["):
            current = found.setdefault(line.strip("[]"), [])
        elif not line.startswith("#"):
            current.extend(line.split())
    return {name: tuple(words) for name, words in found.items()}


@cache
def section(name: str) -> frozenset[str]:
    """Return one section of ``data/words.txt``."""
    return frozenset(sections()[name])


def first_of(name: str) -> str:
    """Return the first word of a section of ``data/words.txt``, which represents the others."""
    return sections()[name][0]


def sections_of(word: str) -> frozenset[str]:
    """Return the names of the sections of ``data/words.txt`` that have a word."""
    return _by_word().get(word, frozenset())


@cache
def _by_word() -> Mapping[str, frozenset[str]]:
    found: dict[str, set[str]] = {}
    for name, words in sections().items():
        for word in words:
            found.setdefault(word, set()).add(name)
    return {word: frozenset(names) for word, names in found.items()}


@cache
def pairs(name: str) -> Mapping[str, str]:
    """Return a section whose entries are "this=that"."""
    return dict(entry.split("=") for entry in sections()[name])


_VOWELS = "aeiou"
# Endings of word forms, each with the ending of the word that they are made of; of plurals and superlatives the first
# row that fits counts.
_PLURALS = (
    (r"(.*(?:kn|w)i)ves", r"\1fe"), (r"(.*(?:shel|scar|loa|wol|thie))ves", r"\1f"), (r"(.{2,})ies", r"\1y"),
    (r"(.*(?:ss|sh|ch|x|zz))es", r"\1"), (r"(.*)s", r"\1"),
)  # fmt: skip
_SUPERLATIVES = ((r"(.{2,})iest", r"\1y"), (r"(.+([^ls]))\2est", r"\1"), (r"(.{3,})est", r"\1"))
_VERB_FORMS = (
    (r"(.{2,})ie(s)", r"\1y"), (r"(.*)e(s)", r"\1"), (r"(.*[^s])(s)", r"\1"), (r"(.+)i(ed)", r"\1y"),
    (r"(.*([^aeiouls]))\2(ing|ed)", r"\1"), (r"(.{2,})(ing|ed)", r"\1e"), (r"(.{2,})(ing|ed)", r"\1"),
    (r"(.*(.))\2(ing|ed)", r"\1"),
)  # fmt: skip


def _respelled(word: str, rows: Iterable[tuple[str, str]]) -> Iterator[tuple[str, str]]:
    """Yield a word with another ending for each row that fits, and the last part of the old ending."""
    matches = ((re.fullmatch(form, word), ending) for form, ending in rows)
    return ((match.expand(ending), match[match.re.groups]) for match, ending in matches if match)


@lru_cache(maxsize=1 << 14)
def singular(noun: str) -> str:
    """Return the singular of the last part of a noun: ``raspberry_syrups`` gives ``raspberry_syrup``."""
    front, joint, head = noun.rpartition("_")
    unchanged = head in section("invariant") or len(head) < 3 or head.endswith(("ss", "us", "is"))
    regular = head if unchanged else next(_respelled(head, _PLURALS), (head,))[0]
    return front + joint + pairs("irregular_plurals").get(head, regular)


def positive(word: str) -> str:
    """Return the adjective of a superlative: ``biggest`` gives ``big``; other words stay."""
    return next(_respelled(word, _SUPERLATIVES), (word,))[0]


def comparative_root(word: str) -> tuple[str, ...]:
    """Return the adjectives that a comparative may come from: ``louder`` gives ``loud`` and ``loude``."""
    if not word.endswith("er") or len(word) < 5:
        return ()
    root = word[:-2]
    undoubled = (root[:-1],) if root[-1] == root[-2] else ()
    return (f"{root[:-1]}y",) if root.endswith("i") else (root, f"{root}e", *undoubled)


def verb_candidates(word: str) -> Iterator[tuple[str, str]]:
    """Yield (stem, form) guesses for a regular verb form, best first."""
    yield word, "base"
    yield from _respelled(word, _VERB_FORMS)


def verb_stem(word: str, known: Callable[[str], bool], irregular: dict[str, str]) -> tuple[str, str] | None:
    """Return (stem, form) of a word if it is a form of a known verb."""
    if known(word):
        return word, "base"
    if word in irregular:
        return irregular[word], "ing" if word.endswith("ing") else "ed"
    for stem, form in verb_candidates(word):
        # "bathing" is of "bathe", "heating" of "heat": the bare root wins where both are verbs, unless it is short and
        # ends in a consonant ("us")
        root = stem[:-1]
        if form in ("ed", "ing") and stem.endswith("e") and known(root) and (len(root) > 3 or root[-1] in _VOWELS):
            return root, form
        if known(stem):
            return stem, form
    return None
