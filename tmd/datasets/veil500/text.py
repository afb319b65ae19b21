"""The texts of VEIL-500: cleaning, and segments with their places in the cleaned text.

A raw text holds ``|`` between segments, line breaks, runs of blanks, and sometimes the same run of words
twice in a row (a slip of the segmenter that wrote the file).
"""

from __future__ import annotations

import re
from dataclasses import dataclass

SHORTEST_REPEAT = 3
"""A repeated run counts as a slip from this many words on."""

_NOT_WORD = re.compile(r"[^a-z0-9']+")
_WORD = re.compile(r"[A-Za-z0-9]")


@dataclass(frozen=True, slots=True)
class VeilSegment:
    """A piece of a text: ``text == cleaned[start:end]``; it may be empty or hold only a full stop."""

    text: str
    start: int
    end: int

    @property
    def has_words(self) -> bool:
        """Whether there is a word in it."""
        return bool(_WORD.search(self.text))


@dataclass(frozen=True, slots=True)
class CleanText:
    """A cleaned text with its segments, and how many repeated runs were deleted."""

    text: str
    segments: tuple[VeilSegment, ...]
    repeats_removed: int


def clean(raw: str) -> CleanText:
    """Collapse white space, delete repeated runs, take out the separators and remember where they stood."""
    words = [(word, number) for number, part in enumerate(raw.split("|")) for word in part.split()]
    count = raw.count("|") + 1
    removed = 0
    while (found := _repeat([word for word, _ in words])) is not None:
        start, length = found
        del words[start + length : start + 2 * length]
        removed += 1
    pieces = [" ".join(word for word, n in words if n == number) for number in range(count)]
    return CleanText(*_join(pieces), repeats_removed=removed)


def _join(pieces: list[str]) -> tuple[str, tuple[VeilSegment, ...]]:
    """The pieces as one text with single blanks between those that hold anything."""
    text = ""
    segments = []
    for piece in pieces:
        if piece and text:
            text += " "
        start = len(text)
        text += piece
        segments.append(VeilSegment(piece, start, len(text)))
    return text, tuple(segments)


def _repeat(words: list[str]) -> tuple[int, int] | None:
    """Start and length of the first and longest run that stands twice in a row, if any.

    The second copy must not begin a new sentence: a person may well say the same thing twice, the segmenter
    repeats inside a sentence.
    """
    keys = [_NOT_WORD.sub("", word.lower()) or word for word in words]
    for start in range(len(keys)):
        for length in range((len(keys) - start) // 2, SHORTEST_REPEAT - 1, -1):
            middle = start + length
            if keys[start:middle] == keys[middle : middle + length] and not words[middle - 1].endswith("."):
                return start, length
    return None
