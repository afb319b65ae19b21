"""A policy: a learned distribution over instruction sequences given the words of a clause.

It is the reward of the paper's Instruction-Tree baseline, and beyond the paper a second source of candidates for
inference (the preset ``policy``). Here: the features of what may come next, proposing sequences, and learning them.

The paper's has the words of the clause and the sequence so far. Ours is *grounded*: it knows besides which objects the
nouns of this clause, of those before and of those to come may mean, the words of the whole text, whether an instruction
applies in the state that was reached and changes it, and what holds there of the objects that it names.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tmd.pddl.model import OBJECT, Instruction
from tmd.pddl.task import Bits
from tmd.veil.demonstration import Demonstration
from tmd.veil.library import lessons
from tmd.veil.world import World
from tmd.world.verb_clause import VerbClause

_DIGITS = re.compile(r"_?\d+")


class KnownObjects:
    """What an instruction may name in one environment, and of which kinds it is.

    A type that some action asks for (``item``, ``part``) says what a thing is fit for, not what it is; the other
    types do, nearest first. Where there is none, and besides, the thing's name without its numbers counts as one.
    """

    def __init__(self, world: World) -> None:
        domain = world.task.problem.domain
        self.parameters = {a.name: tuple(p.types for p in a.parameters) for a in domain.actions}
        self.world = world
        roles = {t for types in self.parameters.values() for wanted in types for t in wanted} | {OBJECT}
        self.kinds: dict[str, tuple[str, ...]] = {}
        for name, types in world.mentions.types.items():
            own = [kind for kind in types if kind not in roles and name not in world.profiles.constants]
            self.kinds[name] = tuple(dict.fromkeys([*own, _DIGITS.sub("", name)]))
        self.of_kind: dict[str, list[str]] = {}
        for name, kinds in self.kinds.items():
            for kind in kinds:
                self.of_kind.setdefault(kind, []).append(name)

    def primary(self, instruction: Instruction) -> tuple[str, ...]:
        """The nearest kind of each argument."""
        return tuple(self.kinds[arg][0] for arg in instruction.args)

    def well_formed(self, instruction: Instruction) -> bool:
        """Whether there is such an action, with so many parameters of such types, and nothing is named twice."""
        types = self.parameters.get(instruction.name)
        if types is None or len(types) != len(instruction.args) or len(set(instruction.args)) < len(types):
            return False
        return all(self.world.objects.is_a(a, t) for a, t in zip(instruction.args, types, strict=True))

    def is_constant(self, name: str) -> bool:
        """Whether ``name`` is a word of the domain (``on``, ``high``) rather than something that lies about."""
        return name in self.world.profiles.constants


@dataclass(frozen=True, slots=True)
class Syntax:
    """What training sequences look like.

    Attributes:
        shapes: Every action with the kinds of arguments it was seen with, sorted.
        needs: For each action and argument place, the actions that (almost) always named the argument before.
        longest: The greatest length of a sequence for one clause.
    """

    shapes: tuple[tuple[str, tuple[str, ...]], ...]
    needs: Mapping[tuple[str, int], tuple[str, ...]]
    longest: int

    def menu(self, things: KnownObjects) -> list[Instruction]:
        """The instructions of an environment that have a seen shape, sorted."""
        found: set[Instruction] = set()
        for name, kinds in self.shapes:
            for args in product(*(things.of_kind.get(kind, ()) for kind in kinds)):
                found.add(Instruction(name, args))
        return sorted(i for i in found if things.well_formed(i))

    def about(self, things: KnownObjects, mentioned: Collection[str]) -> list[Instruction]:
        """The well-formed instructions about ``mentioned`` objects alone, seen or not, sorted.

        Places for words of the domain (relations, settings) take those seen there.
        """
        words: dict[tuple[str, int], dict[str, None]] = {}
        for name, kinds in self.shapes:
            for place, kind in enumerate(kinds):
                if kind in things.kinds and things.is_constant(kind):
                    words.setdefault((name, place), {})[kind] = None
        found: set[Instruction] = set()
        for name in sorted({name for name, _ in self.shapes} & set(things.parameters)):
            places = range(len(things.parameters[name]))
            for args in product(*(words.get((name, place), mentioned) for place in places)):
                found.add(Instruction(name, args))
        return sorted(i for i in found if things.well_formed(i))


def learn_syntax(
    sequences: Iterable[tuple[KnownObjects, Sequence[Sequence[Instruction]]]], *, certain: float, cover: float
) -> Syntax:
    """Learn the constraints.

    Args:
        sequences: The sequences of each demonstration, clause by clause, of well-formed instructions.
        certain: From which share on what went before counts as needed.
        cover: Which share of the clauses is not longer than ``longest``.
    """
    shapes: set[tuple[str, tuple[str, ...]]] = set()
    seen: Counter[tuple[str, int]] = Counter()
    before: Counter[tuple[str, int, str]] = Counter()
    lengths = []
    for things, clauses in sequences:
        named: dict[str, set[str]] = {}
        for clause in clauses:
            lengths.append(len(clause))
            for instruction in clause:
                kinds = [{things.kinds[arg][0], things.kinds[arg][-1]} for arg in instruction.args]
                shapes.update((instruction.name, args) for args in product(*kinds))
                for place, arg in enumerate(instruction.args):
                    if not things.is_constant(arg):
                        seen[instruction.name, place] += 1
                        before.update((instruction.name, place, name) for name in named.get(arg, ()))
                for arg in instruction.args:
                    named.setdefault(arg, set()).add(instruction.name)
    needs: dict[tuple[str, int], tuple[str, ...]] = {}
    for name, place, earlier in sorted(before):
        if before[name, place, earlier] >= certain * seen[name, place]:
            needs[name, place] = (*needs.get((name, place), ()), earlier)
    lengths.sort()
    longest = lengths[min(int(cover * len(lengths)), len(lengths) - 1)] if lengths else 0
    return Syntax(tuple(sorted(shapes)), needs, longest)


Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

STOP = Instruction("")
"""The end of a clause's sequence: one more choice at each step."""
EARLIER, POSSIBLE, MENTIONED, FIRST = 1, 2, 3, 4
"""How far a clause mentions an object: a clause before does; a weaker reading of a noun; a noun; its first noun."""
_LEVELS = 5
_NAMED, _JUST_NAMED = 1, 2
_RECENCIES = 3
_POSITIONS = 6
"""Positions in a sequence that are told apart; later ones are alike."""
_MET = 4
"""How much of what a clause mentions was named: it mentions nothing; nothing was; some; all."""
REALS = 2
"""The features that are numbers: the share of instructions that are no repeats, and (of STOP) the length so far."""
_WHERE = 3
"""Places of a clause in its text that are told apart: the first, the last, between."""
_BEGUN = 4
"""Numbers of instructions of the clause so far that are told apart with each action; more are alike."""
_LENGTHS = 13
"""The same for the end of the sequence."""
_REPEATS = 6
"""How often an instruction was done (never, once, more often), in this clause or before it."""
_APPLIES, _CHANGES, _UNKNOWN = 1, 2, 3
_EFFECTS = 4
"""What an instruction would do now: it does not apply; it changes nothing; it changes something; it never applies."""
_TABLE_RIDGE, _TEXT_RIDGE = 3.0, 12.0
"""How much more the squared weights of words count in a grounded policy than those of its other features.

There are a hundred times as many of them. By the likelihood of folds of VEIL-500's training environments.
"""


