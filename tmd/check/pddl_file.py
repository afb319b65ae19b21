"""Checking one PDDL file: all its faults, without those that only follow from others."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from tmd.check.diagnostic import SEVERITY, Severity
from tmd.check.lint import lint_domain, lint_problem
from tmd.diagnostics import Location, TmdError
from tmd.pddl.model import Domain, Problem
from tmd.pddl.reading.checking import check_domain, check_problem
from tmd.pddl.reading.reader import parse_domain_unchecked, parse_problem_unchecked
from tmd.pddl.reading.syntax import Group, Node, Source, Word, split_lines
from tmd.world.problem_domain import domain_named_in

_DECLARED_IN = {
    ":types": "unknown-type",
    ":predicates": "unknown-predicate",
    ":functions": "unknown-function",
    ":constants": "unknown-object",
    ":objects": "unknown-object",
}
# By the code of a fault: names that may well be declared, in a section that could not be read.
Words = Mapping[str, frozenset[str]]


@dataclass(frozen=True, slots=True)
class CheckedDomain:
    """Domain as far as it could be read, with its faults."""

    domain: Domain
    source: Source
    faults: list[TmdError]
    excused: Words = field(default_factory=dict)

    @property
    def sound(self) -> bool:
        """Return whether there is nothing wrong but perhaps what deserves a warning."""
        return not any(_is_error(fault) for fault in self.faults)


@dataclass(frozen=True, slots=True)
class CheckedProblem:
    """Problem as far as it could be read (``None`` where it could not), with its faults."""

    problem: Problem | None
    source: Source
    faults: list[TmdError]


def check_domain_text(text: str, file: str) -> CheckedDomain:
    """Read a domain as far as it can be read, and list what is wrong with it."""
    faults: list[TmdError] = []
    try:
        domain, source = parse_domain_unchecked(text, file, faults.append)
    except TmdError as error:
        faults.append(error)
        return CheckedDomain(Domain(""), Source(file, split_lines(text)), faults)
    excused = _excused(source, faults)
    faults += _without_excused(check_domain(domain, source), excused)
    if not any(_is_error(fault) for fault in faults):
        faults += lint_domain(domain, source)
    return CheckedDomain(domain, source, _without_echoes(faults), excused)


def check_problem_text(text: str, file: str, checked: CheckedDomain | None) -> CheckedProblem:
    """Return the same for a problem; without its domain only its form is checked."""
    faults: list[TmdError] = []
    checked = checked if checked and checked.domain.name else None
    domain = checked.domain if checked else Domain(domain_named_in(text))
    try:
        problem, source = parse_problem_unchecked(text, domain, file, faults.append)
    except TmdError as error:
        faults.append(error)
        return CheckedProblem(None, Source(file, split_lines(text)), faults)
    if checked is None:
        return CheckedProblem(problem, source, faults)
    excused = _joined(checked.excused, _excused(source, faults))
    faults += _without_excused(check_problem(problem, source), excused)
    if checked.sound and not any(_is_error(fault) for fault in faults):
        faults += lint_problem(problem, source)
    return CheckedProblem(problem, source, _without_echoes(faults, checked.faults))


def explain_objects(checked: CheckedDomain, problem: Problem) -> None:
    """Give the remedy of the objects that a domain names and only its problem declares: they are constants."""
    declared = {o.name: o for o in problem.objects}
    names = {fault: declared.get(_quoted(fault)) for fault in checked.faults if fault.code == "unknown-object"}
    found = {o.name: o.typed() for o in names.values() if o is not None}
    edits = [checked.source.declaration(":constants", " ".join(found.values()))]
    for fault, named in names.items():
        if named is not None and not fault.edits:
            fault.hint = f"an action needs a constant: declare {named.typed()} under (:constants ...) of the domain"
            fault.edits = tuple(edits)


def _quoted(fault: TmdError) -> str:
    """Return the name that a message speaks of."""
    found = re.search(r'"([^"]*)"', fault.message)
    return found[1] if found else ""


def _is_error(fault: TmdError) -> bool:
    return SEVERITY.get(fault.code, Severity.ERROR) is Severity.ERROR


# A kind of fault, and the kind and a part of the message of what only follows from it.
_ECHOES = (
    ("unknown-requirement", "missing-requirement", ""),
    ("unknown-function", "missing-requirement", ":action-costs"),
    ("type-cycle", "parent-after-child", ""),
    ("missing-section", "missing-requirement", ":typing"),
    ("other-notation", "missing-requirement", ":equality"),
    ("unknown-section", "missing-section", ""),
    ("unknown-section", "missing-requirement", ""),
    ("not-supported", "missing-requirement", ":action-costs"),
    ("not-supported", "unsupported-requirement", ""),
    ("bad-name", "domain-mismatch", ""),
)


# Faults of a name in a domain that are not repeated in its problems.
_ONCE = frozenset({"odd-name", "wrong-arity", "unknown-type", "unknown-predicate", "unknown-function"})


def _without_echoes(faults: list[TmdError], others: Sequence[TmdError] = ()) -> list[TmdError]:
    """Return ``faults`` without those that only follow from them, or from ``others``."""
    codes = {fault.code for fault in (*faults, *others)}
    found = [(echo, part) for code, echo, part in _ECHOES if code in codes]
    if any(fault.code == "unclosed-parenthesis" and fault.edits for fault in faults):
        found.append(("not-supported", "nested terms"))  # they are the groups behind the one that is not closed
    if any("durative actions" in fault.message for fault in others):
        found.append(("not-supported", "total-time"))
    found += [(fault.code, f'"{_quoted(fault)}"') for fault in others if fault.code in _ONCE]
    kept = [f for f in faults if not any(f.code == code and part in f.message for code, part in found)]
    return list(_each_letter_once(kept))


def _each_letter_once(faults: Iterable[TmdError]) -> Iterator[TmdError]:
    """Yield the faults; of characters that only look like others the first of each, with the edits of all places."""
    first: dict[str, TmdError] = {}
    for fault in faults:
        letter = fault.message.rpartition(": ")[2]
        if fault.code != "look-alike" or first.setdefault(letter, fault) is fault:
            yield fault
        else:
            first[letter].edits += fault.edits


def _without_excused(faults: Iterable[TmdError], excused: Words) -> list[TmdError]:
    return [fault for fault in faults if _quoted(fault) not in excused.get(fault.code, ())]


def _joined(one: Words, other: Words) -> Words:
    return {code: one.get(code, frozenset()) | other.get(code, frozenset()) for code in {*one, *other}}


def _excused(source: Source, faults: list[TmdError]) -> Words:
    """Return the words of the sections in which something could not be read: they would be declared otherwise."""
    if not faults:
        return {}
    places = [fault.location for fault in faults if fault.location and _is_error(fault)]
    unknown = {fault.location for fault in faults if fault.code in ("unknown-section", "not-supported")}
    excused: dict[str, set[str]] = {}
    for group in (part for top in source.groups for part in top.parts if isinstance(part, Group)):
        codes = set(_DECLARED_IN.values()) if group.location in unknown else {_DECLARED_IN.get(group.head, "")}
        if any(_within(place, group) for place in places):
            for code in codes - {""}:
                excused.setdefault(code, set()).update(_words(group))
    return {code: frozenset(words) for code, words in excused.items()}


def _within(place: Location, group: Group) -> bool:
    return group.location <= place <= group.end


def _words(group: Group) -> Iterator[str]:
    waiting: list[Node] = [group]
    while waiting:
        node = waiting.pop()
        if isinstance(node, Word):
            yield node.text
        else:
            waiting.extend(node.parts)
