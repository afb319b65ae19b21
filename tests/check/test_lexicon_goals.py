"""What a lexicon says verbs, adjectives and groups mean: each fault has its kind, its place and a hint."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tmd.check.checker import Checker
from tmd.check.diagnostic import SEVERITY, Diagnostic, Severity
from tmd.check.lexicon import check_lexicon
from tmd.language.lexicon.file import read_lexicon

ROOT = Path(__file__).resolve().parents[2]
SOUND = "  - take|grasp X: (holding pr2 ?x)\n  - put|keep X in|on Y: (at ?x ?y ?rel)\n"
BOTH = "  - open X: (opened ?x)\n  - close X: (not (opened ?x))\n"


def found(tmp_path: Path, text: str, domain: str = "03_drawer") -> list[Diagnostic]:
    """What is told of a lexicon with ``text`` in a copy of a domain, beside its problems."""
    for kind in ("domains", "problems"):
        shutil.copytree(ROOT / kind / domain, tmp_path / kind / domain)
    file = tmp_path / "domains" / domain / "lexicon.yaml"
    file.write_text(text)
    checker = Checker(tmp_path / "domains", None, tmp_path / "problems")
    checker.check(file)
    checker.finish()
    return checker.findings.sorted()


def marked(text: str) -> tuple[str, int, int]:
    """A text without its mark ``^``, and the line and column of what the mark stands before."""
    before = text.partition("^")[0]
    return text.replace("^", "", 1), before.count("\n") + 1, len(before) - before.rfind("\n")


@pytest.mark.parametrize(
    ("row", "code", "hint"),
    [
        ("- lock X: (^lokced ?x)", "unknown-predicate", "predicates: "),
        ("- unlock X: (not (^opend ?x))", "unknown-predicate", 'did you mean "opened"?'),
        ("- lift X: (holding ^pr3 ?x)", "unknown-object", 'did you mean "pr2"?'),
        ("- lift X: ^(holding ?x)", "wrong-arity", "declared as (holding ?r ?x)"),
        ("- lift X: (holding pr2 ^?y)", "free-variable", "variables here: ?x"),
        ("- lift X: (at ?x ?x ^?rel)", "free-variable", "variables here: ?x"),
        ("- shift X to Y: (exists (?d - ^drawr) (at ?x ?d in))", "unknown-type", 'did you mean "drawer"?'),
        ("- shift X to Y: (at ?x ^pr2 in)", "wrong-type", None),
        ("- shift X to Y: (exists (?x - item) (at ^?z ?y in))", "free-variable", None),
        ("- lift X: ^(and (opened ?x) (holding pr2 ?x)", "unclosed-parenthesis", 'add the missing ")"'),
        ("- lift X: (opened ?x) ^(free pr2)", "bad-goal", "write (and (…) (…)) for several"),
        ("- lift X: ^opened", "syntax", None),
        ("- shift X ^inside Y: (at ?x ?y in)", "bad-goal", 'write "in", which is read for "inside" as well'),
        ("- shift X ^onn Y: (at ?x ?y on)", "bad-goal", 'did you mean "on"?'),
        ("- shift X ^on: (free pr2)", "bad-goal", "write a capital behind it"),
        ("- shift X on ^X: (free pr2)", "bad-goal", "give each slot a letter of its own"),
        ("- ^Lift X: (holding pr2 ?x)", "bad-goal", "write verbs in lower case"),
        ("- lift X: (was (^opend ?x))", "unknown-predicate", 'did you mean "opened"?'),
        ('- lift X: "(and (free pr2) (^opend ?x))"', "unknown-predicate", 'did you mean "opened"?'),
        ("- lift X: (and (free pr2)\n      (^opend ?x))", "unknown-predicate", 'did you mean "opened"?'),
        ("- lift X: >-\n      (and (free pr2)\n        (^opend ?x))", "unknown-predicate", 'did you mean "opened"?'),
    ],
)
def test_a_fault_of_a_row_has_its_kind_place_and_hint(tmp_path: Path, row: str, code: str, hint: str | None) -> None:
    text, line, column = marked(f"goals:\n{SOUND}{BOTH}  {row}\n")
    told = [d for d in found(tmp_path, text) if d.code != "duplicate-name"]
    assert [(d.code, d.location.line, d.location.column) for d in told] == [(code, line, column)]
    assert SEVERITY[code] is Severity.ERROR
    assert told[0].source == text.splitlines()[line - 1]
    assert hint is None or hint in (told[0].hint or "")


def test_every_fault_of_every_row_is_told(tmp_path: Path) -> None:
    rows = "goals:\n  - lift X: (and (opend ?x) (holding pr3 ?y))\n  - drop X Y: (free pr2)\n  - lay X: (at ?x)\n"
    told = [(d.location.line, d.code) for d in found(tmp_path, rows) if d.severity is Severity.ERROR]
    assert told == [
        (2, "unknown-predicate"),
        (2, "unknown-object"),
        (2, "free-variable"),
        (3, "bad-goal"),
        (4, "wrong-arity"),
    ]


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("- tip X: (exists (?d - drawer) (at ?d ?x in))", "(at ?d ?x in)"),
        ("- tip X: (and (opened ?x) (or (opened pen_1) (part_of ?x ?x)))", None),
        ("- hang X on|under Y: (at ?x ?y ?rel)", "with 'under'"),
        ("- hang X under Y: (at ?x ?y ?rel)", "with 'under'"),
        ("- tip X: (exists (?r - robot) (near ?r ?x))", None),
        ("- tip X: (was (exists (?d - drawer ?f - furniture) (at ?d ?f on)))", "(at ?d ?f on)"),
        ("- tip X: (imply (part_of ?x ?x) (opened ?x))", ""),
        ("- tip X: (forall (?d - drawer) (not (at ?d ?x in)))", ""),
    ],
)
def test_a_goal_that_nothing_can_fulfil_is_told(tmp_path: Path, row: str, message: str | None) -> None:
    told = [d for d in found(tmp_path, f"goals:\n{SOUND}{BOTH}  {row}\n") if d.code == "impossible-goal"]
    if not message:
        assert message is None or told == []
    else:
        assert len(told) == 1
        assert message in told[0].message
        assert told[0].severity is Severity.WARNING


def test_no_environment_tells_nothing_impossible(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "domains" / "03_drawer", tmp_path / "domains" / "mine")
    (tmp_path / "problems" / "mine").mkdir(parents=True)
    file = tmp_path / "domains" / "mine" / "lexicon.yaml"
    file.write_text("goals:\n  - hang X under Y: (at ?x ?y ?rel)\n")
    checker = Checker(tmp_path / "domains", None, tmp_path / "problems")
    checker.check(file)
    assert not [d for d in checker.findings.sorted() if d.code == "impossible-goal"]


def test_adjectives_speak_of_x(tmp_path: Path) -> None:
    text, line, column = marked(f"goals:\n{SOUND}{BOTH}attributes:\n  shut: (not (opened ^?y))\n  open: (opened ?x)\n")
    told = [(d.code, d.location.line, d.location.column) for d in found(tmp_path, text)]
    assert told == [("free-variable", line, column)]


def test_groups_name_what_is_there(tmp_path: Path) -> None:
    text, line, column = marked(f"nouns:\n  stuff: [key]\ngoals:\n{SOUND}{BOTH}groups:\n  stuff: [key, item, ^penn]\n")
    told = [(d.code, d.location.line, d.location.column, d.hint) for d in found(tmp_path, text)]
    assert told == [("unknown-class", line, column, 'did you mean "pen"?')]


def test_groups_of_plain_pddl_name_objects_of_environments(tmp_path: Path) -> None:
    text = "goals:\n  - put|keep X on Y: (on ?x ?y)\ngroups:\n  warm: [red_block]\n  cold: [blue_blok]\n"
    told = [(d.code, d.hint) for d in found(tmp_path, text, "01_blocks") if d.severity is Severity.ERROR]
    assert told == [("unknown-class", 'did you mean "blue_block"?')]


def test_a_verb_with_a_goal_is_served(tmp_path: Path) -> None:
    path = tmp_path / "lexicon.yaml"
    path.write_text("verbs: [polish, dust]\nverb_synonyms:\n  buff: polish\ngoals:\n  - polish X: (clean ?x)\n")
    lexicon = read_lexicon(path)
    told = check_lexicon(path, lexicon, lexicon.goal_verbs, (), (), ["Look at it."])
    assert [fault.message.split("'")[1] for fault in told] == ["dust"]


@pytest.mark.parametrize(
    "domain", ["01_blocks", "02_table", "03_drawer", "04_tea", "lab_bench", "kitchen", "living_room"]
)
def test_what_is_bundled_has_neither_errors_nor_warnings(domain: str) -> None:
    checker = Checker()
    checker.check(ROOT / "domains" / domain / "lexicon.yaml")
    assert checker.findings.sorted() == []
