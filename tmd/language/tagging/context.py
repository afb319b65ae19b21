"""What the choice between verb and noun looks at: the sentence so far and the tokens around a word."""

from __future__ import annotations

from dataclasses import dataclass

from tmd.language.tagging.tokens import Kind, Token

ARTICLES = frozenset({Kind.DET, Kind.PRON})
OPENERS = frozenset({Kind.DET, Kind.PRON, Kind.NUM, Kind.ADJ})
DATIVE = frozenset({"me", "us", "him", "her", "you"})
SERIAL = frozenset({"go", "come", "run", "help", "hurry"})


@dataclass(slots=True)
class State:
    """What the pass remembers of the sentence so far."""

    sub: bool = False
    """Inside a condition or relative clause whose own verb has not come yet."""
    nominal: bool = False
    """... and whose subject has come."""
    narrative: bool = False
    """The sentence tells what somebody does: "she takes the cup"."""
    let: bool = False
    verb: bool = False
    """An instruction verb has come."""

    def close(self) -> None:
        """Leave the condition or relative clause."""
        self.sub = self.nominal = False


def next_token(tokens: list[Token], at: int, step: int = 1) -> Token | None:
    """Return the next token that is no adverb, or the one ``step`` further."""
    for token in tokens[at + 1 : at + 8]:
        if token.kind is not Kind.ADV:
            step -= 1
            if step == 0:
                return token
    return None


def helped(tokens: list[Token], at: int) -> list[Token]:
    """Return "help me" right before a verb: the verb behind it is what counts."""
    lead = tokens[max(0, at - 2) : at]
    helps = len(lead) == 2 and lead[0].kind is Kind.V and lead[0].stem == "help"
    return lead if helps and lead[1].text in DATIVE else []
