"""Parts of speech from the neighbours: verb or noun, pronoun or determiner, infinitive or preposition.

Each word gets one class before any grammar runs; leaving the choice to an ambiguous grammar picks the noun reading in
lists and is far slower. The rules are tables: of the table for a word (:func:`_rule`) the first row whose condition
holds says what the word is. Each row has its reason and an example, in which the word stands between asterisks;
``tests/language/test_part_of_speech.py`` holds every row to it. To add a rule, add a row where it comes first.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from tmd.language.clause import NOWHERE
from tmd.language.lexicon.lexicon import Lexicon, section
from tmd.language.syntax.tokens import Kind, Token

_EDGE = Token(Kind.STOP, "", NOWHERE)
"""What stands before the first word and behind the last."""
_ARTICLES = frozenset({Kind.DET, Kind.PRON})
_OPENERS = frozenset({Kind.DET, Kind.PRON, Kind.NUM, Kind.ADJ})
_ENDS = frozenset({Kind.STOP, Kind.COMMA, Kind.CC})
_OPEN_CLAUSES = frozenset({Kind.SUB, Kind.REL, Kind.PURP})
_HEADS = frozenset({Kind.N, Kind.PRON})
_PERSONS = frozenset({"me", "us", "him", "her", "you"})
_NARRATORS = frozenset({"he", "she", "they", "i", "we", "you"})
_SERIAL = frozenset({"go", "come", "run", "help", "hurry"})
"""Verbs that only lead to the next one: "go get the cup"."""
_SERVING = frozenset({"serve", "keep", "eat", "drink"})
_DEGREES = frozenset({"really", "very", "quite", "too", "extremely"})
_COLOURS = frozenset({"red", "blue", "green", "yellow", "orange", "pink", "brown", "black", "white", "grey", "gray"})


@dataclass(slots=True)
class Sentence:
    """What the rules know of the sentence so far."""

    sub: bool = False
    """Inside a condition or relative clause whose own verb has not come yet ..."""
    nominal: bool = False
    """... and whose subject has come."""
    narrative: bool = False
    """The sentence tells what somebody does: "she takes the cup"."""
    let: bool = False
    """*Let* waits for its verb: "let the tea cool"."""
    verb: bool = False
    """An instruction verb has come."""

    @property
    def clause(self) -> bool:
        """A condition or relative clause has a subject, and waits for its verb."""
        return self.sub and self.nominal

    def close(self) -> None:
        """Leave the condition or relative clause."""
        self.sub = self.nominal = False


class Neighbours:
    """A word and what stands around it: what a rule looks at.

    Attributes:
        left: The token before it that is no adverb, decided.
        right: The token behind it that is no adverb, with its first tag.
        beyond: The one behind that.
    """

    __slots__ = ("at", "beyond", "left", "lexicon", "right", "sentence", "token", "tokens")

    def __init__(self, tokens: list[Token], at: int, left: Token, sentence: Sentence, lexicon: Lexicon) -> None:
        """Look at the word at one place of a text."""
        self.token, self.tokens, self.at, self.left = tokens[at], tokens, at, left
        self.sentence, self.lexicon = sentence, lexicon
        ahead = [t for t in tokens[at + 1 : at + 8] if t.kind is not Kind.ADV]
        self.right, self.beyond = [*ahead, _EDGE, _EDGE][:2]

    @property
    def text(self) -> str:
        """The word as it is written, in lower case."""
        return self.token.text

    @property
    def sure(self) -> int:
        """How sure the word is a verb: 3 no noun, 2 a noun as well, 1 more often a noun."""
        return self.token.strength

    def among(self, *names: str) -> bool:
        """Tell whether one of these sections of ``words.txt`` has the word."""
        return any(self.token.text in section(name) for name in names)

    @property
    def first(self) -> bool:
        """It begins a sentence or a part of one."""
        return self.left.kind in _ENDS

    @property
    def determined(self) -> bool:
        """An article or the like stands before it."""
        return self.left.kind is Kind.DET

    @property
    def article(self) -> bool:
        """An article or a pronoun stands behind it."""
        return self.right.kind in _ARTICLES

    @property
    def object(self) -> bool:
        """What stands behind it can be its object: an article, a pronoun, or a number behind a likely verb."""
        relative = self.right.text == "that" and (self.beyond.kind is Kind.AUX or self.beyond.form in ("s", "ed"))
        if relative and self.left.kind in (Kind.N, Kind.DET):
            return False  # "the slice that is left"
        return self.article or (self.right.kind is Kind.NUM and self.sure > 1)

    @property
    def opener(self) -> bool:
        """What stands behind it can begin a noun phrase."""
        return self.right.kind in _OPENERS or _weak(self.right)

    @property
    def modified(self) -> bool:
        """A word that it may belong to as an adjective stands behind it."""
        return self.right.kind in (Kind.WORD, Kind.ADJ, Kind.NUM) or self.right.text in ("one", "ones")

    @property
    def noun_next(self) -> bool:
        """A likely noun stands behind it."""
        return _weak(self.right) or self.right.text == "can"

    @property
    def particle(self) -> bool:
        """The word behind it is its particle: "switch on"."""
        return self.lexicon.particle(self.token.stem or self.text, self.right.text) is not None

    @property
    def moved(self) -> Token:
        """What the particle before it moves: "turn it on wait"."""
        near = self.at > 1 and self.tokens[self.at - 1] is self.left
        return self.tokens[self.at - 2] if near else _EDGE

    @property
    def person(self) -> bool:
        """Somebody stands before it: "hand me the cup"."""
        return self.left.text in _PERSONS

    @property
    def helped(self) -> list[Token]:
        """*Help me* right before it: it is the verb that counts."""
        lead = self.tokens[max(0, self.at - 2) : self.at]
        helps = len(lead) == 2 and lead[0].kind is Kind.V and lead[0].stem == "help"
        return lead if helps and lead[1].text in _PERSONS else []

    @property
    def predicate(self) -> bool:
        """The adjectives before it belong to a verb: "is full"."""
        before = (t.kind for t in reversed(self.tokens[max(0, self.at - 4) : self.at]))
        return next((kind for kind in before if kind not in (Kind.ADJ, Kind.ADV)), None) is Kind.AUX

    @property
    def paired_state(self) -> bool:
        """A state stands before the conjunction before it."""
        before = [t.kind for t in self.tokens[max(0, self.at - 2) : self.at - 1]]
        return before in ([Kind.PARTICIPLE], [Kind.ADJ])

    @property
    def later_verb(self) -> bool:
        """A verb comes later in the same part of the sentence."""
        for token in self.tokens[self.at + 1 :]:
            if token.kind in _ENDS:
                return False
            if (token.strength >= 2 and token.form == "base") or token.kind is Kind.AUX:
                return True
        return False


class TagRule(NamedTuple):
    """One row of a table: the class of a word, why, when, and an example with the word between asterisks."""

    tag: Kind
    reason: str
    when: Callable[[Neighbours], bool]
    example: str


def _always(_: Neighbours) -> bool:
    return True


def _weak(token: Token) -> bool:
    """Tell whether a token is a likely noun."""
    return token.kind is Kind.WORD and token.strength < 2


def _infinitive(word: Neighbours) -> bool:
    """Tell whether what follows can be an infinitive."""
    right = word.right
    return not right.capital and right.form in ("base", "") and right.kind in (Kind.WORD, Kind.LET)


def _headless(word: Neighbours) -> bool:
    return word.right.kind in _ENDS | {Kind.P}


def _modifies(word: Neighbours) -> bool:
    return word.right.kind in (Kind.WORD, Kind.N, Kind.ADJ)


def _heads(word: Neighbours) -> bool:
    """Tell whether it comes first, is a noun rather than a verb, and what follows is no particle of it."""
    return word.first and word.sure < 2 and word.lexicon.is_noun(word.text) and not word.particle


def _starts(word: Neighbours) -> bool:
    """Tell whether an instruction can begin with it."""
    return word.left.kind in (Kind.STOP, Kind.ENSURE, Kind.PURP, Kind.MOD)


def _after_particle(word: Neighbours) -> bool:
    """Tell whether it is a sure verb behind what may be the particle of the verb before."""
    particle = word.left.text in section("particles") | {"inside", "outside"}
    return word.left.kind in (Kind.P, Kind.TO) and word.sure == 3 and particle


V, N, P, DET, NUM, PRON, ADJ, ADV = Kind.V, Kind.N, Kind.P, Kind.DET, Kind.NUM, Kind.PRON, Kind.ADJ, Kind.ADV
AUX, SUB, REL, TO, CC, COMMA, STOP = Kind.AUX, Kind.SUB, Kind.REL, Kind.TO, Kind.CC, Kind.COMMA, Kind.STOP
ING, PARTICIPLE, FINITE, SUBJECT = Kind.ING, Kind.PARTICIPLE, Kind.FINITE, Kind.SUBJECT
LET, MOD, WORD = Kind.LET, Kind.MOD, Kind.WORD
Rule = TagRule  # short, so that a row takes two or three lines

# fmt: off
CLOSED: dict[Kind, tuple[TagRule, ...]] = {
    STOP: (
        Rule(Kind.FILLER, "a colon right behind a verb separates nothing",
             lambda w: w.text == ":" and w.left.kind is V, "Take*:* the cup and the bowl."),
    ),
    CC: (
        Rule(N, "behind an article it is a thing",
             lambda w: w.text == "plus" and w.determined, "Press the *plus*."),
    ),
    SUB: (
        Rule(ADV, "nothing that could be a clause follows: how often",
             lambda w: w.text == "once" and w.right.kind in _ENDS | {MOD}, "Stir the soup *once*."),
        Rule(V, "behind a subject or an auxiliary it is the verb",
             lambda w: w.text == "like" and w.left.kind in (AUX, SUBJECT), "I would *like* a tea."),
    ),
    LET: (
        Rule(FINITE, "the verb of a clause that has a subject",
             lambda w: w.sentence.clause and w.left.kind in _HEADS, "If they *let* the cat in, close the door."),
    ),
    TO: (  # a row makes it the mark of an infinitive; otherwise it says whither
        Rule(TO, "what something is for",
             lambda w: w.left.text in ("something", "anything", "nothing") and w.right.strength > 0,
             "Bring me something *to* drink."),
        Rule(TO, "an auxiliary follows",
             lambda w: w.right.text in ("be", "have", "do"), "Use the cloth *to* do the dishes."),
        Rule(TO, "a sure verb follows",
             lambda w: _infinitive(w) and w.right.strength == 3, "Use the knife *to* open the box."),
        Rule(TO, "a verb follows that is a noun as well, and behind it something that goes with verbs",
             lambda w: _infinitive(w) and w.right.strength == 2
             and (_weak(w.beyond) or w.beyond.kind in _OPENERS | {P, REL, SUB, STOP, CC, MOD}),
             "Use the remote *to* set the clock."),
        Rule(TO, "a noun follows that is a verb here, since it has an object",
             lambda w: _infinitive(w) and w.right.strength == 1 and w.beyond.kind in _ARTICLES,
             "Use the can *to* water the fern."),
    ),
    DET: (
        Rule(REL, "an auxiliary follows: a clause",
             lambda w: w.text == "what" and w.right.kind is AUX, "Take *what* is in the bowl."),
        Rule(ADV, "behind a pronoun it belongs to that",
             lambda w: w.text in ("all", "both") and w.left.kind is PRON, "Put them *both* on the table."),
        Rule(PRON, "somebody is given something",
             lambda w: w.text == "her" and w.left.kind is V and w.left.stem == "give", "Give *her* the book."),
        Rule(REL, "behind a noun, and a verb or a subject follows: a clause",
             lambda w: w.text == "that" and w.left.kind in _HEADS
             and (w.right.kind in (AUX, PRON, SUBJECT) or w.right.form in ("s", "ed") or w.right.capital),
             "Take the cup *that* is on the table."),
        Rule(PRON, "no noun follows, nor *of*",
             lambda w: w.among("pronouns")
             and w.right.kind not in (DET, ADJ, NUM, WORD) and w.right.text != "of", "Take *this* to the hall."),
    ),
    PRON: (
        Rule(SUBJECT, "it is no object, and no clause is open that it could be the subject of",
             lambda w: w.among("subjects") and w.left.kind not in (P, V, TO) and not w.sentence.sub,
             "Now *you* take the cup."),
    ),
    AUX: (
        Rule(N, "nothing follows that it could help",
             lambda w: w.text == "can" and w.right.kind in _ENDS | {P, TO}, "Open the *can*."),
        Rule(N, "behind an article or a noun, and no verb follows",
             lambda w: w.text == "can" and w.left.kind in (N, DET, ADJ)
             and not (w.right.strength and w.right.form == "base"), "Open the *can* the robot brought."),
        Rule(V, "an instruction with an object",
             lambda w: w.text in ("need", "needs", "do") and w.first and w.article and w.right.text != "you",
             "*Do* the dishes."),
    ),
}
"""Words of lists that are something else in some places: by their first tag."""

MODIFIERS = (
    Rule(N, "behind an article, and no noun follows: a thing",
         lambda w: w.determined and _headless(w) and w.text in ("well", "same", "other", "others"),
         "Use the *well*."),
    Rule(N, "behind *a*, and no noun follows: a thing, not a comparative",
         lambda w: w.left.text in ("a", "an") and _headless(w) and w.text.endswith("er"),
         "Bring a rope and an *opener*."),
    Rule(N, "which of several",
         lambda w: w.determined and _modifies(w) and w.text in ("upstairs", "downstairs"),
         "Open the *upstairs* window."),
    Rule(V, "first, and an object follows",
         lambda w: w.token.kind is ADJ and w.token.form == "base" and w.sure > 1 and w.first
         and (w.article or (w.particle and w.beyond.kind in _ARTICLES)), "*Separate* the eggs."),
    Rule(V, "somebody tells what was done",
         lambda w: w.token.kind is ADJ and w.token.form == "ed" and w.token.stem != ""
         and (w.left.kind is SUBJECT or (w.first and w.article)), "She *closed* the door."),
    Rule(ADV, "first, and a sure verb follows",
         lambda w: w.token.kind is not P and (w.among("adverbs") or w.text in ("next", "last")) and w.first
         and w.right.strength == 3 and w.right.form == "base", "*Next* open the box."),
    Rule(P, "between two nouns: where",
         lambda w: w.text in ("nearest", "closest") and w.left.kind is N and w.right.kind in _OPENERS,
         "Take the cup *nearest* the sink."),
    Rule(N, "behind an article or an adjective: which of several",
         lambda w: w.left.kind in (DET, ADJ) and w.among("keep_adjectives"), "Open the *right* door."),
    Rule(N, "behind an article, and no noun follows: a place",
         lambda w: w.left.kind in (DET, ADJ) and w.text in ("inside", "outside", "front", "back") and not _modifies(w),
         "Wipe the *inside*."),
    Rule(N, "before a noun: which of several",
         lambda w: w.token.kind is ADV and w.among("keep_adjectives") and _modifies(w)
         and not (w.left.kind is V and w.lexicon.particle(w.left.stem, w.text) is not None)  # "put back soap"
         and (w.text != "right" or w.right.text in section("keep_adjectives")
              or (w.left.kind in (P, V, CC, COMMA, N) and w.right.kind is WORD)), "Put the cup on *right* shelf."),
)
"""Adjectives, adverbs and prepositions that are something else in some places."""

ANY_WORD = (
    Rule(N, "whose it is",
         lambda w: w.token.form == "possessive", "Wash the bowl and *Mark's* cup."),
    Rule(ADV, "what becomes of the thing before it",
         lambda w: w.left.kind in _HEADS and w.right.kind in _ENDS | {P}
         and (w.text == "shut" or (w.text == "flat" and w.left.kind is PRON)
              or (w.text in _COLOURS and w.left.text not in section("keep_adjectives") | {"egg"})),
         "Paint the fence *white*."),
    Rule(ADJ, "before a noun that looks like an auxiliary",
         lambda w: w.determined and w.among("drop_adjectives") and w.right.text == "can", "Take the *empty* can."),
    Rule(ADV, "behind a verb of moving, and no noun follows: whither",
         lambda w: w.text in ("left", "right") and w.left.kind is V and w.left.stem in ("turn", "go", "look", "head")
         and w.right.kind is not WORD, "Turn *left*."),
    Rule(V, "behind *to*, and its particle follows",
         lambda w: w.token.stem != "" and w.left.kind is TO and w.particle, "Use the remote to *switch* on the tv."),
    Rule(N, "first, and what follows says in what state it shall be",
         lambda w: _heads(w) and w.right.text in ("on", "off", "out") and w.beyond.kind in _ENDS, "*Music* on."),
    Rule(N, "first, and what follows says where it shall be",
         lambda w: _heads(w) and w.right.text in ("in", "into", "on", "onto") and w.beyond.kind not in _ENDS,
         "*Water* in the pot, lid on the pot."),
)
"""Words of no list of closed classes, whatever their form."""

UNKNOWN_WORD = (
    Rule(V, "nothing else can stand first before an article",
         lambda w: w.right.text in ("the", "a", "an", "my", "it", "them") and w.article
         and (w.first or w.left.kind is SUBJECT) and not w.lexicon.is_noun(w.text) and w.text.isalpha(),
         "*Blorf* the soup."),
    Rule(N, "what is no known verb is a thing", _always, "Take the *blorf*."),
)
"""Words that are no form of a known verb."""

ING_FORM = (
    Rule(ING, "behind an auxiliary or a conjunction",
         lambda w: w.left.kind in (AUX, SUB), "While *stirring*, add the milk."),
    Rule(ING, "how, or when",
         lambda w: w.left.kind is P and w.left.text in ("by", "without", "after", "before"),
         "Open it by *pressing* the button."),
    Rule(ING, "behind a verb that only leads to it",
         lambda w: w.left.kind is V and w.left.stem in section("lead_verbs") | {"keep", "stop"}, "Keep *stirring*."),
    Rule(N, "a known noun",
         lambda w: w.lexicon.is_noun(w.text), "Add salt and *seasoning*."),
    Rule(N, "a noun follows: what kind that is",
         lambda w: w.left.kind in {STOP, CC, MOD} | _HEADS and w.noun_next
         and (w.among("ing_modifiers") or w.sure < 3), "Take the green *watering* can."),
    Rule(N, "the kind of something in a list",
         lambda w: w.left.kind is COMMA and w.noun_next and w.among("ing_modifiers") and w.sentence.verb,
         "Mix the flour, *baking* soda and salt."),
    Rule(ING, "where a clause can begin, or behind the noun that it is said of",
         lambda w: w.left.kind in _ENDS | _HEADS | {MOD}, "The robot *holding* the cup."),
    Rule(N, "anything else is a noun", _always, "Take two *painting* brushes."),
)
PAST_FORM = (
    Rule(PARTICIPLE, "behind an auxiliary or a conjunction",
         lambda w: w.left.kind in (AUX, SUB), "When the soup is *heated*, stir it."),
    Rule(V, "somebody tells what was done",
         lambda w: w.left.kind is SUBJECT or (w.sentence.narrative and w.left.kind in (CC, COMMA)),
         "She *stirred* the soup."),
    Rule(N, "the side",
         lambda w: w.text == "left" and w.left.kind is not PRON and w.right.kind is WORD, "Open the *left* drawer."),
    Rule(V, "first, and an object follows",
         lambda w: w.first and w.article, "*Rinsed* the cup."),
    Rule(FINITE, "behind its subject, and an object follows",
         lambda w: w.left.kind in _HEADS | {NUM} and w.article, "The robot *stirred* the soup."),
    Rule(PARTICIPLE, "behind the noun that it is said of",
         lambda w: w.left.kind in _HEADS | {NUM}, "Take the cup *filled* with milk."),
    Rule(N, "behind an article, and no noun follows",
         lambda w: w.left.kind in (DET, ADJ) and w.right.kind in _ENDS | {P, TO, SUB} and not w.text.endswith("ed"),
         "Put the *rose* in the vase."),
    Rule(N, "which of several",
         lambda w: w.text == "left" or w.among("keep_adjectives"), "Take the *boiled* egg."),
    Rule(ADJ, "before a noun: in what state it is", _always, "Take the *folded* towel."),
)
THIRD_PERSON = (
    Rule(FINITE, "the verb of a clause that has a subject",
         lambda w: w.sentence.clause and w.left.kind in _HEADS | {REL, P, SUBJECT},
         "When the kettle *whistles*, take it."),
    Rule(V, "somebody tells what is done",
         lambda w: w.left.kind is SUBJECT or w.left.text == "robot", "She *takes* the cup."),
    Rule(V, "somebody goes on telling what is done",
         lambda w: w.sentence.narrative and w.left.kind in (CC, COMMA) and not w.lexicon.is_noun(w.text),
         "She opens the fridge and *takes* the milk."),
    Rule(FINITE, "behind its subject",
         lambda w: w.left.kind in _HEADS and w.sure >= 2 and not w.lexicon.is_noun(w.text)
         and (w.left.kind is PRON or w.article or w.sure == 3), "The robot arm *takes* the cup."),
    Rule(N, "a plural", _always, "Take the *slices*."),
)
BASE_FORM = (
    Rule(ADJ, "the second of two states",
         lambda w: w.left.kind is CC and w.sure < 3 and w.right.kind in _ENDS and w.paired_state
         and not w.lexicon.is_noun(w.text),
         "Stir it until it is blended and *smooth*."),
    # where only a verb can stand
    Rule(V, "behind a subject or a negation",
         lambda w: w.left.kind in (SUBJECT, Kind.NEG), "Do not *touch* the stove."),
    Rule(V, "an infinitive",
         lambda w: w.left.kind is TO and w.left.form == "inf", "Use the knife to *open* the box."),
    Rule(ADJ, "behind a number, before a noun: in what state it is",
         lambda w: w.left.kind is NUM and w.among("drop_adjectives") and w.modified,
         "Take the two *empty* bottles."),
    Rule(N, "behind a form of *be* or *have*: what something is",
         lambda w: w.left.kind is AUX and w.left.text in section("be") | {"has", "have", "had"},
         "If it is *water*, drink it."),
    Rule(V, "behind another auxiliary",
         lambda w: w.left.kind is AUX, "The robot should *wash* the cup."),
    # conditions and relative clauses
    Rule(FINITE, "the verb of a clause that has a subject",
         lambda w: w.sentence.clause and (w.left.kind in (PRON, REL) or (w.left.kind is N and w.sure >= 2)),
         "When the potatoes *boil*, add salt."),
    Rule(N, "the second noun of the subject of a clause",
         lambda w: w.sentence.clause and w.left.kind is N, "When the bread *box* is empty, wash it."),
    Rule(N, "where only a noun can stand",
         lambda w: w.left.kind in (SUB, DET, REL) or (w.left.kind is ADJ and not w.predicate), "Take the *drink*."),
    Rule(V, "a likely verb behind the verb of another clause; behind one with -ing it must be a sure one",
         lambda w: w.left.kind in (FINITE, PARTICIPLE, ADJ, ING) and w.sure >= 2 + (w.left.kind is ING),
         "If the bowl is full *empty* it."),
    Rule(N, "what the verb of another clause acts on",
         lambda w: w.left.kind in (FINITE, ING, PARTICIPLE, ADJ), "While heating *water*, open the bag."),
    # behind let
    Rule(V, "right behind *let*, and no noun follows",
         lambda w: w.left.kind is LET and w.sure >= 2 and w.right.kind in _ENDS | {P, SUB, MOD},
         "Let *cool* for an hour."),
    Rule(V, "the verb that *let* waits for",
         lambda w: w.sentence.let and w.left.kind in _HEADS | {TO} and (w.person or w.sure >= 2 or not w.opener),
         "Let the tea *steep*."),
    # behind a verb
    Rule(V, "behind *help me*", lambda w: w.sure >= 2 and w.helped != [], "Help me *fold* the towels."),
    Rule(V, "behind *go* and the like",
         lambda w: w.left.kind is V and w.left.stem in _SERIAL and w.sure >= 2, "Go *get* the cup."),
    Rule(V, "a sure verb with an object, behind a verb without one",
         lambda w: w.left.kind is V and w.left.strength > 1 and w.sure == 3 and w.right.text in ("the", "it", "them")
         and not w.lexicon.is_noun(w.text), "Stir *wash* the pan."),
    Rule(ADV, "in what state something is served",
         lambda w: w.left.kind is V and w.left.stem in _SERVING and w.among("drop_adjectives")
         and w.right.kind in _ENDS | {P}, "Serve *warm* with cream."),
    Rule(N, "what the verb before it acts on", lambda w: w.left.kind is V, "Add *water*."),
    # at the start of a sentence
    Rule(V, "a likely verb that comes first",
         lambda w: _starts(w) and w.sure >= 2, "*Slice* bread."),
    Rule(V, "first, and behind it an object, a place or nothing",
         lambda w: _starts(w) and (w.object or w.right.kind in (STOP, P, MOD, TO)), "*Water* the fern."),
    Rule(V, "first, and a number with its noun follows",
         lambda w: _starts(w) and w.right.kind is NUM and (w.beyond.kind is WORD or w.beyond.text == "of"),
         "*Water* two ferns."),
    Rule(V, "first, before a noun, and no other verb follows",
         lambda w: _starts(w) and w.right.kind in (WORD, ADJ) and not w.later_verb, "*Water* ferns."),
    # behind a comma or a conjunction
    Rule(V, "its particle follows",
         lambda w: w.left.kind in (CC, COMMA) and w.right.kind is P
         and w.lexicon.particle(w.token.stem, w.right.text) is True,
         "Take the remote and *switch* on the tv."),
    Rule(V, "behind *then* only an instruction can come",
         lambda w: w.left.kind is CC and w.left.text == "then" and w.sure >= 2, "Boil the milk, then *reduce* heat."),
    Rule(V, "a noun that is a verb here: *with* says what it is done with",
         lambda w: w.left.kind is CC and w.right.text == "with" and w.among("with_verbs") and w.sentence.verb,
         "Spread jam over the cake and *top* with cream."),
    Rule(V, "up, down or out follows, and then an object",
         lambda w: w.left.kind in (CC, COMMA) and w.right.text in ("up", "down", "out") and w.beyond.kind in _ARTICLES,
         "Take the cloth and *dust* down the shelf."),
    Rule(V, "a sure verb", lambda w: w.left.kind in (CC, COMMA) and w.sure == 3, "Wash and *dry* the cup."),
    Rule(V, "a likely verb, and behind it an object, a place or nothing",
         lambda w: w.left.kind in (CC, COMMA) and w.sure == 2
         and (w.opener or w.right.kind in (P, STOP, MOD, SUB, Kind.PURP, TO)), "Take the bread and *set* the table."),
    Rule(V, "a noun that is a verb here, since it has an object",
         lambda w: w.left.kind in (CC, COMMA) and w.sure == 1 and w.object, "Fill the can and *water* the fern."),
    # behind a preposition or a particle
    Rule(V, "a sure verb behind a particle, with an object",
         lambda w: _after_particle(w) and w.object, "Take the sheets out *fold* them."),
    Rule(V, "a sure verb behind a particle that moves what stands before it",
         lambda w: _after_particle(w) and (w.moved.kind is PRON
                                           or (w.moved.kind is N and w.token.stem in section("intransitive"))),
         "Turn it on *wait*."),
    Rule(N, "behind a preposition", lambda w: w.left.kind in (P, TO), "Fill the cup with *water*."),
    # right behind an object, with no sign between: "open the oven put the pan inside"
    Rule(V, "an object follows", lambda w: w.object and not w.person, "Open the oven *put* the pan inside."),
    Rule(N, "a known noun, and where: the second word of the object",
         lambda w: w.left.kind is N and w.right.kind in (P, TO) and w.lexicon.is_noun(w.text)
         and w.token.stem not in section("intransitive"), "Place the cheese *slice* on the plate."),
    Rule(V, "a sure verb that needs no object, and nothing that it could belong to",
         lambda w: w.sure == 3 and w.right.kind in _ENDS and w.left.kind is N
         and w.token.stem in section("intransitive") and not w.lexicon.is_noun(w.text),
         "Turn to the left *go* straight."),
    Rule(V, "a sure verb without an object, and where, how long or how many",
         lambda w: w.sure == 3 and not w.person and not (w.among("drop_adjectives") and w.right.kind is P)
         and (w.right.kind in (P, NUM, ADJ) or (w.right.kind is MOD and w.right.form == "duration")
              or (w.right.kind is TO and w.token.stem in section("intransitive"))),
         "Close the door *walk* to the sink."),
    Rule(V, "a sure verb before a noun",
         lambda w: w.sure == 3 and w.right.kind is WORD,
         "Open the oven *bake* bread."),
    Rule(N, "the next noun of the object", _always, "Take the bread *box*."),
)
"""Words that can be the base form of a verb, which most nouns of a home can."""
ADJECTIVES = (
    Rule(ADJ, "before a noun", lambda w: w.among("drop_adjectives") and w.modified, "Take the *dry* towel."),
    Rule(ADJ, "behind an auxiliary", lambda w: w.among("drop_adjectives") and w.left.kind is AUX,
         "If it is *dry*, take it."),
    Rule(ADJ, "behind the noun that it is said of",
         lambda w: w.among("drop_adjectives") and w.left.kind in _HEADS and not w.among("nouns", "noun_verbs"),
         "Wipe it *dry*."),
)
"""Those of them that are adjectives, where a row says noun."""
# fmt: on

_FORMS = {"": UNKNOWN_WORD, "ing": ING_FORM, "ed": PAST_FORM, "s": THIRD_PERSON, "base": BASE_FORM}
_BY_FIRST_TAG = CLOSED | dict.fromkeys((ADJ, ADV, P), MODIFIERS)


def decide(tokens: list[Token], lexicon: Lexicon) -> list[tuple[Token, TagRule]]:
    """Set the kind of every token that its neighbours decide, in place, in one pass; return which row did it."""
    sentence, left = Sentence(), _EDGE
    fired: list[tuple[Token, TagRule]] = []
    _mark_purposes(tokens)
    for at, token in enumerate(tokens):
        word = Neighbours(tokens, at, left, sentence, lexicon)
        rule = _rule(word)
        if token.kind is TO:
            token.form = "inf" if rule else ""
        if rule is not None:
            token.kind = rule.tag
            fired.append((token, rule))
        if token.kind is STOP:
            sentence = Sentence()
        _remember(word, sentence)
        if token.kind not in (ADV, Kind.FILLER):
            left = token
    return fired


def _rule(word: Neighbours) -> TagRule | None:
    """The first row that holds for a word; ``None`` leaves it as it is."""
    token = word.token
    if token.kind is not WORD:
        return _first(_BY_FIRST_TAG.get(token.kind, ()), word)
    rule = _first(ANY_WORD, word)
    if rule is None:
        table = _FORMS.get(token.form if token.stem else "", BASE_FORM)
        rule = _first(table, word)
        if table is BASE_FORM and rule is not None and rule.tag is N:
            rule = _first(ADJECTIVES, word) or rule
    return rule


def _first(table: tuple[TagRule, ...], word: Neighbours) -> TagRule | None:
    return next((rule for rule in table if rule.when(word)), None)


def _remember(word: Neighbours, sentence: Sentence) -> None:
    """Note what a decided word says of the sentence."""
    token, kind = word.token, word.token.kind
    if kind in _OPEN_CLAUSES:
        timed = token.text in ("after", "before", "until") and word.right.kind is MOD  # "after 3 minutes": no clause
        if not timed:
            sentence.sub, sentence.nominal = True, kind is REL
    elif kind is LET:
        if word.left.kind in (CC, COMMA):
            sentence.close()
        sentence.let = token.text != "leave"
    elif kind is SUBJECT and word.among("subjects"):
        sentence.narrative = token.text in _NARRATORS
    elif kind in _HEADS:
        sentence.nominal = True
    elif kind in (FINITE, AUX):
        sentence.close()
    elif kind is V:
        if not token.stem:  # a verb that no list has is its own stem
            known = word.lexicon.verb(token.text)
            token.stem, token.form = known[0] if known else token.text, "base"
        sentence.close()
        sentence.let, sentence.verb = False, True
        sentence.narrative = sentence.narrative or token.form == "s"
        if word.left.kind is V and word.left.stem in _SERIAL:
            word.left.kind = Kind.FILLER
        else:
            for lead in word.helped:
                lead.kind = ADV


def _mark_purposes(tokens: list[Token]) -> None:
    """Tell "hang it up so it dries" from "so, take the cup"."""
    for before, token, after in zip(tokens, tokens[1:], tokens[2:], strict=False):
        if token.text != "so" or before.kind in (STOP, AUX, DET):
            continue
        clause = after.kind in (PRON, SUBJECT) or (after.kind is AUX and "'" in after.text)
        if clause or (after.kind is DET and before.kind not in (CC, COMMA)):
            token.kind = Kind.PURP
