"""What is shown is known at once, is the same as what is learned later, and never half of it."""

from __future__ import annotations

import shutil
import threading
from pathlib import Path

import numpy as np
import pytest

from tmd.diagnostics import TmdError
from tmd.knowledge import Knowledge, known, library_to_json, place, recall, study
from tmd.library.library import learn
from tmd.pddl.model import GroundAtom
from tmd.pddl.plan_file import parse_instruction
from tmd.studio.demonstrations.correction import Correction
from tmd.studio.demonstrations.demo_store import Archive
from tmd.studio.demonstrations.session import DemonstratedStep, Session
from tmd.studio.teaching import Teacher
from tmd.world.corpus import Corpus
from tmd.world.demonstration import Demonstration
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).parents[2]
CHILL = [
    "find(mug1)", "moveto(mug1)", "grasp(mug1)", "moveto(fridge1)", "open(fridge1_door)", "keep(mug1, fridge1, in)",
    "close(fridge1_door)",
]  # fmt: skip
BOIL = [
    "find(kettle1)", "moveto(kettle1)", "grasp(kettle1)", "moveto(sink1)", "keep(kettle1, sink1, in)",
    "turn(sink1_handle, high)", "turn(sink1_handle, off)", "grasp(kettle1)", "moveto(stove1)",
    "keep(kettle1, stove1_burner1, on)", "turn(stove1_knob1, high)", "wait()",
]  # fmt: skip
TABLE = ["moveto(cup1)", "grasp(cup1)", "moveto(shelf1)", "keep(cup1, shelf1, on)"]


def show(corpus: Corpus, environment: str, text: str, plan: list[str], task: str = "shown") -> Demonstration:
    """Demonstrate from nothing, and save it."""
    session = Session(corpus.world(environment), text, corpus.lexicon)
    for line in plan:
        session.do(parse_instruction(line))
    return Archive(corpus).save(session, task)


def answer(teacher: Teacher, text: str, environment: str) -> list[str]:
    """The best plan; nothing where there is none."""
    plans = teacher.ground(text, teacher.corpus.world(environment)).plans
    return [str(instruction) for instruction in plans[0].instructions] if plans else []


def same(one: Knowledge, other: Knowledge) -> bool:
    assert (one.reward is None) == (other.reward is None)
    if one.reward is not None and other.reward is not None:
        assert np.array_equal(one.reward.theta, other.reward.theta)
    return library_to_json(one.library) == library_to_json(other.library)


def test_a_verb_that_nobody_showed_is_known_in_other_kitchens_once_it_is_shown(tmp_path: Path, learned: Path) -> None:
    shutil.copytree(ROOT / "problems" / "kitchen", tmp_path / "kitchen", ignore=shutil.ignore_patterns("learned"))
    corpus = Corpus(DomainFolder(ROOT / "domains" / "kitchen"), tmp_path / "kitchen")
    teacher = Teacher(corpus, learned)
    assert recall(corpus, place(corpus, learned)) is not None
    assert answer(teacher, "Frost the mug.", "kitchen2") == []
    found = show(corpus, "kitchen1", "Frost the mug.", CHILL)
    reward = teacher.knowledge.reward
    teacher.learn_one(found)
    assert teacher.knowledge.reward is reward
    for environment in ("kitchen2", "kitchen3", "kitchen5"):
        assert answer(teacher, "Frost the mug.", environment) == CHILL
    assert answer(teacher, "Please frost the cup.", "kitchen5") == [step.replace("mug1", "cup1") for step in CHILL]
    assert library_to_json(teacher.knowledge.library) == library_to_json(
        learn(Corpus(corpus.folder, corpus.directory).demonstrations(), corpus.world, corpus.lexicon)
    )


def test_boiling_water_from_nothing(tmp_path: Path) -> None:
    environments = tmp_path / "kitchen" / "environments"
    shutil.copytree(ROOT / "problems" / "kitchen" / "environments", environments)
    corpus = Corpus(DomainFolder(ROOT / "domains" / "kitchen"), environments.parent)
    teacher = Teacher(corpus)
    text = "Boil some water in the kettle."
    teacher.learn_one(show(corpus, "kitchen1", text, BOIL))
    world = corpus.world("kitchen2")
    grounded = teacher.ground(text, world)
    assert grounded.verdicts[0].valid
    end = world.task.decode(grounded.plans[0].state)
    assert {GroundAtom("contains", ("kettle1", "water")), GroundAtom("hot", ("kettle1",))} <= end


def test_what_is_learned_at_once_is_what_is_learned_later(table: Corpus) -> None:
    teacher = Teacher(table)
    for task, text in [
        ("set_table", "Put the cup on the shelf."),
        ("a_task", "Bring the cup to the shelf."),
        ("zoo", "x"),
    ]:
        teacher.learn_one(show(table, "corner1", text, TABLE, task))
        later = Corpus(table.folder, table.directory)
        everything = learn(later.demonstrations(), later.world, later.lexicon)
        assert library_to_json(teacher.knowledge.library) == library_to_json(everything)
    assert ("zoo-corner1-01", "x") in teacher.knowledge.library.unaligned
    assert answer(teacher, "Bring the cup to the shelf.", "corner1") == TABLE


