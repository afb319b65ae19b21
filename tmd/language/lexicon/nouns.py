"""Things of an environment that a noun may name, with the kind of evidence for each.

The order of evidence is fixed: the thing's own name, an alias of the domain, a synonym in WordNet, similarity in
WordNet, nothing. A weaker kind is only asked where all stronger ones are silent; but where a name agrees only in part,
an alias of the whole noun goes before it. Similarity is that of Wu and Palmer (1994) among WordNet's artifacts, food
and substances, loaded when a noun has to be compared (``experiments.language.rebuild`` writes the file).
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import NamedTuple

from tmd.language.lexicon.lexicon import Lexicon, builtin, data_text, pairs, sections, singular
from tmd.language.lexicon.names import split_name

NAME, ALIAS, WORDNET = "name", "alias", "wordnet"
"""What :attr:`Match.how` can say, strongest first."""

SIMILAR = 0.85
"""Least Wu-Palmer similarity that counts (the value of the original system)."""

_LOOSEST = 0.5
"""Score of a name match by head alone, all modifiers unmatched."""
_ANCESTOR_DECAY = 0.05


@dataclass(frozen=True, slots=True)
class NounMatch:
    """A thing of the environment: an object, a part of one, or a substance.

    Attributes:
        name: Its name in the environment: ``microwave1_door``.
        class_name: Its class.
        ancestors: The classes above, nearest first.
        words: Further words for it: the class of the whole for a part, colours, labels.
    """

    name: str
    class_name: str = ""
    ancestors: tuple[str, ...] = ()
    words: tuple[str, ...] = ()


class Match(NamedTuple):
    """A candidate a noun may name: how sure (0 to 1], and by which kind of evidence."""

    name: str
    score: float
    how: str


@dataclass(frozen=True, slots=True)
class _Noun:
    """A language-object taken apart: head and modifiers, and the number it is called by."""

    head: str
    modifiers: tuple[str, ...]
    number: int | None
    ordinal: bool = False

    @property
    def words(self) -> tuple[str, ...]:
        return (*self.modifiers, self.head)


def rank(
    noun: str,
    candidates: Sequence[NounMatch],
    lexicon: Lexicon | None = None,
    threshold: float = SIMILAR,
) -> list[Match]:
    """Rank the things a noun may name.

    Args:
        noun: A language-object (``fridge_door``, ``burner_3``, ``cups``).
        candidates: What there is.
        lexicon: The domain's words; its ``nouns`` are the aliases.
        threshold: Least WordNet similarity.

    Returns:
        Matches of the strongest kind of evidence that speaks, best first; ties in the order of the
        candidates' names. Empty if the noun names nothing here.
    """
    parsed, aliases = _parse(noun), (lexicon or builtin()).nouns
    named = _only_one_numbered(noun, candidates) or _by_name(parsed, candidates)
    if all(match.score < 1.0 for match in named):
        named = _as_a_whole(noun, parsed, named, candidates, aliases)
    named = named or _by_alias(noun, parsed, candidates, aliases) or _by_synonym(parsed, candidates)
    found = named or _by_wordnet(parsed, candidates, threshold)
    return sorted(_numbered(found, parsed), key=lambda m: (-m.score, _natural(m.name)))


def _as_a_whole(
    noun: str,
    parsed: _Noun,
    named: list[Match],
    candidates: Sequence[NounMatch],
    aliases: Mapping[str, tuple[str, ...]],
) -> list[Match]:
    """Return the matches by an alias or a synonym of the whole noun, which says more than a name with the same head."""
    spelled = {form: aliases[form] for form in _spellings(noun, parsed)[:-1] if form in aliases}
    synonyms = {match.name for match in _by_synonym(parsed, candidates)} if parsed.modifiers else set()
    named = [match for match in named if match.name in synonyms] or named
    return _by_alias(noun, parsed, candidates, spelled) or named


def _only_one_numbered(noun: str, candidates: Sequence[NounMatch]) -> list[Match]:
    """Return the only thing with a number in its name that is called by it: "in 102", of room_102."""
    number = int(noun) if noun.isdecimal() and len(noun) > 1 else None
    found = [c.name for c in candidates if number is not None and _number(c.name) == number]
    return [Match(found[0], 1.0, NAME)] if len(found) == 1 else []


def _natural(name: str) -> tuple[tuple[int, int | str], ...]:
    return tuple((0, int(p)) if p.isdigit() else (1, p) for p in re.split(r"(\d+)", name) if p)


def number_in_name(noun: str) -> int | None:
    """Return the number in the name of a thing: 3 for ``burner_3`` and ``burner_three``, none for ``third_burner``."""
    parsed = _parse(noun)
    return None if parsed.ordinal else parsed.number


def _parse(noun: str) -> _Noun:
    words = list(split_name(singular(noun.lower().replace(" ", "_").replace("-", "_"))))
    number, ordinal = None, False
    if words and words[-1].isdecimal():
        number = int(words.pop())
    elif len(words) > 1 and words[-1] in (numbers := sections()["number_order"]):
        number = numbers.index(words.pop())
    elif len(words) > 1 and words[0] in (ordinals := sections()["ordinal_order"]):
        number, ordinal = ordinals.index(words.pop(0)), True
    words = [singular(w) for w in words] or [noun]
    return _Noun(words[-1], tuple(words[:-1]), number, ordinal)


@lru_cache(maxsize=4096)
def _vocabulary(candidate: NounMatch) -> tuple[tuple[str, ...], ...]:
    """Return the ways to name a candidate, each as its words without numbers, nearest first."""
    names = (candidate.name, candidate.class_name, *candidate.ancestors)
    spelled = [tuple(singular(w) for w in split_name(name) if not w.isdigit()) for name in names]
    return tuple(words for words in spelled if words)


def _by_name(noun: _Noun, candidates: Sequence[NounMatch]) -> list[Match]:
    found = []
    for candidate in candidates:
        score = max(
            (
                _name_score(noun, words, candidate.words) - _ANCESTOR_DECAY * max(0, level - 1)
                for level, words in enumerate(_vocabulary(candidate))
            ),
            default=0.0,
        )
        if score > 0:
            found.append((candidate, score))
    best = max((score for _, score in found), default=0.0)
    # "cup" is the cup, not the cup_holder's cup, where an exact name exists
    kept = [(c, s) for c, s in found if s >= best - 0.25]
    return [Match(c.name, round(s, 4), NAME) for c, s in kept]


def _name_score(noun: _Noun, words: tuple[str, ...], extra: tuple[str, ...]) -> float:
    """Score the words of one name: the head has to agree, modifiers count by share."""
    if "".join(noun.words) == "".join(words):
        return 1.0
    if noun.head != words[-1]:
        return 0.0
    supporting = set(words[:-1]) | {singular(w.lower()) for e in extra for w in split_name(e)}
    wanted = set(noun.modifiers)
    hits = sum(word in supporting or any(same(word, other) for other in supporting) for word in wanted)
    missing, unsaid = len(wanted) - hits, len(set(words[:-1]) - wanted)
    return _LOOSEST + (1 - _LOOSEST) * (1 + 2 * hits) / (1 + 2 * hits + 2 * missing + unsaid) - 0.05


def _numbered(matches: list[Match], noun: _Noun) -> list[Match]:
    """Pick by number: the thing that carries it in its name, else (and for "second") the n-th in order.

    Of two cups none is the third one; a number that no name carries only lowers the scores.
    """
    if not noun.number:
        return matches
    order = sections()["number_order"]
    called = f"{noun.head}{order[noun.number]}" if noun.number < len(order) else noun.head
    carrying = [m for m in matches if _number(m.name) == noun.number or "".join(split_name(m.name)).endswith(called)]
    if carrying and not noun.ordinal:
        return carrying
    ordered = sorted(matches, key=lambda m: (-m.score, _natural(m.name)))
    if noun.number <= len(ordered):
        chosen = ordered[noun.number - 1]
        return [chosen, *(m._replace(score=round(m.score / 2, 4)) for m in ordered if m is not chosen)]
    return [] if noun.ordinal else [m._replace(score=round(m.score / 2, 4)) for m in matches]


def _number(name: str) -> int | None:
    digits = re.findall(r"\d+", name)
    return int(digits[-1]) if digits else None


def _spellings(noun: str, parsed: _Noun) -> list[str]:
    """Return the forms under which a noun may stand in a table: whole, without number, its head."""
    forms = [noun.lower(), singular(noun.lower()), "_".join(parsed.words), parsed.head]
    return list(dict.fromkeys(forms))


def _names(candidate: NounMatch, target: str) -> bool:
    wanted = "".join(split_name(target))
    own = (candidate.name, candidate.class_name, *candidate.ancestors)
    return any("".join(split_name(name)) == wanted for name in own if name)


def _by_alias(
    noun: str, parsed: _Noun, candidates: Sequence[NounMatch], aliases: Mapping[str, tuple[str, ...]]
) -> list[Match]:
    for form in _spellings(noun, parsed):
        found: dict[str, Match] = {}
        for place, target in enumerate(aliases.get(form, ())):
            for candidate in candidates:
                if candidate.name not in found and _names(candidate, target):
                    found[candidate.name] = Match(candidate.name, round(0.9**place, 4), ALIAS)
        if found:
            return list(found.values())
    return []


def _by_synonym(noun: _Noun, candidates: Sequence[NounMatch]) -> list[Match]:
    """Return what a synonym in WordNet names: *couch* is a sofa."""
    said = "_".join(noun.words)
    named = [c for c in candidates if any(same(said, "_".join(words)) for words in _vocabulary(c))]
    return [Match(candidate.name, 1.0, ALIAS) for candidate in named]


def _by_wordnet(noun: _Noun, candidates: Sequence[NounMatch], threshold: float) -> list[Match]:
    whole = "_".join(noun.words)
    word = whole if _senses(whole) else noun.head
    found = []
    for candidate in candidates:
        names = (("_".join(words), words[-1]) for words in _vocabulary(candidate))
        score = max((similarity(word, name if _senses(name) else head) for name, head in names), default=0.0)
        if score >= threshold:
            found.append(Match(candidate.name, round(score, 4), WORDNET))
    return found


_SENSES = 4
"""Rarer senses of a word are not looked at."""
_USUAL = 2
"""Synonyms share one of the first so many senses."""


class _Taxonomy(NamedTuple):
    """Synsets by number, parents before children."""

    parents: list[tuple[int, ...]]
    depth: list[int]
    senses: dict[str, list[tuple[int, int]]]
    """For each noun its senses, the commonest first, with their synsets."""


@cache
def _taxonomy() -> _Taxonomy:
    found = _Taxonomy([], [], {})
    for number, line in enumerate(data_text("wordnet_nouns.txt.gz").split("\n")[:-1]):
        above, _, lemmas = line.partition("\t")
        found.parents.append(tuple(int(p) for p in above.split(",") if p))
        found.depth.append(1 + min((found.depth[p] for p in found.parents[-1]), default=0))
        for word, _, sense in (lemma.rpartition(".") for lemma in lemmas.split()):
            found.senses.setdefault(word, []).append((int(sense), number))
    return found


@cache
def _senses(noun: str) -> list[int]:
    """Return the synsets of a noun, rare senses left out."""
    known = _taxonomy().senses
    found = known.get(noun) or known.get(singular(noun)) or []
    return [synset for sense, synset in sorted(found) if sense <= _SENSES]


@cache
def same(first: str, second: str) -> bool:
    """Return whether two nouns are synonyms: in a usual sense of both in WordNet, or by ``same_things``."""
    joined = pairs("same_things").get(first) == second
    return joined or not {*_senses(first)[:_USUAL]}.isdisjoint(_senses(second)[:_USUAL])


@cache
def similarity(first: str, second: str) -> float:
    """Return the Wu-Palmer similarity of two nouns, 0 to 1: their closest senses; 0 for unknown words.

    ``2 d(lcs) / (d(lcs) + l1 + d(lcs) + l2)`` with the depth ``d`` of the lowest common hypernym and the
    lengths ``l`` of the paths up to it.
    """
    depth, above = _taxonomy().depth, [(_above(a), _above(b)) for a in _senses(first) for b in _senses(second)]
    ways = ((depth[node], up + other[node]) for one, other in above for node, up in one.items() if node in other)
    return max((2 * deep / (2 * deep + steps) for deep, steps in ways), default=0.0)


@cache
def _above(number: int) -> dict[int, int]:
    """Return every hypernym of a synset with its distance, itself included."""
    distance, frontier = {number: 0}, [number]
    for node in frontier:  # grows while it is read
        for parent in _taxonomy().parents[node]:
            if parent not in distance:
                distance[parent] = distance[node] + 1
                frontier.append(parent)
    return distance
