"""Checking paths, and mending what is mechanical: what ``tmd check`` does."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from tmd.check.checker import Checker
from tmd.check.codes import Severity
from tmd.check.diagnostic import Diagnostic
from tmd.check.fixes import FIXABLE, fix_file
from tmd.files import write_text

_MOST_ROUNDS = 4
"""Mending one thing may bring another to light."""


@dataclass(frozen=True, slots=True)
class CheckReport:
    """What was found.

    Attributes:
        files: The files that were checked.
        diagnostics: What is wrong with them, by file, line and column.
        fixed: The files that were mended.
    """

    files: tuple[Path, ...]
    diagnostics: tuple[Diagnostic, ...]
    fixed: tuple[Path, ...] = ()

    @property
    def counts(self) -> Mapping[Severity, int]:
        """How many diagnostics there are of each severity."""
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
        domain: The file of the domain of all problems, where it shall not be looked for.
        domains: The directory of all domains; the usual one by default.
        problems: The directory of all problems; the usual one by default.
        fix: Mend what can be mended without knowing what the author meant, and check again.

    Raises:
        TmdError: There is nothing at a path, or a mended file cannot be written.
    """
    chosen = [Path(path) for path in paths]
    fixed: dict[Path, None] = {}
    for rounds in reversed(range(_MOST_ROUNDS + 1)):
        checker = Checker(domains, domain, problems)
        for path in chosen:
            checker.check(path)
        checker.finish()
        mended = _mend(checker) if fix and rounds else []
        if not mended:
            break
        fixed |= dict.fromkeys(mended)
    return CheckReport(tuple(checker.files), tuple(checker.findings.sorted()), tuple(fixed))


def _mend(checker: Checker) -> list[Path]:
    """Mend the files that were checked, each written whole; the files that changed."""
    by_file: dict[Path, list[Diagnostic]] = {}
    for diagnostic in checker.findings.sorted():
        if diagnostic.code in FIXABLE:
            by_file.setdefault(Path(diagnostic.location.file), []).append(diagnostic)
    changed = []
    for file, diagnostics in sorted(by_file.items()):
        text = fix_file(file, diagnostics)
        if text is not None:
            write_text(file, text)
            changed.append(file)
    return changed
