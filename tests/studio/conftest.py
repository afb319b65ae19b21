from __future__ import annotations

from pathlib import Path

import pytest

from tmd.veil.corpus import Corpus
from tmd.veil.world import World
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).parents[2]


def bundled(name: str) -> Corpus:
    return Corpus(DomainFolder(ROOT / "domains" / name), ROOT / "problems" / name)


@pytest.fixture(scope="session")
def kitchen() -> Corpus:
    return bundled("kitchen")


@pytest.fixture(scope="session")
def kitchen1(kitchen: Corpus) -> World:
    return kitchen.world("kitchen1")
