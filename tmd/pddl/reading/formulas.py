"""Reading conditions and effects from nested groups.

Effects come out flat. ``and`` and ``forall`` are spread out, and the conditions of a ``when`` within a
``when`` are conjoined: ``(when a (when b e))`` becomes ``(when (and a b) e)``.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import takewhile

from tmd.diagnostics import Edit, Location, TmdError
from tmd.pddl.model import (
    OBJECT,
    TOTAL_COST,
    TRUE,
    And,
    Atom,
    Effect,
    Equals,
    Exists,
    Forall,
    Formula,
    Imply,
    Not,
    Or,
    TypedName,
    free_variables,
)
from tmd.pddl.reading.infix import ONLY_COSTS, UNEQUAL, in_prefix
from tmd.pddl.reading.syntax import (
    CONNECTIVES,
    NAME,
    NO_BLANKS,
    Document,
    Group,
    Node,
    Source,
    Word,
    after,
    enclosed,
    replaced,
    shifted,
)

_NAME = re.compile(r"[a-z][a-z0-9_-]*")
# What planners take for a name although PDDL does not.
_ODD_NAME = re.compile(r"[a-z0-9_][!-~]*")
_VARIABLE = re.compile(r"\?[a-z][a-z0-9_-]*")
_ODD_VARIABLE = re.compile(r"\?[a-z0-9_][!-~]*")
_NUMBER = re.compile(r"([0-9]{1,15})(\.0*)?")

RESERVED = CONNECTIVES | {"either", "increase"}


def is_variable(term: str) -> bool:
    """Return whether a term is a variable."""
    return term.startswith("?")


# Constructs of PDDL outside the supported part: their requirements, sections, parts of actions and other words.
UNSUPPORTED = {
    word: feature
    for feature, words in {
        "durative actions": ":durative-actions :duration-inequalities :durative-action :duration :condition",
        "continuous effects": ":continuous-effects",
        "timed initial literals": ":timed-initial-literals :timed-initial-effects",
        "processes and events": ":time :process :event :class",
        "numeric fluents": ":fluents :numeric-fluents decrease scale-up scale-down",
        "numeric and object fluents": "assign change",
        "numeric conditions": "< > <= >= \u2264 \u2265",
        "object fluents": ":object-fluents",
        "preferences": ":preferences preference",
        "trajectory constraints": ":constraints always sometime within at-most-once sometime-after sometime-before "
        "always-within hold-during hold-after",
        "non-deterministic effects": ":non-deterministic oneof",
        "probabilistic effects": ":probabilistic-effects :mdp probabilistic",
        "rewards": ":rewards :goal-reward",
        "several agents": ":multi-agent :agents :agent",
        "private facts of agents": ":unfactored-privacy :factored-privacy :private",
        "hierarchical tasks": ":hierarchy :htn :method-preconditions :task :method",
        "utilities of goals": ":goal-utilities",
        "supply and demand": ":supply-demand",
        "partial observability": ":contingent :observable :sensing-action :observe :sense unknown",
        "plan length limits": ":length",
        "axioms of PDDL 1": ":axiom",
        "variables beside the parameters": ":vars",
    }.items()
    for word in words.split()
}


def unsupported(source: Source, what: str, name: str, location: Location, hint: str | None = None) -> TmdError:
    """Return the error for a construct of PDDL that is outside the supported part."""
    hint = hint or "tmd takes typed ADL with derived predicates and action costs"
    return source.error(f'not supported: {what}: "{name}"', location, hint, "not-supported")


def read_name(node: Node, source: Source, what: str) -> Word:
    """Return a name such as ``mug1``."""
    if isinstance(node, Group):
        raise source.error(f"expected {what}, found a parenthesis", node.location)
    if "\\" in node.text.rstrip("\\"):
        plain = node.text.replace("\\", "")
        message, edits = "names have no backslashes in PDDL", [replaced(node, plain)]
        source.fault_once(message, node.location, f"write {plain}", "other-notation", edits)
        node = Word(plain, node.location)
    if not _NAME.fullmatch(node.text):
        _odd_name(node, source, what, _ODD_NAME, "names begin with a letter and hold letters, digits, - and _")
    if node.text in RESERVED:
        raise source.error(f'"{node.text}" is a word of PDDL and cannot be {what}', node.location, code="bad-name")
    return node


def _odd_name(node: Word, source: Source, what: str, accepted: re.Pattern[str], hint: str) -> None:
    """Warn of a name that PDDL does not have, and planners take; raise the error where it is none."""
    strange = next((place for place, letter in enumerate(node.text) if not letter.isascii()), None)
    if strange is not None:
        letter = node.text[strange]
        place, shown = shifted(node.location, strange), f"{letter!r} ({unicodedata.name(letter, 'unnamed')})"
        message = f'"{node.text}" has a character that PDDL does not: {shown}'
        plain = _LOOK_ALIKES.get(letter) or unicodedata.normalize("NFKD", letter)[0]
        plain = plain if plain.isascii() and plain.isprintable() else ""
        edits = [Edit(place, shifted(place, 1), plain)] if plain else []
        raise source.error(message, place, f'write "{plain}"' if plain else hint, "look-alike", edits)
    if not accepted.fullmatch(node.text):
        raise source.error(f'"{node.text}" is not {what}', node.location, hint, "bad-name")
    if node.text in source.reported:
        return
    source.reported.add(node.text)
    source.warn(
        f'"{node.text}" is not a name by the letter of PDDL; some tools refuse it', node.location, hint, "odd-name"
    )


# Dashes, and Cyrillic and Greek letters, with the ASCII characters that they look like.
_LOOK_ALIKES = {
    **dict.fromkeys("\u2010\u2011\u2012\u2013\u2014\u2015\u2212\ufe63\uff0d", "-"),
    **dict(zip("\u0430\u0435\u043e\u0440\u0441\u0443\u0445\u0456\u0458\u0455", "aeopcyxijs", strict=True)),
    **dict(zip("\u03b1\u03bf\u03c1\u03bd\u03b9", "aopvi", strict=True)),
    **dict.fromkeys("\u2018\u2019\u201c\u201d", "'"),
}


def read_term(node: Node, source: Source) -> str:
    """Return a variable, constant or object."""
    if isinstance(node, Group):
        raise unsupported(
            source, "object fluents and nested terms", f"({node.head} ...)", node.location, "write a name or ?variable"
        )
    if is_variable(node.text):
        if not _VARIABLE.fullmatch(node.text):
            _odd_name(node, source, "a variable", _ODD_VARIABLE, "write ?name")
        return node.text
    return read_name(node, source, "a name or ?variable").text


def read_number(node: Node, source: Source) -> int | None:
    """Return a whole number that is not negative; ``None`` where ``node`` is not a number at all."""
    if isinstance(node, Group) or not re.fullmatch(r"[-+]?[0-9.]+(e[-+]?[0-9]+)?", node.text):
        return None
    whole = _NUMBER.fullmatch(node.text)
    if whole:
        return int(whole[1])
    shown = node.text if len(node.text) <= 30 else f"{node.text[:30]}…"
    message = f'not supported: numbers other than whole ones from 0 to 10^15: "{shown}"'
    raise source.error(message, node.location, "multiply all costs by 10, 100, ...", "not-supported")


def read_typed_list(nodes: Sequence[Node], source: Source, *, variables: bool, what: str) -> tuple[TypedName, ...]:
    """Read ``a b - t c - (either t u)``: names (or variables) with their types."""
    found: list[TypedName] = []
    waiting: list[Word] = []
    rest = list(reversed(_type_first(nodes, source) if variables else nodes))
    while rest:
        node = rest.pop()
        if isinstance(node, Group) and node.parts and node.head != "either":
            _without_parentheses(node, source)
            rest += reversed(node.parts)
            continue
        if isinstance(node, Word):
            node = _apart(node, rest, variables, source)
        if isinstance(node, Word) and node.text == "-":
            behind = rest[-1] if rest else node
            types = source.recover((OBJECT,), _read_types, rest, node.location, source)
            types = _with_blank(behind, types, rest, source) if variables else types
            if not waiting:
                edits = [source.removal(node.location, after(behind))]
                hint = "write names before it, or remove it"
                source.fault_at("no name stands before this type", node.location, hint, "syntax", edits)
            found.extend(TypedName(w.text, types, w.location) for w in waiting)
            waiting.clear()
        else:
            waiting.extend(_read_listed(node, source, variables, what))
    found.extend(TypedName(w.text, (OBJECT,), w.location) for w in waiting)
    return tuple(found)


def _with_blank(first: Node, types: tuple[str, ...], rest: list[Node], source: Source) -> tuple[str, ...]:
    """Return the types of a list, where a type of two words, which is reported, is its second one."""
    second = rest[-1] if rest and isinstance(first, Word) else first
    if second is first or not isinstance(second, Word) or second.text not in types_of(source):
        return types
    rest.pop()
    joined = f"{types[0]}-{second.text}"
    edits = [Edit(after(first), second.location, "-")]
    source.fault_once(NO_BLANKS.format(joined), second.location, f"write {joined}", "bad-name", edits)
    return (second.text,)


# What some write for the dash before a type.
DASHES = frozenset({"->", "=>", "=", "\u2192"})


def _apart(node: Word, rest: list[Node], variables: bool, source: Source) -> Word:
    """Return the first of the words that are written as one; the rest begins with the others then."""
    if variables:
        node = _before_glued_type(node, rest, source)
    if ":" in node.text and node.text[0] != ":":
        node = _before_colon(node, rest, source)
    if node.text in DASHES:
        message, edits = f'a type stands behind a dash, not behind "{node.text}"', [replaced(node, "-")]
        source.fault_once(message, node.location, "write name - type", "other-notation", edits)
        return Word("-", node.location)
    if len(node.text) > 1 and node.text[-1] == "-" and rest and (isinstance(rest[-1], Group) or rest[-1].text != "-"):
        return _before_dash(node, rest, source)
    if len(node.text) > 1 and node.text[0] == "-":
        place, kind = shifted(node.location, 1), node.text[1:]
        message, edits = f'some tools want a space between "-" and "{kind}"', [Edit(place, place, " ")]
        source.warn(message, node.location, f'write "- {kind}"', "glued-dash", edits)
        rest.append(Word(kind, place))
        return Word("-", node.location)
    if _LOOK_ALIKES.get(node.text) == "-":
        source.recover(None, read_name, node, source, "a dash")
        return Word("-", node.location)
    return node


def types_of(source: Source) -> frozenset[str]:
    """Return the types that a domain declares, as far as they can be read."""
    section = source.sections.get(":types")
    return frozenset(part.text for part in section.parts[1:] if isinstance(part, Word)) if section else frozenset()


def _type_first(nodes: Sequence[Node], source: Source) -> Sequence[Node]:
    """Return ``can ?c bed ?b``, which is reported, as ``?c - can ?b - bed``; other lists as they are."""
    words = [node for node in nodes if isinstance(node, Word)]
    pairs = list(zip(words[::2], words[1::2], strict=False))
    types = types_of(source)
    if not pairs or 2 * len(pairs) < len(nodes) or any(t.text not in types or v.text[0] != "?" for t, v in pairs):
        return nodes
    for kind, variable in pairs:
        edits = [replaced(kind, variable.text), replaced(variable, f"- {kind.text}")]
        hint = f"write {variable.text} - {kind.text}"
        source.fault_once("a type stands behind its variable", kind.location, hint, "other-notation", edits)
    return [node for kind, variable in pairs for node in (variable, Word("-", kind.location), kind)]


def _without_parentheses(node: Group, source: Source) -> None:
    """Report a group where names with their types should be."""
    start, end = node.location, shifted(node.end, 1)
    before, behind = source.lines[start.line - 1][: start.column - 1], source.lines[end.line - 1][end.column - 1 :]
    blanks = [" " if re.search(r"[\w-]\Z", before) else "", " " if re.match(r"[\w-]", behind) else ""]
    edits = [Edit(start, shifted(start, 1), blanks[0]), Edit(node.end, end, blanks[1])]
    hint = "write a b - type c - (either type other)"
    source.fault_once("names with their type have no parentheses", node.location, hint, "other-notation", edits)


def _before_glued_type(node: Word, rest: list[Node], source: Source) -> Word:
    """Return the variable in ``?c-can``, where the part behind a dash is a type; the rest begins with the type then."""
    types = types_of(source) if "-" in node.text[1:] else frozenset()
    for dash in (match.start() for match in re.finditer("-", node.text) if node.text[match.end() :] in types):
        name, kind = node.text[:dash], node.text[dash + 1 :]
        place = shifted(node.location, dash)
        message, hint = "the dash before a type has blanks around it", f"write {name} - {kind}"
        source.fault_once(message, place, hint, "other-notation", [Edit(place, shifted(place, 1), " - ")])
        rest += [Word(kind, shifted(place, 1)), Word("-", place)]
        return Word(name, node.location)
    return node


def _before_colon(node: Word, rest: list[Node], source: Source) -> Word:
    """Return the name in ``name:type`` or ``name: type``; the rest begins with the type then."""
    name, _, kind = node.text.partition(":")
    place = shifted(node.location, len(name))
    edits = [Edit(place, shifted(place, 1), " - " if kind else " -")]
    message = "a type stands behind a dash, not behind a colon"
    source.fault_once(message, place, f"write {name} - {kind or 'type'}", "other-notation", edits)
    rest += [Word(kind, shifted(place, 1)), Word("-", place)] if kind else [Word("-", place)]
    return Word(name, node.location)


def _before_dash(node: Word, rest: list[Node], source: Source) -> Word:
    """Return the name in ``name-``, which wants a space; the rest begins with the dash then."""
    name, place = node.text[:-1], shifted(node.location, len(node.text) - 1)
    message, hint = f'some tools want a space between "{name}" and "-"', f'write "{name} -"'
    source.warn(message, node.location, hint, "glued-dash", [Edit(place, place, " ")])
    rest.append(Word("-", place))
    return Word(name, node.location)


BARE = 'variables begin with "?"'
"""The fault of variables without their mark, of one message for their declarations and uses."""


def _read_listed(node: Node, source: Source, variables: bool, what: str) -> list[Word]:
    """Return the name at ``node``; nothing where it is none and faults are collected."""
    if not variables and isinstance(node, Word) and is_variable(node.text) and len(node.text) > 1:
        name = node.text.lstrip("?")
        message, edits = f'"{node.text}" is not the name of {what}', [replaced(node, name)]
        source.fault_at(message, node.location, f'write "{name}"', "bad-name", edits)
        node = Word(name, node.location)
    if not variables:
        return source.recover([], lambda: [read_name(node, source, f"the name of {what}")])
    if isinstance(node, Group):
        source.fault_at(f"expected {what} such as ?x, found a parenthesis", node.location)
        return []
    if not _VARIABLE.fullmatch(node.text):
        name = f"?{node.text.lstrip('?')}"
        if _NAME.fullmatch(node.text):
            edits = [replaced(node, name)]
            source.fault_once(BARE, node.location, f'write "{name}"', "bad-name", edits)
        else:
            source.recover(None, _odd_name, node, source, what, _ODD_VARIABLE, f'write "{name}"')
        node = Word(name, node.location)
    return [node]


def _read_types(rest: list[Node], dash: Location, source: Source) -> tuple[str, ...]:
    if not rest:
        raise source.error('a type is missing after "-"', dash)
    node = rest.pop()
    if isinstance(node, Word):
        return (read_name(node, source, "the name of a type").text,)
    if node.head != "either" or len(node.parts) < 2:
        plain = [part.text for part in node.parts if isinstance(part, Word)]
        start = shifted(node.location, 1)
        edits = [Edit(start, start, "either ")] if plain and len(plain) == len(node.parts) else []
        hint = f"write (either {' '.join(plain)})" if edits else None
        raise source.error("expected a type or (either type ...)", node.location, hint, "syntax", edits)
    return tuple(read_name(n, source, "the name of a type").text for n in node.parts[1:])


def read_parameters(node: Node, source: Source) -> tuple[TypedName, ...]:
    """Return the parameter list of an action or quantifier."""
    if isinstance(node, Word):
        raise source.error(f'expected a list of parameters, found "{node.text}"', node.location, "write (?x - type)")
    return read_typed_list(node.parts, source, variables=True, what="a variable")


# Conditions without a part in other notations, and connectives with their words of PDDL.
_EMPTY = frozenset({"nil", "none", "null", "true", "empty", "n/a", "[]", "{}", "t"})
_CONNECTIVES = {
    "&&": "and", "&": "and", "||": "or", "|": "or", "!": "not", "~": "not", "implies": "imply", "=>": "imply",
    "->": "imply", "if": "when", "for-all": "forall", "foreach": "forall", "exist": "exists",
    "there-exists": "exists", "thereexists": "exists", "\u2227": "and", "\u2228": "or", "\u00ac": "not",
    "\u2192": "imply", "\u21d2": "imply", "\u2200": "forall", "\u2203": "exists",
    "add": "and", "delete": "not", "del": "not", "remove": "not",
}  # fmt: skip
_SIGNS = UNEQUAL | {"=", "=="}


def _not_in_parentheses(node: Word, source: Source, what: str) -> TmdError:
    """Return the error for a word where a group should be."""
    if node.text in _EMPTY:
        edits = [replaced(node, "(and)")]
        return source.error(f'"{node.text}" is not PDDL', node.location, "write (and)", "other-notation", edits)
    hint = f"write ({node.text})"
    return source.error(f'expected {what}, found "{node.text}"', node.location, hint, "syntax")


def _in_pddl(node: Group, source: Source) -> Group:
    """Return ``node`` with the connective or equation of another notation, which is reported, in that of PDDL."""
    if not node.parts:
        return node
    head, *rest = node.parts
    if isinstance(head, Group) and len(node.parts) > 2 and len(written := in_prefix(node.parts, source)) < 2:
        return _only_group(written, node)
    if isinstance(head, Group):
        return _without_word(node, [part for part in rest if isinstance(part, Word)], source)
    if head.text in ("when", "if"):
        rest = _without_then(rest, source)
        node = _group(node, head, *rest)
    if head.text == "not" or head.text[0] in "!~\u00ac":
        return _negation(node, head, rest, source)
    if len(rest) == 2 and node.head in _TIMES:
        return _timeless(node, rest[0], rest[1], source)
    if len(rest) == 2 and node.head in ASSIGNED and isinstance(rest[0], Group):
        return truth_value(node, rest[0], rest[1], source)
    return _connective(node, head, rest, source)


def _without_then(parts: Sequence[Node], source: Source) -> list[Node]:
    """Return the parts of a condition without the word "then", which is reported."""
    then = next((part for part in parts if isinstance(part, Word) and part.text == "then"), None)
    if then is not None:
        edits = [source.removal(then.location, after(then))]
        source.fault_once('"then" is not PDDL', then.location, "remove it", "other-notation", edits)
    return [part for part in parts if part is not then]


def _only_group(written: Sequence[Node], node: Group) -> Group:
    """Return the group that is left of ``node``; the empty conjunction where what was in it is not supported."""
    (group,) = written or [_group(node, Word("and", node.location))]
    return group if isinstance(group, Group) else node


def _negation(node: Group, head: Word, rest: Sequence[Node], source: Source) -> Group:
    """Return ``(!p ?x)`` and ``(not p ?x)``, which are reported, as ``(not (p ?x))``."""
    if NAME.fullmatch(head.text[1:]) and head.text != "not":
        atom = _group(node, Word(head.text[1:], shifted(head.location, 1)), *rest)
        shown = source.text(node.location, after(node)).replace(head.text[0], "", 1)
        _of_pddl(node, f"(not {shown})", head.text[0], source)
        return _group(node, Word("not", node.location), atom)
    if head.text == "not" and len(rest) > 2 and len(written := in_prefix(rest, source)) < len(rest):
        return _group(node, head, *(written or [_group(node, Word("and", node.location))]))
    if head.text == "not" and len(rest) > 1 and all(isinstance(part, Word) for part in rest):
        edits = enclosed(rest[0], rest[-1])
        hint = f"write (not ({source.text(rest[0].location, after(rest[-1]))}))"
        source.fault_at('what is behind "not" stands in parentheses', rest[0].location, hint, "syntax", edits)
        return _group(node, head, Group(tuple(rest), rest[0].location, node.end, node.depth + 1))
    return _connective(node, head, rest, source)


def _connective(node: Group, head: Word, rest: Sequence[Node], source: Source) -> Group:
    """Return a group whose head or sign is that of another notation, which is reported, with that of PDDL."""
    between = rest[0].text if len(rest) == 2 and isinstance(rest[0], Word) else ""
    if between in _SIGNS:
        return _equation(node, between, (head, rest[1]), source)
    if node.head not in _SIGNS and node.head not in _CONNECTIVES:
        return node
    groups = any(isinstance(part, Group) for part in rest)
    if node.head != "=" and node.head in _SIGNS and not groups:
        return _equation(node, node.head, rest, source)
    plain = _CONNECTIVES.get(node.head) if groups else None
    if plain:
        _of_pddl(head, plain, node.head, source)
        return _group(node, Word(plain, node.location), *rest)
    return node


# How the times of durative actions begin, and the words behind that.
_TIMES = {"at": ("start", "end"), "over": ("all",)}
# What some write to make an atom true or false.
ASSIGNED = ("=", "==", "assign", "set")


def _timeless(node: Group, time: Node, inner: Node, source: Source) -> Group:
    """Return the condition or effect in ``(at start (...))``, which is reported."""
    if isinstance(time, Group) or isinstance(inner, Word) or time.text not in _TIMES[node.head]:
        return node
    edits = [Edit(node.location, inner.location), Edit(node.end, shifted(node.end, 1))]
    message = f'"{node.head} {time.text}" belongs in durative actions'
    source.fault_once(message, node.location, "write what is in it alone", "other-notation", edits)
    return _in_pddl(inner, source)


def truth_value(node: Group, atom: Group, value: Node, source: Source) -> Group:
    """Return ``(= (p) true)``, which is reported, as ``(p)``, and ``(= (p) false)`` as ``(not (p))``."""
    if isinstance(value, Group) or value.text not in ("true", "false"):
        return node
    shown = source.text(atom.location, after(atom))
    plain = shown if value.text == "true" else f"(not {shown})"
    _of_pddl(node, plain, f"({node.head} (...) {value.text})", source)
    return atom if value.text == "true" else _group(node, Word("not", node.location), atom)


def _quantifier(node: Group, source: Source, what: str) -> Group:
    """Return a quantifier with parameters in parentheses and one part behind them; anything else is reported."""
    head, *parts = node.parts
    words = list(takewhile(lambda part: isinstance(part, Word), parts))
    if words:
        parts = [parameters_of_words(words, source), *parts[len(words) :]]
    if len(parts) > 2 and all(isinstance(part, Group) for part in parts):
        parts = [parts[0], conjoined(f'"{node.head}" takes one part behind its parameters', parts[1:], source)]
    node = _group(node, head, *parts)
    _expect(node, 2, f"({node.head} (parameters) {what})", source)
    return node


def parameters_of_words(words: Sequence[Node], source: Source) -> Group:
    """Return parameters without parentheses, which are reported, as a group."""
    start, edits = words[0].location, enclosed(words[0], words[-1])
    source.fault_at("parameters stand in parentheses", start, "write (?x - type)", "syntax", edits)
    return Group(tuple(words), start, after(words[-1]), 2)


def conjoined(message: str, parts: Sequence[Node], source: Source) -> Group:
    """Return the conjunction of several conditions or effects where one should be, which is reported."""
    place, edits = parts[0].location, enclosed(parts[0], parts[-1], "(and ")
    source.fault_at(message, place, "use (and (...) (...)) for several", "syntax", edits)
    return Group((Word("and", place), *parts), place, shifted(after(parts[-1]), -1), 2)


def _equation(node: Group, sign: str, terms: Sequence[Node], source: Source) -> Group:
    """Return an equation or its negation that is written in another notation, which is reported."""
    shown = f"(= {' '.join(source.text(term.location, after(term)) for term in terms)})"
    equation = _group(node, Word("=", node.location), *terms)
    if sign in UNEQUAL:
        shown, equation = f"(not {shown})", _group(node, Word("not", node.location), equation)
    _of_pddl(node, shown, sign if node.head == sign else f"({node.head} {sign} ...)", source)
    return equation


def _without_word(node: Group, between: Sequence[Word], source: Source) -> Group:
    """Return ``((a) and (b))`` and ``((a) (b))``, which are reported, as ``(and (a) (b))``."""
    place, word = shifted(node.location, 1), between[0].text if between else "and"
    if word not in ("and", "or") or any(each.text != word for each in between):
        return node
    edits = [Edit(place, place, f"{word} "), *(replaced(each, "") for each in between)]
    message = f'"{word}" does not stand before its parts' if between else '"and" is missing here'
    start = between[0].location if between else node.location
    source.fault_at(message, start, f"write ({word} (...) (...))", "other-notation" if between else "syntax", edits)
    return _group(node, Word(word, place), *(part for part in node.parts if isinstance(part, Group)))


def _group(node: Group, *parts: Node) -> Group:
    return Group(parts, node.location, node.end, node.depth)


def _of_pddl(node: Node, plain: str, found: str, source: Source) -> None:
    """Report the notation ``found`` at ``node``, for which PDDL has ``plain``."""
    edits = [replaced(node, plain)]
    source.fault_once(f'"{found}" is not PDDL', node.location, f"write {plain}", "other-notation", edits)


# The other words that are not supported may be names of predicates, and then have no conditions in them.
_NEVER_PREDICATES = frozenset({"preference", "<", ">", "<=", ">=", "\u2264", "\u2265"})
_EFFECT_WORDS = frozenset({"assign", "change", "decrease", "scale-up", "scale-down", "oneof", "probabilistic"})


def _hint_for(feature: str) -> str | None:
    return ONLY_COSTS if "numeric" in feature else None


def read_condition(node: Node, source: Source) -> Formula:
    """Return a precondition, goal or condition of an effect.

    Raises:
        TmdError: It is not a formula, or it holds something that is not supported.
    """
    if isinstance(node, Word):
        raise _not_in_parentheses(node, source, "a condition")
    node = _in_pddl(node, source)
    if not node.parts:
        message, edits = "() is empty, and some tools read it as false", [replaced(node, "(and)")]
        source.warn(message, node.location, "write (and)", "empty-condition", edits)
        return And((), node.location)
    head, parts, place = node.head, node.parts[1:], node.location
    if head in ("and", "or"):
        inner = _read_parts(parts, source)
        return And(inner, place) if head == "and" else Or(inner, place)
    if head == "not":
        _expect(node, 1, "(not condition)", source)
        return Not(read_condition(parts[0], source), place)
    if head == "imply":
        _expect(node, 2, "(imply condition condition)", source)
        return Imply(read_condition(parts[0], source), read_condition(parts[1], source), place)
    if head in ("forall", "exists"):
        _, parameters, part = _quantifier(node, source, "condition").parts
        quantified = Forall if head == "forall" else Exists
        return quantified(read_parameters(parameters, source), read_condition(part, source), place)
    if head == "=":
        _expect(node, 2, "(= term term)", source)
        if any(isinstance(p, Group) or p.text[0].isdigit() for p in parts):
            raise unsupported(source, "numeric conditions and object fluents", head, place)
        return Equals(read_term(parts[0], source), read_term(parts[1], source), place)
    if head == "when":
        raise source.error('"when" belongs in effects', place, 'write "imply" in conditions', "when-in-condition")
    if head in UNSUPPORTED and (head in _NEVER_PREDICATES or any(isinstance(p, Group) for p in parts)):
        raise unsupported(source, UNSUPPORTED[head], head, place, _hint_for(UNSUPPORTED[head]))
    return read_atom(node, source)


def read_only_condition(document: Document) -> Formula:
    """Return the condition that a text consists of.

    Raises:
        TmdError: It is none, or several.
    """
    document.check_depth()
    source = document.source
    if len(document.groups) != 1:
        place = Location(source.file, 1, 1)
        raise source.error("a goal is one condition", place, "write (and (…) (…)) for several")
    return read_condition(document.groups[0], source)


def _read_parts(parts: Sequence[Node], source: Source) -> tuple[Formula, ...]:
    read = (source.recover(None, read_condition, p, source) for p in in_prefix(parts, source))
    return tuple(part for part in read if part is not None)


def read_atom(node: Group, source: Source) -> Atom:
    """Return a predicate or function applied to terms."""
    if not node.parts:
        raise source.error("expected (predicate term ...), found ()", node.location)
    name = read_name(node.parts[0], source, "the name of a predicate")
    terms = _without_types(list(node.parts[1:]), source)
    return Atom(name.text, tuple(read_term(p, source) for p in terms), node.location)


def _without_types(terms: list[Node], source: Source) -> list[Node]:
    """Return the terms of an atom without types, which are reported: they stand where the names are declared."""
    dashes = [n for n, term in enumerate(terms) if isinstance(term, Word) and term.text == "-" and n and terms[n + 1 :]]
    for number in reversed(dashes):
        dash, kind = terms[number], terms[number + 1]
        edits = [source.removal(dash.location, after(kind))]
        message, hint = "a type does not stand in a condition, an effect or :init", "remove it"
        source.fault_once(message, dash.location, hint, "other-notation", edits)
        del terms[number : number + 2]
    return terms


def _expect(node: Group, count: int, form: str, source: Source) -> None:
    if len(node.parts) != count + 1:
        raise source.error(f'"{node.head}" takes {count} part(s), found {len(node.parts) - 1}', node.location, form)


@dataclass(slots=True)
class Effects:
    """The result of :func:`read_effects`."""

    flat: list[Effect] = field(default_factory=list)
    cost: int | Atom | None = None


@dataclass(frozen=True, slots=True)
class _Around:
    """The quantifiers and conditions around an effect."""

    parameters: tuple[TypedName, ...] = ()
    conditions: tuple[Formula, ...] = ()

    def condition(self) -> Formula:
        if not self.conditions:
            return TRUE
        return self.conditions[0] if len(self.conditions) == 1 else And(self.conditions)


def read_effects(node: Node, source: Source) -> Effects:
    """Return the effects of an action, flattened, and its cost.

    Raises:
        TmdError: It is not an effect, or it holds something that is not supported.
    """
    found = Effects()
    _read_effect(node, source, _Around(), found)
    return found


def _read_effect(node: Node, source: Source, around: _Around, found: Effects) -> None:
    if isinstance(node, Word):
        raise _not_in_parentheses(node, source, "an effect")
    node = _in_pddl(node, source)
    head, parts = node.head, node.parts[1:]
    if head == "and" or not node.parts:
        for part in in_prefix(parts, source):
            source.recover(None, _read_effect, part, source, around, found)
    elif head == "forall":
        node = _quantifier(node, source, "effect")
        _read_effect(node.parts[2], source, _quantified(node, source, around), found)
    elif head == "when":
        _expect(node, 2, "(when condition effect)", source)
        if around.conditions:
            source.warn(
                'a "when" within a "when" is read as one with both conditions; most planners refuse it',
                node.location,
                "write one (when (and ...) ...)",
                "nested-when",
            )
        condition = source.recover(TRUE, read_condition, parts[0], source)
        inside = _Around(around.parameters, (*around.conditions, condition))
        _read_effect(parts[1], source, inside, found)
    elif head == "increase":
        _read_cost(node, source, around, found)
    elif head in _EFFECT_WORDS:
        what = UNSUPPORTED[head]
        raise unsupported(source, what, head, node.location, _hint_for(what))
    elif head in ("or", "exists", "imply", "="):
        hint = "it belongs in conditions"
        raise source.error(f'"{head}" cannot be an effect', node.location, hint, "not-an-effect")
    else:
        found.flat.append(_read_literal(node, source, around))


def _quantified(node: Group, source: Source, around: _Around) -> _Around:
    """Return ``around`` with the quantifier of ``node``; a condition outside it must not be captured."""
    parameters = read_parameters(node.parts[1], source)
    outside = frozenset[str]().union(*(free_variables(c) for c in around.conditions))
    for parameter in parameters:
        if parameter.name in outside:
            raise source.error(
                f'"{parameter.name}" already stands in a condition around this forall',
                parameter.location,
                "give it another name",
            )
    return _Around(around.parameters + parameters, around.conditions)


def _read_literal(node: Group, source: Source, around: _Around) -> Effect:
    positive = node.head != "not"
    inner: Node = node
    if not positive:
        _expect(node, 1, "(not (predicate term ...))", source)
        inner = node.parts[1]
    if isinstance(inner, Word) or inner.head in RESERVED or inner.head == "=":
        raise source.error(
            'only an atom can stand in an effect\'s "not"',
            inner.location,
            "write (not (predicate ...))",
            "not-an-effect",
        )
    return Effect(read_atom(inner, source), positive, around.condition(), around.parameters, node.location)


def _read_cost(node: Group, source: Source, around: _Around, found: Effects) -> None:
    _expect(node, 2, "(increase (total-cost) number)", source)
    target, amount = node.parts[1:]
    name = target.head if isinstance(target, Group) else target.text
    if name != TOTAL_COST:
        raise unsupported(source, "numeric fluents", name, node.location, ONLY_COSTS)
    if around.parameters or around.conditions:
        raise unsupported(source, "costs that depend on conditions", "increase", node.location)
    if found.cost is not None:
        raise source.error("the cost of this action is given twice", node.location)
    if isinstance(amount, Group):
        if amount.head in ("+", "-", "*", "/"):
            raise unsupported(source, "numeric expressions", amount.head, amount.location, ONLY_COSTS)
        found.cost = read_atom(amount, source)
        return
    found.cost = read_number(amount, source)
    if found.cost is None:
        raise source.error(f'cost "{amount.text}" is neither a number nor (function ...)', amount.location)
