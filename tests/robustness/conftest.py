"""The real command, without what other tests need to be learned before."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Tmd, run_tmd


@pytest.fixture
def tmd(tmp_path: Path) -> Tmd:
    """``tmd("parse", "--text", "…")`` in an empty directory."""
    return lambda *arguments, **options: run_tmd(arguments, tmp_path, **options)
