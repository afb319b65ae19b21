"""Grounding a text of six clauses: seconds once everything is loaded, and where they go as the beam grows.

``python experiments/bench/ground_text.py``: in each bundled kitchen, trained on the others.
"""

from __future__ import annotations

import statistics
import time
from dataclasses import replace

from tmd.energy.config import DEFAULT, PRESETS
from tmd.ground import ground
from tmd.veil.corpus import Corpus
from tmd.veil.library import learn
from tmd.world.folder import find_domain, find_root

TEXT = (
    "Fill the pot with water. Put the pot on the stove. Turn on the burner. Wait until the water boils. "
    "Add the ramen to the pot. Wait for three minutes."
)
BEAMS = (1, 3, 5, 10)
REPEATS = 3


def main() -> None:
    """Print one line for each kitchen, one column for each beam."""
    corpus = Corpus(find_domain("kitchen"), find_root("problems") / "kitchen")
    print(f"{'environment':12} {'templates':>9} " + " ".join(f"beam {b:>3}" for b in BEAMS) + "  (median s, cold memo)")
    for environment in corpus.environments():
        demonstrations = [d for d in corpus.demonstrations() if d.environment != environment]
        library = learn(demonstrations, corpus.world, corpus.lexicon)
        world = corpus.world(environment)
        ground(TEXT, world, library)
        cells = []
        for beam in BEAMS:
            times = []
            for _ in range(REPEATS):
                start = time.perf_counter()
                grounded = ground(TEXT, world, library, config=replace(PRESETS[DEFAULT], beam=beam))
                times.append(time.perf_counter() - start)
                assert len(grounded.parsed.clauses) == 6
            cells.append(f"{statistics.median(times):8.2f}")
        print(f"{environment:12} {len(library):9} " + " ".join(cells))


if __name__ == "__main__":
    main()
