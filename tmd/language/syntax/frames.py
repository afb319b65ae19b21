"""Set aside the frames of indirect requests: "would it be possible for you to open it" asks to open it.

A frame begins a sentence with a subject or an auxiliary, names no thing, and ends at the verb that counts: behind *to*,
behind "if you could", or with -ing behind "would you mind". Where a thing is the subject ("I'd be glad if the window
were open"), what follows is a demand. Conditions that are only polite ("if it is no trouble") are set aside as well.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tmd.language.lexicon.lexicon import Lexicon, first_of, section, singular
from tmd.language.syntax.tokens import NP, Kind, Token, Words

K = Kind
_LONGEST = 18
"""Tokens of a frame, at most."""
_DEEDS = (K.V, K.ENSURE)


class Frames(Words):
    """One pass over the decided words of a text."""

    def __init__(self, tokens: list[Token], lexicon: Lexicon) -> None:
        """Take decided words."""
        super().__init__(tokens)
        self._lexicon = lexicon

    def run(self) -> list[Token]:
        """Return the words that are in no frame."""
        if section("people").isdisjoint(self._lexicon.kinds):
            self._somebody()
        kept: list[Token] = []
        at = 0
        while at < len(self.tokens):
            at = self._parenthesis(at)
            begins = not at or self.follows(at - 1, "STOP|COMMA|CC") or self.among(at - 1, "reasoning")
            end = self._end(at) if begins else at
            end = self._courtesy(at) if end == at else end
            if end == at:
                kept += self.tokens[at : at + 1]
                end += 1
            at = end
        return kept

    def _somebody(self) -> None:
        """Read people who are not here as "somebody", where they are what a clause is about: "my son is thirsty"."""
        for at in reversed(range(len(self.tokens))):
            start = at
            while self.follows(start - 1, "DET|ADJ|N") and start:
                start -= 1
            begins = not start or self.follows(start - 1, "STOP|COMMA|CC|SUB") or self.among(start - 1, "reasoning")
            if begins and self.kind(at) is K.N and self._is_person(at):
                gone = self.tokens[start:at]
                person = self.tokens[at]
                person.kind, person.text = K.SUBJECT, first_of("somebody")
                person.parts += [part for token in gone for part in (token.span, *token.parts)]
                del self.tokens[start:at]

    def _is_person(self, at: int) -> bool:
        """Return whether a subject is a person: by its noun, or a name that is no word and has or needs something."""
        token, verb = self.tokens[at], self.past(at + 1, "IDLE*")
        needs = self.kind(verb) is K.AUX and self.among(verb, "having", "needing")
        named = (token.capital or not at or self.follows(at - 1, "STOP")) and not self._lexicon.knows(token.text)
        known = singular(token.text) in section("people") and not self._lexicon.names_thing(token.text)
        says = self.follows(verb, "AUX|FINITE") and not self.stem_among(verb, "wishing")  # "my aunt wants the lamp on"
        return (named and needs) or (known and says)

    def _parenthesis(self, at: int) -> int:
        """Return where words go on behind talk that adds nothing: "I think", "let me see"."""
        verb = self.past(at + 1, "(IDLE|AUX)*")
        if self.kind(at) is K.LET and self.among(at + 1, "persons"):
            verb = at + 2
        elif not self.among(at, "speakers"):
            return at
        return verb + 1 if self.stem_among(verb, "parenthetic") and self.follows(verb + 1, "STOP|COMMA") else at

    def _end(self, begin: int) -> int:
        """Return where the frame that begins at a place ends; the place itself where none does."""
        start = self.past(begin, "IDLE*")
        if not self.follows(start, "SUBJECT|AUX|NEG") and not self.among(start, "singular_pronouns"):
            return begin
        for place in range(start + 1, min(start + _LONGEST, len(self.tokens))):
            if self.follows(place, "STOP|COMMA"):
                break
            end = self._counts(start, place)
            if end and self._asks(start, place, end):
                own = not any(self.among(i, "addressee", "persons") for i in range(start, end))
                self.tokens[end].told = own and self.among(start, "speakers", "self_forms")  # "I want to see the snow"
                return end
            if end:
                return self._denied(start, end) or begin
            if self._is_deed(place) or self._is_thing(place):
                break
        return begin

    def _is_thing(self, at: int) -> bool:
        return self.kind(at) is K.N and self._lexicon.is_noun(self.tokens[at].text)

    def _is_deed(self, at: int) -> bool:
        """Return whether a verb stands at a place that is itself what is asked for, or tells what has been done."""
        token = self.tokens[at]
        if token.kind not in (K.V, K.FINITE, K.ING):
            return False
        known = token.stem in section("verbs") or token.stem in self._lexicon.goal_verbs
        return token.form == "ed" or (known and token.stem not in section("framing"))

    def _is_done(self, at: int) -> bool:
        """Return whether a word is a form of a verb that does not belong to a frame: "put", "heated", "boiling"."""
        verb = self._lexicon.verb(self.tokens[at].text)
        return verb is not None and verb[0] in section("verbs") - section("framing") - section("courtesies")

    def _counts(self, start: int, at: int) -> int:
        """Return the place of the verb that counts where a frame leads to it at ``at``; 0 elsewhere."""
        if self.kind(at) is K.TO and (self.tokens[at].form == "inf" or self.kind(self.peek(at)) is K.ENSURE):
            return 0 if self._offers(start, at) else self._infinitive(self.peek(at))
        if self._is_thought(at):
            return self._joined(start, at - 1, advised=False)  # "I don't suppose you could"
        if self.among(at - 1, "glad") and self.among(at, "awaited") and self.kind(at + 1) in NP:
            token = self.tokens[at]  # "I'd be grateful for a tea"
            token.kind, token.stem, token.form = K.V, first_of("ordering"), "base"
            return at
        advised = self.stem_among(at - 1, "advising") and self.among(at, "persons")
        if advised or self.among(at, "frame_joints"):
            return self._joined(start, at, advised=advised)
        before = self.back(at)
        if self.among(before, "persons"):
            before = self.back(before)  # "I'd appreciate you closing it"
        return at if self.stem_among(before, "mind") and self._made_deed(at, "ing") else 0

    def _offers(self, start: int, at: int) -> bool:
        """Return whether speakers report what they do or feel: "I'd be ashamed to serve it", not "glad to"."""
        frame = range(start, at)
        speaks = self.tokens[start].text.partition("'")[0] in section("speakers")
        feels = speaks and any(self.among(i, "be") for i in frame)
        wishes = any(self.stem_among(i, "wishing", "framing") or self.among(i, "glad", "welcome") for i in frame)
        return feels and not wishes

    def _infinitive(self, verb: int) -> int:
        """Return the place of the verb behind "to", if it counts; 0 for others."""
        if self.stem_among(verb, "knowing") and self.kind(verb + 1) is K.PURP:
            verb = self.peek(verb + 1)
        wish = self.kind(verb) is K.AUX and self.kind(verb + 1) in NP and self._made_deed(verb, "base")
        return verb if wish or self.kind(verb) in _DEEDS else 0

    def _joined(self, start: int, at: int, *, advised: bool) -> int:
        """Return the place of the verb behind "if you could", or of "if" before a wished state; 0 for others."""
        verb = self.past(at + 1, "(SUBJECT|PRON|AUX|IDLE|MOD)*")
        person = self.among(at + 1, "subjects", "persons")
        asked = advised or (person and not self.among(at + 1, "singular_pronouns"))
        if asked and (self.kind(verb) in _DEEDS or self._made_deed(verb, "base") or self._made_deed(verb, "ed")):
            return verb
        if asked and self.kind(verb) in NP and self._made_deed(verb - 1, "base"):
            return verb - 1  # "might have some tea"
        if person or not self._is_welcome(start, at):
            return 0
        self.tokens[at].kind = K.ENSURE
        return at

    def _is_welcome(self, start: int, at: int) -> bool:
        """Return whether a state follows that would be welcome: "it would be nice if there were some tea"."""
        glad = any(self.among(i, "welcome", "glad") or self.stem_among(i, "wishing") for i in range(start, at))
        return glad and (self.among(at + 1, "there_words") or self.kind(at + 1) in NP)

    def _is_thought(self, at: int) -> bool:
        """Return whether a person with a modal verb stands behind what is hoped or supposed, without "that"."""
        return (
            self.stem_among(at - 1, "framing")
            and self.among(at, "subjects")
            and any(self.among(i, "frame_modals") for i in range(at + 1, min(self.peek(at) + 1, len(self.tokens))))
        )

    def _made_deed(self, at: int, form: str) -> bool:
        """Make "putting" of "would you mind putting" what is asked for, if it is a verb in this form."""
        token = self.tokens[min(at, len(self.tokens) - 1)]
        known = self._lexicon.verb(token.text)
        if known is None or known[1] != form:
            return False
        token.stem, token.form = known[0], "base"
        token.kind = K.LET if token.stem in section("let_verbs") else K.V
        return True

    def _courtesy(self, at: int) -> int:
        """Return where a condition ends that is only polite: "if that is possible", "when you have a moment"."""
        if self.kind(at) is not K.SUB or not self.among(at, "courteous"):
            return at
        end = self.first(at, "STOP|COMMA|V P? (DET|PRON|N)")
        inner = range(at + 1, end)
        about = self.among(at + 1, "singular_pronouns", "subjects", "persons")
        words = {word for i in inner for word in (*self.tokens[i].text.split(), self.tokens[i].stem)}
        polite = section("courtesies") | (section("finishing") if self.among(at + 1, "addressee") else frozenset())
        said = not words.isdisjoint(polite)
        if not (about and said) or any(self._is_thing(i) or self._is_deed(i) or self._is_done(i) for i in inner):
            return at
        return end + (self.kind(end) is K.COMMA)

    def _denied(self, start: int, end: int) -> int:
        """Make a prohibition of "I don't want you to"; return the place of its denial, 0 for other frames."""
        frame = range(start, end)
        wished = self.among(start, "speakers") and any(self.stem_among(i, "wishing") for i in frame)
        denied = sum(self.kind(i) is K.NEG for i in frame) == 1 and any(self.among(i, "persons") for i in frame)
        if not (wished and denied and self.kind(end - 1) is K.TO):
            return 0
        self.tokens[end - 1].kind, self.tokens[end - 1].text = K.NEG, first_of("negations")
        return end - 1

    def _asks(self, start: int, at: int, end: int) -> bool:
        """Return whether a frame asks for what follows, and does not state or deny it."""
        frame = range(start, end)
        denied, asked = [i for i in frame if self.kind(i) is K.NEG], self.asked(at)
        if denied and not (asked and self._is_harmless(denied, frame)):
            return False
        modal = any(self.among(i, "frame_modals", "frame_negations") for i in frame)
        wished = self.among(start, "speakers", "self_forms") and any(map(self._is_wish, frame))
        kindly = self.among(start, "infinitive_be")
        return modal or wished or kindly or (asked and self.kind(start) is K.AUX)

    def _is_harmless(self, denied: Sequence[int], frame: Iterable[int]) -> bool:
        """Return whether negations of a question deny nothing: "wouldn't you", "I don't suppose"."""
        return all(self.among(i, "frame_negations") for i in denied) or any(
            self.stem_among(i, "supposing") for i in frame
        )

    def _is_wish(self, at: int) -> bool:
        """Return whether a verb wishes for what follows: "I like to read" does not, without "would"."""
        return self.stem_among(at, "framing", "advising") and not self.stem_among(at, "liking")
