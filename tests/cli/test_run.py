"""``tmd run`` as people use it: short plans without physics in a small kitchen, and everything that can go wrong."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from base64 import b64decode
from io import BytesIO
from pathlib import Path

import pytest

from tests.cli.conftest import BLOCKS, ROOT, Ended, Tmd
from tmd.diagnostics import ExitCode

HIDE_PYBULLET = "import sys; sys.modules['pybullet'] = None"
HIDE_FFMPEG = "import sys; sys.modules['imageio_ffmpeg'] = None"
HIDE_PILLOW = "import sys; sys.modules['PIL'] = None"
HIDE_PR2 = "import importlib.metadata as m\ndef files(name): raise m.PackageNotFoundError(name)\nm.files = files"
STOP_WHEELS = (
    "import tmd.robot.skills.navigate_and_look as go\nfrom tmd.robot.skills.results import SkillError, SkillPhase\n"
    "def drive(*_): raise SkillError(SkillPhase.PATH, 'the wheels do not turn')\n"
    "go.drive = drive"
)
CORNER = ROOT / "tests" / "cli" / "corner.yaml"
KITCHEN = ("run", "--environment", CORNER, "--kinematic")
PLAN = "(find pot1)\n(moveto pot1)\n"


@pytest.fixture
def robot() -> None:
    """For tests that start the simulation."""
    for package in ("pybullet", "PIL", "imageio_ffmpeg"):
        pytest.importorskip(package, reason="needs the extra robot")


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    path = tmp_path / "short.plan"
    path.write_text(PLAN)
    return path


def lines(path: Path) -> list[dict[str, object]]:
    """A log."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def frames(path: Path) -> int:
    """Count the pictures of a film."""
    import imageio.v3 as iio

    return sum(1 for _ in iio.imiter(path))


@pytest.mark.usefixtures("robot")
def test_a_plan_is_told_logged_and_drawn(tmd: Tmd, plan: Path, tmp_path: Path) -> None:
    from PIL import Image

    ended = tmd(*KITCHEN, "--plan", plan, "--log", "log.jsonl", "--strip", "strip.png")
    assert (ended.code, ended.err) == (ExitCode.OK, "")
    assert re.fullmatch(
        r"plan: 2 instructions in corner, without physics\n"
        r"    1\. find\(pot1\) +ok: pot1 is in view, .*; inferred \(found pr2 pot1\)\n"
        r"    2\. moveto\(pot1\) +ok: pot1 is \d\.\d\d m away; measured \(near pr2 pot1\)(; inferred .*)?\n"
        r"done: every effect is as predicted \(\d+ measured, \d+ inferred\); 2 instructions, \d+\.\d s simulated\n",
        ended.out,
    )
    log = lines(tmp_path / "log.jsonl")
    assert [entry["event"] for entry in log] == ["plan", "begin", "step", "begin", "step", "end"]
    assert (log[-1]["status"], log[-2]["outcome"]) == ("done", "ok")
    with Image.open(tmp_path / "strip.png") as sheet:
        assert sheet.format == "PNG"
        assert min(sheet.size) > 300
    assert sorted(path.name for path in tmp_path.iterdir()) == ["log.jsonl", "short.plan", "strip.png"]


@pytest.mark.usefixtures("robot")
def test_the_record(tmd: Tmd) -> None:
    """A text is grounded, and each step says which clause it is for."""
    ended = tmd(*KITCHEN, "--text", "Take the cup.", "--json")
    assert (ended.code, ended.err) == (ExitCode.OK, "")
    record = json.loads(ended.out)
    keys = ["text", "domain", "environment", "mode", "seed", "planner", "plan"]
    keys += ["version", "environment_file", "strip", "grounding", "steps"]
    assert list(record) == [*keys, "status", "reason", "repairs", "seconds"]
    assert (record["text"], record["mode"], record["status"]) == ("Take the cup.", "kinematic", "done")
    assert [step["action"] for step in record["steps"]] == [step["action"] for step in record["plan"]]
    assert {step["clause"] for step in record["plan"]} == {0}
    last = record["steps"][-1]
    assert ("(holding pr2 cup1)", True, "measured") in {(e["fact"], e["holds"], e["basis"]) for e in last["effects"]}
    assert (last["outcome"], last["mismatches"], last["failure"]) == ("ok", [], None)
    assert last["begin"] < last["end"]


