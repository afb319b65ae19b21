"""The features of a policy: what the next instruction may be, and what the words of a text can tell of it.

The paper's policy has the words of the clause and the sequence so far. Ours is *grounded*: it also knows which objects
the nouns of this clause, of those before and of those to come may mean, the words of the whole text, whether an
instruction applies in the state that was reached and changes it, and what holds there of the objects that it names.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tmd.pddl.model import OBJECT, Instruction
from tmd.world.verb_clause import VerbClause
from tmd.world.world import World

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

STOP = Instruction("")
"""The end of a clause's sequence: one more choice at each step."""

# How far a clause mentions an object: an earlier clause does; a weaker reading of a noun; a noun; its first noun.
EARLIER, POSSIBLE, MENTIONED, FIRST = 1, 2, 3, 4
LEVELS = 5
# How recently an object was named: never, earlier, by the instruction before.
NAMED, JUST_NAMED = 1, 2
RECENCIES = 3
# Positions in a sequence that are distinguished; later ones are alike.
_POSITIONS = 6
# How much of the objects that a clause mentions was named: it mentions none; none was; some; all.
MET = 4
# Features that are numbers: the share of instructions that are not repeated, and (of STOP) the length so far.
REALS = 2
# Places of a clause in its text that are distinguished: the first, the last, between.
WHERE = 3
# Numbers of instructions of the clause so far that are distinguished with each action, and with STOP; more are alike.
BEGUN = 4
LENGTHS = 13
# How often an instruction was done (never, once, more often), in this clause or before it.
REPEATS = 6
# Effect of an instruction now: it does not apply (0); it changes nothing; it changes something; it never applies.
APPLIES, CHANGES, UNKNOWN = 1, 2, 3
EFFECTS = 4
# How much more the squared weights of words count in a grounded policy than those of its other features, because there
# are a hundred times as many of them. Chosen by the likelihood of folds of VEIL-500's training environments.
_TABLE_RIDGE, _TEXT_RIDGE = 3.0, 12.0
# Share of occurrences from which on an earlier action counts as needed.
_CERTAIN = 0.95
# Share of the training sequences that are not longer than those that are searched.
_COVER = 0.99
_NO_STATE = 0
_DIGITS = re.compile(r"_?\d+")
_WORD = re.compile(r"[a-z0-9']+")


class KnownObjects:
    """The objects of one environment that instructions may name, and their kinds.

    A type that some action asks for (``item``, ``part``) says what a thing can be used for, not what it is; the other
    types do, nearest first. The thing's name without its numbers is its last kind.
    """

    def __init__(self, world: World) -> None:
        domain = world.task.problem.domain
        self.parameters = {a.name: tuple(p.types for p in a.parameters) for a in domain.actions}
        self.world = world
        roles = {t for types in self.parameters.values() for wanted in types for t in wanted} | {OBJECT}
        self.kinds: dict[str, tuple[str, ...]] = {}
        for name, types in world.mentions.types.items():
            own = [kind for kind in types if kind not in roles and name not in world.profiles.constants]
            self.kinds[name] = tuple(dict.fromkeys([*own, _DIGITS.sub("", name)]))
        self.numbers = {name: number for number, name in enumerate(self.kinds)}
        self.of_kind: dict[str, list[str]] = {}
        for name, kinds in self.kinds.items():
            for kind in kinds:
                self.of_kind.setdefault(kind, []).append(name)

    def well_formed(self, instruction: Instruction) -> bool:
        """Return whether an action has such parameters, and nothing is named twice."""
        types = self.parameters.get(instruction.name)
        if types is None or len(types) != len(instruction.args) or len(set(instruction.args)) < len(types):
            return False
        return all(self.world.objects.is_a(a, t) for a, t in zip(instruction.args, types, strict=True))

    def is_constant(self, name: str) -> bool:
        """Return whether ``name`` is a constant of the domain (``on``, ``high``) rather than an object."""
        return name in self.world.profiles.constants


@dataclass(frozen=True, slots=True)
class Syntax:
    """Constraints on sequences that training sequences keep.

    Attributes:
        shapes: Every action with the kinds of arguments it was seen with, sorted.
        needs: For each action and argument place, the actions that (almost) always named the argument earlier.
        longest: Maximum length of a sequence for one clause.
    """

    shapes: tuple[tuple[str, tuple[str, ...]], ...]
    needs: Mapping[tuple[str, int], tuple[str, ...]]
    longest: int

    def menu(self, things: KnownObjects) -> list[Instruction]:
        """Return the instructions of an environment that have a seen shape, sorted."""
        choices = ((name, [things.of_kind.get(kind, ()) for kind in kinds]) for name, kinds in self.shapes)
        return _instructions(choices, things)

    def about(self, things: KnownObjects, mentioned: Collection[str]) -> list[Instruction]:
        """Return the well-formed instructions about ``mentioned`` objects alone, seen or not, sorted.

        Places for constants of the domain (relations, settings) take those seen there.
        """
        words: dict[tuple[str, int], dict[str, None]] = {}
        for name, kinds in self.shapes:
            for place, kind in enumerate(kinds):
                if kind in things.kinds and things.is_constant(kind):
                    words.setdefault((name, place), {})[kind] = None
        names = {name for name, _ in self.shapes} & things.parameters.keys()
        choices = (
            (name, [words.get((name, place), mentioned) for place in range(len(things.parameters[name]))])
            for name in names
        )
        return _instructions(choices, things)


