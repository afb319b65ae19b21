"""Goal tables: rows that give a verb with its slots a PDDL condition.

A row is written as in ``lexicon.yaml``::

    place X in|on|next_to Y: (at ?x ?y ?rel)

Its pattern has verbs (``a|b`` for several), slots (capitals), prepositions before all slots but the first, and, last, a
word for the state that something shall be in (``make X louder``). In the condition each slot is a variable of its name
in lower case, ``?rel`` the relation that was said. Beyond PDDL's conditions, ``(was φ)`` tells whether φ holds when the
clause begins, and ``(first φ)`` whether it held before the whole text.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Final, TypeAlias

from tmd.diagnostics import Location, TmdError
from tmd.goals.words import PREPOSITIONS as PREPOSITIONS
from tmd.goals.words import family as family
from tmd.goals.words import is_relation, relations_said
from tmd.language.clause import AGENT
from tmd.language.lexicon.lexicon import Declared
from tmd.pddl.model import (
    OBJECT,
    And,
    Atom,
    Domain,
    Equals,
    Exists,
    Forall,
    Formula,
    Imply,
    Not,
    Or,
    TypedName,
    hierarchy,
    predicates_of,
)  # fmt: skip
from tmd.pddl.reading.formulas import RESERVED, read_condition
from tmd.pddl.reading.syntax import Group, Node, Word, nearest, parse

WAS: Final = "was"
"""The operator for what held when the clause began."""
FIRST: Final = "first"
"""The operator for what held before the whole text."""
MARK = "@"
"""Between a predicate and the operator that it is under."""
RELATION = "?rel"
"""The variable for the relation that was said."""
DECLARED: Final = "declared"
LEARNED: Final = "learned"
ACTIONS: Final = "actions"
Translation: TypeAlias = Callable[[Formula], Formula]
_SLOT = re.compile(r"[A-Z]\Z")
_WORD = re.compile(r"[a-z][a-z0-9_]*\Z")
_CONNECTIVES = RESERVED | {"=", ""}


@dataclass(frozen=True, slots=True)
class Slot:
    """A place of a pattern for a noun phrase.

    Attributes:
        variable: Its variable.
        prepositions: The prepositions before it; none for the object of the verb.
        types: The types of what may stand in it; empty where the condition alone tells.
    """

    variable: str
    prepositions: tuple[str, ...] = ()
    types: tuple[str, ...] = ()

    @property
    def is_place(self) -> bool:
        """Return whether the slot says where something is or goes."""
        return any(is_relation(p, "placing") for p in self.prepositions)


@dataclass(frozen=True, slots=True)
class GoalRow:
    """The meaning of a verb with its slots.

    Attributes:
        verbs: The verbs it is for.
        slots: Its slots.
        condition: What shall hold.
        pattern: It as it was written.
        noun: The noun that it is for, where that is not a slot: ``make affogato``.
        result: The word for a state at its end.
        source: Where it comes from.
        probability: How sure it is.
        evidence: What speaks for it, for people.
        location: Where it was written.
    """

    verbs: tuple[str, ...]
    slots: tuple[Slot, ...]
    condition: Formula
    pattern: str
    noun: str | None = None
    result: str | None = None
    source: str = DECLARED
    probability: float = 1.0
    evidence: str = ""
    location: Location | None = field(default=None, compare=False)

    @property
    def direct(self) -> Slot | None:
        """The slot of what the verb acts on."""
        return next((slot for slot in self.slots if not slot.prepositions), None)

    @property
    def places(self) -> tuple[Slot, ...]:
        """The slots behind prepositions."""
        return tuple(slot for slot in self.slots if slot.prepositions)

    @property
    def traceless(self) -> bool:
        """Return whether the row brings about nothing that a state shows."""
        return self.condition == And()

    @property
    def tells_agent(self) -> bool:
        """Return whether the row says of a thing what it does: *Ann knows chess*."""
        return any(relations_said(AGENT, slot.prepositions) for slot in self.slots)

    @property
    def looks_back(self) -> bool:
        """Return whether the condition refers to the first state, as *put it back* does."""
        return any(split_predicate(name)[1] == FIRST for name in predicates_of(self.condition))


@dataclass(frozen=True, slots=True, order=True)
class PutBack:
    """A state that people restore unasked: a tap that was turned on along the way is turned off.

    Attributes:
        predicate: A predicate of one thing that was made true and that nobody asked for.
        kind: The class of the thing.
    """

    predicate: str
    kind: str


@dataclass(frozen=True)
class GoalTable:
    """Rows of one source, and what adjectives and groups mean.

    Attributes:
        rows: The rows, in their order.
        attributes: For an adjective the condition of ``?x``.
        groups: For a noun that means many things the classes of all of them.
        put_back: What people undo by themselves, as demonstrations show it.
        unrestored: What people nearly always leave as it came about: an opened packet.
        restored: Conditions of ``?x`` that no plan leaves behind, as they are declared.
    """

    rows: tuple[GoalRow, ...] = ()
    attributes: Mapping[str, Formula] = field(default_factory=dict)
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    put_back: frozenset[PutBack] = frozenset()
    unrestored: frozenset[PutBack] = frozenset()
    restored: tuple[Formula, ...] = ()

    @cached_property
    def _by_verb(self) -> Mapping[str, tuple[GoalRow, ...]]:
        found: dict[str, list[GoalRow]] = {}
        for row in self.rows:
            for verb in row.verbs:
                found.setdefault(verb, []).append(row)
        return {verb: tuple(rows) for verb, rows in found.items()}

    def of(self, verb: str) -> tuple[GoalRow, ...]:
        """Return the rows of a verb, in their order."""
        return self._by_verb.get(verb, ())

    def verbs(self) -> list[str]:
        """Return the verbs that there are rows for, sorted."""
        return sorted(self._by_verb)


def read_table(
    goals: Sequence[Declared],
    attributes: Sequence[Declared],
    groups: Mapping[str, tuple[str, ...]],
    domain: Domain,
    faults: list[TmdError] | None = None,
) -> GoalTable:
    """Read what a lexicon declares.

    Args:
        goals: The rows.
        attributes: Adjectives; the pattern is the adjective.
        groups: Nouns for many things.
        domain: The domain that the conditions speak of.
        faults: Takes every fault; without it the first one is raised.

    Raises:
        TmdError: A row is wrong; with its place.
    """
    rows: list[GoalRow] = []
    said: dict[str, Formula] = {}
    for entry, is_row in [*((e, True) for e in goals), *((e, False) for e in attributes)]:
        try:
            if is_row:
                rows.append(read_row(entry, domain))
            else:
                said[entry.pattern] = read_row_condition(entry, {"?x"}, domain)
        except TmdError as error:
            if faults is None:
                raise
            faults.append(error)
    return GoalTable(tuple(rows), said, groups)


def read_row(entry: Declared, domain: Domain, source: str = DECLARED, translate: Translation | None = None) -> GoalRow:
    """Read one row.

    Raises:
        TmdError: Its pattern or its condition is wrong; with its place.
    """
    verbs, noun, slots, result = read_pattern(entry)
    condition = read_row_condition(entry, slot_variables(slots), domain, translate)
    return GoalRow(verbs, slots, condition, entry.pattern, noun, result, source, location=entry.location)


def slot_variables(slots: Sequence[Slot]) -> set[str]:
    """Return the variables that a pattern with some slots binds."""
    return {slot.variable for slot in slots} | ({RELATION} if any(slot.prepositions for slot in slots) else set())


def read_pattern(entry: Declared) -> tuple[tuple[str, ...], str | None, tuple[Slot, ...], str | None]:
    """Read a pattern: its verbs, its noun if it has one, its slots, and the word for a state.

    Raises:
        TmdError: It is not a pattern.
    """
    first, *words = entry.pattern.split() or [""]
    if not first:
        raise _wrong(entry, "a goal has no verb", "write 'open X: (opened ?x)'")
    verbs = tuple(first.split("|"))
    if not all(_WORD.match(verb) for verb in verbs):
        raise _wrong(entry, f"'{first}' is not a verb", "write verbs in lower case: open, turn_on, put|place")
    noun = words.pop(0) if words and _WORD.match(words[0]) and not _is_prepositions(words[0]) else None
    final = bool(words) and _WORD.match(words[-1]) and not _is_prepositions(words[-1])
    result = words.pop() if final and (len(words) < 2 or not _is_prepositions(words[-2])) else None
    slots = _read_slots(entry, words)
    if sum(not slot.prepositions for slot in slots) + (noun is not None) > 1:
        raise _wrong(entry, "two slots follow each other", "write a preposition between them")
    return verbs, noun, slots, result


def _is_prepositions(word: str) -> bool:
    return all(part in PREPOSITIONS for part in word.split("|"))


def _read_slots(entry: Declared, words: Sequence[str]) -> tuple[Slot, ...]:
    slots: list[Slot] = []
    waiting = ""
    for word in words:
        variable = f"?{word.lower()}"
        if _is_prepositions(word):
            waiting = word
            continue
        if not _SLOT.match(word):
            hint = nearest(word, list(PREPOSITIONS), what="prepositions")
            raise _wrong(entry, f"'{word}' is neither a slot nor a preposition", hint or "slots are single capitals")
        if any(slot.variable == variable for slot in slots):
            raise _wrong(entry, f"the slot {word} stands twice", "give each slot a letter of its own")
        slots.append(Slot(variable, tuple(waiting.split("|")) if waiting else ()))
        waiting = ""
    if waiting:
        raise _wrong(entry, f"no slot follows '{waiting}'", "write a capital behind it: in Y")
    return tuple(slots)


def _wrong(entry: Declared, message: str, hint: str | None = None) -> TmdError:
    return TmdError(message, location=entry.location, hint=hint, code="bad-goal")


def read_row_condition(
    entry: Declared, variables: set[str], domain: Domain, translate: Translation | None = None
) -> Formula:
    """Read a condition over ``variables``.

    Args:
        entry: The condition, with its place.
        variables: The variables.
        domain: The domain.
        translate: Returns the condition in the predicates of the domain.

    Raises:
        TmdError: It is not a condition, or speaks of what the domain does not have.
    """
    formula = read_formula(entry)
    try:
        formula = translate(formula) if translate is not None else formula
        _check(formula, frozenset(variables), domain)
    except TmdError as error:
        raise placed_in(entry, error) from None
    return formula


def read_formula(entry: Declared) -> Formula:
    """Read a condition, of any domain.

    Raises:
        TmdError: It is not a condition.
    """
    try:
        document = parse(entry.condition, "")
        if len(document.groups) != 1:
            raise TmdError("a goal is one condition", hint="write (and (…) (…)) for several")
        return read_condition(_marked(document.groups[0], ""), document.source)
    except TmdError as error:
        raise placed_in(entry, error) from None


def placed_in(entry: Declared, error: TmdError) -> TmdError:
    """Return a fault of a condition with its place in the file; where YAML folded its lines, that of the condition."""
    place, within = entry.location, error.location
    if place is not None and within is not None and within.line == 1:
        place = replace(place, column=place.column + within.column - 1)
    return TmdError(error.message, location=place, hint=error.hint, code=error.code or "bad-goal")


def _marked(node: Node, operator: str) -> Node:
    """Take out ``was`` and ``first``; the predicates below carry them in their names."""
    if isinstance(node, Word) or node.head.startswith("?"):
        return node
    if node.head in (WAS, FIRST) and len(node.parts) == 2 and isinstance(node.parts[1], Group):
        return _marked(node.parts[1], node.head)
    if node.head in _CONNECTIVES:
        return replace(node, parts=tuple(_marked(part, operator) for part in node.parts))
    if operator and isinstance(node.parts[0], Word):
        head = replace(node.parts[0], text=f"{node.parts[0].text}{MARK}{operator}")
        return replace(node, parts=(head, *node.parts[1:]))
    return node


def split_predicate(name: str) -> tuple[str, str]:
    """Return a predicate and the operator it is under, or ``""``."""
    predicate, _, operator = name.partition(MARK)
    return predicate, operator


def _check(formula: Formula, variables: frozenset[str], domain: Domain) -> None:
    """Check that a condition speaks of what the domain has.

    Raises:
        TmdError: It does not.
    """
    for part, bound in subformulas(formula, variables):
        match part:
            case Atom(terms=terms):
                _check_predicate(part, domain)
                _check_terms(terms, part.location, bound, variables, domain)
            case Equals(left, right):
                _check_terms((left, right), part.location, bound, variables, domain)
            case Forall(parameters) | Exists(parameters):
                for parameter in parameters:
                    _check_types(parameter, domain)


def _check_types(parameter: TypedName, domain: Domain) -> None:
    types = hierarchy(domain)
    for kind in parameter.types:
        if not types.known(kind):
            hint = nearest(kind, sorted(types.parents), what="types")
            raise TmdError(f'there is no type "{kind}"', location=parameter.location, hint=hint)


def _check_predicate(atom: Atom, domain: Domain) -> None:
    signatures = {p.name: p for p in domain.predicates}
    name, _ = split_predicate(atom.predicate)
    if name not in signatures:
        hint = nearest(name, sorted(signatures), what="predicates")
        raise TmdError(f'there is no predicate "{name}"', location=atom.location, hint=hint)
    wanted = len(signatures[name].parameters)
    if len(atom.terms) != wanted:
        message = f'"{name}" takes {wanted} arguments, found {len(atom.terms)}'
        raise TmdError(message, location=atom.location)


def _check_terms(
    terms: Sequence[str], location: Location | None, bound: frozenset[str], variables: frozenset[str], domain: Domain
) -> None:
    constants = sorted(c.name for c in domain.constants)
    for term in terms:
        if term.startswith("?") and term not in bound:
            hint = f"the slots here: {', '.join(sorted(variables)) or 'none'}"
            raise TmdError(f"no slot is called {term}", location=location, hint=hint)
        if not term.startswith("?") and term not in constants:
            hint = nearest(term, constants, what="constants") or ""
            raise TmdError(f'the domain has no constant "{term}"', location=location, hint=hint or None)


def subformulas(formula: Formula, bound: frozenset[str] = frozenset()) -> Iterator[tuple[Formula, frozenset[str]]]:
    """Yield each atom, equality and quantifier of a condition, outer ones first, with the variables bound there."""
    match formula:
        case Atom() | Equals():
            yield formula, bound
        case Not(part):
            yield from subformulas(part, bound)
        case And(parts) | Or(parts):
            for inner in parts:
                yield from subformulas(inner, bound)
        case Imply(left, right):
            yield from subformulas(left, bound)
            yield from subformulas(right, bound)
        case Forall(parameters, part) | Exists(parameters, part):
            yield formula, bound
            yield from subformulas(part, bound | {p.name for p in parameters})


def atoms_in(formula: Formula) -> Iterator[Atom]:
    """Yield the atoms of a condition."""
    return (part for part, _ in subformulas(formula) if isinstance(part, Atom))


def slot_types(row: GoalRow, slot: Slot, domain: Domain) -> tuple[str, ...]:
    """Return the types of what may stand in a slot: its own, or those that the condition tells."""
    return slot.types or _types_in(row.condition, slot.variable, domain)


def _types_in(row_condition: Formula, variable: str, domain: Domain) -> tuple[str, ...]:
    """Return the types of a variable, read off the signature of the first predicate that takes it.

    Where there are several ways (``or``), it may be of the types of any.
    """
    if isinstance(row_condition, Or):
        ways = [part for part in row_condition.parts if any(variable in atom.terms for atom in atoms_in(part))]
        return tuple(dict.fromkeys(t for way in ways for t in _types_in(way, variable, domain))) or (OBJECT,)
    predicate, place = slot_predicate(row_condition, variable)
    signature = next((p for p in domain.predicates if p.name == predicate), None)
    return signature.parameters[place].types if signature is not None else (OBJECT,)


def slot_predicate(row_condition: Formula, variable: str) -> tuple[str, int]:
    """Return the first predicate in which a slot's variable stands, and its place there; ``""`` for none."""
    for atom in atoms_in(row_condition):
        if variable in atom.terms:
            return split_predicate(atom.predicate)[0], atom.terms.index(variable)
    return "", 0
