"""Data sets for experiments: the bundled one and VEIL-500."""

from __future__ import annotations

import hashlib
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Protocol

from pydantic import BaseModel, ConfigDict

from tmd.datasets.veil500.compile import absent_types, compile_environment
from tmd.datasets.veil500.data import Point, load
from tmd.datasets.veil500.forms import domain_path, mentioned, to_veil
from tmd.diagnostics import DataError, TmdError
from tmd.evaluation.metrics import Scorer
from tmd.evaluation.runs.config import VEIL500, ExperimentConfig
from tmd.language.lexicon.file import read_lexicon
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.model import Formula, Instruction, Problem
from tmd.pddl.reading.syntax import nearest
from tmd.world.corpus import Corpus
from tmd.world.demonstration import Demonstration, Segment, read_goal
from tmd.world.folder import DomainFolder, find_domain, find_problems
from tmd.world.world import World, make_world
from tmd.world.yaml_positions import YamlSource

ALL = "all"
"""The name that selects every task."""
PROTOCOL = "protocol.yaml"
"""The file beside the problems of a domain that says which tasks are trained together."""


class ProtocolFile(BaseModel):
    """The protocol of a domain: the tasks that are trained together.

    Section VII: "…the first two tasks trained together and then the next two tasks trained together"::

        trained_together:
          - [boiling_water, coffee]
          - [affogato, ramen]

    A task in no group, or of a domain without this file, is trained with all tasks.
    """

    model_config = ConfigDict(extra="forbid")
    trained_together: list[list[str]] = []


def read_protocol(path: Path, tasks: Collection[str]) -> tuple[frozenset[str], ...]:
    """Return the groups of tasks in a protocol file; none where there is no file.

    Raises:
        TmdError: The file is wrong, names a task that is not there, or names one twice.
    """
    if not path.is_file():
        return ()
    source = YamlSource(path)
    groups = source.load(ProtocolFile).trained_together
    seen: set[str] = set()
    for i, group in enumerate(groups):
        for j, task in enumerate(group):
            place = ("trained_together", i, j)
            if task not in tasks:
                raise source.error(place, f"there is no task '{task}'", nearest(task, sorted(tasks)))
            if task in seen:
                raise source.error(place, f"the task '{task}' stands here twice")
            seen.add(task)
    return tuple(frozenset(group) for group in groups if group)


@dataclass(frozen=True, slots=True)
class Example:
    """One point: a text in an environment, with what a person did.

    Attributes:
        world: The kind of place, ``kitchen`` say; templates are not carried from one kind to another.
        environment: The environment's name, unique in the data set.
        goal: What the demonstration's goal says; ``None`` where it has none.
    """

    id: str | int
    task: str
    world: str
    environment: str
    number: int
    demonstration: Demonstration
    goal: Formula | None = None

    @property
    def gold(self) -> tuple[Instruction, ...]:
        """The instructions that the person gave."""
        return self.demonstration.instructions


class Worlds(Protocol):
    """The worlds that examples were made in, and the words: needed for learning and predicting."""

    @property
    def lexicon(self) -> Lexicon:
        """The words of the domain."""
        ...

    def world(self, environment: str) -> World:
        """Return an environment as planning sees it."""
        ...


