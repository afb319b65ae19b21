"""The pages: examples are run, links lead somewhere, and nothing speaks of one machine.

An example is a ``console`` block after a ``<!-- tested -->`` line; its commands must print what stands below them.
A block after ``<!-- file: NAME -->`` is a file that the examples of its page find in their working directory.
Blocks after ``<!-- tested: one after another -->`` are a walk: the commands of the page run in one directory, which is
empty at first, and a block after ``<!-- write: PATH -->`` (or ``append:``) writes that file when its turn comes.
A ``json`` block after ``<!-- format: NAME -->`` holds values of that format, one a line.
``python -m tests.test_docs`` runs the examples and writes their output into the pages again, and the schemas.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from pydantic import TypeAdapter

from tests import test_notebook
from tests.cli.conftest import fork_server
from tmd.records.schemas import FORMATS, schema_text, write_schemas

ROOT = Path(__file__).resolve().parents[1]
SCHEMAS = ROOT / "docs" / "schemas"
_BLOCK = re.compile(r"(?<=<!-- tested -->\n```console\n).*?(?=^```$)", re.MULTILINE | re.DOTALL)
_WALK = re.compile(
    r"<!-- tested: one after another -->\n```console\n(?P<console>.*?)^```$"
    r"|<!-- (?P<how>write|append): (?P<path>[\w./]+) -->\n```\w*\n(?P<content>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)
_FILE = re.compile(r"<!-- file: ([\w.]+) -->\n```\w*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_VALUES = re.compile(r"<!-- format: ([\w-]+) -->\n```json\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_PRINTED = re.compile(r"tmd (parse|ground|run|test) [^|&>]*--json[^|&>]*")
_FENCED = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
_HEADING = re.compile(r"^#+ +(.*?) *$", re.MULTILINE)
_CODE = re.compile(r"`[^`]*`")
_AVOIDED = re.compile(r"\b(?:akin|anew|besides|shall|told|whoever)\b", re.IGNORECASE)
_OF_ONE_MACHINE = re.compile(r"(?<![\w.])/(?:home|root|Users|work|tmp|mnt|opt|srv)/\w+")


def pages() -> list[Path]:
    """Every page that git would keep."""
    listed = [*ROOT.glob("*.md"), *(p for d in ("docs", "domains", "problems") for p in (ROOT / d).rglob("*.md"))]
    return sorted(listed)


def examples() -> Iterator[tuple[Path, str, str]]:
    """Page, command and the output that the page shows."""
    for page in pages():
        for block in _BLOCK.findall(page.read_text(encoding="utf-8")):
            for command, output in _commands(block):
                yield page, command, output


def _commands(block: str) -> Iterator[tuple[str, str]]:
    """The commands of a block with their output; a backslash continues a command on the next line."""
    for piece in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
        command, _, output = piece.partition("\n")
        while command.endswith("\\"):
            more, _, output = output.partition("\n")
            command = f"{command}\n{more}"
        yield command, output


def executed(page: Path, command: str, directory: Path) -> str:
    """What a command prints, standard error included; ``tmd`` is the one of this checkout."""
    for name in ("domains", "problems", "tests"):
        (directory / name).symlink_to(ROOT / name)
    for name, content in _FILE.findall(page.read_text(encoding="utf-8")):
        (directory / name).write_text(content, encoding="utf-8")
    return _printed(command, directory, directory / "bin")


_PROGRESS = ("learning from the demonstrations of ", "compiling the search")
"""How lines of progress begin: whether they are printed depends on how quick the machine is."""


def _printed(command: str, directory: Path, programs: Path) -> str:
    programs.mkdir(exist_ok=True)
    forked = f"-I -S {ROOT}/tests/cli/fork_server.py {fork_server()} "
    for name, arguments in (("tmd", forked), ("python", "")):
        program = programs / name
        program.write_text(f'#!/bin/sh\nexec "{sys.executable}" {arguments}"$@"\n', encoding="utf-8")
        program.chmod(0o755)
    environment = os.environ | {
        "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
        "COLUMNS": "100",
    }
    done = subprocess.run(
        command,
        shell=True,
        cwd=directory,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=120,
        check=False,
    )
    lines = done.stdout.decode("utf-8").splitlines(keepends=True)
    return "".join(line for line in lines if not line.startswith(_PROGRESS))


def walked(page: Path, directory: Path) -> str:
    """The page as it would be if every walk printed what it prints now."""
    text, place, found = page.read_text(encoding="utf-8"), 0, ""
    (directory / "here").mkdir()
    for step in _WALK.finditer(text):
        if step["path"]:
            path = directory / "here" / step["path"]
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("a" if step["how"] == "append" else "w", encoding="utf-8") as file:
                file.write(step["content"])
            continue
        found += text[place : step.start("console")]
        for command, _ in _commands(step["console"]):
            printed = _printed(f"unset TMD_LEARNED; {command}", directory / "here", directory / "bin")
            found += f"$ {command}\n{printed}"
        place = step.end("console")
    return found + text[place:]


WALKS = [page for page in pages() if "<!-- tested: one after another -->" in page.read_text(encoding="utf-8")]


@pytest.mark.parametrize("page", WALKS, ids=lambda page: page.name)
def test_a_walk_goes_as_the_page_says(page: Path, tmp_path: Path, learned: Path) -> None:
    assert walked(page, tmp_path) == page.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("page", "command", "output"),
    [pytest.param(*example, id=f"{example[0].name}-{example[1][:40]}") for example in examples()],
)
def test_example_prints_what_the_page_shows(
    page: Path, command: str, output: str, tmp_path: Path, learned: Path
) -> None:
    assert executed(page, command, tmp_path) == output


def test_there_are_examples() -> None:
    assert {"README.md", "cli.md"} <= {page.name for page, _, _ in examples()}


def test_links_lead_somewhere() -> None:
    broken = []
    for page in pages():
        text = _FENCED.sub("", page.read_text(encoding="utf-8"))
        for target in _LINK.findall(text):
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            path = (page.parent / name).resolve() if name else page
            if not path.exists() or (anchor and anchor not in _anchors(path)):
                broken.append((page, target))
    assert not broken


def _anchors(page: Path) -> set[str]:
    """The anchors of a page's headings, as code forges make them."""
    headings = _HEADING.findall(_FENCED.sub("", page.read_text(encoding="utf-8")))
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_no_page_speaks_of_one_machine() -> None:
    assert [page for page in pages() if _OF_ONE_MACHINE.search(page.read_text(encoding="utf-8"))] == []


