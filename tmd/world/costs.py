"""Costs of instructions, as ``skills.yaml`` of a domain gives them with ``cost:``.

They become action costs of the PDDL problem, so that every planner minimises them: the searches in this process, and
other programs, which read PDDL.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from tmd.pddl.model import TOTAL_COST, ActionSchema, Predicate, Problem
from tmd.world.yaml_positions import YamlSource

_REQUIREMENT = ":action-costs"


class _Skill(BaseModel):
    model_config = ConfigDict(defer_build=True, extra="ignore")
    cost: Annotated[int, Field(strict=True, ge=0)] | None = None


class _File(BaseModel):
    """The costs in ``skills.yaml``; all else in it is the robot's."""

    model_config = ConfigDict(defer_build=True, extra="ignore")
    skills: dict[str, _Skill] = {}


def read_costs(path: Path) -> dict[str, int]:
    """Return the costs that a file gives, by action; none where there is no file.

    Raises:
        TmdError: The file is wrong, or a cost is not a whole number of at least 0; with the place.
    """
    if not path.is_file():
        return {}
    skills = YamlSource(path).load(_File).skills
    return {name: skill.cost for name, skill in skills.items() if skill.cost is not None}


def with_costs(problem: Problem, costs: Mapping[str, int]) -> Problem:
    """Return the problem with costs of actions, which it minimises; an action without one costs 1, or what it says."""
    if not costs:
        return problem
    domain = problem.domain
    functions = domain.functions
    if all(function.name != TOTAL_COST for function in functions):
        functions = (*functions, Predicate(TOTAL_COST, ()))
    domain = replace(
        domain,
        requirements=tuple(dict.fromkeys((*domain.requirements, _REQUIREMENT))),
        functions=functions,
        actions=tuple(_priced(action, costs) for action in domain.actions),
    )
    return replace(problem, domain=domain, minimize_cost=True)


def _priced(action: ActionSchema, costs: Mapping[str, int]) -> ActionSchema:
    own = 1 if action.cost is None else action.cost
    return replace(action, cost=costs.get(action.name, own))
