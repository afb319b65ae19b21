"""What was not saved is offered again, whatever ended the process; what is damaged is told of and kept."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tmd import files as atomic
from tmd.diagnostics import OutputError, TmdError
from tmd.pddl.plan_file import parse_instruction
from tmd.studio.demonstrations.drafts import Draft, Drafts, place
from tmd.studio.demonstrations.session import Session
from tmd.world.corpus import Corpus

ROOT = Path(__file__).parents[2]
TEXT = "Take the cup and put it on the shelf."
PLAN = ["moveto(cup1)", "grasp(cup1)", "moveto(shelf1)", "keep(cup1, shelf1, on)"]
DEMONSTRATOR = """
import sys
from pathlib import Path
from tmd.pddl.plan_file import parse_instruction
from tmd.studio.demonstrations.drafts import Draft, Drafts
from tmd.studio.demonstrations.session import Session
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder

corpus = Corpus(DomainFolder(Path(sys.argv[1])), Path(sys.argv[2]))
drafts = Drafts(Path(sys.argv[3]))
drafts.enter("guest")
session = Session(corpus.world("corner1"), sys.argv[4], corpus.lexicon)
for line in sys.argv[5:]:
    session.do(parse_instruction(line))
    drafts.keep("guest", Draft.of(session, "shown"))
    print(line, flush=True)
while True:
    session.undo()
    session.redo()
    drafts.keep("guest", Draft.of(session, "shown"))
"""


@pytest.fixture
def drafts(tmp_path: Path) -> Drafts:
    return Drafts(tmp_path / "drafts")


def demonstrated(corpus: Corpus, steps: int = 4) -> Session:
    found = Session(corpus.world("corner1"), TEXT, corpus.lexicon)
    for line in PLAN[:steps]:
        found.do(parse_instruction(line))
    return found


def test_a_draft_is_the_session_again(table: Corpus, drafts: Drafts) -> None:
    session = demonstrated(table)
    session.mark(3, 1)
    visitor = drafts.enter()
    drafts.keep(visitor, Draft.of(session, "shown"))
    drafts.leave(visitor)
    drafts.enter(visitor)
    taken = drafts.of(visitor, Draft)
    assert taken is not None
    assert (taken.task, taken.environment) == ("shown", "corner1")
    again = taken.resume(table.world("corner1"), table.lexicon)
    assert (again.steps, again.pins, again.text, again.state) == (session.steps, {3: 1}, session.text, session.state)
    assert again.undo() and again.pins == {}
    assert again.undo()
    assert again.instructions == session.instructions[:3]
    drafts.discard(visitor, Draft)
    drafts.leave(visitor)
    assert list(drafts.directory.iterdir()) == []


def test_who_is_here_is_here_once(drafts: Drafts, table: Corpus) -> None:
    drafts.enter("me")
    for studio in (drafts, Drafts(drafts.directory)):
        with pytest.raises(TmdError, match="'me' is here already"):
            studio.enter("me")
    with pytest.raises(TmdError, match="'you' is not here"):
        drafts.keep("you", Draft.of(demonstrated(table), "shown"))
    for name in ("../x", "a b", "x" * 65, "ä"):
        with pytest.raises(TmdError, match="cannot be the name of a visitor"):
            drafts.enter(name)


def test_a_killed_process_loses_no_action_that_was_done(table: Corpus, drafts: Drafts) -> None:
    arguments = [str(ROOT / "domains" / "02_table"), str(table.directory), str(drafts.directory), TEXT, *PLAN[:3]]
    process = subprocess.Popen([sys.executable, "-c", DEMONSTRATOR, *arguments], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    for line in PLAN[:3]:
        assert process.stdout.readline().strip() == line
    with pytest.raises(TmdError, match="'guest' is here already"):
        drafts.enter("guest")
    process.kill()
    process.wait()
    process.stdout.close()
    drafts.enter("guest")
    draft = drafts.of("guest", Draft)
    assert draft is not None
    assert len(draft.instructions) in (2, 3)
    again = draft.resume(table.world("corner1"), table.lexicon)
    assert [str(i) for i in again.instructions] == PLAN[: len(draft.instructions)]


DAMAGE = ["", "{", "[]", "null", '{"draft": 2}', '{"draft": 1}', "\x00", "[" * 100_000, '"' + "x" * 2_000_000 + '"']


@pytest.mark.parametrize("content", DAMAGE, ids=range(len(DAMAGE)))
def test_a_damaged_draft_is_set_aside_and_reported(drafts: Drafts, content: str) -> None:
    drafts.enter("bad")
    (drafts.directory / "bad.json").write_text(content)
    with pytest.raises(TmdError, match=r"^the draft of 'bad' is damaged \(") as error:
        drafts.of("bad", Draft)
    assert "\n" not in str(error.value)
    (aside,) = drafts.directory.glob("bad.json.damaged-*")
    assert aside.read_text() == content
    assert drafts.of("bad", Draft) is None


@settings(max_examples=80, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_no_draft_crashes_the_studio(table: Corpus, drafts: Drafts, data: st.DataObject) -> None:
    drafts.leave("one")
    drafts.enter("one")
    drafts.keep("one", Draft.of(demonstrated(table), "shown"))
    file = drafts.directory / "one.json"
    content = json.loads(file.read_text())
    anything = (
        st.none() | st.integers() | st.text(max_size=5) | st.lists(st.integers() | st.text(max_size=3), max_size=3)
    )
    for key in data.draw(st.lists(st.sampled_from(sorted(content)), max_size=3)):
        content[key] = data.draw(anything | st.lists(anything, max_size=2))
    file.write_text(json.dumps(content))
    try:
        draft = drafts.of("one", Draft)
        assert draft is not None
        draft.resume(table.world("corner1"), table.lexicon)
    except TmdError as error:
        assert "\n" not in str(error)


def test_a_disk_that_takes_nothing_leaves_the_draft_before(
    table: Corpus, drafts: Drafts, monkeypatch: pytest.MonkeyPatch
) -> None:
    drafts.enter("me")
    drafts.keep("me", Draft.of(demonstrated(table, 2), "shown"))

    def full(path: Path, data: bytes, flags: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(atomic, "_write", full)
    with pytest.raises(OutputError, match="No space left on device"):
        drafts.keep("me", Draft.of(demonstrated(table, 3), "shown"))
    draft = drafts.of("me", Draft)
    assert draft is not None
    assert len(draft.instructions) == 2


def test_each_corpus_has_its_own_drafts(table: Corpus, kitchen: Corpus, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMD_STUDIO_STATE", "/somewhere")
    assert place(table).parent == Path("/somewhere")
    assert place(table) != place(Corpus(table.folder, ROOT / "problems" / "02_table"))
    monkeypatch.delenv("TMD_STUDIO_STATE")
    monkeypatch.setenv("XDG_STATE_HOME", "/state")
    assert place(kitchen).parent == Path("/state/tmd/studio")
