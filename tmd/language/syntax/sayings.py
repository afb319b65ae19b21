"""Clauses with a subject: states, events and possessions, as clauses with *be* or with their verb.

*The water boils* says what *boil the water* brings about; *the cup is dirty* is (be, [cup]) with the result ``dirty``.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from itertools import pairwise, zip_longest

from lark import Tree

from tmd.language.clause import AGENT, BE, BRING, HAVE, OF, PUT, SET, WHERE, WITH, Mood, Quantifier, Relation, Span
from tmd.language.lexicon.lexicon import first_of, pairs, section, sections_of
from tmd.language.syntax.brackets import ALSO
from tmd.language.syntax.drafts import ClauseDraft
from tmd.language.syntax.grammar import Leaf, Node, is_a, leaves, spans, trees
from tmd.language.syntax.noun_phrases import Phrase, about_things, is_number, named_in
from tmd.language.syntax.tokens import EXISTS, IMPLIED, VERBAL, Kind, Token

Attach = Callable[[ClauseDraft, Sequence[Node], Sequence[Node]], None]
"""Attaches arguments, and what a predicate says of them, to a clause."""


class Saying:
    """One part of a subordinate clause or statement.

    Attributes:
        part: Its tree.
        subject: What stands before its predicate.
        rest: What stands behind its verbs.
        verbs: Its verbs, without auxiliaries.
        helpers: Its auxiliaries.
    """

    def __init__(self, part: Tree[Leaf]) -> None:
        """Take a part of the grammar to pieces."""
        predicate = [n for p in trees(part.children, "predicate") for n in p.children]
        words = [n.source for n in predicate if isinstance(n, Leaf)]
        self.part = part
        self.subject = [n for n in part.children if not is_a(n, "predicate")]
        self.rest = [n for n in predicate if not isinstance(n, Leaf) or n.source.kind is Kind.MOD]
        self.verbs = [t for t in words if t.kind in VERBAL - {Kind.AUX} and t.stem]
        self.helpers = [t for t in words if t.kind is Kind.AUX]

    def go_on(self, before: Saying) -> None:
        """Take the predicate of the part before where it only names things: "the lamp should be off, and the radio"."""
        if not (self.verbs or self.helpers or self.rest) and all(is_a(node, "group") for node in self.subject):
            self.verbs, self.helpers, self.rest = before.verbs, before.helpers, before.rest

    @property
    def complement(self) -> bool:
        """Return whether something follows its verb."""
        return any(isinstance(n, Tree) for n in self.rest)

    @property
    def bare(self) -> bool:
        """Return whether it has only an auxiliary: "the mug does not"."""
        return bool(self.helpers) and not (self.verbs or self.complement)

    @property
    def outstanding(self) -> bool:
        """Return whether it says what its subject still lacks: "has to be swept", "needs washing", "needs water"."""
        before = [t.text for t in self.helpers]
        due = not section("having").isdisjoint(before[:-1]) and before[-1] in section("infinitive_be")
        return (due or not section("needing").isdisjoint(before)) and about_things(self.subject)

    @property
    def denied(self) -> bool:
        """Return whether it says that something is not so, whatever the other parts say."""
        return any(helper.negated for helper in self.helpers)

    def asks(self) -> bool:
        """Return whether it demands a state: a duty, "belongs", "would like"; but not what somebody has done."""
        if self._perfect():
            return False
        words = [*self.verbs, *self.helpers]
        modal = any(t.text in section("modals") for t in words)
        wished = modal and any(t.stem in section("wishing") or t.text in section("wishful") for t in words)
        settled = section("belonging") | section("staying") | section("returning")
        placed = any(t.kind in (Kind.FINITE, Kind.V) and t.stem in settled for t in self.verbs)
        placed = placed or self._goes()
        return wished or placed or any(said() for said in (self._duty, self._wants, self._released, self._receives))

    def _duty(self) -> bool:
        """Return whether it says what has to be so; but not "we have guests", "the cat has a cold"."""
        words = [*self.verbs, *self.helpers]
        alone = len(words) == 1 and words[0].text in section("having")
        return any(t.text in section("duties") for t in words) and not (alone or self._somebody())

    def _receives(self) -> bool:
        """Return whether it says what things get: "both plants get some water"."""
        verbs = (v for v in self.verbs[-1:] if v.kind is Kind.FINITE and v.form != "ed")
        gets = any(verb.stem in section("receiving") for verb in verbs)
        return gets and about_things(self.subject) and bool(trees(self.rest, "group"))

    def _released(self) -> bool:
        """Return whether it says what may be done with its subject by now: "the lid can come off", "can be washed"."""
        free = any(t.text in section("asking") for t in self.helpers) and about_things(self.subject)
        last = self.verbs[-1] if self.verbs else None
        said = {t.text for node in self.rest for t in leaves(node)}
        done = self._helped("be") and (self._permitted(said) if last is None else last.kind is Kind.PARTICIPLE)
        moved = last is not None and last.stem in pairs("demand_verbs")
        told = not said.isdisjoint(section("with_words") | section("by_words"))  # "can be turned off with the switch"
        return free and (done or moved) and not (told or self.denied or self._somebody())

    def _permitted(self, said: Collection[str]) -> bool:
        """Return whether it says in which state its subject can be: "the lamp can be off now"."""
        can = any(t.text in section("permitting") for t in self.helpers)
        return can and not section("end_states").isdisjoint(said)

    def _goes(self) -> bool:
        """Return whether it says where things are to go or may stay: "is going on the shelf", "can wait there"."""
        goes = self.verbs[-1:]
        planned = [v for v in goes if v.kind is Kind.ING and v.stem in section("belonging")]
        allowed = [v for v in goes if v.stem in section("waiting") and self._helped("asking")]
        places = section("static") | section("arrivals")
        there = any(next(leaves(node)).text in places for node in trees(self.rest, "place"))
        return there and about_things(self.subject) and bool(planned or allowed) and not self._somebody()

    def _somebody(self) -> bool:
        """Return whether its subject is somebody who is not asked."""
        subject = {t.text.partition("'")[0] for node in self.subject for t in leaves(node)}
        return bool(subject) and subject <= section("tellers")

    def _perfect(self) -> bool:
        """Return whether it says what somebody or something has done: "the little ones have left their toys there"."""
        lasted = any(helper.text in section("lasting") for helper in self.helpers)  # "has been out all day"
        return lasted or (self._helped("having") and bool(self.verbs) and self.verbs[0].kind is Kind.PARTICIPLE)

    @property
    def talk(self) -> bool:
        """Return whether it only says that somebody says something: "my aunt said so"."""
        return bool(self.verbs) and all(verb.stem in section("talking") for verb in self.verbs)

    def _wants(self) -> bool:
        """Return whether somebody wants something: "Grandma wants the lamp on"."""
        wishing = section("wishing") - section("liking")
        return bool(self.verbs) and self.verbs[-1].kind is Kind.FINITE and self.verbs[-1].stem in wishing

    def clauses(self, attach: Attach) -> list[ClauseDraft]:
        """Return what it says."""
        if self._only_states():
            return self._states(attach)
        verbs = [] if self._is_left() else self.verbs
        done = self._deeds(verbs)
        if done and done[-1] is verbs[-1] and self._passive():
            return [self._done(verb, after, attach) for verb, after in zip_longest(done, done[1:])]
        owned = self._owns(verbs)
        if verbs and not owned:
            return [self._event(v, attach) for v in verbs if v.kind is not Kind.ING or len(verbs) == 1]
        return self._owned(attach) if owned else self._states(attach)

    def _deeds(self, verbs: Sequence[Token]) -> list[Token]:
        """Return the verbs that say what is done to the subject: "must be washed", "needs washing and drying"."""
        done = []
        for verb in verbs:
            before = [t.text for t in self.helpers if t.span.start < verb.span.start][-1:]
            needed = verb.kind is Kind.ING and not section("needing").isdisjoint(before)
            done += [verb] if needed or verb.kind is Kind.PARTICIPLE else []
        return done

    def _is_left(self) -> bool:
        """Return whether it says only where or how something is: "left lying on the table"."""
        loose = any(v.text in section("loosely") for v in self.verbs)
        return loose and bool(trees(self.rest, "state", "place"))

    def _owns(self, verbs: Sequence[Token]) -> bool:
        """Return whether a thing has, or should have, something: "the cup gets some milk"."""
        thing = about_things(self.subject)
        # "the cup gets some milk", "if the cup contains milk"
        received = bool(verbs) and thing and not sections_of(verbs[-1].stem).isdisjoint(("receiving", "holding"))
        needed = self._helped("needing") and thing  # "the cup needs some sugar"
        return bool(trees(self.rest, "group")) and (received or ((needed or self._helped("having")) and not verbs))

    def _only_states(self) -> bool:
        """Return whether its verb adds nothing to a state: "stays open", "you see a cup"."""
        last = self.verbs[-1].stem if self.verbs else ""
        if last in section("noticed") and trees(self.rest, "group"):
            self.subject = []  # what you see is there
            return True
        settled = section("becoming") | section("staying") | section("postures")  # "that is lying open"
        return last in settled and bool(trees(self.rest, "state"))

    def _helped(self, name: str) -> bool:
        """Return whether its last auxiliary is in a section of ``words.txt``."""
        return bool(self.helpers) and self.helpers[-1].text in section(name)

    def _passive(self) -> bool:
        """Return whether a participle says in what state its subject is, not what it has done."""
        return self._helped("be") or (not self._helped("having") and about_things(self.subject))

    def _states(self, attach: Attach) -> list[ClauseDraft]:
        """Return a clause for each state, and one for a place of its own: "empty and in the shed"."""
        places = trees(self.rest, "place")
        apart = [n for n in places if next(leaves(n)).form == ALSO]
        apart = apart if len(apart) == len(places) else []  # but "on in the hall and in the shed"
        if not (apart and trees(self.rest, "state") and about_things(self.subject)):
            return self._each_state(attach)
        both: list[list[Node]] = [[n for n in self.rest if n not in apart], [*apart]]
        return [draft for self.rest in both for draft in self._each_state(attach)]

    def _each_state(self, attach: Attach) -> list[ClauseDraft]:
        """Return a clause for each state: "should be shut, locked and dry"; but one for "open or shut"."""
        subject, rest, listed = self.subject, self.rest, trees([*self.rest, *self.subject], "state")[:1]
        words = [leaf for node in listed for leaf in node.children if isinstance(leaf, Leaf)]
        states = [leaf for leaf in words if leaf.source.kind is Kind.STATE]
        if len(states) < 2 or any(leaf.source.text in section("choices") for leaf in words):
            return [self._state(attach)]
        found = []
        for state in states:
            alone = Tree("state", [state])
            self.subject = [alone if node is listed[0] else node for node in subject]
            self.rest = [alone if node is listed[0] else node for node in rest]
            found.append(self._state(attach))
        return found

    def _state(self, attach: Attach) -> ClauseDraft:
        draft = empty_draft(BE, [self.part])
        named = about_things(self.subject)
        if not named and not about_things(self.rest) and trees([*self.subject, *self.rest], "state", "place"):
            self._take_it(draft)
        elif not named and about_things(self.rest):
            draft.verb.form = EXISTS
            self.subject = [n for n in self.subject if not is_a(n, "group")]
        attach(draft, self.subject, self.rest)
        if draft.result is None and draft.settings() and not draft.landmarks:
            draft.result = draft.settings()[-1]  # "until it is two thirds full"
        return draft

    def _take_it(self, draft: ClauseDraft) -> None:
        """Let a clause be about *it* where its subject is no thing: "once she is in there" may be about a dog."""
        if not self._plural():
            start = min(t.span.start for t in leaves(self.part))
            self.subject = [n for n in self.subject if not is_a(n, "group")]
            draft.direct.append(Phrase(first_of("singular_pronouns"), start, False, True))

    def _plural(self) -> bool:
        """Return whether its subject is a pronoun that may mean several things: "they"."""
        return any(t.text in section("plural_pronouns") for node in self.subject for t in leaves(node))

    def _done(self, verb: Token, after: Token | None, attach: Attach) -> ClauseDraft:
        """*The kettle is filled with water*: a state that a participle names; what follows belongs to the last one."""
        draft = empty_draft(BE, [self.part])
        if self.subject and not about_things(self.subject):
            self._take_it(draft)
        rest = [n for n in self.rest if after is None or next(leaves(n)).span.start < after.span.start]
        attach(draft, self.subject, rest)
        draft.result, draft.verb.participle = verb.text, verb.stem
        return draft

    def _event(self, verb: Token, attach: Attach) -> ClauseDraft:
        """*The water boils* is what *boil the water* brings about; *Ann knows chess* is that chess is known by Ann.

        Of *when you take it* only the verb counts.
        """
        draft = empty_draft(verb.stem, [self.part])
        draft.spans += verb.parts
        named = about_things(self.subject)
        about = self.subject if named else [n for n in self.subject if not is_a(n, "group")]
        owned = named and bool(trees(self.rest, "group"))
        subject = named_in(self.subject) if owned and verb.stem not in section("wishing") else []
        acting = [phrase for phrase in subject if not phrase.pronoun]
        attach(draft, [] if owned else about, self.rest)
        draft.landmarks += acting
        draft.relations += [Relation(AGENT, draft.direct[-1].name if draft.direct else None, p.name) for p in acting]
        if acting:
            who = empty_draft(verb.stem, [self.part])
            attach(who, self.subject, ())  # "everyone in the hall except Ann"
            draft.relations += who.relations
            draft.landmarks += who.landmarks
        return draft

    def _owned(self, attach: Attach) -> list[ClauseDraft]:
        """*The cup has milk in it*: a state with a relation, for each of several owners."""
        draft = empty_draft(BE, [self.part])
        if not (about_things(self.subject) or self._plural()):
            attach(draft, self.rest, ())
            return [draft]
        # "every cup gets some milk, except the one that is full"
        attach(draft, [*self.subject, *(n for n in self.rest if is_a(n, "exception", "relative"))], ())
        draft.stated += draft.relations  # "every book on the desk should get a label"
        contents = named_in(self.rest)
        draft.landmarks += contents
        owners: list[str | None] = [p.name for p in draft.direct] or [None]
        draft.relations += [Relation(WITH, owner, p.name) for owner in owners for p in contents]
        draft.relations += [Relation(OF, p.name, part.name) for p in contents for part in p.of]
        return draft.each() if len(owners) > 1 else [draft]


def sayings_of(node: Tree[Leaf]) -> list[Saying]:
    """Return the parts of a subordinate clause or statement."""
    found = [Saying(part) for part in trees(node.children, "part")]
    for before, saying in pairwise(found):
        saying.go_on(before)
    return found


def empty_draft(stem: str, nodes: Sequence[Node]) -> ClauseDraft:
    """Return a clause without arguments that stands where some nodes stand."""
    places = spans(nodes) or [Span(0, 0)]
    return ClauseDraft(Token(Kind.V, stem, places[0], stem=stem, form="base"), spans=places)


def demand(draft: ClauseDraft, *, denied: bool) -> None:
    """Turn a clause that demands a state into one that brings it about."""
    verb, none = draft.verb, draft.none()
    _each_of_any(draft)
    verb.stem = pairs("demand_verbs").get(verb.stem, verb.stem)
    if verb.stem in section("wishing") or draft.result in section("welcome"):
        _demand_wish(draft, denied=denied)
    elif verb.stem in section("staying"):
        verb.stem, draft.mood = (BE, None) if none or denied else (first_of("leaving"), Mood.KEEP)
    elif verb.stem == BE:
        _demand_state(draft, denied=denied, none=none)
    elif verb.stem in section("going"):
        whither = any(r.relation in section("bringing") for r in draft.relations)
        if draft.result in pairs("state_verbs") and not denied:  # "has to go off"
            verb.stem, draft.result = pairs("state_verbs")[draft.result or ""], None
        else:
            verb.stem = BE if none else BRING if whither else PUT
    elif denied:
        draft.mood = Mood.AVOID
    give_back(draft)


def _demand_wish(draft: ClauseDraft, *, denied: bool) -> None:
    """Demand what somebody wants: "grandma wants the window shut", "a tea would be nice"."""
    if draft.result and draft.result not in section("welcome"):
        draft.verb.stem = BE
        _demand_state(draft, denied=denied, none=False)
    else:
        draft.verb.stem, draft.verb.form, draft.result = HAVE, IMPLIED, None


def _each_of_any(draft: ClauseDraft) -> None:
    """Demand of each one what is demanded of any: "any bottle that is empty belongs in the bin"."""
    for phrase in draft.direct:
        if phrase.lead and phrase.lead[0] in section("any_words") and not any(map(is_number, phrase.lead)):
            phrase.lead = (first_of("all_words"), *phrase.lead[1:])


def _demand_state(draft: ClauseDraft, *, denied: bool, none: bool) -> None:
    verb, result = draft.verb, draft.result or ""
    if verb.participle:
        verb.stem, draft.result = verb.participle, None  # "should be washed"
        give_back(draft)
        draft.mood = Mood.AVOID if denied or none else Mood.KEEP if verb.stem in section("leaving") else None
    elif denied and not none:
        for phrase in draft.direct:
            phrase.lead = (first_of("none_words"), *phrase.lead)
    elif none or verb.form == EXISTS:
        return
    else:
        _demand_plainly(draft, result)


def _demand_plainly(draft: ClauseDraft, result: str) -> None:
    """Give a verb to a demanded state: "the floor should be clean", "the cup should be on the shelf"."""
    verb, said = draft.verb, {r.relation for r in draft.relations}
    if result in pairs("state_verbs") or result in section("verbs"):
        verb.stem, draft.result = pairs("state_verbs").get(result, result), None
    elif draft.settings():
        verb.stem, draft.result = SET, None
    elif not result and WITH not in said and not said.isdisjoint({WHERE, *section("static"), *section("arrivals")}):
        verb.stem = PUT


def give_back(draft: ClauseDraft) -> None:
    """Read "put it in its usual place" and "return it" as "put it back"."""
    stem = draft.verb.stem
    own = {p.name for p in draft.landmarks if p.name.rpartition("_")[2] in section("own_places") and _is_own(p)}
    returned = stem in section("returning") and not draft.relations
    moved = not section("moving").isdisjoint((stem, stem.partition("_")[0])) or stem in section("returning")
    if draft.direct and (returned or (own and moved and not draft.conditions)):
        draft.verb.stem = first_of("returning")
        draft.landmarks = [p for p in draft.landmarks if p.name not in own]
        draft.relations = [r for r in draft.relations if r.target not in own]


def _is_own(phrase: Phrase) -> bool:
    """Return whether a place is the one where a thing was: "its place", "the original position"."""
    return not section("own_words").isdisjoint((*phrase.lead, *phrase.name.split("_")[:-1]))


def name_verb(draft: ClauseDraft) -> None:
    """Give a verb to what is only named with a state, a setting or a place: "TV on", "sound low", "cup to the sink"."""
    verb = draft.verb
    if draft.result in pairs("state_verbs"):
        verb.stem, draft.result, verb.form = pairs("state_verbs")[draft.result or ""], None, "base"
        draft.elliptic = True
    elif any(r.relation in section("bringing") for r in draft.relations):
        verb.stem = BRING
    elif draft.result is not None:
        verb.stem = BE
    elif draft.settings():
        verb.stem = SET


def described(draft: ClauseDraft, ahead: Sequence[Phrase], node: Tree[Leaf]) -> Phrase:
    """Return the noun that a relative clause is about: the last, or the one of which the last says where it is.

    It is that one where only it agrees with the verb ("the cups on the table that are clean"), and where all of them
    are meant ("everything on the floor that is empty") unless the place is where they are to be put, and no other is.
    """
    last = max(ahead, key=lambda phrase: phrase.place)
    static = [r for r in draft.relations if r.relation in section("static")]
    placed = {r.source for r in static if r.target == last.name}
    head = next((phrase for phrase in reversed(ahead) if phrase.name in placed), None)
    if head is None or last.plural:
        return last
    plural = any(t.text in section("plural_forms") for t in leaves(node) if t.kind is Kind.AUX)
    return head if (head.plural if plural else _is_whole(head, last, draft, static)) else last


def _is_whole(head: Phrase, last: Phrase, draft: ClauseDraft, static: Sequence[Relation]) -> bool:
    """Return whether all of a kind are meant, and their place is not where they are to be put."""
    elsewhere = any(r.source in (head.name, last.name) and r.target != last.name for r in static)
    placing = draft.verb.stem in section("placing") and not elsewhere
    return head.said().quantifier is Quantifier.ALL and not head.plural and not placing
