"""Object graphs to PDDL: every domain folder and every environment, and what each kind of mistake says."""

from __future__ import annotations

from pathlib import Path

import pytest

from tmd.diagnostics import TmdError
from tmd.pddl.model import GroundAtom, Instruction, Problem
from tmd.pddl.reading.reader import parse_problem
from tmd.pddl.semantics import first_broken
from tmd.pddl.writer import format_problem
from tmd.world.compile import compile_domain, compile_problem
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder, find_domain

ROOT = Path(__file__).parents[2]
COMPILED = sorted(p.parent for p in ROOT.glob("domains/*/objects.yaml"))
ENVIRONMENTS = sorted(ROOT.glob("problems/*/environments/*.yaml"))
KITCHEN = DomainFolder(ROOT / "domains" / "kitchen")


def compiled(path: Path) -> Problem:
    return compile_problem(load_environment(path), DomainFolder(ROOT / "domains" / path.parent.parent.name))


def atom(text: str) -> GroundAtom:
    predicate, *args = text.split()
    return GroundAtom(predicate, tuple(args))


@pytest.mark.parametrize("folder", COMPILED, ids=lambda p: p.name)
def test_the_committed_domain_is_what_its_sources_compile_to(folder: Path) -> None:
    assert (folder / "domain.pddl").read_text() == compile_domain(DomainFolder(folder))


@pytest.mark.parametrize("path", ENVIRONMENTS, ids=lambda p: p.stem)
def test_every_environment_compiles_and_survives_being_written_as_pddl(path: Path) -> None:
    problem = compiled(path)
    again = parse_problem(format_problem(problem), problem.domain)
    assert again.init == problem.init
    assert again.objects == problem.objects


@pytest.mark.parametrize("path", ENVIRONMENTS, ids=lambda p: p.stem)
def test_every_item_has_exactly_one_place(path: Path) -> None:
    environment = load_environment(path)
    problem = compiled(path)
    for name, entry in environment.objects.items():
        places = [a for a in problem.init if a.predicate == "at" and a.args[0] == name]
        assert len(places) == (entry.at is not None), name


def test_a_part_is_an_object_and_an_edge_a_fact() -> None:
    problem = compiled(ROOT / "problems/kitchen/environments/kitchen1.yaml")
    types = {o.name: o.types for o in problem.objects}
    assert types["stove1_knob3"] == ("knob",)
    assert atom("controls stove1_knob3 stove1_burner3") in problem.init
    assert atom("controls stove1_knob3 stove1_burner1") not in problem.init
    assert atom("part_of microwave1_door microwave1") in problem.init
    assert atom("set_to stove1_knob1 off") in problem.init


def test_what_is_behind_a_closed_door_is_hidden_and_what_is_behind_an_open_one_is_not() -> None:
    shut = compiled(ROOT / "problems/kitchen/environments/kitchen2.yaml").init
    opened = compiled(ROOT / "problems/kitchen/environments/kitchen4.yaml").init
    assert {atom("shut cupboard1"), atom("hidden ramen1")} <= shut
    assert atom("hidden pot1") not in shut
    assert atom("opened cupboard1_door") in opened
    assert not {atom("shut cupboard1"), atom("hidden cup1")} & opened


def test_contents_make_a_vessel_filled_and_stated_states_win_over_the_class() -> None:
    init = compiled(ROOT / "problems/kitchen/environments/kitchen5.yaml").init
    assert {atom("contains pot1 coffee"), atom("filled pot1"), atom("filled cup1")} <= init
    assert atom("filled cup2") not in init


GOOD = """\
name: here
domain: kitchen
objects:
  counter1: {class: counter}
  microwave1: {class: microwave}
  mug1: {class: mug, at: on counter1}
"""


