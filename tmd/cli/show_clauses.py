"""Clauses as JSON and as lines for people."""

from __future__ import annotations

from typing import Any

from tmd.language.clause import Clause, Parsed, Skipped
from tmd.language.notation import clause_json, print_clause


def parsed_json(parsed: Parsed) -> dict[str, Any]:
    """The clauses, and what no clause accounts for.

    A ``span`` counts characters of the text from 0; its end is the first character after the piece.
    """
    return {
        "clauses": [clause_json(clause) | {"span": list(clause.span)} for clause in parsed.clauses],
        "skipped": [_skipped_json(piece) for piece in parsed.skipped],
    }


def _skipped_json(piece: Skipped) -> dict[str, Any]:
    return {"text": piece.text, "span": list(piece.span), "reason": piece.reason}


def parsed_text(parsed: Parsed) -> str:
    """The clauses, numbered from 1, and what was skipped."""
    lines = ["clauses"] if parsed.clauses else ["no clause"]
    lines += [f"  {number}. {_clause_text(clause)}" for number, clause in enumerate(parsed.clauses, start=1)]
    if parsed.skipped:
        lines.append("skipped")
        lines += [f'  "{_flat(piece.text)}": {piece.reason}' for piece in parsed.skipped]
    return "\n".join(lines) + "\n"


def _clause_text(clause: Clause) -> str:
    notes = [f"{name} = {' + '.join(clause.meant(name))}" for name in clause.antecedents if name]
    said = (("condition", clause.condition), ("duration", clause.duration), ("purpose", clause.purpose))
    notes += [f"{word}: {_flat(value)}" for word, value in said if value]
    return print_clause(clause) + (f"   {'; '.join(notes)}" if notes else "")


def _flat(text: str) -> str:
    return " ".join(text.split())
