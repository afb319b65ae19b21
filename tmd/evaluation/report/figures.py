"""The charts of a report, as SVG that takes ink and typeface from its page.

The colours are those of Okabe and Ito, which colour-blind people can distinguish; nothing depends on colour alone. The
same numbers give the same bytes.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from tmd.records.fit import CurvePoint, Fit
from tmd.records.metrics import EXECUTABLE, SUCCESS, Means, Metrics

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# What the columns are called.
LABELS = {
    SUCCESS: "success %",
    "IED": "IED",
    "EED": "EED",
    "EED_trim": "EED-trim",
    "END": "END",
    EXECUTABLE: "executable %",
}
_INK = "#010203"
_FAINT = "#040506"
# Written by the charts, and replaced: the page knows whether it is light or dark.
_COLOURS_OF_THE_PAGE = {_INK: "currentColor", _FAINT: "var(--rule)"}
_BAR = "#0072b2"
_SERIES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
_SIDES = {"loss": "loss (0 to 1)", "objective": "objective"}
_WIDTH = 9.0
_STYLE: dict[Any, Any] = {
    "axes.edgecolor": _FAINT,
    "axes.labelcolor": _INK,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlelocation": "left",
    "axes.titlesize": 10,
    "font.family": "sans-serif",
    "font.size": 9,
    "grid.color": _FAINT,
    "grid.linewidth": 0.5,
    "svg.fonttype": "none",
    "text.color": _INK,
    "text.parse_math": False,
    "xtick.color": _INK,
    "ytick.color": _INK,
    "xtick.major.size": 0,
    "ytick.major.size": 0,
}


def overall_bars(metrics: Metrics, models: Sequence[str], columns: Sequence[str]) -> str:
    """Return a panel for each column, a bar with its standard error for each row: averages over tasks."""
    rows = {model: metrics.models[model].average for model in models}
    floor = metrics.floor.average if metrics.floor else None
    return _bar_chart("overall", [("", rows, floor)], columns, 0.9 + 0.28 * len(models))


def task_bars(metrics: Metrics, models: Sequence[str], columns: Sequence[str]) -> str:
    """Return the same for each task: a line of panels for each."""
    lines = []
    for task in tasks_of(metrics):
        rows = {model: metrics.models[model].tasks[task] for model in models if task in metrics.models[model].tasks}
        floor = metrics.floor.tasks.get(task) if metrics.floor else None
        lines.append((f"{task.replace('_', ' ')}: ", rows, floor))
    return _bar_chart("tasks", lines, columns, (0.5 + 0.2 * len(models)) * len(lines) + 0.5)


def _bar_chart(
    name: str, lines: Sequence[tuple[str, Mapping[str, Means], Means | None]], columns: Sequence[str], height: float
) -> str:
    """Return lines of panels, one panel for each column; a line is the beginning of its titles, its rows, the floor."""
    with _figure(name, len(lines), len(columns), height) as (figure, axes):
        for number, (title, rows, floor) in enumerate(lines):
            line = axes[number * len(columns) : (number + 1) * len(columns)]
            for axis, column in zip(line, columns, strict=True):
                _bars(axis, list(rows.values()), column, None if column == EXECUTABLE else floor)
                axis.set_title(title + LABELS[column])
            line[0].set_yticks(range(len(rows)), list(rows))
        return _svg(figure, name)


def learning_curves(fits: Sequence[Fit], model: str) -> str | None:
    """Draw loss and objective over the epochs, a line for each training set; ``None`` without a curve."""
    own = [fit for fit in fits if fit.model == model]
    worlds = sorted({world for fit in own for world in fit.worlds})
    curves = {world: [fit.worlds[world].points for fit in own if world in fit.worlds] for world in worlds}
    points = [point for found in curves.values() for curve in found for point in curve]
    sides = [side for side in _SIDES if any(getattr(point, side) is not None for point in points)]
    if not sides:
        return None
    with _figure(f"curve-{model}", 1, len(sides), 2.6) as (figure, axes):
        for axis, side in zip(axes, sides, strict=True):
            for number, (world, found) in enumerate(curves.items()):
                _lines(axis, found, side, _SERIES[number % len(_SERIES)], world)
            axis.set_title(_SIDES[side])
            axis.set_xlabel("epoch, over all rounds")
            axis.locator_params(axis="x", integer=True)
            axis.grid(axis="y")
        if len(worlds) > 1:
            axes[-1].legend(frameon=False)
        return _svg(figure, f"curve-{model}")


def _lines(axis: Axes, curves: Sequence[Sequence[CurvePoint]], side: str, colour: str, label: str) -> None:
    """Draw the curves of one kind of world, and the beginnings of its rounds."""
    for number, curve in enumerate(curves):
        told = [(n, value) for n, point in enumerate(curve) if (value := getattr(point, side)) is not None]
        x, y = [n for n, _ in told], [value for _, value in told]
        once = "_nolegend_" if number else label
        axis.plot(x, y, color=colour, linewidth=1.1, alpha=0.75, marker=".", markersize=4, label=once)
    for edge in _round_edges(curves):
        axis.axvline(edge, color=_FAINT, linewidth=0.8, linestyle=":")


def tasks_of(metrics: Metrics) -> list[str]:
    """Return the tasks of a run, by name."""
    return sorted({task for row in metrics.models.values() for task in row.tasks})


def _bars(axis: Axes, rows: Sequence[Means], column: str, floor: Means | None) -> None:
    """Draw horizontal bars from 0 to 100, the first row at the top; none for a mean of nothing."""
    told = [(place, row.mean(column), row.se(column)) for place, row in enumerate(rows)]
    bars = [(place, mean, error or 0.0) for place, mean, error in told if mean is not None]
    places, means, errors = [list(part) for part in zip(*bars, strict=True)] or ([], [], [])
    axis.barh(places, means, height=0.62, color=_BAR, xerr=errors, error_kw={"ecolor": _INK, "elinewidth": 1.0})
    for place, mean, error in bars:
        axis.text(mean + error + 2, place, f"{mean:.1f}", va="center", fontsize=8)
    lowest = None if floor is None else floor.mean(column)
    if lowest is not None:
        axis.axvline(lowest, color=_SERIES[1], linewidth=1.0, linestyle="--")
    axis.set_xlim(0, 130)
    axis.set_xticks([0, 50, 100])
    axis.set_ylim(len(rows) - 0.4, -0.6)
    axis.set_yticks([])
    axis.grid(axis="x")
    axis.set_axisbelow(True)


def _round_edges(curves: Sequence[Sequence[CurvePoint]]) -> list[float]:
    """Return the places between epochs where rounds of several epochs begin, if they are the same everywhere."""
    edges = [[n - 0.5 for n in range(1, len(curve)) if curve[n].round != curve[n - 1].round] for curve in curves]
    if not edges or any(edge != edges[0] for edge in edges) or len(edges[0]) >= len(curves[0]) - 1:
        return []
    return edges[0]


@contextmanager
def _figure(name: str, rows: int, columns: int, height: float) -> Iterator[tuple[Figure, list[Axes]]]:
    """Yield a figure with its panels line by line, under the page's style and no other."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    # what a user's own matplotlibrc says must not change the page
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(_STYLE | {"svg.hashsalt": name})
        figure = Figure(figsize=(_WIDTH, height), layout="constrained")
        yield figure, list(figure.subplots(rows, columns, squeeze=False).flat)


def _svg(figure: Figure, name: str) -> str:
    """Return the figure as an element of a page: without a fixed size, with unique names."""
    drawn = io.StringIO()
    figure.savefig(drawn, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    text = drawn.getvalue()
    text = text[text.index("<svg") :]
    # a style inside the element would hold for the whole page
    text = re.sub(r"<(metadata|style).*?</\1>", "", text, flags=re.DOTALL)
    width = re.search(r'width="([\d.]+)pt"', text)
    assert width is not None
    text = re.sub(r' (width|height)="[\d.]+pt"', "", text, count=2)
    text = text.replace("<svg ", f'<svg style="width: {float(width[1]) * 4 / 3:.0f}px" ', 1)
    text = re.sub(r' xmlns(:xlink)?="[^"]*"', "", text).replace("xlink:href", "href")
    prefix = re.sub(r"\W", "-", name)
    text = re.sub(r'\bid="', f'id="{prefix}-', text)
    text = re.sub(r'(href="|url\()#', rf"\1#{prefix}-", text)
    for written, meant in _COLOURS_OF_THE_PAGE.items():
        text = text.replace(written, meant)
    return re.sub(r"font: ([\d.]+)px [^;\"]*", r"font-size: \1px", text)
