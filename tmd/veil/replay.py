"""Playing a demonstration: every instruction must be executable, the stated end and the goal must be reached."""

from __future__ import annotations

from tmd.diagnostics import TmdError
from tmd.pddl.model import GroundAtom, Problem, State
from tmd.pddl.reading.goal import with_goal
from tmd.pddl.semantics import apply, first_broken, holds
from tmd.veil.demonstration import Demonstration
from tmd.veil.goal import check_goal
from tmd.veil.world import World


def replay(demonstration: Demonstration, problem: Problem) -> list[State]:
    """The states before the first and after each instruction.

    Raises:
        TmdError: An instruction is not executable (with its number and the first broken precondition), or a
            literal of the stated end state or the goal does not hold.
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
    check_goal(demonstration, problem, states[-1])
    return states


def goal_holds(goal: str, problem: Problem, state: State) -> bool:
    """Whether a closed PDDL condition, as a text, holds in a state of ``problem``.

    Raises:
        TmdError: It is not a condition, or speaks of what the problem does not have.
    """
    return holds(with_goal(problem, goal, "goal").goal, state, problem)


def final_state(demonstration: Demonstration, world: World) -> State:
    """The state after all instructions of a demonstration that can be executed."""
    state = world.task.init
    for instruction in demonstration.instructions:
        state = world.task.by_instruction[instruction].apply(state)
    return world.task.decode(state)


def check_executable(demonstration: Demonstration, world: World) -> None:
    """Make sure that a demonstration can be done in its environment: what cannot teaches nothing true.

    Raises:
        TmdError: An instruction is not executable; with the demonstration's place, and the first broken precondition.
    """
    state = world.task.init
    for number, instruction in enumerate(demonstration.instructions, start=1):
        operator = world.task.by_instruction.get(instruction)
        if operator is None or not operator.applicable(state):
            raise TmdError(
                f"'{demonstration.id}' cannot be executed in {world.name}: {_broken(demonstration, number, world)}",
                location=demonstration.location,
                hint="mend the demonstration, or the domain or environment if they are what changed",
            )
        state = operator.apply(state)


def _broken(demonstration: Demonstration, number: int, world: World) -> str:
    """What is wrong with step ``number``, the first that cannot be executed."""
    problem = world.task.problem
    state = problem.init
    for instruction in demonstration.instructions[: number - 1]:
        state = apply(instruction, state, problem)
    wrong = demonstration.instructions[number - 1]
    try:
        broken = first_broken(wrong, state, problem)
    except TmdError as error:
        return f"step {number}, {wrong}: {error.message}"
    return f"step {number}, {wrong}: {broken.text if broken else 'it'} does not hold"


def _literal_holds(literal: str, state: State) -> bool:
    words = literal.replace("(", " ").replace(")", " ").split()
    if not words or words == ["not"]:
        raise TmdError(f"'{literal}' is not a literal", hint="write (predicate name …) or (not (predicate name …))")
    positive = words[0] != "not"
    atom = words if positive else words[1:]
    return (GroundAtom(atom[0], tuple(atom[1:])) in state) == positive
