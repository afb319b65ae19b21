"""Meanings of verbs, derived from the names of a domain's actions and predicates.

Four readings, each as rows that an author could have written:

* a verb whose outcome has a word (*open*: opened; *turn on*: active, lit, running) and a predicate with that word;
* a verb that stands in the name of an action, and what that action brings about for its parameters;
* a participle that is the name of a predicate (*deliver*: ``delivered-to``);
* prepositions that stand in predicates, or as constants in their arguments: where things are, and what they contain.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import chain, permutations, product

from tmd.goals.sources.table import ACTIONS, FIRST, MARK, WAS, GoalRow, GoalTable, Slot
from tmd.goals.words import PREPOSITIONS, family, results, table, the_word, words_of
from tmd.language.lexicon.lexicon import builtin, section, singular
from tmd.language.lexicon.names import split_name, states_in_name, words_in_name
from tmd.pddl.domain_traits import passing_predicates
from tmd.pddl.ground_formula import conjunction, disjunction
from tmd.pddl.model import (
    OBJECT,
    ActionSchema,
    And,
    Atom,
    Domain,
    Effect,
    Equals,
    Exists,
    Forall,
    Formula,
    Imply,
    Not,
    Predicate,
    TypedName,
    TypeHierarchy,
    hierarchy,
    predicates_of,
)

_ROWS = table("rows")
"""Verbs and prepositions of the rows that are read off a domain, in order."""
_ANYWHERE = _ROWS["anywhere"]
_MOST_SLOTS = 3
OF_ACTION = "the action "
"""Evidence for the rows of an action, before its name."""


def rows_of_actions(domain: Domain) -> GoalTable:
    """Return the rows that a domain's names suggest."""
    words = _Words(domain)
    rows = [
        *words.relations(),
        *words.contents(),
        *words.named_actions(),
        *words.states(),
        *words.parts(),
        *words.participles(),
        *words.named_actions(shortened=True),
        *words.doings(),
        *words.receipts(),
    ]
    return GoalTable(tuple(rows), words.settings())


def actor_types(domain: Domain) -> frozenset[str]:
    """Return the types of those who act, and are not acted on."""
    return _Words(domain).actors


def is_journey(row: GoalRow, domain: Domain) -> bool:
    """Return whether a row says that something is anywhere, of an action that takes it from place to place."""
    found = row.condition
    if not (isinstance(found, Exists) and isinstance(found.part, Atom)):
        return False
    atom, left = found.part, {parameter.name for parameter in found.parameters}
    journeys = (
        (made, place)
        for action in domain.actions
        if row.evidence == f"{OF_ACTION}{action.name}"
        for made, (place,) in _journeys(action)
    )
    return any(made.predicate == atom.predicate and atom.terms[made.terms.index(p)] in left for made, p in journeys)


def plain_words(predicate: Predicate, types: TypeHierarchy) -> tuple[str, ...]:
    """Return the words of a predicate's name that say something of its arguments: *fed*, of ``horse_has_been_fed``.

    Args:
        predicate: The predicate.
        types: The types of the domain.
    """
    kinds = {one for p in predicate.parameters for kind in p.types for one in types.ancestors(kind)}
    words = split_name(predicate.name)
    while len(words) > 1 and (words[0] in kinds or words[0] in section("be")):
        words = words[1:]
    perfect = len(words) > 2 and words[0] in section("having") and words[1] in section("be")
    return words[2:] if perfect else words


def told_nouns(domain: Domain) -> Mapping[str, frozenset[str]]:
    """Return for each predicate of one thing the nouns of parts that its name, or that of an action, speaks of.

    The lights of rooms, where ``light-on`` makes them ``lit``; the troughs of paddocks, with ``water_trough_is_full``.
    """
    return _Words(domain).told()


