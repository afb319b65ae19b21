"""The robot: simulated seconds for each second of wall-clock time, and how long a whole plan takes.

``python experiments/bench/robot_speed.py [DEMONSTRATION]``: the beginning of a gold demonstration under physics,
without pictures, and filmed by TinyRenderer and by EGL where that starts; then the first ramen demonstration of each
kitchen in kinematic mode, from start to end.
"""

from __future__ import annotations

import importlib.util
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from tmd.diagnostics import TmdError
from tmd.robot.monitor.listeners import Listener, Order
from tmd.robot.session import SimulationSession
from tmd.robot.sim.simulator import STEPS_PER_SECOND, egl_starts
from tmd.robot.video.film import Film, open_movie
from tmd.world.corpus import Corpus
from tmd.world.demonstration import Demonstration
from tmd.world.environment import load_environment
from tmd.world.folder import find_domain, find_roots

DOMAIN, TASK = "kitchen", "ramen"
FIRST = "ramen-kitchen4-01"
BEGINNING = 6
"""So many instructions are executed under physics."""


def main(arguments: Sequence[str]) -> None:
    """Print what is measured."""
    corpus = Corpus(find_domain(DOMAIN), find_roots("problems")[0] / DOMAIN)
    known = {demonstration.id: demonstration for demonstration in corpus.demonstrations()}
    wanted = arguments[0] if arguments else FIRST
    if wanted not in known:
        raise SystemExit(f"there is no demonstration '{wanted}' in {corpus.directory}")
    film_is_possible = importlib.util.find_spec("imageio") is not None
    ways = ["no pictures", *["film, TinyRenderer"] * film_is_possible]
    ways += ["film, EGL"] * (film_is_possible and egl_starts())
    print(f"{wanted}, its first {BEGINNING} instructions under physics")
    for way in ways:
        physics(corpus, known[wanted], way)
    print(f"\n{'kinematic':24} {'setup s':>8} {'plan s':>8} {'all s':>8} {'CPU s':>8}  instructions")
    for environment in corpus.environments():
        first = next((d for d in corpus.demonstrations(TASK) if d.environment == environment), None)
        if first is not None:
            kinematic(corpus, first)


def physics(corpus: Corpus, demonstration: Demonstration, way: str) -> None:
    """Simulated against wall-clock seconds."""
    with ExitStack() as stack:
        stage = stack.enter_context(make(corpus, demonstration.environment, kinematic=False, pictures="EGL" in way))
        listeners: list[Listener] = []
        if "film" in way:
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
            movie = stack.enter_context(open_movie(folder / "film.mp4"))
            listeners.append(Film(stage.cell, stage.skills, movie=movie))
        orders = [Order(instruction) for instruction in demonstration.instructions[:BEGINNING]]
        steps, begin = stage.sim.steps, time.perf_counter()
        execution = stage.execute(orders, listeners)
        spent = time.perf_counter() - begin
        simulated = (stage.sim.steps - steps) / STEPS_PER_SECOND
        print(
            f"{way:24} {simulated:6.1f} s simulated in {spent:6.1f} s: {simulated / spent:.2f} a second"
            f" ({execution.status})",
            flush=True,
        )


def kinematic(corpus: Corpus, demonstration: Demonstration) -> None:
    """Seconds of a whole plan."""
    begin, worked = time.perf_counter(), time.process_time()
    with make(corpus, demonstration.environment, kinematic=True, pictures=False) as stage:
        ready = time.perf_counter()
        execution = stage.execute([Order(instruction) for instruction in demonstration.instructions])
        end, worked = time.perf_counter(), time.process_time() - worked
    print(
        f"{demonstration.id:24} {ready - begin:8.1f} {end - ready:8.1f} {end - begin:8.1f} {worked:8.1f}"
        f"  {len(execution.steps)}, {execution.status}",
        flush=True,
    )


def make(corpus: Corpus, environment: str, *, kinematic: bool, pictures: bool) -> SimulationSession:
    """A simulation of an environment."""
    source = load_environment(corpus.directory / "environments" / f"{environment}.yaml")
    problem = corpus.world(environment).task.problem
    return SimulationSession(source, corpus.folder, problem, kinematic=kinematic, pictures=pictures)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except TmdError as error:
        raise SystemExit(str(error)) from None
