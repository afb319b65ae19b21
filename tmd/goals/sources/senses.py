"""What English says whatever the domain: families of verbs, the states that verbs lead to, and some nouns.

The lists are in ``tmd/language/data/senses.txt``.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from tmd.language.lexicon.word_lists import data_text


@cache
def _sections() -> Mapping[str, tuple[str, ...]]:
    found: dict[str, list[str]] = {}
    current: list[str] = []
    for line in data_text("senses.txt").splitlines():
        if line.startswith("["):
            current = found.setdefault(line.strip("[]"), [])
        elif line and not line.startswith("#"):
            current.append(line)
    return {name: tuple(lines) for name, lines in found.items()}


@cache
def _table(section: str) -> Mapping[str, tuple[str, ...]]:
    lines = (line.partition(":") for line in _sections()[section])
    return {name.strip(): tuple(words.split()) for name, _, words in lines}


def words_of(section: str) -> frozenset[str]:
    """The words of a plain section: ``measures``, ``anaphors``."""
    return frozenset(word for line in _sections()[section] for word in line.split())


def family(verb: str) -> tuple[str, ...]:
    """Verbs that ask for the same as ``verb``, nearest first: its own family, then the families it stands in."""
    families = _table("families")
    found = dict.fromkeys(families.get(verb, ()))
    for head, members in families.items():
        if verb in members:
            found[head] = None
    for members in families.values():
        if verb in members:
            found.update(dict.fromkeys(members[:4]))
    found.pop(verb, None)
    return tuple(found)


def results(verb: str) -> tuple[str, ...]:
    """Words for the state that ``verb`` leaves its object in; those with a minus are taken away."""
    return _table("results").get(verb, ())


def state_words(adjective: str) -> tuple[str, ...]:
    """Words that say the same as ``adjective``, itself first; those with a minus say the contrary."""
    return tuple(dict.fromkeys((adjective, *_table("states").get(adjective, ()))))


def result_verbs() -> tuple[str, ...]:
    """The verbs that there are words for the outcome of."""
    return tuple(_table("results"))
