"""Verb or noun: each word gets one class from its neighbours, before any grammar runs.

Leaving the choice to an ambiguous grammar picks the noun reading in lists and is far slower. The words of open
classes are read in :mod:`tmd.language.tagging.verb_or_noun`.
"""

from __future__ import annotations

from tmd.language.lexicon.lexicon import Lexicon
from tmd.language.lexicon.word_lists import section
from tmd.language.tagging.context import ARTICLES, OPENERS, SERIAL, State, helped, next_token
from tmd.language.tagging.tokens import Kind, Token
from tmd.language.tagging.verb_or_noun import read_word


def decide(tokens: list[Token], lexicon: Lexicon) -> None:
    """Set the kind of every undecided token, in place, in one pass."""
    state = State()
    previous: Token | None = None
    _mark_purposes(tokens)
    for at, token in enumerate(tokens):
        following = next_token(tokens, at)
        if token.text == ":" and previous is not None and previous.kind is Kind.V:
            token.kind = Kind.FILLER
        elif token.kind is Kind.STOP:
            state = State()
        elif token.kind in (Kind.SUB, Kind.REL, Kind.PURP):
            _open_subordinate(token, previous, following, state)
        elif token.kind is Kind.LET:
            if previous is not None and previous.kind in (Kind.CC, Kind.COMMA):
                state.close()
            state.let = token.text != "leave"
            if state.sub and state.nominal and previous is not None and previous.kind in (Kind.N, Kind.PRON):
                token.kind, state.let = Kind.FINITE, False
        elif token.kind is Kind.CC and token.text == "plus" and previous and previous.kind is Kind.DET:
            token.kind = Kind.N
        elif token.kind is Kind.TO:
            open_thing = previous is not None and previous.text in ("something", "anything", "nothing")
            causative = (state.let or open_thing) and following is not None and following.strength > 0
            token.form = "inf" if causative or _infinitive(following, next_token(tokens, at, 2)) else ""
        elif token.kind is Kind.DET:
            _read_determiner(token, previous, following, state)
        elif token.kind is Kind.PRON:
            _read_pronoun(token, previous, following, state)
        elif token.kind is Kind.AUX:
            _read_auxiliary(token, previous, following, state, lexicon)
        elif token.kind in (Kind.ADJ, Kind.ADV, Kind.P):
            _read_modifier(token, previous, following)
        elif token.kind is Kind.WORD:
            token.kind = read_word(token, previous, following, state, lexicon, tokens, at)
        if token.kind in (Kind.N, Kind.PRON):
            state.nominal = True
        elif token.kind is Kind.FINITE:
            state.close()
        elif token.kind is Kind.V:
            state.close()
            state.let, state.verb = False, True
            if previous and previous.kind is Kind.V and previous.stem in SERIAL:
                previous.kind = Kind.FILLER
            else:
                for word in helped(tokens, at):
                    word.kind = Kind.ADV
        if token.kind not in (Kind.ADV, Kind.FILLER):
            previous = token


def _open_subordinate(token: Token, previous: Token | None, following: Token | None, state: State) -> None:
    ends = following is None or following.kind in (Kind.STOP, Kind.CC, Kind.COMMA, Kind.MOD)
    if token.text == "once" and ends:
        token.kind = Kind.ADV
        return
    if token.text in ("after", "before", "until") and following is not None and following.kind is Kind.MOD:
        return
    if token.text == "like" and previous is not None and previous.kind in (Kind.AUX, Kind.SUBJECT):
        token.kind, token.stem, token.form = Kind.V, "like", "base"
        return
    state.sub, state.nominal = True, token.kind is Kind.REL


def _infinitive(following: Token | None, after: Token | None) -> bool:
    if following is not None and following.capital:
        return False
    if following is None or following.form not in ("base", "") or following.kind not in (Kind.WORD, Kind.LET):
        return following is not None and following.text in ("be", "have", "do")
    if following.strength == 3:
        return True
    opens = after is not None and (after.kind in OPENERS or (after.kind is Kind.WORD and after.strength < 2))
    particle = after is not None and after.kind in (Kind.P, Kind.REL, Kind.SUB)
    if following.strength == 2:
        return opens or after is None or particle or after.kind in (Kind.STOP, Kind.CC, Kind.MOD)
    return following.strength == 1 and after is not None and after.kind in ARTICLES


def _read_determiner(token: Token, previous: Token | None, following: Token | None, state: State) -> None:
    """Determiners without a noun are pronouns; "that" after a noun opens a relative clause."""
    if token.text == "what" and following is not None and following.kind is Kind.AUX:
        token.kind, state.sub, state.nominal = Kind.REL, True, True
        return
    if token.text in ("all", "both") and previous is not None and previous.kind is Kind.PRON:
        token.kind = Kind.ADV
        return
    if token.text == "her" and previous is not None and previous.kind is Kind.V and previous.stem == "give":
        token.kind = Kind.PRON
        return
    nominal = following is not None and following.kind in (Kind.DET, Kind.ADJ, Kind.NUM, Kind.WORD)
    of = following is not None and following.text == "of"
    if token.text == "that" and previous and previous.kind in (Kind.N, Kind.PRON):
        verbal = following is not None and (
            following.kind in (Kind.AUX, Kind.PRON, Kind.SUBJECT) or following.form in ("s", "ed") or following.capital
        )
        if verbal:
            token.kind, state.sub, state.nominal = Kind.REL, True, True
            return
    if token.text in ("the", "a", "an", "my", "your", "its", "every"):
        return
    adjective = following is not None and following.text in section("drop_adjectives")  # "both empty bottles"
    verb_next = following is not None and following.strength == 3 and following.form == "base" and not adjective
    if not (nominal or of) or (verb_next and token.text in section("pronouns") and previous is not None):
        token.kind = Kind.PRON if token.text in section("pronouns") else Kind.DET


