"""The clause grammar (``clauses.lark``): its terminals, the parser, and its trees.

:class:`Linker` gives each comma and conjunction its class: between nouns or states, verbs, parts of a clause, or units.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache
from importlib.resources import files
from typing import TypeGuard

from lark import Lark, Tree
from lark import Token as LarkToken
from lark.exceptions import UnexpectedInput

from tmd.language.clause import Span
from tmd.language.lexicon.lexicon import section
from tmd.language.syntax.brackets import ALONE, ALSO
from tmd.language.syntax.tokens import HEADS, LINKS, NP, OPENERS, VERBAL, Kind, Token, Words

K = Kind
UNEXPECTED = "does not fit into a clause here"
CHOICE = "choice"
"""The form of what "or" joins to what stands before it."""
_FOLLOWERS = {K.CONJ: NP | {K.STATE}, K.VCC: VERBAL, K.LINK: NP | VERBAL | OPENERS | {K.STATE, K.P, K.MOD, K.EXC}}
"""What may stand behind a joint."""


class Linker(Words):
    """One pass over bracketed words; returns the terminals of the clause grammar."""

    def __init__(self, tokens: list[Token]) -> None:
        """Take bracketed words."""
        super().__init__(tokens)
        self.out: list[Token] = []
        self._open: list[bool] = []
        """For each open bracket, whether its predicate has come."""
        self._fronted = True
        """No verb has come since the last separator."""

    def run(self) -> list[Token]:
        """Return the terminals of the clause grammar."""
        at = 0
        while at < len(self.tokens):
            token = self.tokens[at]
            if token.kind in LINKS:
                at = self._decide(at)
                continue
            if token.kind in OPENERS:
                self._open.append(False)
            elif token.kind is K.END and self._open:
                self._open.pop()
            elif self._open and token.kind in VERBAL:
                self._open[-1] = True
            elif token.kind in (K.V, K.SEP):
                self._fronted = token.kind is K.SEP
            self.out.append(token)
            at += 1
        return self._without_dangling()

    def _decide(self, at: int) -> int:
        end = self.past(at, "LINKS*")
        links, after = self.tokens[at:end], self.kind(end) if end < len(self.tokens) else K.SEP
        link, before = links[0], self.out[-1].kind if self.out else K.SEP
        if any(self.among(place, "choices") for place in range(at, end)):
            link.form = CHOICE
            if after is K.V:
                self.tokens[end].form = CHOICE
        joined = any(t.kind is K.CC for t in links)
        kind = self._inner(before, after, end) if self._open else self._outer(before, after, end, joined=joined)
        if kind is not None:
            if any(t.form == ALSO or t.text in section("then_words") for t in links):
                link.form = ALSO
            link.kind = kind
            self.out.append(link)
            self._fronted = self._fronted or kind is K.SEP
        return end

    def _inner(self, before: Kind, after: Kind, end: int) -> Kind | None:
        """Classify a link inside of a subordinate clause."""
        if after in (K.END, K.SEP, K.EXC) or before in OPENERS:
            return None
        if before in VERBAL and after in VERBAL:
            return K.VCC
        if before is K.STATE and after is K.STATE:
            return K.CONJ
        predicate = self._open[-1]
        if after is K.SUB and predicate:
            return None  # "the box belongs there, with the lid shut"
        if before in HEADS and after in NP:
            if not predicate:
                return None if self._place_in_front() else K.CONJ  # "apart from the red cup, all the cups"
            if not self.follows(end, "(NP|OF|P)* (VERBAL|STATE)"):
                return K.CONJ
        elif after is K.P:
            self.tokens[end].form = ALSO
            return None
        self._open[-1] = False
        return K.LINK

    def _outer(self, before: Kind, after: Kind, end: int, *, joined: bool) -> Kind | None:
        """Classify a link between the parts of a unit."""
        if after in (K.V, K.LET):
            return self._before_verb(before, after, end, joined=joined)
        if not self._fronted and after is K.SUB and self._condition_of_next(end):
            self._fronted = True
            return K.SEP
        if after in (K.SAY, K.ENSURE) or (after is K.P and self.follows(end + 1, "(NP|OF)* COMMA V")):
            return K.SEP
        if after is K.P and joined:
            self.tokens[end].form = ALSO
        return self._between_things(before, after, end)

    def _between_things(self, before: Kind, after: Kind, end: int) -> Kind | None:
        """Classify a link between things or states: "a cup and a mug", "TV on, lamp off"."""
        if after not in NP:
            return None
        if before not in HEADS:
            return K.SEP if self._ends_part(before, end) else None
        then = not self._fronted and self.among(end - 1, "then_words") and not self.among(end, "other_words")
        apart = then or self._state_of_its_own(end) or self._verbless(end)
        return K.SEP if apart else K.CONJ

    def _ends_part(self, before: Kind, end: int) -> bool:
        """Return whether a link behind something else than a thing begins a part of its own."""
        if before is K.END and not self._fronted and self.follows(end, "(NP|OF)+ P"):
            self.tokens[end - 1].form = ALSO  # "the book where the pen is, and the cup on the shelf"
        if before is K.MOD:  # "lamp on high, the other lamp off"
            return self._fronted and self._state_of_its_own(end)
        # "lid on, kettle in the sink"
        return before in (K.P, K.STATE) or (before is K.END and self.tokens[end - 1].form == ALSO)

    def _state_of_its_own(self, at: int) -> bool:
        """Return whether a thing with its state follows: "… in the chest, the lid closed"; not "leave both open"."""
        unit = self._unit()
        shared = any(t.kind is K.V and t.stem in section("result_verbs") for t in unit)
        shared = shared and not any(t.kind in (K.STATE, K.P) for t in unit)
        return self.follows(at, "NP+ (P NP+)* (STATE|MOD) (BREAK|SUB)") and not shared

    def _before_verb(self, before: Kind, after: Kind, end: int, *, joined: bool) -> Kind | None:
        if self._fronted:
            # "the lid on, shake it"; but not "the cup on the shelf, wash it"
            said = joined or self.kind(end + 1) is not K.PRON or before in (K.P, K.STATE)
            return K.SEP if said and self._named(joined=joined) else None
        if before is not K.V or after is not K.V:
            return K.SEP
        last = self.out[-1]
        alone = last.told or last.form == ALONE or last.stem in section("intransitive")
        return K.SEP if alone else K.VCC

    def _unit(self) -> list[Token]:
        """Return what has come of the open unit or bracket."""
        start = len(self.out)
        while start and self.out[start - 1].kind not in OPENERS | {K.SEP, K.END}:
            start -= 1
        return self.out[start:]

    def _place_in_front(self) -> bool:
        """Return whether only a prepositional phrase has come."""
        unit = self._unit()
        return bool(unit) and unit[0].kind in (K.P, K.EXC)

    def _named(self, *, joined: bool) -> bool:
        """Return whether the open unit asks for something: "a glass of milk, and shut the fridge".

        Where nothing joins it to what follows, it adds a place or a state: "eggs in the pot, boil".
        """
        behind = named = False
        for token in self._unit():
            named = named or (token.kind in HEADS and not behind)
            if named and (joined or token.kind in (K.P, K.STATE, K.MOD)):
                return True
            behind = token.kind in (K.P, K.EXC) or (behind and token.kind in NP | {K.OF, K.CONJ})
        return False

    def _condition_of_next(self, at: int) -> bool:
        """Return whether a condition belongs to the verb behind it: "take the cup and, if it is dirty, wash it"."""
        depth = 0
        for place in range(at, len(self.tokens)):
            depth += (self.kind(place) in OPENERS) - (self.kind(place) is K.END)
            if not depth:
                return self.follows(place + 1, "LINKS* (V|LET)")
        return False

    def _verbless(self, at: int) -> bool:
        """Return whether two parts without verbs are joined: "milk in the cup, sugar in the bowl"."""
        said = [t for t in self._unit() if t.kind in (K.P, K.STATE)] if self._fronted else []
        together = bool(said) and said[-1].text in section("with_words")  # "a tea with milk and sugar in a mug"
        return bool(said) and not together and self.follows(at, "(NP|OF|MOD|EXC|ADV)* (P|STATE)")

    def _without_dangling(self) -> list[Token]:
        """Drop joints, determiners, numerals, adjectives and "of" without what must stand behind them."""
        backwards: list[Token] = []
        for at in range(len(self.out) - 1, -1, -1):
            token, following = self.out[at], backwards[-1].kind if backwards else K.STOP
            if following not in _FOLLOWERS.get(token.kind, {following}):
                continue
            if token.kind in (K.DET, K.NUM, K.ADJ, K.OF) and following not in NP:
                if at and self.out[at - 1].kind is K.V:
                    self.out[at - 1].form = ALONE
                continue
            backwards.append(token)
        return backwards[::-1]


# -- the parser and its trees ----------------------------------------------------------------------------------------


@cache
def _parser() -> Lark:
    """Return the parser, which is fed token by token."""
    grammar = (files("tmd.language.data") / "clauses.lark").read_text(encoding="utf-8")
    return Lark(grammar, start="text", parser="lalr")


class Leaf(LarkToken):
    """A lark token that carries ours."""

    __slots__ = ("source",)
    source: Token


Node = Tree[Leaf] | Leaf


def parse_tokens(tokens: list[Token]) -> Tree[Leaf]:
    """Parse the terminals of the grammar. A token that cannot follow is noted and left out. Linear."""
    parser, fed = _parser().parse_interactive(""), []
    for token in tokens:
        leaf = Leaf(token.kind.value, token.text)
        leaf.source = token
        try:
            parser.feed_token(leaf)
            fed.append(token)
        except UnexpectedInput:
            token.note = token.note or UNEXPECTED
    try:
        tree: Tree[Leaf] = parser.feed_token(LarkToken("$END", ""))
    except UnexpectedInput:
        fed[-1].note = UNEXPECTED  # "the small" at the end of a text, and no noun
        return parse_tokens(fed[:-1])
    return tree


def leaves(node: Node) -> Iterator[Token]:
    """Yield the tokens under a node, in order."""
    if isinstance(node, Leaf):
        yield node.source
    else:
        for child in node.children:
            yield from leaves(child)


def is_a(node: Node, *names: str) -> TypeGuard[Tree[Leaf]]:
    """Return whether a node is a rule of one of these names."""
    return isinstance(node, Tree) and node.data in names


def trees(nodes: Sequence[Node], *names: str) -> list[Tree[Leaf]]:
    """Return those of the nodes that are rules of one of these names."""
    return [n for n in nodes if is_a(n, *names)]


def spans(nodes: Sequence[Node]) -> list[Span]:
    """Return the places of the words under some nodes, with those that belong to them."""
    return [span for node in nodes for token in leaves(node) for span in (token.span, *token.parts)]
