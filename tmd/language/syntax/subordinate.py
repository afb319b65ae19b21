"""What a subordinate clause says: conditions, events, purposes, prohibitions and relative clauses, as clauses.

Each is turned into an imperative or a statement with *be* and read by the parser again: *when you have taken the cup
out* says (take, [cup]), *if the window is open* says (be, [window]) with the result ``open``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from tmd.language.clause import PERSONS, Clause, Condition, Mood, Quantifier, Relation
from tmd.language.lexicon.lexicon import Lexicon, section
from tmd.language.syntax.attachment import ClauseDraft, Phrase
from tmd.language.syntax.chunking import ALSO
from tmd.language.syntax.pronouns import resolve_alone
from tmd.language.syntax.tokens import Kind, Token, fold

REMINDER = "names a thing, and not what to do with it"
NEGATED = "says what not to do"
UNNEEDED = "says what need not be done"
STATEMENT = "a statement, not an instruction"
RELATIVE = "relative"
"""The form of a preposition that opens what was a relative clause: "the remote that is on the sofa"."""
ASIDE = "an aside in brackets"
ADDRESS = "addresses somebody"

_NOMINAL = frozenset({Kind.DET, Kind.NUM, Kind.ADJ, Kind.N, Kind.PRON, Kind.P, Kind.ADV, Kind.MOD})
_WHITHER = frozenset({"to", "into", "onto", "off", "out_of"})
_DO_NOT = frozenset({"don't", "dont", "doesn't", "not"})
_NAMING = frozenset({"call", "name", "label", "mark", "title"})
_AFTER_SUBJECT = frozenset({Kind.AUX, Kind.ADV, Kind.SUBJECT})
_INSIDE = frozenset({Kind.DET, Kind.NUM, Kind.ADJ, Kind.N, Kind.PRON, Kind.ADV, Kind.CC})
_DUTIES = frozenset({"should", "must", "need", "needs", "has", "have", "ought"})
_SWITCHES = {"on": "turn_on", "off": "turn_off"}


class _Folder:
    """One pass over the decided tokens of a text; ``out`` is what stays."""

    def __init__(self, tokens: list[Token]) -> None:
        self.tokens = tokens
        self.out: list[Token] = []
        self.verb: Token | None = None
        """The verb of the clause that is open."""
        self.start = True
        """Nothing but fillers since the last separator."""
        self.handlers: dict[Kind, Callable[[int], int]] = {
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
            Kind.P: self._preposition,
            Kind.PARTICIPLE: self._participle,
            Kind.FINITE: self._drop,
        }

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
        """Read what begins at one place; return where reading goes on."""
        token = self.tokens[at]
        if token.kind in (Kind.CC, Kind.COMMA):
            self.start = self.start or self._kind(self._peek(at)) not in _NOMINAL
        end = self._sentence(at)
        if end is None:
            end = self._set_apart(at)
        if end is None:
            end = self.handlers.get(token.kind, self._keep)(at)
        return end

    def _sentence(self, at: int) -> int | None:
        """Read what should be done, or a statement, where a sentence or a part of one can begin."""
        joint = self.tokens[at].kind in (Kind.CC, Kind.COMMA, Kind.STOP)
        if not (self.start or joint):
            return None
        begin = at + joint
        asked = _rewrite_should(self.tokens, begin) if begin < len(self.tokens) else None
        end = self._statement(begin) if asked is None else None
        if joint and (asked or end is not None):
            self._emit(self.tokens[at])
        if asked and any(t.kind is Kind.REL for t in asked[0]):
            self.tokens[begin : asked[1]] = asked[0]  # the relative clause is still to be folded
            self.start = False
            return begin
        if asked:
            return self._rewritten(asked)
        return self._fold(begin, end, Kind.SKIP, STATEMENT) if end is not None else None

    def _set_apart(self, at: int) -> int | None:
        """Read a name that is called, an aside in brackets, and "no need"."""
        token = self.tokens[at]
        if self.start and token.kind is Kind.N and self._kind(at + 1) is Kind.COMMA and self._calls(at + 1):
            return self._fold(at, at + 1, Kind.SKIP, ADDRESS)
        aside = self._aside(at) if token.text == "(" else None
        if aside is not None:
            return self._fold(at, aside, Kind.SKIP, ASIDE)
        if token.text == "no" and at + 1 < len(self.tokens) and self.tokens[at + 1].text == "need":
            return self._negation(at)
        return None

    def _keep(self, at: int) -> int:
        self._emit(self.tokens[at])
        return at + 1

    def _drop(self, at: int) -> int:
        self._filler(self.tokens[at])
        return at + 1

    def _preposition(self, at: int) -> int:
        following = self.tokens[at + 1] if at + 1 < len(self.tokens) else None
        manner = following is not None and (following.kind is Kind.ING or following.text == "using")
        if manner and self.tokens[at].text == "without":
            return self._fold(at, self.boundary(at + 1), Kind.MOD, "manner")
        return self._drop(at) if manner and self.tokens[at].text == "by" else self._keep(at)

    def _participle(self, at: int) -> int:
        """Fold "called the ark"; other participles say nothing of a clause."""
        if self.tokens[at].stem not in _NAMING:
            return self._drop(at)
        end = at + 1
        while self._kind(end) in (Kind.N, Kind.ADJ, Kind.NUM):
            end += 1
        return self._fold(at, end, Kind.MOD, "relative")

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
                if (
                    scan
                    and self.tokens[scan - 1].text in section("modals")
                    and self.tokens[scan - 1].kind is Kind.FILLER
                ):
                    return None  # "can you find the cup": asked, not told
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
            if token.kind is Kind.COMMA and self._asks(end + 1):
                break
            end += 1
        return end

    def _asks(self, at: int) -> bool:
        """Tell whether a question begins here: "…, could you bring one"."""
        modal = self._kind(at) is Kind.AUX and self.tokens[at].text in section("modals")
        return modal and self._kind(at + 1) in (Kind.SUBJECT, Kind.PRON)

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
            owns = said and self.tokens[at + 1].text in ("has", "have") and self._kind(place + 1) is not Kind.PRON
            if owns and token.text in ("in", "on", "at"):
                return place  # "the pot that has an egg | on the stove"; but "the pot that has an egg in it"
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
        words = [t.text for t in self.tokens[at : at + 3]]
        unneeded = words[0] == "needn't" or (words[0] in _DO_NOT and words[1:3] in (["have", "to"], ["need", "to"]))
        return self._fold(at, end, Kind.SKIP, UNNEEDED if unneeded else NEGATED)

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
        return self._rewritten(_rewrite_let(self.tokens, at))

    def _ensure(self, at: int) -> int:
        end = self._rewritten(_rewrite_ensure(self.tokens, at))
        also = _states_also(self.tokens, end)
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


def _verb(stem: str, *sources: Token) -> Token:
    """Make the verb of a rewritten clause; it stands where its sources stand."""
    first, *rest = (t.span for t in sources)
    return Token(Kind.V, stem, first, stem=stem, form="base", strength=3, parts=list(rest))


def _filler(tokens: list[Token]) -> list[Token]:
    for token in tokens:
        token.kind = Kind.FILLER
    return tokens


def _nominal_end(tokens: list[Token], at: int) -> int:
    while at < len(tokens) and tokens[at].kind in _INSIDE:
        at += 1
    return at


def _rewrite_let(tokens: list[Token], at: int) -> tuple[list[Token], int]:
    """Rewrite "let X (to) do" as "do X".

    Returns:
        The new tokens and the index where reading goes on.
    """
    end = _nominal_end(tokens, at + 1)
    objects, stop = tokens[at + 1 : end], end
    if end < len(tokens) and tokens[end].kind is Kind.TO:
        end += 1
    bare_leave = tokens[at].text == "leave" and end == stop
    if end < len(tokens) and not bare_leave and tokens[end].kind is Kind.V and tokens[end].form == "base":
        verb = tokens[end]
        if objects and objects[-1].text in ("us", "me"):
            return [*_filler(tokens[at:end]), verb], end + 1
        lead = _verb(verb.stem, tokens[at], verb)
        return [lead, *objects, *_filler(tokens[stop:end])], end + 1
    token = tokens[at]
    token.kind, token.form, token.strength = Kind.V, "base", 3
    return [token], at + 1


def _rewrite_ensure(tokens: list[Token], at: int) -> tuple[list[Token], int]:
    """Rewrite "make sure (that) X is done" as "do X", and "make sure to do" as "do".

    Where the state is neither a verb nor on or off, the verb stays ``make_sure``.
    """
    ensure, begin = tokens[at], at + 1
    while begin < len(tokens) and (tokens[begin].text == "that" or tokens[begin].kind is Kind.TO):
        begin += 1
    lead = tokens[at:begin]
    if begin < len(tokens) and tokens[begin].kind in (Kind.V, Kind.SUBJECT, Kind.NEG):
        return _filler(lead), begin
    if any(t.text == "no" or t.kind is Kind.NEG for t in tokens[begin : begin + 4]):
        end = begin
        while end < len(tokens) and tokens[end].kind not in (Kind.STOP, Kind.COMMA):
            if tokens[end].kind is Kind.V and tokens[end - 1].kind not in (Kind.NEG, Kind.AUX):
                break
            end += 1
        absent = fold(tokens[at:end], Kind.SKIP, " ")
        absent.note = NEGATED
        return [absent], end
    copula = _nominal_end(tokens, begin)
    place = copula
    while place < len(tokens) and tokens[place].kind is Kind.P and copula - begin:
        copula = place = _nominal_end(tokens, place + 1)
    if copula >= len(tokens) or tokens[copula].kind is not Kind.AUX:
        ensure.kind, ensure.stem, ensure.form = Kind.V, _stem(ensure.text), "base"
        return [ensure, *_filler(lead[1:])], begin
    state = copula + 1
    while state < len(tokens) and tokens[state].kind in (Kind.ADV, Kind.AUX):
        state += 1
    stem, used = _state_verb(tokens, state)
    sources = [ensure, *tokens[copula:used]]
    return [_verb(stem, *sources), *_filler(lead[1:]), *tokens[begin:copula]], used


def _rewrite_should(tokens: list[Token], at: int) -> tuple[list[Token], int] | None:
    """Rewrite "the plates should be washed and dried" as "wash and dry the plates".

    Returns:
        The new tokens and the index where reading goes on, or ``None`` if nothing is asked for there.
    """
    copula = _nominal_end(tokens, at)
    while copula < len(tokens) and tokens[copula].kind is Kind.P and copula > at:
        copula = _nominal_end(tokens, copula + 1)
    if copula < len(tokens) and tokens[copula].kind is Kind.REL and any(t.kind is Kind.N for t in tokens[at:copula]):
        # "the cup that is on the desk should be washed"
        ends = (i for i in range(copula, len(tokens)) if tokens[i].kind in (Kind.STOP, Kind.COMMA))
        duties = (i for i in range(copula, next(ends, len(tokens))) if tokens[i].text in ("should", "must"))
        copula = next(duties, copula)
    nominal = tokens[at:copula]
    named = any(t.kind is Kind.N or t.text in ("one", "ones") for t in nominal)
    if copula >= len(tokens) or tokens[copula].text not in _DUTIES or not named:
        return None
    state = copula + 1
    while state < len(tokens) and tokens[state].kind in (Kind.AUX, Kind.ADV, Kind.TO):
        state += 1
    denied = any(t.kind is Kind.NEG or t.text == "not" or t.text.endswith("n't") for t in tokens[copula : state + 1])
    if denied or not any(t.text == "be" for t in tokens[copula:state]):
        return None
    stem, used = _state_verb(tokens, state)
    if stem == "make_sure":
        return None
    verbs = [_verb(stem, *tokens[copula:used])]
    while used + 1 < len(tokens) and tokens[used].kind is Kind.CC and tokens[used + 1].form == "ed":
        verbs += [tokens[used], _verb(tokens[used + 1].stem, tokens[used + 1])]
        used += 2
    if used < len(tokens) and tokens[used].kind in (Kind.P, Kind.TO) and any(t.kind is Kind.P for t in nominal):
        tokens[used].form = ALSO  # said of what is acted on, not of the noun before it
    return [*verbs, *nominal], used


def _states_also(tokens: list[Token], at: int) -> bool:
    """Tell whether a second state follows: "make sure the door is shut and the lamp is off"."""
    if at >= len(tokens) or tokens[at].kind is not Kind.CC:
        return False
    copula = _nominal_end(tokens, at + 1)
    named = any(t.kind in (Kind.N, Kind.PRON) for t in tokens[at + 1 : copula])
    return named and copula < len(tokens) and tokens[copula].text in section("be")


def _stem(text: str) -> str:
    return "make_sure" if "_" in text else text


def _state_verb(tokens: list[Token], at: int) -> tuple[str, int]:
    """Return the verb that brings about the state that begins at ``at``, and where it ends."""
    if at >= len(tokens):
        return "make_sure", at
    token = tokens[at]
    following = tokens[at + 1] if at + 1 < len(tokens) else None
    nominal_next = following is not None and following.kind in _INSIDE - {Kind.CC, Kind.ADV}
    if token.kind is Kind.P and token.text in _SWITCHES and not nominal_next:
        return _SWITCHES[token.text], at + 1
    if token.kind is Kind.PARTICIPLE and token.stem:
        particle = following is not None and following.text in (
            "on",
            "off",
            "up",
            "down",
            "in",
            "away",
            "out",
        )
        if particle and following is not None:
            after = tokens[at + 2].kind if at + 2 < len(tokens) else Kind.STOP
            if after not in _INSIDE - {Kind.CC, Kind.ADV}:
                return f"{token.stem}_{following.text}", at + 2
        return token.stem, at + 1
    if token.stem and (token.text in section("verbs") or token.form == "ed") and token.kind in (Kind.ADJ, Kind.N):
        return token.stem, at + 1
    if token.form == "ing" and token.stem and not nominal_next:
        return token.stem, at + 1  # "make sure the film is playing"
    return "make_sure", at + (token.kind is Kind.ADJ)


BE = "be"
Reader = Callable[[str], tuple[Clause, ...]]
"""Reads a text as clauses."""

_BE = frozenset(
    {"is", "are", "was", "were", "be", "been", "am", "isn't", "aren't", "wasn't", "weren't", "stays", "looks", "seems"}
)
_STANDS = frozenset({"stands", "stand", "lies", "lie", "sits", "sit", "lying", "standing", "sitting", "hangs"})
_HAVE = frozenset({"has", "have", "had", "hasn't", "haven't", "having"})
_BECOME = frozenset({"gets", "becomes", "turns", "get", "become", "turn"})
_YOU = frozenset({"you", "we", "i", "you've", "we've", "i've", "you're", "you'll"})
_NOT = frozenset(
    {
        "not",
        "no",
        "never",
        "neither",
        "nor",
        "don't",
        "dont",
        "doesn't",
        "didn't",
        "without",
        "cannot",
        "can't",
        "won't",
    }
)
_HELPERS = frozenset(
    {"do", "does", "did", "will", "would", "can", "could", "should", "must", "may", "to", "please", "just", "already",
     "then", "ever", "also", "still", "got", "i'd", "we'd", "rather", "you", "we", "i", "the_robot", "need", "want"}
)  # fmt: skip
_SOFT = frozenset(
    {"already", "still", "just", "yet", "too", "very", "really", "all", "enough", "now", "completely", "nice", "and"}
)
_NOTICE = frozenset({"see", "find", "notice", "spot", "discover"})
"""What you see is there."""
_POSTURE = frozenset({"left", "standing", "lying", "sitting", "around", "about", "somewhere", "remaining"})
_HAPPENING = frozenset({"boil", "heat", "warm", "cool", "chill", "dry", "cook", "simmer", "soak", "charge", "melt"})
"""What a thing does by itself when it is put somewhere: to have it do so is what that is for."""
_DETERMINED = section("determiners") | section("quantifiers")


def read_subordinates(found: Sequence[ClauseDraft], lexicon: Lexicon, read: Reader) -> None:
    """Read what was folded into each clause; a condition in front of a sentence holds for the whole of it."""
    before: ClauseDraft | None = None
    asked: list[Condition] = []
    for draft in found:
        for token in draft.folds:
            if token.form == "condition" and _condition_words(token) in (["if", "so"], ["if", "yes"]):
                draft.conditions += asked
                draft.fronted = True
            elif token.form == "condition" and _condition_words(token)[1:] == ["there", "is", "any"]:
                continue  # "some sweets, if there are any": where there are none, that is told anyway
            elif token.form == "condition":
                draft.conditions.append(_read_condition(_condition_words(token), lexicon, read))
                asked = [c for c in draft.conditions if c.word == "if"] or asked
                draft.fronted = draft.fronted or token.span < draft.verb.span
            elif token.form == "purpose":
                words = _condition_words(token)
                said = _read_condition(["to", *_purpose(words)], lexicon, read)
                draft.conditions.append(replace(said, text=" ".join(words)))
            elif token.form == "relative":
                _add_relative(draft, token, lexicon, read)
        same = before is not None and before.verb.sentence == draft.verb.sentence and before.fronted
        if before is not None and same and not draft.conditions and not draft.verb.otherwise:
            draft.conditions = [replace(c, carried=True) for c in before.conditions if c.word in ("if", "unless")]
            draft.fronted = True
        before = draft


def _purpose(words: list[str]) -> list[str]:
    """The words of a purpose as those of an instruction to somebody."""
    while words and words[0] in ("to", "so", "that", "in", "order", "so_that", "in_order_to", "so_as_to"):
        words = words[1:]
    if len(words) == 1 and words[0] in _HAPPENING:
        words = [*words, "it"]  # "put the kettle on the stove to boil"
    return words if words and words[0] in section("subjects") | section("pronouns") else ["you", *words]


def _add_relative(draft: ClauseDraft, token: Token, lexicon: Lexicon, read: Reader) -> None:
    """Add what a relative clause says to the noun before it."""
    ahead = [phrase for phrase in draft.mentions() if phrase.place < token.span.start]
    if not ahead:
        return
    noun = _described(draft, ahead, token)
    attributes, relations, clause = _read_relative(token, lexicon, read)
    noun.attributes += attributes
    for relation, target in relations:
        draft.relations.append(Relation(relation, noun.name, target))
        if clause is not None:
            draft.further[target] = clause.phrase(target)


def _described(draft: ClauseDraft, ahead: Sequence[Phrase], token: Token) -> Phrase:
    """The noun that a relative clause is about: the last, or the one of which the last says where it is.

    It is that one where only it agrees with the verb ("the cups on the table that are clean"), and where all of them
    are meant ("everything on the floor that is empty") unless the place is where they are to be put, and no other is.
    """
    last = max(ahead, key=lambda phrase: phrase.place)
    placed = {r.source for r in draft.relations if r.target == last.name and r.relation in section("static")}
    head = next((phrase for phrase in reversed(ahead) if phrase.name in placed), None)
    if head is None or last.plural:
        return last
    if _condition_words(token)[1:2] in (["are"], ["were"], ["have"]):
        return head if head.plural else last
    whole = head.said().quantifier is Quantifier.ALL and not head.plural
    others = (r for r in draft.relations if r.source in (head.name, last.name) and r.target != last.name)
    placing = draft.verb.stem in section("placing") and not any(r.relation in section("static") for r in others)
    return head if whole and not placing else last


def read_prohibitions(
    tokens: Sequence[Token], clauses: Sequence[Clause], text: str, lexicon: Lexicon, read: Reader
) -> tuple[tuple[Clause, ...], list[Token]]:
    """What must not be done, and the tokens that say so."""
    found: list[Clause] = []
    understood: list[Token] = []
    for token in tokens:
        negated = token.kind is Kind.SKIP and token.note == NEGATED
        manner = token.kind is Kind.MOD and token.form == "manner"
        if not (negated or manner) or not token.inner:
            continue
        before = [clause for clause in clauses if clause.span.start < token.span.start]
        said = _read_prohibition(_condition_words(token), before[-1] if before else None, lexicon, read)
        found += [
            replace(resolve_alone(c, before), mood=Mood.AVOID, span=token.span, text=text[slice(*token.span)])
            for c in said
        ]
        if said and negated:
            understood.append(token)
    return tuple(found), understood


def _read_condition(words: Sequence[str], lexicon: Lexicon, read: Reader) -> Condition:
    """Return what the words of a subordinate clause say; without clauses where it is not understood.

    Args:
        words: Its words, the first of which opens it.
        lexicon: The words of the domain.
        read: The parser.
    """
    if words[0] == "with" and len(words) > 2:
        return Condition("with", _state(list(words[1:-1]), [words[-1]], lexicon, read), False, " ".join(words))
    opener, rest = words[0], [w for w in words[1:] if w not in ("that", ",")]
    text = " ".join(words)
    if len(rest) == 2 and rest[0] == "its":
        rest = ["it's", rest[1]]  # as people write it: "when its done"
    rest = [part for word in rest for part in _expanded(word)]
    negated = any(w in ("not", "no", "never") or w.endswith("n't") for w in rest)
    plain = [w for w in rest if w not in ("not", "never") and w not in ("any",)]
    plain = ["any" if w == "no" else w for w in plain]
    clauses = _said(plain, lexicon, read) if plain else ()
    return Condition(opener, tuple(replace(clause, text=text) for clause in clauses), negated, text)


def _expanded(word: str) -> list[str]:
    for ending, full in (("n't", "not"), ("'s", "is"), ("'re", "are"), ("'ve", "have")):
        if word.endswith(ending) and word != ending:
            stem = word.removesuffix(ending)
            return [{"ca": "can", "wo": "will"}.get(stem, stem), full]
    return [word]


def _said(words: list[str], lexicon: Lexicon, read: Reader) -> tuple[Clause, ...]:
    if words[0] == "there" and len(words) > 2:
        return _named(_without_posture(words[2:]), read)
    copula = next((i for i, w in enumerate(words) if w in _BE), None)
    if words[0] in _YOU:
        return _done_by_you(words[1:], lexicon, read)
    if copula is not None and words[copula - 1 : copula] and words[copula - 1] in _HAVE:
        words = [*words[: copula - 1], *words[copula:]]
        copula -= 1
    if copula:
        return _state(words[:copula], words[copula + 1 :], lexicon, read)
    if copula == 0:
        return _state([], words[1:], lexicon, read)
    having = next((i for i, w in enumerate(words) if w in _HAVE), None)
    if having:
        return _having(words[:having], words[having + 1 :], lexicon, read)
    first = lexicon.verb(words[0])
    if words[0].endswith("ing") and first is not None:
        return read(" ".join([_imperative(first[0]), *words[1:]]))
    finite = next((i for i, w in enumerate(words) if i and _finite(w, lexicon)), None)
    if finite is not None:
        return _event(words[:finite], words[finite:], lexicon, read)
    last = lexicon.verb(words[-1])
    if len(words) > 1 and last is not None and last[1] == "s":
        return _event(words[:-1], words[-1:], lexicon, read)  # "when the kettle whistles"
    if len(words) == 1 or words[0] in _SOFT:
        return _state([], words, lexicon, read)
    return _named(words, read)


def _done_by_you(words: list[str], lexicon: Lexicon, read: Reader) -> tuple[Clause, ...]:
    while words and words[0] in _HELPERS | {"had", "are", "is"}:
        words = words[1:]
    if words and words[0] in _HAVE:
        words = words[1:]
        if (words and lexicon.verb(words[0]) is None) or (words and words[0] in _DETERMINED):
            return _named(words, read)
    found = lexicon.verb(words[0]) if words else None
    if found and found[0] in _NOTICE and len(words) > 1:
        return _named(words[1:], read)
    return read(" ".join([_imperative(found[0]), *words[1:]])) if found else ()


def _without_posture(words: list[str]) -> list[str]:
    """The words of what is there, without *already* before and *standing around* behind them."""
    while words and words[0] in _SOFT - {"all", "enough"}:
        words = words[1:]
    while len(words) > 1 and words[-1] in _POSTURE:
        words = words[:-1]
    return words


def _imperative(stem: str) -> str:
    return stem.replace("_", " ")


def _named(words: list[str], read: Reader) -> tuple[Clause, ...]:
    """That something is there."""
    found = read(" ".join(["find", *words]))
    return (replace(found[0], verb=BE),) if found else ()


def _state(subject: list[str], complement: list[str], lexicon: Lexicon, read: Reader) -> tuple[Clause, ...]:
    while complement and complement[0] in _SOFT:
        complement = complement[1:]
    while complement and complement[-1] in _SOFT and len(complement) > 1:
        complement = complement[:-1]
    if not complement:
        return ()
    subject = subject or ["it"]
    switch = complement[0] in ("on", "off", "out", "over", "up", "down") and len(complement) == 1
    if not switch and complement[0] in section("prepositions") | {"next_to", "on_top_of", "out_of", "in_front_of"}:
        found = read(" ".join(["put", *subject, *(c.replace("_", " ") for c in complement)]))
        return (replace(found[0], verb=BE),) if found else ()
    found = read(" ".join(["find", *subject]))
    if not found:
        return ()
    past = lexicon.verb(complement[0])
    if past is not None and past[1] == "ed" and complement[0] not in section("drop_adjectives") | {"shut", "open"}:
        return (replace(found[0], verb=BE, result=complement[0]),)
    return (replace(found[0], verb=BE, result=complement[-1] if len(complement) < 3 else complement[0]),)


def _having(subject: list[str], rest: list[str], lexicon: Lexicon, read: Reader) -> tuple[Clause, ...]:
    """*It has boiled* is an event, *the cup has milk in it* a state."""
    found = lexicon.verb(rest[0]) if rest else None
    if found is not None and found[1] == "ed" and rest[0] not in _DETERMINED:
        return _event(subject, [found[0], *rest[1:]], lexicon, read)
    owner, thing = read(" ".join(["find", *subject])), read(" ".join(["find", *rest]))
    if not owner or not thing or not owner[0].objects or not thing[0].objects:
        return ()
    content = thing[0].objects[0]
    relation = Relation("with", owner[0].objects[0], content)
    phrases = {**owner[0].phrases, content: thing[0].phrase(content)}
    names = (owner[0].objects[0], content)
    return (replace(owner[0], verb=BE, objects=names, relations=(relation,), phrases=phrases),)


def _finite(word: str, lexicon: Lexicon) -> bool:
    found = lexicon.verb(word)
    return found is not None and (found[1] in ("s", "ed") or word in _BECOME) and found[2] > 1


def _event(subject: list[str], words: list[str], lexicon: Lexicon, read: Reader) -> tuple[Clause, ...]:
    """*The water boils* is what *boil the water* brings about."""
    if words[0] in _BECOME and len(words) > 1:
        return _state(subject, words[1:], lexicon, read)
    found = lexicon.verb(words[0])
    if found is None:
        return ()
    return read(" ".join([_imperative(found[0]), *subject, *words[1:]]))


def _read_prohibition(
    words: Sequence[str], before: Clause | None, lexicon: Lexicon, read: Reader
) -> tuple[Clause, ...]:
    """Return what must not be done; empty where it is not understood.

    Args:
        words: The words of the prohibition.
        before: The clause before it: *… in the bowl, not in the pot*.
        lexicon: The words of the domain.
        read: The parser.
    """
    parts = [part for word in words for part in _expanded(word)]
    parts = ["and" if part == "nor" and i else part for i, part in enumerate(parts)]
    at = next((i for i, w in enumerate(parts) if w in _NOT or w == "avoid"), None)
    if at is None:
        return ()
    rest = parts[at + 1 :]
    while rest and rest[0] in _HELPERS:
        rest = rest[1:]
    if not rest:
        return ()
    if rest[0] == "using":  # "without using the stove"
        rest = ["use", *rest[1:]]
    found = lexicon.verb(rest[0])
    if any(w in _BE for w in rest[1:]):
        return _said(["any", *rest] if parts[at] in ("no", "neither") else rest, lexicon, read)
    if rest[0] in section("prepositions") and before is not None:
        objects = [f"the {name.replace('_', ' ')}" for name in before.direct] or ["it"]
        said = read(" ".join([_imperative(before.verb), " and ".join(objects), *rest]))
        return tuple(replace(clause, implied=True) for clause in said)
    if found is not None and found[2] > 0 and rest[0] not in _DETERMINED and parts[at] != "no":
        return read(" ".join([_imperative(found[0]), *rest[1:]]))
    if before is not None:
        return tuple(replace(clause, implied=True) for clause in read(" ".join([_imperative(before.verb), *rest])))
    return ()


def _read_relative(
    token: Token, lexicon: Lexicon, read: Reader
) -> tuple[list[str], list[tuple[str, str]], Clause | None]:
    """Return what a relative clause says of its noun: adjectives, and relations with other nouns.

    *That are dirty* gives an adjective; *where the mug is* a relation ``where``, *that has milk in it* one ``with``.
    """
    words = [part for word in _condition_words(token) for part in _expanded(word)]
    if not words:
        return [], [], None
    rest = words[1:]
    if words[0] == "where" and rest:
        subject = [w for w in rest if w not in _BE]
        if not subject or subject[0] in section("pronouns"):
            return [], [], None
        found = read(" ".join(["find", *subject]))
        return ([], [("where", found[0].objects[0])], found[0]) if found and found[0].objects else ([], [], None)
    if len(rest) > 2 and rest[0] in _BE | _STANDS and rest[1] in section("prepositions"):
        found = read(" ".join(["find", *rest[2:]]))
        return ([], [(rest[1], found[0].objects[0])], found[0]) if found and found[0].objects else ([], [], None)
    if len(rest) > 1 and rest[0] in _BE:
        last = [w for w in rest[1:] if w not in _SOFT and w not in ("not",)]
        if "not" in rest and last and last[0] in section("prepositions") and len(last) > 1:
            found = read(" ".join(["find", *last[1:]]))
            return (
                ([], [(f"not_{last[0]}", found[0].objects[0])], found[0])
                if found and found[0].objects
                else ([], [], None)
            )
        if last and (len(last) == 1 or last[0] not in section("prepositions")):
            word = f"not_{last[-1]}" if "not" in rest else last[-1]
            return [word], [], None
    copula = next((i for i, w in enumerate(rest) if i and w in _BE), None)
    if copula is not None and rest[-1] in section("prepositions"):
        found = read(" ".join(["find", *rest[:copula]]))
        return ([], [("where", found[0].objects[0])], found[0]) if found and found[0].objects else ([], [], None)
    if rest and rest[0] in _HAVE | {"contains", "contain", "holds", "hold"} and len(rest) > 1:
        found = read(" ".join(["find", *rest[1:]]))
        return ([], [("with", found[0].objects[0])], found[0]) if found and found[0].objects else ([], [], None)
    return ["_".join(words)], [], None


def _condition_words(token: Token) -> list[str]:
    """Return the words of a folded condition."""
    words = [t.text for t in token.inner if t.kind is not Kind.COMMA] or token.text.split()
    return [words[0], *(part for word in words[1:] for part in word.split("_"))]
