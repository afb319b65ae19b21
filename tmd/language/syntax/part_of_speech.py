"""Verb or noun: each word gets one class from its neighbours, before any grammar runs.

Leaving the choice to an ambiguous grammar picks the noun reading in lists and is far slower. The words of open
classes are read in :mod:`tmd.language.tagging.verb_or_noun`.
"""

from __future__ import annotations

from dataclasses import dataclass

from tmd.language.lexicon.lexicon import Lexicon
from tmd.language.lexicon.words import section
from tmd.language.syntax.tokens import Kind, Token


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


ARTICLES = frozenset({Kind.DET, Kind.PRON})
OPENERS = frozenset({Kind.DET, Kind.PRON, Kind.NUM, Kind.ADJ})
DATIVE = frozenset({"me", "us", "him", "her", "you"})
SERIAL = frozenset({"go", "come", "run", "help", "hurry"})


@dataclass(slots=True)
class State:
    """What the pass remembers of the sentence so far."""

    sub: bool = False
    """Inside a condition or relative clause whose own verb has not come yet."""
    nominal: bool = False
    """... and whose subject has come."""
    narrative: bool = False
    """The sentence tells what somebody does: "she takes the cup"."""
    let: bool = False
    verb: bool = False
    """An instruction verb has come."""

    def close(self) -> None:
        """Leave the condition or relative clause."""
        self.sub = self.nominal = False


def next_token(tokens: list[Token], at: int, step: int = 1) -> Token | None:
    """Return the next token that is no adverb, or the one ``step`` further."""
    for token in tokens[at + 1 : at + 8]:
        if token.kind is not Kind.ADV:
            step -= 1
            if step == 0:
                return token
    return None


def helped(tokens: list[Token], at: int) -> list[Token]:
    """Return "help me" right before a verb: the verb behind it is what counts."""
    lead = tokens[max(0, at - 2) : at]
    helps = len(lead) == 2 and lead[0].kind is Kind.V and lead[0].stem == "help"
    return lead if helps and lead[1].text in DATIVE else []


_STARTS = frozenset({Kind.STOP, Kind.ENSURE, Kind.PURP, Kind.MOD})
_DEGREES = frozenset({"really", "very", "quite", "too", "extremely"})
_CONTINUES = frozenset({Kind.P, Kind.ADV, Kind.STOP, Kind.MOD, Kind.SUB, Kind.PURP, Kind.TO})
_COLOURS = frozenset({"red", "blue", "green", "yellow", "orange", "pink", "brown", "black", "white", "grey", "gray"})


def read_word(
    token: Token,
    previous: Token | None,
    following: Token | None,
    state: State,
    lexicon: Lexicon,
    tokens: list[Token],
    at: int,
) -> Kind:
    """Return the class of a word that no list of closed classes has."""
    if token.form == "possessive":
        return Kind.N
    if token.capital and previous is not None and previous.kind in (Kind.P, Kind.TO):
        return Kind.N
    if _is_result(token, previous, following):
        return Kind.ADV
    determined = previous is not None and previous.kind is Kind.DET
    if determined and token.text in section("drop_adjectives") and following is not None and following.text == "can":
        return Kind.ADJ  # "the empty can": the noun, which looks like an auxiliary
    if at and tokens[at - 1].text in _DEGREES and not (following and following.kind in ARTICLES):
        return Kind.ADJ
    turning = previous is not None and previous.kind is Kind.V and previous.stem in ("turn", "go", "look", "head")
    if turning and token.text in ("left", "right") and not (following and following.kind is Kind.WORD):
        return Kind.ADV
    particle = lexicon.particle(token.stem, following.text) if token.stem and following is not None else None
    if particle is not None and previous is not None and previous.kind is Kind.TO:
        return Kind.V  # "use the remote to switch on the television"
    if _heads_place(token, previous, following, lexicon, tokens, at):
        return Kind.N
    if not token.stem:
        return _read_unknown(token, previous, following, lexicon)
    if token.form == "ing":
        return _read_ing(token, previous, following, lexicon)
    if token.form == "ed":
        return _read_past(token, previous, following, state)
    if token.form == "s":
        return _read_third_person(token, previous, following, state, lexicon)
    return _read_base(token, previous, following, state, lexicon, tokens, at)


