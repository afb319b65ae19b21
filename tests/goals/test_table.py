"""Rows that authors declare: patterns with slots, prepositions, nouns and states, and their conditions."""

from __future__ import annotations

import pytest

from tests.bundled import corpus
from tests.goals.conftest import pddl
from tmd.diagnostics import Location, TmdError
from tmd.goals.sources.demonstrations import table_from_json, table_to_json
from tmd.goals.sources.table import GoalTable, PutBack, Slot, read_row, read_table, slot_types
from tmd.language.lexicon.lexicon import Declared

DRAWER = corpus("03_drawer").folder.domain
TEA = corpus("04_tea").folder.domain
PLACE = Location("lexicon.yaml", 7, 5)


def row(pattern: str, condition: str) -> Declared:
    return Declared(pattern, condition, PLACE)


def test_a_row_has_verbs_slots_and_a_condition() -> None:
    read = read_row(row("put|place X in|on Y", "(at ?x ?y ?rel)"), DRAWER)
    assert read.verbs == ("put", "place")
    assert read.slots == (Slot("?x"), Slot("?y", ("in", "on")))
    assert (read.direct, read.places) == (read.slots[0], read.slots[1:])
    assert (read.noun, read.result, read.source, read.location) == (None, None, "declared", PLACE)
    assert pddl(read.condition) == "(at ?x ?y ?rel)"
    assert not read.traceless


def test_a_pattern_may_name_a_noun_or_the_state_it_ends_in() -> None:
    dish = read_row(row("make tea in V", "(contains ?v tea)"), TEA)
    assert (dish.noun, dish.slots, dish.direct) == ("tea", (Slot("?v", ("in",)),), None)
    state = read_row(row("make X hot", "(hot ?x)"), TEA)
    assert (state.noun, state.result, state.slots) == (None, "hot", (Slot("?x"),))
    assert read_row(row("wait", "(and)"), TEA).traceless


def test_a_condition_may_look_back() -> None:
    read = read_row(row("cool V", "(and (was (hot ?v)) (first (not (hot ?v))) (not (hot ?v)))"), TEA)
    assert pddl(read.condition) == "(and (hot@was ?v) (not (hot@first ?v)) (not (hot ?v)))"


@pytest.mark.parametrize(
    ("pattern", "condition", "variable", "types"),
    [
        ("put X in|on Y", "(at ?x ?y ?rel)", "?y", ("fixture",)),
        ("put X in|on Y", "(at ?x ?y ?rel)", "?x", ("thing",)),
        ("take X", "(and (not (opened ?y)) (holding pr2 ?x))", "?x", ("item",)),
        ("free X", "(free pr2)", "?x", ("object",)),
        ("shut X", "(not (was (opened ?x)))", "?x", ("fixture",)),
    ],
)
def test_what_a_slot_takes_is_read_off_the_first_predicate(
    pattern: str, condition: str, variable: str, types: tuple[str, ...]
) -> None:
    read = read_row(row(pattern if "?y" not in condition or "Y" in pattern else "take X from Y", condition), DRAWER)
    assert slot_types(read, Slot(variable), DRAWER) == types
    assert slot_types(read, Slot(variable, types=("door",)), DRAWER) == ("door",)  # what an action takes is narrower


@pytest.mark.parametrize(
    ("pattern", "condition", "message", "hint"),
    [
        ("lock X", "(lokced ?x)", 'there is no predicate "lokced"', "predicates: "),
        ("open X", "(opend ?x)", 'there is no predicate "opend"', 'did you mean "opened"?'),
        ("open X", "(opened ?z)", "no slot is called ?z", "the slots here: ?x"),
        ("open X", "(at ?x ?x ?rel)", "no slot is called ?rel", "the slots here: ?x"),
        ("open X", "(opened ?x ?x)", '"opened" takes 1 arguments, found 2', None),
        ("take X", "(holding pr3 ?x)", 'the domain has no constant "pr3"', 'did you mean "pr2"?'),
        ("open X", "(forall (?d - drawr) (opened ?d))", 'there is no type "drawr"', 'did you mean "drawer"?'),
        ("put X onn Y", "(at ?x ?y on)", "'onn' is neither a slot nor a preposition", 'did you mean "on"?'),
        ("put X Y", "(at ?x ?y on)", "two slots follow each other", "write a preposition between them"),
        ("put X on X", "(at ?x ?x on)", "the slot X stands twice", "give each slot a letter of its own"),
        ("put X on", "(free pr2)", "no slot follows 'on'", "write a capital behind it: in Y"),
        ("Put X", "(holding pr2 ?x)", "'Put' is not a verb", "write verbs in lower case"),
        ("", "(free pr2)", "a goal has no verb", "write 'open X: (opened ?x)'"),
        ("open X", "(opened ?x) (free pr2)", "a goal is one condition", "write (and (…) (…)) for several"),
    ],
)
def test_a_bad_row_is_told_with_its_place_and_what_to_do(
    pattern: str, condition: str, message: str, hint: str | None
) -> None:
    with pytest.raises(TmdError) as raised:
        read_row(row(pattern, condition), DRAWER)
    error = raised.value
    assert error.message == message
    assert error.location is not None
    assert (error.location.file, error.location.line) == (PLACE.file, PLACE.line)
    assert error.location.column >= PLACE.column
    assert hint is None or hint in (error.hint or "")


def test_every_fault_of_a_table_is_told_and_the_rest_is_read() -> None:
    faults: list[TmdError] = []
    rows = [row("open X", "(opend ?x)"), row("close X", "(not (opened ?x))"), row("take X", "(holding ?x)")]
    table = read_table(rows, [row("open", "(opened ?y)"), row("shut", "(not (opened ?x))")], {}, DRAWER, faults)
    assert len(faults) == 3
    assert table.verbs() == ["close"]
    assert [r.pattern for r in table.of("close")] == ["close X"]
    assert table.of("open") == ()
    assert list(table.attributes) == ["shut"]
    with pytest.raises(TmdError, match="opend"):
        read_table(rows, [], {}, DRAWER)


def test_learned_rows_survive_json() -> None:
    entries = [
        {"pattern": "open X", "condition": "(opened ?x)", "evidence": "9 of 10", "probability": 0.9},
        {"pattern": "put X in|on Y", "condition": "(at ?x ?y ?rel)", "evidence": "all", "probability": 1.0},
    ]
    data = {"rows": entries, "put_back": [["opened", "drawer"]], "unrestored": [["opened", "packet"]]}
    table = table_from_json(data, DRAWER)
    assert {r.source for r in table.rows} == {"learned"}
    assert table.put_back == {PutBack("opened", "drawer")}
    assert table.unrestored == {PutBack("opened", "packet")}
    assert table_to_json(table) == data
    assert table_from_json(table_to_json(table), DRAWER) == table
    assert table_to_json(GoalTable()) == {"rows": [], "put_back": [], "unrestored": []}
    with pytest.raises(TmdError, match="no predicate"):
        table_from_json({**data, "rows": [{**entries[0], "condition": "(opend ?x)"}]}, DRAWER)
    with pytest.raises(KeyError):
        table_from_json({**data, "rows": [{"pattern": "open X"}]}, DRAWER)
