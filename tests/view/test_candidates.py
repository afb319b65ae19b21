"""The table of energies: what it says adds up, and losers and refusals say why."""

from __future__ import annotations

from tests.view.reading import Reader
from tmd.grounded import Grounded
from tmd.inference.energy import title
from tmd.inference.ranking import Choice, PlanStep, RankedPlan
from tmd.inference.ranking import RejectedProposal as Rejected
from tmd.pddl.model import Instruction
from tmd.view.candidates import candidates, factors_of, grouped


def plan(value: float, why: str = "") -> RankedPlan:
    step = PlanStep(Instruction("grasp", ("<b>cup</b>",)), 0, True)
    return RankedPlan((Choice("<i>demo</i>", (step,), {"description_length": value, "zero": 0.0}, {}),), 0, why)


def test_plans_have_their_energies_factors_and_reasons(grounded: Grounded) -> None:
    reader = Reader(candidates(grounded.plans, [v.reason for v in grounded.verdicts], grounded.rejected))
    for ranked in grounded.plans:
        assert f"{ranked.energy:.2f}" in reader.text
        assert ranked.why in reader.text
        assert all(f"{choice.energy:.2f}" in reader.text for choice in ranked.choices)
    for name in factors_of(grounded.plans):
        assert title(name) in reader.text
    assert all(refusal.reason in reader.text for refusal in grounded.rejected)


def test_the_factors_that_are_left_out_add_nothing(grounded: Grounded) -> None:
    shown = factors_of(grounded.plans)
    for ranked in grounded.plans:
        assert abs(sum(ranked.factors.get(name, 0.0) for name in shown) - ranked.energy) < 1e-6


def test_names_are_only_text() -> None:
    reader = Reader(candidates([plan(1.0), plan(-2.5, "<u>why</u>")], ["", "<s>broken</s>"], [Rejected(0, "s", "<q>")]))
    assert not {"b>cup", "i", "u", "s", "q"} & reader.tags()
    assert all(text in reader.text for text in ("<b>cup</b>", "<i>demo</i>", "<u>why</u>", "<s>broken</s>", "<q>"))
    assert "−2.50" in reader.text


def test_refusals_with_one_reason_are_one_row() -> None:
    rows = grouped(
        [
            Rejected(1, "b", "no cup"),
            Rejected(0, "z", "x"),
            Rejected(1, "a", "no cup"),
            Rejected(1, "c", "y"),
        ]
    )
    assert [(row.clause, row.reason, row.sources) for row in rows] == [
        (0, "x", ("z",)), (1, "no cup", ("a", "b")), (1, "y", ("c",)),
    ]  # fmt: skip


def test_without_a_plan_the_refusals_are_open() -> None:
    reader = Reader(candidates([], refusals=[Rejected(0, "demo", "there is no cup")]))
    assert "No plan was found." in reader.text
    assert [a for tag, a in reader.elements if tag == "details"] == [{"open": ""}]
