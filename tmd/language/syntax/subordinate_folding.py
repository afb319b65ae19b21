"""Fold what is not a clause of its own: conditions, purposes, relative clauses, statements, prohibitions.

A fold is one token (:attr:`Kind.MOD` or :attr:`Kind.SKIP`) that keeps its place in the text. What only
introduces a verb ("you should", "try to", "remember to") becomes filler.
"""

from __future__ import annotations

from tmd.language.clause import PERSONS
from tmd.language.lexicon.coverage import REMINDER
from tmd.language.lexicon.word_lists import section
from tmd.language.rewriting.causatives import NEGATED, rewrite_ensure, rewrite_let, rewrite_should, states_also
from tmd.language.tagging.first_tags import fold
from tmd.language.tagging.tokens import Kind, Token

STATEMENT = "a statement, not an instruction"
RELATIVE = "relative"
"""The form of a preposition that opens what was a relative clause: "the remote that is on the sofa"."""
ASIDE = "an aside in brackets"
ADDRESS = "addresses somebody"

_NOMINAL = frozenset({Kind.DET, Kind.NUM, Kind.ADJ, Kind.N, Kind.PRON, Kind.P, Kind.ADV, Kind.MOD})
_WHITHER = frozenset({"to", "into", "onto", "off", "out_of"})
_AFTER_SUBJECT = frozenset({Kind.AUX, Kind.ADV, Kind.SUBJECT})


