"""The matrix as a table of ``docs/export.md``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.interop.matrix import Cell
from experiments.interop.tools import TOOLS
from tmd.export.formats import FORMATS

BEGIN, END = "<!-- generated: matrix -->", "<!-- end: matrix -->"
_QUESTIONS = (("accepts", "A"), ("solves", "S"), ("validates", "V"), ("confirmed", "O"))


def write(page: Path, cells: Sequence[Cell], versions: Mapping[str, str]) -> None:
    """Put the table between the markers of a page."""
    text = page.read_text(encoding="utf-8")
    head, _, rest = text.partition(BEGIN)
    _, _, tail = rest.partition(END)
    page.write_text(f"{head}{BEGIN}\n{tables(cells, versions)}{END}{tail}", encoding="utf-8")


def tables(cells: Sequence[Cell], versions: Mapping[str, str]) -> str:
    """Return a row for each tool, with the formats in the columns."""
    used = [name for name in FORMATS if any(cell.format == name for cell in cells)]
    lines = [
        f"| tool | version | {' | '.join(used)} |",
        f"| --- | --- |{' --- |' * len(used)}",
    ]
    for tool, (_, package) in TOOLS.items():
        of_tool = [cell for cell in cells if cell.tool == tool]
        counts = [_counts([cell for cell in of_tool if cell.format == name]) for name in used]
        if of_tool:
            lines.append(f"| {tool} | {package} {versions.get(package, '(not installed)')} | {' | '.join(counts)} |")
    return "\n".join(lines) + "\n"


def _counts(cells: Sequence[Cell]) -> str:
    """Return such as ``A 13/13, S 12/13``: of how many problems something holds, where the tool does it at all."""
    found = []
    for key, letter in _QUESTIONS:
        asked = [getattr(cell, key) for cell in cells if getattr(cell, key) is not None]
        if asked:
            found.append(f"{letter} {sum(asked)}/{len(asked)}")
    return ", ".join(found)
