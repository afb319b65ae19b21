"""Every row of ``phrases.yaml`` fires on its example and on its paraphrase, and means what stands there."""

import re
from pathlib import Path

import pytest
import yaml

from tmd.diagnostics import TmdError
from tmd.language import parse, print_clause
from tmd.language.lexicon.file import read_lexicon
from tmd.language.lexicon.lexicon import Lexicon, data_text
from tmd.language.syntax.phrases import builtin_rows

WRITTEN = {row["id"]: row for row in yaml.safe_load(data_text("phrases.yaml"))["rows"]}
CASES = [
    pytest.param(name, row[key], row["means"][at] if "means" in row else None, id=f"{name}-{key}")
    for name, row in WRITTEN.items()
    for at, key in enumerate(("example", "paraphrase"))
]
ROW = """phrases:
  - id: quick-deed
    read: "^ do|give a quick x:V|N of?"
    as: "{x.stem}"
    example: Do a quick wipe of the bench.
    paraphrase: Give a quick polish of the mirror.
"""


def lexicon(directory: Path, text: str) -> Lexicon:
    file = directory / "lexicon.yaml"
    file.write_text(text, encoding="utf-8")
    return read_lexicon(file)


@pytest.mark.parametrize(("name", "text", "means"), CASES)
def test_a_row_fires_and_means_what_it_says(name: str, text: str, means: list[str] | None) -> None:
    trace: list[str] = []
    parsed = parse(text, trace=trace)
    assert name in trace
    if means is not None:
        assert [print_clause(clause) for clause in parsed.clauses] == means


def test_every_row_is_read_and_has_a_meaning_or_a_reason_for_none() -> None:
    assert [row.id for row in builtin_rows()] == list(WRITTEN)
    assert len(WRITTEN) <= 120
    for row in WRITTEN.values():
        assert row["example"] != row["paraphrase"]
        assert len(row.get("means", [[], []])) == 2


def test_a_domain_has_phrases_of_its_own(tmp_path: Path) -> None:
    text = "Please do a quick wipe of the bench, then close the gate."
    trace: list[str] = []
    parsed = parse(text, lexicon(tmp_path, ROW), trace)
    assert [print_clause(clause) for clause in parsed.clauses] == ["(wipe, [bench])", "(close, [gate])"]
    assert "quick-deed" in trace
    assert parsed.clauses[0].text == "do a quick wipe of the bench"
    assert print_clause(parse(text).clauses[0]) != "(wipe, [bench])"


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ('"^ do|give a quick x:V|N of?"', '"^ do a x:VERB"', 3, "'VERB' is no class of words and no macro"),
        ('"^ do|give a quick x:V|N of?"', '"^ @deeds a x:V"', 3, "'deeds' is no section of words.txt"),
        ('"^ do|give a quick x:V|N of?"', '"do ( a quick x:V"', 3, "missing ), unterminated subpattern"),
        ('"^ do|give a quick x:V|N of?"', '"do ? x:V"', 3, "'?' is no element of a pattern"),
        ("{x.stem}", "{y.stem}", 4, "the pattern keeps nothing under 'y'"),
        ("    paraphrase: Give a quick polish of the mirror.\n", "", 2, "a row without paraphrase"),
        ("    as:", "    becomes:", 4, "unknown key 'becomes'"),
        ("quick-deed", "time-to", 2, "the language has a row with the id 'time-to'"),
        ("phrases:\n", ROW, 7, "two rows have the id 'quick-deed'"),
        ("phrases:\n  - id: quick-deed\n", "phrases:\n    id: quick-deed\n", 2, "expected a list of rows here"),
    ],
)  # fmt: skip
def test_a_bad_row_is_refused_with_its_place(tmp_path: Path, old: str, new: str, line: int, message: str) -> None:
    text = ROW.replace(old, new, 1)
    assert text != ROW
    with pytest.raises(TmdError, match=re.escape(message)) as caught:
        lexicon(tmp_path, text)
    assert caught.value.location
    assert caught.value.location.line == line
