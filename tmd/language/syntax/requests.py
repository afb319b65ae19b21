"""Requests that are no imperatives, as imperatives: wishes, statements of where things belong, bare noun phrases.

*I'd like a cup of tea* and *A cup of tea, please* become a clause with the verb ``have``; *The mug should go on the
shelf* and *Both wrappers belong in the bin* one with ``put``. The new verb stands where the words it replaces do.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

from tmd.language.lexicon.lexicon import section
from tmd.language.syntax.chunking import ALSO
from tmd.language.syntax.tokens import IMPLIED, Kind, Token

HAVE, PUT = "have", "put"
_WISHES = frozenset({"like", "love", "want", "wants", "prefer", "fancy", "fancies"})
_WISHED = _WISHES | {"need", "needs", "have", "get"}
_MAY = frozenset({"can", "could", "may", "might"})
_SPEAKERS = frozenset({"i", "we", "i'd", "we'd", "i'll", "we'll", "i'm", "we're", "me", "us"})
_NOUN_PHRASE = frozenset({Kind.DET, Kind.NUM, Kind.ADJ, Kind.N, Kind.PRON})
_BELONG = frozenset(
    {"go", "goes", "belong", "belongs", "live", "lives", "stand", "stands", "sit", "sits", "lie", "lies"}
)
_OUGHT = frozenset({"should", "must", "need", "needs", "ought", "has", "have", "like", "want"})
_DUTIES = frozenset(
    {"should", "must", "needs", "need", "ought", "has", "have", "can", "could", "to", "not", "all", "both"}
)
_SWITCHED = {
    "on": "turn_on", "off": "turn_off", "out": "turn_off", "up": "raise", "down": "lower", "open": "open",
    "closed": "close", "shut": "close", "in": "put_in",
}  # fmt: skip
"""The verbs for states that a noun alone is given: "lights out", "blinds down", "windows closed"."""
_SIDES = frozenset({"on", "off", "up", "down"})
_PLACING = frozenset({"in", "into", "on", "onto", "next_to", "on_top_of", "over", "beside", "under"})
_BREAKS = (Kind.COMMA, Kind.CC, Kind.STOP)
_THEY = frozenset({"they", "it", "these", "those"})
_INSIDE = frozenset({Kind.DET, Kind.NUM, Kind.ADJ, Kind.N, Kind.PRON, Kind.P, Kind.OF, Kind.CC, Kind.ADV})


def rewrite_requests(tokens: list[Token]) -> list[Token]:
    """Return the tokens with every such request as an imperative."""
    result: list[Token] = []
    sentence: list[Token] = []
    explains = False
    count = 1 + sum(t.kind is Kind.STOP and t is not tokens[-1] for t in tokens)
    for token in tokens:
        sentence.append(token)
        if token.kind is Kind.STOP:
            result += _sentence(sentence, 1 if explains else count)
            sentence, explains = [], token.text == ":"
    return result + _sentence(sentence, 1 if explains else count)


def _sentence(tokens: list[Token], count: int) -> list[Token]:
    """One sentence: each request in it, cut at commas and conjunctions before a new subject."""
    for before, token in pairwise(tokens):
        if token.text in ("one", "ones") and token.kind is Kind.NUM and before.kind in (Kind.DET, Kind.ADJ):
            token.kind = Kind.PRON  # "the other one should be on"
    if not any(t.kind in (Kind.N, Kind.PRON) for t in tokens):
        return tokens
    rewritten = _belonging(_there(_wish(_telegram(tokens))))
    return _bare(rewritten, alone=count == 1)


def _telegram(tokens: list[Token]) -> list[Token]:
    """Give a verb to each part of a list that has none: "TV on, lamps off", "shut the fridge, game in the cupboard"."""
    result: list[Token] = []
    part: list[Token] = []
    spoken = any(t.kind in (Kind.V, Kind.AUX, Kind.LET, Kind.NEG) for t in tokens)
    for token in [*tokens, None]:
        names = all(t.kind in (*_NOUN_PHRASE, Kind.CC) for t in part) or _accompanied(part)
        if token is not None and (token.kind not in _BREAKS or (token.kind is Kind.CC and part and names)):
            part.append(token)
            continue
        verb = _unspoken(part)
        after = result[-1] if result else token
        listed = after is not None and after.kind is Kind.COMMA
        plain = part[:1] != [] and part[0].kind not in (Kind.DET, Kind.NUM) and not _goes_on_listing(result, part)
        again = len(result) > 1 and {result[-1].text, result[-2].text} & _SIDES  # "the tv on and the lamp off"
        fronted = not result and token is not None and any(t.text in ("into", "onto") for t in part)
        state = verb is not None and verb.stem in _SWITCHED.values() and not result and not spoken
        if verb is not None and ((plain and (listed or not spoken)) or again or fronted or state):
            part = [verb, *(t for t in part if t.span != verb.span)]
        result += part if token is None else [*part, token]
        part = []
    return result


def _goes_on_listing(result: list[Token], part: list[Token]) -> bool:
    """Whether a part ends a list: "put the plates, cups and spoons *in the box*", and not "…, lamp in the box"."""
    before = result[:-1]
    start = max((i + 1 for i, t in enumerate(before) if t.kind in (Kind.COMMA, Kind.STOP)), default=0)
    verb = next((t for t in before[start:] if t.kind is Kind.V), None)
    places = any(t.kind in (Kind.P, Kind.TO) for t in before[start:])
    joined = any(t.kind is Kind.CC for t in part)
    listed = joined or (verb is not None and verb.stem in section("placing") | section("moving"))
    return listed and not places and (verb is not None or len(before) > 0)


def _accompanied(part: list[Token]) -> bool:
    """Whether what follows an *and* belongs to what something comes with: "coffee with milk *and* sugar in a mug"."""
    return next((t.text for t in reversed(part) if t.kind in (Kind.P, Kind.OF)), "") in ("with", "without")


def _unspoken(part: list[Token]) -> Token | None:
    """Return the verb that a part of a list leaves out: a noun and *on* or *off*, or a bare noun and a place."""
    words = [t for t in part if t.kind not in (Kind.FILLER, Kind.ADV) or t.text in _SWITCHED]
    nouns = 0
    while nouns < len(words) and words[nouns].kind in (*_NOUN_PHRASE, Kind.CC) and words[nouns].text not in _SWITCHED:
        nouns += 1
    rest = words[nouns:]
    if not nouns or not rest or words[nouns - 1].kind not in (Kind.N, Kind.PRON):
        return None
    particles = nouns == 1 or rest[0].text in _SIDES
    alone = len(rest) == 1 or rest[1].text in ("except", "but")  # "every lamp off except the red one"
    if alone and rest[0].text in _SWITCHED and particles:
        verb = _verb(_SWITCHED[rest[0].text], rest[0])
        verb.form = "base"
        return verb
    kinds = (*_NOUN_PHRASE, Kind.P) if rest[0].text in ("into", "onto") else _NOUN_PHRASE
    place = rest[0].kind is Kind.P and len(rest) > 1 and all(t.kind in kinds for t in rest[1:])
    if place and rest[0].text in _PLACING:
        verb = _verb(HAVE, words[0])
        verb.span = words[0].span._replace(end=words[0].span.start)
        return verb
    return None


def _verb(stem: str, *sources: Token) -> Token:
    first, *rest = (t.span for t in sources)
    return Token(Kind.V, stem, first, stem=stem, form=IMPLIED, strength=3, parts=list(rest))


def _wish(tokens: list[Token]) -> list[Token]:
    """Read "I'd like some tea", "Grandma would like some tea", "can I have some tea" as "have some tea"."""
    for cut in range(len(tokens) - 2, 0, -1):  # "open the door, but I'd like the window shut"
        joint = tokens[cut - 1].kind in (Kind.CC, Kind.COMMA)
        wished = tokens[cut].text in _SPEAKERS and any(t.kind in (Kind.V, Kind.LET) for t in tokens[:cut])
        asked = tokens[cut].text in _MAY and tokens[cut + 1].text in _SPEAKERS  # "tea is fine, can I have one?"
        if joint and (wished or asked):
            return [*_wish(tokens[:cut]), *_wish(tokens[cut:])]
    for at, token in enumerate(tokens):
        if token.text not in _WISHED or not _names_thing(tokens, at + 1):
            continue
        lead = [t for t in tokens[:at] if t.kind not in (Kind.ADV, Kind.FILLER)]
        if not lead:
            continue
        words = [t.text for t in lead]
        would = any(w in ("would", "'d") or w.endswith("'d") for w in words)
        somebody = all(t.kind in (*_NOUN_PHRASE, Kind.SUBJECT, Kind.AUX, Kind.P) for t in lead)
        asks = words[0] in _MAY and any(w in _SPEAKERS for w in words[1:]) and token.text in ("have", "get")
        wish = token.text in _WISHES and (would or any(w in _SPEAKERS for w in words) or token.text.endswith("s"))
        need = token.text in ("need", "needs") and words[-1] in _SPEAKERS
        if asks or ((wish or need) and somebody and not any(t.kind is Kind.V for t in lead)):
            later = next(
                (i for i in range(at + 1, len(tokens) - 1) if tokens[i].kind is Kind.TO and tokens[i + 1].text == "be"),
                None,
            )
            if later is not None:
                for lead_token in tokens[: at + 1]:
                    lead_token.kind = Kind.FILLER
                shall = Token(Kind.AUX, "should", tokens[later].span)
                return [*tokens[: at + 1], *tokens[at + 1 : later], shall, *tokens[later + 1 :]]
            where = _fronted(tokens, at)
            end = len(tokens) - 1 if tokens[-1].kind is Kind.STOP else len(tokens)
            rest = [*tokens[at + 1 : end], *tokens[:where], *tokens[end:]]
            return [_verb(HAVE, token, *tokens[where:at]), *rest]
    return tokens


def _fronted(tokens: list[Token], at: int) -> int:
    """Return where the place ends that a wish begins with: "in the mug | I'd like milk"."""
    if tokens[0].kind is not Kind.P:
        return 0
    end = next((i for i in range(1, at) if tokens[i].kind not in _NOUN_PHRASE), 0)
    speaker = next((i for i in range(1, at) if tokens[i].text in _SPEAKERS), 0)
    return min(end or at, speaker or at)


def _names_thing(tokens: list[Token], at: int) -> bool:
    """Tell whether a noun phrase begins here that is no subject of a verb: "you to go"."""
    while at < len(tokens) and tokens[at].kind is Kind.ADV:
        at += 1
    if (
        at >= len(tokens)
        or tokens[at].kind not in _NOUN_PHRASE
        or tokens[at].text in ("you", "him", "her", "them", "it")
    ):
        return False
    end = at
    while end < len(tokens) and tokens[end].kind in _NOUN_PHRASE:
        end += 1
    nouns = any(t.kind is Kind.N or t.text in ("something", "anything", "one") for t in tokens[at:end])
    return nouns and not (
        end < len(tokens)
        and tokens[end].kind is Kind.TO
        and tokens[end].form == "inf"
        and any(t.text in ("something", "anything") for t in tokens[at:end])
    )


def _there(tokens: list[Token]) -> list[Token]:
    """Read "there should be water in the glass" as a state that is asked for."""
    words = [t.text for t in tokens]
    for at in range(len(tokens) - 3):
        if words[at] == "there" and words[at + 1] in ("should", "must") and words[at + 2] == "be":
            verb = _verb("be", *tokens[at : at + 3])
            verb.form = "base"
            return [*tokens[:at], verb, *tokens[at + 3 :]]
    return tokens


def _belonging(tokens: list[Token]) -> list[Token]:
    """Read "the mug should go on the shelf", "both books belong on it" as "put the mug on the shelf"."""
    for at, token in enumerate(tokens):
        be = token.text == "be" and any(t.text in _OUGHT for t in tokens[max(0, at - 4) : at])
        if not (token.text in _BELONG or be) or at + 1 >= len(tokens):
            continue
        place = at + 1
        while place < len(tokens) and tokens[place].kind is Kind.ADV and tokens[place].text not in ("back", "away"):
            place += 1
        goes = place < len(tokens) and (
            tokens[place].kind in (Kind.P, Kind.TO) or tokens[place].text in ("back", "away", "where")
        )
        switch = (
            be and place < len(tokens) and tokens[place].text in ("on", "off") and not _names_thing(tokens, place + 1)
        )
        state = (
            be
            and place < len(tokens)
            and tokens[place].kind is Kind.ADJ
            and tokens[place].form != "ed"
            and tokens[place].stem not in section("verbs")
        )
        ends = place + 1 >= len(tokens) or tokens[place + 1].kind in _BREAKS
        hung = be and ends and place < len(tokens) and tokens[place].text in ("up", "down")  # "the blinds should be up"
        if not (goes or state) or switch:
            continue
        begin = _subject_start(tokens, at)
        if begin is None:
            continue
        duties = [t for t in tokens[begin:at] if t.text in _DUTIES and t.kind not in (Kind.DET, Kind.N)]
        subject = [t for t in tokens[begin:at] if t not in duties]
        if not duties and token.text in ("stands", "sits", "lies", "stand", "sit", "lie"):
            continue  # "the cup that stands there" states something
        subject = [replace(t, kind=Kind.PRON) if t.text in _THEY else t for t in subject]
        bare = token.text in ("go", "live") and not duties
        plural = any(t.text.endswith("s") or t.kind is Kind.PRON or t.kind is Kind.CC for t in subject)
        if any(t.kind in (Kind.N, Kind.PRON) for t in subject) and (not bare or plural) and not _negated(duties):
            to = tokens[place].kind is Kind.TO  # "the letters have to go to Ann"
            none = subject[0].text in ("no", "nothing", "none")  # "no cups should be on the table"
            placed = _SWITCHED[tokens[place].text] if hung else PUT
            verb = _verb("be" if state or none else "bring" if to else placed, token, *duties)
            verb.parts += [tokens[place].span] * hung
            verb.form = "base"
            if state:
                verb.lead = [tokens[place].text]
            if any(t.kind is Kind.P for t in subject):
                tokens[place].form = ALSO  # said of what the sentence is about, not of the noun before it
            return [*tokens[:begin], verb, *subject, *_belonging(tokens[(place if hung else at) + 1 :])]
    return tokens


def _negated(duties: list[Token]) -> bool:
    return any(t.kind is Kind.NEG or t.text.endswith("n't") for t in duties)


def _subject_start(tokens: list[Token], at: int) -> int | None:
    """Return where the noun phrase that a verb is said of begins; ``None`` where an instruction comes before it."""
    begin = at
    while begin > 0:
        token = tokens[begin - 1]
        apart = token.kind is Kind.CC and begin > 1 and tokens[begin - 2].kind is Kind.COMMA
        if apart and not any(t.kind is Kind.COMMA for t in tokens[: begin - 2]):
            return begin  # "a tea for me, and the kettle should go back": no list of three
        duty = token.kind in (Kind.AUX, Kind.TO) or token.text in _DUTIES
        listed = token.kind is Kind.COMMA and all(t.kind in _INSIDE | {Kind.COMMA} for t in tokens[:begin])
        if not duty and not listed and token.kind not in _INSIDE | {Kind.SUBJECT, Kind.PARTICIPLE, Kind.REL, Kind.ING}:
            break
        begin -= 1
    if tokens[begin].kind is Kind.P:
        # "… on the table, the toy goes in the drawer": the place belongs to what stands before it
        begin = next((i for i in range(begin, at) if tokens[i].kind in (Kind.COMMA, Kind.CC)), at)
        begin += begin < at and tokens[begin].kind is Kind.COMMA
    while begin < at and tokens[begin].kind in (Kind.CC, Kind.ADV):
        begin += 1
    if begin > 0 and tokens[begin - 1].kind not in (*_BREAKS, Kind.MOD, Kind.FILLER, Kind.ADV):
        return None
    return begin if begin < at else None


def _goes_on(token: Token, rest: list[Token]) -> bool:
    """Tell whether an instruction of its own follows a comma or a conjunction."""
    ahead = next((t for t in rest if t.kind not in (Kind.CC, Kind.ADV, Kind.FILLER)), None)
    links = token.kind in (Kind.COMMA, Kind.CC)
    return links and ahead is not None and ahead.kind in (Kind.V, Kind.LET, Kind.NEG, Kind.SUBJECT, Kind.ENSURE)


def _bare(tokens: list[Token], *, alone: bool) -> list[Token]:
    """Read "Two scoops of ice cream, please." as "have two scoops of ice cream"."""
    subordinate = next((i for i, t in enumerate(tokens) if t.kind is Kind.SUB), len(tokens))
    if subordinate < len(tokens) and any(t.kind is Kind.N for t in tokens[:subordinate]):
        head = _bare(tokens[:subordinate], alone=alone)
        return [*head, *tokens[subordinate:]]
    cut = next((i for i, t in enumerate(tokens[:-1]) if _goes_on(t, tokens[i + 1 :])), None)
    if cut is not None and any(t.kind is Kind.N for t in tokens[:cut]):
        head = _bare(tokens[:cut], alone=False)
        return [*head, *tokens[cut:]]
    spoken = {Kind.V, Kind.AUX, Kind.FINITE, Kind.LET, Kind.ENSURE, Kind.NEG, Kind.SUB, Kind.TO, Kind.SUBJECT, Kind.ING}
    if any(t.kind in spoken for t in tokens):
        return tokens
    first = next((i for i, t in enumerate(tokens) if t.kind in (*_NOUN_PHRASE, Kind.REL)), None)
    if first is None or not any(t.kind is Kind.N and not t.text.isdigit() for t in tokens):
        return tokens
    ahead = [t for t in tokens[:first] if t.kind is not Kind.ADV and t.kind is not Kind.FILLER]
    polite = any(t.text in ("please", "pls", "plz") for t in tokens)
    counted = tokens[first].kind is Kind.NUM or (
        tokens[first].kind is Kind.DET and tokens[first].text in ("a", "an", "some")
    )
    if ahead or not (polite or counted or (alone and len(tokens) > 1)):
        return tokens
    place = tokens[first]
    verb = Token(Kind.V, HAVE, place.span._replace(end=place.span.start), stem=HAVE, form=IMPLIED, strength=3)
    return [*tokens[:first], verb, *tokens[first:]]
