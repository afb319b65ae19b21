"""The words of a text before they have classes: forms that are read elsewhere, and what is no instruction at all."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

from tmd.language.folding import STATEMENT
from tmd.language.tagging import fold
from tmd.language.tokens import Kind, Token
from tmd.language.words import section

_MAY = frozenset({"can", "could", "may", "might", "should", "shall", "must", "would", "will"})
_NOTHING = {"any": "no", "anything": "nothing", "a": "no", "an": "no"}
_POSTURES = frozenset({"left", "lying", "standing", "sitting", "around", "about", "remaining"})
_BEFORE_THERE = frozenset({"in", "into", "on", "onto", "from", "under", "inside", "within"})
_SPEAKERS = frozenset({"i", "we"})
_WE_ARE = frozenset({"i'm", "im", "we're"})
_UNABLE = frozenset({"can't", "cannot", "couldn't", "didn't", "haven't"})
_STAYS = frozenset({"stays", "stay", "remains", "remain"})
_IS_BEFORE = frozenset(
    {"a", "an", "the", "not", "still", "too", "already", "open", "closed", "shut", "on", "off", "empty", "full"}
)
_BREAKS = (Kind.STOP, Kind.COMMA)
_JOINTS = frozenset({"and", "but", "then", "while"})


def rewrite_words(tokens: list[Token]) -> list[Token]:
    """Return the words of a text, which have no classes yet, with forms that are read elsewhere.

    * "Is the window open? If so, close it" as "if the window is open, close it";
    * "Could the lamp be turned off?" as "the lamp should be turned off";
    * "I don't want anything left on the table" as "there should be nothing on the table";
    * "the other one stays put" as "leave the other one alone";
    * "the lamp in there" as "the lamp in it";
    * "the books that are lying around on the table" as "the books on the table";
    * "I'm going to bake a cake", "Where did the mug go?" as statements.
    """
    tokens = _without_posture(_without_asides(_with_copulas(tokens)))
    starts = [0, *(i + 1 for i, t in enumerate(tokens) if t.kind is Kind.STOP)]
    if starts[-1] < len(tokens):
        starts.append(len(tokens))
    for start, end in reversed(list(pairwise(starts))):
        asked = _question(tokens, start, end)
        sentence = _of_oneself(_unwanted(_passive_question(tokens[start:end]))) if asked is None else None
        tokens = asked or [*tokens[:start], *(sentence or ()), *tokens[end:]]
    for before, token, after in zip(tokens, tokens[1:], [*tokens[2:], None], strict=False):
        copula = after is not None and after.text in section("be") | section("modals")
        if token.text == "there" and before.text in _BEFORE_THERE and not copula:
            token.text = "it"
    return _staying(tokens)


def _with_copulas(tokens: list[Token]) -> list[Token]:
    """Read "the bin's open", "the kettle's standing there" as "the bin is open": no owner stands before such words."""
    result: list[Token] = []
    for token, after in zip(tokens, [*tokens[1:], None], strict=True):
        stem = token.text.removesuffix("'s")
        follows = after.text if after is not None and after.kind is Kind.WORD else ""
        verbal = follows.endswith("ing") and follows not in section("nouns") | section("ing_modifiers")
        plain = stem != token.text and token.text not in section("be") | section("let_verbs") and stem != "let"
        if plain and (verbal or follows in _IS_BEFORE | section("prepositions")):
            cut = token.span.end - 2
            result.append(replace(token, text=stem, span=token.span._replace(end=cut)))
            result.append(Token(Kind.WORD, "is", token.span._replace(start=cut)))
        else:
            result.append(token)
    return result


def _without_asides(tokens: list[Token]) -> list[Token]:
    """Leave out "wherever they are", between commas."""
    result: list[Token] = []
    skipping = False
    for token in tokens:
        if token.text == "wherever":
            skipping = True
        if skipping and token.kind in _BREAKS:
            skipping = False
            if result and result[-1].kind is Kind.COMMA and token.kind is Kind.COMMA:
                continue
        if not skipping:
            result.append(token)
    return result


def _of_oneself(tokens: list[Token]) -> list[Token]:
    """Fold what speakers say of themselves, and what they ask: "I'm going to make pasta", "Where did the mug go?"."""
    words = [t.text for t in tokens]
    asks = words[:1] in (["where"], ["who"]) and words[-1][:1] == "?"
    start = 2 if words[:2] in (["i", "am"], ["we", "are"]) else 1 if words[:1] and words[0] in _WE_ARE else 0
    going = start and words[start : start + 2] in (["going", "to"], ["about", "to"])
    unable = len(words) > 1 and words[0] in _SPEAKERS and words[1] in _UNABLE
    if not (going or unable or asks):
        return tokens
    breaks = (i for i, t in enumerate(tokens) if t.kind in _BREAKS or t.text in ("so", "but"))
    end = len(tokens) - 1 if asks else next(breaks, len(tokens))
    said = fold(tokens[:end], Kind.SKIP, " ")
    said.note = STATEMENT
    said.inner = [t for t in said.inner if t.text not in ("go", "gone")]  # "where did the mug go": no "mug go"
    return [said, *tokens[end:]]


def _staying(tokens: list[Token]) -> list[Token]:
    """Read "the other one stays put", "the mug stays where it is" as "leave the other one alone"."""
    for at, token in enumerate(tokens):
        following = [t.text for t in tokens[at + 1 : at + 3]]
        put = following[:1] == ["put"] and (at + 2 == len(tokens) or tokens[at + 2].kind in _BREAKS)
        if token.text not in _STAYS or not (put or following in (["where", "it"], ["where", "they"], ["as", "it"])):
            continue
        begin = at
        while begin and tokens[begin - 1].kind not in _BREAKS and tokens[begin - 1].text not in _JOINTS:
            begin -= 1
        subject = tokens[begin:at]
        if not subject or any(t.text in section("modals") | {"you"} for t in subject):
            continue
        lead = replace(subject[0], text="leave", span=subject[0].span._replace(end=subject[0].span.start))
        behind = [replace(tokens[at + 1], text="alone"), *tokens[at + 2 :]] if put else tokens[at + 1 :]
        return [*tokens[:begin], lead, *subject, *_staying(behind)]
    return tokens


def _question(tokens: list[Token], start: int, end: int) -> list[Token] | None:
    """All the tokens, with the question from ``start`` to ``end`` as a condition of what follows."""
    following = [t.text for t in tokens[end : end + 2]]
    depends = following in (["if", "so"], ["if", "not"]) or following[:1] in (["then"], ["otherwise"])
    if tokens[end - 1].text[:1] != "?" or tokens[start].text not in ("is", "are") or not depends or end - start < 4:
        return None
    copula, *said = tokens[start : end - 1]
    cut = _complement(said)
    negated = following == ["if", "not"] or following[:1] == ["otherwise"]
    opener = Token(Kind.WORD, "unless" if negated else "if", copula.span)
    comma = Token(Kind.COMMA, ",", tokens[end - 1].span)
    spoken = end + (2 if following[0] == "if" else 1)
    if spoken < len(tokens) and tokens[spoken].kind is Kind.COMMA:
        spoken += 1
    return [*tokens[:start], opener, *said[:cut], copula, *said[cut:], comma, *tokens[spoken:]]


def _without_posture(tokens: list[Token]) -> list[Token]:
    """Leave out "that are lying around", and "lying" of "should be lying on": they say only that things are there."""
    result: list[Token] = []
    at = 0
    while at < len(tokens):
        words = [t.text for t in tokens[at : at + 3]]
        relative = words[:1] in (["that"], ["which"]) and words[1:2] in (["is"], ["are"])
        first = at + 2 if relative else at + 1
        end = first
        while (relative or words[0] == "be") and end < len(tokens) and tokens[end].text in _POSTURES:
            end += 1
        if end > first and not relative:
            result.append(tokens[at])
        at = end if end > first else at
        result += tokens[at : at + 1]
        at += 1
    return result


def _passive_question(tokens: list[Token]) -> list[Token]:
    """Read "could the lamp be turned off" as "the lamp should be turned off"."""
    be = next((i for i, t in enumerate(tokens) if t.text == "be"), 0)
    words = [t.text for t in tokens[:be]]
    if len(words) < 2 or words[0] not in _MAY or words[1] in ("there", "you"):
        return tokens
    tokens[0].text = "should"
    return [*tokens[1:be], tokens[0], *tokens[be:]]


def _unwanted(tokens: list[Token]) -> list[Token]:
    """Read "I don't want any cups left on the table" as "there should be no cups on the table"."""
    at = next((i for i, t in enumerate(tokens) if t.text == "want"), 0)
    negated = at and any(t.text in ("don't", "dont", "not", "never") for t in tokens[max(0, at - 2) : at])
    rest = tokens[at + 1 :]
    if rest and rest[0].text == "to" and len(rest) > 1 and rest[1].text in ("see", "find", "have"):
        rest = rest[2:]
    if not negated or not rest or rest[0].text not in _NOTHING or tokens[0].text not in _SPEAKERS:
        return tokens
    rest[0].text = _NOTHING[rest[0].text]
    place = next((i for i, t in enumerate(rest) if t.text in section("prepositions")), len(rest))
    rest = [*(t for t in rest[:place] if t.text not in _POSTURES), *rest[place:]]
    lead = [replace(tokens[min(i, at)], text=word) for i, word in enumerate(("there", "should", "be"))]
    return [*lead, *rest]


def _complement(tokens: list[Token]) -> int:
    """Return where the complement of a question begins: "there | any milk", "the mug | in the sink", "it | hot"."""
    if tokens[0].text == "there":
        return 1
    soft = next((i for i, t in enumerate(tokens) if i and t.text in ("still", "already", "really", "now")), None)
    if soft is not None:
        return soft
    places = [i for i, t in enumerate(tokens) if i and t.text in section("prepositions")]
    known = tokens[-1].text in section("keep_adjectives") | section("drop_adjectives") | section("adverbs")
    if places and not known and not tokens[-1].text.endswith(("ed", "ing")):
        return places[-1]
    return len(tokens) - 1