@pytest.mark.usefixtures("robot")
def test_a_goal_is_planned_for_and_reached(tmd: Tmd) -> None:
    ended = tmd(*KITCHEN, "--goal", "(near pr2 pot1)", "--json")
    assert (ended.code, ended.err) == (ExitCode.OK, "")
    record = json.loads(ended.out)
    assert (record["text"], record["goal"], record["status"]) == (None, "(near pr2 pot1)", "done")
    assert (record["steps"][-1]["action"], record["steps"][-1]["outcome"]) == ("moveto", "ok")


@pytest.mark.usefixtures("robot")
def test_a_goal_that_cannot_be_reached_is_not_begun(tmd: Tmd, tmp_path: Path) -> None:
    ended = tmd(*KITCHEN, "--goal", "(at counter1 pot1 in)", "--json", "--log", "log.jsonl")
    assert ended.code == ExitCode.UNREACHABLE
    record = json.loads(ended.out)
    assert (record["status"], record["plan"], record["steps"]) == ("unreachable", [], [])
    assert record["reason"].endswith("this is proven")
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("robot")
def test_the_same_run_gives_the_same_bytes(tmd: Tmd, plan: Path) -> None:
    """Physics included: the robot turns its head to the pot under gravity, from places that the seed moved."""
    plan.write_text("(find pot1)\n")
    arguments = ("run", "--environment", CORNER, "--plan", plan, "--seed", "7", "--json")
    ended = tmd(*arguments)
    assert (ended.code, json.loads(ended.out)["mode"]) == (ExitCode.OK, "physics")
    assert tmd(*arguments).out == ended.out


@pytest.mark.usefixtures("robot")
def test_a_robot_that_cannot_go_on_says_why(tmd: Tmd, plan: Path) -> None:
    ended = tmd(*KITCHEN, "--plan", plan, "--repairs", "1", before=STOP_WHEELS)
    assert ended.code == ExitCode.NOT_EXECUTED
    assert ended.out.count("failed: path: the wheels do not turn") == 3  # twice as a step, once as the reason
    assert re.search(r"^stopped: replanned 1 times?, and then moveto\(pot1\) failed: path: ", ended.out, re.MULTILINE)


@pytest.mark.usefixtures("robot")
def test_a_thing_out_of_reach_is_told_with_what_is_in_the_way(tmd: Tmd, tmp_path: Path, plan: Path) -> None:
    """The mug stands on the second of two tables, at its far end."""
    (tmp_path / "far.yaml").write_text(
        "name: far\ndomain: kitchen\nobjects:\n"
        "  table1: {class: table, position: [2.5, 0, 0]}\n  table2: {class: table, position: [3.3, 0, 0]}\n"
        "  mug1: {class: mug, at: on table2, position: [3.55, 0.0, 0.74]}\n"
    )
    plan.write_text("(find mug1)\n(moveto mug1)\n(grasp mug1)\n")
    options = ("--kinematic", "--plan", plan, "--repairs", "0", "--explain", "why.html")
    ended = tmd("run", "--environment", "far.yaml", *options)
    assert ended.code == ExitCode.NOT_EXECUTED, ended.err
    assert re.search(
        r"^stopped: .*grasp\(mug1\) failed: stance: no place to stand reaches mug1, .* table1 .*in the way",
        ended.out,
        re.MULTILINE,
    ), ended.out
    from PIL import Image

    page = (tmp_path / "why.html").read_text()
    assert "grasp(mug1)" in page
    assert re.search(r"<b>a place to stand</b>, from [^<]*: in table1", page)
    pictures = re.findall(r'src="data:image/jpeg;base64,([^"]+)"', page)
    assert pictures, "no way has a picture"
    assert {Image.open(BytesIO(b64decode(each))).size for each in pictures} == {(400, 300)}


