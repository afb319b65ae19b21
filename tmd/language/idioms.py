"""Turns of phrase in plain words: *the floor needs sweeping*, *how about a tea*, *in with the keys*."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from tmd.language.lexicon import builtin
from tmd.language.tokens import Kind, Token
from tmd.language.words import section

SPEAKERS = frozenset({"i", "we"})
_PUTTING = frozenset({"put", "place", "pop", "stick", "go", "goes", "belong", "belongs"})
PRONOUNS = frozenset({"it", "they", "them", "you", "i", "we", "he", "she", "this", "that", "there"})
BREAKS = (Kind.STOP, Kind.COMMA)
JOINTS = frozenset({"and", "but", "then", "while"})


def _none_of(tokens: list[Token]) -> list[Token]:
    """Read "none of the lamps should be on" as "no lamps should be on"."""
    if [t.text for t in tokens[:2]] != ["none", "of"]:
        return tokens
    determined = tokens[2:3] != [] and tokens[2].text in section("determiners")
    return [replace(tokens[0], text="no"), *tokens[3 if determined else 2 :]]


def _but_there(tokens: list[Token]) -> list[Token]:
    """Read "…, but leave the blanket there" as "leave the blanket alone": it is there already."""
    words = [t.text for t in tokens]
    for at in range(len(words) - 3):
        if words[at : at + 2] != ["but", "leave"] or words[at + 2] in PRONOUNS:
            continue
        ends = (i for i in range(at + 2, len(words)) if tokens[i].kind in BREAKS or words[i] in JOINTS)
        end = next(ends, len(words))
        if words[end - 1] == "there":
            return [*tokens[: end - 1], replace(tokens[end - 1], text="alone"), *tokens[end:]]
    return tokens


def _in_with(tokens: list[Token]) -> list[Token]:
    """Read "put the pen in with the keys" as "put the pen where the keys are"."""
    words = [t.text for t in tokens]
    for at in range(2, len(words) - 2):
        if words[at : at + 2] != ["in", "with"] or not _PUTTING.intersection(words[:at]):
            continue
        ends = (i for i in range(at + 3, len(words)) if tokens[i].kind in BREAKS or words[i] in JOINTS)
        end = next(ends, len(words))
        where = replace(tokens[at], text="where", span=tokens[at].span._replace(end=tokens[at + 1].span.end))
        copula = replace(tokens[end - 1], text="is", span=tokens[end - 1].span._replace(start=tokens[end - 1].span.end))
        return [*tokens[:at], where, *tokens[at + 2 : end], copula, *tokens[end:]]
    return tokens


def _needing(tokens: list[Token]) -> list[Token]:
    """Read "the floor needs sweeping" as "sweep the floor"."""
    for at in range(1, len(tokens) - 1):
        done = builtin().verb(tokens[at + 1].text)
        if tokens[at].text not in ("needs", "need") or done is None or done[1] != "ing":
            continue
        begin = at
        while begin and tokens[begin - 1].kind not in BREAKS and tokens[begin - 1].text not in ("but", "so", "then"):
            begin -= 1
        begin += tokens[begin].text == "and"
        subject = tokens[begin:at]
        if subject and not {t.text for t in subject} & {*SPEAKERS, "you", "that", "which", "if", "when"}:
            return [*tokens[:begin], replace(tokens[at + 1], text=done[0]), *subject, *_needing(tokens[at + 2 :])]
    return tokens


def _not_done_yet(tokens: list[Token]) -> list[Token]:
    """Read "that hasn't been steamed" as "that isn't steamed"."""
    words = [t.text for t in tokens]
    for at in range(1, len(words) - 2):
        short = words[at] in ("hasn't", "haven't") and words[at + 1] == "been"
        full = words[at] in ("has", "have") and words[at + 1 : at + 3] == ["not", "been"]
        if words[at - 1] in ("that", "which") and (short or full):
            isnt = replace(tokens[at], text="isn't" if words[at].startswith("has") else "aren't")
            return [*tokens[:at], isnt, *_not_done_yet(tokens[at + (2 if short else 3) :])]
    return tokens


def _could_do_with(tokens: list[Token]) -> list[Token]:
    """Read "I could do with a tea", "how about a tea" as "I would like a tea"."""
    if [t.text for t in tokens[:2]] in (["how", "about"], ["what", "about"]) and len(tokens) > 2:
        lead = [replace(tokens[0], text="i"), replace(tokens[0], text="would"), replace(tokens[1], text="like")]
        return [*lead, *tokens[2:]]
    for at in range(1, len(tokens) - 3):
        if [t.text for t in tokens[at : at + 3]] == ["could", "do", "with"] and tokens[at - 1].text in SPEAKERS:
            would, like = replace(tokens[at], text="would"), replace(tokens[at + 1], text="like")
            return [*tokens[:at], would, like, *tokens[at + 3 :]]
    return tokens


IDIOMS: tuple[Callable[[list[Token]], list[Token]], ...] = (
    _none_of,
    _in_with,
    _but_there,
    _needing,
    _not_done_yet,
    _could_do_with,
)
"""What is done with each sentence, in this order."""
