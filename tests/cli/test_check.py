"""``tmd check`` and ``tmd fmt`` as a user runs them."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

GOOD = "(define (domain d)\n  (:predicates (p ?x))\n  (:action a\n    :parameters (?x)\n    :effect (p ?x)))\n"
FIRST_LINE = re.compile(r"^(.+?):(\d+):(\d+): (error|warning)\[([a-z0-9-]+)\]: (.*)$")
"""What docs/errors.md gives to editors."""
Tmd = Callable[..., Any]


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "d.pddl"
    path.write_text(GOOD)
    return path


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
