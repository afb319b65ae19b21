"""Verdicts on plans that say of themselves what is wrong with them."""

from __future__ import annotations

import re
from pathlib import Path

from tmd.pddl.model import Instruction, Problem
from tmd.pddl.plan_file import read_plan
from tmd.pddl.validator import Status, validate

EXPECTED = re.compile(r"; fails: (?:step (\d+)|goal) (.+)")


def test_verdict(plan_path: Path, plan_problem: Problem) -> None:
    plan = read_plan(plan_path)
    verdict = validate(plan_problem, plan.instructions, trace=True)
    if plan_path.name.startswith("valid"):
        assert verdict.valid and verdict.status is Status.VALID and not verdict.reason
        assert len(verdict.trace) == len(plan.instructions) + 1
        cost = re.search(r"; cost = (\d+)", plan_path.read_text(encoding="utf-8"))
        assert verdict.cost == (int(cost[1]) if cost else len(plan.instructions))
        return
    expected = EXPECTED.match(plan_path.read_text(encoding="utf-8"))
    assert expected, "the plan does not say how it fails"
    step = int(expected[1]) if expected[1] else None
    assert not verdict.valid
    assert verdict.step == step
    assert expected[2] in verdict.reason
    if verdict.broken:
        assert verdict.broken.text == expected[2]
    executed = len(plan.instructions) if step is None else step - 1
    assert len(verdict.trace) == executed + 1


def test_the_statuses_are_told_apart(plan_path: Path, plan_problem: Problem) -> None:
    bad = Instruction("no-such-action", ())
    plan = (*read_plan(plan_path).instructions, bad)
    verdict = validate(plan_problem, plan)
    first = validate(plan_problem, plan[:-1])
    if first.step is None:
        assert (verdict.status, verdict.step) == (Status.BAD_INSTRUCTION, len(plan))
        assert verdict.instruction == bad
    else:
        assert verdict == first
