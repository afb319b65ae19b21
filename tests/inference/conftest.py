from __future__ import annotations

import pytest

from tests.bundled import corpus
from tmd.world.corpus import Corpus


@pytest.fixture(scope="session")
def kitchen() -> Corpus:
    return corpus("kitchen")
