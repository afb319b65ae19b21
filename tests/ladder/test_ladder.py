"""The ladder of domains: each a folder without Python that answers what a person would say in it."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from tests.bundled import corpus
from tmd.diagnostics import RefusalKind
from tmd.ground import ground
from tmd.inference.config import PAPER
from tmd.knowledge import Knowledge, study
from tmd.pddl.model import Instruction
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.semantics import holds

ROOT = Path(__file__).resolve().parents[2]
LADDER = ["01_blocks", "02_table", "03_drawer", "04_tea", "lab_bench"]
SAID = [
    ("01_blocks", "yard1", "Put the red block on the green block.", "(on red_block green_block)"),
    ("01_blocks", "yard2", "Put the red block on the green block.", "(on red_block green_block)"),
    ("01_blocks", "yard1", "Stack the blue cube on the red one.", "(on blue_block red_block)"),
    ("02_table", "corner2", "Put the book on the table.", "(at book1 table1 on)"),
    ("02_table", "corner1", "Take the cup and put it on the shelf.", "(at cup1 shelf1 on)"),
    ("03_drawer", "study2", "Put the key on the table.", "(at key1 table1 on)"),
    ("03_drawer", "study2", "Take the pen.", "(holding pr2 pen1)"),
    ("04_tea", "pantry2", "Turn off the tap. Boil the water in the kettle and pour it into the cup.", "(hot cup1)"),
    ("lab_bench", "lab1", "Spin the sample tube.", "(separated sample_tube1)"),
    (
        "lab_bench",
        "lab2",
        "Put the sample tube in the centrifuge and close the lid.",
        "(or (at sample_tube1 centrifuge1 in) (at sample_tube2 centrifuge1 in))",
    ),
    ("lab_bench", "lab1", "Add ethanol to the beaker with the pipette.", "(contains beaker1 ethanol)"),
]


@cache
def knowledge(domain: str) -> Knowledge:
    return study(corpus(domain))


@pytest.mark.parametrize("domain", LADDER)
def test_a_step_has_all_its_files_and_no_python(domain: str) -> None:
    folder, problems = ROOT / "domains" / domain, ROOT / "problems" / domain
    assert {"README.md", "domain.pddl", "lexicon.yaml"} <= {path.name for path in folder.iterdir()}
    assert not [path for root in (folder, problems) for path in root.rglob("*.py")]
    assert len(corpus(domain).environments()) == 2
    assert len(corpus(domain).demonstrations()) >= 3
    assert list(problems.glob("p*.pddl"))


def test_the_laboratory_has_ten_demonstrations() -> None:
    texts = {demonstration.text for demonstration in corpus("lab_bench").demonstrations()}
    assert len(texts) == len(corpus("lab_bench").demonstrations()) == 10


@pytest.mark.parametrize(("domain", "environment", "text", "wanted"), SAID, ids=[f"{s[1]}: {s[2]}" for s in SAID])
def test_what_is_said_is_done(domain: str, environment: str, text: str, wanted: str) -> None:
    known = knowledge(domain)
    world = corpus(domain).world(environment)
    grounded = ground(text, world, known.library, reward=known.reward)
    assert grounded.verdicts[0].valid
    goal = with_goal(world.task.problem, wanted, "goal").goal
    assert goal is not None
    assert holds(goal, world.task.decode(grounded.plans[0].state), world.task.problem)


@pytest.mark.parametrize("domain", LADDER)
def test_what_was_demonstrated_is_done_when_it_is_said_again(domain: str) -> None:
    known = knowledge(domain)
    reached = 0
    for demonstration in corpus(domain).demonstrations():
        world = corpus(domain).world(demonstration.environment)
        grounded = ground(demonstration.text, world, known.library, reward=known.reward)
        if not grounded.plans:
            assert grounded.refused is not None
            continue
        state = {str(atom) for atom in world.task.decode(grounded.plans[0].state)}
        reached += all(
            (literal in state) if not literal.startswith("(not ") else (literal[5:-1] not in state)
            for literal in demonstration.end_state
        )
    assert reached >= 0.6 * len(corpus(domain).demonstrations())


def test_a_verb_that_nobody_showed_or_declared_is_refused() -> None:
    known = knowledge("02_table")
    grounded = ground(
        "Polish the cup on the shelf.", corpus("02_table").world("corner1"), known.library, reward=known.reward
    )
    assert grounded.plans == ()
    assert grounded.unseen == ("polish",)
    assert grounded.refused is not None
    assert (grounded.refused[0], grounded.refused[1].kind) == (0, RefusalKind.UNKNOWN_VERB)


def test_a_verb_that_means_what_a_declared_one_does_needs_no_demonstration() -> None:
    known = knowledge("02_table")
    world = corpus("02_table").world("corner1")
    grounded = ground("Hide the cup on the shelf.", world, known.library, reward=known.reward)
    assert grounded.unseen == ("hide",)
    assert [goal.source for goal in grounded.plans[0].goals] == ["declared"]
    assert "(at cup1 shelf1 on)" in {str(atom) for atom in world.task.decode(grounded.plans[0].state)}


def test_the_paper_model_knows_nothing_of_ours() -> None:
    known = knowledge("01_blocks")
    world = corpus("01_blocks").world("yard2")
    text = "Put the blue block on the green block."
    plan = ground(text, world, known.library, reward=known.reward, config=PAPER).plans[0]
    assert not {"language_model", "policy_proposal"} & set(plan.factors)
    assert not plan.factors["objects_not_touched"]
    mine = ground(text, world, known.library, reward=known.reward).plans[0]
    assert mine.instructions[-1] == Instruction("stack", ("blue_block", "green_block"))
    assert [goal.row for goal in mine.goals] and not any(goal.already for goal in mine.goals)
    assert parse_instruction("unstack(blue_block, red_block)") in mine.instructions
