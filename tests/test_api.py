"""``import tmd`` for programs: quick to import, and its way to other tools and back."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import tmd
import tmd.api
from tmd.domain_kit import DomainKit, orders_of
from tmd.export.formats import FORMATS
from tmd.pddl.task import Bits
from tmd.readers.interface import Dialogue
from tmd.readers.rules import RuleReader
from tmd.world.world import World

ROOT = Path(__file__).resolve().parents[1]
BLOCKS = ROOT / "tests" / "pddl" / "cases" / "blocks"


def test_the_names_of_the_package_are_those_of_its_api() -> None:
    assert tmd.__all__ == tmd.api.__all__
    for name in tmd.__all__:
        assert getattr(tmd, name) is getattr(tmd.api, name)
    assert set(tmd.__all__) <= set(dir(tmd))
    with pytest.raises(AttributeError, match="has no attribute 'nothing'"):
        _ = tmd.nothing


def test_importing_it_imports_nothing_else() -> None:
    code = "import sys, typing; before = set(sys.modules); import tmd; print(*sorted(set(sys.modules) - before))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    assert set(done.stdout.split()) <= {"__future__", "tmd"}


def test_the_api_loads_no_planner_and_no_unified_planning() -> None:
    code = "import sys, tmd; tmd.load_problem; print('unified_planning' in sys.modules, 'numba' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    assert done.stdout.split() == ["False", "False"]


def test_a_plan_is_found_exported_and_read(tmp_path: Path) -> None:
    problem = tmd.load_problem(BLOCKS / "p01.pddl", BLOCKS / "domain.pddl")
    assert tmd.load_problem(BLOCKS / "p01.pddl") == problem
    plan = tmd.find_plan(problem)
    assert tmd.validate(problem, plan).valid
    for name in ("adl", "strips", "durative", "plansys2"):
        written = tmd.export_plan(problem, plan, tmp_path / name, [name])
        assert written == [tmp_path / name / file for file in ("domain.pddl", "problem.pddl", "plan.plan")]
        assert len(tmd.read_plan(tmp_path / name / "plan.plan")) == len(plan)
    with pytest.raises(tmd.TmdError, match="is not empty"):
        tmd.export_plan(problem, plan, tmp_path)
    assert set(FORMATS) >= {"adl", "strips"}


def test_no_plan_says_whether_that_is_proven() -> None:
    problem = tmd.load_problem(BLOCKS / "p01.pddl", BLOCKS / "domain.pddl")
    with pytest.raises(tmd.NoPlanError, match="there is no plan") as caught:
        tmd.find_plan(tmd.with_goal(problem, "(and (on a b) (on b a))"))
    assert caught.value.proven


def test_mistakes_get_a_suggestion(tmp_path: Path) -> None:
    kit = tmd.load_domain("02_table")
    problem = kit.problem("corner2", goal="(at cup1 table1 on)")
    run: dict[str, Any] = {"task": "set_table", "out": tmp_path}
    mistakes: list[tuple[Callable[[], object], str]] = [
        (lambda: tmd.load_domain("02_tabel"), 'did you mean "02_table"'),
        (lambda: kit.ground("Take the cup.", "corner22"), 'did you mean "corner2"'),
        (lambda: kit.ground("Take the cup.", "corner2", model="gaols"), 'did you mean "goals"'),
        (lambda: kit.ground("Take the cup.", "corner2", reader="rulez"), 'did you mean "rules"'),
        (lambda: kit.ground("Take the cup.", "corner2", top=0), "top is 0 .it is at least 1"),
        (lambda: kit.ground("Take the cup.", "corner2", beam=-1), "beam is -1 .it is at least 0"),
        (lambda: kit.ground(problem, "corner2"), "not a text .write kit.ground"),
        (lambda: tmd.find_plan(problem, planner="in-proces"), 'did you mean "in-process"'),
        (lambda: tmd.find_plan(problem, time_limit=0), "the time limit is 0 s .give more"),
        (lambda: tmd.find_plan(kit), "this is a DomainKit, not a problem .kit.problem"),
        (lambda: tmd.export_plan(problem, tmd.find_plan(problem), tmp_path, "stripz"), 'did you mean "strips"'),
        (lambda: tmd.ExperimentConfig(**run, data="bundeld"), 'did you mean "bundled"'),
        (lambda: tmd.ExperimentConfig(**run, backend="dusk"), 'did you mean "dask"'),
        (lambda: tmd.carry_out_predictions(tmd.ExperimentConfig(**run), "kinematics"), 'did you mean "kinematic"'),
    ]
    for make, told in mistakes:
        with pytest.raises(tmd.TmdError, match=told):
            make()
    with pytest.raises(AttributeError) as caught:
        _ = tmd.load_domian
    assert (caught.value.name, caught.value.obj) == ("load_domian", tmd), "what Python suggests names from"
    assert tmd.ExperimentConfig("set_table", str(tmp_path)).out == tmp_path
    assert tmd.export_plan(problem, tmd.find_plan(problem), tmp_path / "one", "strips")[0].parent == tmp_path / "one"


def test_environments_become_problems(tmp_path: Path) -> None:
    kitchen = tmd.load_domain("kitchen", domains=ROOT / "domains", problems=ROOT / "problems")
    assert kitchen.name == "kitchen"
    assert "kitchen3" in kitchen.environments()
    problem = kitchen.problem("kitchen3", goal="(found pr2 cup1)")
    assert [str(step) for step in tmd.find_plan(problem)] == ["find(cup1)"]
    mine = tmp_path / "mine.yaml"
    mine.write_text("name: mine\ndomain: kitchen\nobjects:\n  counter1: {class: counter}\n")
    assert kitchen.problem(mine).name == "mine"
    with pytest.raises(tmd.TmdError, match="there is no environment 'kitchen99'"):
        kitchen.problem("kitchen99")
    with pytest.raises(tmd.TmdError, match=r"goal:1:\d+: unknown object"):
        kitchen.problem("kitchen3", goal="(found pr2 cup99)")


def test_another_reader_may_read_the_request() -> None:
    class Telegraphic(RuleReader):
        """It reads requests such as "book table"."""

        def begin(self, request: str, world: World, state: Bits) -> Dialogue:
            item, place = request.split()
            return super().begin(f"Put the {item} on the {place}.", world, state)

    kit = tmd.load_domain("02_table")
    grounded = kit.ground("book table", "corner1", reader=Telegraphic(kit.lexicon))
    assert [str(i) for i in grounded.plans[0].instructions][-1] == "keep(book1, table1, on)"


def test_what_words_could_not_be_used_is_told() -> None:
    table = tmd.load_domain("02_table", domains=ROOT / "domains", problems=ROOT / "problems")
    refused = table.ground("Put the zebra on the table.", "corner1")
    assert refused.plans == ()
    assert refused.unknown == ("zebra",)
    assert refused.reason.startswith("clause 1: nothing here is called 'zebra'")
    guessed = table.ground("Put the book on the table. Ahem!", "corner1")
    assert guessed.reason == ""
    assert guessed.warnings == ('"Ahem" was skipped: no verb that this could belong to',)
    plain = table.ground("Polish the zebra.", "corner1", model="paper")
    assert plain.warnings[0].startswith("no demonstration has the verb 'polish' (say ")
    assert "nothing here is called 'zebra'" in plain.warnings[1]


def table(tmp_path: Path) -> DomainKit:
    """The domain 02_table with a copy of its problems, where tests may write."""
    shutil.copytree(ROOT / "problems" / "02_table", tmp_path / "problems" / "02_table")
    return tmd.load_domain("02_table", domains=ROOT / "domains", problems=tmp_path / "problems")


def test_what_a_text_asks_for_is_a_problem(tmp_path: Path) -> None:
    kit = table(tmp_path)
    grounded = kit.ground("Put the cup on the first table.", "corner2", beam=0, trim=0, weights="paper")
    problem = tmd.asked_problem(grounded)
    assert problem is not None
    assert "(:goal (at cup1 table1 on))" in tmd.format_problem(problem)
    assert tmd.validate(problem, tmd.find_plan(problem)).valid
    page = tmd.grounded_page(grounded)
    assert page.startswith("<!DOCTYPE html>") and "Put the cup on the first table. (corner2)" in page
    assert "A plan in corner2" in tmd.plan_page(problem, grounded.plans[0].instructions)
    file = tmp_path / "plan.txt"
    file.write_text("".join(f"{step}\n" for step in (i.pddl() for i in grounded.plans[0].instructions)))
    assert "a plan in corner2" in tmd.file_page(
        file, environment="corner2", domain="02_table", domains=ROOT / "domains"
    )
    assert tmd.parse("Put the cup down.", kit.lexicon).clauses[0].verb == "put_down"


def test_what_is_learned_is_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("TMD_LEARNED", raising=False)
    kit = table(tmp_path)
    with pytest.raises(tmd.TmdError, match="there are no learned weights of '02_table'"):
        kit.ground("Take the cup.", "corner2", weights="learned")
    saved = kit.learn(weights=False)
    assert saved == tmp_path / "problems" / "02_table" / "learned"
    assert (saved / "library.json").is_file()
    assert kit.ground("Take the cup.", "corner2").reason == ""


def test_sentence_tests_are_run(tmp_path: Path) -> None:
    kit = table(tmp_path)
    assert all(result.outcome.passed for result in kit.run_sentence_tests()[:2])
    file = tmp_path / "mine.sentences.jsonl"
    line = '{"id": "a", "domain": "02_table", "environment": "%s", "text": "Take the zebra.", "goal": null}\n'
    file.write_text(line % "corner1")
    (result,) = kit.run_sentence_tests(tmd.read_sentences(file))
    assert result.outcome == "impossible_refused"
    assert "nothing here is called 'zebra'" in result.reason
    file.write_text(line % "corner9")
    with pytest.raises(tmd.TmdError, match=r"mine.sentences.jsonl:1:1: 'a': there is no environment 'corner9'"):
        kit.run_sentence_tests(tmd.read_sentences(file))


def test_a_domain_is_begun_checked_laid_out_and_compiled(tmp_path: Path) -> None:
    made = tmd.new_domain("mine", domains=tmp_path / "domains", problems=tmp_path / "problems")
    places = {"domains": tmp_path / "domains", "problems": tmp_path / "problems"}
    assert not tmd.compile_domain("mine", domains=places["domains"])
    domain = made.folder / "domain.pddl"
    text = domain.read_text()
    domain.write_text(text + "; changed\n")
    assert tmd.compile_domain("mine", domains=places["domains"], write=False)
    found = tmd.check_files("mine", **places)
    assert [(d.code, d.location.file) for d in found.diagnostics] == [("stale-domain", str(domain))]
    fixed = tmd.check_files(made.folder, made.problems, fix=True, **places)
    assert fixed.fixed == (domain,)
    assert not fixed.counts[next(s for s in fixed.counts if s == "error")]
    assert domain.read_text() == text
    problem = next(made.problems.glob("*.pddl"))
    laid_out = problem.read_text()
    problem.write_text(laid_out.replace("\n", "   \n", 1))
    assert tmd.format_file(problem, write=False)
    assert tmd.format_file(problem)
    assert not tmd.format_file(problem)


def test_an_experiment_is_run_and_reported(tmp_path: Path) -> None:
    config = tmd.ExperimentConfig(
        "set_table", tmp_path / "run", models=("nearest",), domain="02_table",
        domains=ROOT / "domains", problems=ROOT / "problems",
    )  # fmt: skip
    told: list[tuple[int, int]] = []
    metrics = tmd.run_experiment(config, progress=lambda done, of: told.append((done, of)))
    assert set(metrics.models) == {"nearest"}
    assert told[-1][0] == told[-1][1]
    report = config.out / "report.html"
    assert "nearest" in report.read_text()
    report.unlink()
    assert tmd.run_experiment(config, collect_only=True) == metrics
    assert report.is_file()


def test_the_usual_models_are_those_that_the_domain_has(tmp_path: Path) -> None:
    config = tmd.ExperimentConfig("set_table", tmp_path / "run", domain="02_table")
    with pytest.raises(tmd.TmdError, match="parts are not done"):
        tmd.run_experiment(config, collect_only=True)
    assert "templates" not in json.loads((tmp_path / "run" / "config.json").read_text())["models"]


def test_a_plan_is_carried_out(tmp_path: Path) -> None:
    pytest.importorskip("pybullet", reason="needs the extra robot")
    kitchen = tmd.load_domain("kitchen", domains=ROOT / "domains", problems=ROOT / "problems")
    find = tmd.Instruction("find", ("mug1",))
    run = kitchen.run_plan([find], "kitchen1", kinematic=True)
    assert run.execution.status == "done"
    assert isinstance(run, tmd.RecordedRun)
    assert tmd.RunRecord.from_text(json.dumps(run.record.to_value()), "record") == run.record
    assert (run.record.status, [step.instruction for step in run.record.steps]) == ("done", [find])
    assert [step.instruction for step in run.execution.steps] == [find]
    with pytest.raises(tmd.TmdError, match="the plan does not work: "):
        kitchen.run_plan([tmd.Instruction("grasp", ("mug1",))] * 2, "kitchen1")
    with pytest.raises(tmd.TmdError, match="cannot be written: No such directory"):
        kitchen.run_plan([find], "kitchen1", strip=tmp_path / "no" / "s.png")
    scene = kitchen.survey_scene("kitchen1")
    assert "mug1" in {entry.name for entry in scene.entries}


def test_the_best_plan_of_a_text_is_what_the_robot_is_to_do(tmp_path: Path) -> None:
    kit = table(tmp_path)
    orders = orders_of(kit.ground("Take the cup.", "corner2"))
    assert [(str(order.instruction), order.text) for order in orders] == [
        ("moveto(cup1)", "Take the cup"),
        ("grasp(cup1)", "Take the cup"),
    ]
    with pytest.raises(tmd.TmdError, match="there is no plan: clause 1: nothing here is called 'zebra'"):
        kit.run_plan(kit.ground("Take the zebra.", "corner2"), "corner2")


def test_a_studio_is_opened(tmp_path: Path) -> None:
    pytest.importorskip("viser", reason="needs the extra studio")
    server = table(tmp_path).open_studio("corner2", port=0)
    try:
        assert server.url.startswith(f"http://127.0.0.1:{server.port}/?token=")
        assert server.studio.start == "corner2"
    finally:
        server.close()
