"""From the tree of a text to its clauses, before pronouns are resolved: attachment, conditions, demands, prohibitions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from importlib.resources import files

from lark import Lark, Tree
from lark import Token as LarkToken
from lark.exceptions import UnexpectedInput
from lark.lexer import Lexer

from tmd.language.clause import BE, PERSONS, Clause, Condition, Mood, NounPhrase, Quantifier, Relation, Span
from tmd.language.lexicon.lexicon import pairs, section, sections, singular
from tmd.language.syntax.brackets import ALSO, DUTY, RELATIVE, STATEMENT
from tmd.language.syntax.links import CHOICE
from tmd.language.syntax.tokens import IMPLIED, NAME, Kind, Token

EXISTS = "exists"
"""The form of *be* in "there is"."""
UNEXPECTED = "does not fit into a clause here"
NEGATED = "says what not to do"
HAVE, PUT, SET, BRING = "have", "put", "set", "bring"
"""Verbs of requests without one: what a thing shall be had, put or set to."""
_MULTIPLE = "; "


class _NoLexer(Lexer):
    """The parser is fed token by token; nothing is left to lex."""

    def __init__(self, lexer_conf: object) -> None:
        """Take lark's configuration, which is not needed."""

    def lex(self, data: object) -> Iterator[LarkToken]:  # type: ignore[override]
        """Yield nothing."""
        return iter(())


@cache
def _parser() -> Lark:
    grammar = (files("tmd.language.syntax") / "clauses.lark").read_text(encoding="utf-8")
    return Lark(grammar, start="text", parser="lalr", lexer=_NoLexer)


class Leaf(LarkToken):
    """A lark token that carries ours."""

    __slots__ = ("source",)
    source: Token


Node = Tree[Leaf] | Leaf


def parse_tokens(tokens: list[Token]) -> Tree[Leaf]:
    """Parse the terminals of the grammar. A token that cannot follow is noted and left out. Linear."""
    parser = _parser().parse_interactive("")
    for token in tokens:
        leaf = Leaf(token.kind.value, token.text)
        leaf.source = token
        try:
            parser.feed_token(leaf)
        except UnexpectedInput:
            token.note = token.note or UNEXPECTED
    tree: Tree[Leaf] = parser.feed_token(LarkToken("$END", ""))
    return tree


def leaves(node: Node) -> Iterator[Token]:
    """Yield the tokens under a node, in order."""
    if isinstance(node, Leaf):
        yield node.source
    else:
        for child in node.children:
            yield from leaves(child)


def _is(node: Node, *names: str) -> bool:
    return isinstance(node, Tree) and node.data in names


def _trees(nodes: Sequence[Node], *names: str) -> list[Tree[Leaf]]:
    return [n for n in nodes if isinstance(n, Tree) and n.data in names]


# -- noun phrases ------------------------------------------------------------------------------------------------------


def number_of(word: str) -> int | None:
    """Return the number that a word or numeral names, up to twelve in words."""
    if word.isascii() and word.isdigit() and len(word) < 10:
        return int(word)
    if word in section("pairs"):
        return 2
    order = sections()["number_order"]
    return order.index(word) if word in order else None


def is_number(word: str) -> bool:
    """Tell whether a word is a number, in figures or in words."""
    return word[:1].isdigit() or word in section("numbers")


@dataclass(slots=True)
class Phrase:
    """A noun phrase.

    Attributes:
        name: The name of its head with its modifiers.
        place: Where it begins in the text.
        plural: Whether it is plural.
        pronoun: Whether its head is one.
        quantity: Its number as written.
        of: What hangs on it with "of".
        lead: The words before the head.
        either: The names of which any will do.
        attributes: Adjectives behind it.
    """

    name: str
    place: int
    plural: bool
    pronoun: bool
    quantity: str = ""
    of: list[Phrase] = field(default_factory=list)
    lead: tuple[str, ...] = ()
    either: tuple[str, ...] = ()
    attributes: list[str] = field(default_factory=list)

    @property
    def determined(self) -> bool:
        """Whether an article or the like stands before it."""
        return any(word in _determiners() for word in self.lead)

    @property
    def whole(self) -> bool:
        """Whether it means all there is."""
        return self.name in section("whole_words")

    def said(self) -> NounPhrase:
        """Return how it was said."""
        words = (*self.lead, self.name) if self.pronoun or self.whole else self.lead
        if not (self.plural or self.pronoun or self.of):
            words = tuple(w for w in words if w not in section("both_words"))  # "both the cup and the mug": one of each
        quantity = self.quantity or next((w for w in self.lead if is_number(w) and number_of(w) != 1), "")
        both = any(w in section("both_words") for w in words)
        described = (w for w in self.lead if w not in _determiners() | section("other_words") and not is_number(w))
        return NounPhrase(
            self.name,
            self._quantifier(words, quantity),
            number_of(quantity) if quantity else 2 if both else None,
            self.determined and section("indefinite").isdisjoint(self.lead),
            self.plural,
            tuple(dict.fromkeys([*described, *self.attributes])),
            self.either,
            not section("each_words").isdisjoint(words),
        )

    def _quantifier(self, words: tuple[str, ...], quantity: str) -> Quantifier:
        one_of = self.plural and self.lead[:1] != () and number_of(self.lead[0]) == 1
        rows = (
            (Quantifier.NONE, not section("none_words").isdisjoint((*self.lead, self.name))),
            (Quantifier.ALL, self.whole or not section("all_words").isdisjoint(words)),
            (Quantifier.NUMBER, number_of(quantity) not in (None, 1)),
            (Quantifier.OTHER, not section("other_words").isdisjoint(self.lead)),
            (Quantifier.SOME, one_of or not section("some_words").isdisjoint(self.lead)),
        )
        return next((quantifier for quantifier, holds in rows if holds), Quantifier.PLAIN)

    def all(self) -> Iterator[Phrase]:
        """Yield the phrase and everything under it."""
        yield self
        for phrase in self.of:
            yield from phrase.all()


