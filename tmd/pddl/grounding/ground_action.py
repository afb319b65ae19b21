"""Ground conditions in normal form, actions over numbered atoms, and which of them relaxed reachability can reach."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby, product
from typing import NamedTuple, TypeAlias

from tmd.diagnostics import LimitError, TmdError
from tmd.pddl.model import And, Atom, Equals, Exists, Forall, Formula, GroundAtom, Imply, Instruction, Not, Or, Universe
from tmd.pddl.semantics import Binding, bindings, instantiate

Tree: TypeAlias = "int | tuple[str, tuple[Tree, ...]]"
"""A literal, or ``("and", parts)`` or ``("or", parts)``."""

TRUE: Tree = ("and", ())
FALSE: Tree = ("or", ())

Lookup: TypeAlias = Callable[[GroundAtom], Tree]
"""What is known of an atom: :data:`TRUE`, :data:`FALSE`, or the literal that stands for it."""

Literals: TypeAlias = frozenset[int]

_MOST = 3_000
TOO_MANY_CASES = "too-many-cases"
"""The code of the error that a condition is too large to be written out."""


MOST_WORK = 5_000_000
"""Values and conditions that one grounding writes down: some 50 s and 2 GB. The largest bundled problem has 100,000."""


@dataclass(slots=True)
class Work:
    """The work that one instantiation may still do; too large a part is refused before it is done."""

    left: int = MOST_WORK

    def spend(self, amount: int, what: str) -> None:
        """Subtract ``amount``.

        Raises:
            LimitError: There is not so much left; ``what`` says what asks for it.
        """
        self.left -= amount
        if self.left < 0:
            raise LimitError(
                f"grounding {what} is too large: more than {MOST_WORK:,} values and conditions",
                hint="use types or static preconditions to narrow the parameters, or fewer objects",
            )


def expand(formula: Formula, binding: Binding, objects: Universe, lookup: Lookup, positive: bool = True) -> Tree:
    """Write ``formula`` (or its negation) over literals: quantifiers spread out, constants gone."""
    match formula:
        case Atom():
            found = lookup(instantiate(formula, binding))
            if positive:
                return found
            if isinstance(found, int):
                return found ^ 1
            return FALSE if found == TRUE else TRUE
        case Equals(left, right):
            return TRUE if (binding.get(left, left) == binding.get(right, right)) == positive else FALSE
        case Not(part):
            return expand(part, binding, objects, lookup, not positive)
        case Imply(left, right):
            return expand(Or((Not(left), right)), binding, objects, lookup, positive)
        case And(parts) | Or(parts):
            inner = (expand(p, binding, objects, lookup, positive) for p in parts)
        case Forall(parameters, part) | Exists(parameters, part):
            inner = (expand(part, b, objects, lookup, positive) for b in bindings(parameters, objects, binding))
    return _combine("and" if isinstance(formula, And | Forall) == positive else "or", inner)


def _combine(word: str, parts: Iterable[Tree]) -> Tree:
    neutral, absorbing = (TRUE, FALSE) if word == "and" else (FALSE, TRUE)
    kept: list[Tree] = []
    for part in parts:
        if part == absorbing:
            return absorbing
        if part == neutral:
            continue
        if not isinstance(part, int) and part[0] == word:
            kept.extend(part[1])
        else:
            kept.append(part)
    return kept[0] if len(kept) == 1 else (word, tuple(kept))


def normal_form(tree: Tree, outer: str, what: str) -> list[Literals]:
    """Return ``tree`` in normal form.

    With ``outer`` ``"and"`` it consists of clauses, all of which must hold (an empty one is false); with ``"or"`` of
    cubes, one of which must hold (an empty one is true). ``what`` says whose condition it is.

    Raises:
        TmdError: It has too many of them.
    """
    if isinstance(tree, int):
        return [frozenset((tree,))]
    word, parts = tree
    if word == outer:
        return absorb({clause for part in parts for clause in normal_form(part, outer, what)})
    if all(isinstance(p, int) for p in parts):
        literals = frozenset(p for p in parts if isinstance(p, int))
        return [] if any(p ^ 1 in literals for p in literals) else [literals]
    found: list[Literals] = [frozenset()]
    for part in parts:
        choices = normal_form(part, outer, what)
        if len(found) * len(choices) > _MOST:
            raise TmdError(
                f"a condition of {what} has more than {_MOST} cases when written out",
                hint="split it, or name what it asks for by a predicate that actions keep true and false",
                code=TOO_MANY_CASES,
            )
        joined = {a | b for a, b in product(found, choices)}
        found = absorb({c for c in joined if not any(literal ^ 1 in c for literal in c)})
    return found


def absorb(clauses: set[Literals]) -> list[Literals]:
    """Return clauses without those that contain another one, sorted."""
    if len(clauses) < 2:
        return list(clauses)
    kept: list[Literals] = []
    # clauses of one length cannot contain each other
    for length, alike in groupby(sorted(clauses, key=lambda c: (len(c), sorted(c))), key=len):
        kept += [c for c in alike if length == 1 or not any(map(c.issuperset, kept))]
    return kept


Tag: TypeAlias = tuple[int, int]
"""Which rule: the action's number, and the number of its effect or -1 for the action itself."""


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule: when every clause can hold, so can the literals ``heads``, and the rules ``then`` are added."""

    tag: Tag
    clauses: Sequence[Literals]
    heads: Sequence[int]
    then: Sequence[Rule] = ()


class Reachability:
    """A fixpoint that can be extended by more rules while it runs.

    ``starts_false`` returns whether an atom is false in some initial state.
    """

    def __init__(self, literals: Iterable[int], starts_false: Callable[[int], bool]) -> None:
        self.reached: dict[int, None] = {}
        self.fired: set[Tag] = set()
        self._starts_false = starts_false
        self._queue: list[int] = []
        self._watchers: dict[int, list[list[int]]] = {}
        self._rules: list[Rule] = []
        self._missing: list[int] = []
        self._new: list[int] = []
        self._reach(literals)

    def holds(self, literal: int) -> bool:
        """Return whether ``literal`` can hold, as far as is known now."""
        return literal in self.reached or bool(literal & 1 and self._starts_false(literal >> 1))

    def add(self, rule: Rule) -> None:
        """Let ``rule`` take part; call :meth:`run` afterwards."""
        waiting = [c for c in rule.clauses if not any(self.holds(literal) for literal in c)]
        if not waiting:
            self._fire(rule)
            return
        number = len(self._rules)
        self._rules.append(rule)
        self._missing.append(len(waiting))
        for clause in waiting:
            watcher = [number, 0]
            for literal in clause:
                self._watchers.setdefault(literal, []).append(watcher)

    def run(self) -> list[int]:
        """Follow all rules to the end; the literals reached since the last call, in order."""
        while self._queue:
            for watcher in self._watchers.pop(self._queue.pop(), ()):
                number, done = watcher
                if done:
                    continue
                watcher[1] = 1
                self._missing[number] -= 1
                if not self._missing[number]:
                    self._fire(self._rules[number])
        new, self._new = self._new, []
        return new

    def _reach(self, literals: Iterable[int]) -> None:
        for literal in literals:
            if literal not in self.reached:
                self.reached[literal] = None
                self._queue.append(literal)
                self._new.append(literal)

    def _fire(self, rule: Rule) -> None:
        self.fired.add(rule.tag)
        self._reach(rule.heads)
        for inner in rule.then:
            self.add(inner)


class GroundEffect(NamedTuple):
    """One literal, and the cube under which it comes about (empty: always)."""

    condition: Literals
    literal: int


class Conditional(NamedTuple):
    """A cube, and the atoms that are added and deleted where it holds."""

    condition: Literals
    add: frozenset[int]
    delete: frozenset[int]

    def literals(self) -> tuple[int, ...]:
        """Return the literals that come about, sorted."""
        return (*sorted(2 * atom for atom in self.add), *sorted(2 * atom + 1 for atom in self.delete))


@dataclass(frozen=True, slots=True)
class GroundAction:
    """An instantiated action: its clauses must all hold; a ``forced`` one counts even if they cannot."""

    instruction: Instruction
    clauses: tuple[Literals, ...]
    effects: tuple[Conditional, ...]
    cost: int
    forced: bool = False

    def rule(self, number: int) -> Rule:
        """Return the reachability rule of this action, with one within for each condition."""
        inner = tuple(
            Rule((number, place), [frozenset((literal,)) for literal in effect.condition], effect.literals())
            for place, effect in enumerate(self.effects)
        )
        return Rule((number, -1), () if self.forced else self.clauses, (), inner)

    def flat(self) -> Iterator[GroundEffect]:
        """Yield the effects, one literal each."""
        for effect in self.effects:
            yield from (GroundEffect(effect.condition, literal) for literal in effect.literals())


def grouped(effects: Iterable[GroundEffect]) -> tuple[Conditional, ...]:
    """Return ``effects`` by condition, without those that change nothing; adding wins over deleting throughout.

    Deleting an atom where it does not hold changes nothing, and deleting it where it holds is deleting it.
    """
    adds: dict[Literals, set[int]] = {}
    deletes: dict[Literals, set[int]] = {}
    for condition, literal in effects:
        atom = literal >> 1
        if not literal & 1:
            adds.setdefault(condition, set()).add(atom)
        elif literal not in condition:
            where = frozenset[int]() if condition == {2 * atom} else condition
            deletes.setdefault(where, set()).add(atom)
    always = frozenset[int]()
    add = frozenset(adds.get(always, ()))
    delete = frozenset(deletes.get(always, ())) - add
    found = [Conditional(always, add, delete)] if add or delete else []
    for condition in dict.fromkeys((*adds, *deletes)):
        also_add = frozenset(adds.get(condition, ())) - add
        also_delete = frozenset(deletes.get(condition, ())) - add - delete - also_add
        if condition and (also_add or also_delete):
            found.append(Conditional(condition, also_add, also_delete))
    return tuple(found)
