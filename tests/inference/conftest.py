from __future__ import annotations

from pathlib import Path

import pytest

from tmd.veil.corpus import Corpus
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def kitchen() -> Corpus:
    return Corpus(DomainFolder(ROOT / "domains" / "kitchen"), ROOT / "problems" / "kitchen")
