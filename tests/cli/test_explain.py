"""``tmd check --explain``: what is known of a verb, and from which file and line."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.bundled import corpus
from tmd.check.explain import explain, explanation_text
from tmd.diagnostics import TmdError

ROOT = Path(__file__).resolve().parents[2]
Tmd = Callable[..., Any]


def line(file: str, number: int) -> str:
    return (ROOT / file).read_text(encoding="utf-8").splitlines()[number - 1]


def test_english_is_told_with_file_and_line() -> None:
    found = explain("scrubbing", [])
    assert found.verb == "scrub"
    assert {mention.section for mention in found.english} >= {"verbs", "families"}
    for mention in found.english:
        assert "scrub" in line(mention.file, mention.line)
    assert "wash" in found.same
    assert [entry.pattern.partition(" ")[0] for entry in found.bases] == ["clean|wash|rinse|scrub"]


def test_a_verb_that_only_wordnet_has() -> None:
    found = explain("juggle", [])
    assert [mention.section for mention in found.english] == ["WordNet"]


def test_rows_are_told_in_order_with_source_and_place() -> None:
    (drawer,) = explain("fetch", [corpus("03_drawer")]).domains
    assert drawer.stands_for is not None
    place = drawer.stands_for
    assert place.verb == "take"
    assert place.file is not None and place.line is not None
    assert line(place.file, place.line).strip() == "fetch: take"
    first = next(one for one in drawer.rows if one.file is not None)
    assert (first.verb, first.pattern, first.source) == ("take", "take|hold X", "declared")
    assert [one.source for one in drawer.rows] == sorted(
        (one.source for one in drawer.rows), key=["declared", "learned", "actions"].index
    )
    assert 0 < drawer.demonstrations.shown < drawer.demonstrations.clauses


def test_rows_that_do_not_apply_are_told_with_the_reason() -> None:
    (blocks,) = explain("fill", [corpus("01_blocks")]).domains
    reasons = {one.pattern: one.reason for one in blocks.unused}
    assert reasons["fill V: (contains ?v water)".partition(":")[0]].startswith("this domain has nothing for (contains")
    (drawer,) = explain("take", [corpus("03_drawer")]).domains
    assert any("says it already" in one.reason for one in drawer.unused)


def test_an_unknown_verb_has_the_nearest_by_meaning() -> None:
    (drawer,) = explain("haul", [corpus("03_drawer")]).domains
    assert {one.why for one in drawer.rows} == {"it asks for the same"}
    (drawer,) = explain("barricade", [corpus("03_drawer")]).domains
    assert (drawer.rows, drawer.nearest) == ((), ())
    (drawer,) = explain("unseal", [corpus("03_drawer")]).domains
    assert drawer.nearest[:1] == ("open",) or drawer.rows


def test_a_misspelt_verb_has_the_nearest_in_spelling() -> None:
    assert "open" in explain("opeen", []).nearest


def test_text_and_json_say_the_same(tmd: Tmd) -> None:
    told = json.loads(tmd("check", "--explain", "take", "03_drawer", "--json").out)
    assert list(told) == ["verb", "known", "english", "same", "bases", "nearest", "domains"]
    (drawer,) = told["domains"]
    assert drawer["domain"] == "03_drawer"
    assert {"fetch", "get", "grab"} <= set(drawer["serves"])
    text = tmd("check", "--explain", "take", "03_drawer").out
    for row in drawer["rows"][:3]:
        assert f"{row['pattern']}: {row['condition']}" in text
        assert row["file"] is None or f"[{row['file']}:{row['line']}]" in text
    for row in drawer["unused"]:
        assert row["reason"] in text


def test_what_was_is_written_as_in_a_row() -> None:
    assert "(was (at ?i ?f ?r))" in explanation_text(explain("place", [corpus("03_drawer")]))


def test_particles_and_several_domains(tmd: Tmd) -> None:
    told = json.loads(tmd("check", "--explain", "turn on", "01_blocks", "03_drawer", "--json").out)
    assert told["verb"] == "turn_on"
    assert [meaning["domain"] for meaning in told["domains"]] == ["01_blocks", "03_drawer"]


@pytest.mark.parametrize("said", ["", "12", "(open)"])
def test_what_is_not_a_word_is_told(said: str) -> None:
    with pytest.raises(TmdError, match="is not a verb"):
        explain(said, [])


def test_exit_codes(tmd: Tmd) -> None:
    assert tmd("check", "--explain", "open").code == 0
    ended = tmd("check", "--explain", "open", "01_blokcs")
    assert ended.code == 31 and "01_blocks" in ended.err
    assert tmd("check", "--explain", "open", "--strict", "01_blocks").code == 30
    assert tmd("check").code == 30
