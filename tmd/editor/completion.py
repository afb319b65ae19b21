"""Completion: the words that fit at a place of a PDDL or YAML file."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from tmd.diagnostics import Location
from tmd.editor.names import NameKind, groups_in, names_in_section
from tmd.editor.project import YAML, Project
from tmd.editor.yaml_names import keys_in, kinds_at, path_at
from tmd.language.lexicon.file import KEYS, bases_near
from tmd.pddl.model import OBJECT
from tmd.pddl.reading.reader import REQUIREMENTS
from tmd.pddl.reading.syntax import Group, Node, Word, split_lines
from tmd.world.problem_domain import domains_in, kind_and_name

_SECTIONS = {
    "domain": (":requirements", ":types", ":constants", ":predicates", ":functions", ":action", ":derived"),
    "problem": (":domain", ":requirements", ":objects", ":init", ":goal", ":metric"),
}
_PARTS = (":parameters", ":precondition", ":effect")
_CONDITIONS = ("and", "or", "not", "imply", "forall", "exists", "=")
_EFFECTS = ("and", "not", "forall", "when", "increase")
_BINDING = (":action", ":derived", "forall", "exists")
_FORMULAS = frozenset({":action", ":derived", ":init", ":goal"})


def complete(project: Project, file: Path, text: str) -> dict[str, str]:
    """Return the words that may follow ``text``, a file up to the cursor, each with what it is."""
    lines = split_lines(text)
    if file.suffix in YAML:
        return _in_yaml(project, file, lines)
    return {} if ";" in lines[-1] else _in_pddl(project, file, text)


def _in_pddl(project: Project, file: Path, text: str) -> dict[str, str]:
    typed = re.split(r"[\s()]", text)[-1]
    opened = _opened(text.removesuffix(typed))
    if not opened:
        return {}
    top = opened[-1]
    if typed.startswith("?"):
        return _variables(opened)
    if _word(top.parts[-1:]) == "-" or top.head == "either":
        return {**_declared(project, file, NameKind.TYPE), OBJECT: "type"}
    return _in_formula(project, file, opened) if len(opened) > 2 else _in_section(project, file, opened)


def _opened(text: str) -> list[Group]:
    """Return the groups that are open at the end of a text, which is where reading ends them."""
    lines = split_lines(text)
    end = Location("", len(lines), len(lines[-1]) + 1)
    opened: list[Group] = []
    last: Sequence[Node] = groups_in(text, "")[-1:]
    while last and isinstance(last[0], Group) and last[0].end == end:
        opened.append(last[0])
        last = last[0].parts[-1:]
    return opened


def _word(part: Sequence[Node]) -> str:
    return part[0].text if part and isinstance(part[0], Word) else ""


def _variables(opened: list[Group]) -> dict[str, str]:
    """Return the variables that open groups bind, without those of a list that is open itself."""
    top, scopes = opened[-1], {group.location for group in opened}
    names = (name for section in opened[1:2] for name in names_in_section(section) if name.scope in scopes)
    return {n.name: "variable" for n in names if n.place < top.location or top.head in _BINDING}


def _in_section(project: Project, file: Path, opened: list[Group]) -> dict[str, str]:
    """Return what fits directly in ``(define ...)`` or in a section of it."""
    top = opened[-1]
    if top.head == ":requirements":
        return dict.fromkeys(REQUIREMENTS, "requirement")
    if top.head == ":domain":
        return dict.fromkeys((*domains_in(file.parent), *domains_in(file.parent.parent)), "domain")
    if top.head == ":action" and len(top.parts) > 1:
        written = {_word([part]) for part in top.parts}
        return {part: "keyword" for part in _PARTS if part not in written}
    kind = kind_and_name(project.text(file))[0]
    return {} if top.parts or len(opened) == 1 else dict.fromkeys(_SECTIONS[kind], "keyword")


def _in_formula(project: Project, file: Path, opened: list[Group]) -> dict[str, str]:
    top, section = opened[-1], opened[1]
    keyword = _word(section.parts[-2:-1])
    if section.head not in _FORMULAS or keyword == ":parameters":
        return {}
    if top.parts:
        return _variables(opened) | _declared(project, file, NameKind.OBJECT)
    words = {":init": ("not", "=")}.get(section.head, _EFFECTS if keyword == ":effect" else _CONDITIONS)
    return _declared(project, file, NameKind.PREDICATE, NameKind.FUNCTION) | dict.fromkeys(words, "keyword")


def _declared(project: Project, file: Path, *kinds: NameKind) -> dict[str, str]:
    return {name.name: str(name.kind) for name in project.declarations(file, *kinds)}


def _in_yaml(project: Project, file: Path, lines: Sequence[str]) -> dict[str, str]:
    last = lines[-1]
    if re.search(r"(^|\s)#", last):
        return {}
    if last.count("(") > last.count(")"):
        return _in_pddl(project, file, f"(define (:goal {last[last.index('(') :]}")
    path = path_at(lines)
    value = re.search(r"(?:[\w-]+:\s|^\s*-\s|\[)(?:[^{}\[\]]*,)?\s*([^{}\[\],]*)$", last)
    if value is None or re.search(r"\{[^{}\[:]*(,[^{}\[:]*)?$", last):
        keys = keys_in(file, path) if path or file.name != "lexicon.yaml" else KEYS
        return dict.fromkeys(keys, "key") | _declared(project, file, *kinds_at(path, 0, is_key=True))
    if path[-1:] == ("include",):
        return dict.fromkeys(bases_near(file), "base lexicon")
    return _declared(project, file, *kinds_at(path, value[1].count(" "), is_key=False))