@cache
def _determiners() -> frozenset[str]:
    names = ("determiners", "quantifiers", "definite", "indefinite", "all_words", "none_words")
    return frozenset().union(*(section(name) for name in names))


def _phrases(group: Tree[Leaf]) -> list[Phrase]:
    """Return the phrases of a group; "or" makes them alternatives."""
    phrases = [_phrase(node) for node in _trees(group.children, "phrase")]
    if any(isinstance(n, Leaf) and n.source.form == CHOICE for n in group.children):
        for phrase in phrases:
            phrase.either = tuple(p.name for p in phrases)
        none = [w for w in phrases[0].lead if w in section("none_words")]
        for phrase in phrases[1:] if none else ():
            phrase.lead = (*none, *phrase.lead)  # "neither the lamp nor the radio"
    result: list[Phrase] = []
    for phrase in phrases:
        host = result[-1] if result else None
        if host is not None and host.of and host.name in section("inner_and") and not phrase.determined:
            host.of.append(phrase)
        else:
            result.append(phrase)
    return result


def _also(group: Tree[Leaf]) -> list[Phrase]:
    """Return the phrases of a group that go with what stands before it: "… and the lid too"."""
    joint = next((i for i, n in enumerate(group.children) if isinstance(n, Leaf) and n.source.form == ALSO), None)
    return [] if joint is None else [_phrase(n) for n in _trees(group.children[joint:], "phrase")]


def _phrase(node: Tree[Leaf]) -> Phrase:
    chain: list[Phrase] = []
    lead: list[Token] = []
    for child in node.children:
        if isinstance(child, Leaf):
            lead.append(child.source)
            continue
        phrase = _head(list(leaves(child)), [t for t in lead if t.kind is not Kind.OF])
        if chain:
            chain[-1].of.append(phrase)
        chain.append(phrase)
        lead = []
    return chain[0]


def _head(words: list[Token], lead: list[Token]) -> Phrase:
    written = "_".join(t.text for t in words)
    if len(words) == 1 and words[0].text in section("other_words"):
        return Phrase("one", words[0].span.start, False, True, lead=(*(t.text for t in lead), words[0].text))
    if len(words) == 1 and words[0].text in section("ordinals"):
        return Phrase(f"{words[0].text}_{sections()['one_words'][0]}", words[0].span.start, False, True, lead=tuple(t.text for t in lead))
    one = words[-1].text in section("one_words")
    pronoun = words[-1].kind is Kind.PRON or one
    said = tuple(t.text for t in lead)
    quantity = next((t.text for t in reversed(lead) if t.kind is Kind.NUM), "")
    start = words[0].span.start
    if one:  # "the white one": what was spoken of, and which of it
        names = [t.text for t in words[:-1]]
        name = "_".join([*names, singular(words[-1].text)])
        return Phrase(name, start, name != written, True, quantity, lead=(*said, *names))
    name = written if pronoun or words[-1].form == NAME else singular(written)
    return Phrase(name, start, name != written, pronoun, quantity, lead=said)


# -- drafts ------------------------------------------------------------------------------------------------------------


@dataclass(slots=True)
class ClauseDraft:
    """A clause before pronouns are resolved.

    Attributes:
        verb: The verb token.
        direct: What the verb acts on.
        landmarks: What stands behind prepositions.
        relations: The relation matrix.
        folds: Durations and settings.
        spans: Everything that belongs to it.
        conditions: What its conditions and purposes say.
        fronted: A condition stands in front of the verb.
        further: Noun phrases that stand in relative clauses.
        result: The state that something shall be in.
        mood: What is asked of it, if it says so itself.
        written: Conditions and purposes as written, by kind.
        elliptic: Its verb was read off a state: "TV on".
        host: The clause that it is said with, whose objects its pronouns may mean.
    """

    verb: Token
    direct: list[Phrase] = field(default_factory=list)
    landmarks: list[Phrase] = field(default_factory=list)
    relations: list[Relation] = field(default_factory=list)
    folds: list[Token] = field(default_factory=list)
    spans: list[Span] = field(default_factory=list)
    conditions: list[Condition] = field(default_factory=list)
    fronted: bool = False
    further: dict[str, NounPhrase] = field(default_factory=dict)
    result: str | None = None
    mood: Mood | None = None
    relative: bool = False
    written: list[tuple[str, str]] = field(default_factory=list)
    elliptic: bool = False
    host: ClauseDraft | None = None

    def mentions(self) -> list[Phrase]:
        """Return every phrase in order of mention, each name once."""
        ordered = sorted((p for top in self.direct + self.landmarks for p in top.all()), key=lambda p: p.place)
        return list({p.name: p for p in reversed(ordered)}.values())[::-1]

    def clause(self, text: str) -> Clause:
        """Return the clause without antecedents."""
        span = Span(min(s.start for s in self.spans), max(s.end for s in self.spans))
        mentions = self.mentions()
        return Clause(
            verb=self.verb.stem,
            objects=tuple(dict.fromkeys([*(p.name for p in mentions), *self.further])),
            relations=tuple(dict.fromkeys(self.relations)),
            span=span,
            text=text[span.start : span.end],
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
            condition=self._written("condition"),
            duration=self._folded(text, "duration"),
            purpose=self._written("purpose"),
        )

    def _mood(self) -> Mood:
        """Return the mood of *leave the cup where it is* and *keep the door shut*, which say what must stay so."""
        leaves_it, keeps = self.verb.stem in section("leaving"), self.verb.stem in section("keeping")
        if not (self.direct and (leaves_it or keeps)):
            return Mood.DO
        placed = [r for r in self.relations if r.relation not in section("unplaced")]
        if leaves_it and any(p.whole for p in self.direct):
            placed = []  # "leave everything else on the table": what is there
        if leaves_it and not any(p.pronoun for p in self.direct) and all(r.target in section("pronouns") for r in placed):
            placed = []  # "leave the key in there"
        if self.result in section("alone_words"):
            placed = []  # "leave the cup on the desk alone"
        return Mood.KEEP if not placed or (leaves_it and self.relative) else Mood.DO

    def _folded(self, text: str, form: str) -> str | None:
        spans = [t.span for t in self.folds if t.form == form]
        return _MULTIPLE.join(" ".join(text[s.start : s.end].split()) for s in spans) or None

    def _written(self, form: str) -> str | None:
        return _MULTIPLE.join(words for kind, words in self.written if kind == form) or None