def properties(choice: Instruction, things: KnownObjects) -> list[tuple[str, ...]]:
    """What the words can go with: the action, its arguments' kinds and names, and all kinds together."""
    found: list[tuple[str, ...]] = [(choice.name,)]
    for place, arg in enumerate(choice.args):
        found += [(choice.name, str(place), kind) for kind in (*things.kinds[arg], arg)]
        if not things.is_constant(arg):
            found += [("", kind) for kind in things.kinds[arg]]
    if len(choice.args) > 1:
        found.append((choice.name, *things.primary(choice)))
    return list(dict.fromkeys(found))


def followers(before: Instruction | None, position: int, things: KnownObjects) -> list[str]:
    """The words that stand for the sequence so far: the instruction before (with its kinds), and the position."""
    found = [f"at {min(position, _POSITIONS)}"]
    if before is not None:
        found.append(f"after {before.name}")
        found += [f"after {before.name} {place} {things.kinds[arg][-1]}" for place, arg in enumerate(before.args)]
    return found


@dataclass(frozen=True, slots=True)
class ClauseContext:
    """What a text says, seen from one of its clauses.

    Attributes:
        words: The numbers of the clause's words.
        text: The numbers of the words of the whole text.
        levels: How far the clause mentions each thing of the menu (0 not at all), with a last 0 for no thing.
        later: 1 for each thing that a clause to come mentions.
        where: 0 for the first clause of the text, 2 for the last one, 1 for those between.
    """

    words: Ints
    text: Ints
    levels: Ints
    later: Ints
    where: int


class Node(NamedTuple):
    """A node of the tree: what was chosen for earlier clauses, and for this one."""

    earlier: tuple[Instruction, ...] = ()
    own: tuple[Instruction, ...] = ()


class WeightBlocks(NamedTuple):
    """The weights, part by part.

    Attributes:
        local: Words × properties, for the words of the clause and those of the sequence so far.
        text: The same for the words of the whole text; ``None`` where the policy is not grounded.
        paired: What is met or not.
        facts: Places × facts.
        reals: The features that are numbers.
    """

    local: Floats
    text: Floats | None
    paired: Floats
    facts: Floats
    reals: Floats


