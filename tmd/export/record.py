"""A planned problem as the record of ``plan.json``, and back; ``plan.schema.json`` beside it is its JSON Schema."""

from __future__ import annotations

import json

from tmd.export.planned_problem import Planned, planned
from tmd.pddl.model import Instruction, State
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.semantics import cost
from tmd.pddl.writer import format_domain, format_problem
from tmd.records.plan import PlanRecord, StepRecord


def format_record(source: Planned) -> str:
    """Return the record of a planned problem as JSON.

    Raises:
        TmdError: The problem cannot be written in the form that other tools read.
    """
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
    record = PlanRecord(
        domain=plain.domain.name,
        problem=plain.name,
        domain_pddl=format_domain(plain.domain),
        problem_pddl=format_problem(plain),
        cost=source.cost,
        steps=steps,
    )
    return json.dumps(record.model_dump(), ensure_ascii=False, indent=2) + "\n"


def _words(atoms: State) -> list[list[str]]:
    return [[atom.predicate, *atom.args] for atom in sorted(atoms)]


def format_schema() -> str:
    """Return the JSON Schema of :class:`PlanRecord`."""
    return json.dumps(PlanRecord.model_json_schema(), ensure_ascii=False, indent=2) + "\n"


def parse_record(text: str, file: str = "<text>") -> Planned:
    """Return the planned problem in a record.

    Raises:
        TmdError: The text is not a record, or its plan does not work.
    """
    read = PlanRecord.from_text(text, file)
    domain = parse_domain(read.domain_pddl, f"{file}: domain_pddl")
    problem = parse_problem(read.problem_pddl, domain, f"{file}: problem_pddl")
    return planned(problem, [Instruction(step.action, tuple(step.args)) for step in read.steps])
