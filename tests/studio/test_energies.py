from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from tmd.inference.ranking import Choice, PlanStep, RankedPlan
from tmd.inference.ranking import RejectedProposal as Rejected
from tmd.pddl.model import Instruction
from tmd.view.candidates import candidates


def plan(energy: float, source: str | None, why: str = "") -> RankedPlan:
    factors = {"language_model": energy, "clause_distance": 0.0}
    return RankedPlan(
        (Choice(source, (PlanStep(Instruction("wait", ()), 0, False),), factors, factors),), state=0, why=why
    )


def test_each_loser_says_why_and_each_plan_has_a_column() -> None:
    plans = [plan(3.5, "a-01"), plan(4.25, None, "words +0.75")]
    html = candidates(plans, ["", "step 1 does not apply"], narrow=True)
    losers = html.partition("<h4>Energies")[0]
    assert (
        "Plan 2" in losers and "words +0.75" in losers and "does not work: step 1" in losers and "Plan 1" not in losers
    )
    assert html.count('scope="col"') == 2
    assert "3.50" in html and "4.25" in html and "a-01" in html and "no template" in html
    assert ">nl<" not in html  # a factor that is 0 everywhere tells nothing


def test_without_a_plan_there_are_the_refusals() -> None:
    html = candidates([], refusals=[Rejected(0, name, "no stove") for name in ("a-01", "a-02")], narrow=True)
    assert "1 reason" in html and "no stove" in html and "(2, for example" in html and "<table" not in html


@given(st.text())
def test_what_is_told_is_text(said: str) -> None:
    said += "<script>"
    plans = [plan(1.0, said), plan(2.0, said, said)]
    html = candidates(plans, [said, said], [Rejected(0, said, said)], narrow=True)
    assert "<script" not in html


def test_a_corrected_plan_is_first_and_says_so() -> None:
    step = PlanStep(Instruction("wait", ()), 0, False)
    by_hand = RankedPlan((Choice("shown-01", (step, step), {}, {}),), state=0)
    html = candidates([by_hand, plan(3.5, "a-01")], narrow=True, corrected=True)
    assert "<b>Plan 1</b> is first because somebody corrected a plan so; it has no energy" in html
    assert html.count('scope="col"') == 2 and html.count("<td>–</td>") == 1 and "<b>–</b>" in html
    assert "3.50" in html and "shown-01" in html
    found = candidates([plan(4.25, "shown-01"), plan(3.5, "a-01")], narrow=True, corrected=True)
    assert "corrected a plan so</li>" in found and "–" not in found and "4.25" in found
    assert "<b>–</b>" in candidates([by_hand, plan(3.5, "a-01")])
    assert "corrected" not in candidates([plan(4.25, "shown-01"), plan(3.5, "a-01")], narrow=True)
