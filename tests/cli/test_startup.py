"""Start-up stays quick: the commands import nothing heavy before they need it."""

from __future__ import annotations

import subprocess
import sys

from tmd.cli.program import COMMANDS

HEAVY = {
    "dask", "distributed", "hypothesis", "jinja2", "joblib", "lark", "llvmlite", "matplotlib", "numba", "numpy", "pddl",
    "pydantic", "rich", "scipy", "unified_planning", "yaml",
}  # fmt: skip
PROBE = """
import io, sys
from contextlib import redirect_stdout
from tmd.cli.program import run
for command in sys.argv[1:]:
    with redirect_stdout(io.StringIO()) as said:
        code = run(command.split())
    print(int(code), bool(said.getvalue()), *sorted({name.partition(".")[0] for name in sys.modules}))
"""


def test_help_imports_nothing_heavy() -> None:
    """In one process, which would still have what an earlier command imported."""
    commands = ["", "--help", "--version", *(f"{name} --help" for name in COMMANDS)]
    done = subprocess.run([sys.executable, "-c", PROBE, *commands], capture_output=True, text=True, check=True)
    for command, line in zip(commands, done.stdout.splitlines(), strict=True):
        code, said, *modules = line.split()
        assert (code, said) == ("0", "True"), command
        assert "click" in modules
        assert not HEAVY & set(modules), command


def test_help_loads_no_pddl() -> None:
    code = "import sys; from tmd.cli.program import run; run(['--help']); print(*sys.modules, file=sys.stderr)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(done.stderr.split())
    assert "tmd.world.roots" in loaded
    assert not loaded & {"tmd.pddl.model", "tmd.pddl.reading.reader", "tmd.pddl.task"}