class _Words:
    """The names of one domain."""

    def __init__(self, domain: Domain) -> None:
        self.domain = domain
        self.types = hierarchy(domain)
        self.fluent = {effect.atom.predicate for action in domain.actions for effect in action.effects}
        self.made = {effect.atom.predicate for a in domain.actions for effect in a.effects if effect.positive}
        self._fixed: dict[tuple[str, ...], list[str]] = {}  # the constants of each type, asked for thousands of times
        self.passing = passing_predicates(domain)
        actors, people = words_of("names", "actors"), section("people") - section("served")
        # people act where most actions have one; elsewhere things are done for them
        peopled = [a for a in domain.actions if any(self._kinds(p) & people for p in a.parameters)]
        self.actors = actors | people if 2 * len(peopled) > len(domain.actions) else actors
        self.actors |= self._movers()

    def _movers(self) -> frozenset[str]:
        """Return the type of the first parameter of most actions, if such things move or carry something.

        What most actions have no other parameter beside is acted on: animals that are weighed, bandaged and woken.
        """
        firsts = Counter(kind for a in self.domain.actions for p in a.parameters[:1] for kind in p.types)
        kind, count = firsts.most_common(1)[0] if firsts else ("", 0)
        twice = any(sum(kind in p.types for p in a.parameters) > 1 for a in self.domain.actions)
        alone = sum(len(a.parameters) == 1 for a in self.domain.actions)
        if twice or 4 * count < 3 * len(self.domain.actions) or 2 * alone >= len(self.domain.actions):
            return frozenset()
        return frozenset({kind}) if self._goes(kind) or self._carries(kind) else frozenset()

    def _goes(self, kind: str) -> bool:
        """Return whether the first parameter of an action, if it is of a type, goes to another place by itself."""
        return any(
            a.parameters[0].name in made.terms and kind in a.parameters[0].types
            for a in self.domain.actions
            if split_name(a.name)[0] not in words_of("verbs", "transporting")
            for made, _ in _journeys(a)
        )

    def _carries(self, kind: str) -> bool:
        """Return whether the first parameter of an action, if it is of a type, carries something."""
        return any(
            e.atom.terms[:1] == (a.parameters[0].name,) and kind in a.parameters[0].types and _is_held(e.atom.predicate)
            for a in self.domain.actions
            for e in a.effects
            if a.parameters
        )

    def _kinds(self, parameter: TypedName) -> set[str]:
        return {kind for given in parameter.types for kind in self.types.ancestors(given)}

    def actor(self, parameter: TypedName) -> bool:
        """Return whether a parameter is for the actor, not for what is acted on."""
        return bool(self._kinds(parameter) & self.actors)

    def things(self, predicate: Predicate) -> list[TypedName]:
        """Return the parameters of a predicate that are neither the actor nor a value."""
        return [p for p in predicate.parameters if not self.actor(p) and not self.valued(p)]

    def fixed(self, parameter: TypedName) -> list[str]:
        """Return the constants of the domain that a parameter may be."""
        found = self._fixed.get(parameter.types)
        if found is None:
            found = [c.name for c in self.domain.constants if self.types.accepts(parameter.types, c.types)]
            self._fixed[parameter.types] = found
        return found

    def valued(self, parameter: TypedName) -> bool:
        """Return whether a parameter is a value (an amount, a setting, a substance): its type has constants."""
        fixed = bool(self.fixed(parameter)) and not self.actor(parameter)
        return fixed and not _placelike(parameter) and (self._sites | self._stateful).isdisjoint(parameter.types)

    @cached_property
    def _stateful(self) -> frozenset[str]:
        """The types of things that actions alone change the state of, and that are no values: pumps run."""
        unary = (p for p in self.domain.predicates if len(p.parameters) == 1 and p.name in self.fluent)
        return frozenset(kind for predicate in unary for kind in predicate.parameters[0].types) - {OBJECT}

    @cached_property
    def _sites(self) -> frozenset[str]:
        """The types of the places where things are: of the last of two parameters of ``at`` or ``located-in``."""
        words = {*chain.from_iterable(PREPOSITIONS.values()), *words_of("located"), *section("be")}
        located = (p for p in self.domain.predicates if len(p.parameters) == 2 and words.issuperset(split_name(p.name)))
        return frozenset(chain.from_iterable(p.parameters[-1].types for p in located))

    def told(self) -> Mapping[str, frozenset[str]]:
        """Return for each predicate of one thing the nouns that are only spoken of with it."""
        unary = {p.name: p for p in self.domain.predicates if len(self.things(p)) == 1}
        found = {name: set(self._part_in(predicate)) for name, predicate in unary.items()}
        for action in self.domain.actions:
            acted_on = next((p.name for p in action.parameters if not self.actor(p)), "")
            changed = {e.atom.predicate for e in self._brought_about(action) if acted_on in e.atom.terms}
            for name in changed & unary.keys():
                found[name].update(self._part_acted_on(action))
        return {name: frozenset(map(singular, nouns)) for name, nouns in found.items() if nouns}

    def _part_in(self, predicate: Predicate) -> tuple[str, ...]:
        """Return a compound noun and its head before a state: ``water_trough_is_full``."""
        words = [w for w in plain_words(predicate, self.types) if w not in section("be")]
        nouns, last = words[:-1], words[-1:]
        stated = bool(nouns) and not (words_of("part_states") | section("end_states")).isdisjoint(last)
        return ("_".join(nouns), nouns[-1]) if stated else ()

    def _part_acted_on(self, action: ActionSchema) -> tuple[str, ...]:
        """Return a compound noun and its head in an action's name: ``fill_water_trough``, ``light-on``."""
        words = split_name(action.name)
        first = len(words) == 2 and words[1] in words_of("names", "particles")
        noun = words[0] if first else self._noun_in(action, words)
        return (noun, noun.rpartition("_")[2]) if noun else ()

    # ------------------------------------------------------------------ states

    def states(self) -> Iterator[GoalRow]:
        """Yield ``open X: (opened ?x)`` for each verb whose outcome a predicate or a constant has in its name."""
        for verb in table("results"):
            for word in results(verb):
                wanted, positive = word.removeprefix("-"), not word.startswith("-")
                for predicate in self.domain.predicates:
                    if predicate.name not in self.fluent:
                        continue
                    *noun, last = split_name(predicate.name)
                    if not predicate.parameters and noun and last == wanted:  # ``shop_open``: "close the shop"
                        alone = Atom(predicate.name, ()) if positive else Not(Atom(predicate.name, ()))
                        row = self._row(
                            (verb,), (), alone, f"{verb} {'_'.join(noun)}", f"'{wanted}' in {predicate.name}"
                        )
                        yield replace(row, noun="_".join(noun))
                    condition = self._state(predicate, wanted, any_value=not positive)
                    if condition is not None:
                        found = condition if positive else Not(condition)
                        yield self._row((verb,), (Slot("?x"),), found, f"{verb} X", f"'{wanted}' in {predicate.name}")

    def settings(self) -> dict[str, Formula]:
        """Return what a state in the name of an action says of a thing: *red* with ``set_red`` is no longer green."""
        known = {word for p in self.domain.predicates for word in words_in_name(p.name)}
        found: dict[str, Formula] = {}
        for action in self.domain.actions:
            verb, *state = split_name(action.name)
            things = [p for p in action.parameters if not self.actor(p)]
            told = len(state) == 1 and state[0] not in known and state[0] not in words_of("names", "particles")
            if not told or len(things) != 1 or verb not in words_of("rows", "set"):
                continue
            effects = [self._said(effect, {things[0].name: "?x"}, action) for effect in self._brought_about(action)]
            such = Exists((TypedName("?such", things[0].types),), Equals("?such", "?x"))
            found[state[0]] = conjunction([such, *effects])
        return found

    def parts(self) -> Iterator[GoalRow]:
        """Yield ``put the lid on X`` for a predicate such as ``lid_on``, and ``put soap in X`` for ``has_soap``."""
        for predicate in self.domain.predicates:
            plain = plain_words(predicate, self.types)
            first, *words = plain
            if words and first in words_of("rows", "having") and len(self.things(predicate)) == 1:
                noun, there = "_".join(words), self._atom(predicate, {self.things(predicate)[0].name: "?y"})
                if predicate.name in self.fluent:
                    why = f"'{noun}' in its name"
                    into = Slot("?y", _ROWS["vessel"])
                    row = self._row((*_ROWS["lay"], *_ROWS["pour"]), (into,), there, f"put {noun} in Y", why)
                    yield replace(row, noun=noun)
                    out = Slot("?y", _ROWS["whence"])
                    row = self._row(_ROWS["take"], (out,), Not(there), f"take {noun} from Y", why)
                    yield replace(row, noun=noun)
                continue
            noun, _, preposition = "_".join(plain).rpartition("_")
            if predicate.name not in self.fluent or len(self.things(predicate)) != 1 or not noun:
                continue
            there = self._atom(predicate, {self.things(predicate)[0].name: "?y"})
            if preposition in words_of("rows", "resting"):
                on, off = Slot("?y", (preposition,)), Slot("?y", _ROWS["whence"])
                row = self._row(_ROWS["lay"], (on,), there, f"put {noun} {preposition} Y", f"'{noun}' in its name")
                yield replace(row, noun=noun)
                row = self._row(_ROWS["take"], (off,), Not(there), f"take {noun} from Y", f"'{noun}' in its name")
                yield replace(row, noun=noun)

    def _state(self, predicate: Predicate, word: str, *, any_value: bool = False) -> Formula | None:
        """Return that ``?x`` is in a state that has ``word`` in its name; everything else is left open.

        A predicate with a value or thing besides (an amount, a load, what it is connected to) is such a state with
        ``any_value`` only: nothing is in it.
        """
        things = self.things(predicate)
        if not 0 < len(things) <= 1 + any_value:
            return None
        values = [p for p in predicate.parameters if self.valued(p)]
        named = word in states_in_name("_".join(plain_words(predicate, self.types)))
        chosen = {p.name: word for p in values if word in self.fixed(p)}
        if not chosen and (not named or (values and not any_value)):
            return None
        return self._atom(predicate, {things[0].name: "?x", **chosen})

    def _atom(self, predicate: Predicate, given: dict[str, str]) -> Formula:
        """Return an atom with some arguments given; the others are left open."""
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
        """Yield ``put X in Y`` for each relation of two things with a preposition in its name or its arguments."""
        places = self._all_places()
        yield from self._going()
        for preposition, atoms in places.items():
            slots = (Slot("?x"), Slot("?y", (preposition,)))
            yield self._row(_ROWS["put"], slots, disjunction(atoms), f"put X {preposition} Y", "a predicate of place")
        if places:
            whither = tuple(dict.fromkeys(atom for atoms in places.values() for atom in atoms))
            yield self._placed("bring", "whither", disjunction(whither), "take X to Y")
            yield from self._of_all_places()
        yield from self._exchanges()

    def _of_all_places(self) -> Iterator[GoalRow]:
        """Yield ``take X from Y``; ``clear Y``: nothing is there; and ``put back X``: it is where it was."""
        made = (self.fluent & self.made) - set(self.passing)
        nothing: dict[Formula, None] = {}
        back: dict[Formula, None] = {}
        placed = [(p, atom) for p in self.domain.predicates if p.name in made for _, atom in self._places(p)]
        for predicate, atom in placed:
            thing, place = (p.types for p in self.things(predicate))
            nothing[Not(Exists((TypedName("?x", thing),), atom))] = None
            back[Forall((TypedName("?y", place),), Imply(_before(atom, FIRST), atom))] = None
        for where in dict.fromkeys(self.things(predicate)[1] for predicate, _ in placed):
            there = dict.fromkeys(atom for predicate, atom in placed if self._alike(self.things(predicate)[1], where))
            yield self._placed("take", "whence", conjunction([Not(atom) for atom in there]), "take X from Y")
        why = "predicates of place"
        yield from (self._row(_ROWS["clear"], (Slot("?y"),), each, "clear Y", why) for each in nothing)
        yield self._row(_ROWS["back"], (Slot("?x"),), conjunction(list(back)), "put_back X", why)

    def _exchanges(self) -> Iterator[GoalRow]:
        """Yield ``swap X with Z`` for each kind of things: each is where the other one was."""
        made = (self.fluent & self.made) - set(self.passing)
        slots = (Slot("?x"), Slot("?z", (*_ROWS["with"], *_ROWS["for"])))
        atoms = [(p, atom) for p in self.domain.predicates if p.name in made for _, atom in self._places(p)]
        joined = [(p, self._atom(p, {one.name: "?x", other.name: "?y"})) for p, one, other in self._joining()]
        atoms += [(p, atom) for p, atom in joined if not any(self._places(p))]
        kinds = dict.fromkeys(self.things(p)[0] for p, _ in atoms)
        alike = ([pair for pair in atoms if self._alike(self.things(pair[0])[0], kind)] for kind in kinds)
        for condition in dict.fromkeys(map(self._exchange, alike)):
            yield self._row(_ROWS["swap"], slots, condition, "swap X with Z", "predicates of place")

    def _exchange(self, atoms: Sequence[tuple[Predicate, Formula]]) -> Formula:
        """Return that two things are each where the other one was, by predicates of where such things are.

        A plant goes to the other's bench, and keeps its pot. A new part goes where the old one was mounted.
        """
        swapped: dict[Formula, None] = {}
        placed: list[Formula] = []
        for predicate, atom in atoms:
            place = self.things(predicate)[-1].types
            both = (atom, _renamed(atom, "?x", "?z"))
            keeps = bool(placed) and predicate.name not in self._exchanged
            for number, (then, now) in enumerate(permutations(both)):
                was = _before(then, WAS)
                before = And((was, Not(placed[number]))) if keeps else was
                swapped[Forall((TypedName("?y", place),), Imply(before, now))] = None
            there = (TypedName("?there", place),)
            placed = placed or [Exists(there, _before(_renamed(each, "?y", "?there"), WAS)) for each in both]
        return conjunction(list(swapped))

    def _all_places(self) -> dict[str, list[Formula]]:
        """Return for each preposition the conditions of place that it says."""
        places: dict[str, list[Formula]] = {}
        hosts: dict[str, set[str]] = {}
        made = (self.fluent & self.made) - set(self.passing)
        named = {p: list(self._places(p)) for p in self.domain.predicates if p.name in made}
        for predicate, found in named.items():
            for preposition, atom in found:
                places.setdefault(preposition, []).append(atom)
                hosts.setdefault(preposition, set()).update(self.things(predicate)[1].types)
        for predicate, found in named.items():
            said = {preposition for preposition, _ in found} & set(_ROWS["resting"])
            others = [p for p in _ROWS["resting"] if len(said) == 1 and p not in said]
            for preposition in others:  # "onto the truck", where things are only ever in one
                if hosts.get(preposition, set()).isdisjoint(self.things(predicate)[1].types):
                    places.setdefault(preposition, []).extend(atom for _, atom in found)
        return places

    def _placed(self, verbs: str, prepositions: str, condition: Formula, pattern: str) -> GoalRow:
        slots = (Slot("?x"), Slot("?y", _ROWS[prepositions]))
        return self._row(_ROWS[verbs], slots, condition, pattern, "predicates of place")

    def _places(self, predicate: Predicate) -> Iterator[tuple[str, Formula]]:
        things = self.things(predicate)
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
        for preposition in self._prepositions(predicate.name):
            yield preposition, self._atom(predicate, given)

    def _prepositions(self, name: str) -> tuple[str, ...]:
        """Return the prepositions that a predicate's name says, or all that it may say."""
        parts = words_in_name(name)
        hanging = bool(parts & words_of("names", "hanging"))
        for preposition in _ROWS["located"]:
            if parts & set(PREPOSITIONS[preposition]) or (hanging and preposition == _ROWS["hanging"][0]):
                return (preposition,)
        done = participle(name)
        placed = done is not None and not words_of("verbs", "settling").isdisjoint(family(done))  # "stowed"
        return _ROWS["within"] if parts & words_of("located") or placed or name in self._exchanged else ()

    @cached_property
    def _exchanged(self) -> frozenset[str]:
        """The predicates that actions exchange for each other: who goes aboard is ashore no longer, and back."""
        ways = {
            (lost.atom.predicate, made.atom.predicate)
            for action in self.domain.actions
            for lost, made in product(action.effects, action.effects)
            if made.positive and not lost.positive and lost.atom.predicate != made.atom.predicate
            if len(lost.atom.terms) == len(made.atom.terms) == 2 and lost.atom.terms[0] == made.atom.terms[0]
        }
        return frozenset(one for one, other in ways if (other, one) in ways)

    def _going(self) -> Iterator[GoalRow]:
        """Yield ``go to Y`` for the place that an action takes the actor to, and ``send X to Y`` where it is named."""
        found: dict[Formula, dict[str, None]] = {}
        sent: dict[Formula, dict[str, None]] = {}
        for action, there, left in self._whereabouts():
            verb = split_name(action.name)[0]  # "sail to the isle", where that is what the ferry does
            found.setdefault(Exists(left, there) if left else there, {})[verb] = None
            if len(left) == 1:
                named = tuple("?x" if term == left[0].name else term for term in there.terms)
                sent.setdefault(Atom(there.predicate, named), {})[verb] = None  # "sail the boat to the isle"
        where, why = Slot("?y", _ROWS["going"]), "a predicate of where one is"
        for condition, verbs in found.items():
            yield self._row(tuple(dict.fromkeys((*_ROWS["go"], *verbs))), (where,), condition, "go to Y", why)
            was = Forall((TypedName("?y", self._place_types(condition)),), Imply(_before(condition, FIRST), condition))
            yield self._row(_ROWS["home"], (), was, "come_back", why)
        named_so = [(condition, name) for condition in found for name in self._oneself(condition) if not sent]
        for condition, name in named_so:
            row = self._row((*_ROWS["send"], *_ROWS["put"]), (where,), condition, f"send {name} to Y", why)
            yield replace(row, noun=name)
        both = Slot("?x"), where
        for condition, verbs in sent.items():
            yield self._row(tuple(dict.fromkeys((*_ROWS["send"], *verbs))), both, condition, "send X to Y", why)

    def _place_types(self, condition: Formula) -> tuple[str, ...]:
        """Return the types of ``?y`` in an atom, or one with some arguments left open."""
        atom = condition.part if isinstance(condition, Exists) else condition
        assert isinstance(atom, Atom)
        predicate = next(p for p in self.domain.predicates if p.name == atom.predicate)
        return predicate.parameters[atom.terms.index("?y")].types

    @staticmethod
    def _oneself(condition: Formula) -> Iterator[str]:
        """Yield the nouns for who acts: *robot*, and *ferry* with ``at-ferry``."""
        yield from table("nouns")["oneself"]
        (name,) = predicates_of(condition)
        yield from (w for w in split_name(name) if not (_is_preposition(w) or w in words_of("located")))

    def _whereabouts(self) -> Iterator[tuple[ActionSchema, Atom, tuple[TypedName, ...]]]:
        """Yield for each action the atoms of where one is who acts, with ``?y`` for the place, and what is open."""
        for action in self.domain.actions:
            given = {p.name: p for p in action.parameters}
            for atom, (place,) in _journeys(action):
                others = [given[term] for term in atom.terms if term in given and term != place]
                if all(map(self.actor, others)):
                    names = {**{p.name: f"?any_{i}" for i, p in enumerate(others)}, place: "?y"}
                    terms = tuple(names.get(term, term) for term in atom.terms)
                    yield action, Atom(atom.predicate, terms), tuple(TypedName(names[p.name], p.types) for p in others)

    def contents(self) -> Iterator[GoalRow]:
        """Yield ``fill V with S`` for predicates that join a thing and a value, and that actions bring about."""
        for predicate in self.domain.predicates:
            if predicate.name not in self.made:
                continue
            things = self.things(predicate)
            values = [p for p in predicate.parameters if self.valued(p)]
            if len(things) != 1 or len(values) != 1:
                continue
            condition = self._atom(predicate, {things[0].name: "?v", values[0].name: "?s"})
            why = f"{predicate.name} joins a thing and a value"
            value, vessel = Slot("?s"), Slot("?v")
            with_value, in_vessel = Slot("?s", _ROWS["with"]), Slot("?v", _ROWS["vessel"])
            yield self._row(_ROWS["fill"], (vessel, with_value), condition, "fill V with S", why)
            yield self._row(_ROWS["pour"], (value, in_vessel), condition, "put S in V", why)
            yield self._row(_ROWS["be"], (vessel, with_value), condition, "be V with S", why)
            yield self._row(_ROWS["set"], (vessel, Slot("?s", _ROWS["value"])), condition, "set V to S", why)

    # ------------------------------------------------------------------ participles

    def participles(self) -> Iterator[GoalRow]:
        """Yield ``deliver X to Y`` for ``delivered-to``: what something is when the verb was done to it.

        And the same for verbs with that outcome: to plug one thing into another leaves them ``connected``. A prefix
        undoes it: to unmute a channel takes ``muted`` away. To point a telescope at Mars leaves it ``pointing`` there.
        """
        for predicate in self.domain.predicates:
            first, *rest = plain_words(predicate, self.types)
            if rest and first in words_of("names", "covering"):
                first, *rest = rest  # "mop the gallery", with ``floor_mopped``
            things = self.things(predicate)
            verb = participle(first) or (_lasting(first) if len(things) == 2 else None)
            said = predicate.name in self.made and predicate.name not in self.passing
            if not said or verb is None or first in words_of("located") or not 0 < len(things) < 3:
                continue
            slots = (Slot("?x"), Slot("?y", (*_ROWS["beside"], *_ROWS["whither"])))[: len(things)]
            names = {thing.name: slot.variable for thing, slot in zip(things, slots, strict=True)}
            verbs = (verb, "_".join([verb, *rest])) if rest else (verb, *self._leading_to(first))
            pattern = " … ".join([verb, *(s.variable.removeprefix("?").upper() for s in slots)])
            why = f"the predicate {predicate.name}"
            yield self._row(verbs, slots, self._atom(predicate, names), pattern, why)
            undone = Not(self._atom(predicate, {things[0].name: "?x"}))
            undoing = _undoing(verb)
            yield self._row(undoing, (Slot("?x"),), undone, f"{undoing[0]} X", why)

    def doings(self) -> Iterator[GoalRow]:
        """Yield ``Y is known by X`` for ``(knows ?x ?y)``, and ``X waits`` for ``(waiting ?x)``: what a thing does."""
        for predicate in self.domain.predicates:
            words, things = plain_words(predicate, self.types), self.things(predicate)
            verb = _done(words[0]) if len(words) == 1 else None
            if verb is None or len(things) != len(predicate.parameters) or not 0 < len(things) < 3:
                continue
            slots = (Slot("?y"), Slot("?x", _ROWS["by"])) if len(things) == 2 else (Slot("?x"),)
            names = {thing.name: variable for thing, variable in zip(things, ("?x", "?y"), strict=False)}
            pattern = " ".join(["X", verb, *(["Y"] if len(things) == 2 else [])])
            yield self._row((verb,), slots, self._atom(predicate, names), pattern, f"the predicate {predicate.name}")

    def receipts(self) -> Iterator[GoalRow]:
        """Yield ``give X to Y`` and ``be Y with X`` for the only predicate that joins two such things.

        *Mr Smith needs his aspirin*: what he can have to do with it is that he takes it.
        """
        for predicate, one, other in self._joining():
            for thing, owner in ((one, other), (other, one)):
                atom = self._atom(predicate, {thing.name: "?x", owner.name: "?y"})
                why = f"{predicate.name} joins such things"
                to, with_it = Slot("?y", _ROWS["whither"]), Slot("?x", _ROWS["with"])
                yield self._row(_ROWS["give"], (Slot("?x"), to), atom, "give X to Y", why)
                yield self._row(_ROWS["be"], (Slot("?y"), with_it), atom, "be Y with X", why)
                of_it = Slot("?y", _ROWS["of"])  # "I need a spectrum of Andromeda"
                yield self._row(_ROWS["serve"], (Slot("?x"), of_it), atom, "have X of Y", why)
                if any(self._places(predicate)):
                    continue  # which is said by its own preposition
                inside = Slot("?y", tuple(dict.fromkeys((*_ROWS["vessel"], *_ROWS["resting"]))))
                yield self._row(_ROWS["put"], (Slot("?x"), inside), atom, "put X in Y", why)
                outside = Slot("?y", _ROWS["whence"])
                yield self._row(_ROWS["take"], (Slot("?x"), outside), Not(atom), "take X from Y", why)

    def _joining(self) -> Iterator[tuple[Predicate, TypedName, TypedName]]:
        """Yield the predicates that alone join two such things, each with its parameters."""
        made = [p for p in self.domain.predicates if p.name in self.made and p.name not in self.passing]
        pairs = {p: self.things(p) for p in made if len(self.things(p)) == len(p.parameters) == 2}
        for predicate, (one, other) in pairs.items():
            rivals = [p for p, ends in pairs.items() if p != predicate and self._joins_such(ends, one, other)]
            if not (rivals or self._alike(one, other)):
                yield predicate, one, other

    def _joins_such(self, ends: Sequence[TypedName], one: TypedName, other: TypedName) -> bool:
        """Return whether two parameters may be two things, in either order."""
        first, last = ends
        straight = self._alike(first, one) and self._alike(last, other)
        return straight or (self._alike(first, other) and self._alike(last, one))

    def _alike(self, one: TypedName, other: TypedName) -> bool:
        """Return whether a thing may be both."""
        return self.types.accepts(one.types, other.types) or self.types.accepts(other.types, one.types)

    @staticmethod
    def _leading_to(outcome: str) -> list[str]:
        """Return the verbs that leave something so."""
        return [verb for verb in table("results") if outcome in results(verb)]

    # ------------------------------------------------------------------ actions

    def named_actions(self, *, shortened: bool = False) -> Iterator[GoalRow]:
        """Yield rows for the verbs in the names of actions: what these bring about for their parameters.

        Args:
            shortened: Rows for names without their particle instead: *lay* for ``lay-down``.
        """
        firsts = [split_name(action.name)[:1] for action in self.domain.actions]
        for action in self.domain.actions:
            words = split_name(action.name)
            if shortened and (words[-1] not in words_of("names", "dropped") or firsts.count(words[:1]) > 1):
                continue
            wanted = self._brought_about(action)
            verbs = words[:1] if shortened else tuple(dict.fromkeys(_verbs_of("_".join(words))))
            noun = "" if shortened or not wanted else self._noun_in(action, words)
            if noun:
                yield from self._with_noun(action, words, noun, wanted, alone=firsts.count(words[:1]) == 1)
                if noun not in words_of("parts"):  # "lock the hall" is to lock its door
                    verbs = tuple(verb for verb in verbs if verb != words[0])
            if wanted:
                yield from self._with_slots(action, verbs, wanted)
            else:
                yield from self._of_oneself(action, words)

    def _with_noun(
        self, action: ActionSchema, words: tuple[str, ...], noun: str, wanted: Sequence[Effect], *, alone: bool
    ) -> Iterator[GoalRow]:
        """Yield rows for a name with a noun, and those without it for a verb that stands ``alone`` and says enough."""
        particle = words[-1:] if words[-1] in words_of("names", "particles") else ()
        verb = "_".join((words[0], *particle))  # "switch the light off" for ``switch_light_off``
        yield from self._about_noun(action, verb, noun, _naming(noun, action) or wanted)
        if alone and words[0] not in chain.from_iterable(_ROWS.values()):
            plain = self._with_slots(action, words[:1], wanted)  # "explain chess to Ann" for ``explain_rules``
            yield from (row for row in plain if len(row.slots) > 1)

    def _noun_in(self, action: ActionSchema, words: Sequence[str]) -> str:
        """Return the noun behind the verb of an action's name that none of its parameters is: ``set_chocks``."""
        nouns = [word for word in words[1:] if word not in words_of("names", "particles") and not _is_preposition(word)]
        # a bed is not the bed sheets
        kinds = {word for p in action.parameters for kind in self._kinds(p) for word in (kind, split_name(kind)[-1])}
        # what is a verb as well may be one: ``press-mute``, ``saddle_up``
        return singular("_".join(word for word in nouns if kinds.isdisjoint((word, singular(word)))))

    def _about_noun(self, action: ActionSchema, verb: str, noun: str, wanted: Sequence[Effect]) -> Iterator[GoalRow]:
        """Yield rows for an action whose name has a noun: "put the chocks under the plane" for ``set_chocks``.

        Where a predicate says that one has it, whoever wants that asks for it: "I need an image of Mars".
        """
        mentioned = {term for effect in wanted for term in effect.atom.terms}
        places = [p for p in action.parameters if p.name in mentioned and not self.actor(p)]
        had = any(split_name(e.atom.predicate)[0] in section("having") for e in _naming(noun, action))
        verbs = (verb, *_ROWS["serve"]) if had else (verb,)
        for said in chain(permutations(places, 2), permutations(places, 1)):
            names = {p.name: f"?{'yz'[i]}" for i, p in enumerate(said)}
            slots = tuple(Slot(names[p.name], (*_ANYWHERE, *_ROWS["whither"]), p.types) for p in said)
            formula = conjunction([self._said(effect, names, action) for effect in wanted])
            pattern = " … ".join([f"{verb} {noun}", *("YZ"[i] for i in range(len(said)))])
            yield replace(self._row(verbs, slots, formula, pattern, f"{OF_ACTION}{action.name}"), noun=noun)

    def _brought_about(self, action: ActionSchema) -> list[Effect]:
        """Return what an action makes true of its parameters without a condition, or else what it makes false."""
        wanted = [p.name for p in action.parameters if not self.actor(p)]
        settled = (e for e in action.effects if not e.parameters and e.condition == And())
        own = [e for e in settled if set(e.atom.terms) & set(wanted) and e.atom.predicate not in self.passing]
        return _outcome(action, own) or self._purpose(action, own, wanted)

    def _purpose(self, action: ActionSchema, own: Sequence[Effect], wanted: Sequence[str]) -> list[Effect]:
        """Return those of an action's effects that it is done for."""
        told = {term for effect in own for term in effect.atom.terms}
        first = next((name for name in wanted if name in told), "")  # who drives is not what is driven
        chosen = self._main_effects(action, own, first)
        # what only this action brings about says what it is for: to harvest is to pick, not to hold
        fewest = min((self._makers(e) for e in chosen), default=0)
        return [e for e in chosen if not e.positive or self._makers(e) == fewest]

    def _main_effects(self, action: ActionSchema, own: Sequence[Effect], first: str) -> list[Effect]:
        """Return the effects on what is acted on, the first parameter: to strip a bed does not get hold of a sheet."""
        made, lost = _by_sign(own)
        made_of, lost_of = _by_sign([e for e in own if first in e.atom.terms])
        held = bool(made_of) and not _takes(action) and all(map(self._is_to_hold, made_of))
        if held and (only := [e for e in lost_of if self._makers(e) == 1 and len(e.atom.terms) > 1]):
            return only  # to disconnect a hose is more than to hold it: nothing else makes it be no longer connected
        if lost_of and not (made_of or _moves(made, lost)):
            return lost_of
        return made_of or made or lost

    def _is_to_hold(self, effect: Effect) -> bool:
        """Return whether an effect that other actions have as well says that something is held."""
        held = {word for verb in words_of("verbs", "holding") for word in results(verb)}
        return bool(words_in_name(effect.atom.predicate) & held) and self._makers(effect) > 1

    def _of_oneself(self, action: ActionSchema, words: Sequence[str]) -> Iterator[GoalRow]:
        """Yield rows for an action that only changes the actor: ``wash-gripper``, ``recharge``."""
        own = [e for e in action.effects if not e.parameters and e.condition == And() and not e.atom.terms]
        if not own:
            return
        condition = conjunction([self._said(effect, {}, action) for effect in own])
        noun = "_".join(words[1:])
        why = f"{OF_ACTION}{action.name}"
        yield self._row(("_".join(words),), (), condition, "_".join(words), why)
        nouns = [noun] if noun else table("nouns")["self"]
        for name in nouns:
            row = self._row((words[0],), (), condition, f"{words[0]} {name}", why)
            yield replace(row, noun=name)

    def _makers(self, effect: Effect) -> int:
        """Return how many actions make something of a predicate true, or false, as an effect does."""
        alike = (effect.positive, effect.atom.predicate)
        return sum(any((e.positive, e.atom.predicate) == alike for e in a.effects) for a in self.domain.actions)

    def _with_slots(self, action: ActionSchema, verbs: tuple[str, ...], wanted: Sequence[Effect]) -> Iterator[GoalRow]:
        """One row for each choice of which parameters are said; the others are whatever they may be."""
        mentioned = {term for effect in wanted for term in effect.atom.terms}
        anywhere = self._anywhere(action)
        used = [p for p in action.parameters if p.name in mentioned and not self.actor(p)]
        for count in range(min(len(used), _MOST_SLOTS), 0, -1):
            for said in permutations(used, count):
                names = {p.name: f"?{'xyz'[i]}" for i, p in enumerate(said)}
                acted_on, *others = said
                slots = (Slot("?x", types=acted_on.types), *(Slot(names[p.name], anywhere, p.types) for p in others))
                pattern = " … ".join([verbs[0], *(p.name.removeprefix("?").upper() for p in said)])
                formula = conjunction([self._said(effect, names, action) for effect in wanted])
                yield self._row(verbs, slots, formula, pattern, f"{OF_ACTION}{action.name}")

    def _anywhere(self, action: ActionSchema) -> tuple[str, ...]:
        """Return the prepositions of an action's places.

        An action with a parameter for the relation, such as *in* or *on*, says nothing of what is under something.
        """
        relations = {name for p in action.parameters for name in self.fixed(p)} & set(PREPOSITIONS)
        if not relations:
            return _ANYWHERE
        return tuple(p for p in _ANYWHERE if p in relations or p not in _ROWS["located"])

    def _said(self, effect: Effect, names: Mapping[str, str], action: ActionSchema) -> Formula:
        """Return the condition that an effect brings about, with slots that were not filled left open."""
        left = {p.name: f"?any_{i}" for i, p in enumerate(action.parameters) if p.name not in names}
        terms = tuple({**left, **names}.get(term, term) for term in effect.atom.terms)
        others = tuple(TypedName(left[p.name], p.types) for p in action.parameters if left.get(p.name) in terms)
        atom = Atom(effect.atom.predicate, terms)
        formula = Exists(others, atom) if others else atom
        return formula if effect.positive else Not(formula)


