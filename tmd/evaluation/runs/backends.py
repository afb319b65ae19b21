"""Execution backends: this process, processes on this machine, or a cluster."""

from __future__ import annotations

import signal
import warnings
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing.resource_tracker import ensure_running
from pathlib import Path
from typing import Any, TypeVar

from tmd.evaluation.runs.config import DASK, ExperimentConfig
from tmd.evaluation.runs.jobs import GO_ON, EvaluationJob, JobOutcome, WorkerLostError, do
from tmd.planning.processes import end_with_program

_Made = TypeVar("_Made")


def outcomes(
    config: ExperimentConfig, units: Sequence[EvaluationJob], fits: Path, fingerprint: str
) -> Generator[JobOutcome]:
    """Do the units, and yield what came out of each as soon as it is there, in any order.

    ``fits`` is where what is learned is kept on this machine; the data must have the ``fingerprint`` wherever a unit is
    done.

    Raises:
        WorkerLostError: A process was killed.
        TmdError: A unit cannot be done, or the cluster cannot be used.
    """
    if config.backend == DASK:
        from tmd.evaluation.runs.cluster import on_cluster

        yield from on_cluster(config, units, fingerprint)
    else:
        yield from in_processes(do, [(config, unit, fits) for unit in units], config.jobs)


def in_processes(work: Callable[..., _Made], tasks: Sequence[tuple[Any, ...]], jobs: int) -> Generator[_Made]:
    """Call ``work`` with each of ``tasks``, at most ``jobs`` at once, and yield what comes back in any order.

    ``work`` is a function of a module, for other processes must find it. With one job, this process does it all.

    Raises:
        WorkerLostError: A process was killed.
    """
    if jobs == 1 or not tasks:
        for task in tasks:
            yield work(*task)
        return
    from joblib import Parallel, delayed, parallel_config

    end_with_program()
    with warnings.catch_warnings(), parallel_config(backend="loky", inner_max_num_threads=1):
        # a worker that has grown is replaced between two units, and nothing is lost
        warnings.filterwarnings("ignore", message="A worker stopped while some jobs were given")
        # joblib can do without the files that it cannot write; our own files are reported elsewhere
        warnings.filterwarnings("ignore", module=r"joblib\b")
        workers = Parallel(n_jobs=min(jobs, len(tasks)), return_as="generator_unordered", batch_size=1)
        try:
            with _interrupts_blocked():
                found = workers(delayed(work)(*task) for task in tasks)
            yield from found
        except BrokenProcessPool:
            raise WorkerLostError(
                "a worker process was killed, most likely because memory ran out", hint=f"take fewer --jobs; {GO_ON}"
            ) from None


@contextmanager
def _interrupts_blocked() -> Iterator[None]:
    """Block SIGINT in processes and threads started here; this process receives it afterwards and ends them."""
    # Python's resource tracker unblocks SIGINT when it starts, so it is started first
    ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
