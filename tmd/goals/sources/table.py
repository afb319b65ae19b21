"""What verbs mean: rows that give a verb with its slots a PDDL condition.

A row is written as in ``lexicon.yaml``::

    place X in|on|next_to Y: (at ?x ?y ?rel)

Its pattern has verbs (``a|b`` for several), slots (capitals), prepositions before all slots but the first, and, last, a
word for the state that something shall be in (``make X louder``). In the condition each slot is a variable of its name
in lower case, ``?rel`` the relation that was said. Beyond PDDL's conditions, ``(was φ)`` tells whether φ holds when the
clause begins, and ``(first φ)`` whether it held before the whole text.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property

from tmd.diagnostics import Location, TmdError
from tmd.language.lexicon.lexicon import Declared, data_text
from tmd.pddl.model import And, Atom, Domain, Equals, Exists, Forall, Formula, Imply, Not, Or, hierarchy, predicates_of
from tmd.pddl.reading.formulas import read_condition
from tmd.pddl.reading.syntax import Group, Node, Word, nearest, parse


@cache
def _sections() -> Mapping[str, tuple[str, ...]]:
    found: dict[str, list[str]] = {}
    current: list[str] = []
    for line in data_text("senses.txt").splitlines():
        if line.startswith("["):
            current = found.setdefault(line.strip("[]"), [])
        elif line and not line.startswith("#"):
            current.append(line)
    return {name: tuple(lines) for name, lines in found.items()}


@cache
def _table(section: str) -> Mapping[str, tuple[str, ...]]:
    lines = (line.partition(":") for line in _sections()[section])
    return {name.strip(): tuple(words.split()) for name, _, words in lines}


def words_of(section: str) -> frozenset[str]:
    """The words of a plain section: ``measures``, ``anaphors``."""
    return frozenset(word for line in _sections()[section] for word in line.split())


def family(verb: str) -> tuple[str, ...]:
    """Verbs that ask for the same as ``verb``, nearest first: its own family, then the families it stands in.

    A member with a ``>`` is one way of doing it: to cook may be to fry, but to fry is not just to cook.
    """
    families = _table("families")
    found = dict.fromkeys(member.removeprefix(">") for member in families.get(verb, ()))
    for head, members in families.items():
        if verb in members:
            found[head] = None
    for members in families.values():
        if verb in members:
            found.update(dict.fromkeys(member.removeprefix(">") for member in members[:4]))
    found.pop(verb, None)
    return tuple(found)


def results(verb: str) -> tuple[str, ...]:
    """Words for the state that ``verb`` leaves its object in; those with a minus are taken away."""
    return _table("results").get(verb, ())


def state_words(adjective: str) -> tuple[str, ...]:
    """Words that say the same as ``adjective``, itself first; those with a minus say the contrary."""
    return tuple(dict.fromkeys((adjective, *_table("states").get(adjective, ()))))


def result_verbs() -> tuple[str, ...]:
    """The verbs that there are words for the outcome of."""
    return tuple(_table("results"))


WAS, FIRST = "was", "first"
"""The operators beyond PDDL: what held when the clause began, and before the whole text."""
MARK = "@"
"""Between a predicate and the operator it stands under."""
RELATION = "?rel"
"""The variable for the relation that was said."""
DECLARED, LEARNED, ACTIONS = "declared", "learned", "actions"
"""Where a row comes from."""
_SLOT = re.compile(r"[A-Z]\Z")
_WORD = re.compile(r"[a-z][a-z0-9_]*\Z")

PREPOSITIONS: Mapping[str, tuple[str, ...]] = {
    "in": ("in", "into", "inside", "inside_of", "within", "down"),
    "on": ("on", "onto", "on_to", "on_top_of", "upon", "over", "atop"),
    "next_to": ("next_to", "beside", "by", "near", "close_to", "alongside"),
    "under": ("under", "underneath", "below", "beneath"),
    "behind": ("behind",),
    "above": ("above",),
    "to": ("to", "at", "towards"),
    "from": ("from", "out_of", "off", "off_of", "out"),
    "of": ("of", "containing"),
    "with": ("with", "using"),
    "for": ("for",),
    "through": ("through", "via"),
    "between": ("between",),
}
"""Each preposition of a pattern, with the words that it stands for; the first is the most usual."""

LOCATED = frozenset({"at", "located", "location", "loc", "position", "situated", "whereabouts"})
"""Words in the names of predicates that say where something is, and not whether in, on or beside it."""


@dataclass(frozen=True, slots=True)
class Slot:
    """A place of a pattern for a noun phrase: its variable, and the prepositions before it (none: the object)."""

    variable: str
    prepositions: tuple[str, ...] = ()

    @property
    def is_place(self) -> bool:
        """Whether it says where something is or goes."""
        return bool({"in", "on", "next_to", "under", "to"} & set(self.prepositions))


@dataclass(frozen=True, slots=True)
class GoalRow:
    """What a verb with its slots means.

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
        """Whether it brings about nothing that a state shows."""
        return self.condition == And()

    @property
    def looks_back(self) -> bool:
        """Whether it speaks of how things were at first: *put it back* is said of what was moved."""
        return any(split_predicate(name)[1] == FIRST for name in predicates_of(self.condition))


