"""Every row of the part-of-speech tables decides the word of its example, as what the row says."""

import re

import pytest

from tmd.language.lexicon.lexicon import builtin
from tmd.language.syntax import part_of_speech as tables
from tmd.language.syntax.part_of_speech import TagRule, decide
from tmd.language.syntax.sentences import rewrite_words
from tmd.language.syntax.tokens import CLASSES, RUNS, ClassRule, Kind, RunRule, tag, tokenise

WORDS = ("UNKNOWN_WORD", "ING_FORM", "PAST_FORM", "THIRD_PERSON", "BASE_FORM")
TABLES: dict[str, tuple[TagRule, ...]] = {
    **{kind.value: rows for kind, rows in tables.CLOSED.items()},
    **{name: getattr(tables, name) for name in ("MODIFIERS", "ANY_WORD", *WORDS, "ADJECTIVES")},
}
ROWS = [pytest.param(row, id=f"{name}-{row.tag}-{row.reason}") for name, rows in TABLES.items() for row in rows]


@pytest.mark.parametrize("row", ROWS)
def test_the_row_decides_the_word_between_asterisks(row: TagRule) -> None:
    before, word, after = row.example.split("*")
    tokens = tag(rewrite_words(tokenise(before + word + after)), builtin())
    fired = {token.span.start: (token, rule) for token, rule in decide(tokens, builtin())}
    assert len(before) in fired, "no row decided the word"
    token, rule = fired[len(before)]
    assert rule is row, f"decided as {rule.tag}: {rule.reason}"
    assert token.kind is row.tag


@pytest.mark.parametrize("name", WORDS)
def test_no_word_is_left_undecided(name: str) -> None:
    tokens = tokenise("A")
    assert TABLES[name][-1].when(tables.Neighbours(tokens, 0, tokens[0], tables.Sentence(), builtin()))


def test_reasons_tell_the_rows_of_a_table_apart() -> None:
    for rows in TABLES.values():
        assert len({(row.tag, row.reason) for row in rows}) == len(rows)


def test_to_is_no_infinitive_where_no_row_says_so() -> None:
    tokens = tag(tokenise("Take the cup to the kitchen."), builtin())
    decide(tokens, builtin())
    assert [(token.text, token.form) for token in tokens if token.kind is Kind.TO] == [("to", "")]


@pytest.mark.parametrize("row", CLASSES, ids=lambda row: f"{row.tag}-{row.reason}")
def test_the_first_class_that_holds_for_a_word_is_that_of_its_row(row: ClassRule) -> None:
    assert next(rule for rule in CLASSES if rule.when(row.example)) is row


@pytest.mark.parametrize("row", RUNS, ids=lambda row: row.example)
def test_a_run_of_words_is_folded_by_its_row(row: RunRule) -> None:
    assert next(rule for rule in RUNS if re.match(rule.pattern, f"{row.example} ")) is row
    folded = tag(tokenise(f"Wait {row.example}."), builtin())[1]
    assert (folded.kind, folded.form, folded.text) == (Kind.MOD, row.form, row.example)