@pytest.mark.usefixtures("robot")
def test_no_plan_for_a_text(tmd: Tmd, tmp_path: Path) -> None:
    ended = tmd(*KITCHEN, "--text", "Flurble the pot", "--json", "--log", "log.jsonl", "--video", "out.mp4")
    assert ended.code == ExitCode.NOT_GROUNDED
    record = json.loads(ended.out)
    assert (record["status"], record["steps"], record["plan"]) == ("not_grounded", [], [])
    assert record["reason"].startswith("no plan: clause 1: unknown verb 'flurble'")
    assert record["reason"] in ended.err
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("robot")
@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("(find pot1)\n(grasp pot1)\n", r"invalid: .*wrong\.plan:2:1: step 2, grasp\(pot1\): its precondition "),
        ("(find pot9)\n", r"invalid: .*wrong\.plan:1:1: .*pot9"),
    ],
)
def test_a_plan_that_does_not_work_is_not_begun(tmd: Tmd, tmp_path: Path, text: str, told: str) -> None:
    path = tmp_path / "wrong.plan"
    path.write_text(text)
    ended = tmd(*KITCHEN, "--plan", path)
    assert (ended.code, ended.out) == (ExitCode.INVALID_PLAN, "")
    assert re.match(told, ended.err), ended.err