@dataclass(frozen=True, slots=True, order=True)
class PutBack:
    """What people undo by themselves: the tap that was turned on by the way is turned off.

    Attributes:
        predicate: A predicate of one thing that was made true and that nobody asked for.
        kind: The class of the thing.
        at_once: It is undone when the clause is done that needed it; otherwise at the end of the text.
    """

    predicate: str
    kind: str
    at_once: bool


@dataclass(frozen=True)
class GoalTable:
    """Rows of one source, and what adjectives and groups mean.

    Attributes:
        rows: The rows, in their order.
        attributes: For an adjective the condition of ``?x``.
        groups: For a noun that means many things the classes of all of them.
        put_back: What people undo by themselves.
    """

    rows: tuple[GoalRow, ...] = ()
    attributes: Mapping[str, Formula] = field(default_factory=dict)
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    put_back: frozenset[PutBack] = frozenset()

    @cached_property
    def _by_verb(self) -> Mapping[str, tuple[GoalRow, ...]]:
        found: dict[str, list[GoalRow]] = {}
        for row in self.rows:
            for verb in row.verbs:
                found.setdefault(verb, []).append(row)
        return {verb: tuple(rows) for verb, rows in found.items()}

    def of(self, verb: str) -> tuple[GoalRow, ...]:
        """The rows of a verb, in their order."""
        return self._by_verb.get(verb, ())

    def verbs(self) -> list[str]:
        """The verbs that there are rows for, sorted."""
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


def read_row(entry: Declared, domain: Domain, source: str = DECLARED) -> GoalRow:
    """Read one row.

    Raises:
        TmdError: Its pattern or its condition is wrong; with its place.
    """
    verbs, noun, slots, result = read_pattern(entry)
    known = {slot.variable for slot in slots} | ({RELATION} if any(s.prepositions for s in slots) else set())
    condition = read_row_condition(entry, known, domain)
    return GoalRow(verbs, slots, condition, entry.pattern, noun, result, source, location=entry.location)


def read_pattern(entry: Declared) -> tuple[tuple[str, ...], str | None, tuple[Slot, ...], str | None]:
    """Read a pattern: its verbs, its noun if it has one, its slots, and the word for a state.

    Raises:
        TmdError: It is not a pattern.
    """
    words = entry.pattern.split()
    if not words:
        raise _wrong(entry, "a goal has no verb", "write 'open X: (opened ?x)'")
    verbs = tuple(words[0].split("|"))
    if not all(_WORD.match(verb) for verb in verbs):
        raise _wrong(entry, f"'{words[0]}' is not a verb", "write verbs in lower case: open, turn_on, put|place")
    slots: list[Slot] = []
    waiting: tuple[str, ...] = ()
    noun = result = None
    for place, word in enumerate(words[1:], 1):
        if _SLOT.match(word):
            variable = f"?{word.lower()}"
            if any(slot.variable == variable for slot in slots):
                raise _wrong(entry, f"the slot {word} stands twice", "give each slot a letter of its own")
            slots.append(Slot(variable, waiting))
            waiting = ()
        elif all(part in PREPOSITIONS for part in word.split("|")):
            waiting = tuple(word.split("|"))
        elif place == 1 and _WORD.match(word):
            noun = word
        elif place == len(words) - 1 and _WORD.match(word) and not waiting:
            result = word
        else:
            hint = nearest(word, list(PREPOSITIONS), what="prepositions")
            raise _wrong(entry, f"'{word}' is neither a slot nor a preposition", hint or "slots are single capitals")
    if waiting:
        raise _wrong(entry, f"no slot follows '{'|'.join(waiting)}'", "write a capital behind it: in Y")
    if sum(not slot.prepositions for slot in slots) + (noun is not None) > 1:
        raise _wrong(entry, "two slots follow each other", "write a preposition between them")
    return verbs, noun, tuple(slots), result


def _wrong(entry: Declared, message: str, hint: str | None = None) -> TmdError:
    return TmdError(message, location=entry.location, hint=hint, code="bad-goal")


