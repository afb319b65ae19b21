"""Every demonstration in ``problems/`` works: it replays in its environment and reaches its stated end."""

from __future__ import annotations

import json
import re
from collections import Counter
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tmd.pddl.model import Problem
from tmd.veil.demonstration import Demonstration, read_demonstrations
from tmd.veil.replay import replay
from tmd.world.compile import compile_problem
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).resolve().parents[2]
CORPORA = sorted((ROOT / "problems").glob("*/*/demonstrations.jsonl"))
ENVIRONMENTS = sorted((ROOT / "problems").glob("*/environments/*.yaml"))
RAMEN = ROOT / "problems/kitchen/ramen/demonstrations.jsonl"
KEYS = {"id", "task", "environment", "text", "segments", "end_state"}
# what may stand between two segments of a ramen text: words that join clauses, and thanks
JOINTS = {"an", "adn", "and", "then", "after", "that", "meanwhile", "so", "first", "thank", "you"}


def short(path: Path) -> str:
    return str(path.relative_to(ROOT / "problems"))


@cache
def domain_folder(name: str) -> DomainFolder:
    return DomainFolder(ROOT / "domains" / name)


@cache
def problem(environment: Path) -> Problem:
    return compile_problem(load_environment(environment), domain_folder(environment.parent.parent.name))


@cache
def corpus(path: Path) -> tuple[Demonstration, ...]:
    return tuple(read_demonstrations(path))


def environment_of(path: Path, demonstration: Demonstration) -> Path:
    return path.parent.parent / "environments" / f"{demonstration.environment}.yaml"


def raw(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines() if line.strip()]


EACH = [pytest.param(path, d, id=f"{short(path.parent)}:{d.id}") for path in CORPORA for d in corpus(path)]
RAMEN_TEXTS = [pytest.param(d, id=d.id) for d in corpus(RAMEN)]


@pytest.mark.parametrize("path", ENVIRONMENTS, ids=short)
def test_environment_compiles(path: Path) -> None:
    compiled = problem(path)
    assert compiled.name == path.stem
    assert compiled.init


@pytest.mark.parametrize(("path", "demonstration"), EACH)
def test_replays_and_reaches_its_end(path: Path, demonstration: Demonstration) -> None:
    place = environment_of(path, demonstration)
    assert place.is_file(), f"{demonstration.id} names an environment that is not there"
    states = replay(demonstration, problem(place))
    assert len(states) == len(demonstration.instructions) + 1
    assert states[-1] != states[0]


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


def test_ten_ramen_texts_for_each_kitchen() -> None:
    counts = Counter(d.environment for d in corpus(RAMEN))
    assert counts == {f"kitchen{n}": 10 for n in range(1, 6)}
    assert {d.id for d in corpus(RAMEN)} == {
        f"ramen-kitchen{kitchen}-{number:02d}" for kitchen in range(1, 6) for number in range(1, 11)
    }


def test_fifty_distinct_ramen_texts() -> None:
    plain = {" ".join(re.findall(r"[a-z0-9]+", d.text.lower())) for d in corpus(RAMEN)}
    assert len(plain) == 50


@pytest.mark.parametrize("demonstration", RAMEN_TEXTS)
def test_ramen_segments_leave_only_joints(demonstration: Demonstration) -> None:
    rest = list(demonstration.text)
    for segment in demonstration.segments:
        rest[segment.start : segment.end] = " " * (segment.end - segment.start)
    assert set(re.findall(r"[a-z']+", "".join(rest).lower())) <= JOINTS


@pytest.mark.parametrize("demonstration", RAMEN_TEXTS)
def test_ramen_end_is_news(demonstration: Demonstration) -> None:
    """The end names what the ramen was cooked in, and nobody had cooked it before."""
    assert 2 <= len(demonstration.end_state) <= 5
    cooked = [literal for literal in demonstration.end_state if literal.endswith(" cooked_ramen)")]
    assert len(cooked) == 1
    init = problem(environment_of(RAMEN, demonstration)).init
    assert cooked[0] not in {str(atom) for atom in init}