def _takes(action: ActionSchema) -> bool:
    """Return whether an action's name says to take something."""
    take = the_word("verbs", "taking")
    return split_name(action.name)[0] in (take, *family(take))


def _naming(noun: str, action: ActionSchema) -> list[Effect]:
    """Return the effects of an action with a noun in the name of their predicate: ``bed_made``, of ``make_bed``."""
    settled = (e for e in action.effects if not e.parameters and e.condition == And())
    return [e for e in settled if noun in map(singular, words_in_name(e.atom.predicate))]


def _outcome(action: ActionSchema, effects: Sequence[Effect]) -> list[Effect]:
    """Return the effects that the verb of an action's name speaks of: who washes a car wants it clean, and not wet."""
    verb = split_name(action.name)[0]
    said = {word for word in results(verb) if participle(word.removeprefix("-")) != verb}
    return [
        effect
        for effect in effects
        if any(
            w.startswith("-") != effect.positive and w.removeprefix("-") in words_in_name(effect.atom.predicate)
            for w in said
        )
    ]


def _by_sign(effects: Sequence[Effect]) -> tuple[list[Effect], list[Effect]]:
    return [e for e in effects if e.positive], [e for e in effects if not e.positive]


def _journeys(action: ActionSchema) -> Iterator[tuple[Atom, tuple[str]]]:
    """Yield the atoms that an action makes true of one place and false of another, each with the place."""
    settled = [effect for effect in action.effects if effect.condition == And()]
    for made, left in product((e.atom for e in settled if e.positive), [e.atom for e in settled if not e.positive]):
        if left.predicate == made.predicate:
            differing = [there for there, here in zip(made.terms, left.terms, strict=True) if there != here]
            if len(differing) == 1 and differing[0].startswith("?"):
                yield made, (differing[0],)


