"""Texts cut into segments by ``|``: the whole text is parsed, then clauses are dealt out by offset.

Cutting first would tear verbs from their particles.
"""

from __future__ import annotations

from collections.abc import Sequence

from tmd.language.clause import Clause, Span

MARK = "|"


def segments(text: str) -> tuple[Span, ...]:
    """Return the spans between the marks, in order; empty ones too."""
    spans, start = [], 0
    for place in (i for i, sign in enumerate(text) if sign == MARK):
        spans.append(Span(start, place))
        start = place + 1
    return (*spans, Span(start, len(text)))


def by_segment(text: str, clauses: Sequence[Clause]) -> tuple[tuple[Clause, ...], ...]:
    """Return for each segment of a text the clauses that begin in it.

    Args:
        text: The text with its marks.
        clauses: The clauses of that very text, in order.
    """
    spans = segments(text)
    dealt: list[list[Clause]] = [[] for _ in spans]
    place = 0
    for clause in sorted(clauses, key=lambda c: c.span.start):
        while place + 1 < len(spans) and clause.span.start > spans[place].end:
            place += 1
        dealt[place].append(clause)
    return tuple(tuple(group) for group in dealt)
