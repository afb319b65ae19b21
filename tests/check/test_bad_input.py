"""Whatever a file holds, every problem has a place in it, and nothing takes long or crashes."""

from __future__ import annotations

import os
import random
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tmd.check.checker import Checker
from tmd.check.diagnostic import Diagnostic
from tmd.check.pddl_file import check_domain_text, check_problem_text
from tmd.check.report import check_paths
from tmd.diagnostics import TmdError

ROOT = Path(__file__).resolve().parents[2]
CAFE = ROOT / "experiments" / "checkers" / "cases" / "none"
DOMAIN = (CAFE / "domain.pddl").read_text(encoding="utf-8")
PROBLEM = (CAFE / "problem.pddl").read_text(encoding="utf-8")


def found(path: Path) -> list[Diagnostic]:
    checker = Checker(ROOT / "domains", None, ROOT / "problems")
    checker.check(path)
    checker.finish()
    return checker.findings.sorted()


def kinds(path: Path) -> set[str]:
    return {diagnostic.code for diagnostic in found(path)}


FILES: dict[str, tuple[str, bytes, str]] = {
    "a chain of types": (
        "d.pddl",
        f"(define (domain d) (:types {' '.join(f't{n} - t{n + 1}' for n in range(3_000))}))".encode(),
        "nested-too-deeply",
    ),
    "binary": ("d.pddl", b"\x7fELF\x00\x01", "not-text"),
    "utf-16": ("d.pddl", DOMAIN.encode("utf-16"), "not-utf8"),
    "latin-1": ("d.pddl", b"(define (domain caf\xe9))", "not-utf8"),
    "empty": ("d.pddl", b"", "empty-file"),
    "only a comment": ("d.pddl", b"; nothing\n", "empty-file"),
    "ten megabytes": ("d.pddl", b"(a)" * 3_500_000, "too-large"),
    "escape": ("d.pddl", DOMAIN.replace("held", "held\x1b[31m", 1).encode(), "control-character"),
    "ten thousand levels": ("d.pddl", b"(" * 10_000 + b")" * 10_000, "nested-too-deeply"),
    "levels of a call": (
        "d.pddl",
        b"(define (domain d) (:action a :precondition (and on" + b"(" * 10_000 + b")" * 10_003,
        "nested-too-deeply",
    ),
    "levels of a domain": ("d.pddl", b"(define (domain d) " + b"(" * 10_000 + b")" * 10_001, "nested-too-deeply"),
    "never closed": ("d.pddl", b"(" * 10_000, "unclosed-parenthesis"),
    "only closed": ("d.pddl", b")" * 10_000, "extra-parenthesis"),
    "unterminated string": ("d.pddl", DOMAIN.replace("(full ?m))))", '"(full ?m))))').encode(), "syntax"),
    "yaml levels": ("objects.yaml", b"[" * 10_000, "nested-too-deeply"),
    "yaml levels on lines of their own": ("objects.yaml", b"[\n" * 60, "nested-too-deeply"),
    "yaml levels of mappings": ("objects.yaml", b"{a: " * 50_000, "nested-too-deeply"),
    "yaml values": ("objects.yaml", b"- 1\n" * 500_001, "too-large"),
    "yaml list as a key": ("objects.yaml", b"? [a]\n: 1\n", "bad-value"),
    "yaml mapping as a key": ("objects.yaml", b"{{a}}: 1\n", "bad-value"),
    "yaml digits": ("objects.yaml", b"facts: " + b"9" * 5_000, "yaml-syntax"),
    "yaml no day": ("objects.yaml", b"facts: 2020-02-30", "yaml-syntax"),
    "yaml no number": ("objects.yaml", b"facts: 0x_", "yaml-syntax"),
    "yaml bomb": ("objects.yaml", b"a: &a [x]\nb: &b [*a, *a]\nc: [*b, *b]\n", "yaml-alias"),
    "yaml tag": ("objects.yaml", b"facts: !!python/object/apply:os.system [ls]\n", "yaml-tag"),
    "yaml twice": ("objects.yaml", b"facts: []\nfacts: []\n", "duplicate-key"),
    "yaml string": ("objects.yaml", b'facts: ["a]\n', "yaml-syntax"),
    "yaml empty": ("objects.yaml", b"", "empty-file"),
    "classes without instructions": ("objects.yaml", b"facts: []\n", "missing-file"),
    "json": ("demonstrations.jsonl", b'{"id": \n', "json-syntax"),
    "json levels": ("demonstrations.jsonl", b"[" * 100_000 + b"\n", "nested-too-deeply"),
    "json digits": ("demonstrations.jsonl", b'{"id": ' + b"9" * 5_000 + b"}", "json-syntax"),
    "json list": ("demonstrations.jsonl", b"[1]\n", "bad-demonstration"),
}  # fmt: skip


