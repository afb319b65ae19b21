"""Prepare the token stream of the clause grammar: particles, separators against conjunctions, fillers out."""

from __future__ import annotations

from itertools import pairwise

from tmd.language.clause import Span
from tmd.language.lexicon.lexicon import Lexicon, section, singular
from tmd.language.syntax.tokens import Kind, Token, fold

ALONE = "alone"
"""The form of a verb that lost its object to a slip: it shares none."""
ALSO = "also"
"""The form of a preposition after a conjunction: "near the wall and near the door"."""
_PURE = frozenset({"up", "down", "out", "away", "back", "together", "apart", "aside", "around"})
"""Particles that stay particles even when a noun follows."""
_FREE = frozenset({"up", "out"})
"""Particles of any verb that acts on something, before its object."""
_FINAL = frozenset({"up", "off", "in", "down", "away"})
"""... and behind it."""
_MEASURES = frozenset(
    {"spoon", "spoonful", "tablespoon", "teaspoon", "pinch", "handful", "dash", "drop", "slice", "cube"}
)
_NP = frozenset({Kind.DET, Kind.NUM, Kind.N, Kind.PRON})
_HEADS = frozenset({Kind.N, Kind.PRON})
_INSIDE = frozenset({Kind.DET, Kind.NUM, Kind.N, Kind.PRON, Kind.ADJ, Kind.ADV, Kind.FILLER})
_SCALES = frozenset({"heat", "flame", "fire", "power", "speed", "volume", "temperature", "setting"})
_ON_OFF = frozenset({"turn", "switch", "shut", "power"})
CHOICE = "choice"
"""The form of what "or" joins to what stands before it."""
_LINKS = frozenset({Kind.COMMA, Kind.CC})
_WHOLES = frozenset({"everything", "anything", "all", "every", "each", "everybody", "nothing"})
_RESULT_VERBS = frozenset({"make", "get", "have", "keep", "leave", "turn", "want", "set"})
"""What stands behind their object may be the state that it shall be in ..."""
_PLAIN_VERBS = frozenset(
    {"push", "pull", "put", "swing", "slide", "tie", "lock", "switch", "hold", "prop", "find", "pop", "crack", "throw",
     "slam", "pry", "yank", "ease", "nudge", "fling", "kick"}
)  # fmt: skip
"""... and behind that of these, if it is one of the next."""
_STATES = frozenset({"open", "shut", "closed", "on", "off", "alone", "ready", "full", "empty", "done", "up", "down"})
NO_NOUN = "says how something is, and not what"
_ENDS = (Kind.STOP, Kind.COMMA, Kind.SEP)
_VISIBLE = frozenset({Kind.V, *_NP, Kind.P, Kind.OF, Kind.CONJ, Kind.VCC, Kind.SEP, Kind.MOD})


def chunk(tokens: list[Token], lexicon: Lexicon) -> list[Token]:
    """Return the tokens the grammar sees, in order."""
    _exceptions(tokens)
    tokens = _settings(_with_states(_ones(_numbered(_partitives(tokens)))))
    _particles(tokens, lexicon)
    _leads(tokens)
    _sentences(tokens)
    for verb, modifier in pairwise(tokens):
        if verb.kind is Kind.V and modifier.kind is Kind.ADV:
            verb.form = ALONE
    tokens = [t for t in tokens if t.kind not in (Kind.FILLER, Kind.ADV, Kind.ADJ, Kind.SKIP)]
    tokens = _links(_drop_dangling(tokens))
    return [t for t in tokens if t.kind in _VISIBLE]


def _exceptions(tokens: list[Token]) -> None:
    """Read "everything but the cup", "all of them except for the cup": *but* is a preposition there."""
    for at, token in enumerate(tokens[1:-1], 1):
        end = next((i for i in range(at, len(tokens)) if tokens[i].kind in _ENDS), len(tokens))
        # "all the cups on the table but the red one on the shelf" makes no exception
        last = not any(t.kind is Kind.P for t in tokens[at + 1 : end])
        whole = any(t.text in _WHOLES for t in tokens[max(0, at - (7 if last else 4)) : at])
        if token.text in ("but", "save") and whole and tokens[at + 1].kind in _NP | {Kind.ADJ}:
            token.kind, token.text = Kind.P, "except"
            if tokens[at + 1].text == "for":
                tokens[at + 1].kind = Kind.FILLER


