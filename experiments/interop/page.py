"""The matrix as tables of ``docs/results/interop.md``."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from experiments.interop.matrix import Cell
from experiments.interop.tools import TOOLS
from tmd.export.formats import FORMATS

BEGIN, END = "<!-- generated: matrix -->", "<!-- end: matrix -->"
_QUESTIONS = (("accepts", "A"), ("solves", "S"), ("validates", "V"), ("confirmed", "O"))


def write(page: Path, cells: Sequence[Cell], versions: Mapping[str, str]) -> None:
    """Put the tables between the markers of a page."""
    text = page.read_text(encoding="utf-8")
    head, _, rest = text.partition(BEGIN)
    _, _, tail = rest.partition(END)
    page.write_text(f"{head}{BEGIN}\n{tables(cells, versions)}{END}{tail}", encoding="utf-8")


def tables(cells: Sequence[Cell], versions: Mapping[str, str]) -> str:
    """All tables."""
    problems = sorted({cell.problem for cell in cells})
    parts = [f"{len(problems)} problems, {len(cells)} cells.\n", _summary(cells, versions)]
    parts += [_details(name, [c for c in cells if c.format == name]) for name in FORMATS]
    return "\n".join(part for part in parts if part)


def _summary(cells: Sequence[Cell], versions: Mapping[str, str]) -> str:
    used = [name for name in FORMATS if any(cell.format == name for cell in cells)]
    lines = [
        "### All problems together\n",
        f"| tool | version | {' | '.join(used)} |",
        f"|---|---|{'---|' * len(used)}",
    ]
    for tool, (_, package) in TOOLS.items():
        of_tool = [cell for cell in cells if cell.tool == tool]
        counts = [_counts([cell for cell in of_tool if cell.format == name]) for name in used]
        if of_tool:
            lines.append(f"| {tool} | {package} {versions.get(package, '(not installed)')} | {' | '.join(counts)} |")
    return "\n".join(lines) + "\n"


def _counts(cells: Sequence[Cell]) -> str:
    """``A 13/13 S 12/13``: of how many problems something holds, where the tool does it at all."""
    found = []
    for key, letter in _QUESTIONS:
        asked = [getattr(cell, key) for cell in cells if getattr(cell, key) is not None]
        if asked:
            found.append(f"{letter} {sum(asked)}/{len(asked)}")
    return "<br>".join(found)


def _details(name: str, cells: Sequence[Cell]) -> str:
    if not cells:
        return ""
    tools = [tool for tool in TOOLS if any(cell.tool == tool for cell in cells)]
    notes: dict[str, int] = {}
    lines = [f"### {name}\n", f"| problem | {' | '.join(tools)} |", f"|---|{'---|' * len(tools)}"]
    by_place = {(cell.problem, cell.tool): cell for cell in cells}
    for problem in sorted({cell.problem for cell in cells}):
        shown = [_cell(by_place.get((problem, tool)), notes) for tool in tools]
        lines.append(f"| {problem} | {' | '.join(shown)} |")
    lines += ["", *(f"{number}. {_escaped(why)}" for why, number in notes.items())] if notes else []
    return "\n".join(lines) + "\n"


def _cell(cell: Cell | None, notes: dict[str, int]) -> str:
    """``A S O``; what failed is struck out, with the number of the note that says why."""
    if cell is None:
        return ""
    letters = _letters((getattr(cell, key), letter) for key, letter in _QUESTIONS)
    if "~" not in letters:
        return letters
    why = f"{cell.tool}: {cell.why or 'it does not say why'}"
    return f"{letters} ({notes.setdefault(why, len(notes) + 1)})"


def _letters(answers: Iterable[tuple[bool | None, str]]) -> str:
    return " ".join(letter if answer else f"~~{letter}~~" for answer, letter in answers if answer is not None)


def _escaped(text: str) -> str:
    plain = text.replace("`", "'")
    return f"`{plain}`"
