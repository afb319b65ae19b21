"""A folder with small domains and all that commands make of them, and commands run in it on damaged copies.

A command runs in a child that is forked from here, where everything it imports is in memory already: that is what
makes ten thousand cases an hour possible on one processor. Whatever it does to the folder is undone afterwards.
"""

from __future__ import annotations

import contextlib
import ctypes
import errno
import gc
import io
import json
import os
import re
import resource
import shutil
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from random import Random
from typing import IO, Any
from zlib import crc32

from experiments.robustness.mutate import damaged, damaged_json
from tmd.cli import ALLOCATIONS
from tmd.cli.program import run as run_tmd
from tmd.diagnostics import ExitCode

ROOT = Path(__file__).resolve().parents[2]
SECONDS = 60.0
"""No command on a damaged small file takes longer on a busy machine."""
PATIENCE = 2.0
"""Seconds in which the processes of a command that has ended must have ended."""
MEMORY = 4_000_000_000
"""Bytes of address space that a command may have."""
LISTENING = 4.0
"""Seconds after which a studio that has begun to listen is told to end."""
DOMAINS = ("01_blocks", "02_table", "03_drawer", "04_tea", "lab_bench")
PROBLEM = "problems/04_tea/p01-tea-pantry1.pddl"
SAID = "Fill the kettle with water. Heat it on the stove, then put the cup on the table."
EXPERIMENT = (
    *("experiment", "--task", "tea", "--domain", "04_tea"),
    *("--models", "empty,chance", "--out", "run", "--jobs", "1"),
)
_WRITERS = ("fmt", "compile", "learn", "new", "experiment")
_OUTPUTS = ("--out", "--output", "--log", "--strip", "--picture", "--video", "--fix", "--overwrite")
_PR_SET_CHILD_SUBREAPER = 36
_DIED = 99
_Saved = Callable[[int, "Case", "Outcome"], None]
_KEPT = ("tmd.language", "tmd.planning.search", "tmd.robot", "tmd.studio", "tmd.view.markup")
_CACHES: list[Any] = []
_LEFTOVER = re.compile(r"\.part$|\.unfinished\.")


@dataclass(frozen=True, slots=True)
class Case:
    """A command, run in a :class:`Workspace` that was damaged before.

    Attributes:
        arguments: What follows ``tmd``.
        stdin: What it reads.
        streams: Standard streams, by number, that are ``closed``, ``full`` or ``gone`` (nobody reads them).
        environment: Variables that are set; ``None`` takes one away.
        hold: Whether the command serves until it is told to end.
    """

    arguments: tuple[str, ...]
    stdin: bytes = b""
    streams: Mapping[int, str] = field(default_factory=dict)
    environment: Mapping[str, str | None] = field(default_factory=dict)
    hold: bool = False


@dataclass(slots=True)
class Outcome:
    """How a case ended: ``fault`` says what is wrong with that, empty where nothing is."""

    code: int
    seconds: float
    fault: str
    told: str


