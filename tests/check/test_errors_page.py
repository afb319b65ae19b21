"""docs/errors.md: each kind is explained, its bad example gives that kind and no other, the good one gives none.

The good lines are those of the files in ``page_files/``; a bad example is such a file with the bad lines instead.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from tmd.check.checker import Checker
from tmd.check.diagnostic import SEVERITY
from tmd.diagnostics import TmdError
from tmd.world.compile import compile_domain
from tmd.world.folder import DomainFolder

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "errors.md").read_text(encoding="utf-8")
FILES = Path(__file__).resolve().parent / "page_files"
BASE = {str(path.relative_to(FILES)): path.read_text(encoding="utf-8") for path in FILES.rglob("*") if path.is_file()}
_ROW = re.compile(r"^\| `([a-z0-9-]+)` \| (.+?) \| (`.*`)? ?\| (`.*`)? ?\|$", re.MULTILINE)
KINDS = {kind for kind, *_ in _ROW.findall(PAGE)}
SHOWN_ELSEWHERE = {
    "unreadable", "not-text", "not-utf8", "too-large", "too-many", "control-character", "nested-too-deeply",
    "empty-file", "missing-file", "ambiguous-domain", "domain-not-found", "too-many-cases",
    "cost-missing", "latin1-comment",
}  # fmt: skip
"""These have no example that a page can show; test_bad_input.py and test_slips.py have them."""


def _lines(cell: str) -> list[str]:
    """The lines of code in a cell of the table."""
    return [line.strip("`").replace("\\|", "|") for line in cell.split("<br>")]


def _changed(bad: list[str], good: list[str]) -> tuple[str, str]:
    """The file that has the good lines, and its text with the bad ones; cells lack the indentation of the file."""
    pattern = re.compile(r"\n *".join(re.escape(line.strip()) for line in good))
    name, text = min((name, text) for name, text in BASE.items() if pattern.search(text))
    found = pattern.search(text)
    assert found
    first = found.start() - text.rfind("\n", 0, found.start()) - 1
    shift = first - (len(bad[0]) - len(bad[0].lstrip()))
    new = "\n".join([bad[0].lstrip(), *(" " * shift + line for line in bad[1:])])
    return name, text[: found.start()] + new + text[found.end() :]


def examples() -> Iterator[tuple[str, list[str], list[str]]]:
    """Kind, bad lines and good lines of each row that shows some."""
    for kind, _, bad, good in _ROW.findall(PAGE):
        if bad:
            yield kind, _lines(bad), _lines(good)


EXAMPLES = list(examples())


def codes(directory: Path) -> set[str]:
    checker = Checker(directory / "domains", None, directory / "problems")
    checker.check(directory)
    checker.finish()
    return {diagnostic.code for diagnostic in checker.findings.sorted()}


def written(directory: Path, stale: bool, **changed: str) -> Path:
    """The files in ``page_files/``, with changed ones; the shop is compiled."""
    for name, text in (BASE | changed).items():
        path = directory / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    shop = DomainFolder(directory / "domains" / "shop")
    try:
        compiled = compile_domain(shop)
    except TmdError:
        compiled = ""
    if stale or not compiled:
        (shop.path / "objects.yaml").write_text(BASE["domains/shop/objects.yaml"])
        compiled = compile_domain(DomainFolder(shop.path))
        (shop.path / "objects.yaml").write_text((BASE | changed)["domains/shop/objects.yaml"])
    (shop.path / "domain.pddl").write_text(compiled)
    return directory


def test_every_kind_is_explained() -> None:
    assert set(SEVERITY) == KINDS
    assert KINDS - {kind for kind, *_ in EXAMPLES} == SHOWN_ELSEWHERE


def test_the_good_files_have_no_problems(tmp_path: Path) -> None:
    assert codes(written(tmp_path, stale=False)) == set()


@pytest.mark.parametrize(("kind", "bad", "good"), EXAMPLES, ids=[e[0] for e in EXAMPLES])
def test_an_example(tmp_path: Path, kind: str, bad: list[str], good: list[str]) -> None:
    if kind == "overlap":
        pytest.importorskip("pybullet", reason="needs the extra robot")
    name, text = _changed(bad, good)
    assert codes(written(tmp_path, kind == "stale-domain", **{name: text})) == {kind}
