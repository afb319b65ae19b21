"""Every documented exit code, provoked by a real command; every command says in one line what is wrong."""

from __future__ import annotations

import errno
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import BLOCKS, ROOT, Ended, Tmd, heed_interrupts
from tmd.cli.errors import fault_of
from tmd.diagnostics import ExitCode

DOMAIN, PROBLEM = BLOCKS / "domain.pddl", BLOCKS / "p01.pddl"
PLANS = BLOCKS / "plans"
HIDE_FAST_DOWNWARD = "import sys; sys.modules['up_fast_downward'] = None"
HIDE_UNIFIED_PLANNING = "import sys; sys.modules['unified_planning'] = None"
LOWER_CAP = "import tmd.planning.backends; tmd.planning.backends.PLAN_CAP = 2000"  # the usual one takes half a minute
BREAK_PARSER = (
    "import tmd.language\ndef parse(*_): raise ZeroDivisionError('division by zero')\ntmd.language.parse = parse"
)
KITCHEN = ("ground", "--environment", "kitchen1")


def documented() -> dict[str, int]:
    """The table in the page."""
    page = (ROOT / "docs" / "exit-codes.md").read_text(encoding="utf-8")
    return {name: int(code) for code, name in re.findall(r"^\| (\d+) \| `(\w+)` \|", page, re.MULTILINE)}


def test_the_page_lists_the_codes() -> None:
    assert documented() == {code.name: int(code) for code in ExitCode}


def counter(directory: Path, bits: int = 20) -> tuple[Path, Path]:
    """A problem whose only plan has 2 ** bits - 1 steps."""
    names = [f"b{i}" for i in range(bits)]
    actions = "".join(
        f"(:action up{i} :precondition (and (not (one b{i})) {' '.join(f'(one {b})' for b in names[:i])})\n"
        f" :effect (and (one b{i}) {' '.join(f'(not (one {b}))' for b in names[:i])}))\n"
        for i in range(bits)
    )
    domain, problem = directory / "counter.pddl", directory / "count.pddl"
    domain.write_text(
        "(define (domain counter) (:requirements :strips :typing :negative-preconditions) (:types bit)\n"
        f"(:constants {' '.join(names)} - bit) (:predicates (one ?b - bit))\n{actions})\n"
    )
    goal = " ".join(f"(one {b})" for b in names)
    problem.write_text(f"(define (problem count) (:domain counter) (:goal (and {goal})))\n")
    return domain, problem