def _is_result(token: Token, previous: Token | None, following: Token | None) -> bool:
    """Tell what a thing becomes: "lay it flat", "tie the bag shut", "paint the fence white"."""
    if previous is None or previous.kind not in (Kind.PRON, Kind.N):
        return False
    if token.text == "flat" and previous.kind is Kind.PRON:
        return True
    ends = following is None or following.kind in (Kind.STOP, Kind.CC, Kind.COMMA, Kind.P)
    colour = token.text in _COLOURS and previous.text not in ("egg", *section("keep_adjectives"))
    return ends and (colour or token.text == "shut")


def _heads_place(
    token: Token, previous: Token | None, following: Token | None, lexicon: Lexicon, tokens: list[Token], at: int
) -> bool:
    """Tell whether a noun that looks like a verb says what goes where, or is on or off: "water in the pot", "TV on"."""
    starts = previous is None or previous.kind in (Kind.STOP, Kind.COMMA, Kind.CC)
    if not starts or following is None or not lexicon.is_noun(token.text) or token.strength > 1:
        return False
    if lexicon.particle(token.stem or token.text, following.text) is not None:
        return False  # "switch on the light"
    ahead = next_token(tokens, at + 1)
    ends = ahead is None or ahead.kind in (Kind.STOP, Kind.COMMA, Kind.CC)
    return (following.text in ("on", "off", "out") and ends) or (
        following.text in ("in", "into", "on", "onto") and not ends
    )


def _read_unknown(token: Token, previous: Token | None, following: Token | None, lexicon: Lexicon) -> Kind:
    """A word that is no known verb: a verb only where nothing else can stand ("zap the soup")."""
    article = following is not None and (
        following.text in ("the", "a", "an", "my", "it", "them") and following.kind in ARTICLES
    )
    start = previous is None or previous.kind in (Kind.STOP, Kind.COMMA, Kind.CC, Kind.SUBJECT)
    if article and start and not lexicon.is_noun(token.text) and token.text.isalpha():
        token.stem, token.form = token.text, "base"
        return Kind.V
    return Kind.N


def _read_ing(token: Token, previous: Token | None, following: Token | None, lexicon: Lexicon) -> Kind:
    noun_next = following is not None and following.kind is Kind.WORD and following.strength < 2
    noun_next = noun_next or (following is not None and following.text == "can")
    if token.text in section("drop_adjectives") and noun_next:
        return Kind.ADJ
    if previous is not None and previous.kind in (Kind.AUX, Kind.SUB):
        return Kind.ING
    if previous is not None and previous.kind is Kind.P and previous.text in ("by", "without", "after", "before"):
        return Kind.ING
    if previous is not None and previous.kind is Kind.V and previous.stem in section("lead_verbs") | {"keep", "stop"}:
        return Kind.ING
    if lexicon.is_noun(token.text) or (previous is not None and previous.kind in (Kind.DET, Kind.ADJ, Kind.P)):
        return Kind.N
    if previous is None or previous.kind in (Kind.STOP, Kind.COMMA, Kind.CC, Kind.N, Kind.PRON, Kind.MOD):
        modifier = token.text in section("ing_modifiers") or token.strength < 3
        bare_noun = noun_next and modifier and (previous is None or previous.kind is not Kind.COMMA)
        return Kind.N if bare_noun else Kind.ING
    return Kind.N


def _read_past(token: Token, previous: Token | None, following: Token | None, state: State) -> Kind:
    kind = previous.kind if previous else Kind.STOP
    if kind is Kind.AUX or kind is Kind.SUB:
        return Kind.PARTICIPLE
    if kind is Kind.SUBJECT or (state.narrative and kind in (Kind.CC, Kind.COMMA)):
        return Kind.V
    if token.text == "left" and kind is not Kind.PRON and following is not None and following.kind is Kind.WORD:
        return Kind.N
    if state.sub and state.nominal and kind in (Kind.N, Kind.PRON, Kind.REL):
        return Kind.FINITE
    article = following is not None and following.kind in ARTICLES
    if kind in (Kind.STOP, Kind.CC, Kind.COMMA) and article:
        return Kind.V
    if kind in (Kind.N, Kind.PRON, Kind.NUM):
        return Kind.FINITE if article else Kind.PARTICIPLE
    ends = following is None or following.kind in (Kind.STOP, Kind.COMMA, Kind.CC, Kind.P, Kind.TO, Kind.SUB)
    if kind is Kind.DET and ends and not token.text.endswith("ed"):
        return Kind.N  # "the rose", "the dove"
    return Kind.N if token.text in section("keep_adjectives") | {"left"} else Kind.ADJ


