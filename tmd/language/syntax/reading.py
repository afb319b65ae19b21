"""From the tree of a text to its clauses, before pronouns are resolved."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import islice, takewhile, zip_longest

from lark import Tree

from tmd.language.clause import (
    BE,
    EXCEPT,
    HAVE,
    NEGATED,
    PERSONS,
    TO,
    WHERE,
    WITH,
    Clause,
    Condition,
    Mood,
    Quantifier,
    Relation,
    Span,
    hull,
)
from tmd.language.lexicon.lexicon import first_of, pairs, section
from tmd.language.lexicon.nouns import similarity
from tmd.language.syntax.brackets import ALSO, DUTY, REASON, STATEMENT
from tmd.language.syntax.drafts import Attachment, ClauseDraft, as_one, state_of
from tmd.language.syntax.grammar import Leaf, Node, is_a, leaves, spans, trees
from tmd.language.syntax.noun_phrases import Phrase, about_things, is_number, named_in, phrases_of
from tmd.language.syntax.sayings import Saying, demand, described, empty_draft, give_back, name_verb, sayings_of
from tmd.language.syntax.tokens import EXISTS, IMPLIED, Kind, Token

_ASIDES = ("demand", "statement")
_DENIALS = ("denial", "manner")
_LATER = "later"
"""The order of a clause behind "before"."""
_LIKE = 0.6
"""Least Wu-Palmer similarity of a place and of what is named instead of it; a mug and a cup have 0.78."""


@dataclass(slots=True)
class TextReading:
    """The clauses of a text before pronouns are resolved.

    Attributes:
        text: The text.
        drafts: What is to be done, in order.
        forbidden: What must not be done, each with the number of drafts before it.
        statements: What statements mention, each with the number of drafts before it.
        skipped: What asks for nothing, as tokens that carry the reason.
        alone: The text has one unit.
        polite: The text asks politely.
        conditioned: The last condition.
        told: The relations of the last statement.
    """

    text: str
    drafts: list[ClauseDraft] = field(default_factory=list)
    forbidden: list[tuple[int, ClauseDraft]] = field(default_factory=list)
    statements: list[tuple[int, ClauseDraft]] = field(default_factory=list)
    skipped: list[Token] = field(default_factory=list)
    alone: bool = False
    polite: bool = False
    conditioned: Condition | None = None
    told: list[Relation] = field(default_factory=list)

    def read(self, tree: Tree[Leaf]) -> TextReading:
        """Read the tree of a text."""
        self.alone = len(trees(tree.children, "unit")) == 1
        self.polite = not section("polite").isdisjoint(re.findall(r"[a-z]+", self.text.lower()))
        goes_on = False
        places: list[Node] = []
        topic: list[Tree[Leaf]] = []
        known = before = (0, 0)
        for number, (unit, following) in enumerate(zip_longest(tree.children, tree.children[1:])):
            if isinstance(unit, Leaf):
                goes_on = unit.source.form == ALSO
                continue
            before, known = known, (len(self.statements), len(self.drafts))
            actions = trees(unit.children, "clause", "letting")
            front = places + [n for n in unit.children if n not in actions]
            sign = following.source.text if isinstance(following, Leaf) else ""
            places = [] if actions else _places_ahead(front, sign)
            if _is_title(unit, sign, tree.children[number + 2 : number + 3]):
                self._mention(front)
            elif goes_on and self._states_too(unit, before):
                pass  # "the lamp is on, and the radio too"
            elif not actions and self._is_topic(front) and _is_taken_up(tree.children[number + 1 :]):
                topic += trees(front, "group")
            elif not places:
                self._unit(actions, _supplied(unit, front, topic), goes_on=goes_on)
                topic = topic if sign == "," else []
        self._carry()
        return self

    def _states_too(self, unit: Tree[Leaf], before: tuple[int, int]) -> bool:
        """State what "too" adds to a statement, if one stands before; ``before`` counts what was read ahead of that."""
        statements, drafts = before
        named = trees(unit.children, "group")
        if len(named) != len(unit.children) or len(self.statements) == statements or len(self.drafts) > drafts:
            return False
        last = self.statements[-1][1]
        if any(phrase.pronoun for phrase in last.direct):
            return False  # "shut the fridge, it is getting warm, and the cupboard too"
        too = replace(last, direct=named_in(named), relations=[], landmarks=[], verb=replace(last.verb))
        too.take_places(last)
        self.statements.append((len(self.drafts), too))
        span = hull(spans(named))
        self.skipped.append(Token(Kind.SKIP, self.text[slice(*span)], span, note=STATEMENT))
        return True

    def _unit(self, actions: Sequence[Tree[Leaf]], front: list[Node], *, goes_on: bool) -> None:
        for index, action in enumerate(actions):
            self._clause(action, [] if index else front)
        if not actions and not (goes_on and self._gapped(front)):
            self._verbless(front)

    # clauses with a verb

    def _clause(self, node: Tree[Leaf], front: list[Node]) -> None:
        """Read a clause; verbs that share their object become a clause each."""
        verbs = [t for t in leaves(trees(node.children, "verbs")[0]) if t.kind is Kind.V]
        drafts = [ClauseDraft(verb, spans=[verb.span, *verb.parts]) for verb in verbs]
        first, last = drafts[0], drafts[-1]
        arguments = [n for n in node.children if not is_a(n, "verbs") and (isinstance(n, Tree) or _is_fold(n))]
        last.spans.extend(spans(arguments))
        for aside in trees(front, *_ASIDES):
            self._aside(aside)
        before = self.drafts[-1] if self.drafts else None
        self.drafts.extend(drafts)
        self._join(first, last, self._taken_up([n for n in front if not is_a(n, *_ASIDES)], arguments, last), arguments)
        for draft in drafts[:-1]:
            draft.direct = last.direct
        self._settle(first, last, before, arguments)
        if last in self.drafts[-1:]:
            self.drafts[-1:] = _each_state(last, arguments)
        self._bring_forward(drafts, before)

    def _bring_forward(self, drafts: Sequence[ClauseDraft], before: ClauseDraft | None) -> None:
        """Put clauses with "first" in front of the sentence before: "put the cup in the crate, but wash it first"."""
        if before is None or not drafts[0].verb.early:
            return
        others = [draft for draft in self.drafts if draft not in drafts]
        at = next(i for i, draft in enumerate(others) if draft.verb.sentence == before.verb.sentence)
        for draft in drafts:
            draft.host = draft.host or before
        self.drafts = [*others[:at], *drafts, *others[at:]]

    def _join(self, first: ClauseDraft, last: ClauseDraft, front: list[Node], arguments: list[Node]) -> None:
        """Attach what stands before the first verb, and behind the last."""
        first.spans.extend(spans([n for n in front if not is_a(n, "group")]))
        places = [n for n in front if is_a(n, "place", "exception")]
        described = [n for n in front if is_a(n, "relative")]
        self._modify(first, [n for n in front if n not in (*places, *described)], fronted=True)
        self._attach(last, arguments, front=places)
        self._modify(last, described)

    @staticmethod
    def _taken_up(front: list[Node], arguments: list[Node], draft: ClauseDraft) -> list[Node]:
        """Put what is named first in the place of the pronoun that takes it up: "the drawers, open them"."""
        topic = [n for n in front if is_a(n, "group", "place", "relative")]
        groups = trees(arguments, "group")
        if not topic or not is_a(topic[0], "group"):
            return front
        if groups and _is_pronoun(groups[0]):
            place = next(i for i, n in enumerate(arguments) if n is groups[0])
            arguments[place : place + 1] = topic
        elif not groups and draft.verb.stem not in section("intransitive"):
            arguments[:0] = topic  # "second drawer, open"
        else:
            return front
        draft.spans.extend(spans(topic))
        return [n for n in front if n not in topic]

    def _settle(
        self, first: ClauseDraft, last: ClauseDraft, before: ClauseDraft | None, arguments: Sequence[Node]
    ) -> None:
        """Read verbs that mean less, or more, than themselves: wishes, "swap", "do the same", "use neither"."""
        if first.verb.stem in section("wishing"):
            first.verb.stem, first.verb.form = HAVE, IMPLIED
            first.verb.told = first.verb.told or _is_vague(last)
        if self.forbidden and not (last.direct or last.landmarks) and trees(arguments, "denial"):
            self.drafts.remove(last)  # "use neither the saw nor the drill"
            self.forbidden[-1][1].spans.extend(last.spans)
        if last.verb.stem in section("mutual_verbs") and len(last.direct) == 2 and not last.relations:
            other = last.direct.pop()
            last.landmarks.append(other)
            last.relations.append(Relation(WITH, last.direct[0].name, other.name))
        if before is not None and last.verb.stem in section("pro_verbs"):
            _repeat(last, before)
        if last.verb.stem in section("light_verbs"):
            at = self.drafts.index(last)
            self.drafts[at : at + 1] = _treatments(last)
        give_back(last)

    def _attach(
        self,
        draft: ClauseDraft,
        arguments: Sequence[Node],
        predicate: Sequence[Node] = (),
        *,
        front: Sequence[Node] = (),
    ) -> None:
        """Attach arguments from left to right, then the predicate, then the arguments in front of the verb."""
        state = Attachment(draft)
        state.add(arguments)
        if predicate and draft.result is not None and state.host:
            state.host[-1].attributes.append(draft.result)  # "nothing wet may stay there"
            draft.result = None
        state.host = []  # what is said of it belongs to what the verb acts on
        state.add(predicate)
        state.add_front(front)
        state.flush(draft.direct)
        self._modify(draft, [*arguments, *predicate])

    def _modify(self, draft: ClauseDraft, nodes: Sequence[Node], *, fronted: bool = False) -> None:
        """Add durations, conditions, purposes, relative clauses and prohibitions to a clause."""
        draft.folds += [n.source for n in nodes if isinstance(n, Leaf) and _is_fold(n)]
        for node in trees(nodes, "condition", "purpose", "relative", *_DENIALS):
            if node.data == "relative":
                self._relative(draft, node)
            elif node.data in _DENIALS:
                self._forbid(draft, node)
            elif next(leaves(node)).text in section("because"):
                self._explained(draft, node)
            elif node.data == "purpose" or not (self._ordered(draft, node) or _only_when(node)):
                self._add_condition(draft, node)
                draft.fronted = draft.fronted or (fronted and node.data == "condition")

    def _explained(self, draft: ClauseDraft, node: Tree[Leaf]) -> None:
        """Set a reason aside; pronouns may mean what it mentions."""
        before = self._number(draft, next(leaves(node)))
        for part in trees(node.children, "part"):
            self._stated(part, Saying(part).clauses(self._attach), before, REASON)

    def _said(self, node: Tree[Leaf]) -> list[ClauseDraft]:
        """Return the clauses of the parts of a subordinate clause."""
        found, mixed = [], _mixed(node)
        for saying in sayings_of(node):
            drafts = saying.clauses(self._attach)
            for draft in drafts if mixed and saying.denied else ():
                draft.deny()
            found += drafts
        return found

    # what is subordinate

    def _ordered(self, draft: ClauseDraft, node: Tree[Leaf]) -> bool:
        """Read "after labelling it" and "before putting it away" as instructions, in their order."""
        opener, parts = next(leaves(node)).text, trees(node.children, "part")
        places = [i for i, d in enumerate(self.drafts) if d is draft]  # a clause of a condition is not a step
        awaited = opener in section("awaiting") and not places
        known = awaited or (opener in pairs("order_words") and places)
        if not (known and parts and all(_is_deed(part, done=awaited) for part in parts)):
            return False
        events = self._said(node)
        if awaited:
            draft.awaits += events
            return True
        if not section("no_steps").isdisjoint(event.verb.stem for event in events):
            return False
        at = places[0] + (pairs("order_words")[opener] == _LATER)
        for event in events:
            event.host, event.verb.sentence = draft, draft.verb.sentence
        self.drafts[at:at] = events
        return True

    def _add_condition(self, draft: ClauseDraft, node: Tree[Leaf]) -> None:
        """Add a condition or a purpose; *if it isn't* is "otherwise" behind the condition that something is so."""
        if node.data == "condition" and self._of_each(draft, node):
            return
        condition, before = self._condition(node), self.conditioned
        said = condition.clauses
        if before is not None and node.data == "condition" and said and all(map(_says_nothing, said)):
            if denies(before) != denies(condition):
                draft.verb.otherwise, draft.spans = True, [*draft.spans, *spans([node])]
                return
            condition = replace(condition, clauses=before.clauses)
        self.conditioned = condition if node.data == "condition" else before
        draft.conditions += _each_denied(condition) if condition.negated and condition.clauses else [condition]

    def _of_each(self, draft: ClauseDraft, node: Tree[Leaf]) -> bool:
        """Read "water the plants if they are dry" as to water those that are dry, if there are any."""
        opener, said = next(leaves(node)), self._said(node)
        things = [p for p in draft.direct if p.place < opener.span.start and not p.pronoun]
        several = len(things) == 1 and (things[0].plural or things[0].said().quantifier is Quantifier.ALL)
        if not several or opener.text not in section("of_each") or not all(map(_is_of_them, said)):
            return False
        before = len(draft.relations)
        for state in said:
            self._describe(draft, things[0], opener, state)
        some = empty_draft(BE, [node])
        some.verb.form, some.relations = EXISTS, draft.relations[before:]
        some.direct = [replace(things[0], plural=False, lead=(first_of("indefinite"),))]
        some.further = dict(draft.further)
        text = " ".join(self.text[slice(*hull(spans([node])))].split()).lower()
        draft.conditions.append(Condition(opener.text, (replace(some.clause(self.text), text=text),), False, text))
        return True

    def _condition(self, node: Tree[Leaf]) -> Condition:
        """Read a condition or a purpose."""
        opener, purpose = next(leaves(node)), node.data == "purpose"
        text = " ".join(self.text[slice(*hull(spans([node])))].split()).lower()
        drafts = self._said(node)
        nothing = any(p.name in pairs("affirmed") for draft in drafts for p in (*draft.direct, *draft.landmarks))
        negated = _denied_whole(node) or nothing
        self._say_in_condition(node, drafts, negated=negated)
        if not purpose and all(Saying(part).outstanding for part in trees(node.children, "part")):
            negated = not negated  # "if it needs washing" is if it is not washed
        clauses = tuple(replace(draft.clause(self.text), text=text) for draft in drafts)
        aimed = purpose and opener.text not in section("reasons")  # "so that it dries" only says what for
        return Condition(TO if aimed else opener.text, clauses, negated, text)

    @staticmethod
    def _say_in_condition(node: Tree[Leaf], drafts: Sequence[ClauseDraft], *, negated: bool) -> None:
        """Complete the clauses of a condition or purpose: its negation is said once, and what happens is *it*."""
        for draft in drafts if negated else ():
            # "no" and "nothing" are in the negation of the condition
            draft.affirm(each=any(t.text in section("negations") for t in leaves(node) if t.kind is Kind.CC))
        for draft in drafts if node.data == "purpose" else ():
            if not draft.direct and draft.verb.stem in section("happening"):
                draft.direct.append(Phrase(first_of("singular_pronouns"), draft.verb.span.start, False, True))

    def _relative(self, draft: ClauseDraft, node: Tree[Leaf]) -> None:
        """Add the content of a relative clause to its noun."""
        opener = next(leaves(node))
        ahead = [p for p in draft.mentions() if p.place < opener.span.start]
        if not ahead:
            return
        noun = described(draft, ahead, node)
        for said in self._said(node):
            self._describe(draft, noun, opener, said)

    @staticmethod
    def _describe(draft: ClauseDraft, noun: Phrase, opener: Token, said: ClauseDraft) -> None:
        draft.relative |= said.verb.stem == BE
        named = [p for p in said.direct if not p.pronoun]
        relation = WHERE if opener.text in section("where_words") else said.owning()
        denied = NEGATED * (opener.negated and relation not in (WITH, WHERE))  # "the mug that Ann is not using"
        if named and relation:
            targets = [(denied + relation, p) for p in named]
        else:
            targets = said.placed(NEGATED * opener.negated)
            if said.verb.stem == BE and said.result and not named:
                noun.attributes.append(NEGATED * opener.negated + said.result)
            elif relation != WHERE and (named or not targets):
                noun.attributes += _telling(said, opener)
        for relation, phrase in targets:
            draft.relations.append(Relation(relation, noun.name, phrase.name))
            draft.stated.append(draft.relations[-1])
            draft.further[phrase.name] = phrase.said()

    def _forbid(self, draft: ClauseDraft | None, node: Tree[Leaf]) -> None:
        """Record what a denial forbids: its own clause, or the verb before it with other arguments."""
        before = self._number(draft, next(leaves(node)))
        for part in trees(node.children, "part"):
            saying = Saying(part)
            deed = any(t.kind is Kind.V for t in leaves(part))
            own = trees(part.children, "predicate") and (deed or draft is None or saying.complement)
            if not own and draft is not None and self._excepted(draft, part):
                continue
            found = saying.clauses(self._attach) if own else [self._contrasted(draft, part.children)] if draft else []
            for item in filter(lambda item: not self._awaited(item), found):
                item.mood, item.spans = Mood.AVOID, spans([node])
                item.verb.form = IMPLIED if not deed and draft is not None else item.verb.form
                self.forbidden.append((before, item))

    def _awaited(self, draft: ClauseDraft) -> bool:
        """Read "don't close it until you have filled it" as to fill it and then to close it."""
        self.drafts += [*draft.awaits, draft] if draft.awaits else []
        for event in draft.awaits:
            event.host = draft
        return bool(draft.awaits)

    def _excepted(self, draft: ClauseDraft, part: Tree[Leaf]) -> bool:
        """Read "the cups, but not the one on the shelf" as an exception, and "the red cups, but not the cup there"."""
        several = [p for p in draft.direct if p.plural or p.said().quantifier is Quantifier.ALL]
        denied = _alike(several, named_in(part.children))
        if not (several and denied):
            return False
        draft.relations += [Relation(EXCEPT, host.name, p.name) for host in several for p in denied]
        draft.landmarks += denied
        for place in trees(part.children, "place"):
            targets = named_in(place.children)
            draft.relations += [Relation(next(leaves(place)).text, p.name, t.name) for p in denied for t in targets]
            draft.landmarks += targets
        draft.spans += spans([part])
        return True

    def _number(self, draft: ClauseDraft | None, opener: Token) -> int:
        """Return how many clauses are done before a denial: those before its own, where it stands in front."""
        place = next((i for i, d in enumerate(self.drafts) if d is draft), len(self.drafts))
        return place if draft is None or opener.span < draft.verb.span else len(self.drafts)

    def _contrasted(self, draft: ClauseDraft, nodes: Sequence[Node]) -> ClauseDraft:
        """Return a clause with what stands in place of its objects, or of its place: "…, not the mug"."""
        copy = empty_draft(draft.verb.stem, nodes)
        if not about_things(nodes):
            copy.direct = list(draft.direct)
        where = self._place_of_kind(draft, named_in(nodes))
        if where is not None:  # "milk in the cup, not the mug": not in the mug
            self._attach(copy, nodes)
            copy.relations = [*(where._replace(target=p.name) for p in copy.direct), *copy.relations]
            copy.direct, copy.landmarks = list(draft.direct), [*copy.direct, *copy.landmarks]
            return copy
        self._attach(copy, nodes)
        placing = draft.verb.stem.partition("_")[0] in section("placing") | section("moving")
        ones = placing and all(p.name in section("one_words") for p in copy.direct)
        demanded = draft.verb.stem == BE and about_things(nodes)  # "…, the mug on the shelf shouldn't"
        copy.result = copy.result or (draft.result if demanded else None)
        if copy.result is None and (ones or demanded or not trees(nodes, "place")):
            copy.take_places(draft)  # "…, but not the one on the shelf"
        if any(p.said().other for p in copy.direct):
            copy.relations = copy.relations[-1:]  # what tells which one it is, is not said of the other one
        return copy

    @staticmethod
    def _place_of_kind(draft: ClauseDraft, named: Sequence[Phrase]) -> Relation | None:
        """Return where something goes, if some other things are rather such a place than such a thing."""
        last = draft.relations[-1] if draft.relations and draft.direct and named else None
        if last is None or last.source is None or last.relation not in section("static") | section("arrivals"):
            return None
        thing, place, other = (name.rpartition("_")[2] for name in (last.source, last.target, named[0].name))
        if other in section("one_words"):  # "in a bowl, not the one with the chips"
            leads = [set(p.lead) for p in draft.landmarks if p.name == last.target]
            return last if any(lead & section("indefinite") for lead in leads) else None
        return last if similarity(other, place) > max(similarity(other, thing), _LIKE) else None

    # requests other than imperatives

    def _verbless(self, nodes: list[Node]) -> None:
        """Read a unit without a verb: prohibitions, demands, statements, and what is only named."""
        rest = [n for n in nodes if not is_a(n, *_ASIDES, *_DENIALS)]
        last = self.drafts[-1] if self.drafts else None
        if _is_denied_next(rest, nodes):
            self._named(rest)  # "the urn in the workshop, but don't wrap it"
            rest = []
        for node in trees(nodes, *_ASIDES, *_DENIALS):
            if node.data in _ASIDES:
                self._aside(node, trees(nodes, "condition"))
            else:
                self._forbid(self.drafts[-1] if self.drafts else None, node)
        if not trees(nodes, *_ASIDES):
            self._left_over(nodes, rest, last)

    def _left_over(self, nodes: Sequence[Node], rest: list[Node], last: ClauseDraft | None) -> None:
        """Read what stands in a unit without a verb beside its prohibitions: another place, or things."""
        if trees(nodes, "denial") and self.forbidden and trees(rest, "group", "place"):
            denied = self.forbidden[-1][1]  # "don't put it on the stove but on the shelf"
            draft = self._contrasted(denied, rest)
            draft.mood = None
            self.drafts.append(draft)
        elif last is not None and last.direct and rest and all(is_a(n, "place") for n in rest):
            self._attach(last, rest)  # "warm up some milk. In the blue mug."
            last.spans += spans(rest)
        elif about_things(rest):
            self._named(rest)
        elif rest and last is not None:
            self._modify(last, rest)
            last.spans += spans(trees(rest, "condition"))

    def _aside(self, node: Tree[Leaf], conditions: Sequence[Node] = ()) -> None:
        """Read a statement; one that requires a state is a demand."""
        opener = next(leaves(node))
        asked = node.data == "demand" or opener.form == DUTY
        for saying in sayings_of(node):
            asked = asked or (saying.asks() and not opener.note)
            if opener.negated and self.drafts and saying.bare:
                self._forbid(self.drafts[-1], node)  # "the cup goes there, the mug does not"
                return
            drafts = saying.clauses(self._attach)
            allowed = any(t.text in section("modals") for t in saying.helpers)
            asked = asked or (allowed and any(draft.none() for draft in drafts))  # "nothing may be touched"
            if asked and not saying.talk:
                self._demand(node, drafts, conditions, denied=_is_denied(node, saying))
            else:
                self._stated(saying.part, drafts, len(self.drafts), opener.note or STATEMENT)

    def _suits(self, said: ClauseDraft) -> bool:
        """Return whether a statement allows a vessel, "bring me some water. The blue glass is fine", and add that."""
        last = self.drafts[-1] if self.drafts else None
        fine = said.verb.stem == BE and said.result in section("suiting") and len(said.direct) == 1
        if last is None or not (fine and last.direct) or not all(p.name in PERSONS for p in last.landmarks):
            return False
        place, heads = said.direct[0], {p.name.rpartition("_")[2] for p in last.direct}
        head = place.name.rpartition("_")[2]
        if head in heads or head not in section("containers"):
            return False  # "bring me a mug. The blue mug is fine.", "water the fern. The ivy is fine."
        last.landmarks += [place, *said.landmarks]
        last.relations += [Relation(first_of("insides"), last.direct[-1].name, place.name), *said.relations]
        last.stated += said.relations
        return True

    def _demand(
        self, node: Tree[Leaf], drafts: Sequence[ClauseDraft], conditions: Sequence[Node], *, denied: bool
    ) -> None:
        """Ask for the states that a statement demands."""
        for draft in drafts:
            self._take_up(draft)
            nobody = any(t.text in section("nobodies") for t in leaves(node) if t.kind is not Kind.NEG)
            demand(draft, denied=denied or nobody)
            draft.verb.otherwise = any(t.otherwise for t in leaves(node))
            draft.spans += spans([node])
            self._demanded(draft, conditions)

    def _take_up(self, draft: ClauseDraft) -> None:
        """Give "it should be" the state, or the place, that a statement before speaks of."""
        said = self.statements[-1][1] if self.statements else None
        named = draft.result or draft.landmarks or not all(p.pronoun for p in draft.direct)
        if said is None or named or not draft.verb.stem == said.verb.stem == BE:
            return
        draft.result, draft.verb.participle = said.result, said.verb.participle
        draft.landmarks = list(said.landmarks)
        subjects, pronouns = {p.name for p in said.direct}, [p.name for p in draft.direct]
        moved = [r for r in self.told if r.source in subjects]
        draft.relations += [r._replace(source=name) for r in moved for name in pronouns]

    def _stated(self, part: Tree[Leaf], drafts: Sequence[ClauseDraft], before: int, note: str) -> None:
        """Set a statement aside; pronouns may mean what it mentions."""
        if len(drafts) == 1 and self._suits(drafts[0]):
            self.drafts[-1].spans += spans([part])
            return
        self.told = [relation for draft in drafts for relation in draft.relations]
        if any(t.kind is Kind.NEG or t.text in section("not_forms") for t in leaves(part)):
            for draft in drafts:  # "it has not been in the oven yet" does not say where it is
                draft.relations.clear()
        self.statements += [(before, draft) for draft in drafts]
        span = hull(spans([part]))
        self.skipped.append(Token(Kind.SKIP, self.text[slice(*span)], span, note=note))

    def _demanded(self, draft: ClauseDraft, conditions: Sequence[Node]) -> None:
        parts = _denied_apart(draft)
        if len(parts) > 1:
            for part in parts:
                self._demanded(part, conditions)
            return
        empty = not draft.landmarks and draft.result is None
        vague = draft.verb.stem == HAVE and all(p.pronoun for p in draft.direct)
        if empty and (draft.verb.stem == BE or vague):
            return
        if draft.mood is Mood.AVOID:
            self.forbidden.append((len(self.drafts), draft))
        else:
            self.drafts.append(draft)
        self._modify(draft, conditions, fronted=True)
        draft.spans += spans(conditions)

    def _named(self, nodes: list[Node]) -> None:
        """Read "TV on", "lid on the pot", "two scoops of ice cream": the text leaves the verb out."""
        before = self.drafts[-1] if self.drafts else None
        if before is not None and before.elliptic and all(is_a(n, "group") for n in nodes):
            before.add(named_in(nodes), spans(nodes))
        elif before is not None and self._is_topic(nodes) and _takes_up(before, nodes):
            before.spans += spans(nodes)
        elif self._orders(nodes):
            start = next(leaves(nodes[0])).span.start
            verb = Token(Kind.V, HAVE, Span(start, start), stem=HAVE, form=IMPLIED)
            draft = ClauseDraft(verb, spans=spans(nodes))
            self._attach(draft, nodes)
            drafts = _each_state(draft, nodes)
            for named in drafts:
                name_verb(named)
            if draft.none() and drafts[-1].verb.stem == HAVE:
                draft.mood = Mood.AVOID  # "no sugar, please"
                self.forbidden.append((len(self.drafts), draft))
            else:
                self.drafts += drafts
        else:  # "Socks! Put both of them away."
            self._mention(nodes)

    def _mention(self, nodes: Sequence[Node]) -> None:
        """State what is only named, so that pronouns may mean it."""
        self.statements.append((len(self.drafts), mention := empty_draft(BE, nodes)))
        mention.direct = named_in(nodes)

    def _gapped(self, nodes: list[Node]) -> bool:
        """Read "then the mug" and "the mug too" with the verb, and the place, of the clause before."""
        if not self.drafts or not about_things(nodes) or trees(nodes, *_ASIDES, *_DENIALS):
            return False
        before = self.drafts[-1]
        if before.verb.form == "ed":
            return False  # "eggs boiled in the pot, then milk in the cup"
        if before.verb.form == IMPLIED and before.result is None and trees(nodes, "state"):
            return False  # "eggs in the fridge, then fridge shut"
        draft = self._contrasted(before, nodes)
        draft.verb.sentence, draft.verb.form = before.verb.sentence, before.verb.form
        self.drafts.append(draft)
        return True

    def _is_topic(self, nodes: Sequence[Node]) -> bool:
        """Return whether a unit only names what those behind it are about: "the bag! close it", "kettle: fill"."""
        last = self.drafts[-1] if self.drafts else None
        return _is_named(nodes) and not (_is_counted(nodes) or (last is not None and last.elliptic))

    def _orders(self, nodes: Sequence[Node]) -> bool:
        """Return whether what is only named is asked for: with a state or a place, a number, politely, or by itself."""
        if any(is_a(n, "state", "place", "exception") or isinstance(n, Leaf) for n in nodes):
            return True
        return _is_counted(nodes) or self.polite or (self.alone and sum(1 for n in nodes for _ in leaves(n)) > 1)

    def _carry(self) -> None:
        """A condition in front of a sentence holds for the whole of it."""
        before: ClauseDraft | None = None
        for draft in self.drafts:
            same = before is not None and before.verb.sentence == draft.verb.sentence and before.fronted
            if before is not None and same and not draft.conditions and not draft.verb.otherwise:
                draft.conditions = [replace(c, carried=True) for c in before.conditions if c.word in section("guards")]
                draft.fronted = True
            if before is not None and before.verb.otherwise and self._goes_on(before, draft):
                draft.verb.otherwise = True  # "otherwise stop it and clean it"
            before = draft

    def _goes_on(self, before: ClauseDraft, draft: ClauseDraft) -> bool:
        """Return whether a clause is joined to the one before it, and is not what comes after it in any case."""
        between = re.findall(r"[a-z]+", self.text[before.verb.span.end : draft.verb.span.start].lower())
        same = before.verb.sentence == draft.verb.sentence and not draft.conditions
        return same and section("then_words").isdisjoint(between)


