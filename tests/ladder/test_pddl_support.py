"""docs/pddl-support.md: each line of its tables is a case, and is run."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from tmd.diagnostics import TmdError
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import GroundAtom, Instruction
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.semantics import apply

PAGE = Path(__file__).parents[2] / "docs" / "pddl-support.md"
DOMAIN = """(define (domain small)
  (:requirements :adl :action-costs)
  {sections}
  (:predicates (p ?x - a) (q) (r ?x - a ?y - a){predicates})
  {functions}
  (:action act :parameters (?x - a ?y - a) :precondition {condition} :effect {effect}))
"""
PROBLEM = """(define (problem one) (:domain small)
  (:objects o1 o2 - a)
  (:init (p o1) (r o1 o1) (r o1 o2) {costs})
  (:goal (and)) {section})
"""
COSTS = "(= (price o1) 2) (= (price o2) 3)"


def rows() -> Iterator[tuple[str, str, str]]:
    """Heading, case and whether it is supported."""
    for part in re.split(r"^## ", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
        heading = part.splitlines()[0]
        for case, supported in re.findall(r"^\| `(.+?)` \| (yes|no: [^|]+?) \|", part, re.MULTILINE):
            yield heading, case, supported


ROWS = list(rows())


def read(heading: str, case: str) -> set[tuple[str, ...]]:
    """Set the case into a small domain, and do its action once; what holds afterwards."""
    said = {"Conditions": "condition", "Effects": "effect", "Sections of a problem": "section"}.get(heading, "sections")
    parts = {"condition": "(and)", "effect": "(q)", "sections": "(:types a b - object)", "predicates": ""}
    parts |= {"functions": "(:functions (total-cost) (price ?x - a) (amount ?x - a) - number)", "section": ""}
    if said == "sections" and case.startswith("(:predicates"):
        parts["predicates"] = case.removeprefix("(:predicates").removesuffix(")")
    elif said == "sections" and case.startswith("(:types"):
        parts["sections"] = f"(:types a b - object {case.removeprefix('(:types')}"
    elif said == "sections" and case.startswith("(:functions"):
        parts["functions"] = case
    elif said == "sections" and case.startswith("(:derived"):
        parts |= {"predicates": " (d ?x - a)", "functions": f"{parts['functions']} {case}"}
    elif said == "sections":
        parts["sections"] += f" {case}"
    else:
        parts[said] = case
    domain = parse_domain(DOMAIN.format_map(parts))
    problem = parse_problem(PROBLEM.format(costs=COSTS, section=parts["section"]), domain)
    ground(problem)
    return {(atom.predicate, *atom.args) for atom in apply(Instruction("act", ("o2", "o1")), problem.init, problem)}


def test_the_page_has_cases_of_every_kind() -> None:
    assert {heading for heading, _, _ in ROWS} == {
        "Conditions",
        "Effects",
        "Sections of a domain",
        "Sections of a problem",
    }
    assert len(ROWS) > 35


@pytest.mark.parametrize(("heading", "case", "supported"), ROWS, ids=[f"{h}: {c}" for h, c, _ in ROWS])
def test_a_case_is_as_the_page_says(heading: str, case: str, supported: str) -> None:
    if supported == "yes":
        read(heading, case)
        return
    with pytest.raises(TmdError) as refused:
        read(heading, case)
    assert f"not supported: {supported.removeprefix('no: ')}" in refused.value.message
    assert refused.value.location


EFFECTS = {
    "(and (p ?x) (not (p ?x)))": True,
    "(when (q) (p ?x))": False,
    "(when (q) (when (p ?y) (p ?x)))": False,
    "(p ?x)": True,
}


@pytest.mark.parametrize("case", EFFECTS)
def test_effects_mean_what_the_page_says(case: str) -> None:
    assert (("p", "o2") in read("Effects", case)) is EFFECTS[case]


def test_conditions_are_read_before_anything_changes() -> None:
    after = read("Effects", "(and (q) (not (p ?y)) (when (q) (p ?x)) (when (p ?y) (r ?x ?y)))")
    assert ("p", "o2") not in after
    assert ("r", "o2", "o1") in after


def test_everything_is_read_in_lower_case() -> None:
    domain = parse_domain(
        DOMAIN.format(sections="(:types A)", predicates="", functions="", condition="(and)", effect="(Q)")
    )
    problem = parse_problem(PROBLEM.format(costs="", section=""), domain)
    assert GroundAtom("q", ()) in apply(Instruction("act", ("o2", "o1")), problem.init, problem)
