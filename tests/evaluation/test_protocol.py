"""Training and test sets: tasks trained together, folds that never leak, sentences left out."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests import bundled
from tmd.diagnostics import TmdError
from tmd.evaluation.runs.config import ExperimentConfig
from tmd.evaluation.runs.dataset import BundledData, Dataset, Example, VeilDataset, read_protocol
from tmd.evaluation.runs.folds import Fold, folds_of, given_fold, halves, ranges
from tmd.evaluation.runs.jobs import leave_out, sentences, units_of
from tmd.pddl.model import Instruction
from tmd.world.demonstration import Demonstration, Segment

ROOT = Path(__file__).parents[2]
VEIL500 = os.environ.get("VEIL500_DIR")


@pytest.fixture(scope="module")
def data() -> BundledData:
    return bundled.data("ramen")


def folds(of: Dataset, **changes: object) -> list[Fold]:
    return folds_of(replace(ExperimentConfig("ramen", Path("out")), **changes), of)  # type: ignore[arg-type]


def check(found: list[Fold], data: Dataset) -> None:
    """Everything is tested once, nobody is tested where it was trained, and a name is one training set."""
    assert sorted(str(e.id) for f in found for e in f.test) == sorted(str(e.id) for e in data.examples)
    assert len({f.name for f in found}) == len(found)
    sets: dict[str, tuple[Example, ...]] = {}
    for fold in found:
        assert fold.train
        assert fold.test
        assert not {e.environment for e in fold.train} & {e.environment for e in fold.test}
        assert sets.setdefault(fold.training_set, fold.train) == fold.train
    assert len(set(map(id, sets.values()))) == len(sets)


def test_five_kitchens_make_ten_folds_that_test_everything_once(data: BundledData) -> None:
    found = halves(data.examples, data.examples)
    assert len(found) == 10
    for fold in found:
        assert not {e.environment for e in fold.train} & {e.environment for e in fold.test}
        assert len(fold.train) == 40


def test_the_paper_trains_two_tasks_together(data: BundledData) -> None:
    found = folds(data)
    check(found, data)
    assert len(found) == 10
    assert {len(f.train) for f in found} == {80}
    assert {e.task for f in found for e in f.train} == {"affogato", "ramen"}
    assert {e.task for f in found for e in f.test} == {"ramen"}
    assert found[0].training_set == "affogato+ramen_2-5"


def test_all_tasks_are_tested_in_two_groups(data: BundledData) -> None:
    everything = bundled.data("all")
    found = folds(everything, task="all")
    check(found, everything)
    assert len(found) == 20
    for fold in found:
        assert {e.task for e in fold.train} == {e.task for e in fold.test}
    pairs = {frozenset(e.task for e in fold.test) for fold in found}
    assert pairs == {frozenset({"boiling_water", "coffee"}), frozenset({"affogato", "ramen"})}
    alone = {f.training_set: f.train for f in folds(data)}
    assert all(alone[f.training_set] == f.train for f in found if f.training_set in alone)
    assert set(alone) < {f.training_set for f in found}


def test_folds_share_a_unit_where_they_share_a_training_set(data: BundledData) -> None:
    units = units_of(("empty", "chance"), folds(data))
    assert len(units) == 10
    assert all(unit.folds == (f"kitchen{i % 5 + 1}a", f"kitchen{i % 5 + 1}b") for i, unit in enumerate(units))


@pytest.mark.parametrize("tasks", [("ramen",), ("coffee",), ("ramen", "coffee")])
def test_training_tasks_can_be_named(data: BundledData, tasks: tuple[str, ...]) -> None:
    found = folds(data, train_tasks=tasks)
    check(found, data)
    assert {e.task for f in found for e in f.train} == set(tasks)


def test_environment_numbers_choose_the_fold(data: BundledData) -> None:
    (fold,) = given_fold(data.examples, data.examples, None, {2, 3})
    assert {e.number for e in fold.test} == {2, 3}
    assert {e.number for e in fold.train} == {1, 4, 5}
    (fold,) = given_fold(data.examples, data.examples, {1}, None)
    assert {e.number for e in fold.test} == {2, 3, 4, 5}
    (fold,) = folds(data, train_environments=(1, 3))
    assert {(e.number, e.task) for e in fold.train} == {(n, t) for n in (1, 3) for t in ("affogato", "ramen")}
    assert fold.training_set == "affogato+ramen_1,3"


@pytest.mark.parametrize(("train", "test"), [({1, 2}, {2}), ({1}, {9}), ({9}, {1}), (set(range(1, 6)), None)])
def test_folds_that_leak_or_are_empty_are_refused(data: BundledData, train: set[int], test: set[int] | None) -> None:
    with pytest.raises(TmdError):
        given_fold(data.examples, data.examples, train, test)


def test_a_task_in_no_group_is_trained_with_all(tmp_path: Path) -> None:
    domain = tmp_path / "kitchen"
    domain.mkdir()
    for name in ("environments", "affogato", "coffee", "ramen"):
        (domain / name).symlink_to(ROOT / "problems" / "kitchen" / name)
    everything = BundledData("ramen", "kitchen", ROOT / "domains", tmp_path)
    assert everything.trained_with("ramen") == {"affogato", "coffee", "ramen"}
    assert {f.training_set for f in folds(everything)} == {
        f"all_{r}" for r in ("2-5", "1,3-5", "1-2,4-5", "1-3,5", "1-4")
    }
    (domain / "protocol.yaml").write_text("trained_together: [[affogato, ramen]]\n")
    grouped = BundledData("all", "kitchen", ROOT / "domains", tmp_path)
    assert grouped.trained_with("ramen") == {"affogato", "ramen"}
    assert grouped.trained_with("coffee") == {"affogato", "coffee", "ramen"}
    assert grouped.fingerprint() != bundled.data("all").fingerprint()


@pytest.mark.parametrize(
    ("text", "message", "line"),
    [
        ("trained_together: [[ramn]]\n", "there is no task 'ramn'", 1),
        ("trained_together:\n  - [ramen]\n  - [coffee, ramen]\n", "stands here twice", 3),
        ("trained_togther: []\n", "unknown key", 1),
        ("trained_together: [ramen]\n", "should be a list", 1),
        ("trained_together: [[\n", "not YAML", 2),
    ],
)
def test_a_wrong_protocol_is_refused_with_its_place(tmp_path: Path, text: str, message: str, line: int) -> None:
    path = tmp_path / "protocol.yaml"
    path.write_text(text)
    with pytest.raises(TmdError, match=message) as caught:
        read_protocol(path, {"ramen", "coffee"})
    assert caught.value.location is not None
    assert caught.value.location.line == line


def test_the_protocol_of_the_kitchen_is_the_papers() -> None:
    tasks = {"affogato", "boiling_water", "coffee", "ramen"}
    groups = read_protocol(ROOT / "problems" / "kitchen" / "protocol.yaml", tasks)
    assert set(groups) == {frozenset({"boiling_water", "coffee"}), frozenset({"affogato", "ramen"})}


@pytest.mark.skipif(not VEIL500, reason="VEIL500_DIR does not say where VEIL-500 is")
@pytest.mark.parametrize(("task", "count"), [("ramen", 4), ("party", 4), ("all", 8)])
def test_veil500_in_pairs_of_environments(task: str, count: int) -> None:
    data = VeilDataset(Path(VEIL500 or ""), task)
    found = folds(data, task=task, data="veil500")
    assert len(found) == count
    for fold in found:
        assert any({e.number for e in fold.test} <= pair for pair in ({1, 2}, {3, 4}, {5, 6}, {7, 8}))
        (world,) = {e.world for e in fold.train + fold.test}
        own = {e.task for e in data.pool if e.world == world}
        assert {e.task for e in fold.train} == own
        assert not {e.environment for e in fold.train} & {e.environment for e in fold.test}
        assert {e.number for e in fold.train + fold.test} <= set(range(1, 9))
    within = [e.id for e in data.examples if e.number <= 8]
    assert sorted(e.id for f in found for e in f.test) == sorted(within)
    (only,) = {e.world for e in data.examples} if task != "all" else {"both"}
    if only != "both":
        assert {f.training_set for f in found} == {f"{only}_{r}" for r in ("3-8", "1-2,5-8", "1-4,7-8", "1-6")}


@pytest.mark.parametrize(
    ("numbers", "text"), [((), ""), ((3,), "3"), ((2, 1), "1-2"), ((1, 3, 4, 5, 9), "1,3-5,9"), ((7, 7), "7")]
)
def test_ranges(numbers: tuple[int, ...], text: str) -> None:
    assert ranges(numbers) == text


@pytest.mark.parametrize(
    ("text", "cut"),
    [
        ("Boil water", ["Boil water"]),
        ("Boil water. Add ramen!", ["Boil water. ", "Add ramen!"]),
        ("Wait 2.5 minutes .Serve it", ["Wait 2.5 minutes .", "Serve it"]),
        ('Turn it to "high." Then wait ...', ['Turn it to "high." ', "Then wait ..."]),
        ("Take a cup\nFill it\n\nServe", ["Take a cup\n", "Fill it\n\n", "Serve"]),
        ("Take a cup; fill it: now", ["Take a cup; fill it: now"]),
        ("Go. ... .", ["Go. ... ."]),
        ("", []),
        ("...", ["..."]),
    ],
)
def test_sentences(text: str, cut: list[str]) -> None:
    assert [text[span.start : span.end] for span in sentences(text)] == cut


@given(st.text(alphabet="ab. !?\n\"'…|2;", max_size=60))
def test_sentences_are_the_whole_text(text: str) -> None:
    assert "".join(text[span.start : span.end] for span in sentences(text)) == text
    assert all(span.start < span.end for span in sentences(text))


def example(text: str, marks: list[tuple[int, int]], name: str = "x") -> Example:
    segments = tuple(Segment(a, b, (Instruction("wait", (str(i),)),)) for i, (a, b) in enumerate(marks))
    return Example(name, "t", "w", "w1", 1, Demonstration(name, "t", "w1", text, segments))


@given(
    st.lists(st.sampled_from(["Take a cup.", "Fill it!", "Wait 2.5 min .", "Serve"]), min_size=1, max_size=8),
    st.floats(0, 0.999),
    st.integers(0, 99),
)
def test_something_is_always_said(pieces: list[str], probability: float, seed: int) -> None:
    text = " ".join(pieces)
    whole = example(text, [(s.start, len(text[: s.end].rstrip())) for s in sentences(text)])
    read = leave_out(whole, probability, seed)
    left = read.demonstration.text
    assert left
    assert read.gold == whole.gold
    pieces_left = [left[s.start : s.end] for s in read.demonstration.segments if s.start < s.end]
    assert " ".join(pieces_left) == left
    rest = iter(text[s.start : s.end].strip() for s in sentences(text))
    assert all(piece in rest for piece in pieces_left), "the order is that of the text"
    assert leave_out(whole, probability, seed) == read
    assert len(leave_out(whole, (1 + probability) / 2, seed).demonstration.text) <= len(left)


def test_each_sentence_is_left_out_as_often_as_asked() -> None:
    text = "A one. B two. C three. D four."
    lost = [4 - len(sentences(leave_out(example(text, [], str(i)), 0.3, 1).demonstration.text)) for i in range(2000)]
    # binomial, but for the text of which nothing would be left (0.3 ** 4): one of its sentences stays
    assert np.mean(lost) / 4 == pytest.approx(0.3 - 0.3**4 / 4, abs=4 * np.sqrt(0.21 / 8000))


def test_segments_follow_their_words() -> None:
    text = "Boil water. Then add ramen and serve."
    whole = example(text, [(0, 10), (12, 26), (31, 36)])
    for seed in range(50):
        read = leave_out(whole, 0.5, seed).demonstration
        found = [read.text[s.start : s.end] for s in read.segments]
        assert found in (
            ["Boil water", "Then add ramen", "serve"],
            ["Boil water", "", ""],
            ["", "Then add ramen", "serve"],
        )
