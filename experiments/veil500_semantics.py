"""A run on VEIL-500 scored under both semantics: ``python experiments/veil500_semantics.py VEIL500 RUN``.

For each row of the run the mean END under the literal rules (what the metric says), under the sane ones (which planning
goes by), how many recorded and how many predicted sequences are executable under each, and IED, which knows no rules.
"""

from __future__ import annotations

import json
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np

from tmd.datasets.veil500 import absent_types, compile_environment, from_veil, load, mentioned
from tmd.datasets.veil500.forms import Semantics
from tmd.evaluation.metrics import Scorer
from tmd.evaluation.runs.config import VEIL500, ExperimentConfig
from tmd.evaluation.runs.dataset import open_dataset

SEMANTICS: tuple[Semantics, ...] = ("literal", "sane")


def main(directory: Path, run: Path) -> None:
    """Print the table."""
    data = load(directory)
    examples = {e.id: e for e in open_dataset(ExperimentConfig("all", run, data=VEIL500, veil500=directory)).pool}
    scorers = {
        (f"{place.world}{number}", kind): Scorer(compile_environment(place, kind), mentioned, absent_types(place))
        for (_, number), place in data.environments.items()
        for kind in SEMANTICS
    }
    rows: dict[str, list[tuple[float, ...]]] = defaultdict(list)
    for line in (run / "predictions.jsonl").read_text().splitlines():
        prediction = json.loads(line)
        example = examples[prediction["id"]]
        predicted = [from_veil(text) for text in prediction["predicted"]]
        values = [prediction["IED"]]
        for kind in SEMANTICS:
            scorer = scorers[example.environment, kind]
            found = scorer.score(predicted, example.gold)
            values += [found.end, found.executable, scorer.score(example.gold, example.gold).executable]
        rows[prediction["model"]].append(tuple(values))
    print(f"{'':20}{'':>6} {'literal':>24} {'sane':>24}")
    print(f"{'row':20}{'IED':>6} " + 2 * f" {'END':>6} {'exec.':>7} {'people':>8}")
    for model, own in rows.items():
        ied, *rest = np.mean(own, axis=0).tolist()
        print(f"{model:20}{ied:6.1f} " + " ".join(f"{e:7.1f} {x:7.1f} {p:8.1f}" for e, x, p in (rest[:3], rest[3:])))


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
