"""A planned problem as JSON, in a form of our own: there is no common standard for plans.

The classes here are the documentation of the form; ``plan.schema.json`` is written from them.
"""

from __future__ import annotations

import json
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from tmd.diagnostics import Location, TmdError
from tmd.export.planned_problem import Planned
from tmd.pddl.model import GroundAtom, State
from tmd.pddl.writer import format_domain, format_problem

FORMAT: Literal["tmd-plan-1"] = "tmd-plan-1"


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class StepRecord(_Strict):
    """An instruction of the plan, and what it changes."""

    action: str = Field(description="The name of the action.")
    args: list[str] = Field(description="Its arguments, in the order of the action's parameters.")
    cost: int = Field(ge=0, description="What it adds to the cost of the plan.")
    gained: list[list[str]] = Field(description="Atoms that hold after it and did not before: [predicate, argument …].")
    lost: list[list[str]] = Field(description="Atoms that held before it and do not after.")


class PlanRecord(_Strict):
    """A problem, its plan, and what each instruction of the plan changes."""

    format: Literal["tmd-plan-1"] = Field(default=FORMAT, description="The name of this form and its version.")
    domain: str = Field(description="The name of the domain.")
    problem: str = Field(description="The name of the problem.")
    domain_pddl: str = Field(description="The domain, as flat typed ADL.")
    problem_pddl: str = Field(description="The problem.")
    cost: int = Field(ge=0, description="The cost of the plan.")
    steps: list[StepRecord] = Field(description="The plan.")


def record(source: Planned) -> PlanRecord:
    """A planned problem as a record.

    Raises:
        TmdError: The problem cannot be written in the form that other tools read.
    """
    from tmd.pddl.semantics import cost

    steps = [
        StepRecord(
            action=instruction.name,
            args=list(instruction.args),
            cost=cost(instruction, source.problem),
            gained=_words(after - before),
            lost=_words(before - after),
        )
        for instruction, before, after in zip(source.plan, source.states, source.states[1:], strict=False)
    ]
    plain = source.portable
    return PlanRecord(
        domain=plain.domain.name,
        problem=plain.name,
        domain_pddl=format_domain(plain.domain),
        problem_pddl=format_problem(plain),
        cost=source.cost,
        steps=steps,
    )


def _words(atoms: State) -> list[list[str]]:
    return [[atom.predicate, *atom.args] for atom in sorted(atoms, key=lambda atom: GroundAtom(*atom))]


def format_record(source: Planned) -> str:
    """The record of a planned problem as JSON."""
    return json.dumps(record(source).model_dump(), ensure_ascii=False, indent=2) + "\n"


def format_schema() -> str:
    """The JSON Schema of :class:`PlanRecord`."""
    return json.dumps(PlanRecord.model_json_schema(), ensure_ascii=False, indent=2) + "\n"


def parse_record(text: str, file: str = "<text>") -> Planned:
    """The planned problem in a record.

    Raises:
        TmdError: The text is not a record, or its plan does not work.
    """
    from pydantic import ValidationError

    from tmd.export.planned_problem import planned
    from tmd.pddl.model import Instruction
    from tmd.pddl.reading.reader import parse_domain, parse_problem

    try:
        read = PlanRecord.model_validate_json(text)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"]))
        raise TmdError(
            f"this is no plan record: {where + ': ' if where else ''}{first['msg']}", location=Location(file, 1, 1)
        ) from error
    domain = parse_domain(read.domain_pddl, f"{file}: domain_pddl")
    problem = parse_problem(read.problem_pddl, domain, f"{file}: problem_pddl")
    return planned(problem, [Instruction(step.action, tuple(step.args)) for step in read.steps])
