"""``tmd check --explain``: what is known of a verb, and from which file and line."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.bundled import corpus
from tmd.check.explain import explain
from tmd.diagnostics import TmdError

ROOT = Path(__file__).resolve().parents[2]
Tmd = Callable[..., Any]
PLACE = re.compile(r"  (.*?)   \[(.*):(\d+)\]")
TRIED, UNUSED = "rows that are tried, in this order", "rows of base lexicons that are not used here"


def section(text: str, title: str) -> list[str]:
    """Return the lines of a section."""
    lines = text.splitlines()
    start = lines.index(title) + 1
    end = next((n for n in range(start, len(lines)) if not lines[n].startswith(" ")), len(lines))
    return lines[start:end]


def written(file: str, number: str) -> str:
    return (ROOT / file).read_text(encoding="utf-8").splitlines()[int(number) - 1]


def test_english_is_told_with_file_and_line() -> None:
    told = explain("scrubbing", [])
    assert told.startswith("scrub\n")
    english = [PLACE.fullmatch(line) for line in section(told, "English")]
    assert {found[1].partition(":")[0] for found in english if found} >= {"verbs", "families"}
    for found in english:
        assert found and "scrub" in written(found[2], found[3])
    assert "wash" in section(told, "asks for the same, nearest first")[0]
    assert [row.split()[0] for row in section(told, "rows of base lexicons")] == ["clean|wash|rinse|scrub"]


def test_a_verb_that_only_wordnet_has() -> None:
    (line,) = section(explain("juggle", []), "English")
    assert line.startswith("  WordNet: juggle")


def test_rows_are_told_in_order_with_source_and_place() -> None:
    told = explain("fetch", [corpus("03_drawer")])
    place = re.search(r"stands for 'take'   \[(.*):(\d+)\]", told)
    assert place and written(place[1], place[2]).strip() == "fetch: take"
    rows = section(told, TRIED)
    assert rows[0].startswith("  take|hold X: (holding pr2 ?x)  (of 'take', it stands for it; declared)   [")
    sources = [found[1] for row in rows if (found := re.search(r"\b(declared|learned|actions)[,)]", row))]
    assert sources == sorted(sources, key=["declared", "learned", "actions"].index)
    shown = re.search(r"demonstrations: (\d+) of (\d+) clauses", told)
    assert shown and 0 < int(shown[1]) < int(shown[2])


def test_rows_that_do_not_apply_are_told_with_the_reason() -> None:
    unused = "\n".join(section(explain("fill", [corpus("01_blocks")]), UNUSED))
    assert re.search(r"fill V: .*\n +this domain has nothing for \(contains", unused)
    assert "says it already" in "\n".join(section(explain("take", [corpus("03_drawer")]), UNUSED))


def test_an_unknown_verb_has_the_nearest_by_meaning() -> None:
    assert all("it asks for the same" in row for row in section(explain("haul", [corpus("03_drawer")]), TRIED))
    told = explain("barricade", [corpus("03_drawer")])
    assert "no row of any source" in told and "nearest known verbs" not in told
    told = explain("unseal", [corpus("03_drawer")])
    assert "nearest known verbs: open" in told or TRIED in told


def test_a_misspelt_verb_has_the_nearest_in_spelling() -> None:
    assert "nearest known verbs: open" in explain("opeen", [])


def test_what_was_is_written_as_in_a_row() -> None:
    assert "(was (at ?i ?f ?r))" in explain("place", [corpus("03_drawer")])


def test_particles_and_several_domains(tmd: Tmd) -> None:
    told = tmd("check", "--explain", "turn on", "01_blocks", "03_drawer").out
    assert told.startswith("turn on\n")
    assert re.findall(r"^in (.*)$", told, re.MULTILINE) == ["01_blocks", "03_drawer"]


@pytest.mark.parametrize("said", ["", "12", "(open)"])
def test_what_is_not_a_word_is_told(said: str) -> None:
    with pytest.raises(TmdError, match="is not a verb"):
        explain(said, [])


def test_exit_codes(tmd: Tmd) -> None:
    assert tmd("check", "--explain", "open").code == 0
    ended = tmd("check", "--explain", "open", "01_blokcs")
    assert ended.code == 31 and "01_blocks" in ended.err
    assert tmd("check", "--explain", "open", "--strict", "01_blocks").code == 2
    assert tmd("check", "--explain", "open", "--json").code == 2
    assert tmd("check").code == 2