def _with_states(tokens: list[Token]) -> list[Token]:
    """Fold "with the door shut", which says how something shall be besides."""
    result: list[Token] = []
    at = 0
    while at < len(tokens):
        end = at + 1
        while end < len(tokens) and tokens[end].kind in (Kind.DET, Kind.N, Kind.NUM):
            end += 1
        noun = end > at + 1 and tokens[end - 1].kind is Kind.N
        last = end + 1 == len(tokens) or (
            end < len(tokens) and tokens[end + 1].kind in (Kind.STOP, Kind.CC, Kind.COMMA)
        )
        if tokens[at].text == "with" and noun and end < len(tokens) and tokens[end].text in _STATES and last:
            result.append(fold(tokens[at : end + 1], Kind.MOD, " ", "condition"))
            at = end + 1
        else:
            result.append(tokens[at])
            at += 1
    return result


def _leads(tokens: list[Token]) -> None:
    """Keep beside each noun the determiners, numerals and adjectives before it; beside a verb the state it asks for."""
    lead: list[str] = []
    alone: list[Token] = []  # adjectives whose noun is still to come
    verb: Token | None = None
    for at, token in enumerate(tokens):
        if token.kind in (Kind.N, Kind.PRON):
            token.lead, lead, alone = lead, [], []
        elif token.kind in (Kind.DET, Kind.NUM, Kind.ADJ) or _modifies(tokens, at):
            lead.append(token.text)
            if _stands_alone(tokens, at) and not (verb is not None and _is_state(tokens, at, verb)):
                alone.append(token)
        elif token.kind not in (Kind.FILLER, Kind.ADV):
            for adjective in alone:
                adjective.note = NO_NOUN
            lead, alone = [], []
        if token.kind in (Kind.V, Kind.STOP, Kind.SEP):
            verb = token if token.kind is Kind.V else None
        if verb is not None and token is not verb and _is_state(tokens, at, verb):
            verb.lead.append(token.text)
            verb.parts.append(token.span)


def _stands_alone(tokens: list[Token], at: int) -> bool:
    """Tell whether a participle between commas has no noun: "a coffee, sweetened, please"."""
    token = tokens[at]
    behind = tokens[at + 1].kind if at + 1 < len(tokens) else Kind.STOP
    apart = bool(at) and tokens[at - 1].kind is Kind.COMMA and behind in (Kind.COMMA, Kind.STOP, Kind.CC)
    return token.kind is Kind.ADJ and token.form == "ed" and apart


def _modifies(tokens: list[Token], at: int) -> bool:
    """Tell whether a participle, which is dropped like an adverb, tells which thing is meant: "the used cup"."""
    token = tokens[at]
    following = tokens[at + 1] if at + 1 < len(tokens) else None
    return token.kind is Kind.FILLER and token.form == "ed" and following is not None and following.kind is Kind.N


def _is_state(tokens: list[Token], at: int, verb: Token) -> bool:
    """Tell whether a word says how something shall be in the end: "get it boiling", "keep the door shut"."""
    token = tokens[at]
    following = tokens[at + 1] if at + 1 < len(tokens) else None
    ends = following is None or following.kind not in (Kind.N, Kind.NUM, Kind.ADJ, Kind.DET, Kind.PRON)
    if token.text in ("on", "off", "up", "down"):
        ends = following is None or following.kind in (Kind.STOP, Kind.COMMA, Kind.CC, Kind.SEP, Kind.ADV)
    said = token.kind is Kind.ADJ or token.text in _STATES or token.form in ("ed", "ing")
    hosts = verb.stem in _RESULT_VERBS or (verb.stem in _PLAIN_VERBS and token.text in _STATES)
    noun_before = any(t.kind in (Kind.N, Kind.PRON) for t in tokens[max(0, at - 3) : at]) or verb.stem == "leave"
    return hosts and said and ends and noun_before and token.kind not in (Kind.N, Kind.V, Kind.PRON, Kind.DET)


