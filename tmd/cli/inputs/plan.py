"""The plan of a run: the best plan of a text, a plan for a goal, or the plan of a file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tmd.diagnostics import ExitCode, TmdError
from tmd.robot.monitor.listeners import Order

if TYPE_CHECKING:
    from tmd.cli.inputs.options import ReadingOptions
    from tmd.records.grounding import GroundingRecord
    from tmd.world.corpus import Corpus
    from tmd.world.world import World


@dataclass(frozen=True, slots=True)
class Orders:
    """A plan, or why there is none.

    Attributes:
        orders: The plan.
        code: ``OK``, or what the program ends with because there is none.
        status: ``not_grounded``, ``question``, ``unreachable``, ``gave_up`` or ``invalid_plan``; empty for a plan.
        remarks: Lines for standard error.
        grounding: What ``tmd ground --json`` prints of the text; nothing where there was none.
    """

    orders: tuple[Order, ...]
    code: ExitCode = ExitCode.OK
    status: str = ""
    remarks: tuple[str, ...] = ()
    grounding: GroundingRecord | None = None


def orders_of_text(
    text: str,
    corpus: Corpus,
    world: World,
    environment: str,
    planner: str,
    reading: ReadingOptions,
    learned: Path | None = None,
) -> Orders:
    """Ground a text, as ``tmd ground`` does with its usual options; ``environment`` is as it was given.

    Where two readings of the text differ there is no plan: the robot does not guess.

    Raises:
        TmdError: The planner is unknown or not installed, or the demonstrations are wrong.
    """
    from tmd.cli.inputs.grounding import Answer, made_with
    from tmd.cli.show.grounding import remarks
    from tmd.domain_kit import DomainKit, orders_of

    kit = DomainKit(corpus, learned)
    grounded = kit.ground(
        text, world, planner=planner, reader=reading.reader, llm=reading.settings(), verify=reading.verify
    )
    told = tuple(remarks(grounded))
    record = Answer(grounded, corpus, made_with(planner)).record(environment)
    if grounded.reason:
        return Orders((), ExitCode.NOT_GROUNDED, "not_grounded", told, record)
    if grounded.question is not None:
        return Orders((), ExitCode.QUESTION, "question", told, record)
    return Orders(tuple(orders_of(grounded)), remarks=told, grounding=record)


def orders_of_goal(goal: str, world: World, planner: str | None) -> Orders:
    """Find a plan for a goal, as ``tmd export --goal`` does; an empty one where the goal holds already.

    Raises:
        TmdError: The goal is wrong, or the planner is unknown, not installed or refuses the problem.
    """
    from tmd.cli.show.answer import answer_json, exit_code, why_none
    from tmd.pddl.reading.reader import with_goal
    from tmd.planning.backends import AUTO, solve
    from tmd.planning.result import Solved

    name = planner or AUTO
    answer = solve(with_goal(world.task.problem, goal, "--goal"), name)
    if isinstance(answer, Solved):
        return Orders(tuple(map(Order, answer.plan)))
    status = str(answer_json(answer, name)["status"])
    return Orders((), exit_code(answer), status, (f"no plan: {why_none(answer)}\n",))


def orders_of_file(path: Path, world: World) -> Orders:
    """Read a plan file; a plan that does not work is not begun.

    Raises:
        TmdError: The file cannot be read, or has no instructions.
    """
    from tmd.pddl.plan_file import read_plan
    from tmd.pddl.validator import validate

    plan = read_plan(path)
    if not plan.instructions:
        raise TmdError(f"{path}: the plan has no instructions", hint="write one (name argument ...) a line")
    verdict = validate(world.task.problem, plan.instructions)
    if not verdict.valid:
        place = f"{plan.locations[verdict.step - 1]}: " if verdict.step else ""
        return Orders((), ExitCode.INVALID_PLAN, "invalid_plan", (f"invalid: {place}{verdict.reason}\n",))
    return Orders(tuple(map(Order, plan.instructions)))
