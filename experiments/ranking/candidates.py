"""Collect the candidates of the row ``ranked`` for VEIL-500, with how near each is to what the person did.

``python experiments/ranking/candidates.py VEIL500 OUT [--jobs N]``: the four folds over environments 1-8, both worlds.
Writes ``OUT/FOLD.json``, which ``experiments/ranking/rank.py`` reads; what is there already is not made again.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
from joblib import Parallel, delayed

from tmd.evaluation.models.ranked import Ranked
from tmd.evaluation.runs.config import VEIL500, ExperimentConfig
from tmd.evaluation.runs.dataset import open_dataset
from tmd.evaluation.runs.folds import Fold, folds_of


def collect(config: ExperimentConfig, fold: Fold, out: Path) -> None:
    """Write the file of one fold."""
    path = out / f"{fold.name}.json"
    if path.exists():
        return
    data = open_dataset(config)
    row = Ranked().fit(fold.train, data, np.random.default_rng(0))
    found = []
    for example in fold.test:
        candidates = row.candidates(example, data)
        scorer = data.scorer(example.environment)
        scores = [scorer.score(plan, example.gold) for plan in candidates.plans]
        known = {"id": example.id, "world": example.world, "environment": example.environment, "fold": fold.name}
        found.append(
            known
            | {
                "text": example.demonstration.text,
                "proposed": dict(candidates.proposed),
                "features": candidates.features.round(9).tolist(),
                "IED": [score.ied for score in scores],
                "END": [score.end for score in scores],
                "executable": [score.executable for score in scores],
            }
        )
    unfinished = path.with_suffix(".part")
    unfinished.write_text(json.dumps(found))
    unfinished.replace(path)
    print(fold.name, len(found), flush=True)


def main() -> None:
    """Collect all folds."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("veil500", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--jobs", type=int, default=1)
    asked = parser.parse_args()
    asked.out.mkdir(parents=True, exist_ok=True)
    config = ExperimentConfig("all", asked.out, data=VEIL500, veil500=asked.veil500)
    folds = folds_of(config, open_dataset(config))
    Parallel(n_jobs=asked.jobs)(delayed(collect)(config, fold, asked.out) for fold in folds)


if __name__ == "__main__":
    main()