def _sentences(tokens: list[Token]) -> None:
    """Number the sentences that verbs stand in, and mark those after "otherwise"."""
    number, otherwise = 0, False
    last: Token | None = None
    for at, token in enumerate(tokens):
        if token.kind is Kind.STOP and token.text[:1] in ".!?":
            number, last = number + 1, None
        if token.kind is Kind.STOP and token.text == ":" and last is not None:
            last.heading = any(t.kind is Kind.V for t in tokens[at + 1 :])
        otherwise = otherwise or token.text in ("otherwise", "else", "if_not")
        if token.kind is Kind.V:
            token.sentence, token.otherwise, otherwise, last = number, otherwise, False, token


def _following(tokens: list[Token], at: int) -> Token | None:
    for token in tokens[at + 1 : at + 12]:
        if token.kind not in (Kind.ADV, Kind.FILLER, Kind.ADJ):
            return token
    return None


def _partitives(tokens: list[Token]) -> list[Token]:
    """Read "all of the cups" as "the cups"."""
    for at, token in enumerate(tokens[:-1]):
        of = tokens[at + 1]
        listed = token.text in section("partitives") and token.kind in (Kind.N, Kind.PRON, Kind.DET)
        counts = token.kind is Kind.NUM and not (at and tokens[at - 1].kind is Kind.N)
        quantity = listed or counts
        if quantity and of.kind is Kind.P and of.text == "of":
            of.kind = Kind.FILLER
            token.kind = Kind.DET
    return tokens


def _numbered(tokens: list[Token]) -> list[Token]:
    """Join "burner 2" to one noun; a numeral without a noun is a noun itself."""
    result: list[Token] = []
    for at, token in enumerate(tokens):
        following = _following(tokens, at)
        if token.text == "half" and following is not None and following.kind is Kind.DET:
            token.kind = Kind.FILLER
        each_other = at + 1 < len(tokens) and tokens[at + 1].text == "each_other"
        if token.kind is Kind.P and each_other:
            token.kind = Kind.FILLER
        counted = following is not None and (following.kind in (Kind.N, Kind.NUM) or following.text == "more")
        if token.kind is Kind.NUM and not counted:
            before = result[-1] if result else None
            if before is not None and before.kind is Kind.N and token.text == "one":
                token.kind = Kind.N  # "the red one"
                result.append(token)
                continue
            if before is not None and before.kind is Kind.N:
                joined = fold([before, token], Kind.N)
                joined.parts = before.parts
                result[-1] = joined
                continue
            of = following is not None and following.text == "of"
            parts = token.text.endswith("s") or token.text == "dozen"
            token.kind = Kind.DET if of else Kind.N if parts else Kind.PRON
        result.append(token)
    return result


def _ones(tokens: list[Token]) -> list[Token]:
    """Let "ones" carry the words that tell which: "the white ones"."""
    for lead, before, token in zip(tokens, tokens[1:], tokens[2:], strict=False):
        which = before.kind is Kind.N and lead.kind in (Kind.DET, Kind.NUM, Kind.ADJ, Kind.N)
        if token.kind is Kind.PRON and token.text in ("one", "ones") and which:
            token.kind = Kind.N
    return tokens