def _instructions(choices: Iterable[tuple[str, Sequence[Iterable[str]]]], things: KnownObjects) -> list[Instruction]:
    """Return the well-formed instructions with actions and the objects for each of their places, sorted."""
    found = {Instruction(name, args) for name, places in choices for args in product(*places)}
    return sorted(i for i in found if things.well_formed(i))


def learn_syntax(sequences: Iterable[tuple[KnownObjects, Sequence[Sequence[Instruction]]]]) -> Syntax:
    """Learn the constraints from demonstrations, each with the well-formed instructions of its clauses."""
    shapes: set[tuple[str, tuple[str, ...]]] = set()
    seen: Counter[tuple[str, int]] = Counter()
    before: Counter[tuple[str, int, str]] = Counter()
    lengths = []
    for things, clauses in sequences:
        named: dict[str, set[str]] = {}
        for clause in clauses:
            lengths.append(len(clause))
            for instruction in clause:
                kinds = [{things.kinds[arg][0], things.kinds[arg][-1]} for arg in instruction.args]
                shapes.update((instruction.name, args) for args in product(*kinds))
                for place, arg in enumerate(instruction.args):
                    if not things.is_constant(arg):
                        seen[instruction.name, place] += 1
                        before.update((instruction.name, place, name) for name in named.get(arg, ()))
                for arg in instruction.args:
                    named.setdefault(arg, set()).add(instruction.name)
    needs: dict[tuple[str, int], tuple[str, ...]] = {}
    for name, place, earlier in sorted(before):
        if before[name, place, earlier] >= _CERTAIN * seen[name, place]:
            needs[name, place] = (*needs.get((name, place), ()), earlier)
    lengths.sort()
    longest = lengths[min(int(_COVER * len(lengths)), len(lengths) - 1)] if lengths else 0
    return Syntax(tuple(sorted(shapes)), needs, longest)


def properties(choice: Instruction, things: KnownObjects) -> list[tuple[str, ...]]:
    """Return the properties that words can go with: the action, its arguments' kinds and names, all kinds together."""
    found: list[tuple[str, ...]] = [(choice.name,)]
    for place, arg in enumerate(choice.args):
        found += [(choice.name, str(place), kind) for kind in (*things.kinds[arg], arg)]
        if not things.is_constant(arg):
            found += [("", kind) for kind in things.kinds[arg]]
    if len(choice.args) > 1:
        found.append((choice.name, *(things.kinds[arg][0] for arg in choice.args)))
    return list(dict.fromkeys(found))


def followers(before: Instruction | None, position: int, things: KnownObjects) -> list[str]:
    """Return the words for the sequence so far: the instruction before (with its kinds), and the position."""
    found = [f"at {min(position, _POSITIONS)}"]
    if before is not None:
        found.append(f"after {before.name}")
        found += [f"after {before.name} {place} {things.kinds[arg][-1]}" for place, arg in enumerate(before.args)]
    return found


class WeightBlocks(NamedTuple):
    """The weights, part by part.

    Attributes:
        local: Words × properties, for the words of the clause and those of the sequence so far.
        text: The same for the words of the whole text; ``None`` where the policy is not grounded.
        paired: Features that a choice has or not.
        facts: Places × facts.
        reals: The features that are numbers.
    """

    local: Floats
    text: Floats | None
    paired: Floats
    facts: Floats
    reals: Floats


