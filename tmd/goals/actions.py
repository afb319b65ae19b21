"""What verbs mean, read off a domain's own words: names of actions and predicates. No kitchen is known here.

Three readings, each as rows that an author could have written:

* a verb whose outcome has a word (*open*: opened; *turn on*: active, lit, running) and a predicate with that word;
* a verb that stands in the name of an action, and what that action brings about for its parameters;
* prepositions that stand in predicates, or as constants in their arguments: where things are, and what they contain.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import permutations

from tmd.goals.senses import result_verbs, results
from tmd.goals.table import ACTIONS, PREPOSITIONS, GoalRow, GoalTable, Slot
from tmd.pddl.hierarchy import hierarchy
from tmd.pddl.model import ActionSchema, And, Atom, Domain, Exists, Formula, Not, Or, Predicate, TypedName
from tmd.pddl.writer import format_formula

_ACTORS = frozenset(
    {"robot", "agent", "person", "human", "gripper", "hand", "arm", "worker", "gardener", "player", "actor"}
)
"""Names of types, and of parents of types, whose objects act or hold rather than being acted on."""
_PLACES = ("in", "on", "next_to", "under", "behind", "above")
_PUT = ("put", "bring", "throw")
_ANYWHERE = ("in", "on", "to", "next_to", "with", "of", "under", "from")
_MOST_SLOTS = 3


def rows_of_actions(domain: Domain) -> GoalTable:
    """The rows that a domain's names suggest."""
    words = _Words(domain)
    rows = [*words.relations(), *words.contents(), *words.named_actions(), *words.states()]
    return GoalTable(tuple(rows))