@dataclass(slots=True)
class Workspace:
    """The folder.

    Attributes:
        folder: Where it is; beside it commands keep what they learned.
        kept: The contents of its files by name, undamaged.
    """

    folder: Path
    kept: dict[str, bytes] = field(default_factory=dict)
    _stamps: dict[str, tuple[int, int]] = field(default_factory=dict)

    def prepare(self, *, robot: bool = False) -> None:
        """Make the folder, and load what commands need; takes half a minute, with the robot a whole one."""
        self.folder.mkdir(parents=True)
        for kind in ("domains", "problems"):
            for name in DOMAINS:
                shutil.copytree(ROOT / kind / name, self.folder / kind / name)
        (self.folder / "said.txt").write_text(SAID)
        _write_veil(self.folder / "veil")
        self._run_once(Case(("plan", "04_tea", PROBLEM, "--output", "plan.txt")))
        self._run_once(Case(("learn", "04_tea", "--no-weights", "--out", "learned")))
        self._run_once(Case(EXPERIMENT))
        ground = ("ground", "--environment", "pantry1", "--text", SAID, "--guess", "--json")
        self._run_once(Case(ground), "ground.json")
        self._run_once(Case(("view", "ground.json", "--out", "page.html")))
        self._run_once(Case(("test", "04_tea")))
        if robot:
            take = ("--environment", "kitchen1", "--text", "Take the pot.", "--kinematic")
            self._run_once(Case(("run", *take, "--log", "log.jsonl")))
        with contextlib.chdir(self.folder), contextlib.redirect_stdout(io.StringIO()):
            run_tmd(("parse", "--text", SAID))  # the words of English are read once
            run_tmd(("plan", "04_tea", PROBLEM, "--planner", "in-process"))  # the search is loaded once
        gc.collect()
        gc.freeze()  # a child that looked over our objects for garbage would copy their pages
        gc.set_threshold(ALLOCATIONS)
        _adopt_orphans()
        self.kept = {name: (self.folder / name).read_bytes() for name in self._files()}
        self._stamps = dict(self._files())

    def _run_once(self, case: Case, keep: str = "") -> None:
        """Run a case, and import here what it imported."""
        listed = self.folder.parent / "modules"
        outcome = self.run(case, listed, seconds=600.0)
        if outcome.code not in (ExitCode.OK, ExitCode.TESTS_FAILED) or outcome.fault:
            raise SystemExit(f"error: `tmd {' '.join(case.arguments)}` fails undamaged: {outcome}")
        for name in listed.read_text().split():
            if not name.startswith(("__", "experiments")):
                with contextlib.suppress(Exception):
                    import_module(name)
        if keep:
            shutil.copy(self.folder.parent / "stdout", self.folder / keep)

    def _files(self) -> dict[str, tuple[int, int]]:
        """Every file, with what changes when it is written."""
        found = {}
        start = len(os.fspath(self.folder)) + 1
        waiting = [os.fspath(self.folder)]
        while waiting:
            for entry in os.scandir(waiting.pop()):
                if entry.is_dir(follow_symlinks=False):
                    waiting.append(entry.path)
                else:
                    status = entry.stat(follow_symlinks=False)
                    found[entry.path[start:]] = (status.st_mtime_ns, status.st_size)
        return found

    def changed(self) -> Iterator[str]:
        """The names of files that are not as they were, or are new, or gone."""
        now = self._files()
        yield from (name for name in now.keys() | self._stamps.keys() if now.get(name) != self._stamps.get(name))

    def restore(self) -> None:
        """Undo the damage."""
        for name in sorted(self.changed()):
            path = self.folder / name
            if name not in self.kept:
                with contextlib.suppress(OSError):
                    path.unlink()
                continue
            for above in reversed([p for p in path.parents if p.is_relative_to(self.folder)]):
                if not above.is_dir() or above.is_symlink():
                    with contextlib.suppress(OSError):
                        above.unlink()
                    above.mkdir(exist_ok=True)
            if path.is_symlink() or path.is_dir():
                shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()
            path.write_bytes(self.kept[name])
            os.utime(path, ns=(self._stamps[name][0], self._stamps[name][0]))
        for path in sorted(self.folder.rglob("*"), reverse=True) if self._odd_directories() else ():
            if path.is_dir() and not path.is_symlink() and not any(path.iterdir()):
                path.rmdir()

    def _odd_directories(self) -> bool:
        wanted = {os.path.dirname(name) for name in self.kept}  # noqa: PTH120 - in the innermost loop
        start = len(os.fspath(self.folder)) + 1
        for directory, _, _ in os.walk(self.folder):
            inner = directory[start:]
            if inner and not any(name == inner or name.startswith(f"{inner}/") for name in wanted):
                return True
        return False

    def damage(self, name: str, choose: Random) -> None:
        """Change a file in one to four places."""
        data = self.kept[name]
        json_like = name.endswith((".json", ".jsonl"))
        try:
            changed = damaged_json(data, choose) if json_like and choose.random() < 0.7 else damaged(data, choose)
        except (ValueError, IndexError):
            changed = damaged(data, choose)
        (self.folder / name).write_bytes(changed)

    def run(self, case: Case, list_modules: Path | None = None, *, seconds: float | None = None) -> Outcome:
        """Run a case in a child of this process."""
        before, others = self._files(), _children()
        begun = time.monotonic()
        child = os.fork()
        if child == 0:  # never returns
            code = _DIED
            try:
                code = self._perform(case, SECONDS if seconds is None else seconds)
                if list_modules is not None:
                    list_modules.write_text("\n".join(sys.modules))
            finally:
                os._exit(code)
        _, status = os.waitpid(child, 0)
        return self.judged(case, os.waitstatus_to_exitcode(status), time.monotonic() - begun, before, others)

    def judged(
        self,
        case: Case,
        code: int,
        seconds: float,
        before: Mapping[str, tuple[int, int]],
        others: frozenset[int] = frozenset(),
    ) -> Outcome:
        """What is to be said of a case that has just ended; ``before`` are the files, ``others`` the children then."""
        printed = (self.folder.parent / "stdout").read_bytes()
        told = (self.folder.parent / "stderr").read_bytes().decode("utf-8", "replace")
        fault = _fault(case, code, printed, told) or _survivors(others) or self._left(case, before)
        return Outcome(code, seconds, fault, told)

    def _left(self, case: Case, before: Mapping[str, tuple[int, int]]) -> str:
        """Files that a command has no right to leave behind or to change."""
        after = self._files()
        leftovers = [name for name in after.keys() - before.keys() if _LEFTOVER.search(name)]
        if leftovers:
            return f"left behind: {leftovers[0]}"
        if case.arguments[0] in _WRITERS or any(option in case.arguments for option in _OUTPUTS):
            return ""
        lost = [name for name in before if after.get(name) != before[name]]
        return f"changed: {lost[0]}" if lost else ""

    def batch(
        self, number: int, size: int, make: Callable[[int], tuple[str, Case]], saved: _Saved
    ) -> Iterator[tuple[int, str, Outcome]]:
        """Make, run, judge and undo cases from ``number`` on in one child; fewer than ``size`` where one ends it.

        What commands keep between calls is forgotten from case to case, but for what is part of tmd itself.
        """
        reading, writing = os.pipe()
        others = _children()
        child = os.fork()
        if child == 0:  # never returns
            os.close(reading)
            try:
                _adopt_orphans()
                with os.fdopen(writing, "w") as report:
                    for now in range(number, number + size):
                        if not self._report(report, now, make, saved):
                            break
            finally:
                os._exit(0)
        os.close(writing)
        begun = time.monotonic()
        kind, done, last = "", number - 1, ""
        with os.fdopen(reading) as lines:
            for line in lines:
                if line.startswith("begun "):
                    kind, begun, last = line[6:].strip(), time.monotonic(), "begun"
                    continue
                code, seconds, fault = line.rstrip("\n").split(" ", 2)
                done, last = done + 1, ""
                yield done, kind, Outcome(int(code), float(seconds), fault, "")
        _, status = os.waitpid(child, 0)
        if last:  # it died in a case
            self.restore()
            _, case = make(done + 1)
            code_ = os.waitstatus_to_exitcode(status)
            outcome = self.judged(case, code_ if code_ else _DIED, time.monotonic() - begun, self._files(), others)
            saved(done + 1, case, outcome)
            self.restore()
            yield done + 1, kind, outcome

    def _report(
        self,
        report: IO[str],
        number: int,
        make: Callable[[int], tuple[str, Case]],
        saved: _Saved,
    ) -> bool:
        """One case of a batch; whether the child is still as it was."""
        kind, case = make(number)
        report.write(f"begun {kind}\n")
        report.flush()
        _forget()
        before, variables, begun = self._files(), dict(os.environ), time.monotonic()
        code = self._perform(case, SECONDS)
        signal.setitimer(signal.ITIMER_REAL, 0)
        os.environ.clear()
        os.environ.update(variables)
        outcome = self.judged(case, code, time.monotonic() - begun, before)
        if outcome.fault:
            saved(number, case, outcome)
        self.restore()
        report.write(f"{code} {outcome.seconds:.3f} {outcome.fault}\n")
        report.flush()
        return not (case.hold or outcome.fault or code == ExitCode.GAVE_UP or threading.active_count() > 1)

    def _perform(self, case: Case, seconds: float) -> int:
        """Run a case in this process."""
        try:
            os.chdir(self.folder)
            reading, writing = os.pipe()
            os.set_blocking(writing, False)
            os.write(writing, case.stdin[:60_000])
            os.close(writing)
            names = (self.folder.parent / "stdout", self.folder.parent / "stderr")
            targets = [os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC) for path in names]
            for number, opened in enumerate((reading, *targets)):
                os.dup2(opened, number)
                os.close(opened)
            for number, how in case.streams.items():
                spoilt = _spoilt(how)
                os.dup2(spoilt, number)
                os.close(spoilt)
            sys.stdin, sys.stdout, sys.stderr = (
                open(number, mode, closefd=False)  # noqa: SIM115 - kept
                for number, mode in enumerate("rww")
            )
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            signal.signal(signal.SIGALRM, signal.SIG_DFL)
            signal.setitimer(signal.ITIMER_REAL, seconds)
            if case.hold:
                signal.signal(signal.SIGALRM, lambda *_: os.kill(os.getpid(), signal.SIGTERM))
                signal.setitimer(signal.ITIMER_REAL, LISTENING, seconds)
            for variable in ("XDG_CACHE_HOME", "XDG_STATE_HOME", "HOME"):
                os.environ[variable] = str(self.folder.parent / "cache")
            for name, value in case.environment.items():
                if value is None:
                    os.environ.pop(name, None)
                else:
                    os.environ[name] = value
            code = int(run_tmd(case.arguments))
            for stream in (sys.stdout, sys.stderr):
                with contextlib.suppress(OSError):
                    stream.flush()
            return code
        except BaseException as error:
            with contextlib.suppress(OSError):
                os.write(2, f"Traceback: {error!r}".encode())
            return _DIED


