"""Whole problems by planners that are processes: what they find, and what becomes of those that hang, die or rave."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest

from tmd.diagnostics import PlannerError, TmdError
from tmd.pddl.model import Problem
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.task import Task
from tmd.pddl.validator import validate
from tmd.planning import processes, up_planners
from tmd.planning.backends import solve
from tmd.planning.gap_filler import GapFiller
from tmd.planning.result import Filled, GaveUp, Solved, Unreachable
from tmd.planning.up_planners import EngineSpec, solve_with_engine

if find_spec("up_fast_downward") is None:
    pytest.skip("Fast Downward is not installed", allow_module_level=True)

ALIKE = """
(define (domain shelves)
  (:requirements :strips :typing :negative-preconditions)
  (:types place thing)
  (:predicates (at ?x - thing ?p - place) (held ?x - thing) (take ?x - thing))
  (:action take
    :parameters (?x - thing ?p - place) :precondition (at ?x ?p) :effect (and (held ?x) (take ?x) (not (at ?x ?p))))
  (:action place
    :parameters (?x - thing ?p - place) :precondition (held ?x) :effect (and (at ?x ?p) (not (held ?x)))))
"""
"""An action and a predicate named take, an action and a type named place, a type and an object named thing."""
ALIKE_PROBLEM = """
(define (problem one) (:domain shelves)
  (:objects place left right - place thing book - thing) (:init (at thing left) (at book left))
  (:goal (and (at thing right) (at book place))))
"""
LAMP = """
(define (domain lamp) (:predicates (lit) (warm) (on) (off))
  (:action light :effect (and (lit) (not (warm))))
  (:action switch_on :precondition (off) :effect (and (on) (not (off))))
  (:action switch_off :precondition (on) :effect (and (off) (not (on)))))
