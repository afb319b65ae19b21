"""An environment, ready for grounding: the ground task, profiles of its objects, and the nouns that name them.

A profile has the labels of the vertices of an object's graph in a state. It maps a *state name* to whether it holds. A
state name is an atom about the object with the object taken out: ``(contains mug1 water)`` is ``("contains", "water")``
of ``mug1``. The states of an object's parts belong to its profile too, under the part's name. What never changes (an
affordance, say) is part of the profile where it holds. Atoms that relate two objects are not states; nor are the
robot's own.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from tmd.language.lexicon.lexicon import Lexicon, section
from tmd.language.lexicon.names import split_name
from tmd.language.lexicon.nouns import Match, NounMatch, rank
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.inferred_types import with_inferred_types
from tmd.pddl.model import OBJECT, TRUE, Domain, GroundAtom, Instruction, Problem, Universe, hierarchy, universe
from tmd.pddl.task import Bits, Task
from tmd.short_repr import short_repr
from tmd.world.compile import PART_OF as PART_OF  # goals and studio need it as well
from tmd.world.costs import with_costs
from tmd.world.verb_clause import VerbClause


@short_repr(lambda world: world.name)
@dataclass(frozen=True, eq=False, slots=True, weakref_slot=True)
class World:
    """An environment, ready for grounding.

    Attributes:
        domain: Its domain, with the types that preconditions imply where it declares none.
        objects: Its objects, by these types.
    """

    name: str
    task: Task
    domain: Domain
    objects: Universe
    profiles: Profiles
    mentions: Mentions


def make_world(
    name: str,
    problem: Problem,
    lexicon: Lexicon,
    kinds: Mapping[str, str] | None = None,
    costs: Mapping[str, int] | None = None,
) -> World:
    """Ground ``problem`` and prepare its objects and nouns.

    The goal and the metric of ``problem`` are dropped, because the request says what is wanted.

    ``kinds`` says what kind of thing an object is whose PDDL type says less than that; ``costs`` are those of actions,
    where some differ.
    """
    problem = replace(problem, goal=TRUE, minimize_cost=False, metric_location=None)
    problem = with_costs(problem, costs or {})
    task = ground(problem)
    profiles = Profiles(task)
    typed = with_inferred_types(problem)
    return World(name, task, typed.domain, universe(typed), profiles, Mentions(profiles, typed, lexicon, kinds))


def run(world: World, state: Bits, instructions: Iterable[Instruction]) -> Bits:
    """Return the state after ``instructions``; one that can never apply here changes nothing."""
    for instruction in instructions:
        operator = world.task.by_instruction.get(instruction)
        if operator is not None:
            state = operator.apply(state)
    return state


# How a :class:`Match` was found: the object contains what the noun names.
CONTAINED = "contained"
# A container is a weaker reading than the thing itself.
_CONTAINED_SHARE = 0.9


class Mentions:
    """The nouns of one environment.

    ``problem`` is the environment, with types; ``kinds`` is as for :func:`make_world`.
    """

    def __init__(
        self, profiles: Profiles, problem: Problem, lexicon: Lexicon, kinds: Mapping[str, str] | None = None
    ) -> None:
        self.profiles = profiles
        self.lexicon = lexicon
        types = hierarchy(problem.domain)
        told = _told_types(profiles.task, lexicon)
        # the classes that the domain knows, with objects here or without
        self.classes = frozenset(t.name for t in problem.domain.types).union(*told.values())
        self.types: Mapping[str, tuple[str, ...]] = {
            o.name: _named_types(types.ancestors(o.types[0]), told.get(o.name, ())) for o in problem.all_objects()
        }
        self._said_of = _names_in_predicates(problem.domain, lexicon)
        own = {name: types[0] for name, types in self.types.items()}
        self.kinds: Mapping[str, str] = own | {name: kind for name, kind in (kinds or {}).items() if name in own}
        self._candidates = tuple(self._candidate(name) for name in self.types)
        self._known: dict[str, tuple[Match, ...]] = {}

    def _candidate(self, name: str) -> NounMatch:
        types, kind = self.types[name], self.kinds[name]
        above = types[1:] if kind == types[0] else types
        above = (*above, *(noun for one in types for noun in self._said_of.get(one, ())))
        return NounMatch(name, kind, above, _words(name, self.profiles.wholes.get(name)))

    def of(self, noun: str, state: Bits) -> list[Match]:
        """Return the objects that ``noun`` may mean in ``state``, likeliest first; empty for what is not there."""
        found: dict[str, Match] = {}
        for match in self.ranked(noun):
            if match.name not in self.profiles.constants:
                found.setdefault(match.name, match)
                continue
            for name in self.profiles.containers(match.name, state):
                better = Match(name, match.score * _CONTAINED_SHARE, CONTAINED)
                if name not in found or found[name].score < better.score:
                    found[name] = better
        return sorted(found.values(), key=lambda m: -m.score)

    def constants(self, noun: str) -> list[str]:
        """Return the constants of the domain, substances say, that ``noun`` may mean, likeliest first."""
        return [match.name for match in self.ranked(noun) if match.name in self.profiles.constants]

    def ranked(self, noun: str) -> tuple[Match, ...]:
        """Return the objects and constants that ``noun`` may name, likeliest first, without what contains them."""
        if noun not in self._known:
            self._known[noun] = tuple(rank(noun, self._candidates, self.lexicon))
        return self._known[noun]

    def meant(self, clause: VerbClause, used: Collection[str], state: Bits) -> tuple[str, ...]:
        """Return the clause's objects: for each noun what it may mean among the objects ``used``, or the likeliest.

        Of several that are equally likely it is the one with the most edges to what was used: the burner of the
        knob that was turned.
        """
        found: dict[str, None] = {}
        for noun in clause.resolved():
            matches = self.of(noun, state)
            chosen = next((match.name for match in matches if match.name in used), None)
            if chosen is None and matches:
                best = [match.name for match in matches if match.score == matches[0].score]
                chosen = max(best, key=lambda name: self._edges(name, used))
            if chosen is not None:
                found[chosen] = None
        return tuple(found)

    def _edges(self, name: str, used: Collection[str]) -> int:
        links = self.profiles.links
        return sum(len(links.get((name, u), ())) + len(links.get((u, name), ())) for u in used)


def _named_types(types: Sequence[str], told: Sequence[str]) -> tuple[str, ...]:
    """Return an object's types, and where they say no more than predicates do, those too."""
    if types[0] not in (OBJECT, *told):
        return tuple(types)
    return tuple(dict.fromkeys((*types[:-1], *told, *types[-1:])))


