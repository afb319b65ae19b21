from __future__ import annotations

from pathlib import Path

from experiments.veil500_report import check_veil500
from tmd.datasets.veil500 import VeilData


def test_small_report(small_directory: Path) -> None:
    report = check_veil500(small_directory)
    counts = report.counts
    assert counts["demonstrations"] == {"points": 2, "kitchen": 1, "living_room": 1}
    assert counts["texts"]["texts with repeated runs removed"] == 1
    assert counts["texts"]["texts with line breaks"] == 1
    assert counts["texts"]["texts without separators"] == 1
    assert counts["actions"]["actions"] == 5
    assert counts["actions"]["empty groups"] == 1
    assert counts["actions"]["mentions of unknown objects"] == 1
    assert counts["actions"]["actions of unknown form"] == 1
    assert counts["environments"]["states dropped, not declared by the class"] == 1
    assert counts["environments"]["placeholder positions left"] == 0
    assert counts["objects at the start"]["on the floor"] == 3
    assert report.remarks == (
        "point 1 (line 14): no object 'unicorn_1' in living_room 1",
        "point 1 (line 14): no rule for dance(unicorn_1); it will do nothing",
    )


def test_forms_of_the_report(small_directory: Path) -> None:
    report = check_veil500(small_directory)
    text = report.text()
    assert "mentions of unknown objects" in text
    assert text.count("\n") == sum(len(v) + 2 for v in report.counts.values()) + 1 + 2 + len(report.remarks)
    assert check_veil500(small_directory).text() == text


def test_report_of_the_release(released: VeilData) -> None:
    report = check_veil500(released.directory)
    counts = report.counts
    assert counts["demonstrations"] == {"points": 360, "kitchen": 209, "living_room": 151}
    assert counts["by objective"]["Making Ramen"] == 45
    assert counts["by environment"]["living_room 6"] == 31
    assert counts["execution under the literal rules"] == {"points executable": 149, "steps not executable": 268}
    assert counts["environments"]["environments"] == 16
    assert counts["environments"]["placeholder positions, taken from the whole"] == 152
    assert counts["objects at the start"]["place unknown"] == 3
    assert not report.remarks
