"""Results in Python: one line of at most 200 characters, and pages in notebooks."""

from __future__ import annotations

import html
import inspect
import re
import sys
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path

import pytest

import tmd
from tests.bundled import kit
from tmd.diagnostics import Refusal, RefusalKind
from tmd.inference.ranking import StepGoal
from tmd.pddl.model import Instruction
from tmd.records.run import RanStep, RunRecord, RunRequest
from tmd.robot.skills.results import ExecutedStep, Execution, SkillStatus
from tmd.short_repr import LONGEST, short_repr
from tmd.world.scaffold import Scaffold

TEXT = "Put the cup on the first table."


def run() -> tmd.RecordedRun:
    """A run of many steps."""
    step = ExecutedStep(Instruction("moveto", ("cup1",)), False, "", "the cup is near " * 30, (), (), 0, 9, frozenset())
    execution = Execution(SkillStatus.STOPPED, "it is out of reach " * 30, (step,) * 50, 0, frozenset())
    asked = RunRequest(
        text=TEXT, domain="02_table", environment="corner2", mode="kinematic", seed=0, planner="in-process", plan=(),
        version="0", environment_file=None, strip=None, grounding=None,
    )  # fmt: skip
    return tmd.RecordedRun(execution, RunRecord.of(asked, (), execution, 9))


@pytest.fixture(scope="module")
def results() -> list[object]:
    """One object of each public class, and further results of what is public."""
    table = kit("02_table")
    grounded = table.ground(TEXT, "corner2", top=3)
    plan = grounded.plans[0].instructions
    problem = table.problem("corner2", goal="(at cup1 table1 on)")
    paths = tuple(map(Path, ("a", "b") * 200))
    return [
        table, grounded, grounded.plans[0], grounded.config, table.lexicon, plan[0], problem, problem.domain,
        tmd.validate(problem, plan), run(), run().record, run().execution,
        table.ground("Put the zebra " * 30, "corner2"), tmd.check_files("02_table"), tmd.parse(TEXT * 20),
        tmd.ModelSettings(), tmd.ExperimentConfig("tea", Path("run"), models=("empty",) * 100),
        *table.run_sentence_tests(),
        Scaffold(Path("x"), Path("y"), paths, (), ""),
        Refusal(RefusalKind.UNSAFE, "word " * 200),
    ]  # fmt: skip


def parts(value: object, depth: int = 6) -> Iterator[object]:
    """A value, and what its fields hold, of the classes of this package."""
    if isinstance(value, tuple | list | Mapping):
        for part in list(value.values() if isinstance(value, Mapping) else value)[:5]:
            yield from parts(part, depth)
    if type(value).__module__.startswith("tmd."):
        yield value
        if is_dataclass(value) and depth:
            for field in fields(value):
                yield from parts(getattr(value, field.name), depth - 1)


def test_every_public_class_is_among_the_results(results: list[object]) -> None:
    public = {each for name in tmd.__all__ if inspect.isclass(each := getattr(tmd, name))}
    assert {each for each in public if not issubclass(each, Exception)} <= set(map(type, results))


def test_results_are_shown_on_one_line(results: list[object]) -> None:
    shown = {repr(part): type(part) for part in parts(results)}
    assert {line: cls for line, cls in shown.items() if len(line) > LONGEST or "\n" in line} == {}
    assert {f"<Grounded '{TEXT}' in corner2: 2 plan(s)>", "<World corner2>", "<Atom (at cup1 table1 on)>"} < {*shown}
    assert f"<StepGoal (at cup1 table1 on) of '{TEXT.rstrip('.')}'>" in shown


def test_a_long_summary_is_cut() -> None:
    @short_repr(lambda thing: "word\n" * 100)
    class Thing:
        pass

    assert len(repr(Thing())) <= LONGEST
    assert repr(Thing()).startswith("<Thing word word ") and repr(Thing()).endswith(" …>")


def test_a_notebook_shows_the_page_of_a_result(results: list[object]) -> None:
    shown = results[1]._repr_html_()
    page = shown.partition('srcdoc="')[2].partition('"')[0]
    assert html.unescape(page) == tmd.grounded_page(results[1])


def cells(value: object) -> list[list[str]]:
    """The table that a notebook shows, with its title in front."""
    title, *rows = re.split(r"</caption>|</tr>", value._repr_html_())  # type: ignore[attr-defined]
    found = [[html.unescape(cell) for cell in re.findall(r"<t[hd](?: [^>]*)?>(.*?)</t[hd]>", row)] for row in rows]
    return [[html.unescape(re.sub(r"<[^>]*>", "", title)).strip()], *(row for row in found if row)]


