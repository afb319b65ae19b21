"""The paper's notation, JSON, and segments."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.diagnostics import TmdError
from tmd.language import Clause, Relation, clause_json, parse, print_clause, read_clause

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
        "direct": ["cup"],
        "phrases": {"cup": {"quantifier": "number", "number": 2, "plural": True}},
    }
    assert second["objects"] == ["them", "sink"]
    assert second["relations"] == [["in", "them", "sink"]]
    assert second["antecedents"] == {"them": ["cup"]}
    assert second["condition"].lower() == "if it is hot"
    assert second["duration"] == "for 3 minutes"
    assert second["purpose"] == "to soak"
    assert json.loads(json.dumps(second)) == second
    (condition, purpose) = second["conditions"]
    assert (condition["word"], purpose["word"]) == ("if", "to")
    assert condition["clauses"][0]["verb"] == "be"
    assert condition["clauses"][0]["result"] == "hot"
    assert "text" not in condition["clauses"][0]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("Open the door, otherwise close the drawer.", [{}, {"otherwise": True}]),
        ("Leave the door open.", [{"mood": "keep", "result": "open"}]),
        ("Turn the stove to low.", [{"setting": "low"}]),
        ("A cup of tea, please.", [{"implied": True}]),
        ("Wash the cup or throw it away.", [{}, {"alternative": True}]),
        ("Make tea: fill the kettle.", [{"heading": True}, {}]),
    ],
)
def test_json_says_what_is_asked_of_a_clause(text: str, said: list[dict[str, object]]) -> None:
    names = ("otherwise", "mood", "result", "setting", "implied", "alternative", "heading")
    found = [
        {name: clause[name] for name in names if name in clause} for clause in map(clause_json, parse(text).clauses)
    ]
    assert found == said


@pytest.mark.parametrize(
    ("text", "name", "phrase"),
    [
        ("Take the cup.", "cup", {"definite": True}),
        ("Take a cup.", "cup", None),
        ("Take all the dirty cups.", "cup", {"quantifier": "all", "attributes": ["dirty"]}),
        ("Take some cups.", "cup", {"quantifier": "some", "plural": True}),
        ("Fill each cup.", "cup", {"quantifier": "all", "each": True}),
        ("Take another cup.", "cup", {"other": True}),
        ("Put no sugar in the cup.", "sugar", {"quantifier": "none"}),
        ("Take the cup or the mug.", "mug", {"definite": True, "either": ["cup", "mug"]}),
    ],
)
def test_json_says_how_a_noun_was_said(text: str, name: str, phrase: dict[str, object] | None) -> None:
    told = clause_json(parse(text).clauses[0]).get("phrases", {}).get(name)
    assert (told is None) == (phrase is None)
    assert told is None or phrase is None or phrase.items() <= told.items()


def test_a_negated_condition_says_so() -> None:
    (clause,) = parse("If the door is not open, open it.").clauses
    assert clause_json(clause)["conditions"][0]["negated"] is True


def test_what_is_as_it_mostly_is_is_left_out() -> None:
    assert clause_json(Clause("wait")) == {"verb": "wait", "objects": [], "relations": [], "text": ""}
