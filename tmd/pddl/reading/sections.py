"""Reading the sections of a domain or problem, except the initial state."""

from __future__ import annotations

from tmd.pddl.model import (
    OBJECT,
    TOTAL_COST,
    TRUE,
    ActionSchema,
    Domain,
    Formula,
    Predicate,
    TypeDeclaration,
    TypedName,
    parents_first,
)
from tmd.pddl.reading.formulas import (
    Effects,
    read_condition,
    read_effects,
    read_name,
    read_parameters,
    read_typed_list,
    unsupported,
)
from tmd.pddl.reading.syntax import Document, Group, Node, Source, Word, nearest


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
            source.fault(source.error("a requirement begins with a colon", node.location))
            continue
        if node.text in _UNSUPPORTED_REQUIREMENTS:
            what = _UNSUPPORTED_REQUIREMENTS[node.text]
            source.warn(
                f"not supported: {what}: {node.text}",
                node.location,
                "the requirement is ignored; what uses it is refused",
                "unsupported-requirement",
            )
        elif node.text not in REQUIREMENTS:
            message = f'"{node.text}" is not a known requirement'
            hint = nearest(node.text, [*REQUIREMENTS, *_UNSUPPORTED_REQUIREMENTS])
            source.fault(source.error(message, node.location, hint, "unknown-requirement"))
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
    ":probabilistic-effects": "probabilistic effects",
    ":rewards": "rewards",
    ":mdp": "probabilistic effects and rewards",
    ":multi-agent": "several agents",
    ":unfactored-privacy": "private facts of agents",
    ":factored-privacy": "private facts of agents",
    ":hierarchy": "hierarchical tasks",
    ":htn": "hierarchical tasks",
    ":method-preconditions": "hierarchical tasks",
    ":goal-utilities": "utilities of goals",
    ":supply-demand": "supply and demand",
    ":contingent": "partial observability",
}


def read_types(group: Group, source: Source) -> tuple[TypeDeclaration, ...]:
    """``(:types ...)``, parents before children."""
    found = []
    for typed in read_typed_list(group.parts[1:], source, variables=False, what="a type"):
        if len(typed.types) > 1:
            place = typed.location or group.location
            source.fault(unsupported(source, "types with several parents", typed.name, place))
        if typed.name != OBJECT:
            found.append(TypeDeclaration(typed.name, typed.types[0], typed.location))
        elif typed.types[0] != OBJECT:
            message = '"object" is the root of all types and has no parent'
            source.fault(source.error(message, typed.location, code="type-cycle"))
    ordered = parents_first(found)
    if source.report is not None:
        _warn_of_children_first(found, source)
    return ordered


def _warn_of_children_first(found: list[TypeDeclaration], source: Source) -> None:
    """Some readers want every parent before its children."""
    later = {declared.name: place for place, declared in enumerate(found)}
    for place, declared in enumerate(found):
        if later.get(declared.parent, 0) > place:
            source.warn(
                f'type "{declared.name}" stands before its parent "{declared.parent}"; some tools refuse that',
                declared.location,
                f'declare "{declared.parent}" first',
                "parent-after-child",
            )


def read_predicates(group: Group, document: Document) -> tuple[Predicate, ...]:
    """``(:predicates ...)``, each with the comment that stands beside it."""
    declared = group.parts[1:]
    following = [*(n.location.line for n in declared[1:]), group.end.line + 1][: len(declared)]
    found: list[Predicate] = []
    for node, next_line in zip(declared, following, strict=True):
        last = isinstance(node, Group) and node.end.line != next_line
        comment = document.comments.get(node.end.line, "") if isinstance(node, Group) and last else ""
        found.extend(document.source.recover((), _read_predicate, node, document, comment))
    return tuple(found)


def _read_predicate(node: Node, document: Document, comment: str) -> tuple[Predicate]:
    if isinstance(node, Word):
        raise document.source.error(f'expected (predicate ...), found "{node.text}"', node.location)
    if node.head == ":private":
        raise unsupported(document.source, "private facts of agents", node.head, node.location)
    return (_read_signature(node, document, comment),)


def _read_signature(node: Group, document: Document, comment: str = "") -> Predicate:
    source = document.source
    if not node.parts:
        raise source.error("expected (name ?parameter ...), found ()", node.location)
    name = read_name(node.parts[0], source, "the name of a predicate")
    parameters = read_typed_list(node.parts[1:], source, variables=True, what="a parameter")
    return Predicate(name.text, parameters, comment, node.location)


