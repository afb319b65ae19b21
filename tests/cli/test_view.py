"""``tmd view`` as a user calls it: every kind of input, every ending, and nothing lost when it goes wrong."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import BLOCKS, ROOT, Ended, Tmd, run_tmd
from tests.view.reading import Reader
from tmd.cli.program import run
from tmd.diagnostics import ExitCode

TEXT = "Put the cup on the first table."
WHERE = ("--environment", "corner2")
STEPS = [
    {"number": 1, "action": "moveto", "args": ["book1"], "repair": False, "outcome": "ok", "failure": None,
     "evidence": "it is near",
     "effects": [{"fact": "(near pr2 table2)", "holds": True, "basis": "measured", "how": "0.4 m away"}],
     "mismatches": [], "begin": 0, "end": 9},
]  # fmt: skip


def page(path: Path) -> Reader:
    return Reader(path.read_text(encoding="utf-8"))


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Tmd:
    """``tmd`` in this process: it starts much sooner."""
    monkeypatch.chdir(tmp_path)

    def ended(*arguments: str | Path, **_: object) -> Ended:
        capsys.readouterr()
        code = run(["--domains", str(ROOT / "domains"), "--problems", str(ROOT / "problems"), *map(str, arguments)])
        return Ended(code, *capsys.readouterr())

    return ended


@pytest.fixture(scope="module")
def answered(learned: Path) -> str:
    arguments = ["ground", *WHERE, "--text", TEXT, "--top", "2", "--json"]
    return run_tmd(arguments, ROOT).out


@pytest.fixture
def grounded(tmp_path: Path, answered: str) -> Path:
    path = tmp_path / "grounded.json"
    path.write_text(answered)
    return path


def run_of(grounded: Path, **more: object) -> dict[str, object]:
    """A record as ``tmd run`` makes them, of the plan that was grounded."""
    told = json.loads(grounded.read_text())
    asked = {"text": TEXT, "domain": "02_table", "environment": "corner2", "mode": "physics", "seed": 3}
    return {
        **asked,
        "planner": "in-process",
        "plan": told["plans"][0]["steps"],
        "version": "0.1.0",
        "environment_file": None,
        "strip": None,
        "grounding": told,
    } | more


def test_what_was_grounded_of_a_text(tmd: Tmd, tmp_path: Path, grounded: Path) -> None:
    ended = tmd("view", "grounded.json")
    assert (ended.code, ended.out, ended.err) == (ExitCode.OK, "grounded.html\n", "")
    text = page(tmp_path / "grounded.html").text
    assert "keep(cup1, table1, on)" in text and "not first" in text and "in-process" in text


def shown(here: Tmd, tmp_path: Path, text: str) -> Ended:
    """Show what is grounded of a text."""
    (tmp_path / "said.json").write_text(here("ground", *WHERE, "--text", text, "--json").out)
    return here("view", "said.json")


def test_standard_input_and_output(tmd: Tmd, tmp_path: Path, grounded: Path) -> None:
    ended = tmd("view", "-", stdin=grounded.read_bytes())
    tmd("view", "grounded.json")
    assert (ended.code, ended.out) == (ExitCode.OK, (tmp_path / "grounded.html").read_text())


def test_a_log_with_its_filmstrip(here: Tmd, tmp_path: Path, grounded: Path) -> None:
    image = pytest.importorskip("PIL.Image")
    events = [
        {"event": "plan", **run_of(grounded)},
        {"event": "begin", "number": 1, "instruction": "moveto(book1)"},
        {"event": "step", **STEPS[0]},
    ]
    events.append({"event": "end", "status": "stopped", "reason": "no hand fits", "repairs": 0, "seconds": 1.5})
    log = tmp_path / "cup.jsonl"
    log.write_text("".join(json.dumps(event) + "\n" for event in events))
    image.new("RGB", (420, 400)).save(tmp_path / "cup.png")
    ended = here("view", "cup.jsonl")
    assert (ended.code, ended.out) == (ExitCode.OK, "cup.html\n")
    found = page(tmp_path / "cup.html")
    assert all(text in found.text for text in ("stopped", "no hand fits", "(near pr2 table2)", "it is near"))
    (sheet,) = found.of_class("sheet")
    assert sheet["src"].startswith("data:image/png;base64,")
    whole = tmp_path / "run.json"
    whole.write_text(json.dumps({**run_of(grounded), "steps": STEPS, "status": "stopped",
                                 "reason": "no hand fits", "repairs": 0, "seconds": 1.5}))  # fmt: skip
    (tmp_path / "cup.png").rename(tmp_path / "run.png")
    here("view", "run.json")
    assert (tmp_path / "run.html").read_bytes() == (tmp_path / "cup.html").read_bytes()


def test_the_log_of_a_run_that_was_killed(here: Tmd, tmp_path: Path, grounded: Path) -> None:
    whole = json.dumps({"event": "plan", **run_of(grounded)}) + "\n" + json.dumps({"event": "step", **STEPS[0]}) + "\n"
    (tmp_path / "cut.jsonl").write_text(whole + '{"event": "beg')
    assert here("view", "cut.jsonl").code == ExitCode.OK
    assert "unfinished" in page(tmp_path / "cut.html").text
    (tmp_path / "hole.jsonl").write_text(whole.replace("}\n{", "}\nxx\n{"))
    ended = here("view", "hole.jsonl")
    assert (ended.code, ended.out) == (ExitCode.BAD_INPUT, "") and "hole.jsonl:2:1" in ended.err


def test_a_run_of_a_plan_file_has_no_sentence(here: Tmd, tmp_path: Path, grounded: Path) -> None:
    record = run_of(grounded, text=None, grounding=None) | {"steps": STEPS, "status": "done"}
    record |= {"reason": None, "repairs": 0, "seconds": 0.5}
    (tmp_path / "run.json").write_text(json.dumps(record))
    assert here("view", "run.json").code == ExitCode.OK
    assert not page(tmp_path / "run.html").of_class("tmd-text")


def test_an_environment_of_ones_own_is_found_again(here: Tmd, tmp_path: Path) -> None:
    source = (ROOT / "problems/02_table/environments/corner2.yaml").read_text()
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "mine.yaml").write_text(source.replace("name: corner2", "name: mine"))
    told = here("ground", "--environment", "there/mine.yaml", "--text", TEXT, "--json").out
    (tmp_path / "mine.json").write_text(told)
    assert here("view", "mine.json").code == ExitCode.OK
    (tmp_path / "there" / "mine.yaml").rename(tmp_path / "mine.yaml")
    assert here("view", "mine.json").code == ExitCode.OK
    (tmp_path / "mine.yaml").rename(tmp_path / "other.yaml")
    ended = here("view", "mine.json")
    assert ended.code == ExitCode.BAD_INPUT and "--environment FILE" in ended.err
    assert here("view", "mine.json", "--environment", "other.yaml").code == ExitCode.OK


def test_a_plan_file_in_its_problem(here: Tmd, tmp_path: Path) -> None:
    plan, problem = BLOCKS / "plans" / "valid-sussman.plan", BLOCKS / "p01.pddl"
    ended = here("view", plan, "--problem", problem, "--out", "blocks.html")
    assert (ended.code, ended.out) == (ExitCode.OK, "blocks.html\n")
    assert len(page(tmp_path / "blocks.html").of_class("step")) == 6


@pytest.mark.parametrize("plan", sorted((BLOCKS / "plans").glob("invalid-*.plan")), ids=lambda path: path.stem)
def test_a_plan_that_does_not_work_ends_as_validate_does(here: Tmd, tmp_path: Path, plan: Path) -> None:
    ended = here("view", plan, "--problem", BLOCKS / "p01.pddl", "--out", "bad.html")
    told = here("validate", BLOCKS / "domain.pddl", BLOCKS / "p01.pddl", plan)
    assert (ended.code, ended.err) == (told.code, told.out) and told.code == ExitCode.INVALID_PLAN
    reason = json.loads(here("validate", BLOCKS / "domain.pddl", BLOCKS / "p01.pddl", plan, "--json").out)["reason"]
    assert reason in page(tmp_path / "bad.html").text


def test_a_text_without_a_plan_has_a_page_that_says_why(here: Tmd, tmp_path: Path) -> None:
    ended = shown(here, tmp_path, "Zzyzx blorf wug.")
    assert (ended.code, ended.out) == (ExitCode.NOT_GROUNDED, "said.html\n")
    found = page(tmp_path / "said.html")
    assert "no plan" in found.text and found.of_class("tmd-skipped")


def test_html_in_a_text_stays_text(here: Tmd, tmp_path: Path) -> None:
    shown(here, tmp_path, "Put the <script>alert('cup')</script> on the <b>first table</b>.")
    found = page(tmp_path / "said.html")
    assert [tag for tag, _ in found.elements].count("script") == 1 and "<script>alert('cup')</script>" in found.text


BAD = {
    "empty": b"",
    "binary": b"\xff\xfe\x00",
    "cut": b'{"text": "take',
    "list": b"[1, 2]",
    "number": b"17",
    "other": b'{"a": 1}',
    "half": b'{"plans": [], "text": 1}',
    "nan": b'{"text": "x", "environment": "corner2", "clauses": [], "plans": [{"steps": [], "choices": '
    b'[{"source": null, "factors": {"x": NaN}}]}]}',
    "deep": b'{"plans":' + b"[" * 100_000,
    "log": b'{"event": "step"}\n',
    "nowhere": b'{"text": "x", "environment": "../../nowhere", "domain": "02_table", "clauses": [], "plans": []}',
    "error": b'{"error": {"code": 31, "message": "no"}}',
    "surrogate": b'{"text": "\\ud800", "environment": "corner2", "clauses": [{}], "plans": []}',
}


@pytest.mark.parametrize("name", BAD)
def test_bad_files_are_refused_in_one_line(here: Tmd, tmp_path: Path, name: str) -> None:
    (tmp_path / "x.json").write_bytes(BAD[name])
    ended = here("view", "x.json")
    assert ended.code in (ExitCode.BAD_INPUT, ExitCode.USAGE) and not ended.out
    assert ended.err.startswith("error: ") and ended.err.count("error: ") == 1 and "Traceback" not in ended.err
    assert sorted(p.name for p in tmp_path.iterdir()) == ["x.json"]


def test_half_characters_in_a_file_do_not_stop_the_page(here: Tmd, tmp_path: Path) -> None:
    told = json.loads(here("ground", *WHERE, "--text", "Zzyzx blorf wug.", "--json").out)
    half = told | {"text": "\ud800 <b>", "clauses": [], "skipped": [], "refused": None}
    (tmp_path / "x.json").write_text(json.dumps(half))
    assert here("view", "x.json").code == ExitCode.NOT_GROUNDED
    assert "�" in page(tmp_path / "x.html").text


@pytest.mark.parametrize(
    "arguments",
    [
        (),
        ("grounded.json", "--problem", "x.pddl"),
        ("grounded.json", "--out", "grounded.json"),
    ],
    ids=lambda arguments: " ".join(arguments) or "nothing",
)
def test_options_that_do_not_go_together(here: Tmd, grounded: Path, arguments: tuple[str, ...]) -> None:
    before = grounded.read_bytes()
    ended = here("view", *arguments)
    assert (ended.code, ended.out) == (ExitCode.USAGE, "") and grounded.read_bytes() == before


def test_a_page_that_cannot_be_written_leaves_the_old_one(here: Tmd, tmp_path: Path, grounded: Path) -> None:
    (tmp_path / "dir").mkdir()
    for out in ("dir", "nowhere/x.html"):
        ended = here("view", "grounded.json", "--out", out)
        assert ended.code == ExitCode.CANNOT_WRITE and ended.err.count("error: ") == 1
    assert not list((tmp_path / "dir").iterdir())