URDF = '<robot name="box"><link name="base_footprint"/></robot>'
OVERLAP = (
    "name: mine\ndomain: kitchen\nobjects:\n  counter1: {class: counter}\n"
    "  pot1: {class: pot, at: on counter1, position: [0, 0, 0.9]}\n"
    "  pot2: {class: pot, at: on counter1, position: [0, 0, 0.9]}\n"
)
TEXT = ("--text", "Take the cup.")
WRONG = {
    "no-text": (ExitCode.USAGE, [*KITCHEN], "", r"error: give one of REQUEST, --text"),
    "text-and-goal": (
        ExitCode.USAGE,
        [*KITCHEN, *TEXT, "--goal", "(a)"],
        "",
        r"error: give one of REQUEST, .*--goal\n",
    ),
    "trajectory-suffix": (
        ExitCode.USAGE,
        [*KITCHEN, *TEXT, "--trajectory", "out.bag"],
        "",
        r"error: .*'out\.bag' does not end in \.jsonl or \.mcap",
    ),
    "no-mcap": (
        ExitCode.MISSING_TOOL,
        [*KITCHEN, "--goal", "(near pr2 pot1)", "--trajectory", "out.mcap"],
        "import sys; sys.modules['mcap_ros2'] = None",
        r"error: MCAP files need the package mcap-ros2-support\nhint: pip install 'tell-me-dave\[ros\]'",
    ),
    "two-robots": (
        ExitCode.USAGE,
        [*KITCHEN, *TEXT, "--robot", "pr2", "--urdf", "a.urdf"],
        "",
        r"error: give one of --robot and --urdf",
    ),
    "no-such-robot": (
        ExitCode.BAD_INPUT,
        [*KITCHEN, *TEXT, "--robot", "tiagopro"],
        "",
        r"error: there is no robot 'tiagopro'\nhint: did you mean \"tiago_pro\"\?",
    ),
    "wrong-goal": (
        ExitCode.BAD_INPUT,
        [*KITCHEN, "--goal", "(near pr2 pot9)"],
        "",
        r"error: --goal:1:11: unknown object \"pot9\"",
    ),
    "text-and-plan": (
        ExitCode.USAGE,
        [*KITCHEN, *TEXT, "--plan", "a"],
        "",
        r"error: give one of REQUEST, .*--plan",
    ),
    "film-suffix": (
        ExitCode.USAGE,
        [*KITCHEN, *TEXT, "--video", "out.avi"],
        "",
        r"error: .*'out\.avi' does not end in \.mp4 or \.gif\n",
    ),
    "strip-suffix": (ExitCode.USAGE, [*KITCHEN, *TEXT, "--strip", "out"], "", r"error: .*'out' does not end in \.png"),
    "no-plan-file": (ExitCode.BAD_INPUT, [*KITCHEN, "--plan", "none.plan"], "", r"error: none\.plan.*cannot be read"),
    "pddl": (
        ExitCode.BAD_INPUT,
        ["run", "--environment", BLOCKS / "p01.pddl", *TEXT],
        "",
        r"error: .*p01\.pddl: a PDDL problem .* no scene of it\nhint: give an environment",
    ),
    "no-environment": (
        ExitCode.BAD_INPUT,
        ["run", "--environment", "kitchen9", *TEXT],
        "",
        r"error: there is no environment 'kitchen9'\nhint: did you mean ",
    ),
    "no-film-directory": (
        ExitCode.CANNOT_WRITE,
        [*KITCHEN, *TEXT, "--video", "none/out.mp4"],
        "",
        r"error: none/out\.mp4 cannot be written: No such directory",
    ),
    "read-only": (  # made up: the tests may run as root, who may write everywhere
        ExitCode.CANNOT_WRITE,
        [*KITCHEN, *TEXT, "--strip", "out.png"],
        "import os; os.access = lambda path, mode, **_: mode != os.W_OK",
        r"error: out\.png cannot be written: Permission denied\nhint: name a file that you may write",
    ),
    "log-is-a-directory": (
        ExitCode.CANNOT_WRITE,
        [*KITCHEN, *TEXT, "--log", ROOT],
        "",
        r"error: .* cannot be written: Is a directory",
    ),
    "no-pybullet": (
        ExitCode.MISSING_TOOL,
        [*KITCHEN, *TEXT],
        HIDE_PYBULLET,
        r"error: .*pybullet is not installed\nhint: pip install 'tell-me-dave\[robot\]'",
    ),
    "no-ffmpeg": (
        ExitCode.MISSING_TOOL,
        [*KITCHEN, *TEXT, "--video", "out.mp4"],
        HIDE_FFMPEG,
        r"error: MP4 films need .*imageio-ffmpeg.*\nhint: pip install 'tell-me-dave\[robot\]', or ask for a GIF",
    ),
    "no-pillow": (
        ExitCode.MISSING_TOOL,
        [*KITCHEN, *TEXT, "--strip", "out.png"],
        HIDE_PILLOW,
        r"error: .*Pillow.*\nhint: pip install 'tell-me-dave\[robot\]'",
    ),
}
WITH_ROBOT = {
    "no-pr2": (ExitCode.MISSING_TOOL, [*KITCHEN, *TEXT], HIDE_PR2, r"error: the PR2's model is missing.*\nhint: pip "),
    "no-display": (
        ExitCode.MISSING_TOOL,
        [*KITCHEN, *TEXT, "--gui"],
        "import os; os.environ.pop('DISPLAY', None)",
        r"error: no window can be opened.*\nhint: .*--video",
    ),
    "no-urdf": (ExitCode.BAD_INPUT, [*KITCHEN, *TEXT, "--urdf", "none.urdf"], "", r"error: .*none\.urdf"),
    "other-robot": (
        ExitCode.BAD_INPUT,
        [*KITCHEN, *TEXT, "--urdf", "box.urdf"],
        "",
        r"error: box\.urdf is not a PR2: ",
    ),
    "no-meshes": (
        ExitCode.BAD_INPUT,
        [*KITCHEN, *TEXT, "--urdf", "lost.urdf"],
        "",
        r"error: lost\.urdf: its mesh package://\S+\.stl is missing\nhint: put the folder .example-robot-data. beside ",
    ),
    "overlap": (
        ExitCode.BAD_INPUT,
        ["run", "--environment", "overlap.yaml", "--text", "Take a pot."],
        "",
        r"error: overlap\.yaml:\d+:\d+: 'pot\d' and 'pot\d' are in each other by \d+ mm",
    ),
}


