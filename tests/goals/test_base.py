"""Base lexicons: what a domain that includes one gets, what it replaces, and what does not apply."""

from __future__ import annotations

from pathlib import Path

import pytest

import tmd
from tmd.check.checker import Checker
from tmd.check.diagnostic import Severity
from tmd.diagnostics import TmdError
from tmd.files import bundled
from tmd.goals.sources.table import GoalTable
from tmd.goals.tables import LeftOut, declared_goals, left_out
from tmd.knowledge import digest
from tmd.language.lexicon.file import bases_near, read_lexicon
from tmd.pddl.reading.reader import read_domain
from tmd.pddl.writer import format_formula
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder, find_domain
from tmd.world.sentence_file import SentenceTest

ROOT = Path(__file__).resolve().parents[2]
GARDEN = """\
(define (domain garden)
  (:requirements :strips :typing :negative-preconditions)
  (:types person thing - object  tool crate - thing)
  (:constants me - person)
  (:predicates
    (inside ?x - tool ?y - crate) (gripped ?p - person ?x - tool) (lifted ?x - tool)
    (closed ?y - crate) (wet ?x - tool))
  (:action pick
    :parameters (?x - tool ?y - crate)
    :precondition (and (inside ?x ?y) (not (closed ?y)))
    :effect (and (not (inside ?x ?y)) (gripped me ?x) (lifted ?x)))
  (:action stow
    :parameters (?x - tool ?y - crate)
    :precondition (and (gripped me ?x) (not (closed ?y)))
    :effect (and (inside ?x ?y) (not (gripped me ?x)) (not (lifted ?x))))
  (:action lid
    :parameters (?y - crate)
    :precondition (not (closed ?y))
    :effect (closed ?y))
  (:action unlid
    :parameters (?y - crate)
    :precondition (closed ?y)
    :effect (not (closed ?y))))
"""
YARD = """\
(define (problem plot1)
  (:domain garden)
  (:objects spade1 rake1 - tool crate1 crate2 - crate)
  (:init (inside spade1 crate1) (inside rake1 crate2) (closed crate2))
  (:goal (and)))
"""
BASE = """\
predicates:
  located ?x ?y ?rel: (at ?x ?y ?rel)
  located ?x ?y in: (in ?x ?y) | (inside ?x ?y)
  located ?x ?y on: (on ?x ?y)
  held ?x: (holding ?x) | (exists (?r - agent) (gripped ?r ?x))
  opened ?x: (opened ?x) | (not (closed ?x))
types:
  agent: [robot, person]
verb_synonyms:
  nab: take
goals:
  - place|put X in|on Y: (located ?x ?y ?rel)
  - take|grip X: (held ?x)
  - open X: (opened ?x)
  - close X: (not (opened ?x))
attributes:
  shut: (not (opened ?x))
"""


def world(tmp_path: Path, lexicon: str, **bases: str) -> DomainFolder:
    """A garden with a lexicon, beside base lexicons."""
    for name, text in bases.items():
        file = tmp_path / "domains" / "base" / f"{name}.yaml"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    folder = tmp_path / "domains" / "garden"
    folder.mkdir(parents=True)
    (folder / "domain.pddl").write_text(GARDEN)
    (folder / "lexicon.yaml").write_text(lexicon)
    environments = tmp_path / "problems" / "garden" / "environments"
    environments.mkdir(parents=True)
    (environments / "plot1.pddl").write_text(YARD)
    return DomainFolder(folder)


def table(folder: DomainFolder) -> tuple[GoalTable, tuple[LeftOut, ...]]:
    lexicon = read_lexicon(folder.lexicon_path)
    return declared_goals(lexicon, folder.domain), left_out(lexicon, folder.domain)


def meaning(rows: GoalTable, verb: str) -> list[str]:
    return [" ".join(format_formula(row.condition).split()) for row in rows.of(verb)]


