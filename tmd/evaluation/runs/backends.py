"""Execution backends: this process, processes on this machine, or a cluster.

A cluster is the workers of a ``dask.distributed`` scheduler, on any number of machines. The outcome of a unit is sent
back and written by the process that asked, so workers share no file system with it. They need the same version of tmd
and the same data, and each unit checks that. A unit whose worker dies is done again by another; a unit that brings down
one worker after the other ends the run.
"""

from __future__ import annotations

import gc
import logging
import pickle
import signal
import socket
import threading
import warnings
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import CancelledError
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from dataclasses import replace
from multiprocessing.resource_tracker import ensure_running
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar

from tmd import __version__
from tmd.diagnostics import DataError, MissingToolError, TmdError, install_extra
from tmd.evaluation.runs.config import DASK, ExperimentConfig
from tmd.evaluation.runs.dataset import open_dataset
from tmd.evaluation.runs.jobs import GO_ON, EvaluationJob, JobOutcome, WorkerLostError, do
from tmd.planning.processes import end_with_program

_Made = TypeVar("_Made")
# Seconds a scheduler has to answer, and its first worker to be there.
CONNECT = 20.0
_NOISY = ("distributed", "distributed.client", "distributed.core", "distributed.comm", "tornado", "asyncio")
# Worlds are cached and not made for threads, so a worker with several threads does one unit at a time.
_ONE_AT_A_TIME = threading.Lock()


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


def on_cluster(config: ExperimentConfig, units: Sequence[EvaluationJob], fingerprint: str) -> Iterator[JobOutcome]:
    """Do the units on the workers of ``config.scheduler``; yield what came out of each as soon as it is there.

    Raises:
        MissingToolError: dask is not installed, the scheduler cannot be reached or is lost, or it has no workers.
        WorkerLostError: A unit brought down several workers.
        DataError: A worker has other data, or another version of tmd.
        TmdError: A unit cannot be done.
    """
    distributed = _distributed()
    address = config.scheduler or ""
    client = _connect(distributed, address)
    # directories are those of the workers, whatever their working directory is
    veil500, domains, problems = (p and p.resolve() for p in (config.veil500, config.domains, config.problems))
    sent = replace(config, out=Path(), jobs=1, veil500=veil500, domains=domains, problems=problems)
    try:
        with _connected(address):
            call = _caller()
            asked = [pickle.dumps((sent, unit, __version__, fingerprint)) for unit in units]
            futures = [client.submit(call, one, pure=False) for one in asked]
            ended = distributed.as_completed(futures, loop=client.loop)
        for future in ended:
            yield _outcome(distributed, future, address)
    finally:
        with suppress(Exception):
            client.close(timeout=1)


def _caller() -> Callable[[bytes], bytes]:
    """Return the function that is sent: being local it travels with its code, and takes and returns bytes.

    So the scheduler needs no tmd, and a worker without it fails in the unit, with an error that is reported.
    """

    def call(sent: bytes) -> bytes:
        import pickle

        from tmd.evaluation.runs.backends import remote

        return pickle.dumps(remote(*pickle.loads(sent)))

    return call


def remote(config: ExperimentConfig, unit: EvaluationJob, version: str, fingerprint: str) -> JobOutcome:
    """Do a unit on a worker, if that has what the run has.

    Raises:
        DataError: The worker has another version of tmd, or other data.
        TmdError: The unit cannot be done.
    """
    here = f"the worker on {socket.gethostname()}"
    with _ONE_AT_A_TIME:
        if __version__ != version:
            raise DataError(
                f"{here} has tmd {__version__}, and the run has {version}",
                hint="install the same version everywhere, and restart the workers",
            )
        try:
            found = open_dataset(config).fingerprint()
        except TmdError as error:
            raise DataError(
                f"{here} cannot read the data: {error.message}",
                hint="the data must lie in the same directory on every machine",
            ) from None
        if found != fingerprint:
            raise DataError(
                f"{here} has other data: their fingerprint is {found}, and not {fingerprint}",
                hint="put the same data in the same directory on every machine, and restart the workers",
            )
        return do(config, unit, None)


def _distributed() -> ModuleType:
    try:
        import distributed
    except ImportError:
        raise MissingToolError(
            "--scheduler needs the package distributed, which is not installed", hint=install_extra("cluster")
        ) from None
    for name in _NOISY:
        logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    module: ModuleType = distributed
    return module


def _connect(distributed: ModuleType, address: str) -> Any:  # noqa: ANN401 - distributed is imported late
    hint = f"start one with `dask scheduler`, and give the address that it shows; {GO_ON}"
    client, failure = None, None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            client = distributed.Client(address, timeout=CONNECT, set_as_default=False)
    except ValueError as error:
        failure = TmdError(f"--scheduler {address}: {error}", hint="an address looks like tcp://host:8786")
    except Exception:  # transports raise errors of many types
        failure = MissingToolError(f"no scheduler answers at {address}", hint=hint)
    if client is None:
        # The half-made client is part of a cycle. Collected later it would stop its event loop, and were that to
        # happen while another client starts one, both would wait for the same lock for ever.
        gc.collect()
        raise failure or MissingToolError(f"no scheduler answers at {address}", hint=hint)
    try:
        client.wait_for_workers(1, timeout=CONNECT)
    except Exception:
        with suppress(Exception):
            client.close(timeout=1)
        raise MissingToolError(
            f"the scheduler at {address} has no workers", hint=f"start some with `dask worker {address}`"
        ) from None
    return client


def _outcome(distributed: ModuleType, future: Any, address: str) -> JobOutcome:  # noqa: ANN401
    """Return the outcome of a unit, or raise its error."""
    with _connected(address):
        error = future.exception()
        if error is None:
            outcome = pickle.loads(future.result())
            assert isinstance(outcome, JobOutcome)
            return outcome
    if isinstance(error, distributed.KilledWorker):
        raise WorkerLostError(
            "a unit brought down several workers one after the other, most likely because memory ran out",
            hint=f"give each worker more memory; {GO_ON}",
        )
    if isinstance(error, ImportError):
        raise MissingToolError(
            f"a worker cannot run tmd: {error}", hint=f"install tmd {__version__} wherever a worker runs"
        )
    assert isinstance(error, BaseException)
    raise error


@contextmanager
def _connected(address: str) -> Iterator[None]:
    """Report any error of the transport as a lost scheduler."""
    try:
        yield
    except (OSError, CancelledError):
        raise MissingToolError(f"the scheduler at {address} is lost", hint=f"restart it; {GO_ON}") from None
