"""The kitchen that most pages are of, and a text grounded in it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.bundled import corpus
from tmd.ground import ground
from tmd.grounded import Grounded
from tmd.knowledge import known
from tmd.world.world import World

TEXT = "Fill the cup with water and heat it in the microwave."


@pytest.fixture(scope="session")
def kitchen() -> World:
    return corpus("kitchen").world("kitchen3")


@pytest.fixture(scope="session")
def grounded(kitchen: World, learned: Path) -> Grounded:
    knowledge = known(corpus("kitchen"), learned)
    return ground(TEXT, kitchen, knowledge.library, reward=knowledge.reward, top=3)
