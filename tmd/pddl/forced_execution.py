"""Executing sequences by force: every effect applies even where a precondition fails.

This is how predictions are scored that nobody checked, for any PDDL domain. An
instruction that names no action, or has a wrong number or type of arguments, is not executable and does
nothing. An object that does not exist is a thing of which nothing is known, of the most general type: the
instruction is not executable, but what it does to the objects that exist, it does.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from tmd.pddl.ground_formula import FALSE
from tmd.pddl.grounding.ground_task import ground, ground_condition
from tmd.pddl.model import OBJECT, Instruction, Problem, State, TypedName, universe
from tmd.pddl.semantics import bind, schema_of
from tmd.pddl.task import Bits, Cube, Operator, Task

# Names of stand-ins for objects that do not exist begin so; no PDDL name can.
_GHOST = "?nobody-"


@dataclass(frozen=True, slots=True)
class Rollout:
    """A forced execution: the state at the start and after each instruction, as bits of ``task``.

    Attributes:
        states: One more than there are instructions.
        failures: The steps, from 0, that were not executable.
    """

    task: Task
    states: tuple[Bits, ...]
    failures: tuple[int, ...]

    @property
    def executable(self) -> bool:
        """Return whether every step was executable."""
        return not self.failures

    def decoded(self) -> list[State]:
        """Return the states as sets of atoms."""
        return [self.task.decode(bits) for bits in self.states]


class ForcedExecution:
    """Forced execution in one environment.

    Only the instructions that are really run are ground, so this is quick where the full task is large. Naming them
    beforehand saves grounding again later; results do not depend on it. ``absent`` are the types of things that do not
    exist and still choose a rule by their name.
    """

    def __init__(
        self, problem: Problem, instructions: Iterable[Instruction] = (), absent: Mapping[str, str] | None = None
    ) -> None:
        self.problem = problem
        self._absent = dict(absent or {})
        self._roots = _general_types(problem)
        self._known: set[Instruction] = set(instructions)
        self._operators: dict[Instruction, Operator | None] = {}
        self._preconditions: dict[Instruction, tuple[Cube, ...]] = {}
        self._steps: dict[tuple[Bits, Instruction], tuple[Bits, bool]] = {}
        self.task = self._ground()

    def prepare(self, instructions: Iterable[Instruction]) -> Task:
        """Get ready for these instructions; the task that :meth:`run` will use for them."""
        wanted = set(instructions)
        if not wanted <= self._known:
            self._known |= wanted
            self.task = self._ground()
        return self.task

    def run(self, instructions: Sequence[Instruction]) -> Rollout:
        """Execute a sequence from the start."""
        self.prepare(instructions)
        states = [self.task.init]
        failures = []
        for number, instruction in enumerate(instructions):
            after, applicable = self.step(states[-1], instruction)
            states.append(after)
            if not applicable:
                failures.append(number)
        return Rollout(self.task, tuple(states), tuple(failures))

    def step(self, state: Bits, instruction: Instruction) -> tuple[Bits, bool]:
        """Return the state after a prepared instruction, and whether it was executable."""
        key = state, instruction
        found = self._steps.get(key)
        if found is None:
            operator = self._operators[instruction]
            after = state if operator is None else operator.apply(state)
            found = self._steps[key] = after, any(c.holds(state) for c in self.precondition(instruction))
        return found

    def precondition(self, instruction: Instruction) -> tuple[Cube, ...]:
        """Return a prepared instruction's precondition: one of these must hold; none if it can never be executed."""
        return self._preconditions[instruction]

    def _ground(self) -> Task:
        """Ground the effects of all known instructions, and nothing else."""
        known = sorted(self._known)
        bound = {instruction: self._bound(instruction) for instruction in known}
        ghosts = sorted({arg for b in bound.values() if b for arg in b.args if arg.startswith(_GHOST)})
        objects = self.problem.objects + tuple(
            TypedName(name, tuple(name.removeprefix(_GHOST).split("-"))) for name in ghosts
        )
        domain = self.problem.domain
        blind = replace(domain, actions=tuple(replace(a, precondition=FALSE) for a in domain.actions))
        problem = replace(self.problem, domain=blind, objects=objects)
        task = ground(problem, forced=sorted({b for b in bound.values() if b}))
        real = ~task.where(lambda atom: any(a in ghosts for a in atom.args))
        self._steps.clear()
        for instruction in known:
            target = bound[instruction]
            self._operators[instruction] = target and _without(task.by_instruction[target], real)
            self._preconditions[instruction] = ()
            if target == instruction:
                needed, binding = schema_of(self.problem, instruction).precondition, bind(self.problem, instruction)
                self._preconditions[instruction] = ground_condition(task, needed, binding)
        return task

    def _bound(self, instruction: Instruction) -> Instruction | None:
        """Return the instruction with stand-ins for objects that do not exist; nothing where it fits no action."""
        schema = next((a for a in self.problem.domain.actions if a.name == instruction.name), None)
        if schema is None or len(schema.parameters) != len(instruction.args):
            return None
        known = universe(self.problem)
        args = []
        for arg, parameter in zip(instruction.args, schema.parameters, strict=True):
            if arg in known.types_of:
                fits = known.is_a(arg, parameter.types)
            elif arg in self._absent:
                fits = known.hierarchy.accepts(parameter.types, (self._absent[arg],))
            else:
                fits = self._roots.issuperset(parameter.types)
            if not fits:
                return None
            args.append(arg if arg in known.types_of else _GHOST + "-".join(parameter.types))
        return Instruction(instruction.name, tuple(args))


def _general_types(problem: Problem) -> frozenset[str]:
    """Return the types right below the root that the problem has objects of; a relation word is no such thing."""
    known = universe(problem)
    declared = (known.hierarchy.ancestors(o.types[0])[-2:] for o in problem.objects)
    return frozenset({OBJECT, *(types[0] for types in declared)})


def rollout(problem: Problem, instructions: Sequence[Instruction]) -> Rollout:
    """Execute one sequence by force; for many in the same environment use a :class:`ForcedExecution`."""
    return ForcedExecution(problem, instructions).run(instructions)


def _without(operator: Operator, real: Bits) -> Operator:
    """Return the operator without what it says of things that do not exist."""
    conditional = tuple(effect._replace(add=effect.add & real) for effect in operator.conditional)
    return replace(operator, add=operator.add & real, conditional=conditional)