def _each_state(draft: ClauseDraft, nodes: Sequence[Node]) -> list[ClauseDraft]:
    """Return a clause for each state: "make it clean and dry"; but one for "leave it open or shut"."""
    at = next((i for i, n in enumerate(nodes) if is_a(n, "state")), len(nodes))
    words = [t for n in takewhile(lambda node: is_a(node, "state"), nodes[at:]) for t in leaves(n)]
    states = [state_of(t) for t in words if t.kind is Kind.STATE]
    if len(states) < 2 or any(t.text in section("choices") for t in words):
        return [draft]
    return [replace(draft, result=state, verb=replace(draft.verb)) for state in states]


def _places_ahead(nodes: list[Node], sign: str) -> list[Node]:
    """Return the places before a colon, which hold for what is named behind it: "into the crate: rope, hose"."""
    return nodes if sign == ":" and all(is_a(n, "place") for n in nodes) else []


def _is_title(unit: Tree[Leaf], sign: str, following: Sequence[Node]) -> bool:
    """Return whether something is only named, and a clause with a verb follows: "tea for Ann: boil the water"."""
    nodes = unit.children
    named = trees(nodes, "group") and all(is_a(node, "group", "place") for node in nodes)
    benefits = all(next(leaves(node)).text in section("awaited") for node in trees(nodes, "place"))
    deed = any(trees(unit.children, "clause") for unit in trees(following, "unit"))
    return sign == ":" and bool(named) and benefits and deed