def _adopt_orphans() -> None:
    """What outlives a command is found by waiting for it: its orphans come to this process."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, 1)


def _forget() -> None:
    """Empty the caches of tmd but for those of its own data, which cost a quarter of a second to fill."""
    if not _CACHES:
        for name, module in list(sys.modules.items()):
            if name.startswith("tmd.") and not name.startswith(_KEPT):
                found = (value for value in vars(module).values() if hasattr(value, "cache_clear"))
                _CACHES.extend(cache for cache in found if cache.__module__ == name)
    for cache in _CACHES:
        cache.cache_clear()


def _spoilt(how: str) -> int:
    """A stream that is as :attr:`Case.streams` says; closed ones as :mod:`tmd.cli.output` finds them."""
    if how == "full":
        return os.open("/dev/full", os.O_RDWR)
    if how == "gone":
        reading, writing = os.pipe()
        os.close(reading)
        return writing
    return os.open(os.devnull, os.O_RDWR)


def _children() -> frozenset[int]:
    """The processes whose parent this one is."""
    return frozenset(map(int, Path(f"/proc/{os.getpid()}/task/{os.getpid()}/children").read_text().split()))


def _survivors(others: frozenset[int]) -> str:
    """Whether a process outlived its command; it is ended. ``others`` are children that were there before."""
    deadline = time.monotonic() + PATIENCE
    while children := _children() - others:
        for child in children:  # all were started by the command, whose orphans come to us
            if os.waitpid(child, os.WNOHANG) == (0, 0) and time.monotonic() > deadline:
                for each in children:
                    with contextlib.suppress(ProcessLookupError, ChildProcessError):
                        os.kill(each, signal.SIGKILL)
                        os.waitpid(each, 0)
                return f"{len(children)} processes alive after two seconds"
        time.sleep(0.01)
    return ""


def _fault(case: Case, code: int, printed: bytes, told: str) -> str:
    """What is wrong with how a case ended."""
    if code == -signal.SIGALRM:
        return f"over {SECONDS:.0f} s"
    if code == ExitCode.INTERNAL or "Traceback" in told:
        return "internal error"
    if code not in set(ExitCode):
        return f"code {code}"
    if "site-packages" in told or "Warning:" in told or "Exception ignored" in told:
        return "a line of Python"
    if "--json" in case.arguments and 1 not in case.streams:
        try:
            json.loads(printed)
        except ValueError:
            if code != ExitCode.USAGE or printed:
                return "broken JSON"
    if 2 in case.streams or (code < ExitCode.BAD_INPUT and code != ExitCode.USAGE) or code == ExitCode.INTERRUPTED:
        return ""
    if not told.strip():
        return "no message"
    return "" if "\nhint: " in told or "error: " not in told else "no remedy"


def _write_veil(folder: Path) -> None:
    """A data set in the format of VEIL-500, of one point."""
    objects = (("Mug_1", "(5, 50, 2)"), ("Sink", "(60, 43, 0)"), ("SinkKnob", "-200,-200,-200"))
    room = "".join(
        f"<object><name>{name}</name><position>{place}</position><rotation>(0, 90, 0)</rotation>"
        "<state><statename>Water</statename><statevalue>False</statevalue></state></object>\n"
        for name, place in objects
    )
    (folder / "Environments" / "kitchen").mkdir(parents=True)
    (folder / "Environments" / "kitchen" / "kitchen2.xml").write_text(f"<environment>\n{room}</environment>\n")
    classes = "".join(f"<name>{name}</name>" for name in ("Mug", "Sink", "SinkKnob"))
    state = "<state><stateName>Water</stateName><default>False</default></state>"
    (folder / "Objects.xml").write_text(
        f"<objects>\n<object>{classes}<attributes><property>\n{state}</property>\n"
        "<affordances><affordance>IsGraspable</affordance></affordances></attributes></object>\n</objects>\n"
    )
    (folder / "data.xml").write_text(
        "<root>\n<point>\n<text>Take the mug | to the sink . Wash it .</text>\n"
        "<environment>kitchen_scenario_environment_number_2</environment>\n<objective>Making Ramen</objective>\n"
        "<action_sequence>\n<action>moveto Mug_1</action>\n<action>grasp Mug_1</action>\n<change_of_alignment/>\n"
        "<action>keep Mug_1 On Sink</action>\n</action_sequence>\n</point>\n</root>\n"
    )


def kind_of_failure(case: Case, outcome: Outcome) -> str:
    """A name that failures of one kind share: the same command, fault and words, whatever names they are about."""
    words = re.sub(r"'[^']*'|\"[^\"]*\"|\S*[/.:]\S*|\d+", "", outcome.told.split("error: ", 1)[-1][:300])
    fault = re.sub(r"\W+", "-", outcome.fault.partition(":")[0])
    return f"{fault}-{case.arguments[0].strip('-')}-{crc32(words.encode()):08x}"


def save(workspace: Workspace, case: Case, outcome: Outcome, target: Path, name: str) -> None:
    """Keep the first failure of a kind: the files that differ from the usual ones, the command and what it told."""
    if target.exists():
        return
    target.mkdir(parents=True)
    for file in workspace.changed():
        path = workspace.folder / file
        if path.is_file() and not path.is_symlink():
            try:
                (target / file).parent.mkdir(parents=True, exist_ok=True)
                (target / file).write_bytes(path.read_bytes())
            except OSError as error:  # its name is too long where it goes to
                if error.errno not in (errno.ENAMETOOLONG, errno.ENOTDIR):
                    raise
    told: dict[str, object] = {"case": name, "arguments": case.arguments, "streams": dict(case.streams)}
    told |= {
        "environment": dict(case.environment),
        "code": outcome.code,
        "fault": outcome.fault,
        "seconds": round(outcome.seconds, 1),
    }
    told |= {"told": outcome.told[-2_000:]}
    (target / "case.json").write_text(json.dumps(told, indent=1) + "\n")
    (target / "stdin").write_bytes(case.stdin)
