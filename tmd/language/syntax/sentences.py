"""The words of a text before they have classes: forms that are read elsewhere, and what is no instruction at all."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

from tmd.language.lexicon.lexicon import builtin, section
from tmd.language.syntax.contrast import CONTRASTS
from tmd.language.syntax.idioms import (
    BREAKS,
    IDIOMS,
    JOINTS,
    PRONOUNS,
    SPEAKERS,
    Idiom,
    asked_and_told,
    named_where_taken_up,
    put_plainly,
)
from tmd.language.syntax.subordinate import STATEMENT, UNNEEDED
from tmd.language.syntax.tokens import Kind, Token, fold

_ANOTHER_TIME = frozenset({"later", "tomorrow", "afterwards", "myself", "ourselves"})
"""What speakers say they will do then, or by themselves, is not asked for."""
_DO_NOT_BOTHER = (["don't", "bother"], ["dont", "bother"], ["do", "not", "bother"])

_ASKING = frozenset({"can", "could", "may", "should", "shall"})
"""What a question begins with that asks for something; *will it be hot* does not."""
_NOTHING = {"any": "no", "anything": "nothing", "a": "no", "an": "no"}
_POSTURES = frozenset({"left", "lying", "standing", "sitting", "around", "about", "remaining"})
_STANDING = frozenset({"lies", "stands", "sits", "hangs", "lying", "standing", "sitting", "hanging"})
_SURE = frozenset({"sure", "ensure", "certain", "that"})
_PLACING = frozenset({"in", "on", "under", "next_to", "next", "inside", "beside", "behind", "at", "near", "by"})
_BEHIND_LEFT = frozenset({"of", "alone", "untouched", "where", "as"})
"""Behind which *left* is a side, or says that nothing is done."""
_REST_OF = frozenset(
    {"what is left of", "what's left of", "whatever is left of", "whatever's left of", "what remains of"}
)
_BEFORE_THERE = frozenset({"in", "into", "on", "onto", "from", "under", "inside", "within"})
_WE_ARE = frozenset({"i'm", "im", "we're"})
_UNABLE = frozenset({"can't", "cannot", "couldn't", "didn't", "haven't"})
_HERE = frozenset({"in", "on", "inside", "there", "here"})
_STAYS = frozenset({"stays", "stay", "remains", "remain"})
_IS_BEFORE = frozenset(
    {"a", "an", "the", "not", "still", "too", "already", "open", "closed", "shut", "on", "off", "empty", "full"}
)
_WELCOME = frozenset({"lovely", "nice", "great", "good", "perfect", "ideal", "wonderful", "fine", "brilliant"})
_TREATMENTS = frozenset(
    {"scrub", "wash", "clean", "shake", "stir", "push", "wipe", "rinse", "polish", "dust", "sweep", "mop", "brush",
     "spin", "squeeze", "turn", "rub", "soak", "boil", "press", "pull"}
)  # fmt: skip
"""Nouns for what is done to a thing that is given one."""
_BEING = (["be"], ["stay"], ["remain"], ["stand"])
_CORRECTIONS = frozenset(
    {"no wait", "wait no", "no sorry", "sorry no", "no actually", "actually no", "scratch that", "no hang on",
     "on second thought", "on second thoughts", "forget that", "no i mean", "i mean"}
)  # fmt: skip
_CORRECTING = frozenset(phrase.split()[0] for phrase in _CORRECTIONS)
_SUMMARIES = frozenset({"clear", "tidy", "clean", "sort", "set", "arrange", "organise", "organize"})
_MODALS = frozenset({"should", "must", "may", "can", "shall"})
_END_STATES = frozenset({"open", "closed", "shut", "on", "off", "locked", "unlocked", "full", "empty", "lit", "clean"})


def drop_taken_back(tokens: list[Token]) -> tuple[list[Token], list[Token]]:
    """Remove what the speaker takes back: "on the table, no wait, on the shelf", "Open it. Actually, no, shut it".

    A place takes back a place, a thing a thing, an instruction what was said since the last full stop. An instruction
    with a pronoun takes nothing back, because what the pronoun stands for was named there.

    Returns:
        The tokens that stay and the tokens removed.
    """
    words = [t.text for t in tokens]
    for at in range(1, len(tokens) - 2):
        end = _correction(words, at) if words[at] in _CORRECTING or words[at] in (",", "-", "–") else 0
        if not end or tokens[at - 1].kind not in (*BREAKS, Kind.COMMA) or end + 1 >= len(tokens):
            continue
        stops = [i + 1 for i in range(at - 1) if tokens[i].kind is Kind.STOP]
        start = stops[-1] if stops else 0
        places = [i for i in range(start, at) if words[i] in section("prepositions")]
        things = [i for i in range(start, at) if words[i] in section("determiners")]
        if words[end] in section("prepositions") and places:
            start = places[-1]
        elif words[end] in section("determiners") and things:
            start = things[-1]
        elif words[end + 1] in PRONOUNS:
            start = at
        rest, dropped = drop_taken_back(tokens[end:])
        return [*tokens[:start], *rest], [*tokens[start:end], *dropped]
    return tokens, []


def drop_headings(tokens: list[Token]) -> tuple[list[Token], list[Token]]:
    """Remove "clear the floor" from "clear the floor: the book onto the shelf, …": what follows says how.

    Returns:
        The tokens that stay and the tokens removed.
    """
    start = 0
    for at, token in enumerate(tokens):
        if token.kind is not Kind.STOP:
            continue
        stops = (i for i in range(at + 1, len(tokens)) if tokens[i].kind is Kind.STOP)
        following = tokens[at + 1 : next(stops, len(tokens))]
        placed = any(t.text in section("prepositions") for t in following)
        if token.text == ":" and placed and tokens[start].text in _SUMMARIES:
            rest, dropped = drop_headings(tokens[at + 1 :])
            return [*tokens[:start], *rest], [*tokens[start : at + 1], *dropped]
        start = at + 1
    return tokens, []


def _correction(words: list[str], at: int) -> int:
    """Return where the words end with which a speaker corrects himself; 0 where there are none."""
    plain = [(i, word) for i, word in enumerate(words[at : at + 6], at) if word not in (",", "-", "–")]
    for count in (3, 2):
        if " ".join(word for _, word in plain[:count]) in _CORRECTIONS and len(plain) > count:
            return plain[count][0]
    return 0


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
    tokens = _without_posture(_without_asides(_with_copulas(_the_other(named_where_taken_up(asked_and_told(tokens))))))
    starts = [0, *(i + 1 for i, t in enumerate(tokens) if t.kind is Kind.STOP)]
    if starts[-1] < len(tokens):
        starts.append(len(tokens))
    for start, end in reversed(list(pairwise(starts))):
        asked = _question(tokens, start, end)
        if asked is not None:
            tokens = asked
            continue
        sentence = put_plainly(tokens[start:end], _SENTENCES)
        tokens = [*tokens[:start], *sentence, *tokens[end:]]
    tokens = _noun_there(tokens)
    for before, token, after in zip(tokens, tokens[1:], [*tokens[2:], None], strict=False):
        copula = after is not None and after.text in section("be") | section("modals")
        if token.text == "there" and before.text in _BEFORE_THERE and not copula:
            token.text = "it"
    return _staying(tokens)


def _noun_there(tokens: list[Token]) -> list[Token]:
    """Read "… to the hall and leave it on the rack there" as "… on the rack in it"."""
    result: list[Token] = []
    for at, token in enumerate(tokens):
        ends = at + 1 == len(tokens) or tokens[at + 1].kind in BREAKS or tokens[at + 1].text in JOINTS
        spoken = any(t.kind in BREAKS or t.text in JOINTS for t in tokens[:at])
        noun = at > 1 and tokens[at - 1].kind is Kind.WORD and tokens[at - 2].text in ("the", "a")
        if token.text == "there" and ends and spoken and noun:
            cut = token.span.start + 1
            result.append(replace(token, text="in", span=token.span._replace(end=cut)))
            result.append(replace(token, text="it", span=token.span._replace(start=cut)))
        else:
            result.append(token)
    return result


def _the_other(tokens: list[Token]) -> list[Token]:
    """Read "a spoon in one and a fork in the other" as "… in the other one"."""
    result: list[Token] = []
    for at, token in enumerate(tokens):
        result.append(token)
        after = tokens[at + 1] if at + 1 < len(tokens) else None
        ends = after is None or after.kind is not Kind.WORD or after.text in JOINTS | section("prepositions")
        if token.text == "other" and at and tokens[at - 1].text == "the" and ends:
            result.append(Token(Kind.WORD, "one", token.span._replace(start=token.span.end)))
    return result


def _with_copulas(tokens: list[Token]) -> list[Token]:
    """Read "the bin's open", "the kettle's standing there" as "the bin is open": no owner stands before such words."""
    result: list[Token] = []
    for at, token in enumerate(tokens):
        after = tokens[at + 1] if at + 1 < len(tokens) else None
        stem = token.text.removesuffix("'s")
        follows = after.text if after is not None and after.kind is Kind.WORD else ""
        ends = at + 2 >= len(tokens) or tokens[at + 2].kind in BREAKS or tokens[at + 2].text in JOINTS
        ensured = token.text in ("it's", "they're") and result[-2:-1] != [] and result[-2].text in _SURE
        if ensured:  # "make sure it's empty"
            cut = token.span.start + len(token.text.split("'")[0])
            subject, copula = ("it", "is") if token.text == "it's" else ("they", "are")
            result[-1:] = [replace(token, text=subject, span=token.span._replace(end=cut))]
            result.append(Token(Kind.WORD, copula, token.span._replace(start=cut)))
            continue
        verbal = follows.endswith("ing") and (ends or follows not in section("nouns") | section("ing_modifiers"))
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
        if skipping and token.kind in BREAKS:
            skipping = False
            if result and result[-1].kind is Kind.COMMA and token.kind is Kind.COMMA:
                continue
        if not skipping:
            result.append(token)
    return result


def _of_oneself(tokens: list[Token]) -> list[Token]:
    """Fold what speakers say of themselves, and what they ask: "I'm going to make pasta", "Where did the mug go?"."""
    begin = next(
        (i + 1 for i, t in enumerate(tokens) if t.kind is Kind.COMMA and _speaks_of_oneself(tokens[i + 1 :])), 0
    )
    words = [t.text for t in tokens]
    asks = words[:1] in (["where"], ["who"]) and words[-1][:1] == "?"
    if not (asks or begin or _speaks_of_oneself(tokens)):
        return tokens
    if asks or _speaks_of_oneself(tokens):
        begin = 0
    breaks = (
        i
        for i in range(begin, len(tokens))
        if tokens[i].kind in BREAKS
        or words[i] in ("so", "but")
        or (words[i] == "and" and words[i + 1 : i + 2] in (["you"], ["please"], ["can"], ["could"]))
    )
    end = len(tokens) - 1 if asks else next(breaks, len(tokens))
    said = fold(tokens[begin:end], Kind.SKIP, " ")
    said.note = STATEMENT
    said.inner = [
        t for t in said.inner if t.text not in _WE_ARE | {"go", "gone", "done", "finished"}
    ]  # "where did the mug go": no "mug go"
    rest = tokens[end:]
    if rest and rest[0].kind is Kind.COMMA and len(rest) > 1 and not begin:
        rest = [replace(rest[0], kind=Kind.STOP, text="."), *rest[1:]]  # what is asked for is a sentence of its own
    return [*tokens[:begin], said, *rest]


def _speaks_of_oneself(tokens: list[Token]) -> bool:
    words = [t.text for t in tokens[:4]]
    start = 2 if words[:2] in (["i", "am"], ["we", "are"]) else 1 if words[:1] and words[0] in _WE_ARE else 0
    being = start > 0 and len(words) > start  # "I'm thirsty", "I'm going to make pasta"
    unable = len(words) > 1 and words[0] in SPEAKERS and words[1] in _UNABLE
    indifferent = len(words) > 2 and words[0] in SPEAKERS and words[1:3] in (["don't", "care"], ["don't", "mind"])
    getting = words[:2] in (["it's", "getting"], ["its", "getting"]) or words[:3] == ["it", "is", "getting"]
    end = next((i for i, t in enumerate(tokens) if t.kind in BREAKS), len(tokens))
    own = words[:1] in (["i'll"], ["we'll"]) and any(t.text in _ANOTHER_TIME for t in tokens[:end])
    return being or unable or indifferent or getting or own  # "it's getting cold in here"


def _absent(tokens: list[Token]) -> list[Token]:
    """Read "nothing wet may stay in the hall" as "no wet thing should be in the hall"."""
    words = [t.text for t in tokens]
    said = len(words) > 2 and words[0] == "nothing" and words[1] not in (*section("modals"), *section("be"), *_STAYS)
    if said and tokens[1].kind is Kind.WORD and words[1] not in section("prepositions") | {"left", "else"}:
        thing = replace(tokens[1], text="thing", span=tokens[1].span._replace(start=tokens[1].span.end))
        tokens = [replace(tokens[0], text="no"), tokens[1], thing, *tokens[2:]]
        words = [t.text for t in tokens]
    if not words or words[0] not in ("nothing", "no", "none"):
        return tokens
    at = next((i for i in range(1, len(words) - 1) if words[i] in _MODALS and words[i + 1] in _STAYS), 0)
    if not at:
        return tokens
    should, be = replace(tokens[at], text="should"), replace(tokens[at + 1], text="be")
    return [*tokens[:at], should, be, *(t for t in tokens[at + 2 :] if t.text not in _POSTURES)]


def _negative_state(tokens: list[Token]) -> list[Token]:
    """Read "the lamp should not be on" as "no lamp should be on", "it must not be moved" as "do not move it".

    So with *make sure … is not* and *neither … nor*.
    """
    words = [t.text for t in tokens]
    starts = ((i, n) for i in range(len(words) - 1, -1, -1) for n in (1, 2, 3) if _ensures(words[i : i + n], n))
    ensured = next(starts, None)
    for begin in (*(i + 1 for i in range(len(tokens) - 1, -1, -1) if tokens[i].kind in BREAKS), 0):
        found = _negative_state_from(tokens, begin, words, ensured)
        if found is not None:
            return found
    return tokens


def _negative_state_from(
    tokens: list[Token], begin: int, words: list[str], ensures: tuple[int, int] | None
) -> list[Token] | None:
    """The same for the piece that begins at ``begin``; ``None`` if it says no such thing.

    ``ensures`` is where the last words such as *make sure* are, if there are any, and how many they are.
    """
    begin += words[begin : begin + 1] != [] and words[begin] in JOINTS
    begin, lead = ensures if ensures is not None and ensures[0] >= begin else (begin, 0)
    start = begin + lead + (words[begin + lead : begin + lead + 1] == ["that"])
    end = next((i for i in range(start, len(words)) if tokens[i].kind in BREAKS), len(words))
    for at in range(start + 1, end - 1):
        full = words[at] in _MODALS and words[at + 1] == "not" and words[at + 2 : at + 3] in _BEING
        short = (
            words[at].endswith("n't") and words[at].removesuffix("n't") in _MODALS and words[at + 1 : at + 2] in _BEING
        )
        ensured = lead and (words[at] in ("isn't", "aren't") or words[at : at + 2] in (["is", "not"], ["are", "not"]))
        neither = words[start] == "neither" and words[at] in _MODALS and words[at + 1] == "be"
        if not (full or short or ensured or neither):
            continue
        subject = tokens[start + neither : at]
        rest = tokens[at + (3 if full else 1 if ensured and words[at].endswith("n't") else 2) :]
        done = builtin().verb(rest[0].text) if rest and not ensured else None
        if done is not None and done[1] == "ed" and rest[0].text not in (*_END_STATES, "left"):
            ban = [replace(tokens[at], text=word) for word in ("do", "not")] + [replace(rest[0], text=done[0])]
            return [
                *tokens[:begin],
                *ban,
                *(replace(t, text="or") if t.text == "nor" else t for t in subject),
                *rest[1:],
            ]
        if not subject or any(t.text in PRONOUNS for t in subject):
            return None
        should = [replace(tokens[at], text=word) for word in ("should", "be")]
        return [*tokens[:begin], *_denied(subject), *should, *rest]
    return None


def _ensures(words: list[str], length: int) -> bool:
    return len(words) == length and "_".join(words) in section("ensure")


def _denied(subject: list[Token]) -> list[Token]:
    """A noun phrase, or several, with *no* for its articles."""
    result: list[Token] = []
    first = True
    for token in subject:
        joint = token.text in ("nor", "or", "and") or token.kind is Kind.COMMA
        if first and not joint:
            result.append(replace(token, text="no", span=token.span._replace(end=token.span.start)))
        if not (first and token.text in section("determiners")):
            result.append(replace(token, text="and") if joint else token)
        first = joint
    return result


def _coordinated_states(tokens: list[Token]) -> list[Token]:
    """Read "the door should be open and the window shut" as "… and the window should be shut"."""
    words = [t.text for t in tokens]
    be = next((i for i, word in enumerate(words) if word == "be" and i and words[i - 1] in (*_MODALS, "to")), None)
    if be is None or words[be + 1 : be + 2] == [] or words[be + 1] not in _END_STATES:
        return tokens
    joint = be + 2
    end = next((i for i in range(be, len(tokens)) if tokens[i].kind is Kind.STOP), len(tokens))
    listed = joint < end and words[joint] in ("and", "but") and end - joint > 2 and words[end - 1] in _END_STATES
    if not listed or any(word in section("be") for word in words[joint:end]):
        return tokens
    should = [replace(tokens[end - 1], text=word) for word in ("should", "be")]
    return [*tokens[: end - 1], *should, *tokens[end - 1 :]]


def _lovely(tokens: list[Token]) -> list[Token]:
    """Read "a cup of tea would be lovely" as "I would like a cup of tea"."""
    words = [t.text for t in tokens]
    at = next((i for i in range(1, len(words) - 2) if words[i : i + 2] == ["would", "be"]), 0)
    stops = [i for i, token in enumerate(tokens) if token.kind in BREAKS or token.kind is Kind.COMMA]
    begin = max((i + 1 for i in stops if i < at and _speaks_of_oneself(tokens)), default=0)  # "I'm starving, some …"
    if not at or words[at + 2] not in _WELCOME or words[begin] in ("it", "that", "what", "this"):
        return tokens
    said = tokens[begin]
    lead = [replace(said, text=word, kind=Kind.WORD, span=tokens[at].span) for word in ("i", "would", "like")]
    end = next((i for i in stops if i > at + 2), len(tokens))
    return [*tokens[:begin], *lead, *tokens[begin:at], *tokens[end:]]


def _verbless_first(tokens: list[Token]) -> list[Token]:
    """Read "milk in the cup, then heat it" as two sentences, the first of which says where the milk shall be."""
    words = [t.text for t in tokens]
    at = next((i for i in range(2, len(words) - 1) if words[i] == "then" and _is_plainly_verb(words[i + 1])), 0)
    end = at - (at > 0 and (tokens[at - 1].kind is Kind.COMMA or words[at - 1] == "and"))
    ahead = words[:end]
    placed = any(word in section("prepositions") for word in ahead[1:-1])
    other = section("modals") | section("be") | SPEAKERS | {"if", "when", "once", "after", "please", "no", "not", "let"}
    if not placed or any(word in other or _is_plainly_verb(word) for word in ahead):
        return tokens
    return [*tokens[:end], replace(tokens[at], kind=Kind.STOP, text="."), *tokens[at + 1 :]]


def _in_the_same(tokens: list[Token]) -> list[Token]:
    """Read "put it on the same shelf as the cup" as "put it where the cup is"."""
    words = [t.text for t in tokens]
    at = next((i for i in range(1, len(words) - 3) if words[i : i + 2] == ["the", "same"]), 0)
    joint = next((i for i in range(at + 3, len(words) - 1) if words[i] == "as"), 0) if at else 0
    place = words[at - 1] in section("prepositions") and joint <= at + 4
    if not (joint and place) or any(t.kind in BREAKS for t in tokens[at:joint]):
        return tokens
    end = next((i for i in range(joint + 1, len(words)) if tokens[i].kind in BREAKS or words[i] in JOINTS), len(words))
    where, are = replace(tokens[at - 1], text="where"), replace(tokens[joint], text="is")
    return [*tokens[: at - 1], where, *tokens[joint + 1 : end], are, *tokens[end:]]


def _not_bothered(tokens: list[Token]) -> list[Token]:
    """Fold "if it is full, don't bother", which asks for nothing."""
    words = [t.text for t in tokens]
    starts = (i for i in range(len(words)) if words[i : i + 2] in _DO_NOT_BOTHER or words[i : i + 3] in _DO_NOT_BOTHER)
    at = next((i for i in starts if not i or tokens[i - 1].kind in BREAKS or words[i - 1] in JOINTS | {"then"}), None)
    if at is None:
        return tokens
    begin = 0 if words[0] in ("if", "when", "unless", "in", "should") else at
    end = next((i for i in range(at, len(words)) if tokens[i].kind is Kind.STOP), len(words))
    said = fold(tokens[begin:end], Kind.SKIP, " ")
    said.note = UNNEEDED
    return [*tokens[:begin], said, *tokens[end:]]


def _is_plainly_verb(word: str) -> bool:
    verb = builtin().verb(word)
    return verb is not None and verb[2] > 1


def _given(tokens: list[Token]) -> list[Token]:
    """Read "give it a good scrub" as "scrub it"."""
    words = [t.text for t in tokens]
    if "give" not in words:
        return tokens
    at = words.index("give")
    article = next((i for i in range(at + 2, len(words)) if words[i] in ("a", "another")), None)
    if article is None:
        return tokens
    verb = next((i for i in (article + 1, article + 2) if i < len(words) and words[i] in _TREATMENTS), None)
    ends = verb is not None and (
        verb + 1 == len(tokens) or tokens[verb + 1].kind in BREAKS or words[verb + 1] in JOINTS
    )
    if verb is None or not ends:
        return tokens
    return [*tokens[:at], replace(tokens[verb], span=tokens[at].span), *tokens[at + 1 : article], *tokens[verb + 1 :]]


def _not_about(tokens: list[Token]) -> list[Token]:
    """Fold "don't leave the tools lying around", which says of no place that things must not be there."""
    words = [t.text for t in tokens]
    if words[:2] not in (["don't", "leave"], ["never", "leave"], ["dont", "leave"]):
        return tokens
    end = next((i for i, t in enumerate(tokens) if t.kind in BREAKS), len(tokens))
    if words[end - 1] not in ("around", "about") or words[end - 2] not in _POSTURES:
        return tokens
    said = fold(tokens[:end], Kind.SKIP, " ")
    said.note, said.inner = STATEMENT, said.inner[2:-2]
    return [said, *tokens[end:]]


def _staying(tokens: list[Token]) -> list[Token]:
    """Read "the other one stays put", "the mug should be left where it is" as "leave the other one alone"."""
    for at, token in enumerate(tokens):
        following = [t.text for t in tokens[at + 1 : at + 3]]
        alone = following[:1] in (["put"], ["alone"], ["untouched"], ["there"], ["here"]) and (
            at + 2 == len(tokens) or tokens[at + 2].kind in BREAKS
        )
        state = following[:1] != [] and following[0] in _END_STATES | {"up", "down", "raised", "lowered"}
        kept = (
            alone
            or (state and token.text in _STAYS)
            or (following[:1] in (["where"], ["as"]) and following[1:] in (["it"], ["they"]))
        )
        here = len(following) > 1 and following[0] in _HERE and following[1] in ("it", "there", "here")
        if here and token.text in _STAYS:  # "everything else stays in there"
            where = [replace(tokens[at + 1], text=word) for word in ("where", "it", "is")]
            kept, tokens = True, [*tokens[: at + 1], *where, *tokens[at + 3 :]]
        stays = token.text in _STAYS or (token.text == "left" and at > 1 and tokens[at - 1].text == "be")
        if not (stays and kept):
            continue
        begin = at
        while begin and tokens[begin - 1].kind not in BREAKS and tokens[begin - 1].text not in JOINTS:
            begin -= 1
        subject = tokens[begin:at]
        while subject and subject[-1].text in _MODALS | {"be"}:
            subject = subject[:-1]
        if not subject or any(t.text in section("modals") | {"you"} for t in subject):
            continue
        lead = replace(subject[0], text="leave", span=subject[0].span._replace(end=subject[0].span.start))
        behind = [replace(tokens[at + 1], text="alone"), *tokens[at + 2 :]] if alone else tokens[at + 1 :]
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
    """Leave out "that are lying around", "lying" of "should be lying on", "what is left of": the things are there."""
    result: list[Token] = []
    at = 0
    while at < len(tokens):
        words = [t.text for t in tokens[at : at + 4]]
        rest = next((n for n in (3, 4) if " ".join(words[:n]) in _REST_OF), 0)
        if rest:
            at += rest
            continue
        relative = words[:1] in (["that"], ["which"]) and words[1:2] in (["is"], ["are"])
        first = at + 2 if relative else at + 1
        adjective = words[0] in ("is", "are") and words[1:2] == ["left"] and words[2:3] and words[2] in _END_STATES
        if adjective:
            result.append(tokens[at])  # "nothing is left open"
            at += 2
            continue
        end = first
        while (relative or words[0] == "be") and end < len(tokens) and tokens[end].text in _POSTURES:
            if tokens[end].text == "left" and end + 1 < len(tokens) and tokens[end + 1].text in _BEHIND_LEFT:
                break
            end += 1
        placed = end < len(tokens) and tokens[end].text in _PLACING
        if end > first and not relative:
            result.append(tokens[at])
        elif end > first and placed:
            result += tokens[at:first]  # "that is lying on the shelf": where it is tells which one is meant
        elif words[0] in _STANDING and placed and end == first:
            sentence = next((i + 1 for i in range(len(result) - 1, -1, -1) if result[i].kind is Kind.STOP), 0)
            asked = result[sentence:] != [] and result[sentence].text in ("is", "are")
            copula = asked or (result != [] and result[-1].text in section("be") | {"be"})
            finite = words[0].endswith("s") or _relates(result)
            said = () if copula else ("is",) if finite else ("that", "is")
            result += [replace(tokens[at], text=word) for word in said]
            at += 1
            continue
        at = end if end > first else at
        result += tokens[at : at + 1]
        at += 1
    return result


def _relates(before: list[Token]) -> bool:
    return bool(before) and before[-1].text in ("that", "which", "who")


def _passive_question(tokens: list[Token]) -> list[Token]:
    """Read "could the lamp be turned off" as "the lamp should be turned off"."""
    be = next((i for i, t in enumerate(tokens) if t.text == "be"), 0)
    words = [t.text for t in tokens[:be]]
    if len(words) < 2 or words[0] not in _ASKING or words[1] in ("there", "you"):
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
    if not negated or not rest or rest[0].text not in _NOTHING or tokens[0].text not in SPEAKERS:
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


_SENTENCES = (
    Idiom(_passive_question, frozenset({"be"})),
    *CONTRASTS,
    *IDIOMS,
    Idiom(_absent, frozenset({"nothing", "no", "none"})),
    Idiom(_negative_state),
    Idiom(_coordinated_states, frozenset({"be"})),
    Idiom(_unwanted, frozenset({"want"})),
    Idiom(_lovely, frozenset({"would"})),
    Idiom(_in_the_same, frozenset({"same"})),
    Idiom(_not_bothered, frozenset({"bother"})),
    Idiom(_verbless_first, frozenset({"then"})),
    Idiom(_given, frozenset({"give"})),
    Idiom(_not_about, frozenset({"leave"})),
    Idiom(_of_oneself),
)
"""What is done with each sentence, in this order."""
