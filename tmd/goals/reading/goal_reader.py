"""A clause as a PDDL goal: by the rows of its verb in the first source that knows it, or as a state."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import chain

from tmd.diagnostics import Refusal, RefusalKind
from tmd.goals.clause_goal import ClauseGoal, ClauseReading, Decisions, lost_amount, words
from tmd.goals.grounder import Grounder, Moments
from tmd.goals.preferences import LEAST, ODDS
from tmd.goals.reading.noun_phrases import Memory
from tmd.goals.reading.referents import Referents, is_none
from tmd.goals.reading.row_reader import RowReader
from tmd.goals.reading.states import States
from tmd.goals.reasons import DOER, nearest_verbs
from tmd.goals.sources.actions import participle, plain_words
from tmd.goals.sources.table import ACTIONS, GoalTable, atoms_in
from tmd.goals.words import (
    BE,
    IT,
    NEGATED,
    PREPOSITIONS,
    SETTING,
    family,
    is_noun,
    is_one,
    is_relation,
    is_verb,
    ranked,
    relations_said,
    results,
    table,
    the_word,
    words_of,
)
from tmd.language.clause import AGENT, BRING, PERSONS, PUT, TO, WITH, Clause, NounPhrase, Quantifier, Relation
from tmd.language.lexicon.lexicon import Lexicon, builtin, section
from tmd.language.lexicon.names import split_name
from tmd.pddl.ground_formula import TRUE, conjunction, disjunction
from tmd.pddl.model import Not, Or, Predicate, hierarchy
from tmd.pddl.task import Bits, Cube, Operator
from tmd.world.world import World


class GoalReader:
    """Reads clauses as goals in one environment.

    Args:
        world: The environment.
        tables: The meanings of verbs, the surest source first; adjectives and groups are those of the first.
        lexicon: The domain's words.
        guess: Whether a thing may be taken for what a noun is only like in meaning.
    """

    def __init__(self, world: World, tables: Sequence[GoalTable], lexicon: Lexicon, *, guess: bool = False) -> None:
        self.world = world
        self.tables = tuple(tables)
        self.lexicon = lexicon
        self.guess = guess
        self.domain = world.domain
        self.grounder = Grounder(world)
        self.rows = self._row_reader(self.grounder)
        self.referents = self.rows.referents
        self.nouns = self.referents.nouns
        self.states = States(self.referents)

    def _row_reader(self, grounder: Grounder) -> RowReader:
        table = self.tables[0] if self.tables else GoalTable()
        return RowReader(Referents(self.world, table, self.lexicon, grounder, guess=self.guess))

    @cached_property
    def _exact_rows(self) -> RowReader:
        """Reads rows with nothing standing in for what was named."""
        return self._row_reader(self.grounder.exactly)

    def candidates(
        self, clause: Clause, state: Bits, memory: Memory, *, awaited: bool = False
    ) -> list[tuple[float, ClauseGoal]] | Refusal:
        """Return the goals that a clause may ask for, the likeliest first, or why there is none.

        Each comes with the natural logarithm of the belief in it, relative to that in the likeliest. The others differ
        from that in one decision.
        """
        decisions = Decisions()
        first = self.read(clause, state, memory, awaited=awaited, decisions=decisions)
        if isinstance(first, Refusal):
            return first
        found = {first.formula: (0.0, first)}
        for decision, count in decisions.met.items():
            odds = ODDS[decision.kind]
            for number in range(1, count):
                if -odds * number < LEAST:
                    break
                changed = Decisions({decision: number})
                other = self.read(clause, state, memory, awaited=awaited, decisions=changed)
                if isinstance(other, ClauseGoal) and other.formula != TRUE:  # nobody asks for nothing
                    found.setdefault(other.formula, (-odds * number, other))
        return sorted(found.values(), key=lambda goal: -goal[0])

    def read(
        self,
        clause: Clause,
        state: Bits,
        memory: Memory,
        *,
        awaited: bool = False,
        decisions: Decisions | None = None,
    ) -> ClauseGoal | Refusal:
        """Return what ``clause`` asks for, or says that it is waited for, said when ``state`` holds."""
        decisions = decisions or Decisions()
        reading = ClauseReading(clause, Moments(state, memory.first), memory, awaited=awaited, decisions=decisions)
        told = self.referents.reattached(reading)
        plain = self._by_anyone(told)
        if plain != told:
            found = self.read(plain, state, memory, awaited=awaited, decisions=decisions)
            return found if isinstance(found, Refusal) else self._by_whom(found, told, state)
        clause = reading.clause = self._with_states(self._of_oneself(told))
        lost = None if self.guess else lost_amount(clause)
        if lost is not None:
            message = f"nothing here can tell '{lost}' of something"
            return Refusal(RefusalKind.NOT_UNDERSTOOD, message, "leave it out, or allow guesses")
        if self._is_to_settle(clause):
            found = self.read(self._settled(clause), state, memory, decisions=decisions)
            if not isinstance(found, Refusal) or any(is_relation(r.relation, "place") for r in clause.relations):
                return found  # "mug on the table" says where it shall be
        treated = self._as_known(clause)
        if treated is not None:
            return self.read(treated, state, memory, decisions=decisions)
        if self._is_state(clause):
            return self._state(reading)
        found = self._by_tables(self._own_verbs(clause), reading)
        return self._read_again(reading, found) if isinstance(found, Refusal) else self._with_tools(found, reading)

    def _as_known(self, clause: Clause) -> Clause | None:
        """Return a clause in another form of words that the domain knows; ``None`` where there is none."""
        return (
            self._undone(clause)
            or self._modified(clause)
            or self._treated(clause)
            or self._dative(clause)
            or self._phrasal(clause)
        )

    def _with_tools(self, found: ClauseGoal, reading: ClauseReading) -> ClauseGoal:
        """Return a goal with a warning for each tool that no action for the goal uses."""
        notes = []
        for relation in reading.clause.relations:
            tools = self.nouns.things(relation.target, reading.state) if is_relation(relation.relation, "tool") else ()
            used = chain(self._in_goal(found), self._ways(found, reading.state))
            if tools and not any(set(tools) & names for names in used):
                notes.append(f"'{words(relation.relation)} {words(relation.target)}' says nothing here")
        return replace(found, notes=tuple(dict.fromkeys((*found.notes, *notes)))) if notes else found

    def _means(self, relation: Relation, reading: ClauseReading) -> frozenset[str]:
        """Return the things that a relation may name as a place or tool of what is done; none for what is acted on."""
        direct = reading.clause.direct
        if relation.source not in (None, *direct):
            return frozenset()
        acted_on = {name for noun in direct for name in self.nouns.things(noun, reading.state)}
        return frozenset(self.nouns.things(relation.target, reading.state)) - acted_on

    def _in_goal(self, found: ClauseGoal) -> Iterator[set[str]]:
        """Yield the things of each cube of a goal."""
        task = self.world.task
        yield from ({n for a in task.names(c.positive | c.negative) for n in a.args} for c in found.cubes)

    def _ways(self, found: ClauseGoal, state: Bits) -> Iterator[set[str]]:
        """Yield the things of each action that brings about a part of a goal."""
        for part in (part for cube in found.cubes for part in cube.literals() if not part.holds(state)):
            yield from ({*op.instruction.args} for op in self.world.task.operators if _brings_about(op, part))

    def _read_again(self, reading: ClauseReading, refusal: Refusal) -> ClauseGoal | Refusal:
        """Return what a clause asks for that no row understands as it was said."""
        clause = reading.clause
        if clause.verb == BE and refusal.kind is not RefusalKind.NO_SUCH_THING:
            asked = self._state(reading.again())
            if not isinstance(asked, Refusal):
                return asked
            if (brought := self._brought(clause)) is not None:
                return self.read(brought, reading.state, reading.memory, decisions=reading.decisions)
        placed = self._placed(reading)
        if placed is None and clause.setting in words_of("extremes"):
            plain, memory = replace(clause, setting=None), reading.memory
            return self.read(plain, reading.state, memory, awaited=reading.awaited, decisions=reading.decisions)
        return placed or self._by_means(reading) or refusal

    def _brought(self, clause: Clause) -> Clause | None:
        """Return "every bed gets a pillow" as to bring one there; ``None`` where nothing is said to be had."""
        had = (r for r in clause.relations if clause.direct == (r.source,) and r.relation == WITH)
        relation = next(had, None)
        if relation is None or is_none(relation.target, clause):
            return None
        others = tuple(r for r in clause.relations if r != relation)
        goes = Relation(TO, relation.target, clause.direct[0])
        return replace(clause, verb=BRING, direct=(relation.target,), relations=(goes, *others))

    def _by_means(self, reading: ClauseReading) -> ClauseGoal | None:
        """Return the goal of a clause with a place or tool that every action for it needs; ``None`` for others.

        *Warm the pie in the oven*, where only the oven warms it.
        """
        clause = reading.clause
        placed = clause.verb == BE or clause.implied or clause.verb in section("placing")
        for relation in () if placed else clause.relations:
            means = self._means(relation, reading)
            others = tuple(r for r in clause.relations if r != relation)
            objects = tuple(noun for noun in clause.objects if noun != relation.target)
            plain = replace(clause, relations=others, objects=objects)
            found = self.read(plain, reading.state, reading.memory, decisions=reading.decisions) if means else None
            ways = list(self._ways(found, reading.state)) if isinstance(found, ClauseGoal) else []
            if isinstance(found, ClauseGoal) and ways and all(not means.isdisjoint(names) for names in ways):
                return found
        return None

    def _placed(self, reading: ClauseReading) -> ClauseGoal | None:
        """Return the goal of "put on the table", or "put the plate in", with what was spoken of; ``None`` for none."""
        clause = reading.clause
        verb, _, particle = clause.verb.partition("_")
        elided = "" in clause.antecedents
        there = not elided and bool(clause.direct and reading.memory.recent) and is_relation(particle, "resting")
        if clause.relations or not particle or not (elided or there):
            return None
        said = reading.again()
        if elided:
            where = tuple(Relation(particle, None, noun) for noun in clause.direct)
            said.clause = replace(clause, verb=verb, direct=(), relations=where)
        else:
            where = tuple(Relation(particle, noun, IT) for noun in clause.direct)
            said.clause = replace(clause, verb=verb, objects=(*clause.objects, IT), relations=where)
        found = self._by_tables(self._own_verbs(said.clause), said)
        return None if isinstance(found, Refusal) else found

    @cached_property
    def _place_states(self) -> Mapping[tuple[str, str], str]:
        """The states that a preposition and a noun name: ``on-table`` for *on* and *table*, *red* for *to red*."""
        unary = [p for p in self.domain.predicates if len(p.parameters) == 1]
        # a dog is ``on-lead``, whoever has the lead
        single = (p for p in self.domain.predicates if len(p.parameters) - self._acting(p) == 1)
        names = {p.name: "_".join(split_name(p.name)) for p in single}
        # "set the signal to red"
        states = {"_".join(plain_words(p, hierarchy(self.domain))) for p in unary} | self.tables[0].attributes.keys()
        return {(SETTING, state): state for state in states} | {
            (preposition, name.removeprefix(preposition).lstrip("_")): predicate
            for predicate, name in names.items()
            for preposition in PREPOSITIONS
            if name.startswith(preposition) and name != preposition
        }

    def _acting(self, predicate: Predicate) -> int:
        """Return how many of the parameters of a predicate are for those who act."""
        return sum(not self.nouns.actors.isdisjoint(parameter.types) for parameter in predicate.parameters)

    @cached_property
    def _mark_states(self) -> Mapping[str, str]:
        """The words in the names of predicates of one thing for what it has: a label is on what is ``labelled``."""
        types = hierarchy(self.domain)
        names = [plain_words(p, types) for p in self.domain.predicates if len(p.parameters) == 1]
        having = words_of("rows", "having")
        had = {"_".join(rest): rest[-1] for first, *rest in names if rest and first in having}
        # "a price is on each" where things are ``price_tagged``
        marked = {first: "_".join([first, *rest]) for first, *rest in names if len(rest) == 1 and participle(rest[0])}
        return {verb: first for first, *_ in names if (verb := participle(first)) is not None} | marked | had

    def _with_states(self, clause: Clause) -> Clause:
        """Return the clause with things that are none here, but states: "on the table", where all have one table.

        So is a label, where things are ``labelled``. What shall be so is the result of the clause; anything else tells
        which things are meant.
        """
        for relation in dict.fromkeys((*clause.relations, *clause.stated)):
            state = self._place_state(relation) or self._mark_state(relation, clause)
            if state and relation.source in clause.objects and not self._names_thing(relation.target):
                gone = clause.verb == BE and is_relation(relation.relation, "origin")  # "should be off the lead"
                clause = self._with_state(clause, relation, f"{NEGATED}{state}" if gone else state)
        return clause

    def _place_state(self, relation: Relation) -> str | None:
        """Return the state that a place is, of what leaves it or gets there."""
        origin = is_relation(relation.relation, "origin")
        said = (
            state
            for (preposition, noun), state in self._place_states.items()
            if noun == relation.target and (origin or relations_said(relation.relation, (preposition,)))
        )
        return next(said, None)

    def _mark_state(self, relation: Relation, clause: Clause) -> str | None:
        """Return the state of what has, or lacks, a mark: "the crates without a label" are not ``labelled``."""
        said = relation.relation.removeprefix(NEGATED)
        lacking = is_relation(said, "lacking")
        state = self._mark_states.get(relation.target) if lacking or is_relation(said, "accompanying") else None
        if state is None:
            return None
        none = lacking or said != relation.relation or is_none(relation.target, clause)
        return f"{NEGATED}{state}" if none else state

    @staticmethod
    def _with_state(clause: Clause, relation: Relation, state: str) -> Clause:
        """Return the clause with a state in the place of a relation: as its result, or as an adjective of the thing."""
        goes = _goes(clause, relation)
        relations, stated = (tuple(r for r in rs if r != relation) for rs in (clause.relations, clause.stated))
        objects = tuple(o for o in clause.objects if o != relation.target or any(o in r for r in relations))
        clause = replace(clause, relations=relations, stated=stated, objects=objects)
        if goes and clause.result in (None, state):
            return replace(clause, result=state)
        phrase = clause.phrase(relation.source or "")
        described = replace(phrase, attributes=(*phrase.attributes, state))
        return replace(clause, phrases={**clause.phrases, phrase.name: described})

    def _by_anyone(self, clause: Clause) -> Clause:
        """Return a clause without the thing that does it, where no row tells who does it."""
        rows = (row for table in self.tables for verb in self._own_verbs(clause) for row in table.of(verb))
        if clause.verb == BE or any(row.tells_agent for row in rows):
            return clause
        relations = tuple(r for r in clause.relations if r.relation != AGENT)
        doing = {r.target for r in clause.relations} - {r.target for r in relations} - {*clause.direct}
        return replace(clause, relations=relations, objects=tuple(n for n in clause.objects if n not in doing))

    def _by_whom(self, found: ClauseGoal, clause: Clause, state: Bits) -> ClauseGoal | Refusal:
        """Return a goal as far as it is about the things that act: "Nadia should start work at the pool"."""
        agents = [r.target for r in clause.relations if r.relation == AGENT]
        names = dict.fromkeys(name for noun in agents for name in self._acting_as(noun, clause, state))
        if not names:
            return found
        parts = found.formula.parts if isinstance(found.formula, Or) else (found.formula,)
        about = {name: [p for p in parts if any(name in atom.terms for atom in atoms_in(p))] for name in names}
        if not any(about.values()):
            said = DOER if self.is_actor(agents[0]) else "says nothing here"
            return replace(found, notes=(*found.notes, f"'{words(agents[0])}': {said}"))
        ways = map(disjunction, filter(None, about.values()))
        # "Ann and Joe need a helmet": each of them one
        formula = (conjunction if self._act_each(agents, clause) else disjunction)(ways)
        cubes = self.rows.cubes(formula, clause)
        return cubes if isinstance(cubes, Refusal) else replace(found, formula=formula, cubes=cubes)

    @staticmethod
    def _act_each(agents: Sequence[str], clause: Clause) -> bool:
        """Return whether each one of those who act does it: "everybody", "Ann and Joe"; but not "Ann or Joe"."""
        said = clause.phrase(agents[0])
        every = said.plural or said.quantifier is Quantifier.ALL or is_noun(agents[0], "everybody")
        return (every or len(agents) > 1) and not said.either

    def _acting_as(self, noun: str, clause: Clause, state: Bits) -> tuple[str, ...]:
        """Return who acts, without those that are excepted: "everyone in the hall except Ann"."""
        names = self.nouns.things(noun, state)
        if not names and is_noun(noun, "everybody"):
            names = tuple(filter(self.nouns.acts, self.world.profiles.objects))
        for relation, source, target in clause.relations:
            others = self.nouns.things(target, state)
            if is_relation(relation, "excepting") and source not in clause.direct:
                names = tuple(n for n in names if n not in others)
            elif is_relation(relation, "place") and source == noun:
                names = self.nouns.related_now(names, relation, others, Moments(state, state)) or names
        return names

    def _of_oneself(self, clause: Clause) -> Clause:
        """Return a clause with nothing left out, if its verb moves who acts: "take the car and sail to the isle"."""
        rows = (row for table in self.tables for row in table.of(clause.verb) if "" in clause.antecedents)
        if clause.direct or not any(row.direct is None and row.noun is None and row.places for row in rows):
            return clause
        return replace(clause, antecedents={n: meant for n, meant in clause.antecedents.items() if n})

    def _is_state(self, clause: Clause) -> bool:
        """Return whether a clause says what is to be so, and no row says what that means."""
        bare = clause.verb == BE and not clause.relations and not clause.result
        some = clause.verb == BE and any(is_noun(noun, "some") for noun in clause.objects)
        return (bare or some) or ((clause.verb == BE or bool(clause.result)) and not self._rows_with(clause))

    def goes_elsewhere(self, clause: Clause, state: Bits, memory: Memory) -> bool:
        """Return whether a clause says a place, which is here, where nothing is by now that it acts on."""
        said = (r for r in clause.relations if r.source in clause.direct)
        places = [r for r in said if is_relation(r.relation, "place") or is_relation(r.relation, "locating")]
        return not self.is_there(clause, state, memory) and any(self.knows_of(r.target) for r in places)

    def is_there(self, clause: Clause, state: Bits, memory: Memory) -> bool:
        """Return whether something that a clause acts on is now where the clause says: "leave the cup on the table"."""
        reading = ClauseReading(clause, Moments(state, memory.first), memory)
        places = (r for r in clause.relations if r.source in clause.direct and is_relation(r.relation, "place"))
        return any(self.referents.tells_which(r.source, r.relation, r.target, reading) for r in places)

    def _is_to_settle(self, clause: Clause) -> bool:
        """Return whether a clause without a verb says where a thing shall be."""
        placed = (r for r in clause.relations if r.source in clause.direct)
        somewhere = any(not is_relation(r.relation, "composing") for r in placed)
        return clause.implied and is_verb(clause.verb, "having") and somewhere

    @staticmethod
    def _undone(clause: Clause) -> Clause | None:
        """Return "shut whatever doors are open" as to shut the open doors: the state is what the verb takes away."""
        taken = f"-{clause.result}" in chain.from_iterable(map(results, (clause.verb, *family(clause.verb))))
        if not (clause.result and taken and clause.direct):
            return None
        said = clause.phrase(clause.direct[0])
        told = replace(said, quantifier=Quantifier.ALL, attributes=(*said.attributes, clause.result))
        return replace(clause, result=None, phrases={**clause.phrases, told.name: told})

    def _modified(self, clause: Clause) -> Clause | None:
        """Return "take an infrared image" as to take an image with what is called so, where that is no thing."""
        modifier, _, noun = "".join(clause.direct[:1]).rpartition("_")
        if len(clause.direct) != 1 or not modifier or self._names_thing(clause.direct[0]):
            return None
        things, places = (self.nouns.things(word, self.world.task.init) for word in (modifier, noun))
        if len(things) == len(places) == 1 and not clause.relations:  # "tilt the roof panel flat"
            plain = clause.renamed(clause.direct[0], modifier)
            return replace(plain, objects=(modifier, noun), relations=(Relation(SETTING, modifier, noun),))
        rows = (row for table in self.tables for verb in self._own_verbs(clause) for row in table.of(verb))
        if not (self.knows_of(modifier) and any(row.noun == noun for row in rows)):
            return None
        plain = clause.renamed(clause.direct[0], noun)
        added = Relation(the_word("relations", "accompanying"), noun, modifier)
        return replace(plain, objects=(*plain.objects, modifier), relations=(*plain.relations, added))

    @staticmethod
    def _given(clause: Clause) -> tuple[Relation, ...]:
        """Return what is said of what a clause acts on, but for "of" in "every piece of clothing needs a price"."""
        said = (r for r in clause.relations if r.source in clause.direct)
        return tuple(r for r in said if not (clause.verb == BE and is_relation(r.relation, "partitive")))

    def _treated(self, clause: Clause) -> Clause | None:
        """Return "give the fern some water", "put a label on it" as to water or label it, where that is a verb here."""
        given = self._given(clause)
        if len(clause.direct) != 1 or len({relation.relation for relation in given}) != 1:
            return None
        noun, receivers = clause.direct[0], tuple(relation.target for relation in given)
        if clause.verb == BE and is_relation(given[0].relation, "accompanying"):  # "the van needs an oil change"
            return self._needed(clause, given[0].target)
        deed = self._deed(noun, clause)
        mark = self._laid_mark(noun, clause)
        if not (deed or mark) or not self._gives(clause, given[0], deed) or self._names_thing(deed or noun):
            return None
        treated = replace(clause, verb=deed or BE, direct=receivers, objects=receivers, relations=())
        return treated if deed else replace(treated, result=mark)

    def _takes_away(self, verb: str) -> bool:
        """Return whether a verb only ends states: to dust leaves nothing dusty."""
        rows = [row for table in self.tables for row in table.of(verb)]
        return bool(rows) and all(isinstance(row.condition, Not) for row in rows)

    def _deed(self, noun: str, clause: Clause) -> str:
        """Return the verb that a noun stands for: *wash* of "a wash" and "a bath"; empty for other nouns."""
        meant = clause.antecedents.get(noun, ())[:1] if is_one(noun) else (noun, _of_gerund(noun))
        giving = is_verb(clause.verb, "giving") and not self._names_thing(noun)
        meant += (self._compound_deed(noun), *(family(noun) if giving else ()))
        return next(filter(self.knows_verb, meant), "")

    def _needed(self, clause: Clause, noun: str) -> Clause | None:
        """Return "both cars get a wash", "the van needs an oil change" as what is to be done to them."""
        served = self._served(clause, noun)
        if served is not None:
            return served
        head = noun if self.knows_verb(noun) else noun.rpartition("_")[2]  # "a thorough wash"
        named = (head, *family(head)) if self._is_single(clause.phrase(noun)) else ()
        deed = self._compound_deed(noun) or next(filter(self.knows_verb, named), "")
        return replace(clause, verb=deed, objects=clause.direct, relations=()) if deed else None

    def _served(self, clause: Clause, noun: str) -> Clause | None:
        """Return "the children get their lunch" as the action that has the noun in its name: ``serve_lunch``."""
        if not self.nouns.is_only_told_of(noun):
            return None
        rows = (row for table in self.tables for row in table.rows if row.noun == noun and row.direct is None)
        row = next((row for row in rows if len(row.places) == 1 and TO in row.places[0].prepositions), None)
        if row is None:
            return None
        given = tuple(Relation(TO, noun, receiver) for receiver in clause.direct)
        objects = (noun, *clause.direct)
        return replace(clause, verb=row.verbs[0], direct=(noun,), objects=objects, relations=given)

    def _gives(self, clause: Clause, relation: Relation, deed: str) -> bool:
        """Return whether a verb only gives something, or puts it there, and is none of this domain's own."""
        if is_relation(relation.relation, "origin") and clause.phrase(relation.source or "").definite:
            return self._takes_away(deed)  # "wipe the dust off it"; but watering takes no water off
        if is_verb(clause.verb, "giving"):
            return relation.relation == TO
        phrasal = clause.verb.rpartition("_")[2] in words_of("names", "particles")  # "switch the light off"
        return not (phrasal or self.knows_verb(clause.verb)) or clause.verb in section("placing")

    @staticmethod
    def _is_single(phrase: NounPhrase) -> bool:
        return phrase.quantifier is Quantifier.PLAIN and not (phrase.definite or phrase.plural or phrase.undetermined)

    def _compound_deed(self, noun: str) -> str:
        """Return the verb of a compound noun: ``change_oil`` of an *oil change*; empty for other nouns."""
        first, _, last = noun.rpartition("_")
        verb = f"{last}_{first}"
        return verb if first and self.knows_verb(verb) else ""

    def _laid_mark(self, noun: str, clause: Clause) -> str | None:
        """Return the state of what is given a mark: "put a price on it", of things that are ``price_tagged``."""
        lays = clause.verb in section("placing") or is_verb(clause.verb, "giving")
        return self._mark_states.get(noun) if lays else None

    def _dative(self, clause: Clause) -> Clause | None:
        """Return "give Ann bed 3" as "give bed 3 to Ann": two names that were read as one."""
        noun = clause.direct[0] if len(clause.direct) == 1 and not clause.relations else ""
        if not is_verb(clause.verb, "giving") or self.knows_of(noun):
            return None
        parts = noun.split("_")
        for at in range(1, len(parts)):
            person, thing = "_".join(parts[:at]), "_".join(parts[at:])
            if self.knows_of(person) and self.knows_of(thing):
                given = replace(clause.phrase(noun), name=thing)
                to = (Relation(TO, thing, person),)
                phrases = {**clause.phrases, thing: given}
                return replace(clause, direct=(thing,), objects=(thing, person), relations=to, phrases=phrases)
        return None

    def knows_verb(self, word: str) -> bool:
        """Return whether a table has the verb."""
        return any(table.of(word) for table in self.tables)

    def names_deed(self, word: str) -> bool:
        """Return whether a word says what is done here: "a soda, already opened"."""
        verb = participle(word)
        return verb is not None and self.knows_verb(verb) and not is_verb(verb, "leaving")  # "on your left"

    def _phrasal(self, clause: Clause) -> Clause | None:
        """Return a clause whose verb and preposition are one verb here: "operate on the cat", "let it out of the cage".

        The preposition of a clause without an object leads to what is acted on; behind an object it stays.
        """
        for relation in clause.relations:
            verb = f"{clause.verb}_{relation.relation.partition('_')[0]}"
            further = family(verb) if relation.source in clause.direct else ()  # "let her off the lead"
            if not any(map(self.knows_verb, (verb, *further))):
                continue
            if relation.source is None and not clause.direct:
                others = tuple(r for r in clause.relations if r != relation)
                return replace(clause, verb=verb, direct=(relation.target,), relations=others)
            if relation.source in clause.direct and not self.knows_verb(clause.verb):
                return replace(clause, verb=verb)
        return None

    def _settled(self, clause: Clause) -> Clause:
        """Return a clause without a verb as one that puts: "mug on the table", and "water for the kettle" in it."""
        inside = the_word("relations", "inside")
        places = tuple(
            r._replace(relation=inside)
            if is_relation(r.relation, "benefit") and self.nouns.substances(r.source or "")
            else r
            for r in clause.relations
        )
        given = any(is_relation(r.relation, "benefit") and self.referents.is_person(r.target) for r in places)
        verb = BRING if given else the_word("verbs", "settling")  # "tea for Ann" is brought to her
        return replace(clause, verb=verb, implied=False, relations=places)

    def _own_verbs(self, clause: Clause) -> list[str]:
        """Return the verb, that for which it stands, and the same without its particle, where that asks for as much."""
        verb = clause.verb
        own = [verb, *self._synonyms(verb)]
        if is_verb(verb, "giving") and any(r.target in PERSONS and r.relation == TO for r in clause.relations):
            own = [BRING, *own]  # "get me a beer from the fridge" asks for more than to take it out
        if clause.setting and is_verb(verb, "setting"):  # "set it to low" is to turn it, where no row is for "set"
            own = [*ranked("verbs", "setting"), *own]
        plain, _, particle = verb.partition("_")
        if is_verb(plain, "moving_in") and is_relation(particle, "resting"):  # "get the disc in"
            settled = f"{PUT}_{particle}"
            own = [verb, settled, *self._synonyms(settled), *own]
        goes = _has_whither(clause)
        if goes and is_verb(verb, "waiting"):  # "wait in the hall"
            own += table("rows")["go"]
        phrasal = verb.count("_") == 1  # to take out is to take; to get rid of is not to get
        if phrasal and (goes or particle not in words_of("particle_ends")):
            own += [plain, *self._synonyms(plain)]
        return list(dict.fromkeys(own))

    def _state(self, reading: ClauseReading) -> ClauseGoal | Refusal:
        """Return what a clause says to be so, or to be there.

        *I want the table laid* is to lay it, where no state is called so.
        """
        clause = reading.clause
        asked = self.states.read(reading)
        if not isinstance(asked, Refusal):
            return self.rows.finished(asked, None, reading)
        if asked.kind is not RefusalKind.NOT_UNDERSTOOD or not is_verb(clause.verb, "finished"):
            return asked
        for verb in self._leading_to(clause.result or "", own=clause.verb == BE):
            said = replace(clause, verb=verb, result=None, implied=False)
            found = self.read(said, reading.state, reading.memory, awaited=reading.awaited, decisions=reading.decisions)
            if not isinstance(found, Refusal):
                return found
        return asked

    def _leading_to(self, result: str, *, own: bool) -> list[str]:
        """Return the verbs that leave things in a state: *lay* for *laid*, *open* and *unlock* for *open*.

        Args:
            result: The state.
            own: Only the verb of which the state is the participle.
        """
        done = self.lexicon.verb(result) if result else None
        named = [done[0]] if done is not None and done[1] in words_of("outcomes", "participle") else []
        further = () if own else (verb for verb in table("results") if result in results(verb))
        return [*named, *filter(self.knows_verb, further)]

    def knows(self, noun: str) -> bool:
        """Return whether the domain has a word for a noun, be there such a thing here or not."""
        declared = {t.name for t in self.domain.types} | {c.name for c in self.domain.constants}
        return bool(declared & {noun, *self.lexicon.nouns.get(noun, ())}) or self.nouns.is_group(noun)

    def knows_of(self, noun: str) -> bool:
        """Return whether a noun means something in the domain or in the environment."""
        return self.knows(noun) or bool(self.nouns.things(noun, self.world.task.init) or self.nouns.substances(noun))

    def is_actor(self, noun: str) -> bool:
        """Return whether a noun names those who act here."""
        named = self.nouns.things(noun, self.world.task.init)
        return bool(named) and all(map(self.nouns.acts, named))

    def _names_thing(self, noun: str) -> bool:
        """Return whether a noun means a thing itself, and not only what facts say of another one."""
        return self.knows_of(noun) and not self.nouns.is_only_told_of(noun)

    def _by_tables(self, own: Sequence[str], reading: ClauseReading) -> ClauseGoal | Refusal:
        """Return the goal by the first source that knows the verb, or else by the first that knows a relative of it."""
        failure: Refusal | None = None
        knows = {id(source): any(map(source.of, own)) for source in self.tables}
        # a weaker source is asked only where the surer ones know nothing
        for source in sorted(self.tables, key=lambda each: not knows[id(each)]):
            found = self._by_table(source, own, reading)
            if isinstance(found, ClauseGoal) or (found and found.kind is not RefusalKind.NOT_UNDERSTOOD):
                return found
            failure = failure or found
        return failure or self._unknown(reading.clause)

    def _by_table(self, table: GoalTable, own: Sequence[str], reading: ClauseReading) -> ClauseGoal | Refusal | None:
        """Return the goal by the rows of one source; ``None`` where it knows neither the verb nor its family."""
        others = [verb for verb in dict.fromkeys(name for one in own for name in family(one)) if verb not in own]
        exact = self._by_action(table, (*own, *others), reading)
        if exact is not None:
            return exact
        placing = self._is_placing(reading.clause)
        looser = () if placing else ((False, others),)  # to put is more than to take
        failure: Refusal | None = None
        for strict, verbs in ((True, own), (True, others), (False, own), *looser):
            for verb in verbs:
                tried = self._by_verb(table, verb, reading.again(strict=strict), own)
                if self._settles(verb, tried, reading.clause):
                    return tried
                if isinstance(tried, Refusal):
                    failure = _more_telling(failure, tried)
            if failure is not None and not _is_unclear(failure) and (not strict or placing):
                return failure
        return failure

    def _by_action(self, table: GoalTable, verbs: Sequence[str], reading: ClauseReading) -> ClauseGoal | Refusal | None:
        """Return the goal by an action that takes just what was named, rather than a relative of it."""
        if not any(row.source == ACTIONS for row in table.rows[:1]):
            return None
        for known in filter(None, map(table.of, verbs)):
            found = self._exact_rows.by_rows(known, reading.again(strict=True))
            if not isinstance(found, Refusal) or found.kind is RefusalKind.IMPOSSIBLE:
                return found
        return None

    def _by_verb(
        self, table: GoalTable, verb: str, reading: ClauseReading, own: Sequence[str]
    ) -> ClauseGoal | Refusal | None:
        # what another verb leaves without a trace says nothing of this one: to put is not to sit
        rows = [row for row in table.of(verb) if verb in own or not row.traceless]
        return self.rows.by_rows(rows, reading) if rows else None

    def _settles(self, verb: str, found: ClauseGoal | Refusal | None, clause: Clause) -> bool:
        """Return whether there is a goal, or what the verb itself asks for can never be: its relatives ask for less."""
        if not isinstance(found, Refusal):
            return found is not None
        alone = not any(r.source in clause.direct for r in clause.relations)
        itself = (clause.verb, *self._synonyms(clause.verb))
        return alone and verb in itself and found.kind is RefusalKind.IMPOSSIBLE

    def _is_placing(self, clause: Clause) -> bool:
        """Return whether a clause says where something shall go: if it cannot go there, nothing less will do."""
        verbs = {clause.verb, *self._synonyms(clause.verb), *family(clause.verb)}
        placed = (r for r in clause.relations if r.source in clause.direct)
        return bool(words_of("verbs", "pouring") & verbs) and any(
            not is_relation(r.relation, "partitive") for r in placed
        )

    def _rows_with(self, clause: Clause) -> bool:
        """Return whether some row says what this verb with this state means."""
        verbs = (clause.verb, *self._synonyms(clause.verb))
        return any(row.result == clause.result for t in self.tables for v in verbs for row in t.of(v))

    def _synonyms(self, verb: str) -> tuple[str, ...]:
        canonical = self.lexicon.canonical_verb(verb)
        return (canonical,) if canonical != verb else ()

    def _unknown(self, clause: Clause) -> Refusal:
        known = {verb for table in self.tables for verb in table.verbs()} - {BE}
        near = ", ".join(map(words, nearest_verbs(clause.verb, known)))
        hint = f"the nearest known verbs are {near}" if near else "say what shall be different afterwards"
        return Refusal(RefusalKind.UNKNOWN_VERB, f"unknown verb '{words(clause.verb)}'", hint)