def read_functions(group: Group, document: Document) -> tuple[Predicate, ...]:
    """``(:functions ...)``, which are numbers, all of them."""
    source = document.source
    found: list[Predicate] = []
    nodes = list(group.parts[1:])
    while nodes:
        node = nodes.pop(0)
        if isinstance(node, Word):
            source.fault(source.error(f'expected (function ...), found "{node.text}"', node.location))
            continue
        found.extend(source.recover((), _read_function, node, document))
        if nodes and isinstance(nodes[0], Word) and nodes[0].text == "-":
            value = nodes[1] if len(nodes) > 1 else nodes[0]
            if isinstance(value, Group) or value.text != "number":
                hint = "a function is a number"
                source.fault(unsupported(source, "object fluents", node.head, node.location, hint))
            del nodes[:2]
    return tuple(found)


def _read_function(node: Group, document: Document) -> tuple[Predicate]:
    return (_read_signature(node, document),)


def read_action(group: Group, source: Source) -> ActionSchema:
    """``(:action name ...)``; what is left out is empty."""
    if len(group.parts) < 2:
        raise source.error("this action has no name", group.location)
    name = read_name(group.parts[1], source, "the name of an action")
    parts = _parts_of_action(group, name.text, source)
    effects = Effects()
    precondition: Formula = TRUE
    parameters: tuple[TypedName, ...] = ()
    if ":effect" in parts:
        effects = source.recover(effects, read_effects, parts[":effect"], source)
    if ":precondition" in parts:
        precondition = source.recover(TRUE, read_condition, parts[":precondition"], source)
    if ":parameters" in parts:
        parameters = source.recover((), read_parameters, parts[":parameters"], source)
    return ActionSchema(name.text, parameters, precondition, tuple(effects.flat), effects.cost, name.location)


_PARTS_OF_ACTIONS = (":parameters", ":precondition", ":effect")
_UNSUPPORTED_PARTS = {
    ":vars": "variables beside the parameters",
    ":agent": "several agents",
    ":observe": "partial observability",
    ":sense": "partial observability",
    ":duration": "durative actions",
    ":condition": "durative actions",
}


def _parts_of_action(group: Group, action: str, source: Source) -> dict[str, Node]:
    """What follows each keyword of an action."""
    parts: dict[str, Node] = {}
    nodes = list(group.parts[2:])
    while nodes:
        keyword = nodes.pop(0)
        if isinstance(keyword, Group):
            message = "expected :parameters, :precondition or :effect, found a parenthesis"
            source.fault(source.error(message, keyword.location, "use (and ...) for several conditions or effects"))
            continue
        value = nodes[0] if nodes else None
        if value is None or (isinstance(value, Word) and value.text.startswith(":")):
            source.fault(source.error(f'nothing follows "{keyword.text}"', keyword.location))
            continue
        source.recover(None, _known_part, keyword, action, parts, source)
        parts.setdefault(keyword.text, nodes.pop(0))
    return parts


def _known_part(keyword: Word, action: str, seen: dict[str, Node], source: Source) -> None:
    if keyword.text in _UNSUPPORTED_PARTS:
        raise unsupported(source, _UNSUPPORTED_PARTS[keyword.text], keyword.text, keyword.location)
    if keyword.text not in _PARTS_OF_ACTIONS:
        hint = nearest(keyword.text, _PARTS_OF_ACTIONS, what="parts of an action")
        message = f'"{keyword.text}" is not a part of an action'
        raise source.error(message, keyword.location, hint, "unknown-keyword")
    if keyword.text in seen:
        message = f'"{keyword.text}" appears twice in action "{action}"'
        raise source.error(message, keyword.location, code="duplicate-section")


def read_domain_name(group: Group, domain: Domain, source: Source) -> str:
    """``(:domain name)``, which must name ``domain``."""
    name = read_name(only_part(group, source), source, "the name of a domain")
    if name.text != domain.name:
        source.fault(
            source.error(
                f'the problem is of domain "{name.text}", the domain given is "{domain.name}"',
                name.location,
                f"write (:domain {domain.name})",
                "domain-mismatch",
            )
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
