"""Words in any order are read without a failure."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from tmd.language.lexicon.lexicon import sections
from tmd.language.parser import parse

_FUNCTION = sorted({word.replace("_", " ") for words in sections().values() for word in words if word.isascii()})
_OPEN = ["take", "put", "press", "boil", "cup", "table", "small", "red", "machine", "water", ",", ".", ",", "."]
_WORDS = st.sampled_from([*_FUNCTION, *_OPEN])


@settings(max_examples=300, deadline=None)
@given(st.lists(_WORDS, min_size=1, max_size=20))
def test_words_in_any_order_are_read(words: list[str]) -> None:
    text = " ".join(words)
    for clause in parse(text).clauses:
        assert clause.verb
        assert clause.span is None or clause.span.end <= len(text)
