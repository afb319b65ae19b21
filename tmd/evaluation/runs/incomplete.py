"""Instructions that say too little: sentences left out of a text at random (section VII, incomplete instructions)."""

from __future__ import annotations

import zlib
from dataclasses import replace

import numpy as np

from tmd.evaluation.runs.dataset import Example
from tmd.language.clause import Span
from tmd.language.syntax.tokens import Kind, tokenise
from tmd.veil.demonstration import Segment

_ENDS = frozenset(".!?…")
_CLOSING = frozenset("\"')]\u201d\u2019\u00bb")
_KEY = zlib.crc32(b"drop-sentences")


def sentences(text: str) -> tuple[Span, ...]:
    """Where the sentences of a text stand: together they are the whole text.

    A sentence ends with a full stop, a question or an exclamation mark, as the clause parser sees them ("2.5" has
    none), or with the line; marks and quotes that close it, and blanks, belong to it. A piece without a word is
    part of the sentence before it.
    """
    tokens = tokenise(text)
    ends = {token.span.end for token in tokens if token.kind is Kind.STOP and _ENDS & set(token.text)}
    ends |= {i + 1 for i, sign in enumerate(text) if sign == "\n"}
    words = [token.span.start for token in tokens if token.kind in (Kind.WORD, Kind.NUM)]
    found: list[Span] = []
    for end in sorted(ends | {len(text)}):
        start = found[-1].end if found else 0
        while end < len(text) and (text[end] in _CLOSING or text[end].isspace()):
            end += 1
        if end <= start:
            continue
        if found and not any(start <= word < end for word in words):
            found[-1] = Span(found[-1].start, end)
        else:
            found.append(Span(start, end))
    return tuple(found)


def leave_out(example: Example, probability: float, seed: int) -> Example:
    """The example with each sentence of its text left out with some probability, but never all of them.

    What is drawn depends on the seed and the example's id only, so all models read the same text; a sentence that is
    left out at one probability is left out at every higher one. Of the sentences, the one with the largest draw
    stays. Segments keep their instructions, and point to what is left of their words.

    Args:
        example: The example.
        probability: In [0, 1).
        seed: Of the run.
    """
    text = example.demonstration.text
    spans = sentences(text)
    if probability == 0 or len(spans) < 2:
        return example
    draws = np.random.default_rng([seed, _KEY, zlib.crc32(str(example.id).encode())]).random(len(spans))
    most = int(np.argmax(draws))
    kept = [span for i, span in enumerate(spans) if draws[i] >= probability or i == most]
    if len(kept) == len(spans):
        return example
    left = "".join(text[span.start : span.end] for span in kept).rstrip()

    def moved(place: int) -> int:
        before = sum(min(span.end, max(place, span.start)) - span.start for span in kept)
        return min(before, len(left))

    segments = tuple(Segment(moved(s.start), moved(s.end), s.instructions) for s in example.demonstration.segments)
    return replace(example, demonstration=replace(example.demonstration, text=left, segments=segments))
