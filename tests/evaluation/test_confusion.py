"""Errors by instruction: each step counts once."""

from __future__ import annotations

from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from tmd.evaluation.report.predictions import NOTHING, by_instruction
from tmd.records.prediction import PredictedClause, PredictionRecord, SegmentRecord

TEXT = "Take the cup. Fill it, then put it down."


def clause(text: str, verb: str, *said: str, latent: tuple[str, ...] = ()) -> PredictedClause:
    return PredictedClause(text=text, verb=verb, latent=latent, said=said, source=None, factors={})


def line(clauses: list[PredictedClause], segments: list[tuple[str, list[str]]], text: str = TEXT) -> PredictionRecord:
    parts = [SegmentRecord(text=t, instructions=i) for t, i in segments]
    scores: dict[str, Any] = dict.fromkeys(("IED", "END", "EED", "EED_trim"), 0.0)
    return PredictionRecord(
        id=1, task="t", environment="e", model="m", fold="f", text=text, executable=True, clauses=clauses,
        predicted=[step for c in clauses for step in (*c.latent, *c.said)],
        gold=[step for part in parts for step in part.instructions], segments=parts, **scores,
    )  # fmt: skip


STEPS = st.lists(st.sampled_from(["moveto(a)", "moveto(b)", "grasp(a)", "wait()"]), max_size=5)


@given(STEPS, STEPS, STEPS, STEPS, STEPS)
def test_every_step_counts_once(a: list[str], b: list[str], c: list[str], g: list[str], h: list[str]) -> None:
    clauses = [clause("Take the cup", "take", *a), clause("Fill it", "fill", *b), clause("put it down", "put", *c)]
    one = line(clauses, [("Take the cup.", g), ("Fill it, then put it down.", h)])
    counts = by_instruction([one])
    assert sum(n for (gold, _), n in counts.items() if gold != NOTHING) == len(one.gold)
    assert sum(n for (_, mine), n in counts.items() if mine != NOTHING) == len(one.predicted)
