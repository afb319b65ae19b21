"""Many visitors at once, and what is sent that no page would send; without a browser, so that it is quick."""

from __future__ import annotations

import json
import random
import shutil
import socket
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Event

import pytest

pytest.importorskip("viser", reason="needs the extra studio")

from experiments.studio.wire import Wire
from tmd.diagnostics import TmdError
from tmd.domain_kit import DomainKit
from tmd.ground import Ask
from tmd.grounded import Grounded
from tmd.readers.interface import Reader
from tmd.studio.page import EVENT
from tmd.studio.server import Server, free_port
from tmd.studio.studio import Studio
from tmd.studio.teaching import Teacher
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder
from tmd.world.roots import Roots
from tmd.world.world import World

VISITORS = 10
TEXT = "Put the cup on the shelf"
STEPS = ("moveto(cup1)", "grasp(cup1)", "moveto(shelf1)", "keep(cup1, shelf1, on)")
OBJECTS = ("cup1", "cup1", "shelf1", "shelf1")
SAID = dict(
    zip(
        STEPS,
        ("Go and stand before cup1", "Take cup1", "Go and stand before shelf1", "Put cup1 on shelf1"),
        strict=True,
    )
)
"""What the page calls them."""


@pytest.fixture
def server(table: Corpus, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Server]:
    monkeypatch.setenv("TMD_STUDIO_STATE", str(tmp_path / "drafts"))
    served = Server(Studio(table, Teacher(table), "corner1"), "127.0.0.1", 0)
    yield served
    served.close()


def corpus(server: Server, task: str = "shown") -> list[dict[str, object]]:
    file = server.studio.corpus.directory / task / "demonstrations.jsonl"
    return [json.loads(line) for line in file.read_text().splitlines()]


def begin(visitor: Wire, text: str) -> None:
    visitor.put("Task text", text)
    visitor.press("Begin")
    visitor.told("Point at an object")


def do(visitor: Wire, name: str, instruction: str) -> None:
    if visitor.elements[visitor.find("With")]["value"] != name:
        visitor.put("With", name)
    visitor.press(SAID[instruction])
    visitor.shows(f"▸ {SAID[instruction]}")


def test_ten_visitors_at_once(server: Server) -> None:
    def demonstrate(number: int) -> int:
        count = 2 + number % 3
        with Wire(server.url) as visitor:
            begin(visitor, f"{TEXT}, visitor {number}.")
            for name, instruction in list(zip(OBJECTS, STEPS, strict=True))[:count]:
                do(visitor, name, instruction)
            visitor.press("Save (K)")
            visitor.told("Saved as shown-corner1-")
        return count

    with ThreadPoolExecutor(VISITORS) as pool:
        counts = list(pool.map(demonstrate, range(VISITORS)))
    records = corpus(server)
    assert len(records) == VISITORS == len({record["id"] for record in records})
    by_text = {str(record["text"]): record for record in records}
    for number, count in enumerate(counts):
        segments = by_text[f"{TEXT}, visitor {number}."]["segments"]
        assert isinstance(segments, list)
        assert tuple(i for segment in segments for i in segment["instructions"]) == STEPS[:count]


def test_what_was_not_saved_is_offered_on_return(server: Server) -> None:
    with Wire(server.url) as visitor:
        begin(visitor, f"{TEXT}.")
        do(visitor, "cup1", STEPS[0])
        identity = visitor.identity
    with Wire(server.url, identity) as again:
        again.press("Go on with what was not saved")
        again.told("1 steps")
        do(again, "cup1", STEPS[1])
        again.press("Throw away")
        again.told("Thrown away")
    with Wire(server.url, identity) as third:
        third.told("Welcome")
        assert not third.elements[third.find("Go on with what was not saved")]["visible"]


