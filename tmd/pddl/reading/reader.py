"""Reading PDDL domains and problems.

Supported: typed ADL with action costs. Everything else is refused by its name. What is read is checked by
:mod:`tmd.pddl.reading.checking`, and the first fault is raised with its source line. All names become lower case.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

from tmd.diagnostics import Location, TmdError
from tmd.pddl.model import (
    TRUE,
    ActionSchema,
    Domain,
    Problem,
)
from tmd.pddl.reading.checking import check_domain, check_problem
from tmd.pddl.reading.formulas import read_condition
from tmd.pddl.reading.init import InitReader
from tmd.pddl.reading.names import read_name, read_typed_list, unsupported
from tmd.pddl.reading.parentheses import parse
from tmd.pddl.reading.sections import (
    only_part,
    read_action,
    read_domain_name,
    read_functions,
    read_metric,
    read_predicates,
    read_requirements,
    read_types,
)
from tmd.pddl.reading.syntax import Document, Group, Report, Source, Word, nearest, read_text

_UNSUPPORTED_SECTIONS = {
    ":derived": "derived predicates",
    ":durative-action": "durative actions",
    ":process": "processes",
    ":event": "events",
    ":constraints": "trajectory constraints",
    ":length": "plan length limits",
    ":task": "hierarchical tasks",
    ":method": "hierarchical tasks",
    ":htn": "hierarchical tasks",
    ":axiom": "derived predicates",
    ":vars": "state variables",
    ":agents": "several agents",
    ":goal-reward": "rewards",
    ":observable": "partial observability",
    ":sensing-action": "partial observability",
    ":class": "processes and classes",
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
    return _faultless_domain(text, file)


@lru_cache(maxsize=8)
def _faultless_domain(text: str, file: str) -> Domain:
    """The same, kept: compiling, checking and grounding read the same domain in one run."""
    domain, source = parse_domain_unchecked(text, file)
    _raise_first(check_domain(domain, source))
    return domain


def parse_problem(text: str, domain: Domain, file: str = "<text>") -> Problem:
    """The problem that ``text`` describes; ``file`` names it in errors."""
    problem, source = parse_problem_unchecked(text, domain, file)
    _raise_first(check_problem(problem, source))
    return problem


def _raise_first(faults: list[TmdError]) -> None:
    """A requirement that is not declared is let pass: what needs it says so itself, and all planners accept that."""
    for fault in faults:
        if fault.code != "missing-requirement":
            raise fault


def parse_domain_unchecked(text: str, file: str = "<text>", report: Report | None = None) -> tuple[Domain, Source]:
    """The domain that ``text`` describes, before its meaning is checked, and the text's lines.

    Where there is a ``report``, it gets every fault, and only a text without any domain is an error.

    Raises:
        TmdError: It is not PDDL, or not of the supported part.
    """
    document = parse(text, file, report)
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
    _read_sections(sections, readers, parts, source)
    keywords = {keyword.removeprefix(":"): value for keyword, value in parts.items()}
    return Domain(name.text, **keywords, actions=tuple(actions), location=name.location), source


def parse_problem_unchecked(
    text: str, domain: Domain, file: str = "<text>", report: Report | None = None
) -> tuple[Problem, Source]:
    """The problem that ``text`` describes, before its meaning is checked, and the text's lines.

    Where there is a ``report``, it gets every fault, and only a text without any problem is an error.

    Raises:
        TmdError: It is not PDDL, not of the supported part, or belongs to another domain.
    """
    document = parse(text, file, report)
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
    _read_sections(sections, readers, parts, source)
    heads = {section.head for section in sections}
    for needed in (":domain", ":goal"):
        if needed not in heads:
            message = f"the problem has no ({needed} ...)"
            source.fault(source.error(message, name.location, "add it", "missing-section"))
    problem = Problem(
        name.text,
        domain,
        objects=parts.get(":objects", ()),
        init=frozenset(init.atoms),
        goal=parts.get(":goal", TRUE),
        function_values=init.values,
        minimize_cost=parts.get(":metric", False),
        requirements=parts.get(":requirements", ()),
        location=name.location,
        init_locations=init.locations,
    )
    return problem, source


def _read_sections(
    sections: list[Group], readers: dict[str, Callable[[Group], object]], parts: dict[str, Any], source: Source
) -> None:
    """Read every section into ``parts``; actions, of which there are many, go where their reader puts them."""

    def read(group: Group) -> None:
        section = _section(group, tuple(readers), parts, source)
        parts[section] = readers[section](group)
        if section == ":action":
            del parts[section]

    for group in sections:
        source.recover(None, read, group)


def _definition(document: Document, kind: str) -> tuple[Word, list[Group]]:
    """The name and sections of ``(define (kind name) section ...)``."""
    source = document.source
    if not document.groups:
        hint = f"write (define ({kind} name) ...)"
        raise source.error(f"there is no {kind} here", Location(source.file, 1, 1), hint, "empty-file")
    first = document.groups[0]
    document.check_depth()
    if len(document.groups) > 1:
        source.fault(
            source.error(
                f'this parenthesis closes "({first.head}" too early: more text follows',
                first.end,
                'a ")" before it is too many',
                "extra-parenthesis",
            )
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
            source.fault(
                source.error(
                    f'"{section.text}" stands outside its section',
                    section.location,
                    "a parenthesis before it is too many",
                )
            )
    return name, [s for s in sections if isinstance(s, Group)]


def _section(group: Group, known: tuple[str, ...], seen: dict[str, Any], source: Source) -> str:
    head = group.head
    if head in _UNSUPPORTED_SECTIONS:
        raise unsupported(source, _UNSUPPORTED_SECTIONS[head], head, group.location)
    if head not in known:
        shown = f'"({head} ...)"' if head else "this group"
        hint = nearest(head, known, what="sections")
        raise source.error(f"{shown} is not a section", group.location, hint, "unknown-section")
    if head in seen:
        raise source.error(f'the section "{head}" appears twice', group.location, "join the two", "duplicate-section")
    return head
