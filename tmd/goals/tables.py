"""The goal tables of a domain: declared, learned, and derived from its actions."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import lru_cache
from weakref import WeakKeyDictionary

from tmd.goals.base import LeftOut, condition_text, shared_meanings
from tmd.goals.sources.actions import rows_of_actions
from tmd.goals.sources.table import ACTIONS, DECLARED, LEARNED, GoalTable, read_table
from tmd.language.lexicon.lexicon import Declared, Lexicon
from tmd.pddl.model import Domain

SOURCES = (DECLARED, LEARNED, ACTIONS)
"""All sources of goals, the surest first."""
_DECLARED: WeakKeyDictionary[Lexicon, dict[Domain, tuple[GoalTable, tuple[LeftOut, ...]]]] = WeakKeyDictionary()


def declared_goals(lexicon: Lexicon, domain: Domain) -> GoalTable:
    """Return the goals that a lexicon declares for a domain, its own before those of base lexicons; they are read once.

    Raises:
        TmdError: A row is wrong; with its place.
    """
    return _declared(lexicon, domain)[0]


def declared_entries(lexicon: Lexicon, domain: Domain) -> tuple[Sequence[Declared], Sequence[Declared]]:
    """Return the rows and the adjectives that are declared for a domain as text, those of base lexicons translated.

    Raises:
        TmdError: A row is wrong; with its place.
    """
    table = declared_goals(lexicon, domain)
    written = {entry.location: entry for entry in lexicon.goals}
    own = {entry.pattern: entry for entry in lexicon.attributes}
    rows = [written.get(row.location) or Declared(row.pattern, condition_text(row.condition)) for row in table.rows]
    adjectives = [own.get(name) or Declared(name, condition_text(said)) for name, said in table.attributes.items()]
    return rows, adjectives


def left_out(lexicon: Lexicon, domain: Domain) -> tuple[LeftOut, ...]:
    """Return the rows of base lexicons that are not used in a domain, with reasons.

    Raises:
        TmdError: A row is wrong; with its place.
    """
    return _declared(lexicon, domain)[1]


def _declared(lexicon: Lexicon, domain: Domain) -> tuple[GoalTable, tuple[LeftOut, ...]]:
    known = _DECLARED.setdefault(lexicon, {})
    if domain not in known:
        own = read_table(lexicon.goals, lexicon.attributes, lexicon.groups, domain)
        shared = shared_meanings(lexicon, domain, own.rows, own.attributes)
        place = len(own.rows) if lexicon.base.place is None else lexicon.base.place
        rows = (*own.rows[:place], *shared.rows, *own.rows[place:])
        table = GoalTable(rows, {**shared.attributes, **own.attributes}, own.groups)
        known[domain] = table, shared.left_out
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