@pytest.mark.parametrize("name", FILES)
def test_a_bad_file_is_told_with_a_place_in_it(tmp_path: Path, name: str) -> None:
    file, data, kind = FILES[name]
    path = tmp_path / file
    path.write_bytes(data)
    told = found(path)
    assert set(kind.split()) & {diagnostic.code for diagnostic in told}
    assert all(d.location.file == str(path) and d.location.line > 0 and d.location.column > 0 for d in told)
    assert len(told) < 250


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.replace("\n", "\r"),
        lambda text: text.replace("  ", "\t"),
        lambda text: "\ufeff" + text,
        str.upper,
        lambda text: " ".join(line.partition(";")[0] for line in text.splitlines()),
        lambda text: text.replace(")", " ; a comment (\n)"),
    ],
)
def test_other_ways_to_write_the_same_are_fine(tmp_path: Path, change: Callable[[str], str]) -> None:
    (tmp_path / "domain.pddl").write_bytes(change(DOMAIN).encode())
    (tmp_path / "p.pddl").write_bytes(change(PROBLEM).encode())
    assert found(tmp_path) == []


def test_a_link_out_of_the_folder_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "secret.pddl").write_text(DOMAIN)
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "domain.pddl").symlink_to(tmp_path / "secret.pddl")
    assert kinds(tmp_path / "folder") == {"outside-folder"}


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_a_file_without_permission(tmp_path: Path) -> None:
    path = tmp_path / "d.pddl"
    path.write_text(DOMAIN)
    path.chmod(0)
    assert kinds(path) == {"unreadable"}


def test_a_directory_that_is_called_like_a_file(tmp_path: Path) -> None:
    (tmp_path / "d.pddl").mkdir()
    assert kinds(tmp_path) == {"unreadable"}


def test_several_domains_of_one_name(tmp_path: Path) -> None:
    for name in ("a.pddl", "b.pddl"):
        (tmp_path / name).write_text(DOMAIN)
    (tmp_path / "p.pddl").write_text(PROBLEM)
    assert kinds(tmp_path) == {"ambiguous-domain"}
    (tmp_path / "b.pddl").unlink()
    assert kinds(tmp_path) == set()
    (tmp_path / "a.pddl").unlink()
    assert kinds(tmp_path) == {"domain-not-found"}


def test_a_domain_that_is_named_with_the_problem_is_its_domain(tmp_path: Path) -> None:
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "domain.pddl").write_text(DOMAIN)
    (tmp_path / "two" / "domain.pddl").write_text(DOMAIN.replace("(at ", "(lies "))
    problem = tmp_path / "two" / "p.pddl"
    problem.write_text(PROBLEM)
    assert check_paths([tmp_path / "one" / "domain.pddl", problem]).diagnostics == ()
    assert check_paths([problem]).diagnostics != ()


def test_of_a_hopeless_file_the_first_problems_are_told(tmp_path: Path) -> None:
    objects = " ".join(f"o{n}" for n in range(3_000))
    atoms = " ".join(f"(at x{n} counter)" for n in range(3_000))
    (tmp_path / "domain.pddl").write_text(DOMAIN)
    (tmp_path / "p.pddl").write_text(
        f"(define (problem p) (:domain cafe) (:objects {objects} - mug) (:init {atoms}) (:goal (and)))"
    )
    told = found(tmp_path)
    assert {d.code for d in told} == {"unknown-object", "too-many"}
    assert len(told) == 201


def test_nothing_at_a_path(tmp_path: Path) -> None:
    with pytest.raises(TmdError, match="no such file"):
        found(tmp_path / "nowhere")


def test_all_problems_of_a_file_are_told_at_once() -> None:
    text = DOMAIN.replace("(tap ?p))\n", "(tpa ?p)\n", 1).replace("thing place - object", "thing - place place - objct")
    text = text.replace(":precondition (held ?x)", ":precond (held ?x)")
    told = {(fault.code, fault.location.line) for fault in check_domain_text(text, "d").faults if fault.location}
    assert ("unclosed-parenthesis", 25) in told
    assert {code for code, _ in told} >= {"unknown-predicate", "unknown-type", "unknown-keyword"}


@settings(max_examples=120, deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 4))
def test_damaged_text_never_crashes_the_checker(seed: int, cuts: int) -> None:
    choose = random.Random(seed)
    text = choose.choice([DOMAIN, PROBLEM])
    for _ in range(cuts):
        start = choose.randrange(len(text))
        insert = choose.choice(["", "(", ")", "((", " - ", "?x", ":action", "\x00", "é", "(:init", '"', ";", "(not)"])
        text = text[:start] + insert + text[start + choose.randrange(12) :]
    lines = text.split("\n")
    checked = check_domain_text(text, "f")
    told = [*checked.faults, *check_problem_text(text, "f", check_domain_text(DOMAIN, "d")).faults]
    for fault in told:
        place = fault.location
        assert place is not None and fault.code
        assert 1 <= place.line <= len(lines)
        assert 1 <= place.column <= len(lines[place.line - 1]) + 1


@settings(max_examples=80, deadline=None)
@given(st.binary(max_size=200))
def test_any_bytes_in_any_file(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    folder = tmp_path_factory.mktemp("any")
    for name in ("domain.pddl", "objects.yaml", "demonstrations.jsonl"):
        (folder / name).write_bytes(data)
    assert all(d.location.line > 0 for d in found(folder))
