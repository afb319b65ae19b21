"""The sources of what verbs mean, put together for one environment: declared, learned, read off the actions."""

from __future__ import annotations

from collections.abc import Collection
from functools import lru_cache
from weakref import WeakKeyDictionary

from tmd.goals.reading.reader import GoalReader
from tmd.goals.sources.actions import rows_of_actions
from tmd.goals.sources.table import ACTIONS, DECLARED, LEARNED, GoalTable, read_table
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.model import Domain
from tmd.veil.world import World

SOURCES = (DECLARED, LEARNED, ACTIONS)
"""All sources, the surest first."""


_DECLARED: WeakKeyDictionary[Lexicon, dict[Domain, GoalTable]] = WeakKeyDictionary()


def declared_goals(lexicon: Lexicon, domain: Domain) -> GoalTable:
    """What a lexicon declares for a domain; read once.

    Raises:
        TmdError: A row is wrong; with its place.
    """
    known = _DECLARED.setdefault(lexicon, {})
    if domain not in known:
        known[domain] = read_table(lexicon.goals, lexicon.attributes, lexicon.groups, domain)
    return known[domain]


@lru_cache(maxsize=8)
def _actions(domain: Domain) -> GoalTable:
    return rows_of_actions(domain)


def goal_reader(
    world: World,
    lexicon: Lexicon,
    learned: GoalTable | None = None,
    *,
    sources: Collection[str] = SOURCES,
    guess: bool = False,
) -> GoalReader:
    """A reader for one environment.

    Args:
        world: The environment.
        lexicon: The domain's words.
        learned: The rows that its demonstrations teach.
        sources: Which sources are asked.
        guess: Whether a thing may be taken for what a noun is only like in meaning.

    Raises:
        TmdError: The lexicon declares something that is wrong; with its place.
    """
    domain = world.task.problem.domain
    said = declared_goals(lexicon, domain)
    rows = said.rows if DECLARED in sources else ()
    tables = [GoalTable(rows, said.attributes, said.groups)]
    if LEARNED in sources and learned is not None:
        tables.append(learned)
    if ACTIONS in sources:
        tables.append(_actions(domain))
    return GoalReader(world, tables, lexicon, guess=guess)
