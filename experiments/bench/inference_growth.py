"""How the cost of grounding one utterance grows: with clauses, library, objects and beam. And the peak memory.

``python experiments/bench/inference_growth.py``: kitchen 1, trained on the other kitchens; one thing is changed at a
time from six clauses, all templates, the kitchen's own objects and a beam of 3. The last column of each row is the
time divided by that of the row's first entry, over the same ratio of sizes: 1 is linear growth, less is better.
"""

from __future__ import annotations

import resource
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

from tmd.ground import ground
from tmd.inference.config import DEFAULT, PRESETS
from tmd.library.library import Library, learn
from tmd.pddl.model import GroundAtom, TypedName
from tmd.world.corpus import Corpus
from tmd.world.folder import find_domain, find_roots
from tmd.world.world import World, make_world

SENTENCES = (
    "Fill the pot with water.",
    "Put the pot on the stove.",
    "Turn on the burner.",
    "Wait until the water boils.",
    "Add the ramen to the pot.",
    "Wait for three minutes.",
)
ENVIRONMENT = "kitchen1"
BEAM = 3
REPEATS = 3


def main() -> None:
    """Print a row for each thing that grows."""
    corpus = Corpus(find_domain("kitchen"), find_roots("problems")[0] / "kitchen")
    demonstrations = [d for d in corpus.demonstrations() if d.environment != ENVIRONMENT]
    world = corpus.world(ENVIRONMENT)
    text = " ".join(SENTENCES)

    def library(share: float) -> Library:
        step = round(1 / share)
        return learn(demonstrations[::step], corpus.world, corpus.lexicon)

    def act(said: str, place: World, taught: Library, beam: int = BEAM) -> object:
        return ground(said, place, taught, config=replace(PRESETS[DEFAULT], beam=beam))

    whole = library(1)
    row("clauses", (1, 2, 3, 6, 12, 24), lambda n: act(" ".join((SENTENCES * 4)[:n]), world, whole))
    libraries = {len(made): made for made in (library(share) for share in (0.125, 0.25, 0.5, 1))}
    row("templates", tuple(libraries), lambda n: act(text, world, libraries[n]))
    crowded = {len(made.profiles.objects): made for made in (with_spoons(corpus, n) for n in (0, 10, 20, 40))}
    row("objects", tuple(crowded), lambda n: act(text, crowded[n], whole))
    row("beam", (1, 2, 4, 8, 16), lambda n: act(text, world, whole, n))
    print(f"peak memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB")


def row(what: str, sizes: Sequence[int], act: Callable[[int], object]) -> None:
    """Time ``act`` for each size, with a cold memo, everything compiled."""
    act(sizes[0])
    times = []
    for size in sizes:
        taken = []
        for _ in range(REPEATS):
            start = time.perf_counter()
            act(size)
            taken.append(time.perf_counter() - start)
        times.append(statistics.median(taken))
    growth = (times[-1] / times[0]) / (sizes[-1] / sizes[0])
    cells = "  ".join(f"{size}: {seconds:.2f} s" for size, seconds in zip(sizes, times, strict=True))
    print(f"{what:10} {cells}  growth {growth:.2f}")


def with_spoons(corpus: Corpus, count: int) -> World:
    """The kitchen with more spoons on its counter."""
    problem = corpus.world(ENVIRONMENT).task.problem
    like = next(o for o in problem.objects if o.name == "spoon1")
    facts = [atom for atom in sorted(problem.init) if "spoon1" in atom.args]
    names = [f"spoon{number}" for number in range(101, 101 + count)]
    more = {
        GroundAtom(atom.predicate, tuple(name if a == "spoon1" else a for a in atom.args))
        for name in names
        for atom in facts
    }
    objects = (*problem.objects, *(TypedName(name, like.types) for name in names))
    crowded = replace(problem, objects=objects, init=problem.init | more)
    return make_world(f"{ENVIRONMENT}+{count}", crowded, corpus.lexicon)


if __name__ == "__main__":
    main()