def _settings(tokens: list[Token]) -> list[Token]:
    """Fold "on high", "to full": a setting without a noun says how."""
    for at, token in enumerate(tokens[:-1]):
        if token.text in section("settings") and tokens[at + 1].text in _SCALES:
            token.kind = Kind.ADJ
        if token.kind is not Kind.P or token.text not in ("on", "to", "at", "in"):
            continue
        place = at + 2 if tokens[at + 1].text == "the" else at + 1
        if place >= len(tokens) or tokens[place].text not in section("settings"):
            continue
        setting = tokens[place]
        after = tokens[place + 1] if place + 1 < len(tokens) else None
        if after is None or (after.kind not in (Kind.N, Kind.PARTICIPLE) and after.text != "of"):
            setting.kind, setting.form = Kind.MOD, "setting"
            if token.text != "on":
                token.kind = Kind.FILLER
    return tokens


def _opposites(tokens: list[Token]) -> None:
    """Give "the lamp off" of "turn on the tv and the lamp off" a verb of its own; "crack open" is open."""
    for at, verb in enumerate(tokens):
        following = tokens[at + 1] if at + 1 < len(tokens) else None
        if verb.kind is not Kind.V or following is None:
            continue
        if following.text in ("open", "shut") and _following(tokens, at + 1) is not None:
            lead = _following(tokens, at + 1)
            if lead is not None and lead.kind in _NP and verb.stem not in _RESULT_VERBS:
                _absorb(verb, [following], "open" if following.text == "open" else "close")
        if verb.stem not in ("turn_on", "turn_off"):
            continue
        for place in range(at + 1, len(tokens) - 2):
            link = tokens[place]
            end = place + 1
            while end < len(tokens) and tokens[end].kind in (Kind.DET, Kind.NUM, Kind.ADJ, Kind.N):
                end += 1
            said = end < len(tokens) and end > place + 1 and tokens[end].text in ("on", "off")
            last = end + 1 >= len(tokens) or tokens[end + 1].kind in (Kind.STOP, Kind.CC, Kind.COMMA)
            if link.kind in _LINKS and said and last:
                link.kind, link.form, link.strength = Kind.V, "base", 3
                _absorb(link, [tokens[end]], f"turn_{tokens[end].text}")
                break
            if link.kind in (Kind.V, Kind.STOP):
                break


def _particles(tokens: list[Token], lexicon: Lexicon) -> None:
    """Join each verb with its particle, beside it or behind its object."""
    _opposites(tokens)
    for at, verb in enumerate(tokens):
        if verb.kind is Kind.V and verb.stem:
            _join_multiword(tokens, at) or _join_particle(tokens, at, lexicon)


def _join_multiword(tokens: list[Token], at: int) -> bool:
    """Join "get rid of", "take care of", "look for"."""
    verb = tokens[at]
    for length in (3, 2):
        run = tokens[at : at + length]
        name = "_".join([verb.stem, *(t.text for t in run[1:])])
        if len(run) == length and name in section("verb_of"):
            _absorb(verb, run[1:], name)
            return True
    for end, token in enumerate(tokens[at + 1 : at + 15], at + 1):
        if token.kind in (Kind.V, Kind.STOP, Kind.SEP):
            break
        boils = token.text in ("boil", "simmer") and verb.stem == "bring" and tokens[end - 1].text in ("to", "the", "a")
        if boils:
            to = next((t for t in reversed(tokens[at + 1 : end]) if t.text == "to"), None)
            if to is not None:
                _absorb(verb, [to, *tokens[tokens.index(to) + 1 : end + 1]], "bring_to_boil")
                return True
        if token.text == "ready" and f"{verb.stem}_ready" in section("verb_of"):
            _absorb(verb, tokens[end : end + 1], f"{verb.stem}_ready")
            return True
    return False


def _absorb(verb: Token, others: list[Token], stem: str) -> None:
    verb.stem = stem
    for token in others:
        token.kind = Kind.FILLER
        verb.parts.append(token.span)


