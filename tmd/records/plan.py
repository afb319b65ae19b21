"""``plan.json`` of ``tmd export``: a planned problem, in a form specific to tmd, as there is no common standard."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from tmd.json_record import JsonRecord

FORMAT: Literal["tmd-plan-1"] = "tmd-plan-1"


class StepRecord(JsonRecord):
    """An instruction of the plan, and what it changes."""

    action: str = Field(description="The name of the action.")
    args: list[str] = Field(description="Its arguments, in the order of the action's parameters.")
    cost: int = Field(ge=0, description="What it adds to the cost of the plan.")
    gained: list[list[str]] = Field(description="Atoms that hold after it and did not before: [predicate, argument …].")
    lost: list[list[str]] = Field(description="Atoms that held before it and do not after.")


class PlanRecord(JsonRecord):
    """A problem, its plan, and what each instruction of the plan changes."""

    WHAT = "a plan that tmd export wrote"
    REMAKE = "make it again with tmd export --format json"

    format: Literal["tmd-plan-1"] = Field(default=FORMAT, description="The name of this form and its version.")
    domain: str = Field(description="The name of the domain.")
    problem: str = Field(description="The name of the problem.")
    domain_pddl: str = Field(description="The domain, as flat typed ADL.")
    problem_pddl: str = Field(description="The problem.")
    cost: int = Field(ge=0, description="The cost of the plan.")
    steps: list[StepRecord] = Field(description="The plan.")