def _read_pronoun(token: Token, previous: Token | None, following: Token | None, state: State) -> None:
    word = token.text
    if word == "her" and following is not None and following.kind in (Kind.WORD, Kind.ADJ):
        token.kind = Kind.DET
        return
    if word not in section("subjects") or (previous and previous.kind in (Kind.P, Kind.V, Kind.TO)):
        return
    if not state.sub:
        token.kind = Kind.SUBJECT
        state.narrative = word in ("he", "she", "they", "i", "we", "you")
    else:
        state.nominal = True


def _read_auxiliary(
    token: Token, previous: Token | None, following: Token | None, state: State, lexicon: Lexicon
) -> None:
    """Auxiliaries at the start of a sentence before a noun phrase are verbs ("have a look")."""
    nominal = previous is not None and previous.kind in (Kind.N, Kind.DET, Kind.ADJ)
    listed = following is None or following.kind in (Kind.CC, Kind.COMMA, Kind.STOP, Kind.P, Kind.TO)
    verbal = following is not None and following.strength and following.form == "base"
    if token.text == "can" and (listed or (nominal and not verbal)):
        token.kind = Kind.N
        return
    start = previous is None or previous.kind in (Kind.STOP, Kind.COMMA, Kind.CC)
    object_next = following is not None and following.kind in ARTICLES and following.text != "you"
    if token.text in ("need", "needs", "do") and start and object_next:
        token.kind, token.stem, token.form = Kind.V, "do" if token.text == "do" else "need", "base"
    state.close()


def _read_modifier(token: Token, previous: Token | None, following: Token | None) -> None:
    """Read "second" and "back" as modifiers a noun; "past" and "out" stay prepositions."""
    start = previous is None or previous.kind in (Kind.STOP, Kind.COMMA, Kind.CC)
    article = following is not None and following.kind in ARTICLES
    determined = previous is not None and previous.kind is Kind.DET
    headless = following is None or following.kind in (Kind.STOP, Kind.COMMA, Kind.CC, Kind.P)
    noun_next = following is not None and following.kind in (Kind.WORD, Kind.N, Kind.ADJ)
    if determined and headless and token.text == "well":
        token.kind = Kind.N
        return
    if determined and noun_next and token.text in ("upstairs", "downstairs"):
        token.kind = Kind.N
        return
    if determined and headless and token.text in ("same", "other", "others"):
        token.kind = Kind.N
        return
    if token.kind is Kind.ADJ and token.form == "base" and token.strength > 1 and start and article:
        token.kind = Kind.V
        return
    narrated = (previous is not None and previous.kind is Kind.SUBJECT) or (start and article)
    if token.kind is Kind.ADJ and token.form == "ed" and token.stem and narrated:
        token.kind = Kind.V
        return
    sure = following is not None and following.strength == 3 and following.form == "base"
    if token.text in section("adverbs") | {"next", "last"} and token.kind is not Kind.P and start and sure:
        token.kind = Kind.ADV
        return
    beside = previous is not None and previous.kind is Kind.N and following is not None
    if token.text in ("nearest", "closest") and beside and following and following.kind in OPENERS:
        token.kind = Kind.P
        return
    inside = previous is not None and previous.kind in (Kind.DET, Kind.ADJ)
    if (inside and token.text in section("keep_adjectives")) or (
        inside and token.text in ("inside", "outside", "front", "back") and not noun_next
    ):
        token.kind = Kind.N
    elif token.kind is Kind.ADV and token.text in section("keep_adjectives") and noun_next:
        beside = following is not None and (following.text in section("keep_adjectives"))
        verb_before = previous is not None and previous.kind in (Kind.P, Kind.V, Kind.CC, Kind.COMMA, Kind.N)
        if token.text != "right" or beside or (verb_before and following and following.kind is Kind.WORD):
            token.kind = Kind.N


def _mark_purposes(tokens: list[Token]) -> None:
    """Tell "hang it up so it dries" from "so, take the cup"."""
    for before, token, after in zip(tokens, tokens[1:], tokens[2:], strict=False):
        if token.text != "so" or before.kind in (Kind.STOP, Kind.AUX, Kind.DET):
            continue
        clause = after.kind in (Kind.PRON, Kind.SUBJECT) or (after.kind is Kind.AUX and "'" in after.text)
        if clause or (after.kind is Kind.DET and before.kind not in (Kind.CC, Kind.COMMA)):
            token.kind = Kind.PURP
