"""Run the LALR clause grammar over tagged tokens. Linear: a token that cannot follow is set aside, not retried."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from importlib.resources import files

from lark import Lark, Tree
from lark import Token as LarkToken
from lark.exceptions import UnexpectedInput
from lark.lexer import Lexer

from tmd.language.tagging.tokens import Kind, Token

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
