"""What a large library and a crowded room cost: one utterance with 36,000 demonstrations, and among 400 objects.

``python experiments/bench/scale.py [COPIES]``: kitchen 1, with what the other kitchens teach. The library grows by
copies (225, by default, make 36,000 demonstrations) in which demonstration, environment and objects have other names;
the kitchen grows by spoons on its counter. Prints the time of one utterance beside that of the library and the kitchen
as they are, then the time and the memory that learning takes with ten times the demonstrations.
"""

from __future__ import annotations

import json
import statistics
import sys
import time
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import TypeVar

import numpy as np
from inference_growth import ENVIRONMENT, with_spoons

from tmd.ground import ground
from tmd.inference.config import PRESETS
from tmd.inference.policy.learning import learn_policy
from tmd.inference.policy.model import Reward
from tmd.knowledge import library_from_json, library_to_json
from tmd.library.library import Library, learn
from tmd.library.template import Template
from tmd.world.corpus import Corpus
from tmd.world.demonstration import Demonstration
from tmd.world.folder import find_domain, find_roots
from tmd.world.world import World

_T = TypeVar("_T")
TEXTS = ("Fill the pot with water and put it on the stove.", "Make some ramen.", "Put the cup in the sink.")
MODELS = ("goals", "bayes_risk", "paper")
COPIES = 225
TENFOLD = 10
CROWD = 400
REPEATS = 3


def main(copies: int) -> None:
    """Print a line for each measurement."""
    corpus = Corpus(find_domain("kitchen"), find_roots("problems")[0] / "kitchen")
    demonstrations = [d for d in corpus.demonstrations() if d.environment != ENVIRONMENT]
    world = corpus.world(ENVIRONMENT)
    small = learn(demonstrations, corpus.world, corpus.lexicon)
    seconds, reward = timed(lambda: policy(demonstrations, corpus))
    large = copied(small, copies)
    print(f"{len(demonstrations)} demonstrations, {len(small)} templates; {copies} copies: {len(large)} templates")
    crowd = with_spoons(corpus, CROWD - len(world.profiles.objects))
    for model in MODELS:
        base = utterance(world, small, reward, model)
        for name, place, library in (("library", world, large), ("objects", crowd, small)):
            size = len(library) / len(small) if name == "library" else len(crowd.profiles.objects)
            grown = utterance(place, library, reward, model)
            print(
                f"{model:12}{name:10}{size:6.0f}: {base:.3f} s to {grown:.3f} s, {grown / base:.2f} times", flush=True
            )
    for name, library in (("as it is", small), ("copied", large)):
        text = json.dumps(library_to_json(library)).encode()
        took, _ = timed(partial(library_from_json, text, corpus.lexicon))
        print(f"library {name}: {len(text) / 1e6:.1f} MB of JSON, read in {took:.2f} s")
    learning(demonstrations, corpus, seconds)


def policy(demonstrations: Sequence[Demonstration], corpus: Corpus) -> Reward:
    """The policy that they teach."""
    return learn_policy(demonstrations, corpus.world, np.random.default_rng(0))


def learning(demonstrations: Sequence[Demonstration], corpus: Corpus, seconds: float) -> None:
    """Time and memory of learning from ten times as many."""
    more = [replace(d, id=f"{d.id}_{copy}") for copy in range(TENFOLD) for d in demonstrations]
    took = {len(d): timed(partial(learn, d, corpus.world, corpus.lexicon))[0] for d in (demonstrations, more)}
    print("library: " + ", ".join(f"{count} demonstrations {value:.1f} s" for count, value in took.items()))
    many, _ = timed(lambda: policy(more, corpus))
    print(f"policy: {len(demonstrations)} demonstrations {seconds:.1f} s, {len(more)} {many:.1f} s")
    for some in (demonstrations, more):
        tracemalloc.start()
        policy(some, corpus)
        print(f"policy: {len(some)} demonstrations, {tracemalloc.get_traced_memory()[1] / 2**20:.0f} MiB at most")
        tracemalloc.stop()


def utterance(world: World, library: Library, reward: Reward, model: str) -> float:
    """The median over the texts of the seconds that one takes, everything compiled and read before."""
    taken = []
    for text in TEXTS:
        act = partial(ground, text, world, library, reward=reward, config=PRESETS[model])
        taken.append(min(timed(act)[0] for _ in range(REPEATS)))
    return statistics.median(taken)


def copied(library: Library, copies: int) -> Library:
    """The library with ``copies - 1`` renamed copies of each template beside it."""
    found = Library(library.lexicon)
    for copy in range(copies):
        for verb in library.verbs():
            for template in library.templates(verb):
                found.add(_renamed(template, f"_{copy}") if copy else template)
    return found


def _renamed(template: Template, ending: str) -> Template:
    return replace(
        template,
        source=template.source + ending,
        environment=template.environment + ending,
        grounding={variable: name + ending for variable, name in template.grounding.items()},
    )


def timed(act: Callable[[], _T]) -> tuple[float, _T]:
    """The seconds that it takes, and what it returns."""
    start = time.perf_counter()
    found = act()
    return time.perf_counter() - start, found


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else COPIES)
