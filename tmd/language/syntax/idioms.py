"""Turns of phrase in plain words: *the floor needs sweeping*, *how about a tea*, *in with the keys*."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

from tmd.language.lexicon.lexicon import builtin, section
from tmd.language.syntax.attachment import is_number
from tmd.language.syntax.tokens import Kind, Token

SPEAKERS = frozenset({"i", "we"})
_PUTTING = frozenset({"put", "place", "pop", "stick", "go", "goes", "belong", "belongs"})
PRONOUNS = frozenset({"it", "they", "them", "you", "i", "we", "he", "she", "this", "that", "there"})
_DUTIES = frozenset({"should", "must", "has", "have", "needs", "need", "ought"})
BREAKS = (Kind.STOP, Kind.COMMA)
_TAGS = frozenset(
    {"however", "though", "thanks", "thank you", "cheers", "will you", "would you", "could you", "can you", "won't you",
     "if you would", "if you please", "if you don't mind", "the pair of them", "both of them", "the two of them",
     "all of them", "the lot", "all of it", "at the end", "in the end"}
)  # fmt: skip
"""What may stand between commas, or at the end, and adds nothing to what shall be done."""
_TAG_OPENERS = frozenset(tag.split()[0] for tag in _TAGS)
_FORBIDDING = {
    "refrain from": "ing", "stop": "ing", "quit": "ing", "no": "ing",
    "under no circumstances": "base", "on no account": "base", "at no time": "base",
}  # fmt: skip
"""What forbids the verb behind it, and the form of that."""
_WOULD = frozenset({"would", "could", "can", "do"})
_LIMITS = frozenset({"not more than", "no more than", "at most"})
_KEEPING = frozenset(
    {"leave", "keep", "leaving", "keeping", "with", "find", "if", "when", "once", "until", "unless", "while"}
)
"""Words after which a noun and a state are no end that is asked for."""
_LYING = frozenset({"lying", "standing", "sitting"})
_STATES = frozenset({"open", "closed", "shut", "empty", "full", "idle"})
_LEVELS = {"low": "low", "medium": "medium", "high": "high", "full": "high", "maximum": "high"}
_SWITCHING = frozenset({"switch", "turn", "set"})
_DEFINITE = frozenset({"the", "this", "that", "these", "those", "my", "both", "all"})
_PREPARING = frozenset({"make", "fix", "prepare", "serve", "pour", "fill", "me", "us", "like", "want", "need", "have"})
_ADJECTIVES = section("keep_adjectives") | section("drop_adjectives")
_WHATEVER = frozenset({"whatever", "everything that", "anything that"})
_ENDING = _STATES | {"on", "off"}
_STAYING = frozenset({"stays", "stay", "remains"})
_GOING = frozenset({"goes", "go", "belongs", "belong", "should", "must", "stays", "stay"})
_ANOTHER = ("in", "another", "one")
_AT = frozenset({"on", "at", "over", "with"})
_LIMIT = frozenset({"goes", "go", "gets", "get", "can", "will"})
_OMITTING = frozenset({"omit", "skip"})
_CLOSING = {"closed": "close", "shut": "shut", "open": "open"}
_AFTERWARDS = frozenset(
    {"again", "afterwards", "after", "that", "this", "too", "as", "well", "please", "then", "finally"}
)
_ORDINALS = frozenset({"first", "second", "third", "fourth", "fifth", "last"})
_COPULAS = frozenset({"is", "are", "was", "lies", "stands", "sits", "remains", "has"})
JOINTS = frozenset({"and", "but", "then", "while"})

_BEHIND = section("prepositions") | JOINTS
"""Words with which a noun phrase is over."""


def _none_of(tokens: list[Token]) -> list[Token]:
    """Read "none of the lamps should be on" as "no lamps should be on"."""
    at = next((i for i in range(len(tokens) - 2) if [t.text for t in tokens[i : i + 2]] == ["none", "of"]), None)
    if at is None:
        return tokens
    determined = tokens[at + 2].text in section("determiners")
    return [*tokens[:at], replace(tokens[at], text="no"), *tokens[at + (3 if determined else 2) :]]


def _neither(tokens: list[Token]) -> list[Token]:
    """Read "use neither the knife nor the fork" as "do not use the knife or the fork"."""
    words = [t.text for t in tokens]
    for at in range(1, len(words) - 3):
        verb = builtin().verb(words[at - 1])
        if words[at] == "neither" and "nor" in words[at:] and verb is not None and verb[1] == "base":
            lead = [replace(tokens[at - 1], text=word) for word in ("do", "not")]
            rest = [replace(t, text="or") if t.text == "nor" else t for t in tokens[at + 1 :]]
            return [*tokens[: at - 1], *lead, tokens[at - 1], *rest]
    return tokens


def _forbidden(tokens: list[Token]) -> list[Token]:
    """Read "refrain from touching it", "stop touching it", "no touching", "hands off it" as "do not touch it"."""
    words = [t.text for t in tokens]
    for at in range(len(words) - 1):
        if at and tokens[at - 1].kind not in BREAKS and words[at - 1] not in JOINTS | {"please", "and"}:
            continue
        count = next((n for n in (3, 2, 1) if " ".join(words[at : at + n]) in _FORBIDDING), 0)
        verb = builtin().verb(words[at + count]) if count and at + count < len(words) else None
        if count and verb is not None and verb[1] in (_FORBIDDING[" ".join(words[at : at + count])], "base"):
            if verb[1] == "base" and words[at] in ("no", "stop", "quit", "refrain"):
                continue
            lead = [replace(tokens[at], text=word) for word in ("do", "not")]
            rest = tokens[at + count :]
            return [*tokens[:at], *lead, replace(rest[0], text=verb[0]), *rest[1:]]
        if words[at : at + 2] == ["hands", "off"] and at + 2 < len(words):
            lead = [replace(tokens[at], text=word) for word in ("do", "not", "touch")]
            return [*tokens[:at], *lead, *tokens[at + 2 :]]
    return tokens


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


_WISHING = frozenset(
    ["could do with", "could use", "feel like", "wish for", "hope for", "long for", "hoping for"]
    + [
        f"{be} {wish}"
        for be in ("am", "are", "i'm", "we're")
        for wish in ("after", "looking for", "in the mood for", "dying for", "hoping for")
    ]
)
"""What wishes are said by, behind "I" and "we"."""


def _could_do_with(tokens: list[Token]) -> list[Token]:
    """Read "I could do with a tea", "how about a tea" as "I would like a tea"."""
    if [t.text for t in tokens[:2]] in (["how", "about"], ["what", "about"]) and len(tokens) > 2:
        lead = [replace(tokens[0], text="i"), replace(tokens[0], text="would"), replace(tokens[1], text="like")]
        return [*lead, *tokens[2:]]
    words = [t.text for t in tokens]
    for at in range(len(words) - 1):
        length = next((n for n in range(5, 1, -1) if " ".join(words[at : at + n]) in _WISHING), 0)
        if length and (at == 0 or words[at - 1] in SPEAKERS or words[at].startswith(("i'", "we'"))):
            said = [] if at and words[at - 1] in SPEAKERS else [replace(tokens[at], text="i")]
            would, like = replace(tokens[at], text="would"), replace(tokens[at + 1], text="like")
            return [*tokens[:at], *said, would, like, *tokens[at + length :]]
    return tokens


def _how_would(tokens: list[Token]) -> list[Token]:
    """Read "how would you bring me a tea?" as "bring me a tea"."""
    words = [t.text for t in tokens[:4]]
    if words[:1] != ["how"] or words[1:2] == [] or words[1] not in _WOULD:
        return tokens
    at = 3 if words[2:3] == ["you"] else 2
    verb = builtin().verb(words[at]) if at < len(words) else None
    return tokens[at:] if verb is not None and verb[1] == "base" else tokens


def _enough_of(tokens: list[Token]) -> list[Token]:
    """Read "enough of the soup" as "the soup": how much that is, nobody said."""
    words = [t.text for t in tokens]
    for at in range(1, len(words) - 2):
        for lead in (["enough", "of"], ["plenty", "of"]):
            if words[at : at + 2] == lead:
                return [*tokens[:at], *_enough_of(tokens[at + 2 :])]
    return tokens


def _one_of_many(tokens: list[Token]) -> list[Token]:
    """Read "one of the two lamps" as "one of the lamps": how many there are picks none of them."""
    for at in range(len(tokens) - 4):
        words = [t.text for t in tokens[at : at + 4]]
        if is_number(words[0]) and words[1] == "of" and words[2] in section("determiners") and is_number(words[3]):
            return [*tokens[: at + 3], *_one_of_many(tokens[at + 4 :])]
    return tokens


def _so_should(tokens: list[Token]) -> list[Token]:
    """Read "the cup should be in the sink and so should the mug" as "the cup and the mug should be in the sink"."""
    words = [t.text for t in tokens]
    for at in range(4, len(words) - 2):
        if words[at - 1] == "so" and words[at] in _DUTIES and words[at] in words[: at - 2] and words[at - 2] == "and":
            first = words.index(words[at])
            end = next((i for i in range(at, len(words)) if tokens[i].kind in BREAKS), len(words))
            return [*tokens[:first], tokens[at - 2], *tokens[at + 1 : end], *tokens[first : at - 2], *tokens[end:]]
    return tokens


def _with_them(tokens: list[Token]) -> list[Token]:
    """Read "put the cups on the shelf, and the mug with them" as "put the cups and the mug on the shelf"."""
    words = [t.text for t in tokens]
    for at in range(5, len(words) - 1):
        ends = at + 2 == len(words) or tokens[at + 2].kind in BREAKS
        if words[at] != "with" or words[at + 1] not in ("it", "them") or not ends:
            continue
        joint = next((i for i in range(at - 1, 0, -1) if words[i] == "and"), 0)
        verb = next((i for i in range(joint) if words[i] in _PUTTING), None)
        said = verb is not None and words[joint + 1] in section("determiners") | section("quantifiers")
        place = next((i for i in range(verb or 0, joint) if words[i] in section("prepositions")), None)
        if said and place is not None:
            cut = joint - (tokens[joint - 1].kind is Kind.COMMA)
            return [*tokens[:place], *tokens[joint:at], *tokens[place:cut], *tokens[at + 2 :]]
    return tokens


def _everything_else(tokens: list[Token]) -> list[Token]:
    """Read "put the pen in the drawer and everything else in the bin" as "… and everything except that …".

    So does "the rest", where it stays as it is: "leave the rest", "the rest stays there".
    """
    words = [t.text for t in tokens]
    for at in range(1, len(words)):
        stays = words[at + 1 : at + 2] and (words[at + 1] in _STAYING or words[at + 1 : at + 3] == ["can", "stay"])
        kept = words[at - 2 : at - 1] in (["leave"], ["leaving"]) or stays
        if words[at - 1 : at + 1] == ["the", "rest"] and kept and words[at + 1 : at + 2] != ["of"]:
            both = [replace(tokens[at - 1], text="everything"), replace(tokens[at], text="else")]
            return _everything_else([*tokens[: at - 1], *both, *tokens[at + 1 :]])
        if words[at] == "else" and words[at - 1] in ("everything", "anything"):
            cut = tokens[at].span.start + 1
            but = replace(tokens[at], text="except", span=tokens[at].span._replace(end=cut))
            them = replace(tokens[at], text="them", span=tokens[at].span._replace(start=cut))
            return [*tokens[:at], but, them, *_everything_else(tokens[at + 1 :])]
    return tokens


def _coming_off(tokens: list[Token]) -> list[Token]:
    """Read "the cups have to come off the table" as "take the cups off the table"."""
    words = [t.text for t in tokens]
    for at in range(2, len(words) - 1):
        duty = at - 1 if words[at - 1] in ("should", "must") else at - 2 if words[at - 1] == "to" else -1
        if words[at] != "come" or words[at + 1] not in ("off", "out", "from") or duty < 1 or words[duty] not in _DUTIES:
            continue
        begin = duty
        while begin and tokens[begin - 1].kind not in BREAKS and words[begin - 1] not in (*JOINTS, "so"):
            begin -= 1
        if begin < duty and words[begin] not in PRONOUNS - {"it", "they", "this", "that"}:
            return [*tokens[:begin], replace(tokens[at], text="take"), *tokens[begin:duty], *tokens[at + 1 :]]
    return tokens


def _without_tags(tokens: list[Token]) -> list[Token]:
    """Leave out "however", "thanks", "will you?", "the pair of them", between commas or at the end."""
    result: list[Token] = []
    at = 0
    while at < len(tokens):
        ahead = [t.text for t in tokens[at : at + 4]] if tokens[at].text in _TAG_OPENERS else []
        length = next((n for n in range(len(ahead), 0, -1) if " ".join(ahead[:n]) in _TAGS), 0)
        end = at + length
        begins = not result or result[-1].kind in BREAKS
        ends = end >= len(tokens) or tokens[end].kind in BREAKS or tokens[end].text in ("and", "but")
        if length and ends and (begins or tokens[at].text in ("though", "however", "at", "in")):
            closed = bool(result) and result[-1].kind is Kind.COMMA
            if closed and end < len(tokens) and tokens[end].kind in BREAKS:
                result.pop()
            at = end
            continue
        result.append(tokens[at])
        at += 1
    return result


def _plain_copula(tokens: list[Token]) -> list[Token]:
    """Read "happens to be" as "is", "is to be" as "should be", "should end up in" as "should be in"."""
    words = [t.text for t in tokens]
    for at in range(1, len(words) - 1):
        happens = words[at] in ("happens", "happen") and words[at + 1 : at + 3] == ["to", "be"]
        shall = words[at] in ("is", "are") and words[at + 1 : at + 3] == ["to", "be"]
        ends = words[at - 1] in _DUTIES | {"to"} and words[at : at + 2] in (["end", "up"], ["wind", "up"])
        lies = words[at] in _LYING
        if lies and words[at + 1] in ("where", "there"):  # "leave the books lying where they are"
            return [*tokens[:at], *_plain_copula(tokens[at + 1 :])]
        if words[at - 1] in _DUTIES and words[at] in ("lie", "stand", "sit") and words[at + 1] == "where":
            return [*tokens[:at], replace(tokens[at], text="go"), *_plain_copula(tokens[at + 1 :])]
        state = tokens[at + 1].kind in BREAKS or words[at + 1] in _STATES
        if lies and words[at - 1] in ("is", "are") and state:  # "if the fridge is standing open"
            return [*tokens[:at], *_plain_copula(tokens[at + 1 :])]
        if happens:
            return [*tokens[:at], replace(tokens[at], text="is"), *_plain_copula(tokens[at + 3 :])]
        if shall:
            should = replace(tokens[at], text="should")
            return [*tokens[:at], should, *_plain_copula(tokens[at + 2 :])]
        if ends:
            return [*tokens[:at], replace(tokens[at], text="be"), *_plain_copula(tokens[at + 2 :])]
    return tokens


def _one_of_them(tokens: list[Token]) -> list[Token]:
    """Read "take one of them" as "take one"."""
    words = [t.text for t in tokens]
    for at in range(len(words) - 2):
        if words[at : at + 2] == ["one", "of"] and words[at + 2] in ("them", "these", "those"):
            return [*tokens[: at + 1], *_one_of_them(tokens[at + 3 :])]
    return tokens


def _at_most(tokens: list[Token]) -> list[Token]:
    """Leave out "but not more than two" behind a number: more than what was said is not done anyway."""
    words = [t.text for t in tokens]
    for at in range(2, len(words) - 2):
        start = at + (words[at] in ("but", "and"))
        limit = next((n for n in (3, 2) if " ".join(words[start : start + n]) in _LIMITS), 0)
        end = start + limit
        counted = any(is_number(word) for word in words[:at])
        if limit and counted and end < len(words) and is_number(words[end]):
            begin = at - (tokens[at - 1].kind is Kind.COMMA)
            return [*tokens[:begin], *tokens[end + 1 :]]
    return tokens


def _all_but_one(tokens: list[Token]) -> list[Token]:
    """Read "all but one of the cups" as "all the cups but one"."""
    for at in range(len(tokens) - 5):
        words = [t.text for t in tokens[at : at + 5]]
        if words[0] == "all" and words[1] in ("but", "except") and words[2:4] == ["one", "of"]:
            end = at + 5
            while end < len(tokens) and not (tokens[end].kind in BREAKS or tokens[end].text in _BEHIND):
                end += 1
            return [*tokens[: at + 1], *tokens[at + 4 : end], *tokens[at + 1 : at + 3], *tokens[end:]]
    return tokens


def _bare_ordinal(tokens: list[Token]) -> list[Token]:
    """Read "except the first" as "except the first one"."""
    found: list[Token] = []
    for at, token in enumerate(tokens):
        found.append(token)
        ends = at + 1 == len(tokens) or tokens[at + 1].kind in BREAKS or tokens[at + 1].text in JOINTS
        if at > 1 and ends and token.text in _ORDINALS and tokens[at - 1].text == "the":
            found.append(replace(token, text="one"))
    return found


def _whatever(tokens: list[Token]) -> list[Token]:
    """Read "whatever is on the floor" as "everything that is on the floor"."""
    for at, token in enumerate(tokens[:-1]):
        if token.text == "whatever" and tokens[at + 1].text in _COPULAS:
            that = [replace(token, text="everything"), replace(token, text="that")]
            return [*tokens[:at], *that, *_whatever(tokens[at + 1 :])]
    return tokens


def _whatever_is_so(tokens: list[Token]) -> list[Token]:
    """Read "whatever is empty on the shelf" as "every empty thing on the shelf"."""
    words = [t.text for t in tokens]
    for at in range(len(words) - 3):
        opener = next((n for n in (1, 2) if " ".join(words[at : at + n]) in _WHATEVER), 0)
        if opener and words[at + opener] in ("is", "are", "'s") and words[at + opener + 1] in _STATES | _ADJECTIVES:
            every = [replace(tokens[at], text="every"), tokens[at + opener + 1]]
            thing = replace(tokens[at + opener + 1], text="thing")
            thing.span = thing.span._replace(start=thing.span.end)
            return [*tokens[:at], *every, thing, *_whatever_is_so(tokens[at + opener + 2 :])]
    return tokens


def _gets(tokens: list[Token]) -> list[Token]:
    """Read "every chair gets a cushion" as "put a cushion to every chair"."""
    words = [t.text for t in tokens]
    for at in range(2, len(words) - 2):
        begin = at
        while begin and tokens[begin - 1].kind not in BREAKS:
            begin -= 1
        end = next((i for i in range(at, len(words)) if tokens[i].kind in BREAKS or words[i] in JOINTS), len(words))
        plain = not {*words[begin:at], *words[at + 1 : end]} & (_BEHIND | section("modals") | section("be"))
        each = words[begin] in ("every", "each", "both", "all") and words[begin + 1] not in ("of", "guest", "one")
        if words[at] in ("gets", "get") and each and plain and words[at + 1] in section("determiners") | {"one"}:
            put, to = (replace(tokens[at], text=word) for word in ("put", "to"))
            return [*tokens[:begin], put, *tokens[at + 1 : end], to, *tokens[begin:at], *_gets(tokens[end:])]
    return tokens


def _same_noun(tokens: list[Token]) -> list[Token]:
    """Read "from the table with the mug to the other table" as "… to the other one"."""
    for at in range(2, len(tokens)):
        noun, told = tokens[at].text, tokens[at - 1].text in ("other", "empty", "free")
        ends = at + 1 == len(tokens) or tokens[at + 1].kind in BREAKS or tokens[at + 1].text in JOINTS
        if not (told and ends and tokens[at - 2].text == "the"):
            continue
        before = next((i for i in range(at - 3, 0, -1) if tokens[i].text == noun), 0)
        joined = any(t.text in JOINTS or t.kind in BREAKS for t in tokens[before:at])
        if before and tokens[before - 1].text in section("determiners") and not joined:
            return [*tokens[:at], replace(tokens[at], text="one"), *_same_noun(tokens[at + 1 :])]
    return tokens


def _last_state(tokens: list[Token]) -> list[Token]:
    """Read "…, and the drawer closed after that" as "… and close the drawer after that"."""
    words = [t.text for t in tokens]
    if _KEEPING.intersection(words):
        return tokens
    for at in range(2, len(words) - 2):
        if words[at] != "and" or words[at + 1] not in section("determiners"):
            continue
        end = next((i for i in range(at, len(words)) if tokens[i].kind in BREAKS), len(words))
        state = next((i for i in range(at + 3, min(at + 6, end)) if words[i] in _CLOSING), 0)
        noun = words[at + 2 : state]
        plain = not set(noun) & (section("prepositions") | section("be") | section("modals") | JOINTS)
        if state and plain and set(words[state + 1 : end]) <= _AFTERWARDS:
            verb = replace(tokens[state], text=_CLOSING[words[state]])
            return [*tokens[: at + 1], verb, *tokens[at + 1 : state], *tokens[state + 1 :]]
    return tokens


def _heat(tokens: list[Token]) -> list[Token]:
    """Read "switch the burner on, full heat" as "… to high", "put the pot on it, low heat" as "… Turn it to low"."""
    words = [t.text for t in tokens]
    for at in range(2, len(words) - 1):
        ends = at + 2 == len(words) or tokens[at + 2].kind in BREAKS or words[at + 2] in {*JOINTS, "please"}
        if words[at] not in _LEVELS or words[at + 1] != "heat" or not ends:
            continue
        begin = at - (words[at - 1] in ("a", "the"))
        begin -= words[begin - 1] in _AT
        begin -= tokens[begin - 1].kind is Kind.COMMA
        source = tokens[at]
        level = replace(source, text=_LEVELS[words[at]])
        switched = bool(_SWITCHING.intersection(words[:begin]))
        begin -= switched and words[begin - 1] == "on"  # "turn it on, low heat"
        lead = ["to"] if switched else [".", "turn", "it", "to"]
        told = [replace(source, text=word, span=source.span._replace(end=source.span.start)) for word in lead]
        told[0].kind = Kind.WORD if switched else Kind.STOP
        return [*tokens[:begin], *told, level, *_heat(tokens[at + 2 :])]
    return tokens


def _left_out(tokens: list[Token]) -> list[Token]:
    """Read "… but leave the milk out", "… and skip the milk" as "… but without the milk"."""
    words = [t.text for t in tokens]
    for at in range(2, len(words) - 1):
        if words[at - 1] not in JOINTS:
            continue
        end = next((i for i in range(at, len(words)) if tokens[i].kind in BREAKS or words[i] in JOINTS), len(words))
        rest = tokens[at + 1 : end]
        if words[at] == "leave" and "out" in (words[at + 1], words[end - 1]):
            rest = rest[1:] if words[at + 1] == "out" else rest[:-1]
        elif words[at] not in _OMITTING:
            continue
        if rest:
            return [*tokens[:at], replace(tokens[at], text="without"), *rest, *tokens[end:]]
    return tokens


def _as_low_as_it_goes(tokens: list[Token]) -> list[Token]:
    """Read "set the sound as low as it goes" as "… to low", "as small as possible" as "small"."""
    words = [t.text for t in tokens]
    for at in range(len(words) - 3):
        if words[at] != "as" or words[at + 2] != "as":
            continue
        end = next((i for i in range(at + 3, len(words)) if tokens[i].kind in BREAKS or words[i] in JOINTS), len(words))
        limit = words[at + 3 : end]
        if limit == ["possible"] or (limit and limit[0] in ("it", "they", "you") and set(limit[1:]) & _LIMIT):
            level = [tokens[at + 1]]
            if _SWITCHING.intersection(words[:at]):
                level = [replace(tokens[at], text="to"), *level]
            return [*tokens[:at], *level, *tokens[end:]]
    return tokens


def _another_of(tokens: list[Token]) -> list[Token]:
    """Read "one bowl of rice and one of beans" as "rice in one bowl and beans in another one"."""
    words = [t.text for t in tokens]
    for at in range(4, len(words) - 2):
        count = words[at] in ("one", "another", "a") and words[at - 1] == "and"
        of = next((i for i in (at + 1, at + 2) if i + 1 < len(words) and words[i] == "of"), 0)
        first = next((i for i in range(at - 4) if words[i] in ("one", "a", "an") and words[i + 2] == "of"), None)
        if not count or not of or first is None or words[first + 1] not in section("containers"):
            continue
        same = words[at + 1 : of] in ([], ["one"], [words[first + 1]])
        same = same and (not first or bool(_PREPARING.intersection(words[:first])))
        ends = (i for i in range(of + 1, len(words)) if tokens[i].kind in BREAKS or words[i] in _BEHIND)
        end = next(ends, len(words))
        if same:
            before, behind = tokens[first].span, tokens[end - 1].span
            inside = replace(tokens[first + 2], text="in", span=before._replace(end=before.start))
            other = [replace(tokens[at], text=w, span=behind._replace(start=behind.end)) for w in _ANOTHER]
            one = [inside, replace(tokens[first], text="one"), tokens[first + 1]]
            verb = [] if first else [replace(inside, text="put")]
            head = [*verb, *tokens[:first], *tokens[first + 3 : at - 1], *one, tokens[at - 1]]
            return [*head, *tokens[of + 1 : end], *other, *tokens[end:]]
    return tokens


def _listed_adjectives(tokens: list[Token]) -> list[Token]:
    """Read "the big, red cup" as "the big red cup"."""
    kept: list[Token] = []
    for at, token in enumerate(tokens):
        before = [t.text for t in kept[-2:]]
        behind = [t.text for t in tokens[at + 1 : at + 3]]
        inside = len(before) == len(behind) == 2 and token.kind is Kind.COMMA and before[1] in _ADJECTIVES
        led = inside and before[0] in section("determiners") | _ADJECTIVES
        more = inside and (behind[0] in _ADJECTIVES or behind[0].endswith("ed")) and behind[1] not in _BEHIND
        if not (led and more):
            kept.append(token)
    return kept


def _which_goes(tokens: list[Token]) -> list[Token]:
    """Read "…, except the rubbish, which goes in the bin" as "…, except the rubbish. The rubbish goes in the bin"."""
    words = [t.text for t in tokens]
    for at in range(2, len(words) - 3):
        if words[at : at + 2] != [",", "which"] or words[at + 2] not in _GOING:
            continue
        begin = next((i for i in range(at - 1, -1, -1) if words[i] in section("determiners")), None)
        if begin is not None and not {*words[begin:at]} & _BEHIND:
            stop = replace(tokens[at], kind=Kind.STOP, text=".")
            again = [replace(t, span=tokens[at + 1].span) for t in tokens[begin:at]]
            return [*tokens[:at], stop, *again, *_which_goes(tokens[at + 2 :])]
    return tokens


def _swapped(tokens: list[Token]) -> list[Token]:
    """Read "swap the cup and the mug" as "swap the cup with the mug"."""
    words = [t.text for t in tokens]
    for at, word in enumerate(words[:-3]):
        end = next((i for i in range(at, len(words)) if tokens[i].kind in BREAKS), len(words))
        joint = next((i for i in range(at, end - 2) if words[i] == "and"), None)
        two = joint is not None and words[joint + 1] in section("determiners") and words[at + 1] != "places"
        if word in ("swap", "exchange") and joint is not None and two and "with" not in words[at:end]:
            return [*tokens[:joint], replace(tokens[joint], text="with"), *_swapped(tokens[joint + 1 :])]
    return tokens


def _another(tokens: list[Token]) -> list[Token]:
    """Read "one of the cups and then another" as "one of the cups and another one"."""
    found: list[Token] = []
    for at, token in enumerate(tokens):
        ends = at + 1 == len(tokens) or tokens[at + 1].kind in BREAKS or tokens[at + 1].text in _BEHIND
        if token.text == "another" and at and ends:
            if found and found[-1].text == "then" and len(found) > 1 and found[-2].text == "and":
                found.pop()
            found += [token, replace(token, text="one", span=token.span._replace(start=token.span.end))]
        else:
            found.append(token)
    return found


def asked_and_told(tokens: list[Token]) -> list[Token]:
    """Read "Is the window closed? It should be." as "The window should be closed."."""
    words = [t.text for t in tokens]
    for at in range(3, len(words) - 3):
        told = words[at + 1] in ("it", "they") and words[at + 2] in ("should", "must") and words[at + 3] == "be"
        ends = at + 4 == len(words) or tokens[at + 4].kind in BREAKS
        begin = at
        while begin and tokens[begin - 1].kind not in BREAKS:
            begin -= 1
        if words[at][:1] == "?" and told and ends and words[begin] in ("is", "are") and words[at - 1] in _ENDING:
            asked = [*tokens[begin + 1 : at - 1], *tokens[at + 2 : at + 4], tokens[at - 1]]
            return [*tokens[:begin], *asked, *asked_and_told(tokens[at + 4 :])]
    return tokens


def named_where_taken_up(tokens: list[Token]) -> list[Token]:
    """Read "The cup on the shelf: wash it" as "wash the cup on the shelf", "The drawers, open them" so too."""
    words = [t.text for t in tokens]
    for at in range(2, len(words) - 2):
        if words[at] not in (":", ","):
            continue
        begin = at
        while begin and tokens[begin - 1].kind not in BREAKS:
            begin -= 1
        named = tokens[begin:at]
        plain = not {t.text for t in named} & (section("be") | section("modals") | JOINTS | _STATES | {"that", "which"})
        asked = builtin().verb(words[at + 1]) is not None and words[at + 2] in ("it", "them")
        if len(named) > 1 and named[0].text in _DEFINITE and plain and asked:
            rest = tokens[at + 3 :]
            rest = rest[1:] if rest and rest[0].text in ("both", "all") else rest
            return [*tokens[:begin], tokens[at + 1], *named, *named_where_taken_up(rest)]
    return tokens


class Idiom(NamedTuple):
    """How sentences with certain words are put plainly.

    Attributes:
        read: From the tokens of a sentence to those that are read instead.
        words: A sentence without any of these is left as it is; empty for all sentences.
    """

    read: Callable[[list[Token]], list[Token]]
    words: frozenset[str] = frozenset()


def _on(read: Callable[[list[Token]], list[Token]], *words: str) -> Idiom:
    return Idiom(read, frozenset(words))


IDIOMS = (
    _on(_without_tags, *_TAG_OPENERS),
    _on(_how_would, "how"),
    _on(_forbidden, "refrain", "stop", "quit", "no", "hands"),
    _on(_neither, "neither"),
    _on(_enough_of, "enough", "plenty"),
    _on(_plain_copula, "is", "are", "happens", "happen", "end", "wind", "lie", "stand", "sit", *_LYING),
    _on(_whatever_is_so, "whatever", "everything", "anything"),
    _on(_whatever, "whatever"),
    _on(_same_noun, "other", "empty", "free"),
    _on(_at_most, "more", "most"),
    _on(_all_but_one, "all"),
    _on(_bare_ordinal, *_ORDINALS),
    _on(_one_of_them, "one"),
    _on(_last_state, *_CLOSING),
    _on(_none_of, "none"),
    _on(_in_with, "with"),
    _on(_but_there, "there"),
    _on(_needing, "needs", "need"),
    _on(_not_done_yet, "been"),
    _on(_could_do_with, "about", *{word for phrase in _WISHING for word in phrase.split()} - {"for", "the", "in"}),
    _on(_one_of_many, "of"),
    _on(_so_should, "so"),
    _on(_with_them, "with"),
    _on(_everything_else, "else", "rest"),
    _on(_coming_off, "come"),
    _on(_heat, "heat"),
    _on(_left_out, "out", *_OMITTING),
    _on(_as_low_as_it_goes, "as"),
    _on(_another_of, "of"),
    _on(_listed_adjectives, ","),
    _on(_which_goes, "which"),
    _on(_swapped, "swap", "exchange"),
    _on(_another, "another"),
    _on(_gets, "gets", "get"),
)
"""What is done with each sentence, in this order."""


def put_plainly(sentence: list[Token], idioms: Sequence[Idiom]) -> list[Token]:
    """Read a sentence by all idioms that its words call for, one after the other."""
    words = {t.text for t in sentence}
    for idiom in idioms:
        if idiom.words and idiom.words.isdisjoint(words):
            continue
        read = idiom.read(sentence)
        if read is not sentence:
            sentence, words = read, {t.text for t in read}
    return sentence
