"""Reading the sections of a domain or problem, except the initial state."""

from __future__ import annotations

from tmd.pddl.hierarchy import parents_first
from tmd.pddl.model import OBJECT, TOTAL_COST, TRUE, ActionSchema, Domain, Formula, Predicate, TypeDeclaration
from tmd.pddl.read_formula import Effects, read_condition, read_effects
from tmd.pddl.read_names import read_name, read_parameters, read_typed_list, unsupported
from tmd.pddl.syntax import Document, Group, Node, Source, Word, nearest


def only_part(group: Group, source: Source) -> Node:
    """The one part that ``group`` must have."""
    if len(group.parts) != 2:
        raise source.error(
            f'"{group.head}" takes one part, found {len(group.parts) - 1}', group.location, "use (and ...)"
        )
    return group.parts[1]


def read_requirements(group: Group, source: Source) -> tuple[str, ...]:
    """``(:requirements ...)``, each once."""
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


def read_types(group: Group, source: Source) -> tuple[TypeDeclaration, ...]:
    """``(:types ...)``, parents before children."""
    found = []
    for typed in read_typed_list(group.parts[1:], source, variables=False, what="a type"):
        if len(typed.types) > 1:
            raise unsupported(source, "types with several parents", typed.name, typed.location or group.location)
        if typed.name != OBJECT:
            found.append(TypeDeclaration(typed.name, typed.types[0], typed.location))
        elif typed.types[0] != OBJECT:
            raise source.error('"object" is the root of all types and has no parent', typed.location)
    return parents_first(found)


def read_predicates(group: Group, document: Document) -> tuple[Predicate, ...]:
    """``(:predicates ...)``, each with the comment that stands beside it."""
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


def read_functions(group: Group, document: Document) -> tuple[Predicate, ...]:
    """``(:functions ...)``, which are numbers, all of them."""
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


def read_action(group: Group, source: Source) -> ActionSchema:
    """``(:action name ...)``; what is left out is empty."""
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


def read_domain_name(group: Group, domain: Domain, source: Source) -> str:
    """``(:domain name)``, which must name ``domain``."""
    name = read_name(only_part(group, source), source, "the name of a domain")
    if name.text != domain.name:
        raise source.error(
            f'the problem is of domain "{name.text}", the domain given is "{domain.name}"',
            name.location,
            f"write (:domain {domain.name})",
        )
    return name.text


def read_metric(group: Group, source: Source) -> bool:
    """``(:metric minimize (total-cost))``, the one that is supported."""
    words = [n.head if isinstance(n, Group) else n.text for n in group.parts[1:]]
    if words == ["minimize", TOTAL_COST]:
        return True
    raise unsupported(
        source, "other metrics", " ".join(words), group.location, f"write (:metric minimize ({TOTAL_COST}))"
    )
