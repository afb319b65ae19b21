"""Text to verb clauses, and nouns to the things of an environment (section III-A of the paper)."""

from tmd.language.clause import Clause, Parsed, Relation, Skipped, Span
from tmd.language.lexicon import Lexicon
from tmd.language.notation import clause_json, print_clause, read_clause
from tmd.language.parse import parse
from tmd.language.segments import by_segment, segments

__all__ = [
    "Clause",
    "Lexicon",
    "Parsed",
    "Relation",
    "Skipped",
    "Span",
    "by_segment",
    "clause_json",
    "parse",
    "print_clause",
    "read_clause",
    "segments",
]
