"""What all tests share: what was learned of the bundled domains, so that not every run of ``tmd`` learns it anew."""

from __future__ import annotations

import os
import time
from pathlib import Path

# the tests run side by side already: linear algebra in many threads would make each of them wait for the others
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest
from hypothesis import settings

from tmd.learned.knowledge import study
from tmd.learned.store import place, save
from tmd.veil.corpus import Corpus
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).resolve().parents[1]

# how long an example takes depends on what else the machine does
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")


LEARNED = ("living_room", "kitchen")


@pytest.fixture(scope="session")
def learned(tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> Path:
    """A directory as `tmd learn --out` leaves it, for commands that tests run; one process learns each domain."""
    base = tmp_path_factory.getbasetemp()
    root = (base if worker_id == "master" else base.parent) / "learned"
    root.mkdir(exist_ok=True)
    os.environ["TMD_LEARNED"] = str(root)
    for name in LEARNED:
        _learn(name, root)
    for _ in range(2_000):
        if all((root / f"{name}.done").exists() for name in LEARNED):
            break
        time.sleep(0.1)
    return root


def _learn(name: str, root: Path) -> None:
    """Learn a domain, unless another process does."""
    try:
        (root / f"{name}.begun").touch(exist_ok=False)
    except FileExistsError:
        return
    try:
        corpus = Corpus(DomainFolder(ROOT / "domains" / name), ROOT / "problems" / name)
        save(study(corpus), corpus, place(corpus, root))
    finally:
        (root / f"{name}.done").touch()