def test_a_second_window_of_a_browser_finds_its_own_again(server: Server) -> None:
    with Wire(server.url) as one:
        begin(one, f"{TEXT}.")
        do(one, "cup1", STEPS[0])
        with Wire(server.url, one.identity) as two:
            begin(two, "Take the cup.")
            do(two, "cup1", STEPS[0])
            do(two, "cup1", STEPS[1])
            browser = two.identity
        assert browser != one.identity
        with Wire(server.url, browser) as again:
            again.press("Go on with what was not saved")
            again.told("2 steps")
    with Wire(server.url, f"no such name,{browser},{'x' * 100_000}") as last:
        last.press("Go on with what was not saved")
        last.told("not saved")


def test_a_corpus_that_cannot_be_written_to(server: Server) -> None:
    (server.studio.corpus.directory / "blocked").write_text("a file where a directory should be")
    with Wire(server.url) as visitor:
        begin(visitor, f"{TEXT}.")
        do(visitor, "cup1", STEPS[0])
        for task, answer in (("blocked", "cannot be"), ("../../etc", "cannot be called"), ("taken", "Saved as taken-")):
            visitor.put("Task name", task)
            visitor.press("Save (K)")
            visitor.told(answer)
    assert len(corpus(server, "taken")) == 1


def test_an_environment_that_is_not_in_the_corpus(
    table: Corpus, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TMD_STUDIO_STATE", str(tmp_path / "drafts"))
    file = tmp_path / "mine.yaml"
    file.write_text(table.file("corner1").read_text().replace("name: corner1", "name: mine"))
    served = Server(Studio(table, Teacher(table), file), "127.0.0.1", 0)
    try:
        with Wire(served.url) as visitor:
            visitor.put("Task text", f"{TEXT}.")
            visitor.press("Begin")
            visitor.told("nothing that is shown in it can be saved")
            visitor.press("Save (K)")
            visitor.told("no demonstration is under way")
    finally:
        served.close()


def test_what_no_page_would_send(server: Server, capfd: pytest.CaptureFixture[str]) -> None:
    rng = random.Random(0)
    with Wire(server.url) as visitor:
        visitor.told("Welcome")
        begin(visitor, f"{TEXT}.")
        for label, value in (
            ("With", "no such object"), ("With", 7), ("With", None), ("Text", 5), ("Text", "x" * 100_000),
            ("Text", "\x00\ud7ff\u202e"), ("Step", 10**9), ("Step", "one"), ("It serves", "17"),
            ("Environment", "../../etc"), ("Environment", []), ("Task name", {"a": 1}), ("Steps a second", -1),
        ):  # fmt: skip
            visitor.put(label, value)
        for label in (
            "Plan it",
            "Start over",
            "Save (K)",
            "Throw away",
            "Insert behind this step",
        ):
            visitor.press(label)
        visitor.send({"type": "GuiUpdateMessage", "uuid": "none", "updates": {"value": 1}})
    for data in (b"", b"\xff" * 40, rng.randbytes(2_000), b"\x81\xa4type\xa4None"):
        with Wire(server.url) as rude:
            rude.garbage(data)
    with Wire(server.url) as polite:
        begin(polite, f"{TEXT}.")
        do(polite, "cup1", STEPS[0])
        assert "Traceback" not in polite.said()
    assert "tmd/studio" not in capfd.readouterr().err


def test_a_port_in_use() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        with pytest.raises(TmdError, match="in use"):
            free_port("127.0.0.1", taken.getsockname()[1])
    with pytest.raises(TmdError, match="cannot be listened at"):
        free_port("192.0.2.1", 0)
    with pytest.raises(TmdError, match="cannot be listened at"):
        free_port("\udcff", 0)


def test_serving_ends(server: Server) -> None:
    ended = Event()
    ended.set()
    server.serve(ended)


def test_goals_are_ticked_off_and_refusals_say_what_to_do(server: Server) -> None:
    with Wire(server.url) as visitor:
        visitor.put("Text", f"{TEXT}.")
        visitor.press("Plan it")
        visitor.told("Planned in")
        visitor.shows("○</span> cup1 is on shelf1")
        buttons = next(uuid for uuid, each in visitor.elements.items() if "▶|" in each.get("options", ()))
        visitor.send({"type": "GuiUpdateMessage", "uuid": buttons, "updates": {"value": "▶|"}})
        visitor.shows("✓</span> cup1 is on shelf1")
        visitor.put("Text", "Put the zebra on the shelf.")
        visitor.press("Plan it")
        visitor.told("No plan: clause 1: nothing here is called &#39;zebra&#39;.")
        visitor.told("name a thing that is there")
        visitor.told("try: Put the cup on")


def test_what_is_refused_leaves_no_other_plan_behind(server: Server) -> None:
    with Wire(server.url) as visitor:
        for text, answer in (
            ("x" * 30_000, "characters"),
            ("kettle " * 1_400, "at most 1,000"),
            ("", "the text is empty"),
            ("<b onclick=alert(1)>zzz</b>", "No plan"),
            ("Where is the cup?", "this is a question"),
            ("Do not take the cup.", "only forbids something"),
        ):
            visitor.put("Text", f"{TEXT}.")
            visitor.press("Plan it")
            visitor.told("Planned in")
            visitor.shows("reaches its goals")
            visitor.put("Text", text)
            visitor.press("Plan it")
            visitor.told(answer)
            visitor.until(
                lambda: not any("cup1 is on shelf1" in str(e.get("content")) for e in visitor.elements.values())
            )


def test_a_correction_may_state_a_goal(server: Server) -> None:
    with Wire(server.url) as visitor:
        visitor.put("Text", f"{TEXT}.")
        visitor.press("Plan it")
        visitor.told("Planned in")
        visitor.press("Correct this plan")
        visitor.told("The plan is under Correct")
        for goal, answer in (
            ("(at cup9 shelf1 on)", "unknown object"),
            ("(holding pr2 cup1)", "does not hold"),
            ("(at cup1 shelf1 on)", "Saved as shown-corner1-"),
        ):
            visitor.put("What must hold at the end", goal)
            visitor.press("Save the correction")
            visitor.told(answer)
    assert [record["goal"] for record in corpus(server)] == ["(at cup1 shelf1 on)"]


def test_what_is_saved_is_used_and_the_page_says_so(server: Server) -> None:
    text = "Polish the cup on the shelf."
    with Wire(server.url) as visitor:
        visitor.put("Text", text)
        visitor.press("Plan it")
        visitor.told("No plan")
        begin(visitor, text)
        for name, instruction in zip(OBJECTS, STEPS, strict=True):
            do(visitor, name, instruction)
        visitor.press("Save (K)")
        visitor.told("Saved as shown-corner1-01. The same sentence now gives what you showed.")
        visitor.shows("Learning from what was saved")
        visitor.told(f"&#34;{text}&#34;: The same sentence now gives what you showed.")
        teacher, files = server.studio.teacher, server.studio.corpus
        assert not teacher.learning
        world = files.world("corner2")
        here = teacher.ground(text, world, top=3)
        there = DomainKit(Corpus(files.folder, files.directory)).ground(text, world, top=3)
        assert [(p.energy, p.instructions) for p in here.plans] == [(p.energy, p.instructions) for p in there.plans]


def test_nothing_is_thrown_away_without_asking(server: Server) -> None:
    with Wire(server.url) as visitor:
        begin(visitor, f"{TEXT}.")
        do(visitor, "cup1", STEPS[0])
        visitor.press("Start over")
        visitor.shows("was shown with 1 step in corner1 and is not saved")
        visitor.press("Cancel")
        do(visitor, "cup1", STEPS[1])
        visitor.press("Start over")
        visitor.press("Throw it away, and begin")
        visitor.shows("No steps.")


def test_a_window_that_is_loaded_again_looks_at_the_same(server: Server) -> None:
    with Wire(server.url) as visitor:
        visitor.put("Environment", "corner2")
        visitor.until(lambda: {"link": "?environment=corner2"} in visitor.told_page)
        visitor.put("Text", "Put the cup on the first table.")
        visitor.press("Plan it")
        visitor.told("Planned in")
        visitor.happens(step=2, list="say")
        visitor.shows("2 / ")
        visitor.happens(tab="Object")
        visitor.until(lambda: any("tab=Object" in told.get("link", "") for told in visitor.told_page))
        link = visitor.told_page[-1]["link"]
        identity = visitor.identity
    assert link == "?environment=corner2&say=Put+the+cup+on+the+first+table.&step=2&tab=Object"
    with Wire(server.url, identity, link) as again:
        again.told("Planned in")
        again.shows("2 / ")
        assert again.elements[again.find("Environment")]["value"] == "corner2"
        again.until(lambda: {"tab": "Object"} in again.told_page)
    for odd, answer in (
        ("?environment=../x&plan=7&tab=<b>&say=" + "x" * 30_000, "No plan"),
        ("?%00", "Welcome"),
        ("?plan=9999999999&say=Take+the+cup.", "Welcome"),
    ):
        with Wire(server.url, None, odd) as visitor:
            visitor.told(answer)
            begin(visitor, "Take the cup.")


def test_what_was_asked_for_since_is_not_overwritten(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    teacher, go_on = server.studio.teacher, Event()
    ground = teacher.ground

    def late(
        text: str, world: World, top: int = 1, *, reader: Reader | None = None, ask: Ask | None = None
    ) -> Grounded:
        if text == f"{TEXT}.":
            assert go_on.wait(20)
        return ground(text, world, top, reader=reader, ask=ask)

    monkeypatch.setattr(teacher, "ground", late)
    with Wire(server.url, None, f"?say={TEXT.replace(' ', '+')}.&step=2") as visitor:
        visitor.told("Planning …")
        visitor.put("Text", "Take the cup.")
        visitor.press("Plan it")
        visitor.told("Planned in")
        go_on.set()
        visitor.happens(step=1, list="say")
        visitor.shows("1 / 2 ")


def test_what_was_not_saved_is_there_again_after_a_reload(server: Server) -> None:
    with Wire(server.url) as visitor:
        begin(visitor, f"{TEXT}.")
        do(visitor, "cup1", STEPS[0])
        identity = visitor.identity
    with Wire(server.url, identity, "?tab=Demonstrate") as again:
        again.told("Here is what was not saved: 1 steps")
        again.shows(f"▸ {SAID[STEPS[0]]}")


def test_a_correction_that_is_not_saved_is_there_again(server: Server) -> None:
    with Wire(server.url) as visitor:
        visitor.put("Text", f"{TEXT}.")
        visitor.press("Plan it")
        visitor.told("Planned in")
        visitor.press("Correct this plan")
        visitor.told("The plan is under Correct")
        visitor.press("Later")
        visitor.shows("Step 1 does not apply.")
        visitor.put("What must hold at the end", "(at cup1 shelf1 on)")
        visitor.put("Environment", "corner2")  # it stays, and can be gone on with
        visitor.until(lambda: visitor.elements[visitor.find("Go on with the correction")]["visible"])
        identity = visitor.identity
    with Wire(server.url, identity, f"?environment=corner1&say={TEXT}.&tab=Correct".replace(" ", "+")) as again:

        def gone(label: str) -> bool:
            return not any(each.get("label") == label for each in again.elements.values())

        again.told("Here is the correction that is not saved.")
        again.shows("Step 1 does not apply.")
        goal = again.find("What must hold at the end")
        again.until(lambda: again.elements[goal]["value"] == "(at cup1 shelf1 on)")
        again.shows("reaches its goals")  # the plan that is made meanwhile takes nothing away
        again.press("Correct this plan")
        again.shows("in corner1 is not saved.")
        again.find("Throw it away")
        again.press("Cancel")
        again.until(lambda: gone("Cancel"))
        again.press("Later")
        again.shows("Every step applies.")
        again.press("Save the correction")
        again.told("Saved as shown-corner1-01")
        begin(again, "Take the cup.")
        do(again, "cup1", STEPS[0])
    directory = server.studio.drafts.directory
    assert not [*directory.glob("*.correction.json")]
    (draft,) = directory.glob("*.json")
    for file in (draft, draft.with_suffix(".correction.json")):
        file.write_text('{"draft": 1}')
    with Wire(server.url, identity) as third:
        third.told("is damaged")
        begin(third, "Take the cup.")
    assert len([*directory.glob("*.damaged-*")]) == 2


def test_a_plan_is_edited_by_clicks(server: Server) -> None:
    with Wire(server.url) as visitor:
        visitor.put("Text", f"{TEXT}.")
        visitor.press("Plan it")
        visitor.told("Planned in")
        visitor.press("Correct this plan")
        visitor.told("The plan is under Correct")
        visitor.happens(step=3, list="correct")
        visitor.shows(f"▸ {SAID[STEPS[2]]}")
        visitor.shows("3 / 4 ")
        visitor.happens(step=1, list="correct")
        visitor.shows(f"▸ {SAID[STEPS[0]]}")
        visitor.press("Later")
        visitor.shows("Step 1 does not apply.")
        visitor.press("Earlier")
        visitor.shows("Every step applies.")
        for event in (
            {"step": 99, "list": "correct"},
            {"step": True, "list": 5},
            {"dark": "yes"},
        ):
            visitor.happens(**event)
        visitor.put(EVENT, "[" * 9_000)
        visitor.happens(step=1, list="correct")
        visitor.shows(f"▸ {SAID[STEPS[0]]}")


def test_what_is_not_possible_yet_is_done_with_what_it_needs(server: Server) -> None:
    with Wire(server.url) as visitor:
        begin(visitor, f"{TEXT}.")
        visitor.put("With", "cup1")
        wanted = "Put cup1 on shelf1"
        visitor.until(lambda: wanted in visitor.elements[visitor.find("More")]["options"])
        visitor.put("More", wanted)
        visitor.press("Do that, and first what it needs")
        visitor.told("Done, with 3 steps before it.")
        visitor.press("Save (K)")
        visitor.told("Saved as shown-corner1-01")
    (record,) = corpus(server)
    segments = record["segments"]
    assert isinstance(segments, list)
    done = [instruction for segment in segments for instruction in segment["instructions"]]
    assert len(done) == len(STEPS) and done[-1] == STEPS[-1]


def plan_it(visitor: Wire, text: str) -> None:
    visitor.put("Text", text)
    visitor.press("Plan it")
    visitor.told("Planned in")


def value(visitor: Wire, label: str, key: str = "value") -> object:
    return visitor.elements[visitor.find(label)][key]


def test_a_correction_is_what_its_text_gives_at_once(server: Server) -> None:
    with Wire(server.url) as visitor:
        plan_it(visitor, f"{TEXT}.")
        visitor.press("Correct this plan")
        visitor.told("The plan is under Correct")
        assert value(visitor, "Let the planner put in what is missing", "disabled")
        visitor.put("Insert with", "book1")
        visitor.until(lambda: len(value(visitor, "Instruction", "options")) > 1)  # type: ignore[arg-type]
        visitor.put("Instruction", "Go and stand before book1")
        visitor.until(lambda: not value(visitor, "Insert behind this step", "disabled"))
        visitor.press("Insert behind this step")
        visitor.shows("▸ Go and stand before book1")
        visitor.until(lambda: value(visitor, "Let the planner put in what is missing", "disabled") is False)
        visitor.press("Let the planner put in what is missing")
        visitor.shows("Every step applies.")
        visitor.press("Save the correction")
        visitor.told("This sentence now gives it here, as it was corrected.")
        assert "as it was corrected" in str(value(visitor, "Plan"))
    with Wire(server.url) as another:  # somebody else, and another environment
        plan_it(another, f"{TEXT}.")
        another.shows("Go and stand before book1")
        another.put("Environment", "corner2")
        another.told("This is corner2.")
        plan_it(another, f"{TEXT}.")
        assert "as it was corrected" not in str(value(another, "Plan"))


def test_files_that_change_meanwhile_are_told_of(server: Server) -> None:
    with Wire(server.url) as visitor:
        begin(visitor, f"{TEXT}.")
        do(visitor, "cup1", STEPS[0])
        file = server.studio.corpus.directory / "environments" / "corner1.yaml"
        file.write_text(file.read_text() + "\n# changed\n")
        visitor.told("Files of the domain have changed on disk: start tmd studio again to use them.")
        do(visitor, "cup1", STEPS[1])


def test_the_robot_is_followed_and_its_run_can_be_looked_back_on(
    kitchen: Corpus, learned: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Under physics: the player, the ticks and the message are those of the run, during it and after it."""
    monkeypatch.setenv("TMD_STUDIO_STATE", str(tmp_path / "drafts"))
    served = Server(Studio(kitchen, Teacher(kitchen, learned), "kitchen1"), "127.0.0.1", 0)

    def ticks(visitor: Wire) -> str:
        return next(str(each["label"]) for each in visitor.elements.values() if str(each.get("label"))[:6] == "Goals:")

    try:
        with Wire(served.url) as visitor:
            plan_it(visitor, "Take the bowl.")
            assert value(visitor, "Stop", "disabled") and ticks(visitor) == "Goals: 0 of 1 hold now"
            visitor.press("Let the robot do it")
            visitor.told("The robot, step 2 of 3: Go and stand before bowl1")
            visitor.shows("▸ Go and stand before bowl1")
            assert value(visitor, "Let the robot do it", "disabled") and not value(visitor, "Stop", "disabled")
            visitor.shows("… the robot is at work")
            visitor.told("run ended: done.")
            visitor.shows("✓ the robot reached the goals")
            visitor.until(lambda: ticks(visitor) == "Goals: 1 of 1 hold now")
            visitor.shows("3 / 3 Take bowl1 into a free hand")
            assert (value(visitor, "Plan"), value(visitor, "Step")) == ("the robot's run", 3)
            last = float(str(value(visitor, "Second of run")))
            assert last > 1 and value(visitor, "Stop", "disabled")
            visitor.put("Second of run", last / 2)
            visitor.until(lambda: ticks(visitor) == "Goals: 0 of 1 hold now")
            visitor.shows("2 / 3 Go and stand before bowl1")
            assert "run ended: done." in visitor.said()
            visitor.put("Step", 3)
            visitor.until(lambda: value(visitor, "Second of run") == last)
            identity = visitor.identity
        with Wire(served.url, identity, "?environment=kitchen1&say=Take+the+bowl.") as again:  # the page is loaded anew
            again.told("run ended: done. It is under Plan, to look back.")
            again.put("Plan", "the robot's run")
            again.until(lambda: float(str(value(again, "Second of run", "max"))) >= last)
            again.press("Let the robot do it")
            again.told("The robot, step")
            again.put("Environment", "kitchen2")
            again.told("This is kitchen2.")
            identity = again.identity
        assert served.studio.runs[str(identity).split(",")[0]].ended.is_set()
    finally:
        served.close()


def test_what_has_no_places_is_a_graph(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMD_STUDIO_STATE", str(tmp_path / "drafts"))
    root = Path(__file__).parents[2]
    shutil.copytree(root / "problems" / "01_blocks", tmp_path / "blocks")
    names = [f"b{number}" for number in range(2_000)]
    facts = " ".join(f"(clear {name}) (on_table {name})" for name in names)
    head = f"(define (problem huge) (:domain blocks) (:objects {' '.join(names)} - block)"
    huge = f"{head} (:init (hand_empty) {facts}) (:goal (and)))"
    (tmp_path / "blocks" / "environments" / "zz_huge.pddl").write_text(huge)
    blocks = Corpus(DomainFolder(root / "domains" / "01_blocks"), tmp_path / "blocks")
    served = Server(Studio(blocks, Teacher(blocks)), "127.0.0.1", 0)
    try:
        with Wire(served.url) as visitor:
            visitor.shows('class="tmd-state"')
            plan_it(visitor, "Put the red block on the green block.")
            visitor.put("Step", 2)
            visitor.shows('class="edge came"')
            visitor.happens(object="red_block")
            visitor.shows("marked")
            visitor.shows("red_block: block</h4>")
            assert not value(visitor, "Let the robot do it", "visible")
            visitor.put("Environment", "zz_huge")
            visitor.told("grounding needs more than 500,000 combinations of objects")
            visitor.until(lambda: value(visitor, "Environment") == "yard1")
            visitor.shows("red_block: block</h4>")
    finally:
        served.close()


def test_a_domain_that_is_broken_meanwhile_is_told_of_and_used_as_it_was(
    table: Corpus, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also a file of demonstrations that somebody has written half of."""
    monkeypatch.setenv("TMD_STUDIO_STATE", str(tmp_path / "drafts"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    domain = tmp_path / "02_table"
    shutil.copytree(table.folder.path, domain)
    corpus = Corpus(DomainFolder(domain), table.directory)
    served = Server(Studio(corpus, Teacher(corpus), "corner1"), "127.0.0.1", 0)
    try:
        with Wire(served.url) as visitor:
            begin(visitor, f"{TEXT}.")
            do(visitor, "cup1", STEPS[0])
            (domain / "objects.yaml").write_text("classes: [")
            visitor.told("Files of the domain have changed on disk")
            plan_it(visitor, f"{TEXT}.")
            assert served.studio.teacher.wait(60)
            file = table.directory / "shown" / "demonstrations.jsonl"
            file.parent.mkdir()
            file.write_text('{"id": "shown-cor')
            visitor.put("Text", f"{TEXT}.")
            visitor.press("Plan it")
            visitor.told("Not done: ")
            assert "demonstrations.jsonl:1" in visitor.said()
            served.studio.teacher.retrain()
            visitor.told("Learning failed: ")
            file.unlink()
            plan_it(visitor, f"{TEXT}.")
            do(visitor, "cup1", STEPS[1])
            visitor.press("Save (K)")
            visitor.told("Saved as shown-corner1-01")
    finally:
        served.close()


def test_a_window_that_is_closed_at_once_leaves_nothing_behind(server: Server) -> None:
    for _ in range(5):
        with Wire(server.url):
            pass
    with Wire(server.url) as visitor:
        begin(visitor, f"{TEXT}.")
        due, drafts = time.monotonic() + 30, server.studio.drafts.directory
        while len(held := list(drafts.glob("*.lock"))) > 1 and time.monotonic() < due:
            time.sleep(0.1)
        assert len(held) == 1


def test_what_the_robot_tried_in_vain_is_shown(
    kitchen: Corpus, learned: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The mug stands on the second of two tables, at its far end."""
    monkeypatch.setenv("TMD_STUDIO_STATE", str(tmp_path / "drafts"))
    file = tmp_path / "far.yaml"
    file.write_text(
        "name: far\ndomain: kitchen\nobjects:\n"
        "  table1: {class: table, position: [2.5, 0, 0]}\n  table2: {class: table, position: [3.3, 0, 0]}\n"
        "  mug1: {class: mug, at: on table2, position: [3.55, 0.0, 0.74]}\n"
    )
    served = Server(Studio(kitchen, Teacher(kitchen, learned), file), "127.0.0.1", 0)
    try:
        with Wire(served.url) as visitor:
            plan_it(visitor, "Take the mug.")
            visitor.press("Let the robot do it")
            visitor.told("Not done: the robot stopped: after grasp(mug1) failed")
            visitor.shows("✗ the robot did not reach all goals")
            visitor.shows("✗ stance: no place to stand reaches mug1")
            visitor.shows("Rejected ways: ")
            visitor.shows("data:image/jpeg;base64,")
    finally:
        served.close()


def test_a_plain_problem_file_is_an_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its domain is beside it, and has neither words nor demonstrations."""
    monkeypatch.setenv("TMD_STUDIO_STATE", str(tmp_path / "drafts"))
    for name in ("domain", "p01"):
        shutil.copy(Path(__file__).parents[1] / "pddl" / "cases" / "blocks" / f"{name}.pddl", tmp_path)
    file = tmp_path / "p01.pddl"
    corpus = Roots(None, None).corpus_of(file)
    studio = Studio(corpus, Teacher(corpus), file)
    assert studio.environments() == [studio.start]
    assert studio.setting(studio.start).look is None
    assert studio.setting(studio.start).name == studio.start
