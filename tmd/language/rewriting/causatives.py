"""Causatives as plain clauses: "let the water boil" is (boil, [water]), "make sure it is off" (turn_off, [it])."""

from __future__ import annotations

from tmd.language.clause import Span
from tmd.language.lexicon.word_lists import section
from tmd.language.syntax.chunking import ALSO
from tmd.language.tagging.first_tags import fold
from tmd.language.tagging.tokens import Kind, Token

NEGATED = "says what not to do"

_INSIDE = frozenset({Kind.DET, Kind.NUM, Kind.ADJ, Kind.N, Kind.PRON, Kind.ADV, Kind.CC})
_DUTIES = frozenset({"should", "must", "need", "needs", "has", "have", "ought"})
_SWITCHES = {"on": "turn_on", "off": "turn_off"}


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


def rewrite_let(tokens: list[Token], at: int) -> tuple[list[Token], int]:
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


def rewrite_ensure(tokens: list[Token], at: int) -> tuple[list[Token], int]:
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


def rewrite_should(tokens: list[Token], at: int) -> tuple[list[Token], int] | None:
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
    if copula >= len(tokens) or tokens[copula].text not in _DUTIES or not any(t.kind is Kind.N for t in nominal):
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


def states_also(tokens: list[Token], at: int) -> bool:
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


def covered(token: Token) -> list[Span]:
    """Return every place a token stands at."""
    return [token.span, *token.parts]
