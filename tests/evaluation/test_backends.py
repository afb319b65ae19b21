"""However the work is shared out, and whoever dies meanwhile: nothing is lost, and the bytes are the same."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.cli.conftest import Ended, heed_interrupts, run_tmd
from tmd import __version__
from tmd.diagnostics import DataError, ExitCode, MissingToolError, TmdError
from tmd.evaluation.models import model
from tmd.evaluation.runs import backends
from tmd.evaluation.runs.config import ExperimentConfig
from tmd.evaluation.runs.experiment import run
from tmd.evaluation.runs.jobs import EvaluationJob, JobOutcome, WorkerLostError, do

ROOT = Path(__file__).parents[2]
FILES = ("config.json", "predictions.jsonl", "metrics.json")
MODELS = ("empty", "chance", "nearest", "tree")
PARTS = 12
# in this small domain a unit takes milliseconds: nobody could interrupt the run between two of them
SLOWLY = """
import time
from tmd.evaluation.runs import backends, jobs
def slowly(config, unit, fits):
    time.sleep(0.15)
    return jobs.do(config, unit, fits)
backends.do = slowly
"""
COMMAND = (
    *("experiment", "--domain", "02_table", "--task", "set_table", "--train-tasks", "set_table"),
    *("--models", ",".join(MODELS)),
)
needs_dask = pytest.mark.skipif(find_spec("distributed") is None, reason="the package distributed is not installed")
needs_signals = pytest.mark.skipif(sys.platform == "win32", reason="no signals here")


def config(out: Path, **changes: object) -> ExperimentConfig:
    base = ExperimentConfig(
        "set_table",
        out,
        domain="02_table",
        train_tasks=("set_table",),
        models=MODELS,
        domains=ROOT / "domains",
        problems=ROOT / "problems",
    )
    return replace(base, **changes)  # type: ignore[arg-type]


def outcome(out: Path) -> dict[str, bytes]:
    return {name: (out / name).read_bytes() for name in FILES}


@pytest.fixture(scope="module")
def serial(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The files that one process writes."""
    out = tmp_path_factory.mktemp("serial") / "out"
    run(config(out))
    assert len(list((out / "parts").iterdir())) == PARTS
    return outcome(out)


def once(action: Callable[[], None]) -> Callable[[int, int], None]:
    """A progress that acts when the first unit is done."""
    done: list[int] = []

    def progress(number: int, total: int) -> None:
        if 0 < number < total and not done:
            done.append(number)
            action()

    return progress


def begin(out: Path, *options: str) -> subprocess.Popen[bytes]:
    """Start ``tmd experiment`` in a process group of its own."""
    return subprocess.Popen(
        [sys.executable, "-c", f"{SLOWLY}from tmd.cli import main\nmain()", *COMMAND, "--out", str(out), *options],
        cwd=out.parent,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
        preexec_fn=heed_interrupts,
    )


def some_part(process: subprocess.Popen[bytes], out: Path) -> None:
    """Wait until a part is there."""
    while process.poll() is None and not list(out.glob("parts/*.jsonl")):
        time.sleep(0.02)


def said(error: bytes) -> list[str]:
    """The messages, without the lines of the progress."""
    return [line for line in error.decode().splitlines() if not re.search(r" \d+/\d+ \d+:\d\d", line)]


# One machine


def test_processes_at_once_in_one_directory(tmp_path: Path, serial: dict[str, bytes]) -> None:
    """Both do the whole of it."""
    out = tmp_path / "out"
    processes = [begin(out, "--jobs", "1") for _ in range(2)]
    told = [process.communicate(timeout=300) for process in processes]
    assert [process.returncode for process in processes] == [0, 0], told
    assert outcome(out) == serial
    assert not list(out.rglob(".*")), "drafts were left behind"


@needs_signals
@pytest.mark.parametrize("jobs", [1, 2])
def test_an_interruption_is_one_line_and_loses_nothing(tmp_path: Path, serial: dict[str, bytes], jobs: int) -> None:
    out = tmp_path / "out"
    with begin(out, "--jobs", str(jobs)) as process:
        some_part(process, out)
        os.killpg(process.pid, signal.SIGINT)
        told, error = process.communicate(timeout=120)
    assert process.returncode == ExitCode.INTERRUPTED, error
    assert b"Traceback" not in error
    assert error.decode().splitlines()[-1] == "error: interrupted"
    assert told == b""
    times = {p: p.stat().st_mtime_ns for p in (out / "parts").iterdir()}
    assert 0 < len(times) < PARTS
    run(config(out))
    assert outcome(out) == serial
    assert {p: p.stat().st_mtime_ns for p in times} == times


