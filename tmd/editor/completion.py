"""Completion: the words that fit at a place of a PDDL or YAML file."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from tmd.diagnostics import Location
from tmd.editor.names import NameKind
from tmd.editor.project import Project
from tmd.editor.yaml_names import keys_at, kind_of_keys, kinds_of_value, path_at
from tmd.language.lexicon.file import KEYS, bases_near
from tmd.pddl.model import OBJECT
from tmd.pddl.reading.reader import REQUIREMENTS
from tmd.pddl.reading.syntax import Source, split_lines
from tmd.world.problem_domain import domains_in, kind_and_name

_SECTIONS = {
    "domain": (":requirements", ":types", ":constants", ":predicates", ":functions", ":action", ":derived"),
    "problem": (":domain", ":requirements", ":objects", ":init", ":goal", ":metric"),
}
_PARTS = (":parameters", ":precondition", ":effect")
_CONDITIONS = ("and", "or", "not", "imply", "forall", "exists", "=")
_EFFECTS = ("and", "not", "forall", "when", "increase")
_FORMULAS = frozenset({":action", ":derived", ":init", ":goal"})


@dataclass(slots=True)
class _Open:
    """A group that is open at the cursor: its parts so far, and the variables that it binds."""

    parts: list[str] = field(default_factory=list)
    variables: dict[str, None] = field(default_factory=dict)

    @property
    def head(self) -> str:
        return self.parts[0] if self.parts else ""

    @property
    def last(self) -> str:
        return self.parts[-1] if self.parts else ""

    def binds(self) -> bool:
        """Return whether the group that was closed last declares variables of this one."""
        second = self.head in ("forall", "exists", ":derived") and len(self.parts) == 2
        return second or self.parts[-2:-1] == [":parameters"]


def complete(project: Project, file: Path, text: str) -> dict[str, str]:
    """Return the words that may follow, each with what it is.

    Args:
        project: The files.
        file: The file that is edited.
        text: Its text up to the cursor.
    """
    lines = split_lines(text)
    if file.suffix in (".yaml", ".yml"):
        return _in_yaml(project, file, list(lines))
    return {} if ";" in lines[-1] else _in_pddl(project, file, lines)


def _in_pddl(project: Project, file: Path, lines: tuple[str, ...]) -> dict[str, str]:
    typed = re.split(r"[\s()]", lines[-1])[-1]
    opened = _opened((*lines[:-1], lines[-1].removesuffix(typed)))
    if not opened:
        return {}
    top = opened[-1]
    if typed.startswith("?"):
        return _variables(opened)
    if top.last == "-" or top.head == "either":
        return {**_declared(project, file, NameKind.TYPE), OBJECT: "type"}
    return _in_formula(project, file, opened) if len(opened) > 2 else _in_section(project, file, opened)


def _variables(opened: list[_Open]) -> dict[str, str]:
    return {name: "variable" for group in opened for name in group.variables}


def _in_section(project: Project, file: Path, opened: list[_Open]) -> dict[str, str]:
    """Return what fits directly in ``(define ...)`` or in a section of it."""
    top = opened[-1]
    if top.head == ":requirements":
        return dict.fromkeys(REQUIREMENTS, "requirement")
    if top.head == ":domain":
        return dict.fromkeys((*domains_in(file.parent), *domains_in(file.parent.parent)), "domain")
    if top.head == ":action" and len(top.parts) > 1:
        return {part: "keyword" for part in _PARTS if part not in top.parts}
    kind = kind_and_name(project.text(file))[0]
    return {} if top.parts or len(opened) == 1 else dict.fromkeys(_SECTIONS[kind], "keyword")


def _in_formula(project: Project, file: Path, opened: list[_Open]) -> dict[str, str]:
    top, section = opened[-1], opened[1]
    if section.head not in _FORMULAS or section.last == ":parameters":
        return {}
    if top.parts:
        return _variables(opened) | _declared(project, file, NameKind.OBJECT)
    words = {":init": ("not", "=")}.get(section.head, _EFFECTS if section.last == ":effect" else _CONDITIONS)
    return _declared(project, file, NameKind.PREDICATE, NameKind.FUNCTION) | dict.fromkeys(words, "keyword")


def _opened(lines: tuple[str, ...]) -> list[_Open]:
    """Return the groups that are open at the end of a text."""
    opened: list[_Open] = []
    for token, _ in Source("", lines).tokens(Location("", 1, 1)):
        if token == "(":
            opened.append(_Open())
        elif token == ")" and opened:
            closed = opened.pop()
            if opened:
                opened[-1].parts.append("()")
                if opened[-1].binds():
                    opened[-1].variables |= dict.fromkeys(part for part in closed.parts if part[0] == "?")
        elif opened:
            opened[-1].parts.append(token.lower())
    return opened


def _declared(project: Project, file: Path, *kinds: NameKind) -> dict[str, str]:
    return {name.name: str(name.kind) for name in project.declarations(file, *kinds)}


def _in_yaml(project: Project, file: Path, lines: list[str]) -> dict[str, str]:
    last = lines[-1]
    if re.search(r"(^|\s)#", last):
        return {}
    if last.count("(") > last.count(")"):
        return _in_pddl(project, file, (f"(define (:goal {last[last.index('(') :]}",))
    path = path_at(lines)
    value = re.search(r"(?:[\w-]+:\s|^\s*-\s|\[)(?:[^{}\[\]]*,)?\s*([^{}\[\],]*)$", last)
    if value is None or re.search(r"\{[^{}\[:]*(,[^{}\[:]*)?$", last):
        kind = kind_of_keys(path)
        keys = keys_at(_model(file), path) if path or file.name != "lexicon.yaml" else KEYS
        return dict.fromkeys(keys, "key") | (_declared(project, file, kind) if kind else {})
    if path[-1:] == ("include",):
        return dict.fromkeys(bases_near(file), "base lexicon")
    kinds = kinds_of_value(path, value[1].count(" "))
    return _declared(project, file, *kinds) if kinds else {}


def _model(file: Path) -> object:
    """Return the model of a YAML file."""
    from tmd.world.classes import ObjectsFile
    from tmd.world.environment import Environment

    if file.name in ("objects.yaml", "lexicon.yaml"):
        return ObjectsFile if file.name == "objects.yaml" else None
    return Environment