def _is_taken_up(nodes: Sequence[Node]) -> bool:
    """Return whether the next unit that does more than name something does not say what it is about."""
    units = (unit for unit in trees(nodes, "unit") if not _is_named(unit.children))
    return any(map(_lacks, islice(units, 1)))


def _takes_up(draft: ClauseDraft, nodes: Sequence[Node]) -> bool:
    """Put what is named last in the place of the pronoun before it: "make it loud, the radio"."""
    named, pronouns = named_in(nodes), section("singular_pronouns")
    if len(named) != 1 or [p.name in pronouns and not p.lead for p in draft.direct] != [True]:
        return False
    old, new = draft.direct[0].name, named[0].name
    draft.relations = [Relation(r.relation, new if r.source == old else r.source, r.target) for r in draft.relations]
    draft.direct = named
    return True


def _is_named(nodes: Sequence[Node]) -> bool:
    """Return whether things are named, and nothing else."""
    groups = trees(nodes, "group")
    return 0 < len(groups) == len(nodes) and not any(map(_is_pronoun, groups))


def _lacks(unit: Tree[Leaf]) -> bool:
    """Return whether a unit does not name what it is about: "close it", "fill", "lid on", "off the stove"."""
    actions = trees(unit.children, "clause", "letting")
    nodes = [*unit.children, *(actions[0].children if actions else ())]
    groups = trees(nodes, "group")
    if trees(nodes, *_ASIDES, *_DENIALS):
        return False
    if not actions:
        return _bare_place(nodes) is not None or (bool(trees(nodes, "place", "state")) and not groups)
    verbs = {t.stem for t in leaves(trees(actions[0].children, "verbs")[0])}
    bare = _bare_place(nodes) is not None or not groups
    return (bare and section("intransitive").isdisjoint(verbs)) or (bool(groups) and _is_pronoun(groups[0]))