"""
NEVER = "no state can satisfy the goal: it contradicts itself or what never changes"


@pytest.fixture
def alike() -> Problem:
    return parse_problem(ALIKE_PROBLEM, parse_domain(ALIKE))


def lamp(goal: str) -> Problem:
    return parse_problem(f"(define (problem dark) (:domain lamp) (:init (off)) (:goal {goal}))", parse_domain(LAMP))


@pytest.mark.parametrize("planner", ["auto", "fast-downward", "kairos", "in-process", "up:fast-downward"])
def test_one_name_for_two_kinds_is_planned_with(alike: Problem, planner: str) -> None:
    if planner == "kairos":
        pytest.importorskip("kairos")
    answer = solve(alike, planner)
    assert isinstance(answer, Solved) and validate(alike, answer.plan).valid


@pytest.mark.parametrize("planner", ["auto", "fast-downward"])
@pytest.mark.parametrize(
    ("condition", "steps"),
    [
        (
            "(exists (?a ?b ?c ?d ?e) (and (in ?a) (in ?b) (not (= ?a ?b)) (= ?c ?b) (in ?d) (not (= ?c ?d)) (in ?e)))",
            3,
        ),
        ("(not (forall (?a ?b ?c ?d ?e) (or (not (in ?a)) (= ?a ?b) (= ?b ?c) (not (in ?c)) (= ?c ?d) (in ?e))))", 2),
        ("(exists (?a ?b ?c ?d ?e) (and (in ?a) (= ?a ?b) (= ?b ?c) (= ?c ?d) (= ?d ?e) (not (= ?e ?a))))", None),
    ],
)
def test_a_condition_on_five_of_75_things_is_planned_for_at_once(
    planner: str, condition: str, steps: int | None
) -> None:
    text = f"""(define (domain many) (:requirements :adl :derived-predicates) (:predicates (in ?x) (ready) (may))
      (:derived (may) {condition})
      (:action fill :parameters (?x) :effect (in ?x))
      (:action go :parameters () :precondition (and (may) {condition}) :effect (ready)))"""
    things = " ".join(f"i{number}" for number in range(75))
    problem = parse_problem(
        f"(define (problem m) (:domain many) (:objects {things}) (:init) (:goal (ready)))", parse_domain(text)
    )
    answer = solve(problem, planner, seconds=10.0)
    if steps is None:
        assert isinstance(answer, Unreachable)
    else:
        assert isinstance(answer, Solved) and len(answer.plan) <= steps + 1


@pytest.mark.parametrize("planner", ["auto", "kairos", "in-process"])
def test_an_optimal_plan_says_so(pantry: Task, pantry_problem: Problem, planner: str) -> None:
    """With conditional effects, which the landmark cuts of Fast Downward do not take."""
    if planner == "kairos":
        pytest.importorskip("kairos")
    least = GapFiller(pantry).fill(pantry.init, pantry.goal)
    answer = solve(pantry_problem, planner, optimal=True)
    assert isinstance(answer, Solved) and isinstance(least, Filled)
    assert (answer.cost, answer.optimal) == (least.cost, True)


def test_a_plan_that_is_just_found_says_so(pantry_problem: Problem) -> None:
    answer = solve(pantry_problem)
    assert isinstance(answer, Solved) and not answer.optimal


def test_optimal_is_what_an_engine_says_it_is(alike: Problem) -> None:
    answer = solve(alike, "up:fast-downward", optimal=True)
    assert isinstance(answer, GaveUp) and "did not prove" in answer.limit


@pytest.mark.parametrize("optimal", [False, True])
@pytest.mark.parametrize(
    ("goal", "why"),
    [("(warm)", NEVER), ("(and (lit) (not (lit)))", NEVER), ("(and (on) (off))", "(off) and (on) exclude each other")],
)
def test_no_plan_is_proven_with_the_reason(goal: str, why: str, optimal: bool) -> None:
    assert solve(lamp(goal), optimal=optimal) == Unreachable(why)


def test_planners_for_gaps_only_are_no_planners_for_problems(alike: Problem) -> None:
    with pytest.raises(TmdError, match="there is no planner 'in-process-first'"):
        solve(alike, "in-process-first")


# ---------------------------------------------------------------------- planners that misbehave

TRANSLATOR = """
import sys
for name in sys.argv[1:3]:
    open(name).read()
{before}
open(sys.argv[4], "w").write("translated")
print("Translator axioms: 0")
"""


class FakeDownward:
    """A Fast Downward whose search is a shell script."""

    def __init__(self, directory: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.directory = directory
        monkeypatch.setattr("tmd.planning.fast_downward.binaries", lambda: directory)

    def does(self, search: str, translator: str = "") -> None:
        package = self.directory / "fast_downward" / "translate"
        package.mkdir(parents=True)
        (package / "__init__.py").touch()
        (package / "__main__.py").write_text(TRANSLATOR.format(before=translator))
        program = self.directory / "downward"
        program.write_text(f'#!/bin/sh\nplan="$4"\n{search}\n')
        program.chmod(0o755)

    def running(self) -> list[int]:
        """The processes of it that are left."""
        return processes_with(str(self.directory))


def processes_with(text: str) -> list[int]:
    """The running processes with ``text`` in their command or environment."""
    found = []
    for path in Path("/proc").glob("[0-9]*"):
        try:
            told = (path / "cmdline").read_bytes() + (path / "environ").read_bytes()
            state = (path / "stat").read_text().rpartition(")")[2].split()[0]
        except OSError:
            continue
        if text.encode() in told and state != "Z" and int(path.name) != os.getpid():
            found.append(int(path.name))
    return found


def all_gone(text: str, seconds: float = 5.0) -> bool:
    end = time.monotonic() + seconds
    while processes_with(text) and time.monotonic() < end:
        time.sleep(0.05)
    return not processes_with(text)


@pytest.fixture
def fake(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[FakeDownward]:
    downward = FakeDownward(tmp_path, monkeypatch)
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(temporary))
    yield downward
    assert all_gone(str(tmp_path))
    assert list(temporary.iterdir()) == []


@pytest.mark.parametrize(
    ("search", "translator", "told"),
    [
        (
            "echo one; echo two; kill -9 $$",
            "",
            r"was killed by SIGKILL \(out of memory\?\); its last lines: .*one / two",
        ),
        ("kill -SEGV $$", "", r"was killed by SIGSEGV"),
        ("echo 'bad thing' >&2; exit 32", "", r"exit code 32; its last lines: .*bad thing"),
        ("echo hello > $plan; echo Solution found.", "", r"wrote what is no plan.*Solution found"),
        ("echo '(light x)' > $plan", "", r"gave a plan that does not work"),
        ("echo '; nothing' > $plan", "", r"gave a plan that does not work"),
        (
            "true",
            "raise ValueError('cannot read this')",
            r"exit code 1; its last lines: .*ValueError: cannot read this",
        ),
        ("true", "import os; os._exit(31)", r"exit code 31"),
    ],
)
def test_a_planner_that_fails_is_told_in_one_line(fake: FakeDownward, search: str, translator: str, told: str) -> None:
    fake.does(search, translator)
    with pytest.raises(PlannerError, match=f"^Fast Downward .*{told}") as caught:
        solve(lamp("(lit)"), "fast-downward")
    assert "\n" not in caught.value.message and int(caught.value.exit_code) == 35


@pytest.mark.parametrize(
    ("search", "translator", "limit"),
    [
        ("sleep 60", "", "1.2 s"),
        ("sleep 60 & wait", "", "1.2 s"),
        ("true", "import time; time.sleep(60)", "1.2 s"),
        ("exit 22", "", "the memory"),
        ("true", "raise SystemExit(20)", "the memory"),
    ],
)
def test_a_planner_that_hangs_or_runs_out_of_memory_gave_up(
    fake: FakeDownward, search: str, translator: str, limit: str
) -> None:
    fake.does(search, translator)
    answer = solve(lamp("(lit)"), "fast-downward", seconds=1.2)
    assert answer == GaveUp(f"{limit} of Fast Downward")


def test_a_deadline_that_may_end_earlier_keeps_its_name() -> None:
    done: list[None] = []
    deadline = processes.Deadline(60.0)
    earlier = deadline.until(lambda: bool(done))
    assert earlier.seconds == 60.0 and earlier.left() > 0
    done.append(None)
    assert earlier.left() == 0 and deadline.left() > 0


def test_a_planner_that_never_reads_gave_up(fake: FakeDownward) -> None:
    """A text of more than a pipe takes at once, which nobody takes."""
    fake.does("true")
    (fake.directory / "fast_downward" / "translate" / "__main__.py").write_text("import time; time.sleep(60)")
    facts = " ".join(f"(p o{number})" for number in range(20_000))
    things = " ".join(f"o{number}" for number in range(20_000))
    domain = parse_domain("(define (domain d) (:predicates (p ?x) (q)) (:action a :effect (q)))")
    text = f"(define (problem big) (:domain d) (:objects {things}) (:init {facts}) (:goal (q)))"
    assert isinstance(solve(parse_problem(text, domain), "fast-downward", seconds=1.0), GaveUp)


def test_an_unsolvable_problem_is_proven_beside_a_search_without_end(fake: FakeDownward) -> None:
    fake.does("sleep 60")
    assert solve(lamp("(and (on) (off))"), "fast-downward", seconds=50) == Unreachable(
        "(off) and (on) exclude each other"
    )


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_no_planner_outlives_the_program(fake: FakeDownward, number: signal.Signals) -> None:
    fake.does("exec sleep 60")
    domain, problem = fake.directory / "d.pddl", fake.directory / "p.pddl"
    domain.write_text(LAMP)
    problem.write_text("(define (problem dark) (:domain lamp) (:goal (lit)))")
    program = (
        "from pathlib import Path; import tmd.planning.fast_downward as d; import sys\n"
        f"d.binaries = lambda: Path({str(fake.directory)!r})\n"
        "from tmd.cli import main; sys.argv[0] = 'tmd'; main()"
    )
    command = [sys.executable, "-c", program, "plan", str(domain), str(problem), "--planner", "fast-downward"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as running:
        while not any("sleep" in Path(f"/proc/{pid}/comm").read_text() for pid in fake.running()):
            time.sleep(0.05)
        running.send_signal(number)
        _, told = running.communicate()
    assert all_gone(str(fake.directory))
    if number == signal.SIGTERM:
        assert (running.returncode, told) == (130, "error: interrupted\n")


@pytest.mark.parametrize(
    "does",
    [
        "exec sleep 60",
        "kill -SEGV $$",
        "exit 10",
        "exit 11",
        "exit 12",
        "exit 13",
        "exit 14",
        "echo '(light x)'",
        "echo hello",
    ],
)
def test_what_kairos_does_not_solve_fast_downward_is_asked(
    does: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("kairos")
    pytest.importorskip("up_fast_downward")
    program = tmp_path / "kairos"
    program.write_text(f"#!/bin/sh\n{does}\n")
    program.chmod(0o755)
    monkeypatch.setattr("tmd.planning.kairos.program", lambda: str(program))
    answer = solve(lamp("(lit)"), seconds=4.0)
    assert isinstance(answer, Solved) and answer.plan


# ---------------------------------------------------------------------- the processes of unified-planning


@pytest.fixture
def engine(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """Replaces the program of an engine's process."""
    monkeypatch.setattr(up_planners, "GRACE", 1.0)
    return lambda program: monkeypatch.setattr(processes, "_CALL", (sys.executable, "-c", program))


