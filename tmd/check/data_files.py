"""Checks of the YAML and JSON Lines of domains and problems."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from difflib import get_close_matches
from pathlib import Path
from typing import Protocol

from tmd.check.diagnostic import Diagnostic, Findings, Severity
from tmd.check.lint import lint_cases
from tmd.diagnostics import Location, MissingToolError, TmdError
from tmd.files import real
from tmd.language import parse, print_clause
from tmd.language.lexicon.file import BASES, read_lexicon
from tmd.language.lexicon.lexicon import Lexicon, section, singular
from tmd.pddl.model import Predicate, Problem
from tmd.pddl.reading.reader import read_domain, read_problem
from tmd.pddl.reading.syntax import Report, nearest, read_text
from tmd.world.classes import SELF, Classes, ObjectsFile
from tmd.world.compile import compile_domain, compile_problem, derive_rules, predicate_of
from tmd.world.corpus import replay
from tmd.world.demonstration import Demonstration, in_line, read_demonstrations
from tmd.world.environment import Environment, load_environment
from tmd.world.folder import DomainFolder, find_domain, find_problems
from tmd.world.problem_domain import folder_near
from tmd.world.yaml_positions import YamlSource


def check_demonstrations(path: Path, world: Callable[[str], Problem | None], known: list[str], report: Report) -> None:
    """Check every demonstration of a file: read it, and play it in its environment.

    ``world`` returns the environment of a name, ``None`` where it has faults; ``known`` are the names of all.

    Raises:
        TmdError: The file cannot be read.
    """
    for demonstration in read_demonstrations(path, report):
        try:
            _play(demonstration, world, known)
        except TmdError as error:
            report(error)


def _play(demonstration: Demonstration, world: Callable[[str], Problem | None], known: list[str]) -> None:
    if demonstration.environment not in known:
        message = f"there is no environment '{demonstration.environment}'"
        hint = nearest(demonstration.environment, known, what="environments")
        place = in_line(demonstration.location, demonstration.source, [json.dumps(demonstration.environment)])
        raise TmdError(message, location=place, hint=hint, code="unknown-environment")
    problem = world(demonstration.environment)
    if problem is not None:
        replay(demonstration, problem)


def check_objects(folder: DomainFolder, report: Report) -> None:
    """Check ``objects.yaml``: its form, the classes, their facts, and the rules that derive more.

    Raises:
        TmdError: The file cannot be used at all.
    """
    source = YamlSource(folder.path / "objects.yaml", report)
    if not folder.instructions_path.is_file():
        source.load(ObjectsFile)
        hint = "a domain with objects.yaml has its instructions there; domain.pddl is compiled"
        place = Location(str(source.path), 1, 1)
        raise TmdError("there is no instructions.pddl beside this", location=place, hint=hint, code="missing-file")
    try:
        domain = read_domain(folder.instructions_path)
    except TmdError:  # they are reported where that file is checked
        return
    classes = Classes(source, {t.name: t.parent for t in domain.types})
    predicates = {p.name: p for p in domain.predicates}
    constants = {c.name for c in domain.constants} | set(classes.entries.substances)
    for path, fact in _facts(classes):
        own = {SELF, *classes.get(str(path[1])).vertices} if path[0] == "classes" else set[str]()
        _check_fact(source, path, fact, predicates, constants | own)
    folder.__dict__["classes"] = classes
    for _ in derive_rules(folder):
        pass
    _check_nouns(source, classes, read_lexicon(folder.lexicon_path, folder.kinds))


def _check_nouns(source: YamlSource, classes: Classes, lexicon: Lexicon) -> None:
    """Check that each name of a class, part or substance is read as the object of a plain instruction."""
    entries = classes.entries
    relations = section("prepositions") | section("particles")
    named: dict[str, tuple[str | int, ...]] = {
        name: ("substances",) for name in entries.substances if name not in relations
    }
    for name, entry in entries.classes.items():
        named[name] = ("classes", name)
        named |= {part: ("classes", name, "parts", part) for part in entry.parts}
    for name, path in named.items():
        words = name.rstrip("0123456789").replace("-", "_").strip("_").split("_")
        read = parse(f"Take the {' '.join(words)}.", lexicon).clauses
        heads = {o.rpartition("_")[2] for clause in read for o in clause.objects}
        if len(read) != 1 or read[0].verb != "take" or not heads & {words[-1], singular(words[-1])}:
            message = f"'{' '.join(words)}' is not read as a thing: \"Take the {' '.join(words)}.\" gives "
            message += ", ".join(print_clause(clause) for clause in read) or "no clause"
            hint = "give it another name, or list it under `nouns` of lexicon.yaml"
            source.fault(source.error(path, message, hint, "unread-noun"))


def check_compiled(folder: DomainFolder) -> None:
    """Check that ``domain.pddl`` is the compiled form of its sources.

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


