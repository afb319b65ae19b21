"""The paper's notation, JSON, and segments."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.errors import TmdError
from tmd.language import Clause, Relation, by_segment, clause_json, parse, print_clause, read_clause, segments

_NAME = st.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True)
_RELATION = st.builds(Relation, _NAME, st.none() | _NAME, _NAME)


@given(st.builds(Clause, _NAME, st.lists(_NAME, max_size=4).map(tuple), st.lists(_RELATION, max_size=3).map(tuple)))
def test_reading_undoes_printing(clause: Clause) -> None:
    assert read_clause(print_clause(clause)) == clause


@pytest.mark.parametrize("text", ["", "take", "(take)", "(take, [cup], on)", "(take, [cup], on: a b)", "(take, [cup]"])
def test_what_is_no_clause_says_where(text: str) -> None:
    with pytest.raises(TmdError) as caught:
        read_clause(text, "gold.yaml", 7)
    assert caught.value.location is not None
    assert caught.value.location.line == 7


def test_json() -> None:
    parsed = parse("Take two cups. If it is hot, put them in the sink for 3 minutes to soak.")
    first, second = (clause_json(c) for c in parsed.clauses)
    assert first == {
        "verb": "take",
        "objects": ["cup"],
        "relations": [],
        "text": "Take two cups",
        "quantities": {"cup": "two"},
    }
    assert second["objects"] == ["them", "sink"]
    assert second["relations"] == [["in", "them", "sink"]]
    assert second["antecedents"] == {"them": ["cup"]}
    assert second["condition"] == "If it is hot"
    assert second["duration"] == "for 3 minutes"
    assert second["purpose"] == "to soak"
    assert json.loads(json.dumps(second)) == second


def test_clauses_are_dealt_to_segments_by_offset() -> None:
    text = "Turn | on the tv and take | the cup | . Wait"
    groups = by_segment(text, parse(text).clauses)
    assert [text[s.start : s.end] for s in segments(text)] == ["Turn ", " on the tv and take ", " the cup ", " . Wait"]
    assert [[c.verb for c in group] for group in groups] == [["turn_on"], ["take"], [], ["wait"]]


@given(st.text(alphabet="take cup|. on the", max_size=60))
def test_every_clause_is_in_one_segment(text: str) -> None:
    clauses = parse(text).clauses
    groups = by_segment(text, clauses)
    assert len(groups) == text.count("|") + 1
    assert sorted(c.span for g in groups for c in g) == sorted(c.span for c in clauses)
