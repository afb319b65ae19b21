"""Readers with a fake server, in small domains."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from tests.bundled import kit
from tests.readers.fake_server import Answer, Decide, FakeServer, serve
from tmd.grounded import Grounded
from tmd.pddl.writer import format_formula
from tmd.readers.llm.client import KEY, MODEL, URL, ModelSettings

ROOT = Path(__file__).resolve().parents[2]
Start = Callable[[Decide], FakeServer]
Ask = Callable[..., Grounded]


@pytest.fixture(autouse=True)
def _alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """No reply of another test, and nothing of the user's environment."""
    for name in (KEY, URL, MODEL):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("tmd.readers.llm.client.cache_directory", lambda name: tmp_path / name)


@pytest.fixture
def start() -> Iterator[Start]:
    """Start servers that end with the test."""
    with ExitStack() as stack:
        yield lambda decide: stack.enter_context(serve(decide))


@pytest.fixture
def ask(start: Start) -> Ask:
    """``ask("02_table/corner1", TEXT, REPLY, REPLY …)``: ground a text with a model that replies so, one by one."""

    def ground(where: str, text: str, *replies: str, **options: Any) -> Grounded:  # noqa: ANN401 - those of DomainKit.ground
        left = list(replies)

        def decide(body: Mapping[str, Any]) -> Answer:
            assert left, body["messages"][-1]["content"]
            return Answer(left.pop(0))

        domain, environment = where.split("/")
        settings = ModelSettings("fake", start(decide).url, cache="off", timeout=20)
        grounded = kit(domain).ground(text, environment, reader="llm", llm=settings, **options)
        assert not left, f"{len(left)} replies were not asked for"
        return grounded

    return ground


def steps(grounded: Grounded) -> list[str]:
    assert grounded.verdicts[0].valid
    return [str(instruction) for instruction in grounded.plans[0].instructions]


def goals(grounded: Grounded) -> list[str]:
    return [
        "" if goal.formula is None else " ".join(format_formula(goal.formula).split())
        for goal in grounded.plans[0].goals
    ]
