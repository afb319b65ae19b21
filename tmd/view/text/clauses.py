"""A text with its clauses lit up: verbs, what each object phrase means, and words that nothing accounts for."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from itertools import groupby, pairwise

from tmd.inference.ranking import RankedPlan
from tmd.language.clause import Parsed, Span
from tmd.veil.world import World
from tmd.view.text.meaning import meanings
from tmd.view.text.phrases import OBJECT, VERB, phrases

NOTHING = "nothing here"
"""Stands under words that name nothing in the environment."""
SKIPPED = "skipped"
UNSEEN = "not demonstrated"


@dataclass(frozen=True, slots=True)
class Lit:
    """Lit words: where they stand, what they are (``verb``, ``object``, ``skipped``), and what stands under them."""

    span: Span
    kind: str
    label: str = ""
    title: str = ""


def lit_choice(parsed: Parsed, plan: RankedPlan, world: World) -> str:
    """The text of a grounded sentence, with what each phrase means in ``plan``, as HTML."""
    return lit_sentence(parsed, meanings(parsed, plan, world))


def lit_sentence(
    parsed: Parsed, meant: Sequence[Mapping[str, Sequence[str]]] | None = None, unseen: Collection[str] = ()
) -> str:
    """The text as a fragment of HTML.

    Args:
        parsed: The text and its clauses.
        meant: For every clause what its language-objects were grounded to; nothing is told of that without it.
        unseen: The verbs that no demonstration has.
    """
    spans = _clipped([clause.span for clause in parsed.clauses])
    lit = _free([*_clause_words(parsed, meant, unseen), *_skipped(parsed)])
    cuts = {0, len(parsed.text)} | {end for span in [*spans.values(), *(m.span for m in lit)] for end in span}
    pieces = [Span(*pair) for pair in pairwise(sorted(cuts))]
    inner = ""
    for number, group in groupby(pieces, key=lambda piece: _owner(piece, spans)):
        words = [_piece(parsed.text, piece, lit) for piece in group]
        inner += "".join(words) if number is None else _clause(number, words)
    return f'<p class="tmd tmd-text">{inner}</p>'


def _clause(number: int, words: Sequence[str]) -> str:
    """A clause; its number stays on the line of the first word."""
    first = f'<span class="tmd-number">{number + 1}</span>{words[0]}'
    if words[0].startswith((f'<span class="tmd-{VERB}', f'<span class="tmd-{OBJECT}')):
        first = f'<span class="tmd-together">{first}</span>'
    return f'<span class="tmd-clause {"odd" if number % 2 else "even"}">{first}{"".join(words[1:])}</span>'


def _clause_words(
    parsed: Parsed, meant: Sequence[Mapping[str, Sequence[str]]] | None, unseen: Collection[str]
) -> list[Lit]:
    found = []
    for number, clause in enumerate(parsed.clauses):
        told = None if meant is None else meant[number]
        for phrase in phrases(parsed.text, clause):
            if phrase.kind == VERB:
                label = UNSEEN if clause.verb in unseen else ""
                found.append(Lit(phrase.span, VERB, label, f"verb: {clause.verb}"))
            else:
                label = "" if told is None or phrase.name not in told else ", ".join(told[phrase.name]) or NOTHING
                found.append(Lit(phrase.span, phrase.kind, label, _reading(phrase.name, clause.meant(phrase.name))))
    return found


def _reading(name: str, meant: Sequence[str]) -> str:
    """How the language-object was read."""
    return f"object: {name}" + ("" if tuple(meant) == (name,) else f", which is {' + '.join(meant)}")


def _skipped(parsed: Parsed) -> list[Lit]:
    return [Lit(piece.span, SKIPPED, "", f"no clause: {piece.reason}") for piece in parsed.skipped]


def _clipped(spans: Sequence[Span]) -> dict[int, Span]:
    """The clauses' pieces of the text without overlaps: each begins where the one before has ended."""
    found: dict[int, Span] = {}
    done = 0
    for number, span in sorted(enumerate(spans), key=lambda item: (item[1], item[0])):
        start = max(span.start, done)
        if start < span.end:
            found[number] = Span(start, span.end)
            done = span.end
    return found


def _free(lit: Sequence[Lit]) -> list[Lit]:
    """In order, and without what overlaps something before it."""
    found: list[Lit] = []
    for words in sorted(lit, key=lambda words: words.span):
        if words.span.start < words.span.end and (not found or words.span.start >= found[-1].span.end):
            found.append(words)
    return found


def _owner(piece: Span, spans: Mapping[int, Span]) -> int | None:
    return next((number for number, span in spans.items() if span.start <= piece.start and piece.end <= span.end), None)


def _piece(text: str, piece: Span, lit: Sequence[Lit]) -> str:
    words = escape(text[piece.start : piece.end])
    found = next((m for m in lit if m.span.start <= piece.start and piece.end <= m.span.end), None)
    if found is None:
        return words
    label = found.label if piece.end == found.span.end else ""
    kind = f"tmd-{found.kind}{' tmd-none' if label in (NOTHING, UNSEEN) else ''}"
    under = f"<small>{escape(label)}</small>" if label else ""
    return f'<span class="{kind}" title="{escape(found.title)}"><span>{words}</span>{under}</span>'
