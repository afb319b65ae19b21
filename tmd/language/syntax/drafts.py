"""Clauses before pronouns are resolved, and the attachment of their arguments."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field, replace

from lark import Tree

from tmd.language.clause import (
    BE,
    EXCEPT,
    NEGATED,
    OF,
    PERSONS,
    TO,
    WITH,
    Clause,
    Condition,
    Mood,
    NounPhrase,
    Quantifier,
    Relation,
    Span,
    hull,
)
from tmd.language.lexicon.lexicon import first_of, pairs, section, singular
from tmd.language.syntax.brackets import ALSO, RELATIVE
from tmd.language.syntax.grammar import CHOICE, Leaf, Node, is_a, leaves, trees
from tmd.language.syntax.joins import SETTING
from tmd.language.syntax.noun_phrases import Phrase, also_of, named_in, phrases_of
from tmd.language.syntax.tokens import EXISTS, IMPLIED, Kind, Token

_MULTIPLE = "; "


@dataclass(slots=True)
class ClauseDraft:
    """A clause before pronouns are resolved.

    Attributes:
        verb: The verb token.
        direct: What the verb acts on.
        landmarks: What stands behind prepositions.
        relations: The relation matrix.
        stated: Those of the relations by which relative clauses tell where things are.
        folds: Durations and settings.
        spans: Everything that belongs to it.
        conditions: What its conditions and purposes say.
        fronted: A condition stands in front of the verb.
        further: Noun phrases that stand in relative clauses.
        result: The state that something should be in.
        mood: What is asked of it, if it says so itself.
        elliptic: Its verb was read off a state: "TV on".
        host: The clause that it belongs to, whose objects its pronouns may mean.
        awaits: What must be done before it may be: "don't close it until you have filled it".
    """

    verb: Token
    direct: list[Phrase] = field(default_factory=list)
    landmarks: list[Phrase] = field(default_factory=list)
    relations: list[Relation] = field(default_factory=list)
    stated: list[Relation] = field(default_factory=list)
    folds: list[Token] = field(default_factory=list)
    spans: list[Span] = field(default_factory=list)
    conditions: list[Condition] = field(default_factory=list)
    fronted: bool = False
    further: dict[str, NounPhrase] = field(default_factory=dict)
    result: str | None = None
    mood: Mood | None = None
    relative: bool = False
    elliptic: bool = False
    host: ClauseDraft | None = None
    awaits: list[ClauseDraft] = field(default_factory=list)

    def mentions(self) -> list[Phrase]:
        """Return every phrase in order of mention, each name once."""
        ordered = sorted((p for top in self.direct + self.landmarks for p in top.all()), key=lambda p: p.place)
        return list({p.name: p for p in reversed(ordered)}.values())[::-1]

    def clause(self, text: str) -> Clause:
        """Return the clause without antecedents."""
        span, mentions = hull(self.spans), self.mentions()
        return Clause(
            verb=self.verb.stem,
            objects=tuple(dict.fromkeys([*(p.name for p in mentions), *self.further])),
            relations=tuple(dict.fromkeys(self.relations)),
            stated=tuple(r for r in dict.fromkeys(self.stated) if r.relation in section("static")),
            span=span,
            text=text[slice(*span)],
            quantities={p.name: p.quantity for p in mentions if p.quantity},
            direct=tuple(dict.fromkeys(p.name for p in self.direct)),
            phrases=self.further | {p.name: p.said() for p in mentions},
            conditions=tuple(self.conditions),
            mood=self.mood or self._mood(),
            result=self.result,
            otherwise=self.verb.otherwise,
            implied=self.verb.form == IMPLIED,
            alternative=self.verb.form == CHOICE,
            setting=self._folded(text, "setting"),
            heading=self.verb.heading,
            told=self.verb.told,
            condition=self._written(purpose=False),
            duration=self._folded(text, "duration"),
            purpose=self._written(purpose=True),
        )

    def add(self, phrases: Sequence[Phrase], places: Sequence[Span]) -> None:
        """Add what was named behind a state: "TV on, channel two"; "lights off, both" says how many."""
        both = [p.name for p in phrases if p.name in section("both_words")]
        for phrase in self.direct:
            phrase.lead = (*both, *phrase.lead)
        self.direct += [p for p in phrases if p.name not in both]
        self.spans += places

    def take_places(self, other: ClauseDraft) -> None:
        """Give what it acts on the places that another clause gives its things."""
        self.landmarks += other.landmarks
        moved, named = {p.name for p in other.direct}, {p.name for p in other.landmarks}
        given = (r for r in other.relations if r not in other.stated)
        places = {r.relation: r.target for r in given if r.source in moved and r.target in named}
        self.relations += [Relation(r, p.name, target) for r, target in places.items() for p in self.direct]

    def unmoved(self) -> list[Relation]:
        """Return its relations but for those of what it acts on."""
        moved = {p.name for p in self.direct}
        return [r for r in self.relations if r.source not in moved]

    def settings(self) -> list[str]:
        """Return its settings."""
        return [token.text for token in self.folds if token.form == SETTING]

    def owning(self) -> str:
        """Return the relation of a noun to what it has or acts on, by what a relative clause says; empty for others."""
        if self.verb.stem == BE:
            return WITH if self.result is None else ""
        return WITH if self.verb.stem in section("holding") else OF

    def placed(self, denied: str) -> list[tuple[str, Phrase]]:
        """Return its relations with what they lead to, as a noun takes them over; ``denied`` stands before each."""
        by_name = {p.name: p for p in self.landmarks}
        return [(denied + r.relation, by_name[r.target]) for r in self.relations if r.target in by_name]

    def each(self) -> list[ClauseDraft]:
        """Return a clause for each of its objects."""
        names = {p.name for p in self.direct}
        others = [r for r in self.relations if r.source not in names]
        own = ([r for r in self.relations if r.source == p.name] for p in self.direct)
        return [
            replace(self, direct=[p], relations=[*others, *said], verb=replace(self.verb))
            for p, said in zip(self.direct, own, strict=True)
        ]

    def none(self) -> bool:
        """Return whether it is about none: *no cup*."""
        return any(p.said().quantifier is Quantifier.NONE for p in self.direct)

    def affirm(self, *, each: bool = False) -> None:
        """Take "no" and "nothing" out of it; with ``each`` it is about each thing: "neither the pot nor the lid"."""
        names = {phrase.name: phrase.without_denial().name for phrase in (*self.direct, *self.landmarks)}
        if each:
            self.direct = [replace(phrase, either=()) for phrase in self.direct]
        self.direct = [phrase.without_denial() for phrase in self.direct]
        self.landmarks = [phrase.without_denial() for phrase in self.landmarks]
        ends = (
            (r.relation, names.get(r.source or "", r.source), names.get(r.target, r.target)) for r in self.relations
        )
        self.relations = [Relation(*end) for end in ends]

    def deny(self) -> None:
        """Say the contrary: that its things are not in the state, or not at the place."""
        self.result = NEGATED + self.result if self.result else None
        if self.result is None:
            self.relations = [r._replace(relation=NEGATED + r.relation) for r in self.relations]

    def _mood(self) -> Mood:
        """Return the mood of *leave the cup where it is* and *keep the door shut*, which say what must stay so."""
        leaves_it, keeps = self.verb.stem in section("leaving"), self.verb.stem in section("keeping")
        if not (self.direct and (leaves_it or keeps)):
            return Mood.DO
        placed = [r for r in self.relations if r.relation not in section("unplaced")]
        stays = self.relative or any(p.whole for p in self.direct) or self._there(placed)
        alone = self.result in section("alone_words")  # "leave the cup on the desk alone"
        return Mood.KEEP if not placed or alone or (leaves_it and stays) else Mood.DO

    def _there(self, placed: list[Relation]) -> bool:
        """Return whether something is named, and its place is where it is: "leave the key in there"."""
        there = section("pronouns") | section("there_pronouns")
        return all(r.target in there for r in placed) and not any(p.pronoun for p in self.direct)

    def _folded(self, text: str, form: str) -> str | None:
        folds = [t for t in self.folds if t.form == form]
        # a word of a phrase row stands nowhere in the text
        return _MULTIPLE.join(" ".join(text[t.span.start : t.span.end].split()) or t.text for t in folds) or None

    def _written(self, *, purpose: bool) -> str | None:
        said = ((c.text, c.word == TO or c.word in section("reasons")) for c in self.conditions if not c.carried)
        return _MULTIPLE.join(words for words, aimed in said if aimed == purpose) or None


class Attachment:
    """Attaches the arguments of one clause from left to right.

    Args:
        draft: The clause.
    """

    def __init__(self, draft: ClauseDraft) -> None:
        self.draft = draft
        self.host: list[Phrase] = []
        """The nouns the next preposition of place stands beside."""
        self._behind = ""
        """The preposition they stand behind, if any."""
        self._earlier: tuple[list[Phrase], str] = ([], "")
        """Host and preposition before the last prepositional phrase."""
        self._instrument = False
        """A "with" has been read."""
        self._paired = False
        """The host is the second thing of a gapped pair and takes any preposition."""
        self._pending: list[tuple[str, list[Phrase]]] = []
        """Relations whose source is the direct object, which may still come."""

    def add(self, nodes: Sequence[Node]) -> None:
        """Attach nodes from left to right."""
        for position, node in enumerate(nodes):
            rest = nodes[position + 1 :]
            if not self._gapped(node, rest):
                self._argument(node, sum(is_a(n, "place") for n in rest))

    def add_front(self, nodes: Sequence[Node]) -> None:
        """Attach what stands before the verb: to what the verb acts on, but a place behind an exception to that."""
        before: Node | None = None
        for node in nodes:
            excepted = trees(before.children, "group") if isinstance(before, Tree) and is_a(before, "exception") else []
            self.host = [p for group in excepted for p in phrases_of(group)] if is_a(node, "place") else []
            self.add([node])
            before = node

    def _argument(self, node: Node, later: int) -> None:
        if not isinstance(node, Tree):
            return
        groups = trees(node.children, "group")
        if node.data == "group":
            self._group(phrases_of(node))
        elif node.data == "place" and groups:
            self._place(next(leaves(node)), groups[0], later)
        elif node.data == "place" and self.draft.verb.form == IMPLIED:
            place = next(leaves(node))  # "both boxes in": in what was mentioned
            self._relate(place.text, [], [Phrase(first_of("singular_pronouns"), place.span.start, False, True)])
        elif node.data == "exception" and groups:
            self._exception(phrases_of(groups[0]))
        elif node.data == "state":
            self.draft.result = [state_of(t) for t in leaves(node) if t.kind is Kind.STATE][-1]

    def _group(self, phrases: list[Phrase]) -> None:
        """Add what the verb acts on; the first of two groups of a giving verb is the receiver."""
        draft = self.draft
        person = bool(draft.direct) and draft.direct[0].name in PERSONS
        giving = person or draft.verb.stem in section("dative_verbs")
        if draft.direct and not self._behind and giving and not draft.relations:
            receivers, draft.direct[:] = [*draft.direct], []
            draft.landmarks.extend(receivers)
            draft.relations.extend(Relation(TO, p.name, receiver.name) for p in phrases for receiver in receivers)
        wanted = [p for p in phrases if p.said().quantifier is not Quantifier.NONE]
        phrases = self._without(wanted, phrases) if wanted else phrases  # "a coffee, no sugar"
        phrases = self._told_apart(phrases)
        draft.direct.extend(phrases)
        self.host, self._behind = phrases, ""
        self._of(phrases)

    def _of(self, phrases: Sequence[Phrase]) -> None:
        for phrase in phrases:
            self.draft.relations.extend(Relation(OF, phrase.name, part.name) for part in phrase.of)
            self._of(phrase.of)

    def _exception(self, phrases: list[Phrase]) -> None:
        """Take an exception out of a whole."""
        acted_on = {p.name for p in self.draft.direct}
        phrases = [as_one(p) if p.name in acted_on else p for p in phrases]  # "all the cups except the cup here"
        self._earlier = self.host, self._behind
        self._relate(EXCEPT, self._whole(), phrases)
        named = acted_on - {p.name for p in phrases}
        goes = any(r.source in named and r.relation in section("arrivals") for r in self.draft.relations)
        # "all cups in the sink except the cup on the shelf": where the others go was said before
        fronted = not self.draft.direct  # "except for the cup on the shelf, all cups …"
        self.host, self._behind = phrases if goes or fronted or _tells(phrases) else [], EXCEPT

    def _whole(self) -> Sequence[Phrase]:
        """Return what an exception is taken from: *all* of something, else several things, else what is nearest."""
        named = (self.draft.direct, self.host)
        every = ([p for p in phrases if p.said().quantifier is Quantifier.ALL] for phrases in named)
        several = [p for phrases in reversed(named) for p in phrases if p.plural]
        return next(filter(None, every), None) or several or self.host or self.draft.direct

    def _place(self, preposition: Token, group: Tree[Leaf], later: int) -> None:
        """Add a prepositional phrase; ``later`` counts those still to come."""
        if preposition.form == ALSO:
            self.host, self._behind = self._earlier
        name, targets = self._named(preposition, group)
        self._earlier = self.host, self._behind
        inner = self._behind in section("with_words") and len(targets) == 1 and targets[0].pronoun
        if inner and name in section("contents_places"):
            return  # "a mug with milk in it"
        paired, self._paired = self._paired, False
        hosts = self.host if paired or self._hosted(name, targets) else []
        self._relate(name, hosts, self._without(hosts, targets) if name in section("with_words") else targets)
        if preposition.form == RELATIVE:
            self.draft.stated += [Relation(name, host.name, target.name) for host in hosts for target in targets]
        # where it goes is still to come: "and the books from the floor on the shelf"
        self._paired = paired and (name in section("origins") or preposition.form == RELATIVE)
        if not self._paired:
            self._next_host(preposition, name, targets, later)

    def _named(self, preposition: Token, group: Tree[Leaf]) -> tuple[str, list[Phrase]]:
        """Return the relation and its targets; what goes with the object ("and the lid too") becomes one."""
        name, also = pairs("relation_names").get(preposition.text, preposition.text), also_of(group)
        targets = self._told_apart(p for p in phrases_of(group) if p.name not in {q.name for q in also})
        also = self._told_apart(also)
        self.draft.direct += also
        self.host = [*self.host, *also] if self.host else []
        if name in section("with_words"):  # "with a splash of milk"
            targets = [p.of[0] if p.of and singular(p.name) in section("drops") else p for p in targets]
        if name in section("with_words") and targets and targets[0].said().quantifier is Quantifier.NONE:
            name = first_of("without_words")  # "with neither milk nor sugar"
            targets = [target.without_denial() for target in targets]
        return name, targets

    def _without(self, hosts: Sequence[Phrase], targets: list[Phrase]) -> list[Phrase]:
        """Relate what must not be there: "with sugar but no milk"; return the others."""
        lacking = [p for p in targets if p.said().quantifier is Quantifier.NONE]
        if lacking:
            self._relate(first_of("without_words"), hosts, [p.without_denial() for p in lacking])
        return [p for p in targets if p not in lacking]

    def _next_host(self, preposition: Token, name: str, targets: list[Phrase], later: int) -> None:
        placing = self.draft.verb.stem in section("placing")
        if preposition.form == RELATIVE:
            self.host = targets if later > 1 or not placing else self.host
            return
        self._instrument = self._instrument or name in section("with_words")
        if self._tells_one() and placing:
            self.host = []  # "except the one on the chair | on the shelf"
        elif targets and (name not in section("never_hosts") or _tells(targets)) and targets[0].name not in PERSONS:
            self.host = targets
        self._behind = name

    def _told_apart(self, phrases: Iterable[Phrase]) -> list[Phrase]:
        """Name "the other table" and "the clean cup" *one* where this clause has mentioned another table or cup.

        Of "a scoop of vanilla in one bowl and a scoop of chocolate in the other" the second is the chocolate.
        """
        mentioned = self.draft.mentions()
        found: list[Phrase] = []
        for phrase in phrases:
            before = [p for p in (*mentioned, *found) if p.name == phrase.name]
            other = bool(before) and not section("other_words").isdisjoint(phrase.lead)
            told = other or any(p.said().attributes != phrase.said().attributes for p in before)
            others = any(p.of and p.of != phrase.of for p in before) and bool(phrase.of)
            measured = others and singular(phrase.name) in section("measures")
            found.append(phrase.of[0] if measured else as_one(phrase) if told or others else phrase)
        return found

    def _relate(self, name: str, sources: Sequence[Phrase], targets: list[Phrase]) -> None:
        """Relate targets to their sources; without sources, to what the verb will turn out to act on."""
        self.draft.landmarks.extend(targets)
        self._of(targets)
        if sources:
            self.draft.relations.extend(Relation(name, s.name, t.name) for s in sources for t in targets)
        else:
            self._pending.append((name, targets))

    def _gapped(self, node: Node, rest: Sequence[Node]) -> bool:
        """Read "the cups on the table and the books on the shelf": the second pair stands by itself."""
        if not (is_a(node, "place") and rest and is_a(rest[0], "place") and self.draft.direct):
            return False
        phrases = named_in(node.children)
        if len(phrases) < 2 or not self._pairs(node, rest, phrases):
            return False
        sources = list(self.host if self._paired else self.draft.direct)
        self._relate(next(leaves(node)).text, sources, phrases[:1])
        others = self._told_apart(phrases[1:])
        self.draft.direct += others
        self._of(others)
        self.flush(sources)
        self.host, self._behind, self._paired = others, "", True
        return True

    def _pairs(self, node: Tree[Leaf], rest: Sequence[Node], phrases: list[Phrase]) -> bool:
        """Return whether the last nouns behind a preposition are things that the next one places."""
        place = rest[0]
        name, opening = next(leaves(node)).text, next(leaves(place)).text
        tells = opening in section("origins") or next(leaves(place)).form == RELATIVE
        origin = tells and len(rest) > 1 and is_a(rest[1], "place")
        goes = next(leaves(rest[1] if origin else rest[0])).text in section("static") | section("arrivals")
        places = section("placing") | section("belonging") | section("getting") | section("wishing")
        placing = self.draft.verb.stem in places or any(t.kind is Kind.PRON for t in leaves(place))
        placing = placing and name not in section("with_words")  # "with neither milk nor sugar in it"
        opposite = isinstance(place, Tree) and any(
            w in section("other_words") for p in named_in(place.children) for w in p.lead
        )
        alike = opposite or self._is_thing_again(phrases)
        return alike and (name == opening or (placing and goes))

    def _is_thing_again(self, phrases: list[Phrase]) -> bool:
        """Return whether the last of some nouns behind a preposition has the determiner of a thing, not of a place."""
        last, direct = phrases[-1], self.draft.direct[0]
        bare = phrases[0].determined and not direct.determined
        terse = not (direct.determined or any(p.determined for p in phrases))  # "cup in sink and pan in bin"
        return last.determined or last.name in section("one_words") or bare or terse

    def _hosted(self, name: str, targets: list[Phrase]) -> bool:
        """Return whether a preposition stands beside the noun before it rather than the direct object."""
        stem = self.draft.verb.stem
        if not self.host:
            return False
        if name in section("with_words"):
            return self._with_hosted(stem, targets)
        if self._tells_one() and name in section("telling_places"):
            return True  # "except the one on the shelf": what stands behind it says which one
        if name in section("by_words") and not any(t.determined or t.pronoun for t in targets):
            return False
        going = self._behind in section("origins") and stem in section("placing") | section("fetching")
        return name in section("static") and not going

    def _with_hosted(self, stem: str, targets: list[Phrase]) -> bool:
        if self.draft.verb.form == EXISTS and not any(p.name in section("one_words") for p in self.host):
            return False  # "there should be a glass on the table with juice in it"
        if self._tells_one():
            return True
        if any(not section("tools").isdisjoint((t.name, t.name.rpartition("_")[2])) for t in targets):
            held = section("moving") | section("placing") | section("dative_verbs")
            return self._instrument or (stem in held and not self._behind)
        return self._instrument or stem.partition("_")[0] not in section("with_verbs")

    def _tell_excepted_apart(self, acted_on: Collection[str]) -> None:
        """Rename what is excepted in front of its whole: "except for the cup on the shelf, every cup"."""
        for number, (name, targets) in enumerate(self._pending):
            alike = {p.name: as_one(p) for p in targets if name == EXCEPT and p.name in acted_on}
            if not alike:
                continue
            self._pending[number] = name, [alike.get(p.name, p) for p in targets]
            self.draft.landmarks = [alike.get(p.name, p) for p in self.draft.landmarks]
            said = self.draft.relations
            self.draft.relations = [r._replace(source=alike[r.source].name) if r.source in alike else r for r in said]

    def _tells_one(self) -> bool:
        """Return whether what comes now says which *one* is meant."""
        return bool(self._behind) and bool(self.host) and all(p.name in section("one_words") for p in self.host)

    def flush(self, direct: list[Phrase]) -> None:
        """Relate what stands behind prepositions to the direct objects."""
        sources: list[str | None] = [p.name for p in direct] or [None]
        self._tell_excepted_apart({p.name for p in direct})
        for name, targets in self._pending:
            self.draft.relations.extend(Relation(name, s, t.name) for t in targets for s in sources)
        self._pending.clear()


def state_of(token: Token) -> str:
    """Return the state that a word names: *off*, for "turned off"."""
    particle = token.stem.partition("_")[2]
    return particle if token.form == "ed" and particle in section("end_states") else token.text


def as_one(phrase: Phrase) -> Phrase:
    """Return a phrase as *one* of what was mentioned."""
    return replace(phrase, name=first_of("one_words"), pronoun=True)


def _tells(phrases: list[Phrase]) -> bool:
    """Return whether a phrase is *the one*, which a further phrase must describe."""
    return bool(phrases) and phrases[0].name in section("one_words") and bool(phrases[0].lead)