class Features:
    """The numbering of all features, in sorted order of their names.

    Args:
        words: The words of the training clauses, with those of :func:`followers`.
        seen: The :func:`properties` of the training instructions.
        syntax: The constraints.
        facts: What may hold of a thing: a predicate and the place of the thing. Without any the policy knows no states,
            no words but the clause's and nothing of what is still to come, as the paper's baseline.

    Attributes:
        words: The numbers of the words.
        properties: The numbers of the properties.
        actions: The numbers of the actions, STOP among them.
        places: The numbers of the argument places.
        arity: The greatest number of arguments.
        facts: The numbers of the facts.
        starts: Where each block of the paired features begins, counted from the first of them.
        shape: Words × properties: the matrix that comes first. A grounded policy has a second one for the whole text.
        size: How many features there are: the matrices, the paired ones, places × facts, and :data:`REALS`.
    """

    def __init__(
        self,
        words: Iterable[str],
        seen: Iterable[tuple[str, ...]],
        syntax: Syntax,
        facts: Iterable[tuple[str, int]] = (),
    ) -> None:
        self.syntax = syntax
        self.facts = {fact: number for number, fact in enumerate(sorted(set(facts)))}
        self.words = {word: number for number, word in enumerate(sorted(set(words)))}
        self.properties = {name: number for number, name in enumerate(sorted({*seen, (STOP.name,)}))}
        self.actions = {n: i for i, n in enumerate(sorted({STOP.name, *(name for name, _ in syntax.shapes)}))}
        places = {(name, place) for name, kinds in syntax.shapes for place in range(len(kinds))}
        self.places = {key: number for number, key in enumerate(sorted(places))}
        self.arity = max((len(kinds) for _, kinds in syntax.shapes), default=0)
        # one more place stands for "no such argument", one more action for "none before"
        n, p = len(self.actions), len(self.places) + 1
        blocks = [p * _LEVELS, p * _RECENCIES, p * (n + 1), (n + 1) * n * 2, n * 2, 1 + _MET]
        if self.facts:
            blocks += [p * _LEVELS * _RECENCIES, p * 4, (n + 1) * (n + 1) * n, n * _REPEATS, n * _WHERE * _BEGUN]
            blocks += [n * _EFFECTS, n * _MET, 1 + _MET * _WHERE * _LENGTHS]
        self.starts = np.cumsum((0, *blocks))
        self.shape = (len(self.words), len(self.properties))
        matrix = len(self.words) * len(self.properties)
        parts = (matrix, matrix if self.facts else 0, int(self.starts[-1]), p * len(self.facts), REALS)
        self._ends = np.cumsum(parts).tolist()
        self.size: int = self._ends[-1]

    def parts(self, theta: Floats) -> WeightBlocks:
        """Views of the weights (or of anything of their size), part by part."""
        local, text, paired, facts, reals = np.split(theta, self._ends[:-1])
        places = len(self.places) + 1
        whole = text.reshape(self.shape) if self.facts else None
        return WeightBlocks(local.reshape(self.shape), whole, paired, facts.reshape(places, len(self.facts)), reals)

    def ridge(self) -> Floats:
        """How much the square of each weight counts: alike in the paper's baseline."""
        found: Floats = np.ones(self.size)
        parts = self.parts(found)
        if parts.text is not None:
            parts.local[:] = _TABLE_RIDGE
            parts.text[:] = _TEXT_RIDGE
        return found

    def known(self, words: Iterable[str]) -> Ints:
        """The numbers of those words that training had."""
        return np.array(sorted({self.words[w] for w in words if w in self.words}), np.int64)


_FACT_PLACES = 2
"""What an atom says of its first two arguments is looked at; a third one is mostly a word of the domain."""
_REMEMBERED = 5_000
"""States and sequences that a menu keeps at most."""


class Seen(NamedTuple):
    """A state as the features see it.

    Attributes:
        effects: C, what each choice would do (:data:`_EFFECTS`).
        facts: (things + 1) × facts, 1 where one holds of a thing.
    """

    effects: Ints
    facts: Floats