def _refused(ended: Ended, code: ExitCode, told: str) -> None:
    assert ended.code == code, ended.err
    assert re.match(told, ended.err), ended.err
    assert "Traceback" not in ended.err
    assert ended.out == ""


@pytest.mark.parametrize(("code", "arguments", "before", "told"), WRONG.values(), ids=list(WRONG))
def test_what_cannot_be_run(
    tmd: Tmd, tmp_path: Path, code: ExitCode, arguments: list[str | Path], before: str, told: str
) -> None:
    _refused(tmd(*arguments, before=before), code, told)
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("robot")
@pytest.mark.parametrize(("code", "arguments", "before", "told"), WITH_ROBOT.values(), ids=list(WITH_ROBOT))
def test_what_cannot_be_simulated(
    tmd: Tmd, tmp_path: Path, code: ExitCode, arguments: list[str | Path], before: str, told: str
) -> None:
    from tmd.robot.pr2.urdf import packaged

    (tmp_path / "box.urdf").write_text(URDF)
    (tmp_path / "lost.urdf").write_text(packaged("urdf/pr2.urdf").read_text())  # without the folder of its meshes
    (tmp_path / "overlap.yaml").write_text(OVERLAP)
    _refused(tmd(*arguments, before=before), code, told)


@pytest.mark.parametrize("missing", ["skills.yaml", "objects.yaml"])
def test_a_domain_without_a_robot(tmd: Tmd, tmp_path: Path, missing: str) -> None:
    folder = shutil.copytree(ROOT / "domains" / "kitchen", tmp_path / "domains" / "kitchen")
    (folder / missing).unlink()
    ended = tmd(*KITCHEN, *TEXT)
    _refused(ended, ExitCode.BAD_INPUT, rf"error: .*{re.escape(missing)}.*\nhint: ")


@pytest.mark.usefixtures("robot")
@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGKILL])
def test_a_killed_run_leaves_a_log_and_an_interrupted_one_a_film(
    tmp_path: Path, plan: Path, how: signal.Signals
) -> None:
    words = [*KITCHEN, "--plan", plan, "--log", "log.jsonl", "--video", "out.mp4"]
    command = [sys.executable, "-m", "tmd", *map(str, words)]
    log, film = (tmp_path / name for name in ("log.jsonl", "out.mp4"))
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(
        command,
        cwd=tmp_path,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        while process.poll() is None and not (log.exists() and log.read_text().count('"event": "begin"') >= 2):
            time.sleep(0.05)
        if how is signal.SIGKILL:
            os.killpg(process.pid, how)
        else:
            process.send_signal(how)
        out, err = process.communicate(timeout=60)
    steps = [entry["event"] for entry in lines(log)]
    assert steps[:4] == ["plan", "begin", "step", "begin"]
    if how is signal.SIGTERM:
        assert (process.returncode, err) == (ExitCode.INTERRUPTED, "error: interrupted\n")
        assert "done:" not in out
        assert (steps[-1], lines(log)[-1]["status"]) == ("end", "interrupted")
        assert frames(film) > 10


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_in_made_code_keeps_its_exit_code(tmp_path: Path, number: int) -> None:
    """A plain KeyboardInterrupt would let the interpreter end by SIGINT."""
    (tmp_path / "stopped.py").write_text(
        "import os, sys\n"
        "from tmd.cli.program import stoppable\n"
        "try:\n"
        "    with stoppable():\n"
        f"        exec('os.kill(os.getpid(), {int(number)})')\n"
        "except KeyboardInterrupt:\n"
        "    sys.exit(130)\n"
    )
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    ended = subprocess.run([sys.executable, "-m", "stopped"], cwd=tmp_path, env=environment, check=False)
    assert ended.returncode == ExitCode.INTERRUPTED
