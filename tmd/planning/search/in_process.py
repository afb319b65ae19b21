"""Search over the bit sets of one task, optimal or content with any plan: the in-process planner, without any cache.

The kernel runs compiled where numba is installed and as plain Python elsewhere; the answers are the same.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from importlib.util import find_spec
from typing import Literal

from tmd.diagnostics import MissingToolError, TmdError, install_extra
from tmd.pddl.task import Bits, Cube, Task
from tmd.planning.result import Answer, Filled, GaveUp, Unreachable, filled
from tmd.planning.search import greedy, kernel
from tmd.planning.search.flat_task import Ints, Tables, build, flat, literals, rows, words_of
from tmd.planning.search.heuristics import Goal, prepared
from tmd.planning.search.numba_build import Functions, PrepareFunction, SearchFunction, array, arrays, compiled, loaded
from tmd.planning.unsolvable import unreachable_reason

Backend = Literal["auto", "numba", "python"]
"""Which form of the kernel runs. ``auto`` begins in plain Python, unless another search loaded numba before, and goes
over to numba, where that is installed, once there is more to do than loading it is worth. The answers are the same."""

DEFAULT_CAP = 30_000
"""Generated states after which a search gives up."""

PATIENCE = 100
"""Generated states after which ``auto`` goes over to numba. Loading it takes a second."""

QUESTION = 5
"""Cost of a question, in generated states."""

GOALS_KEPT = 256
"""Goals whose relaxations a search keeps."""

TASKS_KEPT = 8
"""Tasks whose flat forms are kept, in lists and in arrays."""


class OptimalSearch:
    """Finds the canonical cheapest plan: of the cheapest plans, the first in the order of the operators.

    It gives up after ``cap`` generated states. ``generated`` is the number of states that the last call generated.

    Raises:
        MissingToolError: ``backend`` is ``"numba"`` and numba is not installed.
        TmdError: There is no such back-end, or the cap is not positive.
    """

    patience = PATIENCE
    entry = "search"

    def __init__(self, task: Task, *, backend: Backend = "auto", cap: int = DEFAULT_CAP) -> None:
        if cap < 1:
            raise TmdError(f"the cap on generated states must be at least 1, found {cap}")
        self.task = task
        self.cap = cap
        self.backend = chosen(backend)
        self.generated = 0
        self._patience = self.patience if backend == "auto" and self.backend == "numba" and not loaded() else 0
        self._kernel = self._made("python" if self._patience else self.backend)

    def fill(self, state: Bits, goal: Sequence[Cube], cap: int | None = None) -> Answer:
        """Return the missing instructions from ``state`` to any cube of ``goal``; ``cap`` replaces the usual one."""
        self.generated = 0
        limit = self.cap if cap is None else cap
        cubes = tuple(cube for cube in goal if not cube.positive & cube.negative)
        if any(cube.holds(state) for cube in cubes):
            return Filled((), state, 0)
        status, _, self.generated, steps = self._run(state, cubes, limit)
        if status == kernel.CAPPED:
            return GaveUp(f"{limit} generated states")
        if status == kernel.DEAD_END:
            return Unreachable(unreachable_reason(self.task, state, goal))
        return filled(state, [self.task.operators[step] for step in steps])

    def bound(self, state: Bits, goal: Sequence[Cube]) -> int:
        """Return a lower bound of what it costs to get from ``state`` to ``goal``."""
        return 0 if any(cube.holds(state) for cube in goal) else self._run(state, tuple(goal), 0)[1]

    def _run(self, state: Bits, cubes: tuple[Cube, ...], cap: int) -> tuple[int, int, int, tuple[int, ...]]:
        """Ask the kernel, and change to the compiled one when it is time, or another search has loaded that."""
        if self._patience > 0 and loaded():
            self._patience = 0
            self._kernel = self._made(self.backend)
        if self._patience > 0:
            small = min(cap, self._patience)
            result = self._kernel.run(state, cubes, small)
            self._patience -= result[2] + QUESTION
            if self._patience <= 0:
                self._kernel = self._made(self.backend)
            if result[0] != kernel.CAPPED or small == cap:
                return result
        return self._kernel.run(state, cubes, cap)

    def _made(self, backend: str) -> _Kernel:
        """Return the kernel in one of its forms."""
        tables = _tables(self.task, backend)
        if backend == "python":
            functions = Functions(prepared, kernel.search, greedy.search_any)
            return _Kernel(tables, functions.prepared, getattr(functions, self.entry), list)
        functions = compiled()
        return _Kernel(tables, functions.prepared, getattr(functions, self.entry), array)


class FirstSearch(OptimalSearch):
    """Finds any plan, greedily: for what is too much for :class:`OptimalSearch`. Its answers repeat as well.

    It goes on for better plans, and in plain Python that takes longer than loading numba: ``auto`` does so at once.
    """

    patience = 0
    entry = "search_any"


def chosen(backend: str) -> Literal["numba", "python"]:
    """Return the back-end that ``backend`` means on this machine."""
    present = find_spec("numba") is not None
    if backend == "python" or (backend == "auto" and not present):
        return "python"
    if backend not in ("auto", "numba"):
        raise TmdError(f"there is no search back-end '{backend}'", hint="one of auto, numba, python")
    if not present:
        raise MissingToolError(
            "the compiled search needs numba", hint=f"{install_extra('fast')}, or take the python back-end"
        )
    return "numba"


@lru_cache(TASKS_KEPT)
def _tables(task: Task, backend: str) -> Tables:
    """Return a task in flat form; several searches of one request share it."""
    return build(task) if backend == "python" else arrays(_tables(task, "python"))


class _Kernel:
    """Calls the kernel with a question in flat form, and keeps what it works out about goals."""

    def __init__(
        self, tables: Tables, prepare: PrepareFunction, search: SearchFunction, pack: Callable[[Ints], Ints]
    ) -> None:
        self.tables = tables
        self._prepare = prepare
        self._search = search
        self._pack = pack
        self._goal = lru_cache(GOALS_KEPT)(self._prepared)

    def run(self, state: Bits, cubes: tuple[Cube, ...], cap: int) -> tuple[int, int, int, tuple[int, ...]]:
        """Return the status, the cost or its lower bound, the number of generated states and the plan."""
        start = self._pack(words_of(state, self.tables.words))
        status, cost, generated, plan = self._search(self.tables, self._goal(cubes), start, cap)
        return int(status), int(cost), int(generated), tuple(int(step) for step in plan)

    def _prepared(self, cubes: tuple[Cube, ...]) -> Goal:
        fact_start, fact = rows(literals(cube) for cube in cubes)
        positive = flat((cube.positive for cube in cubes), self.tables.words)
        negative = flat((cube.negative for cube in cubes), self.tables.words)
        return self._prepare(self.tables, *map(self._pack, (positive, negative, fact_start, fact)))
