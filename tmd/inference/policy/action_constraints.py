"""Which instructions the instruction tree may try: the syntactical constraints of its row of Table II.

All of it is learned from how training sequences are written. No state and no precondition is read.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

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