def _before(formula: Formula, when: str) -> Formula:
    """Return an atom, or one with some arguments left open, as that which was so before the clause or the text."""
    if isinstance(formula, Exists):
        return replace(formula, part=_before(formula.part, when))
    return replace(formula, predicate=f"{formula.predicate}{MARK}{when}") if isinstance(formula, Atom) else formula


def _renamed(formula: Formula, old: str, new: str) -> Formula:
    """Return an atom, or one with some arguments left open, with another name for a variable."""
    if isinstance(formula, Exists):
        return replace(formula, part=_renamed(formula.part, old, new))
    if not isinstance(formula, Atom):
        return formula
    return replace(formula, terms=tuple(new if term == old else term for term in formula.terms))


def _verbs_of(name: str) -> Iterator[str]:
    """Yield the verbs that an action's name says: itself, without a preposition at its end, and its first word."""
    yield name
    words = name.split("_")
    if len(words) == 1:
        return
    if words[1] in words_of("names", "particles"):
        yield "_".join(words[:2])  # "muck out", with ``muck_out_stall``
    if _is_preposition(words[-1]):
        yield "_".join(words[:-1])
    if words[-1] not in words_of("names", "particles"):
        yield words[0]


def participle(name: str) -> str | None:
    """Return the verb of which a name is a past participle; ``None`` for any other name."""
    verb = builtin().verb(name)
    return verb[0] if verb is not None and verb[1] in words_of("outcomes", "participle") else None


