"""Dataclasses as JSON and back: clauses with all that can be said, and nothing that is merely like one."""

from __future__ import annotations

import json
from dataclasses import asdict

import pytest

from tmd.knowledge import read_record, record_value
from tmd.language import parse
from tmd.language.clause import Clause, Condition, Mood, NounPhrase, Quantifier, Relation, Span

WHOLE = Clause(
    verb="put",
    objects=("cup", "it"),
    relations=(Relation("on", "cup", "table"), Relation("in", None, "sink")),
    span=Span(3, 20),
    text="put two cups",
    antecedents={"it": ("cup", "mug")},
    together={"it": 2},
    quantities={"cup": "two"},
    condition="if it is hot",
    phrases={"cup": NounPhrase("cup", Quantifier.NUMBER, 2, definite=True, attributes=("red",))},
    conditions=(Condition("if", (Clause("be", ("it",), result="hot"),), negated=True, text="if it is hot"),),
    mood=Mood.KEEP,
    otherwise=True,
)


def there_and_back(clause: Clause) -> Clause:
    return read_record(Clause, json.dumps(record_value(clause)).encode())


@pytest.mark.parametrize("clause", [WHOLE, Clause("wait")], ids=["all fields", "one field"])
def test_a_clause_comes_back_whole(clause: Clause) -> None:
    again = there_and_back(clause)
    assert asdict(again) == asdict(clause)  # equality leaves fields out
    assert again.mood is clause.mood
    assert type(again.span) is Span


def test_what_is_parsed_comes_back_whole() -> None:
    text = "Take the two cups, fill them with water and put each cup on the table until it is cold."
    clauses = parse(text).clauses
    assert clauses
    assert [asdict(there_and_back(clause)) for clause in clauses] == [asdict(clause) for clause in clauses]


@pytest.mark.parametrize(
    "data", ['{"verb": "put", "span": [1]}', "[]", '{"mood": "sad"}', '{"verb": 1}', "{", '{"verb": "a"}]']
)
def test_what_is_none_is_refused(data: str) -> None:
    with pytest.raises(ValueError):
        read_record(Clause, data.encode())