def _supplied(unit: Tree[Leaf], front: list[Node], topic: Sequence[Tree[Leaf]]) -> list[Node]:
    """Return what stands in front of the verb of a unit, with the topic where the unit lacks it."""
    if not (topic and _lacks(unit)):
        return front
    group = Tree("group", [part for named in topic for part in named.children])
    actions = trees(unit.children, "clause", "letting")
    nodes = [*front, *(actions[0].children if actions else ())]
    place = _bare_place(nodes)
    if place is not None and trees(nodes, "group"):
        place.children.append(group)
        return front
    if place is not None and not actions:  # "the lamp! off!"
        next(leaves(place)).kind = Kind.STATE
        return [group, *(Tree("state", place.children) if n is place else n for n in front)]
    return [group, *front]


def _bare_place(nodes: Sequence[Node]) -> Tree[Leaf] | None:
    """Return the first place that is only a preposition."""
    return next((place for place in trees(nodes, "place") if not trees(place.children, "group")), None)


def _is_vague(draft: ClauseDraft) -> bool:
    """Return whether a wish names nothing: "I need it later", "I need something from it" are no requests."""
    unnamed = all(p.name in section("unnamed") for p in draft.direct)
    said = any(not (unnamed and p.pronoun) for p in draft.landmarks) or draft.result or draft.conditions
    return bool(draft.direct) and not said and (unnamed or all(p.pronoun for p in draft.direct))


