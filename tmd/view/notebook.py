"""Results in notebooks: a grounded request as its page, plans, environments and runs as tables.

Importing this module registers them with :func:`tmd.short_repr.html_of`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from itertools import groupby

from tmd.goals.wording import Wording
from tmd.grounded import Grounded
from tmd.inference.ranking import RankedPlan
from tmd.pddl.model import TRUE, Problem
from tmd.records.metrics import EXECUTABLE, Metrics
from tmd.records.run import RecordedRun, RunRecord
from tmd.short_repr import html_of
from tmd.view.markup import macro
from tmd.view.page import render
from tmd.view.subject import planned_steps, text_subject
from tmd.world.world import World

# Pixels of a page in a notebook.
_HEIGHT = 600


@html_of.register
def _grounded(grounded: Grounded) -> str:
    """Return the page in a frame, so that its style stays its own."""
    page = render(text_subject(grounded)).html
    return f'<iframe srcdoc="{escape(page)}" width="100%" height="{_HEIGHT}"></iframe>'


@html_of.register
def _plan(plan: RankedPlan) -> str:
    rows = [
        (number, step.instruction, f"{step.origin}{', latent' if step.latent else ''}")
        for number, step in enumerate(planned_steps(plan), start=1)
    ]
    goals = "; ".join(goal.words for goal in plan.goals if goal.words)
    return _table(f"{goals or 'plan'}: energy {plan.energy:.4f}", ("", "instruction", "for"), rows)


@html_of.register
def _problem(problem: Problem) -> str:
    by_type = sorted((" or ".join(each.types), each.name) for each in problem.objects)
    rows = [(kind, ", ".join(name for _, name in found)) for kind, found in groupby(by_type, lambda pair: pair[0])]
    goal = "" if problem.goal == TRUE else f"; goal: {Wording(problem).goal(problem.goal)}"
    title = f"{problem.name} of {problem.domain.name}: {len(problem.objects)} objects, {len(problem.init)} facts{goal}"
    return _table(title, ("type", "objects"), rows)


@html_of.register
def _world(world: World) -> str:
    return _problem(world.task.problem)


@html_of.register
def _run(run: RecordedRun) -> str:
    return _record(run.record)


@html_of.register
def _record(record: RunRecord) -> str:
    rows = [(step.number, step.instruction, f"{step.sign} {step.outcome}", step.told) for step in record.steps]
    title = f"{record.text or record.goal or 'a plan'} ({record.environment}): {record.status.replace('_', ' ')}"
    return _table(f"{title}, {record.reason}" if record.reason else title, ("", "instruction", "outcome", "seen"), rows)


@html_of.register
def _metrics(metrics: Metrics) -> str:
    rows = [
        (model, row.n, *(_cell(row.mean(column), row.se(column)) for column in metrics.columns))
        for model, row in metrics.models.items()
    ]
    heads = (f"{c} %" if c == EXECUTABLE else c.replace("_", "-") for c in metrics.columns)
    return _table(f"{metrics.config['task']}, {metrics.config['data']} data", ("model", "n", *heads), rows)


def _cell(mean: float | None, error: float | None) -> str:
    return "–" if mean is None else f"{mean:.1f} ±{error or 0.0:.1f}"


def _table(title: str, head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    return macro("notebook.html.j2", "table", title, head, rows)
