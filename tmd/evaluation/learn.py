"""Learn a domain and save what was learned, as ``tmd learn`` does."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from tmd.diagnostics import TmdError
from tmd.evaluation.models.paper_models import weights_of
from tmd.inference.weight_learning import Learned
from tmd.knowledge import Knowledge, Progress, digest, place, save, study
from tmd.world.corpus import Corpus, final_state
from tmd.world.demonstration import check_goal


@dataclass(frozen=True, slots=True)
class LearnedDomain:
    """A learned domain, and where it was saved. ``tuned`` is ``None`` where no weights were learned."""

    knowledge: Knowledge
    tuned: Learned | None
    directory: Path


def learn_domain(corpus: Corpus, root: Path | None = None, *, weights: bool = True, seed: int = 0) -> LearnedDomain:
    """Learn from the demonstrations of a domain, and save it.

    It is saved in the directory of its name below ``root``, or beside the demonstrations. Weights of the factors, which
    take by far the longest, are learned if ``weights`` says so, with the random ``seed``.

    Raises:
        TmdError: There are no demonstrations, one is wrong, or it cannot be saved.
    """
    directory, made_from = place(corpus, root), digest(corpus)
    demonstrations = corpus.demonstrations()
    if not demonstrations:
        raise TmdError(
            f"there are no demonstrations of '{corpus.folder.name}' in {corpus.directory}",
            hint="they are in TASK/demonstrations.jsonl",
        )
    for demonstration in demonstrations:  # one that misses its own goal would teach something wrong
        if demonstration.goal is not None:
            world = corpus.world(demonstration.environment)
            check_goal(demonstration, world.task.problem, final_state(demonstration, world))
    with Progress(f"learning from {len(demonstrations)} demonstrations") as progress:
        knowledge = study(corpus, progress.tell)
    tuned = None
    if weights:
        tuned = weights_of(corpus, np.random.default_rng(seed))
        knowledge = replace(knowledge, weights=tuned.weights)
    save(knowledge, corpus, directory, made_from)
    return LearnedDomain(knowledge, tuned, directory)