def _lasting(name: str) -> str | None:
    """Return the verb of which a name says that it goes on, *point* of ``pointing``; ``None`` for what is held."""
    stem, form, _ = builtin().verb(name) or ("", "", 0)
    return stem if form in words_of("outcomes", "lasting") and not _is_held(name) else None


def _is_held(predicate: str) -> bool:
    """Return whether the name of a predicate begins with a verb of holding: *carry* of ``carries``."""
    stem, _, _ = builtin().verb(split_name(predicate)[0]) or ("", "", 0)
    held = words_of("verbs", "carrying") | words_of("verbs", "holding")
    return not held.isdisjoint((stem, *family(stem)))


def _undoing(verb: str) -> tuple[str, ...]:
    """Return the verbs that undo what a verb does: *unlock*, of *lock*; but not *display*, of *play*."""
    return tuple(other for prefix in section("undoing") if (other := prefix + verb) not in section("not_undoing"))


def _done(name: str) -> str | None:
    """Return the verb of which a name says that it is done: *know* of ``knows``, *wait* of ``waiting``."""
    stem, form, _ = builtin().verb(name) or ("", "", 0)
    return stem if form in words_of("outcomes", "done") else None


def _is_preposition(word: str) -> bool:
    return any(word in members for members in PREPOSITIONS.values())


def _placelike(parameter: TypedName) -> bool:
    """Return whether a parameter may be a thing or a place, although its type has a constant (the floor)."""
    return any(t in words_of("names", "bulk") for t in parameter.types)


def _moves(made: Sequence[Effect], lost: Sequence[Effect]) -> bool:
    """Return whether a predicate is made true of one thing and false of another."""
    return not {e.atom.predicate for e in made}.isdisjoint(e.atom.predicate for e in lost)
