from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.bundled import corpus
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder
from tmd.world.world import World

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def kitchen() -> Corpus:
    return corpus("kitchen")


@pytest.fixture(scope="session")
def kitchen1(kitchen: Corpus) -> World:
    return kitchen.world("kitchen1")


@pytest.fixture
def table(tmp_path: Path) -> Corpus:
    """A small domain, its problems copied so that they may be written to."""
    problems = tmp_path / "problems" / "02_table"
    shutil.copytree(ROOT / "problems" / "02_table", problems)
    return Corpus(DomainFolder(ROOT / "domains" / "02_table"), problems)
