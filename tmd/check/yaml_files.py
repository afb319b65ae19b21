"""Checking the YAML files of a domain: object classes, environments, words, skills and templates."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from tmd.diagnostics import Location, TmdError
from tmd.pddl.model import Domain, Problem
from tmd.pddl.reading.reader import read_domain
from tmd.pddl.reading.syntax import Report, nearest, read_text
from tmd.world.classes import Classes, ObjectsFile
from tmd.world.compile import compile_domain, compile_problem, derive_rules
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder
from tmd.world.yaml_positions import YamlSource


def check_objects(folder: DomainFolder, report: Report) -> None:
    """``objects.yaml``: its form, the classes, their facts, and the rules that derive more.

    Raises:
        TmdError: The file cannot be used at all.
    """
    source = YamlSource(folder.path / "objects.yaml", report)
    if not folder.instructions_path.is_file():
        source.load(ObjectsFile)
        hint = "a domain with objects.yaml has its instructions there; domain.pddl is compiled"
        place = Location(str(source.path), 1, 1)
        raise TmdError("there is no instructions.pddl beside this", location=place, hint=hint, code="missing-file")
    domain = _instructions(folder)
    if domain is None:
        return
    classes = Classes(source, {t.name: t.parent for t in domain.types})
    arities = {p.name: len(p.parameters) for p in domain.predicates}
    for path, fact in _facts(classes):
        _check_fact(source, path, fact, arities)
    folder.__dict__["classes"] = classes
    for _ in derive_rules(folder):
        pass


def check_compiled(folder: DomainFolder) -> None:
    """``domain.pddl`` must be what its sources compile to.

    Raises:
        TmdError: It is something else.
    """
    target = folder.path / "domain.pddl"
    if not target.is_file() or read_text(target) != compile_domain(folder):
        raise TmdError(
            "this is not what instructions.pddl and objects.yaml compile to",
            location=Location(str(target), 1, 1),
            hint=f"run `tmd compile {folder.path}`",
            code="stale-domain",
        )


def check_environment(path: Path, folder: DomainFolder, report: Report) -> Problem | None:
    """An environment as a problem of its domain.

    Raises:
        TmdError: The file cannot be used at all.
    """
    return compile_problem(load_environment(path, report), folder)


def _instructions(folder: DomainFolder) -> Domain | None:
    """The hand-written domain that classes are compiled into; ``None`` where it has faults, which are told anyway."""
    try:
        return read_domain(folder.instructions_path)
    except TmdError:
        return None


def _facts(classes: Classes) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """Every fact of ``objects.yaml`` with its path; an edge as ``predicate tail head``."""
    entries = classes.entries
    for kind in ("facts", "init"):
        yield from (((kind, number), fact) for number, fact in enumerate(getattr(entries, kind)))
    for name, entry in entries.classes.items():
        for kind in ("facts", "init"):
            yield from ((("classes", name, kind, n), fact) for n, fact in enumerate(getattr(entry, kind)))
            for part, said in entry.parts.items():
                path = ("classes", name, "parts", part, kind)
                yield from (((*path, n), fact) for n, fact in enumerate(getattr(said, kind)))
        for number, edge in enumerate(entry.edges):
            words = edge.strip().strip("()").split()
            if len(words) > 2:
                yield ("classes", name, "edges", number), " ".join((words[1], words[0], *words[2:]))


def _check_fact(source: YamlSource, path: tuple[str | int, ...], fact: str, arities: dict[str, int]) -> None:
    words = fact.strip().strip("()").split()
    name = words[0] if words else ""
    if name not in arities:
        hint = nearest(name, sorted(arities))
        source.fault(source.error(path, f"'{fact}': the domain has no predicate '{name}'", hint, "unknown-predicate"))
    elif len(words) - 1 != arities[name]:
        message = f"'{fact}': '{name}' takes {arities[name]} argument(s), found {len(words) - 1}"
        source.fault(source.error(path, message, None, "wrong-arity"))
