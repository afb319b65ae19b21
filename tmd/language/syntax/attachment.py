"""Run the LALR clause grammar over tagged tokens. Linear: a token that cannot follow is set aside, not retried."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files

from lark import Lark, Tree
from lark import Token as LarkToken
from lark.exceptions import UnexpectedInput
from lark.lexer import Lexer

from tmd.language.clause import PERSONS, Clause, Condition, Mood, NounPhrase, Quantifier, Relation, Span
from tmd.language.lexicon.lexicon import section, singular
from tmd.language.syntax.chunking import CHOICE
from tmd.language.syntax.tokens import IMPLIED, NAME, Kind, Token

UNEXPECTED = "does not fit into a clause here"


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


def _leaf(token: Token) -> Leaf:
    leaf = Leaf(token.kind.value, token.text)
    leaf.source = token
    return leaf


def parse_tokens(tokens: list[Token]) -> tuple[Tree[Leaf], list[Token]]:
    """Parse tagged tokens.

    Returns:
        The tree, and the tokens that fitted nowhere.
    """
    parser = _parser().parse_interactive("")
    unexpected = []
    for token in tokens:
        try:
            parser.feed_token(_leaf(token))
        except UnexpectedInput:
            token.note = UNEXPECTED
            unexpected.append(token)
            token.kind = Kind.FILLER
    end = LarkToken("$END", "")
    return parser.feed_token(end), unexpected


_ORIGIN = frozenset({"from", "out_of", "off"})
_NEVER_HOSTS = frozenset({"with", "without", "except", "for", "using", "of", "containing"})
_MULTIPLE = "; "
WHOLES = frozenset({"everything", "anything", "all", "everybody", "both", "each", "every_thing"})
"""Words that mean all there is."""
_ALL = frozenset({"all", "both", "every", "each"})
_OTHERS = frozenset({"other", "another", "others"})
_SOME = frozenset({"some", "any", "few", "several"})
_INDEFINITE = frozenset({"a", "an", "some", "any", "another", "no", "one"})
_DEFINITE = frozenset({"the", "this", "that", "these", "those", "my", "your", "his", "her", "our", "their", "its"})
_DETERMINERS = section("determiners") | section("quantifiers") | _DEFINITE | _INDEFINITE | _ALL
_NUMBERS = ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve")


def number_of(word: str) -> int | None:
    """The number that a word or numeral names, up to twelve in words."""
    if word.isascii() and word.isdigit() and len(word) < 10:
        return int(word)
    if word in ("couple", "pair"):
        return 2
    return _NUMBERS.index(word) if word in _NUMBERS else None


def is_number(word: str) -> bool:
    """Tell whether a word is a number, in figures or in words."""
    return word[:1].isdigit() or word in section("numbers")


@dataclass(slots=True)
class Phrase:
    """A noun phrase: its head's name, what hangs on it with "of", its number as written, and what was said of it.

    ``lead`` are the words before the head, ``attributes`` adjectives behind it, ``either`` the names of which any will
    do.
    """

    name: str
    place: int
    plural: bool
    determined: bool
    pronoun: bool
    quantity: str = ""
    of: list[Phrase] = field(default_factory=list)
    lead: tuple[str, ...] = ()
    either: tuple[str, ...] = ()
    attributes: list[str] = field(default_factory=list)

    def said(self) -> NounPhrase:
        """How it was said."""
        words = (*self.lead, self.name) if self.pronoun or self.name in WHOLES else self.lead
        adjectives = [w for w in self.lead if w not in _DETERMINERS and not is_number(w)]
        if "both" in self.lead and not self.plural and not self.pronoun and not self.of:
            words = tuple(w for w in words if w != "both")  # "both the cup and the mug": one of each
        counted = (w for w in self.lead if is_number(w) and w != "one")
        quantity = self.quantity or next(counted, "")  # "two cups", "two of the cups"
        if self.name in WHOLES or any(w in _ALL for w in words):
            quantifier = Quantifier.ALL
        elif "no" in self.lead or self.name in ("nothing", "none"):
            quantifier = Quantifier.NONE
        elif quantity and number_of(quantity) is not None and number_of(quantity) != 1:
            quantifier = Quantifier.NUMBER
        elif any(w in _OTHERS for w in self.lead):
            quantifier = Quantifier.OTHER
        elif any(w in _SOME for w in self.lead) or (self.lead[:1] == ("one",) and self.plural):
            quantifier = Quantifier.SOME
        else:
            quantifier = Quantifier.PLAIN
        attributes = tuple(dict.fromkeys([*(w for w in adjectives if w not in _OTHERS), *self.attributes]))
        return NounPhrase(
            self.name,
            quantifier,
            number_of(quantity) if quantity else 2 if "both" in words else None,
            any(w in _DEFINITE for w in self.lead)
            or (self.determined and not any(w in _INDEFINITE for w in self.lead)),
            self.plural,
            attributes,
            self.either,
            "each" in words or "every" in words,
        )

    def all(self) -> Iterator[Phrase]:
        """Yield the phrase and everything under it."""
        yield self
        for phrase in self.of:
            yield from phrase.all()


_UNPLACED = frozenset({"of", "with", "where", "except", "besides", "apart_from"})
"""Relations that say of no thing where it shall be."""
_FIRST = re.compile(r"\s+first(?=\s*(?:[.!?;]|$))", re.IGNORECASE)


@dataclass(slots=True)
class ClauseDraft:
    """A clause before pronouns are resolved.

    Attributes:
        verb: The verb token.
        direct: What the verb acts on.
        landmarks: What stands behind prepositions.
        relations: The relation matrix.
        folds: Conditions, durations, purposes.
        spans: Everything that belongs to it.
        conditions: What the folded conditions and purposes say.
        fronted: A condition stands in front of the verb.
        further: Noun phrases that stand in relative clauses.
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

    def mentions(self) -> list[Phrase]:
        """Every phrase in order of mention, each name once."""
        ordered = sorted((p for top in self.direct + self.landmarks for p in top.all()), key=lambda p: p.place)
        return list({p.name: p for p in reversed(ordered)}.values())[::-1]

    def clause(self, text: str) -> Clause:
        """Return the clause without antecedents."""
        span = Span(min(s.start for s in self.spans), max(s.end for s in self.spans))
        last = _FIRST.match(text, span.end)  # "… but rinse it first": it says when
        span = span._replace(end=last.end()) if last else span
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
            mood=self._mood(),
            result=self.verb.lead[-1] if self.verb.lead else None,
            otherwise=self.verb.otherwise,
            implied=self.verb.form == IMPLIED,
            alternative=self.verb.form == CHOICE,
            setting=self._folded(text, "setting"),
            heading=self.verb.heading,
            condition=self._folded(text, "condition"),
            duration=self._folded(text, "duration"),
            purpose=self._folded(text, "purpose"),
        )

    def _mood(self) -> Mood:
        """*Leave the cup where it is* and *keep the door shut* say what must stay so."""
        placed = any(r.relation not in _UNPLACED for r in self.relations)
        if any(phrase.name in WHOLES for phrase in self.direct):
            placed = placed and self.verb.stem != "leave"  # "leave everything else on the table": what is there
        if self.direct and not any(phrase.pronoun for phrase in self.direct):
            there = all(r.target == "it" for r in self.relations if r.relation not in _UNPLACED)
            placed = placed and not (self.verb.stem == "leave" and there)  # "leave the key in there"
        relative = any(t.form == "relative" for t in self.folds)
        placed = placed and self.verb.lead[-1:] != ["alone"]  # "leave the cup on the desk alone"
        if self.verb.stem == "leave" and self.direct and (relative or not placed):
            return Mood.KEEP
        keeps = self.verb.stem == "keep" and (self.verb.lead or self.direct)
        return Mood.KEEP if keeps and not placed else Mood.DO

    def _folded(self, text: str, form: str) -> str | None:
        parts = [" ".join(text[t.span.start : t.span.end].split()) for t in self.folds if t.form == form]
        return _MULTIPLE.join(parts) or None


