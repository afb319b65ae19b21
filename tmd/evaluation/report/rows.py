"""The rows and columns of the table: their names and order, the paper's numbers, the reference row, the main result.

The table is also made for other programs: as CSV and for LaTeX.

The paper's numbers (Table II, RSS 2014) were measured on VEIL-200, which was not released: they show what kind of
number each row gave there, and compare with no other data.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from urllib.parse import quote

from tmd.evaluation.summary import EMPTY
from tmd.inference.config import DEFAULT
from tmd.records.metrics import EXECUTABLE, SUCCESS, TESTED, Difference, Means, Metrics, Pair

# What the columns are called.
LABELS = {
    SUCCESS: "success %",
    "IED": "IED",
    "EED": "EED",
    "EED_trim": "EED-trim",
    "END": "END",
    EXECUTABLE: "executable %",
}
# The paper's full model.
FULL = "full"
# The tasks of Table II, in its order.
TASKS = ("coffee", "boiling_water", "ramen", "affogato")
# The metrics of Table II, normalised to 100, larger is better.
METRICS = ("IED", "EED")


@dataclass(frozen=True, slots=True)
class PaperRow:
    """A row of Table II. ``scores`` are IED and EED for each of :data:`TASKS`."""

    title: str
    scores: tuple[tuple[float, float], ...]
    average: tuple[float, float]

    def of(self, task: str) -> tuple[float, float]:
        """Return IED and EED of one of :data:`TASKS`."""
        return self.scores[TASKS.index(task)]


def _row(title: str, *numbers: float) -> PaperRow:
    pairs = tuple(zip(numbers[::2], numbers[1::2], strict=True))
    return PaperRow(title, pairs[:-1], pairs[-1])


# The rows of Table II by our short names, in its order.
TABLE_2: dict[str, PaperRow] = {
    "chance": _row("Chance", 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2),
    "templates": _row("Predefined Templates", 14.3, 22.8, 21.5, 38.8, 32.8, 28.7, 14.0, 17.0, 20.7, 26.8),
    "tree": _row("Instruction-Tree", 14.4, 25.7, 11.2, 38.8, 26.3, 25.6, 12.5, 15.9, 16.1, 26.5),
    "no_nl": _row("No NL Instructions", 39.2, 43.9, 21.8, 43.3, 1.2, 15.7, 12.8, 11.5, 18.8, 28.6),
    "nearest": _row("Nearest Environment Instantiation", 63.4, 47.3, 43.5, 50.1, 52.1, 51.4, 45.4, 49.2, 51.1, 49.5),
    "no_domain": _row("Our model, No Domain Knowledge", 78.6, 71.7, 55.7, 55.2, 66.1, 49.5, 51.2, 51.3, 62.9, 56.9),
    "no_latent": _row("Our model, No latent nodes", 78.9, 73.8, 57.0, 58.4, 66.3, 53.9, 51.5, 51.2, 63.4, 59.3),
    "full": _row("Our full model", 76.5, 78.3, 54.5, 61.3, 67.3, 49.4, 53.5, 56.2, 63.0, 61.3),
}

# Titles of rows that the paper does not have.
OURS = {
    "paper": "Full model, weights set by hand",
    "paper_extended": "The paper's model with our extensions, weights set by hand",
    "paper_extended_learned": "The paper's model with our extensions, weights learned",
    "policy": "Policy that proposes and judges",
    "goals": "PDDL goals (the default of tmd ground)",
    "goals_learned": "PDDL goals, weights learned",
    "bayes_risk": "The least expected loss, among plans and what the policy draws",
    "ranked": "Candidates of all proposers, ranked by weights that were learned on the metrics",
    "bayes_risk_plans": "The least expected loss, among the plans of least energy alone",
    "empty": "Empty prediction",
}


def title(model: str) -> str:
    """Return the title of a row: that of the paper, or of :data:`OURS`, or its name."""
    if model in TABLE_2:
        return TABLE_2[model].title
    return OURS.get(model, model)


def in_order(models: Iterable[str]) -> list[str]:
    """Return the rows that the paper has, in its order."""
    given = set(models)
    return [name for name in TABLE_2 if name in given]


def tasks_of(metrics: Metrics) -> list[str]:
    """Return the tasks of a run, by name."""
    return sorted({task for row in metrics.models.values() for task in row.tasks})


# A corrected p below this is marked.
ALPHA = 0.05


def by_merit(metrics: Metrics) -> list[str]:
    """Return the rows, the best first: by the first column, then by the next; the row that predicts nothing is last."""

    def merit(model: str) -> tuple[bool, list[float]]:
        means = (metrics.models[model].mean(column) for column in metrics.columns)
        return model == EMPTY, [-(mean or 0.0) for mean in means]

    return sorted(metrics.models, key=merit)


def best_of(rows: Mapping[str, Means], columns: Sequence[str]) -> frozenset[tuple[str, str]]:
    """Return the best rows of each column, with the column; equal as printed is equally good.

    The row that predicts nothing is never best, nor is any where all others are the same.
    """
    found = set()
    for column in columns:
        means = {row: round(m, 1) for row, own in rows.items() if row != EMPTY and (m := own.mean(column)) is not None}
        if len(set(means.values())) > 1:
            found |= {(row, column) for row, mean in means.items() if mean == max(means.values())}
    return frozenset(found)


def reference(models: Iterable[str]) -> str | None:
    """Return the row that the others are tested against: the default model, the paper's, or the last that predicts."""
    rows = [name for name in models if name != EMPTY]
    return next((name for name in (DEFAULT, FULL) if name in rows), rows[-1] if rows else None)


