"""Reading demonstrations: what is accepted, and where each fault is reported."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tmd.diagnostics import TmdError
from tmd.pddl.model import Instruction
from tmd.world.demonstration import read_demonstrations

GOOD: dict[str, Any] = {
    "id": "a",
    "task": "ramen",
    "environment": "kitchen1",
    "text": "Take it. Wait a bit, then wait.",
    "segments": [
        {"text": "Take it", "instructions": ["grasp(mug1)"]},
        {"text": "wait", "instructions": ["wait()", "keep(mug1, counter1, on)"]},
    ],
}


def write(path: Path, *lines: str) -> Path:
    file = path / "demonstrations.jsonl"
    file.write_text("".join(line + "\n" for line in lines))
    return file


def test_segments_are_found_in_the_text_in_order(tmp_path: Path) -> None:
    (found,) = read_demonstrations(write(tmp_path, json.dumps(GOOD), ""))
    assert [found.text[s.start : s.end] for s in found.segments] == ["Take it", "wait"]
    assert found.segments[1].start == found.text.rindex("wait")
    assert found.instructions == (
        Instruction("grasp", ("mug1",)),
        Instruction("wait"),
        Instruction("keep", ("mug1", "counter1", "on")),
    )


MISTAKES = [
    ({"text": None}, "text: should be text"),
    ({"segments": None}, "segments: should be a list"),
    ({"segments": [{"text": "Take that", "instructions": []}]}, "does not stand in the text"),
    ({"segments": [{"instructions": []}]}, "segments.0.text: the key is missing"),
    ({"segments": [{"text": "Take it", "instructions": "wait()"}]}, "segments.0.instructions: should be a list"),
    ({"segments": [{"text": "Take it", "instructions": ["grasp(mug1"]}]}, "'grasp(mug1': "),
    ({"segments": list(reversed(GOOD["segments"]))}, "does not stand in the text after"),
    ({"end_state": "(hot mug1)"}, "end_state: should be a list"),
]


@pytest.mark.parametrize(("change", "message"), MISTAKES)
def test_a_mistake_is_reported_with_its_line(tmp_path: Path, change: dict[str, Any], message: str) -> None:
    file = write(tmp_path, json.dumps(GOOD), json.dumps({**GOOD, "id": "b", **change}))
    with pytest.raises(TmdError) as caught:
        read_demonstrations(file)
    assert message in caught.value.message
    assert caught.value.location is not None
    assert caught.value.location.line == 2


@pytest.mark.parametrize("line", ["{", "[]", '"x"', "[" * 100_000, json.dumps({**GOOD}).replace("task", "tusk")])
def test_a_line_that_is_no_demonstration_is_refused(tmp_path: Path, line: str) -> None:
    with pytest.raises(TmdError) as caught:
        read_demonstrations(write(tmp_path, line))
    assert caught.value.location is not None


def test_an_id_stands_once(tmp_path: Path) -> None:
    with pytest.raises(TmdError, match="twice"):
        read_demonstrations(write(tmp_path, json.dumps(GOOD), json.dumps(GOOD)))
