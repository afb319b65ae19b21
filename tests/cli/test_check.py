"""``tmd check`` and ``tmd fmt`` as a user runs them."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
GOALS = "goals:\n  - take X: (holding pr2 ?x)\n  - put X in|on Y: (at ?x ?y ?rel)\n"
GOOD = "(define (domain d)\n  (:predicates (p ?x))\n  (:action a\n    :parameters (?x)\n    :effect (p ?x)))\n"
FIRST_LINE = re.compile(r"^(.+?):(\d+):(\d+): (error|warning|note)\[([a-z0-9-]+)\]: (.*)$")
"""What docs/errors.md gives to editors."""
Tmd = Callable[..., Any]


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "d.pddl"
    path.write_text(GOOD)
    return path


@pytest.fixture
def drawer(tmp_path: Path) -> Path:
    """The lexicon of a copy of a bundled domain."""
    shutil.copytree(ROOT / "domains" / "03_drawer", tmp_path / "domains" / "03_drawer")
    return tmp_path / "domains" / "03_drawer" / "lexicon.yaml"


def test_exit_codes_and_the_lines_that_editors_read(tmd: Tmd, file: Path) -> None:
    assert tmd("check", file).code == 0
    file.write_text(GOOD.replace("(p ?x)))", "(q ?y)))"))
    ended = tmd("check", file)
    assert ended.code == 13 and ended.err == ""
    heads = [found.groups() for line in ended.out.splitlines() if (found := FIRST_LINE.match(line))]
    assert [(head[1], head[2], head[3], head[4]) for head in heads] == [
        ("5", "14", "error", "unknown-predicate"),
        ("5", "16", "error", "free-variable"),
    ]
    assert tmd("check", file.parent / "nowhere.pddl").code == 31


def test_warnings_count_when_asked_to(tmd: Tmd, file: Path) -> None:
    file.write_text(GOOD.replace("(p ?x))\n", "(p ?x) (unused))\n", 1))
    assert tmd("check", file).code == 0
    assert tmd("check", file, "--strict").code == 13


def test_json_and_fix(tmd: Tmd, file: Path) -> None:
    file.write_text(GOOD.replace(":effect (p ?x)))", ":precondition () :effect (p ?x))"))
    told = json.loads(tmd("check", file, "--json").out)
    assert {d["code"] for d in told["diagnostics"]} == {"empty-condition", "unclosed-parenthesis"}
    assert (told["errors"], told["warnings"], told["fixed"]) == (1, 1, [])
    ended = tmd("check", file, "--fix", "--json")
    assert ended.code == 0 and json.loads(ended.out)["fixed"] == [str(file)]
    assert file.read_text() == GOOD.replace(":effect", ":precondition (and) :effect")


def test_a_parenthesis_too_many_in_a_goal_is_fixed(tmd: Tmd, drawer: Path) -> None:
    drawer.write_text(f"{GOALS}  - open X: (and (opened ?x)\n      (free pr2)))\n")
    assert tmd("check", drawer).code == 13
    assert tmd("check", drawer, "--fix").code == 0
    assert drawer.read_text() == f"{GOALS}  - open X: (and (opened ?x)\n      (free pr2))\n"


def test_fmt(tmd: Tmd, file: Path) -> None:
    assert tmd("fmt", "--check", file).code == 0
    file.write_text(GOOD.replace("\n    ", "\r\n"))
    assert tmd("fmt", "--check", file).code == 13
    assert tmd("fmt", file).code == 0
    assert file.read_bytes() == GOOD.encode()
    file.write_text("(define")
    ended = tmd("fmt", file)
    assert ended.code == 31 and "never closed" in ended.err
    assert file.read_text() == "(define"


def test_a_fault_of_the_classes_is_told_of_them_once(tmd: Tmd, drawer: Path) -> None:
    problems = drawer.parents[2] / "problems" / "03_drawer"
    shutil.copytree(ROOT / "problems" / "03_drawer", problems)
    objects = drawer.parent / "objects.yaml"
    sound = objects.read_text(encoding="utf-8")
    objects.write_text(sound.replace("[free pr2]", "[free robot]"), encoding="utf-8")
    told = json.loads(tmd("check", drawer.parents[2], "--json").out)["diagnostics"]
    line = next(n for n, text in enumerate(sound.splitlines(), start=1) if "[free pr2]" in text)
    assert [(d["code"], Path(d["file"]).name, d["line"]) for d in told] == [("unknown-object", "objects.yaml", line)]
    objects.write_text(sound.replace("allows self in", "allows slef in"), encoding="utf-8")
    told = json.loads(tmd("check", drawer.parents[2], "--json").out)["diagnostics"]
    assert {(d["code"], Path(d["file"]).name) for d in told} == {("unknown-object", "objects.yaml")}
    assert told[0]["hint"] == 'did you mean "self"?'


@pytest.mark.parametrize(("verb", "served"), [("polish", True), ("shine", True), ("knit", False)])
def test_a_verb_that_the_check_calls_served_is_ground(tmd: Tmd, drawer: Path, verb: str, served: bool) -> None:
    shutil.copytree(ROOT / "problems" / "03_drawer", drawer.parents[2] / "problems" / "03_drawer")
    instructions = drawer.parent / "instructions.pddl"
    text = instructions.read_text(encoding="utf-8").replace("(:predicates", "(:predicates\n    (polished ?x - item)", 1)
    polish = (
        "(:action polish\n    :parameters (?x - item)\n    :precondition (holding pr2 ?x)\n    :effect (polished ?x))"
    )
    instructions.write_text(f"{text.rstrip().removesuffix(')')}\n\n  {polish})\n", encoding="utf-8")
    lexicon = drawer.read_text(encoding="utf-8")
    drawer.write_text(lexicon.replace("verb_synonyms:", "verb_synonyms:\n  shine: polish\n  knit: sew", 1))
    root = drawer.parents[2]
    assert tmd("compile", drawer.parent).code == 0
    told = json.loads(tmd("check", root, "--json").out)["diagnostics"]
    unserved = " ".join(d["message"] for d in told if d["code"] == "unserved-verb")
    assert (f"'{verb}'" in unserved) is not served
    environment = root / "problems" / "03_drawer" / "environments" / "study1.yaml"
    ended = tmd("ground", "--domain", drawer.parent, "--environment", environment, "--text", f"{verb} the key.")
    assert (ended.code == 0) is served
    assert ("polish(key1)" in ended.out) is served


def test_a_domain_that_is_named_beside_the_problem_is_its_domain(tmd: Tmd, tmp_path: Path) -> None:
    problem = "(define (problem x) (:domain e) (:objects o) (:init) (:goal (p o)))"
    for name, text in {"one": GOOD, "two": GOOD.replace("domain d", "domain e"), "x": problem}.items():
        (tmp_path / f"{name}.pddl").write_text(text)
    assert tmd("check", tmp_path / "two.pddl", tmp_path / "x.pddl").code == 0
    ended = tmd("check", tmp_path / "one.pddl", tmp_path / "x.pddl")
    assert ended.code == 13 and "domain-mismatch" in ended.out


def test_commands_use_the_files_that_are_named(tmd: Tmd, tmp_path: Path) -> None:
    """Beside the files stands a ``domain.pddl`` of the same name, in which nothing works."""
    lamp = "(define (domain lamp)\n  (:predicates (lit ?x) (lamp ?x))\n  (:action switch_on\n    :parameters (?x)\n"
    files = {
        "domain": f"{lamp}    :precondition (and (lit ?x) (lamp ?x))\n    :effect (lit ?x)))\n",
        "mine": f"{lamp}    :precondition (lamp ?x)\n    :effect (lit ?x)))\n",
        "hall": "(define (problem hall) (:domain lamp) (:objects l) (:init (lamp l)) (:goal (lit l)))\n",
    }
    for name, text in files.items():
        (tmp_path / f"{name}.pddl").write_text(text)
    test = {"id": "a", "domain": "-", "environment": "-", "text": "Switch on the lamp.", "goal": "(lit l)"}
    (tmp_path / "my.sentences.jsonl").write_text(json.dumps(test))
    given = tmp_path / "mine.pddl", tmp_path / "hall.pddl"
    assert "(switch_on l)" in tmd("plan", *given).out
    assert tmd("view", *given, "--out", tmp_path / "a.html").code == 0
    assert "switch_on" in (tmp_path / "a.html").read_text()
    assert tmd("export", *given, tmp_path / "out").code == 0
    assert "(switch_on l)" in (tmp_path / "out" / "plan.plan").read_text()
    assert "switch_on(l)" in tmd("ground", *given, "--text", "Switch on l.").out
    assert "1 of 1 right" in tmd("test", *given).out
    assert tmd("ground", *given, "x.pddl", "--text", "Switch on l.").code == 2
