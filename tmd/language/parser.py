"""The front door: text to clauses, with everything that no clause accounts for.

The passes, in order: tokens, repeated runs, first tags, verb or noun, folds, chunks, the LALR grammar,
attachment, antecedents, coverage. Each is linear in the length of the text.
"""

from __future__ import annotations

from tmd.language.attachment import drafts
from tmd.language.chunking import chunk
from tmd.language.clause import Parsed
from tmd.language.coverage import foreign, skipped
from tmd.language.folding import fold_subordinates
from tmd.language.grammar import parse_tokens
from tmd.language.lexicon import Lexicon, builtin
from tmd.language.pronouns import resolve
from tmd.language.readings import decide
from tmd.language.tagging import tag
from tmd.language.tokens import drop_repeats, tokenise


def parse(text: str, lexicon: Lexicon | None = None) -> Parsed:
    """Read a text as verb clauses, C = (ν, [obj], ρ) (section III-A).

    Args:
        text: Any text: run-ons, typos, missing full stops, upper case, segment marks.
        lexicon: Words of the domain besides the built-in ones.

    Returns:
        The clauses in order, and what was skipped with the reason. Never raises for any text.
    """
    words = lexicon or builtin()
    kept, repeated = drop_repeats(tokenise(text))
    for token in repeated:
        token.note = "repeats what was just said"
    strange = foreign(kept, words)
    if strange is not None:
        return Parsed(text, (), strange(text))
    folded = tag(kept, words)
    decide(folded, words)
    folded = fold_subordinates(folded)
    tree, _ = parse_tokens(chunk(folded, words))
    found = drafts(tree)
    clauses = resolve(found, text)
    return Parsed(text, clauses, skipped(text, clauses, [*folded, *repeated]))
