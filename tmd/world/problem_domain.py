"""The domain of a PDDL problem: which file it is in, by one rule for all commands."""

from __future__ import annotations

import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tmd.diagnostics import TmdError
from tmd.files import opened, real
from tmd.world.folder import find_domain

_DEFINE = re.compile(r"\(\s*define\s*\(\s*(domain|problem)\s+([^\s()]*)", re.IGNORECASE)
_LIKE_A_PROBLEM = re.compile(r"\(\s*(:init|:goal|:objects)\b", re.IGNORECASE)
_OF_DOMAIN = re.compile(r"\(\s*:domain\s+([^\s()]+)", re.IGNORECASE)
_COMMENT = re.compile(r";[^\n\r]*")
_FOLDER = re.compile(r"[\w-]{1,100}")
# Bytes of a file in which its ``define`` is looked for.
_HEAD = 20_000
# Directories with more PDDL files than that are not searched for a domain by its name.
_MOST = 2_000


def kind_and_name(text: str) -> tuple[str, str]:
    """Return whether ``text`` is a ``domain`` or a ``problem``, and its name in lower case (perhaps empty)."""
    code = _COMMENT.sub("", text)
    found = _DEFINE.search(code)
    if found:
        return found[1].lower(), found[2].lower()
    return ("problem" if _LIKE_A_PROBLEM.search(code) else "domain"), ""


def domain_named_in(text: str) -> str:
    """Return the domain that a problem says it is of; empty where it says nothing."""
    found = _OF_DOMAIN.search(_COMMENT.sub("", text))
    return found[1].lower() if found else ""


def domain_in(file: Path) -> str | None:
    """Return the name of the domain in ``file``; ``None`` where there is no file or no domain in it."""
    try:
        with opened(file) as content:
            kind, name = kind_and_name(content.read(_HEAD).decode("utf-8", errors="replace"))
    except OSError:
        return None
    return name if kind == "domain" else None


@dataclass(frozen=True, slots=True)
class FoundDomain:
    """The file of a domain, if there is one; ``others`` are those that may be meant as well."""

    file: Path | None
    others: tuple[Path, ...] = ()


def find_domain_file(problem: Path, name: str, domains: Path | None) -> FoundDomain:
    """Return the file of the domain ``name`` for the file ``problem``.

    The first of: a domain of that name beside the problem or one directory above; one in a folder ``domains/NAME`` near
    by or a known one, where the folder has the domain's name or that of the problem's in ``problems/``; a file
    ``domain.pddl`` beside the problem, whatever its name.
    """
    here = real(problem).parent
    for directory in (here, here.parent):
        named = domains_in(directory).get(name, ())
        if named:
            best = _best(named, problem)
            return FoundDomain(_shown(best, problem)) if best else FoundDomain(None, tuple(named))
    for folder in (name, *(above.name for above in (here, *here.parents) if above.parent.name == "problems")):
        with suppress(TmdError):
            path = folder_near(problem, folder) or find_domain(folder, domains).path
            if name in domains_in(path):
                return FoundDomain(path / "domain.pddl")
    beside = problem.parent / "domain.pddl"
    return FoundDomain(beside if beside.is_file() else None)


def folder_near(file: Path, name: str) -> Path | None:
    """Return the folder ``domains/NAME`` of a domain, in one of the directories above ``file``, if there is one."""
    above = list(real(file).parents)[:5] if _FOLDER.fullmatch(name) else []
    folders = (directory / "domains" / name for directory in above)
    return next((folder for folder in folders if (folder / "domain.pddl").is_file()), None)


def _best(named: Sequence[Path], problem: Path) -> Path | None:
    """Choose among domains of one name: ``domain.pddl``, the one of the same number, or of the folder's name."""
    if len(named) == 1 or named[0].name == "domain.pddl":
        return named[0]
    here = real(problem).parent
    number = re.findall(r"[0-9]+", problem.stem)
    numbered = [p for p in named if p.parent == here and number and re.findall(r"[0-9]+", p.stem) == number]
    folders = (here.name, re.sub(r"[_-](test|train|training|validation)$", "", here.name))
    for fitting in (numbered, *([p for p in named if p.stem == folder] for folder in folders)):
        if len(fitting) == 1:
            return fitting[0]
    return None


def _shown(found: Path, problem: Path) -> Path:
    """Return ``found`` in the way in which the problem's own path was written."""
    if found.parent == real(problem).parent:
        return problem.parent / found.name
    above = problem.parent.parent if problem.parent.name not in ("", "..") else problem.parent / ".."
    return above / found.name


@cache
def domains_in(directory: Path) -> dict[str, tuple[Path, ...]]:
    """Return the domains of a directory by name; ``domain.pddl`` goes before others of its name."""
    files = sorted(directory.glob("*.pddl"), key=lambda path: (path.name != "domain.pddl", path.name))
    found: dict[str, tuple[Path, ...]] = {}
    for file in files[:_MOST]:
        name = domain_in(file)
        if name:
            found[name] = (*found.get(name, ()), file)
    return found
