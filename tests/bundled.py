"""The bundled domains, each read and ground once for all tests of a process that leave it as it is."""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path

from tmd.domain_kit import DomainKit
from tmd.evaluation.runs.dataset import BundledData
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).resolve().parents[1]


@cache
def corpus(domain: str) -> Corpus:
    """The domain with its environments and demonstrations."""
    return Corpus(DomainFolder(ROOT / "domains" / domain), ROOT / "problems" / domain)


@cache
def kit(domain: str) -> DomainKit:
    """The domain as the API has it, with what the fixture ``learned`` has of it."""
    learned = os.environ.get("TMD_LEARNED")
    return DomainKit(corpus(domain), Path(learned) if learned else None)


@cache
def data(task: str) -> BundledData:
    """The demonstrations of a task of the kitchen, or of ``all``, as experiments have them."""
    return BundledData(task, "kitchen", ROOT / "domains", ROOT / "problems")
