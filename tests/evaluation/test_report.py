"""The page of a run: all that was promised, text only as text, nothing to load, and a browser shows it."""

from __future__ import annotations

import csv
import io
import json
import os
import re
import shutil
import subprocess
from collections.abc import Mapping
from html.parser import HTMLParser
from pathlib import Path
from types import MappingProxyType
from typing import Any
from urllib.parse import unquote

import pytest
from rich.console import Console

from tmd.diagnostics import OutputError, TmdError
from tmd.evaluation.report.predictions import best_and_worst
from tmd.evaluation.report.report import print_table, write_report
from tmd.evaluation.report.rows import best_of, reference
from tmd.evaluation.runs.finished_run import read_run
from tmd.evaluation.summary import summarise
from tmd.records.metrics import COLUMNS, Means, Metrics
from tmd.records.prediction import PredictionRecord
from tmd.records.trial import Trial, TrialRequest

EVIL = "<script>alert('é $x$')</script> & <b onclick=\"x\">\u2028[bold]"


def line(model: str, number: int, task: str, score: float, **changes: object) -> dict[str, Any]:
    said = {
        "id": f"{task}-{number}",
        "task": task,
        "environment": f"kitchen{number % 2}",
        "model": model,
        "fold": "one",
        "text": f"Take the cup. {EVIL} {number // 2}",
        "predicted": ["moveto(cup)", "grasp(mug)", "wait()"],
        "gold": ["moveto(cup)", "grasp(cup)", "keep(cup, sink, on)"],
        "executable": number % 2 == 0,
        **dict.fromkeys(("IED", "END", "EED", "EED_trim"), score),
        "clauses": [
            {
                "text": "Take the cup.",
                "verb": "take",
                "latent": ["moveto(cup)"],
                "said": ["grasp(mug)", "wait()"],
                "source": f"demo {EVIL}",
                "factors": {"environment_distance": 3.25, "clause_distance": 0.5, "inconsistent_end": 0.0},
            }
        ],
        "segments": [{"text": "Take the cup.", "instructions": ["moveto(cup)", "grasp(cup)", "keep(cup, sink, on)"]}],
    }
    return said | changes


def finished(
    directory: Path,
    models: tuple[str, ...] = ("empty", "full", "nearest"),
    tasks: tuple[str, ...] = (),
    levels: Mapping[str, float] = MappingProxyType({"empty": 20.0, "nearest": 40.0, "full": 60.0}),
) -> Path:
    """A run's directory with made-up predictions."""
    bare = {"predicted": [], "clauses": []}
    predictions = [
        line(model, n, task, levels.get(model, 30.0) + n, **(bare if model == "empty" else {}))
        for model in models
        for task in tasks or ("ramen", f"coffee {EVIL}")
        for n in range(15)
    ]
    config = {"task": "all", "data": "bundled", "seed": 0, "models": list(models), "note": EVIL}
    folds = {"one": {"train": 4, "test": 30, "training_set": "one"}}
    metrics = summarise(predictions, models) | {"config": config, "folds": folds}
    directory.mkdir(exist_ok=True)
    (directory / "metrics.json").write_text(json.dumps(metrics))
    text = "".join(json.dumps(p, ensure_ascii=False) + "\n" for p in predictions)
    (directory / "predictions.jsonl").write_text(text, encoding="utf-8")
    return directory


