"""Algorithm 1 against brute force, and what must hold of everything it hands out."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tmd.inference.config import PAPER_EXTENDED
from tmd.inference.energy import NAMES, Energy, Weights, count, named_weights
from tmd.inference.goal_pass import Inference
from tmd.inference.proposers import proposers_of
from tmd.language import parse
from tmd.language.clause import Clause
from tmd.library.library import Library, learn
from tmd.library.template import instantiate
from tmd.pddl.model import Instruction
from tmd.pddl.semantics import get_constraints
from tmd.pddl.validator import validate
from tmd.planning.backends import IN_PROCESS, TaskPlanners, make
from tmd.planning.result import Filled, Planner
from tmd.world.corpus import Corpus
from tmd.world.world import World

EXTENDED = named_weights("paper_extended")
MIXED = Weights({name: 1.5 + number for number, name in enumerate(reversed(NAMES))} | {"trimming": 0.3})


def inference_of(
    world: World,
    library: Library,
    weights: Weights,
    filler: Planner | None = None,
    *,
    beam: int | None = 5,
    trim: int | None = None,
) -> Inference:
    config = replace(PAPER_EXTENDED, beam=beam, trim=trim)
    energy = Energy(weights, count(library), world)
    proposers = proposers_of(config, world, library, energy)
    return Inference(world, energy, TaskPlanners(world.task, filler or filler_of(world)), proposers, config)


@cache
def filler_of(world: World) -> Planner:
    """The planner of an environment: its answers, which it remembers, depend on the questions alone."""
    return make(IN_PROCESS, world.task)


@cache
def library_of(corpus: Corpus, without: str) -> Library:
    """What the other environments teach."""
    return learn((d for d in corpus.demonstrations() if d.environment != without), corpus.world, corpus.lexicon)


def small(library: Library, verbs: Sequence[str], each: int) -> Library:
    found = Library(library.lexicon)
    for verb in verbs:
        for template in library.propose(Clause(verb))[:each]:
            found.add(template)
    return found


def executable(world: World, state: int, instructions: Sequence[Instruction]) -> bool:
    for instruction in instructions:
        operator = world.task.by_instruction[instruction]
        if not operator.applicable(state):
            return False
        state = operator.apply(state)
    return True


def walk(world: World, random: np.random.Generator, length: int) -> int:
    state = world.task.init
    for _ in range(length):
        applicable = [o for o in world.task.operators if o.applicable(state)]
        state = applicable[int(random.integers(len(applicable)))].apply(state)
    return state


def test_constraints_hold_exactly_where_the_sequence_can_be_executed(kitchen: Corpus) -> None:
    random = np.random.default_rng(3)
    agreed = {True: 0, False: 0}
    for environment in kitchen.environments():
        world = kitchen.world(environment)
        own = [d for d in kitchen.demonstrations() if d.environment == environment]
        for demonstration in own[:4]:
            state = world.task.init
            states = [state]
            for instruction in demonstration.instructions:
                state = world.task.by_instruction[instruction].apply(state)
                states.append(state)
            start = int(random.integers(len(demonstration.instructions)))
            piece = demonstration.instructions[start : start + 5]
            constraints = get_constraints([world.task.by_instruction[i] for i in piece])
            assert constraints[-1][0].holds(0)
            for tried in [*states, *(walk(world, random, int(random.integers(12))) for _ in range(5))]:
                for t in range(len(piece) + 1):
                    can = executable(world, tried, piece[t:])
                    assert any(cube.holds(tried) for cube in constraints[t]) == can
                    agreed[can] += 1
    assert min(agreed.values()) > 100


def brute_force(world: World, library: Library, weights: Weights, clauses: Sequence[Clause], trim: int) -> float:
    """The least energy over every combination of template and trimming for each clause."""
    filler = filler_of(world)
    scorer = Energy(weights, count(library), world)

    def ways(clause: Clause, state: int) -> list[tuple[float, int]]:
        found = []
        for template in library.propose(clause):
            made = instantiate(template, clause, world, state, pair_nouns=True)
            assert made is not None
            whole = made.instructions
            names = world.mentions.meant(clause, made.grounding.values(), state)
            for t in range(min(trim, len(whole)) + 1):
                if any(i not in world.task.by_instruction for i in whole[t:]):
                    continue
                operators = [world.task.by_instruction[i] for i in whole[t:]]
                answer = filler.fill(state, get_constraints(operators)[0])
                if not isinstance(answer, Filled):
                    continue
                end = answer.state
                for operator in operators:
                    end = operator.apply(end)
                parts = (
                    scorer.of_template(made, clause),
                    scorer.of_sequence(whole[t:], len(whole), names),
                    scorer.of_end(clause.verb, names, end),
                    scorer.of_latent(answer.plan, answer.state),
                )
                found.append((sum(sum(scorer.weigh(part).values()) for part in parts), end))
        return found

    frontier = [(0.0, world.task.init)]
    for clause in clauses:
        assert all(ways(clause, state) for _, state in frontier)
        frontier = [(energy + more, end) for energy, state in frontier for more, end in ways(clause, state)]
    return min(energy for energy, _ in frontier)


@pytest.mark.parametrize(("environment", "weights"), [("kitchen1", MIXED), ("kitchen3", EXTENDED)])
def test_unbounded_inference_finds_what_brute_force_finds(kitchen: Corpus, environment: str, weights: Weights) -> None:
    library = small(library_of(kitchen, environment), ["fill", "add", "wait"], 4)
    world = kitchen.world(environment)
    clauses = parse("Fill the bowl with water. Add the ramen. Wait.", kitchen.lexicon).clauses
    assert len(clauses) == 3
    inference = inference_of(world, library, weights, beam=None, trim=5)
    (plan,) = inference.infer_clauses(clauses, world.task.init).plans
    assert plan.energy == pytest.approx(brute_force(world, library, weights, clauses, trim=5))


TEXTS = [
    "Fill the pot with water, put it on the stove and turn on the burner. Add the ramen and wait.",
    "heat some water in the kettle, put the noodles in a bowl and pour the water over them",
    "take the cup. take the bowl. put the cup on the counter",
]


@pytest.mark.parametrize(
    ("environment", "text"),
    [("kitchen2", TEXTS[0]), ("kitchen2", TEXTS[1]), ("kitchen3", TEXTS[1]), ("kitchen5", TEXTS[2])],
)
def test_every_plan_is_valid_distinct_and_in_order(kitchen: Corpus, environment: str, text: str) -> None:
    world = kitchen.world(environment)
    inference = inference_of(world, library_of(kitchen, environment), EXTENDED, beam=3)
    plans = inference.infer_clauses(parse(text, kitchen.lexicon).clauses, world.task.init, top=4).plans
    assert plans
    for plan in plans:
        verdict = validate(world.task.problem, plan.instructions, trace=True)
        assert verdict.valid, verdict.reason
        assert world.task.encode(verdict.trace[-1]) == plan.state
        assert plan.energy == pytest.approx(sum(plan.factors.values()))
    assert [p.energy for p in plans] == sorted(p.energy for p in plans)
    assert len({p.instructions for p in plans}) == len(plans)
    assert plans[0].why == ""
    assert all(plan.why for plan in plans[1:])


def test_the_beam_loses_nothing_that_its_queue_passes_over(kitchen: Corpus) -> None:
    """With a beam the queue ends early; the kept ends must be those of the full α, cut to the beam."""
    world = kitchen.world("kitchen5")
    library = library_of(kitchen, "kitchen5")
    clause = parse("Fill the pot with water.", kitchen.lexicon).clauses[:1]
    for beam in (1, 2, 4):
        ends = []
        for width in (beam, None):
            inference = inference_of(world, library, EXTENDED, beam=width)
            ends.append([round(p.energy, 9) for p in inference.infer_clauses(clause, world.task.init, top=beam).plans])
        assert ends[0][:1] == ends[1][:1]
        assert len(ends[0]) == len(ends[1])


def test_an_unseen_verb_leaves_the_environment_as_it_is(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    inference = inference_of(world, library_of(kitchen, "kitchen1"), EXTENDED)
    (plan,) = inference.infer_clauses([Clause("defenestrate", ("cup",))], world.task.init).plans
    assert (plan.instructions, plan.energy, plan.state) == ((), 0.0, world.task.init)


def test_a_clause_that_is_already_so_may_be_left_out(kitchen: Corpus) -> None:
    """Wholly trimmed, a template is a no-op; free trimming makes it the cheapest."""
    world = kitchen.world("kitchen1")
    weights = Weights({"description_length": 1.0})
    inference = inference_of(world, library_of(kitchen, "kitchen1"), weights)
    (plan,) = inference.infer_clauses([Clause("fill", ("pot",))], world.task.init).plans
    assert plan.instructions == ()


def test_what_cannot_be_done_is_refused_with_its_reason(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen3")
    inference = inference_of(world, library_of(kitchen, "kitchen3"), EXTENDED)
    refusals = inference.infer_clauses([Clause("heat", ("pot",))], world.task.init).rejected
    assert refusals
    sources = {d.id for d in kitchen.demonstrations()}
    assert all(r.reason and r.source in sources and r.clause == 0 for r in refusals)
    assert len(set(refusals)) == len(refusals)


def test_more_than_one_worker_would_see_the_same(kitchen: Corpus) -> None:
    """The memo of the planner changes nothing: a fresh inference and a warm one agree to the byte."""
    world = kitchen.world("kitchen2")
    library = library_of(kitchen, "kitchen2")
    clauses = parse(TEXTS[0], kitchen.lexicon).clauses
    warm = make(IN_PROCESS, world.task)
    outcomes = []
    for filler in (warm, warm, make(IN_PROCESS, world.task)):
        plans = (
            inference_of(world, library, EXTENDED, filler, beam=3).infer_clauses(clauses, world.task.init, top=3).plans
        )
        outcomes.append([(p.energy, p.instructions) for p in plans])
    for one, other in itertools.pairwise(outcomes):
        assert one == other