def _alike(wholes: Sequence[Phrase], others: Sequence[Phrase]) -> list[Phrase]:
    """Return phrases as some of the wholes; none where one of them is of another kind."""
    names = {phrase.name for phrase in wholes}
    found = [as_one(phrase) if phrase.name in names else phrase for phrase in others]
    kinds = section("one_words") | {name.rpartition("_")[2] for name in names}
    return found if kinds.issuperset(phrase.name for phrase in found) else []


def _is_counted(nodes: Sequence[Node]) -> bool:
    lead = next(leaves(nodes[0])).text
    return lead in section("indefinite") or is_number(lead)


def _treatments(draft: ClauseDraft) -> list[ClauseDraft]:
    """Read "give it a scrub" as "scrub it"; of "a scrub and a rinse", each by itself."""
    deeds = [p.name.rpartition("_")[2] for p in draft.direct]
    receivers = {r.target for r in draft.relations if r.relation == TO}
    if not receivers or section("treatments").isdisjoint(deeds):
        return [draft]
    if len(deeds) > 1:
        return [treated for each in draft.each() for treated in _treatments(each)]
    draft.verb.stem, draft.direct = deeds[0], [p for p in draft.landmarks if p.name in receivers]
    draft.landmarks, draft.relations = [], []
    return [draft]


