"""What is used for something, and what is not, in plain words: *use the pot to boil water*, *the cup, not the mug*."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from tmd.language.lexicon.lexicon import builtin, section
from tmd.language.syntax.idioms import BREAKS, JOINTS, Idiom
from tmd.language.syntax.tokens import Kind, Token

_OTHERWISE = (("not",), ("and", "not"), ("but", "not"), ("instead", "of"), ("rather", "than"))
"""What stands between the thing that is meant and the one that is not."""
_DETERMINERS = section("determiners") - {"no", "what", "which", "whichever", "whatever", "every", "any"}
_ENDS = section("prepositions") | section("be") | section("modals") | JOINTS | {"to", "not"}
"""Words that belong to no noun phrase."""
_WITHOUT = ("do", "not")


def _used_for(sentence: list[Token]) -> list[Token]:
    """Read "use the pot, not the kettle, to boil water" as "use the pot to boil water" and "do not use the kettle".

    And "don't use the stove to heat the milk" as "do not use the stove": nothing is asked for.
    """
    words = [t.text for t in sentence]
    for at, word in enumerate(words):
        end = _phrase(sentence, at + 1) if word == "use" and _begins(sentence, at) else None
        if end is None:
            continue
        thing, other, end = sentence[at + 1 : end], *_contrasted_with(sentence, end)
        verb = builtin().verb(words[end + 1]) if words[end : end + 1] == ["to"] and end + 1 < len(words) else None
        if verb is None or verb[1] != "base":
            continue
        if not _is_forbidden(words[:at]):
            rest, stop = _apart(sentence[end:])
            negated = _not_using(other, sentence[at], stop)
            return [*sentence[: at + 1], *thing, *rest, *negated, *stop] if other else sentence
        done = sentence[end:]
        until = next((i for i, t in enumerate(done) if t.kind in BREAKS or t.text in JOINTS), len(done))
        after = next((i for i in range(until, len(done)) if done[i].kind not in BREAKS and done[i].text != "but"), None)
        if after is not None and done[after].text == "use":  # "…, use the microwave": for the same
            rest, stop = _apart(done[after:])
            rest = rest[:-1] if rest[-1].text == "instead" else rest
            begun = _begun(sentence[: _start(sentence, at)])
            return [*begun, *rest, *done[:until], *_not_using(thing, sentence[at], stop), *stop]
        return [*sentence[: at + 1], *thing, *done[until:]]
    return sentence


def _contrasted(sentence: list[Token]) -> list[Token]:
    """Read "put the cup, not the mug, on the table" as "put the cup on the table" and "do not put the mug on it".

    What is used is an instrument all along: "boil water using the pot, not the kettle" is not using the kettle.
    """
    words = [t.text for t in sentence]
    for at in range(2, len(words) - 2):
        if words[at] != "not" or words[at + 1] not in _DETERMINERS:
            continue
        end = _phrase(sentence, at + 1)
        before = at
        while before and (sentence[before - 1].kind is Kind.COMMA or words[before - 1] in ("and", "but")):
            before -= 1
        begin = _determiner(sentence, before)
        if end is None or begin is None:
            continue
        after = end + 1 if end < len(words) and sentence[end].kind is Kind.COMMA and before < at else end
        start = _clause(sentence, begin)
        if start is None:
            continue
        rest, stop = _apart(sentence[after:])
        other = sentence[at + 1 : end]
        if other[-1].text == "one":  # "the red cup, not the blue one"
            other = [*other[:-1], sentence[before - 1]]
        said = [*sentence[:before], *rest]
        if words[begin - 1] in ("using", "with"):
            return [*said, *_not_using(other, sentence[start], stop), *stop]
        own = next((i for i, t in enumerate(rest) if t.kind in BREAKS or t.text in JOINTS), len(rest))
        forbidden = [*sentence[start:begin], *other, *rest[:own]]
        return [*said, *_negated(forbidden, stop), *stop]
    return sentence


def _with_neither(sentence: list[Token]) -> list[Token]:
    """Read "with neither the stove nor the microwave" as "without the stove or the microwave"."""
    words = [t.text for t in sentence]
    for at in range(len(words) - 2):
        if words[at : at + 2] == ["with", "neither"] and "nor" in words[at + 3 :]:
            rest = [replace(t, text="or") if t.text == "nor" else t for t in sentence[at + 2 :]]
            return [*sentence[:at], replace(sentence[at], text="without"), *rest]
    return sentence


def _only(sentence: list[Token]) -> list[Token]:
    """Read "don't put sugar in the coffee, just milk" as "put milk in the coffee" and "do not put sugar in it"."""
    words = [t.text for t in sentence]
    for at in range(3, len(words) - 1):
        if words[at] not in ("just", "only") or sentence[at - 1].kind is not Kind.COMMA:
            continue
        end = _phrase(sentence, at + 1)
        verb = next((i for i in range(at) if _is_forbidden(words[:i]) and builtin().verb(words[i])), None)
        if verb is None or end is None or (end < len(words) and sentence[end].kind not in BREAKS):
            continue
        own = _phrase(sentence, verb + 1)
        if own is None or own > at - 1:
            continue
        begin = verb - (2 if words[verb - 2 : verb] == ["do", "not"] else 1)
        rest, stop = _apart(sentence[end:])
        place = sentence[own : at - 1]
        said = [*sentence[:begin], sentence[verb], *sentence[at + 1 : end], *place, *rest]
        return [*said, *_negated([sentence[verb], *sentence[verb + 1 : own], *place], stop), *stop]
    return sentence


def _begins(sentence: Sequence[Token], at: int) -> bool:
    """Whether a clause begins with the verb at ``at``."""
    before = sentence[at - 1].text if at else "please"
    free = before in JOINTS | {"please", "not", "don't", "never", "then", "can", "could", "to", "should", "you"}
    return free or sentence[at - 1].kind in BREAKS


def _is_forbidden(words: Sequence[str]) -> bool:
    return bool(words) and words[-1] in ("not", "don't", "never", "dont")


def _start(sentence: Sequence[Token], at: int) -> int:
    """Where the words begin that ask for the verb at ``at``: "please do not", "you should"."""
    while at and sentence[at - 1].kind not in BREAKS and sentence[at - 1].text not in JOINTS:
        at -= 1
    return at


def _begun(tokens: Sequence[Token]) -> list[Token]:
    """What was said before, as a sentence of its own."""
    kept = list(tokens)
    while kept and (kept[-1].kind is Kind.COMMA or kept[-1].text in ("and", "but", "then")):
        last = kept.pop()
        if kept and kept[-1].kind is not Kind.COMMA and kept[-1].text not in ("and", "but", "then"):
            return [*kept, replace(last, kind=Kind.STOP, text=".")]
    return kept


def _phrase(sentence: Sequence[Token], at: int) -> int | None:
    """Where the noun phrase ends that begins at ``at``; ``None`` where none does."""
    end = at
    while end < len(sentence) and sentence[end].kind not in BREAKS and sentence[end].text not in _ENDS:
        joined = end > at and sentence[end - 1].text == "or"  # "the stove or the microwave"
        if end > at and not joined and sentence[end].text in _DETERMINERS | {"instead", "rather"}:
            break
        end += 1
    return end if at < len(sentence) and end > at + (sentence[at].text in _DETERMINERS) else None


def _determiner(sentence: Sequence[Token], end: int) -> int | None:
    """Where the noun phrase begins that ends at ``end``, with its determiner."""
    for at in range(end - 1, 0, -1):
        if sentence[at].kind in BREAKS or sentence[at].text in _ENDS:
            return None
        if sentence[at].text in _DETERMINERS:
            return at if at < end - 1 else None
    return None


def _clause(sentence: Sequence[Token], at: int) -> int | None:
    """Where the verb is of the clause that a word belongs to."""
    for start in range(at - 1, -1, -1):
        verb = builtin().verb(sentence[start].text)
        if sentence[start].kind in BREAKS:
            return None
        if verb is not None and verb[1] == "base" and verb[2] > 1 and sentence[start].text not in _ENDS:
            return start
    return None


def _contrasted_with(sentence: Sequence[Token], at: int) -> tuple[list[Token], int]:
    """The noun phrase that is not meant, and where what was said of it ends."""
    begin = at + 1 if at < len(sentence) and sentence[at].kind is Kind.COMMA else at
    for lead in _OTHERWISE:
        if tuple(t.text for t in sentence[begin : begin + len(lead)]) == lead:
            end = _phrase(sentence, begin + len(lead))
            if end is not None:
                comma = end < len(sentence) and sentence[end].kind is Kind.COMMA
                return list(sentence[begin + len(lead) : end]), end + comma
    return [], at


def _apart(tokens: Sequence[Token]) -> tuple[list[Token], list[Token]]:
    """The words of a sentence, and the sign behind it."""
    ends = bool(tokens) and tokens[-1].kind is Kind.STOP
    return (list(tokens[:-1]), [tokens[-1]]) if ends else (list(tokens), [])


def _not_using(thing: Sequence[Token], like: Token, stop: Sequence[Token]) -> list[Token]:
    return _negated([replace(like, text="use"), *thing], stop) if thing else []


def _negated(clause: Sequence[Token], stop: Sequence[Token]) -> list[Token]:
    """A sentence that forbids what a clause says."""
    end = stop[0] if stop else clause[-1]
    return [replace(end, kind=Kind.STOP, text="."), *(replace(clause[0], text=word) for word in _WITHOUT), *clause]


CONTRASTS = (
    Idiom(_used_for, frozenset({"use"})),
    Idiom(_contrasted, frozenset({"not"})),
    Idiom(_with_neither, frozenset({"neither"})),
    Idiom(_only, frozenset({"just", "only"})),
)
"""What is done with each sentence, in this order."""
