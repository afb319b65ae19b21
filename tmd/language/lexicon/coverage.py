"""What no clause accounts for, with a reason: nothing of a text is silently lost."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import cache

from tmd.language.clause import Clause, Skipped, Span
from tmd.language.lexicon.lexicon import Lexicon
from tmd.language.lexicon.word_lists import section, slips
from tmd.language.tagging.tokens import Kind, Token

NO_VERB = "no verb that this could belong to"
REMINDER = "names a thing, and not what to do with it"
FOREIGN = "most words are not English"
NO_WORDS = "there are no words in the text"

_ENGLISH_SHARE = 0.5
_FEWEST_WORDS = 3
_ADVERB = 5
_FILLERS = (
    "adverbs",
    "multiword_adverbs",
    "determiners",
    "quantifiers",
    "subjects",
    "names",
    "be",
    "modals",
    "ensure",
    "conditions",
    "let_verbs",
    "lead_verbs",
    "relatives",
    "prepositions",
    "pronouns",
    "particles",
)
_JOINTS = frozenset(["and", "or", "but", "plus", "then", "to", "&", "+"])


def is_filler(word: str) -> bool:
    """Tell whether a word may stand outside of all clauses without being reported.

    Fillers carry nothing of a clause: conjunctions, adverbs, articles, politeness, auxiliaries, addressing
    words and verbs that only introduce another ("need to").
    """
    return all(_is_filler(part) for part in re.split("[-_]", word.lower().replace("\u2019", "'").rstrip("'")))


def _is_filler(word: str) -> bool:
    word = slips().get(word, word)
    word = word.removesuffix("'s") if word not in section("be") else word
    if word in _JOINTS or (word.endswith("ly") and len(word) > _ADVERB) or word.endswith(("'ll", "'d", "'ve")):
        return True
    return any(word in section(name) for name in _FILLERS) or word in _inside_phrases()


@cache
def _inside_phrases() -> frozenset[str]:
    words: set[str] = set()
    for name in ("multiword_adverbs", "ensure"):
        for entry in section(name):
            words.update(entry.split("_"))
    return frozenset(words)


def foreign(tokens: Sequence[Token], lexicon: Lexicon) -> Callable[[str], tuple[Skipped, ...]] | None:
    """Return how to report a text without English words, or ``None`` for all other texts."""
    words = [t.text for t in tokens if t.kind is Kind.WORD]
    if not words and not any(t.kind is Kind.NUM for t in tokens):
        return lambda text: (Skipped(text.strip(), Span(0, len(text)), NO_WORDS),)
    distinct = sorted(set(words))
    if len(distinct) < _FEWEST_WORDS:
        return None
    known = sum(lexicon.knows(w) or lexicon.correct(w) is not None for w in distinct)
    if known >= _ENGLISH_SHARE * len(distinct):
        return None
    return lambda text: (Skipped(text.strip(), Span(0, len(text)), FOREIGN),)


def skipped(text: str, clauses: Sequence[Clause], tokens: Sequence[Token]) -> tuple[Skipped, ...]:
    """Return what lies outside of all clauses and is not filler, in order of the text.

    Args:
        text: The text.
        clauses: Its clauses.
        tokens: Every token, folded or not; those with a ``note`` know why they are skipped.
    """
    covered = _merge([c.span for c in clauses])
    pieces: list[tuple[Span, str]] = []
    place = 0
    for token in sorted(tokens, key=lambda t: t.span):
        while place < len(covered) and covered[place].end <= token.span.start:
            place += 1
        inside = place < len(covered) and covered[place].start <= token.span.start
        noted = token.kind is Kind.SKIP or bool(token.note)
        if inside and not noted:
            continue
        if not noted and (token.kind in (Kind.STOP, Kind.SEP, Kind.COMMA, Kind.CONJ, Kind.VCC) or _all_filler(token)):
            continue
        reason = token.note or NO_VERB
        if pieces and pieces[-1][1] == reason and _adjacent(text, pieces[-1][0], token.span):
            pieces[-1] = (Span(pieces[-1][0].start, token.span.end), reason)
        else:
            pieces.append((token.span, reason))
    return tuple(Skipped(text[s.start : s.end], s, reason) for s, reason in pieces)


def _all_filler(token: Token) -> bool:
    return token.kind is not Kind.MOD and all(is_filler(word) for word in token.text.split())


def _adjacent(text: str, before: Span, after: Span) -> bool:
    between = text[before.end : after.start]
    return not any(sign in between for sign in ".!?;")


def _merge(spans: list[Span]) -> list[Span]:
    merged: list[Span] = []
    for span in sorted(spans):
        if merged and span.start <= merged[-1].end:
            merged[-1] = Span(merged[-1].start, max(merged[-1].end, span.end))
        else:
            merged.append(span)
    return merged
