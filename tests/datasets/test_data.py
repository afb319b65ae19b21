from __future__ import annotations

from collections import Counter
from pathlib import Path
from statistics import mean, median

import pytest

from experiments.veil500_report import unknown_objects, words
from tmd.datasets.veil500 import VeilData, load, mentioned
from tmd.datasets.veil500.data import task_slug
from tmd.diagnostics import DataError
from tmd.pddl.model import Instruction


def test_points(small: VeilData) -> None:
    first, second = small.points
    assert (first.index, first.world, first.environment, first.task) == (0, "kitchen", 2, "ramen")
    assert first.objective == "Making Ramen"
    assert first.text == "Boil water in the pot . Rinse the plate now . Stop ."
    assert first.repeats_removed == 1
    assert [g.segments for g in first.groups] == [(0,), (1,), (2, 3)]
    assert first.instructions == (
        Instruction("moveto", ("kettle",)),
        Instruction("keep", ("kettle", "sink", "on")),
    )
    assert (second.world, second.environment, second.task) == ("living_room", 1, "movie_night")
    assert small.environment_of(second).by_name["Tv_1"].states["Volume"]


@pytest.mark.parametrize(
    ("objective", "slug"),
    [
        (" Making Affogato", "affogato"),
        ("Boiling Water", "boiling_water"),
        ("Clean the Kitchen", "clean_kitchen"),
        ("Make Breakfast", "breakfast"),
        ("Prepare Room for Game Night", "game_night"),
        ("Something Else", "something_else"),
    ],
)
def test_task_slug(objective: str, slug: str) -> None:
    assert task_slug(objective) == slug


def _edit(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        ("data.xml", "number_2", "number_12", "names no environment"),
        ("data.xml", "number_2", "number_3", "kitchen3.xml is missing"),
        ("data.xml", "number9", "number0", "livingRoom10.xml is missing"),
        ("data.xml", "<objective> Making Ramen</objective>", "", "has no <objective>"),
        ("data.xml", "<action>moveto Kettle</action>", "<action> </action>", "without words"),
        ("data.xml", "<action>moveto Kettle</action>", "<act>x</act>", "<act> in an action sequence"),
        ("data.xml", "moveto Kettle", "moveto Kett,le", "is not a name"),
        ("data.xml", "</root>", "", "not well-formed"),
        ("Objects.xml", "</objects>", "", "not well-formed"),
        (
            "Environments/kitchen/kitchen2.xml",
            "<name>Sink</name>",
            "<name>a b</name>",
            "not a name for an object",
        ),
        ("Environments/kitchen/kitchen2.xml", "(60, 43, 0)", "(60, here)", "needs three numbers"),
        ("Environments/kitchen/kitchen2.xml", "<environment>", "<world>", "not well-formed"),
    ],
)
def test_faults_are_named_with_their_place(small_directory: Path, file: str, old: str, new: str, message: str) -> None:
    _edit(small_directory / file, old, new)
    with pytest.raises(DataError, match=message) as caught:
        load(small_directory)
    assert caught.value.hint
    assert caught.value.location is not None and caught.value.location.file.endswith(file.split("/")[-1])


@pytest.mark.parametrize("file", ["data.xml", "Objects.xml"])
def test_missing_files(small_directory: Path, file: str) -> None:
    (small_directory / file).unlink()
    with pytest.raises(DataError, match=f"{file} is missing"):
        load(small_directory)


def test_truncation_anywhere_is_one_clear_error(small_directory: Path) -> None:
    path = small_directory / "data.xml"
    whole = path.read_bytes().rstrip()
    for length in range(0, len(whole) - 1, 37):
        path.write_bytes(whole[:length])
        with pytest.raises(DataError):
            load(small_directory)


def test_wrong_directories(tmp_path: Path, small_directory: Path) -> None:
    with pytest.raises(DataError, match="not a directory"):
        load(tmp_path / "nowhere")
    with pytest.raises(DataError, match=r"data\.xml is missing"):
        load(small_directory / "Environments")
    (small_directory / "data.xml").write_text((small_directory / "Objects.xml").read_text())
    with pytest.raises(DataError, match="<root> expected, <objects> found"):
        load(small_directory)


def test_any_environment_of_either_world(small_directory: Path) -> None:
    """Living rooms are numbered backwards in the labels, down to 0."""
    rooms = small_directory / "Environments/livingRoom"
    (rooms / "livingRoom1.xml").rename(rooms / "livingRoom10.xml")
    kitchens = small_directory / "Environments/kitchen"
    (kitchens / "kitchen2.xml").rename(kitchens / "kitchen10.xml")
    _edit(small_directory / "data.xml", "environment_number9", "environment_number_0")
    _edit(small_directory / "data.xml", "environment_number_2", "environment_number10")
    data = load(small_directory)
    assert [point.key for point in data.points] == [("kitchen", 10), ("living_room", 10)]
    assert list(data.environments) == [("kitchen", 10), ("living_room", 10)]


