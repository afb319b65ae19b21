"""``tmd new``: what it writes works at once, under any name, and nothing is ever overwritten."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.cli.conftest import ROOT, Tmd
from tmd.diagnostics import ExitCode, TmdError
from tmd.knowledge import study
from tmd.language.lexicon.file import read_lexicon
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder
from tmd.world.scaffold import STARTS, scaffold
from tmd.world.sentence_file import read_sentences

SAID = {"plain": "Put the red block on the green block.", "graph": "Put the key on the table."}


@pytest.mark.parametrize("start", STARTS)
def test_what_it_prints_to_try_next_works(start: str, tmd: Tmd, tmp_path: Path) -> None:
    made = tmd("new", "mine", "--from", start)
    assert made.code == ExitCode.OK
    steps = made.out.partition("try next:\n")[2].splitlines()
    assert len(steps) >= 5
    for step in steps:
        command, quote, text = step.partition('"')
        words = [*command.split()[1:], *([text.rstrip('"')] if quote else [])]
        done = tmd(*words, env={"TMD_LEARNED": ""})  # beside the demonstrations, where nobody says anything else
        assert done.code == ExitCode.OK, (step, done.err)
        if words[0] == "ground":
            assert text.rstrip('"') == SAID[start]
            assert "valid" in done.out
    assert (tmp_path / "problems" / "mine" / "learned" / "library.json").is_file()


@pytest.mark.parametrize("start", STARTS)
def test_its_lexicon_declares_goals_and_says_how(start: str, tmd: Tmd, tmp_path: Path) -> None:
    assert tmd("new", "mine", "--from", start).code == ExitCode.OK
    file = tmp_path / "domains" / "mine" / "lexicon.yaml"
    lexicon = read_lexicon(file)
    assert len(lexicon.goals) >= 2
    assert {"put", "take"} <= lexicon.goal_verbs
    assert [Path(base).stem for base in lexicon.included] == ["household"]
    comment = file.read_text().partition("\ngoals:\n")[0].rpartition("\n\n")[2]
    assert all(line.startswith("#") for line in comment.splitlines())
    assert all(word in comment for word in ("PDDL", "slots", "prepositions", "`tmd check`"))
    told = json.loads(tmd("check", "domains/mine", "problems/mine", "--json").out)
    assert told["diagnostics"] == []


@pytest.mark.parametrize("start", STARTS)
def test_its_sentence_tests_are_of_the_new_domain(start: str, tmp_path: Path) -> None:
    made = scaffold("mine", start, tmp_path / "domains", tmp_path / "problems")
    (file,) = made.problems.glob("*.sentences.jsonl")
    tests = read_sentences(file)
    assert {(test.domain, test.environment) for test in tests} == {("mine", made.environments[-1])}
    assert [test.goal is None for test in tests] == [False, False, True]


def test_it_lists_what_it_wrote(tmd: Tmd, tmp_path: Path) -> None:
    made = tmd("new", "mine").out.partition("\n\n")[0].splitlines()
    written = [path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if path.is_file()]
    assert sorted(made) == sorted(written)


@pytest.mark.parametrize("there", ["domains/mine", "problems/mine"])
def test_nothing_is_overwritten(there: str, tmd: Tmd, tmp_path: Path) -> None:
    kept = tmp_path / there / "kept.txt"
    kept.parent.mkdir(parents=True)
    kept.write_text("mine")
    done = tmd("new", "mine")
    assert done.code == ExitCode.CANNOT_WRITE
    assert len(done.err.splitlines()) == 2
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == [kept]


@pytest.mark.parametrize("name", ["", "Mine", "1st", "../mine", "a/b", "mine ", "größe", "a-b", "."])
def test_a_bad_name_gets_one_line(name: str, tmp_path: Path) -> None:
    with pytest.raises(TmdError, match="cannot name a domain"):
        scaffold(name, "plain", tmp_path / "domains", tmp_path / "problems")
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_start_gets_one_line(tmd: Tmd) -> None:
    done = tmd("new", "mine", "--from", "plane")
    assert done.code == ExitCode.BAD_INPUT
    assert "'plane'" in done.err


PARCELS = """(define (domain parcels) (:requirements :strips :typing) (:types truck parcel place)
  (:predicates (at ?x - (either truck parcel) ?p - place) (in ?x - parcel ?t - truck))
  (:action load :parameters (?x - parcel ?t - truck ?p - place)
    :precondition (and (at ?x ?p) (at ?t ?p)) :effect (and (in ?x ?t) (not (at ?x ?p))))
  (:action drive :parameters (?t - truck ?from ?to - place)
    :precondition (at ?t ?from) :effect (and (at ?t ?to) (not (at ?t ?from)))))
