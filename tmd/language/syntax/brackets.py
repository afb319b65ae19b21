"""Bracket subordinate clauses, statements, demands and prohibitions: from their opener to the mark of their end.

The grammar (``clauses.lark``) cannot look ahead. The classes of the words decide where a clause begins, and where it
ends (:mod:`~tmd.language.syntax.ends`).
What asks for nothing (questions, what is taken back, what need not be done) is set aside with its reason.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from itertools import pairwise, takewhile

from tmd.language.clause import BE, TO, Span
from tmd.language.lexicon.lexicon import Lexicon, first_of, pairs, section
from tmd.language.syntax.corrections import CORRECTED, GAP, Corrections
from tmd.language.syntax.tokens import ADDRESS, BREAKS, HEADS, IDLE, LINKS, NP, Kind, Token, mark, noted

K = Kind
ALSO = "also"
"""The form of a joint, or of a preposition behind one, that goes on with what stood earlier: "and the mug too"."""
RELATIVE = "relative"
"""The form of a preposition that opens what was a relative clause: "the remote that is on the sofa"."""
ALONE = "alone"
"""The form of a verb that shares no object with the next one."""
DUTY = "duty"
"""The form of the opener of a statement that demands a state."""
STATEMENT = "a statement, not an instruction"
UNNEEDED = "says what need not be done"
REMINDER = "names a thing, and not what to do with it"
ASIDE = "an aside in brackets"
QUESTION = "a question, not an instruction"
REASON = "says what the rest is for"
_DEPTH = 3
"""Maximum nesting depth of subordinate clauses."""
_NEAR = 15
"""Tokens that are looked ahead for what a wish is about."""

Handler = Callable[[int], int]
"""Reads what begins at a place; returns where reading goes on."""


class Bracketer(Corrections):
    """One pass over the joined words of a text."""

    def __init__(self, tokens: list[Token], lexicon: Lexicon) -> None:
        """Take the words of a text."""
        super().__init__(tokens)
        self.lexicon = lexicon
        self._open: list[Token] = []
        """The openers of the brackets that are open."""
        shared: dict[Kind, Handler] = {
            K.SUB: self._condition, K.PURP: self._purpose, K.REL: self._relative, K.P: self._preposition,
            K.ADJ: self._adjective, K.ADV: self._adverb, K.FILLER: self._drop, K.SKIP: self._drop,
        }  # fmt: skip
        self._outer: dict[Kind, Handler] = shared | {
            K.STOP: self._stop, K.TO: self._infinitive, K.NEG: self._negative, K.ENSURE: self._ensure,
            K.LET: self._let, K.SUBJECT: self._speaker, K.AUX: self._auxiliary, K.FINITE: self._auxiliary,
            K.PARTICIPLE: self._participle, K.ING: self._ing, K.V: self._deed, K.N: self._noun,
            K.COMMA: self._comma, K.CC: self._joint, K.PRON: self._pronoun,
        }  # fmt: skip
        self._inner: dict[Kind, Handler] = shared | {
            K.STOP: self._drop, K.TO: self._inner_to, K.NEG: self._inner_negation, K.ENSURE: self._drop,
            K.LET: self._inner_other, K.SUBJECT: self._inner_other, K.AUX: self._inner_negation,
            K.DET: self._inner_negation, K.N: self._inner_noun, K.V: self._inner_verb,
            K.COMMA: self._inner_joint, K.CC: self._inner_joint,
        }  # fmt: skip

    def run(self) -> list[Token]:
        """Return the words with brackets."""
        at = 0
        while at < len(self.tokens):
            if self._corrects(at):
                at = self._corrected(at)
            elif self._is_inverted(at):
                self.tokens[at].text = first_of("guards")
                at = self._condition(at)
            elif self._is_question(at):
                at = self._question(at)
            else:
                at = self._outer.get(self.kind(at), self._keep)(at)
        return self.out

    # brackets

    def _bracket(self, opener: Token, kind: Kind, at: int, end: int) -> int:
        """Emit an opener, what stands from ``at`` to ``end``, and the closing mark."""
        if len(self._open) < _DEPTH and end > at:
            opener.kind = kind
            self.out.append(opener)
            self._fill(opener, at, end)
        return max(end, at)

    def _fill(self, opener: Token, at: int, end: int) -> None:
        self._open.append(opener)
        place = at
        while place < end:
            if not self._corrects(place):
                place = self._inner.get(self.kind(place), self._keep)(place)
            elif self.follows(self.peek(place, GAP), "P|TO"):
                place = self._corrected(place)
            else:  # "the lamp should be on, no, I mean the radio" is not read
                place = self._skip(place, end, REMINDER)
        self._open.pop()
        self.out.append(mark(K.END, self.tokens[end - 1].span.end))
        start = next(i for i in range(len(self.out) - 1, -1, -1) if self.out[i] is opener)
        if self._verb is None and not self._open and all(t.kind in LINKS for t in self.out[self._subject : start]):
            self._subject = len(self.out)

    def _statement(self, at: int, *, negated: bool = False) -> int:
        """Bracket a statement whose subject has come and whose finite verb stands at ``at``."""
        self._except()
        self._part_subject()
        start = (self.out[self._subject] if self._subject < len(self.out) else self.tokens[at]).span.start
        say = mark(K.SAY, start)
        say.negated = negated
        say.form = DUTY if self._asked or self._demand_goes_on(at) else ""
        self.out.insert(self._subject, say)
        reported = self.kind(at) is K.FINITE and self.stem_among(at, "reporting")
        end = self.past(at + 1, "REL?") if reported else self._statement_end(at)
        self._fill(say, at, end)
        if reported:  # "Grandma says the lamp should be off"
            self.out.append(mark(K.SEP, self.tokens[end - 1].span.end))
            self._begin()
        return end

    def _demand_goes_on(self, at: int) -> bool:
        """Return whether a statement is one of a demanded list: "see that the gate is shut, the radio off and …"."""
        demanded = any(t.kind is K.ENSURE for t in self.out[self._units[0][0] :])
        rest = range(at, self.first(at, "STOP"))
        return demanded and any(self.kind(i) is K.CC and self._statement_follows(i) for i in rest)

    def _except(self) -> None:
        """Drop the commas around an exception of the subject: "everything, except the cup, goes here"."""
        named = self.out[self._subject :]
        excepts = [i + 1 < len(named) and named[i + 1].kind is K.EXC for i in range(len(named))]
        if any(excepts):
            kept = [t for t, before in zip(named, excepts, strict=True) if not (before and t.kind is K.COMMA)]
            self.out[self._subject :] = kept[:-1] if kept[-1].kind is K.COMMA else kept

    def _part_subject(self) -> None:
        """Begin a unit behind what precedes the subject without belonging to it: "radio off, the baby is asleep"."""
        named = self.out[self._subject :]
        comma = max((i for i, t in enumerate(named) if t.kind is K.COMMA), default=0)
        first = next((i for i in range(comma, len(named)) if named[i].kind not in LINKS), comma)
        before, subject = named[:comma], {t.kind for t in named[first:]}
        stated = any(t.kind is K.STATE for t in before)
        placed = any(t.kind is K.P for t in before[1:]) and before[0].kind not in (K.P, K.EXC) and K.PRON not in subject
        if (stated or placed) and K.CC not in subject and not subject.isdisjoint(HEADS):
            named[comma].kind = K.SEP
            self._subject += comma
            self._begin()
            self._subject = len(self.out) - len(named) + comma + 1

    def _skip(self, at: int, end: int, note: str) -> int:
        """Set words aside with the reason."""
        token = self.tokens[at]
        token.kind, token.note = K.SKIP, note
        token.span = Span(token.span.start, self.tokens[max(at, end - 1)].span.end)
        return end

    def _hosts_result(self) -> bool:
        """Return whether what stands behind an object may be the state that it should be in."""
        if self._verb is None or self._verb.stem.partition("_")[0] in section("result_verbs"):
            return True
        # "bring the blind down and the curtain up"
        return "_" in self._verb.stem and any(t.kind is K.CC for t in self.out[self._subject :])

    def _keep(self, at: int) -> int:
        self.out.append(self.tokens[at])
        return at + 1

    def _drop(self, at: int) -> int:
        return at + 1

    # subordinate clauses

    def _condition(self, at: int) -> int:
        token = self.tokens[at]
        if self._last() is K.EXC:
            self.out.pop()
            token.text = first_of("excepting")  # "except if"
        if self.kind(at + 1) is K.ING:
            self.tokens[at + 1].kind = K.V
        return self._bracket(token, K.SUB, at + 1, self._clause_end(at))

    def _purpose(self, at: int) -> int:
        verb = self.peek(at)
        if self._wishes_so(at):
            return self._stop(at)
        return self._bracket(self.tokens[at], K.PURP, at + 1, self._clause_end(verb if self.kind(verb) is K.V else at))

    def _infinitive(self, at: int) -> int:
        token = self.tokens[at]
        if token.form != "inf":
            token.kind = K.P
            return self._keep(at)
        if (awaited := self._awaited()) is not None:
            awaited.kind = K.SUB  # "wait for the kettle to boil"
            end = self._clause_end(at + 1)
            self._fill(awaited, at + 1, end)
            return end
        if self._drop_lead() or self._last() in LINKS or self._verb is None:
            return at + 1
        if self._verb.stem in section("chain_verbs"):
            token.kind = K.SEP
            self.out.append(token)
            self._begin()
            return at + 1
        return self._purpose(at)

    def _awaited(self) -> Token | None:
        """Return "for" of "wait for the kettle", where waiting is the open verb."""
        if self._verb is None or self._verb.stem not in section("waiting"):
            return None
        behind = self.out[next(i for i, t in enumerate(self.out) if t is self._verb) :]
        return next((t for t in behind if t.text in section("awaited")), None)

    def _drop_lead(self) -> bool:
        """Drop "want you", "remember", "need" right before an infinitive."""
        back = len(self.out) - 1
        while back >= 0 and self.out[back].kind in (K.PRON, K.ADJ, K.STATE):
            back -= 1
        if back < 0 or self.out[back].kind is not K.V or self.out[back].stem not in section("lead_verbs"):
            return False
        self._told = self._somebody and self.out[back].stem in section("wishing")  # "I want to watch it"
        self._cut(back)
        self._verb = None
        return True

    def _relative(self, at: int) -> int:
        copula = self.peek(at)
        demand = self._demands(at)
        # "the mug belongs on the shelf, which must be shut"
        asks = self._verb is not None or any(t.kind is K.SAY for t in self._unit())
        if demand and (asks or self.kind(demand) is K.FINITE):
            return self._repeat_noun(demand)
        said = self.past(copula, "SUBJECT|PRON IDLE* (V|FINITE)")
        if said > copula and self.stem_among(said - 1, "reporting") and self.kind(said) is K.AUX:
            copula = said  # "which I believe is in the chest"
        if self._is_somewhere(copula):
            place = self._there(copula)
            # what has become a pronoun just now is not seen by patterns
            if self.follows(place, "P IDLE* NP") or (self.kind(place) is K.P and self.kind(place + 1) is K.PRON):
                self.tokens[place].form = RELATIVE if self._last() in HEADS else ""
                return place  # "the cup that is on the desk" as "the cup on the desk"
        if self._last() is K.P:
            self.out.pop()
        return self._bracket(self.tokens[at], K.REL, at + 1, self._relative_end(at))

    def _unit(self) -> Iterable[Token]:
        """Return the words of this unit so far, the last one first."""
        return takewhile(lambda token: token.kind is not K.SEP, reversed(self.out))

    def _is_somewhere(self, at: int) -> bool:
        """Return whether a verb may say where something is: "is", "stands", but not "isn't"."""
        if self.kind(at) is K.FINITE:
            return self.stem_among(at, "postures")
        return self.kind(at) is K.AUX and self.among(at, "be") and not self.among(at, "not_forms")

    def _repeat_noun(self, at: int) -> int:
        """Begin a statement about the last thing named: "all but the socks, which go in the basket"."""
        end = max((i for i, token in enumerate(self.out) if token.kind is K.N), default=-1) + 1
        start = end
        while start and self.out[start - 1].kind in NP:
            start -= 1
        self.out[-1].kind = K.SEP if self._last() is K.COMMA else self._last()
        if self.kind(at) is K.FINITE:
            self.tokens[at].stem = self.tokens[at].stem or first_of("belonging")
        self._begin()
        named = [replace(token) for token in self.out[start:end]]
        if self.kind(at) is K.V:
            at = self._deed(at)
        self.out += named
        return at

    def _there(self, copula: int) -> int:
        """Return where a place begins behind a form of *be*: "that is in there" is in it, "that is there" at it."""
        place = self.peek(copula, "(IDLE|PARTICIPLE|ING)*")
        place += self.among(place, "loosely")
        if self.kind(copula) is K.AUX and self.among(copula + 1, "there_words") and self._last() in HEADS:
            place = copula
            self.tokens[place].kind, self.tokens[place].text = K.P, first_of("whereabouts")
        if self.kind(place) is K.P and self.among(place + 1, "there_words"):
            self.tokens[place + 1].kind, self.tokens[place + 1].text = K.PRON, first_of("singular_pronouns")
        return place

    def _ensure(self, at: int) -> int:
        token, begin = self.tokens[at], at + 1
        while self.follows(begin, "TO|INF|REL|ADV") or self.among(begin, "relatives"):
            begin += 1
        if self.follows(begin, "V|SUBJECT|NEG|MOD"):
            return begin
        finite = self.past(begin, "(NP|P|ADV|MOD|EXC|TO|INF|OF|CC)*")
        if self.follows(finite, "AUX|FINITE|NEG"):
            return self._bracket(token, K.ENSURE, begin, self._statement_end(finite))
        token.kind, token.stem, token.form = K.V, token.text, "base"
        return self._deed(at)

    def _negative(self, at: int) -> int:
        """Drop a negation that only makes a question polite; read any other."""
        self.tokens[at].kind = K.FILLER if self._asks_denied(at) else K.NEG
        return at + 1 if self.kind(at) is K.FILLER else self._negation(at)

    def _negation(self, at: int) -> int:
        """Bracket what must not be done: "don't open it", "not the mug"."""
        token = self.tokens[at]
        if self._verb is None and self.among(at, "none_words") and self._statement_follows(at):
            token.kind = K.DET  # "neither the lamp nor the radio should be on"
            return self._keep(at)
        contrast = self.kind(self.back(at)) is K.COMMA and self.kind(self.peek(at)) in NP | {K.P}
        apart = self.kind(self.back(at)) is K.CC and self.kind(self.peek(at)) is K.V  # "…, but don't wrap it"
        if self._verb is None and self._named() and not (contrast or apart):  # "chips in the bowl, not on the plate"
            return self._denied(at)
        deed = self.past(at + 1, "(NEG|IDLE|AUX|SUBJECT|TO|INF)*")
        if self.stem_among(deed, "forgetting"):
            thing = self.kind(deed + 1) in NP
            return self._skip(at, self._clause_end(deed), REMINDER) if thing else deed + 1
        if self.stem_among(deed, "stopping") and self.kind(deed + 1) is K.ING:
            return deed + 1  # "don't stop stirring"
        end = self._negation_end(deed)
        if self._unneeded(at, deed):
            return self._set_aside(at, deed, end)
        return self._bracket(token, K.NEG, deed, end)

    def _set_aside(self, at: int, deed: int, end: int) -> int:
        """Set aside what need not be done; a thing can be spoken of: "we don't need the lamp, turn it off".

        What need not be done under a condition is done otherwise: "water it. If it is wet, there is no need".
        """
        if self.kind(deed) not in NP or self.among(at, "needless"):
            end = min(end, self.first(deed, "SUB|STOP"))
            self._spare(at, end)
            return self._skip(at, end, UNNEEDED)
        self.tokens[at].note = UNNEEDED
        return self._bracket(self.tokens[at], K.SAY, deed, end)

    def _spare(self, at: int, end: int) -> None:
        """Turn the condition of what need not be done round; take it back where another deed is spared."""
        start = self._units[-1][0]
        ahead = [i for i, token in enumerate(self.out) if i >= start and token.kind is K.SUB]
        before = {token.text for token in self.out[:start] if token.kind is K.N}
        if {t.text for t in self.tokens[at:end] if t.kind is K.N} <= before:
            opener = self.tokens[self.past(end, "COMMA*")] if self.kind(end) is not K.STOP else self.tokens[at]
            for token in [self.out[i] for i in ahead] + [opener] * (opener.kind is K.SUB):
                token.text = first_of("guards" if token.text in section("excepting") else "excepting")
        elif ahead:
            self._take_back(ahead[0], UNNEEDED)

    def _denied(self, at: int) -> int:
        """Bracket a statement whose negation stands at ``at``; set aside what things need not have."""
        if self.among(self.peek(at), "unneeded") and self.follows(self.peek(at) + 1, "NP+ BREAK"):
            self._take_back(self._subject, UNNEEDED)  # "the van doesn't need one"
            return self._skip(at, self.first(at, "BREAK"), UNNEEDED)
        self.tokens[at].kind = K.AUX  # "the mug shouldn't be there"
        return self._statement(at, negated=True)

    # statements

    def _speaker(self, at: int) -> int:
        """Bracket what speakers report about themselves or notice; drop other subjects."""
        verb = self.past(at + 1, "(IDLE|AUX)*")
        if (wish := self._denied_wish(at)) is not None:
            opener = self.tokens[self.peek(at)]
            opener.negated = True
            return self._bracket(opener, K.ENSURE, wish + 1, self._statement_end(wish + 1))
        while self._last() is K.COMMA and self._verb is None and self._wished_ahead(verb):
            self.out.pop()  # "the curtain, I'd like open"
        own = self._of_oneself(at, verb)
        if own and self.stem_among(verb, "ordering") and self.tokens[verb].form != "ing":
            self._told, self._somebody = self.stem_among(verb, "liking"), True
            return at + 1  # "I'll have a tea"
        if said := self._said_of_them(at, verb):
            return said
        tells = self._begin_telling(at, own=own)
        self._somebody = True
        leads = self.follows(verb + 1, "IDLE* (TO|INF)") and not self._is(at, verb)
        if self._verb is not None or not (own or self._noticed(at, verb)) or leads:
            self._told = self._told or tells
            return at + 1
        self.tokens[at].kind = K.PRON
        return self._bracket(mark(K.SAY, self.tokens[at].span.start), K.SAY, at, self._statement_end(at))

    def _said_of_them(self, at: int, verb: int) -> int:
        """Bracket what "they" of things are, or are to be; return where it ends, or 0 for other subjects."""
        due = self.past(verb, "(IDLE|AUX|NEG|TO|INF)*")
        finite = verb if self._they_belong(at, verb) else at + 1 if self._they_are_due(at, due) else 0
        if not finite:
            return 0
        self._begin_telling(at, own=False)
        self.tokens[at].kind, self.tokens[at].text = K.PRON, first_of("plural_pronouns")
        say = mark(K.SAY, self.tokens[at].span.start)
        for token in self.tokens[at + 1 : due]:
            if token.kind is K.NEG and token.text in section("duties"):
                token.kind, say.negated = K.AUX, True  # "they shouldn't be"
        return self._bracket(say, K.SAY, at, self._statement_end(finite))

    def _they_belong(self, at: int, verb: int) -> bool:
        """Read "belong" of "they belong on the bench" as finite; return whether it says where things are to be."""
        belongs = self.stem_among(verb, "belonging") or self.among(verb, "belonging")
        if not (belongs and self.among(at, "plural_pronouns") and self.follows(verb + 1, "IDLE* (P|TO)")):
            return False
        said = self.tokens[verb]
        said.kind, said.stem = K.FINITE, first_of("belonging")
        return True

    def _begin_telling(self, at: int, *, own: bool) -> bool:
        """Begin a unit where somebody is the subject; return whether it is somebody other than the addressee."""
        tells = self.tokens[at].text.partition("'")[0] in section("tellers")
        if self._last() in LINKS and ((own and self._verb is not None) or (tells and self._named())):
            self.out[-1].kind = K.SEP
            self._begin()
        return tells and self.kind(at - 1) is not K.AUX

    def _of_oneself(self, at: int, verb: int) -> bool:
        """Return whether speakers report about themselves: "I'm thirsty", "I spilled it", "I'll get it later"."""
        if self.among(at, "self_forms"):
            return True
        if self.among(at, "addressee") and self.kind(verb) is K.ING and self._is(at, verb):
            return not self.follows(verb + 1, "IDLE* INF")  # "you're sitting there"
        past = verb < len(self.tokens) and self.tokens[verb].form == "ed" and self.kind(verb) is not K.ADJ
        if self.among(at, "tellers") and self._reports(at, verb, past=past):
            return True
        liking = (self.stem_among(verb, "liking") or self._tells(verb)) and verb == self.peek(at)
        return self.among(at, "speakers") and (self._is(at, verb) or past or liking)

    def _tells(self, at: int) -> bool:
        """Return whether a verb never is an instruction, in English or in this domain: "I promise", "we prefer"."""
        if self.kind(at) is not K.V or self.stem_among(at, "verbs", "wishing", "ordering", "lead_verbs", "framing"):
            return False
        return self.tokens[at].stem not in self.lexicon.goal_verbs

    def _denied_wish(self, at: int) -> int | None:
        """Return where "want" stands in "I don't want the lamp on"."""
        wish = self.peek(self.peek(at))
        denied = self.among(at, "speakers", "self_forms") and self.kind(self.peek(at)) is K.NEG
        return wish if denied and self.stem_among(wish, "wishing") and self._wishes_state(wish) else None

    def _wishes_state(self, at: int) -> bool:
        """Return whether a wish is for a state: "I want the fork put in the sink", "I'd like the window to be open"."""
        to = self.first(at + 2, "INF|STOP|COMMA|V")
        if to < at + _NEAR and self.kind(to) is K.TO and self.kind(at + 1) is not K.PRON:
            self._stands(to + 1)
            if self.kind(to + 1) is K.AUX:
                return True
        place, things = at + 1, False
        while self.follows(place, "(NP|P|ADV|MOD|EXC|TO|OF|CC|AUX|FILLER)") and (
            self.kind(place) is not K.ADJ or self._leads(place)
        ):
            things = things or self.kind(place) is K.N or self.among(place, "whole_words")
            behind = self.kind(place + 1) is K.P and not self.among(place + 1, "static")
            if things and behind and self.among(place, "end_states"):
                self.tokens[place].kind = K.STATE  # "I want the lamp on for the guests"
                return True
            place += 1
        return things and self._is_wished(place)

    def _stands(self, at: int) -> None:
        """Read "to stand on the table", "to stay shut" as to be there or so."""
        if not self.among(at, "postures", "staying", "belonging"):
            return
        if self.kind(at + 1) is K.FILLER and self.among(at + 1, "static"):
            self.tokens[at + 1].kind = K.P  # no particle: "to go on the table"
        if self.follows(at + 1, "ADV* (P|TO|REL|ADJ|PARTICIPLE)"):
            self.tokens[at].kind, self.tokens[at].text = K.AUX, BE

    def _auxiliary(self, at: int) -> int:
        """Open a statement where a subject or "there" stands before an auxiliary; drop any other."""
        there, after = self.among(at - 1, "there_words"), self.peek(at)
        self._begin_question(at, after)
        if self.among(after, "needless"):
            return self._negation(after)
        fresh = self._verb is None and all(t.kind in LINKS for t in self.out[self._subject :])
        if not there and self._gets(at, fresh=fresh):
            token = self.tokens[at]
            token.kind, token.stem, token.form = K.V, token.text, "base"
            return self._deed(at)
        if self._verb is None and (there or self._named()):
            return self._statement(at)
        if self._verb is not None and (start := self._run_on()):
            self.out.insert(start, mark(K.SEP, self.out[start].span.start))
            self._verb, self._subject = None, start + 1
            return self._statement(at)
        self._asked = fresh and self.among(at, "asking")
        return self._negation(at) if self.kind(after) is K.NEG else at + 1

    def _gets(self, at: int, *, fresh: bool) -> bool:
        """Return whether "have" asks for something: "have an egg boiled", "wash them and have them dried"."""
        something = fresh and self.follows(at + 1, "DET|NUM|ADJ|N")
        return self.among(at, "getting") and (something or (self._last() in LINKS and self._done_to(at) > 0))

    def _begin_question(self, at: int, subject: int) -> None:
        """Begin a unit with an auxiliary behind a comma: "a tea, can you make it?", "Joe, you can wash it"."""
        asked = self.kind(subject) is K.SUBJECT or self.among(self.back(at), "addressee")
        if self._verb is None and self._last() is K.COMMA and asked and self._named():
            self.out[-1].kind = K.SEP
            self._begin()

    def _run_on(self) -> int:
        """Return where the subject of a statement begins that follows a noun phrase without a sign; 0 for none."""
        place = len(self.out)
        if self._last() is K.PRON:
            place -= 1
        else:
            while place and self.out[place - 1].kind in NP - {K.PRON}:
                place -= 1
                if self.out[place].kind in (K.DET, K.NUM):
                    break
        return place if 0 < place < len(self.out) and self.out[place - 1].kind in HEADS else 0

    # what asks for nothing

    def _is_question(self, at: int) -> bool:
        """Return whether a question begins that asks for nothing: "Is the lamp on?"."""
        begins = not at or self.kind(at - 1) in IDLE | {K.STOP, K.SEP, K.CC}
        begins = begins or (self.kind(at - 1) is K.COMMA and self._verb is None and not self._named())
        starts = begins and self._last() in BREAKS
        opens = self.among(at, "questions") and self.kind(at) is not K.V and self.kind(at + 1) is not K.ING
        opens = opens and not (self.among(at, "getting") and self._done_to(at))
        wonders = self.among(at, "whats") and self.follows(at + 1, "NP* AUX (SUBJECT|PRON|DET BREAK)")
        return starts and (opens or wonders) and self.asked(at)

    def _question(self, at: int) -> int:
        """Set a question aside; one that "if so" or "if not" follows is a condition of what is asked then."""
        end = self.first(at, "STOP | COMMA IDLE* V")  # "is there no hurry, could you set the table?"
        so = end + 1 + (self.kind(end + 1) is K.SUB and self.among(end + 2, "affirming"))
        denied = self.among(end + 1, "denying")
        opener = mark(K.SUB, self.tokens[at].span.start)
        if self.follows(end, "STOP (PRON|SUBJECT) (AUX|NEG|TO|INF)+ BREAK"):  # "is the window shut? It should be."
            opener.note = QUESTION
            return self._bracket(opener, K.SAY, at + 1, end)
        if not (denied or so > end + 1 or self.among(end + 1, "then_words")):
            self._mention(self.tokens[at + 1 : end], QUESTION)
            return self._skip(at, end, QUESTION)
        if denied:  # the condition itself says "if not"
            for token in self.tokens[end : self.first(end + 1, "STOP")]:
                token.otherwise = False
        opener.text = first_of("excepting" if denied else "guards")
        self.out.append(opener)
        for asked in range(at + 2, end):
            if self.kind(asked) is K.PARTICIPLE and self.kind(self.back(asked)) in HEADS:
                self.tokens[asked].kind = K.STATE  # "is the door locked?"
        twice = any(self.kind(i) is K.AUX for i in range(at + 1, end))  # "has it been locked?"
        self._fill(opener, at + twice, end)
        return so + 1

    def _is_inverted(self, at: int) -> bool:
        """Return whether a condition begins that has its verb first: "should the door be open, shut it"."""
        first = self.kind(at) is K.AUX and self.among(at, "inverting") and self._last() in BREAKS
        apart = first and self.kind(self.first(at, "STOP|COMMA")) is K.COMMA
        return apart and not self.asked(at) and self.kind(at + 1) in NP

    # words of the main clause

    def _stop(self, at: int) -> int:
        token = self.tokens[at]
        deed = self.peek(at)
        topic = token.text == ":" and self._verb is None and self._named() and self.kind(deed) is K.V
        if topic and self.follows(deed + 1, "IDLE* BREAK"):  # "window: please close"
            self.out.insert(self._subject, self.tokens[deed])
            self._verb = self.out[self._subject]
            return deed + 1
        if topic and not self.follows(deed + 1, "IDLE* (DET|NUM|ADJ|N)"):  # not "tea for Ann: boil the water"
            return at + 1  # "the radio: put it in the crate"
        ended = token.kind is K.STOP
        token.kind, token.form = K.SEP, ALSO if self._too(at + 1 + (self.kind(at + 1) is K.CC)) else ""
        self.out.append(token)
        self._begin()
        if ended:
            self._units = [(len(self.out), False)]
        return at + 1

    def _deed(self, at: int) -> int:
        token = self.tokens[at]
        if token.stem in section("forgetting") and self.kind(at + 1) in NP:
            return self._skip(at, self._clause_end(at), CORRECTED)  # "no, forget the tea"
        wishes = token.stem in section("wishing")
        self._told = self._told and not (wishes and (token.stem not in section("liking") or self._is_modal(at)))
        if self._is_topic(at):
            return self._statement(at) if self._asked else at + 1
        if (wishes and self._wishes_state(at)) or self._has_done(at):
            return self._bracket(token, K.ENSURE, at + 1, self._statement_end(at + 1))
        if token.stem in section("causing") and self._causes(at):
            return self._cause(at)
        token.told = token.told or self._is_told(at)
        self._go_there(at)
        self.out.append(token)
        self._verb = token
        if self.kind(at + 1) is K.ADV:
            token.form = ALONE
        return at + 1

    def _is_to_be_done(self, at: int) -> bool:
        """Return whether a participle in a place says what shall be done to what was named, where no verb does."""
        deed = self.lexicon.is_deed(self.tokens[at].stem) and self.kind(at + 1) is K.P
        alone = self.kind(self.first(at + 1, "V|LET|FINITE|AUX|STOP|COMMA|REL")) in (K.STOP, K.COMMA, K.REL)
        return deed and alone and self._verb is None and self._named() and self.out[-1].kind in HEADS

    def _cause(self, at: int) -> int:
        """Emit "make it play" as "let it play"; drop "make" of "make close the door"."""
        self.tokens[at].kind = K.LET
        return self._let(at) if self.kind(at + 1) is not K.V else at + 1

    def _is_topic(self, at: int) -> bool:
        """Return whether a verb is about what was named: "could Ann wait outside?", "the curtain I want open".

        The state that is wished for is marked as one.
        """
        named = self._verb is None and self._named()
        if named and self._asked:
            return True
        topic = named and self._wished_ahead(at)
        self.tokens[at + topic].kind = K.STATE if topic and self.kind(at + 1) is not K.P else self.kind(at + topic)
        return topic

    def _go_there(self, at: int) -> None:
        """Begin a unit behind what goes somewhere without a verb: "the mug to the sink, wash it"."""
        named = self.out[self._subject :]
        if self._last() is not K.COMMA or self._verb is not None or not self.follows(at + 1, "IDLE* NP"):
            return
        goes = any(t.kind is K.P and t.text in section("arrivals") - section("static") for t in named[1:])
        if goes and named[0].kind is not K.P and not any(t.kind is K.COMMA for t in named[:-1]):
            named[-1].kind = K.SEP
            self._begin()

    def _has_done(self, at: int) -> bool:
        """Return whether a verb of getting asks for what shall be done to a thing: "have the egg boiled"."""
        done = self._done_to(at)
        if not (done and self.stem_among(at, "getting") and self.tokens[at].form == "base"):
            return False
        for place in range(done, self.first(at, "STOP")):
            put = self.among(place, "same_past") and self.kind(place - 1) is K.N
            if put or place == done:  # "have the cup washed and the plate put on the table"
                self.tokens[place].kind = K.PARTICIPLE
        return True

    def _done_to(self, at: int) -> int:
        """Return where a participle says what shall be done to the things behind a verb; 0 for nowhere."""
        done = self.past(at + 1, "PRON | (DET|NUM|N|OF|ADJ)+")
        done -= self.kind(done) is not K.PARTICIPLE and self.kind(done - 1) is K.ADJ
        token = self.tokens[done] if done < len(self.tokens) else self.tokens[at]
        after_noun = done > at + 1 and self.kind(done - 1) in HEADS and token.kind in (K.PARTICIPLE, K.ADJ)
        return done if after_noun and token.form == "ed" and self.lexicon.is_deed(token.stem) else 0

    def _is_told(self, at: int) -> bool:
        """Return whether the subject of a verb is not the addressee: "they are starving", "my eyes get tired"."""
        token = self.tokens[at]
        past = token.first is not None and token.first[1] == "ed"  # "I tripped over it, nearly fell"
        wish = token.stem in section("wishing") | section("ordering") and token.form != "ing"
        named = self._last() in HEADS and self.out[self._subject].kind is K.DET
        # but not "the boxes from the shelf put them in the bin"
        subject = named and not (self.lexicon.names_thing(self.out[-1].text) or self.follows(at + 1, "IDLE* PRON"))
        # "we eat there, put it in the cupboard" asks for the second
        told = self._told and not wish and self.kind(self.back(at)) is not K.COMMA
        becomes = token.stem in section("becoming") and self.kind(at + 1) is K.ADJ and not self._leads(at + 1)
        return told or past or subject or becomes or token.stem in section("talking")

    def _comma(self, at: int) -> int:
        if self.follows(at, "COMMA IDLE+ COMMA (AUX|FINITE)"):
            return self.peek(at) + 1  # "the door, however, should be shut"
        if self._is_repeated(at):
            return at + 2  # "the cup on the table, that goes on the shelf"
        inner = range(at + 1, min(self.first(at + 1, "V|STOP"), at + 2 * _NEAR) if self.tokens[at].text == "(" else at)
        end = next((i for i in inner if self.tokens[i].text == ")"), None)
        if end is not None and any(self.tokens[i].arrow for i in range(at, end)):
            return self._stop(at)  # "clear the chair (rope -> shed)"
        return self._joint(at) if end is None else self._skip(at, end + 1, ASIDE)

    def _is_repeated(self, at: int) -> bool:
        """Return whether a pronoun repeats the subject before a comma."""
        subject = self._verb is None and self._named() and self.among(at + 1, "relatives")
        return subject and self.kind(at + 2) is K.FINITE

    def _joint(self, at: int) -> int:
        """Begin a unit where a statement follows: "pour the water out, the pot goes on the shelf"."""
        if also := self._also(at):
            return also
        self._deny_ahead(at)
        if self._last() is K.END and self._is_reason(at + 1) and not self.follows(at + 2, "IDLE* V"):
            return self._stop(at)  # "they are here, so the toys in the chest"
        if self.among(at, "dashes") and self._verb is None and self._named():
            return self._stop(at)  # "the radio - off"
        if self._is_returned(at + 1):
            return self._stop(at)
        listed = any(t.kind is K.COMMA for t in self.out[self._subject :])
        apart = self.follows(at, "COMMA CC") and self._named() and not listed
        return self._stop(at) if (self._verb is not None or apart) and self._statement_follows(at) else self._keep(at)

    def _also(self, at: int) -> int:
        """Mark "and the mug too"; return where reading goes on, or 0."""
        begin = at + 1 + (self.kind(at + 1) is K.CC)
        if not self._too(begin):
            return 0
        self.tokens[at].form = ALSO
        self.out.append(self.tokens[at])
        return begin

    def _noun(self, at: int) -> int:
        """Keep a noun, but for a name that is called: "Dave, take"."""
        known = self.lexicon.names_thing(self.tokens[at].text)
        called = self._last() is K.SEP and self.kind(at - 1) not in NP and not known
        if called and self.follows(at + 1, "COMMA IDLE* (V|SUBJECT|AUX|NEG|ENSURE|LET)"):
            self.tokens[at].note = ADDRESS
            return at + 2
        return self._keep(at)

    def _pronoun(self, at: int) -> int:
        """Keep a pronoun; "him" is a thing where nothing is done for somebody: "wake the dog and brush him"."""
        deed = self._last() is K.V and self.out[-1].stem.partition("_")[0] not in section("for_persons")
        if deed and self.among(at, "animate") and self.follows(at + 1, "IDLE* (BREAK|P)"):
            self.tokens[at].text = first_of("singular_pronouns")
        return self._keep(at)

    def _adjective(self, at: int) -> int:
        token, last = self.tokens[at], self._last()
        if not self._leads(at):
            if self.among(at, "adverbs") and not self.among(at, "end_states"):
                return at + 1  # "the lamp only"
            if not (self._open or last in HEADS | {K.STATE, K.CC, K.V, K.P}):
                return at + 1
            done = self._open and token.form == "ed" and last in (K.AUX, K.CC) and not self.among(at, "end_states")
            needed = last is K.AUX and token.form == "ing" and self.out[-1].text in section("needing")
            token.kind = K.PARTICIPLE if done else K.ING if needed else K.STATE
        return self._keep(at)

    def _leads(self, at: int) -> bool:
        """Return whether a noun that an adjective belongs to follows."""
        joint = "" if self._last() is K.AUX else "| LINKS (?=ADJ)"
        return self.follows(at + 1, f"(ADJ|IDLE|PARTICIPLE (?=N) {joint})* (N|NUM|ONE)")

    def _adverb(self, at: int) -> int:
        if self._is_reason(at) and self.kind(at - 1) in LINKS and not self._open:
            self._reasoned()
        if self.among(at, "back_words") and not self._open and self._verb is None and self._is_first_back(at):
            verb = self.tokens[at]  # "the mug back where it was"
            verb.kind, verb.stem, verb.form = K.V, first_of("returning"), "base"
            return self._deed(at)
        if self.among(at, "whither_adverbs") and self._moves_at(at):
            self.out.append(Token(K.P, TO, self.tokens[at].span))  # "take it upstairs"
            self.tokens[at].kind = K.N
            return self._keep(at)
        if self._is_whereabouts(at):
            self.out.append(Token(K.P, first_of("whereabouts"), self.tokens[at].span))
            self.tokens[at].kind, self.tokens[at].text = K.PRON, first_of("there_pronouns")
            return self._keep(at)
        if not (self.among(at, "end_states") and self._is_state(at)):
            return at + 1
        self.tokens[at].kind = K.STATE
        return self._keep(at)

    def _is_whereabouts(self, at: int) -> bool:
        """Return whether "there" is a place of its own: "unless it is there already", "put it there"."""
        if not (self.among(at, "there_words") and self.follows(at + 1, "IDLE* (BREAK|SUB)")):
            return False
        conditional = bool(self._open) and self._open[-1].kind is K.SUB
        said = conditional and self._last() is K.AUX and self.out[-1].text in section("be")
        about = len(self.out) > 1 and self.out[-2].kind is K.PRON
        placing = section("placing") - section("returning")  # "put it back there" is where it was
        puts = not self._open and self._verb is not None and self._verb.stem in placing
        return (said and about) or (puts and self._last() in HEADS)

    def _moves_at(self, at: int) -> bool:
        """Return whether the open verb moves something, whose place is said by a word that ends the clause."""
        moves = self._verb is not None and self._verb.stem.partition("_")[0] in section("moving")
        return moves and not self._open and self._last() in HEADS and self.follows(at + 1, "BREAK|P")

    def _is_first_back(self, at: int) -> bool:
        """Return whether "back" says where something named before goes, or with its place, what was mentioned."""
        return self._last() in HEADS or (self._last() is K.SEP and self.follows(at + 1, "P|TO|REL"))

    def _is_returned(self, at: int) -> bool:
        """Return whether something named goes "back" from a place on: "then the mug back", "then back on the table"."""
        end = begin = self.past(at, "CC*")
        while self.kind(end) in NP:
            end += 1
        if not self.among(end, "back_words"):
            return False
        if end == begin:
            return self.follows(end + 1, "P|TO|REL")
        return self._verb is None and self._named() and self.kind(end - 1) in HEADS

    def _deny_ahead(self, at: int) -> None:
        """Put "not" before what is denied: "take the red cup, the blue one not"."""
        if self._verb is not None and self.follows(at + 1, "IDLE* NP+ (P NP+)* NEG BREAK"):
            end = self.first(at + 1, "NEG")
            self.tokens[at + 1 : end + 1] = [self.tokens[end], *self.tokens[at + 1 : end]]

    def _reasoned(self) -> None:
        """Set aside what the rest of a sentence is for: "I hate draughts, it is cold, so shut the window"."""
        told = self._told or (self._verb is not None and (self._verb.told or self._verb.stem in section("wishing")))
        if told and any(t.kind not in LINKS for t in self.out[self._subject :]):
            self._take_back(self._subject, REASON)
        if self._verb is not None:
            return
        for (start, _), (end, told) in reversed(list(pairwise(self._units))):
            unit = self.out[start : end - 1]
            stated = any(t.kind is K.SAY for t in unit)
            if not (told or stated):
                break
            if not stated:
                self.dropped += noted(unit, REASON)
                del self.out[start : end - 1]
                self._subject -= len(unit)

    def _is_state(self, at: int) -> bool:
        """Return whether a particle or adverb names the state that something is in or should be in."""
        ends = self.follows(at + 1, "IDLE* (BREAK|SUB|V|EXC|MOD|PURP|REL)")
        if self._open:
            ends = ends or (self._last() is K.AUX and self.follows(at + 1, "P"))  # "the lamp is on in the hall"
            # what must not stay up shall be otherwise; what must stay up is left so
            stays = self._last() is K.V and self.out[-1].stem in section("staying") and self._open[-1].negated
            return ends and (stays or self._last() in HEADS | {K.AUX, K.STATE, K.CC, K.FINITE})
        placed = self._verb is not None and self._verb.stem in section("placing")
        ends = ends or self._is_verbless_state(at)
        hosts = self._hosts_result() or (self.among(at, "switch_states") and not placed)
        return ends and hosts and self._last() in HEADS | {K.STATE, K.CC}

    def _is_verbless_state(self, at: int) -> bool:
        """Return whether a place follows a state without a verb: "lamp off in the hall"."""
        return self._verb is None and self.among(at, "switch_states") and self.follows(at + 1, "P NP")

    def _participle(self, at: int) -> int:
        if self._is_to_be_done(at):  # "eggs boiled in the pot"
            self.out.insert(self._subject, self.tokens[at])
            self.tokens[at].kind, self._verb = K.V, self.tokens[at]
            return at + 1
        if not (self._last() in HEADS and self._hosts_result() and self.follows(at + 1, "IDLE* (BREAK|SUB|MOD)")):
            return at + 1
        self.tokens[at].kind = K.STATE
        return self._keep(at)

    def _ing(self, at: int) -> int:
        token = self.tokens[at]
        if self._last() in HEADS:
            if self.kind(at + 1) is K.P:
                self.tokens[at + 1].form = RELATIVE  # "the letter lying on the chair"
            return self._participle(at)
        token.kind = K.V
        lead = self.out.pop() if self.out and self.out[-1] is self._verb else None
        if lead is not None and lead.stem in section("stopping"):
            self._verb = None
            return self._bracket(lead, K.NEG, at, self._clause_end(at))
        return self._deed(at)

    def _let(self, at: int) -> int:
        """Emit "let X do" as LET, the noun phrase and the verb; any other "let" is a verb."""
        token, end = self.tokens[at], self.past(at + 1, "(NP|IDLE|OF)*")
        verb = end + (self.kind(end) is K.TO)
        if self.among(end - 1, "persons") and self.among(end, "getting"):
            return end  # "let me have a tea"
        if self.kind(verb) is not K.V or self.tokens[verb].form != "base" or self.among(at, "leaving"):
            token.kind, token.form, token.strength = K.V, "base", 3
            return self._deed(at)
        if self.among(end - 1, "persons"):
            return verb
        self.out += [token, *(t for t in self.tokens[at + 1 : end] if t.kind not in IDLE)]
        self._deed(verb)
        self.tokens[verb].form = ALONE
        return verb + 1

    def _preposition(self, at: int) -> int:
        token = self.tokens[at]
        if self.among(at + 1, "reciprocals"):
            return at + 1
        self._name_target(at)
        if self.among(at, "with_words") and (end := self._absolute_end(at)):
            return self._bracket(token, K.SUB, at + 1, end)
        if self.among(at, "replacing"):
            return self._replaced(at)
        if self._benefits(at):
            return at + 2
        if self.kind(at + 1) is K.ING and self.among(at, "without_words", "by_words"):
            return self._manner(at)
        if self.kind(at + 1) is K.ING and self._verb is not None and self._verb.stem in section("stopping"):
            return at + 1  # "refrain from opening it"
        if self._is_state_word(at):
            token.kind = K.STATE
        elif self.among(at, "of_words") and self._last() in HEADS:
            token.kind = K.OF
        return self._keep(at)

    def _is_state_word(self, at: int) -> bool:
        """Return whether a preposition is a state: "the lamp on"."""
        state = self.among(at, "end_states") and self.kind(at + 1) not in NP | {K.ING, K.V, K.OF}
        return state and self._is_state(at)

    def _benefits(self, at: int) -> bool:
        """Return whether something is done for somebody: "lay it on the bench for him"."""
        somebody = self.among(at, "awaited") and self.among(at + 1, "animate") and self.follows(at + 2, "BREAK")
        return somebody and self._verb is not None and self._verb.stem not in section("waiting")

    def _name_target(self, at: int) -> None:
        """Give a preposition a noun phrase: "in there", "with neither milk nor sugar", "without using the axe"."""
        if at + 1 >= len(self.tokens):
            return
        after = self.tokens[at + 1]
        top = self.among(at + 1, "top_words") and self.follows(at + 2, "IDLE* BREAK")
        there = self.among(at + 1, "there_words") and self.kind(at + 2) is not K.AUX and self._last() is not K.V
        if top or there:  # "put it in there"
            after.kind, after.text = K.PRON, first_of("there_pronouns" if there else "singular_pronouns")
        elif after.kind is K.NEG:
            after.kind, after.text = K.DET, first_of("none_words")
            for word in self.tokens[at + 2 : at + 6]:
                word.kind = K.N if word.kind is K.V and self.lexicon.is_noun(word.text) else word.kind
        elif after.text in pairs("using_verbs") and self.among(at, "without_words"):
            after.kind = K.ING

    def _manner(self, at: int) -> int:
        """Bracket "without spilling it"; "by pressing it" is a clause, which may be what was started or tried."""
        self.tokens[at + 1].kind = K.V
        if self.among(at, "without_words"):
            return self._bracket(self.tokens[at], K.WITHOUT, at + 1, self._clause_end(at + 1))
        if self._verb is not None and self.out[-1] is self._verb and self._verb.stem in section("lead_verbs"):
            self.out.pop()
        return at + 1

    def _replaced(self, at: int) -> int:
        """Bracket what is not to be done, or not to be taken: "instead of putting it here", "instead of the lid"."""
        end = self._negation_end(at + 1)
        if self.kind(at + 1) is K.ING:
            self.tokens[at + 1].kind, end = K.V, self._clause_end(at + 1)
        return self._bracket(self.tokens[at], K.NEG, at + 1, end)

    def _absolute_end(self, at: int) -> int:
        """Return where "with the door shut" ends, which adds a demanded state; 0 for other phrases."""
        place = at + 1
        while self.kind(place) in NP and (self.kind(place) is not K.ADJ or self._leads(place)):
            place += 1
        state = self.among(place, "end_states") or self.kind(place) is K.ADJ
        ends = [place + 1] if state else []
        if self.kind(at - 1) is K.COMMA and self.among(place, "static"):  # ", with the lid next to the pot"
            ends.append(self.past(place, "P NP* N"))
        ends = ends if self.kind(place - 1) in HEADS else []
        return next((end for end in ends if self.follows(end, "IDLE* BREAK")), 0)

    # words inside of brackets

    def _inner_to(self, at: int) -> int:
        token, opener = self.tokens[at], self._open[-1]
        if token.form != "inf":
            token.kind = K.P
            return self._keep(at)
        if opener.kind is K.NEG and self._last() in HEADS:
            return self._bracket(token, K.PURP, at + 1, self._clause_end(at + 1))
        if self.among(at + 1, "infinitive_be"):
            self.tokens[at + 1].kind = K.AUX
        state = self.kind(at + 1) is K.AUX or self.stem_among(at + 1, "staying")
        if self._last() is K.AUX and state and self.out[-1].text in section("be"):
            opener.form = DUTY  # "no lamp is to be on"
        return at + 1

    def _inner_negation(self, at: int) -> int:
        """Note a negation in the opener: "not", "isn't", and "no" in a condition; keep all but the first."""
        kind, opener = self.kind(at), self._open[-1]
        none = kind is K.DET and opener.kind is K.SUB and self.among(at, "none_words")
        if kind is K.NEG and self._last() is K.CC:  # "on and not broken"
            self.tokens[at].kind, self.tokens[at].text = K.AUX, first_of("be")
        if kind is K.NEG or none or (kind is K.AUX and self.among(at, "not_forms")):
            opener.negated = True
            verb = self.tokens[at] if kind is not K.NEG or self._last() is not K.AUX else self.out[-1]
            verb.negated = True
        return at + 1 if self.kind(at) is K.NEG else self._keep(at)

    def _inner_joint(self, at: int) -> int:
        return self._also(at) or self._keep(at)

    def _inner_other(self, at: int) -> int:
        """Keep the subject as a pronoun, and "let" as a verb."""
        token = self.tokens[at]
        token.kind = K.PRON if token.kind is K.SUBJECT else K.V
        token.text = token.text.partition("'")[0]  # "once you've done that"
        return self._keep(at)

    def _inner_noun(self, at: int) -> int:
        """Keep a noun, but for what is a state behind a form of *be*: "it is shut", "should be put", "is golden"."""
        token, last = self.tokens[at], self._last()
        state = self.among(at, "end_states")
        if last is K.AUX and self.among(at, "same_past") and not state:
            token.kind, token.stem = K.PARTICIPLE, token.text
        elif self.follows(at + 1, "IDLE* (BREAK|SUB|MOD|P|V)"):
            hosted = state and last in (K.AUX, K.V, K.FINITE, K.STATE, K.CC)
            becomes = last is K.V and self.out[-1].stem in section("becoming")  # "should go green"
            if hosted or becomes or (last is K.AUX and not self._is_thing(at)):
                token.kind = K.STATE
        return self._keep(at)

    def _is_thing(self, at: int) -> bool:
        """Return whether a noun behind an auxiliary is a thing: "there is milk", "needs bed 4"; not "is green"."""
        there = any(self.among(i - 1, "there_words") and self.past(i, "(AUX|NEG)*") == at for i in range(at - 3, at))
        named = self.lexicon.is_noun(self.tokens[at].text) or self.tokens[at].text[-1:].isdigit()
        return there or (
            named and not (self.out[-1].text in section("be") and self.follows(at + 1, "IDLE* (BREAK|SUB)"))
        )

    def _inner_verb(self, at: int) -> int:
        """Keep a verb, but for what is a state behind a denied form of *be*: "it is not open"."""
        if self._last() is K.AUX and self.out[-1].text in section("be") and self.kind(at - 1) is K.NEG:
            self.tokens[at].kind = K.STATE
        return self._keep(at)