class Attachment:
    """Attaches the arguments of one clause from left to right."""

    def __init__(self, draft: ClauseDraft) -> None:
        self.draft = draft
        self.host: list[Phrase] = []
        """The nouns the next preposition of place stands beside."""
        self.behind = ""
        """The preposition they stand behind, if any."""
        self.earlier: tuple[list[Phrase], str] = ([], "")
        """Host and preposition before the last prepositional phrase."""
        self.instrument = False
        """A "with" has been read."""
        self.paired = False
        """The host is the second thing of a gapped pair and takes any preposition."""
        self.pending: list[tuple[str, list[Phrase]]] = []
        """Relations whose source is the direct object, which may still come."""

    def group(self, phrases: list[Phrase]) -> None:
        """Add what the verb acts on; the first of two groups of a giving verb is the receiver."""
        draft = self.draft
        person = bool(draft.direct) and draft.direct[0].name in PERSONS
        giving = person or draft.verb.stem in section("dative_verbs")
        if len(draft.direct) == 1 and not self.behind and giving and not draft.relations:
            receiver = draft.direct.pop()
            draft.landmarks.append(receiver)
            draft.relations.extend(Relation("to", p.name, receiver.name) for p in phrases)
        draft.direct.extend(phrases)
        self.host, self.behind = phrases, ""
        self._of(phrases)

    def _of(self, phrases: list[Phrase]) -> None:
        for phrase in phrases:
            for part in phrase.of:
                self.draft.relations.append(Relation("of", phrase.name, part.name))
                self._of([part])

    def exception(self, phrases: list[Phrase]) -> None:
        """Take something out of what was said of all."""
        wholes = [p for p in self.draft.direct if p.said().quantifier is Quantifier.ALL]
        self.earlier = self.host, self.behind
        if hosts := wholes or self.host or self.draft.direct:
            self._relate("except", hosts, phrases)
        else:
            self.draft.landmarks.extend(phrases)
            self.pending.append(("except", phrases))
        told = bool(phrases) and phrases[0].name in section("one_words") and bool(phrases[0].lead)
        self.behind = "except"
        self.host = phrases if told else []

    def place(self, preposition: Token, groups: list[Tree[Leaf]], later: int) -> None:
        """Add a prepositional phrase; ``later`` counts those still to come."""
        if not groups:
            return
        if preposition.form == ALSO:
            self.host, self.behind = self.earlier
        name, also = pairs("relation_names").get(preposition.text, preposition.text), _also(groups[0])
        targets = [self._told_apart(p) for p in _phrases(groups[0]) if p.name not in {q.name for q in also}]
        self.draft.direct += also  # "put the pot on the bench, and the lid too"
        if name in section("with_words") and targets and targets[0].said().quantifier is Quantifier.NONE:
            name = sections()["without_words"][0]  # "with neither milk nor sugar"
            for target in targets:
                target.lead = tuple(w for w in target.lead if w not in section("none_words"))
        self.earlier = self.host, self.behind
        inner = self.behind in section("with_words") and len(targets) == 1 and targets[0].pronoun
        if inner and name in section("contents_places"):
            return  # "a mug with milk in it"
        paired, self.paired = self.paired, False
        self.host = [*self.host, *also] if self.host else []
        if self.host and (paired or self._hosted(name, targets)):
            self._relate(name, self.host, targets)
        else:
            self.draft.landmarks.extend(targets)
            self._of(targets)
            self.pending.append((name, targets))
        if paired and name in section("origins"):
            self.paired = True  # where it goes is still to come
            return
        placing = self.draft.verb.stem in section("placing")
        if preposition.form == RELATIVE:
            self.host = targets if later > 1 or not placing else self.host
            return
        self.instrument = self.instrument or name in section("with_words")
        if self._tells_one() and placing:
            self.host, self.behind = [], name  # "except the one on the chair | on the shelf"
            return
        self.behind = name
        told = targets[0].name in section("one_words") and bool(targets[0].lead)
        if (name not in section("never_hosts") or told) and targets[0].name not in PERSONS:
            self.host = targets

    def _told_apart(self, phrase: Phrase) -> Phrase:
        """Name "the other table" *one* where a table was spoken of in this clause."""
        again = any(p.name == phrase.name for p in self.draft.mentions())
        if again and not section("other_words").isdisjoint(phrase.lead):
            return replace(phrase, name=sections()["one_words"][0], pronoun=True)
        return phrase

    def _relate(self, name: str, sources: Sequence[Phrase], targets: list[Phrase]) -> None:
        self.draft.landmarks.extend(targets)
        self._of(targets)
        self.draft.relations.extend(Relation(name, s.name, t.name) for s in sources for t in targets)

    def gapped(self, node: Node, following: Node | None, beyond: Node | None) -> bool:
        """Read "the cups on the table and the books on the shelf": the second pair stands by itself."""
        if not (_is(node, "place") and following is not None and _is(following, "place") and self.draft.direct):
            return False
        assert isinstance(node, Tree)
        assert isinstance(following, Tree)
        phrases = [p for group in _trees(node.children, "group") for p in _phrases(group)]
        if len(phrases) < 2:
            return False
        name, opening = next(leaves(node)).text, next(leaves(following)).text
        opposite = [p for group in _trees(following.children, "group") for p in _phrases(group)]
        bare = phrases[0].determined and not phrases[-1].determined and not self.draft.direct[0].determined
        bare = bare or any(w in section("other_words") for p in opposite for w in p.lead)
        last = beyond if opening in section("origins") and beyond is not None and _is(beyond, "place") else following
        goes = next(leaves(last)).text in section("static") | section("arrivals")
        placing = section("placing") | section("belonging")
        alike = name == opening or (self.draft.verb.stem in placing and goes)
        told = phrases[-1].determined or phrases[-1].name in section("one_words")
        if not (told or bare) or not alike:
            return False
        sources = list(self.host if self.paired else self.draft.direct)
        self._relate(name, sources, phrases[:1])
        self.draft.direct += phrases[1:]
        self._of(phrases[1:])
        self._flush(sources)
        self.host, self.behind, self.paired = phrases[1:], "", True
        return True

    def _hosted(self, name: str, targets: list[Phrase]) -> bool:
        """Tell whether a preposition stands beside the noun before it rather than the direct object."""
        stem, withal = self.draft.verb.stem, name in section("with_words")
        if self._tells_one() and (withal or name in section("telling_places")):
            return True  # "except the one with the handle": what stands behind it says which one
        if withal and any(_is_tool(t.name) for t in targets):
            held = section("moving") | section("placing") | section("dative_verbs")
            return self.instrument or (stem in held and not self.behind)
        if withal:
            return stem.partition("_")[0] not in section("with_verbs") or self.instrument
        if name in section("by_words") and not any(t.determined or t.pronoun for t in targets):
            return False
        if name not in section("static"):
            return False
        going = section("placing") | section("fetching")
        return not (self.behind in section("origins") and stem in going)

    def _tells_one(self) -> bool:
        """Tell whether what comes now says which *one* is meant."""
        return bool(self.behind) and bool(self.host) and all(p.name in section("one_words") for p in self.host)

    def finish(self) -> None:
        """Relate what stands behind prepositions to the direct objects."""
        self._flush(self.draft.direct)

    def _flush(self, direct: list[Phrase]) -> None:
        sources: list[str | None] = [p.name for p in direct] or [None]
        for name, targets in self.pending:
            self.draft.relations.extend(Relation(name, s, t.name) for t in targets for s in sources)
        self.pending.clear()


