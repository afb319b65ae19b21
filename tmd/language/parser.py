"""Text to clauses, with everything that no clause accounts for, and the reason.

The passes, in order: tokens, repeated runs, first classes of words, classes by neighbours, frames of requests, phrase
rows, joints, brackets, links, the LALR grammar, clauses with their attachment, antecedents. Each is linear in the
length of the text.
"""

from __future__ import annotations

import re
from collections.abc import Container, Sequence
from functools import cache

from tmd.diagnostics import TmdError
from tmd.language.clause import Clause, Parsed, Skipped, Span, hull
from tmd.language.lexicon.lexicon import Lexicon, builtin, pairs, section, sections, sections_of
from tmd.language.syntax.antecedents import resolve
from tmd.language.syntax.brackets import STATEMENT, Bracketer
from tmd.language.syntax.frames import Frames
from tmd.language.syntax.grammar import Linker, parse_tokens
from tmd.language.syntax.joins import join
from tmd.language.syntax.phrases import rewrite
from tmd.language.syntax.reading import TextReading
from tmd.language.syntax.tagger import ADVERB, decide, tag
from tmd.language.syntax.tokens import MARKUP, Kind, Token, drop_endearments, drop_repeats, tokenise

NO_VERB = "no verb that this could belong to"
FOREIGN = "most words are not English"
NO_WORDS = "there are no words in the text"
MAX_WORDS = 1_000
"""Texts with more words are not grounded at once."""

_ENGLISH_SHARE = 0.5
"""A text of which fewer words than this are known is not English ..."""
_FEWEST_WORDS = 3
"""... if it has as many different words."""


def parse(text: str, lexicon: Lexicon | None = None, trace: list[str] | None = None) -> Parsed:
    """Read a text as verb clauses, C = (ν, [obj], ρ) (section III-A).

    Args:
        text: Any text: run-ons, typos, missing full stops, upper case, segment marks.
        lexicon: Words of the domain, in addition to the built-in ones.
        trace: Takes the ids of the rows of ``data/pos.yaml`` and ``data/phrases.yaml`` that fire.

    Returns:
        The clauses in order, what must not be done, and what was skipped with the reason. Never raises for any text.
    """
    words = lexicon or builtin()
    cut = tokenise(text)
    _note_overlong(cut)
    markup = [t for t in cut if t.note]
    kept, repeated = drop_repeats([t for t in cut if not t.note])
    kept, called = drop_endearments(kept)
    strange = _foreign(kept, words)
    if strange:
        return Parsed(text, (), (Skipped(text.strip(), Span(0, len(text)), strange),))
    tokens = tag(kept, words, trace)
    decide(tokens, words, trace)
    tokens = Frames(tokens, words).run()
    tokens, dropped = rewrite(tokens, words, trace)
    bracketer = Bracketer(join(tokens, words), words)
    reading = TextReading(text).read(parse_tokens(Linker(bracketer.run()).run()))
    clauses, constraints, stated = resolve(reading)
    rest = [*tokens, *markup, *repeated, *called, *dropped, *bracketer.dropped, *reading.skipped]
    return Parsed(text, clauses, _skipped(text, (*clauses, *constraints), rest), constraints, stated)


def _note_overlong(tokens: list[Token]) -> None:
    """Set words beyond the limit of a sentence aside, because rules look back and ahead over all of it."""
    count = 0
    for token in tokens:
        count = 0 if token.kind is Kind.STOP else count + 1
        if count > MAX_WORDS:
            token.note = token.note or f"the sentence has more than {MAX_WORDS:,} words"


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


def is_filler(word: str) -> bool:
    """Return whether a word may stand outside of all clauses without being reported.

    Fillers carry nothing of a clause: conjunctions, adverbs, articles, politeness, auxiliaries, addressing
    words and verbs that only introduce another ("need to").
    """
    return all(_is_filler(part) for part in re.split("[-_]", word.lower().replace("\u2019", "'").rstrip("'")))


def _is_filler(word: str) -> bool:
    word = pairs("slips").get(word, word)
    word = word.removesuffix("'s") if word not in section("be") else word
    adverb = word.endswith("ly") and len(word) > ADVERB
    listed = not sections_of(word).isdisjoint(("joints", *sections()["fillers"]))
    return adverb or listed or word.endswith(sections()["contracted"]) or word in _inside_phrases()


@cache
def _inside_phrases() -> frozenset[str]:
    entries = section("multiword_adverbs") | section("ensure")
    return frozenset(word for entry in entries for word in entry.split("_"))


def _foreign(tokens: Sequence[Token], lexicon: Lexicon) -> str:
    """Return why a text without English words is skipped; empty for all other texts."""
    words = {t.text for t in tokens if t.kind is Kind.WORD}
    if not words and not any(t.kind is Kind.NUM for t in tokens):
        return NO_WORDS
    known = sum(lexicon.knows(w) or lexicon.correct(w) is not None for w in words)
    return FOREIGN if len(words) >= _FEWEST_WORDS and known < _ENGLISH_SHARE * len(words) else ""


def _skipped(text: str, clauses: Sequence[Clause], tokens: Sequence[Token]) -> tuple[Skipped, ...]:
    """Return what lies outside of all clauses and is not filler, in order of the text.

    Args:
        text: The text.
        clauses: Its clauses.
        tokens: Every token, folded or not; those with a ``note`` know why they are skipped.
    """
    spans = [*(c.span for c in clauses), *(t.span for t in tokens if t.kind is Kind.SKIP)]
    covered = {place for span in spans for place in range(*span)}
    pieces: list[tuple[Span, str]] = []
    for token in sorted(tokens, key=lambda t: t.span):
        if _is_idle(token, inside=token.span.start in covered):
            continue
        reason = token.note or NO_VERB
        if pieces and pieces[-1][1] == reason and _continues(text, pieces[-1][0], token.span, reason, covered):
            pieces[-1] = (hull([pieces[-1][0], token.span]), reason)
        else:
            pieces.append((token.span, reason))
    return tuple(Skipped(text[s.start : s.end].lstrip(",; "), s, reason) for s, reason in pieces)


def _is_idle(token: Token, *, inside: bool) -> bool:
    """Return whether a token needs no report: a clause covers it, or it carries nothing."""
    if token.kind is Kind.SKIP or token.note:
        return False
    filler = token.kind is not Kind.MOD and all(map(is_filler, token.text.split()))
    return inside or token.span.start == token.span.end or token.kind in _SIGNS or filler


_SIGNS = frozenset({Kind.STOP, Kind.SEP, Kind.COMMA, Kind.FILLER, Kind.CONJ, Kind.VCC, Kind.LINK, Kind.END})


def _continues(text: str, before: Span, after: Span, reason: str, covered: Container[int]) -> bool:
    """Return whether a piece goes on where another one ends: two statements do not, with a clause between them."""
    apart = reason == STATEMENT and any(place in covered for place in range(before.end, after.start))
    return not apart and _adjacent(text, before, after, reason)


def _adjacent(text: str, before: Span, after: Span, reason: str) -> bool:
    between = text[before.end : after.start]
    return not between.strip() if reason == MARKUP else not any(sign in between for sign in ".!?;")