class Dataset(ABC):
    """Examples, and the worlds they were made in.

    Examples of all tasks, the ``pool``, may be trained on, those of ``tested`` tasks are tested; both have the data
    set's order. ``files`` are what the data were read from, for the fingerprint: directory and patterns by kind.
    """

    def __init__(
        self,
        folder: DomainFolder,
        lexicon: Lexicon,
        pool: tuple[Example, ...],
        tested: Collection[str],
        files: Mapping[str, tuple[Path, tuple[str, ...]]],
    ) -> None:
        self.folder = folder
        self.lexicon = lexicon
        self.pool = pool
        self.examples = tuple(example for example in pool if example.task in tested)
        self._fingerprint = _digest(files)
        self._scorers: dict[str, Scorer] = {}

    @abstractmethod
    def trained_with(self, task: str) -> frozenset[str]:
        """Return the tasks that ``task`` is trained with under the protocol of the data, itself among them."""

    @abstractmethod
    def world(self, environment: str) -> World:
        """Return an environment as planning sees it."""

    def scorer(self, environment: str) -> Scorer:
        """Return the metrics in an environment, as scoring sees it."""
        if environment not in self._scorers:
            scorer = self._scorers[environment] = self._scorer(environment)
            scorer.prepare(e.gold for e in self.examples if e.environment == environment)
        return self._scorers[environment]

    @abstractmethod
    def _scorer(self, environment: str) -> Scorer:
        """Make the metrics of an environment."""

    def written(self, environment: str, instructions: Iterable[Instruction]) -> list[str]:
        """Return instructions in the data set's own notation, such as ``keep(mug1, counter1, on)``."""
        return [str(instruction) for instruction in instructions]

    def fingerprint(self) -> str:
        """Return a digest of the files as they were read; two runs on different data have different ones."""
        return self._fingerprint


class BundledData(Dataset):
    """The demonstrations in ``problems/``.

    ``task`` may be ``all``; ``domains`` and ``problems`` are the directories of all of them, if not the usual ones.

    Raises:
        TmdError: There is no such domain or task, or a file of it is wrong.
    """

    def __init__(
        self, task: str, domain: str = "kitchen", domains: Path | None = None, problems: Path | None = None
    ) -> None:
        folder = find_domain(domain, domains)
        self.corpus = Corpus(folder, find_problems(domain, problems))
        known = self.corpus.tasks()
        tested = frozenset(known) if task == ALL else frozenset({d.task for d in self.corpus.demonstrations(task)})
        self._groups = read_protocol(self.corpus.directory / PROTOCOL, known)
        pool = tuple(self._example(d) for name in known for d in self.corpus.demonstrations(name))
        self._check(pool, known)
        files = {
            "domain": (folder.path, ("*.pddl", "*.yaml", "*.txt")),
            "problems": (self.corpus.directory, ("*.jsonl", "*.yaml")),
        }
        super().__init__(folder, self.corpus.lexicon, pool, tested, files)

    def _example(self, d: Demonstration) -> Example:
        """Return a demonstration with its goal; a faulty goal is reported before anything is done."""
        goal = read_goal(d, self.corpus.world(d.environment).task.problem)
        return Example(d.id, d.task, self.corpus.folder.name, d.environment, _number(d.environment), d, goal)

    def _check(self, pool: Sequence[Example], known: Sequence[str]) -> None:
        """Refuse a task that is not named after its folder, and two environments of one number."""
        names: dict[int, str] = {}
        for example in pool:
            if example.task not in known:
                raise TmdError(
                    f"the demonstration '{example.id}' in {self.corpus.directory} is of a task '{example.task}'",
                    hint="a task has the name of its folder",
                )
            other = names.setdefault(example.number, example.environment)
            if other != example.environment:
                raise TmdError(
                    f"the environments {other} and {example.environment} have the same number",
                    hint="environments are chosen by number: give each its own",
                )

    def trained_with(self, task: str) -> frozenset[str]:
        """Return the group of a task in ``protocol.yaml``; all tasks where it is in none."""
        everything = frozenset(example.task for example in self.pool)
        return next((group for group in self._groups if task in group), everything)

    def world(self, environment: str) -> World:
        """Return an environment, ground."""
        return self.corpus.world(environment)

    def _scorer(self, environment: str) -> Scorer:
        return Scorer(self.corpus.world(environment).task.problem)


