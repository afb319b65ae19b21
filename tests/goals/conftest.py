"""Bundled domains, and texts grounded in them by the model that ships."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

import pytest

import tmd
from tests.bundled import kit
from tmd.ground import reader_of
from tmd.grounded import Grounded
from tmd.inference.config import DEFAULT, preset
from tmd.pddl.model import Formula
from tmd.pddl.writer import format_formula
from tmd.readers.interface import Dialogue


@pytest.fixture(scope="session", autouse=True)
def _taught(learned: Path) -> None:
    """Learn the larger domains once for all tests."""


def said(domain: str, environment: str, text: str) -> Grounded:
    return kit(domain).ground(text, environment)


def understood(domain: str, environment: str, text: str) -> Dialogue:
    """What a text is read as, without any plan."""
    own = kit(domain)
    knowledge, world = own._knowledge, own._corpus.world(environment)
    return reader_of(preset(DEFAULT), knowledge.library, knowledge.goals).begin(text, world, world.task.init)


def pddl(formula: Formula | None) -> str:
    return "" if formula is None else " ".join(format_formula(formula).split())


def goals(grounded: Grounded) -> list[str]:
    """The goals of the steps of the first plan; empty for a step that asks for nothing."""
    return [pddl(goal.formula) for goal in grounded.plans[0].goals]


def steps(grounded: Grounded) -> list[str]:
    """The first plan, which the validator vouches for."""
    assert grounded.verdicts[0].valid
    return [str(instruction) for instruction in grounded.plans[0].instructions]


def hot(grounded: Grounded) -> set[str]:
    """The things that are hot when the first plan is done."""
    return {fact.strip("()").split()[1] for fact in end(grounded) if fact.startswith("(hot ")}


def end(grounded: Grounded) -> set[str]:
    """The facts that hold when the first plan is done."""
    assert grounded.verdicts[0].valid
    return {str(atom) for atom in grounded.world.task.decode(grounded.plans[0].state)}


def plain_world(folder: Path, domain: str, problem: str) -> Path:
    """Write a world without a lexicon."""
    (folder / "domain.pddl").write_text(domain)
    (folder / "problem.pddl").write_text(problem)
    return folder


def assert_ends(folder: Path, text: str, held: Collection[str], gone: Collection[str]) -> None:
    """Check that a request in a plain world has goals, and a plan that ends in some facts and without others."""
    grounded = tmd.load_domain(str(folder)).ground(text, folder / "problem.pddl")
    assert goals(grounded)
    facts = end(grounded)
    assert facts.issuperset(held)
    assert facts.isdisjoint(gone)
