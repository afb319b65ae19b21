"""The order of the paper's rows here and in the paper, and what was measured of the reasons."""

from __future__ import annotations

from dataclasses import dataclass

from tmd.evaluation.report.headline import sure
from tmd.evaluation.report.rows import FULL, TABLE_2, difference, title
from tmd.records.metrics import Difference, Metrics

# The rows that check nothing and are stronger than those of the paper.
_STRONGER = ("templates", "tree")


@dataclass(frozen=True, slots=True)
class OtherOrder:
    """Two rows of Table II that stand in another order here.

    Attributes:
        better: The row that is ahead here.
        worse: The row that is ahead in the paper.
        here: ``better`` minus ``worse`` in this run.
        there: The same in the paper, below 0.
    """

    better: str
    worse: str
    here: Difference
    there: float


def other_order(metrics: Metrics) -> tuple[list[OtherOrder], int]:
    """Return the pairs of the paper's rows whose order by IED is another here, and the number of all such pairs.

    The paper's numbers are those of its average; the greatest differences of this run come first.
    """
    found, count = [], 0
    for pair in metrics.significance.pairs:
        if pair.a not in TABLE_2 or pair.b not in TABLE_2:
            continue
        count += 1
        there = TABLE_2[pair.a].average[0] - TABLE_2[pair.b].average[0]
        seen = pair if pair.IED.difference > 0 else pair.seen_from(pair.b)
        if there * pair.IED.difference < 0:
            found.append(OtherOrder(seen.a, seen.b, seen.IED, -abs(there)))
    return sorted(found, key=lambda each: -each.here.difference), count


def reasons(metrics: Metrics) -> list[str]:
    """Return why the order may be another, as far as the rows of this run measure it."""
    rows, found = metrics.models, []
    stronger = [model for model in _STRONGER if model in rows]
    if stronger:
        shares = [f"{rows[model].executable:.0f} % of what {title(model)} predicts" for model in stronger]
        chief = f", and {rows[FULL].executable:.0f} % of what {title(FULL)} predicts" if FULL in rows else ""
        found.append(
            "Predefined Templates and Instruction-Tree are not those of 2014. The library was written by people who "
            "had seen environments of this domain; the tree chooses among well-formed instructions only. Neither is "
            f"held to what can be executed: {' and '.join(shares)} can be{chief}."
        )
    if extended := difference(metrics, "paper_extended", "paper", "IED"):
        found.append(
            "The paper's model as printed maps a noun to a variable only where both clauses share the noun or a "
            "relation. With related nouns and nouns paired in order of mention, and the same weights, IED changes by "
            f"{extended.difference:+.1f} ({sure(extended)})."
        )
    if by_hand := difference(metrics, FULL, "paper", "IED"):
        found.append(
            f"Learning the weights instead of setting them by hand changes IED by {by_hand.difference:+.1f} "
            f"({sure(by_hand)})."
        )
    return found
