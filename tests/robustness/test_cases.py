"""What ever hung, ended in an internal error, left something behind or gave no remedy, so that it does not again."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.cli.conftest import ROOT, Tmd, heed_interrupts
from tests.cli.test_exit_codes import counter
from tmd.diagnostics import ExitCode

PROBLEM = ROOT / "problems" / "04_tea" / "p01-tea-pantry1.pddl"
PANTRY = ("--environment", "pantry1", "--text", "Heat the kettle.")
REMEDY = re.compile(r"error: .+\n(?:.*\n){0,2}hint: \S.+\n")


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="there is no /dev/zero here")
@pytest.mark.parametrize(
    "arguments",
    [
        ("check", "/dev/zero"),
        ("plan", "/dev/zero", PROBLEM, "--planner", "in-process"),
        ("parse", "--text-file", "/dev/zero"),
        ("parse", "--text-file", "-"),
        ("view", "-"),
        ("run", "--environment", "kitchen1", "--text", "Take the pot.", "--urdf", "/dev/zero"),
    ],
)
def test_a_file_without_end_is_not_read_to_its_end(
    tmd: Tmd, arguments: tuple[str | Path, ...], request: pytest.FixtureRequest
) -> None:
    if "run" in arguments:
        pytest.importorskip("pybullet")
        request.getfixturevalue("learned")  # the kitchen is
    before = "import os; os.dup2(os.open('/dev/zero', os.O_RDONLY), 0)"
    ended = tmd(*arguments, before=before)
    assert ended.code in (ExitCode.BAD_INPUT, ExitCode.FAULTS_FOUND)
    assert "larger than 100 MB" in ended.out + ended.err


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"event": {}}, r"event: should be one of plan"),
        ({"environment_file": ""}, r"the environment is not there any more"),
        ({"environment_file": "/"}, r"the environment / is not there any more"),
    ],
)
def test_a_log_that_names_nothing(tmd: Tmd, tmp_path: Path, change: dict[str, object], told: str) -> None:
    plan = {
        "event": "plan", "text": "Take the pot.", "domain": "kitchen", "environment": "kitchen1", "mode": "kinematic",
        "seed": 0, "planner": "in-process", "plan": [], "version": "0.1.0",
        "environment_file": None, "strip": None, "grounding": None,
    }  # fmt: skip
    (tmp_path / "log.jsonl").write_text(json.dumps(plan | change) + "\n")
    ended = tmd("view", "log.jsonl")
    assert ended.code == ExitCode.BAD_INPUT
    assert re.search(told, ended.err), ended.err
    assert REMEDY.search(ended.err)


@pytest.mark.parametrize(
    "arguments",
    [
        ("ground", *PANTRY, "--beam", "9" * 400),
        ("plan", "04_tea", PROBLEM, "--time-limit", "nan"),
        ("plan", "04_tea", PROBLEM, "--memory-limit", "9" * 400),
        ("export", PROBLEM, "out", "--memory-limit", "1"),
    ],
)
def test_numbers_that_nobody_means(tmd: Tmd, arguments: tuple[str | Path, ...]) -> None:
    ended = tmd(*arguments)
    assert ended.code == ExitCode.USAGE
    assert REMEDY.search(ended.err)


CONTENTS = {
    "bad.sentences.jsonl": '{"id": 1,\n',
    "demonstrations.jsonl": '{"id": [], "task": "a", "environment": "pantry1", "text": "x", "segments": []}\n',
    "bad.plan": "(grasp cup?)\n",
    "room.xml": "<environment></environment>\n",
    "list.yaml": "- a\n",
    "plan.json": "[1\n",
    "open.pddl": "(define (domain d)\n",
    "bell.yaml": "name: x\nobjects:\n  a\x07: {}\n",
    "dark.pddl": "(define (problem p) (:domain d) ups)\n",
}


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("test", "--cases", "bad.sentences.jsonl"), r"bad\.sentences\.jsonl:1:10: this is not valid JSON"),
        (("view", "demonstrations.jsonl"), r"demonstrations\.jsonl is JSON of no kind that can be shown"),
        (("validate", "04_tea", PROBLEM, "bad.plan"), r'bad\.plan:1:8: "cup\?" is not a name'),
        (("view", "bad.plan"), r"for the plan bad\.plan give one of --problem and --environment"),
        (("ground", "--environment", "room.xml", "--text", "x"), r"room.xml"),
        (("ground", "--environment", "list.yaml", "--text", "x"), r"list\.yaml:1:1: the file: should be a mapping"),
        (("export", "plan.json", "out"), r"plan\.json:2:1: this is not valid JSON"),
        (("fmt", "open.pddl"), r"open\.pddl:1:1: .* is never closed"),
        (("plan", "04_tea", "dark.pddl", "--planner", "in-process"), r"dark\.pddl:1:\d+: "),
        (("compile", "nothing.yaml"), r"nothing\.yaml:1:1: cannot be read: No such file"),
    ],
)
def test_every_error_has_its_place_and_a_remedy(
    tmd: Tmd, tmp_path: Path, arguments: tuple[str | Path, ...], told: str
) -> None:
    for name, text in CONTENTS.items():
        (tmp_path / name).write_text(text)
    ended = tmd(*arguments)
    assert ended.code == ExitCode.BAD_INPUT or ended.code == ExitCode.USAGE
    assert re.search(f"error: .*{told}", ended.err), ended.err
    assert REMEDY.search(ended.err), ended.err
    assert "Input should" not in ended.err


# ---------------------------------------------------------------------- limits, signals, what is left behind


def wide(directory: Path) -> tuple[Path, Path]:
    """A problem that is too large to be ground: an action of 30 parameters and 30 objects."""
    domain, problem = directory / "wide.pddl", directory / "p.pddl"
    parameters, things = (" ".join(f"{letter}{n}" for n in range(30)) for letter in ("?x", "o"))
    domain.write_text(
        f"(define (domain w) (:predicates (p ?x)) (:action a :parameters ({parameters}) :effect (p ?x0)))"
    )
    problem.write_text(f"(define (problem q) (:domain w) (:objects {things}) (:init) (:goal (and (p o1) (p o2))))")
    return domain, problem


@pytest.mark.parametrize(
    ("planner", "told"),
    [
        ("fast-downward", r"no plan: the planner gave up at 100 MB of Fast Downward; nothing is proven\n"),
        ("in-process", r"error: grounding needs more than 500,000 combinations of objects\nhint: .*\n"),
    ],
)
def test_what_is_too_large_gives_up_within_its_memory(tmd: Tmd, tmp_path: Path, planner: str, told: str) -> None:
    if planner == "fast-downward":
        pytest.importorskip("up_fast_downward")
    ended = tmd("plan", *wide(tmp_path), "--planner", planner, "--memory-limit", "100")
    assert ended.code == ExitCode.GAVE_UP
    assert re.fullmatch(told, ended.err), ended.err


@pytest.mark.parametrize("planner", ["fast-downward", "kairos", "in-process", "up:fast-downward"])
def test_a_small_problem_needs_no_more_than_the_least_limit_of_memory(tmd: Tmd, tmp_path: Path, planner: str) -> None:
    pytest.importorskip({"kairos": "kairos", "in-process": "tmd"}.get(planner, "up_fast_downward"))
    ended = tmd("plan", *counter(tmp_path, 4), "--planner", planner, "--memory-limit", "100")
    assert (ended.code, ended.err) == (ExitCode.OK, "")


def started(arguments: list[str], cwd: Path, **variables: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "tmd", *arguments],
        cwd=cwd,
        env={**os.environ, "PYTHONPATH": str(ROOT), **variables},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=heed_interrupts,
    )


def test_the_search_in_this_process_heeds_its_time_limit_and_signals(tmp_path: Path) -> None:
    """Compiled code hears of neither."""
    domain, problem = map(str, counter(tmp_path, 22))
    limited = started(["plan", domain, problem, "--planner", "in-process", "--time-limit", "1"], tmp_path)
    stopped = started(["plan", domain, problem, "--planner", "in-process"], tmp_path)
    try:
        _, told = limited.communicate(timeout=60)
        assert (limited.returncode, told) == (
            ExitCode.GAVE_UP,
            "no plan: the planner gave up at 1 s of in-process; nothing is proven\n",
        )
        stopped.send_signal(signal.SIGTERM)
        _, told = stopped.communicate(timeout=30)
        assert (stopped.returncode, told) == (ExitCode.INTERRUPTED, "error: interrupted\n")
    finally:
        limited.kill()
        stopped.kill()


def _stop(process: subprocess.Popen[str], number: signal.Signals) -> tuple[str, str]:
    """Send a signal until the process ends; return its output.

    Python notes a signal that comes just before a blocking read, and acts on it after the read. The next one interrupts
    the read.
    """
    for _ in range(6):
        process.send_signal(number)
        with suppress(subprocess.TimeoutExpired):
            return process.communicate(timeout=10)
    raise AssertionError(f"the process does not end by {number.name}")


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
def test_every_command_ends_by_a_signal_with_a_code(tmp_path: Path, number: signal.Signals) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    process = started(["parse", "--text-file", "pipe"], tmp_path)
    writer = os.open(pipe, os.O_WRONLY)  # returns when tmd has begun to read
    try:
        out, err = _stop(process, number)
    finally:
        os.close(writer)
        process.kill()
    assert (process.returncode, out, err) == (ExitCode.INTERRUPTED, "", "error: interrupted\n")


def marked(value: str) -> list[int]:
    """The processes with a variable of that value in their environment that still run."""
    found = []
    for path in Path("/proc").glob("[0-9]*/environ"):
        try:
            if f"TMD_TEST={value}".encode() in path.read_bytes().split(b"\0"):
                found.append(int(path.parent.name))
        except OSError:
            continue
    return found


@pytest.mark.skipif(sys.platform != "linux", reason="needs /proc")
@pytest.mark.parametrize("planner", ["up:fast-downward", "fast-downward"])
def test_a_killed_planning_leaves_no_process_and_no_file(tmp_path: Path, planner: str) -> None:
    if find_spec("up_fast_downward") is None:
        pytest.skip("Fast Downward is not installed")
    domain, problem = map(str, counter(tmp_path, 22))
    temporary = tmp_path / "tmp"
    temporary.mkdir()
    name = f"{planner}-{os.getpid()}"
    process = started(["plan", domain, problem, "--planner", planner], tmp_path, TMPDIR=str(temporary), TMD_TEST=name)
    deadline = time.monotonic() + 60
    while len(marked(name)) < (3 if planner.startswith("up:") else 2) and time.monotonic() < deadline:
        time.sleep(0.05)
    process.kill()
    process.communicate()
    _all_end(name)
    if list(temporary.iterdir()):  # killed before anything watched over it: the next run removes what is left
        (tmp_path / "next").mkdir()
        small = map(str, counter(tmp_path / "next", 2))
        started(["plan", *small, "--planner", planner], tmp_path, TMPDIR=str(temporary)).communicate()
    assert not list(temporary.iterdir())


def _all_end(name: str) -> None:
    deadline = time.monotonic() + 10  # two seconds on a machine that is not busy
    while marked(name) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not marked(name)


@pytest.mark.skipif(sys.platform != "linux", reason="needs /proc")
def test_a_killed_experiment_leaves_no_worker(tmp_path: Path) -> None:
    name = f"experiment-{os.getpid()}"
    command = ["experiment", "--task", "tea", "--domain", "04_tea", "--models", "empty,chance", "--out", "run"]
    process = started([*command, "--jobs", "2"], tmp_path, TMD_TEST=name)
    deadline = time.monotonic() + 60
    while len(marked(name)) < 4 and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.02)  # the program, what watches it, two workers: not long after they were started
    process.kill()
    process.communicate()
    _all_end(name)


def test_nobody_reads_the_table(tmp_path: Path) -> None:
    command = ["experiment", "--task", "tea", "--domain", "04_tea", "--models", "empty", "--out", "run", "--jobs", "1"]
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(
        [sys.executable, "-m", "tmd", *command],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=writing,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    os.close(writing)
    assert (done.returncode, "Traceback" in done.stderr) == (ExitCode.OK, False)
    assert (tmp_path / "run" / "report.html").exists()