def drafts(tree: Tree[Leaf]) -> list[ClauseDraft]:
    """Return the clauses of a parse tree in order."""
    result: list[ClauseDraft] = []
    for unit in tree.children:
        if not isinstance(unit, Tree):
            continue
        front: list[Tree[Leaf] | Leaf] = []
        for child in unit.children:
            if isinstance(child, Tree) and child.data == "front":
                front = [c for c in child.children if not (isinstance(c, Tree) and c.data == "group")]
            elif isinstance(child, Tree):
                result.extend(_clause_drafts(child, front))
                front = []
    return result


def _leaves(node: Tree[Leaf] | Leaf) -> Iterator[Token]:
    if isinstance(node, Leaf):
        yield node.source
    elif isinstance(node, Tree):
        for child in node.children:
            yield from _leaves(child)


def _clause_drafts(clause: Tree[Leaf], front: list[Tree[Leaf] | Leaf]) -> list[ClauseDraft]:
    verbs = [t for t in _leaves(clause.children[0]) if t.kind is Kind.V]
    result = [ClauseDraft(verb, spans=[verb.span, *verb.parts]) for verb in verbs]
    last, arguments = result[-1], list(clause.children[1:])
    for node in (*front, *arguments):
        for token in _leaves(node):
            last.spans.extend([token.span, *token.parts])
    first = result[0]
    for node in front:
        _add_fold(first, node)
        first.spans.extend(t.span for t in _leaves(node) if first is not last)
    if first is not last:
        ahead = {t.span for node in front for t in _leaves(node)}
        last.spans = [s for s in last.spans if s not in ahead]
    _attach(last, arguments, [n for n in front if isinstance(n, Tree)])
    for draft in result[:-1]:
        draft.direct = last.direct
    return result