def fit(directory: Path, model: str = "full", curve: list[Any] | None = None) -> None:
    points = [{"round": 1 + n // 2, "epoch": n % 2, "loss": 1 / (n + 1), "objective": 2 / (n + 1)} for n in range(6)]
    world = {
        "weights": {"environment_distance": 1.5, "clause_distance": 0.25},
        "curve": points if curve is None else curve,
    }
    (directory / "fits").mkdir(exist_ok=True)
    said = {"model": model, "trained_in": ["kitchen1"], "worlds": {"kitchen": world}}
    (directory / "fits" / f"{model}-one.json").write_text(json.dumps(said))


class Reader(HTMLParser):
    """What a page consists of."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        self.text.append(data)

    def said(self) -> str:
        return re.sub(r"\s+", " ", " ".join(self.text))


@pytest.fixture(scope="module")
def directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = finished(tmp_path_factory.mktemp("run"))
    fit(found)
    write_report(found)
    return found


@pytest.fixture(scope="module")
def page(directory: Path) -> str:
    return (directory / "report.html").read_text(encoding="utf-8")


def test_what_users_wrote_is_text(page: str) -> None:
    reader = Reader(page)
    assert not {"script", "iframe", "object", "embed", "link", "img"} & {tag for tag, _ in reader.tags}
    assert not any(name.startswith("on") for _, attributes in reader.tags for name in attributes)
    assert "<script>alert('é $x$')</script> & <b onclick=\"x\">" in reader.said()
    assert page.count("alert(") >= 10


def test_nothing_is_loaded(page: str) -> None:
    assert not re.findall(r"https?:|@import|url\((?!#)", page)
    for tag, attributes in Reader(page).tags:
        assert "src" not in attributes, tag
        assert (attributes.get("href") or "#").startswith("data:text/" if "download" in attributes else "#"), tag
    assert "default-src 'none'" in page
    assert page.count("<style") == 1


def test_names_of_elements_are_unique_and_links_lead_somewhere(page: str) -> None:
    tags = Reader(page).tags
    names = [attributes["id"] for _, attributes in tags if "id" in attributes]
    assert len(names) == len(set(names))
    assert {(a.get("href") or "#results")[1:] for _, a in tags if "download" not in a} <= set(names)
    assert {m[1] for m in re.finditer(r"url\(#([^)]*)\)", page)} <= set(names)


def test_every_part_is_there(page: str) -> None:
    said = Reader(page).said()
    for part in ("Our full model full", "Nearest Environment Instantiation", "Empty prediction", "the floor"):
        assert part in said
    assert "67.3" in said, "the paper's IED of the full model on ramen"
    assert "67.0 ±1.2" in said, "mean of 60 … 74, standard error over 15 examples"
    assert "* differs from full" in said
    differences = said[said.index("full minus each other row") :]
    assert "nearest +20.0 [+20.0, +20.0]" in differences
    assert "empty +40.0 [+40.0, +40.0]" in differences
    assert "[1.5, 1.5]" in said, "learned weights"
    assert "Our full model full 1 1 0.167" in said, "training sets, the loss of the first and of the last epoch"


def test_predictions_are_shown_step_by_step(page: str) -> None:
    shown = page[page.index('id="predictions"') :]
    first = shown[shown.index("<tbody>") : shown.index("</tbody>")]
    rows = [re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", row)).strip() for row in first.split("</tr>")[:-1]]
    assert rows == [
        "✓ match moveto(cup) latent 1 moveto(cup)",
        "≠ substituted grasp(mug) 1 grasp(cup)",
        "≠ substituted wait() 1 keep(cup, sink, on)",
    ]
    energy = Reader(shown[shown.index('class="energy"') :][:900]).said()
    assert "energy 3.75" in energy
    assert re.search(r"environment distance 3\.25 clause distance 0\.5 1 factor is 0", energy)


def test_a_page_with_texts_of_others_says_so(tmp_path: Path) -> None:
    metrics = json.loads((finished(tmp_path, ("full",), ("ramen",)) / "metrics.json").read_text())
    warning = "do not pass it on"
    assert warning not in write_report(tmp_path).read_text(encoding="utf-8")
    metrics["config"]["data"] = "veil500"
    (tmp_path / "metrics.json").write_text(json.dumps(metrics))
    assert warning in write_report(tmp_path).read_text(encoding="utf-8")


def test_the_ten_best_and_the_ten_worst_without_overlap() -> None:
    lines = [PredictionRecord.model_validate(line("m", n, "t", float(n))) for n in range(15)]
    best, worst = best_and_worst(lines)
    assert [shown.line.IED for shown in best] == [float(n) for n in range(14, 4, -1)]
    assert [shown.line.IED for shown in worst] == [0.0, 1.0, 2.0, 3.0, 4.0]


def test_steps_of_a_sequence_that_was_changed_afterwards_belong_to_no_clause() -> None:
    changed = PredictionRecord.model_validate(line("m", 1, "t", 1.0, predicted=["moveto(cup)"]))
    (shown,), _ = best_and_worst([changed])
    assert not shown.line.whole
    assert {step.clause for step in shown.steps} == {None}
    assert not any(step.latent for step in shown.steps)


def test_without_the_empty_row_the_page_says_so(tmp_path: Path) -> None:
    page = write_report(finished(tmp_path, ("nearest", "paper"))).read_text(encoding="utf-8")
    assert "The floor was not computed" in page
    assert 'id="learning"' not in page


@pytest.mark.parametrize("models", [("empty",), ("full",), ("someones_own", "empty")])
def test_a_run_of_few_rows_has_a_page(tmp_path: Path, models: tuple[str, ...]) -> None:
    page = write_report(finished(tmp_path, models, ("study_night",))).read_text(encoding="utf-8")
    assert "This run has no row and task in common with Table II" in page
    assert ("No row predicts anything" in page) == (models == ("empty",))


def test_the_page_begins_with_the_main_result(directory: Path, page: str, tmp_path: Path) -> None:
    told = Reader(page).said()
    assert (
        "Our full model: IED 67.0, 20.0 more than Nearest Environment Instantiation (p = 0.023). "
        "It is also the best in EED, EED-trim and END."
    ) in told
    table = page[page.index('id="results"') : page.index('id="tasks"')]
    rows = re.findall(r'<th scope="row">[^<]*<code>(\w+)', table)
    assert rows == ["full", "nearest", "empty"]
    alone = write_report(finished(tmp_path / "alone", ("full",), ("ramen",))).read_text(encoding="utf-8")
    assert "Our full model: IED 67.0." in alone
    bare = write_report(finished(tmp_path / "bare", ("empty",), ("ramen",))).read_text(encoding="utf-8")
    assert '<p class="headline">No row predicts anything.</p>' in bare


def means(**changes: float | None) -> Means:
    zeros = {name: 0.0 for column in COLUMNS for name in (column, f"{column}_se")}
    return Means.model_validate({"n": 1, **zeros, **changes})


def test_the_best_of_each_column_is_bold_ties_as_well_and_the_floor_never() -> None:
    rows = {
        "a": means(IED=5.04, END=1.0),
        "b": means(IED=4.98),
        "c": means(),
        "empty": means(IED=9.0, executable=100.0),
    }
    assert best_of(rows, COLUMNS) == {("a", "IED"), ("b", "IED"), ("a", "END")}
    assert best_of({"a": means(IED=5.0)}, COLUMNS) == set()


def test_nothing_stands_twice_where_there_is_one_task(tmp_path: Path, page: str) -> None:
    one = write_report(finished(tmp_path, tasks=("ramen",))).read_text(encoding="utf-8")
    assert 'id="tasks"' in page and 'id="tasks"' not in one
    numbers = [re.findall(r"\d+\.\d", table) for table in one[: one.index('id="errors"')].split("<table")[1:]]
    assert len({tuple(table) for table in numbers if table}) == len([table for table in numbers if table])
    assert one.count(">67.0 <") == 6, "four metrics in the results, two in Table II"


def test_rows_are_tested_against_the_default_model(tmp_path: Path) -> None:
    page = write_report(finished(tmp_path, ("full", "goals", "nearest"))).read_text(encoding="utf-8")
    assert "goals minus each other row" in Reader(page).said()
    assert reference(["nearest", "full", "paper"]) == "full"
    assert reference(["nearest", "paper", "empty"]) == "paper"
    assert reference(["empty"]) is None


def test_the_table_can_be_downloaded(directory: Path, page: str) -> None:
    links = {a["download"]: str(a["href"]) for tag, a in Reader(page).tags if "download" in a}
    assert set(links) == {"table.csv", "table.tex"}
    texts = {name: unquote(address.partition(",")[2]) for name, address in links.items()}
    lines = list(csv.DictReader(io.StringIO(texts["table.csv"])))
    metrics = read_run(directory).metrics
    assert [(line["model"], line["task"]) for line in lines[:3]] == [
        ("full", "all"), ("full", f"coffee {EVIL}"), ("full", "ramen")
    ]  # fmt: skip
    assert float(lines[0]["IED_se"]) == metrics.models["full"].IED_se
    latex = texts["table.tex"]
    assert r"Our full model & 30 & \textbf{67.0} $\pm$ 0.8 & " in latex
    assert r"executable \%" in latex
    columns = latex.partition("{tabular}{")[2].partition("}")[0]
    assert {line.count(" & ") + 1 for line in latex.splitlines() if line.endswith(r"\\")} == {len(columns)}


def test_the_order_of_the_papers_rows_is_compared(tmp_path: Path) -> None:
    levels = {"templates": 50.0, "full": 40.0, "nearest": 20.0, "paper": 30.0}
    run = finished(tmp_path / "other", tuple(levels), ("ramen",), levels)
    page = Reader(write_report(run).read_text(encoding="utf-8")).said()
    assert "2 of the 3 pairs of the paper's rows stand in another order" in page
    assert "Predefined Templates Nearest Environment Instantiation +30.0" in page
    assert "Predefined Templates Our full model +10.0" in page
    assert "53 % of what Predefined Templates predicts can be, and 53 % of what Our full model predicts" in page
    assert "Learning the weights instead of setting them by hand changes IED by +10.0 (p = 0.047)" in page
    same = Reader(write_report(finished(tmp_path / "same", tasks=("ramen",))).read_text(encoding="utf-8")).said()
    assert "the paper's rows stand in the order of the paper's average" in same


def test_the_provenance_is_shown_where_it_was_kept(tmp_path: Path) -> None:
    run = finished(tmp_path, ("full",), ("ramen",))
    assert "run time" not in write_report(run).read_text(encoding="utf-8")
    kept = {
        "command": "tmd experiment --task ramen", "date": "2020-02-02 10:00 UTC", "seconds": 432.1,
        "machine": "Linux x86_64, 2 processors", "python": "CPython 3.11.7", "revision": "abc",
    }  # fmt: skip
    (run / "provenance.json").write_text(json.dumps(kept))
    said = Reader(write_report(run).read_text(encoding="utf-8")).said()
    for part in ("2020-02-02 10:00 UTC", "7 min", "tmd experiment --task ramen", "2 processors, CPython 3.11.7"):
        assert part in said
    (run / "provenance.json").write_text("{}")
    with pytest.raises(TmdError, match=r"provenance\.json"):
        write_report(run)


def test_films_stay_files_beside_the_page(tmp_path: Path) -> None:
    run = finished(tmp_path, ("full",), ("ramen",))
    (run / "robot").mkdir()
    asked = TrialRequest(
        environment="kitchen1",
        model="full",
        id="ramen-1",
        text="x",
        plan=("wait()",),
        mode="kinematic",
        seed=0,
        version="1",
    )
    trial = Trial(asked=asked, status="done", film="kitchen 1.mp4", strip="gone.png")
    (run / "robot" / "kitchen1.json").write_text(trial.model_dump_json())
    (run / "robot" / "kitchen 1.mp4").write_bytes(b"0" * 3_000_000)
    page = write_report(run).read_text(encoding="utf-8")
    assert 'src="robot/kitchen%201.mp4#t=1"' in page and "gone.png" not in page and "base64" not in page
    assert len(page.encode()) < 2_000_000
    assert "Without physics" in page
    shown = trial.model_copy(update={"poster": "kitchen 1.jpg"})
    (run / "robot" / "kitchen1.json").write_text(shown.model_dump_json())
    (run / "robot" / "kitchen 1.jpg").write_bytes(b"0")
    assert 'poster="robot/kitchen%201.jpg" src="robot/kitchen%201.mp4"' in write_report(run).read_text(encoding="utf-8")


def test_the_paper_stands_beside_rows_and_tasks_that_both_have(tmp_path: Path) -> None:
    page = write_report(finished(tmp_path, ("full", "paper"), ("ramen", "study_night"))).read_text(encoding="utf-8")
    table = page[page.index('id="table2"') : page.index('id="errors"')]
    said = Reader(table).said()
    assert "average" not in said, "of one task"
    assert said.count("paper, other data") == 1
    assert "study" not in said


@pytest.mark.parametrize("curve", [[{"round": 1, "epoch": 0, "loss": 0.5}], []])
def test_curves_may_be_short(tmp_path: Path, curve: list[Any]) -> None:
    fit(finished(tmp_path, ("full",), ("ramen",)), curve=curve)
    page = write_report(tmp_path).read_text(encoding="utf-8")
    assert ("no curve was kept" in page) == (not curve)


def test_the_same_run_has_the_same_bytes(directory: Path, page: str) -> None:
    write_report(directory)
    assert (directory / "report.html").read_text(encoding="utf-8") == page


@pytest.mark.parametrize(
    ("file", "text", "message"),
    [
        ("metrics.json", None, "metrics.json"),
        ("metrics.json", "{", "metrics.json"),
        ("metrics.json", '{"models": {}}', "models"),
        ("predictions.jsonl", None, "predictions.jsonl"),
        (
            "predictions.jsonl",
            '{"id": 1}\n',
            "predictions.jsonl:1:1: this is not a prediction of tmd experiment: task: ",
        ),
        ("predictions.jsonl", "\n{", "predictions.jsonl:2"),
        ("predictions.jsonl", "", "differ on the row 'empty'"),
        ("fits/full-one.json", "[]", "full-one.json"),
        (
            "fits/full-one.json",
            '{"model": "full", "worlds": {}}',
            "trained_in: the key is missing (it was",
        ),
        (
            "fits/full-one.json",
            '{"model": "full", "trained_in": [], "worlds": {"k": {"weights": {"trimming": "x"}, "curve": []}}}',
            "worlds.k.weights.trimming: should be a valid number",
        ),
    ],
)
def test_a_damaged_run_is_named_in_one_line_and_nothing_is_written(
    tmp_path: Path, file: str, text: str | None, message: str
) -> None:
    finished(tmp_path)
    fit(tmp_path)
    if text is None:
        (tmp_path / file).unlink()
    else:
        (tmp_path / file).write_text(text)
    with pytest.raises(TmdError) as caught:
        write_report(tmp_path)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "report.html").exists()


def test_bytes_that_are_no_text_are_named(tmp_path: Path) -> None:
    (finished(tmp_path) / "predictions.jsonl").write_bytes(b"\xff\xfe")
    with pytest.raises(TmdError, match="not UTF-8"):
        write_report(tmp_path)


def test_a_page_that_cannot_be_written_leaves_the_old_one(tmp_path: Path) -> None:
    finished(tmp_path)
    (tmp_path / "report.html").mkdir()
    with pytest.raises(OutputError):
        write_report(tmp_path)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["metrics.json", "predictions.jsonl", "report.html"]


def test_the_table_on_the_screen_fits_and_is_marked(directory: Path) -> None:
    out = Console(file=io.StringIO(), width=80)
    print_table(Metrics.from_text((directory / "metrics.json").read_text(), "metrics.json"), out)
    assert isinstance(out.file, io.StringIO)
    said = out.file.getvalue()
    assert re.search(r"full +30 +67\.0 ±0\.8 ", said)
    assert re.search(r"nearest +30 +47\.0 ±0\.8\*", said)
    assert "…" not in said
    assert "it is the floor" in said
    assert "* differs from full" in said


def test_records_have_what_was_written(directory: Path) -> None:
    run = read_run(directory)
    assert len(run.of("full")) == 30
    assert list(run.fits) == ["full-one"]
    assert run.lines[0].text.endswith("\u2028[bold] 0")


# A real browser

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


@pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium: apt-get install chromium")
@pytest.mark.parametrize(("width", "dark"), [(1280, False), (500, True)])
def test_a_browser_shows_the_page_without_complaint(directory: Path, tmp_path: Path, width: int, dark: bool) -> None:
    assert CHROMIUM is not None
    found = subprocess.run(
        [
            *(CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run"),
            *(f"--user-data-dir={tmp_path / 'profile'}", f"--window-size={width},2000", "--hide-scrollbars"),
            *(f"--blink-settings=preferredColorScheme={0 if dark else 1}", "--enable-logging=stderr", "--v=0"),
            *(f"--screenshot={tmp_path / 'page.png'}", "--dump-dom", (directory / "report.html").as_uri()),
        ],
        capture_output=True,
        text=True,
        timeout=240,
        env=os.environ | {"HOME": str(tmp_path)},
    )
    assert found.returncode == 0, found.stderr
    assert "CONSOLE" not in found.stderr, found.stderr
    reader = Reader(found.stdout)
    assert "<title>tmd experiment: all, bundled data</title>" in found.stdout
    assert "script" not in {tag for tag, _ in reader.tags}
    assert sum(tag == "table" for tag, _ in reader.tags) > 10
    assert "Our full model" in reader.said()
    assert (tmp_path / "page.png").stat().st_size > 20_000, "an empty page"
