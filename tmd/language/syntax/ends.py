"""Lookahead of the brackets: where clauses, statements and prohibitions end.

The classes of the words ahead decide; nothing is changed here.
"""

from __future__ import annotations

from tmd.language.lexicon.lexicon import section, singular
from tmd.language.syntax.tokens import BREAKS, LINKS, NP, Kind, Words

K = Kind


class ClauseEnds(Words):
    """The words of a text, with the ends of the clauses that begin at a place."""

    def _statement_end(self, at: int) -> int:
        """Return where a statement ends whose finite verb stands at ``at``."""
        end = self.peek(at, "(IDLE|AUX|SUBJECT|NEG|TO|INF)*")
        end += self.kind(end) is K.V
        while self.kind(end) is not K.STOP:
            deed = self.kind(end) is K.V and self.kind(end - 1) not in (K.TO, K.AUX, K.NEG)
            # "such a draught that I'll catch a cold", "they are getting warm"
            deed = deed and not (self.among(end - 1, "self_forms") or self.stem_among(end - 1, "becoming"))
            if deed or self._goes_on_behind(end) or self.follows(end, "SUB|ENSURE|PURP"):
                break
            end += 1
        return end

    def _goes_on_behind(self, at: int) -> bool:
        """Return whether something else than a statement goes on behind a comma or a conjunction."""
        if self.follows(at, "LINKS IDLE* (V|SUBJECT|SUB|NEG|ENSURE|LET) | COMMA IDLE* AUX | LINKS+ IDLE* AUX SUBJECT"):
            return True
        if self.kind(at) not in LINKS:
            return False
        if self.follows(at + 1, "IDLE* NP+ (P NP+)* NEG BREAK"):
            return True  # "the red one should be washed, the blue one not"
        said = self.kind(at) is K.COMMA and (self._statement_follows(at) or self._demands(at + 1) > 0)
        also = self._too(at + 1 + (self.kind(at + 1) is K.CC))
        return said or also or self._is_reason(at + 1) or self.among(at, "then_words")

    def _demands(self, at: int) -> int:
        """Return where a relative clause behind a comma demands something: ", which go in the basket", else 0."""
        said = self.peek(at)
        if not (self.kind(at) is K.REL and self.kind(at - 1) is K.COMMA):
            return 0
        named = self.among(said, "belonging") or self.stem_among(said, "belonging")
        return said if named and self.kind(said) is K.FINITE else self._duty(said)

    def _duty(self, at: int) -> int:
        """Return where a duty of a thing or of the addressee begins: "must be shut", "you should wash"; 0 for none."""
        goes_on = self.first(at, "COMMA|SEP|STOP")
        # ", which must be clean, to Ann", ", which should be in the chest"
        if self.follows(goes_on, "COMMA (P|TO)") or self.follows(at, "AUX IDLE* AUX P"):
            return 0
        deed = self.past(at, "PRON IDLE* AUX (TO|INF|ADV|IDLE)* V")
        own = deed > at and self.among(at, "addressee") and self.kind(deed) not in NP
        duty = self.peek(at) if own else at
        due = self.kind(duty) is K.AUX and self.among(duty, "duties")
        return (deed - 1 if own else at) if due else 0

    def _statement_follows(self, at: int) -> bool:
        """Return whether a subject with its finite verb stands behind a comma or a conjunction."""
        begin = self.past(at + 1, "CC* IDLE*")
        there = self.among(begin, "there_words") and self.kind(begin + 1) is K.AUX
        there = there or (self.among(begin - 1, "there_words") and self.kind(begin) is K.AUX)
        subject = "(NP|OF|IDLE|CC|EXC)* (HEAD|NUM) (NP|OF|IDLE|CC|EXC)* (P NP+)?"  # "the mug on the shelf is dirty"
        return there or self.follows(at + 1, f"{subject} (AUX|FINITE|NEG AUX)")

    def _clause_end(self, at: int) -> int:
        """Return where the subordinate clause that opens at ``at`` ends."""
        finite, end = False, at + 1
        while not (self.follows(end, "STOP|COMMA|ENSURE|LET") or self.among(end, "then_words")):
            deed = self.kind(end) is K.V and end > at + 1
            free = self.kind(end - 1) not in (K.AUX, K.TO, K.NEG) and (finite or self.kind(end - 1) is not K.SUBJECT)
            if (deed and free) or self._begins_behind(end, finite=finite):
                break
            if finite and self._begins_main(end):
                break
            if self.among(end, "by_words") and self.kind(end + 1) is K.ING:
                break
            finite = finite or deed or self.follows(end, "FINITE|AUX|ING|PARTICIPLE|ADJ")
            end += 1
        return end

    def _begins_behind(self, at: int, *, finite: bool) -> bool:
        """Return whether something else begins behind a conjunction; a subordinate clause may go on instead.

        *If the lamp is on and she is in the hall, …*, *if it is on and not broken, …*
        """
        goes_on = finite and self.follows(at, "CC IDLE* SUBJECT IDLE* AUX | CC NEG (ADJ|PARTICIPLE) BREAK")
        return self.follows(at, "CC IDLE* (V|SUBJECT|NEG|ENSURE|LET)") and not goes_on

    def _begins_main(self, at: int) -> bool:
        """Return whether the main clause begins behind a whole subordinate one: "once it boils | it should …"."""
        said = self.kind(at - 1) in (K.N, K.ADJ, K.FINITE, K.PARTICIPLE) and self.follows(at, "PRON IDLE* AUX")
        # "when it is dry the lid should be shut"
        state = self.kind(at - 1) in (K.ADJ, K.PARTICIPLE) or self.among(at - 1, "end_states")
        said = said or (state and self.follows(at, "DET (NP|OF)* IDLE* AUX"))
        return said or self.follows(
            at, "SUB|PURP|SUBJECT IDLE* (AUX|NEG)" if self.kind(at - 1) is not K.CC else "SUB|PURP"
        )

    def _relative_end(self, at: int) -> int:
        """End a relative clause where the main clause goes on: "the chair that stands there to the desk"."""
        verb = said = done = False
        for place in range(at + 1, self._clause_end(at)):
            if verb and (self.kind(place) is K.CC or ((said or done) and self.follows(place, "FINITE|AUX"))):
                return place  # "everything that is empty | goes in the bin", "… that was washed | goes on the shelf"
            done = done or self._has_happened(at, place, verb=verb)
            if self.follows(place, "INF AUX") or self._goes_on(at, place, verb=verb, said=said):
                return place
            said = said or (verb and (self.follows(place, "HEAD|ADJ") or self.among(place, "there_words")))
            verb = verb or self.follows(place, "FINITE|AUX|PARTICIPLE")
        return self._clause_end(at)

    def _has_happened(self, at: int, place: int, *, verb: bool) -> bool:
        """Return whether a participle is the verb of a relative clause: "… that was washed", "who left"."""
        return self.kind(place) is K.PARTICIPLE and (verb or place == at + 1)

    def _goes_on(self, at: int, place: int, *, verb: bool, said: bool) -> bool:
        """Return whether a preposition belongs to the main clause again."""
        if not self.follows(place, "P|TO|EXC"):
            return False
        state = self.kind(place - 1) is K.ADJ  # "the bottles that are empty | in the bag"
        inner = self.follows(place - 2, "P PRON")  # "the cup that has water in it | in the sink"
        owns = said and self.among(at + 1, "having") and self.kind(place + 1) is not K.PRON
        away = said and self.among(place, "arrivals", "origins") and not self.among(place, "static")
        return self.kind(place) is K.EXC or owns or (verb and (state or inner or away))

    def _negation_end(self, at: int) -> int:
        """Return where a prohibition ends of which the deed, or the thing, stands at ``at``."""
        deed, end = self.kind(at) in (K.V, K.LET, K.ING), at
        while self.kind(end) is not K.STOP:
            contrast = self.among(end, "contrasts") or self.kind(end) is K.COMMA
            if contrast and self.follows(end + 1, "IDLE* (V|SUBJECT|SUB|NP|P|TO|INF)"):
                break
            tells = self.kind(end) is K.SUBJECT and self.among(end, "tellers") and end > at
            run_on = tells or (self.follows(end - 1, "(HEAD|STATE) V") and self.tokens[end].strength == 3)
            if run_on or (not deed and self.follows(end, "INF|SUB|PURP|V")):
                break  # "the saw, not the axe, to cut it"
            end += 1
        return end

    def _is_reason(self, at: int) -> bool:
        """Return whether what stands before is the reason of what follows: "so", but not "so does the mug"."""
        asks = self.among(at + 1, "frame_modals") and self.among(at + 2, "addressee", "tellers")
        return self.among(at, "reasoning") and (asks or not self.follows(at + 1, "AUX NP"))

    def _wishes_so(self, at: int) -> bool:
        """Return whether a wish follows for which the reason stands before: "so I'd like the lamp on"."""
        subject = self.peek(at)
        said = range(subject + 1, self.past(subject + 1, "(IDLE|AUX)*") + 1)
        wishes = any(self.stem_among(i, "wishing", "liking") or self.among(i, "wishing") for i in said)
        return wishes and self.kind(subject) in (K.SUBJECT, K.PRON) and self.among(at, "reasoning")

    def _noticed(self, at: int, verb: int) -> bool:
        """Return whether a subject notices something, or has done something: "somebody has put it there"."""
        done = self.kind(verb) is K.PARTICIPLE and self.among(verb - 1, "having") and at + 1 < verb
        return done or (self.stem_among(verb, "noticed", "knowing") and self.kind(at - 1) is not K.AUX)

    def _asks_denied(self, at: int) -> bool:
        """Return whether a negation only makes a question polite: "you couldn't open it, could you?"."""
        return self.among(at, "frame_negations") and self.asked(at) and self.among(self.back(at), "addressee")

    def _is_modal(self, at: int) -> bool:
        """Return whether a verb stands right behind "would" or the like."""
        return any(self.among(i, "frame_modals") for i in range(max(at - 2, 0), at))

    def _wished_ahead(self, at: int) -> bool:
        """Return whether a wish names only a state or a place: what it is about stands before it."""
        state = self.kind(at + 1) in (K.ADJ, K.PARTICIPLE, K.P) or self.among(at + 1, "end_states")
        return state and self.stem_among(at, "wishing")

    def _too(self, at: int) -> bool:
        """Return whether a noun phrase with "too" or "also" stands from a place on, and nothing else."""
        begin = self.past(at, "IDLE*")
        end = self.past(begin, "NP+")
        ahead = any(self.among(i, "also_words") for i in range(at, begin)) and self.kind(end) in BREAKS
        return end > begin and (
            ahead or (self.among(end, "also_words") and self.follows(end + 1, "IDLE* (BREAK|SUB|PURP)"))
        )

    def _is_wished(self, at: int) -> bool:
        """Return whether a state stands behind things: "I want the fork cleaned", "I want the fork put in the sink"."""
        if self.kind(at) is K.V and self.stem_among(at, "placing") and self.follows(at + 1, "P"):
            self.tokens[at].kind = K.PARTICIPLE
        return self.kind(at) in (K.PARTICIPLE, K.ADJ) or self.among(at - 1, "end_states")

    def _they_are_due(self, at: int, end: int) -> bool:
        """Return whether a clause says in what state things are to be: "they should be off", "they need washing"."""
        said = range(at + 1, end)
        due = self.among(at, "plural_pronouns") and any(self.among(i, "duties") for i in said)
        named = next((t.text for t in reversed(self.tokens[:at]) if t.kind is K.N), "")
        if not (due and named) or singular(named) in section("people"):
            return False  # "the guests are here, they should be seated"
        needed = self.among(said[-1], "needing") and self.kind(said[-1] + 1) in (K.ING, K.PARTICIPLE, K.N)
        return needed or self.among(said[-1], "be") or any(self.among(i, "infinitive_be") for i in said)

    def _is(self, at: int, verb: int) -> bool:
        """Return whether a form of *be* stands between a subject and its predicate."""
        return any(self.kind(i) is K.AUX and self.among(i, "be") for i in range(at + 1, verb))

    def _reports(self, at: int, verb: int, *, past: bool) -> bool:
        """Return whether a clause reports: "they left it open", "he never puts them away", "they are getting warm"."""
        unable = self.among(self.peek(at), "abilities")  # "I can hardly see it"; but not "we must not open it"
        denied = self.follows(self.peek(at) + 1 if unable else at + 1, "IDLE* NEG IDLE* (V|N|ADJ|PARTICIPLE)")
        progressive = self.kind(verb) is K.ING and self._is(at, verb)
        return denied or progressive or (past and verb == self.peek(at))

    def _unneeded(self, at: int, deed: int) -> bool:
        """Return whether a negation says that a deed need not be done: "no need to wash it", "don't bother"."""
        if self.stem_among(deed, "caring"):
            return True  # "I don't care if it is old"
        helped = self.kind(deed - 1) is K.TO and any(self.among(i, "unneeded") for i in range(at, deed))
        named = self.follows(deed + 1, "IDLE* NP") and self.tokens[self.peek(deed)].form != "ing"
        idle = self.stem_among(deed, "unneeded") and not named  # but not "don't bother the cat"
        # "they don't need any light in summer"
        spared = self.among(deed - 1, "unneeded") and self.follows(deed, "NP+ (P NP+)* IDLE* BREAK")
        return self.among(at, "needless") or helped or idle or spared

    def _causes(self, at: int) -> bool:
        """Return whether a verb only brings another one about: "make it play", "make close the door"."""
        end = self.past(at + 1, "(NP|IDLE|OF)*")
        sure = self.tokens[end].strength >= 3 if end < len(self.tokens) else False
        if self.kind(end) is not K.V or self.tokens[end].form != "base" or not (sure or self.kind(end - 1) is K.PRON):
            return False
        return end == at + 1 or self.follows(end + 1, "IDLE* (BREAK|P|SUB)")
