"""The directories of domains and problems, and the meaning of names for what is in them.

Every command imports this module, so functions import what is slow to load.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tmd.diagnostics import Location, TmdError
from tmd.pddl.reading.syntax import nearest, read_text
from tmd.world.folder import DomainFolder, find_domain, find_problems, find_roots
from tmd.world.problem_domain import domain_named_in, find_domain_file

if TYPE_CHECKING:
    from tmd.pddl.model import Domain, Problem
    from tmd.world.corpus import Corpus
    from tmd.world.environment import Environment
    from tmd.world.world import World

_DOMAIN_FILE = "domain.pddl"


@dataclass(frozen=True, slots=True)
class Roots:
    """The directories of all domains and of all problems; ``None`` is the usual place."""

    domains: Path | None = None
    problems: Path | None = None

    def folder(self, name: str) -> DomainFolder:
        """Return the domain ``name``, or the one in a file or directory where it is written as a path.

        Raises:
            TmdError: There is none.
        """
        path = Path(name)
        if path.suffix == ".pddl":
            return DomainFolder(path.absolute().parent, path.name)
        if _is_path(name) and path.is_dir():
            return find_domain(path.resolve().name, path.resolve().parent)
        return find_domain(name, self.domains)

    def sources(self, name: str) -> DomainFolder:
        """Find a domain as :meth:`folder` does; its ``domain.pddl`` need not be compiled yet.

        Raises:
            TmdError: There is none, or it has no object graphs.
        """
        roots = [] if _is_path(name) else find_roots("domains", self.domains)
        path = next((root / name for root in roots if (root / name).is_dir()), Path(name))
        folder = DomainFolder(path.resolve() if name in (".", "..") else path)
        if not folder.instructions_path.is_file():
            raise TmdError(
                f"there is nothing to compile in {self.folder(name).path}",
                hint="a domain with object graphs has instructions.pddl and objects.yaml",
            )
        return folder

    def corpus(self, folder: DomainFolder) -> Corpus:
        """Return the bundled environments and demonstrations of a domain.

        Raises:
            TmdError: There is no directory of problems.
        """
        from tmd.world.corpus import Corpus

        return Corpus(folder, find_problems(folder.name, self.problems))

    def domain(self, name: str) -> Domain:
        """Return the PDDL domain in a file, in a directory, or of a bundled name.

        Raises:
            TmdError: There is none, or it is wrong.
        """
        from tmd.pddl.reading.reader import read_domain

        return read_domain(self.pddl_file(name))

    def problem(self, path: Path, domain: str | None = None) -> Problem:
        """Return a PDDL problem with its domain.

        That is the one that was asked for, or else that of :meth:`of_problem`.

        Raises:
            TmdError: One of them is missing or wrong.
        """
        from tmd.pddl.reading.reader import read_problem

        return read_problem(path, self.domain(domain) if domain is not None else self.of_problem(path).domain)

    def of_problem(self, path: Path) -> DomainFolder:
        """Return the domain of a PDDL problem, by :func:`tmd.world.problem_domain.find_domain_file`.

        Raises:
            TmdError: There is none, or several.
        """
        name = domain_named_in(read_text(path))
        found = find_domain_file(path, name, self.domains)
        if found.others or not name:
            message = f'the domain "{name}" stands in several files'
            raise TmdError(
                message if name else "this problem does not say of which domain it is",
                location=Location(str(path), 1, 1),
                hint="give --domain NAME or FILE, or write (:domain NAME)",
            )
        return self.folder(str(found.file) if found.file else name)

    def path(self, name: str) -> Path:
        """Return the file or directory of that name; where there is none, the folder of the domain of that name.

        Raises:
            TmdError: There is neither.
        """
        path = Path(name)
        if path.exists() or path.suffix or _is_path(name):
            return path
        return self.folder(name).path

    def pddl_file(self, name: str) -> Path:
        """Return the PDDL file of a domain: that file, or the one of a bundled domain or of a domain folder.

        Raises:
            TmdError: There is none.
        """
        path = Path(name)
        if not path.is_dir() and _is_file(name):
            return path
        return self.folder(name).path / _DOMAIN_FILE

    def environment(self, name: str, domain: str | None) -> Path:
        """Return the file of an environment: the one at that path, or the bundled one of that name.

        Raises:
            TmdError: There is none, or several domains have one.
        """
        path = Path(name)
        if _is_file(name):
            return path
        if domain:
            return self.corpus(self.folder(domain)).file(name)
        roots = find_roots("problems", self.problems)
        places = {place.parent.name: place for root in reversed(roots) for place in root.glob("*/environments")}
        files = [f for _, d in sorted(places.items()) for f in sorted(d.iterdir()) if f.suffix in (".yaml", ".pddl")]
        found = [file for file in files if file.stem == name]
        if len(found) == 1:
            return found[0]
        if found:
            domains = ", ".join(file.parent.parent.name for file in found)
            raise TmdError(f"several domains have an environment '{name}'", hint=f"give --domain: {domains}")
        known = sorted({file.stem for file in files})
        hint = nearest(name, known, what="environments")
        raise TmdError(f"there is no environment '{name}'", hint=hint or f"give a file, or one of {', '.join(known)}")

    def world(self, environment: str, domain: str | None = None) -> tuple[Corpus, World]:
        """Return an environment, ready for grounding, and the corpus of its domain.

        ``environment`` is a file (YAML, or a PDDL problem), or the name of a bundled one; its own ``domain:`` is asked
        where no ``domain`` is given.

        Raises:
            TmdError: One of them is missing or wrong.
        """
        path = self.environment(environment, domain)
        corpus = self.corpus_of(path, domain)
        return corpus, corpus.world(path.stem if path == corpus.directory / "environments" / path.name else path)

    def corpus_of(self, path: Path, domain: str | None = None) -> Corpus:
        """Return the corpus of a domain, by default that of the environment in a file.

        Raises:
            TmdError: The environment or its domain is missing or wrong.
        """
        from tmd.world.environment import load_environment

        if domain is None:
            if path.suffix != ".pddl":
                domain = load_environment(path).domain
            elif path.parent.name == "environments":
                domain = path.parent.parent.name
        return self.corpus(self.of_problem(path) if domain is None else self.folder(domain))

    def recorded(self, place: str, domain: str | None) -> tuple[Corpus, World]:
        """Return the environment that a record names, with its domain, or with the one beside its PDDL problem.

        Raises:
            TmdError: One of them is missing or wrong.
        """
        own = domain
        if place.endswith(".pddl") and domain is not None:
            try:
                self.folder(domain)
            except TmdError:
                own = None
        return self.world(place, own)

    def room(self, environment: str, domain: str | None = None) -> tuple[Environment, DomainFolder]:
        """Return an environment of which the robot's scene can be built, and its domain.

        Raises:
            TmdError: It is missing or wrong, or does not say where things stand.
        """
        from tmd.world.environment import load_room

        read = load_room(self.environment(environment, domain))
        return read, self.folder(domain or read.domain)


def _is_path(name: str) -> bool:
    return "/" in name or "\\" in name or name in (".", "..")


def _is_file(name: str) -> bool:
    """Return whether a name is that of a file, there or not, and not that of something bundled."""
    path = Path(name)
    return path.is_file() or bool(path.suffix) or _is_path(name)
