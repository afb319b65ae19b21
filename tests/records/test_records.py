"""JSON formats: what is written is read back to the byte, and what is something else is refused in one line."""

from __future__ import annotations

import json
from dataclasses import fields
from typing import Any

import pytest

from tmd.diagnostics import TmdError
from tmd.language import parse
from tmd.language.clause import Clause, NounPhrase
from tmd.records.clauses import ClauseRecord, ParsedRecord, PhraseRecord
from tmd.records.grounding import GroundingRecord
from tmd.records.prediction import PredictionRecord
from tmd.records.run import EndEvent, StepEvent, read_log
from tmd.records.sentence_test import SentenceReport

TEXT = (
    "Take the two empty cups and put them in the microwave for 3 minutes. If the fridge is not open, open it, "
    "otherwise leave it. Don't touch all the red pots. Bring me the milk or the juice until it boils."
)
PREDICTION = {
    "id": 7, "task": "t", "environment": "e", "model": "m", "fold": "f", "text": "one\u2028 two", "predicted": ["a(b)"],
    "gold": [], "executable": True, "success": None, "IED": 0.0, "END": 1.5, "EED": 100.0, "EED_trim": 0.25,
    "clauses": [{"text": "x", "verb": "v", "latent": [], "said": ["a(b)"], "source": None,
                 "factors": {"environment_distance": -0.5}}],
    "segments": [{"text": "one", "instructions": []}],
}  # fmt: skip
STEP = {
    "event": "step", "number": 1, "action": "wait", "args": [], "repair": False, "outcome": "mismatch", "failure": None,
    "evidence": None, "effects": [], "begin": 1, "end": 2,
    "mismatches": [{"fact": "(hot pot1)", "expected": True, "measured": "20 degrees"}],
}  # fmt: skip
END = {"event": "end", "status": "interrupted", "reason": None}
PLAN = {
    "event": "plan", "text": None, "domain": "d", "environment": "e", "mode": "physics", "seed": 0,
    "planner": "p", "plan": [{"action": "wait", "args": [], "clause": None, "latent": False}], "version": "0",
    "environment_file": None, "strip": None, "grounding": None,
}  # fmt: skip


def numbered(*values: object) -> list[tuple[int, str]]:
    return [(n, v if isinstance(v, str) else json.dumps(v)) for n, v in enumerate(values, start=1)]


def test_clauses_are_read_back_with_all_that_was_said() -> None:
    parsed = parse(TEXT)
    record = ParsedRecord.of(parsed)
    text = json.dumps(record.to_value())
    again = ParsedRecord.from_text(text, "x.json")
    assert json.dumps(again.to_value()) == text
    found = again.parsed(TEXT)
    assert (found.clauses, found.skipped, found.constraints) == (parsed.clauses, parsed.skipped, parsed.constraints)
    names = ("antecedents", "together", "quantities", "duration", "condition", "mood", "otherwise", "direct", "phrases")
    for one, other in zip((*found.clauses, *found.constraints), (*parsed.clauses, *parsed.constraints), strict=True):
        assert all(getattr(one, name) == getattr(other, name) for name in names if name != "phrases")
        assert {n: one.phrase(n) for n in one.objects} == {n: other.phrase(n) for n in other.objects}
        assert [c.word for c in one.conditions] == [c.word for c in other.conditions]
    assert any(clause.conditions for clause in found.clauses) and found.constraints


def test_every_part_of_a_clause_has_a_place_in_its_record() -> None:
    unwritten = {"told", "undetermined", "name"}
    assert {f.name for f in fields(Clause)} - unwritten == set(ClauseRecord.model_fields)
    assert {f.name for f in fields(NounPhrase)} - unwritten == set(PhraseRecord.model_fields)
    parsed = parse("There is a mug on the shelf. Wash it, and fill the cup that is on the table.")
    assert any(clause.stated for clause in parsed.clauses)
    again = ParsedRecord.from_text(json.dumps(ParsedRecord.of(parsed).to_value()), "x.json").parsed(parsed.text)
    assert [c.stated for c in again.clauses] == [c.stated for c in parsed.clauses]


