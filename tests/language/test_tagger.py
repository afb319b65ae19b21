"""Every row of ``pos.yaml`` decides what stands between asterisks in its example and in its paraphrase."""

import re

import pytest

from tmd.diagnostics import TmdError
from tmd.language.lexicon.lexicon import Lexicon, builtin
from tmd.language.syntax.phrases import builtin_rows
from tmd.language.syntax.tagger import ClassRow, WordClasses, classes, decide, tag
from tmd.language.syntax.tokens import Kind, tokenise

ROW = (
    "tables: {base: words}\n\nrows:\n  - id: one\n    table: base\n    class: N\n    when: left=DET\n    reason: so\n"
    "    example: Take the *cup*.\n    paraphrase: Wash a *plate*.\n"
)


@pytest.mark.parametrize("name", ["example", "paraphrase"])
def test_each_row_decides_the_words_between_asterisks(name: str) -> None:
    for row in classes().rows:
        decides(row, row.entry[name])


def decides(row: ClassRow, text: str) -> None:
    before, words, after = text.split("*")
    lexicon = Lexicon(kinds=frozenset({"safe", "crate", "trap"}))
    trace: list[str] = []
    tokens = tag(tokenise(before + words + after), lexicon, trace)
    if row.entry["table"] in ("first", "runs", "things"):  # they stand before decisions
        assert row.id in trace, text
    else:
        assert (len(before), row.id) in {(token.span.start, row.id) for token, row in decide(tokens, lexicon)}, text
    token = next(token for token in tokens if token.span.start == len(before))
    assert token.kind is row.kind, (row.id, text)
    assert token.span.end == len(before) + len(words), (row.id, text)


def test_no_row_has_the_id_of_a_phrase_or_says_its_example_twice() -> None:
    rows = classes().rows
    assert not {row.id for row in rows} & {row.id for row in builtin_rows()}
    assert all(row.entry["example"] != row.entry["paraphrase"] for row in rows)


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("left=DET", "left=ARTICLES", 7, "'ARTICLES' is no class of words"),
        ("left=DET", "word@tools & word@gadgets", 7, "'gadgets' is no section of words.txt"),
        ("left=DET", "first & (left=DET", 7, "'first' is no term, no feature and no comparison"),
        ("left=DET", "(left=DET", 7, "this condition is not well-formed: '(' was never closed"),
        ("left=DET", "noun noun", 7, "this condition is not well-formed"),
        ("left=DET", "noun &", 7, "this condition is not well-formed"),
        ("left=DET", "sure>=many", 7, "'sure>=many' is no term, no feature and no comparison"),
        ("class: N", "class: NOUN", 6, "'NOUN' is no class of words"),
        ("table: base", "table: bases", 5, "'bases' is no table"),
        ("    example: Take the *cup*.\n", "", 4, "a row without example"),
        ("reason", "because", 4, "a row without reason"),
        ("    when:", "    where:", 7, "unknown key 'where'"),
        ("id: one", "id: one\n    phrases: gadgets", 5, "'gadgets' is no section of words.txt"),
        ("class: N", "class: [N]", 6, "expected a text for 'class'"),
        (
            "rows:\n",
            f"rows:\n{ROW.partition('rows:')[2].lstrip()[2:].join(['  - ', ''])}",
            11,
            "two rows have the id 'one'",
        ),
    ],
)
def test_a_bad_row_is_refused_with_its_place(old: str, new: str, line: int, message: str) -> None:
    text = ROW.replace(old, new, 1)
    assert text != ROW
    with pytest.raises(TmdError, match=re.escape(message)) as caught:
        WordClasses(text, "pos.yaml")
    assert caught.value.location
    assert caught.value.location.line == line


@pytest.mark.parametrize("name", ["first", "unknown", "ing", "ed", "s", "base"])
def test_no_word_is_left_undecided(name: str) -> None:
    assert not classes().tables[name][-1].entry["when"]


def test_to_is_no_infinitive_where_no_row_says_so() -> None:
    tokens = tag(tokenise("Take the cup to the kitchen."), builtin())
    decide(tokens, builtin())
    assert [(token.text, token.form) for token in tokens if token.kind is Kind.TO] == [("to", "")]
