"""Prohibitions, and what must stay as it is, throughout a text: *without using the stove*, *leave it open*."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, replace

from tmd.diagnostics import Refusal, RefusalKind
from tmd.goals.clause_goal import ClauseGoal, ClauseReading, text_of
from tmd.goals.grounder import Moments
from tmd.goals.reading.goal_reader import GoalReader
from tmd.goals.reading.noun_phrases import Bound, Memory
from tmd.goals.reading.referents import ANY_TYPE, is_none
from tmd.goals.words import BE, is_condition, is_one, is_pronoun, is_relation, is_verb, words_of
from tmd.language.clause import PERSONS, Clause, Mood, Parsed
from tmd.language.lexicon.lexicon import section
from tmd.language.lexicon.names import split_name
from tmd.pddl.ground_formula import atoms_of
from tmd.pddl.model import Atom, Formula, GroundAtom, Not
from tmd.pddl.task import Bits, Cube


@dataclass(frozen=True)
class TextConstraints:
    """The constraints of a text, or of one prohibition.

    Attributes:
        never: Literals that no instruction may make true.
        kept: Literals that must hold at the end of every step.
        untouched: Objects that must not be handled.
        left: Objects that must stay where they are.
        notes: Prohibitions that nothing can check, for people.
    """

    never: tuple[Formula, ...] = ()
    kept: tuple[Formula, ...] = ()
    untouched: frozenset[str] = frozenset()
    left: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    def __or__(self, other: TextConstraints) -> TextConstraints:
        never = tuple(dict.fromkeys((*self.never, *other.never)))
        left = tuple(dict.fromkeys((*self.left, *other.left)))
        notes = (*self.notes, *other.notes)
        return TextConstraints(never, (*self.kept, *other.kept), self.untouched | other.untouched, left, notes)


class ConstraintReader:
    """Reads the constraints of texts in one environment.

    Args:
        reader: Reads clauses as goals.
    """

    def __init__(self, reader: GoalReader) -> None:
        self.reader = reader
        self.task = reader.world.task

    def read(self, parsed: Parsed, state: Bits, memory: Memory) -> TextConstraints | Refusal:
        """Return what prohibitions and *leave it as it is* ask for, from the start of the text on."""
        found = TextConstraints()
        for clause in (clause for clause in parsed.constraints if not is_of_the_end(clause)):
            avoided = self._avoided(clause, state, self._with_named(clause, parsed, state, memory))
            if isinstance(avoided, Refusal):
                return avoided
            found |= avoided
        for clause in parsed.clauses:
            excepted = self._excepted(clause, parsed, state, memory)
            parts = tuple(self._parts_as_they_are(clause, excepted, state))
            untouched = frozenset(self._done_without(clause, state) | (set() if parts else excepted))
            found |= TextConstraints(kept=parts or tuple(self._places(excepted, state)), untouched=untouched)
            left = TextConstraints() if _was_put(clause, parsed) else self._left(clause, state, memory)
            if isinstance(left, Refusal):
                return left
            found |= left
        return replace(found, left=(*found.left, *sorted(found.untouched)))

    def _left(self, clause: Clause, state: Bits, memory: Memory) -> TextConstraints | Refusal:
        """Return what *leave it as it is* asks for; what is left alone is not handled either."""
        other = any(clause.phrase(noun).other for noun in clause.direct)
        bound = any(not is_condition(c.word, "loose") for c in clause.conditions)  # but "so they can share it"
        leaves = is_verb(clause.verb, "leaving") and not clause.result
        stays = clause.mood is Mood.KEEP or (leaves and self.reader.is_there(clause, state, memory))
        if not stays or clause.otherwise or bound or other:
            return TextConstraints()
        preserved = self.preserved(clause, state, memory)
        if isinstance(preserved, Refusal):
            return preserved
        alone = clause.result in words_of("outcomes", "alone")
        left = self._kept_things(clause, state) if alone or not clause.result else ()
        untouched = frozenset(self._with_parts(left)) if alone else frozenset()
        return TextConstraints(kept=tuple(preserved), left=left, untouched=untouched)

    def _meant(self, noun: str, clause: Clause, state: Bits) -> tuple[str, ...]:
        """Return the things that a noun of a clause may mean, by where they are: "the sock on the sofa"."""
        names = self.reader.nouns.things(noun, state)
        moments = Moments(state, state)
        for relation in (r for r in clause.relations if r.source == noun):
            targets = self.reader.nouns.things(relation.target, state)
            there = self.reader.nouns.related_now(names, relation.relation, targets, moments)
            names = there or names
        return names

    def _with_named(self, clause: Clause, parsed: Parsed, state: Bits, memory: Memory) -> Memory:
        """Return the memory of what the text names, for a prohibition of another one: "…, not the other lamp"."""
        if not any(clause.phrase(noun).other for noun in clause.objects):
            return memory
        named = {n: self._meant(n, said, state) for said in parsed.clauses for n in said.objects}
        single = {n: Bound(names) for n, names in named.items() if len(names) == 1 and n not in clause.direct}
        return replace(memory, bound={**memory.bound, **single})

    def _avoided(self, clause: Clause, state: Bits, memory: Memory) -> TextConstraints | Refusal:
        """Return what a prohibition asks for; a note where it is about persons only: "don't leave me in the dark"."""
        if clause.direct and PERSONS.issuperset(clause.direct):
            return TextConstraints(notes=(f"'{text_of(clause)}' is not checked: it is about persons",))
        unwanted = self._unwanted(clause, state)
        if unwanted:
            return TextConstraints(never=unwanted)
        if is_verb(clause.verb, "handling") and not self.leaves_a_trace(clause.verb):
            names = self._kept_things(clause, state)
            if not names:
                return self.reader.referents.not_there(clause)
            return TextConstraints(untouched=frozenset(self._with_parts(names)))
        said = replace(clause, verb=BE if clause.result else clause.verb, mood=Mood.DO)
        goal = self.reader.read(said, state, memory)
        if isinstance(goal, Refusal):
            if goal.kind is RefusalKind.UNKNOWN_VERB:  # no instruction is known to do it
                return TextConstraints(notes=(f"'{text_of(clause)}' is not checked: {goal.message}",))
            never = goal.kind in (RefusalKind.IMPOSSIBLE, RefusalKind.CONTRADICTION)
            return TextConstraints() if never else goal
        means = self._means(clause, goal, state)
        if means:
            return TextConstraints(untouched=frozenset(means))
        if clause.implied or clause.result:
            return TextConstraints(kept=tuple(self._not_left_so(goal, state)))
        return TextConstraints(never=tuple(self._not_made_so(goal, state)))

    def _unwanted(self, clause: Clause, state: Bits) -> tuple[Formula, ...]:
        """Return that nothing gets a substance that is not wanted: "no sugar, please"."""
        if not (clause.implied and is_verb(clause.verb, "having")):
            return ()
        nouns, index = self.reader.nouns, self.task.index
        about = (atom for noun in clause.direct for c in nouns.substances(noun) for atom in nouns.facts_about(c))
        return tuple(_literal(atom) for atom in about if atom in index and not state >> index[atom] & 1)

    def _not_left_so(self, goal: ClauseGoal, state: Bits) -> Iterator[Formula]:
        """Yield the contrary of each literal of a goal, to hold in the end."""
        some = any(cube.positive or cube.negative & state for cube in goal.cubes)
        for atom, bit, stands in self._signed(goal):
            # "noodles in the bowl, not in the pot": the pot need not have the milk that spoils them
            if stands or state & bit or not some:
                yield _literal(atom, holds=not stands)

    def _not_made_so(self, goal: ClauseGoal, state: Bits) -> Iterator[Formula]:
        """Yield the literals of a goal that no instruction may make true."""
        single = len(goal.cubes) == 1 or all(c.positive.bit_count() == 1 for c in goal.cubes)
        signed = list(self._signed(goal))
        made = [atom for atom, bit, stands in signed if stands and not state & bit and single]
        # "put the film in, but don't play it": how things are is forbidden rather than where they are
        things = [sum(not self.reader.nouns.is_constant(name) for name in atom.args) for atom in made]
        yield from (_literal(atom) for atom, count in zip(made, things, strict=True) if count == min(things))
        yield from (_literal(atom, holds=False) for atom, bit, stands in signed if not stands and state & bit)

    def _signed(self, goal: ClauseGoal) -> Iterator[tuple[GroundAtom, int, bool]]:
        """Yield the atoms of a goal, each with its bit, and whether some case has it positive."""
        for atom in sorted(atoms_of(goal.formula)):
            bit = 1 << self.task.index[atom]
            yield atom, bit, any(cube.positive & bit for cube in goal.cubes)

    def _means(self, clause: Clause, goal: ClauseGoal, state: Bits) -> set[str]:
        """Return what a thing must not be done with, or in: "heat the milk, but not in the microwave".

        Nothing where the outcome is about that: "do not put the cup in the sink" is no matter of the sink's being used.
        """
        targets = {r.target for r in clause.relations if not is_relation(r.relation, "excepting")}
        things = (n for target in targets for n in self.reader.nouns.things(target, state))
        found = self._with_parts(n for n in things if not self.reader.nouns.is_constant(n))
        outcome = {name for atom in atoms_of(goal.formula) for name in atom.args}
        return set() if found & outcome else found

    def _done_without(self, clause: Clause, state: Bits) -> set[str]:
        """Return what a clause shall be done without: "heat the milk without the stove", and no contents."""
        nouns = self.reader.nouns
        none = {noun for noun in clause.objects if is_none(noun, clause)}
        none = none if set(clause.direct) - none else set()  # "heat the milk, no stove please", but not "touch no cup"
        without = none | {r.target for r in clause.relations if is_relation(r.relation, "lacking")}
        things = (t for t in without if not nouns.constants(t, ANY_TYPE, state))
        return self._with_parts(n for target in things for n in nouns.things(target, state))

    def _excepted(self, clause: Clause, parsed: Parsed, state: Bits, memory: Memory) -> set[str]:
        """Return what a clause excepts, with its parts, unless another clause speaks of it."""
        referents = self.reader.referents
        pairs = [pair for noun in clause.direct for pair in referents.relations_of(noun, clause)]
        names = self._with_parts(referents.excepted(pairs, ClauseReading(clause, Moments(state, state), memory)))
        others = (noun for other in parsed.clauses if other is not clause for noun in other.resolved())
        spoken = self._with_parts(name for noun in others for name in self.reader.nouns.things(noun, state))
        return {name for name in names - spoken if not self.reader.nouns.is_constant(name)}

    def _parts_as_they_are(self, clause: Clause, names: Collection[str], state: Bits) -> Iterator[Formula]:
        """Yield how parts are that only facts speak of: the light of the hall, through which one may go."""
        told = {noun for noun in clause.direct if self.reader.nouns.is_only_told_of(noun)}
        for atom in (fact for name in sorted(names) for fact in self.reader.nouns.facts_about(name)):
            bit = self.task.index.get(atom)
            if bit is not None and any(self.reader.nouns.speaks_of(atom.predicate, noun) for noun in told):
                yield _literal(atom, holds=bool(state >> bit & 1))

    def _with_parts(self, names: Iterable[str]) -> set[str]:
        """Return things, their parts, and the parts of others that work them: a tap, and its handle."""
        profiles = self.reader.world.profiles
        own = {other for name in names for other in (name, *self.reader.grounder.relatives(name, 0))}
        return own | {tail for tail, head in self.reader.grounder.links if head in own and tail in profiles.wholes}

    def leaves_a_trace(self, verb: str) -> bool:
        """Return whether the domain says what a verb leaves behind; nobody sees afterwards that something was used."""
        return any(not row.traceless for table in self.reader.tables[:1] for row in table.of(verb))

    def _kept_things(self, clause: Clause, state: Bits) -> tuple[str, ...]:
        return tuple(dict.fromkeys(n for noun in clause.direct for n in self._kept(noun, clause, state)))

    def _kept(self, noun: str, clause: Clause, state: Bits) -> tuple[str, ...]:
        """Return the things that a noun, or a pronoun with what was said of it, names."""
        nouns, moments = self.reader.nouns, Moments(state, state)
        meant = clause.antecedents.get(noun, ())[: clause.together.get(noun, 1)] if is_pronoun(noun) else (noun,)
        names = tuple(dict.fromkeys(n for one in meant for n in nouns.things(one, state)))
        for relation, target in ((r.relation, r.target) for r in clause.relations if r.source == noun):
            if is_relation(relation, "excepting"):
                left = set(self.reader.referents.every_kind_of(target, clause, state))
                names = tuple(n for n in names if n not in left)
            elif not is_relation(relation, "locating"):
                targets = (*nouns.things(target, state), *nouns.substances(target))
                names = nouns.related_now(names, relation, targets, moments) or names
        found = nouns.narrowed(names, clause.phrase(noun), moments)[0]
        return found or (self._another_one(noun, meant, clause, state) if is_one(noun) else ())

    def _another_one(self, noun: str, meant: Iterable[str], clause: Clause, state: Bits) -> tuple[str, ...]:
        """Return the things of a wider kind that *one* is: "the empty beer bottles, and not the full one"."""
        nouns = self.reader.nouns
        alike = dict.fromkeys(n for one in meant for n in nouns.things(split_name(one)[-1], state))
        return nouns.narrowed(tuple(alike), clause.phrase(noun), Moments(state, state))[0]

    def preserved(self, clause: Clause, state: Bits, memory: Memory) -> list[Formula] | Refusal:
        """Return what *leave the door open* or *leave the cup where it is* keeps."""
        if clause.result and clause.result not in words_of("outcomes", "alone"):
            return self._kept_state(clause, state, memory)
        names = self._kept_things(clause, state)
        excepted = any(is_relation(r.relation, "excepting") for r in clause.relations)
        if not names and not excepted and not all(map(is_pronoun, clause.direct)):
            return self.reader.referents.not_there(clause)
        found: list[Formula] = []
        for atom in self.task.names(state):
            things = [a for a in atom.args if not self.reader.nouns.is_constant(a)]
            # to keep a bowl is not to keep what is in it
            lasting = len(things) > 1 or (len(atom.args) > 1 and not is_verb(clause.verb, "keeping"))
            if atom.args and atom.args[0] in names and lasting:
                found.append(_literal(atom))
        return found

    def _places(self, names: Collection[str], state: Bits) -> Iterator[Formula]:
        """Yield where things are: an instruction that does not name them may still carry them along."""
        for atom in self.task.names(state):
            things = [a for a in atom.args if not self.reader.nouns.is_constant(a)]
            if len(things) > 1 and atom.args[0] in names:
                yield _literal(atom)

    def _kept_state(self, clause: Clause, state: Bits, memory: Memory) -> list[Formula] | Refusal:
        goal = self.reader.read(replace(clause, verb=BE, mood=Mood.DO), state, memory)
        if isinstance(goal, Refusal):
            # "leave the lid open", "leave it open": of what will have been spoken of
            later = bool(clause.direct) and all(n in words_of("parts") or is_pronoun(n) for n in clause.direct)
            return [] if later else goal
        held = [cube for cube in goal.cubes if cube.holds(state)]
        return [literal for cube in held[:1] for literal in self._literals(cube)]

    def _literals(self, cube: Cube) -> list[Formula]:
        positive = [_literal(atom) for atom in self.task.names(cube.positive)]
        return positive + [_literal(atom, holds=False) for atom in self.task.names(cube.negative)]


def _was_put(clause: Clause, parsed: Parsed) -> bool:
    """Return whether a pronoun means what an earlier clause handles: "put it on the shelf and leave it there".

    It is left where it is then, not where it was.
    """
    before = (other for other in parsed.clauses if other.span < clause.span and other.mood is Mood.DO)
    handled = {other.antecedents.get(noun, (noun,))[0] for other in before for noun in other.direct}
    meant = [clause.antecedents.get(noun, ("",))[0] for noun in clause.direct]
    behind = clause.text.lower().rpartition(f" {''.join(clause.direct[-1:])}")[2].split()
    plain = (
        not (clause.result or clause.relations)
        and all(map(is_pronoun, clause.direct))
        and section("there_words").issuperset(behind)
    )
    return plain and bool(meant) and handled.issuperset(meant)


def is_of_the_end(clause: Clause) -> bool:
    """Return whether a prohibition is about how things are left that are known only then: *and don't leave it open*."""
    left = is_verb(clause.verb, "leaving") and clause.result and clause.direct
    return bool(left) and all(map(is_pronoun, clause.direct))


def _literal(atom: GroundAtom, *, holds: bool = True) -> Formula:
    return Atom(atom.predicate, atom.args) if holds else Not(Atom(atom.predicate, atom.args))
