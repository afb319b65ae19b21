"""A clause as a PDDL goal: the row that fits, its slots filled, its noun phrases quantified."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import combinations, islice, product

from tmd.diagnostics import Refusal, RefusalKind, TmdError
from tmd.goals.clause_goal import ClauseGoal, ClauseReading, Unit, text_of
from tmd.goals.grounder import Moments, why_impossible
from tmd.goals.reading.noun_phrases import Memory, Mode, Referent, relations_said
from tmd.goals.reading.referents import PLACES, Referents
from tmd.goals.reading.requirements import BE, Requirements, States
from tmd.goals.sources.table import (
    ACTIONS,
    PREPOSITIONS,
    RELATION,
    GoalRow,
    GoalTable,
    Slot,
    family,
    slot_predicate,
    slot_types,
)
from tmd.language.clause import PERSONS, Clause, Quantifier
from tmd.language.lexicon.lexicon import Lexicon
from tmd.language.syntax.antecedents import is_one
from tmd.pddl.ground_formula import (
    FALSE,
    TRUE,
    atoms_of,
    conjunction,
    disjunction,
    goal_cubes,
    negation,
    only_negative,
)
from tmd.pddl.model import Atom, Formula, Or, conjuncts
from tmd.pddl.task import Bits
from tmd.planning.unsolvable import Impossible
from tmd.veil.world import World

_PARTICLES = {"in": "in", "on": "on", "into": "in", "onto": "on"}


class Fitting:
    """Chooses among the rows of a verb.

    Args:
        referents: What nouns mean.
    """

    def __init__(self, referents: Referents) -> None:
        self.referents = referents
        self.domain = referents.domain
        self.grounder = referents.grounder
        self.nouns = referents.nouns

    def of(self, rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading) -> list[GoalRow]:
        """The rows that fit, those first that take more of what was said, and that just as it was said."""
        counted = reading.clause.phrase(unit.direct or "").quantifier in (Quantifier.ALL, Quantifier.NUMBER)
        return sorted(
            (row for row in rows if self._fits(row, unit, reading)),
            key=lambda row: (
                not (row.looks_back and not unit.relations),  # "put it back": where it was
                -len(row.slots) - (row.noun is not None),
                -self._latest(row, unit, reading),
                counted and not self._takes_things(row, unit, reading),
                row.source == ACTIONS and not self._takes_named(row, unit),
            ),
        )

    def may_tell_which(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> bool:
        """Whether a place that a row takes is where one of the things is now: *the bottle on the table*."""
        none = unit.direct is not None and reading.clause.phrase(unit.direct).quantifier is Quantifier.NONE
        if none or reading.clause.verb in ("put", "place", "set", "make_sure"):
            return False  # they say where something shall be, or nothing
        said = [pair for slot in row.places for pair in self.fillers(slot, unit, reading)]
        where = any(said[:1] and said[0][0] in PREPOSITIONS[p] for p in ("in", "on", "next_to", "under"))
        definite = unit.direct is not None and reading.clause.phrase(unit.direct).definite
        where = where or (definite and said[:1] != [] and said[0][0] == "of")  # "take the cup of water"
        if not where or len(said) != 1 or len(unit.relations) != 1 or said[0][1] is None:
            return False
        return self.referents.tells_which(unit, said[0][0], said[0][1], reading)

    def _takes_things(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> bool:
        """Whether what the verb acts on may be an object, not only something that objects contain."""
        if row.direct is None or unit.direct is None:
            return False
        types = slot_types(row.condition, row.direct.variable, self.domain)
        return any(self.grounder.is_a(name, types) for name in self.nouns.things(unit.direct, reading.state))

    def takes_all(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> bool:
        """Whether what stands behind the prepositions of a row was said, and may ever be there.

        An oven holds no milk: *heat the milk in the oven* says where it is done.
        """
        for slot in row.places:
            predicate, place = slot_predicate(row.condition, slot.variable)
            for _, target in self.fillers(slot, unit, reading):
                names = self.referents.targets(target, reading) if target else ()
                facts = (fact for name in names for fact in self.nouns.facts_about(name))
                if not any(fact.predicate == predicate and fact.args[place] in names for fact in facts):
                    return False
        return True

    def _latest(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> int:
        """How late what a row takes was said: *the book on the table in the box* says last where it shall go."""
        taken = [pair for slot in row.places for pair in self.fillers(slot, unit, reading)]
        return max((unit.relations.index(pair) for pair in taken if pair in unit.relations), default=0)

    def _takes_named(self, row: GoalRow, unit: Unit) -> bool:
        """Whether what the verb acts on may be what the noun names, not only what holds it: *manure*, the barrow."""
        if row.direct is None or not unit.direct:
            return True
        types = slot_types(row.condition, row.direct.variable, self.domain)
        ranked = self.referents.world.mentions.ranked(unit.direct)
        return not ranked or any(self.grounder.is_a(m.name, types) for m in ranked if m.how == ranked[0].how)

    def _fits(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> bool:
        if (row.result or None) != (reading.clause.result if row.result else None):
            return False
        if row.noun is not None and not self._same(row.noun, unit.direct, reading):
            return False
        if row.noun is None and (row.direct is None) != (unit.direct is None):
            return False
        return all(self.fillers(slot, unit, reading) for slot in row.places)

    def _same(self, noun: str, said: str | None, reading: ClauseReading) -> bool:
        """Whether two nouns are the same, or name the same things here: *kettle*, *kettel*."""
        if noun == said or said is None or noun.endswith("s"):
            return noun == said
        named = self.nouns.things(noun, reading.state)
        return bool(named) and named == self.nouns.things(said, reading.state)

    def fillers(self, slot: Slot, unit: Unit, reading: ClauseReading) -> list[tuple[str, str | None]]:
        """What was said in a slot: relation and noun; a particle alone leaves the noun to what was spoken of."""
        said = [
            (r, t)
            for r, t in unit.relations
            if relations_said(r, slot.prepositions)
            and not (r == "with" and reading.clause.phrase(t).quantifier is Quantifier.NONE)
        ]
        if len({r for r, _ in said}) > 1 or len(said) > 1:
            # "the mug in the sink on the shelf": what holds already tells which mug, the rest where it shall go
            said = [pair for pair in said if not self.referents.tells_which(unit, *pair, reading)] or said[-1:]
        if said:
            first = said[0][0]
            return [(r, t) for r, t in said if r == first]
        if not reading.memory.recent or any(r.target in PERSONS for r in reading.clause.relations):
            return []  # "bring me the milk" says where
        particle = _PARTICLES.get(reading.clause.verb.rpartition("_")[2])
        if particle in slot.prepositions:
            return [(particle, None)]
        # "take a cup, add sugar": into what was spoken of last
        verbs = (reading.clause.verb, self.referents.lexicon.canonical_verb(reading.clause.verb))
        wants_place = {"put", "add", "pour"} & {*verbs, *(name for verb in verbs for name in family(verb))}
        either = {"in", "on"} <= set(slot.prepositions)
        into = "to" if either else next((p for p in slot.prepositions if p in ("in", "on")), None)
        return [(into, None)] if wants_place and into and not unit.relations else []


_NEVER_OTHERWISE = Or((FALSE,))
"""Stands for what holds of a thing because the contrary never can: as good as FALSE where that thing alone is meant."""
_DEAD = (FALSE, _NEVER_OTHERWISE)
_MOST_CHOICES = 200
"""Maximum number of ways of choosing two of many things."""
_NAMING = frozenset({"with", "using", "of", "in", "into", "on", "onto", "from", "out_of", "off", "under", "next_to"})
"""Relations whose nouns must name something."""
_ELIDED = ("in", "on", "to")
"""The places that a verb may leave to what was spoken of."""


class GoalReader:
    """Reads clauses as goals in one environment.

    Args:
        world: The environment.
        tables: What verbs mean, the surest source first; adjectives and groups are those of the first.
        lexicon: The domain's words.
        guess: Whether a thing may be taken for what a noun is only like in meaning.
    """

    def __init__(self, world: World, tables: Sequence[GoalTable], lexicon: Lexicon, *, guess: bool = False) -> None:
        self.world = world
        self.tables = tuple(tables)
        self.lexicon = lexicon
        self.domain = world.task.problem.domain
        self.referents = Referents(world, tables[0] if tables else GoalTable(), lexicon, guess=guess)
        self.requirements = Requirements(self.referents)
        self.states = States(self.referents)
        self.fitting = Fitting(self.referents)
        self.grounder = self.referents.grounder
        self.nouns = self.referents.nouns
        self.exclusions = Impossible(world.task)

    def read(self, clause: Clause, state: Bits, memory: Memory, *, awaited: bool = False) -> ClauseGoal | Refusal:
        """What ``clause`` asks for, or says that it is waited for, said when ``state`` holds."""
        reading = ClauseReading(clause, state, Moments(state, memory.first), memory, awaited=awaited)
        clause = reading.clause = self.referents.reattached(reading)
        if (
            clause.implied
            and clause.verb == "have"
            and any(r.source in clause.direct and r.relation not in ("of", "with", "without") for r in clause.relations)
        ):
            placed = self.read(replace(clause, verb="put", implied=False), state, memory)
            if not isinstance(placed, Refusal):
                return placed  # "mug on the table" says where it shall be
        bare = clause.verb == BE and not clause.relations and not clause.result
        if bare or ((clause.verb == BE or clause.result) and not self._rows_with(clause)):
            return self._state(reading)
        own = list(dict.fromkeys((clause.verb, *self._synonyms(clause.verb))))
        plain = clause.verb.partition("_")[0]
        goals = {word for group in ("in", "on", "next_to", "to") for word in PREPOSITIONS[group]}
        goes = any(r.source in clause.direct and r.relation in goals for r in clause.relations)
        phrasal = clause.verb.count("_") == 1  # to take out is to take; to get rid of is not to get
        if phrasal and (goes or not clause.verb.endswith(("_out", "_away", "_off", "_ready"))):
            own += [v for v in (plain, *self._synonyms(plain)) if v not in own]
        found = self._by_tables(own, reading)
        if isinstance(found, Refusal) and clause.verb == BE and found.kind is not RefusalKind.NO_SUCH_THING:
            asked = self._state(reading.again(strict=False))
            found = found if isinstance(asked, Refusal) else asked
        return found

    def _state(self, reading: ClauseReading) -> ClauseGoal | Refusal:
        """What a clause says to be so, or to be there.

        *I want the table laid* is to lay it, where no state is called so.
        """
        clause = reading.clause
        asked = self.states.read(reading)
        done = self.lexicon.verb(clause.result) if clause.result and clause.verb in ("have", "get", "be") else None
        if (
            isinstance(asked, Refusal)
            and asked.kind is RefusalKind.NOT_UNDERSTOOD
            and done is not None
            and done[1] == "ed"
        ):
            said = replace(clause, verb=done[0], result=None, implied=False)
            found = self.read(said, reading.state, reading.memory, awaited=reading.awaited)
            return asked if isinstance(found, Refusal) else found
        return asked if isinstance(asked, Refusal) else self._finished(asked, None, reading)

    def knows(self, noun: str) -> bool:
        """Whether the domain has a word for a noun, be there such a thing here or not."""
        words = {t.name for t in self.domain.types} | {c.name for c in self.domain.constants}
        return bool(words & {noun, *self.lexicon.nouns.get(noun, ())}) or self.nouns.is_group(noun)

    def _by_tables(self, own: Sequence[str], reading: ClauseReading) -> ClauseGoal | Refusal:
        """The goal by the first source that knows the verb."""
        failure: Refusal | None = None
        for table in self.tables:  # a weaker source is asked only where the surer ones know nothing
            found = self._by_table(table, own, reading)
            if isinstance(found, ClauseGoal):
                return found
            failure = failure or found
            if found is not None and found.kind is not RefusalKind.NOT_UNDERSTOOD:
                return found
        return failure or self._unknown(reading.clause)

    def _by_table(self, table: GoalTable, own: Sequence[str], reading: ClauseReading) -> ClauseGoal | Refusal | None:
        """The goal by the rows of one source; ``None`` where it knows neither the verb nor its family."""
        failure: Refusal | None = None
        others = self._family(own)
        if any(row.source == ACTIONS for row in table.rows[:1]):
            # an action that takes just what was named is meant rather than what an action does to a relative of it
            self.grounder.exact = True
            try:
                for known in filter(None, map(table.of, (*own, *others))):
                    found = self._by_rows(known, reading.again(strict=True))
                    if not isinstance(found, Refusal) or found.kind is RefusalKind.IMPOSSIBLE:
                        return found
            finally:
                self.grounder.exact = False
        looser = () if self._is_placing(reading.clause) else ((False, others),)  # to put is more than to take
        alone = not any(r.source in reading.clause.direct for r in reading.clause.relations)
        itself = (reading.clause.verb, *self._synonyms(reading.clause.verb))
        for strict, verbs in ((True, own), (True, others), (False, own), *looser):
            for verb in verbs:
                # what another verb leaves without a trace says nothing of this one: to put is not to sit
                rows = [row for row in table.of(verb) if verb in own or not row.traceless]
                if not rows:
                    continue
                found = self._by_rows(rows, reading.again(strict=strict))
                if isinstance(found, ClauseGoal):
                    return found
                if alone and verb in itself and found.kind is RefusalKind.IMPOSSIBLE:
                    return found  # what the verb itself asks for can never be: its relatives would ask for less
                if failure is None or failure.kind is RefusalKind.NOT_UNDERSTOOD:
                    failure = found
            settled = failure is not None and failure.kind is not RefusalKind.NOT_UNDERSTOOD
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

    def _unknown(self, clause: Clause) -> Refusal:
        known = sorted({verb for table in self.tables for verb in table.verbs()} - {BE})
        verb = clause.verb.replace("_", " ")
        hint = f"say it with another verb, such as {', '.join(known[:6])}" if known else None
        return Refusal(RefusalKind.UNKNOWN_VERB, f"nobody has shown or declared what '{verb}' means", hint)

    def _by_rows(self, rows: Sequence[GoalRow], reading: ClauseReading) -> ClauseGoal | Refusal:
        """The goal by the first rows that fit every thing the verb acts on."""
        parted = self._one_and_other(reading)
        shared = self._one_place(reading) if parted is None else None
        found = self._with_one(parted or shared, rows, reading)
        if shared is not None and (isinstance(found, Refusal) or (found and self._excluded(found[0], reading))):
            # two pots on a burner: one each
            found, reading.meant, reading.approach = None, {}, []
        if found is None:
            found = self._of_units(rows, reading)
        return found if isinstance(found, Refusal) else self._finished(*found, reading)

    def _with_one(
        self, noun: str | None, rows: Sequence[GoalRow], reading: ClauseReading
    ) -> tuple[Formula, GoalRow | None] | Refusal | None:
        """The goal with one thing for all that is said of a noun, whichever it is; ``None`` where none is left open."""
        candidates = self.referents.targets(noun, reading) if noun is not None else ()
        things = tuple(n for n in candidates if n not in self.world.profiles.constants) or candidates
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
        if not ways:
            return failure
        return disjunction(formula for formula, _ in ways), ways[-1][1]

    def _one_place(self, reading: ClauseReading) -> str | None:
        """The place where several things shall go: "milk and coffee in a mug" is one mug, whichever it is."""
        clause = reading.clause
        for noun, phrase in clause.phrases.items():
            one = phrase.quantifier in (Quantifier.PLAIN, Quantifier.SOME) and not (phrase.plural or phrase.each)
            sources = {r.source for r in clause.relations if r.target == noun and r.relation in PLACES}
            if one and len(sources.intersection(clause.direct)) > 1 and not self.referents.points_back(noun):
                return noun
        return None

    def _excluded(self, formula: Formula, reading: ClauseReading) -> bool:
        """Whether it is proven that something can never be: two pots on one burner."""
        try:
            return self.exclusions.reason(reading.state, goal_cubes(self.world.task, formula)) is not None
        except TmdError:  # too many conjunctions, which is told where the goal is finished
            return False

    def _one_and_other(self, reading: ClauseReading) -> str | None:
        """The noun of which one thing is spoken of more than once: "tea in one of the cups and milk in the other".

        Or: "coffee in a mug and some milk in it".
        """
        clause = reading.clause
        for noun, phrase in clause.phrases.items():
            meant = clause.meant(noun)[0]
            other = is_one(noun) and phrase.quantifier is Quantifier.OTHER
            same = noun == "it" and any(r.target == noun for r in clause.relations)
            first = clause.phrases.get(meant)
            if (other or same) and first is not None and first.quantifier not in (Quantifier.ALL, Quantifier.OTHER):
                return meant
        return None

    def _of_units(self, rows: Sequence[GoalRow], reading: ClauseReading) -> tuple[Formula, GoalRow | None] | Refusal:
        """What shall hold of all that the verb acts on, and the last row that says so."""
        formulas: list[Formula] = []
        used: GoalRow | None = None
        for unit in self.referents.units(reading):
            found = self._unit(rows, unit, reading)
            if isinstance(found, Refusal):
                found = self._measured(rows, unit, reading) or found
            if isinstance(found, Refusal):
                return found
            formula, used = found
            formula = self._as_at_first(formula, reading)
            formulas.append(self._where_spoken_of(formula, used, unit, reading))
        either = any(reading.clause.phrase(name).either for name in reading.clause.direct)
        none = all(reading.clause.phrase(n).quantifier is Quantifier.NONE for n in reading.clause.direct or ("",))
        return disjunction(formulas) if either or none else conjunction(formulas), used

    def _as_at_first(self, formula: Formula, reading: ClauseReading) -> Formula:
        """Of several places where a thing may be put *back* the one where it was: *back on its burner*."""
        if not reading.clause.verb.endswith("_back") or not isinstance(formula, Or):
            return formula
        then = [part for part in formula.parts if self.grounder.truth(part, reading.memory.first)]
        return disjunction(then) if then else formula

    def _where_spoken_of(self, formula: Formula, row: GoalRow, unit: Unit, reading: ClauseReading) -> Formula:
        """Of several things that *the* one may be the one where that is which was spoken of last.

        *Put the pot on the stove. Light the burner*: the burner that the pot stands on.
        """
        said = reading.clause.phrase(unit.direct or "")
        one = said.definite and not said.plural and said.quantifier is Quantifier.PLAIN
        if not one or row.places or not isinstance(formula, Or) or not _of_alternatives(formula.parts):
            return formula
        for name in reading.memory.recent:
            facts = (f for f in self.nouns.facts_about(name) if f in self.world.task.index)
            joined = {other for f in facts if self.grounder.holds(f, reading.state) for other in f.args} - {name}
            near = [part for part in formula.parts if any(joined.intersection(a.args) for a in atoms_of(part))]
            if near and not any(name in a.args for a in atoms_of(formula)):
                return disjunction(near)
        return formula

    def _measured(self, rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading) -> tuple[Formula, GoalRow] | None:
        """*Two spoons of coffee* is some coffee, where nothing can be said of the spoons."""
        inner = next((target for relation, target in unit.relations if relation == "of"), None)
        if inner is None or not self.nouns.constants(inner, ("object",), reading.state):
            return None
        others = [(r, t) for r, t in unit.relations if r != "of"]
        clause, measure = reading.clause, reading.clause.phrase(unit.direct or "")
        held = self.nouns.holders(measure.name, self.referents.targets(inner, reading), reading.state, reading.moments)
        few = measure.quantifier is Quantifier.NUMBER and 0 < len(held) < (measure.number or 1)
        if few and all(map(self.nouns.is_supply, held)):
            return None  # two packets, where there is one
        if measure.quantifier is not Quantifier.PLAIN or not measure.plural:  # of one packet of noodles one is meant
            counted = replace(
                clause.phrase(inner), quantifier=measure.quantifier, number=measure.number, plural=measure.plural
            )
            reading.clause = replace(clause, phrases={**clause.phrases, inner: counted})
        found = self._unit(rows, Unit(inner, others + self.referents.relations_of(inner, clause)), reading)
        reading.clause = clause
        if isinstance(found, Refusal):
            return None
        if unit.direct is not None and inner in reading.meant:
            reading.meant.setdefault(unit.direct, reading.meant[inner])
        return found

    def _finished(self, formula: Formula, row: GoalRow | None, reading: ClauseReading) -> ClauseGoal | Refusal:
        if reading.clause.direct and all(
            reading.clause.phrase(n).quantifier is Quantifier.NONE for n in reading.clause.direct
        ):
            formula = negation(formula)
        try:
            cubes = goal_cubes(self.world.task, formula)
        except TmdError as error:
            return Refusal(RefusalKind.NOT_UNDERSTOOD, error.message, error.hint)
        if not cubes:
            return Refusal(
                RefusalKind.CONTRADICTION, f"'{reading.clause.text}' asks for what cannot hold at the same time"
            )
        return ClauseGoal(
            reading.clause,
            formula,
            cubes,
            row,
            dict(reading.meant),
            tuple(reading.approach),
            tuple(reading.released),
            tuple(dict.fromkeys(reading.notes)),
        )

    def _unit(self, rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading) -> tuple[Formula, GoalRow] | Refusal:
        """The goal of one thing; a pronoun is what it most likely means of that which a row fits."""
        if unit.direct is None or not self.referents.points_back(unit.direct):
            return self._with_places(rows, unit, reading)
        failure: Refusal | None = None
        held: tuple[tuple[Formula, GoalRow], dict[str, tuple[str, ...]]] | None = None
        reading.pronoun = unit.direct
        options = self.referents.antecedents(unit.direct, reading)
        for number in range(len(options) or 1):
            reading.antecedent = number
            before = dict(reading.meant)
            found = self._with_rows(rows, unit, reading)
            if isinstance(found, Refusal):
                failure = failure or found
            elif self.grounder.truth(found[0], reading.state) and atoms_of(found[0]):
                if reading.awaited:
                    return found
                held = held or (found, reading.meant)  # so already: rather what is not
                reading.meant = before
            elif held is None or not options[number][1] or found[1].looks_back:
                return found
        if held is not None:
            reading.meant = held[1]
            return held[0]
        assert failure is not None
        return failure

    def _with_places(
        self, rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading
    ) -> tuple[Formula, GoalRow] | Refusal:
        """As :meth:`_with_rows`, with places that point back: what was spoken of last and a row fits.

        A place may be left out (*pour the milk*) or be a pronoun (*pour the milk in it*); it is then no object of the
        clause itself, whatever row would fit that.
        """
        fillers = [f for row in rows for slot in row.places for f in self.fitting.fillers(slot, unit, reading)]
        back = [""] if any(relation in _ELIDED and target is None for relation, target in fillers) else []
        pronouns = (target for _, target in fillers if target is not None and self.referents.points_back(target))
        back += [p for p in islice(pronouns, 1) if reading.clause.together.get(p, 1) == 1]
        for pronoun in back:
            reading.pronoun = pronoun
            for number, (_, is_object) in enumerate(self.referents.antecedents(pronoun, reading)):
                reading.antecedent = number
                found = self._with_rows(rows, unit, reading)
                if not isinstance(found, Refusal) and (not is_object if pronoun else found[1].places):
                    return found
            reading.pronoun = reading.antecedent = None
        return self._with_rows(rows, unit, reading)

    def _with_rows(
        self, rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading
    ) -> tuple[Formula, GoalRow] | Refusal:
        """The goal of one thing by the row with the most slots that fits and can hold."""
        failure: Refusal | None = None
        fitting = self.fitting.of(rows, unit, reading)
        impossible: set[str] = set()
        most = 0
        for place, row in enumerate(fitting):
            if impossible and (row.source != ACTIONS or row.evidence in impossible) and len(row.slots) < most:
                continue  # what cannot be done with all that was said is not done with less
            before = dict(reading.meant), list(reading.approach), list(reading.notes)
            found = self._by_row(row, unit, reading)
            shorter = [r for r in fitting[place + 1 :] if len(r.slots) < len(row.slots)]
            if not isinstance(found, Refusal) and shorter and self.fitting.may_tell_which(row, unit, reading):
                # what holds already told which thing is meant, if the verb can do without it
                held = self.grounder.truth(found, reading.state)
                other = self._with_rows(shorter, unit, reading)
                if isinstance(other, Refusal):
                    if (
                        other.kind is RefusalKind.NO_SUCH_THING
                    ):  # "everything on the floor that is empty", where nothing is
                        return other
                elif held or not self.grounder.truth(other[0], reading.state):
                    return other
            if not isinstance(found, Refusal):
                return found, row
            failure = failure or found
            if found.kind is RefusalKind.IMPOSSIBLE and self.fitting.takes_all(row, unit, reading):
                impossible.add(row.evidence)
                most = max(most, len(row.slots))
            reading.meant, reading.approach, reading.notes = before
        if failure is not None:
            return failure
        said = text_of(reading.clause)
        known = "; ".join(dict.fromkeys(row.pattern for row in rows))
        return Refusal(
            RefusalKind.NOT_UNDERSTOOD, f"'{said}' does not fit what is known of its verb", f"known: {known}"
        )

    def _by_row(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> Formula | Refusal:
        """The goal of one thing by one row: for each combination of what stands behind the prepositions."""
        consumed: set[tuple[str, str | None]] = set()
        choices: list[list[tuple[Slot, str, str | None]]] = [[]]
        alternatives = False
        for slot in row.places:
            fillers = self.fitting.fillers(slot, unit, reading)
            consumed.update(fillers)
            alternatives = alternatives or any(t and reading.clause.phrase(t).either for _, t in fillers)
            choices = [[*c, (slot, relation, target)] for c in choices for relation, target in fillers]
        leftover = [pair for pair in unit.relations if pair not in consumed]
        if (reading.strict or row.source == ACTIONS) and any(
            self.referents.unplaced(unit, *pair, reading) for pair in leftover
        ):
            return Refusal(
                RefusalKind.NOT_UNDERSTOOD, f"'{text_of(reading.clause)}' says a place that nothing is known of"
            )
        unknown = self._unknown_thing(leftover, reading)
        if unknown is not None:
            return unknown
        formulas = []
        for choice in choices:
            found = self._combination(row, unit.direct, choice, leftover, reading)
            if isinstance(found, Refusal):
                if not alternatives:
                    return found
                continue
            formulas.append(found)
        if not formulas:
            return Refusal(RefusalKind.IMPOSSIBLE, f"'{text_of(reading.clause)}' cannot be done here")
        return disjunction(formulas) if alternatives else conjunction(formulas)

    def _unknown_thing(self, leftover: Sequence[tuple[str, str]], reading: ClauseReading) -> Refusal | None:
        """A thing that was named and that is not there: whatever is done without it is something else."""
        if self.nouns.guess:
            return None
        for relation, target in leftover:
            named = not self.referents.points_back(target) and target not in reading.clause.quantities
            if reading.clause.phrase(target).quantifier is Quantifier.NONE:
                continue  # "no raspberry", where there is none
            if named and relation in _NAMING and not self.referents.targets(target, reading):
                return self.referents.missing(Referent(target, ()), reading)
        return None

    def _combination(
        self,
        row: GoalRow,
        direct: str | None,
        places: Sequence[tuple[Slot, str, str | None]],
        leftover: Sequence[tuple[str, str]],
        reading: ClauseReading,
    ) -> Formula | Refusal:
        slots: list[tuple[Slot, list[Referent]]] = []
        if row.direct is not None and direct is not None:
            slots.append((row.direct, self.referents.referents(direct, row, row.direct, leftover, reading)))
            slots[0] = (row.direct, [self._at_origin(r, places, reading) for r in slots[0][1]])
        relations: dict[str, tuple[str, ...]] = {}
        for slot, relation, target in places:
            relations[slot.variable] = relations_said(relation, slot.prepositions)
            noun = "" if target is None else target
            slots.append(
                (
                    slot,
                    self.referents.referents(
                        noun, row, slot, self.referents.relations_of(noun, reading.clause) if noun else (), reading
                    ),
                )
            )
        failure: Refusal | None = None
        for chosen in product(*(options for _, options in slots)):
            if any(not referent.names for referent in chosen):
                missing = next(referent for referent in chosen if not referent.names)
                failure = failure or self.referents.missing(missing, reading)
                continue
            pairs = [(slot.variable, referent) for (slot, _), referent in zip(slots, chosen, strict=True)]
            formula = self._formula(row, pairs, relations, direct, leftover, reading)
            if formula == FALSE:
                failure = failure or self._impossible(row, pairs, relations, reading)
                continue
            for _, referent in pairs:
                reading.meant[referent.noun] = referent.names
            return formula
        return failure or Refusal(RefusalKind.IMPOSSIBLE, f"'{text_of(reading.clause)}' cannot be done here")

    def _at_origin(
        self, referent: Referent, places: Sequence[tuple[Slot, str, str | None]], reading: ClauseReading
    ) -> Referent:
        """*Everything off the table*: of what is meant, what is there now."""
        for _, relation, target in places:
            if target is not None and relation in PREPOSITIONS["from"]:
                ends = self.referents.targets(target, reading)
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
        reading: ClauseReading,
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

        further = self.requirements.further(row, pairs, direct, leftover, reading)
        excepted = frozenset(self.referents.excepted(leftover, reading))

        def whole(binding: Mapping[str, str]) -> Formula:
            formula = self._but_for(excepted, lambda: leaf(binding), reading)
            settled = formula == TRUE and row.source == ACTIONS  # no action moves a curtain from where it hangs
            if formula == FALSE or ((settled or not self.grounder.live) and not row.traceless):
                # what can never be so is not "not so already", but for one of many: all filters shall be clean
                return FALSE if formula == FALSE else _NEVER_OTHERWISE
            return conjunction((formula, *(extra(binding) for extra in further))) if further else formula

        each = [p for p in pairs if p[1].each]
        one = [p for p in pairs if p[1].mode is Mode.ANY and not p[1].each]
        many = [p for p in pairs if p[1].mode is not Mode.ANY and not p[1].each]
        formula = self._quantified([*each, *one, *many], {}, whole, reading)
        if formula in _DEAD and one and many:
            formula = self._quantified([*each, *many, *one], {}, whole, reading)
        return FALSE if formula in _DEAD else formula

    def _but_for(self, excepted: frozenset[str], condition: Callable[[], Formula], reading: ClauseReading) -> Formula:
        """A condition for all things but some, which stay as they are: *clear the table except the cup*."""
        everything = condition()
        self.grounder.excepted = excepted
        try:
            rest = condition() if excepted else everything
        finally:
            self.grounder.excepted = frozenset()
        if rest == everything:
            return everything
        spared = (part for part in conjuncts(everything) if part not in conjuncts(rest))
        return conjunction((rest, *(negation(p) for p in spared if not self.grounder.truth(p, reading.state))))

    def _quantified(
        self,
        pairs: Sequence[tuple[str, Referent]],
        binding: Mapping[str, str],
        leaf: Callable[[Mapping[str, str]], Formula],
        reading: ClauseReading,
    ) -> Formula:
        """The condition over all candidates, quantifier after quantifier."""
        if not pairs:
            return leaf(binding)
        (variable, referent), *rest = pairs
        parts = {name: self._quantified(rest, {**binding, variable: name}, leaf, reading) for name in referent.names}
        alive = {name: part for name, part in parts.items() if part not in _DEAD}
        match referent.mode:
            case Mode.ALL:
                kept = alive if referent.loose or FALSE not in parts.values() else parts
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

    def _impossible(
        self,
        row: GoalRow,
        pairs: Sequence[tuple[str, Referent]],
        relations: Mapping[str, tuple[str, ...]],
        reading: ClauseReading,
    ) -> Refusal:
        short = next((r for _, r in pairs if r.mode is Mode.NUMBER and len(r.names) < r.number), None)
        if short is not None:
            called = "1 thing here is" if len(short.names) == 1 else f"{len(short.names)} things here are"
            message = f"only {called} called '{short.noun.replace('_', ' ')}', not {short.number}"
            return Refusal(RefusalKind.NO_SUCH_THING, message)
        said = next((names for names in relations.values() if names), ("",))
        binding = {variable: referent.names[0] for variable, referent in pairs}
        reason = why_impossible(row.condition, {**binding, RELATION: said[0]}, self.world.task, self.grounder)
        return Refusal(RefusalKind.IMPOSSIBLE, f"'{text_of(reading.clause)}' cannot be done here: {reason}")


def _of_alternatives(parts: Sequence[Formula]) -> bool:
    """Whether all say the same of several things: one predicate, and arguments that differ in one place."""
    atoms = [(part.predicate, part.terms) for part in parts if isinstance(part, Atom)]
    if len(atoms) < len(parts) or len({(predicate, len(terms)) for predicate, terms in atoms}) > 1:
        return False
    return sum(len(set(column)) > 1 for column in zip(*(terms for _, terms in atoms), strict=True)) == 1