class _Words:
    """The names of one domain."""

    def __init__(self, domain: Domain) -> None:
        self.domain = domain
        self.types = hierarchy(domain)
        self.fluent = {effect.atom.predicate for action in domain.actions for effect in action.effects}
        self.made = {effect.atom.predicate for a in domain.actions for effect in a.effects if effect.positive}
        self.constants: dict[tuple[str, ...], list[str]] = {}
        self.passing = _passing(domain)

    def actor(self, parameter: TypedName) -> bool:
        """Whether a parameter is for who acts, not for what is acted on."""
        return any(kind in _ACTORS for given in parameter.types for kind in self.types.ancestors(given))

    def fixed(self, parameter: TypedName) -> list[str]:
        """The constants of the domain that a parameter may be."""
        return [c.name for c in self.domain.constants if self.types.accepts(parameter.types, c.types)]

    def valued(self, parameter: TypedName) -> bool:
        """Whether a parameter stands for a value (an amount, a setting, a substance): its type has constants."""
        return bool(self.fixed(parameter)) and not self.actor(parameter) and not _placelike(parameter, self.types)

    # ------------------------------------------------------------------ states

    def states(self) -> Iterator[GoalRow]:
        """``open X: (opened ?x)`` for every verb of English whose outcome a predicate or a constant has in its name."""
        for verb in result_verbs():
            for word in results(verb):
                wanted, positive = word.removeprefix("-"), not word.startswith("-")
                for predicate in self.domain.predicates:
                    if predicate.name not in self.fluent:
                        continue
                    condition = self._state(predicate, wanted, any_value=not positive)
                    if condition is not None:
                        found = condition if positive else Not(condition)
                        yield self._row((verb,), (Slot("?x"),), found, f"{verb} X", f"'{wanted}' in {predicate.name}")

    def _state(self, predicate: Predicate, word: str, *, any_value: bool = False) -> Formula | None:
        """That ``?x`` is in a state that has ``word`` in its name; everything else is left open.

        A predicate with a value besides (an amount, a load) is such a state with ``any_value`` only: nothing is in it.
        """
        things = [p for p in predicate.parameters if not self.actor(p) and not self.valued(p)]
        if len(things) != 1:
            return None
        values = [p for p in predicate.parameters if self.valued(p)]
        named = word == predicate.name or word in predicate.name.split("_")
        chosen = {p.name: word for p in values if word in self.fixed(p)}
        if not chosen and (not named or (values and not any_value)):
            return None
        return self._atom(predicate, {things[0].name: "?x", **chosen})

    def _atom(self, predicate: Predicate, given: dict[str, str]) -> Formula:
        """An atom with some arguments given; what is left is whoever or whatever it may be."""
        terms: list[str] = []
        left: list[TypedName] = []
        for parameter in predicate.parameters:
            if parameter.name in given:
                terms.append(given[parameter.name])
                continue
            fixed = self.fixed(parameter)
            if self.actor(parameter) and len(fixed) == 1:
                terms.append(fixed[0])
                continue
            name = f"?any_{len(left)}"
            left.append(TypedName(name, parameter.types))
            terms.append(name)
        atom = Atom(predicate.name, tuple(terms))
        return Exists(tuple(left), atom) if left else atom

    def _row(
        self, verbs: tuple[str, ...], slots: tuple[Slot, ...], condition: Formula, pattern: str, evidence: str
    ) -> GoalRow:
        return GoalRow(verbs, slots, condition, pattern, source=ACTIONS, probability=0.5, evidence=evidence)

    # ------------------------------------------------------------------ relations

    def relations(self) -> Iterator[GoalRow]:
        """``put X in Y`` for every relation of two things with a preposition in its name or among its arguments."""
        places: dict[str, list[Formula]] = {}
        for predicate in self.domain.predicates:
            if predicate.name not in self.fluent or predicate.name not in self.made or predicate.name in self.passing:
                continue
            for preposition, atom in self._places(predicate):
                places.setdefault(preposition, []).append(atom)
        for preposition, atoms in places.items():
            condition = atoms[0] if len(atoms) == 1 else Or(tuple(atoms))
            slots = (Slot("?x"), Slot("?y", (preposition,)))
            yield self._row((*_PUT, "be"), slots, condition, f"put X {preposition} Y", "a predicate of place")
        if places:
            anywhere = tuple(Not(atom) for atoms in places.values() for atom in atoms)
            slots = (Slot("?x"), Slot("?y", ("from",)))
            yield self._row(("take",), slots, And(anywhere), "take X from Y", "predicates of place")

    def _places(self, predicate: Predicate) -> Iterator[tuple[str, Formula]]:
        things = [p for p in predicate.parameters if not self.actor(p) and not self.valued(p)]
        relations = [p for p in predicate.parameters if p not in things and set(self.fixed(p)) & set(PREPOSITIONS)]
        if len(things) != 2:
            return
        given = {things[0].name: "?x", things[1].name: "?y"}
        for parameter in relations:
            for constant in self.fixed(parameter):
                if constant in PREPOSITIONS:
                    yield constant, self._atom(predicate, {**given, parameter.name: constant})
        if relations:
            return
        parts = set(predicate.name.split("_")) | {predicate.name}
        for preposition in _PLACES:
            if parts & set(PREPOSITIONS[preposition]):
                yield preposition, self._atom(predicate, given)
                return
        if "at" in parts:
            for preposition in ("in", "on", "next_to"):
                yield preposition, self._atom(predicate, given)

    def contents(self) -> Iterator[GoalRow]:
        """``fill V with S`` for predicates that join a thing and a value which actions bring about: loads, say."""
        for predicate in self.domain.predicates:
            if predicate.name not in self.made:
                continue
            things = [p for p in predicate.parameters if not self.actor(p) and not self.valued(p)]
            values = [p for p in predicate.parameters if self.valued(p)]
            if len(things) != 1 or len(values) != 1:
                continue
            condition = self._atom(predicate, {things[0].name: "?v", values[0].name: "?s"})
            why = f"{predicate.name} joins a thing and a value"
            yield self._row(("fill", "load"), (Slot("?v"), Slot("?s", ("with", "of"))), condition, "fill V with S", why)
            places = ("in", "on", "to")
            yield self._row(
                ("put", "pour", "add", "be"), (Slot("?s"), Slot("?v", places)), condition, "put S in V", why
            )
            yield self._row(("be",), (Slot("?v"), Slot("?s", ("with", "of"))), condition, "be V with S", why)
            yield self._row(("set", "turn", "change"), (Slot("?v"), Slot("?s", ("to",))), condition, "set V to S", why)

    # ------------------------------------------------------------------ actions

    def named_actions(self) -> Iterator[GoalRow]:
        """Rows for the verbs in the names of actions: what these bring about for their parameters."""
        for action in self.domain.actions:
            condition = self._brought_about(action)
            if condition is None:
                continue
            used = [p for p in action.parameters if p.name in _variables(condition) and not self.actor(p)]
            for verbs in (tuple(dict.fromkeys(_verbs_of(action.name))),):
                yield from self._with_slots(action, verbs, used, condition)

    def _brought_about(self, action: ActionSchema) -> Formula | None:
        """What an action makes true, unconditionally, of its parameters; failing that, what it makes false."""
        wanted = {p.name for p in action.parameters if not self.actor(p)}
        own = [
            e
            for e in action.effects
            if not e.parameters
            and e.condition == And()
            and set(e.atom.terms) & wanted
            and e.atom.predicate not in self.passing
        ]
        positive = [e.atom for e in own if e.positive]
        if positive:
            # what only this action brings about says what it is for: to harvest is to pick, not to hold
            fewest = min(self._makers(atom.predicate) for atom in positive)
            positive = [atom for atom in positive if self._makers(atom.predicate) == fewest]
            return positive[0] if len(positive) == 1 else And(tuple(positive))
        negative: list[Formula] = [Not(e.atom) for e in own]
        return (negative[0] if len(negative) == 1 else And(tuple(negative))) if negative else None

    def _makers(self, predicate: str) -> int:
        """How many actions make something of a predicate true."""
        return sum(any(e.positive and e.atom.predicate == predicate for e in a.effects) for a in self.domain.actions)

    def _with_slots(
        self, action: ActionSchema, verbs: tuple[str, ...], used: list[TypedName], condition: Formula
    ) -> Iterator[GoalRow]:
        """One row for each choice of which parameters are said; the others are whatever they may be."""
        for count in range(min(len(used), _MOST_SLOTS), 0, -1):
            for said in permutations(used, count):
                names = {p.name: f"?{'xyz'[i]}" for i, p in enumerate(said)}
                others = [p for p in action.parameters if p.name in _variables(condition) and p.name not in names]
                formula = _renamed(condition, names)
                if others:
                    formula = Exists(tuple(others), formula)
                slots = (Slot("?x"), *(Slot(names[p.name], _ANYWHERE) for p in said[1:]))
                pattern = " … ".join([verbs[0], *(p.name.removeprefix("?").upper() for p in said)])
                yield self._row(verbs, slots, formula, pattern, f"the action {action.name}")


