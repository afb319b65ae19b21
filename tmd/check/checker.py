"""Checking of files and folders: their kinds, and the domain of each problem."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from tmd.check.diagnostic import SEVERITY, Findings, Severity
from tmd.check.lint import lint_together
from tmd.check.pddl_file import CheckedDomain, check_domain_text, check_problem_text, explain_objects
from tmd.diagnostics import Location, TmdError
from tmd.files import real
from tmd.language.lexicon.file import BASES
from tmd.pddl.model import Problem
from tmd.pddl.reading.syntax import Source, read_text, split_lines
from tmd.world.problem_domain import (
    FoundDomain,
    domain_in,
    domain_named_in,
    domains_in,
    find_domain_file,
    kind_and_name,
)

if TYPE_CHECKING:
    from tmd.check.data_files import DataFiles


# The files of domains and problems that are not PDDL, beside environments.
DATA_FILES = frozenset({"objects.yaml", "lexicon.yaml", "skills.yaml", "templates.yaml", "demonstrations.jsonl"})
# What the other files of a folder are checked against.
_FIRST = ("domain.pddl", "objects.yaml")
# Of a longer source line only the beginning is kept.
MAX_LINE = 10_000
# Of one file.
MOST_SHOWN = 200
# Larger files are refused: no file that people write comes near.
MAX_BYTES = 10_000_000


@dataclass
class Checker:
    """Checker of files and folders, each once, which collects their faults.

    ``domain`` is the file of the domain of all problems, if it is known; ``domains`` and ``problems`` are the
    directories of all of them, if not the usual ones. A problem that nothing else has a domain for is of one of the
    files ``given``, which are checked together.
    """

    domains: Path | None = None
    domain: Path | None = None
    problems: Path | None = None
    given: Sequence[Path] = ()
    findings: Findings = field(default_factory=Findings)
    files: dict[Path, None] = field(default_factory=dict)
    _checked: dict[Path, CheckedDomain | None] = field(default_factory=dict)
    _problems: dict[Path, list[Problem]] = field(default_factory=dict)
    _read: dict[Path, Problem | None] = field(default_factory=dict)
    _given: dict[Path, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        domains_in.cache_clear()
        domains = ((file, domain_in(file)) for file in self.given if file.suffix == ".pddl")
        self._given = {file: name for file, name in domains if name is not None}

    def check(self, path: Path) -> None:
        """Check a file, or everything in a directory.

        Raises:
            TmdError: There is nothing at ``path``.
        """
        files = files_of(path)
        if not path.is_dir():
            self.check_file(path)
            return
        inside = real(path)
        for file in files:
            if file.is_symlink() and not real(file).is_relative_to(inside):
                place = Location(str(file), 1, 1)
                hint = "put the file itself there"
                self.report(TmdError("leads out of the folder", location=place, hint=hint, code="outside-folder"), file)
            else:
                self.check_file(file)

    def check_file(self, file: Path) -> None:
        """Check one file, by what it is."""
        if file.suffix in (".yaml", ".yml", ".jsonl"):
            self._data.check(file)
        else:
            self._pddl(file)

    @cached_property
    def _data(self) -> DataFiles:
        from tmd.check.data_files import DataFiles

        return DataFiles(self)

    def report(self, fault: TmdError, file: Path) -> None:
        """Take in a fault of ``file``; the source line is read where the fault has none."""
        place = fault.location or Location(str(file), 1, 1)
        if fault.source is None and fault.location is not None:
            fault.source = _line(place)
        self.findings.add(fault, place)

    def finish(self) -> None:
        """Look at each domain together with all of its problems that were checked."""
        for path, problems in self._problems.items():
            checked = self._checked[path]
            if checked is not None and problems:
                self._add_all(lint_together(checked.domain, problems, checked.source), path)

    def _pddl(self, file: Path) -> None:
        text = self.read(file)
        if text is None:
            return
        if kind_and_name(text)[0] == "domain":
            self._domain(file, text)
        else:
            self._problem(file, text)

    def _domain(self, file: Path, text: str | None = None) -> CheckedDomain | None:
        key = real(file)
        if key not in self._checked:
            self._checked[key] = None
            text = self.read(file) if text is None else text
            if text is not None:
                checked = check_domain_text(text, str(file))
                _drop_compiled_in(checked, file)
                self._checked[key] = checked
                self._add_all(checked.faults, file)
        return self._checked[key]

    def _problem(self, file: Path, text: str) -> None:
        name = domain_named_in(text)
        found = FoundDomain(self.domain) if self.domain else self._domain_file(file, name)
        path = found.file
        checked = self._domain(path) if path else None
        result = check_problem_text(text, str(file), checked)
        if checked and result.problem:
            explain_objects(checked, result.problem)
        self._add_all(result.faults, file)
        if path is None and name:
            self._not_found(name, result.source, found.others)
        faulty = any(SEVERITY.get(fault.code) is not Severity.WARNING for fault in result.faults)
        if path is not None and result.problem is not None and not faulty and checked is not None and checked.sound:
            self._problems.setdefault(real(path), []).append(result.problem)
        self._read[real(file)] = None if faulty or checked is None else result.problem

    def _domain_file(self, problem: Path, name: str) -> FoundDomain:
        """Return the domain of a problem: of its name among the files given, or the one beside it, or as elsewhere."""
        named = [file for file, domain in self._given.items() if domain == name]
        if not named and problem in self.given:
            named = [file for file in self._given if file.parent == problem.parent]
        if len(named) == 1:
            return FoundDomain(named[0])
        found = find_domain_file(problem, name, self.domains)
        if found.file is None and not found.others and len(self._given) == 1:
            return FoundDomain(next(iter(self._given)))
        return found

    def problem(self, file: Path) -> Problem | None:
        """Return the problem in ``file``; ``None`` where it or its domain has faults, which are reported."""
        key = real(file)
        if key not in self._read:
            self._read[key] = None
            self.check_file(file)
        return self._read[key]

    def _not_found(self, name: str, source: Source, others: Sequence[Path]) -> None:
        for number, line in enumerate(source.lines, start=1):
            column = line.lower().find(":domain")
            if column >= 0:
                place = Location(source.file, number, column + 1)
                what, code = "was not found", "domain-not-found"
                hint = "put the domain beside it, or give --domain FILE"
                if others:
                    what, code = "stands in several files", "ambiguous-domain"
                    hint = f"give --domain FILE, one of {', '.join(path.name for path in others[:8])}"
                message = f'the domain "{name}" {what}, so only the form of this problem was checked'
                self.findings.add(source.error(message, place, hint, code), place)
                return

    def read(self, file: Path) -> str | None:
        """Return the text of a file; ``None`` where it cannot be read, which is reported."""
        self.files[file] = None
        try:
            if file.is_file() and file.stat().st_size > MAX_BYTES:
                hint = "this is not a file that people write"
                message = f"larger than {MAX_BYTES // 1_000_000} MB"
                raise TmdError(message, location=Location(str(file), 1, 1), hint=hint, code="too-large")
            return read_text(file, lambda fault: self.report(fault, file))
        except TmdError as error:
            self.findings.add(error, Location(str(file), 1, 1))
            return None

    def _add_all(self, faults: list[TmdError], file: Path) -> None:
        start = Location(str(file), 1, 1)
        by_weight = sorted(faults, key=_weight)
        for fault in by_weight[:MOST_SHOWN]:
            self.findings.add(fault, start)
        if len(faults) > MOST_SHOWN:
            place = max((fault.location for fault in by_weight[:MOST_SHOWN] if fault.location), default=start)
            message = f"this file has {len(faults) - MOST_SHOWN} more problems; they are not shown"
            self.findings.add(TmdError(message, location=place, hint="mend these first", code="too-many"), place)


def _weight(fault: TmdError) -> int:
    """Return a sort key: errors before unsupported features before warnings."""
    severity = SEVERITY.get(fault.code, Severity.ERROR)
    return 2 if severity is not Severity.ERROR else int(fault.code == "not-supported")


def _drop_compiled_in(checked: CheckedDomain, file: Path) -> None:
    """Drop warnings on unused predicates that ``objects.yaml`` or environments use."""
    objects = file.parent / "objects.yaml"
    from tmd.world.compile import AT, PART_OF

    if not objects.is_file() or not any(fault.code == "unused-predicate" for fault in checked.faults):
        return
    try:
        words = {PART_OF, AT, *re.findall(r"[a-z][a-z0-9_]*", read_text(objects))}
    except TmdError:
        return
    checked.faults[:] = [
        fault
        for fault in checked.faults
        if fault.code != "unused-predicate" or fault.message.split('"')[1] not in words
    ]


def files_of(path: Path) -> list[Path]:
    """Return ``path``, or the files of a directory that are checked, what others need before the others.

    Raises:
        TmdError: There is nothing there.
    """
    if not path.exists():
        raise TmdError(f"{path}: no such file or directory", hint="name a file, a folder or a bundled domain")
    return list(_files(path)) if path.is_dir() else [path]


def _files(directory: Path) -> Iterator[Path]:
    """Yield the files of ``directory`` that are checked, domains first, then by name."""
    found = [
        path
        for path in directory.rglob("*")
        if is_ours(path) and not any(part.startswith(".") for part in path.relative_to(directory).parts)
    ]
    yield from sorted(found, key=lambda path: (path.parent, path.suffix != ".pddl", path.name not in _FIRST, path.name))


def is_ours(path: Path) -> bool:
    """Return whether a file of a directory is one that tmd reads; other YAML may lie there as well."""
    if path.suffix in (".yaml", ".yml"):
        return path.name in DATA_FILES or path.parent.name in ("environments", BASES)
    return path.suffix == ".pddl" or path.name in DATA_FILES


def _line(place: Location) -> str | None:
    """Return the line at ``place``, where it can be read."""
    try:
        lines = split_lines(read_text(place.file))
    except TmdError:
        return None
    return lines[place.line - 1][:MAX_LINE] if place.line <= len(lines) else None
