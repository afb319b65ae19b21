"""Checking paths, and fixing what is mechanical: what ``tmd check`` does."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from tmd.check.checker import Checker, files_of
from tmd.check.diagnostic import Diagnostic, Severity
from tmd.diagnostics import Location, TmdError
from tmd.files import write_text
from tmd.pddl.reading.syntax import ODD_BLANK, Group, parse, read_text, split_lines

# The codes that may be fixed; parentheses only where there is one way to do it.
FIXABLE = frozenset(
    {
        "empty-condition",
        "glued-dash",
        "glued-variable",
        "missing-requirement",
        "unclosed-parenthesis",
        "extra-parenthesis",
        "look-alike",
        "stale-domain",
    }
)  # fmt: skip


@dataclass(frozen=True, slots=True, order=True)
class _Edit:
    """``length`` characters at a place are replaced by ``text``; lines and columns count from 0."""

    line: int
    column: int
    length: int
    text: str


def fix_file(file: Path, diagnostics: Sequence[Diagnostic]) -> str | None:
    """Return the text of ``file`` with what is mechanical fixed; ``None`` where nothing is.

    Raises:
        TmdError: The file cannot be read.
    """
    if any(diagnostic.code == "stale-domain" for diagnostic in diagnostics):
        return _compiled(file)
    text = read_text(file)
    lines = list(split_lines(text))
    edits = sorted(set(_edits(text, lines, file, diagnostics)), reverse=True)
    for edit in edits:
        line = lines[edit.line]
        lines[edit.line] = line[: edit.column] + edit.text + line[edit.column + edit.length :]
    return "\n".join(lines) if edits else None


def _compiled(file: Path) -> str | None:
    from tmd.world.compile import compile_domain
    from tmd.world.folder import DomainFolder

    try:
        return compile_domain(DomainFolder(file.parent))
    except TmdError:
        return None


def _edits(text: str, lines: Sequence[str], file: Path, diagnostics: Sequence[Diagnostic]) -> Iterator[_Edit]:
    parentheses = [d for d in diagnostics if d.code in ("unclosed-parenthesis", "extra-parenthesis")]
    for diagnostic in diagnostics:
        row, column = diagnostic.location.line - 1, diagnostic.location.column - 1
        if diagnostic.code == "empty-condition":
            found = re.compile(r"\(\s*\)").match(lines[row], column)
            if found:
                yield _Edit(row, column, found.end() - column, "(and)")
        elif diagnostic.code == "glued-dash":
            yield _Edit(row, column + 1, 0, " ")
        elif diagnostic.code == "glued-variable":
            yield _Edit(row, column, 0, " ")
        elif diagnostic.code == "look-alike":
            plain = re.fullmatch(r'write "(.)"', diagnostic.hint or "")
            if plain and plain[1] == " ":  # reported once a line
                yield from (_Edit(row, found.start(), 1, " ") for found in ODD_BLANK.finditer(lines[row], column))
            elif plain:
                yield _Edit(row, column, 1, plain[1])
        elif diagnostic in parentheses and len(parentheses) == 1:
            yield from _parenthesis(diagnostic, text, lines)
    wanted = {d.hint.split()[1] for d in diagnostics if d.code == "missing-requirement" and d.hint}
    if wanted and not parentheses:
        yield from _requirements(text, str(file), wanted)


def _parenthesis(diagnostic: Diagnostic, text: str, lines: Sequence[str]) -> Iterator[_Edit]:
    """Yield the edit of a parenthesis at the end of the file; elsewhere only the author knows its place."""
    if "no opening parenthesis" in diagnostic.message:
        yield _Edit(diagnostic.location.line - 1, diagnostic.location.column - 1, 1, "")
    elif diagnostic.hint == 'add the missing ")"' and '"(define"' in diagnostic.message:
        last = max(number for number, line in enumerate(lines) if line.strip())
        code = lines[last].partition(";")[0].rstrip()
        yield _Edit(last, len(code), 0, ")")


def _requirements(text: str, file: str, wanted: Iterable[str]) -> Iterator[_Edit]:
    document = parse(text, file, lambda _: None)
    added = " ".join(sorted(wanted))
    sections = [part for part in document.groups[0].parts if isinstance(part, Group)]
    declared = next((group for group in sections if group.head == ":requirements"), None)
    if declared is not None:
        yield _insertion(declared.end, f" {added}")
    else:
        title = sections[0].end
        strips = ":strips " if sections[0].head == "domain" else ""
        place = Location(title.file, title.line, title.column + 1)
        yield _insertion(place, f"\n  (:requirements {strips}{added})")


def _insertion(place: Location, text: str) -> _Edit:
    return _Edit(place.line - 1, place.column - 1, 0, text)


# Fixing one thing may bring another to light.
_MOST_ROUNDS = 4


@dataclass(frozen=True, slots=True)
class CheckReport:
    """Result of a check.

    Attributes:
        files: The files that were checked.
        diagnostics: What is wrong with them, by file, line and column.
        fixed: The files that were fixed.
    """

    files: tuple[Path, ...]
    diagnostics: tuple[Diagnostic, ...]
    fixed: tuple[Path, ...] = ()

    @property
    def counts(self) -> Mapping[Severity, int]:
        """Number of diagnostics of each severity."""
        return {severity: sum(d.severity is severity for d in self.diagnostics) for severity in Severity}


def check_paths(
    paths: Iterable[str | Path],
    *,
    domain: Path | None = None,
    domains: Path | None = None,
    problems: Path | None = None,
    fix: bool = False,
) -> CheckReport:
    """Check files, and all files of folders.

    Args:
        paths: The files and folders.
        domain: The file of the domain of all problems, if it is known.
        domains: The directory of all domains; the usual one by default.
        problems: The directory of all problems; the usual one by default.
        fix: Fix what can be fixed without knowing what the author meant, and check again.

    Raises:
        TmdError: There is nothing at a path, or a fixed file cannot be written.
    """
    chosen = [Path(path) for path in paths]
    given = [path for path in chosen if not path.is_dir()]
    fixed: dict[Path, None] = {}
    for rounds in reversed(range(_MOST_ROUNDS + 1)):
        stamps = {file: _stamp(file) for path in chosen for file in files_of(path)} if fix else {}
        checker = Checker(domains, domain, problems, given)
        for path in chosen:
            checker.check(path)
        checker.finish()
        changed, stale = _fix(checker, stamps) if fix and rounds else ([], False)
        if not (changed or stale):
            break
        fixed |= dict.fromkeys(changed)
    return CheckReport(tuple(checker.files), tuple(checker.findings.sorted()), tuple(fixed))


def _stamp(file: Path) -> tuple[int, int, int] | None:
    """Return a stamp that changes when the file is written; ``None`` where there is none."""
    try:
        status = file.stat()
    except OSError:
        return None
    return status.st_ino, status.st_mtime_ns, status.st_size


def _fix(checker: Checker, stamps: Mapping[Path, tuple[int, int, int] | None]) -> tuple[list[Path], bool]:
    """Fix the files that were checked, each written whole.

    Args:
        checker: What was found.
        stamps: The files as they were before that.

    Returns:
        The files that changed; and whether another program, an editor or another fix, wrote one meanwhile: the
        diagnostics are outdated then, and the file is left alone.
    """
    by_file: dict[Path, list[Diagnostic]] = {}
    for diagnostic in checker.findings.sorted():
        if diagnostic.code in FIXABLE:
            by_file.setdefault(Path(diagnostic.location.file), []).append(diagnostic)
    changed, stale = [], False
    for file, diagnostics in sorted(by_file.items()):
        text = fix_file(file, diagnostics)
        if text is None:
            continue
        if file in stamps and _stamp(file) != stamps[file]:
            stale = True
        else:
            write_text(file, text)
            changed.append(file)
    return changed, stale
