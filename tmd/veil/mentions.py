"""Which objects of an environment a noun may mean.

The evidence about words comes from the language package (:func:`tmd.language.lexicon.nouns.rank`). Here it meets the
environment: a noun that names no object but something an object contains (*coffee*, *raspberry syrup*) means what
contains it.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping

from tmd.language.clause import Clause
from tmd.language.lexicon.lexicon import Lexicon
from tmd.language.lexicon.nouns import Match, NounMatch, rank
from tmd.pddl.hierarchy import hierarchy
from tmd.pddl.task import Bits
from tmd.veil.profiles import Profiles

CONTAINED = "contained"
"""How a :class:`Match` was found: the object contains what the noun names."""
_CONTAINED_SHARE = 0.9
"""A container is a weaker reading than the thing itself."""


class Mentions:
    """The nouns of one environment.

    Args:
        profiles: The environment's objects and their states.
        lexicon: The domain's words.
        kinds: For objects whose PDDL type says less than that, what kind of thing each is.
    """

    def __init__(self, profiles: Profiles, lexicon: Lexicon, kinds: Mapping[str, str] | None = None) -> None:
        self.profiles = profiles
        self.lexicon = lexicon
        problem = profiles.task.problem
        types = hierarchy(problem.domain)
        self.classes = frozenset(t.name for t in problem.domain.types)
        """The classes that the domain knows, be there something of them here or not."""
        self.types: Mapping[str, tuple[str, ...]] = {o.name: types.ancestors(o.types[0]) for o in problem.all_objects()}
        own = {name: types[0] for name, types in self.types.items()}
        self.kinds: Mapping[str, str] = own | {name: kind for name, kind in (kinds or {}).items() if name in own}
        self._candidates = tuple(self._candidate(name) for name in self.types)
        self._known: dict[str, tuple[Match, ...]] = {}

    def _candidate(self, name: str) -> NounMatch:
        types, kind = self.types[name], self.kinds[name]
        above = types[1:] if kind == types[0] else types
        return NounMatch(name, kind, above, _words(name, self.profiles.wholes.get(name)))

    def of(self, noun: str, state: Bits) -> list[Match]:
        """The objects that ``noun`` may mean in ``state``, likeliest first; empty for what is not there."""
        found: dict[str, Match] = {}
        for match in self.ranked(noun):
            if match.name not in self.profiles.constants:
                found.setdefault(match.name, match)
                continue
            for name in self.profiles.containers(match.name, state):
                better = Match(name, match.score * _CONTAINED_SHARE, CONTAINED)
                if name not in found or found[name].score < better.score:
                    found[name] = better
        return sorted(found.values(), key=lambda m: -m.score)

    def constants(self, noun: str) -> list[str]:
        """The constants of the domain, substances say, that ``noun`` may mean, likeliest first."""
        return [match.name for match in self.ranked(noun) if match.name in self.profiles.constants]

    def ranked(self, noun: str) -> tuple[Match, ...]:
        """The objects and constants that ``noun`` may name, likeliest first, whatever contains them."""
        if noun not in self._known:
            self._known[noun] = tuple(rank(noun, self._candidates, self.lexicon))
        return self._known[noun]

    def meant(self, clause: Clause, used: Collection[str], state: Bits) -> tuple[str, ...]:
        """The clause's objects: for each noun what it may mean among the objects ``used``, or the likeliest.

        Of several that are equally likely it is the one with the most edges to what was used: the burner of the
        knob that was turned.
        """
        found: dict[str, None] = {}
        for noun in clause.resolved():
            matches = self.of(noun, state)
            chosen = next((match.name for match in matches if match.name in used), None)
            if chosen is None and matches:
                best = [match.name for match in matches if match.score == matches[0].score]
                chosen = max(best, key=lambda name: self._edges(name, used))
            if chosen is not None:
                found[chosen] = None
        return tuple(found)

    def _edges(self, name: str, used: Collection[str]) -> int:
        links = self.profiles.links
        return sum(len(links.get((name, u), ())) + len(links.get((u, name), ())) for u in used)


def _words(name: str, whole: str | None) -> tuple[str, ...]:
    """The words in an object's name; a part also answers to the name of its whole."""
    words = [word.rstrip("0123456789") for word in name.replace("-", "_").split("_")]
    return tuple(dict.fromkeys([w for w in words if w] + ([whole.rstrip("0123456789")] if whole else [])))
