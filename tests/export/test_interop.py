"""The part of the matrix of tools that is quick: what is installed here must take what we write.

The whole matrix is ``python -m experiments.interop``; its table is in ``docs/export.md``.
"""

from __future__ import annotations

import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import pytest

from experiments.interop.matrix import exported, measure
from experiments.interop.page import BEGIN, END, tables
from experiments.interop.tools import TOOLS
from tests.export.conftest import ROOT, planned_case

CELLS = [(tool, form) for tool, (kind, _) in TOOLS.items() for form in kind.formats]
SECONDS = 60.0


@pytest.fixture(scope="module")
def blocks(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The three blocks in every format."""
    return exported(planned_case("blocks"), "blocks", tmp_path_factory.mktemp("interop"))


@pytest.mark.parametrize(("tool", "form"), CELLS, ids=[f"{tool}-{form}" for tool, form in CELLS])
def test_it_takes_what_we_write(tool: str, form: str, blocks: Path) -> None:
    package = TOOLS[tool][1]
    try:
        version(package)
    except PackageNotFoundError:
        pytest.skip(f"{package} is not installed; it is not a dependency of development")
    cell = measure(planned_case("blocks"), "blocks", blocks, tool, form, sys.executable, SECONDS)
    assert cell.accepts, cell.why
    assert cell.solves is not False, cell.why
    assert cell.validates is not False, cell.why
    assert cell.confirmed is not False, cell.why
    assert f"| {tool} |" in tables([cell], {}) and "A 1/1" in tables([cell], {})


def test_the_page_has_the_table() -> None:
    page = (ROOT / "docs" / "export.md").read_text(encoding="utf-8")
    _, _, rest = page.partition(BEGIN)
    table, found, _ = rest.partition(END)
    assert found
    for tool in TOOLS:
        assert f"| {tool} |" in table
