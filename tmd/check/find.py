"""The domain that a problem belongs to: beside it, above it, or among the known domains."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from tmd.check.pddl_file import kind_and_name
from tmd.errors import TmdError
from tmd.world.folder import find_domain

_HEAD = 20_000
"""Bytes of a file in which its ``define`` is looked for."""
_MOST = 2_000
"""Directories with more PDDL files than that are not searched for a domain by its name."""


def find_domain_file(problem: Path, name: str, domains: Path | None) -> Path | None:
    """The file of the domain ``name`` for the file ``problem``; ``None`` where there is none.

    The first of: a domain of that name beside the problem or one directory above; a file ``domain.pddl`` beside it,
    whatever its name; the known domain of that name.
    """
    here = problem.resolve().parent
    for directory in (here, here.parent):
        found = domains_in(directory).get(name)
        if found is not None:
            return _shown(found, problem)
    try:
        return find_domain(name, domains).path / "domain.pddl"
    except TmdError:
        beside = problem.parent / "domain.pddl"
        return beside if beside.is_file() else None


def _shown(found: Path, problem: Path) -> Path:
    """``found`` in the way in which the problem's own path was written."""
    if found.parent == problem.resolve().parent:
        return problem.parent / found.name
    return problem.parent / ".." / found.name if not problem.is_absolute() and problem.parent != Path() else found


@cache
def domains_in(directory: Path) -> dict[str, Path]:
    """The domains of a directory by name; ``domain.pddl`` goes before others of its name."""
    files = sorted(directory.glob("*.pddl"), key=lambda path: (path.name != "domain.pddl", path.name))
    found: dict[str, Path] = {}
    for file in files[:_MOST]:
        try:
            with file.open("rb") as opened:
                kind, name = kind_and_name(opened.read(_HEAD).decode("utf-8", errors="replace"))
        except OSError:
            continue
        if kind == "domain" and name:
            found.setdefault(name, file)
    return found
