"""Commands that are disturbed and then given again: afterwards everything is as if nothing had happened.

They are killed at random moments, run twice at once in one folder, under a clock that goes back, and on a disk that is
full from some write on. Whatever happens, the same command afterwards makes the same bytes, nothing else is left in the
folder or in the directory for temporary files, and no process is alive.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random

from experiments.robustness.workspace import DOMAINS, ROOT
from tmd.diagnostics import ExitCode

_OWN = ("log.txt", "shown.log")
"""Files that tell the time, so that they differ from run to run."""
_MARK = "TMD_ROBUSTNESS"
_READY = "is open:"
_STARTING = 0.3
"""Seconds in which Python itself starts: an interrupt then ends with its own traceback, whatever the program."""
_LONGEST = 600.0
"""Seconds for a command that is not disturbed."""


@dataclass(frozen=True, slots=True)
class Job:
    """A command that writes.

    Attributes:
        arguments: Those of Python.
        serves: Whether it serves until it is told to end.
        rounds: Whether it writes a file several times, each time whole and better than before.
        cluster: Whether it needs a scheduler, whose address takes the place of ``{scheduler}``.
    """

    arguments: tuple[str, ...]
    serves: bool = False
    cluster: bool = False
    rounds: bool = False


def _tmd(*arguments: str, serves: bool = False, cluster: bool = False, rounds: bool = False) -> Job:
    return Job(("-m", "tmd", *arguments), serves, cluster, rounds)


_PROBLEM = "problems/04_tea/p01-tea-pantry1.pddl"
_RUN = ("experiment", "--task", "tea", "--domain", "04_tea", "--models", "empty,chance,goals", "--out", "run")
_SAVING = """
import os
import signal
import sys

signal.signal(signal.SIGINT, lambda *_: os._exit(130))  # as tmd: no traceback
from pathlib import Path
from tmd.diagnostics import TmdError
from tmd.files import locked
from tmd.pddl.plan_file import parse_instruction
from tmd.studio.demonstrations.demo_store import Archive
from tmd.studio.demonstrations.session import Session
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder

corpus = Corpus(DomainFolder(Path("domains/02_table")), Path("problems/02_table"))
archive = Archive(corpus, wait=60)
shown = archive.file("shown")
while (count := len(shown.read_text().splitlines()) if shown.exists() else 0) < 40:
    if shown.exists() and not shown.read_text().endswith("\\n"):
        raise SystemExit("a line is torn")
    session = Session(corpus.world("corner1"), "Put the cup on the shelf.", corpus.lexicon)
    for line in ("moveto(cup1)", "grasp(cup1)", "moveto(shelf1)", "keep(cup1, shelf1, on)"):
        session.do(parse_instruction(line))
    try:
        archive.save(session)
    except TmdError as error:
        print(f"error: {error.message}\\nhint: {error.hint}", file=sys.stderr)
        raise SystemExit(error.exit_code) from None
    if len(shown.read_text().splitlines()) <= count:
        raise SystemExit("a line is lost")
with locked(shown.with_name(".demonstrations.jsonl.lock"), wait=60):  # of two at once both may have been at 39
    shown.write_text("".join(shown.read_text().splitlines(keepends=True)[:40]))