def _add_fold(draft: ClauseDraft, node: Tree[Leaf] | Leaf) -> None:
    if isinstance(node, Leaf) and node.source.kind is Kind.MOD:
        draft.folds.append(node.source)


def _attach(draft: ClauseDraft, arguments: list[Tree[Leaf] | Leaf], front: list[Tree[Leaf]]) -> None:
    state = _Attachment(draft)
    for position, node in enumerate(arguments):
        following = arguments[position + 1] if position + 1 < len(arguments) else None
        beyond = arguments[position + 2] if position + 2 < len(arguments) else None
        if isinstance(node, Tree) and isinstance(following, Tree) and state.gapped(node, following, beyond):
            continue
        if not isinstance(node, Tree):
            _add_fold(draft, node)
        elif node.data == "group":
            state.group(_phrases(node))
        else:
            later = sum(isinstance(n, Tree) and n.data == "place" for n in arguments[position + 1 :])
            state.place(node, later)
    for node in front:
        state.host = []
        state.place(node, 0)
    state.finish()


class _Attachment:
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
        draft = self.draft
        stem = draft.verb.stem
        person = bool(draft.direct) and draft.direct[0].name in PERSONS
        dative = len(draft.direct) == 1 and not self.behind and (person or stem in section("dative_verbs"))
        if dative and not draft.relations:
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

    def place(self, node: Tree[Leaf], later: int) -> None:
        preposition = next(_leaves(node))
        groups = [c for c in node.children if isinstance(c, Tree)]
        if not groups:
            return
        if preposition.form == "also":
            self.host, self.behind = self.earlier
        if name_of(preposition) == "except":
            wholes = [p for p in self.draft.direct if p.said().quantifier is Quantifier.ALL]
            self.host, self.behind = wholes or self.host, ""
        self.earlier = self.host, self.behind
        name = name_of(preposition)
        targets = _phrases(groups[0])
        within = self.behind == "with" and len(targets) == 1 and targets[0].name in ("it", "them")
        if within and name in ("in", "on", "inside"):
            return
        self.draft.landmarks.extend(targets)
        self._of(targets)
        paired, self.paired = self.paired, False
        if self.host and (paired or self._hosted(name, targets)):
            self.draft.relations.extend(Relation(name, s.name, t.name) for s in self.host for t in targets)
        else:
            self.pending.append((name, targets))
        if paired and name in _ORIGIN:
            self.paired = True  # where it goes is still to come
            return
        if preposition.form == "relative":
            chained = later > 1 or self.draft.verb.stem not in section("placing")
            self.host = targets if chained else self.host
            return
        self.instrument = self.instrument or name == "with"
        if self._tells_one() and self.draft.verb.stem in section("placing"):
            self.host, self.behind = [], name  # "except the one on the chair | on the shelf"
            return
        self.behind = name
        told = targets[0].name in ("one", "ones") and bool(targets[0].lead)  # "but the one on the shelf", not "but one"
        if (name not in _NEVER_HOSTS or told) and targets[0].name not in PERSONS:
            self.host = targets

    def gapped(self, node: Tree[Leaf], following: Tree[Leaf], beyond: Tree[Leaf] | Leaf | None) -> bool:
        """Read "the cups on the table and the books on the shelf": the second pair stands for itself."""
        if node.data != "place" or following.data != "place":
            return False
        groups = [c for c in node.children if isinstance(c, Tree)]
        phrases = _phrases(groups[0]) if groups else []
        same = next(_leaves(node)).text == next(_leaves(following)).text
        if len(phrases) < 2 or not self.draft.direct:
            return False
        bare = phrases[0].determined and not phrases[-1].determined and not self.draft.direct[0].determined
        opposite = [p for c in following.children if isinstance(c, Tree) for p in _phrases(c)]
        # "crisps in one bowl and nuts in the other"
        bare = bare or any(word in _OTHERS for p in opposite for word in p.lead)
        last = following
        if next(_leaves(following)).text in _ORIGIN and isinstance(beyond, Tree) and beyond.data == "place":
            last = beyond  # "the pillow from the floor onto the sofa"
        place = next(_leaves(last)).text in section("static") | {"into", "onto"}
        other = self.draft.verb.stem in section("placing") and place
        if not (phrases[-1].determined or bare) or not (same or other):
            return False
        name, moved = next(_leaves(node)).text, phrases[-1]
        sources = list(self.host if self.paired else self.draft.direct)
        self.draft.landmarks.extend(phrases[:-1])
        self.draft.relations.extend(Relation(name, s.name, t.name) for s in sources for t in phrases[:-1])
        self._of(phrases)
        self.draft.direct.append(moved)
        self._flush(sources)
        self.host, self.behind, self.paired = [moved], "", True
        return True

    def _hosted(self, name: str, targets: list[Phrase]) -> bool:
        """Tell whether a preposition stands beside the noun before it rather than the direct object."""
        stem = self.draft.verb.stem
        if self._tells_one() and name in ("with", "on", "in", "from"):
            return True  # "except the one with the handle": what stands behind it says which one
        if name == "with" and any(_is_tool(t.name) for t in targets):
            held = stem in section("moving") | section("placing") | section("dative_verbs")
            return self.instrument or (held and not self.behind)
        if name == "by" and not any(t.determined or t.pronoun for t in targets):
            return False
        if name == "with":
            return stem.partition("_")[0] not in section("with_verbs") or self.instrument
        if name == "except":
            return True
        if name not in section("static") and name != "of":
            return False
        return not (self.behind in _ORIGIN and (stem in section("placing") or stem in ("have", "get", "bring")))

    def _tells_one(self) -> bool:
        """Tell whether what comes now says which *one* is meant."""
        return bool(self.behind) and all(p.name in ("one", "ones") for p in self.host)

    def finish(self) -> None:
        self._flush(self.draft.direct)

    def _flush(self, direct: list[Phrase]) -> None:
        sources: list[str | None] = [p.name for p in direct] or [None]
        for name, targets in self.pending:
            self.draft.relations.extend(Relation(name, s, t.name) for t in targets for s in sources)
        self.pending.clear()