class Menu:
    """The C instructions to choose from in one environment, STOP last, as arrays.

    Attributes:
        choices: The instructions.
        index: Their numbers.
        things: The environment.
        numbers: The number of each thing; one more stands for none.
        properties: C × properties, 1 where an instruction has one.
        having: C × the most that one has, their numbers; where it has fewer, the number after the last property.
        actions: C, the actions.
        args: C × arity, the things that are named.
        places: C × arity, the places they are named in.
        needs: Rows (choice, action, thing): the choice needs that the action named the thing before.
        words: Things, 1 where one is a word of the domain, and for no thing.
    """

    def __init__(self, features: Features, things: KnownObjects, choices: Sequence[Instruction]) -> None:
        self.features = features
        self.things = things
        self.choices = (*choices, STOP)
        self.index = {choice: number for number, choice in enumerate(self.choices)}
        self.numbers = {name: number for number, name in enumerate(things.kinds)}
        count = len(self.choices)
        self.properties: Floats = np.zeros((count, len(features.properties)))
        own: list[list[int]] = []
        self.actions: Ints = np.array([features.actions[choice.name] for choice in self.choices], np.int64)
        self.args: Ints = np.full((count, features.arity), len(self.numbers), np.int64)
        self.places: Ints = np.full((count, features.arity), len(features.places), np.int64)
        needs = []
        for row, choice in enumerate(self.choices):
            having = [features.properties[p] for p in properties(choice, things) if p in features.properties]
            self.properties[row, having] = 1
            own.append(having)
            for place, arg in enumerate(choice.args):
                key = (choice.name, place)
                self.args[row, place] = self.numbers[arg]
                self.places[row, place] = features.places[key]
                needs += [(row, features.actions[n], self.numbers[arg]) for n in features.syntax.needs.get(key, ())]
        most = max(map(len, own))
        self.having: Ints = np.array([[*row, *[len(features.properties)] * (most - len(row))] for row in own], np.int64)
        self.needs: Ints = np.array(needs, np.int64).reshape(-1, 3)
        self.words: Mask = np.array([*(things.is_constant(name) for name in things.kinds), True])
        self._task = things.world.task
        self._operators = [self._task.by_instruction.get(choice) for choice in self.choices]
        self._reached: dict[tuple[Instruction, ...], Bits] = {(): self._task.init}
        self._seen: dict[Bits, Seen] = {}
        if features.facts:
            self._prepare_states()

    def _prepare_states(self) -> None:
        """The bits of all operators and facts as rows of words, so that a state is compared with all at once."""
        operators = [operator for operator in self._operators if operator is not None]
        self._possible: Ints = np.flatnonzero([operator is not None for operator in self._operators])
        self._positive = self._rows(operator.precondition.positive for operator in operators)
        self._negative = self._rows(operator.precondition.negative for operator in operators)
        self._adds = self._rows(operator.add for operator in operators)
        self._deletes = self._rows(operator.delete & ~operator.add for operator in operators)
        self._special = [i for i, operator in enumerate(operators) if operator.forbidden or operator.conditional]
        self._special_operators = [operators[i] for i in self._special]
        masks: Counter[tuple[int, int]] = Counter()
        for bit, atom in enumerate(self._task.atoms):
            for place, name in enumerate(atom.args[:_FACT_PLACES]):
                fact = self.features.facts.get((atom.predicate, place))
                if name in self.numbers and fact is not None:
                    masks[self.numbers[name], fact] += 1 << bit
        self._about = tuple(np.array(list(masks), np.int64).reshape(-1, 2).T)
        self._masks = self._rows(masks.values())

    def _rows(self, sets: Iterable[Bits]) -> NDArray[np.uint64]:
        """Bit sets as rows of words of 64 bits."""
        length = 8 * (len(self._task.atoms) // 64 + 1)
        return np.frombuffer(b"".join(s.to_bytes(length, "little") for s in sets), np.uint64).reshape(-1, length // 8)

    def seen_after(self, sequence: tuple[Instruction, ...]) -> Seen:
        """The state that a sequence leads to, as the features see it; what can never apply changes nothing."""
        state = self._state(sequence)
        known = self._seen.get(state)
        if known is None:
            (row,) = self._rows([state])
            applies = ~((self._positive & ~row) | (self._negative & row)).any(axis=1)
            changes = ((self._adds & ~row) | (self._deletes & row)).any(axis=1)
            for i, operator in zip(self._special, self._special_operators, strict=True):
                applies[i] = applies[i] and operator.applicable(state)
                changes[i] = applies[i] and operator.apply(state) != state
            effects: Ints = np.full(len(self.choices), _UNKNOWN, np.int64)
            effects[self._possible] = np.where(applies, np.where(changes, _CHANGES, _APPLIES), 0)
            facts: Floats = np.zeros((len(self.numbers) + 1, len(self.features.facts)))
            facts[self._about] = (self._masks & row).any(axis=1)
            if len(self._seen) == _REMEMBERED:
                self._seen.clear()
            known = self._seen[state] = Seen(effects, facts)
        return known

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


@dataclass(frozen=True, slots=True)
class Steps:
    """H choices that are looked at together: the steps of one sequence, or the open nodes of a search.

    Attributes:
        menu: What there is to choose from.
        said: What the text says.
        followers: For each node the numbers of the words that stand for its sequence.
        pairs: H × C × Q, the numbers of the paired features.
        facts: H × (things + 1) × facts, what holds of things.
        reals: H × C × 2, the features that are numbers.
        allowed: H × C, what the constraints allow.
    """

    menu: Menu
    said: ClauseContext
    followers: tuple[Ints, ...]
    pairs: Ints
    facts: Floats
    reals: Floats
    allowed: Mask


def steps(menu: Menu, said: ClauseContext, nodes: Sequence[Node]) -> Steps:
    """The features of every choice at each node.

    Args:
        menu: The choices.
        said: What the text says.
        nodes: The nodes.
    """
    looks = [_look(menu, said, node) for node in nodes]
    added, pairs, facts, reals, allowed = zip(*looks, strict=True)
    return Steps(menu, said, tuple(added), np.stack(pairs), np.stack(facts), np.stack(reals), np.stack(allowed))


def _look(menu: Menu, said: ClauseContext, node: Node) -> tuple[Ints, Ints, Floats, Floats, Mask]:
    """One node's part of :class:`Steps`."""
    features, none = menu.features, len(menu.numbers)
    n = len(features.actions)
    recent: Ints = np.zeros(none + 1, np.int64)
    last: Ints = np.full(none + 1, n, np.int64)
    named: Mask = np.zeros((n, none + 1), np.bool_)
    # an action that training never had tells nothing
    sequence = [instruction for instruction in node.earlier + node.own if instruction.name in features.actions]
    for instruction in sequence:
        action, args = features.actions[instruction.name], [menu.numbers[arg] for arg in instruction.args]
        recent[args], last[args], named[action, args] = _NAMED, action, True
    before = sequence[-1] if sequence else None
    if before is not None:
        recent[[menu.numbers[arg] for arg in before.args]] = _JUST_NAMED
    done: Ints = np.zeros(len(menu.choices), np.int64)
    done[[menu.index[i] for i in node.own if i in menu.index]] = 1

    follows = features.actions[before.name] if before is not None else n
    goes_on = (recent[menu.args] == _JUST_NAMED).any(axis=1)
    start, levels = features.starts, said.levels
    met = _met(menu, levels, node.own)
    last_column = np.full(len(menu.choices), start[5])
    last_column[-1] += 1 + met
    columns = [
        start[0] + menu.places * _LEVELS + levels[menu.args],
        start[1] + menu.places * _RECENCIES + recent[menu.args],
        start[2] + menu.places * (n + 1) + last[menu.args],
        start[3] + (follows * n + menu.actions) * 2 + goes_on,
        start[4] + menu.actions * 2 + done,
        last_column,
    ]
    facts = _NO_FACTS
    if features.facts:
        seen = menu.seen_after(node.earlier + node.own)
        facts = seen.facts
        times: Ints = np.zeros(len(menu.choices), np.int64)
        for instruction in sequence:
            if instruction in menu.index:
                times[menu.index[instruction]] += 1
        recent[menu.words] = 0
        earlier = features.actions[sequence[-2].name] if len(sequence) > 1 else n
        begun, where = min(len(node.own), _BEGUN - 1), said.where
        end = np.full(len(menu.choices), start[13])
        end[-1] += 1 + (met * _WHERE + where) * _LENGTHS + min(len(node.own), _LENGTHS - 1)
        told = levels[menu.args]
        columns += [
            start[6] + (menu.places * _LEVELS + told) * _RECENCIES + recent[menu.args],
            start[7] + menu.places * 4 + said.later[menu.args] * 2 + (told > 0),
            start[8] + (earlier * (n + 1) + follows) * n + menu.actions,
            start[9] + menu.actions * _REPEATS + np.minimum(times, 2) * 2 + done,
            start[10] + (menu.actions * _WHERE + where) * _BEGUN + begun,
            start[11] + menu.actions * _EFFECTS + seen.effects,
            start[12] + menu.actions * _MET + met,
            end,
        ]
    length, different = len(node.own), len(set(node.own))
    reals: Floats = np.zeros((len(menu.choices), REALS))
    reals[:, 0] = (different + 1 - done) / (length + 1)
    reals[-1] = different / length if length else 1, length / max(features.syntax.longest, 1)
    choice, action, thing = menu.needs.T
    allowed: Mask = np.ones(len(menu.choices), np.bool_)
    allowed[choice[~named[action, thing]]] = False
    return features.known(followers(before, length, menu.things)), np.column_stack(columns), facts, reals, allowed


_NO_FACTS: Floats = np.zeros((0, 0))


def _met(menu: Menu, levels: Ints, own: Sequence[Instruction]) -> int:
    """How much of what the clause mentions its sequence has named."""
    about = set(np.flatnonzero(levels >= MENTIONED).tolist())
    met = about & {menu.numbers[arg] for instruction in own for arg in instruction.args}
    return 1 + bool(met) + (met == about) if about else 0


_BATCH = 8
"""Sequences between two steps of the ascent."""
_SMALL = 1e-6


class Made(NamedTuple):
    """A sequence of the training data: its steps, and the number of the choice that was made at each."""

    at: Steps
    choices: Ints


def log_probabilities(features: Features, theta: Floats, at: Steps) -> Floats:
    """Give ln P(instruction | words, sequence so far), H × C: exp(θ·φ), normalised over the choices allowed."""
    parts, menu = features.parts(theta), at.menu
    words = parts.local[at.said.words].sum(axis=0)
    if parts.text is not None:
        words = words + _share(at.said) * parts.text[at.said.text].sum(axis=0)
    rows = words + np.stack([parts.local[words].sum(axis=0) for words in at.followers])
    # an instruction has few of the many properties: a product of matrices would take ten times as long
    padded = np.pad(rows, ((0, 0), (0, 1)))
    reward = padded[:, menu.having].sum(axis=2) + parts.paired[at.pairs].sum(axis=2) + at.reals @ parts.reals
    if features.facts:
        worth = at.facts @ parts.facts.T  # H × (things + 1) × places
        reward += worth[:, menu.args, menu.places].sum(axis=2)
    reward[~at.allowed] = -np.inf
    reward -= reward.max(axis=1, keepdims=True)
    logs: Floats = reward - np.log(np.exp(reward).sum(axis=1, keepdims=True))
    return logs


def _share(said: ClauseContext) -> float:
    """What each word of the whole text counts: a long text has many that tell little."""
    return 1.0 / float(np.sqrt(max(len(said.text), 1)))


def likelihood(features: Features, theta: Floats, data: Sequence[Made], gradient: Floats | None = None) -> float:
    """The log-likelihood of the choices made. Its gradient is added to ``gradient``."""
    total = 0.0
    for at, choices in data:
        rows = np.arange(len(choices))
        logs = log_probabilities(features, theta, at)
        total += float(logs[rows, choices].sum())
        if gradient is None:
            continue
        # the features that were met, less those that were to be expected
        rest = -np.exp(logs)
        rest[rows, choices] += 1
        parts, menu = features.parts(gradient), at.menu
        having = rest @ menu.properties
        parts.local[at.said.words] += having.sum(axis=0)
        if parts.text is not None:
            parts.text[at.said.text] += _share(at.said) * having.sum(axis=0)
        for words, row in zip(at.followers, having, strict=True):
            parts.local[words] += row
        weights = np.repeat(rest.ravel(), at.pairs.shape[2])
        parts.paired[:] += np.bincount(at.pairs.ravel(), weights, minlength=len(parts.paired))
        parts.reals[:] += np.einsum("hc,hcr->r", rest, at.reals)
        if features.facts:
            things = len(menu.numbers) + 1
            cells = (menu.places * things + menu.args).ravel()
            for row, facts in zip(rest, at.facts, strict=True):
                named = np.bincount(cells, np.repeat(row, menu.args.shape[1]), minlength=len(parts.facts) * things)
                parts.facts[:] += named.reshape(len(parts.facts), things) @ facts
    return total


def ascend(
    features: Features,
    data: Sequence[Made],
    random: np.random.Generator,
    *,
    rounds: int,
    rate: float,
    ridge: float,
    tell: Callable[[float], None] | None = None,
) -> Floats:
    """The weights θ by stochastic gradient ascent, with the step sizes of AdaGrad, from zero.

    What is raised is the log-likelihood less ridge/2 · Σ r θ², with r of :meth:`Features.ridge`. ``tell`` is told which
    share of the work is done.
    """
    each = ridge * features.ridge()
    theta: Floats = np.zeros(features.size)
    squares: Floats = np.full(features.size, _SMALL)
    for done in range(rounds):
        order = random.permutation(len(data)).tolist()
        for start in range(0, len(order), _BATCH):
            if tell is not None:
                tell((done + start / len(order)) / rounds)
            part = [data[number] for number in order[start : start + _BATCH]]
            gradient: Floats = theta * each * (-len(part) / len(data))
            likelihood(features, theta, part, gradient)
            squares += gradient**2
            theta += rate * gradient / np.sqrt(squares)
    return theta


_WORD = re.compile(r"[a-z0-9']+")
_ROUNDED = 9
"""Rewards are rounded before they are compared, so that equal ones stay equal whatever the order of a sum."""
_NO_STATE = 0
MOST = 12.0
"""The surprise of what training makes impossible."""


@dataclass(frozen=True, slots=True)
class Reward:
    """What is learned of one kind of world.

    Attributes:
        features: The features, with the syntactical constraints.
        theta: Their weights.
        before: The mean log-likelihood of a training choice with all weights zero.
        after: The same with the weights learned.
    """

    features: Features
    theta: Floats
    before: float
    after: float


class Policy:
    """A learned reward in one environment.

    Args:
        reward: What was learned.
        world: The environment.
        grounded: Whether the reward knows which objects the clause's nouns may mean; as it was learned.
        beam: How many sequences of a length are looked at further.
        bonus: Reward for each instruction. The likeliest sequence is shorter than the usual one; this makes up.
        slack: A sequence is given up when its reward is this much below that of the best complete one.
    """

    def __init__(
        self,
        reward: Reward,
        world: World,
        *,
        grounded: bool = True,
        beam: int = 5,
        bonus: float = 0.5,
        slack: float = 3.0,
    ) -> None:
        things = KnownObjects(world)
        self.reward = reward
        self.menu = Menu(reward.features, things, reward.features.syntax.menu(things))
        self.grounded = grounded
        self.beam = beam
        self.bonus = bonus
        self.slack = slack
        self._last: tuple[tuple[object, ...], tuple[Menu, ClauseContext]] | None = None

    def knows(self, verb: str) -> bool:
        """Whether it was learned from demonstrations with that verb."""
        return _verb(verb) in self.reward.features.words

    def best(
        self, clauses: Sequence[VerbClause], number: int, done: Sequence[Instruction], count: int = 1
    ) -> list[tuple[float, tuple[Instruction, ...]]]:
        """The ``count`` sequences of the greatest reward for a clause, by beam search, greatest first.

        Args:
            clauses: The clauses of the text.
            number: Which of them it is, counted from 0.
            done: The instructions that were chosen for those before it.
            count: How many are wanted; at least one is found, perhaps the empty one.
        """
        features = self.reward.features
        menu, said = self._read(clauses, number)
        found: list[tuple[float, tuple[Instruction, ...]]] = []
        beam: list[tuple[float, tuple[Instruction, ...]]] = [(0.0, ())]
        for _ in range(features.syntax.longest + 1):
            at = steps(menu, said, [Node(tuple(done), own) for _, own in beam])
            logs = np.round(log_probabilities(features, self.reward.theta, at), _ROUNDED)
            longer = []
            for (total, own), row in zip(beam, logs, strict=True):
                found.append((float(total + row[-1]), own))
                following = np.argsort(-row[:-1], kind="stable")[: self.beam].tolist()
                longer += [
                    (round(total + float(row[i]) + self.bonus, _ROUNDED), (*own, menu.choices[i])) for i in following
                ]
            found = sorted(found, key=lambda node: -node[0])[:count]
            worst = found[-1][0] if len(found) == count else -np.inf
            longer.sort(key=lambda node: -node[0])
            beam = [node for node in longer[: self.beam] if node[0] >= worst - self.slack and np.isfinite(node[0])]
            if not beam:
                break
        return found

    def sample(
        self, clauses: Sequence[VerbClause], count: int, random: np.random.Generator
    ) -> list[tuple[tuple[Instruction, ...], ...]]:
        """``count`` sequences for a whole text, drawn from the distribution, clause by clause; some may be alike."""
        drawn: list[tuple[tuple[Instruction, ...], ...]] = [()] * count
        before: list[tuple[Instruction, ...]] = [()] * count
        for number in range(len(clauses)):
            own = self._sampled(clauses, number, before, random)
            drawn = [(*parts, part) for parts, part in zip(drawn, own, strict=True)]
            before = [(*earlier, *part) for earlier, part in zip(before, own, strict=True)]
        return drawn

    def _sampled(
        self,
        clauses: Sequence[VerbClause],
        number: int,
        before: Sequence[tuple[Instruction, ...]],
        random: np.random.Generator,
    ) -> list[tuple[Instruction, ...]]:
        """A sequence for one clause after each of those ``before``."""
        features = self.reward.features
        menu, said = self._read(clauses, number)
        own: list[tuple[Instruction, ...]] = [()] * len(before)
        going = list(range(len(before)))
        for _ in range(features.syntax.longest):
            nodes = list(dict.fromkeys(Node(before[i], own[i]) for i in going))
            shares = np.exp(log_probabilities(features, self.reward.theta, steps(menu, said, nodes))).cumsum(axis=1)
            sums = dict(zip(nodes, np.round(shares / shares[:, -1:], _ROUNDED), strict=True))
            still = []
            for i, draw in zip(going, random.random(len(going)).tolist(), strict=True):
                row = int(np.searchsorted(sums[Node(before[i], own[i])], draw, side="right"))
                choice = menu.choices[min(row, len(menu.choices) - 1)]
                if choice != STOP:
                    own[i] = (*own[i], choice)
                    still.append(i)
            going = still
            if not going:
                break
        return own

    def surprise(
        self,
        clauses: Sequence[VerbClause],
        number: int,
        done: Sequence[Instruction],
        instructions: Sequence[Instruction],
    ) -> float:
        """The mean of -ln P over ``instructions`` and the end of the sequence; each is at most :data:`MOST`."""
        menu, said = self._read(clauses, number)
        own = tuple(instructions)
        nodes = [Node(tuple(done), own[:length]) for length in range(len(own) + 1)]
        logs = log_probabilities(self.reward.features, self.reward.theta, steps(menu, said, nodes))
        each = [
            min(MOST, -float(logs[row, menu.index[choice]])) if choice in menu.index else MOST
            for row, choice in enumerate((*own, STOP))
        ]
        return round(sum(each) / len(each), _ROUNDED)

    def _read(self, clauses: Sequence[VerbClause], number: int) -> tuple[Menu, ClauseContext]:
        """The choices, and what the text says there; that of the last clause is remembered."""
        key = (number, *((c.text, c.verb, c.resolved()) for c in clauses))
        last = self._last
        if last is None or last[0] != key:
            last = self._last = key, self._reading(clauses, number)
        return last[1]

    def _reading(self, clauses: Sequence[VerbClause], number: int) -> tuple[Menu, ClauseContext]:
        said = said_in(clauses, number, self.menu, grounded=self.grounded)
        return (_with_mentioned(self.menu, said.levels) if self.grounded else self.menu), said


def said_in(clauses: Sequence[VerbClause], number: int, menu: Menu, *, grounded: bool) -> ClauseContext:
    """What a text says, seen from one of its clauses."""
    features, things, clause = menu.features, menu.things, clauses[number]
    words = features.known(bag(clause, grounded=grounded))
    if not grounded:
        return ClauseContext(words, words, nothing(things), nothing(things), 0)
    where = 0 if number == 0 else 2 if number == len(clauses) - 1 else 1
    text = features.known(word for each in clauses for word in bag(each, grounded=True))
    later = nothing(things)
    numbers = {name: place for place, name in enumerate(things.kinds)}
    for noun in (noun for each in clauses[number + 1 :] for noun in each.resolved()):
        matches = things.world.mentions.of(noun, _NO_STATE)
        later[[numbers[match.name] for match in matches if match.score == matches[0].score]] = 1
    return ClauseContext(words, text, mentioned(clause, clauses[:number], things), later, where)


def bag(clause: VerbClause, *, grounded: bool) -> list[str]:
    """The words of a clause, its verb, and one that every clause has; ``grounded`` with what its pronouns stand for."""
    resolved = clause.resolved() if grounded else ()
    return ["", *_WORD.findall(clause.text.lower()), _verb(clause.verb), *resolved]


def _verb(verb: str) -> str:
    """The word that stands for a clause's verb: no word of a text is like it."""
    return f"verb {verb}"


def nothing(things: KnownObjects) -> Ints:
    """The levels of :func:`mentioned` where nothing is."""
    levels: Ints = np.zeros(len(things.kinds) + 1, np.int64)
    return levels


def mentioned(clause: VerbClause, earlier: Sequence[VerbClause], things: KnownObjects) -> Ints:
    """How far each thing is mentioned (0 not at all), by the evidence of words alone; with a last 0 for no thing."""
    numbers = {name: number for number, name in enumerate(things.kinds)}
    levels: Ints = np.zeros(len(numbers) + 1, np.int64)

    def mark(noun: str, likeliest: int, others: int) -> None:
        matches = things.world.mentions.of(noun, _NO_STATE)
        for match in matches:
            level = likeliest if match.score == matches[0].score else others
            levels[numbers[match.name]] = max(levels[numbers[match.name]], level)

    for before in earlier:
        for noun in before.resolved():
            mark(noun, EARLIER, 0)
    for place, noun in enumerate(clause.resolved()):
        mark(noun, MENTIONED if place else FIRST, POSSIBLE)
    return levels


def _with_mentioned(menu: Menu, levels: Ints) -> Menu:
    """The menu, with instructions of no seen shape about what the clause mentions."""
    names = list(menu.things.kinds)
    about = [names[number] for number in np.flatnonzero(levels >= POSSIBLE)]
    more = set(menu.features.syntax.about(menu.things, about)) - set(menu.choices)
    return Menu(menu.features, menu.things, sorted({*menu.choices[:-1], *more})) if more else menu


RIDGE = 3.0
"""Weight of the squared weights of the paper's baseline."""
GROUNDED_RIDGE = 3.0
"""The same of a grounded policy for all but its words, chosen as those of its words were."""
_MANY = 100
"""Below so many demonstrations it is less, in proportion: what one or two of them show is imitated closely."""
_COVER = 0.99
"""This share of the training sequences is not longer than what is searched."""


class PolicyLesson(NamedTuple):
    """A demonstration as it is learned from: each clause (or none) with its well-formed instructions."""

    things: KnownObjects
    clauses: list[tuple[VerbClause | None, tuple[Instruction, ...]]]


def learn_policy(
    demonstrations: Iterable[Demonstration],
    world_of: Callable[[str], World],
    random: np.random.Generator,
    *,
    grounded: bool = True,
    certain: float = 0.95,
    rounds: int = 8,
    rate: float = 0.2,
    ridge: float | None = None,
    tell: Callable[[float], None] | None = None,
) -> Reward:
    """Learn the constraints, the features and their weights.

    A clause for which a demonstration has no instructions teaches nothing: most of them come from the alignment,
    which gives all that was done for a piece of text to one of its clauses.

    Args:
        demonstrations: The corpus.
        world_of: The world of an environment, by the environment's name.
        random: The order in which the data are gone through.
        grounded: Whether the reward also knows which objects the clause's nouns may mean.
        certain: From which share on what went before counts as needed (``learn_syntax``).
        rounds: How often the training data are gone through.
        rate: Step size of the ascent.
        ridge: Weight of the squared weights; by default :data:`RIDGE`, or where it is grounded :data:`GROUNDED_RIDGE`,
            less for few demonstrations.
        tell: Is told which share of the ascent, which takes the longest, is done.
    """
    lessons = study(demonstrations, world_of)
    sequences = [(lesson.things, [made for _, made in lesson.clauses]) for lesson in lessons]
    syntax = learn_syntax(sequences, certain=certain, cover=_COVER)
    features = number_features(lessons, syntax, grounded=grounded)
    menus: dict[KnownObjects, Menu] = {}
    data = []
    for lesson in lessons:
        if lesson.things not in menus:
            menus[lesson.things] = Menu(features, lesson.things, syntax.menu(lesson.things))
        data += steps_made(lesson, menus[lesson.things], grounded=grounded)
    if ridge is None:
        ridge = GROUNDED_RIDGE * min(1.0, len(lessons) / _MANY) if grounded else RIDGE
    theta = ascend(features, data, random, rounds=rounds, rate=rate, ridge=ridge, tell=tell)
    choices = max(sum(len(made.choices) for made in data), 1)
    before, after = (likelihood(features, weights, data) / choices for weights in (np.zeros_like(theta), theta))
    return Reward(features, theta, before, after)


def study(demonstrations: Iterable[Demonstration], world_of: Callable[[str], World]) -> list[PolicyLesson]:
    """What each demonstration shows, clause by clause, without instructions that are not well-formed."""
    known: dict[str, KnownObjects] = {}
    found = []
    for demonstration in demonstrations:
        place = demonstration.environment
        if place not in known:
            known[place] = KnownObjects(world_of(place))
        things = known[place]
        pairs: list[tuple[VerbClause | None, tuple[Instruction, ...]]] = [
            (lesson.clause, tuple(i for i in lesson.instructions if things.well_formed(i)))
            for lesson in lessons(demonstration, world_of(place), world_of(place).mentions.lexicon)
        ]
        found.append(PolicyLesson(things, pairs))
    return found


def number_features(lessons: Sequence[PolicyLesson], syntax: Syntax, *, grounded: bool) -> Features:
    """Number the features that the training data have."""
    words: set[str] = set()
    seen: set[tuple[str, ...]] = set()
    for things, clauses in lessons:
        before: Instruction | None = None
        for clause, made in clauses:
            words.update(bag(clause, grounded=grounded) if clause is not None else ())
            for position, instruction in enumerate(made):
                words.update(followers(before, position, things))
                seen.update(properties(instruction, things))
                before = instruction
            words.update(followers(before, len(made), things))
    atoms = [atom for things in {lesson.things for lesson in lessons} for atom in things.world.task.atoms]
    facts = {(atom.predicate, place) for atom in atoms for place in range(len(atom.args[:_FACT_PLACES]))}
    return Features(words, seen, syntax, facts if grounded else ())


def steps_made(lesson: PolicyLesson, menu: Menu, *, grounded: bool) -> list[Made]:
    """The sequence of each clause as choices from the menu, with the STOP at its end."""
    found = []
    done: tuple[Instruction, ...] = ()
    clauses = [clause for clause, _ in lesson.clauses if clause is not None]
    number = 0
    for clause, made in lesson.clauses:
        if clause is not None and made:
            nodes = [Node(done, made[:length]) for length in range(len(made) + 1)]
            at = steps(menu, said_in(clauses, number, menu, grounded=grounded), nodes)
            choices: Ints = np.array([menu.index[choice] for choice in (*made, STOP)], np.int64)
            # the constraints are only almost always kept; what was done was possible
            at.allowed[np.arange(len(choices)), choices] = True
            found.append(Made(at, choices))
        number += clause is not None
        done += made
    return found
