"""YAML and JSON Lines of domains and problems: which file is checked how, and with what beside it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Protocol

from tmd.check.codes import Severity
from tmd.check.diagnostic import Findings
from tmd.check.yaml_files import check_compiled, check_environment, check_objects
from tmd.diagnostics import TmdError
from tmd.pddl.model import Problem
from tmd.pddl.reading.reader import read_problem
from tmd.pddl.reading.syntax import Report
from tmd.world.compile import compile_problem
from tmd.world.environment import EnvironmentFile, load_environment
from tmd.world.folder import DomainFolder, find_domain, find_problems
from tmd.world.yaml_positions import YamlSource


class FaultCollector(Protocol):
    """What takes in the faults of data files, and knows where domains and problems are."""

    domains: Path | None
    problems: Path | None
    findings: Findings
    files: dict[Path, None]

    def report(self, fault: TmdError, file: Path) -> None:
        """Take in a fault of ``file``."""

    def problem(self, file: Path) -> Problem | None:
        """The problem in ``file``; ``None`` where it or its domain has faults, which are told."""


class DataFiles:
    """Checks the files that are no PDDL; each folder and environment is read once.

    Args:
        checker: Takes what is found, and knows where domains and problems are.
    """

    def __init__(self, checker: FaultCollector) -> None:
        self.checker = checker
        self._folders: dict[Path, DomainFolder] = {}
        self._worlds: dict[Path, Problem | None] = {}

    def check(self, file: Path) -> None:
        """Check one file, by its name."""
        self.checker.files[file] = None
        known: dict[str, Callable[[Path], None]] = {
            "objects.yaml": self._objects,
            "lexicon.yaml": self._lexicon,
            "skills.yaml": self._skills,
            "templates.yaml": self._templates,
        }
        others = {".jsonl": self._demonstrations, ".json": self._planviz}
        check = known.get(file.name) or others.get(file.suffix, self._environment)
        self._try(check, file)

    def _try(self, check: Callable[[Path], object], file: Path) -> None:
        try:
            check(file)
        except TmdError as error:
            self.checker.report(error, file)
        except RecursionError:
            self.checker.report(TmdError("nested too deeply", code="nested-too-deeply"), file)

    def _report(self, file: Path) -> Report:
        return lambda fault: self.checker.report(fault, file)

    def _folder(self, file: Path) -> DomainFolder:
        """The domain folder that ``file`` lies in."""
        path = file.parent
        return self._folders.setdefault(path.resolve(), DomainFolder(path.resolve() if path == Path() else path))

    def _objects(self, file: Path) -> None:
        folder = self._folder(file)
        before = len(self.checker.findings)
        check_objects(folder, self._report(file))
        if len(self.checker.findings) == before and "classes" in folder.__dict__:
            self._try(lambda _: check_compiled(folder), folder.path / "domain.pddl")

    def _lexicon(self, file: Path) -> None:
        from tmd.check.lexicon_goals import check_goals
        from tmd.check.lexicon_verbs import check_goal_verbs, segments_of
        from tmd.check.lexicon_words import check_lexicon, texts_of
        from tmd.language.lexicon.file import read_lexicon

        folder = self._folder(file)
        actions = [action.name for action in folder.domain.actions]
        corpora = self._corpora(folder.path)
        lexicon = read_lexicon(file)
        texts = [text for path in corpora for text in texts_of(path)]
        segments = (text for path in corpora for text in segments_of(path))
        for fault in (
            *check_lexicon(file, actions, _names(folder), texts),
            *check_goals(file, lexicon, folder.domain, self._problems_of(folder), lambda: self._nameable(folder)),
            *check_goal_verbs(file, lexicon, actions, segments),
        ):
            self.checker.report(fault, file)

    def _corpora(self, folder: Path) -> list[Path]:
        """The demonstrations of a domain."""
        problems = self._beside(folder)
        return sorted(problems.glob("*/demonstrations.jsonl")) if problems else []

    def _beside(self, folder: Path) -> Path | None:
        """The problems of a domain: those beside its folder, or the known ones."""
        name = folder.resolve().name
        beside = folder.resolve().parent.parent / "problems" / name
        try:
            return beside if beside.is_dir() else find_problems(name, self.checker.problems)
        except TmdError:
            return None

    def _problems_of(self, folder: DomainFolder) -> Iterator[Problem]:
        """The environments of a domain that have no faults; faults are told where those files are checked."""
        problems = None if self._has_faults(folder) else self._beside(folder.path)
        for path in sorted((problems / "environments").glob("*")) if problems else ():
            try:
                if path.suffix == ".yaml":
                    yield compile_problem(load_environment(path), folder)
                elif path.suffix == ".pddl":
                    yield read_problem(path, folder.domain)
            except (TmdError, RecursionError):
                continue

    def _has_faults(self, folder: DomainFolder) -> bool:
        """Whether an error of a domain's folder is known: its environments may then lack what they should have."""
        found, here = self.checker.findings.sorted(), folder.path.resolve()
        return any(d.severity is Severity.ERROR and Path(d.location.file).resolve().parent == here for d in found)

    def _nameable(self, folder: DomainFolder) -> frozenset[str]:
        """What a group may name: as for nouns, or, without classes, the objects of the environments as well."""
        names = _names(folder)
        if names:
            return names
        domain = folder.domain
        objects = frozenset(o.name for problem in self._problems_of(folder) for o in problem.objects)
        return objects | {t.name for t in domain.types} | {c.name for c in domain.constants} if objects else frozenset()

    def _skills(self, file: Path) -> None:
        from tmd.robot.skills.skill_file import load_skills

        load_skills(self._folder(file), self._report(file))

    def _templates(self, file: Path) -> None:
        from tmd.evaluation.models.template_file import load_templates

        load_templates(self._folder(file))

    def _planviz(self, file: Path) -> None:
        from tmd.check.planviz import check_planviz

        check_planviz(file, self._report(file))

    def _environment(self, file: Path) -> None:
        key = file.resolve()
        if key not in self._worlds:
            self._worlds[key] = None
            faults: list[TmdError] = []
            said = YamlSource(file).load(EnvironmentFile)
            folder = self._domain_of(file, said.domain)
            problem = check_environment(file, folder, faults.append)
            for fault in faults:
                self.checker.report(fault, file)
            self._worlds[key] = None if faults else problem

    def _domain_of(self, file: Path, name: str) -> DomainFolder:
        """The folder of the domain ``name``: near the environment, or the known one."""
        if Path(name).name != name:
            raise YamlSource(file).error(("domain",), f"'{name}' is not a name of a domain", None, "outside-folder")
        for above in list(file.resolve().parents)[:4]:
            path = above / "domains" / name
            if (path / "domain.pddl").is_file():
                return self._folders.setdefault(path, DomainFolder(path))
        try:
            found = find_domain(name, self.checker.domains)
        except TmdError as error:
            raise YamlSource(file).error(("domain",), error.message, error.hint, "unknown-domain") from None
        return self._folders.setdefault(found.path.resolve(), found)

    def _demonstrations(self, file: Path) -> None:
        from tmd.check.demonstrations import check_demonstrations

        directory = file.parent.parent / "environments"
        environments = {p.stem: p for suffix in ("pddl", "yaml") for p in sorted(directory.glob(f"*.{suffix}"))}

        def world(name: str) -> Problem | None:
            path = environments[name]
            if path.suffix == ".pddl":
                return self.checker.problem(path)
            if path.resolve() not in self._worlds:
                self.check(path)
            return self._worlds.get(path.resolve())

        check_demonstrations(file, world, sorted(environments), self._report(file))


def _names(folder: DomainFolder) -> frozenset[str]:
    """What nouns of a domain may lead to; nothing where it has no classes, for then its objects are anybody's."""
    if not (folder.path / "objects.yaml").is_file():
        return frozenset()
    entries = folder.classes.entries
    parts = {part for entry in entries.classes.values() for part in entry.parts}
    domain = folder.domain
    declared = {t.name for t in domain.types} | {c.name for c in domain.constants}
    return frozenset({*entries.classes, *entries.substances, *parts, *declared})