CASES = {
    "help": (ExitCode.OK, ["--help"], ""),
    "parse": (ExitCode.OK, ["parse", "--text", "take the cup"], ""),
    "parse-no-clause": (ExitCode.OK, ["parse", "--text", "Bonjour, je voudrais une tasse"], ""),
    "valid-plan": (ExitCode.OK, ["validate", DOMAIN, PROBLEM, PLANS / "valid-sussman.plan"], ""),
    "plan": (ExitCode.OK, ["plan", DOMAIN, PROBLEM], ""),
    "compiled": (ExitCode.OK, ["compile", "kitchen"], ""),
    "invalid-plan": (ExitCode.INVALID_PLAN, ["validate", DOMAIN, PROBLEM, PLANS / "invalid-not-clear.plan"], ""),
    "unknown-verb": (
        ExitCode.NOT_GROUNDED,
        [*KITCHEN, "--text", "Flurble the pot"],
        r"no plan: .*unknown verb 'flurble'",
    ),
    "not-english": (
        ExitCode.NOT_GROUNDED,
        [*KITCHEN, "--text", "Bonjour, je voudrais une tasse de café s'il vous plaît"],
        r"no plan: the text has no instruction \(.*not English\); say what is to be done",
    ),
    "no-instruction": (ExitCode.NOT_GROUNDED, [*KITCHEN, "--text", "!?"], r"no plan: the text has no instruc"),
    "chatter": (
        ExitCode.NOT_GROUNDED,
        [*KITCHEN, "--text", "hello there"],
        r"no plan: the text has no instruction; say what",
    ),
    "no-such-thing": (
        ExitCode.NOT_GROUNDED,
        [*KITCHEN, "--text", "Take the unicorn"],
        r"no plan: .*nothing here is called 'unicorn'",
    ),
    "cannot-be-here": (
        ExitCode.NOT_GROUNDED,
        ["ground", "--domain", "02_table", "--environment", "corner1", "--text", "Put the table on the shelf"],
        r"no plan: .*'Put the table on the shelf' cannot be done here: ",
    ),
    "contradiction": (
        ExitCode.NOT_GROUNDED,
        ["ground", "--domain", "03_drawer", "--environment", "study1", "--text", "Open the drawer and leave it closed"],
        r"no plan: .*contradicts what was said before",
    ),
    "no-command": (ExitCode.USAGE, ["bogus"], r"error: there is no command 'bogus'"),
    "no-option": (ExitCode.USAGE, ["--bogus"], r"error: No such option"),
    "no-argument": (ExitCode.USAGE, ["plan", DOMAIN], r"error: Missing argument 'PROBLEM'"),
    "no-text": (ExitCode.USAGE, [*KITCHEN], r"error: give one of REQUEST, --text and --text-file"),
    "two-texts": (ExitCode.USAGE, ["parse", "--text", "a", "--text-file", "b"], r"error: give one of"),
    "bad-range": (
        ExitCode.USAGE,
        ["experiment", "--task", "ramen", "--out", "o", "--train-environments", "8-1"],
        r"error: .*the range 8-1 runs backwards",
    ),
    "bad-top": (ExitCode.USAGE, [*KITCHEN, "--text", "a", "--top", "0"], r"error: Invalid value for '--top'"),
    "goal-of-domain": (ExitCode.USAGE, ["compile", "kitchen", "--goal", "(a)"], r"error: --output and --goal are for"),
    "empty-text": (ExitCode.BAD_INPUT, [*KITCHEN, "--text", " \n\t"], r"error: the request: the text is empty"),
    "empty-text-parse": (ExitCode.BAD_INPUT, ["parse", "--text", ""], r"error: the request: the text is empty"),
    "no-environment": (
        ExitCode.BAD_INPUT,
        ["ground", "--environment", "kitchen9", "--text", "a"],
        r"error: there is no environment 'kitchen9'\nhint: ",
    ),
    "no-environment-file": (
        ExitCode.BAD_INPUT,
        ["ground", "--environment", "none.yaml", "--text", "a"],
        r"error: none.yaml:1:1: cannot be read: No such file",
    ),
    "no-domain": (ExitCode.BAD_INPUT, ["compile", "kitchn"], r'error: .*kitchn.*\nhint: did you mean "kit'),
    "nothing-to-compile": (ExitCode.BAD_INPUT, ["compile", "veil500_sane"], r"error: there is nothing to compile in"),
    "no-domains": (ExitCode.BAD_INPUT, ["--domains", "none", "plan", "kitchen", PROBLEM], r"error: none: no such dir"),
    "no-planner": (
        ExitCode.BAD_INPUT,
        ["plan", DOMAIN, PROBLEM, "--planner", "slow-upward"],
        r"error: there is no planner 'slow-upward'\nhint: planners: auto, fast-downward, kairos, in-process, up:ENGINE",
    ),
    "no-weights": (ExitCode.BAD_INPUT, [*KITCHEN, "--text", "a", "--weights", "hand"], r"error: there are no weights"),
    "no-task": (
        ExitCode.BAD_INPUT,
        ["experiment", "--task", "rmen", "--out", "o"],
        r'error: .*\nhint: did you mean "ra',
    ),
    "no-model": (
        ExitCode.BAD_INPUT,
        ["experiment", "--task", "ramen", "--out", "o", "--models", "empt"],
        r"error: there is no model 'empt'\nhint: ",
    ),
    "problem-as-plan": (ExitCode.BAD_INPUT, ["validate", DOMAIN, PROBLEM, PROBLEM], r"error: .*p01.pddl:\d+:\d+: .+\n"),
    "other-domain": (ExitCode.BAD_INPUT, ["plan", "kitchen", PROBLEM], r'error: .*the problem is of domain "'),
    "bad-goal": (
        ExitCode.BAD_INPUT,
        ["compile", ROOT / "problems/kitchen/environments/kitchen1.yaml", "--goal", "(hot pot12)"],
        r'error: --goal:1:\d+: unknown object "pot12"\n.*\n *\^\nhint: did you mean "pot1"',
    ),
    "named-twice": (
        ExitCode.USAGE,
        ["ground", DOMAIN, PROBLEM, "--environment", PROBLEM, "--text", "a"],
        r"error: name each file once: DOMAIN PROBLEM, or --domain and ENVIRONMENT; quote a request\n",
    ),
    "other-data": (
        ExitCode.BAD_DATA,
        ["experiment", "--task", "ramen", "--data", "veil500", "--veil500", ROOT / "domains", "--out", "o"],
        r"error: .*data.xml is missing\nhint: ",
    ),
    "no-data-for-experiment": (
        ExitCode.BAD_DATA,
        ["experiment", "--task", "ramen", "--data", "veil500", "--veil500", "none", "--out", "o"],
        r"error: none is not a directory",
    ),
    "no-directory": (
        ExitCode.CANNOT_WRITE,
        ["plan", DOMAIN, PROBLEM, "--output", "none/out.plan"],
        r"error: none/out.plan cannot be written: No such file or directory\nhint: ",
    ),
    "file-for-directory": (
        ExitCode.CANNOT_WRITE,
        ["experiment", "--task", "tea", "--domain", "04_tea", "--models", "empty", "--out", PROBLEM],
        r"error: .*p01.pddl",
    ),
}


