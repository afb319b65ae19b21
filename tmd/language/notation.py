"""Clauses as the paper writes them, ``(take, [cup, water], with: cup -> water)``, and as JSON."""

from __future__ import annotations

import re
from typing import Any

from tmd.diagnostics import Location, TmdError
from tmd.language.clause import Clause, Condition, Mood, NounPhrase, Quantifier, Relation

_CLAUSE = re.compile(r"\(\s*([\w'-]+)\s*,\s*\[([^\]]*)\]\s*((?:,[^()]*)?)\)\s*$")
_RELATION = re.compile(r"\s*([\w-]+)\s*:\s*([\w'-]*)\s*->\s*([\w'-]+)\s*$")


def clause_json(clause: Clause) -> dict[str, Any]:
    """Return a clause as JSON: what is empty of the optional parts, or as it mostly is, is left out."""
    result: dict[str, Any] = {
        "verb": clause.verb,
        "objects": list(clause.objects),
        "relations": [list(r) for r in clause.relations],
        "text": clause.text,
    }
    if clause.antecedents:
        result["antecedents"] = {name: list(names) for name, names in clause.antecedents.items()}
        result["together"] = dict(clause.together)
    if clause.quantities:
        result["quantities"] = dict(clause.quantities)
    said = {name: getattr(clause, name) for name in ("condition", "duration", "purpose", "setting", "result")}
    result |= {name: value for name, value in said.items() if value is not None}
    if clause.direct:
        result["direct"] = list(clause.direct)
    phrases = {name: _phrase_json(phrase) for name, phrase in clause.phrases.items()}
    if any(phrases.values()):
        result["phrases"] = {name: said for name, said in phrases.items() if said}
    if clause.conditions:
        result["conditions"] = [_condition_json(condition) for condition in clause.conditions]
    if clause.mood is not Mood.DO:
        result["mood"] = clause.mood.value
    return result | {name: True for name in ("otherwise", "implied", "alternative", "heading") if getattr(clause, name)}


def _phrase_json(phrase: NounPhrase) -> dict[str, Any]:
    """How a noun was said, but for its name and what is as it mostly is."""
    result: dict[str, Any] = {}
    if phrase.quantifier is not Quantifier.PLAIN:
        result["quantifier"] = phrase.quantifier.value
    if phrase.number is not None:
        result["number"] = phrase.number
    result |= {name: True for name in ("definite", "plural", "each") if getattr(phrase, name)}
    lists = {"attributes": phrase.attributes, "either": phrase.either}
    return result | {name: list(words) for name, words in lists.items() if words}


def _condition_json(condition: Condition) -> dict[str, Any]:
    """A condition; the clauses of what it says have no text of their own."""
    clauses = [clause_json(clause) for clause in condition.clauses]
    result: dict[str, Any] = {"word": condition.word, "text": condition.text}
    result["clauses"] = [{name: value for name, value in clause.items() if name != "text"} for clause in clauses]
    return result | ({"negated": True} if condition.negated else {})


def print_clause(clause: Clause) -> str:
    """Return a clause in the paper's notation; an elided source is left empty: ``in: -> microwave``."""
    relations = [f"{r.relation}: {r.source + ' ' if r.source else ''}-> {r.target}" for r in clause.relations]
    return f"({', '.join([clause.verb, '[' + ', '.join(clause.objects) + ']', *relations])})"


def read_clause(text: str, file: str = "<clause>", line: int = 1) -> Clause:
    """Read the paper's notation, as :func:`print_clause` writes it.

    Raises:
        TmdError: The text is not a clause; the place is the first sign that cannot be read.
    """
    match = _CLAUSE.match(text.strip())
    if match is None:
        raise _error("not a clause", text, file, line, 1)
    objects = tuple(name.strip() for name in match[2].split(",") if name.strip())
    relations = []
    for part in (p for p in match[3].split(",") if p.strip()):
        found = _RELATION.match(part)
        if found is None:
            raise _error(f"not a relation: {part.strip()}", text, file, line, text.find(part.strip()) + 1)
        relations.append(Relation(found[1], found[2] or None, found[3]))
    return Clause(match[1], objects, tuple(relations))


def _error(message: str, text: str, file: str, line: int, column: int) -> TmdError:
    hint = "write (verb, [object, object], relation: object -> object)"
    return TmdError(message, location=Location(file, line, column), hint=hint, source=text)
