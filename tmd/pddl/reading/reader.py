"""Reading PDDL domains and problems.

Supported: typed ADL with action costs. Everything else is refused by its name. What is read is checked by
:mod:`tmd.pddl.reading.checking`, and the first fault is raised with its source line. All names become lower case.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from difflib import get_close_matches
from functools import lru_cache
from itertools import groupby, pairwise, takewhile
from pathlib import Path
from typing import Any, TypeAlias

from tmd.diagnostics import Edit, Location, TmdError
from tmd.pddl.model import (
    OBJECT,
    TOTAL_COST,
    TRUE,
    ActionSchema,
    Atom,
    Axiom,
    Domain,
    Formula,
    Predicate,
    Problem,
    TypeDeclaration,
    TypedName,
    parents_first,
)
from tmd.pddl.reading.checking import check_domain, check_problem, undeclared_requirements
from tmd.pddl.reading.formulas import (
    DASHES,
    UNSUPPORTED,
    Effects,
    conjoined,
    parameters_of_words,
    read_condition,
    read_effects,
    read_name,
    read_only_condition,
    read_parameters,
    read_typed_list,
    types_of,
    unsupported,
)
from tmd.pddl.reading.infix import atom_of_words, joined
from tmd.pddl.reading.initial_state import InitReader
from tmd.pddl.reading.syntax import (
    NAME,
    NO_BLANKS,
    PARTS,
    Document,
    Group,
    Node,
    Report,
    Source,
    Word,
    after,
    enclosed,
    meant,
    nearest,
    parse,
    read_text,
    replaced,
    shifted,
)
from tmd.pddl.semantics import close


def only_part(group: Group, source: Source) -> Node:
    """Return the one part that ``group`` must have."""
    parts = group.parts[1:]
    if len(parts) == 1:
        return parts[0]
    message = f'"{group.head}" takes one part, found {len(parts)}'
    if group.head == ":goal" and parts and all(isinstance(part, Group) for part in parts):
        return conjoined(message, parts, source)
    if group.head == ":goal" and (whole := joined(parts, source) or atom_of_words(parts, source) if parts else None):
        return whole
    raise source.error(message, group.location, "write one")


def read_title(nodes: Sequence[Node], place: Location, source: Source, what: str) -> Word:
    """Read the name of a domain, problem or action, which may have blanks by mistake."""
    words = [node for node in nodes if isinstance(node, Word)]
    if not nodes:
        raise source.error(f"expected {what}, found nothing", place)
    name = read_name(nodes[0], source, what)
    if len(nodes) == 1 or len(words) < len(nodes):
        return name
    strange = next((word for word in words if not NAME.fullmatch(word.text)), None)
    if strange is not None:
        source.fault_at(f'"{strange.text}" is no part of a name', strange.location, "remove it", "bad-name")
        return name
    joined = "-".join(word.text for word in words)
    edits = [Edit(after(one), other.location, "-") for one, other in pairwise(words)]
    source.fault_once(NO_BLANKS.format(joined), words[1].location, f"write {joined}", "bad-name", edits)
    return Word(joined, name.location)


def read_requirements(group: Group, source: Source) -> tuple[str, ...]:
    """Read ``(:requirements ...)``, each once."""
    names: list[str] = []
    nodes = list(group.parts[1:])
    for node in nodes:
        if isinstance(node, Group) and node.head.startswith(":"):
            edits = [Edit(node.location, shifted(node.location, 1)), Edit(node.end, shifted(node.end, 1))]
            source.fault_once("a requirement has no parentheses", node.location, "remove them", "syntax", edits)
            nodes += node.parts
            continue
        if isinstance(node, Group) or not node.text.startswith(":"):
            plain = isinstance(node, Word) and f":{node.text}" in REQUIREMENTS
            edits = [Edit(node.location, node.location, ":")] if plain else []
            hint = f"write :{node.text}" if isinstance(node, Word) else None
            source.fault_once("a requirement begins with a colon", node.location, hint, "unknown-requirement", edits)
            continue
        if node.text in UNSUPPORTED:
            source.warn(
                f"not supported: {UNSUPPORTED[node.text]}: {node.text}",
                node.location,
                "the requirement is ignored; what uses it is refused",
                "unsupported-requirement",
            )
        elif node.text not in REQUIREMENTS:
            message = f'"{node.text}" is not a known requirement'
            hint, edits = _meant(node, REQUIREMENTS)
            hint = hint or nearest(node.text, [word for word in UNSUPPORTED if word[0] == ":"]) or "remove it"
            source.fault_at(message, node.location, hint, "unknown-requirement", edits)
            continue
        if node.text not in names:
            names.append(node.text)
    return tuple(names)


REQUIREMENTS = (
    ":strips",
    ":typing",
    ":negative-preconditions",
    ":disjunctive-preconditions",
    ":equality",
    ":existential-preconditions",
    ":universal-preconditions",
    ":quantified-preconditions",
    ":conditional-effects",
    ":adl",
    ":action-costs",
    ":derived-predicates",
    ":domain-axioms",
)


def read_types(group: Group, source: Source) -> tuple[TypeDeclaration, ...]:
    """Read ``(:types ...)``, parents before children."""
    found = []
    for typed in read_typed_list(group.parts[1:], source, variables=False, what="a type"):
        if len(typed.types) > 1:
            place = typed.location or group.location
            source.fault(unsupported(source, "types with several parents", typed.name, place))
        if typed.name != OBJECT:
            found.append(TypeDeclaration(typed.name, typed.types[0], typed.location))
        elif typed.types[0] != OBJECT:
            message, hint = '"object" is the root of all types and has no parent', 'remove "object" here'
            source.fault_at(message, typed.location, hint, "type-cycle")
    declared = _with_undeclared_parents(_each_once(found, source), source)
    if source.report is not None:
        _warn_of_children_first(found, source)
    return parents_first(declared)


def _each_once(found: list[TypeDeclaration], source: Source) -> list[TypeDeclaration]:
    """Return each type with its last parent that is not ``object``: planning competitions declare some types twice."""
    kept: dict[str, TypeDeclaration] = {}
    for declared in found:
        before = kept.get(declared.name)
        if before is None:
            kept[declared.name] = declared
            continue
        counting = declared if declared.parent != OBJECT else before
        counts = f'; its parent is read as "{counting.parent}"' if before.parent != declared.parent else ""
        message = f'type "{declared.name}" is declared twice{counts}'
        source.warn(message, declared.location, "declare it once", "type-twice")
        kept[declared.name] = counting
    return list(kept.values())


def _with_undeclared_parents(found: list[TypeDeclaration], source: Source) -> list[TypeDeclaration]:
    """Add the undeclared parents of types: all common planners take them as declared.

    A parent that differs from a declared type by a letter or so is left out: that is a slip, and an error.
    """
    known = {OBJECT, *(declared.name for declared in found)}
    added: dict[str, TypeDeclaration] = {}
    for declared in found:
        parent = declared.parent
        if parent in known or parent in added or get_close_matches(parent, sorted(known), n=1, cutoff=_ONE_SLIP):
            continue
        place = source.type_of(declared.location, parent)
        message = f'the parent type "{parent}" is not declared itself; some tools refuse that'
        source.warn(message, place, f'add "{parent}" to (:types ...)', "undeclared-parent")
        added[parent] = TypeDeclaration(parent, OBJECT, place)
    return [*found, *added.values()]


# The likeness (of :mod:`difflib`) of two names of four letters or more that differ by one.
_ONE_SLIP = 0.85


def _warn_of_children_first(found: list[TypeDeclaration], source: Source) -> None:
    """Warn of types that stand before their parents, which some readers refuse."""
    later = {declared.name: place for place, declared in enumerate(found)}
    early = [declared for place, declared in enumerate(found) if later.get(declared.parent, 0) > place]
    if early:
        more = f" (and {len(early) - 1} more before theirs)" if len(early) > 1 else ""
        source.warn(
            f'type "{early[0].name}" stands before its parent "{early[0].parent}"{more}; some tools refuse that',
            early[0].location,
            f'declare "{early[0].parent}" first',
            "parent-after-child",
        )


def read_predicates(group: Group, document: Document) -> tuple[Predicate, ...]:
    """Read ``(:predicates ...)``, each with the comment that stands beside it."""
    declared: Sequence[Node] = group.parts[1:]
    declared = list(_with_parentheses(declared, document.source))
    words = [node for node in declared if isinstance(node, Word)]
    if len(words) > 1:
        names, hint = ", ".join(word.text for word in words[:8]), f"write ({words[0].text} ?x - type)"
        document.source.fault_at(f"expected (predicate ...), found {names}", words[0].location, hint)
        declared = [node for node in declared if isinstance(node, Group)]
    following = [*(n.location.line for n in declared[1:]), group.end.line + 1][: len(declared)]
    found: list[Predicate | None] = []
    for node, next_line in zip(declared, following, strict=True):
        last = isinstance(node, Group) and node.end.line != next_line
        comment = document.comments.get(node.end.line, "") if isinstance(node, Group) and last else ""
        found.append(document.source.recover(None, _read_signature, node, document, comment))
    return tuple(predicate for predicate in found if predicate)


def _with_parentheses(nodes: Sequence[Node], source: Source) -> Iterator[Node]:
    """Yield predicates; names with variables behind them on a line, which are reported, are put in parentheses."""
    for (words, _), run in groupby(
        nodes, lambda node: (isinstance(node, Word), isinstance(node, Word) and node.location.line)
    ):
        nodes_of_line = list(run)
        typed = words and any(isinstance(node, Word) and node.text[0] == "?" for node in nodes_of_line[1:2])
        atom = atom_of_words(nodes_of_line, source) if typed else None
        yield from [atom] if atom else nodes_of_line


def _read_signature(node: Node, document: Document, comment: str = "") -> Predicate:
    source = document.source
    if isinstance(node, Word):
        raise source.error(f'expected (predicate ...), found "{node.text}"', node.location)
    if len(node.parts) == 1 and isinstance(node.parts[0], Group):
        edits = [Edit(node.location, shifted(node.location, 1)), Edit(node.end, shifted(node.end, 1))]
        message, hint = "these are two pairs of parentheses", "remove one of them"
        source.fault_once(message, node.location, hint, "syntax", edits)
        return _read_signature(node.parts[0], document, comment)
    if node.head == ":private":
        raise unsupported(source, UNSUPPORTED[node.head], node.head, node.location)
    if not node.parts:
        raise source.error("expected (name ?parameter ...), found ()", node.location)
    named = _name_of_signature(node, source)
    rest = node.parts[len(named) :]
    name = read_title(named, node.location, source, "the name of a predicate")
    parameters = read_typed_list(rest, source, variables=True, what="a parameter")
    return Predicate(name.text, _each_named(parameters, source), comment, node.location)


def _name_of_signature(node: Group, source: Source) -> Sequence[Node]:
    """Return the words before the parameters: a name with blanks, or the name alone where others are no part of it."""
    named = [*takewhile(lambda part: isinstance(part, Word) and part.text[0] not in "?-", node.parts)]
    words = [part.text for part in node.parts if isinstance(part, Word)]
    variables = words[len(named) : len(named) + 1]
    if len(named) < 2 or not variables or variables[0][0] != "?":
        return node.parts[:1]  # those are variables without a mark
    typed_before = words[1] in types_of(source) and "-" not in words
    return node.parts[:1] if typed_before else named


def _each_named(parameters: tuple[TypedName, ...], source: Source) -> tuple[TypedName, ...]:
    """Rename the second parameter of one name: in a declaration only their number and types count."""
    named: dict[str, TypedName] = {}
    for parameter in parameters:
        name = parameter.name
        if name in named:
            message = f'variable "{name}" stands twice in this declaration; some tools refuse that'
            source.warn(message, parameter.location, "rename one of them", "variable-twice")
            taken = {*named, *(other.name for other in parameters)}
            name = next(f"{name}{n}" for n in range(2, len(parameters) + 2) if f"{name}{n}" not in taken)
        named[name] = replace(parameter, name=name)
    return tuple(named.values())


def read_functions(group: Group, document: Document) -> tuple[Predicate, ...]:
    """Read ``(:functions ...)``, which are numbers, all of them."""
    source = document.source
    found: list[Predicate | None] = []
    nodes = list(group.parts[1:])
    while nodes:
        node = nodes.pop(0)
        if isinstance(node, Word):
            source.fault_at(f'expected (function ...), found "{node.text}"', node.location)
            continue
        found.append(source.recover(None, _read_signature, node, document))
        if nodes and isinstance(nodes[0], Word) and nodes[0].text == "-":
            value = nodes[1] if len(nodes) > 1 else nodes[0]
            if isinstance(value, Group) or value.text != "number":
                hint = "a function is a number"
                source.fault(unsupported(source, "object fluents", node.head, node.location, hint))
            del nodes[:2]
    return tuple(function for function in found if function)


def read_action(group: Group, source: Source) -> ActionSchema:
    """Read ``(:action name ...)``; what is left out is empty."""
    if len(group.parts) < 2:
        raise source.error("this action has no name", group.location)
    words = _words_before_keyword(group.parts[2:])
    named = [group.parts[1], *takewhile(lambda word: isinstance(word, Word) and word.text[0] != "?", words)]
    name = read_title(named, group.location, source, "the name of an action")
    parts = _parts_of_action(group, len(named) + 1, name.text, source)
    effects = Effects()
    precondition: Formula = TRUE
    parameters: tuple[TypedName, ...] = ()
    if ":effect" in parts:
        effects = source.recover(effects, read_effects, parts[":effect"], source)
    if ":precondition" in parts:
        precondition = source.recover(TRUE, read_condition, parts[":precondition"], source)
    if ":parameters" in parts:
        parameters = source.recover((), read_parameters, parts[":parameters"], source)
    if ":vars" in parts:  # not supported, which is reported once: its variables are known
        parameters += source.recover((), read_parameters, parts[":vars"], source)
    comment = _comment_above(group, source)
    return ActionSchema(name.text, parameters, precondition, tuple(effects.flat), effects.cost, name.location, comment)


def _after_parameters(nodes: list[Node], source: Source) -> list[Node]:
    """Return the parts of an action, which may begin with parameters without their keyword; that is reported."""
    first = nodes[0] if nodes else None
    start = first.parts[0] if isinstance(first, Group) and first.parts else first
    if not isinstance(start, Word) or start.text[0] != "?" or first is None:
        return nodes
    run = [first] if isinstance(first, Group) else _words_before_keyword(nodes)
    place, end = first.location, after(run[-1])
    if any(isinstance(node, Word) and node.text == ":parameters" for node in nodes):
        source.fault_at("this is no part of the name", place, 'remove it, or move it to ":parameters"')
        return nodes[len(run) :]
    opening, closing = ("", "") if isinstance(first, Group) else ("(", ")")
    blank = "" if source.lines[place.line - 1][: place.column - 1].endswith((" ", "\t")) else " "
    edits = [Edit(place, place, f"{blank}:parameters {opening}"), Edit(end, end, closing)]
    hint = f"write :parameters {opening}{source.text(place, end)}{closing}".replace(",", "")
    source.fault_at('":parameters" is missing here', place, hint, "syntax", edits)
    parameters = first if isinstance(first, Group) else Group(tuple(run), place, end, 2)
    return [Word(":parameters", place), parameters, *nodes[len(run) :]]


def _comment_above(group: Group, source: Source) -> str:
    """Return the comment in the lines right above a group."""
    above = reversed(source.lines[: group.location.line - 1])
    found = list(takewhile(lambda line: line.startswith(";"), map(str.strip, above)))
    return " ".join(line.lstrip(";").strip() for line in reversed(found))


def read_axiom(group: Group, source: Source) -> Axiom:
    """Read ``(:derived (predicate ?parameter ...) condition)``."""
    if len(group.parts) != 3 or not isinstance(group.parts[1], Group) or not group.parts[1].parts:
        hint = "write (:derived (predicate ?x) (condition ?x))"
        raise source.error("expected a predicate and its condition", group.location, hint)
    head = group.parts[1]
    name = read_name(head.parts[0], source, "the name of a predicate")
    terms = read_typed_list(head.parts[1:], source, variables=True, what="a parameter")
    parameters = {term.name: term for term in reversed(terms)}
    condition = read_condition(group.parts[2], source)
    atom = Atom(name.text, tuple(term.name for term in terms), head.location)
    return Axiom(atom, tuple(reversed(parameters.values())), condition, group.location)


def _with_declared_types(axiom: Axiom, predicates: Mapping[str, Predicate]) -> Axiom:
    """Give the parameters of an axiom without a type that of the declaration of their predicate."""
    declared = predicates.get(axiom.head.predicate)
    if declared is None or len(declared.parameters) != len(axiom.head.terms):
        return axiom
    types = dict(zip(axiom.head.terms, (p.types for p in declared.parameters), strict=True))
    untyped = (OBJECT,)
    named = tuple(replace(p, types=types[p.name]) if p.types == untyped else p for p in axiom.parameters)
    return replace(axiom, parameters=named)


def _parts_of_action(group: Group, begin: int, action: str, source: Source) -> dict[str, Node]:
    """Return the node after each keyword of an action, whose parts begin with number ``begin``."""
    parts: dict[str, Node] = {}
    nodes = _after_parameters(list(group.parts[begin:]), source)
    found: list[_Part] = []
    while nodes:
        keyword = nodes.pop(0)
        if isinstance(keyword, Group):
            _without_keyword(keyword, nodes, parts, source)
            continue
        value = nodes[0] if nodes else None
        if value is None or (isinstance(value, Word) and value.text.startswith(":")):
            empty, end = "()" if keyword.text == ":parameters" else "(and)", after(keyword)
            edits = [Edit(end, end, f" {empty}")] if keyword.text in PARTS else []
            hint = f"write {keyword.text} {empty}" if edits else None
            if keyword.text == ":parameters" and "?" in source.text(keyword.location, group.end):
                continue  # the variables without parameters are reported
            source.fault_at(f'nothing follows "{keyword.text}"', keyword.location, hint, "syntax", edits)
            continue
        value = _whole_value(keyword, value, nodes, source)
        source.recover(None, _known_part, keyword, action, parts, source)
        parts.setdefault(_part_meant(keyword.text), nodes.pop(0))
        if keyword.text in PARTS:
            found.append((PARTS.index(keyword.text), keyword.text, keyword.location, after(value)))
        else:  # what else belongs to it is not reported as well
            del nodes[: len(_words_before_keyword(nodes))]
    warn_of_order(found, source)
    return parts


def _whole_value(keyword: Word, value: Node, nodes: list[Node], source: Source) -> Node:
    """Return the value that ``nodes`` begin with, and keep it alone: it may lack parentheses, or a word before it."""
    if isinstance(value, Word) and value.text in DASHES and len(nodes) > 1:
        edits = [source.removal(value.location, after(value))]
        source.fault_once(f'"{value.text}" is not PDDL', value.location, "remove it", "other-notation", edits)
        value = nodes[1]
        del nodes[0]
    until = list(takewhile(lambda node: isinstance(node, Group) or not node.text.startswith(":"), nodes))
    whole: Node | None = None
    if keyword.text == ":parameters" and isinstance(value, Word) and value.text.startswith("?"):
        until = _words_before_keyword(nodes)
        whole = parameters_of_words(until, source)
    elif keyword.text in PARTS[1:] and len(until) > 1:
        whole = joined(until, source) or atom_of_words(until, source)
    if whole is None:
        return value
    nodes[: len(until)] = [whole]
    return whole


# The effects of STRIPS before PDDL.
_LISTS = frozenset({
    ":add", ":adds", ":add-list", ":add-effect", ":add-effects", ":del", ":dels", ":delete", ":deletes", ":del-list",
    ":delete-list", ":del-effect", ":del-effects", ":delete-effect", ":delete-effects",
})  # fmt: skip
_EFFECT = "write :effect (and (added ...) (not (deleted ...)))"


def _part_meant(keyword: str) -> str:
    """Return the part of an action that a keyword means, so that its value is not reported as missing as well."""
    if keyword in PARTS or (keyword in UNSUPPORTED and keyword != ":condition") or keyword.replace("_", "-") in _LISTS:
        return keyword
    return meant(keyword, PARTS) or keyword


def _words_before_keyword(nodes: Sequence[Node]) -> list[Node]:
    """Return the words up to a keyword; one that lacks its colon stands before a group."""
    words = list(takewhile(lambda node: isinstance(node, Word) and not node.text.startswith(":"), nodes))
    group = len(words) < len(nodes) and isinstance(nodes[len(words)], Group)
    last = words[-1] if words else None
    return words[:-1] if group and isinstance(last, Word) and f":{last.text}" in PARTS else words


def _without_keyword(group: Group, nodes: list[Node], parts: dict[str, Node], source: Source) -> None:
    """Report a group without a keyword before it, and those that follow: several conditions or effects."""
    more = list(takewhile(lambda node: isinstance(node, Group), nodes))
    del nodes[: len(more)]
    message = "expected :parameters, :precondition or :effect, found a parenthesis"
    last = next(reversed(parts)) if parts else ""
    if last not in (":precondition", ":effect"):
        hint = "use (and (...) (...)) for several conditions or effects"
        source.fault_at(message, group.location, hint)
        return
    several = [parts[last], group, *more]
    parts[last] = conjoined(f'"{last}" takes one part, found {len(several)}', several, source)


_Part: TypeAlias = tuple[int, str, Location, Location]
"""A part of a text: its rank in the usual order, its name, its beginning and its end."""


def warn_of_order(found: Sequence[_Part], source: Source) -> None:
    """Warn of parts that stand in another order than other planners need."""
    for (before, other, *_), (rank, name, start, _) in pairwise(found):
        if rank < before:
            pairs = zip(found, sorted(found, key=lambda part: part[0]), strict=True)
            edits = [Edit(*old[2:], source.text(*new[2:])) for old, new in pairs if old != new]
            message = f'"{name}" stands after "{other}", which other planners refuse'
            source.warn(message, start, f'put "{name}" before it', "section-order", edits)
            return


def _meant(word: Word, names: Sequence[str], what: str = "declared") -> tuple[str | None, list[Edit]]:
    """Return the hint and the edit that put the nearest of ``names`` for a keyword of PDDL that is misspelt."""
    name = meant(word.text, names)
    return (f'did you mean "{name}"?', [replaced(word, name)]) if name else (nearest(word.text, names, what=what), [])


def _known_part(keyword: Word, action: str, seen: dict[str, Node], source: Source) -> None:
    if keyword.text in UNSUPPORTED and (keyword.text != ":condition" or ":duration" in seen):
        raise unsupported(source, UNSUPPORTED[keyword.text], keyword.text, keyword.location)
    if keyword.text.replace("_", "-") in _LISTS:
        message = "an action of PDDL has no lists of what is added and deleted"
        source.fault_once(message, keyword.location, _EFFECT, "unknown-keyword", ())
        return
    if keyword.text not in PARTS:
        hint, edits = _meant(keyword, PARTS, "parts of an action")
        message = f'"{keyword.text}" is not a part of an action'
        source.fault_once(message, keyword.location, hint, "unknown-keyword", edits)
    if keyword.text in seen:
        message = f'"{keyword.text}" appears twice in action "{action}"'
        raise source.error(message, keyword.location, code="duplicate-section")


def read_domain_name(group: Group, domain: Domain, source: Source) -> str:
    """Read ``(:domain name)``, which must name ``domain``."""
    name = read_title(group.parts[1:], group.location, source, "the name of a domain")
    if name.text != domain.name:
        source.fault_at(
            f'the problem is of domain "{name.text}", the domain given is "{domain.name}"',
            name.location,
            f'did you mean "{domain.name}"?',
            "domain-mismatch",
        )
    return name.text


def read_metric(group: Group, source: Source) -> bool:
    """Read ``(:metric minimize (total-cost))``, the one that is supported."""
    words = [n.head if isinstance(n, Group) else n.text for n in group.parts[1:]]
    if words == ["minimize", TOTAL_COST]:
        return True
    hint, edits = f"write (:metric minimize ({TOTAL_COST}))", []
    if words[1:] == [TOTAL_COST] and words[0] in ("min", "minimise", "minimized", "minimizing"):
        edits = [replaced(group.parts[1], "minimize")]
        source.fault_at(f'"{words[0]}" is not a word of PDDL', group.parts[1].location, hint, "syntax", edits)
        return True
    raise unsupported(source, "other metrics", " ".join(words), group.location, hint)


def read_domain(path: str | Path) -> Domain:
    """Return the domain in the file at ``path``.

    Raises:
        TmdError: The file cannot be read, is not PDDL, or has a fault.
    """
    return parse_domain(read_text(path), str(path))


def read_problem(path: str | Path, domain: Domain) -> Problem:
    """Return the problem in the file at ``path``.

    Raises:
        TmdError: The file cannot be read, is not PDDL, has a fault, or belongs to another domain.
    """
    return parse_problem(read_text(path), domain, str(path))


@lru_cache(maxsize=8)  # compiling, checking and grounding read the same domain in one run
def parse_domain(text: str, file: str = "<text>") -> Domain:
    """Return the domain that ``text`` describes; ``file`` names it in errors."""
    domain, source = parse_domain_unchecked(text, file)
    _raise_first(check_domain(domain, source))
    return domain


def parse_problem(text: str, domain: Domain, file: str = "<text>") -> Problem:
    """Return the problem that ``text`` describes; ``file`` names it in errors."""
    problem, source = parse_problem_unchecked(text, domain, file)
    _raise_first(check_problem(problem, source))
    return replace(problem, init=close(problem.init, problem)) if domain.derived else problem


def _raise_first(faults: list[TmdError]) -> None:
    """Raise the first fault. Undeclared requirements pass: all planners accept that."""
    for fault in faults:
        if fault.code != "missing-requirement":
            raise fault


def parse_domain_unchecked(text: str, file: str = "<text>", report: Report | None = None) -> tuple[Domain, Source]:
    """Return the domain that ``text`` describes, before its meaning is checked, and the text's lines.

    Where there is a ``report``, it gets every fault, and only a text without any domain is an error.

    Raises:
        TmdError: It is not PDDL, or not of the supported part.
    """
    document = parse(text, file, report, definition=True)
    source = document.source
    name, sections = _definition(document, "domain")
    parts: dict[str, Any] = {}
    actions: list[ActionSchema] = []
    axioms: list[Axiom] = []
    readers: dict[str, Callable[[Group], object]] = {
        ":requirements": lambda g: read_requirements(g, source),
        ":types": lambda g: read_types(g, source),
        ":constants": lambda g: read_typed_list(g.parts[1:], source, variables=False, what="a constant"),
        ":predicates": lambda g: read_predicates(g, document),
        ":functions": lambda g: read_functions(g, document),
        ":derived": lambda g: axioms.append(read_axiom(g, source)),
        ":action": lambda g: actions.append(read_action(g, source)),
    }
    _read_sections(sections, readers, parts, source)
    keywords = {keyword.removeprefix(":"): value for keyword, value in parts.items()}
    predicates = {p.name: p for p in keywords.get("predicates", ())}
    derived = tuple(_with_declared_types(axiom, predicates) for axiom in axioms)
    return Domain(name.text, **keywords, actions=tuple(actions), derived=derived, location=name.location), source


def parse_problem_unchecked(
    text: str, domain: Domain, file: str = "<text>", report: Report | None = None
) -> tuple[Problem, Source]:
    """Return the problem that ``text`` describes, before its meaning is checked, and the text's lines.

    Where there is a ``report``, it gets every fault, and only a text without any problem is an error.

    Raises:
        TmdError: It is not PDDL, not of the supported part, or belongs to another domain.
    """
    document = parse(text, file, report, definition=True)
    source = document.source
    name, sections = _definition(document, "problem")
    init = InitReader(source, domain)
    parts: dict[str, Any] = {}
    readers: dict[str, Callable[[Group], object]] = {
        ":domain": lambda g: read_domain_name(g, domain, source),
        ":requirements": lambda g: read_requirements(g, source),
        ":objects": lambda g: read_typed_list(g.parts[1:], source, variables=False, what="an object"),
        ":init": init.read,
        ":goal": lambda g: read_condition(only_part(g, source), source),
        ":metric": lambda g: read_metric(g, source) and g.location,
    }
    _read_sections(sections, readers, parts, source)
    heads = {section.head for section in sections}
    for needed in (":domain", ":goal"):
        if needed not in heads:
            message = f"the problem has no ({needed} ...)"
            known = needed == ":domain"
            edits = [source.declaration(needed, domain.name)] if known else []
            hint = f"add (:domain {domain.name})" if known else "add it"
            source.fault_at(message, name.location, hint, "missing-section", edits)
    problem = Problem(
        name.text,
        domain,
        objects=parts.get(":objects", ()),
        init=frozenset(init.atoms),
        goal=parts.get(":goal", TRUE),
        function_values=init.values,
        minimize_cost=":metric" in parts,
        metric_location=parts.get(":metric"),
        requirements=parts.get(":requirements", ()),
        location=name.location,
        init_locations=init.locations,
        init_denied=frozenset(init.denied),
    )
    return problem, source


def _read_sections(
    sections: list[Group], readers: dict[str, Callable[[Group], object]], parts: dict[str, Any], source: Source
) -> None:
    """Read every section into ``parts``; those of which there are many go where their reader puts them."""

    def read(group: Group) -> None:
        section = _section(group, tuple(readers), parts, source)
        parts[section] = readers[section](group)
        if section in (":action", ":derived"):
            del parts[section]

    for group in sections:
        source.recover(None, read, group)
    ranks = _RANKS_OF_PROBLEM if ":goal" in readers else _RANKS_OF_DOMAIN
    found = [(ranks[group.head], group.head, group.location, after(group)) for group in sections if group.head in ranks]
    warn_of_order(found, source)


# The order of sections that all planners read; those of one rank in any order.
_RANKS_OF_DOMAIN = {
    **dict.fromkeys((":requirements", ":types", ":constants", ":predicates", ":functions"), 0),
    **dict.fromkeys((":derived", ":action"), 1),
}
_RANKS_OF_PROBLEM = {":domain": 0, ":requirements": 1, ":objects": 1, ":init": 2, ":goal": 3, ":metric": 4}


def _definition(document: Document, kind: str) -> tuple[Word, list[Group]]:
    """Return the name and sections of ``(define (kind name) section ...)``."""
    source = document.source
    if not document.groups:
        hint = f"write (define ({kind} name) ...)"
        raise source.error(f"there is no {kind} here", Location(source.file, 1, 1), hint, "empty-file")
    first = document.groups[0]
    document.check_depth()
    if len(document.groups) > 1:
        source.closed_too_early(first)
    other = "problem" if kind == "domain" else "domain"
    hint = f"write (define ({kind} name) ...)"
    if any(isinstance(part, Group) and part.head == other for part in first.parts[1:2]):
        hint = f"this is a {other}: name the file of the {kind}"
    if len(first.parts) < 2 or not _is_word(first.parts[0], "define", source):
        raise source.error(f"expected (define ({kind} name) ...)", first.location, hint)
    title, sections = _titled(first.parts[1:], kind, hint, source)
    name = read_title(title.parts[1:], title.location, source, f"the name of a {kind}")
    groups = _sections(sections, source)
    _of_kind(kind, title.parts[0], name.text, groups, source)
    return name, groups


def _titled(parts: Sequence[Node], kind: str, hint: str, source: Source) -> tuple[Group, list[Node]]:
    """Return the title of a definition, with its kind and a name, and the sections behind it."""
    title, *sections = parts
    if isinstance(title, Word) and title.text == kind and sections and isinstance(sections[0], Word):
        name = sections.pop(0)
        start, end, edits = title.location, after(name), enclosed(title, name)
        message, hint_here = f"the name of the {kind} stands in parentheses", f"write ({source.text(start, end)})"
        source.fault_at(message, start, hint_here, "syntax", edits)
        title = Group((title, name), start, end, 1)
    if isinstance(title, Group) and title.head == f":{kind}":
        message, edit = f"expected ({kind} name), found (:{kind} ...)", replaced(title.parts[0], kind)
        source.fault_at(message, title.location, f'write "{kind}" without a colon', edits=[edit])
        title = replace(title, parts=(Word(kind, title.parts[0].location), *title.parts[1:]))
    if not isinstance(title, Group) or not title.parts or not _is_word(title.parts[0], kind, source):
        found = f", found ({title.head} ...)" if isinstance(title, Group) and title.head else ""
        raise source.error(f"expected ({kind} name){found}", title.location, hint)
    if len(title.parts) < 2:
        raise source.error(f"this {kind} has no name", title.location, f"write ({kind} name)")
    return title, sections


def _is_word(node: Node, wanted: str, source: Source) -> bool:
    """Return whether a node is the word ``wanted``, perhaps misspelt, which is reported."""
    if not isinstance(node, Word) or (node.text != wanted and not get_close_matches(node.text, [wanted])):
        return False
    if node.text != wanted and node.text in ("domain", "problem"):
        return False
    if node.text != wanted:
        message, edits = f'"{node.text}" is not a word of PDDL', [replaced(node, wanted)]
        source.fault_at(message, node.location, f'did you mean "{wanted}"?', "syntax", edits)
    return True


def _sections(nodes: Sequence[Node], source: Source) -> list[Group]:
    """Return the sections of a definition; the words between them are reported."""
    for words, run in groupby(nodes, lambda node: isinstance(node, Word)):
        if words:
            _outside([node for node in run if isinstance(node, Word)], source)
    return [node for node in nodes if isinstance(node, Group)]


def _outside(words: Sequence[Word], source: Source) -> None:
    """Report words between the sections of a definition: a sentence, or what a parenthesis too many left over."""
    first, last = words[0], words[-1]
    if len(words) > 1 and all(word.text[0] not in ":?" for word in words):
        ends = source.lines[last.location.line - 1][after(last).column - 1 :].strip()
        starts = sorted({word.location.line: word.location for word in reversed(words)}.values())
        edits = [Edit(start, start, "; ") for start in starts]
        edits += [Edit(after(last), after(last), "\n")] if ends else []
        source.fault_at("this text is not PDDL", first.location, 'write ";" before it', "foreign-text", edits)
        return
    for word in words:
        if not word.text.strip("."):
            edits = [replaced(word, f"; {word.text}\n")]
            source.fault_at("something is left out here", word.location, "write it", "syntax", edits)
            continue
        message, hint = f'"{word.text}" stands outside its section', "a parenthesis before it is too many"
        source.fault_at(message, word.location, hint)


def _of_kind(kind: str, named: Node, name: str, sections: Sequence[Group], source: Source) -> None:
    """Make sure that a definition has not the sections of the other kind only."""
    heads = {section.head for section in sections} - {":requirements"}
    own, other = _RANKS_OF_DOMAIN, _RANKS_OF_PROBLEM
    needed, meant = {":init", ":goal"}, "problem"
    if kind == "problem":
        own, other, needed, meant = other, own, {":predicates", ":action"}, "domain"
    if needed <= heads and heads <= other.keys() and not heads & own.keys():
        hint, edits = f"write (define ({meant} {name}) ...)", [replaced(named, meant)]
        raise source.error(f"this is a {meant}, and is called a {kind}", named.location, hint, "syntax", edits)


def _section(group: Group, known: tuple[str, ...], seen: dict[str, Any], source: Source) -> str:
    head = group.head
    if head in UNSUPPORTED:
        raise unsupported(source, UNSUPPORTED[head], head, group.location)
    if head not in known:
        shown = f'"({head} ...)"' if head else "this group"
        other = "problem" if ":action" in known else "domain"
        if head in (*_RANKS_OF_DOMAIN, *_RANKS_OF_PROBLEM):
            message = f"{shown} belongs in the {other}"
            edits: list[Edit] = []
            hint = f"move it to the file of the {other}"
            if head == ":objects":
                hint += ", or name it (:constants ...)"
                edits = [replaced(group.parts[0], ":constants")]
            raise source.error(message, group.location, hint, "unknown-section", edits)
        word = group.parts[0] if head else None
        nearby, edits = nearest(head, known, what="sections"), []
        if isinstance(word, Word) and (head[0] == ":" or f":{head}" in known):
            nearby, edits = _meant(word, known, "sections")
        raise source.error(f"{shown} is not a section", group.location, nearby, "unknown-section", edits)
    if head in seen:
        edits = list(_moved(group, source.sections[head], source)) if head in _LISTED else []
        message = f'the section "{head}" appears twice'
        raise source.error(message, group.location, "join the two", "duplicate-section", edits)
    return head


# The sections that are lists, of which two are one.
_LISTED = frozenset({":requirements", ":types", ":constants", ":predicates", ":functions", ":objects", ":init"})


def _moved(group: Group, first: Group, source: Source) -> Iterator[Edit]:
    """Yield the edits that move what is in a section to the end of the first one of its name."""
    content = source.text(after(group.parts[0]), group.end).strip()
    end = "\n" if ";" in content.rpartition("\n")[2] else ""
    yield Edit(first.end, first.end, f"\n    {content}{end}")
    yield source.removal(group.location, after(group))


PLACE = "--goal"
"""What a goal is called in errors where nothing else is said."""


def with_goal(problem: Problem, text: str, file: str = PLACE) -> Problem:
    """Replace the goal by that of ``text``, such as ``(contains mug1 coffee)``; ``file`` names it in errors.

    A goal may use ``exists``, ``forall`` and the like with any ``:requirements`` of the domain: the problem declares
    those that the domain does not.

    Raises:
        TmdError: It is not a condition, or speaks of what the problem does not have.
    """
    document = parse(text, file)
    return aimed_at(problem, read_only_condition(document), document.source)


def aimed_at(problem: Problem, goal: Formula, source: Source | None = None) -> Problem:
    """Return ``problem`` with a goal, and with the requirements that this goal needs.

    Raises:
        TmdError: The goal speaks of what the problem does not have.
    """
    aimed = replace(problem, goal=goal)
    aimed = replace(aimed, requirements=(*aimed.requirements, *undeclared_requirements(aimed)))
    for fault in check_problem(aimed, source):
        if source is not None:
            fault.source = source.line(fault.location)
        raise fault
    return aimed