def name_of(preposition: Token) -> str:
    """The preposition that *except for* and the like stand for."""
    return "except" if preposition.text in ("except", "except_for", "apart_from", "other_than") else preposition.text


def _is_tool(name: str) -> bool:
    return name in section("tools") or name.rpartition("_")[2] in section("tools")


def _phrases(group: Tree[Leaf]) -> list[Phrase]:
    phrases = [_phrase(node) for node in group.children if isinstance(node, Tree)]
    if any(isinstance(n, Leaf) and n.source.form == CHOICE for n in group.children):
        names = tuple(phrase.name for phrase in phrases)
        for phrase in phrases:
            phrase.either = names
    result: list[Phrase] = []
    for phrase in phrases:
        host = result[-1] if result else None
        if host is not None and host.of and host.name in section("inner_and") and not phrase.determined:
            host.of.append(phrase)
        else:
            result.append(phrase)
    return result


def _phrase(node: Tree[Leaf]) -> Phrase:
    chain: list[Phrase] = []
    lead: list[Token] = []
    for child in node.children:
        if isinstance(child, Leaf):
            lead.append(child.source)
        elif isinstance(child, Tree):
            phrase = _head(child, lead)
            if chain:
                chain[-1].of.append(phrase)
            chain.append(phrase)
            lead = []
    return chain[0]


def _head(node: Tree[Leaf], lead: list[Token]) -> Phrase:
    words = list(_leaves(node))
    written = "_".join(t.text for t in words)
    pronoun = words[-1].kind is Kind.PRON
    as_written = pronoun or words[-1].form == NAME
    name = "one" if written == "ones" else written if as_written else singular(written)
    quantity = next((t.text for t in reversed(lead) if t.kind is Kind.NUM), "")
    determined = any(t.kind is Kind.DET for t in lead)
    said = tuple(words[0].lead) or tuple(t.text for t in lead if t.kind in (Kind.DET, Kind.NUM))
    if len(words) > 1 and words[-1].text in ("one", "ones"):
        # "the white one": what was spoken of, and which of it
        said = (*said, *(t.text for t in words[:-1]))
        name = "_".join([*(t.text for t in words[:-1]), "one"])
        return Phrase(name, words[0].span.start, words[-1].text == "ones", determined, True, quantity, lead=said)
    return Phrase(name, words[0].span.start, name != written, determined, pronoun, quantity, lead=said)
