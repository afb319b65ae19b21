"""Checking paths, and fixing what is mechanical: what ``tmd check`` does."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path

from tmd.check.checker import Checker, files_of
from tmd.check.diagnostic import Diagnostic, Severity
from tmd.diagnostics import Edit, Location, TmdError
from tmd.files import write_text
from tmd.pddl.reading.syntax import read_text, split_lines
from tmd.short_repr import short_repr


def fix_file(file: Path, diagnostics: Sequence[Diagnostic]) -> str | None:
    """Return the text of ``file`` with what is mechanical fixed; ``None`` where nothing is.

    Raises:
        TmdError: The file cannot be read.
    """
    if any(diagnostic.code == "stale-domain" for diagnostic in diagnostics):
        from tmd.world.compile import compile_domain
        from tmd.world.folder import DomainFolder

        with suppress(TmdError):
            return compile_domain(DomainFolder(file.parent))
        return None
    return _edited(file, _edits(file, diagnostics))


def _edits(file: Path, diagnostics: Sequence[Diagnostic]) -> list[Edit]:
    """Return the edits of ``file`` that the diagnostics have; those of parentheses only where there are no others."""
    edits = [edit for d in diagnostics for edit in d.edits if edit.start.file == str(file)]
    parentheses = [d for d in diagnostics if d.code in ("unclosed-parenthesis", "extra-parenthesis")]
    if len(parentheses) == 1 and not edits:
        edits = list(_parenthesis(parentheses[0], split_lines(read_text(file))))
    return edits


def _edited(file: Path, edits: Iterable[Edit]) -> str | None:
    """Return the text of ``file`` with ``edits``, without those that overlap others; ``None`` where there are none."""
    wanted = sorted(set(edits))
    if not wanted:
        return None
    if not wanted[0].start.line:
        return wanted[0].text
    lines = split_lines(read_text(file))
    starts = [0, *accumulate(len(line) + 1 for line in lines)]
    text = "\n".join(lines)
    made: list[str] = []
    done = 0
    for edit in wanted:
        start, end = (starts[place.line - 1] + place.column - 1 for place in (edit.start, edit.end))
        if start >= done:
            made += (text[done:start], edit.text)
            done = end
    return "".join((*made, text[done:]))


def _parenthesis(diagnostic: Diagnostic, lines: Sequence[str]) -> Iterator[Edit]:
    """Yield the edit of a parenthesis at the end of the file; elsewhere only the author knows its place."""
    place = diagnostic.location
    if "no opening parenthesis" in diagnostic.message:
        yield Edit(place, Location(place.file, place.line, place.column + 1))
    elif diagnostic.hint == 'add the missing ")"' and '"(define"' in diagnostic.message:
        last = max(number for number, line in enumerate(lines) if line.strip())
        code = lines[last].partition(";")[0].rstrip()
        end = Location(place.file, last + 1, len(code) + 1)
        yield Edit(end, end, ")")


# Fixing one thing may bring another to light.
_MOST_ROUNDS = 8


@short_repr(lambda r: f"{len(r.files)} file(s): " + ", ".join(f"{n} {severity}(s)" for severity, n in r.counts.items()))
@dataclass(frozen=True, slots=True)
class CheckReport:
    """Result of a check. Diagnostics are sorted by file, line and column."""

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

    ``domain`` is the file of the domain of all problems, if it is known; ``domains`` and ``problems`` are the
    directories of all of them, if not the usual ones. ``fix`` mends what needs no knowledge of what the author meant,
    and checks again.

    Raises:
        TmdError: There is nothing at a path, or a fixed file cannot be written.
    """
    named = [Path(path) for path in paths]
    fixed: dict[Path, None] = {}
    made: list[Path] = []
    for rounds in reversed(range(_MOST_ROUNDS + 1)):
        chosen = named + made
        given = [path for path in chosen if not path.is_dir()]
        stamps = {file: _stamp(file) for path in chosen for file in files_of(path)} if fix else {}
        checker = Checker(domains, domain, problems, given)
        for path in chosen:
            checker.check(path)
        checker.finish()
        changed, stale = _fix(checker, stamps) if fix and rounds else ([], False)
        if not (changed or stale):
            break
        fixed |= dict.fromkeys(changed)
        made += [file for file in changed if file not in checker.files]
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

    ``stamps`` are those of the files before they were checked.

    Returns:
        The files that changed; and whether another program, an editor or another fix, wrote one meanwhile: the
        diagnostics are outdated then, and the file is left alone.
    """
    by_file: dict[Path, list[Diagnostic]] = {}
    for diagnostic in checker.findings.sorted():
        new = {Path(edit.start.file) for edit in diagnostic.edits if not edit.start.line}
        if not any(path.exists() for path in new):
            files = {Path(diagnostic.location.file), *(Path(edit.start.file) for edit in diagnostic.edits)}
            for file in files:
                by_file.setdefault(file, []).append(diagnostic)
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