def _is_deed(part: Tree[Leaf], *, done: bool) -> bool:
    """Return whether the addressee is the subject of a part: "after taking it out", "before you take it out".

    If ``done``, also "until you have taken it out".
    """
    kinds = (Kind.V, Kind.ING, Kind.FINITE, *([Kind.PARTICIPLE] if done else []))
    verb = next((t for t in leaves(part) if t.kind in kinds), None)
    if verb is None or verb.form == "ing":
        return verb is not None
    saying = Saying(part)
    subject = [t.text.partition("'")[0] for n in saying.subject for t in leaves(n)]
    return subject == [first_of("addressee")] and bool(saying.verbs) and saying.complement


def _is_pronoun(group: Tree[Leaf]) -> bool:
    phrases = phrases_of(group)
    return len(phrases) == 1 and phrases[0].pronoun and not phrases[0].lead


def _is_fold(node: Node) -> bool:
    return isinstance(node, Leaf) and node.source.kind is Kind.MOD


def _each_denied(condition: Condition) -> list[Condition]:
    """Return a condition for each thing that something must not be so of: "if neither the pot nor the lid is hot"."""
    said, *others = condition.clauses
    if others or len(said.direct) < 2 or any(said.phrase(noun).either for noun in said.direct):
        return [condition]
    alone = (replace(said, direct=(noun,), relations=_relations_without(said, noun)) for noun in said.direct)
    return [replace(condition, clauses=(clause,)) for clause in alone]


