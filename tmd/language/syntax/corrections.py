"""The words that the brackets have emitted, and corrections of them: "on the bench, no wait, in the shed"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import takewhile

from tmd.language.lexicon.lexicon import first_of, section
from tmd.language.lexicon.nouns import similarity
from tmd.language.syntax.ends import ClauseEnds
from tmd.language.syntax.tokens import HEADS, LINKS, NP, Kind, Token, mark, noted

K = Kind
CORRECTION = "correction"
"""The form of words behind which a speaker says something better: "no wait"."""
CORRECTED = "taken back by what was said next"
GAP = "(LINKS|IDLE)*"
"""The pattern of words between a sign of a correction and the correction."""


class Corrections(ClauseEnds):
    """The words of a text, what has been emitted of them, and what speakers take back of that.

    Attributes:
        out: What the grammar sees; commas and conjunctions are still undecided.
        dropped: What speakers have taken back.
    """

    def __init__(self, tokens: list[Token]) -> None:
        """Take the words of a text."""
        super().__init__(tokens)
        self.out: list[Token] = []
        self.dropped: list[Token] = []
        self._verb: Token | None = None
        """The verb of the clause that is open."""
        self._subject = 0
        """Where in ``out`` the arguments begin that may be the subject of a statement."""
        self._told = False
        """The subject of the open clause is a person other than the addressee."""
        self._somebody = False
        """The subject of the open clause is a person."""
        self._units: list[tuple[int, bool]] = [(0, False)]
        """Where in ``out`` the clauses of the sentence begin, and whether somebody is the subject of the one before."""
        self._asked = False
        """A request begins as a question: "could the lamp be turned off"."""

    def _begin(self) -> None:
        """Begin a unit."""
        self._units.append((len(self.out), self._told))
        self._verb, self._subject = None, len(self.out)
        self._asked = self._told = self._somebody = False

    def _last(self) -> Kind:
        return self.out[-1].kind if self.out else K.SEP

    def _cut(self, start: int) -> None:
        """Remove what has been emitted from a place on."""
        del self.out[start:]
        self._subject = min(self._subject, start)

    def _named(self) -> bool:
        """Return whether something has been named that may be a subject."""
        return any(t.kind in HEADS for t in self.out[self._subject :])

    def _mention(self, words: Sequence[Token], note: str) -> None:
        """State the first thing of what is set aside, so that pronouns may mean it: "is the lamp on? turn it off"."""
        thing = next((i for i, t in enumerate(words) if t.kind is K.N), len(words))
        begin = end = thing
        while begin and words[begin - 1].kind in NP - {K.N}:
            begin -= 1
        while end < len(words) and words[end].kind is K.N:
            end += 1
        if end > begin:
            opener = mark(K.SAY, words[begin].span.start)
            opener.note = note
            self.out += [opener, *(replace(t) for t in words[begin:end]), mark(K.END, words[end - 1].span.end)]

    def _corrects(self, at: int) -> bool:
        """Return whether a speaker says something better from here on: "no wait", "no," behind a sign."""
        no_the = self.kind(at + 1) is K.DET and self.tokens[at].text == first_of("none_words")  # "no the blue one"
        denies = (self.among(at, "none_words") and self.kind(at + 1) is K.COMMA) or no_the
        signs = self.tokens[at].form == CORRECTION or (denies and self.kind(at - 1) in (K.COMMA, K.SEP))
        begin = self.peek(at, GAP)
        rather = self.kind(begin) is not K.NEG or self.follows(begin, "NEG NP+ COMMA CC? NP+ BREAK")
        return signs and bool(self.out) and rather

    def _corrected(self, at: int) -> int:
        """Take back what the speaker corrects: "on the bench, no wait, in the shed": a place, a thing or a deed."""
        begin = self.peek(at, GAP)
        if self.kind(begin) is K.NEG:
            return self._put_right(at, begin)
        place, thing = self.follows(begin, "P|TO"), self.kind(begin) in NP
        if thing and (end := self._correct_object(at, begin)):
            return end
        start = self._taken_back(place=place, thing=thing)
        self.dropped += noted([self.tokens[at]], CORRECTED)
        start = max(start - place, 0)
        taken = self.out[start:]
        self._take_back(start, CORRECTED)
        if not (place or thing):
            self._mention(taken, CORRECTED)
        return begin

    def _put_right(self, at: int, denied: int) -> int:
        """Put one thing in the place of another that was said: "wash the mug. No, not the mug, the cup"."""
        comma = self.past(denied + 1, "NP+")
        begin = comma + 1 + (self.kind(comma + 1) is K.CC)
        behind = self.past(begin, "NP+")
        said = [t.text for t in self.tokens[denied:comma] if t.kind in HEADS]
        heads = (i for i, t in enumerate(self.out) if t.kind in HEADS and t.text in said)
        end = max(heads, default=-1) + 1
        start = end
        while start and self.out[start - 1].kind in NP:
            start -= 1
        self.dropped += noted([*self.out[start:end], *self.tokens[at:begin]], CORRECTED)
        if end:
            self.out[start:end] = self.tokens[begin:behind]
        return behind

    def _taken_back(self, *, place: bool, thing: bool) -> int:
        """Return where the last place, thing or sentence begins."""
        start = len(self.out) - (self._last() is K.SEP)
        while start and (
            self.out[start - 1].kind in LINKS | {K.SEP} or self.out[start - 1].text in section("none_words")
        ):
            start -= 1
        until = {K.P, K.TO} if place else NP if thing else {K.SEP}
        while start and self.out[start - 1].kind not in until:
            start -= 1
        while start and thing and self.out[start - 1].kind in NP:
            start -= 1
            if self.out[start].kind is K.DET and self.out[start - 1].kind in HEADS:
                break  # "serve Ann the tea, no, the soup"
        return start

    def _correct_object(self, at: int, begin: int) -> int:
        """Put a thing in the place of what the sentence before acts on: "the rope to the shed. No, the hose".

        Returns:
            Where reading goes on; 0 where that sentence acts on nothing.
        """
        start = max((i for i, t in enumerate(self.out) if t.kind is K.V), default=len(self.out)) + 1
        end = start + sum(1 for _ in takewhile(lambda token: token.kind in NP, self.out[start:]))
        behind = self.past(begin, "NP+")
        apart = self.tokens[at - 1].text[:1] in ".!;" or self._is_rather(begin, behind, start, end)
        if end == start or not apart or not self.follows(behind, "BREAK"):
            return 0
        self.dropped += noted([*self.out[start:end], self.tokens[at]], CORRECTED)
        self.out[start:end] = self.tokens[begin:behind]
        return behind

    def _is_rather(self, begin: int, behind: int, start: int, end: int) -> bool:
        """Return whether a thing is more like what is acted on than like the last thing said.

        "Put the cup in the sink, no, the mug" is about the mug, "…, no, the basin" about the basin.
        """
        heads = [token.text for token in self.out[end:] if token.kind is K.N][-1:]
        ends = [t.text for t in self.tokens[begin:behind] if t.kind is K.N][-1:]
        owns = [token.text for token in self.out[start:end] if token.kind is K.N][-1:]
        ends, owns, heads = ([name.rstrip("_0123456789") for name in names] for names in (ends, owns, heads))
        own, last = ((similarity(ends[0], other[0]) if ends and other else 0.0) for other in (owns, heads))
        return bool(heads) and own > last

    def _take_back(self, start: int, note: str) -> None:
        """Set aside what has been emitted from a place on."""
        self.dropped += noted(self.out[start:], note)
        self._cut(start)
        if self._verb is not None and self._verb.note:
            self._begin()
