"""Units on a cluster: the workers of a ``dask.distributed`` scheduler, on any number of machines.

What comes out of a unit is sent back and written by the process that asked, so workers share no file system with it.
They need the same version of tmd and the same data, and each unit checks that. A unit whose worker dies is done again
by another; a unit that brings down one worker after the other ends the run.
"""

from __future__ import annotations

import gc
import hashlib
import logging
import pickle
import socket
import threading
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any

from tmd import __version__
from tmd.diagnostics import DataError, MissingToolError, TmdError, install_extra
from tmd.evaluation.runs.config import ExperimentConfig
from tmd.evaluation.runs.dataset import forget_datasets, open_dataset
from tmd.evaluation.runs.jobs import GO_ON, EvaluationJob, JobOutcome, WorkerLostError, do

PACKAGE = Path(__file__).resolve().parents[2]
CONNECT = 20.0
"""Seconds a scheduler has to answer, and its first worker to be there."""
PATIENCE = 300.0
"""Seconds a run waits when all workers are gone."""
_LOOK = 2.0
"""Seconds between two looks at whether there still are workers."""
_NOISY = ("distributed", "distributed.client", "distributed.core", "distributed.comm", "tornado", "asyncio")
_ONE_AT_A_TIME = threading.Lock()
"""Worlds are cached and not made for threads, so a worker with several threads does one unit at a time."""


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
    sent = _sent(config)
    try:
        with _connected(address):
            call = _caller()
            waiting = {
                client.submit(call, pickle.dumps((sent, unit, build(), fingerprint)), pure=False) for unit in units
            }
        gone_since = None
        while waiting:
            with _connected(address):
                ended, gone_since = _ended(distributed, client, waiting, address, gone_since)
            waiting -= ended
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

        from tmd.evaluation.runs.cluster import remote

        return pickle.dumps(remote(*pickle.loads(sent)))

    return call


def _sent(config: ExperimentConfig) -> ExperimentConfig:
    """Return the configuration for workers, with absolute directories."""
    veil500, domains, problems = (p and p.resolve() for p in (config.veil500, config.domains, config.problems))
    return replace(config, out=Path(), jobs=1, veil500=veil500, domains=domains, problems=problems)


def remote(config: ExperimentConfig, unit: EvaluationJob, wanted: str, fingerprint: str) -> JobOutcome:
    """Do a unit on a worker, if that has what the run has.

    Args:
        config: The run.
        unit: What to do.
        wanted: The run's :func:`build`.
        fingerprint: Of the run's data.

    Raises:
        DataError: The worker has another version of tmd, or other data.
        TmdError: The unit cannot be done.
    """
    with _ONE_AT_A_TIME:
        here = _here()
        if build() != wanted:
            raise DataError(
                f"the worker on {here} has another tmd: {build()}, and the run has {wanted}",
                hint="install the same version everywhere, and restart the workers",
            )
        try:
            found = open_dataset(config).fingerprint()
            if found != fingerprint:
                forget_datasets()
                found = open_dataset(config).fingerprint()
        except TmdError as error:
            raise DataError(
                f"the worker on {here} cannot read the data: {error.message}",
                hint="the data must lie in the same directory on every machine",
            ) from None
        if found != fingerprint:
            raise DataError(
                f"the worker on {here} has other data: their fingerprint is {found}, and not {fingerprint}",
                hint="put the same data in the same directory on every machine",
            )
        return do(config, unit, None)


def build() -> str:
    """Return the version of tmd and a digest of its code."""
    return f"{__version__} (code {source_digest()})"


@lru_cache(maxsize=1)
def source_digest(package: Path = PACKAGE) -> str:
    """Return a digest of the code below a directory, as it was when this process asked for the first time."""
    digest = hashlib.sha256()
    for path in sorted(package.rglob("*.py")):
        content = path.read_bytes()
        digest.update(f"{path.relative_to(package).as_posix()} {len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()[:8]


def _here() -> str:
    """Return the worker's address, or the machine's name."""
    with suppress(Exception):
        from distributed import get_worker

        return str(get_worker().address)
    return socket.gethostname()


def _distributed() -> ModuleType:
    try:
        import distributed
    except ImportError:
        raise MissingToolError(
            "--backend dask needs the package distributed, which is not installed",
            hint=install_extra("cluster"),
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


def _ended(
    distributed: ModuleType,
    client: Any,  # noqa: ANN401
    waiting: set[Any],
    address: str,
    gone_since: float | None,
) -> tuple[set[Any], float | None]:
    """Return the futures that have ended, and since when all workers are gone; ``None`` if they are not.

    Raises:
        MissingToolError: They are gone for too long.
    """
    try:
        with client.as_current():
            return set(distributed.wait(waiting, timeout=_LOOK, return_when="FIRST_COMPLETED").done), None
    except TimeoutError:
        if client.nthreads():
            return set(), None
    now = time.monotonic()
    if gone_since is not None and now - gone_since > PATIENCE:
        raise MissingToolError(
            f"the workers of {address} are gone, for {PATIENCE:.0f} seconds",
            hint=f"start some with `dask worker {address}`; {GO_ON}",
        )
    return set(), now if gone_since is None else gone_since


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
