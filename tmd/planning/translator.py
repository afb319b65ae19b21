"""Fast Downward's translator as a process that waits for its problem.

It is started before there is a text for it and gets that through pipes: this hides the start of its interpreter behind
the reading of the problem. So nothing is imported here that is not needed to start it.
"""

from __future__ import annotations

import os
import sys
import tempfile
from contextlib import AbstractContextManager, nullcontext
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from tmd.diagnostics import MissingToolError
from tmd.planning.processes import Deadline, PlannerProcess, feed

if TYPE_CHECKING:
    from types import TracebackType

    from tmd.pddl.model import Problem

_TRANSLATE = (
    # its many small objects make Python look for cycles all the time: a quarter of the time of a large task
    "import gc, runpy; gc.set_threshold(100_000); "
    "runpy.run_module('fast_downward.translate', run_name='__main__', alter_sys=True)"
)


def binaries() -> Path:
    """The directory with Fast Downward's translator and search.

    Raises:
        MissingToolError: It is not installed.
    """
    spec = find_spec("up_fast_downward")
    if spec is None or spec.origin is None:
        raise MissingToolError("Fast Downward is not installed", hint="pip install up-fast-downward")
    return Path(spec.origin).parent / "downward" / "builds" / "release" / "bin"


class Translator:
    """Fast Downward's translator, started and waiting for its problem; a ``with`` block ends it.

    Raises:
        MissingToolError: Fast Downward is not installed.
        PlannerError: It cannot be started.
    """

    def __init__(self) -> None:
        self.binaries = binaries()
        self.sas = tempfile.TemporaryFile()  # noqa: SIM115 - closed when the block is left
        ends = [os.pipe(), os.pipe()]
        self._pipes = [write for _, write in ends]
        inherited = [read for read, _ in ends]
        try:
            self.process = PlannerProcess(
                "Fast Downward's translator",
                [
                    *(sys.executable, "-S", "-c", _TRANSLATE),
                    *(f"/dev/fd/{end}" for end in inherited),
                    *("--sas-file", f"/dev/fd/{self.sas.fileno()}"),
                ],
                passed=(*inherited, self.sas.fileno()),
                environment={"PYTHONPATH": str(self.binaries)},
            )
        except BaseException:
            self._close()
            raise
        finally:
            for end in inherited:
                os.close(end)

    def __enter__(self) -> Translator:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.process.__exit__(kind, error, trace)
        self._close()

    def translate(self, problem: Problem, deadline: Deadline) -> int | None:
        """Translate ``problem``: how the translator ended, ``None`` where it did not by the deadline.

        Raises:
            TmdError: The problem cannot be written in the form that other planners read.
        """
        from tmd.pddl.normalise import portable
        from tmd.pddl.writer import format_domain, format_problem

        plain = portable(problem)
        for text in (format_domain(plain.domain), format_problem(plain)):
            feed(self._pipes.pop(0), text, self.process, deadline)
        return self.process.wait(deadline)

    def _close(self) -> None:
        for end in self._pipes:
            os.close(end)
        self._pipes = []
        self.sas.close()


def early_translator(planner: str | None) -> AbstractContextManager[Translator | None]:
    """A translator for :func:`tmd.planning.backends.solve`, where ``planner`` will need one and it is there."""
    needed = planner in (None, "auto", "fast-downward") and find_spec("up_fast_downward")
    return Translator() if needed else nullcontext()
