"""Play every demonstration of a corpus and say which do not work: ``python experiments/check_demonstrations.py``.

Arguments: corpus files (default: every ``problems/*/*/demonstrations.jsonl``).
"""

from __future__ import annotations

import sys
from pathlib import Path

from tmd.errors import TmdError
from tmd.veil.demonstration import read_demonstrations
from tmd.veil.replay import replay
from tmd.world.compile import compile_problem
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder


def main(paths: list[Path]) -> int:
    """Print one line for each demonstration that fails; return the number of failures."""
    failures = total = 0
    for path in paths:
        folder = DomainFolder(Path("domains") / path.parent.parent.name)
        for demonstration in read_demonstrations(path):
            total += 1
            place = path.parent.parent / "environments" / f"{demonstration.environment}.yaml"
            try:
                replay(demonstration, compile_problem(load_environment(place), folder))
            except TmdError as error:
                failures += 1
                print(f"{path}: {demonstration.id}: {error}")
    print(f"{total} demonstrations, {failures} fail")
    return failures


if __name__ == "__main__":
    given = [Path(argument) for argument in sys.argv[1:]]
    sys.exit(1 if main(given or sorted(Path("problems").glob("*/*/demonstrations.jsonl"))) else 0)
