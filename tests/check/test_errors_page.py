"""docs/errors.md: every kind is explained, its bad example gives that kind and no other, the good one gives none."""

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
BASE = dict(re.findall(r"<!-- base: (\S+) -->\n`\S+`\n\n```\w+\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL))
KINDS = dict(re.findall(r"^### ([a-z0-9-]+)\n(.*?)(?=^##|\Z)", PAGE, re.MULTILINE | re.DOTALL))
_EXAMPLE = re.compile(r"Bad, in `(\S+)`:\n\n```\w+\n(.*?)\n```\n\nGood:\n\n```\w+\n(.*?)\n```", re.DOTALL)
SHOWN_ELSEWHERE = {
    "unreadable", "not-text", "not-utf8", "too-large", "too-many", "control-character", "nested-too-deeply",
    "empty-file", "missing-file", "ambiguous-domain", "domain-not-found", "too-many-cases",
    "cost-missing", "latin1-comment",
}  # fmt: skip
"""These have no example that a page can show; test_bad_input.py and test_slips.py have them."""


def examples() -> Iterator[tuple[str, str, str, str]]:
    for kind, text in KINDS.items():
        for file, bad, good in _EXAMPLE.findall(text):
            yield kind, file, bad, good


EXAMPLES = list(examples())


def codes(directory: Path) -> set[str]:
    checker = Checker(directory / "domains", None, directory / "problems")
    checker.check(directory)
    checker.finish()
    return {diagnostic.code for diagnostic in checker.findings.sorted()}


def written(directory: Path, stale: bool, **changed: str) -> Path:
    """The files of the page, with changed ones; the shop is compiled."""
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
    assert set(KINDS) == set(SEVERITY)
    assert set(KINDS) - {kind for kind, *_ in EXAMPLES} == SHOWN_ELSEWHERE


def test_the_files_of_the_page_have_no_problems(tmp_path: Path) -> None:
    assert codes(written(tmp_path, stale=False)) == set()


@pytest.mark.parametrize(("kind", "file", "bad", "good"), EXAMPLES, ids=[e[0] for e in EXAMPLES])
def test_an_example(tmp_path: Path, kind: str, file: str, bad: str, good: str) -> None:
    if kind == "overlap":
        pytest.importorskip("pybullet", reason="needs the extra robot")
    assert BASE[file].count(good) >= 1, "the good example does not stand in the file"
    changed = BASE[file].replace(good, bad, 1)
    assert codes(written(tmp_path, kind == "stale-domain", **{file: changed})) == {kind}
