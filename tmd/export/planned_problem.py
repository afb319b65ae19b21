"""A problem and a plan that works for it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

from tmd.diagnostics import TmdError
from tmd.export.names import Renames, renamed, renames
from tmd.pddl.model import TRUE, And, Atom, Instruction, Not, Problem, State
from tmd.pddl.normalise import portable
from tmd.pddl.validator import validate


@dataclass(frozen=True)
class Planned:
    """A problem, a plan that reaches its goal, and the states on the way.

    Make it with :func:`planned`, which executes the plan. There is one more of the states, before, between and after
    the instructions, than of these.
    """

    problem: Problem
    plan: tuple[Instruction, ...]
    cost: int
    states: tuple[State, ...]

    @cached_property
    def portable(self) -> Problem:
        """The problem in the form that other planners read: flat, every requirement named, no ``either``.

        Raises:
            TmdError: It cannot be written so.
        """
        return portable(self.problem)

    @cached_property
    def renames(self) -> Renames:
        """The names that other tools refuse, with those that they take."""
        return renames(self.portable)

    @cached_property
    def accepted(self) -> Planned:
        """The portable problem and the plan, in names that other tools take.

        Raises:
            TmdError: As :attr:`portable`.
        """
        if not self.renames:
            return self
        plan: tuple[Instruction, ...] = renamed(self.plan, self.renames)
        states: tuple[State, ...] = renamed(self.states, self.renames)
        return replace(self, problem=renamed(self.portable, self.renames), plan=plan, states=states)


def planned(problem: Problem, plan: Iterable[Instruction]) -> Planned:
    """Execute ``plan`` in ``problem``.

    Raises:
        TmdError: The plan does not work; the message names the first thing that fails.
    """
    steps = tuple(plan)
    verdict = validate(problem, steps, trace=True)
    if not verdict.valid:
        raise TmdError(f"the plan does not work: {verdict.reason}", hint="only plans that work are exported")
    return Planned(problem, steps, verdict.cost, verdict.trace)


def with_outcome(problem: Problem, plan: Iterable[Instruction]) -> Problem:
    """Return ``problem`` with the goal that everything is as it is after ``plan``.

    The goal of a text is not stated anywhere; the changes of its plan are taken for it. Where nothing changed, the goal
    is empty.

    Raises:
        TmdError: An instruction cannot be executed.
    """
    open_ended = replace(problem, goal=TRUE)
    end = planned(open_ended, plan).states[-1]
    gained = [Atom(atom.predicate, atom.args) for atom in sorted(end - problem.init)]
    lost = [Not(Atom(atom.predicate, atom.args)) for atom in sorted(problem.init - end)]
    return replace(problem, goal=And((*gained, *lost)))
