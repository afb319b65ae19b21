"""``--fix`` and others that write the same file."""

from __future__ import annotations

from pathlib import Path

import pytest

from tmd.check.checker import Checker
from tmd.check.report import check_paths

DOMAIN = "(define (domain d)\n  (:requirements :typing)\n  (:types cup -object)\n  (:predicates (full ?c - cup)))\n"


def test_what_was_written_meanwhile_is_looked_at_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "domain.pddl"
    file.write_text(DOMAIN)
    finish, written = Checker.finish, []

    def finish_late(checker: Checker) -> None:
        finish(checker)
        if not written:
            written.append(file.write_text(DOMAIN.replace("cup -object", "cup dish -object")))

    monkeypatch.setattr(Checker, "finish", finish_late)
    report = check_paths([file], fix=True)
    assert report.fixed == (file,)
    assert file.read_text() == DOMAIN.replace("cup -object", "cup dish - object")
