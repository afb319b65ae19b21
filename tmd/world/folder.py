"""Domain folders, and where they are found.

A domain is a folder ``<domains>/<name>/``. It holds ``domain.pddl`` and, where the domain has object graphs,
``objects.yaml`` and ``instructions.pddl`` from which ``domain.pddl`` is compiled; ``lexicon.yaml`` for its words.
Its environments, problems and demonstrations lie in ``<problems>/<name>/``.

Every command imports this module, so functions import what is slow to load.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from tmd.diagnostics import TmdError
from tmd.files import bundled
from tmd.pddl.reading.syntax import nearest

if TYPE_CHECKING:
    from tmd.language.lexicon.lexicon import Lexicon
    from tmd.pddl.model import Domain
    from tmd.world.classes import Classes


DOMAIN_FILE = "domain.pddl"


@dataclass(frozen=True)
class DomainFolder:
    """A domain's folder, and what it holds, read when first asked for.

    Attributes:
        file: The name of the domain's file, where it is another than the usual one.
    """

    path: Path
    file: str = DOMAIN_FILE

    @property
    def name(self) -> str:
        """The folder's name, which is the domain's; of another file than the usual one the name of that."""
        return self.path.name if self.file == DOMAIN_FILE else Path(self.file).stem

    @cached_property
    def domain(self) -> Domain:
        """The PDDL domain.

        Raises:
            TmdError: It is missing or wrong.
        """
        from tmd.pddl.reading.reader import read_domain

        return read_domain(self.path / self.file)

    @cached_property
    def classes(self) -> Classes:
        """``objects.yaml``.

        Raises:
            TmdError: It is missing or wrong.
        """
        from tmd.pddl.reading.reader import read_domain
        from tmd.world.classes import Classes
        from tmd.world.yaml_positions import YamlSource

        path = self.path / "objects.yaml"
        if not path.is_file():
            raise TmdError(
                f"domain '{self.name}' has no objects.yaml, so it has no environments in YAML",
                hint="give a PDDL problem instead",
            )
        return Classes(YamlSource(path), {t.name: t.parent for t in read_domain(self.instructions_path).types})

    @property
    def instructions_path(self) -> Path:
        """The PDDL that people write: ``instructions.pddl`` where classes are compiled in."""
        return self.path / "instructions.pddl"

    @cached_property
    def costs(self) -> dict[str, int]:
        """The costs of instructions that ``skills.yaml`` gives.

        Raises:
            TmdError: A cost is no whole number of at least 0.
        """
        from tmd.world.costs import read_costs

        return read_costs(self.path / "skills.yaml")

    @property
    def lexicon_path(self) -> Path | None:
        """``lexicon.yaml``, if there is one."""
        path = self.path / "lexicon.yaml"
        return path if path.is_file() else None

    @cached_property
    def lexicon(self) -> Lexicon:
        """The built-in words with those of the domain.

        Raises:
            TmdError: ``lexicon.yaml`` or ``domain.pddl`` is wrong.
        """
        from tmd.language.lexicon.file import read_lexicon

        return read_lexicon(self.lexicon_path, self.kinds)

    @cached_property
    def kinds(self) -> tuple[str, ...]:
        """The names of the domain's types and constants.

        Raises:
            TmdError: ``domain.pddl`` is missing or wrong.
        """
        return (*(t.name for t in self.domain.types), *(c.name for c in self.domain.constants))


def find_roots(kind: str, given: Path | None = None) -> list[Path]:
    """Return the directories of ``domains`` or ``problems``, in the order in which they are searched.

    That is ``given`` alone; or ``./<kind>``, the copy in the installed package, the copy beside the package (a
    checkout), as far as they exist.

    Raises:
        TmdError: There is none.
    """
    if given is not None:
        if not given.is_dir():
            raise TmdError(f"{given}: no such directory", hint=f"--{kind} takes the directory of all {kind}")
        return [given]
    found: dict[Path, Path] = {}
    for candidate in (Path(kind), *bundled(kind)):
        if candidate.is_dir():
            found.setdefault(candidate.resolve(), candidate)
    if not found:
        raise TmdError(f"there is no directory of {kind}", hint=f"give one with --{kind} DIR")
    return list(found.values())


def find_domain(name: str, domains: Path | None = None) -> DomainFolder:
    """Return the folder of domain ``name``: your own hides a bundled one of the same name.

    Raises:
        TmdError: There is none; the hint names the nearest.
    """
    roots = find_roots("domains", domains)
    found = [root / name for root in roots if (root / name / "domain.pddl").is_file()]
    if Path(name).name != name or not found:
        known = known_domains(domains)
        hint = nearest(name, known) or f"there are {', '.join(known) or 'none'} in {', '.join(map(str, roots))}"
        raise TmdError(f"there is no domain '{name}'", hint=hint)
    return DomainFolder(found[0])


def known_domains(domains: Path | None = None) -> list[str]:
    """Return the names of all domains, sorted."""
    return sorted({path.parent.name for root in find_roots("domains", domains) for path in root.glob("*/domain.pddl")})


def find_problems(name: str, problems: Path | None = None) -> Path:
    """Return the directory ``<problems>/<name>`` of a domain: the first there is, or else where it would be.

    Raises:
        TmdError: There is no directory of problems.
    """
    roots = find_roots("problems", problems)
    return next((root / name for root in roots if (root / name).is_dir()), roots[0] / name)
