"""Start-up stays quick: the commands import nothing heavy before they need it."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tmd.cli.program import COMMANDS

HEAVY = {
    "dask", "distributed", "hypothesis", "jinja2", "joblib", "lark", "llvmlite", "matplotlib", "numba", "numpy", "pddl",
    "pydantic", "rich", "scipy", "unified_planning", "yaml",
}  # fmt: skip
PROBE = """
import sys
from tmd.cli.program import run
code = run(sys.argv[1:])
print(int(code), *sorted({name.partition(".")[0] for name in sys.modules}), file=sys.stderr)
"""


@pytest.mark.parametrize("arguments", [[], ["--help"], ["--version"], *([c, "--help"] for c in COMMANDS)])
def test_help_imports_nothing_heavy(arguments: list[str]) -> None:
    done = subprocess.run([sys.executable, "-c", PROBE, *arguments], capture_output=True, text=True, check=True)
    code, *modules = done.stderr.split()
    assert code == "0"
    assert "click" in modules
    assert not HEAVY & set(modules)
    assert done.stdout


def test_help_loads_no_pddl() -> None:
    code = "import sys; from tmd.cli.program import run; run(['--help']); print(*sys.modules, file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(done.stderr.split())
    assert "tmd.world.roots" in loaded
    assert not loaded & {"tmd.pddl.model", "tmd.pddl.reading.reader", "tmd.pddl.task"}