class Features:
    """The numbering of all features, in sorted order of their names.

    ``words`` are those of the training clauses, with those of :func:`followers`; ``seen`` the :func:`properties` of the
    training instructions; ``facts`` those of a thing: a predicate and the thing's place. Without any the policy knows
    no states, no words but the clause's and no later clauses, as the paper's baseline.

    Attributes:
        actions: The numbers of the actions, STOP among them.
        arity: Maximum number of arguments.
        starts: The first number of each block of the paired features.
        shape: Words × properties: the matrix that comes first. A grounded policy has a second one for the whole text.
        size: Number of features: the matrices, the paired ones, places × facts, and :data:`REALS`.
    """

    def __init__(
        self,
        words: Iterable[str],
        seen: Iterable[tuple[str, ...]],
        syntax: Syntax,
        facts: Iterable[tuple[str, int]] = (),
    ) -> None:
        self.syntax = syntax
        self.facts = {fact: number for number, fact in enumerate(sorted(set(facts)))}
        self.words = {word: number for number, word in enumerate(sorted(set(words)))}
        self.properties = {name: number for number, name in enumerate(sorted({*seen, (STOP.name,)}))}
        self.actions = {n: i for i, n in enumerate(sorted({STOP.name, *(name for name, _ in syntax.shapes)}))}
        places = {(name, place) for name, kinds in syntax.shapes for place in range(len(kinds))}
        self.places = {key: number for number, key in enumerate(sorted(places))}
        self.arity = max((len(kinds) for _, kinds in syntax.shapes), default=0)
        # one more place stands for "no such argument", one more action for "none before"
        n, p = len(self.actions), len(self.places) + 1
        blocks = [p * LEVELS, p * RECENCIES, p * (n + 1), (n + 1) * n * 2, n * 2, 1 + MET]
        if self.grounded:
            blocks += [p * LEVELS * RECENCIES, p * 4, (n + 1) * (n + 1) * n, n * REPEATS, n * WHERE * BEGUN]
            blocks += [n * EFFECTS, n * MET, 1 + MET * WHERE * LENGTHS]
        self.starts = np.cumsum((0, *blocks))
        self.shape = (len(self.words), len(self.properties))
        matrix = len(self.words) * len(self.properties)
        parts = (matrix, matrix if self.grounded else 0, int(self.starts[-1]), p * len(self.facts), REALS)
        self._ends = np.cumsum(parts).tolist()
        self.size: int = self._ends[-1]

    @property
    def grounded(self) -> bool:
        """Return whether the policy knows states, and the objects that a clause's nouns may mean."""
        return bool(self.facts)

    def parts(self, theta: Floats) -> WeightBlocks:
        """Return views of the weights, or of an array of their size, part by part."""
        local, text, paired, facts, reals = np.split(theta, self._ends[:-1])
        places = len(self.places) + 1
        whole = text.reshape(self.shape) if self.grounded else None
        return WeightBlocks(local.reshape(self.shape), whole, paired, facts.reshape(places, len(self.facts)), reals)

    def ridge(self) -> Floats:
        """Return the factor of each squared weight, which is 1 in the paper's baseline."""
        found: Floats = np.ones(self.size)
        parts = self.parts(found)
        if parts.text is not None:
            parts.local[:] = _TABLE_RIDGE
            parts.text[:] = _TEXT_RIDGE
        return found

    def known(self, words: Iterable[str]) -> Ints:
        """Return the numbers of the words that training had."""
        return np.array(sorted({self.words[w] for w in words if w in self.words}), np.int64)


@dataclass(frozen=True, slots=True)
class ClauseContext:
    """A clause in the context of its text.

    Attributes:
        words: The numbers of the clause's words.
        text: The numbers of the words of the whole text.
        levels: For each thing how far the clause mentions it (0 not at all), with a last 0 for no thing.
        later: 1 for each thing that a later clause mentions.
        where: 0 for the first clause of the text, 2 for the last one, 1 for those between.
    """

    words: Ints
    text: Ints
    levels: Ints
    later: Ints
    where: int


def context_of(clauses: Sequence[VerbClause], number: int, features: Features, things: KnownObjects) -> ClauseContext:
    """Return the context of one clause of a text."""
    clause = clauses[number]
    later: Ints = np.zeros(len(things.numbers) + 1, np.int64)
    words = features.known(bag(clause, grounded=features.grounded))
    if not features.grounded:
        return ClauseContext(words, words, later, later, 0)
    where = 0 if number == 0 else 2 if number == len(clauses) - 1 else 1
    text = features.known(word for each in clauses for word in bag(each, grounded=True))
    for noun in (noun for each in clauses[number + 1 :] for noun in each.resolved()):
        matches = things.world.mentions.of(noun, _NO_STATE)
        later[[things.numbers[match.name] for match in matches if match.score == matches[0].score]] = 1
    return ClauseContext(words, text, mentioned(clause, clauses[:number], things), later, where)


def bag(clause: VerbClause, *, grounded: bool) -> list[str]:
    """Return a clause's words, its verb, and a word of every clause; ``grounded`` with the nouns of its pronouns."""
    resolved = clause.resolved() if grounded else ()
    return ["", *_WORD.findall(clause.text.lower()), verb_word(clause.verb), *resolved]


def verb_word(verb: str) -> str:
    """Return the word for a clause's verb, which is unlike all words of texts."""
    return f"verb {verb}"


def mentioned(clause: VerbClause, earlier: Sequence[VerbClause], things: KnownObjects) -> Ints:
    """Return how far each thing is mentioned (0 not at all), by its words alone; with a last 0 for no thing."""
    levels: Ints = np.zeros(len(things.numbers) + 1, np.int64)

    def mark(noun: str, likeliest: int, others: int) -> None:
        matches = things.world.mentions.of(noun, _NO_STATE)
        for match in matches:
            level = likeliest if match.score == matches[0].score else others
            place = things.numbers[match.name]
            levels[place] = max(levels[place], level)

    for before in earlier:
        for noun in before.resolved():
            mark(noun, EARLIER, 0)
    for position, noun in enumerate(clause.resolved()):
        mark(noun, MENTIONED if position else FIRST, POSSIBLE)
    return levels