def check_shapes(folder: DomainFolder) -> None:
    """Check the shapes of ``objects.yaml`` and the files that they name.

    Raises:
        TmdError: A shape makes no sense, or a file is not what it should be.
    """
    from tmd.robot.assets.shapes import Shapes

    shapes, source = Shapes(folder), folder.classes.source
    for name in folder.classes.entries.classes:
        if shapes.sort(name) != "part":
            source.recover(None, shapes.blueprint, name)


def check_scene(environment: Environment, folder: DomainFolder) -> None:
    """Check the places of things: each finds room, and no two overlap.

    Only given positions can put things into each other, which the simulator finds to the millimetre; without
    the extra ``robot`` that is left out.

    Raises:
        TmdError: Something does not fit, or things overlap; with the place in the environment's file.
    """
    from importlib.util import find_spec

    from tmd.robot.scene.catalogue import Catalogue, built
    from tmd.robot.scene.placement import Placing

    things = Catalogue(environment, *built(environment, folder))
    Placing(environment, things.blueprints, things.names(), None)
    if any(entry.position for entry in environment.objects.values()) and find_spec("pybullet"):
        from tmd.robot.scene.scene import Scene
        from tmd.robot.sim.simulator import Simulator

        with Simulator() as sim:
            Scene(sim, environment, folder, settle=0)


def _facts(classes: Classes) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """Yield every fact of ``objects.yaml`` with its path; an edge as ``predicate tail head``."""
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


def _check_fact(
    source: YamlSource, path: tuple[str | int, ...], fact: str, predicates: dict[str, Predicate], names: set[str]
) -> None:
    """Check a fact: its predicate, the number of names, and names that differ by a letter from one of ``names``.

    Any other name may be that of an object, which each environment knows for itself.
    """
    words = fact.strip().strip("()").split()
    source.recover(None, predicate_of, words, predicates, path, source)
    for term in words[1:] if "edges" not in path else ():  # classes report the names of edges
        meant = [] if term in names else get_close_matches(term, sorted(names), n=1, cutoff=_ONE_LETTER)
        if meant:
            message = f"({' '.join(words)}): there is no '{term}'"
            source.fault(source.error(path, message, f'did you mean "{meant[0]}"?', "unknown-object"))


# The likeness (of :mod:`difflib`) of two names of three letters or more that differ by one.
_ONE_LETTER = 0.65


class FaultCollector(Protocol):
    """Receiver of the faults of data files, which knows the places of domains and problems."""

    domains: Path | None
    problems: Path | None
    findings: Findings
    files: dict[Path, None]

    def report(self, fault: TmdError, file: Path) -> None:
        """Take in a fault of ``file``."""

    def problem(self, file: Path) -> Problem | None:
        """Return the problem in ``file``; ``None`` where it or its domain has faults, which are reported."""


