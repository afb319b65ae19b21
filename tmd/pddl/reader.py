"""Reading PDDL domains and problems.

Supported: typed ADL with action costs. Everything else is refused by its name. What is read is checked by
:mod:`tmd.pddl.check`, and the first fault is raised with its source line. All names become lower case.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from tmd.errors import Location, TmdError
from tmd.pddl.check import check_domain, check_problem
from tmd.pddl.model import (
    ActionSchema,
    Domain,
    Problem,
)
from tmd.pddl.read_formula import read_condition
from tmd.pddl.read_init import InitReader
from tmd.pddl.read_names import read_name, read_typed_list, unsupported
from tmd.pddl.read_sections import (
    only_part,
    read_action,
    read_domain_name,
    read_functions,
    read_metric,
    read_predicates,
    read_requirements,
    read_types,
)
from tmd.pddl.syntax import Document, Group, Source, Word, nearest, parse, read_text

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
    _raise_first(check_domain(domain, source))
    return domain


def parse_problem(text: str, domain: Domain, file: str = "<text>") -> Problem:
    """The problem that ``text`` describes; ``file`` names it in errors."""
    problem, source = parse_problem_unchecked(text, domain, file)
    _raise_first(check_problem(problem, source))
    return problem


def _raise_first(faults: list[TmdError]) -> None:
    if faults:
        raise faults[0]


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
        ":requirements": lambda g: read_requirements(g, source),
        ":types": lambda g: read_types(g, source),
        ":constants": lambda g: read_typed_list(g.parts[1:], source, variables=False, what="a constant"),
        ":predicates": lambda g: read_predicates(g, document),
        ":functions": lambda g: read_functions(g, document),
        ":action": lambda g: actions.append(read_action(g, source)),
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
    init = InitReader(source)
    parts: dict[str, Any] = {}
    readers: dict[str, Callable[[Group], object]] = {
        ":domain": lambda g: read_domain_name(g, domain, source),
        ":requirements": lambda g: read_requirements(g, source),
        ":objects": lambda g: read_typed_list(g.parts[1:], source, variables=False, what="an object"),
        ":init": init.read,
        ":goal": lambda g: read_condition(only_part(g, source), source),
        ":metric": lambda g: read_metric(g, source),
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