MISTAKES = [
    ("class: mug,", "class: mugg,", "6:10", "class 'mugg'", "mug"),
    ("class: mug,", "clas: mug,", "6:10", "clas", None),
    ("on counter1", "on counter2", "6:22", "no 'counter2'", "counter1"),
    ("on counter1", "counter1", "6:22", "no place", "RELATION OBJECT"),
    ("on counter1", "beneath counter1", "6:22", "no 'beneath'", None),
    (
        "{class: microwave}",
        "{class: microwave, parts: {dor: {opened: true}}}",
        "5:42",
        "no part 'dor'",
        "door",
    ),
    (
        "{class: microwave}",
        "{class: microwave, parts: {door: {open: true}}}",
        "5:49",
        "no state 'open'",
        "opened",
    ),
    ("{class: mug, at", "{class: mug, states: {contains: [vine]}, at", "6:31", "no 'vine'", None),
    ("domain: kitchen", "domain: garden", "2:1", "is of domain 'garden'", None),
    ("mug1:", "Mug1:", "6:3", "cannot name an object", "lower-case"),
    ("mug1:", "counter1:", "6:3", "twice", None),
    ("  mug1:", "   mug1:", "6:4", "not YAML", None),
    ("mug1: {", "mug1: {at: [", "6:42", "not YAML", None),
    ("counter1: {class: counter}", "counter1: &a {class: counter}\n  c2: *a", "5:7", "aliases", "write"),
    ("objects:", "objcts:", "3:1", "objcts", "objects"),
]


@pytest.mark.parametrize(("old", "new", "place", "message", "hint"), MISTAKES)
def test_a_mistake_is_reported_with_place_and_remedy(
    tmp_path: Path, old: str, new: str, place: str, message: str, hint: str | None
) -> None:
    path = tmp_path / "here.yaml"
    assert old in GOOD
    path.write_text(GOOD.replace(old, new))
    with pytest.raises(TmdError) as caught:
        compile_problem(load_environment(path), KITCHEN)
    assert message in caught.value.message
    assert str(caught.value.location) == f"{path}:{place}"
    assert hint is None or hint in (caught.value.hint or "")


@pytest.mark.parametrize("content", [b"\xff\xfe\x00", b"", b"[" * 5000, b"a: !!python/object:os.system x\n"])
def test_what_is_no_environment_at_all_is_refused_in_one_line(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "here.yaml"
    path.write_bytes(content)
    with pytest.raises(TmdError) as caught:
        load_environment(path)
    assert "\n" not in str(caught.value)
    assert str(path) in str(caught.value)


def test_words_that_yaml_once_took_for_truth_values_stay_words(tmp_path: Path) -> None:
    path = tmp_path / "here.yaml"
    path.write_text(GOOD + "  stove1: {class: stove, parts: {knob1: {set_to: off}, knob2: {set_to: high}}}\n")
    init = compile_problem(load_environment(path), KITCHEN).init
    assert {atom("set_to stove1_knob1 off"), atom("set_to stove1_knob2 high")} <= init
    assert atom("set_to stove1_knob2 off") not in init


def test_an_unknown_domain_names_the_nearest() -> None:
    with pytest.raises(TmdError, match="kitchen"):
        find_domain("kichen", ROOT / "domains")
    with pytest.raises(TmdError):
        find_domain("../kitchen", ROOT / "domains")


@pytest.mark.parametrize(
    ("domain", "environment", "hidden", "instruction"),
    [
        ("kitchen", "kitchen1", "milk1", "open milk1"),
        ("kitchen", "kitchen1", "milk1", "moveto milk1"),
        ("kitchen", "kitchen1", "milk1", "grasp milk1"),
        ("living_room", "room3", "remote1", "moveto remote1"),
        ("living_room", "room3", "remote1_power_button", "press remote1_power_button"),
    ],
)
def test_nothing_is_done_to_what_is_behind_a_closed_door(
    domain: str, environment: str, hidden: str, instruction: str
) -> None:
    """However near the robot stands, and however well it knows the place."""
    problem = compiled(ROOT / f"problems/{domain}/environments/{environment}.yaml")
    name, argument = instruction.split()
    # the robot has been there before
    known = problem.init | {atom(f"{fact} pr2 {argument}") for fact in ("found", "near", "carried")}
    broken = first_broken(Instruction(name, (argument,)), known, problem)
    assert atom(f"hidden {hidden}") in problem.init
    assert broken is not None
    assert "hidden" in broken.text
