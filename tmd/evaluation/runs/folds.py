"""The folds of a run. A model is never tested in an environment that it was trained in."""

from __future__ import annotations

import zlib
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby

from tmd.diagnostics import TmdError
from tmd.evaluation.runs.config import VEIL500, ExperimentConfig
from tmd.evaluation.runs.dataset import ALL, Dataset, Example
from tmd.pddl.reading.syntax import nearest

VEIL_PAIRS = ((1, 2), (3, 4), (5, 6), (7, 8))
"""The folds over environments 1-8 of VEIL-500; 9 and 10 are the authors' test set."""
HALVES = 2
"""The bundled environments are tested half of the examples at a time: five kitchens make ten folds."""
_LONGEST = 60
"""The longest name of a training set, in characters."""


@dataclass(frozen=True, slots=True)
class Fold:
    """One split. Folds with the same training examples have the same ``training_set``, the name of ``train``."""

    name: str
    train: tuple[Example, ...]
    test: tuple[Example, ...]
    training_set: str = ""


def folds_of(config: ExperimentConfig, data: Dataset) -> list[Fold]:
    """Return the folds of a run: for each group of tasks that are trained together its own.

    Raises:
        TmdError: They cannot be made.
    """
    if not data.examples:
        raise TmdError(
            f"there are no demonstrations of '{config.task}'", hint="--task all takes all tasks that there are"
        )
    found = []
    groups = _groups(config, data)
    for trained, tested in groups.items():
        test = [e for e in data.examples if e.task in tested]
        pool = [e for e in data.pool if e.task in trained]
        label = _label(sorted(trained), data.pool)
        prefix = f"{_label(tested, data.pool)}-" if len(groups) > 1 else ""
        for fold in _split(config, test, pool):
            numbers = {example.number for example in fold.train}
            found.append(Fold(prefix + fold.name, fold.train, fold.test, f"{label}_{ranges(numbers)}"))
    return found


def _groups(config: ExperimentConfig, data: Dataset) -> dict[frozenset[str], list[str]]:
    """Return the tested tasks, sorted, by the tasks that they are trained with."""
    tasks = sorted({example.task for example in data.pool})
    for task in config.train_tasks or ():
        if task not in tasks:
            raise TmdError(f"--train-tasks: there is no task '{task}'", hint=nearest(task, tasks))
    found: dict[frozenset[str], list[str]] = {}
    for task in sorted({example.task for example in data.examples}):
        trained = data.trained_with(task) if config.train_tasks is None else frozenset(config.train_tasks)
        found.setdefault(trained, []).append(task)
    return found


def _split(config: ExperimentConfig, test: Sequence[Example], pool: Sequence[Example]) -> list[Fold]:
    if config.train_environments is not None or config.test_environments is not None:
        return given_fold(test, pool, config.train_environments, config.test_environments)
    return pairs(test, pool) if config.data == VEIL500 else halves(test, pool)


def given_fold(
    examples: Sequence[Example], pool: Sequence[Example], train: Collection[int] | None, test: Collection[int] | None
) -> list[Fold]:
    """Return the one fold that environment numbers define; a side without numbers is all other environments.

    Raises:
        TmdError: An environment is in both, or nothing is left to train or test on.
    """
    numbers = {example.number for example in (*examples, *pool)}
    testing = set(test) if test is not None else numbers - set(train or ())
    training = set(train) if train is not None else numbers - testing
    if training & testing:
        both = ", ".join(map(str, sorted(training & testing)))
        raise TmdError(
            f"environment {both} is in both --train-environments and --test-environments",
            hint="a model is tested in environments it has not seen",
        )
    fold = _fold("given", examples, pool, training, testing)
    for side, chosen, asked in (("train", fold.train, training), ("test", fold.test, testing)):
        if not chosen:
            wanted = ", ".join(map(str, sorted(asked))) or "none"
            there = ", ".join(map(str, sorted(numbers)))
            raise TmdError(f"there is nothing to {side} on in environments {wanted}", hint=f"there are {there}")
    return [fold]


def halves(examples: Sequence[Example], pool: Sequence[Example]) -> list[Fold]:
    """Return each environment in turn, its examples in two halves: ten folds for five environments.

    Raises:
        TmdError: There is only one environment.
    """
    folds = []
    for environment in sorted({example.environment for example in examples}):
        train = tuple(e for e in pool if e.environment != environment)
        if not train:
            raise TmdError(
                f"there is no environment but {environment} that the training tasks were done in",
                hint="give other --train-tasks, or demonstrations in a second environment",
            )
        test = [e for e in examples if e.environment == environment]
        for half in range(min(HALVES, len(test))):
            folds.append(Fold(f"{environment}{'ab'[half]}", train, tuple(test[half::HALVES])))
    return folds


def pairs(examples: Sequence[Example], pool: Sequence[Example]) -> list[Fold]:
    """Return the four folds over environments 1-8 of VEIL-500.

    Raises:
        TmdError: There is nothing to test or to train on.
    """
    within = {number for pair in VEIL_PAIRS for number in pair}
    folds = []
    for pair in VEIL_PAIRS:
        name = "-".join(map(str, pair))
        fold = _fold(name, examples, pool, within - set(pair), set(pair))
        if fold.test and fold.train:
            folds.append(fold)
    if not folds:
        raise TmdError("there are no examples in environments 1-8", hint="say --test-environments")
    return folds


def _fold(
    name: str, examples: Sequence[Example], pool: Sequence[Example], train: Collection[int], test: Collection[int]
) -> Fold:
    return Fold(name, tuple(e for e in pool if e.number in train), tuple(e for e in examples if e.number in test))


def ranges(numbers: Iterable[int]) -> str:
    """Format numbers as people write them: ``1,3-5``."""
    places = groupby(enumerate(sorted(set(numbers))), key=lambda pair: pair[1] - pair[0])
    runs = ([number for _, number in run] for _, run in places)
    return ",".join("-".join(map(str, dict.fromkeys((run[0], run[-1])))) for run in runs)


def _label(tasks: Sequence[str], pool: Sequence[Example]) -> str:
    """Return a name for some tasks: ``all``, the kind of world that has just these, or all of their names.

    Names become names of files, so very many tasks are counted instead, with a digest that tells them apart.
    """
    if set(tasks) == {example.task for example in pool}:
        return ALL
    for world in sorted({example.world for example in pool}):
        if set(tasks) == {example.task for example in pool if example.world == world}:
            return world
    name = "+".join(tasks)
    return name if len(name) <= _LONGEST else f"{len(tasks)}_tasks_{zlib.crc32(name.encode()):08x}"
