"""Compiling the searches: told of where somebody waits for it, and done by ``python -m tmd.planning``."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PROBE = """
import numba
from tmd.planning.search import numba_build as compiled
compiled._announce_compiling()
def other(x): return x + 1
def first(x): return x + 2
def second(x): return x + 3
first.__module__ = second.__module__ = "tmd.planning.probe"
print(numba.njit(other)(1), file=__import__("sys").stderr)
print(numba.njit(first)(1), numba.njit(second)(1))
"""


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, *arguments], cwd=ROOT, capture_output=True, text=True, check=True, timeout=120
    )


def test_compiling_is_told_of_once_and_only_if_it_is_ours() -> None:
    pytest.importorskip("numba", reason="numba is not installed")
    done = run("-c", PROBE)
    assert done.stdout == "3 4\n"
    other, line = done.stderr.splitlines()
    assert other == "2"
    assert line.startswith("compiling the search for this machine")


def test_what_is_compiled_is_not_compiled_again() -> None:
    pytest.importorskip("numba", reason="numba is not installed")
    assert run("-m", "tmd.planning").stdout == ""
    assert run("-m", "tmd.planning").stderr == ""


THREADS = """
from threading import Thread
from time import sleep
from tmd.planning.search.numba_build import compiled
def ask(delay):
    sleep(delay)
    compiled()
    print("compiled")
threads = [Thread(target=ask, args=(i / 100,)) for i in range(60)]
for each in threads: each.start()
for each in threads: each.join()
"""


def test_threads_may_ask_at_the_same_time() -> None:
    pytest.importorskip("numba", reason="numba is not installed")
    assert run("-c", THREADS).stdout.count("compiled") == 60