def test_pages_avoid_words_that_are_hard_to_read() -> None:
    found = {}
    for page in pages():
        prose = _CODE.sub("", _FENCED.sub("", page.read_text(encoding="utf-8")))
        if words := _AVOIDED.findall(prose):
            found[page.name] = words
    assert not found


def _json_values() -> Iterator[object]:
    """The JSON texts of the pages with the name of their format."""
    names = {"ground": "grounding"}
    for page, command, output in examples():
        if printed := _PRINTED.fullmatch(command):
            name = "goal-only" if "--goal-only" in command else names.get(printed[1], printed[1])
            yield pytest.param(name, output, id=f"{page.name}-{command[:40]}")
    for page in pages():
        for name, block in _VALUES.findall(page.read_text(encoding="utf-8")):
            for number, line in enumerate(block.splitlines()):
                yield pytest.param(name, line, id=f"{page.name}-{name}-{number}")


@pytest.mark.parametrize(("name", "text"), list(_json_values()))
def test_json_on_the_pages_is_of_its_format(name: str, text: str) -> None:
    TypeAdapter(FORMATS[name]).validate_python(json.loads(text))


@pytest.mark.parametrize(("name", "text"), list(_json_values()))
def test_json_on_the_pages_is_of_its_schema(name: str, text: str) -> None:
    jsonschema = pytest.importorskip("jsonschema", reason="the package jsonschema is not installed")
    jsonschema.validate(json.loads(text), json.loads((SCHEMAS / f"{name}.schema.json").read_text(encoding="utf-8")))


def test_a_grounding_is_of_its_format_and_schema(tmp_path: Path, learned: Path) -> None:
    """No page shows a whole one."""
    command = 'tmd ground --environment corner1 --text "Take the book." --json'
    text = executed(ROOT / "README.md", command, tmp_path)
    test_json_on_the_pages_is_of_its_format("grounding", text)
    test_json_on_the_pages_is_of_its_schema("grounding", text)


def test_the_schemas_are_those_of_the_classes() -> None:
    written = {path.name.removesuffix(".schema.json"): path.read_text(encoding="utf-8") for path in SCHEMAS.iterdir()}
    assert written == {name: schema_text(name) for name in FORMATS}, "write them again: python -m tmd.records"


def test_the_page_on_json_links_to_every_schema() -> None:
    page = (ROOT / "docs" / "json.md").read_text(encoding="utf-8")
    assert set(re.findall(r"\(schemas/([\w-]+)\.schema\.json\)", page)) == set(FORMATS)


def rewrite() -> None:
    """Write the output of every example into its page or into the notebook, and the schemas of the formats."""
    write_schemas(SCHEMAS)
    test_notebook.rewrite()
    for page in pages():
        text = page.read_text(encoding="utf-8")
        page.write_text(_BLOCK.sub(lambda block, page=page: _again(page, block[0]), text), encoding="utf-8")
    for page in WALKS:
        with tempfile.TemporaryDirectory() as directory:
            page.write_text(walked(page, Path(directory)), encoding="utf-8")


def _again(page: Path, block: str) -> str:
    found = ""
    for command, _ in _commands(block):
        with tempfile.TemporaryDirectory() as directory:
            found += f"$ {command}\n{executed(page, command, Path(directory))}"
    return found


if __name__ == "__main__":
    rewrite()
