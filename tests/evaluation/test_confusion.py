"""Errors by verb: each step counts once, for the right clause."""

from __future__ import annotations

from collections import Counter
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from tmd.evaluation.report.predictions import NO_CLAUSE, NOTHING, belonging, by_instruction, by_verb
from tmd.records.prediction import PredictedClause, PredictionRecord, SegmentRecord

TEXT = "Take the cup. Fill it, then put it down."
SEGMENTS = [
    ("Take the cup.", ["moveto(cup)", "grasp(cup)"]),
    ("Fill it, then put it down.", ["turn(tap)", "keep(cup)"]),
]


def clause(text: str, verb: str, *said: str, latent: tuple[str, ...] = ()) -> PredictedClause:
    return PredictedClause(text=text, verb=verb, latent=latent, said=said, source=None, factors={})


def line(
    clauses: list[PredictedClause], segments: list[tuple[str, list[str]]] | None = None, text: str = TEXT
) -> PredictionRecord:
    parts = [SegmentRecord(text=t, instructions=i) for t, i in (SEGMENTS if segments is None else segments)]
    scores: dict[str, Any] = dict.fromkeys(("IED", "END", "EED", "EED_trim"), 0.0)
    return PredictionRecord(
        id=1, task="t", environment="e", model="m", fold="f", text=text, executable=True, clauses=clauses,
        predicted=[step for c in clauses for step in (*c.latent, *c.said)],
        gold=[step for part in parts for step in part.instructions], segments=parts, **scores,
    )  # fmt: skip


def test_a_clause_belongs_to_the_segment_it_shares_most_with() -> None:
    clauses = [clause("Take the cup", "take"), clause("Fill it", "fill"), clause("put it down", "put")]
    segments = [SegmentRecord(text=t, instructions=i) for t, i in SEGMENTS]
    assert belonging(TEXT, clauses, segments) == [0, 1, 1]
    assert belonging(TEXT, [clause("dance", "dance")], segments) == [None]


def test_the_same_words_twice_are_two_places() -> None:
    text = "wait. wait."
    segments = [SegmentRecord(text="wait.", instructions=[]), SegmentRecord(text="wait.", instructions=[])]
    assert belonging(text, [clause("wait. ", "a"), clause("wait", "b")], segments) == [0, 0]
    assert belonging("wait. then wait.", [clause("then wait", "b")], segments) == [1]


def test_errors_are_counted_for_the_verb_they_belong_to() -> None:
    clauses = [
        clause("Take the cup", "take", "grasp(cup)", latent=("moveto(cup)",)),
        clause("Fill it", "fill", "turn(tap)", "wait()"),
        clause("put it down", "put", "keep(mug)"),
    ]
    take, fill, put = sorted(by_verb([line(clauses)]), key=lambda v: ["take", "fill", "put"].index(v.verb))
    assert (take.clauses, take.matched, take.ied) == (1, 2, 100.0)
    assert (fill.matched, fill.superfluous, fill.missed) == (1, Counter({"wait": 1}), Counter())
    assert fill.ied == 50.0
    assert (put.arguments, put.ied, put.recorded) == (Counter({"keep": 1}), 0.0, 1)


def test_what_was_missed_counts_for_the_clause_before_it() -> None:
    clauses = [clause("Fill it", "fill", "turn(tap)"), clause("put it down", "put")]
    found = {verb.verb: verb for verb in by_verb([line(clauses)])}
    assert found["fill"].missed == Counter({"keep": 1})
    assert found["put"].recorded == 0
    assert found[NO_CLAUSE].missed == Counter({"moveto": 1, "grasp": 1})
    assert found[NO_CLAUSE].clauses == 0


def test_a_clause_in_no_segment_has_superfluous_steps_only() -> None:
    found = {v.verb: v for v in by_verb([line([clause("dance", "dance", "moveto(cup)")], [("Take the cup.", [])])])}
    assert found["dance"].superfluous == Counter({"moveto": 1})
    assert NO_CLAUSE not in found


def test_rows_without_clauses_have_no_verbs_but_texts_without_any_count() -> None:
    silent = line([])
    assert by_verb([silent]) == []
    found = {v.verb: v for v in by_verb([silent, line([clause("Take the cup", "take")])])}
    assert found[NO_CLAUSE].recorded == 4 + 2


STEPS = st.lists(st.sampled_from(["moveto(a)", "moveto(b)", "grasp(a)", "wait()"]), max_size=5)


@given(STEPS, STEPS, STEPS, STEPS, STEPS)
def test_every_step_counts_once(a: list[str], b: list[str], c: list[str], g: list[str], h: list[str]) -> None:
    clauses = [clause("Take the cup", "take", *a), clause("Fill it", "fill", *b), clause("put it down", "put", *c)]
    one = line(clauses, [("Take the cup.", g), ("Fill it, then put it down.", h)])
    verbs = by_verb([one])
    assert sum(v.recorded for v in verbs) == len(one.gold)
    done = sum(v.matched + v.superfluous.total() + v.arguments.total() + v.substituted.total() for v in verbs)
    assert done == len(one.predicted)
    assert sum(v.clauses for v in verbs) == 3
    assert all(0 <= score <= 100 for v in verbs for score in v.scores)
    counts = by_instruction([one])
    assert sum(n for (gold, _), n in counts.items() if gold != NOTHING) == len(one.gold)
    assert sum(n for (_, mine), n in counts.items() if mine != NOTHING) == len(one.predicted)
