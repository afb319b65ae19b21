"""Bring decided words into the shape of the clause grammar (``clauses.lark``).

Numbers, partitives and settings are joined, particles go to their verbs, subordinate clauses are bracketed, and each
comma and conjunction gets its class. Each pass is linear in the length of the text, up to a bounded look ahead.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

from tmd.language.clause import Span
from tmd.language.lexicon.lexicon import Lexicon, pairs, section, sections, singular
from tmd.language.syntax.tokens import Kind, Token, fold

K = Kind
CHOICE = "choice"
"""The form of what "or" joins to what stands before it."""
ALSO = "also"
"""The form of a preposition after a conjunction: "near the wall and near the door"."""
RELATIVE = "relative"
"""The form of a preposition that opens what was a relative clause: "the remote that is on the sofa"."""
DUTY = "duty"
"""The form of the opener of a statement that says what shall be."""
ALONE = "alone"
"""The form of a verb that lost its object to a slip: it shares none."""
STATEMENT = "a statement, not an instruction"
UNNEEDED = "says what need not be done"
REMINDER = "names a thing, and not what to do with it"
ADDRESS = "addresses somebody"
ASIDE = "an aside in brackets"
QUESTION = "a question, not an instruction"
CORRECTED = "taken back by what was said next"

_NP = frozenset({K.DET, K.NUM, K.ADJ, K.N, K.PRON})
_HEADS = frozenset({K.N, K.PRON})
_LINKS = frozenset({K.COMMA, K.CC})
_BREAKS = frozenset({K.STOP, K.COMMA, K.CC, K.SEP})
_IDLE = frozenset({K.ADV, K.FILLER})
_NOMINAL = _NP | {K.P, K.ADV, K.MOD, K.EXC, K.TO}
_VERBAL = frozenset({K.AUX, K.FINITE, K.PARTICIPLE, K.ING, K.V})
_OPENERS = frozenset({K.SUB, K.PURP, K.REL, K.NEG, K.WITHOUT, K.ENSURE, K.SAY})
_FOLLOWERS = {K.CONJ: _NP | {K.STATE}, K.VCC: _VERBAL, K.LINK: _NOMINAL | _VERBAL | _OPENERS | {K.STATE}}
"""What may stand behind a joint."""
_DEPTH = 3
"""Maximum nesting depth of subordinate clauses."""
_AHEAD = 15
"""Tokens between a verb and its particle, at most."""


def shape(tokens: list[Token], lexicon: Lexicon) -> tuple[list[Token], list[Token]]:
    """Return the terminals of the clause grammar, in order, and what speakers have taken back."""
    tokens = _copulas(tokens)
    _placings(tokens)
    tokens = _settings(_numbered(_partitives(tokens)))
    _exceptions(tokens)
    _particles(tokens, lexicon)
    _mark_sentences(tokens)
    shaper = _Shaper(tokens, lexicon)
    shaper.main(0, len(tokens))
    return _drop_dangling(_link(shaper.out)), shaper.dropped


def next_of(tokens: Sequence[Token], at: int, skip: frozenset[Kind] = _IDLE) -> Token | None:
    """Return the next token behind ``at`` that is of none of the kinds to skip."""
    return next((t for t in tokens[at + 1 : at + 12] if t.kind not in skip), None)


def _kind(token: Token | None) -> Kind:
    return token.kind if token is not None else K.STOP


# -- joins -------------------------------------------------------------------------------------------------------------


def _copulas(tokens: list[Token]) -> list[Token]:
    """Read "the bin's open", "the kettle's on the stove" with "is": no owner stands before such words."""
    result: list[Token] = []
    for at, token in enumerate(tokens):
        result.append(token)
        follows = next_of(tokens, at, frozenset({K.ADV}))
        if token.kind is K.DET and token.text in section("its_words") and _kind(follows) in (K.P, K.ADJ) and not _owns(tokens, at):
            token.kind, token.text = K.PRON, sections()["singular_pronouns"][0]
            result.append(Token(K.AUX, sections()["be"][0], Span(token.span.end, token.span.end)))
            continue
        beyond = tokens[at + 2].kind if at + 2 < len(tokens) else K.STOP
        states = follows is not None and (follows.kind is K.P or (follows.kind in (K.ADJ, K.ING, K.PARTICIPLE) and beyond in _BREAKS))
        if token.form == "possessive" and token.kind is K.N and (states or follows is None or follows.text in section("end_states")):
            end = token.span.end
            result.append(Token(K.AUX, sections()["be"][0], Span(end, end)))
    return result


def _owns(tokens: list[Token], at: int) -> bool:
    """Tell whether a noun that a possessive belongs to follows."""
    after = next((t for t in tokens[at + 1 : at + 6] if t.kind not in (K.ADJ, K.ADV, K.NUM)), None)
    return _kind(after) is K.N


def _partitives(tokens: list[Token]) -> list[Token]:
    """Read "all of the cups" as "the cups"; mark the other "of"."""
    for at, (token, of) in enumerate(pairwise(tokens)):
        if of.kind is not K.P or of.text not in section("of_words"):
            continue
        listed = token.text in section("partitives") and token.kind in (K.N, K.PRON, K.DET)
        if listed or (token.kind is K.NUM and not (at and tokens[at - 1].kind is K.N)):
            of.kind, token.kind = K.FILLER, K.DET
            if [t.kind for t in tokens[at + 2 : at + 4]] == [K.DET, K.NUM]:
                tokens[at + 3].kind = K.FILLER  # "one of the two lamps": how many there are picks none of them
        elif token.kind in _HEADS:
            of.kind = K.OF
    return tokens


def _numbered(tokens: list[Token]) -> list[Token]:
    """Join "burner 2" to one noun; a numeral without a noun is a noun itself; "ones" carries what tells which."""
    result: list[Token] = []
    for at, token in enumerate(tokens):
        following = next_of(tokens, at, _IDLE | {K.ADJ})
        before = result[-1] if result else None
        one = token.text in section("one_words")
        if token.kind in (K.DET, K.ADJ) and token.text in section("other_words") and _kind(following) not in (K.N, K.NUM, K.PRON):
            token.kind = K.PRON  # "and another in the crate"
        if one and token.kind in (K.NUM, K.PRON) and before is not None and before.kind is K.N:
            token.kind = K.N  # "the red one"
        elif token.kind is K.NUM and _kind(following) is K.DET and token.text in section("fractions"):
            pass  # "half a cup"
        elif token.kind is K.NUM and _kind(following) not in (K.N, K.NUM):
            if before is not None and before.kind is K.N:
                joined = fold([before, token], K.N)
                joined.parts = before.parts
                result[-1] = joined
                continue
            token.kind = K.PRON if singular(token.text) == token.text else K.N
        result.append(token)
    return result


def _settings(tokens: list[Token]) -> list[Token]:
    """Fold "on high", "to full": a setting without a noun says how."""
    for at, token in enumerate(tokens[:-1]):
        last = next_of(tokens, at + 1)
        if token.kind in (K.N, K.NUM) and tokens[at + 1].text in section("settings") and _kind(last) in _BREAKS:
            tokens[at + 1].kind, tokens[at + 1].form = K.MOD, "setting"  # "turn the sound low", "sound low"
        if token.kind not in (K.P, K.TO) or token.text not in section("setting_places"):
            continue
        place = at + 1 + (tokens[at + 1].kind is K.DET)
        setting = tokens[place] if place < len(tokens) else token
        after = tokens[place + 1] if place + 1 < len(tokens) else None
        if setting.text not in section("settings"):
            continue
        if after is not None and after.text in section("scales"):
            after.kind = K.FILLER
            setting.parts.append(after.span)
        elif _kind(after) in (K.N, K.PARTICIPLE) or (after is not None and after.text in section("of_words")):
            continue
        setting.kind, setting.form, token.kind = K.MOD, "setting", K.FILLER
        setting.parts.append(token.span)
    return tokens


def _exceptions(tokens: list[Token]) -> None:
    """Mark what opens an exception: "except", and "but" or "save" behind a word for all there is."""
    whole = -_AHEAD
    for at, token in enumerate(tokens):
        if token.text in section("whole_words") | section("all_words"):
            whole = at
        elif token.kind in (K.STOP, K.COMMA, K.V):
            whole = -_AHEAD
        named = token.kind is K.P and token.text in section("exceptions")
        follows = _kind(next_of(tokens, at))
        but = token.text in section("exceptive") and at - whole < _AHEAD // 2 and follows in _NP
        if named or but:
            token.kind = K.EXC


def _placings(tokens: list[Token]) -> None:
    """Mark "goes" and "belongs" behind a subject as finite verbs: "both books go on the shelf"."""
    subject = verb = False
    for at, token in enumerate(tokens):
        if token.kind in (K.STOP, K.COMMA, K.CC, K.SUB, K.ENSURE):
            subject = subject and token.kind is K.CC and not verb
            verb = False
            continue
        follows = next_of(tokens, at, frozenset())
        place = follows is not None and (follows.kind in (K.P, K.TO, K.STATE) or follows.text in section("back_words") | section("where_words"))
        stays = follows is None or follows.kind in _BREAKS or follows.text in section("there_words")
        if token.text in section("belonging") and subject and not verb and place:
            token.kind, token.stem, verb = K.FINITE, sections()["belonging"][0], True
        elif token.text in pairs("standing") and subject and not verb and (place or stays):
            token.kind, token.stem, verb = K.FINITE, pairs("standing")[token.text], True
        subject = subject or token.kind in (K.N, K.PRON, K.NUM)
        verb = verb or token.kind in (K.V, K.LET)


def _mark_sentences(tokens: list[Token]) -> None:
    """Number the sentences that verbs stand in; mark headings, and verbs behind "otherwise"."""
    number, otherwise = 0, False
    last: Token | None = None
    for at, token in enumerate(tokens):
        if token.kind is K.STOP and token.text[:1] in ".!?":
            number, last = number + 1, None
        if token.kind is K.STOP and token.text == ":" and last is not None:
            last.heading = any(t.kind is K.V for t in tokens[at + 1 :])
        otherwise = otherwise or token.text in section("otherwise_words")
        if token.kind is K.V:
            token.sentence, token.otherwise, otherwise, last = number, otherwise, False, token


# -- particles ---------------------------------------------------------------------------------------------------------


def _particles(tokens: list[Token], lexicon: Lexicon) -> None:
    """Join each verb with its particle, beside it or behind its object."""
    for at, verb in enumerate(tokens):
        deed = verb.kind is K.ING and (not at or tokens[at - 1].kind not in _HEADS)
        if (verb.kind in (K.V, K.LET) or deed) and verb.stem:
            if not _join_multiword(tokens, at):
                _join_particle(tokens, at, lexicon)
        elif verb.kind in (K.PARTICIPLE, K.FINITE, K.ING) and verb.stem not in ("", "go"):
            after = tokens[at + 1] if at + 1 < len(tokens) else None
            ends = _kind(next_of(tokens, at + 1)) not in _NP
            if after is not None and after.kind in (K.P, K.ADV) and lexicon.particle(verb.stem, after.text) and ends:
                _absorb(verb, [after], f"{verb.stem}_{after.text}")


def _join_multiword(tokens: list[Token], at: int) -> bool:
    """Join "get rid of", "look for", and "bring it to the boil"."""
    verb = tokens[at]
    for length in (3, 2):
        run = tokens[at : at + length]
        name = "_".join([verb.stem, *(t.text for t in run[1:])])
        if len(run) == length and name in section("verb_of"):
            _absorb(verb, run[1:], name)
            return True
    for end, token in enumerate(tokens[at + 1 : at + _AHEAD], at + 1):
        if token.kind in (K.STOP, K.SEP) or (token.kind is K.V and tokens[end - 1].kind is not K.TO):
            break
        start = end - 1 if tokens[end - 1].kind is not K.DET else end - 2
        for words in ([token], [tokens[start], token]):
            name = "_".join([verb.stem, *(t.text for t in words)])
            if name in section("split_verbs"):
                _absorb(verb, tokens[start : end + 1] if len(words) > 1 else words, name)
                return True
    return False


def _absorb(verb: Token, others: list[Token], stem: str) -> None:
    verb.stem = stem
    for token in others:
        token.kind = K.FILLER
        verb.parts.append(token.span)


def _join_particle(tokens: list[Token], at: int, lexicon: Lexicon) -> bool:
    verb, behind = tokens[at], False
    for place, token in enumerate(tokens[at + 1 : at + 1 + 2 * _AHEAD], at + 1):
        if token.kind in (K.V, K.LET, K.NEG, K.ENSURE, K.STOP, K.SEP, K.SUB, K.REL, K.EXC):
            return False
        if token.kind not in (K.P, K.ADV):
            continue
        if not behind and _split(verb, token, lexicon):
            return True
        keeps = verb.stem in section("leaving") | section("keeping")
        if keeps and place > at + 1 and token.text in section("end_states"):
            return False  # "leave the radio on": as it is, and no particle
        if place == at + 1 and token.text in section("opening") and _kind(next_of(tokens, place)) in _NP:
            _absorb(verb, [token], pairs("state_verbs")[token.text])  # "crack open the soda"
            return True
        match = lexicon.particle(verb.stem, token.text)
        if match is None and not behind and _moves_object(tokens, at, place):
            match = False
        pure = token.text in section("pure_particles")
        if match is not None and (not behind or pure or match) and _is_particle(tokens, at, place, match):
            stem = verb.stem
            _absorb(verb, [token], f"{stem}_{token.text}")
            _second_particle(tokens, place, stem, lexicon)
            return True
        behind = behind or token.kind is K.P
    return False


def _split(verb: Token, token: Token, lexicon: Lexicon) -> bool:
    """Give "up" of "hook it up to the set" to the verb."""
    first, _, rest = token.text.partition("_")
    if token.text not in section("parted") or lexicon.particle(verb.stem, first) is None:
        return False
    start, end = token.span
    verb.stem, token.text = f"{verb.stem}_{first}", rest
    verb.parts.append(Span(start, start + len(first)))
    token.span = Span(end - len(rest), end)
    return True


def _second_particle(tokens: list[Token], at: int, stem: str, lexicon: Lexicon) -> None:
    """Give "the radio on" of "turn the tv off and the radio on" a verb, where the conjunction stands."""
    link = tokens[at + 1] if at + 1 < len(tokens) else None
    if link is None or link.kind not in _LINKS:
        return
    end = at + 2
    while end < len(tokens) and tokens[end].kind in _NP | _IDLE and lexicon.particle(stem, tokens[end].text) is None:
        end += 1
    if end == at + 2 or end >= len(tokens) or lexicon.particle(stem, tokens[end].text) is None:
        return
    if _kind(next_of(tokens, end)) in _BREAKS:
        link.kind, link.form, link.strength = K.V, "base", 3
        _absorb(link, [tokens[end]], f"{stem}_{tokens[end].text}")


def _moves_object(tokens: list[Token], at: int, place: int) -> bool:
    """Tell whether "up" or "out" goes with a verb of no list: "fluff up the pillows", "fluff them up"."""
    verb, text, beside = tokens[at], tokens[place].text, place == at + 1
    none = section("intransitive") | section("chain_verbs") | section("lead_verbs")
    if verb.stem in none or text not in section("free_particles" if beside else "final_particles"):
        return False
    following = _kind(next_of(tokens, place))
    if beside:
        return following in _NP
    return all(t.kind in _NP | _IDLE for t in tokens[at + 1 : place]) and following in _BREAKS


def _is_particle(tokens: list[Token], at: int, place: int, strict: bool) -> bool:
    text, following = tokens[place].text, next_of(tokens, place)
    if _kind(following) not in _NP:
        return True
    adjacent = all(t.kind in _IDLE for t in tokens[at + 1 : place])
    if text in section("pure_particles"):
        return adjacent or text not in pairs("relation_names")
    return adjacent and (strict or _takes_particle(tokens, at, place))


def _takes_particle(tokens: list[Token], at: int, place: int) -> bool:
    """Tell "put on some music" from "put on the table" by the head of the noun phrase."""
    text, head, fresh = tokens[place].text, "", False
    for token in tokens[place + 1 :]:
        if token.kind is K.OF and singular(head) in section("measures"):
            continue
        if token.kind not in _NP:
            break
        fresh = fresh or token.text in section("fresh_words")
        head = token.text if token.kind in _HEADS else head
    contained = singular(head) in section("containers")
    if text not in section("object_particles"):
        return text in section("adjacent_particles")
    if tokens[at].stem in section("put_verbs"):
        return head in section(f"put_{text}_objects") or (fresh and not contained)
    return not contained


# -- subordinate clauses -----------------------------------------------------------------------------------------------


class _Shaper:
    """One pass over the decided tokens of a text; ``out`` is what the grammar sees, links still undecided."""

    def __init__(self, tokens: list[Token], lexicon: Lexicon) -> None:
        self.tokens = tokens
        self.lexicon = lexicon
        self.out: list[Token] = []
        self.verb: Token | None = None
        """The verb of the clause that is open."""
        self.subject = 0
        """Where in ``out`` the arguments begin that may be the subject of a statement."""
        self.depth = 0
        self.dropped: list[Token] = []
        """What speakers have taken back."""
        self.handlers: dict[Kind, Callable[[int, int], int]] = {
            K.STOP: self._stop,
            K.SUB: self._condition,
            K.PURP: self._purpose,
            K.TO: self._infinitive,
            K.REL: self._relative,
            K.NEG: self._negation,
            K.ENSURE: self._ensure,
            K.LET: self._let,
            K.SUBJECT: self._speaker,
            K.AUX: self._auxiliary,
            K.FINITE: self._auxiliary,
            K.PARTICIPLE: self._participle,
            K.ING: self._ing,
            K.P: self._preposition,
            K.V: self._verb,
            K.ADJ: self._adjective,
            K.ADV: self._adverb,
            K.N: self._noun,
            K.COMMA: self._comma,
            K.CC: self._joint,
            K.FILLER: self._drop,
            K.SKIP: self._drop,
        }
        self.inner: dict[Kind, Callable[[int, int], int]] = {
            **self.handlers,
            K.STOP: self._drop,
            K.TO: self._inner_to,
            K.NEG: self._inner_negation,
            K.ENSURE: self._drop,
            K.LET: self._inner_let,
            K.SUBJECT: self._inner_subject,
            K.AUX: self._inner_auxiliary,
            K.FINITE: self._keep,
            K.PARTICIPLE: self._keep,
            K.ING: self._keep,
            K.V: self._keep,
            K.DET: self._inner_determiner,
            K.N: self._inner_noun,
            K.COMMA: self._inner_joint,
            K.CC: self._inner_joint,
        }
        self.opener: list[Token] = []

    # the two walks

    def main(self, at: int, end: int) -> None:
        """Walk over what is outside of subordinate clauses."""
        while at < end:
            if self.tokens[at].text in section("corrections") and self.out:
                at = self._corrected(at)
            elif (question := self._question(at)) > at:
                at = self._skip(at, question, QUESTION)
            else:
                at = self.handlers.get(self.tokens[at].kind, self._keep)(at, end)

    def _question(self, at: int) -> int:
        """Return where a question that asks for nothing ends; ``at`` where none begins."""
        starts = not at or self._at(at - 1) in _IDLE | {K.STOP, K.CC}
        first = starts and self.tokens[at].text in section("questions") and (not self.out or self._last() in _BREAKS)
        if not first or self._at(at + 1) is K.ING:
            return at
        stop = next((i for i in range(at, len(self.tokens)) if self.tokens[i].kind is K.STOP), len(self.tokens) - 1)
        return stop if "?" in self.tokens[stop].text else at

    def _corrected(self, at: int) -> int:
        """Take back what a speaker corrects: "on the bench, no wait, in the shed": a place, a thing or a deed."""
        begin = at + 1
        while self._at(begin) in _LINKS | _IDLE:
            begin += 1
        kind = self._at(begin)
        until = {K.P, K.TO} if kind in (K.P, K.TO) else _NP if kind in _NP else {K.SEP}
        place = len(self.out)
        while place and (self.out[place - 1].kind in _LINKS or self.out[place - 1].text in section("none_words")):
            place -= 1
        while place and self.out[place - 1].kind not in until:
            place -= 1
        while place and kind in _NP and self.out[place - 1].kind in _NP:
            place -= 1
        place -= kind in (K.P, K.TO)
        for token in (self.tokens[at], *self.out[max(place, 0) :]):
            token.note = CORRECTED
        self.dropped += [self.tokens[at], *self.out[max(place, 0) :]]
        del self.out[max(place, 0) :]
        if self.verb is not None and self.verb.note:
            self.verb, self.subject = None, len(self.out)
        return begin

    def _inside(self, at: int, end: int) -> None:
        while at < end:
            at = self.inner.get(self.tokens[at].kind, self._keep)(at, end)

    def _bracket(self, opener: Token, kind: Kind, at: int, end: int) -> int:
        """Emit an opener, what stands from ``at`` to ``end``, and the closing mark."""
        if self.depth >= _DEPTH or end <= at:
            return max(end, at)
        opener.kind = kind
        self.out.append(opener)
        self._fill(opener, at, end)
        return end

    def _fill(self, opener: Token, at: int, end: int) -> None:
        self.opener.append(opener)
        self.depth += 1
        self._inside(at, end)
        self.depth -= 1
        self.opener.pop()
        last = self.tokens[end - 1].span.end
        self.out.append(Token(K.END, "", Span(last, last)))
        fronted = all(t.kind in (K.COMMA, K.CC) for t in self.out[self.subject : self.out.index(opener, self.subject)])
        if self.verb is None and not self.depth and fronted:
            self.subject = len(self.out)

    def _at(self, at: int) -> Kind:
        return self.tokens[at].kind if at < len(self.tokens) else K.STOP

    def _peek(self, at: int, skip: frozenset[Kind] = frozenset({K.ADV, K.FILLER})) -> int:
        at += 1
        while at < len(self.tokens) and self.tokens[at].kind in skip:
            at += 1
        return at

    def _last(self) -> Kind:
        return self.out[-1].kind if self.out else K.SEP

    def _keep(self, at: int, end: int) -> int:
        self.out.append(self.tokens[at])
        return at + 1

    def _drop(self, at: int, end: int) -> int:
        return at + 1

    # main words

    def _stop(self, at: int, end: int) -> int:
        token = self.tokens[at]
        if token.text == ":" and self.verb is None and self._named() and self._at(at + 1) is K.V:
            return at + 1  # "the radio: put it in the crate"
        token.kind = K.SEP
        self.out.append(token)
        self.verb, self.subject = None, len(self.out)
        return at + 1

    def _verb(self, at: int, end: int) -> int:
        token = self.tokens[at]
        if token.stem in section("wishing") and self._wishes_state(at):
            return self._bracket(token, K.ENSURE, at + 1, self._statement_end(at + 1))
        self.out.append(token)
        self.verb = token
        if self._at(at + 1) is K.ADV:
            token.form = ALONE
        return at + 1

    def _wishes_state(self, at: int) -> bool:
        """Tell whether a wish is for a state: "I want the fork put in the sink", "I'd like the window to be open"."""
        for place in range(at + 2, min(at + _AHEAD, len(self.tokens) - 1)):
            if self._at(place) in (K.STOP, K.COMMA, K.V):
                break
            if self.tokens[place].form == "inf" and self._at(place + 1) is K.AUX and self._at(at + 1) is not K.PRON:
                return True
        place, things = at + 1, False
        while self._at(place) in _NOMINAL | {K.OF, K.CC, K.AUX} and not (self._at(place) is K.ADJ and not self._leads(place)):
            things = things or self._at(place) is K.N
            if self.tokens[place].form == "inf" and self._at(place + 1) is not K.AUX:
                return False
            place += 1
        state = self._at(place) in (K.PARTICIPLE, K.ADJ) or (
            place < len(self.tokens) and self.tokens[place - 1].text in section("end_states")
        )
        return things and state

    def _comma(self, at: int, end: int) -> int:
        aside = self._aside(at) if self.tokens[at].text == "(" else None
        if aside is not None:
            for token in self.tokens[at:aside]:
                token.note = ASIDE
            return aside
        return self._joint(at, end)

    def _joint(self, at: int, end: int) -> int:
        """Begin a unit where a statement follows: "pour the water out, the pot goes on the shelf"."""
        if (also := self._also(at)) != at:
            return also
        several = self.tokens[at].kind is K.COMMA and self._at(at + 1) is K.CC
        named = self._named()
        listed = any(t.kind is K.COMMA for t in self.out[self.subject :])
        if (self.verb is not None or (several and named and not listed)) and self._statement_follows(at):
            return self._stop(at, end)
        return self._keep(at, end)

    def _also(self, at: int) -> int:
        """Mark "and so does the mug", "and the mug too"; return where reading goes on, ``at`` for any other joint."""
        so = at + 1 + (self._at(at + 1) is K.CC)
        place = so
        while self._at(place) in _NP:
            place += 1
        too = place < len(self.tokens) and self.tokens[place].text in section("also_words")
        does = self._at(so) in (K.ADV, K.PURP) and self._at(so + 1) is K.AUX and self._at(so + 2) in _NP
        if not (does or (too and place > so and self._at(place + 1) in _BREAKS)):
            return at
        self.tokens[at].form = ALSO
        self.out.append(self.tokens[at])
        return so + 2 * does

    def _named(self) -> bool:
        return any(t.kind in _HEADS for t in self.out[self.subject :])

    def _statement_follows(self, at: int) -> bool:
        """Tell whether a subject with its finite verb stands behind a comma or a conjunction."""
        place, named = at + 1, False
        while self._at(place) in _NP | {K.OF, K.ADV, K.FILLER, K.CC, K.EXC} or (
            place < len(self.tokens) and self.tokens[place].text in section("choices")
        ):
            named = named or self._at(place) in _HEADS | {K.NUM}
            place += 1
        denied = self._at(place) is K.NEG and self.tokens[place].text in section("duties")
        return named and (self._at(place) in (K.AUX, K.FINITE) or denied)

    def _aside(self, at: int) -> int | None:
        """Return where a bracket without a verb ends."""
        for end, token in enumerate(self.tokens[at + 1 : at + 2 * _AHEAD], at + 1):
            if token.text == ")":
                return end + 1
            if token.kind in (K.V, K.STOP):
                return None
        return None

    def _noun(self, at: int, end: int) -> int:
        """Keep a noun, but for a name that is called: "Dave, take"."""
        first = not self.out or self._last() is K.SEP
        asks = (K.V, K.SUBJECT, K.AUX, K.NEG, K.ENSURE, K.LET)
        if first and self._at(at + 1) is K.COMMA and self._at(self._peek(at + 1)) in asks and self._at(at - 1) not in _NP:
            self.tokens[at].note = ADDRESS
            return at + 2
        return self._keep(at, end)

    def _adjective(self, at: int, end: int) -> int:
        token = self.tokens[at]
        if not self._leads(at):
            if not (self.depth or self._last() in _HEADS | {K.STATE, K.CC, K.V, K.P}):
                return at + 1
            done = self.depth and token.form == "ed" and self._last() in (K.AUX, K.CC) and token.text not in section("end_states")
            token.kind = K.PARTICIPLE if done else K.STATE
        self.out.append(token)
        return at + 1

    def _leads(self, at: int) -> bool:
        """Tell whether a noun that an adjective belongs to follows."""
        for place in range(at + 1, min(at + 6, len(self.tokens))):
            kind = self.tokens[place].kind
            if kind in (K.N, K.NUM) or (kind is K.PRON and self.tokens[place].text in section("one_words")):
                return True
            if kind is K.PARTICIPLE and self._at(place + 1) is K.N:
                continue
            joint = kind in _LINKS and self._at(place + 1) is K.ADJ and self._last() is not K.AUX
            if kind not in (K.ADJ, K.ADV, K.FILLER) and not joint:
                return False
        return False

    def _adverb(self, at: int, end: int) -> int:
        token = self.tokens[at]
        if token.text in section("end_states") and self._is_state(at):
            token.kind = K.STATE
            self.out.append(token)
        return at + 1

    def _is_state(self, at: int) -> bool:
        """Tell whether a particle or adverb says in what state something is or shall be."""
        after = self._at(self._peek(at))
        ends = after in _BREAKS | {K.SUB, K.END, K.V, K.EXC, K.MOD, K.PURP, K.REL}
        if self.depth:
            return ends and self._last() in _HEADS | {K.AUX, K.LINK, K.STATE, K.CC, K.FINITE}
        hosts = self.verb is None or self.verb.stem.partition("_")[0] in section("result_verbs")
        return ends and hosts and self._last() in _HEADS | {K.STATE, K.CC}

    def _preposition(self, at: int, end: int) -> int:
        token, following = self.tokens[at], self._at(at + 1)
        after = self.tokens[at + 1] if at + 1 < len(self.tokens) else token
        if after.text in section("reciprocals"):
            return at + 1
        if after.text in section("there_words") and self._at(at + 2) is not K.AUX and self._last() is not K.V:
            after.kind, after.text = K.PRON, sections()["singular_pronouns"][0]  # "leave it in there"
        if after.kind is K.NEG:
            after.kind, after.text = K.DET, sections()["none_words"][0]  # "with neither milk nor sugar"
            for word in self.tokens[at + 2 : at + 6]:
                if word.kind is K.V and self.lexicon.is_noun(word.text):
                    word.kind = K.N
        if after.text in section("using_words") and token.text in section("without_words"):
            after.kind, after.stem = K.ING, (self.lexicon.verb(after.text) or (after.text,))[0]
            following = K.ING
        absolute = self._absolute_end(at) if token.text in section("with_words") else 0
        if absolute:
            return self._bracket(token, K.SUB, at + 1, absolute)
        if token.text in section("end_states") and following not in _NP | {K.ING, K.V, K.OF} and self._is_state(at):
            token.kind = K.STATE
        elif following is K.ING:
            if token.text in section("without_words"):
                self.tokens[at + 1].kind = K.V
                return self._bracket(token, K.WITHOUT, at + 1, self.boundary(at + 1))
            if token.text in section("by_words"):
                self.tokens[at + 1].kind = K.V
                if self.verb is not None and self.out[-1] is self.verb and self.verb.stem in section("lead_verbs"):
                    self.out.pop()
                return at + 1
        if token.text in section("of_words") and self._last() in _HEADS:
            token.kind = K.OF
        self.out.append(token)
        return at + 1

    def _absolute_end(self, at: int) -> int:
        """Return where "with the door shut" ends, which says how something shall be besides; 0 for other phrases."""
        place = at + 1
        while self._at(place) in _NP and not (self._at(place) is K.ADJ and not self._leads(place)):
            if self.tokens[place].text in section("end_states") and self._at(place - 1) is K.N:
                break
            place += 1
        if place >= len(self.tokens) or self._at(place - 1) not in _HEADS:
            return 0
        state = self.tokens[place].text in section("end_states") or self._at(place) is K.ADJ
        return place + 1 if state and self._at(place + 1) in _BREAKS else 0

    def _participle(self, at: int, end: int) -> int:
        token = self.tokens[at]
        after = self._at(self._peek(at))
        hosts = self.verb is None or self.verb.stem.partition("_")[0] in section("result_verbs")
        if self._last() in _HEADS and hosts and after in _BREAKS | {K.SUB, K.MOD}:
            token.kind = K.STATE
            self.out.append(token)
        return at + 1

    def _ing(self, at: int, end: int) -> int:
        token, last = self.tokens[at], self.out[-1] if self.out else None
        if last is not None and last.kind in _HEADS:
            if self._at(at + 1) is K.P:
                self.tokens[at + 1].form = RELATIVE  # "the letter lying on the chair"
            return self._participle(at, end)
        if last is not None and last is self.verb:
            self.out.pop()
        token.kind = K.V
        if last is not None and last is self.verb and last.stem in section("stopping"):
            self.verb = None
            return self._bracket(last, K.NEG, at, self.boundary(at))
        return self._verb(at, end)

    def _let(self, at: int, end: int) -> int:
        """Emit "let X do" as LET, the noun phrase and the verb; any other "let" is a verb."""
        token, stop = self.tokens[at], at + 1
        while self._at(stop) in _NP | _IDLE | {K.OF}:
            stop += 1
        verb = stop + (self._at(stop) is K.TO)
        if self._at(verb) is not K.V or self.tokens[verb].form != "base" or token.text in section("leaving"):
            token.kind, token.form, token.strength = K.V, "base", 3
            return self._verb(at, end)
        if self.tokens[stop - 1].text in section("persons"):
            return verb
        self.out += [token, *(t for t in self.tokens[at + 1 : stop] if t.kind not in _IDLE)]
        self._verb(verb, end)
        self.tokens[verb].form = ALONE
        return verb + 1

    # clauses

    def _condition(self, at: int, end: int) -> int:
        token = self.tokens[at]
        if self._last() is K.EXC:
            self.out.pop()
            token.text = sections()["excepting"][0]  # "except if"
        if self._at(at + 1) is K.ING:
            self.tokens[at + 1].kind = K.V
        return self._bracket(token, K.SUB, at + 1, min(end, self.boundary(at)))

    def _purpose(self, at: int, end: int) -> int:
        first = self._peek(at)
        start = first if self._at(first) is K.V else at
        return self._bracket(self.tokens[at], K.PURP, at + 1, min(end, self.boundary(start)))

    def _infinitive(self, at: int, end: int) -> int:
        token = self.tokens[at]
        if token.form != "inf":
            token.kind = K.P
            return self._keep(at, end)
        awaited = self._awaited()
        if awaited is not None:
            opener = self.out[awaited]
            opener.kind = K.SUB
            stop = self.boundary(at + 1)
            self._fill(opener, at + 1, stop)
            return stop
        if self._drop_lead() or self._last() in (K.CC, K.COMMA):
            return at + 1
        if self.verb is not None and self.verb.stem in section("chain_verbs"):
            token.kind = K.SEP
            self.out.append(token)
            self.verb, self.subject = None, len(self.out)
            return at + 1
        if self.verb is None:
            return at + 1
        return self._purpose(at, end)

    def _awaited(self) -> int | None:
        """Return where "for the kettle" of "wait for the kettle to boil" begins in ``out``."""
        if self.verb is None or self.verb.stem not in section("waiting"):
            return None
        for back in range(len(self.out) - 1, max(-1, len(self.out) - 10), -1):
            if self.out[back] is self.verb:
                return None
            if self.out[back].text in section("awaited"):
                return back
        return None

    def _drop_lead(self) -> bool:
        """Drop "want you", "remember", "need" right before an infinitive."""
        back = len(self.out) - 1
        while back >= 0 and self.out[back].kind in (K.PRON, K.ADJ, K.STATE):
            back -= 1
        verb = self.out[back] if back >= 0 else None
        if verb is None or verb.kind is not K.V or verb.stem not in section("lead_verbs"):
            return False
        del self.out[back:]
        self.verb = None
        return True

    def _relative(self, at: int, end: int) -> int:
        token, copula = self.tokens[at], self._peek(at)
        stop = min(end, self._relative_end(at))
        stands = self._at(copula) is K.FINITE and self.tokens[copula].stem in section("postures")
        if stands or (self._at(copula) is K.AUX and self.tokens[copula].text in section("be")):
            denied = self.tokens[copula].text in section("not_forms")
            place = self._peek(copula, frozenset({K.ADV, K.PARTICIPLE, K.ING, K.FILLER}))
            place += place < len(self.tokens) and self.tokens[place].text in section("loosely")
            if not denied and self._at(place) is K.P and self._at(self._peek(place)) in _NP:
                self.tokens[place].form = RELATIVE if self._last() in _HEADS else ""
                return place  # "the cup that is on the desk" as "the cup on the desk"
        if self._last() is K.P:
            self.out.pop()
        return self._bracket(token, K.REL, at + 1, stop)

    def _relative_end(self, at: int) -> int:
        """End a relative clause where the main clause says whither: "the chair that stands there to the desk"."""
        stop, said, verb = self.boundary(at), False, False
        for place in range(at + 1, stop):
            token = self.tokens[place]
            if token.kind is K.CC and verb:
                return place
            if verb and said and token.kind in (K.FINITE, K.AUX):
                return place  # "everything that is empty | goes in the bin"
            if token.form == "inf" and self._at(place + 1) is K.AUX:
                return place  # "the mug that is empty | to be on the shelf"
            if self.tokens[place - 1].kind is K.ADJ and token.kind in (K.P, K.TO, K.EXC) and verb:
                return place  # "the bottles that are empty | in the bag"
            inner = self.tokens[place - 1].kind is K.PRON and self.tokens[place - 2].kind is K.P
            whither = token.kind in (K.P, K.TO, K.EXC) and token.form != "inf"
            owns = said and self.tokens[at + 1].text in section("having") and self._at(place + 1) is not K.PRON
            away = token.text in section("arrivals") | section("origins") and token.text not in section("static")
            if whither and ((verb and inner) or owns or (verb and said and away) or token.kind is K.EXC):
                return place
            there = token.text in section("there_words")
            said = said or (verb and (token.kind in (K.N, K.PRON, K.ADJ) or there))
            verb = verb or token.kind in (K.FINITE, K.AUX, K.PARTICIPLE)
        return stop

    def _negation(self, at: int, end: int) -> int:
        """Bracket what must not be done: "don't open it", "not the mug"."""
        token, stop = self.tokens[at], at + 1
        if token.text in section("choices"):
            token.kind = K.CC
            return self._keep(at, end)
        if self.verb is None and token.text in section("none_words") and self._statement_follows(at):
            token.kind = K.DET  # "neither the lamp nor the radio should be on"
            return self._keep(at, end)
        if self.verb is None and self._named():
            token.kind = K.AUX  # "the mug shouldn't be there"
            return self._state_of_subject(at, negated=True)
        while self._at(stop) in (K.NEG, K.ADV, K.AUX, K.FILLER, K.SUBJECT, K.TO):
            stop += 1
        lead = self.tokens[stop] if stop < len(self.tokens) else None
        if lead is not None and lead.stem in section("forgetting"):
            if self._at(stop + 1) in _NP:
                return self._skip(at, self.boundary(stop), REMINDER)
            return stop + 1
        finish = self._negation_end(stop)
        idle = self._at(self._peek(stop)) in (K.TO, K.STOP, K.COMMA)
        helped = self._at(stop - 1) is K.TO and any(t.text in section("unneeded") for t in self.tokens[at:stop])
        if token.text in section("needless") or helped:
            return self._skip(at, finish, UNNEEDED)
        if lead is not None and lead.stem in section("unneeded") and idle:
            return self._skip(at, finish, UNNEEDED)
        if self._at(stop) is K.ING:
            self.tokens[stop].kind = K.V
        return self._bracket(token, K.NEG, stop, finish)

    def _negation_end(self, at: int) -> int:
        deed = self._at(at) in (K.V, K.LET, K.ING)
        while at < len(self.tokens) and self.tokens[at].kind is not K.STOP:
            token, follows = self.tokens[at], self._at(self._peek(at))
            contrast = token.text in section("contrasts") or token.kind is K.COMMA
            if contrast and follows in (K.V, K.SUBJECT, K.SUB, *_NP, K.P, K.TO):
                break
            if token.kind is K.V and self._at(at - 1) in _HEADS | {K.STATE} and token.strength == 3:
                break
            if not deed and (token.form == "inf" or token.kind in (K.SUB, K.PURP, K.V)):
                break  # "the saw, not the axe, to cut it"
            at += 1
        return at

    def _skip(self, at: int, end: int, note: str) -> int:
        said = fold(self.tokens[at:end], K.SKIP, " ")
        said.note = note
        self.tokens[at].note, self.tokens[at].kind = note, K.SKIP
        self.tokens[at].span = said.span
        return end

    def _ensure(self, at: int, end: int) -> int:
        token, begin = self.tokens[at], at + 1
        while self._at(begin) in (K.TO, K.REL, K.ADV) or (begin < len(self.tokens) and self.tokens[begin].text in section("relatives")):
            begin += 1
        if self._at(begin) in (K.V, K.SUBJECT, K.NEG, K.MOD):
            return begin
        scan = begin
        while self._at(scan) in _NOMINAL | {K.OF, K.CC}:
            scan += 1
        if self._at(scan) in (K.AUX, K.FINITE, K.NEG):
            return self._bracket(token, K.ENSURE, begin, self._statement_end(scan))
        token.kind, token.stem, token.form = K.V, token.text, "base"
        return self._verb(at, begin)

    def _speaker(self, at: int, end: int) -> int:
        """Bracket what speakers say of themselves or notice; other subjects are dropped."""
        verb = self._peek(at, frozenset({K.ADV, K.FILLER, K.AUX}))
        been = any(t.kind is K.AUX and t.text in section("be") for t in self.tokens[at + 1 : verb])
        said = self.tokens[verb] if verb < len(self.tokens) else None
        noticing = said is not None and said.stem in section("noticed") | section("knowing")
        past = said is not None and said.form == "ed" and said.kind is not K.ADJ
        first = self.tokens[at].text in section("speakers") | section("self_forms")
        liking = said is not None and said.stem in section("liking") and verb == self._peek(at) and first
        own = self.tokens[at].text in section("self_forms") or (first and (been or past or liking))
        leads = self._at(self._peek(verb)) is K.TO and not been
        denied = self._peek(at)
        if first and self._at(denied) is K.NEG:
            wish = self._peek(denied)
            if wish < len(self.tokens) and self.tokens[wish].stem in section("wishing") and self._wishes_state(wish):
                self.tokens[denied].negated = True
                return self._bracket(self.tokens[denied], K.ENSURE, wish + 1, self._statement_end(wish + 1))
            own = own or self._at(wish) is K.V
        if own and said is not None and said.stem in section("ordering"):
            return at + 1  # "I'll have a tea"
        if own and self.verb is not None and self._last() in _LINKS:
            self.out[-1].kind, self.verb, self.subject = K.SEP, None, len(self.out)
        if self.verb is None and (own or (noticing and not self._asked(at))) and not leads:
            token = self.tokens[at]
            token.kind = K.PRON
            say = Token(K.SAY, "", Span(token.span.start, token.span.start))
            return self._bracket(say, K.SAY, at, self._statement_end(at))
        return at + 1

    def _asked(self, at: int) -> bool:
        """Tell whether an auxiliary stands before a subject: "can you find the cup"."""
        return at > 0 and self.tokens[at - 1].kind is K.AUX

    def _auxiliary(self, at: int, end: int) -> int:
        """Open a statement where a subject or "there" stands before an auxiliary; drop any other."""
        there = at > 0 and self.tokens[at - 1].text in section("there_words")
        token, after = self.tokens[at], self._peek(at)
        if after < len(self.tokens) and self.tokens[after].text in section("needless"):
            return self._negation(after, end)
        fresh = self.verb is None and all(t.kind in _LINKS for t in self.out[self.subject :])
        if fresh and not there and token.text in section("getting") and self._at(at + 1) in _NP - {K.PRON}:
            token.kind, token.stem, token.form = K.V, token.text, "base"
            return self._verb(at, end)
        if self.verb is None and (there or self._named()):
            return self._state_of_subject(at)
        run_on = self._run_on()
        if self.verb is not None and run_on:
            stop = Token(K.SEP, "", Span(self.out[run_on].span.start, self.out[run_on].span.start))
            self.out.insert(run_on, stop)
            self.verb, self.subject = None, run_on + 1
            return self._state_of_subject(at)
        if self._at(self._peek(at)) is K.NEG:
            return self._negation(at, end)
        return at + 1

    def _run_on(self) -> int:
        """Return where the subject of a statement begins that follows a noun phrase without a sign; 0 for none."""
        place = len(self.out)
        while place > 0 and self.out[place - 1].kind in _NP and self.out[place - 1].kind is not K.PRON:
            place -= 1
            if self.out[place].kind in (K.DET, K.NUM):
                break
        if place == len(self.out) and place and self.out[-1].kind is K.PRON:
            place -= 1
        return place if 0 < place < len(self.out) and self.out[place - 1].kind in _HEADS else 0

    def _state_of_subject(self, at: int, *, negated: bool = False) -> int:
        """Bracket a statement whose subject has come."""
        start = (self.out[self.subject] if self.subject < len(self.out) else self.tokens[at]).span.start
        say = Token(K.SAY, "", Span(start, start), negated=negated)
        self.out.insert(self.subject, say)
        stop = self._statement_end(at)
        self._fill(say, at, stop)
        return stop

    def _statement_end(self, at: int) -> int:
        stop = self._peek(at, frozenset({K.ADV, K.FILLER, K.AUX, K.SUBJECT, K.NEG, K.TO}))
        if self._at(stop) is K.V:
            stop += 1
        while stop < len(self.tokens) and self.tokens[stop].kind is not K.STOP:
            token, follows = self.tokens[stop], self._at(self._peek(stop))
            verb = token.kind is K.V and self.tokens[stop - 1].kind not in (K.TO, K.AUX, K.NEG)
            if verb or token.kind in (K.SUB, K.ENSURE, K.PURP):
                break
            if token.kind in _LINKS and follows in (K.V, K.SUBJECT, K.SUB, K.NEG, K.ENSURE, K.LET):
                break
            if token.kind is K.COMMA and (follows is K.AUX or self._statement_follows(stop)):
                break
            stop += 1
        return stop

    def boundary(self, at: int) -> int:
        """Return where the subordinate clause that opens at ``at`` ends."""
        finite, end = False, at + 1
        while end < len(self.tokens):
            token, before = self.tokens[end], self.tokens[end - 1]
            verbal = token.kind is K.V and before.kind not in (K.AUX, K.TO, K.NEG)
            if token.kind in (K.STOP, K.COMMA, K.ENSURE, K.LET) or token.text in section("then_words"):
                break
            if verbal and (before.kind is not K.SUBJECT or finite) and end > at + 1:
                break
            if token.kind in (K.SUB, K.PURP) and finite:
                break
            if token.text in section("by_words") and self._at(end + 1) is K.ING:
                break
            follows = self._at(self._peek(end))
            if token.kind is K.CC and follows in (K.V, K.SUBJECT, K.NEG, K.ENSURE, K.LET):
                break
            if token.kind is K.SUBJECT and finite and follows is K.AUX:
                break
            if token.kind in (K.FINITE, K.AUX, K.ING, K.PARTICIPLE, K.ADJ) or (token.kind is K.V and end > at + 1):
                finite = True
            end += 1
        return end

    # inside of subordinate clauses

    def _inner_to(self, at: int, end: int) -> int:
        token = self.tokens[at]
        if token.form == "inf" and self.opener[-1].kind is K.NEG and self._last() in _HEADS:
            return self._bracket(token, K.PURP, at + 1, end)
        if token.form == "inf":
            if self._last() is K.AUX and self._at(at + 1) is K.AUX and self.out[-1].text in section("be"):
                self.opener[-1].form = DUTY  # "no lamp is to be on"
            return at + 1
        token.kind = K.P
        return self._keep(at, end)

    def _inner_negation(self, at: int, end: int) -> int:
        self.opener[-1].negated = True
        return at + 1

    def _inner_determiner(self, at: int, end: int) -> int:
        token = self.tokens[at]
        if token.text in section("none_words") and self.opener[-1].kind is K.SUB:
            self.opener[-1].negated = True
        return self._keep(at, end)

    def _inner_subject(self, at: int, end: int) -> int:
        self.tokens[at].kind = K.PRON
        return self._keep(at, end)

    def _inner_joint(self, at: int, end: int) -> int:
        also = self._also(at)
        return also if also != at else self._keep(at, end)

    def _inner_let(self, at: int, end: int) -> int:
        self.tokens[at].kind = K.V
        return self._keep(at, end)

    def _inner_noun(self, at: int, end: int) -> int:
        token, last = self.tokens[at], self._last()
        ends = self._at(self._peek(at)) in _BREAKS | {K.SUB, K.MOD, K.P, K.V}
        if last is K.AUX and token.text in section("same_past") and token.text not in section("end_states"):
            token.kind, token.stem = K.PARTICIPLE, token.text  # "should be put"
            return self._keep(at, end)
        state = token.text in section("end_states") and last in (K.AUX, K.V, K.FINITE, K.STATE, K.CC)
        if ends and (state or (last is K.AUX and not self.lexicon.is_noun(token.text))):
            token.kind = K.STATE
        return self._keep(at, end)

    def _inner_auxiliary(self, at: int, end: int) -> int:
        if self.tokens[at].text in section("not_forms"):
            self.opener[-1].negated = True
        return self._keep(at, end)


# -- commas and conjunctions -------------------------------------------------------------------------------------------


def _link(tokens: list[Token]) -> list[Token]:
    """Give each comma and conjunction its class: between nouns, verbs, clauses, or none."""
    linker = _Linker(tokens)
    return linker.run()


class _Linker:
    def __init__(self, tokens: list[Token]) -> None:
        self.tokens = tokens
        self.out: list[Token] = []
        self.open: list[bool] = []
        """For each open bracket, whether its predicate has come."""
        self.fronted = True
        """No verb has come since the last separator."""

    def run(self) -> list[Token]:
        at = 0
        while at < len(self.tokens):
            token = self.tokens[at]
            if token.kind in _LINKS:
                at = self._decide(at)
                continue
            if token.kind in _OPENERS:
                self.open.append(False)
            elif token.kind is K.END and self.open:
                self.open.pop()
            elif self.open and token.kind in _VERBAL:
                self.open[-1] = True
            elif token.kind in (K.V, K.SEP):
                self.fronted = token.kind is K.SEP
            self.out.append(token)
            at += 1
        return self.out

    def _decide(self, at: int) -> int:
        end = at
        while end < len(self.tokens) and self.tokens[end].kind in _LINKS:
            end += 1
        link = self.tokens[at]
        before = self.out[-1].kind if self.out else K.SEP
        after = self.tokens[end].kind if end < len(self.tokens) else K.SEP
        choice = any(t.text in section("choices") for t in self.tokens[at:end])
        link.form = CHOICE if choice else link.form
        if after is K.V and choice:
            self.tokens[end].form = CHOICE
        joined = any(t.kind is K.CC for t in self.tokens[at:end])
        link.form = ALSO if any(t.form == ALSO for t in self.tokens[at:end]) else link.form
        kind = self._inner(before, after, end) if self.open else self._outer(before, after, end, joined)
        if kind is not None:
            link.kind = kind
            self.out.append(link)
            self.fronted = self.fronted or kind is K.SEP
        return end

    def _inner(self, before: Kind, after: Kind, end: int) -> Kind | None:
        """Classify a link inside of a subordinate clause."""
        if after in (K.END, K.SEP) or before in _OPENERS:
            return None
        if before is K.STATE and after is K.STATE:
            return K.CONJ
        if before in _VERBAL and after in _VERBAL:
            return K.VCC
        nouns = before in _HEADS and after in _NP
        if nouns and not self.open[-1] and self._behind_preposition(len(self.out) - 1) and self._first():
            return None  # "apart from the red cup, all the cups"
        if nouns and not (self.open[-1] and self._predicate_follows(end)):
            return K.CONJ
        if after is K.P and not nouns:
            self.tokens[end].form = ALSO
            return None
        self.open[-1] = False
        return K.LINK

    def _predicate_follows(self, at: int) -> bool:
        for token in self.tokens[at:]:
            if token.kind in _VERBAL | {K.STATE}:
                return True
            if token.kind not in _NP | {K.OF, K.P}:
                return False
        return False

    def _outer(self, before: Kind, after: Kind, end: int, joined: bool) -> Kind | None:
        """Classify a link between the parts of a unit."""
        if before is K.STATE and after is K.STATE:
            return K.CONJ
        if not self.fronted and after is K.SUB and self._fronts(end):
            self.fronted = True
            return K.SEP
        if after in (K.V, K.LET) and not self.fronted:
            shares = before is K.V and self.out[-1].form != ALONE and self.out[-1].stem not in section("intransitive")
            return K.VCC if shares and after is K.V else K.SEP
        if after in (K.V, K.LET) and joined and self._named():
            return K.SEP
        if after in (K.SAY, K.ENSURE) or before is K.SAY:
            return K.SEP
        if after is K.P and self._opens_clause(end):
            return K.SEP
        if after is K.P and joined:
            self.tokens[end].form = ALSO
            return None
        if before is K.STATE and after in _NP:
            return K.SEP
        if before in _HEADS and after in _NP:
            apart = self._state_follows(end) or (self.fronted and self._verbless(end))
            return K.SEP if apart else K.CONJ
        return None

    def _first(self) -> bool:
        """Tell whether only a prepositional phrase has come in the open bracket."""
        kinds = []
        for token in reversed(self.out):
            if token.kind in _OPENERS:
                break
            kinds.append(token.kind)
        return bool(kinds) and kinds[-1] in (K.P, K.EXC)

    def _state_follows(self, at: int) -> bool:
        """Tell whether a thing with its state follows: "… in the chest, and the lid closed"."""
        while at < len(self.tokens) and self.tokens[at].kind in _NP:
            at += 1
        after = self.tokens[at + 1].kind if at + 1 < len(self.tokens) else K.SEP
        return at < len(self.tokens) and self.tokens[at].kind is K.STATE and after in _BREAKS

    def _named(self) -> bool:
        """Tell whether the open unit names something: "a glass of milk, and shut the fridge"."""
        for place in range(len(self.out) - 1, -1, -1):
            kind = self.out[place].kind
            if kind in (K.SEP, K.END):
                return False
            if kind in _HEADS and not self._behind_preposition(place):
                return True
        return False

    def _behind_preposition(self, place: int) -> bool:
        while place >= 0 and self.out[place].kind in _NP | {K.OF, K.CONJ}:
            place -= 1
        return place >= 0 and self.out[place].kind in (K.P, K.EXC)

    def _fronts(self, at: int) -> bool:
        """Tell whether a condition belongs to the verb behind it: "take the cup and, if it is dirty, wash it"."""
        depth = 0
        for place in range(at, len(self.tokens)):
            depth += (self.tokens[place].kind in _OPENERS) - (self.tokens[place].kind is K.END)
            if not depth:
                after = place + 1
                while after < len(self.tokens) and self.tokens[after].kind in _LINKS:
                    after += 1
                return after < len(self.tokens) and self.tokens[after].kind in (K.V, K.LET)
        return False

    def _opens_clause(self, at: int) -> bool:
        """Tell whether a place belongs to the verb behind it: "and, using a spoon, scoop some"."""
        for place, token in enumerate(self.tokens[at + 1 : at + 9], at + 1):
            if token.kind is K.COMMA:
                return place + 1 < len(self.tokens) and self.tokens[place + 1].kind is K.V
            if token.kind not in _NP | {K.OF}:
                return False
        return False

    def _verbless(self, at: int) -> bool:
        """Tell whether two parts without verbs are joined: "milk in the cup, sugar in the bowl"."""
        last = next((t for t in reversed(self.out) if t.kind in (K.P, K.STATE, K.SEP)), None)
        if last is not None and last.text in section("with_words"):
            return False  # "a tea with milk and sugar in a mug"
        ahead = [t.kind for t in self.tokens[at : at + _AHEAD]]
        stop = next((i for i, kind in enumerate(ahead) if kind in (*_LINKS, K.SEP, K.V)), len(ahead))
        mine = []
        for token in reversed(self.out):
            if token.kind in (K.SEP, K.END, *_OPENERS):
                break
            mine.append(token.kind)
        said = {K.P, K.STATE}
        return bool(said & set(ahead[:stop])) and bool(said & set(mine))


def _drop_dangling(tokens: list[Token]) -> list[Token]:
    """Drop determiners, numerals, adjectives and "of" without a noun behind them."""
    backwards: list[Token] = []
    for at in range(len(tokens) - 1, -1, -1):
        token = tokens[at]
        following = backwards[-1].kind if backwards else K.STOP
        if following not in _FOLLOWERS.get(token.kind, {following}):
            continue  # a joint at the end of its part
        if token.kind in (K.DET, K.NUM, K.ADJ, K.OF) and following not in _NP:
            if at and tokens[at - 1].kind is K.V:
                tokens[at - 1].form = ALONE
            continue
        backwards.append(token)
    return backwards[::-1]