BLOCKED = """
import signal, time
from tmd.evaluation.runs.backends import in_processes
def blocked(number):
    time.sleep(0.2)  # so that another process has a turn as well
    return signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, ())
print(list(in_processes(blocked, [(n,) for n in range(6)], 2)), blocked(0))
"""


@needs_signals
def test_workers_never_hear_of_interruptions() -> None:
    """In a new process, where nothing has started yet that workers need."""
    done = subprocess.run([sys.executable, "-c", BLOCKED], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.stdout == f"{[True] * 6} False\n", done.stderr


@needs_signals
def test_a_killed_run_goes_on(tmp_path: Path, serial: dict[str, bytes]) -> None:
    out = tmp_path / "out"
    with begin(out, "--jobs", "1") as process:
        some_part(process, out)
        os.killpg(process.pid, signal.SIGKILL)
    run(config(out))
    assert outcome(out) == serial


def workers_of(pid: int) -> list[int]:
    """The worker processes of a process."""
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return [int(child) for child in children if b"LokyProcess" in Path(f"/proc/{child}/cmdline").read_bytes()]


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="processes are listed in another way here")
def test_a_killed_process_is_told(tmp_path: Path, serial: dict[str, bytes], monkeypatch: pytest.MonkeyPatch) -> None:
    def slowly(config: ExperimentConfig, unit: EvaluationJob, fits: Path) -> JobOutcome:
        time.sleep(0.15)
        return do(config, unit, fits)

    def kill() -> None:
        for pid in workers_of(os.getpid()):
            os.kill(pid, signal.SIGKILL)

    monkeypatch.setattr(backends, "do", slowly)
    with pytest.raises(WorkerLostError, match="the same command goes on from there") as caught:
        run(config(tmp_path, jobs=2), once(kill))
    assert caught.value.exit_code == ExitCode.GAVE_UP
    assert list((tmp_path / "parts").iterdir())
    run(config(tmp_path))
    assert outcome(tmp_path) == serial


# A cluster

NO_TMD = "import sys\nsys.modules['tmd'] = None\n"


class Cluster:
    """A scheduler and its workers, each a process of its own."""

    def __init__(self, directory: Path, *options: str) -> None:
        self.file = directory / "scheduler.json"
        self.directory = directory
        self.workers: list[subprocess.Popen[bytes]] = []
        self.scheduler = self.start("scheduler", "--port", "0", "--host", "127.0.0.1", *options)
        deadline = time.monotonic() + 60
        # the scheduler makes the file before it writes into it, so an empty one is not the answer yet
        while not (self.file.exists() and self.file.read_text().endswith("}")) and time.monotonic() < deadline:
            time.sleep(0.05)
        self.address: str = json.loads(self.file.read_text())["address"]

    def start(self, kind: str, *options: str) -> subprocess.Popen[bytes]:
        log = (self.directory / f"{kind}-{len(self.workers)}.log").open("wb")
        settings = {"PYTHONPATH": str(ROOT), "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1"}
        command = [sys.executable, "-m", "dask", kind, "--scheduler-file", str(self.file), "--no-dashboard", *options]
        with log:
            return subprocess.Popen(command, cwd=self.directory, env={**os.environ, **settings}, stdout=log, stderr=log)

    def work(self, count: int, *options: str) -> None:
        """Start some workers; they are slow unless there are options."""
        if not options:
            preload = self.directory / "slowly.py"
            preload.write_text(SLOWLY)
            options = ("--preload", str(preload))
        for _ in range(count):
            self.workers.append(self.start("worker", "--no-nanny", "--nthreads", "1", *options))

    def dismiss(self) -> None:
        """End the workers."""
        for process in self.workers:
            process.kill()
            process.wait()
        self.workers.clear()

    def stop(self) -> None:
        self.dismiss()
        self.scheduler.kill()
        self.scheduler.wait()


