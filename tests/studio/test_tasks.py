"""Texts to draw from: of each task and environment one, and each can be done where it is offered."""

from __future__ import annotations

from pathlib import Path

from tmd.studio.demonstrations.session import Session
from tmd.studio.demonstrations.tasks import task_texts
from tmd.world.corpus import Corpus

ROOT = Path(__file__).parents[2]


def test_each_task_has_a_text_in_each_environment(kitchen: Corpus) -> None:
    found = task_texts(kitchen)
    assert found == task_texts(Corpus(kitchen.folder, kitchen.directory))
    assert {(t.environment, t.task) for t in found if t.task} == {
        (e, t) for e in kitchen.environments() for t in kitchen.tasks()
    }
    assert [t.environment for t in found] == sorted(t.environment for t in found)
    spoken = " ".join((kitchen.directory / "p01-ramen-kitchen1.nl").read_text().split())
    assert spoken in [" ".join(t.text.split()) for t in found if t.environment == "kitchen1" and not t.task]
    for entry in found:
        assert Session(kitchen.world(entry.environment), entry.text, kitchen.lexicon).text == entry.text.strip()


def test_what_cannot_be_read_is_left_out(table: Corpus) -> None:
    before = task_texts(table)
    (table.directory / "set_table" / "demonstrations.jsonl").write_text("{")
    (table.directory / "p09-nobody.nl").write_text("Go away.")
    (table.directory / "p10-x-corner1.nl").write_bytes(b"\xff")
    assert {t.task for t in task_texts(table)} == {""}
    assert {t.text for t in task_texts(table)} < {t.text for t in before}