def _is_tool(name: str) -> bool:
    return name in section("tools") or name.rpartition("_")[2] in section("tools")


# -- the text ----------------------------------------------------------------------------------------------------------


@dataclass(slots=True)
class TextReading:
    """The clauses of a text before pronouns are resolved.

    Attributes:
        drafts: What is to be done, in order.
        forbidden: What must not be done, each with the number of drafts before it.
        statements: Noun phrases of statements, each with the number of drafts before it.
        skipped: What asks for nothing, as tokens that carry the reason.
        alone: The text has one unit.
    """

    text: str
    drafts: list[ClauseDraft] = field(default_factory=list)
    forbidden: list[tuple[int, ClauseDraft]] = field(default_factory=list)
    statements: list[tuple[int, ClauseDraft]] = field(default_factory=list)
    skipped: list[Token] = field(default_factory=list)
    alone: bool = False

    def read(self, tree: Tree[Leaf]) -> TextReading:
        """Read the tree of a text."""
        self.alone = sum(isinstance(unit, Tree) for unit in tree.children) == 1
        for unit in tree.children:
            if isinstance(unit, Tree):
                self._unit(unit)
        self._carry()
        return self

    def _unit(self, unit: Tree[Leaf]) -> None:
        actions = _trees(unit.children, "clause", "letting")
        front = [n for n in unit.children if n not in actions]
        for index, action in enumerate(actions):
            self._clause(action, front if not index else [])
        if not actions:
            self._verbless(front)

    def _clause(self, node: Tree[Leaf], front: list[Node]) -> None:
        """Read a clause; verbs that share their object become a clause each."""
        verbs = [t for t in leaves(_trees(node.children, "verbs")[0]) if t.kind is Kind.V]
        drafts = [ClauseDraft(verb, spans=[verb.span, *verb.parts]) for verb in verbs]
        first, last = drafts[0], drafts[-1]
        arguments = [n for n in node.children if not _is(n, "verbs") and not (isinstance(n, Leaf) and n.source.kind is Kind.LET)]
        for token in leaves(node):
            last.spans.extend([token.span, *token.parts] if token.kind is not Kind.V else [])
        demands = [n for n in front if _is(n, "demand", "statement")]
        for demand in demands:
            self._aside(demand)  # type: ignore[arg-type]
        front = [n for n in front if n not in demands]
        topic = [n for n in front if _is(n, "group", "place")]
        if topic and _is(topic[0], "group") and (pronoun := self._pronoun(arguments)) is not None:
            arguments[pronoun : pronoun + 1] = topic  # "the drawers, open them"
            front = [n for n in front if n not in topic]
            last.spans.extend(t.span for n in topic for t in leaves(n))
        for item in front:
            if not _is(item, "group"):
                first.spans.extend(s for t in leaves(item) for s in (t.span, *t.parts))
        if first.verb.stem in section("wishing"):
            first.verb.stem, first.verb.form = HAVE, IMPLIED
        same = self.drafts[-1] if self.drafts else None
        self.drafts.extend(drafts)
        places = [n for n in front if _is(n, "place", "exception")]
        self._modify(first, [n for n in front if n not in places], fronted=True)
        self._attach(last, arguments, front=places)
        for draft in drafts[:-1]:
            draft.direct = last.direct
        if not (last.direct or last.landmarks) and _trees(arguments, "denial"):
            self.drafts.remove(last)  # "use neither the saw nor the drill"
        if last.verb.stem in section("mutual_verbs") and len(last.direct) == 2 and not last.relations:
            other = last.direct.pop()  # "swap the rope and the hose"
            last.landmarks.append(other)
            last.relations.append(Relation("with", last.direct[0].name, other.name))
        if same is not None and first.verb.stem in section("pro_verbs"):
            self._same(first, same)

    @staticmethod
    def _pronoun(arguments: Sequence[Node]) -> int | None:
        """Return which argument is a pronoun alone."""
        for place, node in enumerate(arguments):
            if isinstance(node, Tree) and node.data == "group":
                phrases = _phrases(node)
                return place if len(phrases) == 1 and phrases[0].pronoun and not phrases[0].lead else None
        return None

    @staticmethod
    def _same(draft: ClauseDraft, before: ClauseDraft) -> None:
        """Read "do the same with the glass" as the clause before, with another object."""
        named = [p for p in draft.landmarks if any(r.target == p.name for r in draft.relations)]
        if not named or not any(p.name in section("same_words") for p in draft.direct):
            return
        old = {p.name for p in before.direct}
        draft.verb.stem, draft.direct, draft.result = before.verb.stem, named, before.result
        draft.landmarks = list(before.landmarks)
        draft.relations = [
            r if r.source not in old else Relation(r.relation, p.name, r.target) for r in before.relations for p in named
        ]
        draft.folds += before.folds

    def _attach(
        self, draft: ClauseDraft, arguments: Sequence[Node], *, front: Sequence[Node] = (), predicate: Sequence[Node] = ()
    ) -> None:
        """Attach arguments from left to right; those in front of a verb, or of a predicate, are said of its objects."""
        state = Attachment(draft)
        self._arguments(state, arguments)
        if predicate and draft.result is not None and state.host:
            state.host[-1].attributes.append(draft.result)  # "nothing wet may stay there"
            draft.result = None
        if predicate:
            state.host = []
            self._arguments(state, predicate)
        for node in front:
            state.host = []
            self._argument(state, node, 0)
        state.finish()
        self._modify(draft, [*arguments, *predicate])

    def _arguments(self, state: Attachment, nodes: Sequence[Node]) -> None:
        for position, node in enumerate(nodes):
            rest = nodes[position + 1 :]
            if not state.gapped(node, rest[0] if rest else None, rest[1] if len(rest) > 1 else None):
                self._argument(state, node, sum(_is(n, "place") for n in rest))

    def _argument(self, state: Attachment, node: Node, later: int) -> None:
        if not isinstance(node, Tree):
            return
        groups = _trees(node.children, "group")
        if node.data == "group":
            state.group(_phrases(node))
        elif node.data == "place":
            state.place(next(leaves(node)), groups, later)
        elif node.data == "exception" and groups:
            state.exception(_phrases(groups[0]))
        elif node.data == "state":
            words = [t.text for t in leaves(node) if t.kind is Kind.STATE]
            state.draft.result = words[-1]

    def _modify(self, draft: ClauseDraft, nodes: Sequence[Node], *, fronted: bool = False) -> None:
        """Add durations, conditions, purposes, relative clauses and prohibitions to a clause."""
        for node in nodes:
            if isinstance(node, Leaf):
                if node.source.kind is Kind.MOD:
                    draft.folds.append(node.source)
            elif node.data == "condition" and self._ordered(draft, node):
                continue
            elif node.data == "condition":
                draft.conditions.append(self._condition(node))
                draft.fronted = draft.fronted or fronted
                draft.written.append(("condition", draft.conditions[-1].text))
            elif node.data == "purpose":
                draft.conditions.append(self._purpose(node))
                draft.written.append(("purpose", draft.conditions[-1].text))
            elif node.data == "relative":
                self._relative(draft, node)
            elif node.data in ("denial", "manner"):
                self._forbid(draft, node)

    def _ordered(self, draft: ClauseDraft, node: Tree[Leaf]) -> bool:
        """Read "after labelling it" and "before putting it away" as instructions, in their order."""
        opener, parts = next(leaves(node)).text, self._parts(node)
        verbs = [next(t for t in leaves(p) if t.kind is Kind.V) for p in parts if any(t.kind is Kind.V for t in leaves(p))]
        if opener not in pairs("order_words") or not verbs or any(v.form != "ing" for v in verbs):
            return False
        events = [d for part in parts for d in self._said(part)]
        at = next(i for i, d in enumerate(self.drafts) if d is draft) + (pairs("order_words")[opener] == "later")
        for event in events:
            event.host, event.verb.sentence = draft, draft.verb.sentence
        self.drafts[at:at] = events
        return True

    def _words(self, node: Tree[Leaf]) -> str:
        spans = [t.span for t in leaves(node)]
        return " ".join(self.text[min(s.start for s in spans) : max(s.end for s in spans)].split()).lower()

    # what subordinate clauses say

    def _condition(self, node: Tree[Leaf]) -> Condition:
        opener = next(leaves(node))
        text = self._words(node)
        clauses = tuple(replace(d.clause(self.text), text=text) for part in self._parts(node) for d in self._said(part))
        return Condition(opener.text, clauses, opener.negated, text)

    def _purpose(self, node: Tree[Leaf]) -> Condition:
        text = self._words(node)
        clauses = []
        for part in self._parts(node):
            for draft in self._said(part):
                if not draft.direct and draft.verb.stem in section("happening"):
                    draft.direct.append(Phrase("it", draft.verb.span.start, False, True))
                clauses.append(replace(draft.clause(self.text), text=text))
        return Condition("to", tuple(clauses), next(leaves(node)).negated, text)

    def _parts(self, node: Tree[Leaf]) -> list[Tree[Leaf]]:
        return _trees(node.children, "part")

    def _said(self, part: Tree[Leaf]) -> list[ClauseDraft]:
        """Return what one part of a subordinate clause says, as clauses: states with *be*, events with their verb."""
        subject = [n for n in part.children if not _is(n, "predicate")]
        predicates = _trees(part.children, "predicate")
        if not predicates:
            return [self._state(subject, [], part)]
        verbal = [n.source for n in predicates[0].children if isinstance(n, Leaf)]
        rest = [n for n in predicates[0].children if isinstance(n, Tree) or n.source.kind is Kind.MOD]
        verbs = [t for t in verbal if t.kind in (Kind.FINITE, Kind.PARTICIPLE, Kind.ING, Kind.V) and t.stem]
        helpers = [t for t in verbal if t.kind is Kind.AUX]
        owns = bool(helpers) and helpers[-1].text in section("having")
        lasting = section("becoming") | section("staying")
        if verbs and verbs[-1].stem in lasting and _trees(rest, "state"):
            return [self._state(subject, rest, part)]
        if verbs and verbs[-1].stem in section("noticed") and _trees(rest, "group"):
            return [self._state([], rest, part)]
        verbs = [v for v in verbs if v.text not in section("loosely")]
        passive = bool(helpers) and helpers[-1].text in section("be")
        if verbs and verbs[-1].kind is Kind.PARTICIPLE and (passive or (not owns and _about_things(subject))):
            return [self._done(subject, v, rest, part) for v in verbs if v.kind is Kind.PARTICIPLE]
        if verbs:
            return [self._event(subject, v, rest, part) for v in verbs if v.kind is not Kind.ING or len(verbs) == 1]
        if owns and _trees(rest, "group"):
            return [self._owned(subject, rest, part)]
        return [self._state(subject, rest, part)]

    def _draft(self, stem: str, node: Tree[Leaf]) -> ClauseDraft:
        tokens = list(leaves(node))
        span = tokens[0].span if tokens else Span(0, 0)
        verb = Token(Kind.V, stem, span, stem=stem, form="base")
        return ClauseDraft(verb, spans=[s for t in tokens for s in (t.span, *t.parts)] or [span])

    def _state(self, subject: Sequence[Node], rest: Sequence[Node], part: Tree[Leaf]) -> ClauseDraft:
        draft = self._draft(BE, part)
        things = [n for n in (*subject, *rest) if _about_things([n])]
        if not things and _trees([*subject, *rest], "state", "place"):
            draft.direct.append(Phrase("it", part_start(part), False, True))
        elif not _about_things(subject) and _about_things(rest):
            draft.verb.form = EXISTS
            subject = [n for n in subject if not _is(n, "group")]
        self._attach(draft, subject, predicate=rest)
        settings = [t for t in draft.folds if t.form == "setting"]
        if draft.result is None and settings and not draft.landmarks:
            draft.result = settings[-1].text  # "until it is two thirds full"
        return draft

    def _done(self, subject: Sequence[Node], verb: Token, rest: Sequence[Node], part: Tree[Leaf]) -> ClauseDraft:
        """*The kettle is filled with water*: a state that a participle names."""
        draft = self._draft(BE, part)
        self._attach(draft, subject, predicate=rest)
        draft.result = verb.text
        draft.verb.lead = [verb.stem]
        return draft

    def _event(self, subject: Sequence[Node], verb: Token, rest: Sequence[Node], part: Tree[Leaf]) -> ClauseDraft:
        """*The water boils* is what *boil the water* brings about; of *when you take it* only the verb counts."""
        draft = self._draft(verb.stem, part)
        draft.spans += verb.parts
        about = subject if _about_things(subject) else [n for n in subject if not _is(n, "group")]
        moved = _about_things(subject) and _trees(rest, "group")
        self._attach(draft, [] if moved else about, predicate=rest)
        return draft

    def _owned(self, subject: Sequence[Node], rest: Sequence[Node], part: Tree[Leaf]) -> ClauseDraft:
        """*The cup has milk in it*: a state with a relation."""
        draft = self._draft(BE, part)
        contents = [p for n in _trees(rest, "group") for p in _phrases(n)]
        if not _about_things(subject):
            self._attach(draft, rest)
            return draft
        self._attach(draft, subject)
        draft.landmarks += contents
        owner = draft.direct[-1].name if draft.direct else None
        draft.relations += [Relation("with", owner, p.name) for p in contents]
        return draft

    def _relative(self, draft: ClauseDraft, node: Tree[Leaf]) -> None:
        """Add what a relative clause says to the noun that it is about."""
        opener = next(leaves(node))
        ahead = [p for p in draft.mentions() if p.place < opener.span.start]
        if not ahead:
            return
        draft.relative = True
        noun = _described(draft, ahead, node)
        for part in self._parts(node):
            for said in self._said(part):
                self._describe(draft, noun, opener, said)

    def _describe(self, draft: ClauseDraft, noun: Phrase, opener: Token, said: ClauseDraft) -> None:
        where = opener.text in section("where_words")
        named = [p for p in said.direct if not p.pronoun]
        denied = "not_" if opener.negated else ""
        if where:
            targets = [("where", p) for p in named]
        elif said.verb.stem == BE and said.result is not None and not named:
            noun.attributes.append(denied + said.result)
            targets = []
        else:
            by_name = {p.name: p for p in said.landmarks}
            held = said.verb.stem in section("holding") or (said.verb.stem == BE and bool(named))
            targets = [("with", p) for p in named if held]
            targets += [(denied + r.relation, by_name[r.target]) for r in said.relations if r.target in by_name and not held]
        for relation, phrase in targets:
            draft.relations.append(Relation(relation, noun.name, phrase.name))
            draft.further[phrase.name] = phrase.said()

    def _forbid(self, draft: ClauseDraft | None, node: Tree[Leaf]) -> None:
        """Record what a denial forbids: a clause of its own, or the verb before it with other arguments."""
        before = len(self.drafts)
        for part in self._parts(node):
            verbs = [t for t in leaves(part) if t.kind is Kind.V]
            if any(_is(n, "predicate") for n in part.children) and (verbs or draft is None or _complement(part)):
                found = self._said(part)
            elif draft is not None:
                copy = self._draft(draft.verb.stem, part)
                copy.verb.form = IMPLIED
                things = list(part.children)
                if not _about_things(things):
                    copy.direct = list(draft.direct)
                self._attach(copy, things)
                if not _trees(things, "place"):
                    copy.landmarks += draft.landmarks
                    names, placed = [p.name for p in copy.direct], {r.relation: r for r in draft.relations if r.source in {p.name for p in draft.direct}}
                    copy.relations += [Relation(r.relation, name, r.target) for r in placed.values() for name in names]
                found = [copy]
            else:
                continue
            for item in found:
                item.mood = Mood.AVOID
                item.verb.form = IMPLIED if not verbs and draft is not None else item.verb.form
                item.spans = [s for t in leaves(node) for s in (t.span, *t.parts)]
                self.forbidden.append((before, item))

    # requests that are no imperatives

    def _verbless(self, nodes: list[Node]) -> None:
        """Read a unit without a verb: prohibitions, demands, statements, and what is only named."""
        rest = []
        last = self.drafts[-1] if self.drafts else None
        for node in nodes:
            if _is(node, "demand", "statement"):
                self._aside(node, [n for n in nodes if _is(n, "condition")])  # type: ignore[arg-type]
            elif _is(node, "denial", "manner"):
                self._forbid(last, node)  # type: ignore[arg-type]
            else:
                rest.append(node)
        asked = any(_is(n, "demand", "statement") for n in nodes)
        denied = self.forbidden[-1][1] if any(_is(n, "denial") for n in nodes) and self.forbidden else None
        if denied is not None and _trees(rest, "group", "place") and not asked:
            self._instead(denied, rest)
        elif _about_things(rest) and not asked:
            self._named(rest)
        elif rest and not asked and self.drafts:
            self._modify(self.drafts[-1], rest)

    def _instead(self, denied: ClauseDraft, nodes: list[Node]) -> None:
        """Read "don't put it on the stove but on the shelf": what stands behind takes the place of what is denied."""
        verb = replace(denied.verb, form="base", span=next(t for n in nodes for t in leaves(n)).span)
        draft = ClauseDraft(verb, spans=[s for n in nodes for t in leaves(n) for s in (t.span, *t.parts)])
        if not _trees(nodes, "group"):
            draft.direct = list(denied.direct)
        self._attach(draft, nodes)
        if not _trees(nodes, "place"):
            draft.landmarks += denied.landmarks
            draft.relations += [Relation(r.relation, p.name, r.target) for r in denied.relations for p in draft.direct]
        self.drafts.append(draft)

    def _aside(self, node: Tree[Leaf], conditions: Sequence[Node] = ()) -> None:
        """Read a statement; with a duty it is a demand."""
        asked = node.data == "demand" or next(leaves(node)).form == DUTY
        denied = next(leaves(node)).negated
        for part in self._parts(node):
            verbal = [n.source for p in _trees(part.children, "predicate") for n in p.children if isinstance(n, Leaf)]
            asked = asked or any(self._asks(t, verbal) for t in verbal)
            if denied and self.drafts and verbal and all(t.kind is Kind.AUX for t in verbal) and not _complement(part):
                self._forbid(self.drafts[-1], node)  # "the cup goes there, the mug does not"
                return
            if not asked:
                drafts = self._said(part)
                self.statements += [(len(self.drafts), d) for d in drafts]
                spans = [t.span for t in leaves(part)]
                span = Span(min(s.start for s in spans), max(s.end for s in spans))
                self.skipped.append(Token(Kind.SKIP, self.text[span.start : span.end], span, note=STATEMENT))
                continue
            for draft in self._demanded(part, denied):
                vague = all(p.pronoun for p in draft.direct)
                if not draft.landmarks and draft.result is None and (draft.verb.stem == BE or (draft.verb.stem == HAVE and vague)):
                    continue
                draft.spans += [t.span for t in leaves(node)]
                self._modify(draft, conditions, fronted=True)
                if draft.mood is Mood.AVOID:
                    self.forbidden.append((len(self.drafts), draft))
                else:
                    self.drafts.append(draft)

    @staticmethod
    def _asks(token: Token, verbal: Sequence[Token]) -> bool:
        """Tell whether a word of a predicate makes it a demand: a duty, "belongs", "would like"."""
        modal = any(t.text in section("modals") for t in verbal)
        wished = modal and (token.stem in section("wishing") or token.text in section("wishful"))
        placed = token.kind in (Kind.FINITE, Kind.V) and token.stem in section("belonging") | section("staying")
        return token.text in section("duties") or wished or placed

    def _demanded(self, part: Tree[Leaf], denied: bool) -> list[ClauseDraft]:
        """Return what brings about a state that is asked for."""
        found = []
        for draft in self._said(part):
            placed = [r for r in draft.relations if r.relation in section("static") | section("arrivals")]
            none = any(p.said().quantifier is Quantifier.NONE for p in draft.direct)
            draft.verb.stem = pairs("demand_verbs").get(draft.verb.stem, draft.verb.stem)
            if draft.verb.stem in section("wishing") or draft.result in section("welcome"):
                draft.verb.stem, draft.verb.form, draft.result = HAVE, IMPLIED, None
            elif draft.verb.stem in section("staying"):
                stays = none or denied
                draft.verb.stem, draft.mood = (BE, None) if stays else (sections()["leaving"][0], Mood.KEEP)
            elif draft.verb.stem == BE and draft.verb.lead:
                draft.verb.stem, draft.result = draft.verb.lead[0], None  # "should be washed"
                draft.mood = Mood.AVOID if denied or none else None
            elif draft.verb.stem == BE and none:
                pass
            elif draft.verb.stem == BE and denied:
                for phrase in draft.direct:
                    phrase.lead = ("no", *phrase.lead)
            elif draft.verb.stem == BE and draft.result in pairs("state_verbs") and draft.verb.form != EXISTS:
                draft.verb.stem, draft.result = pairs("state_verbs")[draft.result], None
            elif draft.verb.stem in section("going") or (draft.verb.stem == BE and placed and not draft.result):
                draft.verb.stem = BE if none or draft.verb.form == EXISTS else PUT
            elif draft.verb.stem == BE and any(t.form == "setting" for t in draft.folds):
                draft.verb.stem = SET
            elif denied:
                draft.mood = Mood.AVOID
            found.append(draft)
        return found

    def _named(self, nodes: list[Node]) -> None:
        """Read "TV on", "lid on the pot", "two scoops of ice cream": the verb was not said."""
        first = next(t for n in nodes for t in leaves(n))
        before = self.drafts[-1] if self.drafts else None
        if before is not None and before.elliptic and all(_is(n, "group") for n in nodes):
            before.direct += [p for n in _trees(nodes, "group") for p in _phrases(n)]  # "TV on, channel two"
            before.spans += [s for n in nodes for t in leaves(n) for s in (t.span, *t.parts)]
            return
        if not self._orders(nodes):
            return
        verb = Token(Kind.V, HAVE, Span(first.span.start, first.span.start), stem=HAVE, form=IMPLIED)
        draft = ClauseDraft(verb, spans=[s for n in nodes for t in leaves(n) for s in (t.span, *t.parts)])
        self._attach(draft, nodes)
        if draft.result in pairs("state_verbs"):
            verb.stem, draft.result, verb.form = pairs("state_verbs")[draft.result or ""], None, "base"
            draft.elliptic = True
        elif any(r.relation in section("bringing") for r in draft.relations):
            verb.stem = BRING
        elif draft.result is not None:
            verb.stem = BE
        elif any(t.form == "setting" for t in draft.folds):
            verb.stem = SET
        self.drafts.append(draft)

    def _orders(self, nodes: Sequence[Node]) -> bool:
        """Tell whether what is only named is asked for: with a state or a place, a number, politely, or by itself."""
        if any(_is(n, "state", "place", "exception") or isinstance(n, Leaf) for n in nodes):
            return True
        lead = [t.text for t in leaves(nodes[0])][:1]
        counted = not section("indefinite").isdisjoint(lead) or any(is_number(word) for word in lead)
        polite = not section("polite").isdisjoint(self.text.lower().replace(",", " ").replace(".", " ").split())
        return counted or polite or (self.alone and sum(1 for n in nodes for _ in leaves(n)) > 1)

    def _carry(self) -> None:
        """A condition in front of a sentence holds for the whole of it."""
        before: ClauseDraft | None = None
        for draft in self.drafts:
            same = before is not None and before.verb.sentence == draft.verb.sentence and before.fronted
            if before is not None and same and not draft.conditions and not draft.verb.otherwise:
                draft.conditions = [replace(c, carried=True) for c in before.conditions if c.word in section("guards")]
                draft.fronted = True
            before = draft