@pytest.fixture(scope="module")
def scheduled(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    """A scheduler for all tests that leave it alive; it has no tmd, and needs none."""
    directory = tmp_path_factory.mktemp("cluster")
    preload = directory / "no_tmd.py"
    preload.write_text(NO_TMD)
    started = Cluster(directory, "--preload", str(preload))
    yield started
    started.stop()


@pytest.fixture
def cluster_(scheduled: Cluster) -> Iterator[Cluster]:
    """The scheduler, with no workers yet."""
    yield scheduled
    scheduled.dismiss()


def on(cluster: Cluster, out: Path, **changes: object) -> ExperimentConfig:
    return config(out, backend="dask", scheduler=cluster.address, **changes)


@needs_dask
@needs_signals
def test_a_worker_that_dies_loses_nothing(tmp_path: Path, cluster_: Cluster, serial: dict[str, bytes]) -> None:
    """One that is there already takes over, and one that comes late."""
    cluster_.work(2)
    run(on(cluster_, tmp_path / "out"), once(cluster_.workers[0].kill))
    assert cluster_.workers[0].wait() == -signal.SIGKILL
    assert cluster_.workers[1].poll() is None
    assert outcome(tmp_path / "out") == serial
    times = {p: p.stat().st_mtime_ns for p in (tmp_path / "out" / "parts").iterdir()}
    run(on(cluster_, tmp_path / "out"))
    assert {p: p.stat().st_mtime_ns for p in (tmp_path / "out" / "parts").iterdir()} == times

    def replace_worker() -> None:
        cluster_.workers[1].kill()
        cluster_.work(1)

    run(on(cluster_, tmp_path / "late"), once(replace_worker))
    assert outcome(tmp_path / "late") == serial


@needs_dask
@needs_signals
def test_a_scheduler_that_dies_is_told(tmp_path: Path, serial: dict[str, bytes]) -> None:
    own = Cluster(tmp_path)
    own.work(1)
    out = tmp_path / "out"
    try:
        with begin(out, "--scheduler", own.address) as process:
            some_part(process, out)
            own.scheduler.kill()
            told, error = process.communicate(timeout=120)
    finally:
        own.stop()
    assert process.returncode == ExitCode.MISSING_TOOL
    lines = said(error)
    assert lines[0] == f"error: the scheduler at {own.address} is lost"
    assert lines[1].startswith("hint: restart it; what is done is kept")
    assert len(lines) == 2
    assert told == b""
    assert 0 < len(list((out / "parts").iterdir())) < PARTS
    run(config(out))
    assert outcome(out) == serial


@needs_dask
@needs_signals
def test_an_interruption_leaves_the_cluster_ready(tmp_path: Path, cluster_: Cluster, serial: dict[str, bytes]) -> None:
    cluster_.work(1)
    out = tmp_path / "out"
    with begin(out, "--scheduler", cluster_.address) as process:
        some_part(process, out)
        process.send_signal(signal.SIGINT)
        told, error = process.communicate(timeout=120)
    assert process.returncode == ExitCode.INTERRUPTED, error
    assert said(error) == ["error: interrupted"]
    assert told == b""
    assert 0 < len(list((out / "parts").iterdir())) < PARTS
    run(on(cluster_, out))
    assert outcome(out) == serial


@needs_dask
@needs_signals
def test_a_unit_that_kills_its_workers_is_told(
    tmp_path: Path, cluster_: Cluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    preload = tmp_path / "killer.py"
    preload.write_text(
        "import os, signal\n"
        "from tmd.evaluation.models import model\n"
        "class Killer(model.Empty):\n"
        "    def fit(self, *_):\n"
        "        os.kill(os.getpid(), signal.SIGKILL)\n"
        "model.MODELS['killer'] = Killer\n"
    )
    monkeypatch.setattr(model, "MODELS", {**model.MODELS, "killer": model.Empty})
    cluster_.work(2, "--preload", str(preload))
    with pytest.raises(WorkerLostError, match="brought down several workers"):
        run(on(cluster_, tmp_path / "out", models=("killer",), test_environments=(1,)))


@needs_dask
def test_a_worker_with_another_version_or_data_is_told(
    tmp_path: Path, cluster_: Cluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    cluster_.work(1)
    with monkeypatch.context() as other:
        other.setattr(backends, "__version__", "9.9")
        with pytest.raises(DataError, match=rf"has tmd {__version__}, and the run has 9\.9"):
            run(on(cluster_, tmp_path / "out"))
    problems = tmp_path / "problems"
    problems.mkdir()
    (problems / "02_table").symlink_to(ROOT / "problems" / "02_table")
    (cluster_.directory / "problems" / "02_table").mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(DataError, match=r"the worker on .* (has other|cannot read the) data"):
        run(on(cluster_, tmp_path / "out", problems=None))


@needs_dask
def test_a_worker_without_tmd_is_told(tmp_path: Path, cluster_: Cluster) -> None:
    preload = tmp_path / "preload.py"
    preload.write_text(NO_TMD)
    cluster_.work(1, "--preload", str(preload))
    with pytest.raises(MissingToolError, match="a worker cannot run tmd"):
        run(on(cluster_, tmp_path / "out"))


def test_a_worker_checks_what_it_has(tmp_path: Path) -> None:
    here = config(tmp_path, test_environments=(1,))
    unit = EvaluationJob("empty", "set_table_2", ("given",))
    found = backends.open_dataset(here).fingerprint()
    assert backends.remote(here, unit, __version__, found).parts.keys() == {"given"}
    with pytest.raises(DataError, match=r"other data: their fingerprint is \w+, and not 0123"):
        backends.remote(here, unit, __version__, "0123")
    with pytest.raises(DataError, match="and the run has 0"):
        backends.remote(here, unit, "0", found)


@needs_dask
def test_a_scheduler_without_workers_is_told(
    tmp_path: Path, cluster_: Cluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(backends, "CONNECT", 1.0)
    with pytest.raises(MissingToolError, match=r"the scheduler at .* has no workers"):
        run(on(cluster_, tmp_path / "out"))


def told(tmp_path: Path, *options: str, before: str = "") -> Ended:
    return run_tmd([*COMMAND, "--out", "out", *options], tmp_path, before=before)


@needs_dask
@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "tcp://no-such-host.invalid:8786"])
def test_a_scheduler_out_of_reach_is_told(tmp_path: Path, address: str) -> None:
    hurry = "import tmd.evaluation.runs.backends as b; b.CONNECT = 1.0"
    ended = told(tmp_path, "--scheduler", address, before=hurry)
    assert ended.code == ExitCode.MISSING_TOOL
    assert ended.err.splitlines()[-2:][0] == f"error: no scheduler answers at {address}"
    assert "Traceback" not in ended.err


@needs_dask
@pytest.mark.parametrize("address", ["", "nonsense", "tcp://", "tcp://127.0.0.1:port"])
def test_an_address_that_is_none_is_told(tmp_path: Path, address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(backends, "CONNECT", 1.0)
    with pytest.raises(TmdError, match="scheduler"):
        run(config(tmp_path / "out", backend="dask", scheduler=address))


def test_without_distributed_the_package_is_named(tmp_path: Path) -> None:
    hidden = "import sys; sys.modules['distributed'] = None"
    ended = told(tmp_path, "--scheduler", "tcp://127.0.0.1:9", before=hidden)
    assert ended.code == ExitCode.MISSING_TOOL
    assert "distributed, which is not installed\nhint: pip install 'tell-me-dave[cluster]'" in ended.err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--drop-sentences", "1"), "x<1"),
        (("--drop-sentences", "-0.1"), "x<1"),
        (("--drop-sentences", "nan"), "not a number"),
        (("--train-tasks", " , "), "names nothing"),
    ],
)
def test_a_wrong_command_is_told(tmp_path: Path, options: tuple[str, ...], message: str) -> None:
    ended = told(tmp_path, *options)
    assert ended.code == ExitCode.USAGE
    assert message in ended.err
    assert not list(tmp_path.iterdir())


@needs_dask
@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "nonsense"])
def test_a_client_that_could_not_connect_is_gone_at_once(
    tmp_path: Path, address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Collected later, while another one starts, it would block both."""
    import gc

    from distributed import Client

    monkeypatch.setattr(backends, "CONNECT", 0.5)
    gc.disable()
    try:
        with pytest.raises(TmdError):
            run(config(tmp_path / "out", backend="dask", scheduler=address))
        assert not any(isinstance(thing, Client) for thing in gc.get_objects())
    finally:
        gc.enable()