def _join_particle(tokens: list[Token], at: int, lexicon: Lexicon) -> bool:
    verb = tokens[at]
    preposition = False
    for place, token in enumerate(tokens[at + 1 :], at + 1):
        if token.kind in (Kind.V, Kind.STOP, Kind.SEP, Kind.SKIP):
            return False
        if token.kind is Kind.MOD and token.form != "setting":
            return False
        again = token.text == "back" and verb.stem in _ON_OFF and place + 1 < len(tokens)
        if token.kind not in (Kind.P, Kind.ADV) or (again and tokens[place + 1].text in ("on", "off")):
            continue
        if token.text == "of" and place == at + 1 and verb.stem in _ON_OFF:
            token.text = "off"
        if token.text == "up_to" and not preposition and lexicon.particle(verb.stem, "up") is not None:
            _split_up_to(verb, token)
            return True
        if verb.stem in ("leave", "keep") and token.text in ("on", "off") and place > at + 1:
            return False  # "leave the radio on": as it is, and no particle
        match = lexicon.particle(verb.stem, token.text)
        if match is None and not preposition and _moves_object(tokens, at, place):
            match = False
        behind = preposition and token.text not in _PURE and not match
        if match is not None and not behind and _is_particle(tokens, at, place, match):
            stem = verb.stem
            _absorb(verb, [token], f"{stem}_{token.text}")
            _second_particle(tokens, place, stem, lexicon)
            return True
        preposition = preposition or token.kind is Kind.P
    return False


def _second_particle(tokens: list[Token], at: int, stem: str, lexicon: Lexicon) -> None:
    """Give "the radio on" of "turn the tv off and the radio on" a verb of its own, where the conjunction stands."""
    link = tokens[at + 1] if at + 1 < len(tokens) else None
    if link is None or link.kind is not Kind.CC:
        return
    end = at + 2
    while end < len(tokens) and tokens[end].kind in _INSIDE and lexicon.particle(stem, tokens[end].text) is None:
        end += 1
    if end == at + 2 or end >= len(tokens) or lexicon.particle(stem, tokens[end].text) is None:
        return
    following = _following(tokens, end)
    if following is None or following.kind in (Kind.STOP, Kind.CC, Kind.COMMA):
        link.kind, link.form, link.strength = Kind.V, "base", 3
        _absorb(link, [tokens[end]], f"{stem}_{tokens[end].text}")


def _moves_object(tokens: list[Token], at: int, place: int) -> bool:
    """Tell whether "up" or "out" goes with a verb of no list: "fluff up the pillows", "fluff them up"."""
    verb, text = tokens[at], tokens[place].text
    if text not in (_FREE if place == at + 1 else _FINAL) or verb.stem in section("intransitive") | section(
        "chain_verbs"
    ) | section("lead_verbs"):
        return False
    following = _following(tokens, place)
    if place == at + 1:
        return following is not None and following.kind in _NP
    object_before = all(t.kind in _INSIDE for t in tokens[at + 1 : place])
    return object_before and (following is None or following.kind in (Kind.STOP, Kind.CC, Kind.COMMA))


def _split_up_to(verb: Token, token: Token) -> None:
    """Give "up" of "hook it up to the set" to the verb."""
    start, end = token.span
    verb.stem, token.text = f"{verb.stem}_up", "to"
    verb.parts.append(Span(start, start + 2))
    token.span = Span(end - 2, end)


def _is_particle(tokens: list[Token], at: int, place: int, strict: bool) -> bool:
    text = tokens[place].text
    following = _following(tokens, place)
    noun = following is not None and following.kind in _NP
    if not noun or text in _PURE:
        return True
    adjacent = all(t.kind in (Kind.ADV, Kind.FILLER) for t in tokens[at + 1 : place])
    return adjacent and (strict or text == "off" or _takes_particle(tokens, at, place))


def _takes_particle(tokens: list[Token], at: int, place: int) -> bool:
    """Tell "put on some music" from "put on the table" by the head of the noun phrase."""
    text, head, fresh = tokens[place].text, "", False
    for token in tokens[place + 1 :]:
        if token.text == "of" and singular(head) in _MEASURES:
            continue
        if token.kind not in (Kind.DET, Kind.NUM, Kind.ADJ, Kind.N, Kind.PRON):
            break
        fresh = fresh or token.text in ("new", "fresh", "another")
        if token.kind in (Kind.N, Kind.PRON):
            head = token.text
    if text not in ("on", "in"):
        return False
    if tokens[at].stem in ("put", "place"):
        return head in section(f"put_{text}_objects") or (fresh and singular(head) not in section("containers"))
    return singular(head) not in section("containers")