def told(folder: DomainFolder) -> list[tuple[str, int, int, str]]:
    checker = Checker(folder.path.parent, None, folder.path.parent.parent / "problems")
    checker.check(folder.path / "lexicon.yaml")
    found = [d for d in checker.findings.sorted() if d.severity is Severity.ERROR]
    return [(Path(d.location.file).name, d.location.line, d.location.column, d.code) for d in found]


def test_rows_speak_of_what_the_domain_has(tmp_path: Path) -> None:
    rows, unused = table(world(tmp_path, "include: [yard]\n", yard=BASE))
    assert meaning(rows, "grip") == ["(exists (?r_held - person) (gripped ?r_held ?x))"]
    assert meaning(rows, "close") == ["(not (not (closed ?x)))"]
    assert set(rows.attributes) == {"shut"}
    # there is no "on": the row applies with the other preposition only
    assert [(row.pattern, row.slots[1].prepositions) for row in rows.of("put")] == [("place|put X in Y", ("in",))]
    assert meaning(rows, "put") == ["(inside ?x ?y)"]
    assert unused == ()


def test_a_row_without_its_predicates_is_left_out_with_the_reason(tmp_path: Path) -> None:
    base = "predicates:\n  hot ?x: (hot ?x) | (warm ?x)\ngoals:\n  - heat X: (hot ?x)\nattributes:\n  hot: (hot ?x)\n"
    folder = world(tmp_path, "include: [warmth]\n", warmth=base)
    rows, unused = table(folder)
    assert rows.rows == () and rows.attributes == {}
    assert [one.entry.pattern for one in unused] == ["heat X", "hot"]
    assert unused[0].reason == "this domain has nothing for (hot ?x): (hot ?x) | (warm ?x)"
    assert told(folder) == []


def test_a_domain_says_what_it_calls_otherwise(tmp_path: Path) -> None:
    own = "include: [yard]\npredicates:\n  held ?thing: (lifted ?thing)\n"
    rows, _ = table(world(tmp_path, own, yard=BASE))
    assert meaning(rows, "take") == ["(lifted ?x)"]
    own = "include: [yard]\ntypes:\n  agent: tool\n"
    rows, unused = table(world(tmp_path / "again", own, yard=BASE))
    assert rows.of("take") == ()
    assert [one.entry.pattern for one in unused] == ["take|grip X"]


@pytest.mark.parametrize(
    ("own", "verb", "expected"),
    [
        ("- take X: (lifted ?x)", "take", ["(lifted ?x)"]),
        # for the other verbs of a shared row it still holds
        ("- take X: (lifted ?x)", "grip", ["(exists (?r_held - person) (gripped ?r_held ?x))"]),
        # other prepositions, and other kinds of things, are other patterns
        ("- put X in|on Y: (wet ?x)", "put", ["(wet ?x)", "(inside ?x ?y)"]),
        ("- put X in Y: (wet ?x)", "put", ["(wet ?x)"]),
        ("- open X: (wet ?x)", "open", ["(wet ?x)", "(not (closed ?x))"]),
        # the shared rows are tried where the list says so
        ("- included\n  - open X: (wet ?x)", "open", ["(not (closed ?x))", "(wet ?x)"]),
    ],
)
def test_own_rows_replace_shared_ones(tmp_path: Path, own: str, verb: str, expected: list[str]) -> None:
    rows, _ = table(world(tmp_path, f"include: [yard]\ngoals:\n  {own}\n", yard=BASE))
    assert meaning(rows, verb) == expected


def test_a_row_of_the_verb_that_another_one_stands_for_replaces_as_well(tmp_path: Path) -> None:
    own = "include: [yard]\nverb_synonyms:\n  grip: seize\ngoals:\n  - seize X: (lifted ?x)\n"
    rows, unused = table(world(tmp_path, own, yard=BASE))
    assert rows.of("grip") == ()
    (one,) = [one for one in unused if "grip" in one.verbs]
    assert "'seize X'" in one.reason and "lexicon.yaml:5:14" in one.reason


