"""A clause as a PDDL goal: the row that fits, its slots filled, its noun phrases quantified."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from itertools import combinations, islice, pairwise

from tmd.errors import TmdError
from tmd.goals.grounder import (
    FALSE,
    TRUE,
    Grounder,
    Moments,
    atoms_of,
    conjunction,
    disjunction,
    negation,
    only_negative,
)
from tmd.goals.nouns import INVERSE, Bound, Memory, Mode, Nouns, Referent, mode_of, relations_said
from tmd.goals.senses import family, results, words_of
from tmd.goals.table import FIRST, PREPOSITIONS, RELATION, GoalRow, GoalTable, Slot, slot_types, split_predicate
from tmd.goals.why import why_impossible
from tmd.language.clause import PERSONS, Clause, NounPhrase, Quantifier, Relation
from tmd.language.lexicon import Lexicon
from tmd.language.pronouns import is_pronoun
from tmd.pddl.conjunctions import predicates_of
from tmd.pddl.grounding import ground_condition
from tmd.pddl.model import And, Atom, Formula, Not, Or
from tmd.pddl.task import Bits, Cube
from tmd.veil.world import World

BE = "be"
_MOST_CHOICES = 200
"""So many ways of choosing two of many things are looked at."""
_PARTICLES = {"in": "in", "on": "on", "into": "in", "onto": "on", "out": "from", "off": "from"}
_SELECTING = frozenset({"except", "besides", "apart_from", "for", "where", "from", "out_of", "off"})
"""Relations that only tell which thing is meant."""
_RESTRICTING = frozenset({"of", "with", "where", "containing"})


class Why(StrEnum):
    """Why there is no goal, or no plan."""

    NO_SUCH_THING = "no-such-thing"
    IMPOSSIBLE = "impossible"
    UNKNOWN_VERB = "unknown-verb"
    NOT_UNDERSTOOD = "not-understood"
    CONDITION = "condition"
    CONTRADICTION = "contradiction"
    GAVE_UP = "gave-up"


@dataclass(frozen=True, slots=True)
class Refused:
    """Why a clause has no goal here; ``hint`` is what could be said or done instead."""

    why: Why
    message: str
    hint: str | None = None


@dataclass(frozen=True, slots=True)
class ClauseGoal:
    """What a clause asks for.

    Attributes:
        clause: The clause.
        formula: The goal, over ground atoms.
        cubes: The same as a disjunction of conjunctions over the task's atoms.
        row: The row it was read by; ``None`` for a state ("the door is open").
        meant: For each noun the objects it may mean.
        approach: What shall hold on the way, before the goal does: *in the microwave*, *with the remote*.
        released: Objects whose earlier commitments need not be kept: what is poured leaves where it was.
        touches: Things that were named; a plan that touches none of a group did something else.
        notes: What of the clause was not taken into account.
    """

    clause: Clause
    formula: Formula
    cubes: tuple[Cube, ...]
    row: GoalRow | None = None
    meant: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    approach: tuple[Formula, ...] = ()
    released: tuple[str, ...] = ()
    touches: tuple[tuple[str, tuple[str, ...]], ...] = ()
    notes: tuple[str, ...] = ()


@dataclass(slots=True)
class _Unit:
    """One thing that the verb acts on, with what stands behind prepositions."""

    direct: str | None
    relations: list[tuple[str, str]]


@dataclass(slots=True)
class _Reading:
    """What one clause is read with, in one state."""

    clause: Clause
    state: Bits
    moments: Moments
    memory: Memory
    notes: list[str] = field(default_factory=list)
    meant: dict[str, tuple[str, ...]] = field(default_factory=dict)
    approach: list[Formula] = field(default_factory=list)
    released: list[str] = field(default_factory=list)
    wanted: dict[str, tuple[str, ...]] = field(default_factory=dict)
    """Adjectives of nouns that tell what shall be, not which thing is meant."""
    asked: set[str] = field(default_factory=set)
    """The nouns whose meaning is being asked for: none leads to itself."""
    strict: bool = False
    """Every place that was said must have a slot."""
    pronoun: str | None = None
    antecedent: int | None = None
    """Which of what ``pronoun`` may mean is tried."""


class GoalReader:
    """Reads clauses as goals in one environment.

    Args:
        world: The environment.
        tables: What verbs mean, the surest source first; adjectives and groups are those of the first.
        lexicon: The domain's words.
        guess: Whether a thing may be taken for what a noun is only like in meaning.
    """

    def __init__(
        self,
        world: World,
        tables: Sequence[GoalTable],
        lexicon: Lexicon,
        *,
        guess: bool = False,
    ) -> None:
        self.world = world
        self.tables = tuple(tables)
        self.lexicon = lexicon
        self.domain = world.task.problem.domain
        self.grounder = Grounder(world)
        self.nouns = Nouns(world, tables[0] if tables else GoalTable(), self.grounder, guess=guess)

    # ------------------------------------------------------------------ clauses

    def read(self, clause: Clause, state: Bits, memory: Memory) -> ClauseGoal | Refused:
        """What ``clause`` asks for, said when ``state`` holds."""
        reading = _Reading(clause, state, Moments(state, memory.first), memory)
        if (clause.verb == BE or clause.result) and not self._rows_with(clause):
            return self._state(reading)
        own = list(dict.fromkeys((clause.verb, *self._synonyms(clause.verb))))
        plain = clause.verb.partition("_")[0]
        if plain != clause.verb:
            own += [v for v in (plain, *self._synonyms(plain)) if v not in own]
        failure: Refused | None = None
        for table in self.tables:  # a weaker source is asked only where the surer ones know nothing
            found = self._by_table(table, own, reading)
            if isinstance(found, ClauseGoal):
                return found
            failure = failure or found
            if found is not None and found.why is not Why.NOT_UNDERSTOOD:
                return found
        return failure or self._unknown(clause)

    def _by_table(self, table: GoalTable, own: Sequence[str], reading: _Reading) -> ClauseGoal | Refused | None:
        """The goal by the rows of one source; ``None`` where it knows neither the verb nor its family."""
        failure: Refused | None = None
        others = self._family(own)
        for strict, verbs in ((True, own), (True, others), (False, own), (False, others)):
            for rows in filter(None, map(table.of, verbs)):
                found = self._by_rows(rows, replace_reading(reading, strict))
                if isinstance(found, ClauseGoal):
                    return found
                if failure is None or failure.why is Why.NOT_UNDERSTOOD:
                    failure = found
            settled = failure is not None and failure.why is not Why.NOT_UNDERSTOOD
            if settled and (not strict or self._is_placing(reading.clause)):
                return failure
        return failure

    def _is_placing(self, clause: Clause) -> bool:
        """Whether a clause says where something shall go: if it cannot go there, nothing less will do."""
        placing = {"put", "place", "pour", "add"} & {clause.verb, *self._synonyms(clause.verb), *family(clause.verb)}
        return bool(placing) and any(r.source in clause.direct and r.relation != "of" for r in clause.relations)

    def _rows_with(self, clause: Clause) -> bool:
        """Whether some row says what this verb with this state means."""
        verbs = (clause.verb, *self._synonyms(clause.verb))
        return any(row.result == clause.result for t in self.tables for v in verbs for row in t.of(v))

    def _synonyms(self, verb: str) -> tuple[str, ...]:
        canonical = self.lexicon.canonical_verb(verb)
        return (canonical,) if canonical != verb else ()

    def _family(self, own: Sequence[str]) -> list[str]:
        """Verbs that ask for the same as ``own`` in English, whatever the domain."""
        return [verb for verb in dict.fromkeys(name for one in own for name in family(one)) if verb not in own]

    def _unknown(self, clause: Clause) -> Refused:
        known = sorted({verb for table in self.tables for verb in table.verbs()} - {BE})
        verb = clause.verb.replace("_", " ")
        hint = f"say it with another verb, such as {', '.join(known[:6])}" if known else None
        return Refused(Why.UNKNOWN_VERB, f"nobody has shown or declared what '{verb}' means", hint)

    def _by_rows(self, rows: Sequence[GoalRow], reading: _Reading) -> ClauseGoal | Refused:
        """The goal by the first rows that fit every thing the verb acts on."""
        formulas: list[Formula] = []
        used: GoalRow | None = None
        for unit in self._units(reading):
            found = self._unit(rows, unit, reading)
            if isinstance(found, Refused):
                return found
            formula, used = found
            formulas.append(formula)
        either = any(reading.clause.phrase(name).either for name in reading.clause.direct)
        whole = disjunction(formulas) if either else conjunction(formulas)
        return self._finished(whole, used, reading)

    def _finished(self, formula: Formula, row: GoalRow | None, reading: _Reading) -> ClauseGoal | Refused:
        if any(reading.clause.phrase(n).quantifier is Quantifier.NONE for n in reading.clause.direct):
            formula = negation(formula)
        try:
            cubes = self.cubes(formula)
        except TmdError as error:
            return Refused(Why.NOT_UNDERSTOOD, error.message, error.hint)
        if not cubes:
            return Refused(Why.CONTRADICTION, f"'{reading.clause.text}' asks for what cannot hold at the same time")
        groups = tuple((noun, names) for noun, names in reading.meant.items() if names)
        return ClauseGoal(
            reading.clause,
            formula,
            cubes,
            row,
            dict(reading.meant),
            tuple(reading.approach),
            tuple(reading.released),
            groups,
            tuple(dict.fromkeys(reading.notes)),
        )

    def cubes(self, formula: Formula) -> tuple[Cube, ...]:
        """A ground condition as cubes; where there are too many cases, with fewer choices.

        Raises:
            TmdError: There are too many even so.
        """
        for most in (None, 8, 3, 1):
            try:
                return ground_condition(self.world.task, formula if most is None else _fewer(formula, most))
            except TmdError:
                if most == 1:
                    raise
        return ()

    # ------------------------------------------------------------------ units

    def _units(self, reading: _Reading) -> list[_Unit]:
        """What the verb acts on, one by one, with the relations of each; measures make room for what they measure."""
        clause = reading.clause
        direct = [name for name in clause.direct if name not in PERSONS]
        if not direct:
            direct = [""] if "" in clause.antecedents else []
        units = [_Unit(name, self._relations_of(name, clause)) for name in direct]
        for unit in units:
            measured = next((t for r, t in unit.relations if r == "of"), None)
            if unit.direct in words_of("measures") and measured is not None:
                unit.relations = [(r, t) for r, t in unit.relations if r != "of"] + self._relations_of(measured, clause)
                unit.direct = measured
        if clause.implied:
            # "pillows and blanket on the sofa": what has no place of its own goes where the next one does
            for unit, following in reversed(list(pairwise(units))):
                unit.relations = unit.relations or list(following.relations)
        return units or [_Unit(None, [(r.relation, r.target) for r in clause.relations if r.source is None])]

    def _relations_of(self, name: str, clause: Clause) -> list[tuple[str, str]]:
        found = [
            (r.relation, r.target) for r in clause.relations if r.source == name or (r.source is None and not name)
        ]
        if clause.setting and name in (*clause.direct, ""):
            found.append(("to", clause.setting.split()[-1]))
        return [(r, t) for r, t in found if t not in PERSONS]

    def _unit(self, rows: Sequence[GoalRow], unit: _Unit, reading: _Reading) -> tuple[Formula, GoalRow] | Refused:
        """The goal of one thing; a pronoun is what it most likely means of that which a row fits."""
        if unit.direct is None or not self._points_back(unit.direct):
            return self._with_rows(rows, unit, reading)
        failure: Refused | None = None
        held: tuple[tuple[Formula, GoalRow], dict[str, tuple[str, ...]]] | None = None
        reading.pronoun = unit.direct
        options = self._antecedents(unit.direct, reading)
        for number in range(len(options) or 1):
            reading.antecedent = number
            before = dict(reading.meant)
            found = self._with_rows(rows, unit, reading)
            if isinstance(found, Refused):
                failure = failure or found
            elif self.grounder.truth(found[0], reading.state) and atoms_of(found[0]):
                held = held or (found, reading.meant)  # so already: rather what is not
                reading.meant = before
            elif held is None or not options[number][1] or _looks_back(found[1]):
                return found
        if held is not None:
            reading.meant = held[1]
            return held[0]
        assert failure is not None
        return failure

    def _points_back(self, noun: str) -> bool:
        return not noun or is_pronoun(noun) or noun in words_of("anaphors")

    def _antecedents(self, noun: str, reading: _Reading) -> list[tuple[str, bool]]:
        """What a pronoun may mean, likeliest first: nouns, then (marked) objects that were spoken of."""
        clause, memory = reading.clause, reading.memory
        if noun in clause.antecedents and clause.together.get(noun, 1) > 1:
            return [(noun, False)]
        nouns = [(name, False) for name in clause.antecedents.get(noun, ())]
        seen = {n for name, _ in nouns for n in (memory.bound[name].names if name in memory.bound else ())}
        return [*nouns, *((name, True) for name in memory.recent if name not in seen)]

    def _with_rows(self, rows: Sequence[GoalRow], unit: _Unit, reading: _Reading) -> tuple[Formula, GoalRow] | Refused:
        """The goal of one thing by the row with the most slots that fits and can hold."""
        failure: Refused | None = None
        counted = reading.clause.phrase(unit.direct or "").quantifier in (Quantifier.ALL, Quantifier.NUMBER)
        fitting = sorted(
            (r for r in rows if self._fits(r, unit, reading)),
            key=lambda row: (
                -len(row.slots) - (row.noun is not None),
                counted and not self._takes_things(row, unit, reading),
            ),
        )
        for place, row in enumerate(fitting):
            before = dict(reading.meant), list(reading.approach), list(reading.notes)
            found = self._by_row(row, unit, reading)
            if not isinstance(found, Refused) and self.grounder.truth(found, reading.state):
                # what holds already told which thing is meant, if the verb can do without it
                shorter = [r for r in fitting[place + 1 :] if len(r.slots) < len(row.slots)]
                other = self._with_rows(shorter, unit, reading) if shorter else None
                if other is not None and not isinstance(other, Refused):
                    return other
            if not isinstance(found, Refused):
                return found, row
            failure = failure or found
            reading.meant, reading.approach, reading.notes = before
        if failure is not None:
            return failure
        said = print_clause_text(reading.clause)
        known = "; ".join(dict.fromkeys(row.pattern for row in rows))
        return Refused(Why.NOT_UNDERSTOOD, f"'{said}' does not fit what is known of its verb", f"known: {known}")

    def _takes_things(self, row: GoalRow, unit: _Unit, reading: _Reading) -> bool:
        """Whether what the verb acts on may be an object, not only something that objects contain."""
        if row.direct is None or unit.direct is None:
            return False
        types = slot_types(row.condition, row.direct.variable, self.domain)
        return any(self.grounder.is_a(name, types) for name in self.nouns.things(unit.direct, reading.state))

    def _fits(self, row: GoalRow, unit: _Unit, reading: _Reading) -> bool:
        if (row.result or None) != (reading.clause.result if row.result else None):
            return False
        if row.noun is not None and row.noun != unit.direct:
            return False
        if row.noun is None and (row.direct is None) != (unit.direct is None):
            return False
        return all(self._fillers(slot, unit, reading) for slot in row.places)

    def _fillers(self, slot: Slot, unit: _Unit, reading: _Reading) -> list[tuple[str, str | None]]:
        """What was said in a slot: relation and noun; a particle alone leaves the noun to what was spoken of."""
        said = [(r, t) for r, t in unit.relations if relations_said(r, slot.prepositions)]
        if len({r for r, _ in said}) > 1 or len(said) > 1:
            # "the mug in the sink on the shelf": what holds already tells which mug, the rest where it shall go
            said = [pair for pair in said if not self._tells_which(unit, *pair, reading)] or said[-1:]
        if said:
            first = said[0][0]
            return [(r, t) for r, t in said if r == first]
        if not reading.memory.recent:
            return []
        particle = _PARTICLES.get(reading.clause.verb.rpartition("_")[2])
        if particle in slot.prepositions:
            return [(particle, None)]
        # "take a cup, add sugar": into what was spoken of last
        wants_place = {"put", "add", "pour"} & {reading.clause.verb, *family(reading.clause.verb)}
        into = next((p for p in slot.prepositions if p in ("in", "on")), None)
        return [(into, None)] if wants_place and into and not unit.relations else []

    def _unplaced(self, unit: _Unit, relation: str, target: str, reading: _Reading) -> bool:
        """Whether a relation says a place where what is acted on is not yet."""
        place = relation in ("in", "into", "inside", "on", "onto", "to", "next_to", "on_top_of", "over", "beside")
        return place and bool(self._targets(target, reading)) and not self._tells_which(unit, relation, target, reading)

    def _tells_which(self, unit: _Unit, relation: str, target: str, reading: _Reading) -> bool:
        """Whether a relation of what is acted on holds now of one of its candidates."""
        if not unit.direct:
            return False
        referent = Referent(unit.direct, self.nouns.things(unit.direct, reading.state))
        names = self._targets(target, reading)
        return bool(self.nouns.related_now(referent, relation, names, reading.state, reading.moments))

    # ------------------------------------------------------------------ one row

    def _by_row(self, row: GoalRow, unit: _Unit, reading: _Reading) -> Formula | Refused:
        """The goal of one thing by one row: for each combination of what stands behind the prepositions."""
        consumed: set[tuple[str, str | None]] = set()
        choices: list[list[tuple[Slot, str, str | None]]] = [[]]
        alternatives = False
        for slot in row.places:
            fillers = self._fillers(slot, unit, reading)
            consumed.update(fillers)
            alternatives = alternatives or any(t and reading.clause.phrase(t).either for _, t in fillers)
            choices = [[*c, (slot, relation, target)] for c in choices for relation, target in fillers]
        leftover = [pair for pair in unit.relations if pair not in consumed]
        if reading.strict and any(self._unplaced(unit, *pair, reading) for pair in leftover):
            return Refused(
                Why.NOT_UNDERSTOOD, f"'{print_clause_text(reading.clause)}' says a place that nothing is known of"
            )
        formulas = []
        for choice in choices:
            found = self._combination(row, unit.direct, choice, leftover, reading)
            if isinstance(found, Refused):
                if not alternatives:
                    return found
                continue
            formulas.append(found)
        if not formulas:
            return Refused(Why.IMPOSSIBLE, f"'{print_clause_text(reading.clause)}' cannot be done here")
        return disjunction(formulas) if alternatives else conjunction(formulas)

    def _combination(
        self,
        row: GoalRow,
        direct: str | None,
        places: Sequence[tuple[Slot, str, str | None]],
        leftover: Sequence[tuple[str, str]],
        reading: _Reading,
    ) -> Formula | Refused:
        slots: list[tuple[Slot, list[Referent]]] = []
        if row.direct is not None and direct is not None:
            slots.append((row.direct, self._referents(direct, row, row.direct, leftover, reading)))
            slots[0] = (row.direct, [self._at_origin(r, places, reading) for r in slots[0][1]])
        relations: dict[str, tuple[str, ...]] = {}
        for slot, relation, target in places:
            relations[slot.variable] = relations_said(relation, slot.prepositions)
            noun = "" if target is None else target
            slots.append(
                (
                    slot,
                    self._referents(noun, row, slot, self._relations_of(noun, reading.clause) if noun else (), reading),
                )
            )
        failure: Refused | None = None
        for chosen in _product([options for _, options in slots]):
            if any(not referent.names for referent in chosen):
                missing = next(referent for referent in chosen if not referent.names)
                failure = failure or self._missing(missing, reading)
                continue
            pairs = [(slot.variable, referent) for (slot, _), referent in zip(slots, chosen, strict=True)]
            formula = self._formula(row, pairs, relations, direct, leftover, reading)
            if formula == FALSE:
                failure = failure or self._impossible(row, pairs, relations, reading)
                continue
            for _, referent in pairs:
                reading.meant[referent.noun] = referent.names
            return formula
        return failure or Refused(Why.IMPOSSIBLE, f"'{print_clause_text(reading.clause)}' cannot be done here")

    def _at_origin(
        self, referent: Referent, places: Sequence[tuple[Slot, str, str | None]], reading: _Reading
    ) -> Referent:
        """*Everything off the table*: of what is meant, what is there now."""
        for _, relation, target in places:
            if target is not None and relation in PREPOSITIONS["from"]:
                ends = self._targets(target, reading)
                there = self.nouns.related_now(referent, relation, ends, reading.state, reading.moments)
                referent = replace(referent, names=there or referent.names)
        return referent

    def _formula(
        self,
        row: GoalRow,
        pairs: Sequence[tuple[str, Referent]],
        relations: Mapping[str, tuple[str, ...]],
        direct: str | None,
        leftover: Sequence[tuple[str, str]],
        reading: _Reading,
    ) -> Formula:
        """The condition of a row with its slots quantified, and what else was said of the thing acted on."""
        said = [r for names in relations.values() for r in names] or [""]
        variables = [variable for variable, _ in pairs]

        def leaf(binding: Mapping[str, str]) -> Formula:
            if len(set(binding.values())) < len(binding):
                return FALSE
            self.grounder.live = 0
            return disjunction(
                self.grounder.ground(row.condition, {**binding, RELATION: one}, variables, reading.moments)
                for one in said
            )

        further = self._further(row, pairs, direct, leftover, reading)

        def whole(binding: Mapping[str, str]) -> Formula:
            formula = leaf(binding)
            if formula == FALSE or not (self.grounder.live or row.traceless):
                return FALSE  # what can never be so is not "not so already"
            return conjunction((formula, *(extra(binding) for extra in further))) if further else formula

        each = [p for p in pairs if p[1].each]
        one = [p for p in pairs if p[1].mode is Mode.ANY and not p[1].each]
        many = [p for p in pairs if p[1].mode is not Mode.ANY and not p[1].each]
        formula = self._quantified([*each, *one, *many], {}, whole, reading)
        if formula == FALSE and one and many:
            formula = self._quantified([*each, *many, *one], {}, whole, reading)
        return formula

    def _quantified(
        self,
        pairs: Sequence[tuple[str, Referent]],
        binding: Mapping[str, str],
        leaf: Callable[[Mapping[str, str]], Formula],
        reading: _Reading,
    ) -> Formula:
        """The condition over all candidates, quantifier after quantifier."""
        if not pairs:
            return leaf(binding)
        (variable, referent), *rest = pairs
        parts = {name: self._quantified(rest, {**binding, variable: name}, leaf, reading) for name in referent.names}
        alive = {name: part for name, part in parts.items() if part != FALSE}
        match referent.mode:
            case Mode.ALL:
                kept = alive if referent.loose else parts
                return conjunction(kept.values()) if kept else FALSE
            case Mode.NUMBER:
                ways = islice(combinations(alive.values(), referent.number), _MOST_CHOICES)
                return disjunction(conjunction(way) for way in ways)
            case Mode.NONE:
                return conjunction(parts.values()) if len(parts) == 1 else disjunction(alive.values())
        if referent.definite and len(alive) > 1:
            open_ = [part for part in alive.values() if not self.grounder.truth(part, reading.state)]
            if open_ and all(only_negative(part) for part in alive.values()):
                return conjunction(open_)
            if open_:
                return disjunction(open_)
        return disjunction(alive.values())

    def _further(
        self,
        row: GoalRow,
        pairs: Sequence[tuple[str, Referent]],
        direct: str | None,
        leftover: Sequence[tuple[str, str]],
        reading: _Reading,
    ) -> list[Callable[[Mapping[str, str]], Formula]]:
        """What must hold besides: contents, *without*, adjectives of a substance, where further nouns are."""
        found: list[Callable[[Mapping[str, str]], Formula]] = []
        for variable, referent in pairs:
            noun = referent.noun
            relations = leftover if noun == direct else self._relations_of(noun, reading.clause)
            for relation, target in relations:
                if relation in _SELECTING or relation.startswith("not_"):
                    continue
                names = self._targets(target, reading)
                if relation == "without" or reading.clause.phrase(target).quantifier is Quantifier.NONE:
                    found.append(self._without(row, pairs, names, reading))
                    continue
                if not names or set(names) <= set(referent.names):
                    continue
                beside = self.nouns.constants(target, ("object",), reading.state)
                if relation in ("with", "and") and beside and self._is_substance(referent):
                    found.append(self._beside(row, variable, beside))
                    continue
                if self.nouns.related_now(referent, relation, names, reading.state, reading.moments):
                    continue
                tool = noun == direct and relation in ("with", "using", "by", "via", "through")
                if tool and self._tool(names, reading):
                    continue
                if noun == direct and relation not in _RESTRICTING and row.places != ():
                    self._approach(referent, relation, names, reading)
                    continue
                if noun == direct and relation not in _RESTRICTING:
                    self._approach(referent, relation, names, reading)
                    continue
                found.append(self._relation_goal(variable, relation, names, reading))
        found += self._substance_attributes(row, pairs, reading)
        for variable, referent in pairs:
            if referent.noun in reading.wanted:
                found.append(self._state_wanted(variable, reading.wanted[referent.noun], reading))
        return found

    def _state_wanted(
        self, variable: str, words: Sequence[str], reading: _Reading
    ) -> Callable[[Mapping[str, str]], Formula]:
        def goal(binding: Mapping[str, str]) -> Formula:
            said = (self.nouns.attribute(word, binding[variable], reading.moments) for word in words)
            return conjunction(formula for formula in said if formula is not None)

        return goal

    def _relation_goal(
        self, variable: str, relation: str, names: Sequence[str], reading: _Reading
    ) -> Callable[[Mapping[str, str]], Formula]:
        def goal(binding: Mapping[str, str]) -> Formula:
            return disjunction(
                self.nouns.related(relation, binding[variable], name, reading.moments)
                for name in names
                if name != binding[variable]
            )

        return goal

    def _approach(self, referent: Referent, relation: str, names: Sequence[str], reading: _Reading) -> None:
        """Do it there, or with that: a place or a tool that no slot takes."""
        formula = disjunction(
            self.nouns.related(relation, name, target, reading.moments)
            for name in referent.names
            for target in names
            if name != target
        )
        if formula not in (FALSE, TRUE):
            reading.approach.append(formula)
        reading.meant.setdefault(f"{relation} {names[0]}", tuple(names))

    def _is_substance(self, referent: Referent) -> bool:
        return bool(referent.names) and all(name in self.world.profiles.constants for name in referent.names)

    def _beside(self, row: GoalRow, variable: str, names: Sequence[str]) -> Callable[[Mapping[str, str]], Formula]:
        """*Coffee with milk*: what the goal says of the one shall hold of the other as well, of the same thing."""

        def goal(binding: Mapping[str, str]) -> Formula:
            now = Moments(0, 0)
            own = self.grounder.ground(row.condition, {**binding, RELATION: "in"}, binding, now)
            ways = []
            for atom in sorted(atoms_of(own)):
                if binding[variable] not in atom.args:
                    continue
                for name in names:
                    other = atom._replace(args=tuple(name if a == binding[variable] else a for a in atom.args))
                    if other in self.world.task.index:
                        both = (Atom(atom.predicate, atom.args), Atom(other.predicate, other.args))
                        ways.append(conjunction(both))
            return disjunction(ways) if ways else FALSE

        return goal

    def _tool(self, names: Sequence[str], reading: _Reading) -> bool:
        """Whether things are said to be used: they are taken first, where they can be."""
        if any(name in self.world.profiles.constants for name in names):
            return False
        contents = [n for n in names if self.nouns.contents(n, reading.state)]
        held = [self.nouns.state_of(results("hold"), name) for name in names]
        formula = disjunction(f for f in held if f is not None)
        if formula in (FALSE, TRUE):
            return not contents
        reading.approach.append(formula)
        reading.meant.setdefault(f"with {names[0]}", tuple(names))
        return True

    def _without(
        self, row: GoalRow, pairs: Sequence[tuple[str, Referent]], names: Sequence[str], reading: _Reading
    ) -> Callable[[Mapping[str, str]], Formula]:
        """None of ``names`` where the goal puts something else of their kind."""

        def goal(binding: Mapping[str, str]) -> Formula:
            own = self.grounder.ground(row.condition, {**binding, RELATION: "in"}, binding, reading.moments)
            found = []
            for atom in atoms_of(own):
                for place, argument in enumerate(atom.args):
                    for name in names:
                        other = atom._replace(args=(*atom.args[:place], name, *atom.args[place + 1 :]))
                        alike = self.world.mentions.types[name][1:2] == self.world.mentions.types.get(argument, ())[1:2]
                        same = self.world.mentions.types[name][0] == self.world.mentions.types.get(argument, ("",))[0]
                        if (alike or same) and other in self.world.task.index:
                            found.append(Not(Atom(other.predicate, other.args)))
            return conjunction(found)

        return goal

    def _substance_attributes(
        self, row: GoalRow, pairs: Sequence[tuple[str, Referent]], reading: _Reading
    ) -> list[Callable[[Mapping[str, str]], Formula]]:
        """*Hot milk*: what contains the milk in the end shall be hot."""
        found: list[Callable[[Mapping[str, str]], Formula]] = []
        for variable, referent in pairs:
            words = reading.clause.phrase(referent.noun).attributes
            if not words or not all(name in self.world.profiles.constants for name in referent.names):
                continue

            def goal(binding: Mapping[str, str], variable: str = variable, words: tuple[str, ...] = words) -> Formula:
                own = self.grounder.ground(row.condition, {**binding, RELATION: "in"}, binding, reading.moments)
                ways = []
                for atom in sorted(atoms_of(own)):
                    things = [a for a in atom.args if a not in self.world.profiles.constants]
                    said = [self.nouns.attribute(word, things[0], reading.moments) for word in words] if things else []
                    if binding[variable] in atom.args and things and all(f is not None for f in said):
                        ways.append(conjunction((Atom(atom.predicate, atom.args), *(f for f in said if f is not None))))
                return disjunction(ways) if ways else TRUE

            found.append(goal)
        return found

    # ------------------------------------------------------------------ nouns

    def _referents(
        self, noun: str, row: GoalRow, slot: Slot, relations: Iterable[tuple[str, str]], reading: _Reading
    ) -> list[Referent]:
        """What may stand in a slot, likeliest first: one reading for a noun, one for each antecedent of a pronoun."""
        types = slot_types(row.condition, slot.variable, self.domain)
        clause = reading.clause
        phrase = clause.phrase(noun)
        if not self._points_back(noun):
            return [self._named(noun, phrase, types, list(relations), reading)]
        if noun in clause.antecedents and clause.together.get(noun, 1) > 1:
            return [self._together(clause.antecedents[noun][: clause.together[noun]], noun, types, reading)]
        options = self._antecedents(noun, reading)
        if reading.antecedent is not None and noun == reading.pronoun:
            options = options[reading.antecedent : reading.antecedent + 1]
        found = []
        for name, is_object in options:
            if not is_object:
                found.append(self._antecedent(name, noun, types, reading))
            elif self.grounder.is_a(name, types):
                found.append(Referent(noun or "it", (name,), definite=True))
            else:
                inside = tuple(c for c in self.nouns.contents(name, reading.state) if self.grounder.is_a(c, types))
                found.append(Referent(noun or "it", inside))
        return [referent for referent in found if referent.names] or [Referent(noun or "it", ())]

    def _antecedent(self, antecedent: str, pronoun: str, types: tuple[str, ...], reading: _Reading) -> Referent:
        """What a pronoun means if it stands for ``antecedent``: what that turned out to be."""
        if pronoun in ("one", "ones"):
            said = reading.clause.phrase(pronoun)
            relations = self._relations_of(pronoun, reading.clause)
            return replace(
                self._named(antecedent, replace(said, name=antecedent), types, relations, reading), noun=pronoun
            )
        bound = reading.memory.bound.get(antecedent)
        many = pronoun in ("them", "they", "these", "those", "both", "all")
        if bound is not None:
            names = tuple(n for n in (*bound.names, *bound.containers) if self.grounder.is_a(n, types))
            if not names:
                inside = (c for n in (*bound.names, *bound.containers) for c in self.nouns.contents(n, reading.state))
                names = tuple(dict.fromkeys(c for c in inside if self.grounder.is_a(c, types)))
                return Referent(antecedent, names)
            mode = Mode.ALL if many and len(names) > 1 else Mode.ANY
            return Referent(antecedent, names if mode is Mode.ALL else names[:1] or names, mode, definite=True)
        return self._named(antecedent, NounPhrase(antecedent, definite=True, plural=many), types, [], reading)

    def _together(self, nouns: Sequence[str], pronoun: str, types: tuple[str, ...], reading: _Reading) -> Referent:
        names: dict[str, None] = {}
        for noun in nouns:
            names.update(dict.fromkeys(self._antecedent(noun, "them", types, reading).names))
        return Referent(pronoun, tuple(names), Mode.ALL)

    def _named(
        self,
        noun: str,
        phrase: NounPhrase,
        types: tuple[str, ...],
        relations: Sequence[tuple[str, str]],
        reading: _Reading,
    ) -> Referent:
        """The candidates of a noun of the wanted type, but for those that adjectives and relations leave out."""
        things = tuple(n for n in self.nouns.things(noun, reading.state) if self.grounder.is_a(n, types))
        wanted_constants = tuple(n for n in self.nouns.constants(noun, types, reading.state))
        objects = tuple(n for n in things if n not in self.world.profiles.constants)
        group = self.nouns.is_group(noun)
        if not objects and wanted_constants:
            mode, number = mode_of(phrase, group=False, thing=False)
            return Referent(noun, wanted_constants, mode, number, phrase.definite)
        mode, number = mode_of(phrase, group=group, thing=True)
        if mode is not Mode.ANY and not group:
            objects, group = self._all_kinds(noun, objects, types, reading)
        if phrase.number == 2 and mode is Mode.ALL:
            mode, number, group = Mode.NUMBER if len(objects) != 2 else mode, 2, False
        referent = Referent(noun, objects, mode, number, phrase.definite, group, phrase.each)
        whole = referent.names
        referent, unknown = self.nouns.narrowed(referent, phrase, reading.state, reading.moments)
        if whole and not referent.names and any(relation == "of" for relation, _ in relations):
            # "a hot cup of coffee": the cup shall be so, with what is in it
            reading.wanted[noun] = phrase.attributes
            referent = replace(referent, names=whole)
        if any(word.startswith(("that_", "which_", "who_")) for word in unknown) and len(referent.names) > 1:
            referent = replace(referent, names=())
        reading.notes += [f"'{word.replace('_', ' ')}' says nothing here that could be checked" for word in unknown]
        referent = self._restricted(referent, relations, reading)
        bound = reading.memory.bound.get(noun)
        if bound is not None and phrase.quantifier is Quantifier.OTHER:
            return replace(referent, names=tuple(n for n in referent.names if n not in bound.names))
        if bound is not None and phrase.definite and mode is Mode.ANY and set(bound.names) & set(referent.names):
            return replace(referent, names=tuple(n for n in referent.names if n in bound.names))
        return referent

    def _all_kinds(
        self, noun: str, objects: tuple[str, ...], types: tuple[str, ...], reading: _Reading
    ) -> tuple[tuple[str, ...], bool]:
        """*All the lights*, where no class has that name, are the things of every class that the noun may mean."""
        matches = self.world.mentions.of(noun, reading.state)
        if len(objects) == 1 and noun in self.lexicon.nouns:
            wider = set(self.lexicon.nouns[noun])
            kinds = self.world.mentions.kinds
            names = [n for n in self.world.profiles.objects if kinds.get(n) in wider and self.grounder.is_a(n, types)]
            return (tuple(names), True) if len(names) > 1 else (objects, False)
        if not matches or matches[0].how != "alias":
            return objects, False
        names = [m.name for m in matches if m.how == "alias" and m.name not in self.world.profiles.constants]
        return tuple(n for n in names if self.grounder.is_a(n, types)), True

    def _restricted(self, referent: Referent, relations: Sequence[tuple[str, str]], reading: _Reading) -> Referent:
        """The candidates that stand in the relations that were said, where some do; *except* takes some away."""
        for relation, target in relations:
            names = self._targets(target, reading)
            if relation in ("except", "besides", "apart_from"):
                referent = replace(referent, names=tuple(n for n in referent.names if n not in names))
                continue
            if relation.startswith("not_"):
                now = self.nouns.related_now(
                    referent, relation.removeprefix("not_"), names, reading.state, reading.moments
                )
                referent = replace(referent, names=tuple(n for n in referent.names if n not in now))
                continue
            if relation in ("without", "for") or not names:
                continue
            now = self.nouns.related_now(referent, relation, names, reading.state, reading.moments)
            if now or relation in INVERSE or relation == "where":
                referent = replace(referent, names=now)  # what stands on nothing has no burner under it
        return referent

    def _targets(self, noun: str, reading: _Reading) -> tuple[str, ...]:
        """The objects or constants that a noun behind a preposition may mean."""
        if noun in reading.asked:
            return ()
        reading.asked.add(noun)
        try:
            return self._meant_by(noun, reading)
        finally:
            reading.asked.discard(noun)

    def _meant_by(self, noun: str, reading: _Reading) -> tuple[str, ...]:
        if is_pronoun(noun):
            names = tuple(n for a in reading.clause.antecedents.get(noun, ())[:1] for n in self._targets(a, reading))
            names = names or tuple(
                n for a in reading.clause.direct[:1] if noun == "one" for n in self._targets(a, reading)
            )
            for relation, target in self._relations_of(noun, reading.clause):
                ends = self._targets(target, reading)
                referent = Referent(noun, names)
                names = self.nouns.related_now(referent, relation, ends, reading.state, reading.moments) or names
            return names
        bound = reading.memory.bound.get(noun)
        things = self.nouns.things(noun, reading.state)
        if bound is not None and set(bound.names) & set(things):
            return tuple(n for n in things if n in bound.names)
        constants = self.nouns.constants(noun, ("object",), reading.state)
        return tuple(dict.fromkeys((*things, *constants)))

    # ------------------------------------------------------------------ states

    def _state(self, reading: _Reading) -> ClauseGoal | Refused:
        """What is to be so: *the door is open*, *get the water boiling*, *there is milk in the cup*."""
        clause = reading.clause
        names = [n for n in (clause.direct or clause.objects[:1]) if n not in PERSONS] or [""]
        formulas = []
        for noun in names:
            found = self._state_of(noun, reading)
            if isinstance(found, Refused):
                return found
            formulas.append(found)
        return self._finished(conjunction(formulas), None, reading)

    def _state_of(self, noun: str, reading: _Reading) -> Formula | Refused:
        clause = reading.clause
        relations = self._relations_of(noun, clause)
        constants = self._substance(noun, reading) if noun and not is_pronoun(noun) else ()
        if constants:
            return self._substance_state(noun, constants, relations, reading)
        row = GoalRow((BE,), (Slot("?x"),), TRUE, BE)
        failure: Refused | None = None
        for referent in self._referents(noun, row, row.slots[0], (), reading):
            if not referent.names:
                failure = failure or self._missing(referent, reading)
                continue
            found = self._thing_state(referent, relations, reading)
            if not isinstance(found, Refused):
                reading.meant[referent.noun] = referent.names
                return found
            failure = failure or found
        return failure or self._missing(Referent(noun or "it", ()), reading)

    def _substance(self, noun: str, reading: _Reading) -> tuple[str, ...]:
        """The constants that a noun names where it names no object."""
        objects = [n for n in self.nouns.things(noun, reading.state) if n not in self.world.profiles.constants]
        matches = self.world.mentions.of(noun, reading.state)
        contained = all(match.how == "contained" for match in matches)
        return self.nouns.constants(noun, ("object",), reading.state) if contained or not objects else ()

    def _thing_state(
        self, referent: Referent, relations: Sequence[tuple[str, str]], reading: _Reading
    ) -> Formula | Refused:
        result = reading.clause.result
        parts: dict[str, list[Formula]] = {name: [] for name in referent.names}
        for name, said in parts.items():
            if result:
                formula = self.nouns.attribute(result, name, reading.moments)
                if formula is None:
                    continue
                said.append(formula)
            for relation, target in relations:
                targets = self._targets(target, reading)
                said.append(
                    disjunction(self.nouns.related(relation, name, t, reading.moments) for t in targets if t != name)
                )
            if not result and not relations:
                said.append(TRUE)
        alive = [conjunction(said) for said in parts.values() if said]
        if not alive:
            return Refused(
                Why.NOT_UNDERSTOOD,
                f"nothing here says whether {referent.noun.replace('_', ' ')} is {str(result).replace('_', ' ')}",
                "declare the adjective under 'attributes' in lexicon.yaml",
            )
        return conjunction(alive) if referent.mode is Mode.ALL else disjunction(alive)

    def _substance_state(
        self, noun: str, constants: Sequence[str], relations: Sequence[tuple[str, str]], reading: _Reading
    ) -> Formula | Refused:
        """A substance is where it is contained, and as that is."""
        result = reading.clause.result
        attributes = [*([result] if result else []), *reading.clause.phrase(noun).attributes]
        targets = [self._targets(target, reading) for relation, target in relations]
        bound = reading.memory.bound.get(noun)
        ways = []
        for constant in constants:
            for atom in self.nouns.facts_about(constant):
                things = [a for a in atom.args if a not in self.world.profiles.constants]
                if len(things) != 1 or atom not in self.world.task.index:
                    continue
                if any(things[0] not in names for names in targets):
                    continue
                if not targets and bound is not None and bound.containers and things[0] not in bound.containers:
                    continue
                said = [self.nouns.attribute(word, things[0], reading.moments) for word in attributes]
                if all(f is not None for f in said):
                    ways.append(conjunction((Atom(atom.predicate, atom.args), *(f for f in said if f is not None))))
        if not ways:
            return Refused(
                Why.NOT_UNDERSTOOD, f"'{print_clause_text(reading.clause)}' says nothing that could be checked here"
            )
        reading.meant[noun] = tuple(constants)
        return disjunction(ways)

    # ------------------------------------------------------------------ refusals

    def missing(self, clause: Clause) -> Refused:
        """That the thing a clause acts on is not there."""
        reading = _Reading(clause, 0, Moments(0, 0), Memory())
        return self._missing(Referent(clause.direct[0] if clause.direct else "it", ()), reading)

    def _missing(self, referent: Referent, reading: _Reading) -> Refused:
        phrase = reading.clause.phrase(referent.noun)
        words = " ".join((*phrase.attributes, referent.noun.replace("_", " ")))
        known = self.nouns.things(referent.noun, reading.state)
        if known and phrase.attributes:
            return Refused(
                Why.NO_SUCH_THING, f"no {referent.noun.replace('_', ' ')} here is {' and '.join(phrase.attributes)}"
            )
        if known:
            return Refused(
                Why.NOT_UNDERSTOOD,
                f"'{words}' is nothing that '{reading.clause.verb.replace('_', ' ')}' can be said of here",
            )
        return Refused(
            Why.NO_SUCH_THING, f"nothing here is called '{words}'", "name a thing that is there, or allow guesses"
        )

    def _impossible(
        self,
        row: GoalRow,
        pairs: Sequence[tuple[str, Referent]],
        relations: Mapping[str, tuple[str, ...]],
        reading: _Reading,
    ) -> Refused:
        short = [r for _, r in pairs if r.mode is Mode.NUMBER and len(r.names) < r.number]
        if short:
            noun = short[0].noun.replace("_", " ")
            return Refused(
                Why.NO_SUCH_THING, f"there are only {len(short[0].names)} of '{noun}' here, not {short[0].number}"
            )
        said = next((names for names in relations.values() if names), ("",))
        binding = {variable: referent.names[0] for variable, referent in pairs}
        reason = why_impossible(row.condition, {**binding, RELATION: said[0]}, self.world.task, self.grounder)
        return Refused(Why.IMPOSSIBLE, f"'{print_clause_text(reading.clause)}' cannot be done here: {reason}")


def bindings_of(goal: ClauseGoal, cube: Cube, reader: GoalReader, memory: Memory) -> Memory:
    """What later clauses remember of a clause whose goal was reached as ``cube``."""
    task = reader.world.task
    atoms = task.names(cube.positive | cube.negative)
    mentioned = dict.fromkeys(a for atom in atoms for a in atom.args)
    constants = reader.world.profiles.constants
    bound = dict(memory.bound)
    recent: dict[str, None] = {}
    for noun, names in goal.meant.items():
        chosen = tuple(n for n in names if n in mentioned) or tuple(
            n for n in names if any(o in mentioned for level in range(4) for o in reader.grounder.relatives(n, level))
        )
        chosen = chosen or names
        containers: tuple[str, ...] = ()
        if all(n in constants for n in chosen):
            containers = tuple(
                dict.fromkeys(a.args[0] for a in atoms if set(a.args[1:]) & set(chosen) and a.args[0] not in constants)
            )
        bound.pop(noun, None)
        bound[noun] = Bound(chosen, containers)
        recent.update(dict.fromkeys((*(n for n in chosen if n not in constants), *containers)))
    recent.update(dict.fromkeys(a for a in mentioned if a not in constants))
    recent.update(dict.fromkeys(memory.recent))
    return replace(memory, bound=bound, recent=tuple(recent))


def replace_reading(reading: _Reading, strict: bool) -> _Reading:
    """A fresh reading of the same clause."""
    return _Reading(reading.clause, reading.state, reading.moments, reading.memory, strict=strict)


def print_clause_text(clause: Clause) -> str:
    """The clause as it was said, for messages."""
    return " ".join(clause.text.split()) or clause.verb.replace("_", " ")


def _looks_back(row: GoalRow) -> bool:
    """Whether a row speaks of how things were at first: *put it back* is said of what was moved."""
    return any(split_predicate(name)[1] == FIRST for name in predicates_of(row.condition))


def _product(options: Sequence[Sequence[Referent]]) -> Iterator[tuple[Referent, ...]]:
    """Every combination, the likeliest of the first slots first."""
    if not options:
        yield ()
        return
    for first in options[0]:
        for rest in _product(options[1:]):
            yield (first, *rest)


def _fewer(formula: Formula, most: int) -> Formula:
    """A ground condition with at most so many alternatives in each disjunction."""
    match formula:
        case And(parts):
            return conjunction(_fewer(part, most) for part in parts)
        case Or(parts):
            return disjunction(_fewer(part, most) for part in parts[:most])
    return formula


__all__ = ["ClauseGoal", "GoalReader", "Refused", "Relation", "Why", "bindings_of"]