def _read_third_person(
    token: Token, previous: Token | None, following: Token | None, state: State, lexicon: Lexicon
) -> Kind:
    kind = previous.kind if previous else Kind.STOP
    if state.sub and state.nominal and kind in (Kind.N, Kind.PRON, Kind.REL, Kind.P, Kind.SUBJECT):
        return Kind.FINITE
    if kind is Kind.SUBJECT or (previous is not None and previous.text == "robot"):
        state.narrative = True
        return Kind.V
    if state.narrative and kind in (Kind.CC, Kind.COMMA) and not lexicon.is_noun(token.text):
        return Kind.V
    article = following is not None and following.kind in ARTICLES
    if kind is Kind.N and state.verb and not state.sub and not article:
        return Kind.N
    if kind in (Kind.N, Kind.PRON) and not lexicon.is_noun(token.text) and token.strength >= 2:
        return Kind.FINITE if article or token.strength == 3 or (previous and previous.kind is Kind.PRON) else Kind.N
    return Kind.N


def _read_base(
    token: Token,
    previous: Token | None,
    following: Token | None,
    state: State,
    lexicon: Lexicon,
    tokens: list[Token],
    at: int,
) -> Kind:
    kind = previous.kind if previous else Kind.STOP
    verb = Kind.V
    sure = token.strength
    adjective = token.text in section("drop_adjectives")
    nominal_next = following is not None and following.kind in (Kind.WORD, Kind.ADJ, Kind.NUM)
    nominal_next = nominal_next or (following is not None and following.text in ("one", "ones"))
    ends = kind in (Kind.N, Kind.PRON) and token.text not in section("nouns") | section("noun_verbs")
    noun = Kind.ADJ if adjective and (nominal_next or kind is Kind.AUX or ends) else Kind.N
    counted = following is not None and following.kind is Kind.NUM and sure > 1
    article = following is not None and (following.kind in ARTICLES or counted)
    if following is not None and following.text == "that" and kind in (Kind.N, Kind.DET):
        finite = next_token(tokens, at, 2)
        article = article and not (finite is not None and (finite.kind is Kind.AUX or finite.form in ("s", "ed")))
    opener = following is not None and (
        following.kind in OPENERS or (following.kind is Kind.WORD and following.strength < 2)
    )
    if kind in (Kind.SUBJECT, Kind.NEG) or (kind is Kind.TO and previous and previous.form == "inf"):
        return verb if sure else noun
    counting = previous is not None and (kind is Kind.NUM or previous.text in ("both", "all"))
    if counting and adjective and nominal_next:
        return noun  # "the two empty bottles"
    if kind is Kind.AUX:
        be = previous is not None and previous.text in section("be") | {"has", "have", "had"}
        return noun if be else verb
    if state.sub and state.nominal and kind in (Kind.N, Kind.PRON, Kind.REL):
        return Kind.FINITE if sure >= 2 or kind is not Kind.N else Kind.N
    if kind in (Kind.SUB, Kind.DET, Kind.REL) or (kind is Kind.ADJ and not _predicate(tokens, at)):
        return noun
    if kind in (Kind.FINITE, Kind.ING, Kind.PARTICIPLE, Kind.ADJ):
        return verb if sure >= 2 and (kind is not Kind.ING or sure == 3) else noun
    if kind in (Kind.LET,):
        return verb if sure >= 2 else noun
    if state.let and kind in (Kind.N, Kind.PRON, Kind.TO):
        person = previous is not None and previous.text in DATIVE
        return verb if person or (sure and not (opener and sure == 1)) else noun
    if sure >= 2 and helped(tokens, at):
        return verb
    if kind is Kind.V:
        serial = previous is not None and previous.stem in SERIAL and sure >= 2
        return verb if serial else noun
    if kind in _STARTS or previous is None:
        return _at_start(token, following, article, tokens, at, noun)
    if kind in (Kind.CC, Kind.COMMA):
        phrasal = following is not None and following.kind is Kind.P and lexicon.particle(token.stem, following.text)
        moved = next_token(tokens, at, 2) if following is not None and following.text in ("up", "down", "out") else None
        phrasal = phrasal or (moved is not None and moved.kind in ARTICLES)
        return verb if phrasal else _after_conjunction(token, following, article, opener, noun)
    if kind in (Kind.P, Kind.TO):
        return verb if sure == 3 and _after_particle(token, previous, article, tokens, at) else noun
    return _run_on(token, previous, following, article, opener, noun)


