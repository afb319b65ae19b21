"""The choices of a policy in one environment, and their features at each node of a search."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tmd.inference.policy.features import (
    APPLIES,
    BEGUN,
    CHANGES,
    EFFECTS,
    JUST_NAMED,
    LENGTHS,
    LEVELS,
    MENTIONED,
    MET,
    NAMED,
    REALS,
    RECENCIES,
    REPEATS,
    STOP,
    UNKNOWN,
    WHERE,
    ClauseContext,
    Features,
    Floats,
    Ints,
    KnownObjects,
    followers,
    properties,
)
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits

Mask = NDArray[np.bool_]

# An atom is looked at for its first two arguments; a third one is mostly a constant of the domain.
FACT_PLACES = 2
# Maximum number of states and of sequences that a menu keeps.
_REMEMBERED = 5_000


class Node(NamedTuple):
    """A node of the search tree: the instructions chosen for earlier clauses, and for this one."""

    earlier: tuple[Instruction, ...] = ()
    own: tuple[Instruction, ...] = ()


class Seen(NamedTuple):
    """A state as the features see it.

    Attributes:
        effects: C, the effect of each choice (:data:`EFFECTS`).
        facts: (things + 1) × facts, 1 where one holds of a thing.
    """

    effects: Ints
    facts: Floats


class Menu:
    """The C instructions to choose from in one environment, STOP last, as arrays.

    Attributes:
        things: The objects of the environment; the number after the last one means none.
        properties: C × properties, 1 where an instruction has one.
        having: C × maximum, the numbers of each one's properties, padded with the number after the last property.
        args: C × arity, the things that are named.
        places: C × arity, the places they are named in.
        needs: Rows (choice, action, thing): the choice needs that the action named the thing before.
        words: Things, 1 for each constant of the domain, and for no thing.
    """

    def __init__(self, features: Features, things: KnownObjects, choices: Sequence[Instruction]) -> None:
        self.features = features
        self.things = things
        self.choices = (*choices, STOP)
        self.index = {choice: number for number, choice in enumerate(self.choices)}
        count = len(self.choices)
        self.properties: Floats = np.zeros((count, len(features.properties)))
        own: list[list[int]] = []
        self.actions: Ints = np.array([features.actions[choice.name] for choice in self.choices], np.int64)
        self.args: Ints = np.full((count, features.arity), len(things.numbers), np.int64)
        self.places: Ints = np.full((count, features.arity), len(features.places), np.int64)
        needs = []
        for row, choice in enumerate(self.choices):
            having = [features.properties[p] for p in properties(choice, things) if p in features.properties]
            self.properties[row, having] = 1
            own.append(having)
            for place, arg in enumerate(choice.args):
                key = (choice.name, place)
                self.args[row, place] = things.numbers[arg]
                self.places[row, place] = features.places[key]
                needs += [(row, features.actions[n], things.numbers[arg]) for n in features.syntax.needs.get(key, ())]
        most = max(map(len, own))
        self.having: Ints = np.array([[*row, *[len(features.properties)] * (most - len(row))] for row in own], np.int64)
        self.needs: Ints = np.array(needs, np.int64).reshape(-1, 3)
        self.words: Mask = np.array([*(things.is_constant(name) for name in things.kinds), True])
        self._task = things.world.task
        self._operators = [self._task.by_instruction.get(choice) for choice in self.choices]
        self._reached: dict[tuple[Instruction, ...], Bits] = {(): self._task.init}
        self._seen = lru_cache(_REMEMBERED)(self._seen_in)
        if features.grounded:
            self._prepare_states()

    def _prepare_states(self) -> None:
        """Store the bits of all operators and facts as rows of words, to compare a state with all at once."""
        operators = [operator for operator in self._operators if operator is not None]
        self._possible: Ints = np.flatnonzero([operator is not None for operator in self._operators])
        self._positive = self._rows(operator.precondition.positive for operator in operators)
        self._negative = self._rows(operator.precondition.negative for operator in operators)
        self._adds = self._rows(operator.add for operator in operators)
        self._deletes = self._rows(operator.delete & ~operator.add for operator in operators)
        self._special = [
            (i, operator) for i, operator in enumerate(operators) if operator.forbidden or operator.conditional
        ]
        masks: Counter[tuple[int, int]] = Counter()
        for bit, atom in enumerate(self._task.atoms):
            for place, name in enumerate(atom.args[:FACT_PLACES]):
                fact = self.features.facts.get((atom.predicate, place))
                if name in self.things.numbers and fact is not None:
                    masks[self.things.numbers[name], fact] += 1 << bit
        self._about = tuple(np.array(list(masks), np.int64).reshape(-1, 2).T)
        self._masks = self._rows(masks.values())

    def _rows(self, sets: Iterable[Bits]) -> NDArray[np.uint64]:
        """Return bit sets as rows of words of 64 bits."""
        length = 8 * (len(self._task.atoms) // 64 + 1)
        return np.frombuffer(b"".join(s.to_bytes(length, "little") for s in sets), np.uint64).reshape(-1, length // 8)

    def seen_after(self, sequence: tuple[Instruction, ...]) -> Seen:
        """Return the state after a sequence, as the features see it; an impossible instruction changes nothing."""
        return self._seen(self._state(sequence))

    def _seen_in(self, state: Bits) -> Seen:
        (row,) = self._rows([state])
        applies = ~((self._positive & ~row) | (self._negative & row)).any(axis=1)
        changes = ((self._adds & ~row) | (self._deletes & row)).any(axis=1)
        for i, operator in self._special:
            applies[i] = applies[i] and operator.applicable(state)
            changes[i] = applies[i] and operator.apply(state) != state
        effects: Ints = np.full(len(self.choices), UNKNOWN, np.int64)
        effects[self._possible] = np.where(applies, np.where(changes, CHANGES, APPLIES), 0)
        facts: Floats = np.zeros((len(self.things.numbers) + 1, len(self.features.facts)))
        facts[self._about] = (self._masks & row).any(axis=1)
        return Seen(effects, facts)

    def _state(self, sequence: tuple[Instruction, ...]) -> Bits:
        known = len(sequence)
        while sequence[:known] not in self._reached:
            known -= 1
        state = self._reached[sequence[:known]]
        if len(self._reached) > _REMEMBERED:
            self._reached = {(): self._task.init}
        for length in range(known, len(sequence)):
            operator = self._task.by_instruction.get(sequence[length])
            state = operator.apply(state) if operator is not None else state
            self._reached[sequence[: length + 1]] = state
        return state


@dataclass(frozen=True)
class Steps:
    """The features of H choices: the steps of one sequence, or the open nodes of a search.

    Attributes:
        followers: For each node the numbers of the words for its sequence.
        open: The numbers of the O choices that are allowed at one node at least: few are.
        pairs: H × O × Q, the numbers of the paired features.
        facts: H × (things + 1) × facts, 1 where one holds of a thing.
        reals: H × C × 2, the features that are numbers.
        allowed: H × C, whether the constraints allow the choice.
    """

    menu: Menu
    context: ClauseContext
    followers: tuple[Ints, ...]
    open: Ints
    pairs: Ints
    facts: Floats
    reals: Floats
    allowed: Mask

    @cached_property
    def closed(self) -> Mask:
        """The choices that the constraints forbid, H × O. Learning looks at the same steps again and again."""
        return ~self.allowed[:, self.open]

    @cached_property
    def allowed_pairs(self) -> tuple[Ints, Ints]:
        """The numbers of the paired features of the allowed choices, each once, and which of them each is."""
        found, which = np.unique(self.pairs[~self.closed].ravel(), return_inverse=True)
        return found, which


def steps(menu: Menu, context: ClauseContext, nodes: Sequence[Node], made: Ints | None = None) -> Steps:
    """Return the features of every choice at each node; what was ``made`` there was possible."""
    allowed = np.stack([_allowed(menu, node) for node in nodes])
    if made is not None:  # the constraints are only almost always kept
        allowed[np.arange(len(made)), made] = True
    numbers = np.flatnonzero(allowed.any(axis=0))
    looks = [_look(menu, context, node, numbers) for node in nodes]
    added, pairs, facts, reals = zip(*looks, strict=True)
    return Steps(menu, context, tuple(added), numbers, np.stack(pairs), np.stack(facts), np.stack(reals), allowed)


def _sequence(menu: Menu, node: Node) -> list[Instruction]:
    """Return what a node did; an action that training never had says nothing."""
    return [instruction for instruction in node.earlier + node.own if instruction.name in menu.features.actions]


def _allowed(menu: Menu, node: Node) -> Mask:
    """Return which choices the constraints allow."""
    named: Mask = np.zeros((len(menu.features.actions), len(menu.things.numbers) + 1), np.bool_)
    for instruction in _sequence(menu, node):
        args = [menu.things.numbers[arg] for arg in instruction.args]
        named[menu.features.actions[instruction.name], args] = True
    choice, action, thing = menu.needs.T
    allowed: Mask = np.ones(len(menu.choices), np.bool_)
    allowed[choice[~named[action, thing]]] = False
    return allowed


def _look(menu: Menu, context: ClauseContext, node: Node, numbers: Ints) -> tuple[Ints, Ints, Floats, Floats]:
    """Return one node's part of :class:`Steps`."""
    features, none = menu.features, len(menu.things.numbers)
    n = len(features.actions)
    recent: Ints = np.zeros(none + 1, np.int64)
    last: Ints = np.full(none + 1, n, np.int64)
    sequence = _sequence(menu, node)
    for instruction in sequence:
        args = [menu.things.numbers[arg] for arg in instruction.args]
        recent[args], last[args] = NAMED, features.actions[instruction.name]
    before = sequence[-1] if sequence else None
    if before is not None:
        recent[[menu.things.numbers[arg] for arg in before.args]] = JUST_NAMED
    done: Ints = np.zeros(len(menu.choices), np.int64)
    done[[menu.index[i] for i in node.own if i in menu.index]] = 1

    actions, named, places, repeated = menu.actions[numbers], menu.args[numbers], menu.places[numbers], done[numbers]
    stops = numbers == len(menu.choices) - 1
    follows = features.actions[before.name] if before is not None else n
    goes_on = (recent[named] == JUST_NAMED).any(axis=1)
    start, levels = features.starts, context.levels
    met = _met(menu, levels, node.own)
    mentioned = levels[named]
    columns = [
        start[0] + places * LEVELS + mentioned,
        start[1] + places * RECENCIES + recent[named],
        start[2] + places * (n + 1) + last[named],
        start[3] + (follows * n + actions) * 2 + goes_on,
        start[4] + actions * 2 + repeated,
        start[5] + stops * (1 + met),
    ]
    facts = _NO_FACTS
    if features.grounded:
        seen = menu.seen_after(node.earlier + node.own)
        facts = seen.facts
        times: Ints = np.zeros(len(menu.choices), np.int64)
        for instruction in sequence:
            if instruction in menu.index:
                times[menu.index[instruction]] += 1
        recent[menu.words] = 0
        earlier = features.actions[sequence[-2].name] if len(sequence) > 1 else n
        begun, where = min(len(node.own), BEGUN - 1), context.where
        end = 1 + (met * WHERE + where) * LENGTHS + min(len(node.own), LENGTHS - 1)
        columns += [
            start[6] + (places * LEVELS + mentioned) * RECENCIES + recent[named],
            start[7] + places * 4 + context.later[named] * 2 + (mentioned > 0),
            start[8] + (earlier * (n + 1) + follows) * n + actions,
            start[9] + actions * REPEATS + np.minimum(times[numbers], 2) * 2 + repeated,
            start[10] + (actions * WHERE + where) * BEGUN + begun,
            start[11] + actions * EFFECTS + seen.effects[numbers],
            start[12] + actions * MET + met,
            start[13] + stops * end,
        ]
    length, different = len(node.own), len(set(node.own))
    reals: Floats = np.zeros((len(menu.choices), REALS))
    reals[:, 0] = (different + 1 - done) / (length + 1)
    reals[-1] = different / length if length else 1, length / max(features.syntax.longest, 1)
    return features.known(followers(before, length, menu.things)), np.column_stack(columns), facts, reals


_NO_FACTS: Floats = np.zeros((0, 0))


def _met(menu: Menu, levels: Ints, own: Sequence[Instruction]) -> int:
    """Return how much of the objects that the clause mentions its sequence has named (:data:`MET`)."""
    about = set(np.flatnonzero(levels >= MENTIONED).tolist())
    met = about & {menu.things.numbers[arg] for instruction in own for arg in instruction.args}
    return 1 + bool(met) + (met == about) if about else 0
