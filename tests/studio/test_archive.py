"""Saving: nothing is lost or mixed, whoever writes at the same time and whatever goes wrong."""

from __future__ import annotations

import errno
import json
import os
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tmd import files as atomic
from tmd.check.checker import Checker
from tmd.diagnostics import OutputError, TmdError
from tmd.files import try_lock
from tmd.pddl.plan_file import parse_instruction
from tmd.studio.demonstrations.correction import Correction
from tmd.studio.demonstrations.demo_store import Archive
from tmd.studio.demonstrations.session import DemonstratedStep, Session
from tmd.world.corpus import Corpus
from tmd.world.demonstration import demonstration_line, read_demonstrations
from tmd.world.folder import DomainFolder
from tmd.world.world import make_world

ROOT = Path(__file__).parents[2]
TEXT = "Put the cup on the shelf."
PLAN = ["moveto(cup1)", "grasp(cup1)", "moveto(shelf1)", "keep(cup1, shelf1, on)"]
WRITER = """
import sys
from pathlib import Path
from tmd.pddl.plan_file import parse_instruction
from tmd.studio.demonstrations.demo_store import Archive
from tmd.studio.demonstrations.session import Session
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder

corpus = Corpus(DomainFolder(Path(sys.argv[1])), Path(sys.argv[2]))
for number in range(int(sys.argv[4])):
    session = Session(corpus.world("corner1"), f"Put the cup on the shelf for {sys.argv[3]} {number}.", corpus.lexicon)
    for line in sys.argv[5:]:
        session.do(parse_instruction(line))
    Archive(corpus, wait=60).save(session)
"""


def shown(corpus: Corpus, text: str = TEXT) -> Session:
    found = Session(corpus.world("corner1"), text, corpus.lexicon)
    for line in PLAN:
        found.do(parse_instruction(line))
    return found


def faults(corpus: Corpus, file: Path) -> list[str]:
    checker = Checker(domains=ROOT / "domains", problems=corpus.directory.parent)
    checker.check(file)
    return [diagnostic.message for diagnostic in checker.findings.sorted()]


def test_what_is_saved_is_found_by_everything_that_reads_demonstrations(table: Corpus) -> None:
    archive = Archive(table)
    found = archive.save(shown(table))
    file = table.directory / "shown" / "demonstrations.jsonl"
    assert (found.id, found.task, found.text) == ("shown-corner1-01", "shown", TEXT)
    assert [str(i) for i in found.instructions] == PLAN
    assert found.end_state == ("(at cup1 shelf1 on)", "(not (at cup1 table1 on))")
    assert (found.who, found.when, found.proposed) == (None, None, None)
    assert not {"who", "when", "proposed", "goal"} & json.loads(file.read_text()).keys()
    again = Corpus(table.folder, table.directory)
    assert again.demonstrations("shown") == [found]
    assert faults(table, file) == []
    assert archive.save(shown(table)).id == "shown-corner1-02"


def test_a_goal_is_saved_with_what_reaches_it(table: Corpus) -> None:
    archive, file = Archive(table), table.directory / "shown" / "demonstrations.jsonl"
    goal = "(exists (?x - item) (at ?x shelf1 on))"
    assert archive.save(shown(table), goal=goal).goal == json.loads(file.read_text())["goal"] == goal
    assert Corpus(table.folder, table.directory).demonstrations("shown")[0].goal == goal
    assert faults(table, file) == []
    before = file.read_bytes()
    for wrong, why in [
        ("(at cup1 table1 on)", r"is not reached: \(at cup1 table1 on\) does not hold at the end"),
        ("(at cup1 shelf9 on)", 'unknown object "shelf9"'),
        ("(at cup1", "never closed"),
    ]:
        with pytest.raises(TmdError, match=why):
            archive.save(shown(table), goal=wrong)
    assert file.read_bytes() == before


def test_a_correction_may_have_a_goal_that_its_plan_did_not_reach(table: Corpus) -> None:
    proposed = tuple(DemonstratedStep(parse_instruction(line), 0) for line in PLAN[:3])
    steps = tuple(DemonstratedStep(parse_instruction(line), 0) for line in PLAN)
    session = Correction(table.world("corner1"), TEXT, proposed, table.lexicon, steps)
    found = Archive(table).save(session, "corrected", goal="(at cup1 shelf1 on)")
    assert (found.goal, found.proposed) == ("(at cup1 shelf1 on)", tuple(step.instruction for step in proposed))
    assert faults(table, table.directory / "corrected" / "demonstrations.jsonl") == []


def test_a_task_that_is_there_grows_and_keeps_what_it_had(table: Corpus) -> None:
    file = table.directory / "set_table" / "demonstrations.jsonl"
    before = file.read_bytes()
    file.write_bytes(before.removesuffix(b"\n"))
    found = Archive(table).save(shown(table), "set_table")
    assert file.read_bytes() == before + demonstration_line(found).encode() + b"\n"
    numbers = [d.id for d in read_demonstrations(file)]
    assert len(set(numbers)) == len(numbers)
    assert faults(table, file) == []


def test_a_correction_keeps_the_plan_that_was_proposed(table: Corpus) -> None:
    proposed = tuple(DemonstratedStep(parse_instruction(line), 0) for line in PLAN[:3])
    steps = tuple(DemonstratedStep(parse_instruction(line), 0) for line in PLAN)
    session = Correction(table.world("corner1"), TEXT, proposed, table.lexicon, steps)
    found = Archive(table).save(session, "corrected")
    assert found.proposed == tuple(step.instruction for step in proposed)
    file = table.directory / "corrected" / "demonstrations.jsonl"
    assert faults(table, file) == []
    data = json.loads(file.read_text())
    for change, why in [
        ({"proposed": 3}, "proposed: should be a list"),
        ({"proposed": ["x"]}, "'x': "),
        ({"who": 7}, "who: should be text"),
    ]:
        file.write_text(json.dumps({**data, **change}) + "\n")
        assert why in "".join(faults(table, file))