def _relations_without(clause: Clause, noun: str) -> tuple[Relation, ...]:
    """Return the relations of a clause that are not those of another thing that it acts on."""
    return tuple(r for r in clause.relations if r.source == noun or r.source not in clause.direct)


def _only_when(node: Tree[Leaf]) -> bool:
    """Return whether a condition says of somebody that he goes or is done, which no state of things shows."""
    sayings = [Saying(part) for part in trees(node.children, "part")]
    return bool(sayings) and all(
        saying.verbs
        and saying.verbs[-1].stem in section("intransitive")
        and trees(saying.subject, "group")
        and not (about_things(saying.subject) or saying.complement)
        for saying in sayings
    )


def _repeat(draft: ClauseDraft, before: ClauseDraft) -> None:
    """Read "do the same with the glass" as the clause before, with another object."""
    inner = [r for r in draft.relations if r.relation in section("static")]  # "with the glass in the sink"
    targets = {r.target for r in draft.relations if r not in inner}
    named = [p for p in draft.landmarks if p.name in targets]
    if not named or not any(p.name in section("same_words") for p in draft.direct):
        return
    if before.none():
        named = [replace(p, lead=(first_of("none_words"), *p.lead)) for p in named]
    draft.verb.stem, draft.direct, draft.result = before.verb.stem, named, before.result
    draft.landmarks = [p for p in draft.landmarks if p.name not in targets]
    draft.stated += [r._replace(source=named[-1].name) for r in inner]
    draft.relations = [*draft.stated, *before.unmoved()]
    draft.take_places(before)
    draft.folds += before.folds