def _has_whither(clause: Clause) -> bool:
    """Return whether a clause says where what it acts on goes, or who acts: "go back to the hall"."""
    going = tuple(words_of("relations", "going"))
    moved = clause.direct or (None,)
    return any(r.source in moved and relations_said(r.relation, going) for r in clause.relations)


def _brings_about(operator: Operator, part: Cube) -> bool:
    """Return whether an action may make a literal true."""
    effects = (operator.add, operator.delete), *((add, delete) for _, add, delete in operator.conditional)
    return any(part.positive & add or part.negative & delete for add, delete in effects)


def _of_gerund(noun: str) -> str:
    """Return the verb of what is named after it: to ice for *icing*; the noun itself where it has another form."""
    stem, form, _ = builtin().verb(noun) or (noun, "", 0)
    return stem if form == "ing" else noun


def _goes(clause: Clause, relation: Relation) -> bool:
    """Return whether a place is where the things that a clause acts on shall be."""
    placing = clause.verb == BE or is_verb(clause.verb, "leaving") or clause.verb in section("placing")
    moved = clause.verb in section("moving") or is_verb(clause.verb, "transporting")
    goes = placing or relation.relation in section("arrivals") - (frozenset() if moved else section("static"))
    told = relation in clause.stated or (is_relation(relation.relation, "origin") and clause.verb != BE)
    return goes and relation.source in clause.direct and not told


def _is_unclear(refusal: Refusal) -> bool:
    return refusal.kind is RefusalKind.NOT_UNDERSTOOD


def _more_telling(one: Refusal | None, other: Refusal) -> Refusal:
    """Return the second of two reasons where the first says only that a row does not fit."""
    return other if one is None or _is_unclear(one) else one
