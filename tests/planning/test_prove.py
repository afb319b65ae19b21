"""Holding the gaps of a plan against another planner."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tmd.diagnostics import TmdError
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits, Cube, Task
from tmd.planning.gap_filler import GapFiller
from tmd.planning.prove import Segment, Verdict, needs, prove
from tmd.planning.result import Answer, Filled, GaveUp, Unreachable


def instruction(text: str) -> Instruction:
    name, *arguments = text.split()
    return Instruction(name, tuple(arguments))


ASKED = (instruction("unscrew honey"), instruction("put honey shelf"))


def gap(pantry: Task) -> tuple[Instruction, ...]:
    answer = GapFiller(pantry).fill(pantry.init, needs([pantry.by_instruction[i] for i in ASKED]))
    assert isinstance(answer, Filled)
    return answer.plan


def test_a_gap_of_the_search_is_optimal(pantry: Task) -> None:
    proofs = prove(pantry, pantry.init, [Segment(gap(pantry), ASKED)], GapFiller(pantry))
    assert [(proof.verdict, proof.cost) for proof in proofs] == [(Verdict.OPTIMAL, 3)]


def test_a_detour_is_found_out(pantry: Task) -> None:
    there = (instruction("go table sink"), instruction("go sink table"))
    proofs = prove(pantry, pantry.init, [Segment(there + gap(pantry), ASKED)], GapFiller(pantry))
    assert [(proof.verdict, proof.cost) for proof in proofs] == [(Verdict.LONGER, 6)]


def test_needs_are_exact(pantry: Task) -> None:
    cubes = needs([pantry.by_instruction[i] for i in ASKED])
    for state in range(0, 1 << len(pantry.atoms), 37):
        first, second = (pantry.by_instruction[i] for i in ASKED)
        works = first.applicable(state) and second.applicable(first.apply(state))
        assert works == any(cube.holds(state) for cube in cubes)


class Says:
    """A planner that always gives one answer."""

    def __init__(self, answer: Answer) -> None:
        self.answer = answer

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        return self.answer


def test_a_reference_that_gives_up_proves_nothing(pantry: Task) -> None:
    (proof,) = prove(pantry, pantry.init, [Segment(gap(pantry), ASKED)], Says(GaveUp("1 s")))
    assert proof.verdict is Verdict.UNPROVEN


@pytest.mark.parametrize(
    ("answer", "message"),
    [(Unreachable("so it is"), "calls a gap unreachable"), (Filled((), 0, 99), "the reference needs 99")],
)
def test_a_contradiction_is_loud(answer: Answer, message: str, pantry: Task) -> None:
    with pytest.raises(TmdError, match=message):
        prove(pantry, pantry.init, [Segment(gap(pantry), ASKED)], Says(answer))


def test_plans_that_cannot_be_executed_are_refused(pantry: Task) -> None:
    with pytest.raises(TmdError, match="does not apply"):
        prove(pantry, pantry.init, [Segment((), ASKED)], Says(GaveUp("1 s")))
    with pytest.raises(TmdError, match="can never be done"):
        prove(pantry, pantry.init, [Segment((), (instruction("fly honey"),))], Says(GaveUp("1 s")))
