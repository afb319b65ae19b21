"""Fast Downward as a process that waits for its problem.

It is started before there is a text for it and gets that through pipes: this hides the start of its interpreter behind
the reading of the problem. So nothing is imported here that is not needed to start it. The translator becomes the
search when it has translated, in the same process, without the driver that Fast Downward has for that.
"""

from __future__ import annotations

import os
import sys
from contextlib import AbstractContextManager, nullcontext
from importlib.util import find_spec
from pathlib import Path
from typing import IO, TYPE_CHECKING

from tmd.diagnostics import MissingToolError
from tmd.planning.processes import Deadline, PlannerProcess, feed, unnamed_file

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import TracebackType

NAME = "Fast Downward"

FIRST = (
    "let(hlm,eval_modify_costs(landmark_sum(lm_factory=lm_reasonable_orders_hps(lm_rhw()),pref=false),cost_type=one),"
    "let(hff,eval_modify_costs(ff(),cost_type=one),"
    "lazy_greedy([hff,hlm],preferred=[hff,hlm],cost_type=one,reopen_closed=false)))"
)
"""The first iteration of LAMA, which Fast Downward calls ``lama-first``."""

OPTIMAL = "astar(lmcut())"
"""The best admissible heuristic that needs no preparation; it takes neither conditional effects nor axioms."""

_TRANSLATE_AND_SEARCH = """
import gc, os, runpy, sys
gc.set_threshold(100_000)  # its many small objects make Python look for cycles: a quarter of the time of a large task
sas, *search = sys.argv[3:]
sys.argv[3:] = ["--sas-file", f"/dev/fd/{sas}"]
runpy.run_module("fast_downward.translate", run_name="__main__", alter_sys=True)
print(flush=True)
if search:
    os.lseek(int(sas), 0, os.SEEK_SET)
    os.dup2(int(sas), 0)
    os.execv(search[0], search)
"""


def binaries() -> Path:
    """The directory with Fast Downward's translator and search.

    Raises:
        MissingToolError: It is not installed.
    """
    spec = find_spec("up_fast_downward")
    if spec is None or spec.origin is None:
        raise MissingToolError("Fast Downward is not installed", hint="pip install up-fast-downward")
    return Path(spec.origin).parent / "downward" / "builds" / "release" / "bin"


def search_command(configuration: str, plan: IO[bytes]) -> list[str]:
    """The search, reading a translated problem from standard input and writing its plan into ``plan``."""
    program = str(binaries() / "downward")
    return [program, "--search", configuration, "--internal-plan-file", f"/dev/fd/{plan.fileno()}"]


class DownwardProcess:
    """Translator and search, started and waiting for a problem; a ``with`` block ends them.

    Args:
        search: The configuration of the search; without one the problem is translated only.
        memory: Bytes that it may take.
        processor: Seconds of the processor after which it is stopped.

    Attributes:
        process: The process.
        sas: The translated problem, when the translator has ended.
        plan: The plan, when the search has ended with 0.

    Raises:
        MissingToolError: Fast Downward is not installed.
        PlannerError: It cannot be started.
    """

    def __init__(self, search: str | None, memory: int | None = None, processor: int | None = None) -> None:
        programs = binaries()
        self.sas = unnamed_file()  # both are closed when the block is left
        self.plan = unnamed_file()
        ends = [os.pipe(), os.pipe()]
        self._pipes = [write for _, write in ends]
        inherited = [read for read, _ in ends]
        files = (self.sas.fileno(), self.plan.fileno())
        try:
            self.process = PlannerProcess(
                NAME,
                [
                    *(sys.executable, "-S", "-c", _TRANSLATE_AND_SEARCH),
                    *(f"/dev/fd/{end}" for end in inherited),
                    *(str(files[0]), *(search_command(search, self.plan) if search else ())),
                ],
                passed=(*inherited, *files),
                environment={"PYTHONPATH": str(programs)},
                memory=memory,
                processor=processor,
            )
        except BaseException:
            self._close()
            raise
        finally:
            for end in inherited:
                os.close(end)

    def __enter__(self) -> DownwardProcess:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.process.__exit__(kind, error, trace)
        self._close()

    def give(self, texts: Sequence[str], deadline: Deadline) -> None:
        """Give it the texts of domain and problem; what came of them is known when its process has ended."""
        for text in texts:
            feed(self._pipes.pop(0), text, self.process, deadline)

    def translated(self) -> bool:
        """Whether the search has begun."""
        return os.fstat(self.sas.fileno()).st_size > 0

    def _close(self) -> None:
        for end in self._pipes:
            os.close(end)
        self._pipes = []
        self.sas.close()
        self.plan.close()


def early_start(
    planner: str | None, *, optimal: bool, memory: int | None = None
) -> AbstractContextManager[DownwardProcess | None]:
    """Fast Downward for :func:`tmd.planning.backends.solve`, where ``planner`` asks it first and it is there."""
    first = planner == "fast-downward" or (planner in (None, "auto") and (optimal or not find_spec("kairos")))
    needed = first and find_spec("up_fast_downward")
    return DownwardProcess(OPTIMAL if optimal else FIRST, memory) if needed else nullcontext()