@pytest.mark.parametrize(("code", "arguments", "told"), CASES.values(), ids=list(CASES))
def test_exit_code(tmd: Tmd, tmp_path: Path, code: ExitCode, arguments: list[str | Path], told: str) -> None:
    ended = tmd(*arguments, env={"VEIL500_DIR": ""})
    assert (ended.code, ended.err) == (code, ended.err)
    assert re.search(told, ended.err), ended.err
    _no_traceback(ended)
    assert not list(tmp_path.iterdir())


def _no_traceback(ended: Ended) -> None:
    assert "Traceback" not in ended.out + ended.err
    assert sum(line.startswith("error:") for line in ended.err.splitlines()) <= 1
    if ended.code == ExitCode.USAGE or ended.code >= 30:
        assert ended.out == ""
        assert ended.err.startswith("error: ")


def test_unreachable(tmd: Tmd, tmp_path: Path) -> None:
    domain, problem = counter(tmp_path, 2)
    problem.write_text(problem.read_text().replace("(one b0)", "(one b0) (not (one b0))"))
    ended = tmd("plan", domain, problem)
    assert (ended.code, ended.out) == (ExitCode.UNREACHABLE, "")
    assert re.fullmatch(r"no plan: .+\n", ended.err)


def test_gave_up(tmd: Tmd, tmp_path: Path) -> None:
    ended = tmd("plan", *counter(tmp_path), "--planner", "in-process", before=LOWER_CAP)
    assert (ended.code, ended.out) == (ExitCode.GAVE_UP, "")
    assert re.fullmatch(r"no plan: the planner gave up at .*; nothing is proven\n", ended.err)


@pytest.mark.parametrize("planner", ["fast-downward", "kairos"])
def test_a_time_limit(tmd: Tmd, tmp_path: Path, planner: str) -> None:
    pytest.importorskip({"fast-downward": "up_fast_downward"}.get(planner, planner))
    ended = tmd("plan", *counter(tmp_path), "--planner", planner, "--time-limit", "0.5", "--json")
    assert ended.code == ExitCode.GAVE_UP
    assert re.fullmatch(r"no plan: the planner gave up at 0.5 s of .*; nothing is proven\n", ended.err)
    told = json.loads(ended.out)
    assert (told["status"], told["plan"], told["optimal"]) == ("gave_up", None, None)


def test_planner_failed(tmd: Tmd) -> None:
    pytest.importorskip("up_fast_downward")
    broken = "import tmd.planning.fast_downward as d; d.FIRST = 'no_such_search()'"
    ended = tmd("plan", DOMAIN, PROBLEM, "--planner", "fast-downward", before=broken)
    assert (ended.code, ended.out) == (ExitCode.PLANNER_FAILED, "")
    assert re.match(r"error: Fast Downward ended with the exit code 33; its last lines: .*no_such_search", ended.err)
    _no_traceback(ended)


def test_optimal_or_found(tmd: Tmd) -> None:
    pytest.importorskip("up_fast_downward")
    found, best = (tmd("plan", DOMAIN, PROBLEM, *options) for options in ((), ("--optimal",)))
    assert found.out.startswith("; found: a cheaper plan may exist\n(") and found.code == ExitCode.OK
    assert best.out.startswith("; optimal: no plan is cheaper\n(") and best.code == ExitCode.OK


def test_no_pygls(tmd: Tmd) -> None:
    ended = tmd("lsp", before="import sys; sys.modules['pygls'] = None")
    assert (ended.code, ended.out) == (ExitCode.MISSING_TOOL, "")
    expected = "error: the language server needs the package pygls\nhint: pip install 'tell-me-dave[editor]'\n"
    assert ended.err == expected


def test_out_of_memory(tmd: Tmd) -> None:
    broken = BREAK_PARSER.replace("ZeroDivisionError('division by zero')", "MemoryError")
    ended = tmd("parse", "--text", "take the cup", before=broken)
    assert ended.code == ExitCode.GAVE_UP
    assert ended.err.startswith("error: out of memory\nhint: ")


