"""The features of the instruction tree: of each instruction that may come next, for a clause and a sequence so far.

There are two groups. Words of the clause (and a few that stand for the sequence so far) meet properties of the
instruction: the bag of words, a matrix words × properties. The others tell how the instruction goes with what stands
before it and with what the clause mentions: bigrams, repeats, length. None of them reads a state.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tmd.pddl.model import OBJECT, Instruction
from tmd.veil.world import World

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


class Node(NamedTuple):
    """A node of the tree: what was chosen for earlier clauses, and for this one."""

    earlier: tuple[Instruction, ...] = ()
    own: tuple[Instruction, ...] = ()


class Features:
    """The numbering of all features, in sorted order of their names.

    Args:
        words: The words of the training clauses, with those of :func:`followers`.
        seen: The :func:`properties` of the training instructions.
        syntax: The constraints.

    Attributes:
        words: The numbers of the words.
        properties: The numbers of the properties.
        actions: The numbers of the actions, STOP among them.
        places: The numbers of the argument places.
        arity: The greatest number of arguments.
        starts: Where each block of the features after the matrix begins, counted from the matrix's end.
        size: How many features there are. The matrix comes first, the :data:`REALS` last.
    """

    def __init__(self, words: Iterable[str], seen: Iterable[tuple[str, ...]], syntax: Syntax) -> None:
        self.syntax = syntax
        self.words = {word: number for number, word in enumerate(sorted(set(words)))}
        self.properties = {name: number for number, name in enumerate(sorted({*seen, (STOP.name,)}))}
        self.actions = {n: i for i, n in enumerate(sorted({STOP.name, *(name for name, _ in syntax.shapes)}))}
        places = {(name, place) for name, kinds in syntax.shapes for place in range(len(kinds))}
        self.places = {key: number for number, key in enumerate(sorted(places))}
        self.arity = max((len(kinds) for _, kinds in syntax.shapes), default=0)
        # one more place stands for "no such argument", one more action for "none before"
        n, p = len(self.actions), len(self.places) + 1
        blocks = (p * _LEVELS, p * _RECENCIES, p * (n + 1), (n + 1) * n * 2, n * 2, 1 + _MET)
        self.starts = np.cumsum((0, *blocks))
        self.shape = (len(self.words), len(self.properties))
        self.size = len(self.words) * len(self.properties) + int(self.starts[-1]) + REALS

    def known(self, words: Iterable[str]) -> Ints:
        """The numbers of those words that training had."""
        return np.array(sorted({self.words[w] for w in words if w in self.words}), np.int64)


class Menu:
    """The C instructions to choose from in one environment, STOP last, as arrays.

    Attributes:
        choices: The instructions.
        index: Their numbers.
        things: The environment.
        numbers: The number of each thing; one more stands for none.
        properties: C × properties, 1 where an instruction has one.
        actions: C, the actions.
        args: C × arity, the things that are named.
        places: C × arity, the places they are named in.
        needs: Rows (choice, action, thing): the choice needs that the action named the thing before.
    """

    def __init__(self, features: Features, things: KnownObjects, choices: Sequence[Instruction]) -> None:
        self.features = features
        self.things = things
        self.choices = (*choices, STOP)
        self.index = {choice: number for number, choice in enumerate(self.choices)}
        self.numbers = {name: number for number, name in enumerate(things.kinds)}
        count = len(self.choices)
        self.properties: Floats = np.zeros((count, len(features.properties)))
        self.actions: Ints = np.array([features.actions[choice.name] for choice in self.choices], np.int64)
        self.args: Ints = np.full((count, features.arity), len(self.numbers), np.int64)
        self.places: Ints = np.full((count, features.arity), len(features.places), np.int64)
        needs = []
        for row, choice in enumerate(self.choices):
            having = [features.properties[p] for p in properties(choice, things) if p in features.properties]
            self.properties[row, having] = 1
            for place, arg in enumerate(choice.args):
                key = (choice.name, place)
                self.args[row, place] = self.numbers[arg]
                self.places[row, place] = features.places[key]
                needs += [(row, features.actions[n], self.numbers[arg]) for n in features.syntax.needs.get(key, ())]
        self.needs: Ints = np.array(needs, np.int64).reshape(-1, 3)


@dataclass(frozen=True, slots=True)
class Steps:
    """H choices that are looked at together: the steps of one sequence, or the open nodes of a search.

    Attributes:
        menu: What there is to choose from.
        words: The numbers of the clause's words.
        followers: For each node the numbers of the words that stand for its sequence.
        pairs: H × C × Q, the numbers of the other features.
        reals: H × C × 2, the features that are numbers.
        allowed: H × C, what the constraints allow.
    """

    menu: Menu
    words: Ints
    followers: tuple[Ints, ...]
    pairs: Ints
    reals: Floats
    allowed: Mask


def steps(menu: Menu, words: Ints, levels: Ints, nodes: Sequence[Node]) -> Steps:
    """The features of every choice at each node.

    Args:
        menu: The choices.
        words: The numbers of the clause's words.
        levels: How far the clause mentions each thing of the menu (0 not at all), with a last 0 for no thing.
        nodes: The nodes.
    """
    looks = [_look(menu, levels, node) for node in nodes]
    added, pairs, reals, allowed = zip(*looks, strict=True)
    return Steps(menu, words, tuple(added), np.stack(pairs), np.stack(reals), np.stack(allowed))


def _look(menu: Menu, levels: Ints, node: Node) -> tuple[Ints, Ints, Floats, Mask]:
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
    start = features.starts
    last_column = np.full(len(menu.choices), start[5])
    last_column[-1] += 1 + _met(menu, levels, node.own)
    pairs = np.column_stack(
        (
            start[0] + menu.places * _LEVELS + levels[menu.args],
            start[1] + menu.places * _RECENCIES + recent[menu.args],
            start[2] + menu.places * (n + 1) + last[menu.args],
            start[3] + (follows * n + menu.actions) * 2 + goes_on,
            start[4] + menu.actions * 2 + done,
            last_column,
        )
    )
    length, different = len(node.own), len(set(node.own))
    reals: Floats = np.zeros((len(menu.choices), REALS))
    reals[:, 0] = (different + 1 - done) / (length + 1)
    reals[-1] = different / length if length else 1, length / max(features.syntax.longest, 1)
    choice, action, thing = menu.needs.T
    allowed: Mask = np.ones(len(menu.choices), np.bool_)
    allowed[choice[~named[action, thing]]] = False
    return features.known(followers(before, length, menu.things)), pairs, reals, allowed


def _met(menu: Menu, levels: Ints, own: Sequence[Instruction]) -> int:
    """How much of what the clause mentions its sequence has named."""
    about = set(np.flatnonzero(levels >= MENTIONED).tolist())
    met = about & {menu.numbers[arg] for instruction in own for arg in instruction.args}
    return 1 + bool(met) + (met == about) if about else 0
