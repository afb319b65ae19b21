"""The domain that a problem belongs to: beside it, above it, or among the known domains."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tmd.check.pddl_file import kind_and_name
from tmd.diagnostics import TmdError
from tmd.world.folder import find_domain

_HEAD = 20_000
"""Bytes of a file in which its ``define`` is looked for."""
_MOST = 2_000
"""Directories with more PDDL files than that are not searched for a domain by its name."""


@dataclass(frozen=True, slots=True)
class FoundDomain:
    """The file of a domain, if there is one; ``others`` are those that may be meant as well."""

    file: Path | None
    others: tuple[Path, ...] = ()


def find_domain_file(problem: Path, name: str, domains: Path | None) -> FoundDomain:
    """The file of the domain ``name`` for the file ``problem``.

    The first of: a domain of that name beside the problem or one directory above; the known domain of that name;
    a file ``domain.pddl`` beside the problem, whatever its name.
    """
    here = problem.resolve().parent
    for directory in (here, here.parent):
        named = domains_in(directory).get(name, ())
        if named:
            best = _best(named, problem)
            return FoundDomain(_shown(best, problem)) if best else FoundDomain(None, tuple(named))
    for above in list(here.parents)[:3] if re.fullmatch(r"[\w-]+", name) else ():
        file = above / "domains" / name / "domain.pddl"
        if file.is_file():
            return FoundDomain(file)
    for above, part in ((above, here.relative_to(above).parts) for above in list(here.parents)[:4]):
        file = above / "domains" / part[1] / "domain.pddl" if len(part) > 1 and part[0] == "problems" else Path()
        if file.name and name in domains_in(file.parent):
            return FoundDomain(file)
    try:
        return FoundDomain(find_domain(name, domains).path / "domain.pddl")
    except TmdError:
        beside = problem.parent / "domain.pddl"
        return FoundDomain(beside if beside.is_file() else None)


def _best(named: Sequence[Path], problem: Path) -> Path | None:
    """Of several domains with one name: ``domain.pddl``, the one of the same number, or of the folder's name."""
    if len(named) == 1 or named[0].name == "domain.pddl":
        return named[0]
    here = problem.resolve().parent
    number = re.findall(r"[0-9]+", problem.stem)
    numbered = [p for p in named if p.parent == here and number and re.findall(r"[0-9]+", p.stem) == number]
    folders = (here.name, re.sub(r"[_-](test|train|training|validation)$", "", here.name))
    for fitting in (numbered, *([p for p in named if p.stem == folder] for folder in folders)):
        if len(fitting) == 1:
            return fitting[0]
    return None


def _shown(found: Path, problem: Path) -> Path:
    """``found`` in the way in which the problem's own path was written."""
    if found.parent == problem.resolve().parent:
        return problem.parent / found.name
    above = problem.parent.parent if problem.parent.name not in ("", "..") else problem.parent / ".."
    return above / found.name


@cache
def domains_in(directory: Path) -> dict[str, tuple[Path, ...]]:
    """The domains of a directory by name; ``domain.pddl`` goes before others of its name."""
    files = sorted(directory.glob("*.pddl"), key=lambda path: (path.name != "domain.pddl", path.name))
    found: dict[str, tuple[Path, ...]] = {}
    for file in files[:_MOST]:
        try:
            with file.open("rb") as opened:
                kind, name = kind_and_name(opened.read(_HEAD).decode("utf-8", errors="replace"))
        except OSError:
            continue
        if kind == "domain" and name:
            found[name] = (*found.get(name, ()), file)
    return found
