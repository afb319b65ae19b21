"""What an experiment needs of a data set, and the two that there are: the bundled one and VEIL-500."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Protocol

from tmd.diagnostics import DataError, TmdError
from tmd.evaluation.metrics import Scorer
from tmd.evaluation.runs.config import VEIL500, ExperimentConfig
from tmd.evaluation.runs.protocol import FILE, read_protocol
from tmd.language.lexicon.file import read_lexicon
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.model import Formula, Instruction, Problem
from tmd.pddl.reading.syntax import nearest
from tmd.veil.corpus import Corpus
from tmd.veil.demonstration import Demonstration, Segment, read_goal
from tmd.veil.world import World, make_world
from tmd.world.folder import find_domain, find_problems

ALL = "all"
"""The task that stands for every task."""


@dataclass(frozen=True, slots=True)
class Example:
    """One point: a text in an environment, with what a person did.

    Attributes:
        id: What the data set calls it.
        task: What it is a demonstration of.
        world: The kind of place, ``kitchen`` say; templates are not carried from one kind to another.
        environment: The environment's name, unique in the data set.
        number: The environment's number within its world.
        demonstration: Text, segments and instructions.
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
        """What the person did."""
        return self.demonstration.instructions


class Worlds(Protocol):
    """What a model needs to learn from examples and to predict: the worlds they were made in, and the words."""

    @property
    def lexicon(self) -> Lexicon:
        """The words of the domain."""
        ...

    def world(self, environment: str) -> World:
        """The environment, as planning sees it."""
        ...


class Dataset(Worlds, Protocol):
    """Examples, and the worlds they were made in."""

    @property
    def examples(self) -> tuple[Example, ...]:
        """All examples of the task that was asked for, in the data set's order: what may be tested."""
        ...

    @property
    def pool(self) -> tuple[Example, ...]:
        """All examples of all tasks, in the data set's order: what may be trained on."""
        ...

    def trained_with(self, task: str) -> frozenset[str]:
        """The tasks that ``task`` is trained with under the protocol of the data, itself among them."""
        ...

    def scorer(self, environment: str) -> Scorer:
        """The metrics in the environment, as scoring sees it."""
        ...

    def written(self, environment: str, instructions: Iterable[Instruction]) -> list[str]:
        """The instructions in the data set's own notation."""
        ...

    def fingerprint(self) -> str:
        """A digest of the data as they were read; two runs on different data have different ones."""
        ...


class BundledData:
    """The demonstrations in ``problems/``.

    Args:
        task: A task, or ``all``.
        domain: The domain.
        domains: The directory of all domains, if not the usual one.
        problems: The directory of all problems, if not the usual one.

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
        self._groups = read_protocol(self.corpus.directory / FILE, known)
        self._pool = tuple(self._example(d) for name in known for d in self.corpus.demonstrations(name))
        self._check(known)
        self._examples = tuple(example for example in self._pool if example.task in tested)
        self._fingerprint = _digest(
            {
                "domain": (folder.path, ("*.pddl", "*.yaml", "*.txt")),
                "problems": (self.corpus.directory, ("*.jsonl", "*.yaml")),
            }
        )
        self._scorers: dict[str, Scorer] = {}

    def _example(self, d: Demonstration) -> Example:
        """A demonstration with its goal, read once: a faulty one is told before anything is done."""
        goal = read_goal(d, self.corpus.world(d.environment).task.problem)
        return Example(d.id, d.task, self.corpus.folder.name, d.environment, _number(d.environment), d, goal)

    def _check(self, known: Sequence[str]) -> None:
        """A task is the folder it lies in, and a number stands for one environment."""
        names: dict[int, str] = {}
        for example in self._pool:
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

    @property
    def examples(self) -> tuple[Example, ...]:
        """All demonstrations of the task."""
        return self._examples

    @property
    def pool(self) -> tuple[Example, ...]:
        """All demonstrations of the domain."""
        return self._pool

    def trained_with(self, task: str) -> frozenset[str]:
        """Its group in ``protocol.yaml``; all tasks if it stands in none."""
        everything = frozenset(example.task for example in self._pool)
        return next((group for group in self._groups if task in group), everything)

    @property
    def lexicon(self) -> Lexicon:
        """The words of the domain."""
        return self.corpus.lexicon

    def world(self, environment: str) -> World:
        """The environment, ground."""
        return self.corpus.world(environment)

    def scorer(self, environment: str) -> Scorer:
        """The metrics under the domain's own rules."""
        if environment not in self._scorers:
            scorer = Scorer(self.corpus.world(environment).task.problem)
            scorer.prepare(e.gold for e in self._examples if e.environment == environment)
            self._scorers[environment] = scorer
        return self._scorers[environment]

    def written(self, environment: str, instructions: Iterable[Instruction]) -> list[str]:
        """``keep(mug1, counter1, on)``."""
        return [str(instruction) for instruction in instructions]

    def fingerprint(self) -> str:
        """A digest of the demonstrations, the environments, the protocol and the domain."""
        return self._fingerprint