def test_own_synonyms_win(tmp_path: Path) -> None:
    synonyms = {
        "nab: open": {"nab": "open"},
        "take: get": {"take": "get", "nab": "get"},
        "take: nab": {"take": "nab"},
    }
    for number, (own, expected) in enumerate(synonyms.items()):
        text = f"include: [yard]\nverb_synonyms:\n  {own}\n"
        folder = world(tmp_path / str(number), text, yard=BASE)
        assert read_lexicon(folder.lexicon_path).verb_synonyms == expected


def test_bases_include_bases(tmp_path: Path) -> None:
    nearer = "include: [yard]\npredicates:\n  held ?x: (lifted ?x)\ngoals:\n  - open X: (opened ?x)\n"
    folder = world(tmp_path, "include: [nearer]\n", yard=BASE, nearer=nearer)
    rows, _ = table(folder)
    assert meaning(rows, "take") == ["(lifted ?x)"]
    assert len(rows.of("open")) == 1
    included = read_lexicon(folder.lexicon_path).included
    assert [Path(file).stem for file in included] == ["nearer", "yard"]


@pytest.mark.parametrize(
    ("lexicon", "bases", "expected"),
    [
        ("include: [yrad]\n", {}, [("lexicon.yaml", 1, 11, "unknown-base")]),
        ("include: [yard]\n", {"yard": "include: [yard]\n"}, [("yard.yaml", 1, 11, "include-cycle")]),
        (
            "include: [one]\n",
            {"one": "include: [two]\n", "two": "include: [one]\n"},
            [("two.yaml", 1, 11, "include-cycle")],
        ),
        ("include: yard\n", {}, [("lexicon.yaml", 1, 10, "syntax")]),
        ("include: [yard]\n", {"yard": "gaols: []\n"}, [("yard.yaml", 1, 1, "syntax")]),
        (
            "include: [yard]\n",
            {"yard": "predicates:\n  held ?x: (held ?x)\ngoals:\n  - take X: (heldd ?x)\n"},
            [("yard.yaml", 4, 13, "unknown-predicate")],
        ),
        (
            "include: [yard]\n",
            {"yard": "predicates:\n  held ?x: (held ?x)\ngoals:\n  - take X: (and (held ?y) (held ?x ?x))\n"},
            [("yard.yaml", 4, 18, "free-variable"), ("yard.yaml", 4, 28, "wrong-arity")],
        ),
        (
            "include: [yard]\n",
            {"yard": "predicates:\n  held ?x: (held ?x)\ngoals:\n  - take X inn Y: (held ?x)\n"},
            [("yard.yaml", 4, 19, "bad-goal")],
        ),
        (
            "include: [yard]\n",
            {"yard": "predicates:\n  held ?x: (held ?x\n"},
            [("yard.yaml", 2, 12, "unclosed-parenthesis")],
        ),
        ("include: [yard]\n", {"yard": "predicates:\n  Held: (held ?x)\n"}, [("yard.yaml", 2, 3, "syntax")]),
        (
            "include: [yard]\npredicates:\n  hold ?x: (lifted ?x)\n",
            {},
            [("lexicon.yaml", 3, 3, "unknown-predicate")],
        ),
        ("include: [yard]\npredicates:\n  held ?x: (liftd ?x)\n", {}, [("lexicon.yaml", 3, 13, "unknown-predicate")]),
        ("include: [yard]\ntypes:\n  agent: persn\n", {}, [("lexicon.yaml", 3, 3, "unknown-type")]),
    ],
)
def test_faults_have_their_file_and_place(
    tmp_path: Path, lexicon: str, bases: dict[str, str], expected: list[tuple[str, int, int, str]]
) -> None:
    folder = world(tmp_path, lexicon, **({"yard": BASE} | bases))
    assert told(folder) == expected
    with pytest.raises(TmdError) as caught:
        table(folder)
    place = caught.value.location
    assert place is not None
    assert (Path(place.file).name, place.line, place.column) == expected[0][:3]