"""
JOBS: dict[str, Job] = {
    "fmt": _tmd("fmt", "domains/04_tea", "problems/04_tea"),
    "check --fix": _tmd("check", "--fix", "domains/04_tea", "problems/04_tea", rounds=True),
    "compile": _tmd("compile", "04_tea"),
    "export": _tmd("export", _PROBLEM, "out", "--format", "adl,strips", "--overwrite"),
    "plan": _tmd("plan", "04_tea", _PROBLEM, "--output", "plan.txt"),
    "plan, unified-planning": _tmd("plan", "04_tea", _PROBLEM, "--output", "plan.txt", "--planner", "up:fast-downward"),
    "learn": _tmd("learn", "04_tea", "--out", "learned"),
    "experiment": _tmd(*_RUN, "--jobs", "1"),
    "experiment, 2 jobs": _tmd(*_RUN, "--jobs", "2"),
    "experiment, dask": _tmd(
        *("--domains", "{folder}/domains", "--problems", "{folder}/problems", *_RUN),
        *("--scheduler", "{scheduler}"),
        cluster=True,
    ),
    "studio": _tmd("studio", "--domain", "02_table", "--port", "0", serves=True),
    "studio, saving": Job(("-c", _SAVING)),
    "run --video": _tmd(
        *("run", "--environment", "kitchen1", "--text", "Take the pot.", "--kinematic"),
        *("--video", "v.mp4", "--strip", "v.png", "--log", "v.jsonl"),
    ),
}  # fmt: skip


class Disturber:
    """Runs one job undisturbed, for its bytes and its time, and then disturbs it again and again.

    Args:
        job: The job.
        folder: Where to; is made.
    """

    def __init__(self, job: Job, folder: Path) -> None:
        self.job = job
        self.folder = folder
        self.cache, self.temporary = folder.with_name(f"{folder.name}-cache"), folder.with_name(f"{folder.name}-tmp")
        self.mark = f"{os.getpid()}-{folder.name}"
        self.shim = _shim(folder.parent)
        self._cluster: list[subprocess.Popen[bytes]] = []
        self.scheduler = self._started_cluster() if job.cluster else ""
        self._fresh()
        self._finish()  # learns what is kept in the cache, and is not measured
        self._fresh()
        begun = time.monotonic()
        fault = self._finish()
        if fault:
            raise SystemExit(f"error: {' '.join(job.arguments)[:80]} {fault}")
        self.seconds = time.monotonic() - begun
        self.whole = self._bytes()

    def close(self) -> None:
        """End the cluster, if there is one."""
        for process in self._cluster:
            process.terminate()
            process.wait()

    def _started_cluster(self) -> str:
        """A scheduler with one worker; its address."""
        self.folder.parent.mkdir(parents=True, exist_ok=True)
        told = self.folder.with_name(f"{self.folder.name}-scheduler.json")
        common = ("--scheduler-file", str(told))
        here = {**os.environ, "PYTHONPATH": str(ROOT)}
        for role in (("scheduler", "--port", "0", "--no-dashboard"), ("worker", "--nworkers", "1", "--no-dashboard")):
            command = [sys.executable, "-m", "distributed.cli.dask_" + role[0], *role[1:], *common]
            self._cluster.append(
                subprocess.Popen(
                    command,
                    cwd=self.folder.parent,
                    env=here,
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                )
            )
            while not told.exists():
                time.sleep(0.1)
        import json

        return str(json.loads(told.read_text())["address"])

    def _fresh(self) -> None:
        for folder in (self.folder, self.temporary):
            shutil.rmtree(folder, ignore_errors=True)
        self.temporary.mkdir(parents=True)
        for kind in ("domains", "problems"):
            for name in DOMAINS:
                shutil.copytree(ROOT / kind / name, self.folder / kind / name)
        for path in [*self.folder.rglob("*.pddl"), *self.folder.rglob("*.yaml")]:
            path.write_text(path.read_text() + "\n\n")  # something to lay out
        domain = self.folder / "domains" / "04_tea" / "instructions.pddl"
        domain.write_text(domain.read_text().replace(" - ", " -", 1))  # something to mend

    def _start(self, **settings: str) -> subprocess.Popen[bytes]:
        places = {"{scheduler}": self.scheduler, "{folder}": str(self.folder)}
        arguments = list(self.job.arguments)
        for name, place in places.items():
            arguments = [argument.replace(name, place) for argument in arguments]
        variables = {
            **os.environ,
            "PYTHONPATH": str(ROOT),
            "XDG_CACHE_HOME": str(self.cache),
            "XDG_STATE_HOME": str(self.cache),
            "TMPDIR": str(self.temporary),
            "PYTHONDONTWRITEBYTECODE": "1",
            _MARK: self.mark,
            **settings,
        }
        with (self.temporary.parent / f"{self.folder.name}-stderr").open("ab") as told:
            return subprocess.Popen(
                [sys.executable, *arguments],
                cwd=self.folder,
                env=variables,
                stdin=subprocess.DEVNULL,
                stdout=told if self.job.serves else subprocess.DEVNULL,
                stderr=told,
                preexec_fn=_heed_interrupts,
            )

    def _told(self) -> str:
        """What the commands of this disturbance printed, which is forgotten then."""
        file = self.temporary.parent / f"{self.folder.name}-stderr"
        told = file.read_text(errors="replace") if file.exists() else ""
        file.unlink(missing_ok=True)
        return told

    def _finish(self) -> str:
        """Run it to its end; what is wrong with that."""
        self._told()
        process = self._start()
        code = self._ended(process)
        told = self._told()
        right = (ExitCode.INTERRUPTED,) if self.job.serves else (ExitCode.OK, ExitCode.FAULTS_FOUND)
        return "" if code in right and "Traceback" not in told else f"ends with {code} undisturbed: {told[-300:]}"

    def _ended(self, process: subprocess.Popen[bytes]) -> int:
        """The exit code of a command; one that serves is told to end once it does."""
        deadline = time.monotonic() + _LONGEST
        file = self.temporary.parent / f"{self.folder.name}-stderr"
        while self.job.serves and process.poll() is None and time.monotonic() < deadline:
            if file.exists() and _READY in file.read_text(errors="replace"):
                process.send_signal(signal.SIGTERM)
                break
            time.sleep(0.1)
        try:
            return process.wait(max(deadline - time.monotonic(), 1.0))
        except subprocess.TimeoutExpired:
            process.kill()
            return process.wait()

    def _bytes(self) -> dict[str, bytes]:
        return {
            str(path.relative_to(self.folder)): path.read_bytes()
            for path in sorted(self.folder.rglob("*"))
            if path.is_file() and path.name not in _OWN
        }

    def _again(self, *, alive: int = 0) -> str:
        """Give the command again; what is wrong afterwards."""
        fault = self._finish()
        if fault:
            return fault
        after = self._bytes()
        left = sorted(name for name in after.keys() - self.whole.keys())
        left += [f"(temporary) {path.name}" for path in self.temporary.iterdir()]
        if left:
            return f"left behind: {left[0]}"
        if after != self.whole:
            return f"other bytes: {min(n for n in self.whole if after.get(n) != self.whole[n])}"
        return f"{alive} processes alive after two seconds" if alive else ""

    def kill(self, choose: Random) -> str:
        """End it at a random moment, and run it again; what is wrong afterwards."""
        self._fresh()
        process = self._start()
        moment = choose.uniform(0, self.seconds)
        how = choose.choice((*[signal.SIGKILL] * 6, signal.SIGTERM, signal.SIGINT))
        time.sleep(max(moment, _STARTING) if how is signal.SIGINT else moment)
        process.send_signal(how)
        try:
            process.wait(30)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            return "does not end within 30 s of a signal"
        told = self._told()
        return f"a traceback: {told[-400:]}" if "Traceback" in told else self._again(alive=self._survivors())

    def _survivors(self) -> int:
        """How many processes live on two seconds later; they are ended."""
        deadline = time.monotonic() + 2
        while (alive := _marked(self.mark)) and time.monotonic() < deadline:
            time.sleep(0.05)
        for number in alive:  # all of them are children of the command started above
            os.kill(number, signal.SIGKILL)
        return len(alive)

    def twice(self, choose: Random) -> str:
        """Run it twice at once in one folder, the second a moment later; what is wrong."""
        self._fresh()
        self._told()
        first = self._start()
        time.sleep(choose.uniform(0, self.seconds / 2))
        second = self._start()
        codes = self._ended(first), self._ended(second)
        told = self._told()
        if "Traceback" in told or ExitCode.INTERNAL in codes or min(codes) < 0 or not set(codes) <= set(ExitCode):
            return f"two at once end with {codes}: {told[-200:]}"
        if all(code >= ExitCode.GAVE_UP for code in codes) and not self.job.serves:
            return f"neither of two at once succeeds: {codes}: {told[-200:]}"
        return self._again(alive=self._survivors())

    def clock_back(self, choose: Random) -> str:
        """Run it under a clock that goes back at every look; what is wrong."""
        if self.shim is None or self.job.cluster:  # dask waits by that clock itself, and for ever
            return ""
        self._fresh()
        self._told()
        code = self._ended(self._start(LD_PRELOAD=str(self.shim), ROBUSTNESS_BACK=str(choose.choice((1, 60, 86_400)))))
        right = (ExitCode.INTERRUPTED,) if self.job.serves else (ExitCode.OK, ExitCode.FAULTS_FOUND)
        told = self._told()
        if code not in right or "Traceback" in told:
            return f"ends with {code} under a clock that goes back: {told[-200:]}"
        if (found := self._bytes()) != self.whole:
            names = [n for n in self.whole.keys() | found.keys() if found.get(n) != self.whole.get(n)]
            return f"other bytes under a clock that goes back: {min(names)}"
        return self._again(alive=self._survivors())

    def writes(self) -> int:
        """How many calls that make files grow its processes make, at most."""
        if self.shim is None:
            return 0
        self._fresh()
        count = self.folder.with_name(f"{self.folder.name}-count")
        self._ended(self._start(LD_PRELOAD=str(self.shim), ROBUSTNESS_COUNT=str(count)))
        numbers = [int(line) for line in count.read_text().split()] if count.exists() else []
        count.unlink(missing_ok=True)
        return max(numbers, default=0)

    def full(self, number: int) -> str:
        """Run it on a disk that is full from the write of that number on, and again with room; what is wrong."""
        self._fresh()
        self._told()
        before = self._bytes()
        code = self._ended(self._start(LD_PRELOAD=str(self.shim), ROBUSTNESS_FULL=str(number)))
        told = self._told()
        if "Traceback" in told or code == ExitCode.INTERNAL or code not in set(ExitCode):
            return f"write {number}: ends with {code} on a full disk: {told[-300:]}"
        if code >= ExitCode.BAD_INPUT and code != ExitCode.INTERRUPTED and "\nhint: " not in told:
            return f"write {number}: no remedy: {told[-200:]}"
        torn = [name for name, data in before.items() if self._of(name) not in (data, self.whole.get(name))]
        torn = [] if self.job.rounds else torn
        if torn:
            return f"write {number}: neither as before nor as meant: {torn[0]}"
        fault = self._again(alive=self._survivors())
        return f"write {number}: {fault}" if fault else ""

    def _of(self, name: str) -> bytes | None:
        path = self.folder / name
        return path.read_bytes() if path.is_file() else None


def _shim(folder: Path) -> Path | None:
    """The library that makes the disk full and the clock go back; ``None`` where there is no compiler."""
    made = folder / "shim.so"
    folder.mkdir(parents=True, exist_ok=True)
    if made.exists():
        return made
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None or sys.platform != "linux":
        return None
    source = Path(__file__).with_name("shim.c")
    subprocess.run([compiler, "-shared", "-fPIC", "-O1", "-o", str(made), str(source), "-ldl"], check=True)
    return made


def _heed_interrupts() -> None:
    """A shell's background job ignores Ctrl-C, and so would what it starts."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def _marked(mark: str) -> Sequence[int]:
    """The processes with the mark in their environment that still run."""
    found = []
    wanted = f"{_MARK}={mark}".encode()
    for entry in Path("/proc").iterdir():
        if entry.name.isdecimal():
            try:
                if wanted in (entry / "environ").read_bytes().split(b"\0"):
                    found.append(int(entry.name))
            except OSError:
                continue
    return found