def test_lines_are_read_back_whatever_ends_of_lines_are_in_them() -> None:
    text = json.dumps(PREDICTION, ensure_ascii=False) + "\n"
    (record,) = PredictionRecord.from_lines(text + "\n", "x.jsonl")
    assert record.to_line() == text
    assert record.whole


def changed(**changes: object) -> dict[str, Any]:
    return {name: value for name, value in (PREDICTION | changes).items() if value is not ...}


@pytest.mark.parametrize(
    ("line", "message", "hint"),
    [
        (
            changed(text=...),
            "not a prediction of tmd experiment: text: the key is missing",
            "an older version of tmd: run",
        ),
        (
            changed(new=1),
            "not a prediction of tmd experiment: new: there is no such key",
            "another version of tmd: run",
        ),
        (changed(IED="x"), "not a prediction of tmd experiment: IED: should be a valid number", "run the same `tmd"),
        (
            changed(predicted="x"),
            "not a prediction of tmd experiment: predicted: should be a list",
            "run the same",
        ),
        (changed(segments=[[]]), "experiment: segments.0: should be a JSON object", "run the same"),
        ([], "not a prediction of tmd experiment: should be a JSON object", "run the same"),
    ],
)
def test_what_is_no_prediction_is_told(line: object, message: str, hint: str) -> None:
    good = json.dumps(PREDICTION)
    with pytest.raises(TmdError) as caught:
        PredictionRecord.from_lines(f"{good}\n{json.dumps(line)}\n", "x.jsonl")
    assert str(caught.value.location) == "x.jsonl:2:1"
    assert message in caught.value.message and hint in (caught.value.hint or "")
    assert "\n" not in str(caught.value)


def test_numbers_that_json_does_not_have_are_refused() -> None:
    with pytest.raises(TmdError, match="IED: should be a finite number"):
        PredictionRecord.from_text(json.dumps(changed(IED=float("nan"))), "x.jsonl", 1)


@pytest.mark.parametrize(
    ("text", "place"), [("{", "x.json:1:2"), ('{\n "a": }', "x.json:2:7"), ("[" * 100_000, "x.json:1:1")]
)
def test_what_is_not_json_is_told_with_its_place(text: str, place: str) -> None:
    with pytest.raises(TmdError) as caught:
        GroundingRecord.from_text(text, "x.json")
    assert str(caught.value.location) == place and "JSON" in caught.value.message


def test_a_whole_file_is_told_with_its_key() -> None:
    with pytest.raises(
        TmdError, match=r"^x\.json is not what tmd test --json prints: summary\.n: the key is missing \("
    ):
        SentenceReport.from_text('{"summary": {}, "cases": []}', "x.json")


def test_a_log_is_read_line_by_line() -> None:
    plan, events = read_log(numbered(PLAN, STEP, END, '{"event": "st'), "x.jsonl")
    assert plan.mode == "physics"
    assert [type(event) for event in events] == [StepEvent, EndEvent]
    assert [event.to_value() for event in (plan, *events)] == [PLAN, STEP, END]
    assert isinstance(events[0], StepEvent) and events[0].told == "(hot pot1) was expected, but 20 degrees"


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ([STEP], "x.jsonl does not begin with a plan"),
        ([PLAN, "{", END], "x.jsonl:2:2: this is not valid JSON"),
        ([PLAN, {"event": "dance"}], "x.jsonl:2:1: this is not a line of a log of tmd run: event: should be one of"),
        ([PLAN, 7, END], "x.jsonl:2:1: this is not a line of a log of tmd run: event"),
        (
            [PLAN, {**END, "status": "bored"}],
            "x.jsonl:2:1: this is not a line of a log of tmd run: status: should be 'done'",
        ),
        (
            [{k: PLAN[k] for k in PLAN if k != "strip"}],
            "x.jsonl:1:1: this is not a line of a log of tmd run: strip: the",
        ),
    ],
)
def test_what_is_no_log_is_told(lines: list[Any], message: str) -> None:
    with pytest.raises(TmdError) as caught:
        read_log(numbered(*lines), "x.jsonl")
    assert str(caught.value).startswith(message)
