"""What an experiment needs of a data set, and the two that there are: the bundled one and VEIL-500."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Protocol

from tmd.errors import DataError, TmdError
from tmd.evaluation.metrics import Scorer
from tmd.language.lexicon import Lexicon
from tmd.pddl.model import Instruction
from tmd.pddl.syntax import nearest
from tmd.veil.corpus import Corpus
from tmd.veil.demonstration import Demonstration, Segment
from tmd.veil.world import World, make_world
from tmd.world.folder import find_domain, find_root

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
    """

    id: str | int
    task: str
    world: str
    environment: str
    number: int
    demonstration: Demonstration

    @property
    def gold(self) -> tuple[Instruction, ...]:
        """What the person did."""
        return self.demonstration.instructions


class Dataset(Protocol):
    """Examples, and the worlds they were made in."""

    @property
    def examples(self) -> tuple[Example, ...]:
        """All examples of the task that was asked for, in the data set's order."""
        ...

    @property
    def lexicon(self) -> Lexicon:
        """The words of the domain."""
        ...

    def world(self, environment: str) -> World:
        """The environment, as planning sees it."""
        ...

    def scorer(self, environment: str) -> Scorer:
        """The metrics in the environment, as scoring sees it."""
        ...

    def written(self, environment: str, instructions: Iterable[Instruction]) -> list[str]:
        """The instructions in the data set's own notation."""
        ...

    def fingerprint(self) -> str:
        """A digest of the data; two runs on different data have different ones."""
        ...


class BundledData:
    """The demonstrations in ``problems/``.

    Args:
        task: A task, or ``all``.
        domain: The domain.
        domains: The directory of all domains, if not the usual one.
        problems: The directory of all problems, if not the usual one.

    Raises:
        TmdError: There is no such domain or task.
    """

    def __init__(
        self, task: str, domain: str = "kitchen", domains: Path | None = None, problems: Path | None = None
    ) -> None:
        folder = find_domain(domain, domains)
        self.corpus = Corpus(folder, find_root("problems", problems) / domain)
        demonstrations = self.corpus.demonstrations(None if task == ALL else task)
        self._examples = tuple(
            Example(d.id, d.task, domain, d.environment, _number(d.environment), d) for d in demonstrations
        )
        self._scorers: dict[str, Scorer] = {}

    @property
    def examples(self) -> tuple[Example, ...]:
        """All demonstrations of the task."""
        return self._examples

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
        """A digest of the demonstrations, the environments and the domain."""
        files = sorted(self.corpus.directory.rglob("*.jsonl")) + sorted(self.corpus.directory.rglob("*.yaml"))
        return _digest([self.corpus.folder.path / "domain.pddl", *files])


class VeilDataset:
    """VEIL-500 from a directory of the user's: planning by the sane rules, scoring by the literal ones.

    Args:
        directory: Where the data set is.
        task: A task, or ``all``.

    Raises:
        DataError: The data set is not there or damaged, or has no such task.
    """

    def __init__(self, directory: Path, task: str) -> None:
        from tmd.world.veil500.data import load

        self._data = load(directory)
        tasks = sorted({point.task for point in self._data.points})
        if task != ALL and task not in tasks:
            raise DataError(f"VEIL-500 has no task '{task}'", hint=nearest(task, tasks) or ", ".join(tasks))
        self._points = [p for p in self._data.points if task in (ALL, p.task)]
        self._worlds: dict[str, World] = {}
        self._scorers: dict[str, Scorer] = {}

    @cached_property
    def examples(self) -> tuple[Example, ...]:
        """All points of the task; ids are places in ``data.xml``, environments go by file number."""
        found = []
        for point in self._points:
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
        from tmd.world.veil500.compile import domain_path

        path = domain_path("sane").parent / "lexicon.yaml"
        return Lexicon.load(path) if path.is_file() else Lexicon()

    def world(self, environment: str) -> World:
        """The environment under the sane rules."""
        if environment not in self._worlds:
            from tmd.world.veil500.compile import compile_environment

            problem = compile_environment(self._data.environments[self._key(environment)], "sane")
            self._worlds[environment] = make_world(environment, problem, self.lexicon)
        return self._worlds[environment]

    def scorer(self, environment: str) -> Scorer:
        """The metrics under the literal rules."""
        if environment not in self._scorers:
            from tmd.world.veil500.compile import absent_types, compile_environment
            from tmd.world.veil500.forms import mentioned

            place = self._data.environments[self._key(environment)]
            scorer = Scorer(compile_environment(place, "literal"), mentioned, absent_types(place))
            scorer.prepare(e.gold for e in self.examples if e.environment == environment)
            self._scorers[environment] = scorer
        return self._scorers[environment]

    def written(self, environment: str, instructions: Iterable[Instruction]) -> list[str]:
        """``keep Mug_1 On Sink``."""
        from tmd.world.veil500.forms import to_veil

        names = self._data.environments[self._key(environment)].names
        return [to_veil(instruction, names) for instruction in instructions]

    def fingerprint(self) -> str:
        """A digest of every file of the set."""
        return _digest(sorted(self._data.directory.rglob("*.xml")))

    def _key(self, environment: str) -> tuple[str, int]:
        return environment.rstrip("0123456789"), _number(environment)


def _number(environment: str) -> int:
    match = re.search(r"(\d+)$", environment)
    if match is None:
        raise TmdError(f"the environment '{environment}' has no number", hint="name it kitchen1, kitchen2 …")
    return int(match[1])


def _digest(paths: Iterable[Path]) -> str:
    digest = hashlib.sha256()
    for path in paths:
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