def _verbs_of(name: str) -> Iterator[str]:
    """The verbs that an action's name says: itself, without a preposition at its end, and its first word."""
    yield name
    words = name.split("_")
    if len(words) == 1:
        for ending in ("into", "onto", "from", "to", "in", "on"):
            if name.endswith(ending) and len(name) > len(ending) + 2:
                yield name.removesuffix(ending)
        return
    prepositions = {word for members in PREPOSITIONS.values() for word in members}
    if words[-1] in prepositions:
        yield "_".join(words[:-1])
    if words[-1] not in ("on", "off", "up", "down", "out"):
        yield words[0]


def _placelike(parameter: TypedName, types: object) -> bool:
    """Whether a parameter may be a thing or a place, although the domain has a constant of that type (the floor)."""
    return any(t in ("object", "thing", "item", "place", "location", "physobj", "movable") for t in parameter.types)


def _passing(domain: Domain) -> frozenset[str]:
    from tmd.goals.commitments import passing_predicates

    return passing_predicates(domain)


def _variables(formula: Formula) -> set[str]:
    match formula:
        case Atom(_, terms):
            return {t for t in terms if t.startswith("?")}
        case Not(part) | Exists(_, part):
            return _variables(part)
        case And(parts) | Or(parts):
            return set().union(*(_variables(part) for part in parts))
    return set()


def _renamed(formula: Formula, names: dict[str, str]) -> Formula:
    match formula:
        case Atom(predicate, terms):
            return Atom(predicate, tuple(names.get(t, t) for t in terms))
        case Not(part):
            return Not(_renamed(part, names))
        case And(parts):
            return And(tuple(_renamed(part, names) for part in parts))
    return formula


def describe(rows: Iterable[GoalRow]) -> str:
    """The rows as lines of ``lexicon.yaml``, for an author to look at."""
    return "\n".join(f"- {row.pattern}: {' '.join(format_formula(row.condition).split())}" for row in rows)
