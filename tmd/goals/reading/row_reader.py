"""A clause as a goal by the rows of one verb: slots filled, noun phrases quantified."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from itertools import islice, product
from operator import or_
from typing import TypeAlias

from tmd.diagnostics import Refusal, RefusalKind, TmdError
from tmd.goals.clause_goal import ClauseGoal, ClauseReading, RowUse, Unit, text_of, words
from tmd.goals.preferences import ANTECEDENT, PLACE, TELLS_WHICH
from tmd.goals.reading.fitting import Fitting
from tmd.goals.reading.noun_phrases import Mode, Referent, so_many_of
from tmd.goals.reading.referents import ANY_TYPE, Referents, is_none
from tmd.goals.reading.requirements import Pairs, Requirements
from tmd.goals.reasons import forms, placed, why_impossible
from tmd.goals.sources.actions import OF_ACTION, is_journey
from tmd.goals.sources.table import ACTIONS, RELATION, GoalRow
from tmd.goals.words import ends_as, is_noun, is_one, is_relation, is_verb, relations_said, table, the_word, words_of
from tmd.language.clause import PERSONS, Clause, NounPhrase, Quantifier
from tmd.language.lexicon.lexicon import section
from tmd.language.lexicon.names import split_name, words_in_name
from tmd.pddl.ground_formula import (
    FALSE,
    TRUE,
    atoms_of,
    conjunction,
    disjunction,
    goal_cubes,
    negation,
    only_negative,
)  # fmt: skip
from tmd.pddl.model import And, Atom, Exists, Formula, GroundAtom, Not, Or, conjuncts, predicates_of
from tmd.pddl.task import Cube
from tmd.planning.unsolvable import Impossible

_NEVER_OTHERWISE = Or((FALSE,))
"""Marks what holds of a thing because the contrary never can: as good as FALSE where that thing alone is meant."""
_DEAD = (FALSE, _NEVER_OTHERWISE)
Read: TypeAlias = "tuple[Formula, GoalRow] | Refusal"


@dataclass(frozen=True, slots=True)
class _Option:
    """The goal with one meaning of a pronoun.

    Attributes:
        goal: The goal, and the row that it was read by.
        meant: The meanings of the nouns.
        held: It held before the text and holds now.
        done: It holds by now, and did not before the text.
        is_object: The meaning is an object that was spoken of, and no noun.
    """

    goal: tuple[Formula, GoalRow]
    meant: dict[str, tuple[str, ...]]
    held: bool
    done: bool
    is_object: bool


class RowReader:
    """Reads clauses by rows in one environment.

    Args:
        referents: Finds what nouns mean.
    """

    def __init__(self, referents: Referents) -> None:
        self.world = referents.world
        self.grounder = referents.grounder
        self.referents = referents
        self.nouns = referents.nouns
        self.requirements = Requirements(referents)
        self.fitting = Fitting(referents)
        self.exclusions = Impossible(referents.world.task)

    def by_rows(self, rows: Sequence[GoalRow], reading: ClauseReading) -> ClauseGoal | Refusal:
        """Return the goal by the first rows that fit every thing the verb acts on."""
        parted = self._one_and_other(reading)
        shared = self._one_place(reading) if parted is None else None
        found = self._with_one(parted or shared, rows, reading)
        if shared is not None and (isinstance(found, Refusal) or (found and self._excluded(found[0], reading))):
            # two pots on a burner: one each
            found, reading.meant, reading.approach = None, {}, []
        if found is None:
            found = self._of_units(rows, reading)
        return found if isinstance(found, Refusal) else self.finished(*found, reading)

    def finished(self, formula: Formula, row: GoalRow | None, reading: ClauseReading) -> ClauseGoal | Refusal:
        """Return a condition as the goal of the clause."""
        clause = reading.clause
        if clause.direct and all(is_none(n, clause) for n in clause.direct):
            formula = negation(formula)
        cubes = self.cubes(formula, clause)
        if isinstance(cubes, Refusal):
            return cubes
        notes = tuple(dict.fromkeys(reading.notes))
        return ClauseGoal(clause, formula, cubes, row, dict(reading.meant), tuple(reading.approach), notes)

    def cubes(self, formula: Formula, clause: Clause) -> tuple[Cube, ...] | Refusal:
        """Return a condition as conjunctions over the task's atoms."""
        try:
            cubes = goal_cubes(self.world.task, formula)
        except TmdError as error:
            return Refusal(RefusalKind.NOT_UNDERSTOOD, error.message, error.hint)
        contradiction = f"'{clause.text}' asks for what cannot hold at the same time"
        return cubes or Refusal(RefusalKind.CONTRADICTION, contradiction)

    # ------------------------------------------------------------------ one thing for several

    def _with_one(
        self, noun: str | None, rows: Sequence[GoalRow], reading: ClauseReading
    ) -> tuple[Formula, GoalRow | None] | Refusal | None:
        """Return the goal with one thing for all that is said of a noun; ``None`` where none is left open."""
        candidates = self.referents.targets(noun, reading) if noun is not None else ()
        things = tuple(n for n in candidates if not self.nouns.is_constant(n)) or candidates
        if noun is None or len(things) < 2:  # a bottle, not the beer in it
            return None
        ways: list[tuple[Formula, GoalRow | None]] = []
        approaches: list[list[Formula]] = []
        meant: dict[str, dict[str, None]] = {}
        failure: Refusal | None = None
        for name in things:
            reading.taken, reading.meant, reading.approach = {noun: name}, {}, []
            found = self._of_units(rows, reading)
            if isinstance(found, Refusal):
                failure = failure or found
                continue
            ways.append(found)
            approaches.append(reading.approach)
            for said, names in reading.meant.items():
                meant.setdefault(said, {}).update(dict.fromkeys(names))
        reading.taken, reading.meant = {}, {said: tuple(names) for said, names in meant.items()}
        reading.approach = [disjunction(parts) for parts in zip(*approaches, strict=False)]
        return (disjunction(formula for formula, _ in ways), ways[-1][1]) if ways else failure

    def _one_place(self, reading: ClauseReading) -> str | None:
        """Return the place where several things shall go: "milk and coffee in a mug" is one mug, whichever it is."""
        clause = reading.clause
        for noun, phrase in clause.phrases.items():
            one = phrase.quantifier in (Quantifier.PLAIN, Quantifier.SOME) and not (phrase.plural or phrase.each)
            sources = {r.source for r in clause.relations if r.target == noun and is_relation(r.relation, "place")}
            if one and len(sources.intersection(clause.direct)) > 1 and not self.referents.points_back(noun):
                return noun
        return None

    def _excluded(self, formula: Formula, reading: ClauseReading) -> bool:
        """Return whether it is proven that something can never be: two pots on one burner."""
        try:
            return self.exclusions.reason(reading.state, goal_cubes(self.world.task, formula)) is not None
        except TmdError:  # too many conjunctions, which is told where the goal is finished
            return False

    def _one_and_other(self, reading: ClauseReading) -> str | None:
        """Return the noun of which one thing is spoken of more than once: "tea in a cup and milk in the other".

        Or: "coffee in a mug and some milk in it".
        """
        clause = reading.clause
        for noun, phrase in clause.phrases.items():
            meant = clause.meant(noun)[0]
            other = is_one(noun) and phrase.other
            same = is_noun(noun, "it") and any(r.target == noun for r in clause.relations)
            first = clause.phrases.get(meant)
            if (other or same) and first is not None and not (first.other or first.quantifier is Quantifier.ALL):
                return meant
        return None

    # ------------------------------------------------------------------ each thing that is acted on

    def _of_units(self, rows: Sequence[GoalRow], reading: ClauseReading) -> tuple[Formula, GoalRow | None] | Refusal:
        """Return what shall hold of all that the verb acts on, and the last row that says so."""
        formulas: list[Formula] = []
        used: GoalRow | None = None
        units = self.referents.units(reading)
        for unit in units:
            found = self._unit(rows, unit, reading)
            if isinstance(found, Refusal) and len(units) > 1 and self._is_vacuous(unit, found, reading):
                reading.notes.append(found.message)  # "every door and every lid that is open", where no lid is
                continue
            if isinstance(found, Refusal):
                found = self._measured(rows, unit, reading) or found
            if isinstance(found, Refusal):
                return found
            formula, used = found
            formula = self._as_at_first(formula, reading)
            if used is not None and used.source == ACTIONS:
                formula = self._taken_out(formula, unit, reading)
            formulas.append(self._where_spoken_of(formula, used, unit, reading))
        clause = reading.clause
        either = any(clause.phrase(name).either for name in clause.direct)
        none = all(is_none(n, clause) for n in clause.direct or ("",))
        return disjunction(formulas) if either or none else conjunction(formulas), used

    def _taken_out(self, formula: Formula, unit: Unit, reading: ClauseReading) -> Formula:
        """Return that a thing is held as that it is also no longer where it is taken from.

        That is what the clause says, "out of the trunk", or wherever it is: "get the sword out". Of several things,
        which cannot all be held, it is only that.
        """
        parts = formula.parts if isinstance(formula, And) else (formula,)
        held = [part for part in parts if isinstance(part, Atom)]
        gone = [Not(Atom(f.predicate, f.args)) for f in self._left(held, unit, reading)]
        whither = any(r in section("arrivals") for r, _ in unit.relations)
        if whither or len(held) < len(parts) or (len(held) > 1 and len(gone) != len(held)):
            return formula
        return conjunction([*held, *gone] if len(held) == 1 else gone)

    def _left(self, held: Sequence[Atom], unit: Unit, reading: ClauseReading) -> list[GroundAtom]:
        """Return the facts that say where things stand that are taken from there, or just taken out."""
        origins = (t for r, t in unit.relations if is_relation(r, "origin"))
        places = {name for target in origins for name in self.referents.targets(target, reading)}
        out = reading.clause.verb.rpartition("_")[2] in section("out_words")
        stood = (f for part in held for term in part.terms for f in self._standing(term, reading))
        return [f for f in stood if out or places & set(f.args[1:])]

    def _standing(self, name: str, reading: ClauseReading) -> Iterator[GroundAtom]:
        """Yield the facts that say where a thing is now, and may change."""
        for fact in self.nouns.facts_about(name):
            changes = fact.predicate in self.grounder.changing and self.grounder.holds(fact, reading.state)
            if changes and len(fact.args) > 1 and fact.args[0] == name:
                yield fact

    def _is_vacuous(self, unit: Unit, refusal: Refusal, reading: ClauseReading) -> bool:
        """Return whether all things of a kind in some state are meant, and none of the kind is."""
        phrase = reading.clause.phrase(unit.direct or "")
        known = self.nouns.things(unit.direct or "", reading.state)
        every = phrase.quantifier is Quantifier.ALL and bool(phrase.attributes)
        understood = all(
            any(self.nouns.attribute(word, name, reading.moments) is not None for name in known)
            for word in phrase.attributes
        )
        return every and understood and bool(known) and refusal.kind is RefusalKind.NO_SUCH_THING

    def _as_at_first(self, formula: Formula, reading: ClauseReading) -> Formula:
        """Return of several places where a thing may be put *back* the one where it was: *back on its burner*."""
        if not ends_as(reading.clause.verb, "back") or not isinstance(formula, Or):
            return formula
        then = [part for part in formula.parts if self.grounder.truth(part, reading.memory.first)]
        return disjunction(then) if then else formula

    def _where_spoken_of(self, formula: Formula, row: GoalRow, unit: Unit, reading: ClauseReading) -> Formula:
        """Return of several things that *the* one may be the one where that is which was spoken of last.

        *Put the pot on the stove. Light the burner*: the burner that the pot stands on.
        """
        said = reading.clause.phrase(unit.direct or "")
        one = said.definite and not said.plural and said.quantifier is Quantifier.PLAIN
        if (
            not one
            or self._says_where(row, unit, reading)
            or not isinstance(formula, Or)
            or not _of_alternatives(formula.parts)
        ):
            return formula
        named = {name for atom in atoms_of(formula) for name in atom.args}
        recent = [name for name in reading.memory.recent if name not in named]
        # what may change first; of what never does, most: both knobs are of the stove, and one controls the burner
        near = (self._nearest(formula.parts, name, reading, fixed) for fixed in (False, True) for name in recent)
        return disjunction(next(filter(None, near), formula.parts))

    def _says_where(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> bool:
        """Return whether a clause fills a slot of a row behind a preposition with more than a setting: "to low"."""
        targets = [t for slot in row.places for _, t in self.fitting.fillers(slot, unit, reading)]
        values = [t for t in targets if t and all(map(self.nouns.is_constant, self.referents.targets(t, reading)))]
        return len(values) < len(targets)

    def _nearest(self, parts: Sequence[Formula], name: str, reading: ClauseReading, fixed: bool) -> list[Formula]:
        """Return the parts about what most facts join to a thing: facts that may change, or those that never do."""
        facts = [f for f in self.nouns.facts_about(name) if (f in self.world.task.static) == fixed]
        joined = Counter(other for f in facts if self.grounder.holds(f, reading.state) for other in {*f.args} - {name})
        counts = [max(joined[n] for atom in atoms_of(part) for n in atom.args) for part in parts]
        most = max(counts)
        return [p for p, count in zip(parts, counts, strict=True) if count == most > (min(counts) if fixed else 0)]

    def _measured(self, rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading) -> Read | None:
        """Return *two spoons of coffee* as some coffee, where nothing can be said of the spoons."""
        clause, measure = reading.clause, reading.clause.phrase(unit.direct or "")
        measured = self.referents.measured(unit, clause)
        inner = measured.direct if measured is not None else None
        if measured is None or inner is None or not self.nouns.constants(inner, ANY_TYPE, reading.state):
            return None
        if self._too_few(measure, inner, reading):
            return None  # two packets, where there is one
        if measure.quantifier is not Quantifier.PLAIN or not measure.plural:  # of one packet of noodles one is meant
            own = clause.phrase(inner)
            counted = replace(own, quantifier=measure.quantifier, number=measure.number, plural=measure.plural)
            reading.clause = replace(clause, phrases={**clause.phrases, inner: counted})
        found = self._unit(rows, measured, reading)
        reading.clause = clause
        if isinstance(found, Refusal):
            return None
        if self._elsewhere(found[0], measure.name, reading):
            return self._with_contents(rows, unit, reading)
        if unit.direct is not None and inner in reading.meant:
            reading.meant.setdefault(unit.direct, reading.meant[inner])
        return found

    def _elsewhere(self, formula: Formula, measure: str, reading: ClauseReading) -> bool:
        """Return whether a goal is about other things than those that a measure names: coffee in a mug, not a glass."""
        named = set(self.nouns.things(measure, reading.state))
        held = {n for atom in atoms_of(formula) for n in atom.args if not self.nouns.is_constant(n)}
        return bool(named and held) and named.isdisjoint(held)

    def _with_contents(self, rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading) -> Read | None:
        """Return *a glass of coffee with milk* as one glass that has all of it."""
        contained = the_word("relations", "partitive")
        inner = [t for r, t in unit.relations if is_relation(r, "partitive") or is_relation(r, "accompanying")]
        others = [(r, t) for r, t in unit.relations if t not in inner]
        ways: list[Formula] = []
        used: GoalRow | None = None
        for name in self.nouns.things(unit.direct or "", reading.state):
            reading.taken = {unit.direct or "": name}
            found = [self._unit(rows, Unit(unit.direct, [(contained, t), *others]), reading) for t in inner]
            goals = [goal for goal in found if not isinstance(goal, Refusal)]
            if len(goals) == len(inner):
                ways.append(conjunction(formula for formula, _ in goals))
                used = goals[-1][1]
        reading.taken = {}
        return (disjunction(ways), used) if used is not None else None

    def _too_few(self, measure: NounPhrase, inner: str, reading: ClauseReading) -> bool:
        held = self.nouns.holders(measure.name, self.referents.targets(inner, reading), reading.moments)
        counted = measure.quantifier is Quantifier.NUMBER
        few = counted and 0 < len(held) < (measure.number or 1)
        vessels = () if measure.name in words_of("measures") else self.nouns.things(measure.name, reading.state)
        lacking = counted and 0 < len(vessels) < (measure.number or 1)
        return lacking or (few and all(map(self.nouns.is_supply, held)))

    def _unit(self, rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading) -> Read:
        """Return the goal of one thing; a pronoun is what it most likely means of that which a row fits."""
        if unit.direct is None or not self.referents.points_back(unit.direct):
            return self._with_places(rows, unit, reading)
        failure: Refusal | None = None
        found: list[_Option] = []
        reading.pronoun = unit.direct
        options = self.referents.antecedents(unit.direct, reading)
        before = dict(reading.meant)
        for number, (_, is_object) in enumerate(options or [("", True)]):
            if is_object and any(not option.held for option in found):
                break  # a noun comes before any object that was spoken of
            reading.antecedent, reading.meant = number, dict(before)
            tried = self._with_rows(rows, unit, reading)
            if isinstance(tried, Refusal):
                failure = failure or tried
                continue
            found.append(self._option(tried, reading, is_object=is_object))
            if self._settles(found, reading) or (not number and self._of_condition(unit.direct, found[0], reading)):
                break
        if not found:
            assert failure is not None
            return failure
        best = self._decided(self._best(found, reading), found, unit.direct, reading)
        reading.meant = best.meant
        return best.goal

    def _decided(self, best: _Option, found: Sequence[_Option], noun: str, reading: ClauseReading) -> _Option:
        """Return the likeliest option, or another one if that is asked for."""
        others = [o for o in found if not (o.held or o.is_object or o is best) and o.goal[0] != best.goal[0]]
        return [best, *others][reading.decisions.taken(ANTECEDENT, noun, 1 + len(others))]

    def _option(self, goal: tuple[Formula, GoalRow], reading: ClauseReading, *, is_object: bool) -> _Option:
        now = self.grounder.truth(goal[0], reading.state) and bool(atoms_of(goal[0]))
        held = now and self.grounder.truth(goal[0], reading.memory.first)
        return _Option(goal, reading.meant, held, now and not held, is_object)

    def _settles(self, found: Sequence[_Option], reading: ClauseReading) -> bool:
        """Return whether what a pronoun means is settled by the last of its options."""
        last = found[-1]
        return reading.awaited if last.held else last.is_object and not self._is_late(last, found)

    def _of_condition(self, pronoun: str, option: _Option, reading: ClauseReading) -> bool:
        """Return whether a pronoun most likely means what the condition of its clause is about."""
        subjects = {noun for c in reading.clause.conditions for clause in c.clauses for noun in clause.objects[:1]}
        return not option.held and not subjects.isdisjoint(reading.clause.antecedents.get(pronoun, ())[:1])

    def _is_late(self, option: _Option, found: Sequence[_Option]) -> bool:
        """Return whether an object comes after a noun of which the goal holds already: that was meant then."""
        return option.is_object and not option.goal[1].looks_back and any(other.held for other in found)

    def _best(self, found: Sequence[_Option], reading: ClauseReading) -> _Option:
        """Return rather what was not so all along, and of that what was done meanwhile: what was opened is closed."""
        if reading.awaited and found[-1].held:
            return found[-1]
        fresh = [option for option in found if not option.held and not self._is_late(option, found)]
        nouns = [option for option in fresh if not option.is_object]
        if nouns and nouns[0].done:
            return nouns[0]
        return self._reversed(nouns, reading) or next(iter(fresh), found[0])

    def _reversed(self, nouns: Sequence[_Option], reading: ClauseReading) -> _Option | None:
        """Return an option that undoes what was done meanwhile, or that would have prevented it if it comes first."""
        # one closes again, or turns off: "turn off the lamp, put the film in, start it" is not about the lamp
        undone = [o for o in nouns if only_negative(o.goal[0]) and self._undoes(o.goal[0], reading)]
        ahead = nouns[: nouns.index(undone[0])] if undone else nouns
        locking = (option for option in ahead if len(nouns) > 1 and self._locks(option.goal[0], reading))
        return next(locking, None) or self._outermost(undone, reading)

    def _outermost(self, options: Sequence[_Option], reading: ClauseReading) -> _Option | None:
        """Return the first option, or one that holds what it is about: the fridge that the tub was put back in."""
        best = options[0] if options else None
        for option in options[1:]:
            assert best is not None
            inner = self._about(best)
            if self.nouns.related_now(inner, the_word("relations", "inside"), self._about(option), reading.moments):
                best = option
        return best

    def _about(self, option: _Option) -> tuple[str, ...]:
        """Return the things that a pronoun means by an option."""
        return tuple(n for names in option.meant.values() for n in names if not self.nouns.is_constant(n))

    def _locks(self, formula: Formula, reading: ClauseReading) -> bool:
        """Return whether what is asked for would have prevented what was done: to close what something was put in."""
        task, gained = self.world.task, reading.state & ~reading.memory.first
        wanted = sum(1 << task.index[atom] for atom in atoms_of(formula) if atom in task.index)
        ways = [o for o in task.operators if (o.delete if only_negative(formula) else o.add) & wanted]
        added = [way.add & ~gained for way in ways]
        done = [o for o in task.operators if o.add & gained]
        ruled_out = [reduce(or_, (cube.positive for cube in o.forbidden), o.precondition.negative) for o in done]
        return any(add & bits for add in added for bits in ruled_out)

    def _undoes(self, formula: Formula, reading: ClauseReading) -> bool:
        """Return whether what is asked for held before the text: what was done meanwhile is undone."""
        return bool(atoms_of(formula)) and self.grounder.truth(formula, reading.memory.first)

    def _with_places(self, rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading) -> Read:
        """Return the goal with places that point back: what was spoken of last and a row fits.

        A place may be left out (*pour the milk*) or be a pronoun (*pour the milk in it*); it is then no object of the
        clause itself, whatever row would fit that.
        """
        for pronoun in self._back(rows, unit, reading):
            reading.pronoun = pronoun
            options = self.referents.antecedents(pronoun, reading)
            passed = reading.decisions.taken(PLACE, pronoun, len(options)) if options else 0
            last: Read | None = None
            for number, (_, is_object) in enumerate(options):
                reading.antecedent = number
                found = self._with_rows(rows, unit, reading)
                if not isinstance(found, Refusal) and (not is_object if pronoun else found[1].places):
                    last = found
                    if not passed:
                        break
                    passed -= 1
            if last is not None:
                return last
            reading.pronoun = reading.antecedent = None
        return self._with_rows(rows, unit, reading)

    def _back(self, rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading) -> Iterator[str]:
        """Yield the places of rows that point back: the empty one that was left out, and the first pronoun."""
        fillers = [f for row in rows for slot in row.places for f in self.fitting.fillers(slot, unit, reading)]
        if any(target is None and is_relation(relation, "elided") for relation, target in fillers):
            yield ""
        pronouns = (target for _, target in fillers if target is not None and self.referents.points_back(target))
        yield from (p for p in islice(pronouns, 1) if reading.clause.together.get(p, 1) == 1)

    # ------------------------------------------------------------------ rows

    def _with_rows(self, rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading) -> Read:
        """Return the goal of one thing by the row with the most slots that fits and can hold."""
        failure = self._short(unit, reading)
        if failure is not None:
            return failure
        fitting = self.fitting.of(rows, unit, reading)
        tried = self.fitting.unfit(rows, unit, reading)
        impossible: set[str] = set()
        most = 0
        for place, row in enumerate(fitting):
            if impossible and (row.source != ACTIONS or row.evidence in impossible) and len(row.slots) < most:
                continue  # what cannot be done with all that was said is not done with less
            before = dict(reading.meant), list(reading.approach), list(reading.notes)
            found = self._by_row(row, unit, reading)
            if not isinstance(found, Refusal):
                return self._settled(fitting[place + 1 :], row, found, unit, reading)
            failure = failure or found
            tried.append(f"{placed(row)}: {found.message}")
            if found.kind is RefusalKind.IMPOSSIBLE and self.fitting.takes_all(row, unit, reading):
                impossible.add(row.evidence)
                most = max(most, len(row.slots))
            reading.meant, reading.approach, reading.notes = before
        if failure is None:
            failure = Refusal(RefusalKind.NOT_UNDERSTOOD, *_misfit(rows, unit, reading))
        return replace(failure, rows=tuple(tried))

    def _settled(
        self, others: Sequence[GoalRow], row: GoalRow, found: Formula, unit: Unit, reading: ClauseReading
    ) -> Read:
        """Return the goal by the first row that fits, or by another one that says rather what is meant."""
        settled = self._still_to_do(others, row, found, unit, reading)
        if isinstance(settled, Refusal):
            return settled
        found, row = settled
        shorter = [each for each in others if len(each.slots) < len(row.slots)]
        return self._with_fewer(shorter, row, found, unit, reading) or (found, row)

    def _short(self, unit: Unit, reading: ClauseReading) -> Refusal | None:
        """Return a refusal of *both eggs* where there is one egg, also if only what is in it is asked for."""
        phrase = reading.clause.phrase(unit.direct or "")
        kinds = self.world.mentions.kinds
        named = self.nouns.things(phrase.name, reading.state)
        some = any(kinds.get(n) == phrase.name for n in named)
        names = self.referents.every_kind_of(phrase.name, reading.clause, reading.state) if some else ()
        measures = any(is_relation(relation, "partitive") for relation, _ in unit.relations)  # "two spoons of sugar"
        if measures or self.nouns.guess or not 0 < len(names) < (phrase.number or 1):
            return None
        return self._not_so_many(Referent(phrase.name, names, Mode.NUMBER, phrase.number or 1))

    def _is_anywhere(self, row: GoalRow, found: Formula, reading: ClauseReading) -> bool:
        """Return whether a clause puts a thing without saying where, and it is somewhere by now."""
        verb, _, particle = reading.clause.verb.partition("_")
        # "move the lion", "walk the dog": to any place at all
        moved = isinstance(row.condition, Exists) and (verb in section("moving") or is_journey(row, self.world.domain))
        put = moved or (is_verb(verb, "placing") and (not particle or particle in table("particles")))
        # "fit the battery", read by the row of "put"
        put = put or (isinstance(row.condition, Exists) and any(is_verb(each, "placing") for each in row.verbs))
        return put and row.source == ACTIONS and not row.places and self.grounder.truth(found, reading.state)

    def _still_to_do(
        self, others: Sequence[GoalRow], row: GoalRow, found: Formula, unit: Unit, reading: ClauseReading
    ) -> Read:
        """Return another row where one asks only to be rid of what is nowhere: "throw the egg away" means the egg.

        Where there is no such row, the egg stays.
        """
        if not (only_negative(found) and self.grounder.truth(found, reading.state)):
            return found, row
        before = dict(reading.meant), list(reading.approach), list(reading.notes)
        for other in (each for each in others if len(each.slots) == len(row.slots)):
            tried = self._by_row(other, unit, reading)
            if not isinstance(tried, Refusal) and not self.grounder.truth(tried, reading.state):
                return tried, other
            reading.meant, reading.approach, reading.notes = before
        thing = unit.direct and not unit.relations and reading.clause.phrase(unit.direct).definite
        if (
            thing
            and self.nouns.things(unit.direct or "", reading.state)
            and not self.fitting.takes_things(row, unit, reading)
        ):
            return self._cannot(reading)
        return found, row

    def _with_fewer(
        self, shorter: Sequence[GoalRow], row: GoalRow, found: Formula, unit: Unit, reading: ClauseReading
    ) -> Read | None:
        """Return the goal without a place that told which thing is meant, if the verb can do without it."""
        if not shorter or not self.fitting.may_tell_which(row, unit, reading):
            return None
        other = self._with_rows(shorter, unit, reading)
        if isinstance(other, Refusal):  # "everything on the floor that is empty", where nothing is
            return other if other.kind is RefusalKind.NO_SUCH_THING else None
        held = self.grounder.truth(found, reading.state)
        fewer = held or not self.grounder.truth(other[0], reading.state)
        ranked = (other, None) if fewer else (None, other)
        return ranked[reading.decisions.taken(TELLS_WHICH, unit.direct or "", 2)]

    def _of_part(self, row: GoalRow, unit: Unit) -> GoalRow:
        """Return a row without the ways that do not speak of a part: "in the minibar" is not just in its room."""
        parts = {split_name(place)[-1] for _, place in unit.relations if self.nouns.is_only_told_of(place)}
        ways = row.condition.parts if isinstance(row.condition, Or) else ()
        about = [w for w in ways if any(parts & words_in_name(name) for name in predicates_of(w))]
        return replace(row, condition=disjunction(about)) if about else row

    def _by_row(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> Formula | Refusal:
        """Return the goal of one thing by one row: for each combination of what stands behind the prepositions."""
        clause = reading.clause
        row = self._of_part(row, unit)
        fillers = [(slot, self.fitting.fillers(slot, unit, reading)) for slot in row.places]
        consumed = {filler for _, said in fillers for filler in said}
        alternatives = any(target and clause.phrase(target).either for _, target in consumed)
        leftover = [pair for pair in unit.relations if pair not in consumed]
        refused = self._unused(row, unit, leftover, reading) or self._unknown_thing(leftover, reading)
        if refused is not None:
            return refused
        choices = product(*([(slot, *filler) for filler in said] for slot, said in fillers))
        found = [self._combination(RowUse(row, unit.direct, choice, leftover, reading)) for choice in choices]
        asked = self._joined_ways(found, reading, alternatives=alternatives)
        if not isinstance(asked, Refusal) and self._is_anywhere(row, asked, reading):
            return Refusal(RefusalKind.NOT_UNDERSTOOD, f"'{text_of(clause)}' does not say where")
        return asked

    def _joined_ways(
        self, found: Sequence[Formula | Refusal], reading: ClauseReading, *, alternatives: bool
    ) -> Formula | Refusal:
        """Return what all combinations ask for, or any one of them."""
        failure = next((one for one in found if isinstance(one, Refusal)), None)
        formulas = [one for one in found if not isinstance(one, Refusal)]
        if alternatives:
            return disjunction(formulas) if formulas else self._cannot(reading)
        return failure or conjunction(formulas)

    def _unused(
        self, row: GoalRow, unit: Unit, leftover: Sequence[tuple[str, str]], reading: ClauseReading
    ) -> Refusal | None:
        """Return a refusal for a place that no slot of the row takes, where each must have one."""
        every = reading.strict or row.source == ACTIONS
        whither = section("arrivals") - section("static")  # "run water into the kettle" is more than to run water
        told = (pair for pair in leftover if every or pair[0] in whither)
        # "an image of Mars in infrared" is of Mars: no noun of a row is a thing that this could tell from others
        spoken = row.noun is not None and row.source == ACTIONS and bool(row.places)
        strange = next((p for p in told if spoken or self.referents.unplaced(unit, *p, reading)), None)
        return None if strange is None else self._strange(row, unit, strange, reading)

    def _strange(self, row: GoalRow, unit: Unit, strange: tuple[str, str], reading: ClauseReading) -> Refusal:
        """Return the refusal for a place that no slot of a row takes."""
        if row.noun is not None and not self.referents.targets(strange[1], reading):
            return self.referents.missing(Referent(strange[1], ()), reading)
        telling = row.source == ACTIONS and not row.places and strange[0] not in section("arrivals") - section("static")
        if telling and unit.direct and self.nouns.things(unit.direct, reading.state):
            message = f"no {words(unit.direct)} here is {words(strange[0])} {words(strange[1])}"
        else:
            message = f"'{text_of(reading.clause)}' says a place that nothing is known of"
        return Refusal(RefusalKind.NOT_UNDERSTOOD, message)

    def _cannot(self, reading: ClauseReading, reason: str = "") -> Refusal:
        return Refusal(RefusalKind.IMPOSSIBLE, f"'{text_of(reading.clause)}' cannot be done here{reason}")

    def _unknown_thing(self, leftover: Sequence[tuple[str, str]], reading: ClauseReading) -> Refusal | None:
        """Return a refusal for a thing that is not there: whatever is done without it is something else."""
        if self.nouns.guess:
            return None
        clause = reading.clause
        further = [
            (r.relation, r.target)
            for r in self.referents.without_rooms(clause)
            if r.source and r.source not in clause.direct
        ]
        for relation, target in (*leftover, *further):
            said = self.referents.points_back(target) or target in PERSONS  # "on the table beside her"
            named = not (said or is_noun(target, "degrees") or is_none(target, clause))
            if named and self._is_not_there(relation, target, reading):
                return self.referents.missing(Referent(target, ()), reading)
        return None

    def _is_not_there(self, relation: str, target: str, reading: ClauseReading) -> bool:
        """Return whether nothing here is called so that is excepted, or that a relation leads to."""
        if is_relation(relation, "excepting"):
            meant = reading.clause.meant(target)
            return not any(self.nouns.things(n, reading.state) or self.nouns.substances(n) for n in meant)
        fewest = 1 + reading.clause.phrase(target).other  # "the other table", where there is one
        return is_relation(relation, "naming") and len(self.referents.targets(target, reading)) < fewest

    def _combination(self, use: RowUse) -> Formula | Refusal:
        reading = use.reading
        slots = self._options(use)
        failure: Refusal | None = None
        for chosen in product(*(options for _, options in slots)):
            missing = next((referent for referent in chosen if not referent.names), None)
            if missing is not None:
                failure = failure or self.referents.missing(missing, reading)
                continue
            pairs = [(variable, referent) for (variable, _), referent in zip(slots, chosen, strict=True)]
            formula = self._formula(use, pairs)
            if formula == FALSE:
                failure = failure or self._impossible(use, pairs)
                continue
            reading.meant.update((referent.noun, referent.names) for _, referent in pairs)
            return formula
        return failure or self._cannot(reading)

    def _options(self, use: RowUse) -> list[tuple[str, list[Referent]]]:
        """Return what may stand in each slot."""
        row, reading = use.row, use.reading
        slots: list[tuple[str, list[Referent]]] = []
        if row.direct is not None and use.direct is not None:
            acted_on = self.referents.referents(use.direct, row, row.direct, use.leftover, reading)
            slots.append((row.direct.variable, [self._at_origin(r, use) for r in acted_on]))
        for slot, _, target in use.places:
            relations = self.referents.relations_of(target, reading.clause) if target else []
            slots.append((slot.variable, self.referents.referents(target or "", row, slot, relations, reading)))
        return slots

    def _at_origin(self, referent: Referent, use: RowUse) -> Referent:
        """Return of *everything off the table* what is there now."""
        for _, relation, target in use.places:
            if target is not None and is_relation(relation, "origin"):
                ends = self.referents.targets(target, use.reading)
                there = self.nouns.related_now(referent.names, relation, ends, use.reading.moments)
                referent = referent.only(there or referent.names)
        return referent

    # ------------------------------------------------------------------ conditions

    def _formula(self, use: RowUse, pairs: Pairs) -> Formula:
        """Return the condition of a row with its slots quantified, and what else was said of the thing acted on."""
        row, reading = use.row, use.reading
        variables = [variable for variable, _ in pairs]
        further = self.requirements.further(use, pairs)
        excepted = frozenset((*self.referents.excepted(use.leftover, reading), *reading.memory.left))

        def own(binding: Mapping[str, str], spared: frozenset[str]) -> tuple[Formula, bool]:
            if len(set(binding.values())) < len(binding):
                return FALSE, False
            moments = replace(reading.moments, excepted=spared)
            ways = [
                self.grounder.ground_live(row.condition, {**binding, RELATION: one}, variables, moments)
                for one in use.said
            ]
            return disjunction(formula for formula, _ in ways), any(live for _, live in ways)

        def whole(binding: Mapping[str, str]) -> Formula:
            formula, live = own(binding, frozenset())
            if excepted:
                rest, live = own(binding, excepted)
                formula = self._but_for(rest, formula, reading)
            # no action moves a curtain from where it hangs
            settled = formula == TRUE and row.source == ACTIONS and not row.tells_agent
            if formula == FALSE or ((settled or not live) and not row.traceless):
                # what can never be so is not "not so already", but for one of many: all filters shall be clean
                return FALSE if formula == FALSE else _NEVER_OTHERWISE
            return conjunction((formula, *(extra(binding) for extra in further))) if further else formula

        each = [p for p in pairs if p[1].each]
        one = [p for p in pairs if p[1].mode is Mode.ANY and not p[1].each]
        many = [p for p in pairs if p[1].mode is not Mode.ANY and not p[1].each]
        formula = self._quantified([*each, *one, *many], {}, whole, reading)
        if formula in _DEAD and one and many:
            formula = self._quantified([*each, *many, *one], {}, whole, reading)
        return self._done_for_ever(row, pairs) if formula in _DEAD else formula

    def _done_for_ever(self, row: GoalRow, pairs: Pairs) -> Formula:
        """Return the state that a thing is in for ever, and is to be brought into; FALSE for any other goal.

        *Feed the cat*, which is fed, and no action makes it hungry.
        """
        done = row.condition
        names = pairs[0][1].names if len(pairs) == 1 and pairs[0][1].mode is Mode.ANY else ()
        plain = (
            row.evidence.startswith(OF_ACTION) and isinstance(done, Atom) and done.terms == tuple(v for v, _ in pairs)
        )
        if not (plain and isinstance(done, Atom) and len(names) == 1):
            return FALSE
        return Atom(done.predicate, names) if GroundAtom(done.predicate, names) in self.world.task.static else FALSE

    def _but_for(self, rest: Formula, everything: Formula, reading: ClauseReading) -> Formula:
        """Return a condition for all things but some, which stay as they are: *clear the table except the cup*."""
        if rest == everything:
            return everything
        spared = [part for part in conjuncts(everything) if part not in conjuncts(rest)]
        if len(spared) == len(conjuncts(everything)):
            return FALSE  # "switch all lights off, but leave the lights on"
        return conjunction((rest, *(negation(p) for p in spared if not self.grounder.truth(p, reading.state))))

    def _quantified(
        self,
        pairs: Sequence[tuple[str, Referent]],
        binding: Mapping[str, str],
        leaf: Callable[[Mapping[str, str]], Formula],
        reading: ClauseReading,
    ) -> Formula:
        """Return the condition over all candidates, quantifier after quantifier."""
        if not pairs:
            return leaf(binding)
        (variable, referent), *rest = pairs
        parts = {name: self._quantified(rest, {**binding, variable: name}, leaf, reading) for name in referent.names}
        alive = [part for part in parts.values() if part not in _DEAD]
        match referent.mode:
            case Mode.ALL:
                kept = alive if referent.loose or FALSE not in parts.values() else list(parts.values())
                return conjunction(kept) if kept else FALSE
            case Mode.NUMBER:
                return so_many_of(alive, referent.number)
            case Mode.NONE:
                return conjunction(parts.values()) if len(parts) == 1 else disjunction(alive)
        return self._any_of(alive, reading) if referent.definite else disjunction(alive)

    def _any_of(self, alive: Sequence[Formula], reading: ClauseReading) -> Formula:
        """Return *the sock* of several socks: one for which it does not hold yet; all, of what shall cease to be."""
        left = [part for part in alive if not self.grounder.truth(part, reading.state)] if len(alive) > 1 else []
        if left and all(map(only_negative, alive)):
            return conjunction(left)
        return disjunction(left or alive)

    @staticmethod
    def _not_so_many(short: Referent) -> Refusal:
        called = "1 thing here is" if len(short.names) == 1 else f"{len(short.names)} things here are"
        message = f"only {called} called '{words(short.noun)}', not {short.number}"
        return Refusal(RefusalKind.NO_SUCH_THING, message)

    def _impossible(self, use: RowUse, pairs: Pairs) -> Refusal:
        short = next((r for _, r in pairs if r.mode is Mode.NUMBER and len(r.names) < r.number), None)
        if short is not None:
            return self._not_so_many(short)
        binding = {variable: referent.names[0] for variable, referent in pairs}
        reason = why_impossible(use.row.condition, {**binding, RELATION: use.said[0]}, self.grounder)
        return self._cannot(use.reading, f": {reason}")


def _of_alternatives(parts: Sequence[Formula]) -> bool:
    """Return whether all say the same of several things: one predicate, and arguments that differ in one place."""
    atoms = [(part.predicate, part.terms) for part in parts if isinstance(part, Atom)]
    if len(atoms) < len(parts) or len({(predicate, len(terms)) for predicate, terms in atoms}) > 1:
        return False
    return sum(len(set(column)) > 1 for column in zip(*(terms for _, terms in atoms), strict=True)) == 1


def _misfit(rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading) -> tuple[str, str]:
    """Return why no row of a verb fits, in the words of the request, and how the verb can be said."""
    verb, text = words(reading.clause.verb), text_of(reading.clause)
    taken = dict.fromkeys(p for row in rows for slot in row.places for p in slot.prepositions)
    strange = [pair for pair in unit.relations if not relations_said(pair[0], tuple(taken))]
    if strange:
        message = f"'{verb}' takes no '{' '.join(words(part) for part in strange[0] if part)}' here"
    elif unit.direct is None:
        message = f"'{text}' does not say what to {verb}"
    elif taken and not unit.relations:
        message = f"'{text}' lacks a part with {' or '.join(repr(words(p)) for p in taken)}"
    else:
        message = f"'{text}' fits no form of '{verb}'"
    return message, f"say {forms(rows, reading.clause.verb)}"
