"""How long one person waits for the studio's modules: ``python -m experiments.studio.speed``.

Everything is done on a copy of the bundled kitchens. The best and the worst of each is printed.
"""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from tmd.pddl.plan_file import parse_instruction
from tmd.studio.demonstrations.demo_store import Archive
from tmd.studio.demonstrations.drafts import Draft, Drafts
from tmd.studio.demonstrations.session import Session
from tmd.studio.environment_view import Setting
from tmd.studio.teaching import Teacher
from tmd.world.corpus import Corpus
from tmd.world.demonstration import Demonstration
from tmd.world.folder import find_domain, find_problems

TEXT = "Chill the mug."
PLAN = (
    "find(mug1); moveto(mug1); grasp(mug1); moveto(fridge1); open(fridge1_door); keep(mug1, fridge1, in); "
    "close(fridge1_door)"
)
REPEATS = 10


def timed(name: str, work: Callable[[], object], repeats: int = REPEATS) -> None:
    """Print how long ``work`` takes."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append((time.perf_counter() - start) * 1e3)
    print(f"{name:55} {min(times):9.1f} to {max(times):9.1f} ms")


def main() -> None:
    """Print a line for each action."""
    with tempfile.TemporaryDirectory() as directory:
        _measure(Path(directory))


def _measure(directory: Path) -> None:
    ignored = shutil.ignore_patterns("learned")
    shutil.copytree(find_problems("kitchen"), directory / "kitchen", ignore=ignored)
    corpus = Corpus(find_domain("kitchen"), directory / "kitchen")
    start = time.perf_counter()
    teacher = Teacher(corpus)
    print(f"learning everything at first: {time.perf_counter() - start:.1f} s")
    world = corpus.world("kitchen5")
    setting = Setting(world, corpus.file("kitchen5"))
    names = world.profiles.objects
    timed(f"offers for all {len(names)} objects", lambda: [setting.offers(n) for n in names])
    session = Session(corpus.world("kitchen1"), TEXT, corpus.lexicon, habits=teacher.habits)
    lines = [parse_instruction(line.strip()) for line in PLAN.split(";")]

    def act() -> None:
        session.goto(0)
        for line in lines:
            session.do(line)

    timed(f"{len(lines)} instructions", act)
    drafts = Drafts(directory / "drafts")
    visitor = drafts.enter()
    timed("writing the draft", lambda: drafts.keep(visitor, Draft.of(session, "shown")))
    archive = Archive(corpus)
    saved: list[Demonstration] = []
    timed("saving", lambda: saved.append(archive.save(session)))
    timed("taking what was saved into the library", lambda: teacher.learn_one(saved[-1]), 1)
    saved.append(archive.save(session))
    timed("and once more", lambda: teacher.learn_one(saved[-1]), 1)
    timed("grounding the same text in another kitchen", lambda: teacher.ground(TEXT, corpus.world("kitchen2")))
    start = time.perf_counter()
    teacher.retrain()
    teacher.wait()
    print(f"learning everything again, in a process of its own: {time.perf_counter() - start:.1f} s")


if __name__ == "__main__":
    main()
