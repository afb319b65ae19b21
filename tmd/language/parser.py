"""The front door: text to clauses, with everything that no clause accounts for.

The passes, in order: tokens, repeated runs, first tags, verb or noun, requests that are no imperatives, folds, chunks,
the LALR grammar, attachment, subordinate clauses, antecedents, coverage. Each is linear in the length of the text.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

from tmd.language.clause import Clause, Condition, Mood, Parsed, Relation
from tmd.language.lexicon.coverage import foreign, skipped
from tmd.language.lexicon.lexicon import Lexicon, builtin
from tmd.language.lexicon.word_lists import section
from tmd.language.rewriting.causatives import NEGATED
from tmd.language.rewriting.requests import rewrite_requests
from tmd.language.rewriting.sentences import rewrite_words
from tmd.language.syntax.attachment import ClauseDraft, drafts
from tmd.language.syntax.chunking import chunk
from tmd.language.syntax.grammar import parse_tokens
from tmd.language.syntax.pronouns import resolve, resolve_alone
from tmd.language.syntax.subordinate_folding import fold_subordinates
from tmd.language.syntax.subordinate_reading import (
    Reader,
    condition_words,
    read_condition,
    read_prohibition,
    read_relative,
)
from tmd.language.tagging.first_tags import tag
from tmd.language.tagging.readings import decide
from tmd.language.tagging.tokens import Kind, Token, drop_repeats, tokenise

_HAPPENING = frozenset({"boil", "heat", "warm", "cool", "chill", "dry", "cook", "simmer", "soak", "charge", "melt"})
"""What a thing does by itself when it is put somewhere: to have it do so is what that is for."""
_DEEPEST = 3
"""So deep may subordinate clauses stand in one another."""


class ClauseParser(Protocol):
    """Reads texts as clauses: :func:`parse`, or whatever is given to :func:`tmd.ground.ground` in its place."""

    def __call__(self, text: str, lexicon: Lexicon | None = None) -> Parsed:
        """Read a text; arguments, result and promises are those of :func:`parse`."""


def parse(text: str, lexicon: Lexicon | None = None) -> Parsed:
    """Read a text as verb clauses, C = (ν, [obj], ρ) (section III-A).

    Args:
        text: Any text: run-ons, typos, missing full stops, upper case, segment marks.
        lexicon: Words of the domain besides the built-in ones.

    Returns:
        The clauses in order, what must not be done, and what was skipped with the reason. Never raises for any text.
    """
    return _parse(text, lexicon or builtin(), 0)


def _parse(text: str, words: Lexicon, depth: int) -> Parsed:
    kept, repeated = drop_repeats(tokenise(text))
    for token in repeated:
        token.note = "repeats what was just said"
    strange = foreign(kept, words) if not depth else None
    if strange is not None:
        return Parsed(text, (), strange(text))
    folded = tag(rewrite_words(kept), words)
    decide(folded, words)
    for statement in (t for t in folded if t.kind is Kind.SKIP):
        statement.inner = tag(statement.inner, words)
        decide(statement.inner, words)
    folded = fold_subordinates(rewrite_requests(folded))
    tree, _ = parse_tokens(chunk(folded, words))
    found = drafts(tree)

    def read(inner: str) -> tuple[Clause, ...]:
        return _parse(inner, words, depth + 1).clauses

    if depth < _DEEPEST:
        _read_subordinates(found, words, read)
    clauses = resolve(found, text, [t for t in folded if t.kind is Kind.SKIP])
    constraints, understood = _prohibitions(folded, clauses, text, words, read) if depth < _DEEPEST else ((), [])
    rest = [t for t in (*folded, *repeated) if t not in understood]
    return Parsed(text, clauses, skipped(text, clauses, rest), constraints)


def _read_subordinates(found: Sequence[ClauseDraft], lexicon: Lexicon, read: Reader) -> None:
    """Read what was folded into each clause; a condition in front of a sentence holds for the whole of it."""
    before: ClauseDraft | None = None
    asked: list[Condition] = []
    for draft in found:
        for token in draft.folds:
            if token.form == "condition" and condition_words(token) in (["if", "so"], ["if", "yes"]):
                draft.conditions += asked
                draft.fronted = True
            elif token.form == "condition" and condition_words(token)[1:] == ["there", "is", "any"]:
                continue  # "some sweets, if there are any": where there are none, that is told anyway
            elif token.form == "condition":
                draft.conditions.append(read_condition(condition_words(token), lexicon, read))
                asked = [c for c in draft.conditions if c.word == "if"] or asked
                draft.fronted = draft.fronted or token.span < draft.verb.span
            elif token.form == "purpose":
                words = condition_words(token)
                said = read_condition(["to", *_purpose(words)], lexicon, read)
                draft.conditions.append(replace(said, text=" ".join(words)))
            elif token.form == "relative":
                _add_relative(draft, token, lexicon, read)
        same = before is not None and before.verb.sentence == draft.verb.sentence and before.fronted
        if before is not None and same and not draft.conditions and not draft.verb.otherwise:
            draft.conditions = [replace(c, carried=True) for c in before.conditions if c.word in ("if", "unless")]
            draft.fronted = True
        before = draft


def _purpose(words: list[str]) -> list[str]:
    """The words of a purpose as those of an instruction to somebody."""
    while words and words[0] in ("to", "so", "that", "in", "order", "so_that", "in_order_to", "so_as_to"):
        words = words[1:]
    if len(words) == 1 and words[0] in _HAPPENING:
        words = [*words, "it"]  # "put the kettle on the stove to boil"
    return words if words and words[0] in section("subjects") | section("pronouns") else ["you", *words]


def _add_relative(draft: ClauseDraft, token: Token, lexicon: Lexicon, read: Reader) -> None:
    """Add what a relative clause says to the noun before it."""
    ahead = [phrase for phrase in draft.mentions() if phrase.place < token.span.start]
    if not ahead:
        return
    noun = max(ahead, key=lambda phrase: phrase.place)
    attributes, relations, clause = read_relative(token, lexicon, read)
    noun.attributes += attributes
    for relation, target in relations:
        draft.relations.append(Relation(relation, noun.name, target))
        if clause is not None:
            draft.further[target] = clause.phrase(target)


def _prohibitions(
    tokens: Sequence[Token], clauses: Sequence[Clause], text: str, lexicon: Lexicon, read: Reader
) -> tuple[tuple[Clause, ...], list[Token]]:
    """What must not be done, and the tokens that say so."""
    found: list[Clause] = []
    understood: list[Token] = []
    for token in tokens:
        negated = token.kind is Kind.SKIP and token.note == NEGATED
        manner = token.kind is Kind.MOD and token.form == "manner"
        if not (negated or manner) or not token.inner:
            continue
        before = [clause for clause in clauses if clause.span.start < token.span.start]
        said = read_prohibition(condition_words(token), before[-1] if before else None, lexicon, read)
        found += [
            replace(resolve_alone(c, before), mood=Mood.AVOID, span=token.span, text=text[slice(*token.span)])
            for c in said
        ]
        if said and negated:
            understood.append(token)
    return tuple(found), understood
