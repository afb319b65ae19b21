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


@pytest.fixture(scope="session")
def learned(tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> Path:
    """A directory as `tmd learn --out` leaves it, for commands that tests run; one process learns, the others wait."""
    base = tmp_path_factory.getbasetemp()
    root = (base if worker_id == "master" else base.parent) / "learned"
    os.environ["TMD_LEARNED"] = str(root)
    done = root / "done"
    try:
        root.mkdir()
    except FileExistsError:
        for _ in range(2_000):
            if done.exists():
                break
            time.sleep(0.1)
        return root
    try:
        for name in ("kitchen", "living_room"):
            corpus = Corpus(DomainFolder(ROOT / "domains" / name), ROOT / "problems" / name)
            save(study(corpus), corpus, place(corpus, root))
    finally:
        done.touch()
    return root
