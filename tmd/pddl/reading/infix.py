"""Notation in which operators stand between their terms: ``?a != ?b``, ``(fuel ?r) > 0``, ``(p) and (q)``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tmd.diagnostics import Edit
from tmd.pddl.model import TOTAL_COST
from tmd.pddl.reading.syntax import NAME, Group, Node, Source, Word, after, enclosed, replaced, shifted

UNEQUAL = frozenset({"!=", "<>", "/=", "=/=", "~=", "neq", "not-equal", "not=", "\u2260"})
_EQUAL = frozenset({"=", "=="})
_COMPARED = frozenset({"<", ">", "<=", ">=", "\u2264", "\u2265"})
_ASSIGNED = {"+=": "increase", "-=": "decrease", ":=": "assign"}
_ARITHMETIC = frozenset({"+", "-", "*", "/"})
_OPERATORS = UNEQUAL | _EQUAL | _COMPARED | _ARITHMETIC | _ASSIGNED.keys()
# Words that join conditions, with those of PDDL.
_JOINING = {
    "and": "and", "or": "or", "&&": "and", "&": "and", "||": "or", "|": "or", "\u2227": "and", "\u2228": "or",
}  # fmt: skip
_DENYING = frozenset({"not", "!", "~", "\u00ac"})
ONLY_COSTS = "of numeric fluents only total-cost is supported"


def in_prefix(nodes: Sequence[Node], source: Source) -> list[Node]:
    """Return the parts of a connective, with operators before their terms; those between them are reported.

    Comparisons and assignments of numbers are left out: they are not supported.
    """
    found: list[Node] = []
    rest = list(nodes)
    while rest:
        if _text(rest[0]) in _DENYING and len(rest) > 1 and isinstance(rest[1], Group):
            found.append(_denied(rest.pop(0), rest.pop(0), source))
            continue
        run = _run(rest)
        del rest[: len(run)]
        found += run if len(run) == 1 else _written(run, source)
    return found


def _denied(word: Node, group: Node, source: Source) -> Group:
    """Return ``(not (p))`` for ``not (p)``, which is reported."""
    place, end = word.location, after(group)
    shown = f"(not {source.text(group.location, end)})"
    message, hint = f'"{_text(word)}" stands in parentheses with what it denies', f"write {shown}"
    source.fault_once(message, place, hint, "other-notation", [Edit(place, end, shown)])
    return Group((Word("not", place), group), place, shifted(end, -1), 0)


def _run(nodes: Sequence[Node]) -> list[Node]:
    """Return the first node, with the operators and terms behind it."""
    length = 1
    while length + 1 < len(nodes) and _text(nodes[length]) in _OPERATORS:
        length += 2
    return list(nodes[:length])


def _text(node: Node) -> str:
    return node.text if isinstance(node, Word) else ""


def _written(run: Sequence[Node], source: Source) -> Iterator[Node]:
    """Yield the equation or cost that a run of terms and operators is; anything else is not supported."""
    left, sign, right = run[0], _text(run[1]), run[2]
    names = all(_text(term)[:1].isalpha() or _text(term)[:1] == "?" for term in (left, right))
    place = run[0].location
    whole = Group((), place, after(run[-1]), 0)
    terms = [source.text(term.location, after(term)) for term in run[::2]]
    if len(run) == 3 and names and sign in UNEQUAL | _EQUAL:
        equation = Group((Word("=", place), left, right), place, run[-1].location, 0)
        shown = f"(= {terms[0]} {terms[1]})"
        if sign in UNEQUAL:
            equation, shown = Group((Word("not", place), equation), place, equation.end, 0), f"(not {shown})"
        _report(whole, shown, sign, source)
        yield equation
    elif len(run) == 3 and sign == "+=" and TOTAL_COST in (_text(left), left.head if isinstance(left, Group) else ""):
        cost = Group((Word("increase", place), left, right), place, run[-1].location, 0)
        _report(whole, f"(increase ({TOTAL_COST}) {terms[1]})", sign, source)
        yield cost
    else:
        what = "numeric conditions" if sign in _COMPARED | UNEQUAL else "numeric fluents"
        message, hint = f'not supported: {what}: "{sign}"', f"operators stand before their terms, and {ONLY_COSTS}"
        source.fault_at(message, place, hint, "not-supported")


def _report(whole: Group, shown: str, sign: str, source: Source) -> None:
    edits = [Edit(whole.location, whole.end, shown)]
    source.fault_once(f'"{sign}" stands between its terms', whole.location, f"write {shown}", "other-notation", edits)


def joined(nodes: Sequence[Node], source: Source) -> Group | None:
    """Return ``(and (p) (q))`` for ``(p) and (q)``, which is reported; ``None`` for anything else."""
    words = [node for node in nodes if isinstance(node, Word)]
    groups = [node for node in nodes if isinstance(node, Group)]
    plain = {_JOINING.get(word.text, "") for word in words}
    if len(plain) != 1 or not all(plain) or len(groups) != len(words) + 1 or isinstance(nodes[0], Word):
        return None
    (word,) = plain
    start, end = groups[0].location, after(groups[-1])
    edits = [Edit(start, start, f"({word} "), Edit(end, end, ")"), *(replaced(each, "") for each in words)]
    message, hint = f'"{words[0].text}" does not stand before its parts', f"write ({word} (...) (...))"
    source.fault_at(message, words[0].location, hint, "other-notation", edits)
    return Group((Word(word, start), *groups), start, groups[-1].end, groups[0].depth)


def atom_of_words(nodes: Sequence[Node], source: Source) -> Group | None:
    """Return the atom that words without parentheses are, which is reported; ``None`` where there are groups."""
    words = [node for node in nodes if isinstance(node, Word)]
    if len(words) < 2 or len(words) < len(nodes) or not NAME.fullmatch(words[0].text):
        return None
    start, end = words[0].location, after(words[-1])
    message, hint = "an atom stands in parentheses", f"write ({source.text(start, end)})"
    source.fault_once(message, start, hint, "syntax", enclosed(words[0], words[-1]))
    return Group(tuple(words), start, shifted(end, -1), 2)
