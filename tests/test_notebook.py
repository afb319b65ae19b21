"""The notebook: its cells run one after another, and print and show what stands below them.

``python -m tests.test_notebook`` writes their outputs again. Cells with the tag ``notebook`` need that extra; what
pandas and matplotlib draw is not compared.
"""

from __future__ import annotations

import ast
import base64
import contextlib
import io
import json
import os
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[1]
NOTEBOOK = ROOT / "docs" / "tour.ipynb"
DRAWN = "notebook"


def cells() -> list[dict[str, Any]]:
    return [cell for cell in json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == "code"]


def drawn(cell: dict[str, Any]) -> bool:
    return DRAWN in cell["metadata"].get("tags", ())


def can_draw() -> bool:
    return find_spec("pandas") is not None and find_spec("matplotlib") is not None


def outputs(source: str, names: dict[str, object], count: int) -> list[dict[str, Any]]:
    """What a notebook stores for a cell: what it prints, and the value of its last line."""
    tree = ast.parse(source)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(tree, NOTEBOOK.name, "exec"), names)
        value = eval(compile(ast.Expression(last.value), NOTEBOOK.name, "eval"), names) if last else None
    text = printed.getvalue()
    found: list[dict[str, Any]] = []
    if text:
        found.append({"name": "stdout", "output_type": "stream", "text": text.splitlines(keepends=True)})
    if value is not None:
        shown = {"data": dict(forms(value)), "execution_count": count, "metadata": {}, "output_type": "execute_result"}
        found.append(shown)
    return found


def forms(value: object) -> Iterator[tuple[str, Any]]:
    """The forms in which a notebook stores a value; frames are left out, which no viewer of stored ones shows."""
    if hasattr(value, "figure"):
        picture = io.BytesIO()
        value.figure.savefig(picture, format="png", metadata={"Software": None})
        yield "image/png", base64.b64encode(picture.getvalue()).decode()
    html = getattr(value, "_repr_html_", lambda: None)()
    if html and not html.startswith("<iframe"):
        yield "text/html", html.splitlines(keepends=True)
    yield "text/plain", repr(value).splitlines(keepends=True)


def ran(directory: Path) -> Iterator[tuple[dict[str, Any], list[dict[str, Any]]]]:
    """Each cell that can be run here, with its outputs; the files that it writes come into a directory."""
    names: dict[str, object] = {}
    if can_draw():
        import matplotlib

        matplotlib.use("agg")
    with contextlib.chdir(directory):
        for count, cell in enumerate(cells(), start=1):
            if not drawn(cell) or can_draw():
                yield cell, outputs("".join(cell["source"]), names, count)


def test_the_cells_show_what_stands_below_them(tmp_path: Path, learned: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    for name in ("domains", "problems"):
        (tmp_path / name).symlink_to(ROOT / name)
    compared = 0
    for cell, found in ran(tmp_path):
        if not drawn(cell):
            assert found == cell["outputs"], f"{''.join(cell['source'])}\nwrite it again: python -m tests.test_notebook"
            compared += 1
    assert compared > 5


def test_the_notebook_is_one() -> None:
    book = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
    assert (book["nbformat"], book["nbformat_minor"]) == (4, 5)
    names = [cell["id"] for cell in book["cells"]]
    assert len(names) == len(set(names))
    assert [cell["execution_count"] for cell in cells()] == list(range(1, len(cells()) + 1))


def rewrite() -> None:
    """Write the outputs of all cells that can be run here into the notebook again."""
    import tempfile

    book = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as directory:
        for name in ("domains", "problems"):
            (Path(directory) / name).symlink_to(ROOT / name)
        found = {cell["id"]: shown for cell, shown in ran(Path(directory))}
    code = (cell for cell in book["cells"] if cell["cell_type"] == "code")
    for count, cell in enumerate(code, start=1):
        cell["execution_count"] = count
        cell["outputs"] = found.get(cell["id"], cell["outputs"])
    NOTEBOOK.write_text(json.dumps(book, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    os.environ["COLUMNS"] = "100"
    rewrite()
    sys.exit()
