"""One environment, ready for grounding: the ground task, the objects' states and the nouns that name them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.grounding.ground import ground
from tmd.pddl.model import Problem, Universe, universe
from tmd.pddl.task import Task
from tmd.veil.profiles import Mentions, Profiles


@dataclass(frozen=True, eq=False, slots=True, weakref_slot=True)
class World:
    """What templates are made from and instantiated in."""

    name: str
    task: Task
    objects: Universe
    profiles: Profiles
    mentions: Mentions


def make_world(name: str, problem: Problem, lexicon: Lexicon, kinds: Mapping[str, str] | None = None) -> World:
    """Ground ``problem`` and prepare its objects and nouns.

    Args:
        name: The environment's name.
        problem: The environment.
        lexicon: The words of the domain.
        kinds: For objects whose PDDL type says less than that, what kind of thing each is.
    """
    task = ground(problem)
    profiles = Profiles(task)
    return World(name, task, universe(problem), profiles, Mentions(profiles, lexicon, kinds))
