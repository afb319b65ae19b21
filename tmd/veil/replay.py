"""Playing a demonstration: every instruction must be executable, and the stated end must be reached."""

from __future__ import annotations

from tmd.errors import TmdError
from tmd.pddl.model import GroundAtom, Problem, State
from tmd.pddl.semantics import apply, first_broken
from tmd.veil.demonstration import Demonstration


def replay(demonstration: Demonstration, problem: Problem) -> list[State]:
    """The states before the first and after each instruction.

    Raises:
        TmdError: An instruction is not executable (with its number and the first broken precondition), or a
            literal of the stated end state does not hold.
    """
    states = [problem.init]
    for number, instruction in enumerate(demonstration.instructions, start=1):
        broken = first_broken(instruction, states[-1], problem)
        if broken is not None:
            raise TmdError(f"step {number}, {instruction}: {broken.text} does not hold")
        states.append(apply(instruction, states[-1], problem))
    for literal in demonstration.end_state:
        if not _literal_holds(literal, states[-1]):
            raise TmdError(f"the stated end {literal} is not reached")
    return states


def _literal_holds(literal: str, state: State) -> bool:
    words = literal.replace("(", " ").replace(")", " ").split()
    if not words or words == ["not"]:
        raise TmdError(f"'{literal}' is no literal", hint="write (predicate name …) or (not (predicate name …))")
    positive = words[0] != "not"
    atom = words if positive else words[1:]
    return (GroundAtom(atom[0], tuple(atom[1:])) in state) == positive
