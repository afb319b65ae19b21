"""Names that tools refuse are written differently, and what is written is the same problem."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import pytest

from tests.cli.conftest import run_tmd
from tests.export.conftest import Val
from tmd.diagnostics import ExitCode
from tmd.export.formats import FORMATS, chosen_files
from tmd.export.planned_problem import Planned, planned
from tmd.pddl.model import Instruction
from tmd.pddl.plan_file import parse_plan
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.validator import validate


def named(**names: str) -> Planned:
    n = {"domain": "d0", "type": "tray", "object": "t1", "predicate": "clean", "action": "scrub", **names}
    domain = f"""(define (domain {n["domain"]}) (:requirements :strips :typing) (:types {n["type"]})
      (:predicates ({n["predicate"]} ?x - {n["type"]}) (here ?x - {n["type"]}))
      (:action {n["action"]} :parameters (?x - {n["type"]}) :precondition (here ?x) :effect ({n["predicate"]} ?x)))"""
    problem = f"""(define (problem {n["domain"]}) (:domain {n["domain"]}) (:objects {n["object"]} - {n["type"]})
      (:init (here {n["object"]})) (:goal ({n["predicate"]} {n["object"]})))"""
    return planned(parse_problem(problem, parse_domain(domain)), [Instruction(n["action"], (n["object"],))])


KINDS = ("type", "object", "predicate", "action")
ODD = [named(domain="7-up", **dict.fromkeys(KINDS, "2nd"))]
ODD += [named(**{one: "same", other: "same"}) for one, other in combinations(KINDS, 2)]
ODD += [named(**{kind: word}) for kind, word in zip(KINDS, ("number", "name", "within", "total-time"), strict=True)]


@pytest.mark.parametrize("source", ODD)
@pytest.mark.parametrize("form", ["adl", "strips", "durative", "plansys2"])
def test_val_takes_names_that_it_refuses(source: Planned, form: str, val: Val) -> None:
    files = FORMATS[form](source)
    assert val.valid(files["domain.pddl"], files["problem.pddl"], files["plan.plan"])
    assert chosen_files(source, [form]).renames


@pytest.mark.parametrize("source", ODD)
def test_unified_planning_and_pddl_take_them(source: Planned, tmp_path: Path) -> None:
    from pddl import parse_domain as theirs
    from unified_planning.io import PDDLReader

    files = FORMATS["adl"](source)
    PDDLReader().parse_problem_string(files["domain.pddl"], files["problem.pddl"])
    (tmp_path / "domain.pddl").write_text(files["domain.pddl"])
    theirs(str(tmp_path / "domain.pddl"))
    problem = parse_problem(files["problem.pddl"], parse_domain(files["domain.pddl"]))
    assert validate(problem, parse_plan(files["plan.plan"], problem=problem).instructions).valid


@pytest.mark.parametrize("variable", ["?2nd", "?a.b", "?_x", "?duration", "?object", "?and"])
def test_variables_are_renamed_as_well(variable: str, val: Val) -> None:
    from unified_planning.io import PDDLReader

    domain = f"""(define (domain d0) (:requirements :adl) (:types tray)
      (:predicates (clean {variable} - tray) (here ?x - tray))
      (:action scrub :parameters ({variable} ?x_2nd - tray) :precondition (and (here {variable}) (here ?x_2nd))
        :effect (clean {variable})))"""
    problem = "(define (problem p) (:domain d0) (:objects t1 - tray) (:init (here t1)) (:goal (clean t1)))"
    source = planned(parse_problem(problem, parse_domain(domain)), [Instruction("scrub", ("t1", "t1"))])
    for form in ("adl", "strips", "durative"):
        files = FORMATS[form](source)
        assert val.valid(files["domain.pddl"], files["problem.pddl"], files["plan.plan"])
        PDDLReader().parse_problem_string(files["domain.pddl"], files["problem.pddl"])
    assert set(chosen_files(source, ["adl"]).renames) == {("object", variable)}


def test_other_names_and_other_formats_keep() -> None:
    assert not chosen_files(named(), ["adl"]).renames
    assert not chosen_files(ODD[0], ["ipc", "bt"]).renames
    assert FORMATS["ipc"](ODD[0])["plan.plan"].startswith("(2nd 2nd)")


def test_one_warning_lists_them(tmp_path: Path) -> None:
    (tmp_path / "domain.pddl").write_text(
        "(define (domain lamps) (:predicates (1st ?x) (off ?x)) (:action 3rd :parameters (?x)"
        " :precondition (off ?x) :effect (1st ?x)))"
    )
    (tmp_path / "p.pddl").write_text(
        "(define (problem p) (:domain lamps) (:objects a) (:init (off a)) (:goal (1st a)))"
    )
    ended = run_tmd(["export", "p.pddl", "out", "--format", "adl,strips"], tmp_path)
    assert ended.code == ExitCode.OK
    assert [line for line in ended.err.splitlines() if "predicate_1st" in line] == [
        "warning: other tools refuse names, which are written differently: "
        "predicate 1st is predicate_1st, action 3rd is action_3rd"
    ]
