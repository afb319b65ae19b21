"""The goal tables of a domain: declared, learned, and derived from its actions."""

from __future__ import annotations

from collections.abc import Collection
from functools import lru_cache
from weakref import WeakKeyDictionary

from tmd.goals.sources.actions import rows_of_actions
from tmd.goals.sources.table import ACTIONS, DECLARED, LEARNED, GoalTable, read_table
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.model import Domain

SOURCES = (DECLARED, LEARNED, ACTIONS)
"""All sources of goals, the surest first."""
_DECLARED: WeakKeyDictionary[Lexicon, dict[Domain, GoalTable]] = WeakKeyDictionary()


def declared_goals(lexicon: Lexicon, domain: Domain) -> GoalTable:
    """Return the goals that a lexicon declares for a domain; they are read once.

    Raises:
        TmdError: A row is wrong; with its place.
    """
    known = _DECLARED.setdefault(lexicon, {})
    if domain not in known:
        known[domain] = read_table(lexicon.goals, lexicon.attributes, lexicon.groups, domain)
    return known[domain]


def goal_tables(
    lexicon: Lexicon,
    domain: Domain,
    learned: GoalTable | None = None,
    sources: Collection[str] = SOURCES,
) -> list[GoalTable]:
    """Return the goal tables of a domain, the surest source first; the first also has its adjectives and groups.

    Args:
        lexicon: The words of the domain.
        domain: The domain.
        learned: The rows that its demonstrations teach.
        sources: The sources that are used.

    Raises:
        TmdError: The lexicon declares something that is wrong; with its place.
    """
    declared = declared_goals(lexicon, domain)
    rows = declared.rows if DECLARED in sources else ()
    tables = [GoalTable(rows, declared.attributes, declared.groups)]
    if LEARNED in sources and learned is not None:
        tables.append(learned)
    if ACTIONS in sources:
        tables.append(_actions(domain))
    return tables


@lru_cache(maxsize=8)
def _actions(domain: Domain) -> GoalTable:
    return rows_of_actions(domain)
