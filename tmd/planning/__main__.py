"""``python -m tmd.planning``: compile the searches for this machine now, so that nobody waits for that later."""

from __future__ import annotations

import sys
from importlib.util import find_spec

from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.planning.search.in_process import FirstSearch, OptimalSearch

_DOMAIN = """
(define (domain lamp) (:predicates (lit))
  (:action light :parameters () :precondition (not (lit)) :effect (lit)))
"""
_PROBLEM = "(define (problem dark) (:domain lamp) (:init) (:goal (lit)))"


def main() -> int:
    """Search once with each of the compiled searches."""
    if find_spec("numba") is None:
        print("numba is not installed: searches run in plain Python", file=sys.stderr)
        return 0
    task = ground(parse_problem(_PROBLEM, parse_domain(_DOMAIN)))
    for search in (OptimalSearch, FirstSearch):
        search(task, backend="numba").fill(task.init, task.goal)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
