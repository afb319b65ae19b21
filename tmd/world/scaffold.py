"""Start a new domain: a copy of a bundled one under a new name, an empty one, or one around a PDDL file.

The copy works at once, so that its author can change it line by line. Its environments are named after the new domain
(``yard1`` becomes ``mine1``). It has a problem, demonstrations, and a few sentence tests, which it passes.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from tmd.diagnostics import OutputError, TmdError
from tmd.files import make_directory, write_text
from tmd.pddl.reading.syntax import nearest, read_text
from tmd.short_repr import short_repr
from tmd.world.folder import find_domain, find_problems
from tmd.world.shape import NAME

# What a new domain can be begun from: plain PDDL, or classes with parts.
STARTS: Mapping[str, str] = {"plain": "01_blocks", "graph": "03_drawer"}
# The start without anything that has to be deleted.
EMPTY = "empty"
_DOMAIN = """\
(define (domain {name})
  (:requirements :strips :typing)

  ; Kinds of things.
  (:types
    item place - object)

  ; States of things.
  (:predicates
    (at ?x - item ?y - place))

  ; Name all that an action needs as its parameters: planners join conditions over parameters, and enumerate those of
  ; exists and forall.
  (:action carry
    :parameters (?x - item ?from ?to - place)
    :precondition (at ?x ?from)
    :effect (and (at ?x ?to) (not (at ?x ?from)))))
"""
_LEXICON = """\
# What verbs mean in every household: put, take, bring, ... `tmd check --explain put DOMAIN` shows the rows of a verb.
include: [household]

# What verbs mean here, such as: put X in Y: (at ?x ?y)
goals: []
"""
_SENTENCES = "requests.sentences.jsonl"
# Sentence tests in the last environment of the copy, with their goals; ``None``: nothing here is called that.
_ASKED: Mapping[str, tuple[tuple[str, str | None], ...]] = {
    "plain": (
        ("Put the red block on the green block.", "(on red_block green_block)"),
        ("Clear the red block.", "(clear red_block)"),
        ("Take the spoon.", None),
    ),
    "graph": (
        ("Put the key on the table.", "(at key1 table1 on)"),
        ("Open the top drawer.", "(opened cabinet1_top_drawer)"),
        ("Take the spoon.", None),
    ),
}
_SUFFIXES = (".pddl", ".yaml", ".jsonl", ".nl")


@short_repr(lambda made: made.folder)
@dataclass(frozen=True, slots=True)
class Scaffold:
    """A new domain.

    Attributes:
        files: Every file, in the order of their names.
        task: The name of the folder of its demonstrations; empty where there are none.
    """

    folder: Path
    problems: Path
    files: tuple[Path, ...]
    environments: tuple[str, ...]
    task: str


def scaffold(name: str, start: str, domains: Path, problems: Path, given: tuple[str, str] | None = None) -> Scaffold:
    """Begin the domain ``name`` in ``domains/name`` and ``problems/name``.

    ``name`` has lower-case letters, digits and ``_``; ``start`` is one of :data:`STARTS`, or ``empty``. The directories
    are made if they are not there. ``given`` are the texts of ``domain.pddl`` and ``lexicon.yaml``, in place of a
    start.

    Raises:
        TmdError: The name or the start is none, or another domain has that name.
        OutputError: It cannot be written; what was there is as it was.
    """
    _check(name, start)
    folder, place = domains / name, problems / name
    for path in (folder, place):
        if path.exists() or path.is_symlink():
            raise OutputError(f"{path} is there already; nothing was changed", hint="choose another name, or remove it")
    _refuse_hiding(name)
    if given is None and start != EMPTY:
        texts = _texts(name, start, folder, place)
    else:
        domain, lexicon = given or (_DOMAIN.format(name=name), _LEXICON)
        texts = {folder / "domain.pddl": domain, folder / "lexicon.yaml": lexicon, folder / "README.md": _readme(name)}
    for path in sorted(texts):
        make_directory(path.parent)
        write_text(path, texts[path])
    environments = sorted(path.stem for path in texts if path.parent == place / "environments")
    task = next((path.parent.name for path in texts if path.name == "demonstrations.jsonl"), "")
    return Scaffold(folder, place, tuple(sorted(texts)), tuple(environments), task)


def _check(name: str, start: str) -> None:
    if not re.fullmatch(NAME, name):
        raise TmdError(
            f"'{name}' cannot name a domain", hint="use lower-case letters, digits and _; begin with a letter"
        )
    if start not in (*STARTS, EMPTY):
        hint = nearest(start, [*STARTS, EMPTY], what="starts")
        raise TmdError(f"a domain cannot be begun from '{start}'", hint=f"{hint}; or give a file that ends in .pddl")


def _refuse_hiding(name: str) -> None:
    """Refuse the name of another domain, which the new one would hide."""
    try:
        found = find_domain(name)
    except TmdError:
        return
    raise TmdError(f"there is a domain '{name}' already: {found.path}", hint="choose another name: yours would hide it")


def _texts(name: str, start: str, folder: Path, place: Path) -> dict[Path, str]:
    """Return the text of every file of the copy."""
    source = find_domain(STARTS[start])
    shown = find_problems(STARTS[start])
    own = source.domain.name
    environments = sorted(path.stem for path in (shown / "environments").iterdir())
    words = {environment: name + environment.lstrip("abcdefghijklmnopqrstuvwxyz_") for environment in environments}

    def renamed(text: str) -> str:
        text = re.sub(rf"\((:?domain) {own}\)", rf"(\1 {name})", text)
        text = re.sub(rf"^domain: {STARTS[start]}$", f"domain: {name}", text, flags=re.MULTILINE)
        return re.sub("|".join(rf"(?<![a-z]){e}\b" for e in words), lambda m: words[m[0]], text)

    found = {folder / path.name: renamed(read_text(path)) for path in source.path.iterdir() if path.suffix in _SUFFIXES}
    for path in shown.rglob("*"):
        relative = path.relative_to(shown)
        if path.suffix in _SUFFIXES and "learned" not in relative.parts and path.name != _SENTENCES:
            found[place / renamed(str(relative))] = renamed(read_text(path))
    found[place / _SENTENCES] = _sentences(name, start, words[environments[-1]])
    found[folder / "README.md"] = _readme(name)
    return found


def _readme(name: str) -> str:
    return f"# {name}\n\nSay here what this domain is about, and what it leaves out.\n"


def _sentences(name: str, start: str, environment: str) -> str:
    """Sentence tests for the copy, as JSON Lines."""
    said = {"domain": name, "environment": environment}
    tests = ({"id": f"{name}-{n}", **said, "text": t, "goal": g} for n, (t, g) in enumerate(_ASKED[start], start=1))
    return "".join(json.dumps(test) + "\n" for test in tests)