def test_a_notebook_shows_plans_environments_and_runs_as_tables() -> None:
    table = kit("02_table")
    plan = table.ground(TEXT, "corner2").plans[0]
    (title,), head, *steps = cells(plan)
    assert title == f"cup1 is on table1: energy {plan.energy:.4f}"
    assert head == ["", "instruction", "for"]
    assert steps == [[str(n), str(i), "clause 1"] for n, i in enumerate(plan.instructions, start=1)]

    problem = table.problem("corner2", goal="(at cup1 table1 on)")
    (title,), _, *kinds = cells(problem)
    assert title.endswith("; goal: cup1 is on table1") and ["table", "table1, table2"] in kinds
    assert "goal" not in cells(table.ground(TEXT, "corner2").world)[0][0]

    step = ExecutedStep(plan.instructions[0], False, "<b>dropped</b>", "", (), (), 0, 9, frozenset())
    execution = Execution(SkillStatus.STOPPED, "it fell", (step,), 0, frozenset())
    made = run()
    ran = RanStep(
        number=1, action="moveto", args=("cup1",), repair=False, outcome="failed", failure="<b>dropped</b>",
        evidence=None, effects=(), mismatches=(), begin=0, end=9,
    )  # fmt: skip
    record = RunRecord.of(RunRequest.model_validate(made.record.model_dump(include=set(RunRequest.model_fields))),
                          (ran,), execution, 9)  # fmt: skip
    (title,), _, row = cells(tmd.RecordedRun(execution, record))
    assert title == f"{TEXT} (corner2): stopped, it fell"
    assert row == ["1", "moveto(cup1)", "✗ failed", "<b>dropped</b>"]
    assert "<b>" not in record._repr_html_()


def test_a_notebook_shows_the_metrics_of_an_experiment(tmp_path: Path) -> None:
    config = tmd.ExperimentConfig("set_table", tmp_path, models=("empty", "nearest"), domain="02_table")
    metrics = tmd.run_experiment(config)
    (title,), head, *rows = cells(metrics)
    assert title == "set_table, bundled data" and head[:3] == ["model", "n", "success"]
    assert [row[0] for row in rows] == ["empty", "nearest"]
    assert rows[1][3] == f"{metrics.models['nearest'].IED:.1f} ±{metrics.models['nearest'].IED_se:.1f}"


def test_what_has_no_html_is_left_to_its_repr(results: list[object]) -> None:
    assert kit("02_table").lexicon._repr_html_() is None


def test_goals_are_pddl_and_words(results: list[object]) -> None:
    (goal,) = results[1].plans[0].goals
    assert (str(goal), goal.words) == ("(at cup1 table1 on)", "cup1 is on table1")
    assert str(StepGoal(0, "", None)) == ""


def test_energies_are_a_frame_and_a_plot(results: list[object]) -> None:
    pytest.importorskip("pandas", reason="needs the extra notebook")
    pytest.importorskip("matplotlib", reason="needs the extra notebook").use("agg")
    frame, plans = results[1].to_frame(), results[1].plans
    assert list(frame.index) == [1, 2]
    assert list(frame["steps"]) == [len(plan.steps) for plan in plans] and frame["valid"].all()
    assert list(frame["energy"]) == [plan.energy for plan in plans]
    assert list(frame.drop(columns=["energy", "steps", "valid"]).sum(axis=1)) == pytest.approx(list(frame["energy"]))
    axes = results[1].plot()
    ends = [max(bar.get_x() + bar.get_width() for bar in axes.patches if round(bar.get_y()) == n) for n in (0, 1)]
    assert ends == pytest.approx(list(frame["energy"]))
    refused = kit("02_table").ground("Put the zebra down.", "corner2")
    assert len(refused.to_frame()) == 0 and not refused.plot().patches


@pytest.mark.parametrize(("package", "method"), [("pandas", "to_frame"), ("matplotlib", "plot")])
def test_a_missing_package_is_named(
    results: list[object], monkeypatch: pytest.MonkeyPatch, package: str, method: str
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(tmd.TmdError, match=rf"{package} is not installed \(pip install 'tell-me-dave\[notebook\]'"):
        getattr(results[1], method)()


def test_weights_of_single_factors() -> None:
    table = kit("02_table")
    own, other, without = (
        table.ground(TEXT, "corner2", weights=weights).plans[0]
        for weights in (None, {"description length": 7, "language model (-log P)": 0.5}, {"description_length": 0})
    )

    def weighed(name: str) -> list[float]:
        return [round(plan.factors[name] / plan.raw[name], 6) for plan in (own, other, without)]

    first, *others = weighed("description_length")
    assert others == [7, 0] and first not in others
    assert len(set(weighed("changes_not_asked_for"))) == 1


@pytest.mark.parametrize(
    ("weights", "told"),
    [
        ({"description lenght": 2.0}, "there is no factor 'description_lenght' .*did you mean \"description_length\""),
        ({"description length": "much"}, "'much' is not a number"),
        ({"description length": float("nan")}, "not finite"),
    ],
)
def test_wrong_weights_are_refused(weights: dict[str, float], told: str) -> None:
    with pytest.raises(tmd.TmdError, match=told):
        kit("02_table").ground(TEXT, "corner2", weights=weights)
