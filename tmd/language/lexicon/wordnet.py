"""WordNet's artifacts, food and substances: how alike two nouns are (Wu and Palmer, 1994).

Loaded only when a noun has to be compared; the data file is written by ``data/rebuild.py``.
"""

from __future__ import annotations

from functools import cache

from tmd.language.lexicon.morphology import singular
from tmd.language.lexicon.word_lists import data_text


class _Taxonomy:
    """Synsets by number, parents before children."""

    def __init__(self, lines: list[str]) -> None:
        self.parents: list[tuple[int, ...]] = []
        self.depth: list[int] = []
        self.senses: dict[str, list[tuple[int, int]]] = {}
        for number, line in enumerate(lines):
            above, _, lemmas = line.partition("\t")
            parents = tuple(int(p) for p in above.split(",") if p)
            self.parents.append(parents)
            self.depth.append(1 + min((self.depth[p] for p in parents), default=0))
            for lemma in lemmas.split():
                word, _, sense = lemma.rpartition(".")
                self.senses.setdefault(word, []).append((int(sense), number))
        for senses in self.senses.values():
            senses.sort()

    def ancestors(self, number: int) -> dict[int, int]:
        """Return every hypernym with its distance, the synset itself included."""
        distance, frontier = {number: 0}, [number]
        while frontier:
            following = []
            for node in frontier:
                for parent in self.parents[node]:
                    if parent not in distance:
                        distance[parent] = distance[node] + 1
                        following.append(parent)
            frontier = following
        return distance


@cache
def _taxonomy() -> _Taxonomy:
    return _Taxonomy(data_text("wordnet_nouns.txt.gz").split("\n")[:-1])


_SENSES = 4
"""Rarer senses of a word are not looked at."""


def known(noun: str) -> bool:
    """Tell whether WordNet's subset has a noun."""
    return bool(_senses(noun))


@cache
def _senses(noun: str) -> list[tuple[int, int]]:
    taxonomy = _taxonomy()
    found = taxonomy.senses.get(noun) or taxonomy.senses.get(singular(noun)) or []
    return [pair for pair in found if pair[0] <= _SENSES]


@cache
def similarity(first: str, second: str) -> float:
    """Return the Wu-Palmer similarity of two nouns, 0 to 1: their closest senses; 0 for unknown words.

    ``2 d(lcs) / (d(lcs) + l1 + d(lcs) + l2)`` with the depth ``d`` of the lowest common hypernym and the
    lengths ``l`` of the paths up to it.
    """
    taxonomy = _taxonomy()
    best = 0.0
    for _, one in _senses(first):
        for _, other in _senses(second):
            best = max(best, _wu_palmer(taxonomy, _above(one), _above(other)))
    return best


@cache
def _above(number: int) -> dict[int, int]:
    return _taxonomy().ancestors(number)


def _wu_palmer(taxonomy: _Taxonomy, first: dict[int, int], second: dict[int, int]) -> float:
    best = 0.0
    for node, up in first.items():
        if node in second:
            depth = taxonomy.depth[node]
            best = max(best, 2 * depth / (2 * depth + up + second[node]))
    return best