class VeilDataset:
    """VEIL-500 from a directory of the user's: planning by the sane rules, scoring by the literal ones.

    Args:
        directory: Where the data set is.
        task: A task, or ``all``.

    Raises:
        DataError: The data set is not there or damaged, or has no such task.
    """

    def __init__(self, directory: Path, task: str) -> None:
        from tmd.datasets.veil500.compile import domain_path
        from tmd.datasets.veil500.data import load

        self._data = load(directory)
        tasks = sorted({point.task for point in self._data.points})
        if task != ALL and task not in tasks:
            raise DataError(f"VEIL-500 has no task '{task}'", hint=nearest(task, tasks) or ", ".join(tasks))
        self._task = task
        self._fingerprint = _digest(
            {
                "data": (self._data.directory, ("*.xml",)),
                "domains": (domain_path("sane").parent, ("*.pddl", "*.yaml")),
            }
        )
        self._worlds: dict[str, World] = {}
        self._scorers: dict[str, Scorer] = {}

    @cached_property
    def examples(self) -> tuple[Example, ...]:
        """All points of the task."""
        return tuple(example for example in self.pool if self._task in (ALL, example.task))

    def trained_with(self, task: str) -> frozenset[str]:
        """All tasks of its world: nothing is carried from kitchens to living rooms."""
        worlds = {example.world for example in self.pool if example.task == task}
        return frozenset(example.task for example in self.pool if example.world in worlds)

    @cached_property
    def pool(self) -> tuple[Example, ...]:
        """All points; ids are places in ``data.xml``, environments go by file number."""
        found = []
        for point in self._data.points:
            name = f"{point.world}{point.environment}"
            segments: list[Segment] = []
            for group in point.groups:
                pieces = [s for s in (point.segments[i] for i in group.segments) if s.has_words]
                start = pieces[0].start if pieces else (segments[-1].end if segments else 0)
                end = pieces[-1].end if pieces else start
                segments.append(Segment(start, end, group.instructions))
            demonstration = Demonstration(str(point.index), point.task, name, point.text, tuple(segments))
            found.append(Example(point.index, point.task, point.world, name, point.environment, demonstration))
        return tuple(found)

    @cached_property
    def lexicon(self) -> Lexicon:
        """The built-in words, with those of the sane domain if it has any."""
        from tmd.datasets.veil500.compile import domain_path

        path = domain_path("sane").parent / "lexicon.yaml"
        return read_lexicon(path) if path.is_file() else Lexicon()

    def world(self, environment: str) -> World:
        """The environment under the sane rules."""
        if environment not in self._worlds:
            from tmd.datasets.veil500.compile import compile_environment

            problem = compile_environment(self._data.environments[self._key(environment)], "sane")
            self._worlds[environment] = make_world(environment, problem, self.lexicon, _kinds(problem))
        return self._worlds[environment]

    def scorer(self, environment: str) -> Scorer:
        """The metrics under the literal rules."""
        if environment not in self._scorers:
            from tmd.datasets.veil500.compile import absent_types, compile_environment
            from tmd.datasets.veil500.forms import mentioned

            place = self._data.environments[self._key(environment)]
            scorer = Scorer(compile_environment(place, "literal"), mentioned, absent_types(place))
            scorer.prepare(e.gold for e in self.examples if e.environment == environment)
            self._scorers[environment] = scorer
        return self._scorers[environment]

    def written(self, environment: str, instructions: Iterable[Instruction]) -> list[str]:
        """``keep Mug_1 On Sink``."""
        from tmd.datasets.veil500.forms import to_veil

        names = self._data.environments[self._key(environment)].names
        return [to_veil(instruction, names) for instruction in instructions]

    def fingerprint(self) -> str:
        """A digest of every file of the set, and of what the domain says of it."""
        return self._fingerprint

    def _key(self, environment: str) -> tuple[str, int]:
        return environment.rstrip("0123456789"), _number(environment)


def _kinds(problem: Problem) -> dict[str, str]:
    """VEIL-500 has no classes of things: a thing's kind is its name without the number."""
    return {o.name: re.sub(r"_\d+$", "", o.name) for o in problem.objects}


def _number(environment: str) -> int:
    match = re.search(r"(\d+)$", environment)
    if match is None:
        raise TmdError(f"the environment '{environment}' has no number", hint="name it kitchen1, kitchen2 …")
    return int(match[1])


def _digest(places: Mapping[str, tuple[Path, tuple[str, ...]]]) -> str:
    """Of the names and contents of files below directories, by kind; not of where the directories are."""
    digest = hashlib.sha256()
    for kind, (directory, patterns) in places.items():
        for path in sorted({path for pattern in patterns for path in directory.rglob(pattern)}):
            content = path.read_bytes()
            digest.update(f"{kind}/{path.relative_to(directory).as_posix()} {len(content)}\n".encode())
            digest.update(content)
    return digest.hexdigest()[:16]


def open_dataset(config: ExperimentConfig) -> Dataset:
    """The data of a run, read once in each process.

    Raises:
        TmdError: They are not there, or wrong.
    """
    if config.data == VEIL500:
        if config.veil500 is None:
            raise TmdError("VEIL-500 is not part of tmd", hint="say where it is: --veil500 DIR or VEIL500_DIR")
        return _veil(config.veil500, config.task)
    return _bundled(config.task, config.domain, config.domains, config.problems)


def forget_datasets() -> None:
    """Read data again when they are asked for next: a worker may live longer than the files it has read."""
    _veil.cache_clear()
    _bundled.cache_clear()


@lru_cache(maxsize=2)
def _veil(directory: Path, task: str) -> Dataset:
    return VeilDataset(directory, task)


@lru_cache(maxsize=2)
def _bundled(task: str, domain: str, domains: Path | None, problems: Path | None) -> Dataset:
    return BundledData(task, domain, domains, problems)