@pytest.mark.parametrize(
    "task", ["", "..", "../x", "a/b", "/tmp/x", "Shown", "1a", "a b", "environments", "a" * 61, "ä"]
)
def test_a_task_has_a_plain_name(table: Corpus, task: str) -> None:
    with pytest.raises(TmdError, match="a task cannot be called"):
        Archive(table).save(shown(table), task)


def test_what_cannot_be_saved(table: Corpus, kitchen: Corpus) -> None:
    archive = Archive(table)
    with pytest.raises(TmdError, match="nothing was demonstrated yet"):
        archive.save(Session(table.world("corner1"), TEXT, table.lexicon))
    problem = table.world("corner2").task.problem
    elsewhere = make_world("attic", problem, table.lexicon)
    with pytest.raises(TmdError, match="'attic' is not an environment in"):
        archive.refuse(elsewhere)
    with pytest.raises(TmdError, match="'corner1' is not the environment of that name"):
        archive.refuse(make_world("corner1", problem, table.lexicon))
    assert not (table.directory / "shown").exists()


def test_a_damaged_file_is_not_touched(table: Corpus) -> None:
    file = table.directory / "set_table" / "demonstrations.jsonl"
    file.write_text(file.read_text() + '{"id": "half\n')
    before = file.read_bytes()
    with pytest.raises(TmdError) as caught:
        Archive(table).save(shown(table), "set_table")
    assert caught.value.location is not None
    assert (caught.value.location.file, caught.value.location.line) == (str(file), 4)
    assert file.read_bytes() == before


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EROFS, errno.EACCES])
def test_a_disk_that_takes_nothing(table: Corpus, monkeypatch: pytest.MonkeyPatch, number: int) -> None:
    file = table.directory / "set_table" / "demonstrations.jsonl"
    before = file.read_bytes()
    session = shown(table)

    def fail(path: Path, data: bytes, flags: int) -> None:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(atomic, "_write", fail)
    with pytest.raises(OutputError, match=os.strerror(number)):
        Archive(table).save(session, "set_table")
    monkeypatch.undo()
    assert file.read_bytes() == before
    assert sorted(p.name for p in file.parent.iterdir()) == [".demonstrations.jsonl.lock", "demonstrations.jsonl"]
    assert Archive(table).save(session, "set_table").instructions == session.instructions


def test_a_directory_that_cannot_be_made(table: Corpus) -> None:
    (table.directory / "shown").write_text("a file")
    with pytest.raises(OutputError, match="cannot be made"):
        Archive(table).save(shown(table))


def test_a_writer_waits_and_then_says_so(table: Corpus) -> None:
    archive = Archive(table, wait=0.05)
    archive.save(shown(table))
    lock = try_lock(table.directory / "shown" / ".demonstrations.jsonl.lock")
    assert lock is not None
    with pytest.raises(OutputError, match=r"somebody else has been writing there for 0\.05 seconds"):
        archive.save(shown(table))
    threading.Timer(0.1, lock.release).start()
    assert Archive(table).save(shown(table)).id == "shown-corner1-02"


def test_ten_threads_save_at_once(table: Corpus) -> None:
    archive = Archive(table, wait=60)

    def save(number: int) -> str:
        return archive.save(shown(table, f"Put the cup on the shelf for guest {number}.")).id

    with ThreadPoolExecutor(10) as pool:
        ids = list(pool.map(save, range(30)))
    found = read_demonstrations(table.directory / "shown" / "demonstrations.jsonl")
    assert sorted(ids) == sorted(d.id for d in found) == [f"shown-corner1-{n:02d}" for n in range(1, 31)]
    assert {d.text for d in found} == {f"Put the cup on the shelf for guest {n}." for n in range(30)}
    assert all([str(i) for i in d.instructions] == PLAN for d in found)


def test_processes_save_at_once(table: Corpus) -> None:
    names = ("Ann", "Bob")
    domain = str(ROOT / "domains" / "02_table")
    started = [
        subprocess.Popen([sys.executable, "-c", WRITER, domain, str(table.directory), name, "8", *PLAN])
        for name in names
    ]
    assert [process.wait() for process in started] == [0] * len(names)
    found = read_demonstrations(table.directory / "shown" / "demonstrations.jsonl")
    assert [d.id for d in found] == [f"shown-corner1-{n:02d}" for n in range(1, 17)]
    assert {d.text for d in found} == {f"Put the cup on the shelf for {name} {n}." for name in names for n in range(8)}


@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=st.text(min_size=1, max_size=40))
def test_any_text_is_read_back_as_it_was(table: Corpus, text: str) -> None:
    try:
        session = shown(table, text)
    except TmdError:
        return
    found = Archive(table).save(session)
    assert found.text == session.text and list(map(str, found.instructions)) == PLAN
    assert len(demonstration_line(found).splitlines()) == 1


def test_the_domain_may_lie_anywhere(table: Corpus, tmp_path: Path) -> None:
    link = tmp_path / "elsewhere"
    link.symlink_to(table.directory)
    corpus = Corpus(DomainFolder(table.folder.path), link)
    Archive(corpus).save(shown(corpus))
    assert (table.directory / "shown" / "demonstrations.jsonl").is_file()