def difference(metrics: Metrics, a: str, b: str, metric: str) -> Difference | None:
    """Return how a row differs from another in a metric, as ``a`` minus ``b``; ``None`` where it was not tested."""
    found = next((pair for pair in metrics.significance.pairs if {pair.a, pair.b} == {a, b}), None)
    return found.seen_from(a).of(metric) if found is not None and metric in TESTED else None


def differing(pairs: Iterable[Pair], against: str) -> frozenset[tuple[str, str]]:
    """Return the rows that differ from one in a metric, with the metric: corrected p below :data:`ALPHA`."""
    own = [pair.seen_from(against) for pair in pairs if against in (pair.a, pair.b)]
    tested = [(pair.b, metric, found) for pair in own for metric in TESTED if (found := pair.of(metric)) is not None]
    return frozenset((other, metric) for other, metric, found in tested if found.p_holm < ALPHA)


def headline(metrics: Metrics) -> str:
    """Return the row that leads, by how much, and whether that is significant."""
    rows = [model for model in by_merit(metrics) if model != EMPTY]
    if not rows:
        return "No row predicts anything."
    first, *others = rows
    column = metrics.columns[0]
    mean = metrics.models[first].mean(column) or 0.0
    score = f"{mean:.1f} % success" if column == SUCCESS else f"{LABELS[column]} {mean:.1f}"
    if not others:
        return f"{title(first)}: {score}."
    second = others[0]
    ahead = mean - (metrics.models[second].mean(column) or 0.0)
    found = difference(metrics, first, second, column)
    sure = "" if found is None else f" ({_p(found)})"
    told = f"{title(first)}: {score}, {ahead:.1f} more than {title(second)}{sure}."
    best = best_of(metrics.models, TESTED if column == SUCCESS else TESTED[1:])
    also = [LABELS[metric] for metric in TESTED if metric != column and (first, metric) in best]
    return f"{told} It is also the best in {_listed(also)}." if also else told


def _p(found: Difference) -> str:
    """Return the corrected p of a difference: *p = 0.002*, *not significant, p = 0.310*."""
    p = "p < 0.001" if found.p_holm < 0.001 else f"p = {found.p_holm:.3f}"
    return p if found.p_holm < ALPHA else f"not significant, {p}"


def _listed(words: list[str]) -> str:
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1])))


# The rows that check nothing and are stronger than those of the paper.
_STRONGER = ("templates", "tree")


@dataclass(frozen=True, slots=True)
class OtherOrder:
    """Two rows of Table II that stand in another order here.

    ``here`` is ``better`` minus ``worse`` in this run, ``there`` the same in the paper, below 0.
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
            f"{extended.difference:+.1f} ({_p(extended)})."
        )
    if by_hand := difference(metrics, FULL, "paper", "IED"):
        found.append(
            f"Learning the weights instead of setting them by hand changes IED by {by_hand.difference:+.1f} "
            f"({_p(by_hand)})."
        )
    return found


# The task of the lines that are over all examples.
_ALL = "all"
_LATEX = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "±": r"$\pm$"} | {
    special: f"\\{special}" for special in "&%$#_{}"
}


def csv_table(metrics: Metrics, order: Sequence[str]) -> str:
    """Return the means with their standard errors: a line for each row, and for each of its tasks if it has several."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["model", "task", "n", *(name for column in metrics.columns for name in (column, f"{column}_se"))])
    for model in order:
        row = metrics.models[model]
        tasks = sorted(row.tasks.items())
        for task, means in [(_ALL, row), *tasks] if len(tasks) > 1 else tasks:
            cells = (value for column in metrics.columns for value in (means.mean(column), means.se(column)))
            writer.writerow([model, task, means.n, *("" if value is None else value for value in cells)])
    return out.getvalue()


def latex_table(metrics: Metrics, order: Sequence[str]) -> str:
    """Return the table over all examples for LaTeX with the package ``booktabs``; the best of each column is bold."""
    best = best_of(metrics.models, metrics.columns)
    lines = [rf"\begin{{tabular}}{{l{'r' * (len(metrics.columns) + 1)}}}", r"\toprule"]
    lines += [
        " & ".join(["row", "$n$", *(_escaped(LABELS[column]) for column in metrics.columns)]) + r" \\",
        r"\midrule",
    ]
    for model in order:
        row = metrics.models[model]
        cells = [_cell(row, column, bold=(model, column) in best) for column in metrics.columns]
        lines.append(" & ".join([_escaped(title(model)), str(row.n), *cells]) + r" \\")
    return "\n".join([*lines, r"\bottomrule", r"\end{tabular}"]) + "\n"


def _cell(means: Means, column: str, *, bold: bool) -> str:
    mean = means.mean(column)
    if mean is None:
        return "--"
    number = rf"\textbf{{{mean:.1f}}}" if bold else f"{mean:.1f}"
    return rf"{number} $\pm$ {means.se(column) or 0.0:.1f}"


def _escaped(text: str) -> str:
    return "".join(_LATEX.get(letter, letter) for letter in text)


def data_address(text: str, kind: str) -> str:
    """Return an address that holds a text itself, for a link that downloads it."""
    return f"data:text/{kind};charset=utf-8,{quote(text)}"
