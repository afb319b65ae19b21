"""What a subordinate clause says: conditions, events, purposes, prohibitions and relative clauses, as clauses.

Each is turned into an imperative or a statement with *be* and read by the parser again: *when you have taken the cup
out* says (take, [cup]), *if the window is open* says (be, [window]) with the result ``open``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from tmd.language.clause import Clause, Condition, Mood, Relation
from tmd.language.lexicon.lexicon import Lexicon
from tmd.language.lexicon.words import section
from tmd.language.syntax.attachment import ClauseDraft
from tmd.language.syntax.pronouns import resolve_alone
from tmd.language.syntax.subordinate_folding import NEGATED
from tmd.language.syntax.tokens import Kind, Token

BE = "be"
Reader = Callable[[str], tuple[Clause, ...]]
"""Reads a text as clauses."""

_BE = frozenset(
    {"is", "are", "was", "were", "be", "been", "am", "isn't", "aren't", "wasn't", "weren't", "stays", "looks", "seems"}
)
_STANDS = frozenset({"stands", "stand", "lies", "lie", "sits", "sit", "lying", "standing", "sitting", "hangs"})
_HAVE = frozenset({"has", "have", "had", "hasn't", "haven't", "having"})
_BECOME = frozenset({"gets", "becomes", "turns", "get", "become", "turn"})
_YOU = frozenset({"you", "we", "i", "you've", "we've", "i've", "you're", "you'll"})
_NOT = frozenset(
    {
        "not",
        "no",
        "never",
        "neither",
        "nor",
        "don't",
        "dont",
        "doesn't",
        "didn't",
        "without",
        "cannot",
        "can't",
        "won't",
    }
)
_HELPERS = frozenset(
    {"do", "does", "did", "will", "would", "can", "could", "should", "must", "may", "to", "please", "just", "already",
     "then", "ever", "also", "still", "got", "i'd", "we'd", "rather", "you", "we", "i", "the_robot", "need", "want"}
)  # fmt: skip
_SOFT = frozenset(
    {"already", "still", "just", "yet", "too", "very", "really", "all", "enough", "now", "completely", "nice", "and"}
)
_NOTICE = frozenset({"see", "find", "notice", "spot", "discover"})
"""What you see is there."""
_POSTURE = frozenset({"left", "standing", "lying", "sitting", "around", "about", "somewhere", "remaining"})
_HAPPENING = frozenset({"boil", "heat", "warm", "cool", "chill", "dry", "cook", "simmer", "soak", "charge", "melt"})
"""What a thing does by itself when it is put somewhere: to have it do so is what that is for."""
_DETERMINED = section("determiners") | section("quantifiers")


def read_subordinates(found: Sequence[ClauseDraft], lexicon: Lexicon, read: Reader) -> None:
    """Read what was folded into each clause; a condition in front of a sentence holds for the whole of it."""
    before: ClauseDraft | None = None
    asked: list[Condition] = []
    for draft in found:
        for token in draft.folds:
            if token.form == "condition" and _condition_words(token) in (["if", "so"], ["if", "yes"]):
                draft.conditions += asked
                draft.fronted = True
            elif token.form == "condition" and _condition_words(token)[1:] == ["there", "is", "any"]:
                continue  # "some sweets, if there are any": where there are none, that is told anyway
            elif token.form == "condition":
                draft.conditions.append(_read_condition(_condition_words(token), lexicon, read))
                asked = [c for c in draft.conditions if c.word == "if"] or asked
                draft.fronted = draft.fronted or token.span < draft.verb.span
            elif token.form == "purpose":
                words = _condition_words(token)
                said = _read_condition(["to", *_purpose(words)], lexicon, read)
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
    attributes, relations, clause = _read_relative(token, lexicon, read)
    noun.attributes += attributes
    for relation, target in relations:
        draft.relations.append(Relation(relation, noun.name, target))
        if clause is not None:
            draft.further[target] = clause.phrase(target)


def read_prohibitions(
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
        said = _read_prohibition(_condition_words(token), before[-1] if before else None, lexicon, read)
        found += [
            replace(resolve_alone(c, before), mood=Mood.AVOID, span=token.span, text=text[slice(*token.span)])
            for c in said
        ]
        if said and negated:
            understood.append(token)
    return tuple(found), understood


def _read_condition(words: Sequence[str], lexicon: Lexicon, read: Reader) -> Condition:
    """Return what the words of a subordinate clause say; without clauses where it is not understood.

    Args:
        words: Its words, the first of which opens it.
        lexicon: The words of the domain.
        read: The parser.
    """
    if words[0] == "with" and len(words) > 2:
        return Condition("with", _state(list(words[1:-1]), [words[-1]], lexicon, read), False, " ".join(words))
    opener, rest = words[0], [w for w in words[1:] if w not in ("that", ",")]
    text = " ".join(words)
    if len(rest) == 2 and rest[0] == "its":
        rest = ["it's", rest[1]]  # as people write it: "when its done"
    rest = [part for word in rest for part in _expanded(word)]
    negated = any(w in ("not", "no", "never") or w.endswith("n't") for w in rest)
    plain = [w for w in rest if w not in ("not", "never") and w not in ("any",)]
    plain = ["any" if w == "no" else w for w in plain]
    clauses = _said(plain, lexicon, read) if plain else ()
    return Condition(opener, tuple(replace(clause, text=text) for clause in clauses), negated, text)


def _expanded(word: str) -> list[str]:
    for ending, full in (("n't", "not"), ("'s", "is"), ("'re", "are"), ("'ve", "have")):
        if word.endswith(ending) and word != ending:
            stem = word.removesuffix(ending)
            return [{"ca": "can", "wo": "will"}.get(stem, stem), full]
    return [word]


def _said(words: list[str], lexicon: Lexicon, read: Reader) -> tuple[Clause, ...]:
    if words[0] == "there" and len(words) > 2:
        return _named(_without_posture(words[2:]), read)
    copula = next((i for i, w in enumerate(words) if w in _BE), None)
    if words[0] in _YOU:
        return _done_by_you(words[1:], lexicon, read)
    if copula is not None and words[copula - 1 : copula] and words[copula - 1] in _HAVE:
        words = [*words[: copula - 1], *words[copula:]]
        copula -= 1
    if copula:
        return _state(words[:copula], words[copula + 1 :], lexicon, read)
    if copula == 0:
        return _state([], words[1:], lexicon, read)
    having = next((i for i, w in enumerate(words) if w in _HAVE), None)
    if having:
        return _having(words[:having], words[having + 1 :], lexicon, read)
    first = lexicon.verb(words[0])
    if words[0].endswith("ing") and first is not None:
        return read(" ".join([_imperative(first[0]), *words[1:]]))
    finite = next((i for i, w in enumerate(words) if i and _finite(w, lexicon)), None)
    if finite is not None:
        return _event(words[:finite], words[finite:], lexicon, read)
    last = lexicon.verb(words[-1])
    if len(words) > 1 and last is not None and last[1] == "s":
        return _event(words[:-1], words[-1:], lexicon, read)  # "when the kettle whistles"
    if len(words) == 1 or words[0] in _SOFT:
        return _state([], words, lexicon, read)
    return _named(words, read)


def _done_by_you(words: list[str], lexicon: Lexicon, read: Reader) -> tuple[Clause, ...]:
    while words and words[0] in _HELPERS | {"had", "are", "is"}:
        words = words[1:]
    if words and words[0] in _HAVE:
        words = words[1:]
        if (words and lexicon.verb(words[0]) is None) or (words and words[0] in _DETERMINED):
            return _named(words, read)
    found = lexicon.verb(words[0]) if words else None
    if found and found[0] in _NOTICE and len(words) > 1:
        return _named(words[1:], read)
    return read(" ".join([_imperative(found[0]), *words[1:]])) if found else ()


def _without_posture(words: list[str]) -> list[str]:
    """The words of what is there, without *already* before and *standing around* behind them."""
    while words and words[0] in _SOFT - {"all", "enough"}:
        words = words[1:]
    while len(words) > 1 and words[-1] in _POSTURE:
        words = words[:-1]
    return words


def _imperative(stem: str) -> str:
    return stem.replace("_", " ")


def _named(words: list[str], read: Reader) -> tuple[Clause, ...]:
    """That something is there."""
    found = read(" ".join(["find", *words]))
    return (replace(found[0], verb=BE),) if found else ()


def _state(subject: list[str], complement: list[str], lexicon: Lexicon, read: Reader) -> tuple[Clause, ...]:
    while complement and complement[0] in _SOFT:
        complement = complement[1:]
    while complement and complement[-1] in _SOFT and len(complement) > 1:
        complement = complement[:-1]
    if not complement:
        return ()
    subject = subject or ["it"]
    switch = complement[0] in ("on", "off", "out", "over", "up", "down") and len(complement) == 1
    if not switch and complement[0] in section("prepositions") | {"next_to", "on_top_of", "out_of", "in_front_of"}:
        found = read(" ".join(["put", *subject, *(c.replace("_", " ") for c in complement)]))
        return (replace(found[0], verb=BE),) if found else ()
    found = read(" ".join(["find", *subject]))
    if not found:
        return ()
    past = lexicon.verb(complement[0])
    if past is not None and past[1] == "ed" and complement[0] not in section("drop_adjectives") | {"shut", "open"}:
        return (replace(found[0], verb=BE, result=complement[0]),)
    return (replace(found[0], verb=BE, result=complement[-1] if len(complement) < 3 else complement[0]),)


def _having(subject: list[str], rest: list[str], lexicon: Lexicon, read: Reader) -> tuple[Clause, ...]:
    """*It has boiled* is an event, *the cup has milk in it* a state."""
    found = lexicon.verb(rest[0]) if rest else None
    if found is not None and found[1] == "ed" and rest[0] not in _DETERMINED:
        return _event(subject, [found[0], *rest[1:]], lexicon, read)
    owner, thing = read(" ".join(["find", *subject])), read(" ".join(["find", *rest]))
    if not owner or not thing or not owner[0].objects or not thing[0].objects:
        return ()
    content = thing[0].objects[0]
    relation = Relation("with", owner[0].objects[0], content)
    phrases = {**owner[0].phrases, content: thing[0].phrase(content)}
    names = (owner[0].objects[0], content)
    return (replace(owner[0], verb=BE, objects=names, relations=(relation,), phrases=phrases),)


def _finite(word: str, lexicon: Lexicon) -> bool:
    found = lexicon.verb(word)
    return found is not None and (found[1] in ("s", "ed") or word in _BECOME) and found[2] > 1


def _event(subject: list[str], words: list[str], lexicon: Lexicon, read: Reader) -> tuple[Clause, ...]:
    """*The water boils* is what *boil the water* brings about."""
    if words[0] in _BECOME and len(words) > 1:
        return _state(subject, words[1:], lexicon, read)
    found = lexicon.verb(words[0])
    if found is None:
        return ()
    return read(" ".join([_imperative(found[0]), *subject, *words[1:]]))


def _read_prohibition(
    words: Sequence[str], before: Clause | None, lexicon: Lexicon, read: Reader
) -> tuple[Clause, ...]:
    """Return what must not be done; empty where it is not understood.

    Args:
        words: The words of the prohibition.
        before: The clause before it: *… in the bowl, not in the pot*.
        lexicon: The words of the domain.
        read: The parser.
    """
    parts = [part for word in words for part in _expanded(word)]
    parts = ["and" if part == "nor" and i else part for i, part in enumerate(parts)]
    at = next((i for i, w in enumerate(parts) if w in _NOT or w == "avoid"), None)
    if at is None:
        return ()
    rest = parts[at + 1 :]
    while rest and rest[0] in _HELPERS:
        rest = rest[1:]
    if not rest:
        return ()
    found = lexicon.verb(rest[0])
    if any(w in _BE for w in rest[1:]):
        return _said(["any", *rest] if parts[at] in ("no", "neither") else rest, lexicon, read)
    if rest[0] in section("prepositions") and before is not None:
        objects = [f"the {name.replace('_', ' ')}" for name in before.direct] or ["it"]
        said = read(" ".join([_imperative(before.verb), " and ".join(objects), *rest]))
        return tuple(replace(clause, implied=True) for clause in said)
    if found is not None and found[2] > 0 and rest[0] not in _DETERMINED and parts[at] != "no":
        return read(" ".join([_imperative(found[0]), *rest[1:]]))
    if before is not None:
        return tuple(replace(clause, implied=True) for clause in read(" ".join([_imperative(before.verb), *rest])))
    return ()


def _read_relative(
    token: Token, lexicon: Lexicon, read: Reader
) -> tuple[list[str], list[tuple[str, str]], Clause | None]:
    """Return what a relative clause says of its noun: adjectives, and relations with other nouns.

    *That are dirty* gives an adjective; *where the mug is* a relation ``where``, *that has milk in it* one ``with``.
    """
    words = [part for word in _condition_words(token) for part in _expanded(word)]
    if not words:
        return [], [], None
    rest = words[1:]
    if words[0] == "where" and rest:
        subject = [w for w in rest if w not in _BE]
        if not subject or subject[0] in section("pronouns"):
            return [], [], None
        found = read(" ".join(["find", *subject]))
        return ([], [("where", found[0].objects[0])], found[0]) if found and found[0].objects else ([], [], None)
    if len(rest) > 2 and rest[0] in _BE | _STANDS and rest[1] in section("prepositions"):
        found = read(" ".join(["find", *rest[2:]]))
        return ([], [(rest[1], found[0].objects[0])], found[0]) if found and found[0].objects else ([], [], None)
    if len(rest) > 1 and rest[0] in _BE:
        last = [w for w in rest[1:] if w not in _SOFT and w not in ("not",)]
        if "not" in rest and last and last[0] in section("prepositions") and len(last) > 1:
            found = read(" ".join(["find", *last[1:]]))
            return (
                ([], [(f"not_{last[0]}", found[0].objects[0])], found[0])
                if found and found[0].objects
                else ([], [], None)
            )
        if last and (len(last) == 1 or last[0] not in section("prepositions")):
            word = f"not_{last[-1]}" if "not" in rest else last[-1]
            return [word], [], None
    copula = next((i for i, w in enumerate(rest) if i and w in _BE), None)
    if copula is not None and rest[-1] in section("prepositions"):
        found = read(" ".join(["find", *rest[:copula]]))
        return ([], [("where", found[0].objects[0])], found[0]) if found and found[0].objects else ([], [], None)
    if rest and rest[0] in _HAVE | {"contains", "contain", "holds", "hold"} and len(rest) > 1:
        found = read(" ".join(["find", *rest[1:]]))
        return ([], [("with", found[0].objects[0])], found[0]) if found and found[0].objects else ([], [], None)
    return ["_".join(words)], [], None


def _condition_words(token: Token) -> list[str]:
    """Return the words of a folded condition."""
    words = [t.text for t in token.inner if t.kind is not Kind.COMMA] or token.text.split()
    return [words[0], *(part for word in words[1:] for part in word.split("_"))]