class VeilDataset(Dataset):
    """VEIL-500 from a directory: planning by the sane rules, scoring by the literal ones.

    Ids are places in ``data.xml``, environments go by file number. ``task`` may be ``all``.

    Raises:
        DataError: The data set is not there or damaged, or has no such task.
    """

    def __init__(self, directory: Path, task: str) -> None:
        self._data = load(directory)
        tasks = sorted({point.task for point in self._data.points})
        if task != ALL and task not in tasks:
            raise DataError(f"VEIL-500 has no task '{task}'", hint=nearest(task, tasks) or ", ".join(tasks))
        domains = domain_path("sane").parent
        words = domains / "lexicon.yaml"
        super().__init__(
            DomainFolder(domains),
            read_lexicon(words) if words.is_file() else Lexicon(),
            tuple(map(_example_of, self._data.points)),
            tasks if task == ALL else [task],
            {"data": (self._data.directory, ("*.xml",)), "domains": (domains, ("*.pddl", "*.yaml"))},
        )
        self._worlds: dict[str, World] = {}

    def trained_with(self, task: str) -> frozenset[str]:
        """Return all tasks of the world of a task: nothing is carried from kitchens to living rooms."""
        worlds = {example.world for example in self.pool if example.task == task}
        return frozenset(example.task for example in self.pool if example.world in worlds)

    def world(self, environment: str) -> World:
        """Return an environment under the sane rules."""
        if environment not in self._worlds:
            problem = compile_environment(self._data.environments[_key(environment)], "sane")
            self._worlds[environment] = make_world(environment, problem, self.lexicon, _kinds(problem))
        return self._worlds[environment]

    def _scorer(self, environment: str) -> Scorer:
        place = self._data.environments[_key(environment)]
        return Scorer(compile_environment(place, "literal"), mentioned, absent_types(place))

    def written(self, environment: str, instructions: Iterable[Instruction]) -> list[str]:
        """Return instructions as VEIL-500 writes them, such as ``keep Mug_1 On Sink``."""
        names = self._data.environments[_key(environment)].names
        return [to_veil(instruction, names) for instruction in instructions]


def _example_of(point: Point) -> Example:
    """Return a point of VEIL-500; its groups of actions become segments."""
    name = f"{point.world}{point.environment}"
    segments: list[Segment] = []
    for group in point.groups:
        pieces = [s for s in (point.segments[i] for i in group.segments) if s.has_words]
        start = pieces[0].start if pieces else (segments[-1].end if segments else 0)
        end = pieces[-1].end if pieces else start
        segments.append(Segment(start, end, group.instructions))
    demonstration = Demonstration(str(point.index), point.task, name, point.text, tuple(segments))
    return Example(point.index, point.task, point.world, name, point.environment, demonstration)


def _key(environment: str) -> tuple[str, int]:
    return environment.rstrip("0123456789"), _number(environment)


def _kinds(problem: Problem) -> dict[str, str]:
    """Return the kind of each object: its name without the number, for VEIL-500 has no classes in PDDL."""
    return {o.name: re.sub(r"_\d+$", "", o.name) for o in problem.objects}


def _number(environment: str) -> int:
    match = re.search(r"(\d+)$", environment)
    if match is None:
        raise TmdError(f"the environment '{environment}' has no number", hint="name it kitchen1, kitchen2 …")
    return int(match[1])


def _digest(places: Mapping[str, tuple[Path, tuple[str, ...]]]) -> str:
    """Return a digest of the names and contents of files, by kind; the place of their directories does not count."""
    digest = hashlib.sha256()
    for kind, (directory, patterns) in places.items():
        for path in sorted({path for pattern in patterns for path in directory.rglob(pattern)}):
            content = path.read_bytes()
            digest.update(f"{kind}/{path.relative_to(directory).as_posix()} {len(content)}\n".encode())
            digest.update(content)
    return digest.hexdigest()[:16]


def open_dataset(config: ExperimentConfig) -> Dataset:
    """Return the data of a run, read once in each process.

    Raises:
        TmdError: They are not there, or wrong.
    """
    if config.data == VEIL500:
        if config.veil500 is None:
            raise TmdError("VEIL-500 is not part of tmd", hint="say where it is: --veil500 DIR or VEIL500_DIR")
        return _read_once(VeilDataset, config.veil500, config.task)
    return _read_once(BundledData, config.task, config.domain, config.domains, config.problems)


@lru_cache(maxsize=4)
def _read_once(kind: Callable[..., Dataset], *place: str | Path | None) -> Dataset:
    return kind(*place)
