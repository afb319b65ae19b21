"""tmd fmt: twice is once, nothing else is said afterwards, and no comment is lost."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tmd.diagnostics import TmdError
from tmd.format.files import format_file
from tmd.format.pddl_layout import WIDTH, format_pddl
from tmd.pddl.reading.reader import parse_domain

ROOT = Path(__file__).resolve().parents[2]
BUNDLED = sorted(path for kind in ("domains", "problems") for path in (ROOT / kind).rglob("*.pddl"))
_TOKEN = re.compile(r";.*|[()]|[^\s();]+")

WORDS = st.sampled_from(["and", "or", "p", "?x", "-", "thing", ":action", ":parameters", ":effect", "define", "forall"])
GROUPS = st.recursive(
    WORDS, lambda inner: st.lists(inner, max_size=5).map(lambda parts: ["(", *parts, ")"]), max_leaves=40
)
SPACES = st.lists(
    st.sampled_from(["", " ", "  ", "\n", "\n\n\n", "\t", " ; a note\n", "\n   ; (another) one\n"]), min_size=1
)


def flat(node: object) -> list[str]:
    return [node] if isinstance(node, str) else [word for part in node for word in flat(part)]  # type: ignore[attr-defined]


def tokens(text: str) -> list[str]:
    return [match[0].rstrip() for line in text.splitlines() for match in _TOKEN.finditer(line)]


@settings(max_examples=150, deadline=None)
@given(GROUPS.filter(lambda node: not isinstance(node, str)), SPACES)
def test_any_groups(node: object, spaces: list[str]) -> None:
    words = flat(node)
    text = "".join(f"{word} {spaces[number % len(spaces)]}" for number, word in enumerate(words))
    laid = format_pddl(text)
    assert format_pddl(laid) == laid
    assert tokens(laid) == tokens(text)
    assert all(line == line.rstrip() for line in laid.splitlines())
    assert "\n\n\n" not in laid


def test_one_line_becomes_readable() -> None:
    line = (
        "(define (domain d)(:predicates (p ?x)(q ?x)) ; two\n"
        "(:action a :parameters (?x) :precondition (and (p ?x)(not (q ?x))) :effect (q ?x)))"
    )
    assert format_pddl(line) == (
        "(define (domain d)\n"
        "  (:predicates (p ?x) (q ?x)) ; two\n"
        "  (:action a\n"
        "    :parameters (?x)\n"
        "    :precondition (and (p ?x) (not (q ?x)))\n"
        "    :effect (q ?x)))\n"
    )


def test_long_lines_are_broken() -> None:
    objects = " ".join(f"object{n}" for n in range(100))
    atoms = " ".join(f"(p object{n})" for n in range(100))
    laid = format_pddl(f"(define (problem x) (:domain d) (:objects {objects}) (:init {atoms}) (:goal (p object1)))")
    assert max(map(len, laid.splitlines())) <= WIDTH
    assert format_pddl(laid) == laid


@pytest.mark.parametrize("path", BUNDLED, ids=lambda path: str(path.relative_to(ROOT)))
def test_what_is_bundled_is_laid_out(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert format_pddl(text) == text


def test_what_does_not_match_is_left_alone() -> None:
    with pytest.raises(TmdError, match="never closed"):
        format_pddl("(define (domain d)")


def test_the_domain_stays_the_same() -> None:
    text = (ROOT / "domains" / "kitchen" / "domain.pddl").read_text(encoding="utf-8")
    squeezed = " ".join(line.partition(";")[0] for line in text.splitlines())
    assert parse_domain(format_pddl(squeezed)) == parse_domain(text)


TOO_MUCH = {
    "levels of PDDL": ("x.pddl", "(" * 101 + ")" * 101, "nested-too-deeply"),
    "PDDL": ("x.pddl", "(a)" * 3_500_000, "too-large"),
    "words on one line": ("x.pddl", f"(define (domain d) (:types {'a ' * 30_000}))", "too-large"),
}


@pytest.mark.parametrize("kind", TOO_MUCH)
def test_what_is_too_much_is_refused_as_by_check(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str) -> None:
    monkeypatch.setattr("tmd.format.pddl_layout._MOST_WORK", 300_000)  # the whole of it takes half a minute
    name, text, code = TOO_MUCH[kind]
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(TmdError) as caught:
        format_file(path)
    assert caught.value.code == code
    assert path.read_text() == text
