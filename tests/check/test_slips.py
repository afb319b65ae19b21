"""Every slip of the collection is told once, where it was made; edits that change nothing are let pass."""

from __future__ import annotations

from difflib import SequenceMatcher
from pathlib import Path

import pytest

from tmd.check.checker import Checker
from tmd.check.diagnostic import Diagnostic, Severity
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.reading.reader import read_domain, read_problem
from tmd.pddl.validator import validate
from tmd.planning.backends import solve
from tmd.planning.result import Solved

CHECKERS = Path(__file__).resolve().parents[2] / "experiments" / "checkers"
SOUND = CHECKERS / "cases" / "none"
SLIPS = sorted(path.name for path in (CHECKERS / "cases").iterdir() if path != SOUND)
HARMLESS = sorted(path.name for path in (CHECKERS / "harmless").iterdir())
TOLD_IN_BOTH_FILES = {"contradictory-precondition", "predicate-never-produced"}
"""An action that never applies, and the goal that is out of reach therefore."""
PLACED_ELSEWHERE = {
    "extra-parenthesis": "what follows it, and stands outside its action",
    "missing-parenthesis-at-end": "the parenthesis that is not closed",
    "missing-parenthesis-in-condition": "the parenthesis that is not closed",
    "missing-parenthesis-in-problem": "the parenthesis that is not closed",
    "missing-parenthesis-of-action": "the parenthesis that is not closed",
    "goal-out-of-reach": "the goal that a missing fact keeps from being reached",
    "no-goal": "the problem's name",
    "parameter-twice": "the second of the two",
    "predicate-never-produced": "the condition that is never true",
    "type-without-objects": "what needs objects of the type",
    "typing-not-declared": "the first type",
    "unused-predicate": "its declaration",
}


def _told(folder: Path) -> list[Diagnostic]:
    checker = Checker()
    checker.check(folder)
    checker.finish()
    return checker.findings.sorted()


def _edited(folder: Path) -> set[tuple[str, int]]:
    """The lines, by file, in which ``folder`` differs from the files without a slip."""
    lines: set[tuple[str, int]] = set()
    for name in ("domain.pddl", "problem.pddl"):
        before, after = ((at / name).read_text(encoding="utf-8").split("\n") for at in (SOUND, folder))
        for kind, _, _, first, end in SequenceMatcher(None, before, after, autojunk=False).get_opcodes():
            if kind != "equal":
                lines.update((name, line + 1) for line in range(first, max(end, first + 1)))
    return lines


def test_without_a_slip_nothing_is_told() -> None:
    assert _told(SOUND) == []


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_is_told_once_and_where_it_is(slip: str) -> None:
    told = _told(CHECKERS / "cases" / slip)
    assert len(told) == (2 if slip in TOLD_IN_BOTH_FILES else 1), told
    places = {(Path(d.location.file).name, d.location.line) for d in told}
    assert slip in PLACED_ELSEWHERE or places & _edited(CHECKERS / "cases" / slip), places
    assert all(d.hint or d.code == "wrong-type" for d in told)


@pytest.mark.parametrize("edit", HARMLESS)
def test_an_edit_that_changes_nothing_is_no_error(edit: str) -> None:
    folder = CHECKERS / "harmless" / edit
    assert [d for d in _told(folder) if d.severity is Severity.ERROR] == []
    sound, edited = (read_problem(at / "problem.pddl", read_domain(at / "domain.pddl")) for at in (SOUND, folder))
    assert [str(o) for o in ground(edited).operators] == [str(o) for o in ground(sound).operators]
    found = solve(edited)
    assert isinstance(found, Solved) and validate(sound, found.plan).valid


BARN = """\
(define (domain barn)
  (:requirements :strips :typing :existential-preconditions)
  (:types horse stall - object)
  (:predicates (beside ?s - stall) (in ?h - horse ?s - stall) (fed ?h - horse))
  (:action walk
    :parameters (?a ?b - stall)
    :precondition (beside ?a)
    :effect (and (beside ?b) (not (beside ?a))))
  (:action lead
    :parameters (?h - horse ?a ?b - stall)
    :precondition (and (beside ?a) (in ?h ?a))
    :effect (and (in ?h ?b) (not (in ?h ?a))))
  (:action feed
    :parameters (?h - horse)
    :precondition (exists (?s - stall) (and (beside ?s) (in ?h ?s)))
    :effect (fed ?h)))
"""


@pytest.mark.parametrize(("stalls", "codes"), [(6, []), (14, ["too-many-cases"])])
def test_a_condition_that_cannot_be_written_out_is_told_at_its_place(
    tmp_path: Path, stalls: int, codes: list[str]
) -> None:
    names = " ".join(f"s{n}" for n in range(stalls))
    (tmp_path / "domain.pddl").write_text(BARN)
    (tmp_path / "p01.pddl").write_text(
        f"(define (problem one) (:domain barn) (:objects h - horse {names} - stall)"
        " (:init (beside s0) (in h s1)) (:goal (fed h)))"
    )
    told = _told(tmp_path)
    assert [d.code for d in told] == codes
    for diagnostic in told:
        assert (Path(diagnostic.location.file).name, diagnostic.location.line) == ("domain.pddl", 15)
        assert diagnostic.source == BARN.splitlines()[14]