class _Folder:
    """One pass over the decided tokens of a text; ``out`` is what stays."""

    def __init__(self, tokens: list[Token]) -> None:
        self.tokens = tokens
        self.out: list[Token] = []
        self.verb: Token | None = None
        """The verb of the clause that is open."""
        self.start = True
        """Nothing but fillers since the last separator."""

    def run(self) -> list[Token]:
        at = 0
        while at < len(self.tokens):
            at = self._step(at)
        return self.out

    def _peek(self, at: int, skip: frozenset[Kind] = frozenset({Kind.ADV})) -> int:
        """Return the index of the next token that is not skipped (the length at the end)."""
        at += 1
        while at < len(self.tokens) and self.tokens[at].kind in skip:
            at += 1
        return at

    def _kind(self, at: int) -> Kind:
        return self.tokens[at].kind if at < len(self.tokens) else Kind.STOP

    def _emit(self, token: Token) -> None:
        self.out.append(token)
        if token.kind in (Kind.STOP, Kind.SEP):
            self.verb, self.start = None, True
        elif token.kind is Kind.V:
            self.verb, self.start = token, False
        elif token.kind not in (Kind.ADV, Kind.FILLER, Kind.COMMA, Kind.CC, Kind.MOD, Kind.SKIP):
            self.start = False

    def _filler(self, *tokens: Token) -> None:
        for token in tokens:
            token.kind = Kind.FILLER
            self._emit(token)

    def _fold(self, at: int, end: int, kind: Kind, form: str) -> int:
        token = fold(self.tokens[at:end], kind, " ", form)
        if kind is Kind.SKIP:
            token.note = form
        self._emit(token)
        return end

    def _step(self, at: int) -> int:
        token = self.tokens[at]
        if token.kind in (Kind.CC, Kind.COMMA):
            self.start = self.start or self._kind(self._peek(at)) not in _NOMINAL
        if self.start or token.kind in (Kind.CC, Kind.COMMA, Kind.STOP):
            begin = at if token.kind not in (Kind.CC, Kind.COMMA, Kind.STOP) else at + 1
            asked = rewrite_should(self.tokens, begin) if begin < len(self.tokens) else None
            if asked:
                if begin > at:
                    self._emit(token)
                if any(t.kind is Kind.REL for t in asked[0]):
                    self.tokens[begin : asked[1]] = asked[0]  # the relative clause is still to be folded
                    self.start = False
                    return begin
                return self._rewritten(asked)
            end = self._statement(begin)
            if end is not None:
                if token.kind in (Kind.CC, Kind.COMMA, Kind.STOP):
                    self._emit(token)
                    at += 1
                return self._fold(at, end, Kind.SKIP, STATEMENT)
        if self.start and token.kind is Kind.N and self._kind(at + 1) is Kind.COMMA and self._calls(at + 1):
            return self._fold(at, at + 1, Kind.SKIP, ADDRESS)
        if token.text == "(":
            aside = self._aside(at)
            if aside is not None:
                return self._fold(at, aside, Kind.SKIP, ASIDE)
        if token.text == "no" and at + 1 < len(self.tokens) and self.tokens[at + 1].text == "need":
            return self._negation(at)
        handler = {
            Kind.SUB: self._condition,
            Kind.PURP: self._purpose,
            Kind.TO: self._infinitive,
            Kind.REL: self._relative,
            Kind.NEG: self._negation,
            Kind.ING: self._ing,
            Kind.SUBJECT: self._subject,
            Kind.LET: self._let,
            Kind.ENSURE: self._ensure,
            Kind.AUX: self._auxiliary,
        }.get(token.kind)
        if handler:
            return handler(at)
        if token.kind is Kind.P and token.text == "without" and self._kind(at + 1) is Kind.ING:
            return self._fold(at, self.boundary(at + 1), Kind.MOD, "manner")
        if token.kind is Kind.P and token.text == "by" and self._kind(at + 1) is Kind.ING:
            self._filler(token)
            return at + 1
        if token.kind is Kind.PARTICIPLE and token.stem in ("call", "name", "label", "mark", "title"):
            end = at + 1
            while self._kind(end) in (Kind.N, Kind.ADJ, Kind.NUM):
                end += 1
            return self._fold(at, end, Kind.MOD, "relative")
        if token.kind in (Kind.PARTICIPLE, Kind.FINITE):
            self._filler(token)
            return at + 1
        self._emit(token)
        return at + 1

    def _aside(self, at: int) -> int | None:
        """Return where a bracket without a verb ends."""
        for end, token in enumerate(self.tokens[at + 1 : at + 30], at + 1):
            if token.text == ")":
                return end + 1
            if token.kind in (Kind.V, Kind.STOP):
                return None
        return None

    def _calls(self, at: int) -> bool:
        """Tell whether an instruction follows the comma after a single name: "Dave, take"."""
        follows = self._kind(self._peek(at))
        return follows in (Kind.V, Kind.SUBJECT, Kind.AUX, Kind.NEG, Kind.ENSURE, Kind.LET) and (
            not self.out or self.out[-1].kind is Kind.STOP or all(t.kind is Kind.ADV for t in self.out[-3:])
        )

    def boundary(self, at: int) -> int:
        """Return where the subordinate clause that opens at ``at`` ends."""
        finite = False
        end = at + 1
        while end < len(self.tokens):
            token, before = self.tokens[end], self.tokens[end - 1]
            verbal = token.kind is Kind.V and before.kind not in (Kind.AUX, Kind.TO, Kind.NEG)
            opens = token.kind in (Kind.STOP, Kind.COMMA, Kind.ENSURE, Kind.LET) or token.text == "then"
            if opens or (verbal and (before.kind is not Kind.SUBJECT or finite)):
                break
            if token.kind in (Kind.SUB, Kind.PURP) and finite:
                break
            if token.text == "by" and self._kind(end + 1) is Kind.ING:
                break
            follows = self._kind(self._peek(end))
            if token.kind is Kind.CC and follows in (Kind.V, Kind.SUBJECT, Kind.NEG, Kind.ENSURE, Kind.ADV, Kind.LET):
                break
            if token.kind in (Kind.SUBJECT, Kind.PRON) and token.text == "you" and finite and follows is Kind.AUX:
                break
            if token.kind in (Kind.FINITE, Kind.AUX, Kind.ING, Kind.PARTICIPLE, Kind.ADJ):
                finite = True
            end += 1
        return end

    def _statement(self, at: int) -> int | None:
        """Return where a statement that begins at ``at`` ends, or ``None`` if none begins there."""
        scan, nominal = at, False
        while scan < len(self.tokens):
            token = self.tokens[scan]
            if token.kind is Kind.SUBJECT:
                verb = self._peek(scan, _AFTER_SUBJECT)
                noticing = verb < len(self.tokens) and self.tokens[verb].stem in section("noticing")
                lead = self._peek(verb)
                if self._kind(lead) in (Kind.PRON, Kind.SUBJECT):
                    lead = self._peek(lead)
                leads = self._kind(lead) is Kind.TO
                have = self._kind(scan + 1) is Kind.AUX and self._kind(self._peek(scan + 1)) in _NOMINAL | {Kind.ING}
                told = token.text in ("i", "we") and verb < len(self.tokens) and self.tokens[verb].form == "ed"
                if nominal or not (noticing or have or told) or leads:
                    return None
                break
            there = token.text == "there" and self._kind(scan + 1) is Kind.AUX
            contracted = token.kind is Kind.AUX and "'s" in token.text
            if (token.kind in (Kind.AUX, Kind.FINITE) and (nominal or contracted)) or there:
                follows = self._kind(self._peek(scan))
                robot = scan > at and self.tokens[scan - 1].text == "robot" and follows is Kind.V
                if token.kind is Kind.AUX and (follows is Kind.TO or robot):
                    return None
                break
            joins = token.kind in (Kind.CC, Kind.COMMA) and self._kind(self._peek(scan)) in _NOMINAL
            if token.kind not in _NOMINAL and not (joins and nominal):
                return None
            nominal = nominal or token.kind in (Kind.N, Kind.PRON)
            scan += 1
        else:
            return None
        return self._statement_end(scan)

    def _statement_end(self, at: int) -> int:
        end = self._peek(at, _AFTER_SUBJECT)
        if self._kind(end) is Kind.V:
            end += 1
        while end < len(self.tokens) and self.tokens[end].kind is not Kind.STOP:
            token, follows = self.tokens[end], self._kind(self._peek(end))
            verb = token.kind is Kind.V and self.tokens[end - 1].kind not in (Kind.TO, Kind.AUX, Kind.NEG)
            if verb or (token.kind in (Kind.CC, Kind.COMMA) and follows in (Kind.V, Kind.SUBJECT, Kind.SUB)):
                break
            end += 1
        return end

    def _condition(self, at: int) -> int:
        token = self.tokens[at]
        if token.text == "after" and self._kind(at + 1) is Kind.ING:
            self._filler(token)
            return at + 1
        return self._fold(at, self.boundary(at), Kind.MOD, "condition")

    def _purpose(self, at: int) -> int:
        return self._fold(at, self._purpose_end(at), Kind.MOD, "purpose")

    def _purpose_end(self, at: int) -> int:
        """A purpose clause may open with its own verb ("in order to clean it")."""
        first = self._peek(at)
        return self.boundary(first if self._kind(first) is Kind.V else at)

    def _infinitive(self, at: int) -> int:
        token = self.tokens[at]
        if token.form != "inf":
            token.kind = Kind.P
            self._emit(token)
            return at + 1
        awaited = self._awaited()
        if awaited is not None:
            end = self.boundary(at + 1)
            event = fold([*self.out[awaited:], *self.tokens[at:end]], Kind.MOD, " ", "condition")
            del self.out[awaited:]
            self._emit(event)
            return end
        lead = self._lead_before()
        if lead is not None or (self.out and self.out[-1].kind is Kind.CC):
            self._filler(token)
            return at + 1
        if self.verb is not None and self.verb.stem in section("chain_verbs"):
            token.kind = Kind.SEP
            self._emit(token)
            return at + 1
        before = self.out[-1] if self.out else None
        if self.verb is None and before is not None and before.kind in (Kind.FILLER, Kind.ADJ, Kind.N):
            self._filler(token)
            return at + 1
        return self._fold(at, self._purpose_end(at), Kind.MOD, "purpose")

    def _awaited(self) -> int | None:
        """Return where "for the kettle" of "wait for the kettle to boil" begins in ``out``."""
        if self.verb is None or self.verb.stem != "wait":
            return None
        for back in range(len(self.out) - 1, max(-1, len(self.out) - 10), -1):
            if self.out[back] is self.verb:
                return None
            if self.out[back].text == "for":
                return back
        return None

    def _lead_before(self) -> Token | None:
        """Turn "want you", "remember", "need" right before an infinitive into filler."""
        back = len(self.out) - 1
        while back >= 0 and self.out[back].kind in (Kind.PRON, Kind.ADV, Kind.FILLER, Kind.ADJ):
            back -= 1
        verb = self.out[back] if back >= 0 else None
        if verb is None or verb.kind is not Kind.V or verb.stem not in section("lead_verbs") | {"like"}:
            ready = back < len(self.out) - 1 and self.verb is None and self.out[-1].kind is Kind.FILLER
            return self.out[-1] if ready else None
        for token in self.out[back:]:
            token.kind = Kind.FILLER
        self.verb, self.start = None, True
        return verb

    def _relative(self, at: int) -> int:
        copula = self._peek(at)
        if self._kind(copula) is Kind.AUX and self.tokens[copula].text in section("be"):
            denied = self.tokens[copula].text.endswith("n't") or self._kind(copula + 1) is Kind.NEG
            place = self._peek(copula, frozenset({Kind.ADV, Kind.PARTICIPLE, Kind.ING, Kind.NEG}))
            if denied and self._kind(place) is Kind.P and self.out:
                end = place + 1
                while self._kind(end) in (Kind.DET, Kind.ADJ, Kind.NUM, Kind.N):
                    end += 1
                return self._fold(at, end, Kind.MOD, "relative")
            described = bool(self.out) and self.out[-1] is not self.verb and self.out[-1].text not in PERSONS
            ends = self._kind(place + 1) in (Kind.STOP, Kind.COMMA, Kind.CC, Kind.AUX) or place + 1 == len(self.tokens)
            if self._kind(place) is Kind.P and ends and described:
                return self._fold(at, place + 1, Kind.MOD, "relative")  # "the lamps that are on"
            if self._kind(place) is Kind.P and described:
                self._filler(*self.tokens[at:place])
                self.tokens[place].form = RELATIVE
                return place
            adjective = self._peek(copula)
            after = adjective + 1
            if described and self._kind(adjective) is Kind.ADJ and self._kind(after) in (Kind.P, Kind.TO, Kind.CC):
                return self._fold(at, after, Kind.MOD, "relative")
        if self.out and self.out[-1].kind is Kind.P:
            self.out[-1].kind = Kind.FILLER
        return self._fold(at, self._relative_end(at), Kind.MOD, "relative")

    def _relative_end(self, at: int) -> int:
        """End a relative clause where the main clause says whither: "the chair that stands there to the desk"."""
        end = self.boundary(at)
        said = False
        verb = False
        for place in range(at + 1, end):
            token = self.tokens[place]
            inside = self.tokens[place - 1].kind is Kind.PRON and self.tokens[place - 2].kind is Kind.P
            if self.tokens[at].text == "where" and token.kind is Kind.AUX and self._kind(place + 1) is Kind.CC:
                return place + 1  # "where the cup was | and the kettle on the stove"
            if verb and inside and token.kind in (Kind.P, Kind.TO):
                return place  # "the cup that has water in it | in the sink"
            if verb and said and token.kind in (Kind.P, Kind.TO) and token.text in _WHITHER and token.form != "inf":
                return place
            said = said or (verb and (token.kind in (Kind.N, Kind.PRON, Kind.ADJ) or token.text in ("there", "here")))
            verb = verb or token.kind in (Kind.FINITE, Kind.AUX, Kind.PARTICIPLE)
        return end

    def _negation(self, at: int) -> int:
        if self.verb is not None and not self.start and self.tokens[at].text == "not":
            self._filler(self.tokens[at])
            return at + 1
        end = at + 1
        while self._kind(end) in (Kind.NEG, Kind.ADV, Kind.AUX):
            end += 1
        if end < len(self.tokens) and self.tokens[end].stem == "forget":
            if self._kind(end + 1) in (Kind.DET, Kind.N, Kind.PRON, Kind.ADJ):
                return self._fold(at, self.boundary(end), Kind.SKIP, REMINDER)
            self._filler(*self.tokens[at : end + 1])
            return end + 1
        while end < len(self.tokens) and self.tokens[end].kind is not Kind.STOP:
            token = self.tokens[end]
            follows = self._kind(self._peek(end))
            contrast = token.text in ("but", "then") or token.kind is Kind.COMMA
            if contrast and follows in (Kind.V, Kind.SUBJECT, Kind.SUB):
                break
            end += 1
        return self._fold(at, end, Kind.SKIP, NEGATED)

    def _ing(self, at: int) -> int:
        token, before = self.tokens[at], self.out[-1] if self.out else None
        if before is not None and before.kind in (Kind.N, Kind.PRON, Kind.AUX):
            self._filler(token)
            return at + 1
        lead = self.verb is not None and before is not None and before.text in ("by",)
        if lead and self.verb is not None and self.verb.stem in section("lead_verbs"):
            if len(self.out) > 1 and self.out[-2] is self.verb:
                self.verb.kind = Kind.FILLER
        elif before is self.verb and before is not None:
            before.kind = Kind.FILLER
        token.kind = Kind.V
        self._emit(token)
        return at + 1

    def _subject(self, at: int) -> int:
        after = self.tokens[at + 1] if at + 1 < len(self.tokens) else None
        past = after is not None and (after.form == "ed" or after.text in ("was", "were", "had", "am", "have"))
        if past and self.out and self.out[-1].kind is Kind.N:
            return self._fold(at, self.boundary(at + 1), Kind.MOD, "relative")
        self._filler(self.tokens[at])
        return at + 1

    def _auxiliary(self, at: int) -> int:
        if self._kind(self._peek(at)) is Kind.NEG:
            return self._negation(at)
        self._filler(self.tokens[at])
        return at + 1

    def _let(self, at: int) -> int:
        return self._rewritten(rewrite_let(self.tokens, at))

    def _ensure(self, at: int) -> int:
        end = self._rewritten(rewrite_ensure(self.tokens, at))
        also = states_also(self.tokens, end)
        if also:
            self.tokens[end].kind, self.tokens[end].text = Kind.ENSURE, "make_sure"
        return end

    def _rewritten(self, result: tuple[list[Token], int]) -> int:
        for token in result[0]:
            self._emit(token)
        return result[1]


def fold_subordinates(tokens: list[Token]) -> list[Token]:
    """Return the tokens with every subordinate span folded into one token."""
    return _Folder(tokens).run()
