"""SIGKILL at random moments, then the same command again: the same bytes, nothing left behind, nothing alive."""

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

from experiments.robustness.workspace import ROOT
from tmd.diagnostics import ExitCode

_OWN = ("log.txt",)
"""Files that tell the time, so that they differ from run to run."""


@dataclass(frozen=True, slots=True)
class Job:
    """A command that writes, and what it writes to."""

    arguments: tuple[str, ...]
    target: str


_PROBLEM = "problems/04_tea/p01-tea-pantry1.pddl"
_RUN = ("experiment", "--task", "tea", "--domain", "04_tea", "--models", "empty,chance", "--out", "run", "--jobs")
JOBS: dict[str, Job] = {
    "fmt": Job(("fmt", "domains/04_tea", "problems/04_tea"), "."),
    "compile": Job(("compile", "04_tea"), "domains"),
    "export": Job(("export", _PROBLEM, "out", "--format", "adl,json,strips", "--overwrite"), "out"),
    "plan --output": Job(("plan", "04_tea", _PROBLEM, "--output", "plan.txt"), "plan.txt"),
    "view": Job(
        ("view", "--environment", "pantry1", "--text", "Heat the kettle.", "--guess", "--out", "page.html"), "page.html"
    ),
    "learn": Job(("learn", "04_tea", "--no-weights", "--out", "learned"), "learned"),
    "experiment, 1 job": Job((*_RUN, "1"), "run"),
    "experiment, 2 jobs": Job((*_RUN, "2"), "run"),
    "run --video": Job(
        (
            "run",
            "--environment",
            "kitchen1",
            "--text",
            "Wash the pot.",
            "--kinematic",
            "--video",
            "v.mp4",
            "--log",
            "v.jsonl",
        ),
        "v.mp4",
    ),
}


class Killer:
    """Runs one job undisturbed, for its bytes and its time, and then kills it again and again.

    Args:
        job: The job.
        folder: Where to; is made.
    """

    def __init__(self, job: Job, folder: Path) -> None:
        self.job = job
        self.folder = folder
        self.cache = folder.parent / "cache"
        begun = time.monotonic()
        self._fresh()
        self._finish()
        self.seconds = time.monotonic() - begun
        self.whole = self._bytes()

    def _fresh(self) -> None:
        shutil.rmtree(self.folder, ignore_errors=True)
        for kind in ("domains", "problems"):
            shutil.copytree(ROOT / kind / "04_tea", self.folder / kind / "04_tea")
        for path in [*self.folder.rglob("*.pddl"), *self.folder.rglob("*.yaml")]:
            path.write_text(path.read_text() + "\n\n")  # something to lay out

    def _start(self) -> subprocess.Popen[bytes]:
        variables = {**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(self.cache)}
        return subprocess.Popen(
            [sys.executable, "-m", "tmd", *self.job.arguments],
            cwd=self.folder,
            env=variables,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )

    def _finish(self) -> None:
        process = self._start()
        if process.wait(300) >= ExitCode.GAVE_UP or process.returncode < 0:
            raise SystemExit(f"error: `tmd {' '.join(self.job.arguments)}` ends with {process.returncode} undisturbed")

    def _bytes(self) -> dict[str, bytes]:
        return {
            str(path.relative_to(self.folder)): path.read_bytes()
            for path in sorted(self.folder.rglob("*"))
            if path.is_file() and path.name not in _OWN
        }

    def kill(self, choose: Random) -> str:
        """Kill once at a random moment and run again; what is wrong afterwards."""
        self._fresh()
        process = self._start()
        time.sleep(choose.uniform(0, self.seconds))
        group = process.pid
        process.send_signal(signal.SIGKILL)  # the process alone, as a machine out of memory does
        process.wait()
        deadline = time.monotonic() + 2
        while (alive := _members(group)) and time.monotonic() < deadline:
            time.sleep(0.05)
        for number in alive:  # all of them are children of the command started above
            os.kill(number, signal.SIGKILL)
        self._finish()
        after = self._bytes()
        left = sorted(name for name in after.keys() - self.whole.keys())
        if left:
            return f"left behind: {left[0]}"
        if after != self.whole:
            return f"other bytes: {min(n for n in self.whole if after.get(n) != self.whole[n])}"
        return f"{len(alive)} processes alive after two seconds" if alive else ""


def _members(session: int) -> Sequence[int]:
    """The processes of a session that still run."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdecimal():
            try:
                fields = (entry / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            if int(fields[3]) == session and fields[0] != "Z":
                found.append(int(entry.name))
    return found
