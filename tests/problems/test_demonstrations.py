"""Every demonstration in ``problems/`` works: it replays in its environment, reaches its stated end and its goal."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable
from functools import cache
from pathlib import Path
from statistics import mean, median
from typing import Any

import pytest

from tmd.pddl.model import Problem
from tmd.pddl.reading.reader import read_problem
from tmd.world.compile import compile_problem
from tmd.world.corpus import replay
from tmd.world.demonstration import Demonstration, read_demonstrations
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).resolve().parents[2]
CORPORA = sorted((ROOT / "problems").glob("*/*/demonstrations.jsonl"))
ENVIRONMENTS = sorted(p for p in (ROOT / "problems").glob("*/environments/*") if p.suffix in (".yaml", ".pddl"))
# what experiments are run on: ten texts for each environment, and a page that counts them
LARGE = [path for path in CORPORA if path.with_name("README.md").is_file()]
KEYS = {"id", "task", "environment", "text", "segments", "end_state", "goal"}
PER_ENVIRONMENT = 10
# what may stand between two segments of a text: words that join clauses, and thanks
JOINTS = {"an", "adn", "and", "then", "after", "that", "meanwhile", "so", "first", "thank", "you"}
# tasks whose ten texts are the same in every environment; of all others the texts differ
SAME_TEXTS = {"boiling_water", "coffee"}
# what the end of a task always names: the thing made, and nobody had made it before
PRODUCTS = {
    "kitchen/affogato": r"\(contains \w+ (vanilla|chocolate)_ice_cream\)",
    "kitchen/boiling_water": r"\(hot \w+\)",
    "kitchen/coffee": r"\(hot \w+\)",
    "kitchen/ramen": r"\(contains \w+ cooked_ramen\)",
}


def short(path: Path) -> str:
    return str(path.relative_to(ROOT / "problems"))


@cache
def domain_folder(name: str) -> DomainFolder:
    return DomainFolder(ROOT / "domains" / name)


@cache
def problem(environment: Path) -> Problem:
    folder = domain_folder(environment.parent.parent.name)
    if environment.suffix == ".pddl":
        return read_problem(environment, folder.domain)
    return compile_problem(load_environment(environment), folder)


@cache
def initial(environment: Path) -> frozenset[str]:
    """The facts that hold at the start."""
    return frozenset(str(atom) for atom in problem(environment).init)


@cache
def corpus(path: Path) -> tuple[Demonstration, ...]:
    return tuple(read_demonstrations(path))


def environment_of(path: Path, demonstration: Demonstration) -> Path:
    return next((path.parent.parent / "environments").glob(f"{demonstration.environment}.*"))


def environments_of(path: Path) -> list[str]:
    return sorted(place.stem for place in (path.parent.parent / "environments").glob("*.yaml"))


def raw(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines() if line.strip()]


def plain(text: str) -> str:
    """The words of a text, so that texts that differ in capitals and stops only are the same."""
    return " ".join(re.findall(r"[a-z0-9]+", text.lower()))


def test_both_worlds_have_large_corpora() -> None:
    assert {path.parent.parent.name for path in LARGE} == {"kitchen", "living_room"}


@pytest.mark.parametrize("path", ENVIRONMENTS, ids=short)
def test_environment_compiles(path: Path) -> None:
    compiled = problem(path)
    assert compiled.name == path.stem
    assert compiled.init


@pytest.mark.parametrize("path", CORPORA, ids=short)
def test_each_replays_and_reaches_its_end(path: Path) -> None:
    for demonstration in corpus(path):
        place = environment_of(path, demonstration)
        assert place.is_file(), f"{demonstration.id} names an environment that is not there"
        states = replay(demonstration, problem(place))
        assert len(states) == len(demonstration.instructions) + 1, demonstration.id
        assert states[-1] != states[0], demonstration.id


@pytest.mark.parametrize("path", CORPORA, ids=short)
def test_each_end_is_news(path: Path) -> None:
    """The stated end says something that did not hold at the start; for some tasks, what was made."""
    product = PRODUCTS.get(short(path.parent))
    for demonstration in corpus(path):
        init = initial(environment_of(path, demonstration))
        news = [
            literal
            for literal in demonstration.end_state
            if (literal.removeprefix("(not ").replace("))", ")") in init) == literal.startswith("(not ")
        ]
        assert 2 <= len(demonstration.end_state) <= 5, demonstration.id
        assert news, demonstration.id
        assert product is None or any(re.fullmatch(product, literal) for literal in news), demonstration.id


@pytest.mark.parametrize("path", CORPORA, ids=short)
def test_ids_are_unique_and_say_the_task(path: Path) -> None:
    counts = Counter(d.id for d in corpus(path))
    assert [i for i, n in counts.items() if n > 1] == []
    for demonstration in corpus(path):
        assert demonstration.task == path.parent.name
        assert demonstration.id.startswith(f"{demonstration.task}-{demonstration.environment}-")


@pytest.mark.parametrize("path", CORPORA, ids=short)
def test_segments_cover_every_instruction(path: Path) -> None:
    for line, demonstration in zip(raw(path), corpus(path), strict=True):
        assert set(line) <= KEYS, "instructions stand in segments only"
        written = [text for segment in line["segments"] for text in segment["instructions"]]
        assert [str(i) for i in demonstration.instructions] == written
        assert written, f"{demonstration.id} has no instruction"
        for segment, said in zip(demonstration.segments, line["segments"], strict=True):
            piece = demonstration.text[segment.start : segment.end]
            assert piece == said["text"]
            assert piece == piece.strip() != ""


@pytest.mark.parametrize("path", CORPORA, ids=short)
def test_segments_leave_only_joints(path: Path) -> None:
    for demonstration in corpus(path):
        rest = list(demonstration.text)
        for segment in demonstration.segments:
            rest[segment.start : segment.end] = " " * (segment.end - segment.start)
        assert set(re.findall(r"[a-z']+", "".join(rest).lower())) <= JOINTS, demonstration.id


@pytest.mark.parametrize("path", LARGE, ids=short)
def test_ten_texts_for_each_environment(path: Path) -> None:
    assert {d.id for d in corpus(path)} == {
        f"{path.parent.name}-{environment}-{number:02d}"
        for environment in environments_of(path)
        for number in range(1, PER_ENVIRONMENT + 1)
    }


@pytest.mark.parametrize("path", LARGE, ids=short)
def test_texts_differ_or_are_the_same_in_every_environment(path: Path) -> None:
    said = {name: {plain(d.text) for d in corpus(path) if d.environment == name} for name in environments_of(path)}
    assert all(len(texts) == PER_ENVIRONMENT for texts in said.values()), "a text stands in an environment twice"
    distinct = set().union(*said.values())
    if path.parent.name in SAME_TEXTS:
        assert len(distinct) == PER_ENVIRONMENT
    else:
        assert len(distinct) == PER_ENVIRONMENT * len(said)


COUNTED: dict[str, Callable[[Demonstration], int]] = {
    "words": lambda d: len(d.text.split()),
    "segments": lambda d: len(d.segments),
    "instructions": lambda d: len(d.instructions),
}


@pytest.mark.parametrize("path", LARGE, ids=short)
def test_the_page_counts_what_is_there(path: Path) -> None:
    """``| words in a text | total | mean | median | min | max |``; a text that is said in five places counts once."""
    page = (path.parent / "README.md").read_text(encoding="utf-8")
    once = list({d.text: d for d in corpus(path)}.values())
    rows = re.findall(r"^\| (\w+) in a (text|demonstration)(?: \(\d+\))? \| (.*) \|$", page, re.MULTILINE)
    assert [what for what, _, _ in rows] == list(COUNTED)
    for what, per, figures in rows:
        counts = [COUNTED[what](d) for d in (once if per == "text" else corpus(path))]
        expected = [f"{sum(counts)}", f"{mean(counts):.1f}", f"{median(counts):g}", f"{min(counts)}", f"{max(counts)}"]
        assert figures.split(" | ") == expected, what