GROUND = [*KITCHEN, "--text", "fill the pot with water"]


@pytest.mark.parametrize(
    ("arguments", "hidden"),
    [
        (["plan", DOMAIN, PROBLEM], HIDE_FAST_DOWNWARD),
        (GROUND, HIDE_FAST_DOWNWARD),
        (GROUND, HIDE_UNIFIED_PLANNING),  # which is not between whole problems and Fast Downward
    ],
)
def test_no_fast_downward(tmd: Tmd, hidden: str, arguments: list[str | Path]) -> None:
    ended = tmd(*arguments, "--planner", "fast-downward", before=hidden)
    assert ended.code == ExitCode.MISSING_TOOL
    assert re.match(r"error: .*not installed\nhint: pip install ", ended.err)


def test_no_other_engine(tmd: Tmd) -> None:
    ended = tmd("plan", DOMAIN, PROBLEM, "--planner", "up:nosuchengine")
    assert ended.code == ExitCode.MISSING_TOOL
    assert "nosuchengine" in ended.err
    _no_traceback(ended)


def test_drifted_domain(tmd: Tmd, tmp_path: Path) -> None:
    folder = tmp_path / "domains" / "kitchen"
    folder.mkdir(parents=True)
    for file in (ROOT / "domains" / "kitchen").iterdir():
        if file.is_file():
            (folder / file.name).write_bytes(file.read_bytes())
    compiled = folder / "domain.pddl"
    right = compiled.read_text()
    compiled.write_text(right.replace("(:predicates", "(:predicates (new_one)"))
    assert tmd("compile", "kitchen").out.endswith("domain.pddl written\n")
    assert compiled.read_text() == right
    assert tmd("compile", "kitchen").out.endswith("domain.pddl was up to date\n")


def test_internal_error(tmd: Tmd) -> None:
    ended = tmd("parse", "--text", "take the cup", before=BREAK_PARSER)
    assert ended.code == ExitCode.INTERNAL
    assert ended.err.splitlines()[0] == ("error: internal error: ZeroDivisionError: division by zero; please report")
    _no_traceback(ended)


def test_internal_error_in_debugging(tmd: Tmd) -> None:
    ended = tmd("--debug", "parse", "--text", "take the cup", before=BREAK_PARSER)
    assert ended.code == ExitCode.INTERNAL
    assert "Traceback" in ended.err


def test_sentence_tests(tmd: Tmd, tmp_path: Path) -> None:
    line = '{"id": "%s", "domain": "02_table", "environment": "corner1", "text": "Hand me the book.", "goal": "%s"}\n'
    cases = tmp_path / "my.sentences.jsonl"
    cases.write_text(line % ("right", "(holding pr2 book1)") + line % ("wrong", "(holding pr2 cup1)"))
    ended = tmd("test", "--cases", cases)
    assert ended.code == ExitCode.TESTS_FAILED
    assert ended.out.startswith("wrong: wrong: Hand me the book.\n")
    _no_traceback(ended)
    cases.write_text(line % ("right", "(holding pr2 book1)"))
    assert tmd("test", "--cases", cases).code == ExitCode.OK


def test_nested_too_deeply(tmd: Tmd) -> None:
    broken = BREAK_PARSER.replace("ZeroDivisionError('division by zero')", "RecursionError")
    ended = tmd("parse", "--text", "take the cup", before=broken)
    assert ended.code == ExitCode.BAD_INPUT
    assert ended.err.startswith("error: the input is nested too deeply\nhint: ")


def test_interrupted(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    command = [sys.executable, "-m", "tmd", "parse", "--text-file", str(pipe)]
    process = subprocess.Popen(
        command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, preexec_fn=heed_interrupts
    )
    writer = os.open(pipe, os.O_WRONLY)  # returns when tmd has begun to read
    try:
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    finally:
        os.close(writer)
        process.kill()
    assert (process.returncode, out, err) == (ExitCode.INTERRUPTED, "", "error: interrupted\n")


def test_the_reader_goes_away() -> None:
    command = [sys.executable, "-m", "tmd", "parse", "--text-file", "-", "--json"]
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(command, input=b"take the cup", stdout=writing, stderr=subprocess.PIPE, check=False)
    os.close(writing)
    assert (done.returncode, done.stderr) == (ExitCode.OK, b"")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
@pytest.mark.parametrize("arguments", [["parse", "--text", "take the cup"], ["--help"], ["--version"]])
def test_the_disk_is_full(arguments: list[str]) -> None:
    with Path("/dev/full").open("wb") as full:
        command = [sys.executable, "-m", "tmd", *arguments]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, check=False)
    assert done.returncode == ExitCode.CANNOT_WRITE
    assert done.stderr.startswith(b"error: output: No space left on device\n")


