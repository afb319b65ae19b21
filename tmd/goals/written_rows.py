"""The rows that a domain's names suggest, as text for its lexicon."""

from __future__ import annotations

from collections.abc import Iterator

from tmd.diagnostics import TmdError
from tmd.goals.sources.actions import OF_ACTION, rows_of_actions
from tmd.goals.sources.table import GoalRow, read_table
from tmd.language.lexicon.lexicon import Declared
from tmd.pddl.model import Domain
from tmd.pddl.writer import format_formula

_HEAD = """\
# What verbs mean here: a pattern, a colon, and the PDDL condition that must hold in the end. Capitals are slots for
# what is said, X for ?x. These rows are read off the actions in domain.pddl; change them, delete those nobody says.
# A verb without a row here means what its name suggests. `tmd check` finds mistakes; docs/goals.md says it all.
"""


def lexicon_of_actions(domain: Domain) -> str:
    """Return the text of a ``lexicon.yaml`` with a row for each way to say an action of ``domain``."""
    lines: list[str] = []
    said: set[str] = set()
    for row in rows_of_actions(domain).rows:
        words = {f"{verb} {'|'.join(p for slot in row.slots for p in slot.prepositions)}" for verb in row.verbs}
        entry = Declared(_pattern(row), format_formula(row.condition))
        # of rows for the same words the first one is tried first
        if row.evidence.startswith(OF_ACTION) and not words & said and _is_read(entry, domain):
            said |= words
            lines.append(f"  - {entry.pattern}: {entry.condition}\n")
    return f"{_HEAD}goals:\n{''.join(lines)}" if lines else f"{_HEAD}goals: []\n"


def _pattern(row: GoalRow) -> str:
    return " ".join(["|".join(row.verbs), *_parts(row)])


def _parts(row: GoalRow) -> Iterator[str]:
    if row.noun:
        yield row.noun
    for slot in row.slots:
        if slot.prepositions:
            yield "|".join(slot.prepositions)
        yield slot.variable.removeprefix("?").upper()


def _is_read(entry: Declared, domain: Domain) -> bool:
    """Return whether the lexicon may declare the row."""
    try:
        read_table([entry], [], {}, domain)
    except TmdError:
        return False
    return True
