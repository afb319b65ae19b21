"""The same bytes from every interpreter, whatever the hash seed."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import tmd

PROGRAM = """
import sys
from pathlib import Path
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.reading.reader import read_domain, read_problem
from tmd.planning.gap_filler import GapFiller
from tmd.planning.unsolvable import Impossible
here = Path(sys.argv[1])
pantry = ground(read_problem(here / "cases/pantry-problem.pddl", read_domain(here / "cases/pantry.pddl")))
filler = GapFiller(pantry, backend="python")
state = pantry.init
for operator in pantry.operators:
    print(filler.fill(state, (operator.precondition,)))
print(filler.fill(state, pantry.goal))
derived = Impossible(pantry)
derived.reason(state, pantry.goal)
print([str(law) for law in derived.general.laws])
print(filler._search.generated)
"""


@pytest.fixture(scope="module")
def expected() -> str:
    return run("0")


def run(seed: str) -> str:
    root = str(Path(tmd.__file__).resolve().parent.parent)
    path = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH", ""))))
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(Path(__file__).parent)],
        env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout


@pytest.mark.parametrize("seed", ["1", "31337"])
def test_hash_seeds_do_not_matter(seed: str, expected: str) -> None:
    assert expected.count("Filled") > 10
    assert run(seed) == expected
