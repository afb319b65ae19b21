"""Reading PDDL domains and problems.

Supported: typed ADL with action costs. Everything else is refused by its name. What is read is checked by
:mod:`tmd.pddl.check`, and the first fault is raised with its source line. All names become lower case.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from tmd.errors import Location, TmdError
from tmd.pddl.check import check_domain, check_problem
from tmd.pddl.hierarchy import parents_first
from tmd.pddl.model import (
    OBJECT,
    TOTAL_COST,
    TRUE,
    ActionSchema,
    Domain,
    Formula,
    GroundAtom,
    Predicate,
    Problem,
    TypeDeclaration,
)
from tmd.pddl.read_formula import (
    Effects,
    read_atom,
    read_condition,
    read_effects,
    read_name,
    read_number,
    read_parameters,
    read_typed_list,
    unsupported,
)
from tmd.pddl.syntax import Document, Group, Node, Source, Word, nearest, parse, read_text

_DEEPEST = 100
_DOMAIN_SECTIONS = (":requirements", ":types", ":constants", ":predicates", ":functions", ":action")
_PROBLEM_SECTIONS = (":domain", ":requirements", ":objects", ":init", ":goal", ":metric")
_UNSUPPORTED_SECTIONS = {
    ":derived": "derived predicates",
    ":durative-action": "durative actions",
    ":process": "processes",
    ":event": "events",
    ":constraints": "trajectory constraints",
    ":length": "plan length limits",
}


def read_domain(path: str | Path) -> Domain:
    """The domain in the file at ``path``.

    Raises:
        TmdError: The file cannot be read, is not PDDL, or has a fault.
    """
    return parse_domain(read_text(path), str(path))


def read_problem(path: str | Path, domain: Domain) -> Problem:
    """The problem in the file at ``path``.

    Raises:
        TmdError: The file cannot be read, is not PDDL, has a fault, or belongs to another domain.
    """
    return parse_problem(read_text(path), domain, str(path))


def parse_domain(text: str, file: str = "<text>") -> Domain:
    """The domain that ``text`` describes; ``file`` names it in errors."""
    domain, source = parse_domain_unchecked(text, file)
    _raise_first(check_domain(domain), source)
    return domain


def parse_problem(text: str, domain: Domain, file: str = "<text>") -> Problem:
    """The problem that ``text`` describes; ``file`` names it in errors."""
    problem, source = parse_problem_unchecked(text, domain, file)
    _raise_first(check_problem(problem), source)
    return problem


def _raise_first(faults: list[TmdError], source: Source) -> None:
    if faults:
        first = faults[0]
        first.source = source.line(first.location)
        raise first


def parse_domain_unchecked(text: str, file: str = "<text>") -> tuple[Domain, Source]:
    """The domain that ``text`` describes, before its meaning is checked, and the text's lines.

    Raises:
        TmdError: It is not PDDL, or not of the supported part.
    """
    document = parse(text, file)
    source = document.source
    name, sections = _definition(document, "domain")
    parts: dict[str, Any] = {}
    actions: list[ActionSchema] = []
    readers: dict[str, Callable[[Group], object]] = {
        ":requirements": lambda g: _read_requirements(g, source),
        ":types": lambda g: _read_types(g, source),
        ":constants": lambda g: read_typed_list(g.parts[1:], source, variables=False, what="a constant"),
        ":predicates": lambda g: _read_predicates(g, document),
        ":functions": lambda g: _read_functions(g, document),
        ":action": lambda g: actions.append(_read_action(g, source)),
    }
    for group in sections:
        section = _section(group, _DOMAIN_SECTIONS, parts, source)
        value = readers[section](group)
        if section != ":action":
            parts[section] = value
    keywords = {keyword.removeprefix(":"): value for keyword, value in parts.items()}
    return Domain(name.text, **keywords, actions=tuple(actions), location=name.location), source


def parse_problem_unchecked(text: str, domain: Domain, file: str = "<text>") -> tuple[Problem, Source]:
    """The problem that ``text`` describes, before its meaning is checked, and the text's lines.

    Raises:
        TmdError: It is not PDDL, not of the supported part, or belongs to another domain.
    """
    document = parse(text, file)
    source = document.source
    name, sections = _definition(document, "problem")
    init = _Init(source)
    parts: dict[str, Any] = {}
    readers: dict[str, Callable[[Group], object]] = {
        ":domain": lambda g: _read_domain_name(g, domain, source),
        ":requirements": lambda g: _read_requirements(g, source),
        ":objects": lambda g: read_typed_list(g.parts[1:], source, variables=False, what="an object"),
        ":init": init.read,
        ":goal": lambda g: read_condition(_only_part(g, source), source),
        ":metric": lambda g: _read_metric(g, source),
    }
    for group in sections:
        section = _section(group, _PROBLEM_SECTIONS, parts, source)
        parts[section] = readers[section](group)
    for needed in (":domain", ":goal"):
        if needed not in parts:
            raise source.error(f"the problem has no ({needed} ...)", name.location)
    problem = Problem(
        name.text,
        domain,
        objects=parts.get(":objects", ()),
        init=frozenset(init.atoms),
        goal=parts[":goal"],
        function_values=init.values,
        minimize_cost=parts.get(":metric", False),
        requirements=parts.get(":requirements", ()),
        location=name.location,
        init_locations=init.locations,
    )
    return problem, source


def _definition(document: Document, kind: str) -> tuple[Word, list[Group]]:
    """The name and sections of ``(define (kind name) section ...)``."""
    source = document.source
    if not document.groups:
        raise source.error(f"there is no {kind} here", Location(source.file, 1, 1), f"write (define ({kind} name) ...)")
    first = document.groups[0]
    if document.deepest is not None and document.deepest.depth > _DEEPEST:
        raise source.error(f"nested more than {_DEEPEST} levels deep", document.deepest.location)
    if len(document.groups) > 1:
        raise source.error(
            f'this parenthesis closes "({first.head}" too early: more text follows',
            first.end,
            'a ")" before it is too many',
        )
    if first.head != "define" or len(first.parts) < 2:
        raise source.error(f"expected (define ({kind} name) ...)", first.location)
    title, *sections = first.parts[1:]
    if not isinstance(title, Group) or title.head != kind or len(title.parts) != 2:
        found = f", found ({title.head} ...)" if isinstance(title, Group) else ""
        raise source.error(f"expected ({kind} name){found}", title.location)
    name = read_name(title.parts[1], source, f"the name of a {kind}")
    for section in sections:
        if isinstance(section, Word):
            raise source.error(
                f'"{section.text}" stands outside its section',
                section.location,
                "a parenthesis before it is too many",
            )
    return name, [s for s in sections if isinstance(s, Group)]


def _section(group: Group, known: tuple[str, ...], seen: dict[str, Any], source: Source) -> str:
    head = group.head
    if head in _UNSUPPORTED_SECTIONS:
        raise unsupported(source, _UNSUPPORTED_SECTIONS[head], head, group.location)
    if head not in known:
        shown = f'"({head} ...)"' if head else "this group"
        raise source.error(f"{shown} is not a section", group.location, nearest(head, known, what="sections"))
    if head in seen:
        raise source.error(f'the section "{head}" appears twice', group.location)
    return head


def _only_part(group: Group, source: Source) -> Node:
    if len(group.parts) != 2:
        raise source.error(
            f'"{group.head}" takes one part, found {len(group.parts) - 1}', group.location, "use (and ...)"
        )
    return group.parts[1]


def _read_requirements(group: Group, source: Source) -> tuple[str, ...]:
    names: list[str] = []
    for node in group.parts[1:]:
        if isinstance(node, Group) or not node.text.startswith(":"):
            raise source.error("a requirement begins with a colon", node.location)
        if node.text in _UNSUPPORTED_REQUIREMENTS:
            raise unsupported(source, _UNSUPPORTED_REQUIREMENTS[node.text], node.text, node.location)
        if node.text not in REQUIREMENTS:
            raise source.error(
                f'"{node.text}" is not a known requirement', node.location, nearest(node.text, REQUIREMENTS)
            )
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
)
_UNSUPPORTED_REQUIREMENTS = {
    ":derived-predicates": "derived predicates",
    ":domain-axioms": "derived predicates",
    ":durative-actions": "durative actions",
    ":duration-inequalities": "durative actions",
    ":continuous-effects": "continuous effects",
    ":timed-initial-literals": "timed initial literals",
    ":timed-initial-effects": "timed initial literals",
    ":time": "processes and events",
    ":fluents": "numeric fluents",
    ":numeric-fluents": "numeric fluents",
    ":object-fluents": "object fluents",
    ":preferences": "preferences",
    ":constraints": "trajectory constraints",
    ":non-deterministic": "non-deterministic effects",
}


def _read_types(group: Group, source: Source) -> tuple[TypeDeclaration, ...]:
    found = []
    for typed in read_typed_list(group.parts[1:], source, variables=False, what="a type"):
        if len(typed.types) > 1:
            raise unsupported(source, "types with several parents", typed.name, typed.location or group.location)
        if typed.name != OBJECT:
            found.append(TypeDeclaration(typed.name, typed.types[0], typed.location))
        elif typed.types[0] != OBJECT:
            raise source.error('"object" is the root of all types and has no parent', typed.location)
    return parents_first(found)


def _read_predicates(group: Group, document: Document) -> tuple[Predicate, ...]:
    declared = group.parts[1:]
    following = [*(n.location.line for n in declared[1:]), group.end.line + 1]
    found = []
    for node, next_line in zip(declared, following, strict=True):
        if isinstance(node, Word):
            raise document.source.error(f'expected (predicate ...), found "{node.text}"', node.location)
        last = node.end.line != next_line
        found.append(_read_signature(node, document, comment=document.comments.get(node.end.line, "") if last else ""))
    return tuple(found)


def _read_signature(node: Group, document: Document, comment: str = "") -> Predicate:
    source = document.source
    if not node.parts:
        raise source.error("expected (name ?parameter ...), found ()", node.location)
    name = read_name(node.parts[0], source, "the name of a predicate")
    parameters = read_typed_list(node.parts[1:], source, variables=True, what="a parameter")
    return Predicate(name.text, parameters, comment, node.location)


def _read_functions(group: Group, document: Document) -> tuple[Predicate, ...]:
    found = []
    nodes = list(group.parts[1:])
    while nodes:
        node = nodes.pop(0)
        if isinstance(node, Word):
            raise document.source.error(f'expected (function ...), found "{node.text}"', node.location)
        found.append(_read_signature(node, document))
        if nodes and isinstance(nodes[0], Word) and nodes[0].text == "-":
            value = nodes[1] if len(nodes) > 1 else nodes[0]
            if isinstance(value, Group) or value.text != "number":
                raise unsupported(document.source, "object fluents", node.head, node.location, "a function is a number")
            del nodes[:2]
    return tuple(found)


def _read_action(group: Group, source: Source) -> ActionSchema:
    if len(group.parts) < 2:
        raise source.error("this action has no name", group.location)
    name = read_name(group.parts[1], source, "the name of an action")
    parts: dict[str, Node] = {}
    nodes = iter(group.parts[2:])
    for keyword in nodes:
        if isinstance(keyword, Group):
            raise source.error("expected :parameters, :precondition or :effect, found a parenthesis", keyword.location)
        known = (":parameters", ":precondition", ":effect")
        if keyword.text not in known:
            raise source.error(
                f'"{keyword.text}" is not a part of an action', keyword.location, nearest(keyword.text, known)
            )
        if keyword.text in parts:
            raise source.error(f'"{keyword.text}" appears twice in action "{name.text}"', keyword.location)
        value = next(nodes, None)
        if value is None or (isinstance(value, Word) and value.text.startswith(":")):
            raise source.error(f'nothing follows "{keyword.text}"', keyword.location)
        parts[keyword.text] = value
    effects = read_effects(parts[":effect"], source) if ":effect" in parts else Effects()
    precondition: Formula = TRUE
    if ":precondition" in parts:
        precondition = read_condition(parts[":precondition"], source)
    parameters = read_parameters(parts[":parameters"], source) if ":parameters" in parts else ()
    return ActionSchema(name.text, parameters, precondition, tuple(effects.flat), effects.cost, name.location)


def _read_domain_name(group: Group, domain: Domain, source: Source) -> str:
    name = read_name(_only_part(group, source), source, "the name of a domain")
    if name.text != domain.name:
        raise source.error(
            f'the problem is of domain "{name.text}", the domain given is "{domain.name}"',
            name.location,
            f"write (:domain {domain.name})",
        )
    return name.text


def _read_metric(group: Group, source: Source) -> bool:
    words = [n.head if isinstance(n, Group) else n.text for n in group.parts[1:]]
    if words == ["minimize", TOTAL_COST]:
        return True
    raise unsupported(
        source, "other metrics", " ".join(words), group.location, f"write (:metric minimize ({TOTAL_COST}))"
    )


class _Init:
    """Collects the initial state, where each entry stands, and the values of cost functions."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.atoms: dict[GroundAtom, None] = {}
        self.denied: dict[GroundAtom, None] = {}
        self.values: dict[GroundAtom, int] = {}
        self.locations: dict[GroundAtom, Location] = {}

    def read(self, group: Group) -> None:
        for node in _spread(group.parts[1:]):
            if isinstance(node, Word):
                raise self.source.error(f'expected an atom, found "{node.text}"', node.location, f"write ({node.text})")
            self._read_entry(node)
        for atom in self.denied:
            if atom in self.atoms:
                raise self._contradiction(atom)

    def _read_entry(self, node: Group) -> None:
        if node.head == "=":
            self._read_value(node)
        elif node.head == "at" and len(node.parts) == 3 and read_number(node.parts[1], self.source) is not None:
            raise unsupported(self.source, "timed initial literals", "at", node.location)
        elif node.head == "not":
            inner = _only_part(node, self.source)
            if isinstance(inner, Word):
                raise self.source.error("expected (not (predicate ...))", inner.location)
            self.denied[self._ground(inner)] = None
        elif node.head in ("or", "oneof", "forall", "exists", "imply", "when"):
            raise self.source.error(f'"{node.head}" cannot stand in :init', node.location, "list the atoms that hold")
        else:
            self.atoms[self._ground(node)] = None

    def _ground(self, node: Group) -> GroundAtom:
        atom = read_atom(node, self.source)
        for term in atom.terms:
            if term.startswith("?"):
                raise self.source.error(f'variable "{term}" in :init', node.location, "write the name of an object")
        ground = GroundAtom(atom.predicate, atom.terms)
        self.locations.setdefault(ground, node.location)
        return ground

    def _read_value(self, node: Group) -> None:
        if len(node.parts) != 3 or isinstance(node.parts[1], Word):
            raise self.source.error("expected (= (function object ...) number)", node.location)
        number = read_number(node.parts[2], self.source)
        if number is None:
            raise unsupported(self.source, "object fluents", node.parts[1].head, node.location, "give a number")
        function = self._ground(node.parts[1])
        if function == GroundAtom(TOTAL_COST):
            if number:
                raise self.source.error(f"{TOTAL_COST} begins at 0", node.location)
            return
        if function in self.values:
            raise self.source.error(f"the value of {function} is given twice", node.location)
        self.values[function] = number

    def _contradiction(self, atom: GroundAtom) -> TmdError:
        return self.source.error(f"{atom} is said to hold and not to hold", self.locations[atom])


def _spread(nodes: Iterable[Node]) -> list[Node]:
    """``(and a b)`` in :init is the same as ``a b``."""
    found: list[Node] = []
    for node in nodes:
        found.extend(node.parts[1:] if isinstance(node, Group) and node.head == "and" else [node])
    return found
