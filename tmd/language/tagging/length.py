"""How long a text may be, for everything that grounds it at once: grounding takes time for every clause."""

from __future__ import annotations

from tmd.diagnostics import TmdError

MAX_WORDS = 1_000
"""Texts with more words are refused."""


def short_enough(text: str) -> str:
    """The text, if it can be grounded at once.

    Raises:
        TmdError: It has too many words.
    """
    count = len(text.split())
    if count > MAX_WORDS:
        raise TmdError(
            f"the text has {count:,} words; at most {MAX_WORDS:,} are grounded at once", hint="ground it in parts"
        )
    return text