class DataFiles:
    """Checker of files that are not PDDL; each folder and environment is read once."""

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
        other = self._base_lexicon if file.parent.name == BASES else self._environment
        check = self._demonstrations if file.suffix == ".jsonl" else known.get(file.name, other)
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
        """Return the domain folder that ``file`` lies in."""
        path = file.parent
        return self._folders.setdefault(real(path), DomainFolder(real(path) if path == Path() else path))

    def _objects(self, file: Path) -> None:
        folder = self._folder(file)
        before = len(self.checker.findings)
        read = DomainFolder(folder.path)
        check_objects(read, self._report(file))
        if "classes" not in read.__dict__:
            return
        if read.classes.source.left_out <= {"shape"}:  # environments may need what else is left out
            folder.__dict__["classes"] = read.classes
        if len(self.checker.findings) == before:
            self._try(lambda _: check_compiled(folder), folder.path / "domain.pddl")
        if any(entry.shape for entry in read.classes.entries.classes.values()):
            check_shapes(read)

    def _lexicon(self, file: Path) -> None:
        from tmd.check.lexicon import check_goals, check_lexicon, check_phrases, declared_verbs, texts_of
        from tmd.goals.tables import faults_of

        folder = self._folder(file)
        actions = [action.name for action in folder.domain.actions]
        problems = self._beside(folder.path)
        corpora = sorted(problems.glob("*/demonstrations.jsonl")) if problems else []
        lexicon = read_lexicon(file)
        texts = [text for path in corpora for text in texts_of(path)]
        meant = declared_verbs(lexicon, folder.domain)
        for fault in (
            *faults_of(lexicon, folder.domain),
            *check_lexicon(file, lexicon, meant, actions, _names(folder), texts),
            *check_goals(file, lexicon, folder.domain, self._problems_of(folder), lambda: self._nameable(folder)),
            *check_phrases(file, lexicon),
        ):
            self.checker.report(fault, file)

    def _base_lexicon(self, file: Path) -> None:
        from tmd.check.lexicon import check_phrases
        from tmd.goals.tables import faults_of

        lexicon = read_lexicon(file)
        for fault in (*faults_of(lexicon), *check_phrases(file, lexicon)):
            self.checker.report(fault, file)

    def _beside(self, folder: Path) -> Path | None:
        """Return the problems of a domain: those beside its folder, or the known ones."""
        name = real(folder).name
        beside = real(folder).parent.parent / "problems" / name
        try:
            return beside if beside.is_dir() else find_problems(name, self.checker.problems)
        except TmdError:
            return None

    def _problems_of(self, folder: DomainFolder) -> Iterator[Problem]:
        """Yield the environments of a domain that have no faults; faults are reported where those files are checked."""
        faulty = any(d.severity is Severity.ERROR for d in self._found_in(folder))  # they may be incomplete then
        problems = None if faulty else self._beside(folder.path)
        for path in sorted((problems / "environments").glob("*")) if problems else ():
            try:
                if path.suffix == ".yaml":
                    yield compile_problem(load_environment(path), folder)
                elif path.suffix == ".pddl":
                    yield read_problem(path, folder.domain)
            except (TmdError, RecursionError):
                continue

    def _found_in(self, folder: DomainFolder) -> list[Diagnostic]:
        """Return what was found in the folder of a domain."""
        found = self.checker.findings.sorted()
        return [d for d in found if real(Path(d.location.file)).parent == real(folder.path)]

    def _nameable(self, folder: DomainFolder) -> frozenset[str]:
        """Return the names that a group may have: as for nouns, or, without classes, those of objects as well."""
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

    def _environment(self, file: Path) -> None:
        key = real(file)
        if key not in self._worlds:
            self._worlds[key] = None
            faults: list[TmdError] = []
            environment = load_environment(file, faults.append)
            folder = self._domain_of(file, environment.domain)
            problem = compile_problem(environment, folder)
            scene = faults or _scene_faults(file, folder)
            told = {(d.code, d.message) for d in self._found_in(folder)}
            for fault in scene:
                if (fault.code, fault.message) not in told:  # a fault of a class is reported there
                    self.checker.report(fault, file)
            for fault in () if faults else lint_cases(problem):
                self.checker.report(fault, file)
            self._worlds[key] = None if faults else problem

    def _domain_of(self, file: Path, name: str) -> DomainFolder:
        """Return the folder of the domain ``name``: near the environment, or the known one."""
        if Path(name).name != name:
            raise YamlSource(file).error(("domain",), f"'{name}' is not a name of a domain", None, "outside-folder")
        near = folder_near(file, name)
        if near:
            return self._folders.setdefault(near, DomainFolder(near))
        try:
            found = find_domain(name, self.checker.domains)
        except TmdError as error:
            raise YamlSource(file).error(("domain",), error.message, error.hint, "unknown-domain") from None
        return self._folders.setdefault(real(found.path), found)

    def _demonstrations(self, file: Path) -> None:
        directory = file.parent.parent / "environments"
        environments = {p.stem: p for suffix in ("pddl", "yaml") for p in sorted(directory.glob(f"*.{suffix}"))}

        def world(name: str) -> Problem | None:
            path = environments[name]
            if path.suffix == ".pddl":
                return self.checker.problem(path)
            if real(path) not in self._worlds:
                self.check(path)
            return self._worlds.get(real(path))

        check_demonstrations(file, world, sorted(environments), self._report(file))


def _scene_faults(file: Path, folder: DomainFolder) -> list[TmdError]:
    """Return the faults of an environment as a scene, in a domain with skills."""
    if not (folder.path / "skills.yaml").is_file():
        return []
    try:
        check_scene(load_environment(file), folder)
    except MissingToolError:
        return []  # without what reads meshes there is no scene to be looked at
    except TmdError as error:
        return [error]
    return []


def _names(folder: DomainFolder) -> frozenset[str]:
    """Return the names that nouns of a domain may mean; empty for a domain without classes."""
    if not (folder.path / "objects.yaml").is_file():
        return frozenset()
    entries = folder.classes.entries
    parts = {part for entry in entries.classes.values() for part in entry.parts}
    domain = folder.domain
    declared = {t.name for t in domain.types} | {c.name for c in domain.constants}
    return frozenset({*entries.classes, *entries.substances, *parts, *declared})