def _complement(part: Tree[Leaf]) -> bool:
    """Tell whether something follows the verb of a statement."""
    return any(isinstance(n, Tree) for p in _trees(part.children, "predicate") for n in p.children)


def part_start(node: Tree[Leaf]) -> int:
    """Return where a node begins in the text."""
    return min(t.span.start for t in leaves(node))


def _about_things(nodes: Sequence[Node]) -> bool:
    """Tell whether some of the nodes is a group that names more than a person."""
    names = (p.name for n in _trees(nodes, "group") for p in _phrases(n))
    return any(name not in PERSONS and name not in section("subjects") for name in names)


def _described(draft: ClauseDraft, ahead: Sequence[Phrase], node: Tree[Leaf]) -> Phrase:
    """Return the noun that a relative clause is about: the last, or the one of which the last says where it is.

    It is that one where only it agrees with the verb ("the cups on the table that are clean"), and where all of them
    are meant ("everything on the floor that is empty") unless the place is where they are to be put, and no other is.
    """
    last = max(ahead, key=lambda phrase: phrase.place)
    placed = {r.source for r in draft.relations if r.target == last.name and r.relation in section("static")}
    head = next((phrase for phrase in reversed(ahead) if phrase.name in placed), None)
    if head is None or last.plural:
        return last
    verbal = next((t.text for t in leaves(node) if t.kind is Kind.AUX), "")
    if verbal in section("plural_forms"):
        return head if head.plural else last
    whole = head.said().quantifier is Quantifier.ALL and not head.plural
    others = (r for r in draft.relations if r.source in (head.name, last.name) and r.target != last.name)
    placing = draft.verb.stem in section("placing") and not any(r.relation in section("static") for r in others)
    return head if whole and not placing else last
