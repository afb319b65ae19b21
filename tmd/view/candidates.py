"""Ranked plans: the energy of each by factor and by clause, why each lost, and what could not be used at all."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from typing import NamedTuple

from tmd.inference.energy import meaning, title
from tmd.inference.ranking import RankedPlan, RejectedProposal
from tmd.view.markup import templates


class RefusedCandidate(NamedTuple):
    """Templates of a clause that cannot be used here for one and the same reason."""

    clause: int
    reason: str
    sources: tuple[str, ...]


def candidates(
    plans: Sequence[RankedPlan],
    verdicts: Sequence[str] = (),
    refusals: Sequence[RejectedProposal] = (),
    *,
    narrow: bool = False,
    corrected: bool = False,
) -> str:
    """Render ranked plans as a fragment of HTML: a table of energies, then each clause's, then the refusals.

    ``verdicts`` say why a plan does not work, empty for one that does. A ``narrow`` fragment fits into a panel of the
    studio: a column for each plan instead of each factor. ``corrected``: the first plan is first because somebody
    corrected a plan so, whatever its energy.
    """
    names = factors_of(plans)
    return (
        templates()
        .get_template("candidates_narrow.html.j2" if narrow else "candidates.html.j2")
        .render(
            plans=plans,
            verdicts=[verdicts[i] if i < len(verdicts) else "" for i in range(len(plans))],
            factors={name: title(name) for name in names},
            meanings={name: meaning(name) for name in names},
            title_of=title,
            refused=grouped(refusals),
            corrected=corrected,
        )
    )


def factors_of(plans: Sequence[RankedPlan]) -> list[str]:
    """Return the factors that are not 0 in every plan, those that weigh most first."""
    weight: defaultdict[str, float] = defaultdict(float)
    for plan in plans:
        for name, value in plan.factors.items():
            weight[name] += round(abs(value), 6)
    return sorted((name for name in weight if weight[name]), key=lambda name: (-weight[name], name))


def grouped(refusals: Sequence[RejectedProposal]) -> list[RefusedCandidate]:
    """Group refusals by clause and reason, the most frequent reasons of a clause first."""
    found: defaultdict[tuple[int, str], set[str]] = defaultdict(set)
    for refusal in refusals:
        found[refusal.clause, refusal.reason].add(refusal.source)
    rows = [RefusedCandidate(clause, reason, tuple(sorted(sources))) for (clause, reason), sources in found.items()]
    return sorted(rows, key=lambda row: (row.clause, -len(row.sources), row.reason))