@pytest.mark.parametrize(
    ("program", "why"),
    [
        ("print('rubbish')", "answered what is no JSON"),
        ("print('[rubb')", "answered what is no JSON"),
        ("import os; os.abort()", "was killed by SIGABRT"),
        (
            "import sys; print('no space', file=sys.stderr); exit(3)",
            r"^the planner x ended with the exit code 3; its last lines: no space$",
        ),
    ],
)
def test_an_engine_that_misbehaves(engine: Callable[[str], None], program: str, why: str, alike: Problem) -> None:
    engine(program)
    with pytest.raises(PlannerError, match=why):
        solve_with_engine(alike, EngineSpec("x", time_limit=5.0))


def test_an_engine_that_hangs_gave_up(engine: Callable[[str], None], alike: Problem) -> None:
    engine("import time; time.sleep(60)")
    assert solve_with_engine(alike, EngineSpec("x", time_limit=0.2)) == GaveUp("0.2 s of x")


def test_what_an_engine_started_in_a_session_of_its_own_ends_with_it(
    engine: Callable[[str], None], alike: Problem, tmp_path: Path
) -> None:
    text = f"sleep 60; : {tmp_path}"
    engine(
        f"import subprocess; subprocess.Popen(['sh', '-c', {text!r}], start_new_session=True)\n"
        """print('{"status": "TIMEOUT"}')"""
    )
    assert isinstance(solve_with_engine(alike, EngineSpec("x", time_limit=10.0)), GaveUp)
    assert all_gone(str(tmp_path))


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_no_engine_outlives_the_program(alike: Problem, tmp_path: Path, number: signal.Signals) -> None:
    """Neither its directory nor what it has started in a session of its own."""
    engine = (
        "import subprocess, time\n"
        f"subprocess.Popen(['sleep', '60'], start_new_session=True, cwd={str(tmp_path)!r}); time.sleep(60)"
    )
    program = (
        f"import sys, tempfile; from tmd.planning import processes; tempfile.tempdir = {str(tmp_path)!r}\n"
        f"processes._CALL = (sys.executable, '-c', {engine!r})\n"
        "from tmd.cli import main; sys.argv[0] = 'tmd'; main()"
    )
    domain, problem = tmp_path / "d.pddl", tmp_path / "p.pddl"
    domain.write_text(LAMP)
    problem.write_text("(define (problem dark) (:domain lamp) (:goal (lit)))")
    command = [sys.executable, "-c", program, "plan", str(domain), str(problem), "--planner", "up:x"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as running:
        while not any("sleep" in Path(f"/proc/{pid}/comm").read_text() for pid in processes_with(str(tmp_path))):
            time.sleep(0.05)
        running.send_signal(number)
        running.communicate()
    assert all_gone(str(tmp_path))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["d.pddl", "p.pddl"]


def test_the_limit_holds_for_the_replay_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """A replay that never ends is stopped a second after the limit, and so is reading."""

    def replay(*_: object) -> None:
        while True:
            time.sleep(0.01)

    monkeypatch.setattr("tmd.pddl.validator.validate", replay)
    problem = parse_problem(ALIKE_PROBLEM, parse_domain(ALIKE))
    begin = time.monotonic()
    answer = solve(problem, seconds=0.3)
    assert isinstance(answer, GaveUp) and "0.3 s" in answer.limit
    assert time.monotonic() - begin < 2.3
    with pytest.raises(processes.TimeIsUpError), processes.limited(processes.Deadline(0)):
        replay()
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)