def _told_types(task: Task, lexicon: Lexicon) -> dict[str, list[str]]:
    """Return for objects the predicates that always hold of them, the rarest first: types, where a domain has none.

    Those that actions bring about, as ``(fuelled ?p)``, and those that begin with a verb, ``(has-lamp ?d)``, tell none.
    """
    made = {effect.atom.predicate for action in task.problem.domain.actions for effect in action.effects}

    def names(predicate: str) -> bool:
        verb = lexicon.verb(split_name(predicate)[0])
        return predicate not in made and (verb is None or verb[1] == "base")

    always = sorted(atom for atom in task.static if len(atom.args) == 1 and names(atom.predicate))
    count = Counter(atom.predicate for atom in always)
    found: dict[str, list[str]] = {}
    for atom in sorted(always, key=lambda atom: count[atom.predicate]):
        found.setdefault(atom.args[0], []).append(atom.predicate)
    return found


def _names_in_predicates(domain: Domain, lexicon: Lexicon) -> dict[str, list[str]]:
    """Return for types the nouns that predicates use for their objects: *plane*, of ``(planeAt ?p - aircraft ?l)``."""
    found: dict[str, list[str]] = {}
    for predicate in domain.predicates:
        *noun, place = split_name(predicate.name)
        if len(predicate.parameters) == 2 and noun and place in section("static"):
            verb = lexicon.verb(noun[-1])
            if verb is None or verb[1] == "base":  # not ``stands-at``, ``stored-in``
                for one in predicate.parameters[0].types:
                    found.setdefault(one, []).append("_".join(noun))
    return found


def _words(name: str, whole: str | None) -> tuple[str, ...]:
    """Return the words in an object's name; a part also answers to the name of its whole."""
    words = [word.rstrip("0123456789") for word in name.replace("-", "_").split("_")]
    return tuple(dict.fromkeys([w for w in words if w] + ([whole.rstrip("0123456789")] if whole else [])))


Profile = Mapping[tuple[str, ...], bool]


class Profiles:
    """Profiles of the objects of one task.

    The fluent atoms of ``task`` are the states that an object can be in.
    """

    def __init__(self, task: Task) -> None:
        self.task = task
        problem = task.problem
        declared = {c.name for c in problem.domain.constants}
        # a cellar that the domain names is a room like those of the problem; water is like nothing there
        kinds = {o.types for o in problem.objects if o.name not in declared} - {(OBJECT,)}
        self.constants = frozenset(c.name for c in problem.domain.constants if c.types not in kinds)
        things = [c.name for c in problem.domain.constants if c.types in kinds]
        self.objects = (*(o.name for o in problem.objects if o.name not in declared), *things)
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
        """Return ``name``, and the object that it is a part of."""
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
        """Return the profile of the object ``name`` in ``state``."""
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
        """Return the atoms that the profile of ``name`` depends on."""
        things = (name, *(part for _, part in self.parts.get(name, ())))
        return self.task.encode(atom for thing in things for atom, _ in self._fluent.get(thing, ()))

    def own(self, name: str, state: Bits) -> dict[tuple[str, ...], bool]:
        """Return the profile of ``name`` without that of its parts."""
        profile = {key: True for _, key in self._static.get(name, ())}
        for atom, key in self._fluent.get(name, ()):
            profile[key] = bool(state >> self.task.index[atom] & 1)
        return profile

    def containers(self, constant: str, state: Bits) -> list[str]:
        """Return the objects with ``constant`` in a state (*contains mug1 water*), in the problem's order.

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
        """The predicates in the effects of actions."""
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
    """Return the share of the states of either object in which the two differ (Δ_env for one variable, section VI-A.1).

    A state that only one of them can have counts as a difference. 0 where neither has any.
    """
    names = one.keys() | other.keys()
    if not names:
        return 0.0
    return sum(one.get(name) != other.get(name) for name in names) / len(names)


def shared(one: Profile, other: Profile) -> int:
    """Return how many states two profiles have in common (rule 3 of section V-A)."""
    return sum(other.get(name) == value for name, value in one.items())
