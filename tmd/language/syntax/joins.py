"""Join words that belong together: numbers, partitives, settings, particles of verbs.

Each pass looks at the decided words of a text from left to right and changes their classes; it is linear in the length
of the text, up to a bounded look ahead.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

from tmd.language.clause import NOWHERE, PUT, Span
from tmd.language.lexicon.lexicon import Lexicon, first_of, pairs, section, singular
from tmd.language.syntax.tokens import HEADS, IDLE, LINKS, NP, Kind, Token, Words, fold

K = Kind
SETTING = "setting"
_AHEAD = 30
"""Tokens between a verb and its particle, at most."""
_NEAR = 7
"""Tokens between a word for all there is and an exception, at most."""
_DEED = "V|LET|AUX|FINITE|ENSURE|NEG|STOP"
"""Classes of words that are, or stand beside, the verb of a clause, and the end of a sentence."""


def join(tokens: list[Token], lexicon: Lexicon) -> list[Token]:
    """Join the words that are one word of the grammar."""
    tokens = _copulas(_without_commas(Words(tokens)))
    _results(Words(tokens))
    _finite(Words(tokens))
    _partitives(Words(tokens))
    for token in tokens:
        token.kind = K.CC if token.kind is K.NEG and token.text in section("choices") else token.kind  # "nor"
    for before, token in pairwise(t for t in tokens if t.kind is not K.ADV):
        if before.kind is K.AUX and token.kind is K.CC and token.text in section("then_words"):
            token.kind = K.ADV  # "is then filled"
        if before.text in section("be") and token.text in section("owned"):
            before.text = first_of("having")  # "the pot that's got water in it"
    _settings(Words(tokens))
    _firsts(Words(tokens), lexicon)
    tokens = _numbered(Words(tokens))
    _exceptions(Words(tokens))
    _Particles(tokens, lexicon).run()
    tokens = _with_verbs(Words(tokens))
    _sentences(tokens)
    _mark_early(Words(tokens))
    return tokens


def _without_commas(words: Words) -> list[Token]:
    """Drop the commas between the adjectives of a noun: "the big, red mug"."""
    kept = []
    for at, token in enumerate(words.tokens):
        begin = at
        while words.kind(begin - 1) is K.ADJ:
            begin -= 1
        listed = token.kind is K.COMMA and begin < at and words.kind(begin - 1) is K.DET
        if not (listed and words.follows(at + 1, "ADJ* N")):
            kept.append(token)
    return kept


def _copulas(tokens: list[Token]) -> list[Token]:
    """Read "the bin's open", "its in the drawer" with "is": no owner stands before such words."""
    words, result = Words(tokens), []
    for at, token in enumerate(tokens):
        result.append(token)
        its = token.kind is K.DET and words.among(at, "its_words")
        its = its and words.follows(at + 1, "ADV* (P|ADJ)") and not words.follows(at + 1, "(ADJ|ADV|NUM)* N")
        state = words.follows(
            at + 1, "ADV BREAK | ADV* (P | (ADJ|ING|PARTICIPLE) BREAK | ING (P|TO|DET|PRON)) | ADV ADV* N (P|BREAK)"
        ) or words.among(at + 1, "end_states")
        if its:
            token.kind, token.text = K.PRON, first_of("singular_pronouns")
        if its or (token.kind is K.N and token.form == "possessive" and state):
            result.append(Token(K.AUX, first_of("be"), Span(token.span.end, token.span.end)))
    return result


def _results(words: Words) -> None:
    """Put the state that a verb leaves behind its object: "push open the door" as "push the door open"."""
    idle = ("intransitive", "chain_verbs", "lead_verbs")
    for at, token in enumerate(words.tokens):
        state = words.kind(at + 1) in (K.V, K.ADJ) and words.among(at + 1, "end_states")
        if (
            token.kind is K.V
            and state
            and words.follows(at + 2, "IDLE* (DET|PRON)")
            and not words.stem_among(at, *idle)
        ):
            end = words.past(at + 2, "(IDLE|NP)+")
            words.tokens[at + 1].kind = K.ADJ
            words.tokens[at + 1 : end] = [*words.tokens[at + 2 : end], words.tokens[at + 1]]


def _finite(words: Words) -> None:
    """Mark "goes" and "stands" behind a subject as finite verbs: "both books go on the shelf"."""
    subject = verb = aside = False
    for at, token in enumerate(words.tokens):
        if token.kind in (K.STOP, K.COMMA, K.CC, K.SUB, K.ENSURE):
            # "everything, except the cup, goes here"
            opens = token.kind is K.COMMA and words.among(at + 1, "exceptions")
            subject = subject and not verb and (opens or token.kind in ((K.CC, K.COMMA) if aside else (K.CC,)))
            verb, aside = False, opens
            continue
        main = subject and not verb and words.kind(at - 1) is not K.REL  # "the cup that stands there goes in the sink"
        if stem := _finite_stem(words, at) if main else "":
            token.kind, token.stem, verb = K.FINITE, stem, True
        subject = subject or token.kind in (K.N, K.PRON, K.NUM)
        verb = verb or token.kind in (K.V, K.LET)


def _finite_stem(words: Words, at: int) -> str:
    """Return the stem of a verb of placing, or of getting with several things: "both plants get some water"."""
    several = words.kind(at - 1) is K.N and singular(words.tokens[at - 1].text) != words.tokens[at - 1].text
    begin = at - 1
    while words.kind(begin) in NP | {K.CC}:
        several, begin = several or words.kind(begin) is K.CC, begin - 1  # "the sofa and the bed get a pillow"
    token = words.tokens[at]
    base = singular(token.text)
    gets = several and words.stem_among(at, "receiving")
    gets = gets or (base in section("receiving") and base != token.text)
    return (token.stem or base) if gets and words.follows(at + 1, "DET|NUM|ADJ* N") else _placing(words, at)


def _placing(words: Words, at: int) -> str:
    """Return the stem of a verb that says where its subject is or should be; empty for other words."""
    place = words.follows(at + 1, "P|TO|STATE") or words.among(at + 1, "back_words", "where_words")
    if words.among(at, "belonging") and words.among(at + 1, "back_words"):
        return first_of("returning")
    if words.among(at, "belonging") and place:
        return first_of("belonging")
    stays = words.follows(at + 1, "BREAK") or words.among(at + 1, "there_words", "end_states")
    return pairs("standing").get(words.tokens[at].text, "") if place or stays else ""


def _partitives(words: Words) -> None:
    """Read "all of the cups" as "the cups"; mark the other "of"."""
    for at, of in enumerate(words.tokens[1:]):
        token = words.tokens[at]
        if of.kind is not K.P or of.text not in section("of_words"):
            continue
        if words.among(at, "counters") and _is_counted(words, at - 1):
            of.kind = token.kind = K.FILLER  # "two pieces of cutlery" are two, "every piece of clothing" is all
            continue
        if _is_that_of(words, at):
            of.kind, token.kind = K.OF, K.PRON
            continue
        listed = words.among(at, "partitives") and token.kind in (K.N, K.PRON, K.DET, K.ADJ)
        if listed or (token.kind is K.NUM and words.kind(at - 1) is not K.N):
            counts = token.kind is not K.N or words.among(at, "quantifiers", "numbers", "none_words")
            of.kind, token.kind = K.FILLER, K.DET if counts else K.FILLER
            if words.follows(at + 2, "DET NUM"):
                words.tokens[at + 3].kind = K.FILLER  # "one of the two lamps": how many there are picks none of them
        elif token.kind in HEADS:
            of.kind = K.OF


def _is_counted(words: Words, at: int) -> bool:
    return words.kind(at) is K.NUM or words.among(at, "all_words", "any_words", "none_words")


def _is_that_of(words: Words, at: int) -> bool:
    """Return whether "one" is a thing that belongs to what follows: "the hall's door and the one of the cellar"."""
    return words.among(at, "one_words") and words.kind(at - 1) is K.DET and words.follows(at + 2, "DET IDLE* N")


def _firsts(words: Words, lexicon: Lexicon) -> None:
    """Read "burner one" with a figure; "the toy one" and "red one" refer to something that was mentioned."""
    for at, token in enumerate(words.tokens[1:], start=1):
        named = words.kind(at - 1) is K.N and lexicon.names_thing(singular(words.tokens[at - 1].text))
        if named and token.text == first_of("one_words") and not _counts(words, at):
            front = next((t.kind for t in reversed(words.tokens[:at]) if t.kind is not K.N), None)
            if front is not K.DET:
                token.kind, token.text = K.NUM, "1"


def _numbered(words: Words) -> list[Token]:
    """Join "burner 2" to one noun; a numeral without a noun is a noun itself; "ones" carries what tells which.

    "Burners 2 and 3" are burner 2 and burner 3.
    """
    result: list[Token] = []
    _list_numbered(words)
    for at, token in enumerate(words.tokens):
        before = result[-1] if result and result[-1].kind is K.N else None
        if token.kind in (K.NUM, K.PRON) and words.among(at, "one_words") and before is not None:
            token.kind = K.N  # "the red one"
        elif words.among(at, "other_words") and not words.follows(at + 1, "(IDLE|ADJ)* (N|NUM|HEAD)"):
            token.kind = K.PRON if token.kind in (K.DET, K.ADJ) else token.kind  # "and another in the crate"
        elif token.kind is K.NUM and not _counts(words, at):
            if before is not None:
                joined = fold([before, token], K.N)
                joined.parts = before.parts
                result[-1] = joined
                continue
            _stand_alone(words, at)
        result.append(token)
    return result


def _stand_alone(words: Words, at: int) -> None:
    """Read a numeral without a noun as a noun, or as a pronoun: "these two"."""
    token = words.tokens[at]
    token.kind = K.PRON if singular(token.text) == token.text else K.N
    if words.among(at - 1, "pointing") and not words.among(at, "one_words"):
        token.text = first_of("plural_pronouns")


def _list_numbered(words: Words) -> None:
    """Give each numeral of a list the noun in front: "burners 2 and 3"."""
    noun = ""
    for at, token in enumerate(words.tokens):
        if token.kind is not K.NUM or _counts(words, at):
            noun = noun if token.kind in LINKS else ""
        elif words.kind(at - 1) is K.N:
            before = words.tokens[at - 1]
            noun = singular(before.text) if singular(before.text) != before.text else ""
            before.text = singular(before.text)
        elif noun and words.kind(at - 1) in LINKS:
            token.kind, token.text = K.N, f"{noun}_{token.text}"


def _counts(words: Words, at: int) -> bool:
    """Return whether a number counts a noun that follows: "two clean cups", "half a cup"."""
    fraction = words.among(at, "fractions") and words.follows(at + 1, "DET")
    return fraction or words.follows(at + 1, "(IDLE|ADJ)* (N|NUM)")


def _settings(words: Words) -> None:
    """Fold "on high", "to full", "the sound low": a setting without a noun says how."""
    tokens = words.tokens
    for at, token in enumerate(tokens[:-1]):
        behind = token.kind in (K.N, K.NUM, K.PRON) or words.among(at, "pure_particles")
        if behind and words.among(at + 1, "settings") and words.follows(at + 2, "IDLE* BREAK"):
            tokens[at + 1].kind, tokens[at + 1].form = K.MOD, SETTING
        place = at + 1 + (tokens[at + 1].kind is K.DET)
        joined = token.kind in (K.P, K.TO) and words.among(at, "setting_places") and words.among(place, "settings")
        scale = words.among(place + 1, "scales")
        if not joined or (
            not scale and (words.kind(place + 1) in (K.N, K.PARTICIPLE) or words.among(place + 1, "of_words"))
        ):
            continue
        setting = tokens[place]
        others = [token, *tokens[place + 1 : place + 1 + scale]]
        setting.kind, setting.form = K.MOD, SETTING
        for other in others:
            other.kind = K.FILLER
            setting.parts.append(other.span)


def _exceptions(words: Words) -> None:
    """Mark what opens an exception: "except", and "but" or "save" behind a word for all there is."""
    whole, all_of_them = -_AHEAD, False
    for at, token in enumerate(words.tokens):
        all_of_them = token.kind is not K.STOP and (all_of_them or words.among(at, "whole_words", "all_words"))
        denied = all_of_them and words.among(at, "excepted") and words.follows(at + 1, "NEG IDLE* NP")
        if denied:  # "everything in the fridge, but not my cup"
            token.kind, words.tokens[at + 1].kind = K.EXC, K.FILLER
        if words.among(at, "whole_words", "all_words", "all_people"):
            whole = at
        elif token.kind in (K.STOP, K.COMMA, K.V):
            whole = -_AHEAD
        near = at - whole <= _NEAR or words.tokens[at - 1].text in pairs("affirmed")  # "nothing but the cup"
        but = near and words.among(at, "exceptive") and words.follows(at + 1, "IDLE* NP")
        if but or (token.kind is K.P and words.among(at, "exceptions")):
            token.kind = K.EXC
            _name_all(words, at - 1)


def _name_all(words: Words, at: int) -> None:
    """Let "all" before an exception name all there is: "feed all but Rex"."""
    if words.kind(at) is K.DET and words.among(at, "all_words"):
        words.tokens[at].kind, words.tokens[at].text = K.PRON, first_of("whole_words")


def _with_verbs(words: Words) -> list[Token]:
    """Repeat the verb behind an "otherwise" that none follows: "put it in the shed if it is dry, else in the sun"."""
    result: list[Token] = []
    deed, stated = Token(K.V, PUT, NOWHERE, stem=PUT, form="base"), False
    for at, token in enumerate(words.tokens):
        result.append(token)
        if token.kind in (K.V, K.AUX, K.FINITE):
            deed, stated = token if token.kind is K.V else deed, token.kind is not K.V
        if words.among(at, "otherwise_words") and words.kind(at - 1) in LINKS | {K.STOP}:
            begin = words.past(at + 1, "(IDLE|COMMA)*")
            if words.follows(begin, "TO|P|NP") and words.first(begin, _DEED) == words.first(begin, "STOP"):
                token.kind = K.FILLER
                place = Span(token.span.end, token.span.end)
                result.append(replace(deed, span=place, parts=[], first=None))
                if words.kind(at - 1) in LINKS:  # "or else the lamp"
                    words.tokens[at - 1].kind = K.STOP if stated else K.COMMA
    return result


def _sentences(tokens: list[Token]) -> None:
    """Number the sentences that verbs stand in; mark headings, and verbs behind "otherwise"."""
    number, otherwise, taken = 0, False, False
    last: Token | None = None
    for at, token in enumerate(tokens):
        if token.kind is K.STOP and token.text[:1] in ".!?;":
            number, last = number + 1, None
        if token.kind is K.STOP and token.text == ":" and last is not None:
            last.heading = any(t.kind in (K.V, K.N) for t in tokens[at + 1 :])
            otherwise = otherwise and not taken
            taken = False
        otherwise = otherwise or token.text in section("otherwise_words")
        if token.kind in (K.AUX, K.FINITE):
            token.otherwise = taken = otherwise  # "otherwise the door is to be shut"
        if token.kind in (K.V, K.LET):
            token.sentence, token.otherwise, otherwise, last = number, otherwise, False, token


def _mark_early(words: Words) -> None:
    """Mark a later verb with "first" in its clause: "put the cup in the crate, but wash it first"."""
    deeds = [at for at, token in enumerate(words.tokens) if token.kind in (K.V, K.LET)]
    for at in deeds[1:]:
        end = words.first(at + 1, "BREAK | V | LET")
        then = any(words.among(i, "then_words") for i in range(end, words.first(end, "STOP")))
        joint = words.back(at)
        contrary = words.among(joint, "contrary_joints")
        behind = words.among(end - 1, "beforehand") and words.kind(end - 1) is K.ADV and words.kind(end) is not K.CC
        apart = words.kind(joint) is not K.CC or contrary  # "and wash it first" goes on
        ahead = contrary and any(words.among(i, "beforehand") for i in range(joint, at))
        words.tokens[at].early = (behind and apart and not then) or ahead


class _Particles(Words):
    """Joins each verb with its particle, beside it or behind its object."""

    def __init__(self, tokens: list[Token], lexicon: Lexicon) -> None:
        super().__init__(tokens)
        self.lexicon = lexicon

    def run(self) -> None:
        for at, verb in enumerate(self.tokens):
            deed = verb.kind is K.ING and self.kind(at - 1) not in HEADS
            if self._stands(at):
                continue
            if (verb.kind in (K.V, K.LET) or deed) and verb.stem:
                if not self._several_words(at):
                    self._particle(at)
            elif verb.kind in (K.PARTICIPLE, K.FINITE, K.ING) and not self.stem_among(at, "belonging"):
                self._next_particle(at)
            elif verb.kind is K.ADJ and verb.form == "ed" and self._match(verb.stem, at + 1) is not None:
                verb.kind = K.PARTICIPLE  # "the bag should be tied up"
                self._next_particle(at)

    def _stands(self, at: int) -> bool:
        """Return whether a place follows a verb: "the cart can wait in the yard", "the ropes are going on the cart"."""
        waits = (
            self.stem_among(at, "waiting", "belonging")
            and self.among(at + 1, "static")
            and self.follows(at + 2, "IDLE* NP")
        )
        return waits or (self.kind(at) is K.ING and self.stem_among(at, "belonging"))

    def _next_particle(self, at: int) -> None:
        """Join a verb of a clause with the particle right behind it."""
        if self.among(at - 1, "addressee") and self._particle(at):
            return  # "before you switch the light off"
        match = self._match(self.tokens[at].stem, at + 1) if self.kind(at + 1) in (K.P, K.ADV) else None
        if match is not None and not self.follows(at + 2, "IDLE* NP"):
            self._absorb(self.tokens[at], [self.tokens[at + 1]], f"{self.tokens[at].stem}_{self.tokens[at + 1].text}")

    def _match(self, stem: str, at: int) -> bool | None:
        return self.lexicon.particle(stem, self.tokens[at].text) if at < len(self.tokens) else None

    def _several_words(self, at: int) -> bool:
        """Join "get rid of", "look for", and "bring it to the boil"."""
        verb = self.tokens[at]
        for length in (2, 1):
            run = self.tokens[at + 1 : at + 1 + length]
            if len(run) == length and (name := "_".join([verb.stem, *(t.text for t in run)])) in section("verb_of"):
                self._absorb(verb, run, name)
                return True
        if verb.stem not in section("splitting"):
            return False
        for end in range(at + 1, min(at + _AHEAD // 2, self.first(at + 1, "STOP"))):
            start = end - 1 - (self.kind(end - 1) is K.DET)
            for run in (self.tokens[end : end + 1], self.tokens[start : end + 1]):
                name = "_".join([verb.stem, *(t.text for t in run if t.kind is not K.DET)])
                if start > at and name in section("split_verbs"):
                    self._absorb(verb, run, name)
                    return True
        return False

    @staticmethod
    def _absorb(verb: Token, others: list[Token], stem: str) -> None:
        verb.stem = stem
        for token in others:
            token.kind = K.FILLER
            verb.parts.append(token.span)

    def _particle(self, at: int) -> bool:
        verb, behind = self.tokens[at], False
        keeps = self.stem_among(at, "leaving", "keeping")
        said = "(COMMA|CC) (NP|OF|P|IDLE)* AUX"  # "shut the window, the lamp should be off"
        end = self.first(at + 1, f"V|FINITE|LET|NEG|ENSURE|STOP|SUB|REL|EXC|{said}")
        for place in range(at + 1, min(at + _AHEAD, end)):
            token = self.tokens[place]
            if token.kind not in (K.P, K.ADV):
                continue
            if place > at + 1 and self.kind(place - 1) is K.CC:
                return False  # "turn it to two and then down a bit"
            if not behind and self._parted(verb, token):
                return True
            if keeps and place > at + 1 and self.among(place, "end_states"):
                return False  # "leave the radio on": as it is, and no particle
            if self._joins(at, place, behind=behind):
                self._absorb(verb, [token], f"{verb.stem}_{token.text}")
                return True
            behind = behind or token.kind is K.P
        return False

    def _joins(self, at: int, place: int, *, behind: bool) -> bool:
        """Return whether the word at a place is the particle of the verb."""
        match = self._match(self.tokens[at].stem, place)
        there = self.among(place + 1, "there_words") and self.among(place, "static")
        if there and not (match and not self.stem_among(at, "placing", "put_verbs")):
            return False  # "make it dark in here"; but "switch the lamp on there"
        if match is None:
            return not behind and self._moves_object(at, place) and self._before_noun(at, place, strict=False)
        pure = self.among(place, "pure_particles")
        return (not behind or pure or match) and self._before_noun(at, place, strict=match)

    @staticmethod
    def _parted(verb: Token, token: Token) -> bool:
        """Give "up" of "hook it up to the set" to the verb."""
        if token.text not in section("parted"):
            return False
        first, _, rest = token.text.partition("_")
        start, end = token.span
        verb.stem, token.text = f"{verb.stem}_{first}", rest
        verb.parts.append(Span(start, start + len(first)))
        token.span = Span(end - len(rest), end)
        return True

    def _moves_object(self, at: int, place: int) -> bool:
        """Return whether "up" or "out" goes with a verb of no list: "fluff up the pillows", "fluff them up"."""
        beside = place == at + 1
        if self.stem_among(at, "intransitive", "chain_verbs", "lead_verbs"):
            return False
        if not self.among(place, "free_particles" if beside else "final_particles"):
            return False
        between = all(t.kind in NP | IDLE for t in self.tokens[at + 1 : place])
        return self.follows(place + 1, "IDLE* NP" if beside else "IDLE* BREAK") and between

    def _before_noun(self, at: int, place: int, *, strict: bool) -> bool:
        """Tell a particle from a preposition where a noun phrase follows: "put on some music", "put on the table"."""
        if not self.follows(place + 1, "IDLE* NP"):
            return True
        text, adjacent = self.tokens[place].text, all(t.kind in IDLE for t in self.tokens[at + 1 : place])
        if self.among(place, "pure_particles"):
            return adjacent or text not in pairs("relation_names")
        return adjacent and (strict or self._object_of_particle(at, place))

    def _object_of_particle(self, at: int, place: int) -> bool:
        text, head, fresh = self.tokens[place].text, "", False
        for token in self.tokens[place + 1 : self.past(place + 1, "(NP|OF)*")]:
            if token.kind is K.OF and singular(head) not in section("measures"):
                break
            fresh = fresh or token.text in section("fresh_words")
            head = token.text if token.kind in HEADS else head
        contained = singular(head) in section("containers")
        if not self.among(place, "object_particles"):
            return self.among(place, "adjacent_particles")
        if self.stem_among(at, "put_verbs"):
            return head in section(f"put_{text}_objects") or (fresh and not contained)
        return not contained
