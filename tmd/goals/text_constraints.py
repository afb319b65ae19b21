"""What must not be done throughout a text, and what must stay as it is: *without using the stove*, *leave it open*."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from tmd.diagnostics import Refusal, RefusalKind
from tmd.goals.clause_goal import ClauseGoal
from tmd.goals.grounder import Moments
from tmd.goals.reading.goal_reader import GoalReader
from tmd.goals.reading.noun_phrases import Memory, Referent
from tmd.goals.reading.referents import EXCEPTING
from tmd.goals.reading.requirements import LEAVING
from tmd.goals.sources.table import words_of
from tmd.language.clause import Clause, Mood, Parsed, Quantifier
from tmd.language.syntax.antecedents import is_pronoun
from tmd.pddl.ground_formula import atoms_of
from tmd.pddl.model import Atom, Formula, GroundAtom, Not
from tmd.pddl.task import Bits, Cube

USE = "use"
_NEVER = frozenset({USE, "touch"})
"""To do this to a thing is to handle it in whatever way."""


@dataclass(frozen=True)
class TextConstraints:
    """The constraints of a text.

    Attributes:
        never: Literals that no instruction may make true.
        kept: Literals that must hold at the end of every step.
        untouched: Objects that must not be handled.
        left: Objects that must stay where they are, or not be handled.
    """

    never: tuple[Formula, ...] = ()
    kept: tuple[Formula, ...] = ()
    untouched: frozenset[str] = frozenset()
    left: tuple[str, ...] = ()


class ConstraintReader:
    """Reads the constraints of texts in one environment.

    Args:
        reader: Reads clauses as goals.
    """

    def __init__(self, reader: GoalReader) -> None:
        self.reader = reader
        self.task = reader.world.task

    def read(self, parsed: Parsed, state: Bits, memory: Memory) -> TextConstraints | Refusal:
        """What prohibitions and *leave it as it is* ask for, from the start of the text on."""
        never: dict[Formula, None] = {}
        names: set[str] = set()
        left: set[str] = set()
        kept: list[Formula] = []
        for clause in parsed.constraints:
            if is_of_the_end(clause):
                continue
            found = self._avoided(clause, state, memory)
            if isinstance(found, Refusal):
                return found
            never.update(dict.fromkeys(found[0]))
            names |= found[1]
            kept += found[2]
        for clause in parsed.clauses:
            names |= self._done_without(clause, state)
            other = any(clause.phrase(noun).quantifier is Quantifier.OTHER for noun in clause.direct)
            if clause.mood is Mood.KEEP and not (clause.otherwise or clause.conditions or other):
                preserved = self.preserved(clause, state, memory)
                if isinstance(preserved, Refusal):
                    return preserved
                kept += preserved
                if not clause.result:
                    left.update(n for noun in clause.direct for n in self._kept_things(clause, noun, state))
        return TextConstraints(tuple(never), tuple(kept), frozenset(names), tuple(sorted(left | names)))

    def _avoided(
        self, clause: Clause, state: Bits, memory: Memory
    ) -> tuple[list[Formula], set[str], list[Formula]] | Refusal:
        """Return the literals that must not come to hold, the things that must not be handled, and literals to keep."""
        if clause.verb in _NEVER and not self.leaves_a_trace(clause.verb):
            names = {n for noun in clause.direct for n in self._kept_things(clause, noun, state)}
            if not names:
                return self.reader.referents.not_there(clause)
            return [], self._with_parts(names), []
        final = clause.implied or bool(clause.result)
        goal = self.reader.read(
            replace(clause, verb="be" if clause.result else clause.verb, mood=Mood.DO), state, memory
        )
        if isinstance(goal, Refusal):
            return ([], set(), []) if goal.kind in (RefusalKind.IMPOSSIBLE, RefusalKind.CONTRADICTION) else goal
        means = self._means(clause, goal, state)
        if means:
            return [], means, []
        never: list[Formula] = []
        kept: list[Formula] = []
        some = any(cube.positive for cube in goal.cubes)
        for atom in sorted(atoms_of(goal.formula)):
            bit = 1 << self.task.index[atom]
            if final:
                stands = any(cube.positive & bit for cube in goal.cubes)
                if some and not stands and not state & bit:
                    continue  # "noodles in the bowl, not in the pot": the pot need not have the milk that spoils them
                kept.append(_literal(atom, holds=not stands))
                continue
            stands = any(cube.positive & bit for cube in goal.cubes)
            if (
                stands
                and not state & bit
                and all(c.positive.bit_count() == 1 or len(goal.cubes) == 1 for c in goal.cubes)
            ):
                never.append(_literal(atom))
            elif not stands and state & bit:
                never.append(_literal(atom, holds=False))
        return never, set(), kept

    def _means(self, clause: Clause, goal: ClauseGoal, state: Bits) -> set[str]:
        """What a thing must not be done with, or in, though it may be done: "heat the milk, but not in the microwave".

        Nothing where the outcome is about that: "do not put the cup in the sink" is no matter of the sink's being used.
        """
        found: set[str] = set()
        for target in {r.target for r in clause.relations if r.relation not in EXCEPTING}:
            for name in self.reader.nouns.things(target, state):
                if name not in self.reader.world.profiles.constants:
                    found.add(name)
        found = self._with_parts(found)
        outcome = {name for atom in atoms_of(goal.formula) for name in atom.args}
        return set() if found & outcome else found

    def _done_without(self, clause: Clause, state: Bits) -> set[str]:
        """What a clause shall be done without: "heat the milk without the stove", and no contents: "without sugar"."""
        nouns = self.reader.nouns
        found: set[str] = set()
        none = {noun for noun in clause.objects if clause.phrase(noun).quantifier is Quantifier.NONE}
        none = none if set(clause.direct) - none else set()  # "heat the milk, no stove please", but not "touch no cup"
        for target in none | {r.target for r in clause.relations if r.relation == "without"}:
            if not nouns.constants(target, ("object",), state):
                found.update(nouns.things(target, state))
        return self._with_parts(found)

    def _with_parts(self, names: Iterable[str]) -> set[str]:
        """Things, their parts, and the parts of others that work them: a tap, and its handle."""
        profiles = self.reader.world.profiles
        own = {other for name in names for other in (name, *self.reader.grounder.relatives(name, 0))}
        return own | {tail for tail, head in profiles.links if head in own and tail in profiles.wholes}

    def leaves_a_trace(self, verb: str) -> bool:
        """Whether the domain says what a verb leaves behind; nobody sees afterwards that something was used."""
        return any(not row.traceless for table in self.reader.tables[:1] for row in table.of(verb))

    def _kept_things(self, clause: Clause, noun: str, state: Bits) -> tuple[str, ...]:
        """The things that a noun, or a pronoun with what was said of it, names."""
        nouns = self.reader.nouns
        meant = clause.antecedents.get(noun, ())[: clause.together.get(noun, 1)] if is_pronoun(noun) else (noun,)
        names = tuple(dict.fromkeys(n for one in meant for n in nouns.things(one, state)))
        for relation in clause.relations:
            if relation.source == noun and relation.relation in EXCEPTING:
                meant = clause.meant(relation.target)
                left = {n for one in meant for n in self.reader.referents.every_kind(one, state)}
                names = tuple(n for n in names if n not in left)
            elif relation.source == noun and relation.relation != "where":
                targets = nouns.things(relation.target, state)
                referent = Referent(noun, names)
                names = nouns.related_now(referent, relation.relation, targets, state, Moments(state, state)) or names
        said, _ = nouns.narrowed(Referent(noun, names), clause.phrase(noun), state, Moments(state, state))
        return said.names

    def preserved(self, clause: Clause, state: Bits, memory: Memory) -> list[Formula] | Refusal:
        """*Leave the door open* keeps that; *leave the cup where it is* keeps where it is."""
        if clause.result and clause.result not in ("alone",):
            goal = self.reader.read(replace(clause, verb="be", mood=Mood.DO), state, memory)
            if isinstance(goal, Refusal):
                # "leave the lid open", "leave it open": of what will have been spoken of
                later = bool(clause.direct) and all(n in words_of("parts") or is_pronoun(n) for n in clause.direct)
                return [] if later else goal
            held = [cube for cube in goal.cubes if cube.holds(state)]
            return [literal for cube in held[:1] for literal in self._literals(cube)]
        names = [n for noun in clause.direct for n in self._kept_things(clause, noun, state)]
        if not names and any(r.relation in EXCEPTING for r in clause.relations):
            return []  # "the rest stays there", of what else was spoken of with "every empty thing"
        if not names:
            return (
                self.reader.referents.not_there(clause) if not all(is_pronoun(noun) for noun in clause.direct) else []
            )
        constants = self.reader.world.profiles.constants
        found: list[Formula] = []
        for atom in self.task.names(state):
            things = [a for a in atom.args if a not in constants]
            everything = clause.verb != "keep" and len(atom.args) > 1  # to keep a bowl is not to keep what is in it
            if atom.args and atom.args[0] in names and (len(things) > 1 or everything):
                found.append(_literal(atom))
        return found

    def _literals(self, cube: Cube) -> list[Formula]:
        """Return the literals of a cube."""
        positive = [_literal(atom) for atom in self.task.names(cube.positive)]
        return positive + [_literal(atom, holds=False) for atom in self.task.names(cube.negative)]


def is_of_the_end(clause: Clause) -> bool:
    """Whether a prohibition is about how things are left that are known only then: *and don't leave it open*."""
    left = clause.verb in LEAVING and clause.result and clause.direct
    return bool(left) and all(map(is_pronoun, clause.direct))


def _literal(atom: GroundAtom, *, holds: bool = True) -> Formula:
    return Atom(atom.predicate, atom.args) if holds else Not(Atom(atom.predicate, atom.args))