def test_where_no_temporary_file_can_be_written_the_disk_is_full() -> None:
    fault = fault_of(FileNotFoundError(errno.ENOENT, "No usable temporary directory found in ['/tmp', '/var/tmp']"))
    assert (fault.code, fault.hint is not None) == (ExitCode.CANNOT_WRITE, True)
    assert fault.message == "no temporary file can be written in any of ['/tmp', '/var/tmp']"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["experiment", "--task", "tea", "--domain", "04_tea", "--models", "empty", "--out", "run"], ExitCode.OK),
        (["validate", "01_blocks", "nowhere.pddl", "nowhere.txt", "--json"], ExitCode.BAD_INPUT),
    ],
)
def test_where_no_error_can_be_written_the_command_goes_on(arguments: list[str], code: int, tmp_path: Path) -> None:
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    with Path("/dev/full").open("wb") as full:
        command = [sys.executable, "-m", "tmd", *arguments]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=full, check=False, cwd=tmp_path, env=environment)
    assert done.returncode == code
    assert done.stdout


def test_every_code_is_provoked() -> None:
    """The codes of the table above and those that have a test of their own.

    NOT_EXECUTED has it in test_run.py, QUESTION and MODEL_FAILED in tests/readers.
    """
    own = {
        ExitCode.TESTS_FAILED, ExitCode.UNREACHABLE, ExitCode.GAVE_UP, ExitCode.MISSING_TOOL, ExitCode.FAULTS_FOUND,
        ExitCode.INTERNAL, ExitCode.INTERRUPTED, ExitCode.NOT_EXECUTED, ExitCode.PLANNER_FAILED,
        ExitCode.QUESTION, ExitCode.MODEL_FAILED,
    }  # fmt: skip
    assert own | {code for code, _, _ in CASES.values()} == set(ExitCode)


PACKAGES = {
    "yaml": ["check", ROOT / "domains" / "02_table"],
    "pydantic": ["check", ROOT / "domains" / "02_table"],
    "numpy": ["ground", "--domain", "01_blocks", "--environment", "yard1", "--text", "Hold the red block."],
    "joblib": ["experiment", "--task", "tea", "--domain", "04_tea", "--models", "chance", "--out", "run"],
}


@pytest.mark.parametrize("package", PACKAGES)
def test_a_package_that_tmd_cannot_do_without(tmd: Tmd, package: str) -> None:
    ended = tmd(*PACKAGES[package], before=f"import sys; sys.modules['{package}'] = None", fresh=True)
    assert ended.code == ExitCode.MISSING_TOOL
    assert ended.err.splitlines()[-2:] == [
        f"error: the package {package} is missing or damaged",
        "hint: install tmd again with its dependencies: pip install . in a copy of its repository",
    ]


@pytest.mark.parametrize("inside", [False, True])
def test_a_link_to_itself(tmd: Tmd, tmp_path: Path, inside: bool) -> None:
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "x.pddl").symlink_to("x.pddl")
    target = "loop/x" if inside else "loop"
    for arguments in (["plan", DOMAIN, PROBLEM, "--output", target], ["export", PROBLEM, target]):
        ended = tmd(*arguments)
        assert ended.code == ExitCode.CANNOT_WRITE
        assert ended.err.startswith(f"error: {target} cannot be written: ")
    ended = tmd("check", "folder")
    assert ended.code == ExitCode.FAULTS_FOUND
    assert "folder/x.pddl:1:1: error[unreadable]" in ended.out


def test_a_damaged_part_of_a_run_is_named_and_done_again(tmd: Tmd, tmp_path: Path) -> None:
    command = ["experiment", "--task", "tea", "--domain", "04_tea", "--models", "empty", "--out", "run", "--jobs", "1"]
    assert tmd(*command).code == ExitCode.OK
    results = (tmp_path / "run" / "metrics.json").read_bytes()
    part = min((tmp_path / "run" / "parts").iterdir())
    part.write_text(re.sub(r'"task": "[a-z_]*", ', "", part.read_text()))
    told = f"damaged, so to be done again: {part.name}: this is not a prediction of tmd experiment: task: the key is "
    ended = tmd(*command, "--step", "report")
    assert ended.code == ExitCode.BAD_INPUT
    assert told in ended.err
    ended = tmd(*command)
    assert ended.code == ExitCode.OK
    assert told in ended.err
    assert (tmp_path / "run" / "metrics.json").read_bytes() == results
    assert told not in tmd(*command).err
