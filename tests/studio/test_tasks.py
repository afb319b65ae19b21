"""Example texts: one of each task and environment, and each can be done where it is offered."""

from __future__ import annotations

from pathlib import Path

from tmd.studio.demonstrations.session import Session
from tmd.studio.studio import example_texts
from tmd.world.corpus import Corpus

ROOT = Path(__file__).parents[2]


def test_each_task_has_a_text_in_each_environment(kitchen: Corpus) -> None:
    found = example_texts(kitchen)
    assert found == example_texts(Corpus(kitchen.folder, kitchen.directory))
    shown = {(d.environment, d.task, d.text) for d in kitchen.demonstrations()}
    for environment in kitchen.environments():
        tasks = {task for where, task, text in shown if where == environment and text in found[environment]}
        assert tasks == set(kitchen.tasks())
        assert len(found[environment]) == len(set(found[environment]))
        for text in found[environment]:
            assert Session(kitchen.world(environment), text, kitchen.lexicon).text == text.strip()
    spoken = " ".join((kitchen.directory / "p01-ramen-kitchen1.nl").read_text().split())
    assert spoken in [" ".join(text.split()) for text in found["kitchen1"]]
