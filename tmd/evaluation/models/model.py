"""The rows of the table: models that learn from examples and predict an instruction sequence for another one."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from statistics import median
from typing import Protocol, Self

import numpy as np

from tmd.diagnostics import TmdError
from tmd.evaluation.models.instruction_tree import InstructionTree
from tmd.evaluation.models.paper_models import ROWS, libraries
from tmd.evaluation.models.predefined_templates import PredefinedTemplates
from tmd.evaluation.models.prediction import Made, Prediction, from_state
from tmd.evaluation.models.ranked import Ranked
from tmd.evaluation.runs.dataset import Dataset, Example
from tmd.inference.energy import clause_distance, environment_distance
from tmd.language.clause import Clause
from tmd.library.library import Library
from tmd.library.template import instantiate
from tmd.pddl.reading.syntax import nearest
from tmd.world.world import World


class Model(Protocol):
    """One row of the table."""

    def fit(self, examples: Sequence[Example], data: Dataset, random: np.random.Generator) -> Self:
        """Learn from ``examples``."""
        ...

    def predict(self, example: Example, data: Dataset, random: np.random.Generator) -> Prediction:
        """Return the instructions for the example's text in its environment; its own sequence is not looked at."""
        ...


class Empty:
    """The empty prediction: the floor of every metric."""

    def fit(self, examples: Sequence[Example], data: Dataset, random: np.random.Generator) -> Self:
        """Learn nothing."""
        return self

    def predict(self, example: Example, data: Dataset, random: np.random.Generator) -> Prediction:
        """Return an empty prediction."""
        return Prediction()


class Chance:
    """Random instructions of a predefined length (section VII): how large the output space is.

    The length is the median of the training sequences of the same world; each instruction is drawn evenly from
    all those that may ever apply in the environment.
    """

    def fit(self, examples: Sequence[Example], data: Dataset, random: np.random.Generator) -> Self:
        """Learn the length."""
        worlds = sorted({example.world for example in examples})
        self.lengths_ = {world: int(median(len(e.gold) for e in examples if e.world == world)) for world in worlds}
        return self

    def predict(self, example: Example, data: Dataset, random: np.random.Generator) -> Prediction:
        """Return a random sequence."""
        operators = data.world(example.environment).task.operators
        draws = random.integers(len(operators), size=self.lengths_.get(example.world, 0))
        return Prediction(tuple(operators[int(draw)].instruction for draw in draws))


class NearestEnvironment:
    """Nearest Environment Instantiation (section VII).

    For each clause the template of its verb whose environment is nearest (Δ_env), instantiated by section V-A
    and taken as it is: nothing checks whether it can be executed. Among equally near templates the one whose
    clause is most alike (Δ_nl) is taken, then the first of the corpus.
    """

    def fit(self, examples: Sequence[Example], data: Dataset, random: np.random.Generator) -> Self:
        """Build the library of each world."""
        self.libraries_ = libraries(examples, data)
        return self

    def predict(self, example: Example, data: Dataset, random: np.random.Generator) -> Prediction:
        """Return the nearest template of each clause, one after the other."""
        library = self.libraries_.get(example.world) or Library(data.lexicon)

        def nearest_of(clause: Clause, world: World, state: int) -> Made:
            candidates = (instantiate(t, clause, world, state) for t in library.propose(clause))
            chosen = min(
                (c for c in candidates if c is not None),
                key=lambda c: (environment_distance(c), clause_distance(c.template.clause, clause, akin=0.0)),
                default=None,
            )
            return ((), None) if chosen is None else (chosen.instructions, chosen.template.source)

        return from_state(example, data, nearest_of)


MODELS: Mapping[str, Callable[[], Model]] = {
    "empty": Empty,
    "chance": Chance,
    "templates": PredefinedTemplates,
    "tree": InstructionTree,
    "no_nl": ROWS["no_nl"],
    "nearest": NearestEnvironment,
    **{name: row for name, row in ROWS.items() if name != "no_nl"},
    "ranked": Ranked,
}
"""The rows by name, in the order of the table."""


def make_model(name: str) -> Model:
    """Return a new model.

    Raises:
        TmdError: There is none of that name.
    """
    if name not in MODELS:
        raise TmdError(f"there is no model '{name}'", hint=nearest(name, list(MODELS), what="models"))
    return MODELS[name]()
