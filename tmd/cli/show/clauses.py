"""Clauses as lines for people."""

from __future__ import annotations

from collections.abc import Iterator

from tmd.language.clause import Clause, Condition, Mood, Parsed, print_clause

_MOODS = {Mood.AVOID: "not to be done", Mood.KEEP: "to be kept"}


def parsed_text(parsed: Parsed) -> str:
    """The clauses, numbered from 1, the constraints, and what was skipped."""
    lines = ["clauses"] if parsed.clauses else ["no clause"]
    lines += [f"  {number}. {_clause_text(clause)}" for number, clause in enumerate(parsed.clauses, start=1)]
    if parsed.constraints:
        lines.append("constraints")
        lines += [f"  {_MOODS.get(c.mood, 'to be kept')}: {_noted(c, _notes(c))}" for c in parsed.constraints]
    if parsed.skipped:
        lines.append("skipped")
        lines += [f'  "{_flat(piece.text)}": {piece.reason}' for piece in parsed.skipped]
    return "\n".join(lines) + "\n"


def _clause_text(clause: Clause) -> str:
    mood = [_MOODS[clause.mood]] if clause.mood in _MOODS else []
    return _noted(clause, [*mood, *_notes(clause)])


def _noted(clause: Clause, notes: list[str]) -> str:
    return print_clause(clause) + (f"   {'; '.join(notes)}" if notes else "")


def _notes(clause: Clause) -> list[str]:
    """What else was said: what pronouns mean, the state that something shall be in, when and how."""
    return [
        *(f"{name} = {' + '.join(clause.meant(name))}" for name in clause.antecedents if name),
        *([f"state: {clause.result}"] if clause.result else []),
        *(["or"] if clause.alternative else []),
        *(["otherwise"] if clause.otherwise else []),
        *(_condition_text(condition) for condition in clause.conditions),
        *_as_written(clause),
    ]


def _condition_text(condition: Condition) -> str:
    """A condition as written, and as it was read."""
    read = " and ".join(_within(clause) for clause in condition.clauses)
    return f"{_flat(condition.text)}: {'not ' if condition.negated else ''}{read or 'not understood'}"


def _within(clause: Clause) -> str:
    """A clause of a condition, what else was said within its brackets."""
    return "; ".join([print_clause(clause).removesuffix(")"), *_notes(clause)]) + ")"


def _as_written(clause: Clause) -> Iterator[str]:
    """Conditions and the like that were not read any further."""
    read = {_flat(condition.text).lower() for condition in clause.conditions}
    purpose = any(condition.word == "to" for condition in clause.conditions)
    for word in ("condition", "duration", "purpose", "setting"):
        value = getattr(clause, word)
        if value and _flat(value).lower() not in read and not (purpose and word == "purpose"):
            yield f"{word}: {_flat(value)}"


def _flat(text: str) -> str:
    return " ".join(text.split())
