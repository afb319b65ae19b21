"""``import tmd`` for programs: quick to import, and its way to other tools and back."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import tmd
import tmd.api
from tmd.export.formats import FORMATS
from tmd.language import Lexicon, Parsed, parse

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
    plan = tmd.find_plan(problem)
    assert tmd.validate(problem, plan).valid
    for name in ("adl", "strips", "durative", "plansys2"):
        written = tmd.export_plan(problem, plan, tmp_path / name, [name])
        assert written == [tmp_path / name / file for file in ("domain.pddl", "problem.pddl", "plan.plan")]
        assert tmd.read_plan(tmp_path / name / "plan.plan", problem) == plan
    with pytest.raises(tmd.TmdError, match="is not empty"):
        tmd.export_plan(problem, plan, tmp_path)
    assert set(FORMATS) >= {"adl", "strips"}


def test_no_plan_says_whether_that_is_proven() -> None:
    problem = tmd.load_problem(BLOCKS / "p01.pddl", BLOCKS / "domain.pddl")
    with pytest.raises(tmd.NoPlanError, match="there is no plan") as caught:
        tmd.find_plan(tmd.with_goal(problem, "(and (on a b) (on b a))"))
    assert caught.value.proven


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


def test_another_parser_may_read_the_text() -> None:
    def elliptic(text: str, lexicon: Lexicon | None = None) -> Parsed:
        """It reads orders without a verb, such as "book on the table"."""
        return parse(f"Put the {text}.", lexicon)

    grounded = tmd.load_domain("02_table").ground("book on the table", "corner1", parser=elliptic)
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