def _mixed(node: Tree[Leaf]) -> bool:
    """Return whether only some parts of a clause are denied: "that the lamp is on and the radio is not"."""
    return len({Saying(part).denied for part in trees(node.children, "part")}) > 1


def _denied_whole(node: Tree[Leaf]) -> bool:
    """Return whether a negation is about a clause as a whole."""
    return next(leaves(node)).negated and not _mixed(node)


def _is_denied_next(named: Sequence[Node], nodes: Sequence[Node]) -> bool:
    """Return whether things are named, and a denial follows."""
    denials = [node for node in trees(nodes, "denial") if any(t.kind is Kind.V for t in leaves(node))]
    if not denials or trees(nodes, *_ASIDES) or not about_things(named):
        return False
    return next(leaves(named[0])).span.start < next(leaves(denials[0])).span.start


def _is_denied(node: Tree[Leaf], saying: Saying) -> bool:
    """Return whether a part of a clause is denied: by itself, or with all of the clause."""
    return saying.denied if _mixed(node) else next(leaves(node)).negated


def _says_nothing(clause: Clause) -> bool:
    """Return whether a clause says of a pronoun only that it is, or is not: "if it isn't"."""
    said = clause.result or clause.setting or clause.relations
    about = section("pronouns") | section("subjects")
    return clause.verb == BE and not said and about.issuperset(clause.objects)


def _denied_apart(draft: ClauseDraft) -> list[ClauseDraft]:
    """Return the parts of what no thing may be: neither this nor that, "none may be unweighed or without a stamp"."""
    lacking = [r for r in draft.relations if r.relation in section("without_words")]
    if not draft.none():
        return [draft]
    if len(draft.direct) > 1:
        return list(draft.each())
    if draft.result and lacking:
        plain = [r for r in draft.relations if r not in lacking]
        return [replace(draft, relations=plain), replace(draft, result=None)]
    return [draft]


def denies(condition: Condition) -> bool:
    """Return whether a condition asks that something is not so; "unless it is not" asks that it is."""
    return condition.negated != (condition.word in section("excepting"))


def _is_of_them(said: ClauseDraft) -> bool:
    """Return whether a clause says in what state things are that were named before: "they are dry"."""
    them = bool(said.direct) and all(p.name in section("plural_pronouns") for p in said.direct)
    return said.verb.stem == BE and them and bool(said.result or said.relations)


def _telling(said: ClauseDraft, opener: Token) -> list[str]:
    """Return what must not be lost of a relative clause that tells which thing is meant.

    *All that you can find* tells only that it is there.
    """
    if said.verb.stem in section("noticed") and opener.text in section("subjects"):
        return []
    return ["_".join([opener.text, *(p.name for p in said.mentions()), said.verb.stem])]
