"""Alignments are Levenshtein's, and read well."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.evaluation.metrics import levenshtein
from tmd.evaluation.report.predictions import Mark, align, name, words

SEQUENCES = st.lists(st.sampled_from(["grasp(a)", "grasp(b)", "moveto(a)", "moveto(b)", "wait()"]), max_size=9)


@given(SEQUENCES, SEQUENCES)
def test_the_steps_that_do_not_match_are_the_edit_distance(predicted: list[str], gold: list[str]) -> None:
    steps = align(predicted, gold)
    assert sum(step.mark is not Mark.MATCH for step in steps) == levenshtein(predicted, gold)
    assert [step.predicted for step in steps if step.predicted is not None] == list(range(len(predicted)))
    assert [step.gold for step in steps if step.gold is not None] == list(range(len(gold)))
    for step in steps:
        if step.predicted is None:
            assert step.mark is Mark.MISSING
        elif step.gold is None:
            assert step.mark is Mark.SUPERFLUOUS
        else:
            same = predicted[step.predicted] == gold[step.gold]
            assert step.mark is (Mark.MATCH if same else Mark.SUBSTITUTED)


def test_of_equal_alignments_the_one_that_puts_like_beside_like_is_taken() -> None:
    steps = align(["moveto(a)", "grasp(a)"], ["grasp(b)"])
    assert [(step.mark, step.predicted, step.gold) for step in steps] == [
        (Mark.SUPERFLUOUS, 0, None),
        (Mark.SUBSTITUTED, 1, 0),
    ]


def test_like_beside_like_never_costs_an_edit() -> None:
    predicted, gold = ["a(1)", "b(1)", "c(1)"], ["b(2)", "c(2)", "a(2)"]
    assert len(align(predicted, gold)) == levenshtein(predicted, gold) == 3


@pytest.mark.parametrize("written", ["keep(Mug_1, sink, on)", "keep Mug_1 Sink On", "KEEP(mug_1,sink,ON)"])
def test_both_notations_are_read(written: str) -> None:
    assert words(written) == ("keep", "mug_1", "sink", "on")
    assert name(written) == "keep"


def test_nothing_aligns_with_nothing() -> None:
    assert align([], []) == ()
    assert name("") == ""