def test_odd_environments_can_be_used(small_directory: Path) -> None:
    path = small_directory / "Environments/kitchen/kitchen2.xml"
    _edit(path, "<name>Robinia_7</name>", "<name>Sink</name>")
    _edit(path, "<position>(0, 40, 90)</position>", "")
    kitchen = load(small_directory).environments["kitchen", 2]
    assert kitchen.repeated == ("Sink",)
    assert kitchen.by_name["Sink"].position.x == 60
    assert kitchen.by_name["Fridge"].placeholder


def test_environments_are_optional_but_some(small_directory: Path) -> None:
    for path in (small_directory / "Environments").rglob("*.xml"):
        path.unlink()
    with pytest.raises(DataError, match="no environment below"):
        load(small_directory)


def test_counts_of_the_release(released: VeilData) -> None:
    points = released.points
    per_file = Counter(point.key for point in points)
    assert [per_file["kitchen", n] for n in range(1, 9)] == [25, 28, 25, 26, 24, 29, 22, 30]
    assert [per_file["living_room", n] for n in range(1, 9)] == [18, 16, 21, 18, 17, 31, 16, 14]
    assert Counter(point.task for point in points) == {
        "ramen": 45,
        "clean_kitchen": 42,
        "boiling_water": 41,
        "affogato": 41,
        "breakfast": 40,
        "game_night": 36,
        "study_night": 31,
        "party": 26,
        "movie_night": 24,
        "clean_room": 34,
    }
    folds = [{1, 2}, {3, 4}, {5, 6}, {7, 8}]
    assert [sum(p.environment in fold for p in points) for fold in folds] == [87, 90, 101, 82]
    assert unknown_objects(released) == []


def test_texts_of_the_release(released: VeilData) -> None:
    points = released.points
    texts = Counter(words(point.text) for point in points)
    assert sorted(Counter(texts.values()).items()) == [(1, 201), (2, 48), (3, 18), (4, 1), (5, 1)]
    lengths = [len(words(point.raw)) for point in points]
    assert (round(mean(lengths), 1), median(lengths), min(lengths), max(lengths)) == (29.0, 25.5, 2, 112)
    assert len({word for text in texts for word in text}) == 575
    assert sum(point.repeats_removed > 0 for point in points) == 35
    assert sum("\n" in point.raw for point in points) == 19
    assert sum("|" not in point.raw for point in points) == 10
    pieces = [piece for point in points for piece in point.raw.split("|")]
    assert (len(pieces), sum(bool(words(piece)) for piece in pieces)) == (1959, 1677)
    groups = Counter((p.key, words(p.text)) for p in points)
    repeated = [n for n in groups.values() if n > 1]
    assert (len(repeated), sum(repeated)) == (68, 158)
    assert Counter(len({key for key, other in groups if other == text}) for text in texts) == {1: 268, 2: 1}


def test_actions_of_the_release(released: VeilData) -> None:
    points = released.points
    lengths = [len(point.instructions) for point in points]
    assert (sum(lengths), round(mean(lengths), 1), median(lengths), max(lengths)) == (7014, 19.5, 17, 192)
    assert (lengths.count(0), lengths.count(1)) == (4, 6)
    groups = [group for point in points for group in point.groups]
    assert (len(groups), sum(not group.instructions for group in groups)) == (1308, 384)
    assert sum(len(point.groups) == 1 for point in points) == 47
    assert Counter(len(p.groups) - len(p.segments) for p in points).most_common(3) == [
        (-2, 288),
        (-1, 48),
        (0, 15),
    ]
    actions = Counter(i for point in points for i in point.instructions)
    assert (len(actions), sum(n == 1 for n in actions.values())) == (271, 50)
    assert len({name for instruction in actions for name in mentioned(instruction)}) == 70
    verbs = Counter[str]()
    for instruction, number in actions.items():
        verbs[instruction.name] += number
    assert verbs == {
        "moveto": 2425,
        "grasp": 1895,
        "keep": 1008,
        "release": 675,
        "turn": 236,
        "open": 220,
        "close": 152,
        "press": 161,
        "wait": 83,
        "scoopto": 24,
        "add": 21,
        "scoopfrom": 27,
        "squeeze": 12,
        "pour_out": 32,
        "pour": 17,
        "insert": 26,
    }
    targets = Counter(i.args[1] for p in points for i in p.instructions if i.name == "keep")
    assert (targets["loveseat_1"], targets["sink"], targets["coffeetable_1"]) == (291, 259, 177)
    relations = Counter(i.args[2] for p in points for i in p.instructions if i.name == "keep")
    assert relations == {"on": 974, "inside": 34}
