"""The names that the language server knows: their places are right in any text, and renaming them breaks nothing."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.conftest import ROOT
from tmd.check.report import check_paths
from tmd.diagnostics import Location
from tmd.editor.completion import complete
from tmd.editor.names import NameKind, Occurrence, Role, names_in_pddl
from tmd.editor.project import Project
from tmd.editor.yaml_names import names_in_yaml
from tmd.files import UNSAVED
from tmd.pddl.reading.syntax import split_lines
from tmd.world.roots import Roots

WORDS = [
    "(", ")", "(", ")", "?x", "-", "=", "7", "either", "car", "define", "forall", "when", "not", ":action",
    ":parameters", ":effect", ":types", ":derived", ":init", "; x\n", "\n", "\r\n", "\u00e4", "\U0001f6a2",
]  # fmt: skip
YAML = [
    "objects:\n", "  a: {class: b, at: on c}\n", "states: {p: [q]}\n", "- (p ?x)\n",
    "(", "'", '"', "|\n", "#", ": ", "\u2028",
]  # fmt: skip


@settings(max_examples=60)
@given(st.lists(st.sampled_from(WORDS), max_size=60), st.lists(st.sampled_from(YAML), max_size=12))
def test_every_name_stands_at_its_place(pddl: list[str], yaml: list[str]) -> None:
    pddl_text = f"(define (domain d) {' '.join(pddl)}"
    for text, names in (
        (pddl_text, names_in_pddl(pddl_text, "f")),
        ("".join(yaml), [n for n in names_in_yaml("".join(yaml), "f") if "\u2028" not in yaml]),
    ):
        lines = split_lines(text)
        for name in names:
            assert lines[name.place.line - 1][name.place.column - 1 :].lower().startswith(name.name)
    complete(Project(), Path("f.pddl"), pddl_text)
    complete(Project(), Path("objects.yaml"), "".join(yaml))


def renamed(project: Project, file: Path, name: Occurrence, new: str) -> None:
    """Rename, and write the files."""
    edits = sorted({other.place for other in project.rename(file, name, new)}, reverse=True)
    for place in edits:
        path = Path(place.file)
        lines = path.read_text().split("\n")
        line, begin = lines[place.line - 1], place.column - 1
        lines[place.line - 1] = line[:begin] + new + line[begin + len(name.name) :]
        path.write_text("\n".join(lines))


@pytest.mark.parametrize("domain", ["01_blocks", "03_drawer"])
def test_a_renamed_domain_has_no_fault_that_it_had_not(domain: str, tmp_path: Path) -> None:
    for part in ("domains", "problems"):
        shutil.copytree(ROOT / part / domain, tmp_path / part / domain)
    shutil.copytree(ROOT / "domains" / "base", tmp_path / "domains" / "base")
    for path in (tmp_path / "problems").rglob("*.jsonl"):
        path.unlink()  # these are not renamed, which the server says
    project = Project(Roots(tmp_path / "domains", tmp_path / "problems"))
    folder = tmp_path / "domains" / domain
    file = folder / "domain.pddl"
    for kind in NameKind:
        declared = {n.name: n for n in project.names(file) if n.kind is kind and n.role is Role.DECLARED}
        for name, new in zip(list(declared)[-2:], ("widget", "gadget"), strict=False):
            found = next(n for n in project.names(file) if (n.kind, n.name, n.role) == (kind, name, Role.DECLARED))
            renamed(project, file, found, f"?{new}" if kind is NameKind.VARIABLE else f"{new}_{kind}")
    checked = check_paths([folder, tmp_path / "problems"], domains=tmp_path / "domains", problems=tmp_path / "problems")
    assert [d for d in checked.diagnostics if d.code != "stale-domain"] == []


def test_a_variable_is_renamed_where_it_is_bound_only(tmp_path: Path) -> None:
    text = """(define (domain d) (:predicates (p ?x) (q ?x))
  (:action a :parameters (?x) :precondition (and (p ?x) (forall (?x) (q ?x))) :effect (not (p ?x))))"""
    file = tmp_path / "domain.pddl"
    file.write_text(text)
    project = Project()
    place = Location(str(file), 2, text.split("\n")[1].index("(?x) (q ?x)") + 2)
    (name,) = project.at(file, place.line, place.column)
    renamed(project, file, name, "?y")
    assert file.read_text() == text.replace("(forall (?x) (q ?x))", "(forall (?y) (q ?y))")


def test_unsaved_text_goes_before_the_disk(tmp_path: Path) -> None:
    file = tmp_path / "domain.pddl"
    file.write_text("(define (domain d) (:predicates (old)))")
    UNSAVED[file] = b"(define (domain d) (:predicates (new)))"
    try:
        assert [name.name for name in Project().names(file)] == ["new"]
    finally:
        del UNSAVED[file]
    assert [name.name for name in Project().names(file)] == ["old"]
