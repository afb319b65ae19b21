"""What a state says of one object: the vertex labels of its object graph, as comparable profiles.

A profile maps a *state name* to whether it holds. A state name is an atom about the object with the object taken
out: ``(contains mug1 water)`` is ``("contains", "water")`` of ``mug1``. The states of an object's parts belong to
its profile too, under the part's name. What never changes (an affordance, say) is part of the profile where it
holds. Atoms that relate two objects are no states; nor are the robot's own.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property

from tmd.pddl.model import GroundAtom
from tmd.pddl.task import Bits, Task

Profile = Mapping[tuple[str, ...], bool]

PART_OF = "part_of"


class Profiles:
    """Profiles of the objects of one task.

    Args:
        task: The ground problem; its fluent atoms are the states that an object can be in.
    """

    def __init__(self, task: Task) -> None:
        self.task = task
        problem = task.problem
        self.constants = frozenset(c.name for c in problem.domain.constants)
        self.objects = tuple(o.name for o in problem.objects if o.name not in self.constants)
        self._fluent = self._by_object(task.atoms)
        self._static = self._by_object(sorted(task.static))
        self._relevant: dict[str, Bits] = {}
        self._known: dict[tuple[str, Bits], Profile] = {}

    @cached_property
    def parts(self) -> dict[str, tuple[tuple[str, str], ...]]:
        """For every object its parts, as (the part's short name, the part)."""
        found: dict[str, list[tuple[str, str]]] = {}
        for atom in sorted(self.task.static):
            if atom.predicate == PART_OF and len(atom.args) == 2:
                part, whole = atom.args
                found.setdefault(whole, []).append((part.removeprefix(f"{whole}_"), part))
        return {whole: tuple(parts) for whole, parts in found.items()}

    @cached_property
    def wholes(self) -> dict[str, str]:
        """For every part the object it belongs to."""
        return {part: whole for whole, parts in self.parts.items() for _, part in parts}

    def unit(self, name: str) -> tuple[str, ...]:
        """``name``, and the object that it is a part of."""
        whole = self.wholes.get(name)
        return (name,) if whole is None else (name, whole)

    @cached_property
    def links(self) -> Mapping[tuple[str, str], frozenset[str]]:
        """The static relations between each two objects: which edges of the object graphs join them."""
        found: dict[tuple[str, str], set[str]] = {}
        for atom in self.task.static:
            ends = [a for a in atom.args if a not in self.constants]
            if len(ends) == 2 and ends[0] != ends[1]:
                found.setdefault((ends[0], ends[1]), set()).add(atom.predicate)
        return {pair: frozenset(predicates) for pair, predicates in found.items()}

    def of(self, name: str, state: Bits) -> Profile:
        """The profile of the object ``name`` in ``state``."""
        if name not in self._relevant:
            self._relevant[name] = self._atoms_of(name)
        key = name, state & self._relevant[name]
        known = self._known.get(key)
        if known is None:
            profile = self.own(name, state)
            for short, part in self.parts.get(name, ()):
                profile |= {(short, *k): value for k, value in self.own(part, state).items()}
            known = self._known[key] = profile
        return known

    def _atoms_of(self, name: str) -> Bits:
        """The atoms that the profile of ``name`` depends on."""
        bits = 0
        for thing in (name, *(part for _, part in self.parts.get(name, ()))):
            for atom, _ in self._fluent.get(thing, ()):
                bits |= 1 << self.task.index[atom]
        return bits

    def own(self, name: str, state: Bits) -> dict[tuple[str, ...], bool]:
        """The profile of ``name`` without that of its parts."""
        profile = {key: True for _, key in self._static.get(name, ())}
        for atom, key in self._fluent.get(name, ()):
            profile[key] = bool(state >> self.task.index[atom] & 1)
        return profile

    def containers(self, constant: str, state: Bits) -> list[str]:
        """The objects that have ``constant`` in a state of theirs now (*contains mug1 water*), in the problem's order.

        Only states that some action changes count: an affordance contains nothing.
        """
        found = self._about.get(constant, ())
        return list(dict.fromkeys(name for name, bit in found if bit is None or state >> bit & 1))

    @cached_property
    def _about(self) -> dict[str, list[tuple[str, int | None]]]:
        """For every constant the objects that may have it in a state, each with its atom; ``None`` is always true."""
        found: dict[str, list[tuple[str, int | None]]] = {}
        for name in self.objects:
            states = [(key, None) for _, key in self._static.get(name, ())]
            for key, bit in [*states, *((key, self.task.index[atom]) for atom, key in self._fluent.get(name, ()))]:
                if key[0] in self._changing:
                    for constant in dict.fromkeys(key[1:]):
                        found.setdefault(constant, []).append((name, bit))
        return found

    @cached_property
    def _changing(self) -> frozenset[str]:
        """The predicates that stand in some action's effect."""
        return frozenset(effect.atom.predicate for a in self.task.problem.domain.actions for effect in a.effects)

    def _by_object(self, atoms: Iterable[GroundAtom]) -> dict[str, list[tuple[GroundAtom, tuple[str, ...]]]]:
        found: dict[str, list[tuple[GroundAtom, tuple[str, ...]]]] = {}
        for atom in atoms:
            if not atom.args or atom.args[0] in self.constants:
                continue
            if all(a in self.constants for a in atom.args[1:]):
                found.setdefault(atom.args[0], []).append((atom, (atom.predicate, *atom.args[1:])))
        return found


def differences(one: Profile, other: Profile) -> float:
    """The share of the states of either object in which the two differ (Δ_env for one variable, section VI-A.1).

    A state that only one of them can have counts as a difference. 0 where neither has any.
    """
    names = one.keys() | other.keys()
    if not names:
        return 0.0
    return sum(one.get(name) != other.get(name) for name in names) / len(names)


def shared(one: Profile, other: Profile) -> int:
    """How many states the two have in common (rule 3 of section V-A)."""
    return sum(other.get(name) == value for name, value in one.items())
