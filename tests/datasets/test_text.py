from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.datasets.veil500.data import clean


@pytest.mark.parametrize(
    ("raw", "cleaned", "removed"),
    [
        ("Fill  it\r\n with water", "Fill it with water", 0),
        ("Put it down | and go", "Put it down and go", 0),
        ("wash the red cup wash the red cup .", "wash the red cup .", 1),
        ("Put it in there |  Put it in there .", "Put it in there .", 1),
        ("go away go away .", "go away go away .", 0),
        ("Open the door . Open the door .", "Open the door . Open the door .", 0),
        ("Open the door. Open the door.", "Open the door. Open the door.", 0),
        ("a b c a b c a b c", "a b c", 2),
        ("take one cup take ONE cup, then", "take one cup then", 1),
    ],
)
def test_clean(raw: str, cleaned: str, removed: int) -> None:
    found = clean(raw)
    assert (found.text, found.repeats_removed) == (cleaned, removed)


def test_segments_keep_their_numbers() -> None:
    found = clean("one two | | three four five three four five | .")
    assert [s.text for s in found.segments] == ["one two", "", "three four five", "."]
    assert [s.has_words for s in found.segments] == [True, False, True, False]


@given(st.text(alphabet="ab .|\n,", max_size=60))
def test_spans_are_places_in_the_text(raw: str) -> None:
    found = clean(raw)
    assert len(found.segments) == raw.count("|") + 1
    end = 0
    for segment in found.segments:
        assert found.text[segment.start : segment.end] == segment.text
        assert segment.start >= end
        end = segment.end
    assert "  " not in found.text and found.text == found.text.strip()
    assert clean(found.text).text == found.text
