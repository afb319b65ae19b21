"""The English that goal reading knows, as sections of data files.

A section is a list of words or a table of ``key: words``. ``data/words.txt`` of this package has prepositions, classes
of verbs, relations and nouns; ``senses.txt`` of :mod:`tmd.language` has what verbs and adjectives have in common.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache
from importlib.resources import files

from tmd.language.clause import NEGATED as NEGATED
from tmd.language.lexicon.lexicon import data_text, pairs

CONTRARY = "-"
"""The mark of a word for the contrary, in ``senses.txt``."""
_OTHER_WAY = ">"
"""The mark of one way of doing what a verb says, in ``senses.txt``."""
_MORE = "<"
"""The mark of a verb that says more, in ``senses.txt``."""
_NEAR = 4
"""The first so many members of a family ask for the same as each other."""


@cache
def _sections() -> Mapping[str, tuple[str, ...]]:
    found: dict[str, list[str]] = {}
    current: list[str] = []
    own = (files(__package__) / "data" / "words.txt").read_text("utf-8")
    for line in f"{data_text('senses.txt')}\n{own}".splitlines():
        if line.startswith("["):
            current = found.setdefault(line.strip("[]"), [])
        elif line and not line.startswith("#"):
            current.append(line)
    return {name: tuple(lines) for name, lines in found.items()}


@cache
def table(section: str) -> Mapping[str, tuple[str, ...]]:
    """Return a section of ``key: words``, in the order of the file."""
    lines = (line.partition(":") for line in _sections()[section])
    return {name.strip(): tuple(words.split()) for name, _, words in lines}


@cache
def words_of(section: str, key: str = "") -> frozenset[str]:
    """Return the words of a plain section, or those of one row of a table."""
    return (
        frozenset(table(section)[key]) if key else frozenset(w for line in _sections()[section] for w in line.split())
    )


PREPOSITIONS: Mapping[str, tuple[str, ...]] = table("prepositions")
"""Each preposition of a pattern, with the words that it stands for; the first is the most usual."""


def ranked(section: str, key: str) -> tuple[str, ...]:
    """Return the words of a row of a table, in their order."""
    return tuple(table(section)[key])


def the_word(section: str, key: str) -> str:
    """Return the only word of a row of a table."""
    return table(section)[key][0]


BE: str = the_word("verbs", "state")
ONE: str = the_word("nouns", "one")
IT: str = the_word("nouns", "it")
SETTING: str = the_word("relations", "setting")
"""The relation of a setting: *to low*."""


def is_relation(word: str, kind: str) -> bool:
    """Return whether a relation is of a class of the section ``relations``."""
    return word in words_of("relations", kind)


@cache
def is_unknown_relation(word: str) -> bool:
    """Return whether a relation is of no class: an unknown place, such as ``to_the_left_of``."""
    known = {
        *table("inverse"),
        *(w for name in ("prepositions", "relations") for row in table(name).values() for w in row),
    }
    return word not in known


def is_verb(verb: str, kind: str) -> bool:
    """Return whether a verb is of a class of the section ``verbs``."""
    return verb in words_of("verbs", kind)


def is_condition(word: str, kind: str) -> bool:
    """Return whether a word that opens a condition is of a class of the section ``conditions``."""
    return word in words_of("conditions", kind)


def is_noun(noun: str, kind: str) -> bool:
    """Return whether a noun is of a class of the section ``nouns``."""
    return noun in words_of("nouns", kind)


def is_idle(adjective: str) -> bool:
    """Return whether an adjective never tells which thing is meant: *a nice cup*, *only the cup*."""
    return adjective in words_of("idle_adjectives")


def position(noun: str) -> int | None:
    """Return which of what was spoken of *the first one* or *the latter* is; ``None`` for other nouns."""
    place = pairs("places_in_order").get(noun.removesuffix(f"_{ONE}")) if is_one(noun) else None
    return int(place) if place is not None else None


def is_one(noun: str) -> bool:
    """Return whether a noun is *one*, or *red_one*: one of what was spoken of."""
    return noun == ONE or noun.endswith(f"_{ONE}")


def is_pronoun(noun: str) -> bool:
    """Return whether a noun stands for something that was said before."""
    return is_noun(noun, "pronouns") or is_one(noun)


def ends_as(word: str, kind: str) -> bool:
    """Return whether a word ends as a row of the section ``endings`` says."""
    return word.endswith(table("endings")[kind])


def relations_said(relation: str, allowed: tuple[str, ...]) -> tuple[str, ...]:
    """Return the prepositions of a pattern that a relation stands for; *to* and *at* leave open which."""
    exact = tuple(p for p in allowed if relation in PREPOSITIONS[p])
    leaves_open = not exact and is_relation(relation, "open")
    return tuple(p for p in allowed if is_relation(p, "resting")) if leaves_open else exact


@cache
def family(verb: str) -> tuple[str, ...]:
    """Return verbs that ask for the same as ``verb``, nearest first: its own family, then the families it stands in.

    A member with a ``>`` is one way of doing it: to cook may be to fry, but to fry is not just to cook. One with a
    ``<`` says more: to toss is to put, but to put is not to toss.
    """
    families = table("families")
    wide = [(head, members) for head, members in families.items() if verb in members or _MORE + verb in members]
    heads = [head for head, _ in wide]
    alike = (member for _, members in wide for member in members[:_NEAR])
    found = dict.fromkeys((*_not_more(families.get(verb, ())), *heads, *_not_more(alike)))
    found.pop(verb, None)
    return tuple(found)


def _not_more(members: Iterable[str]) -> list[str]:
    return [member.removeprefix(_OTHER_WAY) for member in members if not member.startswith(_MORE)]


def results(verb: str) -> tuple[str, ...]:
    """Return words for the state that ``verb`` leaves its object in; those with a minus are taken away."""
    return table("results").get(verb, ())


def state_words(adjective: str) -> tuple[str, ...]:
    """Return words that say the same as ``adjective``, itself first; those with a minus say the contrary."""
    return tuple(dict.fromkeys((adjective, *table("states").get(adjective, ()))))