def _after_particle(token: Token, previous: Token | None, article: bool, tokens: list[Token], at: int) -> bool:
    """Tell whether a verb begins a clause behind a particle: "turn it on wait"."""
    if previous is None or previous.text not in section("particles") | {"inside", "outside"}:
        return False
    moved = tokens[at - 2] if at > 1 and tokens[at - 1] is previous else None
    pronoun = moved is not None and moved.kind is Kind.PRON
    return article or pronoun or (token.stem in section("intransitive") and moved is not None and moved.kind is Kind.N)


def _predicate(tokens: list[Token], at: int) -> bool:
    """Tell whether the adjective before ``at`` ends a predicate ("is full")."""
    for token in reversed(tokens[max(0, at - 4) : at]):
        if token.kind is Kind.AUX:
            return True
        if token.kind not in (Kind.ADJ, Kind.ADV):
            return False
    return False


def _at_start(token: Token, following: Token | None, article: bool, tokens: list[Token], at: int, noun: Kind) -> Kind:
    copula = following is not None and following.kind is Kind.AUX and following.text in section("be")
    if copula and token.strength < 3:
        return noun
    if token.strength >= 2:
        return Kind.V
    if following is None or following.kind in (Kind.STOP, Kind.P, Kind.MOD) or article:
        return Kind.V
    behind = tokens[at + 2] if at + 2 < len(tokens) else None
    counted = following.kind is Kind.NUM and behind is not None and (behind.kind is Kind.WORD or behind.text == "of")
    if counted or following.kind is Kind.TO:
        return Kind.V
    if following.kind in (Kind.WORD, Kind.ADJ):
        for later in tokens[at + 1 :]:
            if later.kind in (Kind.STOP, Kind.COMMA, Kind.CC):
                break
            if (later.strength >= 2 and later.form == "base") or later.kind is Kind.AUX:
                return noun
        return Kind.V
    return noun


def _after_conjunction(token: Token, following: Token | None, article: bool, opener: bool, noun: Kind) -> Kind:
    if token.strength == 3:
        return Kind.V
    if token.strength == 2:
        ends = following is None or following.kind in _CONTINUES
        return Kind.V if opener or ends else noun
    pronoun = following is not None and following.kind is Kind.PRON
    return Kind.V if article and (pronoun or token.strength == 1) else noun


def _run_on(
    token: Token,
    previous: Token | None,
    following: Token | None,
    article: bool,
    opener: bool,
    noun: Kind,
) -> Kind:
    """A verb right after an object, with no sign between: "open the oven put the pan inside"."""
    person = previous is not None and previous.text in DATIVE
    if article and not person:
        return Kind.V
    if token.strength == 3 and following is not None:
        moves = following.kind is Kind.TO and token.stem in section("intransitive")
        state = token.text in section("drop_adjectives") and following.kind is Kind.P
        timed = following.kind is Kind.MOD and following.form == "duration"
        if not state and (moves or timed or following.kind in (Kind.P, Kind.NUM, Kind.ADJ)):
            return Kind.V if not (previous is not None and previous.kind is Kind.PRON and person) else noun
        if following.kind is Kind.WORD:
            return Kind.V
    if token.strength >= 2 and previous is not None and previous.kind is Kind.PRON and not person and opener:
        return Kind.V
    return noun
