"""Who is tested on what, trained on what. A model is never tested in an environment it was trained in."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from tmd.errors import TmdError
from tmd.evaluation.dataset import Example

VEIL_PAIRS = ((1, 2), (3, 4), (5, 6), (7, 8))
"""The folds over environments 1-8 of VEIL-500; 9 and 10 are the authors' test set."""
HALVES = 2
"""The bundled environments are tested half of the examples at a time: five kitchens make ten folds."""


@dataclass(frozen=True, slots=True)
class Fold:
    """One split."""

    name: str
    train: tuple[Example, ...]
    test: tuple[Example, ...]


def given_fold(examples: Sequence[Example], train: Collection[int] | None, test: Collection[int] | None) -> list[Fold]:
    """The one fold that environment numbers say; what is not said is all the others.

    Raises:
        TmdError: An environment is in both, or nothing is left to train or test on.
    """
    numbers = {example.number for example in examples}
    testing = set(test) if test is not None else numbers - set(train or ())
    training = set(train) if train is not None else numbers - testing
    if training & testing:
        both = ", ".join(map(str, sorted(training & testing)))
        raise TmdError(
            f"environment {both} is in both --train-environments and --test-environments",
            hint="a model is tested in environments it has not seen",
        )
    fold = _fold("given", examples, training, testing)
    for side, chosen, asked in (("train", fold.train, training), ("test", fold.test, testing)):
        if not chosen:
            wanted = ", ".join(map(str, sorted(asked))) or "none"
            there = ", ".join(map(str, sorted(numbers)))
            raise TmdError(f"there is nothing to {side} on in environments {wanted}", hint=f"there are {there}")
    return [fold]


def halves(examples: Sequence[Example]) -> list[Fold]:
    """Each environment in turn, its examples in two halves: ten folds for five environments.

    Raises:
        TmdError: There is only one environment.
    """
    environments = sorted({example.environment for example in examples})
    if len(environments) < HALVES:
        raise TmdError("there is only one environment, so there is none to be trained in")
    folds = []
    for environment in environments:
        train = tuple(e for e in examples if e.environment != environment)
        test = [e for e in examples if e.environment == environment]
        for half in range(HALVES):
            folds.append(Fold(f"{environment}{'ab'[half]}", train, tuple(test[half::HALVES])))
    return folds


def pairs(examples: Sequence[Example]) -> list[Fold]:
    """The four folds over environments 1-8 of VEIL-500.

    Raises:
        TmdError: A fold is empty.
    """
    within = {number for pair in VEIL_PAIRS for number in pair}
    folds = []
    for pair in VEIL_PAIRS:
        fold = _fold("-".join(map(str, pair)), examples, within - set(pair), set(pair))
        if fold.test and fold.train:
            folds.append(fold)
    if not folds:
        raise TmdError("there are no examples in environments 1-8", hint="say --test-environments")
    return folds


def _fold(name: str, examples: Sequence[Example], train: Collection[int], test: Collection[int]) -> Fold:
    return Fold(
        name,
        tuple(e for e in examples if e.number in train),
        tuple(e for e in examples if e.number in test),
    )
