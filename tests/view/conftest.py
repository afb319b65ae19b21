"""The kitchen that most pages are of, and a text grounded in it."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from tmd.ground import ground
from tmd.grounded import Grounded
from tmd.knowledge import known
from tmd.veil.corpus import Corpus
from tmd.veil.world import World
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).resolve().parents[2]
TEXT = "Fill the cup with water and heat it in the microwave."


@cache
def corpus(domain: str) -> Corpus:
    return Corpus(DomainFolder(ROOT / "domains" / domain), ROOT / "problems" / domain)


@pytest.fixture(scope="session")
def kitchen() -> World:
    return corpus("kitchen").world("kitchen3")


@pytest.fixture(scope="session")
def grounded(kitchen: World, learned: Path) -> Grounded:
    knowledge = known(corpus("kitchen"), learned)
    return ground(TEXT, kitchen, knowledge.library, reward=knowledge.reward, top=3)