"""


def test_a_pddl_file_gives_its_lexicon(tmd: Tmd, tmp_path: Path) -> None:
    (tmp_path / "parcels.pddl").write_text(PARCELS)
    made = tmd("new", "post", "--from", "parcels.pddl")
    assert made.code == ExitCode.OK, made.err
    folder = tmp_path / "domains" / "post"
    assert (folder / "domain.pddl").read_text() == PARCELS
    lexicon = read_lexicon(folder / "lexicon.yaml")
    assert {"load", "drive"} <= lexicon.goal_verbs
    assert json.loads(tmd("check", "domains/post", "--json").out)["diagnostics"] == []
    (tmp_path / "post1.pddl").write_text(
        "(define (problem post1) (:domain parcels) (:objects van - truck box - parcel depot school - place)"
        " (:init (at van depot) (at box school)) (:goal (and)))"
    )
    done = tmd("ground", "--domain", "post", "--environment", "post1.pddl", "--text", "Load the box into the van.")
    assert done.code == ExitCode.OK and "(in box van)" in done.out, done.err


def test_an_empty_one_has_a_frame_that_checks(tmd: Tmd, tmp_path: Path) -> None:
    assert tmd("new", "shop", "--empty").code == ExitCode.OK
    assert sorted(path.name for path in (tmp_path / "domains" / "shop").iterdir()) == [
        "README.md",
        "domain.pddl",
        "lexicon.yaml",
    ]
    assert json.loads(tmd("check", "domains/shop", "--json").out)["diagnostics"] == []
    assert tmd("new", "other", "--empty", "--from", "plain").code == ExitCode.USAGE


@pytest.mark.parametrize("options", [(), ("--empty",)])
def test_a_bundled_domain_is_not_hidden(options: tuple[str, ...], tmd: Tmd, tmp_path: Path) -> None:
    done = tmd("new", "kitchen", *options)
    assert done.code == ExitCode.BAD_INPUT
    assert done.err.startswith("error: there is a domain 'kitchen' already: ")
    assert list(tmp_path.iterdir()) == []


def test_an_empty_folder_is_not_ok(tmd: Tmd, tmp_path: Path) -> None:
    (tmp_path / "nothing").mkdir()
    done = tmd("check", "nothing")
    assert (done.code, done.out) == (ExitCode.BAD_INPUT, "")
    assert done.err.startswith("error: there is nothing to check in nothing")


@settings(max_examples=6, deadline=None)
@given(name=st.from_regex(r"[a-z][a-z0-9_]{0,12}", fullmatch=True), start=st.sampled_from(sorted(STARTS)))
def test_any_name_makes_a_domain_that_teaches_what_its_model_does(
    name: str, start: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    root = tmp_path_factory.mktemp("any")
    made = scaffold(name, start, root / "domains", root / "problems")
    corpus = Corpus(DomainFolder(made.folder), made.problems)
    assert all(place.startswith(name) for place in corpus.environments())
    own = study(corpus).library
    source = study(Corpus(DomainFolder(ROOT / "domains" / STARTS[start]), ROOT / "problems" / STARTS[start])).library
    assert own.verbs() == source.verbs()
    assert [t.instructions for v in own.verbs() for t in own.templates(v)] == [
        t.instructions for v in source.verbs() for t in source.templates(v)
    ]
