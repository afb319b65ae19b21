"""A text with its clauses lit up: verbs, what each object phrase means, and words that nothing accounts for."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from html import escape
from itertools import groupby, pairwise

from tmd.inference.ranking import RankedPlan
from tmd.language.clause import Clause, Parsed, Span
from tmd.language.lexicon.lexicon import builtin, positive, singular
from tmd.language.syntax.tokens import Kind, Token, tokenise
from tmd.view.meaning import meanings
from tmd.world.world import World

VERB, OBJECT = "verb", "object"
# Maximum number of words that do not count within a phrase: "the cup of hot coffee".
_WIDER = 3


@dataclass(frozen=True, slots=True)
class TextPhrase:
    """Words of a clause. ``name`` is the stem, or the language-object, as the clause has it."""

    span: Span
    kind: str
    name: str


def phrases(text: str, clause: Clause) -> list[TextPhrase]:
    """Return the verb's words and each object's, as far as they are found in the clause's piece of the text, in order.

    What the parser read from other words than are written there (a missing object, say) has none.
    """
    start = clause.span.start
    tokens = [t for t in tokenise(text[start : clause.span.end]) if t.kind in (Kind.WORD, Kind.NUM)]
    found: list[tuple[list[int], str, str]] = []
    used: set[int] = set()
    for kind, name, places in [(VERB, clause.verb, _verb(tokens, clause.verb)), *_objects(tokens, clause, used)]:
        if places and not used & set(places):
            used |= set(places)
            found += [(run, kind, name) for run in _runs(places)]
    spans = [(Span(start + tokens[run[0]].span.start, start + tokens[run[-1]].span.end), k, n) for run, k, n in found]
    return [TextPhrase(*entry) for entry in sorted(spans)]


def _verb(tokens: Sequence[Token], verb: str) -> list[int]:
    """Return the verb's word and its particle's; nothing where the verb was written in another way."""
    stem, *particles = verb.split("_")
    words = builtin()
    stems = [(words.verb(token.text) or (token.text,))[0] for token in tokens]
    place = next((i for i, found in enumerate(stems) if found == stem), None)
    if place is None:
        return []
    behind = range(place + 1, len(tokens))
    rest = [next((i for i in behind if tokens[i].text == particle), None) for particle in particles]
    return [place, *(i for i in rest if i is not None)]


def _objects(tokens: Sequence[Token], clause: Clause, used: Collection[int]) -> Iterator[tuple[str, str, list[int]]]:
    """Yield each object with its words; lazily, because what one has taken the next cannot have."""
    for name in clause.objects:
        free = {i: {t.text, singular(t.text), positive(t.text)} for i, t in enumerate(tokens) if i not in used}
        yield OBJECT, name, _words_of(free, [word for word in name.split("_") if word])


def _words_of(free: Mapping[int, Set[str]], words: Sequence[str]) -> list[int]:
    """Return the narrowest run of free places with all of ``words``; with their head alone where there is none."""
    starts = [place for place, forms in free.items() if forms & set(words)]
    runs = [run for start in starts if len(run := _run_from(start, free, words)) == len(words)]
    if runs:
        return min(runs, key=lambda run: (run[-1] - run[0], run[0]))
    return [place for place in starts if words[-1] in free[place]][:1]


def _run_from(start: int, free: Mapping[int, Set[str]], words: Sequence[str]) -> list[int]:
    """Return the places from ``start`` on that have ``words``, in any order, with little between them."""
    left, taken = list(words), []
    for place in range(start, start + len(words) + _WIDER):
        word = next((w for w in left if w in free.get(place, ())), None)
        if word is not None:
            left.remove(word)
            taken.append(place)
    return taken


def _runs(places: Sequence[int]) -> list[list[int]]:
    """Return runs of consecutive places."""
    runs = groupby(enumerate(sorted(places)), key=lambda item: item[1] - item[0])
    return [[place for _, place in run] for _, run in runs]


# Stands under words that name nothing in the environment.
NOTHING = "nothing here"
SKIPPED = "skipped"
UNSEEN = "not demonstrated"


@dataclass(frozen=True, slots=True)
class Lit:
    """Lit words: their place, their kind (``verb``, ``object``, ``skipped``), and the label below them."""

    span: Span
    kind: str
    label: str = ""
    title: str = ""


def lit_choice(parsed: Parsed, plan: RankedPlan, world: World) -> str:
    """Return the text of a grounded sentence, with what each phrase means in ``plan``, as HTML."""
    return lit_sentence(parsed, meanings(parsed, plan, world))


def lit_sentence(
    parsed: Parsed, meant: Sequence[Mapping[str, Sequence[str]]] | None = None, unseen: Collection[str] = ()
) -> str:
    """Return the text as a fragment of HTML.

    ``meant`` has for every clause the objects of its language-objects; without it they are left out. ``unseen`` are the
    verbs that no demonstration has.
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
    """Return a clause; its number stays on the line of the first word."""
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
    """Describe the reading of a language-object."""
    return f"object: {name}" + ("" if tuple(meant) == (name,) else f", which is {' + '.join(meant)}")


def _skipped(parsed: Parsed) -> list[Lit]:
    return [Lit(piece.span, SKIPPED, "", f"no clause: {piece.reason}") for piece in parsed.skipped]


def _clipped(spans: Sequence[Span]) -> dict[int, Span]:
    """Return the clauses' pieces of the text without overlaps: each begins where the one before has ended."""
    found: dict[int, Span] = {}
    done = 0
    for number, span in sorted(enumerate(spans), key=lambda item: (item[1], item[0])):
        start = max(span.start, done)
        if start < span.end:
            found[number] = Span(start, span.end)
            done = span.end
    return found


def _free(lit: Sequence[Lit]) -> list[Lit]:
    """Sort lit words, and drop those that overlap earlier ones."""
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