def test_a_name_that_is_nearly_right_is_suggested(tmp_path: Path) -> None:
    with pytest.raises(TmdError) as caught:
        read_lexicon(world(tmp_path, "include: [yrad]\n", yard=BASE).lexicon_path)
    assert (caught.value.message, caught.value.hint) == ("there is no base lexicon 'yrad'", "did you mean 'yard'?")
    with pytest.raises(TmdError) as caught:
        read_lexicon(world(tmp_path / "again", "include: [sea]\n", yard=BASE).lexicon_path)
    assert caught.value.hint == "there are: household, yard"


def test_a_base_lexicon_is_checked_by_itself(tmp_path: Path) -> None:
    folder = world(tmp_path, "", yard=BASE + "  ajar: (openedd ?x)\n")
    checker = Checker(folder.path.parent)
    checker.check(folder.path.parent / "base")
    assert [(d.code, d.hint) for d in checker.findings.sorted()] == [("unknown-predicate", 'did you mean "opened"?')]


def test_a_world_that_only_includes_the_household_is_understood(tmp_path: Path) -> None:
    folder = world(tmp_path, "include: [household]\npredicates:\n  held ?x: (lifted ?x)\n")
    kit = tmd.load_domain("garden", domains=folder.path.parent, problems=tmp_path / "problems")
    for text, goal in {
        "Take the rake.": "(lifted rake1)",
        "Put the rake in the first crate and close it.": "(and (inside rake1 crate1) (closed crate1))",
        "Move the spade to the second crate.": "(inside spade1 crate2)",
        "Hand me the spade.": "(lifted spade1)",
    }.items():
        (result,) = kit.run_sentence_tests(
            [SentenceTest(id="x", domain="garden", environment="plot1", text=text, goal=goal)]
        )
        assert result.outcome == "right", (text, result)


def test_what_was_learned_depends_on_the_base(tmp_path: Path) -> None:
    folder = world(tmp_path, "include: [yard]\n", yard=BASE)

    def made() -> str:
        return digest(Corpus(DomainFolder(folder.path), tmp_path / "problems" / "garden"))

    before = made()
    assert made() == before
    base = tmp_path / "domains" / "base" / "yard.yaml"
    base.write_text(base.read_text() + "  ajar: (opened ?x)\n")
    assert made() != before


def test_the_household_is_found_from_anywhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    found = bases_near(tmp_path / "domains" / "mine" / "lexicon.yaml")
    assert found["household"].resolve() == (bundled("domains")[0] / "base" / "household.yaml").resolve()


@pytest.mark.parametrize("name", ["01_blocks", "03_drawer", "kitchen", "living_room"])
def test_bundled_domains_share_the_household(name: str) -> None:
    folder = find_domain(name, ROOT / "domains")
    lexicon = read_lexicon(folder.lexicon_path, folder.kinds)
    assert [Path(file).stem for file in lexicon.included] == ["household"]
    assert {"take", "place"} <= set(declared_goals(lexicon, folder.domain).verbs())


def test_every_bundled_domain_is_read() -> None:
    for path in sorted((ROOT / "domains").glob("*/lexicon.yaml")):
        lexicon = read_lexicon(path)
        assert declared_goals(lexicon, read_domain(path.parent / "domain.pddl")).rows, path


def test_each_shared_row_is_used_by_the_kitchen_the_living_room_or_another_domain() -> None:
    used: set[str] = set()
    domains = [find_domain(name, ROOT / "domains") for name in ("kitchen", "living_room")]
    for folder in domains:
        rows = declared_goals(read_lexicon(folder.lexicon_path), folder.domain).rows
        used |= {str(row.location) for row in rows if row.location}
    household = read_lexicon(ROOT / "domains" / "base" / "household.yaml")
    unused = [entry.pattern for entry in household.goals if str(entry.location) not in used]
    # what only a third world has or needs: things that are lit, cleaned or wiped, and a plain bringing
    assert {pattern.partition(" ")[0].split("|")[0] for pattern in unused} <= {
        "turn_on", "turn_off", "clean", "wipe", "bring",
    }  # fmt: skip
