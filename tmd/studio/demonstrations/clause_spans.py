"""The text of a demonstration, cleaned and cut into pieces, one for each clause."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass

from tmd.diagnostics import TmdError
from tmd.language import parse
from tmd.language.clause import Clause
from tmd.language.lexicon.lexicon import Lexicon
from tmd.language.parser import short_enough

# Longer texts are refused before anything else is done with them.
MAX_CHARACTERS = 20_000


@dataclass(frozen=True, slots=True)
class ClauseSpan:
    """A piece ``text[start:end]``, and its clause; ``None`` where none was understood in the whole text."""

    start: int
    end: int
    text: str
    clause: Clause | None


def clean(text: str) -> str:
    """Return the text with every control character as a blank, without blanks at its ends.

    Raises:
        TmdError: There is nothing in it, it is too long, or it is not Unicode.
    """
    if len(text) > MAX_CHARACTERS:
        raise TmdError(
            f"the text has {len(text):,} characters; at most {MAX_CHARACTERS:,} are taken", hint="shorten it"
        )
    try:
        text.encode("utf-8")
    except UnicodeEncodeError as error:
        raise TmdError(f"character {error.start + 1} of the text is not Unicode", hint="type it again") from error
    found = "".join(" " if unicodedata.category(c) in ("Cc", "Zl", "Zp") else c for c in text).strip()
    if not found:
        raise TmdError("the text is empty", hint="say what is to be done: boil some water")
    return short_enough(found)


def cut(text: str, lexicon: Lexicon | None) -> tuple[ClauseSpan, ...]:
    """Return the pieces of a cleaned text, at least one, in its order: what each clause spans."""
    starts = {clause.span.start: clause for clause in reversed(parse(text, lexicon).clauses)}
    clauses = [starts[start] for start in sorted(starts)]
    if not clauses:
        return (ClauseSpan(0, len(text), text, None),)
    after = [*(clause.span.start for clause in clauses[1:]), len(text)]
    pieces = [_piece(text, c.span.start, min(c.span.end, end), c) for c, end in zip(clauses, after, strict=True)]
    if not _found_again(text, pieces):
        before = [0, *after[:-1]]
        pieces = [_piece(text, start, end, c) for start, end, c in zip(before, after, clauses, strict=True)]
    return tuple(pieces)


def _piece(text: str, start: int, end: int, clause: Clause) -> ClauseSpan:
    return ClauseSpan(start, end, text[start:end], clause)


def _found_again(text: str, pieces: Sequence[ClauseSpan]) -> bool:
    """Return whether a reader that looks for each piece behind the one before it finds it where it is."""
    ends = [0, *(piece.end for piece in pieces)]
    return all(
        piece.text and text.find(piece.text, end) == piece.start for piece, end in zip(pieces, ends, strict=False)
    )