def test_what_others_saved_or_removed_is_taken_up(table: Corpus) -> None:
    teacher = Teacher(table)
    show(table, "corner1", "Lift the cup to the shelf.", TABLE, "theirs")
    teacher.learn_one(show(table, "corner1", "Hide the cup on the shelf.", TABLE, "mine"))
    assert {"lift", "hide"} <= set(teacher.knowledge.library.verbs())
    (table.directory / "theirs" / "demonstrations.jsonl").unlink()
    teacher.learn_one(show(table, "corner1", "Raise the cup to the shelf.", TABLE, "mine"))
    assert "lift" not in teacher.knowledge.library.verbs()
    before = teacher.knowledge
    later = show(table, "corner1", "Throw the cup to the shelf.", TABLE, "mine")
    (table.directory / "set_table" / "demonstrations.jsonl").write_text("{\n")
    with pytest.raises(TmdError, match="not valid JSON"):
        teacher.learn_one(later)
    assert teacher.knowledge is before


def test_what_is_in_no_file_is_not_learned(table: Corpus) -> None:
    teacher = Teacher(table)
    found = show(table, "corner1", "Hide the cup on the shelf.", TABLE)
    (table.directory / "shown" / "demonstrations.jsonl").unlink()
    with pytest.raises(TmdError, match="'shown-corner1-01' is not among the demonstrations"):
        teacher.learn_one(found)


def test_what_is_learned_in_the_background_is_what_tmd_ground_has(table: Corpus) -> None:
    teacher = Teacher(table)
    teacher.learn_one(show(table, "corner1", "Hide the cup on the shelf.", TABLE))
    teacher.retrain()
    assert teacher.learning
    assert teacher.wait(120) and not teacher.learning
    later = Corpus(table.folder, table.directory)
    assert same(teacher.knowledge, study(later))
    assert same(teacher.knowledge, known(later))
    assert recall(later, place(later)) is None  # what `tmd learn` saves is not touched
    assert answer(teacher, "Hide the cup on the shelf.", "corner1") == TABLE


def test_what_is_saved_while_it_is_learned_is_learned_once_more(table: Corpus) -> None:
    teacher = Teacher(table)
    teacher.retrain()
    teacher.learn_one(show(table, "corner1", "Hide the cup on the shelf.", TABLE))
    teacher.retrain()
    assert "hide" in teacher.knowledge.library.verbs()
    assert teacher.wait(120) and not teacher.learning
    assert same(teacher.knowledge, study(Corpus(table.folder, table.directory)))


def test_what_others_save_is_known_with_the_next_sentence(table: Corpus) -> None:
    teacher = Teacher(table)
    assert answer(teacher, "Polish the cup on the shelf.", "corner1") == []
    show(Corpus(table.folder, table.directory), "corner1", "Polish the cup on the shelf.", TABLE)
    assert answer(teacher, "Polish the cup on the shelf.", "corner1") == TABLE
    assert teacher.wait(120)
    assert same(teacher.knowledge, known(Corpus(table.folder, table.directory)))


def test_learning_that_fails_or_is_stopped_changes_nothing(table: Corpus) -> None:
    teacher, stopped = Teacher(table), Teacher(table)
    before = teacher.knowledge
    (table.directory / "shown").mkdir()
    (table.directory / "shown" / "demonstrations.jsonl").write_text("[]\n")
    for one, message in ((stopped, "learning was stopped"), (teacher, "a demonstration is a JSON object")):
        one.retrain()
        if one is stopped:
            one.close()
        with pytest.raises(TmdError, match=message):
            one.wait(120)
        assert not one.learning
    assert teacher.knowledge is before


def test_that_nothing_is_to_be_done_is_a_correction_that_is_saved_and_learned_from(table: Corpus) -> None:
    world, text = table.world("corner1"), "Polish the cup."
    correction = Correction(world, text, [DemonstratedStep(parse_instruction(TABLE[0]), 0)], table.lexicon)
    correction.delete(1)
    saved = Archive(table).save(correction)
    assert saved.instructions == () and [str(i) for i in saved.proposed or ()] == TABLE[:1]
    teacher = Teacher(table)
    teacher.retrain()
    assert teacher.wait(120)
    assert saved in table.demonstrations()
    assert answer(teacher, "Put the cup on the shelf.", "corner1")


def test_where_nothing_can_be_kept_it_is_learned_all_the_same(
    table: Corpus, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    teacher = Teacher(table)
    teacher.retrain()
    assert teacher.wait(120)
    assert same(teacher.knowledge, study(table))


def test_who_grounds_meanwhile_has_what_was_known_before_or_after(table: Corpus) -> None:
    teacher = Teacher(table)
    text = "Polish the cup on the shelf."
    world = table.world("corner1")
    before = answer(teacher, text, "corner1")
    seen: list[list[str]] = []
    stop = threading.Event()

    def ask() -> None:
        while not stop.is_set():
            plans = teacher.ground(text, world).plans
            seen.append([str(i) for i in plans[0].instructions] if plans else [])

    askers = [threading.Thread(target=ask) for _ in range(3)]
    for asker in askers:
        asker.start()
    teacher.learn_one(show(table, "corner1", text, TABLE))
    for asker in askers:
        while len(seen) < 30 and asker.is_alive():
            asker.join(0.01)
    stop.set()
    for asker in askers:
        asker.join()
    assert before == []
    assert all(plan in (before, TABLE) for plan in seen)
    assert answer(teacher, text, "corner1") == TABLE
