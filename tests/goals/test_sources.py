"""Sources of meanings that nobody declares: the names of actions, and demonstrations."""

from __future__ import annotations

from pathlib import Path

from tests.bundled import corpus
from tests.goals.conftest import pddl
from tmd.diagnostics import Refusal, RefusalKind
from tmd.goals.reading.goal_reader import GoalReader
from tmd.goals.reading.noun_phrases import Memory
from tmd.goals.sources.actions import rows_of_actions
from tmd.goals.sources.demonstrations import learn_goals, table_from_json, table_to_json
from tmd.goals.tables import declared_goals, goal_tables
from tmd.ground import ground
from tmd.knowledge import study
from tmd.language import parse
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).resolve().parents[2]


def test_a_domain_without_a_table_has_the_rows_of_its_actions() -> None:
    table = rows_of_actions(corpus("03_drawer").folder.domain)
    assert {"open", "close"} <= set(table.verbs())
    assert {row.source for row in table.rows} == {"actions"}
    assert pddl(table.of("open")[0].condition) == "(opened ?x)"
    assert pddl(table.of("close")[0].condition) == "(not (opened ?x))"


def test_what_actions_say_is_enough_to_ground(tmp_path: Path) -> None:
    bundled = corpus("03_drawer")
    folder = tmp_path / "03_drawer"
    folder.mkdir()
    for file in (ROOT / "domains" / "03_drawer").iterdir():
        if file.is_file() and file.name != "lexicon.yaml":
            (folder / file.name).write_bytes(file.read_bytes())
    (folder / "lexicon.yaml").write_text("nouns:\n  biro: [pen]\n")
    bare = Corpus(DomainFolder(folder), bundled.directory)
    assert declared_goals(bare.lexicon, bare.folder.domain).rows == ()
    knowledge = study(bare)
    grounded = ground("Open the drawer.", bare.world("study1"), knowledge.library, reward=knowledge.reward)
    assert [(g.source, pddl(g.formula)) for g in grounded.plans[0].goals] == [("actions", "(opened desk1_drawer)")]
    assert grounded.verdicts[0].valid


def test_only_the_sources_that_are_asked_answer() -> None:
    bundled = corpus("03_drawer")
    world = bundled.world("study1")
    clause = parse("Pull out the desk.", bundled.lexicon).clauses[0]
    for sources, known in ((("declared",), True), (("actions",), False)):
        tables = goal_tables(bundled.lexicon, world.task.problem.domain, sources=sources)
        reader = GoalReader(world, tables, bundled.lexicon)
        answer = reader.read(clause, world.task.init, Memory(first=world.task.init))
        assert isinstance(answer, Refusal) != known
        assert known or not isinstance(answer, Refusal) or answer.kind is RefusalKind.IMPOSSIBLE


def test_demonstrations_teach_what_verbs_bring_about() -> None:
    rooms = corpus("living_room")
    table = learn_goals(rooms.demonstrations(), rooms.world, rooms.lexicon)
    assert {row.source for row in table.rows} == {"learned"}
    said = {verb: [pddl(row.condition) for row in table.of(verb)] for verb in ("open", "close", "turn_on")}
    assert "(opened ?x)" in said["open"]
    assert "(not (opened ?x))" in said["close"]
    assert "(active ?x)" in said["turn_on"]
    for row in table.rows:
        assert row.evidence
        assert 0.7 <= row.probability <= 1
    again = table_from_json(table_to_json(table), rooms.folder.domain)
    assert table_to_json(again) == table_to_json(table)
    assert [(r.verbs, r.slots, r.condition, r.noun, r.result) for r in again.rows] == [
        (r.verbs, r.slots, r.condition, r.noun, r.result) for r in table.rows
    ]
    assert learn_goals([], rooms.world, rooms.lexicon).rows == ()
