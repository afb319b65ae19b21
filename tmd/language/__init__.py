"""Text to verb clauses, and nouns to the things of an environment (section III-A of the paper).

The parser is imported when it is first used, because loading the grammar is slow.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tmd.language.clause import (
    Clause,
    Parsed,
    Relation,
    Skipped,
    Span,
    clause_json,
    print_clause,
    read_clause,
)
from tmd.language.lexicon.lexicon import Lexicon

if TYPE_CHECKING:
    from tmd.language.parser import parse

__all__ = [
    "Clause",
    "Lexicon",
    "Parsed",
    "Relation",
    "Skipped",
    "Span",
    "clause_json",
    "parse",
    "print_clause",
    "read_clause",
]


def __getattr__(name: str) -> Any:  # noqa: ANN401 - any member of the module
    """The parser, imported now."""
    if name == "parse":
        from tmd.language.parser import parse

        return parse
    raise AttributeError(f"module 'tmd.language' has no attribute '{name}'")
