"""The clause grammar over the words of a text (``clauses.lark``), and how to look at its trees."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache
from importlib.resources import files
from typing import TypeGuard

from lark import Lark, Tree
from lark import Token as LarkToken
from lark.exceptions import UnexpectedInput

from tmd.language.clause import Span
from tmd.language.syntax.tokens import Token

UNEXPECTED = "does not fit into a clause here"


@cache
def _parser() -> Lark:
    """Return the parser, which is fed token by token."""
    grammar = (files("tmd.language.syntax") / "clauses.lark").read_text(encoding="utf-8")
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
