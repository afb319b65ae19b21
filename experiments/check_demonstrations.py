"""Play every demonstration of every corpus and say which do not work: ``python experiments/check_demonstrations.py``.

A demonstration works if every instruction is executable in its turn, and the stated end and the goal hold at the end.
Arguments: corpus files (default: every ``problems/*/*/demonstrations.jsonl``).
"""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path

from tmd.diagnostics import TmdError
from tmd.pddl.model import Problem
from tmd.pddl.reading.reader import read_problem
from tmd.world.compile import compile_problem
from tmd.world.corpus import replay
from tmd.world.demonstration import read_demonstrations
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).resolve().parents[1]


@cache
def domain(name: str) -> DomainFolder:
    """The domain of that name."""
    return DomainFolder(ROOT / "domains" / name)


@cache
def opened(directory: Path, name: str) -> Problem:
    """The environment of that name in ``problems/DOMAIN``: the YAML file, or the PDDL problem where there is none."""
    folder, place = domain(directory.name), directory / "environments" / f"{name}.yaml"
    if not place.exists() and place.with_suffix(".pddl").exists():
        return read_problem(place.with_suffix(".pddl"), folder.domain)
    return compile_problem(load_environment(place), folder)


def check(path: Path) -> int:
    """Play one corpus: a line for each demonstration that fails and one for the corpus; return the failures."""
    failures = 0
    demonstrations = read_demonstrations(path)
    for demonstration in demonstrations:
        try:
            replay(demonstration, opened(path.resolve().parent.parent, demonstration.environment))
        except TmdError as error:
            failures += 1
            print(f"{path}: {demonstration.id}: {error}")
    print(f"{path}: {len(demonstrations)} demonstrations, {failures} fail")
    return failures


def main(paths: list[Path]) -> int:
    """Check each corpus; return the exit code: 1 where a demonstration fails or a corpus cannot be read."""
    failures = 0
    for path in paths:
        try:
            failures += check(path)
        except TmdError as error:
            failures += 1
            print(f"error: {error}", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    given = [Path(argument) for argument in sys.argv[1:]]
    here = ROOT if Path.cwd() != ROOT else Path()
    sys.exit(main(given or sorted((here / "problems").glob("*/*/demonstrations.jsonl"))))
