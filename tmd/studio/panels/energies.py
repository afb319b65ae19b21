"""Ranked plans in a narrow panel: why the others lost, then energies with a column for each plan, then refusals."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from tmd.inference.ranking import RankedPlan, Refusal
from tmd.view.candidates import factors_of, grouped
from tmd.view.markup import number


def energies(plans: Sequence[RankedPlan], verdicts: Sequence[str] = (), refusals: Sequence[Refusal] = ()) -> str:
    """What :func:`tmd.view.candidates.candidates` tells, as HTML that fits into a panel.

    Args:
        plans: The plans, least energy first.
        verdicts: For each plan why it does not work, empty for one that does.
        refusals: Templates that could not be used.
    """
    pieces = [_losers(plans, verdicts), _factors(plans), *_clauses(plans), _refused(refusals)]
    return "".join(pieces)


def _losers(plans: Sequence[RankedPlan], verdicts: Sequence[str]) -> str:
    lines = []
    for index, plan in enumerate(plans):
        reasons = [f"does not work: {verdict}" for verdict in verdicts[index : index + 1] if verdict]
        reasons += [plan.why] if index and plan.why else []
        if reasons:
            lines.append(f"<li><b>Plan {index + 1}</b> {escape('; '.join(reasons))}</li>")
    return f"<h4>Why the others lost</h4><ul>{''.join(lines)}</ul>" if lines else ""


def _factors(plans: Sequence[RankedPlan]) -> str:
    if not plans:
        return ""
    head = "".join(f"<th scope='col'>plan {index}</th>" for index in range(1, len(plans) + 1))
    rows = [("energy", [f"<b>{number(plan.energy)}</b>" for plan in plans])]
    rows += [(name, [number(plan.factors.get(name, 0.0)) for plan in plans]) for name in factors_of(plans)]
    rows.append(("steps", [str(len(plan.steps)) for plan in plans]))
    body = "".join(
        f"<tr><th scope='row'>{escape(name)}</th>{''.join(f'<td>{value}</td>' for value in values)}</tr>"
        for name, values in rows
    )
    return (
        f"<h4>Energies by factor</h4><table class='numbers'><thead><tr><td></td>{head}</tr></thead>"
        f"<tbody>{body}</tbody></table>"
    )


def _clauses(plans: Sequence[RankedPlan]) -> list[str]:
    return [
        f"<details><summary>Plan {index} by clause</summary><ol>{_choices(plan)}</ol></details>"
        for index, plan in enumerate(plans, start=1)
    ]


def _choices(plan: RankedPlan) -> str:
    lines = []
    owners = [goal.clause for goal in plan.goals] or range(len(plan.choices))
    for owner, choice in zip(owners, plan.choices, strict=True):
        parts = [f"{name} {number(value)}" for name, value in choice.factors.items() if round(value, 2)]
        source = choice.source if choice.source is not None else "no template"
        told = f"<b>{number(choice.energy)}</b> {escape(', '.join(parts))}<br>from {escape(source)}"
        lines.append(f"<li value='{owner + 1}'>{told}</li>")
    return "".join(lines)


def _refused(refusals: Sequence[Refusal]) -> str:
    rows = grouped(refusals)
    if not rows:
        return ""
    lines = "".join(
        f"<li>Clause {row.clause + 1}: {escape(row.reason)} <span class='quiet'>({len(row.sources)}, for example "
        f"{escape(row.sources[0])})</span></li>"
        for row in rows
    )
    word = "reason" if len(rows) == 1 else "reasons"
    return (
        f"<details><summary>{len(rows)} {word} why templates could not be used here</summary><ul>{lines}</ul></details>"
    )
