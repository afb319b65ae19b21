"""The pages that the report of a run links to: one for each prediction that it shows, and of nothing else."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tests.view.reading import Reader
from tmd.evaluation.report.page import linked_pages, page_name
from tmd.evaluation.report.report import write_report
from tmd.evaluation.runs.config import ExperimentConfig
from tmd.evaluation.summary import summarise
from tmd.robot_trials.experiment import write_pages

ROOT = Path(__file__).parents[2]
GOOD = ["find(mug1)", "moveto(mug1)"]


def line(number: int, model: str = "full", **changes: object) -> dict[str, Any]:
    made = {
        "id": f"ramen-kitchen1-{number}", "task": "ramen", "environment": "kitchen1", "model": model, "fold": "f",
        "text": "Find the <b>mug</b>.", "predicted": GOOD, "gold": GOOD, "executable": True, "IED": 50.0, "END": 50.0,
        "EED": 50.0, "EED_trim": 50.0, "segments": [],
        "clauses": [{"text": "Find the mug", "verb": "find", "latent": GOOD[:1], "said": GOOD[1:], "source": "demo-1",
                     "factors": {"description_length": 1.25}}],
    }  # fmt: skip
    return made | changes


def finished(out: Path, lines: Sequence[dict[str, Any]], data: str = "bundled") -> ExperimentConfig:
    models = tuple(dict.fromkeys(each["model"] for each in lines))
    config = ExperimentConfig(
        "ramen", out, models=models, domains=ROOT / "domains", problems=ROOT / "problems", data=data
    )
    metrics = summarise(lines, models) | {
        "config": config.identity(""),
        "folds": {"f": {"train": 1, "test": 1, "training_set": "f"}},
    }
    (out / "metrics.json").write_text(json.dumps(metrics))
    (out / "predictions.jsonl").write_text("".join(json.dumps(each) + "\n" for each in lines))
    return config


def step(number: int, action: str, seen: str, **changes: object) -> dict[str, object]:
    failed = changes.get("outcome") == "failed"
    said = {"failure": seen if failed else None, "evidence": None if failed else seen}
    done = {"number": number, "action": action, "args": ["mug1"], "repair": False, "outcome": "ok", **said}
    return done | {"effects": [], "mismatches": [], "begin": 0, "end": 1} | changes


def links(report: Path) -> list[str]:
    found = (attributes.get("href", "") for tag, attributes in Reader(report.read_text()).elements if tag == "a")
    return [address for address in found if address.startswith("pages/")]


def test_the_report_links_to_a_page_for_each_prediction(tmp_path: Path) -> None:
    lines = [
        line(1),
        line(2, predicted=["grasp(mug1)"], clauses=[], executable=False),
        line(3, predicted=["fly(mug1)"], clauses=[]),
        line(4, environment="nowhere"),
        line(5, predicted=["no instruction"], clauses=[]),
        line(1, "empty", predicted=[], clauses=[]),
    ]
    config = finished(tmp_path, lines)
    assert write_pages(config) == 3
    found = links(write_report(tmp_path))
    assert sorted(found) == [f"pages/full-ramen-kitchen1-{n}.html" for n in (1, 2, 3)]
    one, two = (Reader((tmp_path / f"pages/full-ramen-kitchen1-{n}.html").read_text()) for n in (1, 2))
    assert all(text in one.text for text in ("clause 1", "latent", "1.25", "demo-1"))
    assert "<b>mug</b>" in one.without("small")
    assert "Here the plan breaks." in two.text
    before = {path.name: path.read_bytes() for path in (tmp_path / "pages").iterdir()}
    write_pages(config)
    assert {path.name: path.read_bytes() for path in (tmp_path / "pages").iterdir()} == before


def test_pages_of_predictions_that_are_not_shown_any_more_go(tmp_path: Path) -> None:
    write_pages(finished(tmp_path, [line(1), line(2)]))
    write_pages(finished(tmp_path, [line(2)]))
    assert linked_pages(tmp_path) == {"full-ramen-kitchen1-2.html"}


def test_veil500_has_no_pages(tmp_path: Path) -> None:
    assert write_pages(finished(tmp_path, [line(1)], data="veil500")) == 0
    assert not (tmp_path / "pages").exists() and not links(write_report(tmp_path))


def test_what_a_robot_did_stands_on_the_page(tmp_path: Path) -> None:
    config = finished(tmp_path, [line(1), line(2)])
    asked = {"environment": "kitchen1", "model": "full", "id": "ramen-kitchen1-1", "text": "x", "plan": GOOD}
    steps = [
        step(
            1,
            "find",
            "in view",
            effects=[{"fact": "(found pr2 mug1)", "holds": True, "basis": "inferred", "how": "a ray"}],
        ),
        step(2, "moveto", "no way", outcome="failed"),
        step(2, "find", "again", repair=True),
        step(2, "moveto", "near"),
    ]
    trial = {"asked": asked | {"mode": "kinematic", "seed": 0, "version": "0"}, "status": "recovered", "steps": steps}
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot" / "kitchen1.json").write_text(json.dumps(trial))
    write_pages(config)
    assert write_pages(config, carried_out=True) == 1 and len(linked_pages(tmp_path)) == 2
    html = (tmp_path / "pages" / "full-ramen-kitchen1-1.html").read_text()
    places = [html.index(f'id="step-{n}"') for n in (1, 2)]
    assert places[0] < html.index(": in view<") < html.index("inferred: (found pr2 mug1)") < places[1]
    assert places[1] < html.index("no way") < html.index("again") < html.index(": near<")
    assert "recovered" in html and len(links(write_report(tmp_path))) == 3


def test_every_prediction_has_a_name_of_its_own_that_can_stand_in_an_address() -> None:
    pairs = [("a", "b"), ("a", "b/c"), ("a", "b_c"), ("a/b", "c"), ("a", "é"), ("a", "è"), ("a", 7), ("a", "x" * 500)]
    names = [page_name(*pair) for pair in pairs]
    assert len(set(names)) == len(names)
    assert all(set(name) <= set("abcdefghijklmnopqrstuvwxyz0123456789_.-") and len(name) < 200 for name in names)
