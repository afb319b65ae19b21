"""What all tests share: what was learned of the bundled domains, so that not every run of ``tmd`` learns it again."""

from __future__ import annotations

import atexit
import gc
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

# the tests run side by side already: linear algebra in many threads would make each of them wait for the others
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# the cache of whoever runs the tests is left alone; the processes of one run share one of their own
if "PYTEST_XDIST_WORKER" not in os.environ:
    os.environ["XDG_CACHE_HOME"] = tempfile.mkdtemp(prefix="tmd-tests-")
    atexit.register(shutil.rmtree, os.environ["XDG_CACHE_HOME"], ignore_errors=True)

# every process would compile all modules again, which takes it seconds; nothing is written beside the sources
if os.environ.pop("PYTHONDONTWRITEBYTECODE", None):
    sys.dont_write_bytecode = False
    os.environ["PYTHONPYCACHEPREFIX"] = str(Path(__file__).resolve().parents[1] / ".pytest_cache" / "d" / "bytecode")
    sys.pycache_prefix = os.environ["PYTHONPYCACHEPREFIX"]

import pytest
from hypothesis import settings

from tmd.cli import ALLOCATIONS
from tmd.files import cache_directory
from tmd.knowledge import digest, known, place, recall, save
from tmd.planning.search import numba_build

ROOT = Path(__file__).resolve().parents[1]

# how long an example takes depends on what else the machine does
# the same examples in every run; HYPOTHESIS_PROFILE=random draws new ones
settings.register_profile("fixed", deadline=None, derandomize=True)
settings.register_profile("random", deadline=None)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "fixed"))


LEARNED = ("living_room", "kitchen")
DIGITS = 16
"""Of a digest, in the name of a directory of the user's cache."""
COMPILING: list[subprocess.Popen[bytes]] = []
"""The process that compiles the searches, which takes it half a minute, while tests are collected."""


def pytest_configure(config: pytest.Config) -> None:
    """Let commands end by signals, and have the searches compiled: a command that did so would say so."""
    gc.set_threshold(ALLOCATIONS)
    # what a shell or nohup had this process ignore, the commands that tests run would ignore as well
    for name, default in (("SIGINT", signal.default_int_handler), ("SIGHUP", signal.SIG_DFL)):
        ignored = getattr(signal, name, None)
        if ignored is not None and signal.getsignal(ignored) is signal.SIG_IGN:
            signal.signal(ignored, default)
    if hasattr(config, "workerinput") or os.environ.get("NUMBA_CACHE_DIR"):
        return
    if not list(
        (ROOT / "tmd" / "planning" / "search" / "__pycache__").glob(f"greedy.search_any_{numba_build.digest()}-*.nbc")
    ):
        COMPILING.append(subprocess.Popen([sys.executable, "-m", "tmd.planning"], cwd=ROOT, stderr=subprocess.DEVNULL))


def pytest_collection_finish() -> None:
    """Leave all modules and tests out of garbage collections, which took a tenth of the time."""
    gc.freeze()
    wait_for_searches()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_node_collection_finished() -> None:
    """Give no test to a process before the searches are compiled."""
    wait_for_searches()


def wait_for_searches() -> None:
    """Wait until the searches are compiled."""
    for process in COMPILING:
        assert process.wait() == 0, "the searches cannot be compiled"


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """One process more than there are processors: many tests wait for a browser, a cluster or a time to be over."""
    return len(os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else range(os.cpu_count() or 1)) + 1


@pytest.fixture(scope="session")
def learned(pytestconfig: pytest.Config, tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> Path:
    """A directory as `tmd learn --out` leaves it, for commands that tests run.

    One process learns each domain; the next run has it from pytest's cache, if nothing that it is made from changed.
    """
    base = tmp_path_factory.getbasetemp()
    root = (base if worker_id == "master" else base.parent) / "learned"
    root.mkdir(exist_ok=True)
    os.environ["TMD_LEARNED"] = str(root)
    cache = getattr(pytestconfig, "cache", None)  # there is none with -p no:cacheprovider
    for name in LEARNED:
        _learn(name, root, cache.mkdir("learned") if cache is not None else root)
    for _ in range(6_000):
        if all((root / f"{name}.done").exists() for name in LEARNED):
            break
        time.sleep(0.1)
    return root


def _learn(name: str, root: Path, kept: Path) -> None:
    """Learn a domain, unless another process does."""
    from tests import bundled  # where nothing is to be learned, a process that only collects need not load all of it

    try:
        (root / f"{name}.begun").touch(exist_ok=False)
    except FileExistsError:
        return
    try:
        corpus = bundled.corpus(name)
        for directory in (kept, root):
            if recall(corpus, place(corpus, directory)) is None:
                save(known(corpus, kept), corpus, place(corpus, directory))
        cache = cache_directory("learned")
        assert cache is not None
        shutil.copytree(place(corpus, root), cache / name / digest(corpus)[:DIGITS], dirs_exist_ok=True)
    finally:
        (root / f"{name}.done").touch()
