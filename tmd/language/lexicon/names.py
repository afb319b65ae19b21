"""Words in the names of objects, types, predicates and actions."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

from tmd.language.lexicon.lexicon import Lexicon, builtin, compound_nouns, section

_CAMEL = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
# A shorter name is a word or an abbreviation; a word in it has two letters or more ("robotat").
_JOINED_LENGTH = 6
_SHORTEST_WORD = 2
_MOST_WORDS = 5
# A word of this strength (:meth:`Lexicon.verb`) is an instruction rather than the first word of a name.
_SURE = 3


@lru_cache(maxsize=4096)
def split_name(name: str) -> tuple[str, ...]:
    """Return the words of a name: ``TvRemote_1`` gives ``("tv", "remote", "1")``; of what has none, itself.

    PDDL ignores case, so that a name written ``RedBike`` arrives as ``redbike``: it is taken apart into known words.
    """
    parts = (part.lower() for part in _CAMEL.findall(name))
    return tuple(word for part in parts for word in _joined_words(part)) or (name.lower(),)


@lru_cache(maxsize=4096)
def _joined_words(name: str) -> tuple[str, ...]:
    """Return the words that a name without separators is made of, or the name itself.

    Of several ways, the fewest words win, and among those a compound noun of WordNet ("sportscar"), then one that ends
    in a preposition ("planeat"), and then the one whose shortest word is the longest.
    """
    words = builtin()
    if (len(name) < _JOINED_LENGTH and not _is_short_sentence(name, words)) or not name.isalpha() or words.knows(name):
        return (name,)
    ends = section("short_places")
    for count in range(2, _MOST_WORDS + 1):
        found = _ways(name, count, words)
        if found:
            compounds = compound_nouns() if len(found) > 1 else ()
            return max(
                found,
                key=lambda way: ("_".join(way) in compounds, way[-1] in ends, min(map(len, way)), tuple(map(len, way))),
            )
    return (name,)


def _ways(name: str, count: int, words: Lexicon) -> list[tuple[str, ...]]:
    """Return the ways to read a name as so many known words."""
    if count == 1:
        return [(name,)] if words.is_part(name) else []
    cuts = range(_SHORTEST_WORD, len(name) - _SHORTEST_WORD + 1)
    firsts = [cut for cut in cuts if words.is_part(name[:cut])]
    return [(name[:cut], *rest) for cut in firsts for rest in _ways(name[cut:], count - 1, words)]


def _is_short_sentence(name: str, words: Lexicon) -> bool:
    """Return whether a short name ends in a preposition, or begins with a form of *be* or *have*: ``iswet``."""
    placed = any(name.endswith(place) and words.is_part(name.removesuffix(place)) for place in section("short_places"))
    leads = (*section("be"), *section("having"))
    return placed or any(name.startswith(lead) and words.is_part(name.removeprefix(lead)) for lead in leads)


def words_in_name(name: str) -> frozenset[str]:
    """Return the words of a name and every run of them: ``switched-on`` has *switched*, *on* and *switched_on*."""
    parts = split_name(name)
    ends = range(1, len(parts) + 1)
    return frozenset({name, *("_".join(parts[begin:end]) for end in ends for begin in range(end))})


def states_in_name(name: str) -> frozenset[str]:
    """Return the words of a name that may say how something is: ``lights_on`` has *on*, and ``on_shelf`` has not."""
    places = section("particles").intersection(split_name(name)[:-1])
    return words_in_name(name) - places


def with_names(lexicon: Lexicon, objects: Sequence[str], actions: Sequence[str]) -> Lexicon:
    """Return a lexicon with the names of a world.

    All words of an object's name are one noun ("blood sample 1"). The first word of an action's name is a verb, with
    its particle ("pump up").
    """
    parts = [words for name in objects if (words := tuple(word for word in split_name(name) if word.isalpha()))]
    doing = [words for words in map(split_name, actions) if len(words) == 1 or _is_verb(lexicon, words[0])]
    phrasal = ("_".join(words[:2]) for words in doing if not section("particles").isdisjoint(words[1:2]))
    compounds = {words for words in parts if _is_compound(lexicon, words)}
    return replace(
        lexicon,
        compounds=lexicon.compounds | compounds,
        kinds=lexicon.kinds | ({words[-1] for words in parts} - section("static")),
        verbs=lexicon.verbs | {words[0] for words in doing},
        phrasal={name: name for name in sorted(phrasal)} | dict(lexicon.phrasal),
    )


def _is_compound(lexicon: Lexicon, words: tuple[str, ...]) -> bool:
    """Return whether the words of an object's name are one noun, and the first no instruction."""
    return len(words) > 1 and _reading(lexicon, words)[2] < _SURE


def _is_verb(lexicon: Lexicon, word: str) -> bool:
    """Return whether a word is the base form of a verb, by itself or joined with its particle: "backup"."""
    stems = (word.removesuffix(particle) for particle in section("particles") if word.endswith(particle))
    return any(stem and _reading(lexicon, (stem,))[:2] == (stem, "base") for stem in (word, *stems))


def _reading(lexicon: Lexicon, words: Sequence[str]) -> tuple[str, str, int]:
    """Return the first of some words as a verb; no stem where it is none."""
    return lexicon.verb(words[0]) or ("", "", 0)
