"""Where in a text the words of a clause stand: its verb, and the phrase of each of its objects."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher

from tmd.language.clause import Clause, Span
from tmd.language.lexicon.lexicon import builtin, positive, singular
from tmd.language.syntax.tokens import Kind, Token, tokenise

VERB, OBJECT = "verb", "object"
_SHORTEST_SLIP, _ALIKE = 4, 0.8
_WIDER = 3
"""So many words that do not count may stand within a phrase: "the cup of hot coffee"."""


@dataclass(frozen=True, slots=True)
class TextPhrase:
    """Words of a clause.

    Attributes:
        span: Where they stand.
        kind: :data:`VERB` or :data:`OBJECT`.
        name: The stem, or the language-object, as the clause has it.
    """

    span: Span
    kind: str
    name: str


def phrases(text: str, clause: Clause) -> list[TextPhrase]:
    """The verb's words and each object's, as far as they are found in the clause's piece of the text, in order.

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
    """The verb's word and its particle's; nothing where the verb was written in another way."""
    stem, *particles = verb.split("_")
    words = builtin()
    stems = [(words.verb(token.text) or (token.text,))[0] for token in tokens]
    place = next((i for i, found in enumerate(stems) if found == stem), None)
    if place is None:
        place = next((i for i, found in enumerate(stems) if _is_slip(found, stem)), None)
    if place is None:
        return []
    behind = range(place + 1, len(tokens))
    rest = [next((i for i in behind if tokens[i].text == particle), None) for particle in particles]
    return [place, *(i for i in rest if i is not None)]


def _is_slip(written: str, meant: str) -> bool:
    """Whether the parser may have read a word as another: it mends typing errors."""
    shorter = min(len(written), len(meant))
    return shorter >= _SHORTEST_SLIP and SequenceMatcher(None, written, meant).ratio() >= _ALIKE


def _objects(tokens: Sequence[Token], clause: Clause, used: Collection[int]) -> Iterator[tuple[str, str, list[int]]]:
    """Each object with its words; lazily, because what one has taken the next cannot have."""
    for name in clause.objects:
        free = {i: _forms(tokens[i].text) for i in range(len(tokens)) if i not in used}
        yield OBJECT, name, _words_of(free, [word for word in name.split("_") if word])


def _forms(word: str) -> frozenset[str]:
    return frozenset({word, singular(word), positive(word)})


def _words_of(free: Mapping[int, frozenset[str]], words: Sequence[str]) -> list[int]:
    """The narrowest run of free places with all of ``words``; with their head alone where there is none."""
    mended = {place: forms | {w for w in words for form in forms if _is_slip(form, w)} for place, forms in free.items()}
    for known in (free, mended):
        starts = [place for place, forms in known.items() if forms & set(words)]
        found = (_run_from(start, known, words) for start in starts)
        runs = [run for run in found if len(run) == len(words)]
        if runs:
            return min(runs, key=lambda run: (run[-1] - run[0], run[0]))
    return [place for place in starts if words[-1] in mended[place]][:1]


def _run_from(start: int, free: Mapping[int, frozenset[str]], words: Sequence[str]) -> list[int]:
    """The places from ``start`` on that have ``words``, in any order, with little between them."""
    left, taken = list(words), []
    for place in range(start, start + len(words) + _WIDER):
        word = next((w for w in left if w in free.get(place, ())), None)
        if word is not None:
            left.remove(word)
            taken.append(place)
    return taken


def _runs(places: Sequence[int]) -> list[list[int]]:
    """Places next to each other as one run."""
    runs: list[list[int]] = []
    for place in sorted(places):
        if runs and place == runs[-1][-1] + 1:
            runs[-1].append(place)
        else:
            runs.append([place])
    return runs