def _drop_dangling(tokens: list[Token]) -> list[Token]:
    """Drop determiners, numerals and "of" without a noun behind them; mark the other "of"."""
    backwards: list[Token] = []
    for at in range(len(tokens) - 1, -1, -1):
        token = tokens[at]
        following = backwards[-1].kind if backwards else Kind.STOP
        leads = token.kind in (Kind.DET, Kind.NUM) or (token.kind is Kind.P and token.text == "of")
        if leads and following not in _NP:
            if at and tokens[at - 1].kind is Kind.V:
                tokens[at - 1].form = ALONE
            continue
        backwards.append(token)
    kept = backwards[::-1]
    for before, token in pairwise(kept):
        if token.kind is Kind.P and token.text == "of" and before.kind in _HEADS:
            token.kind = Kind.OF
    return kept


def _opens_clause(tokens: list[Token], at: int) -> bool:
    """Tell whether a prepositional phrase belongs to the verb after it: "and, using a spoon, scoop some"."""
    for place, token in enumerate(tokens[at + 1 : at + 9], at + 1):
        if token.kind is Kind.COMMA:
            return place + 1 < len(tokens) and tokens[place + 1].kind is Kind.V
        if token.kind not in _NP and token.kind is not Kind.OF:
            return False
    return False


def _fronts(tokens: list[Token], at: int) -> bool:
    """Tell whether a condition belongs to the verb after it: "take the cup and, if it is dirty, wash it"."""
    said = at < len(tokens) and tokens[at].kind is Kind.MOD and tokens[at].form == "condition"
    if not said or tokens[at].text.startswith("with "):
        return False
    end = at + 1
    while end < len(tokens) and tokens[end].kind in _LINKS:
        end += 1
    return end < len(tokens) and tokens[end].kind is Kind.V


def _shares(verb: Token) -> bool:
    """Tell whether a verb takes the object of the next one: "wash and dry the pan"."""
    return verb.form != ALONE and verb.stem not in section("intransitive")


def _links(tokens: list[Token]) -> list[Token]:
    """Decide for each comma and conjunction: between nouns, between verbs, between clauses, or nothing."""
    result: list[Token] = []
    at = 0
    fronted = True  # no verb yet since the last separator
    while at < len(tokens):
        token = tokens[at]
        if token.kind is Kind.STOP:
            token.kind = Kind.SEP
        if token.kind not in _LINKS:
            if token.kind in (Kind.V, Kind.SEP):
                fronted = token.kind is Kind.SEP
            result.append(token)
            at += 1
            continue
        end = at
        while end < len(tokens) and tokens[end].kind in _LINKS:
            end += 1
        before = result[-1].kind if result else Kind.SEP
        after = tokens[end].kind if end < len(tokens) else Kind.SEP
        choice = any(t.text == "or" for t in tokens[at:end])
        token.form = CHOICE if choice else token.form
        if after is Kind.V and choice:
            tokens[end].form = CHOICE
        if not fronted and _fronts(tokens, end):
            token.kind, fronted = Kind.SEP, True
            result.append(token)
        elif after is Kind.V and not fronted:
            token.kind = Kind.VCC if before is Kind.V and _shares(result[-1]) else Kind.SEP
            result.append(token)
        elif after is Kind.P and _opens_clause(tokens, end):
            token.kind, fronted = Kind.SEP, True
            result.append(token)
        elif after is Kind.P and any(t.kind is Kind.CC for t in tokens[at:end]):
            tokens[end].form = ALSO
        elif before in _HEADS and after in _NP:
            token.kind = Kind.CONJ
            result.append(token)
        at = end
    return result
