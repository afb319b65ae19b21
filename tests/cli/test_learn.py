"""``tmd learn``: what is kept says the same as learning again, for as long as it is true and whole."""

from __future__ import annotations

import json
import re
import shutil
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import ROOT, Ended, Tmd
from tmd.diagnostics import ExitCode
from tmd.knowledge import MANIFEST, Knowledge, place, recall, save, study
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder

SAID = (
    "ground",
    "--environment",
    "corner2",
    "--text",
    "Put the cup on the first table.",
    "--json",
)


@pytest.fixture
def table(tmp_path: Path) -> Corpus:
    """A copy of a small domain that may be changed."""
    for kind in ("domains", "problems"):
        shutil.copytree(
            ROOT / kind / "02_table", tmp_path / kind / "02_table", ignore=shutil.ignore_patterns("learned")
        )
    return Corpus(DomainFolder(tmp_path / "domains" / "02_table"), tmp_path / "problems" / "02_table")


@pytest.fixture(scope="module")
def knowledge() -> Knowledge:
    """What the domain teaches, wherever its files lie."""
    return study(Corpus(DomainFolder(ROOT / "domains" / "02_table"), ROOT / "problems" / "02_table"))


def test_what_was_kept_is_what_was_learned(table: Corpus, knowledge: Knowledge) -> None:
    directory = place(table)
    save(knowledge, table, directory)
    again = recall(table, directory)
    assert again is not None
    assert again.library.verbs() == knowledge.library.verbs()
    for verb in knowledge.library.verbs():
        assert list(again.library.templates(verb)) == list(knowledge.library.templates(verb))
        # what a clause is compared by does not tell all of it
        assert [asdict(t) for t in again.library.templates(verb)] == [
            asdict(t) for t in knowledge.library.templates(verb)
        ]
    assert again.library.unaligned == knowledge.library.unaligned
    assert again.reward is not None
    assert knowledge.reward is not None
    assert np.array_equal(again.reward.theta, knowledge.reward.theta)
    assert again.reward.features.words == knowledge.reward.features.words
    assert again.reward.features.properties == knowledge.reward.features.properties


def test_the_same_demonstrations_leave_the_same_bytes(table: Corpus, tmp_path: Path) -> None:
    for name in ("one", "two"):
        save(study(table), table, tmp_path / name)
    for path in (tmp_path / "one").iterdir():
        assert path.read_bytes() == (tmp_path / "two" / path.name).read_bytes()


@pytest.mark.parametrize(
    "changed",
    [
        "problems/02_table/set_table/demonstrations.jsonl",
        "problems/02_table/environments/corner1.yaml",
        "domains/02_table/lexicon.yaml",
        "domains/02_table/domain.pddl",
    ],
)
def test_what_was_made_from_something_else_is_not_used(
    changed: str, table: Corpus, knowledge: Knowledge, tmp_path: Path
) -> None:
    save(knowledge, table, place(table))
    assert recall(table, place(table)) is not None
    path = tmp_path / changed
    path.write_text(path.read_text() + "\n")
    assert recall(table, place(table)) is None


@pytest.mark.parametrize("file", ["library.json", "policy.json", "policy.bin", MANIFEST])
def test_what_is_damaged_is_not_used(file: str, table: Corpus, knowledge: Knowledge) -> None:
    save(knowledge, table, place(table))
    path = place(table) / file
    whole = path.read_bytes()
    for damaged in (whole[: len(whole) // 2], b"", b"\x00" + whole, b"[]"):
        path.write_bytes(damaged)
        assert recall(table, place(table)) is None
    path.unlink()
    assert recall(table, place(table)) is None


def test_ground_says_the_same_with_and_without_it(table: Corpus, tmd: Tmd) -> None:
    before = tmd(*SAID)
    done = tmd("learn", "02_table", "--out", "kept", "--no-weights")
    assert done.code == ExitCode.OK
    assert done.out.startswith("02_table: 3 demonstrations in corner1, corner2\n4 templates\n")
    assert done.out.endswith("saved in kept/02_table\n")
    after = tmd(*SAID, "--learned", "kept")
    assert before.code == ExitCode.OK
    assert (after.code, after.out) == (before.code, before.out)


def test_weights_are_learned_and_used_when_asked_for(tmd: Tmd, tmp_path: Path) -> None:
    said = ("ground", "--environment", "corner2", "--text", "Put the cup on the first table.", "--weights", "learned")
    missing = tmd(*said, "--learned", "kept")
    assert missing.code == ExitCode.BAD_INPUT
    assert "tmd learn 02_table" in missing.err
    told = tmd("learn", "02_table", "--out", "kept").out
    losses = re.search(r"^weights: .* (\d\.\d+) before, (\d\.\d+) after$", told, re.MULTILINE)
    assert losses and float(losses[2]) <= float(losses[1])
    assert (tmp_path / "kept" / "02_table" / "weights.txt").is_file()
    assert tmd(*said, "--learned", "kept").code == ExitCode.OK


def test_a_domain_without_demonstrations_gets_one_line(table: Corpus, tmd: Tmd) -> None:
    (table.directory / "set_table" / "demonstrations.jsonl").unlink()
    done = tmd("learn", "02_table")
    assert done.code == ExitCode.BAD_INPUT
    assert "there are no demonstrations of '02_table'" in done.err


def test_where_nothing_can_be_written_one_line_says_so(tmd: Tmd, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    done = tmd("learn", "02_table", "--out", "file", "--no-weights")
    assert done.code == ExitCode.CANNOT_WRITE
    assert len(done.err.splitlines()) <= 2


def test_a_goal_that_is_not_reached_teaches_nothing(table: Corpus, tmd: Tmd) -> None:
    (file,) = table.directory.glob("*/demonstrations.jsonl")
    lines = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]

    def learn(goal: str | None) -> Ended:
        said = [{**line, "goal": goal if number == 1 else "(and)"} for number, line in enumerate(lines)]
        file.write_text("".join(json.dumps(line) + "\n" for line in said), encoding="utf-8")
        return tmd("learn", "02_table", "--no-weights")

    assert learn(None).code == ExitCode.OK
    for wrong, why in (("(not (and))", "is not reached"), ("(and (", "never closed"), ("(shiny cup1)", "shiny")):
        done = learn(wrong)
        assert done.code == ExitCode.BAD_INPUT
        assert re.search(rf"demonstrations\.jsonl:2:\d+: .*the goal of '{lines[1]['id']}'", done.err)
        assert why in done.err