def read_row_condition(entry: Declared, variables: set[str], domain: Domain) -> Formula:
    """Read a condition over ``variables``.

    Raises:
        TmdError: It is not a condition, or speaks of what the domain does not have.
    """
    place = entry.location or Location("goals", 1, 1)
    try:
        document = parse(entry.condition, place.file)
        if len(document.groups) != 1:
            raise TmdError("a goal is one condition", hint="write (and (…) (…)) for several", code="bad-goal")
        formula = read_condition(_marked(document.groups[0], ""), document.source)
        _check(formula, frozenset(variables), domain)
    except TmdError as error:
        column = place.column + (error.location.column - 1 if error.location and error.location.line == 1 else 0)
        where = replace(place, column=column) if entry.location else None
        raise TmdError(error.message, location=where, hint=error.hint, code=error.code or "bad-goal") from None
    return formula


def _marked(node: Node, operator: str) -> Node:
    """Take out ``was`` and ``first``; the predicates below carry them in their names."""
    if isinstance(node, Word) or node.head.startswith("?"):
        return node
    if node.head in (WAS, FIRST) and len(node.parts) == 2 and isinstance(node.parts[1], Group):
        return _marked(node.parts[1], node.head)
    if node.head in ("and", "or", "not", "imply", "forall", "exists", "=", ""):
        return replace(node, parts=tuple(_marked(part, operator) for part in node.parts))
    if operator and isinstance(node.parts[0], Word):
        head = replace(node.parts[0], text=f"{node.parts[0].text}{MARK}{operator}")
        return replace(node, parts=(head, *node.parts[1:]))
    return node


def split_predicate(name: str) -> tuple[str, str]:
    """A predicate and the operator it stands under, or ``""``."""
    predicate, _, operator = name.partition(MARK)
    return predicate, operator


def _check(formula: Formula, variables: frozenset[str], domain: Domain) -> None:
    """Check that a condition speaks of what the domain has.

    Raises:
        TmdError: It does not.
    """
    signatures = {p.name: p for p in domain.predicates}
    constants = {c.name for c in domain.constants}
    types = hierarchy(domain)
    for part, bound in _parts(formula, variables):
        if isinstance(part, Forall | Exists):
            for parameter in part.parameters:
                for kind in parameter.types:
                    if not types.known(kind):
                        hint = nearest(kind, sorted(types.parents), what="types")
                        raise TmdError(f'there is no type "{kind}"', location=parameter.location, hint=hint)
            continue
        if isinstance(part, Atom):
            name, _ = split_predicate(part.predicate)
            if name not in signatures:
                hint = nearest(name, sorted(signatures), what="predicates")
                raise TmdError(f'there is no predicate "{name}"', location=part.location, hint=hint)
            wanted = len(signatures[name].parameters)
            if len(part.terms) != wanted:
                message = f'"{name}" takes {wanted} arguments, found {len(part.terms)}'
                raise TmdError(message, location=part.location)
        terms = part.terms if isinstance(part, Atom) else (part.left, part.right)
        for term in terms:
            if term.startswith("?") and term not in bound:
                slots = ", ".join(sorted(variables)) or "none"
                raise TmdError(f"no slot is called {term}", location=part.location, hint=f"the slots here: {slots}")
            if not term.startswith("?") and term not in constants:
                hint = nearest(term, sorted(constants), what="constants")
                raise TmdError(f'the domain has no constant "{term}"', location=part.location, hint=hint)


def _parts(formula: Formula, bound: frozenset[str]) -> Iterator[tuple[Atom | Equals | Forall | Exists, frozenset[str]]]:
    match formula:
        case Atom() | Equals():
            yield formula, bound
        case Not(part):
            yield from _parts(part, bound)
        case And(parts) | Or(parts):
            for inner in parts:
                yield from _parts(inner, bound)
        case Imply(left, right):
            yield from _parts(left, bound)
            yield from _parts(right, bound)
        case Forall(parameters, part) | Exists(parameters, part):
            yield formula, bound
            yield from _parts(part, bound | {p.name for p in parameters})


def slot_types(row_condition: Formula, variable: str, domain: Domain) -> tuple[str, ...]:
    """The types of what may stand in a slot, read off the signature of the first predicate that takes it.

    Where there are several ways (``or``), it may be of the types of any.
    """
    if isinstance(row_condition, Or):
        ways = [part for part in row_condition.parts if variable in _terms(part)]
        return tuple(dict.fromkeys(t for way in ways for t in slot_types(way, variable, domain))) or ("object",)
    predicate, place = slot_predicate(row_condition, variable)
    signature = next((p for p in domain.predicates if p.name == predicate), None)
    return signature.parameters[place].types if signature is not None else ("object",)


def slot_predicate(row_condition: Formula, variable: str) -> tuple[str, int]:
    """The first predicate in which the variable of a slot stands, and its place there; ``""`` where there is none."""
    for part, _ in _parts(row_condition, frozenset()):
        if isinstance(part, Atom) and variable in part.terms:
            return split_predicate(part.predicate)[0], part.terms.index(variable)
    return "", 0


def _terms(formula: Formula) -> set[str]:
    return {term for part, _ in _parts(formula, frozenset()) if isinstance(part, Atom) for term in part.terms}
