"""The goal tables of a domain: declared, learned, and derived from its actions.

A lexicon declares rows itself, and includes those of base lexicons as far as they apply in the domain. A base lexicon
is written once for many domains. Its rows speak of *shared predicates*, which it declares with the conditions that may
say the same in a domain::

    predicates:
      held ?x: (holding pr2 ?x) | (holding ?x) | (grasped ?x)
    goals:
      - take X: (held ?x)

The first condition that the domain has the predicates, types and constants for is used. Where there is none, the row
does not apply. Where a condition is there for some prepositions of a row only, the row applies with these.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from weakref import WeakKeyDictionary

from tmd.diagnostics import Location, TmdError
from tmd.goals.sources.actions import rows_of_actions
from tmd.goals.sources.table import (
    ACTIONS,
    DECLARED,
    LEARNED,
    MARK,
    RELATION,
    GoalRow,
    GoalTable,
    placed_in,
    read_formula,
    read_pattern,
    read_row,
    read_row_condition,
    read_table,
    slot_types,
    slot_variables,
    split_predicate,
    subformulas,
)
from tmd.language.lexicon.lexicon import Base, Declared, Lexicon, SharedPredicate
from tmd.pddl.model import Atom, Domain, Equals, Exists, Forall, Formula, free_variables, hierarchy, with_parts
from tmd.pddl.reading.checking import check_condition
from tmd.pddl.reading.syntax import nearest, parse, read_text, split_lines
from tmd.pddl.writer import format_formula

SOURCES = (DECLARED, LEARNED, ACTIONS)
"""All sources of goals, the surest first."""


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A row, or an adjective, of a base lexicon that is not used in a domain.

    Attributes:
        entry: The row as it was written.
        reason: The reason, in one line.
        verbs: The verbs that it is left out for; none for an adjective.
    """

    entry: Declared
    reason: str
    verbs: tuple[str, ...] = ()


_DECLARED: WeakKeyDictionary[Lexicon, dict[Domain, tuple[GoalTable, tuple[LeftOut, ...]]]] = WeakKeyDictionary()


def declared_goals(lexicon: Lexicon, domain: Domain) -> GoalTable:
    """Return the goals that a lexicon declares for a domain, its own before those of base lexicons; they are read once.

    Raises:
        TmdError: A row is wrong; with its place.
    """
    return _declared(lexicon, domain)[0]


def declared_entries(lexicon: Lexicon, domain: Domain) -> tuple[Sequence[Declared], Sequence[Declared]]:
    """Return the rows and the adjectives that are declared for a domain as text, those of base lexicons translated.

    Raises:
        TmdError: A row is wrong; with its place.
    """
    table = declared_goals(lexicon, domain)
    written = {entry.location: entry for entry in lexicon.goals}
    own = {entry.pattern: entry for entry in lexicon.attributes}
    rows = [written.get(row.location) or Declared(row.pattern, condition_text(row.condition)) for row in table.rows]
    adjectives = [own.get(name) or Declared(name, condition_text(said)) for name, said in table.attributes.items()]
    return rows, adjectives


def left_out(lexicon: Lexicon, domain: Domain) -> tuple[LeftOut, ...]:
    """Return the rows of base lexicons that are not used in a domain, with reasons.

    Raises:
        TmdError: A row is wrong; with its place.
    """
    return _declared(lexicon, domain)[1]


def _declared(lexicon: Lexicon, domain: Domain) -> tuple[GoalTable, tuple[LeftOut, ...]]:
    known = _DECLARED.setdefault(lexicon, {})
    if domain not in known:
        own = read_table(lexicon.goals, lexicon.attributes, lexicon.groups, domain)
        restored = tuple(read_row_condition(entry, {"?x"}, domain) for entry in lexicon.restored or ())
        own = replace(own, restored=restored)
        known[domain] = _with_bases(own, lexicon, domain)
    return known[domain]


def goal_tables(
    lexicon: Lexicon,
    domain: Domain,
    learned: GoalTable | None = None,
    sources: Collection[str] = SOURCES,
) -> list[GoalTable]:
    """Return the goal tables of a domain, the surest source first; the first also has its adjectives and groups.

    Args:
        lexicon: The words of the domain.
        domain: The domain.
        learned: The rows that its demonstrations teach.
        sources: The sources that are used.

    Raises:
        TmdError: The lexicon declares something that is wrong; with its place.
    """
    declared = declared_goals(lexicon, domain)
    rows = declared.rows if DECLARED in sources else ()
    read_off = (_actions(domain),) if ACTIONS in sources else ()
    attributes: dict[str, Formula] = {}
    for table in (*read_off, declared):  # what is declared is surer
        attributes.update(table.attributes)
    tables = [GoalTable(rows, attributes, declared.groups)]
    if LEARNED in sources and learned is not None:
        tables.append(learned)
    return [*tables, *read_off]


@lru_cache(maxsize=8)
def _actions(domain: Domain) -> GoalTable:
    return rows_of_actions(domain)


# ---------------------------------------------------------------------- base lexicons


def _with_bases(own: GoalTable, lexicon: Lexicon, domain: Domain) -> tuple[GoalTable, tuple[LeftOut, ...]]:
    """Return the goals that a lexicon declares itself with those of its base lexicons, and what of these is left out.

    Raises:
        TmdError: A base lexicon has a fault, or the lexicon maps a predicate to what the domain does not have.
    """
    for fault in faults_of(lexicon, domain):
        raise fault
    translation = _Translation(lexicon.base, domain)
    rows, added, unused = list(own.rows), [], []
    for entry in lexicon.base.goals:
        found, reason = translation.rows(entry)
        if not found:
            unused.append(LeftOut(entry, reason, read_pattern(entry)[0]))
        for row in found:
            kept, gone = _without_replaced(row, entry, rows, lexicon, domain)
            unused += gone
            if kept.verbs:
                rows.append(kept)
                added.append(kept)
    meant: dict[str, Formula] = {}
    for entry in lexicon.base.attributes:
        condition, reason = translation.adjective(entry)
        if condition is None or entry.pattern in own.attributes:
            unused.append(LeftOut(entry, reason or f"the adjective '{entry.pattern}' is declared already"))
        else:
            meant.setdefault(entry.pattern, condition)
    place = len(own.rows) if lexicon.base.place is None else lexicon.base.place
    restored = own.restored
    if lexicon.restored is None:
        conditions = (translation.adjective(entry)[0] for entry in lexicon.base.restored)
        restored = tuple(condition for condition in conditions if condition is not None)
    whole = (*own.rows[:place], *added, *own.rows[place:])
    table = replace(own, rows=whole, attributes={**meant, **own.attributes}, restored=restored)
    return table, tuple(unused)


def _without_replaced(
    row: GoalRow, entry: Declared, rows: Sequence[GoalRow], lexicon: Lexicon, domain: Domain
) -> tuple[GoalRow, list[LeftOut]]:
    """Return a shared row for the verbs for which no row nearer to the domain replaces it, and what is left out."""
    replaced = {verb: other for verb in row.verbs if (other := _before(verb, row, rows, lexicon, domain)) is not None}
    gone: dict[str, list[str]] = {}
    for verb, other in replaced.items():
        gone.setdefault(f"'{other.pattern}' ({other.location}) says it already", []).append(verb)
    kept = replace(row, verbs=tuple(verb for verb in row.verbs if verb not in replaced))
    return kept, [LeftOut(entry, reason, tuple(verbs)) for reason, verbs in gone.items()]


def _before(verb: str, row: GoalRow, rows: Iterable[GoalRow], lexicon: Lexicon, domain: Domain) -> GoalRow | None:
    """Return a row of a file nearer to the domain that says what a verb, or the one it stands for, means here."""
    verbs = {verb, lexicon.canonical_verb(verb)}
    for other in rows:
        elsewhere = other.location is None or row.location is None or other.location.file != row.location.file
        if elsewhere and verbs.intersection(other.verbs) and _same_pattern(other, row, domain):
            return other
    return None


def _same_pattern(one: GoalRow, other: GoalRow, domain: Domain) -> bool:
    """Return whether two rows take the same prepositions, nouns and state words, and things of kinds that may agree."""
    if (one.noun, one.result, len(one.slots)) != (other.noun, other.result, len(other.slots)):
        return False
    kinds = hierarchy(domain)
    for first, second in zip(one.slots, other.slots, strict=True):
        if set(first.prepositions) != set(second.prepositions):
            return False
        left = slot_types(one, first, domain)
        right = slot_types(other, second, domain)
        if not any(a in kinds.ancestors(b) or b in kinds.ancestors(a) for a in left for b in right):
            return False
    return True


def condition_text(condition: Formula) -> str:
    """Return the condition of a row on one line, as it is written in a lexicon."""
    written = " ".join(format_formula(condition).split())
    return re.sub(rf"\((\S+){MARK}(\w+)([^()]*)\)", r"(\2 (\1\3))", written)


class _Translation:
    """Translates rows of base lexicons into the predicates of a domain.

    Args:
        base: The rows, the shared predicates and types.
        domain: The domain.
    """

    def __init__(self, base: Base, domain: Domain) -> None:
        self._base = base
        self._domain = domain
        known = hierarchy(domain)
        self._types = {
            name: next((kind for kind in kinds if known.known(kind)), None) for name, kinds in base.types.items()
        }
        self._fitting: dict[tuple[SharedPredicate, Declared], Formula | None] = {}

    def rows(self, entry: Declared) -> tuple[list[GoalRow], str]:
        """Return a row in the predicates of the domain, or the reason why there is none.

        Where it applies with some prepositions only, there is a row for each of them.
        """
        try:
            return [read_row(entry, self._domain, translate=self._translated)], ""
        except TmdError as error:
            reason = error.message
        found = []
        for one in _with_one_preposition(entry):
            try:
                found.append(read_row(one, self._domain, translate=self._translated))
            except TmdError:
                continue
        return found, reason

    def adjective(self, entry: Declared) -> tuple[Formula | None, str]:
        """Return the condition of an adjective in the predicates of the domain, or the reason why there is none."""
        try:
            return read_row_condition(entry, {"?x"}, self._domain, self._translated), ""
        except TmdError as error:
            return None, error.message

    def _translated(self, formula: Formula) -> Formula:
        """Return a condition over the predicates of the domain.

        Raises:
            TmdError: The domain has nothing for one of the shared predicates or types.
        """
        if isinstance(formula, Atom):
            return self._shared(formula)
        return with_parts(self._typed(formula), self._translated)

    def _typed(self, formula: Formula) -> Formula:
        """Replace the types of a quantifier's variables."""
        if not isinstance(formula, Forall | Exists):
            return formula
        parameters = (replace(p, types=tuple(map(self._type, p.types))) for p in formula.parameters)
        return replace(formula, parameters=tuple(parameters))

    def _with_types(self, formula: Formula) -> Formula:
        """Replace the types of all quantifiers of a condition."""
        return with_parts(self._typed(formula), self._with_types)

    def _type(self, name: str) -> str:
        found = self._types.get(name, name)
        if found is None:
            kinds = ", ".join(self._base.types[name])
            raise TmdError(f"this domain has no type for '{name}' ({kinds})")
        return found

    def _shared(self, atom: Atom) -> Formula:
        """Replace an atom over a shared predicate by the first of its conditions that the domain has."""
        name, operator = split_predicate(atom.predicate)
        tried: list[SharedPredicate] = []
        for predicate in self._base.predicates:
            if predicate.name != name or not _matches(predicate, atom.terms):
                continue
            if any(_shadows(other, predicate) for other in tried):
                continue
            for form in predicate.forms:
                condition = self._condition(predicate, form)
                if condition is not None:
                    given = dict(zip(predicate.terms, atom.terms, strict=True))
                    return _substituted(condition, given, predicate.name, operator)
            tried.append(predicate)
        conditions = " | ".join(" ".join(form.condition.split()) for predicate in tried for form in predicate.forms)
        raise TmdError(f"this domain has nothing for ({name} {' '.join(atom.terms)}): {conditions or 'none'}")

    def _condition(self, predicate: SharedPredicate, form: Declared) -> Formula | None:
        """Return a condition of a shared predicate; ``None`` where the domain lacks what it speaks of."""
        if (predicate, form) not in self._fitting:
            try:
                found = self._with_types(read_formula(form))
                faults = check_condition(_present(found), _variables(predicate), self._domain)
                self._fitting[predicate, form] = None if faults else found
            except TmdError:
                self._fitting[predicate, form] = None
        return self._fitting[predicate, form]


def _variables(predicate: SharedPredicate) -> set[str]:
    return {term for term in predicate.terms if term.startswith("?")}


def _present(formula: Formula) -> Formula:
    """Return a condition without ``was`` and ``first``."""
    if isinstance(formula, Atom):
        return replace(formula, predicate=split_predicate(formula.predicate)[0])
    return with_parts(formula, _present)


def _shadows(first: SharedPredicate, second: SharedPredicate) -> bool:
    """Return whether ``first`` is declared for the same arguments in a file nearer to the domain, and replaces it."""
    places = first.location, second.location
    other = places[0] is not None and places[1] is not None and places[0].file != places[1].file
    one, two = (["?" if term.startswith("?") else term for term in each.terms] for each in (first, second))
    return other and one == two


def _matches(predicate: SharedPredicate, arguments: Sequence[str]) -> bool:
    """Return whether a shared predicate is declared for arguments: names must agree, variables match anything."""
    if len(predicate.terms) != len(arguments):
        return False
    return all(term.startswith("?") or term == said for term, said in zip(predicate.terms, arguments, strict=True))


def _substituted(formula: Formula, given: Mapping[str, str], name: str, operator: str) -> Formula:
    """Return the condition of a shared predicate with its arguments, under ``was`` or ``first``.

    Variables that it binds itself get the name of the predicate at their ends.
    """

    def term(old: str) -> str:
        return given.get(old, f"{old}_{name}") if old.startswith("?") else old

    def changed(part: Formula) -> Formula:
        match part:
            case Atom(predicate, terms):
                marked = f"{predicate}{MARK}{operator}" if operator and MARK not in predicate else predicate
                return replace(part, predicate=marked, terms=tuple(map(term, terms)))
            case Equals(left, right):
                return Equals(term(left), term(right))
            case Forall(parameters) | Exists(parameters):
                part = replace(part, parameters=tuple(replace(p, name=term(p.name)) for p in parameters))
        return with_parts(part, changed)

    return changed(formula)


def _with_one_preposition(entry: Declared) -> Iterator[Declared]:
    """Yield a row for each preposition that ``?rel`` may be in it."""
    words = entry.pattern.split()
    for place, word in enumerate(words):
        names = word.split("|")
        if place > 0 and word.islower() and len(names) > 1 and RELATION in entry.condition:
            for name in names:
                pattern = " ".join((*words[:place], name, *words[place + 1 :]))
                yield replace(entry, pattern=pattern, condition=entry.condition.replace(RELATION, name))


# ---------------------------------------------------------------------- faults


def faults_of(lexicon: Lexicon, domain: Domain | None = None) -> list[TmdError]:
    """Return the faults of what a lexicon includes, and of what it says about it.

    Args:
        lexicon: A lexicon of a domain, or a base lexicon as it is read by itself.
        domain: The domain; without it the conditions of shared predicates are not compared with one.
    """
    base = lexicon.base
    rows = base.goals if domain is not None else (*lexicon.goals, *base.goals)
    adjectives = base.attributes if domain is not None else (*lexicon.attributes, *base.attributes)
    names = [p.name for p in base.predicates if domain is None or not _of(p.location, lexicon)]
    found: list[TmdError] = []
    for predicate in base.predicates:
        found += _predicate_faults(predicate, lexicon, domain, names)
    found += _type_faults(lexicon, domain) if domain is not None else ()
    for entry in rows:
        found += _entry_faults(entry, base, is_row=True)
    for entry in adjectives:
        found += _entry_faults(entry, base, is_row=False)
    for fault in found:
        fault.source = _line(fault.location)
    return found


def _line(place: Location | None) -> str | None:
    """Return the line of a file at a place."""
    lines = split_lines(read_text(place.file)) if place is not None else ()
    return lines[place.line - 1] if place is not None and place.line <= len(lines) else None


def _of(place: Location | None, lexicon: Lexicon) -> bool:
    return place is not None and place.file == lexicon.source


def _predicate_faults(
    predicate: SharedPredicate, lexicon: Lexicon, domain: Domain | None, names: Sequence[str]
) -> Iterator[TmdError]:
    """Yield what is wrong with a shared predicate.

    In a domain those of its own lexicon must be of an included one, and their conditions of the domain.
    """
    own = domain is not None and _of(predicate.location, lexicon)
    if own and predicate.name not in names:
        hint = nearest(predicate.name, sorted(set(names)), what="shared predicates")
        message = f"no base lexicon that is included has a predicate '{predicate.name}'"
        yield TmdError(message, location=predicate.location, hint=hint, code="unknown-predicate")
    for form in predicate.forms:
        try:
            formula = read_formula(form)
        except TmdError as error:
            yield error
            continue
        if own and domain is not None:
            source = parse(form.condition, "").source
            for fault in check_condition(_present(formula), _variables(predicate), domain, source):
                yield placed_in(form, fault)


def _type_faults(lexicon: Lexicon, domain: Domain) -> Iterator[TmdError]:
    """Yield the types that a lexicon itself gives for one of the shared rows, and that its domain does not have."""
    kinds = hierarchy(domain)
    for name, meant in lexicon.base.types.items():
        place = lexicon.places.get(("types", name))
        if _of(place, lexicon) and not any(kinds.known(kind) for kind in meant):
            hint = nearest(meant[0], sorted(kinds.parents), what="types") if meant else None
            message = f"the domain has no type '{', '.join(meant)}'"
            yield TmdError(message, location=place, hint=hint, code="unknown-type")


def _entry_faults(entry: Declared, base: Base, *, is_row: bool) -> Iterator[TmdError]:
    """Yield what is wrong with a row or an adjective of a base lexicon, whatever the domain."""
    try:
        free = slot_variables(read_pattern(entry)[2]) if is_row else {"?x"}
        formula = read_formula(entry)
    except TmdError as error:
        yield error
        return
    for part, bound in subformulas(formula, frozenset(free)):
        found = list(_atom_faults(entry, part, base)) if isinstance(part, Atom) else []
        for term in sorted(free_variables(part) - bound) if isinstance(part, Atom | Equals) else ():
            hint = f"the slots here: {', '.join(sorted(bound)) or 'none'}"
            message = f"no slot is called {term}, in '{entry.pattern}'"
            found.append(TmdError(message, location=part.location, hint=hint, code="free-variable"))
        yield from (placed_in(entry, error) for error in found)


def _atom_faults(entry: Declared, atom: Atom, base: Base) -> Iterator[TmdError]:
    """Yield what is wrong with an atom of a row: it must be one of the shared predicates."""
    name, _ = split_predicate(atom.predicate)
    known = [predicate for predicate in base.predicates if predicate.name == name]
    if not known:
        hint = nearest(name, sorted({predicate.name for predicate in base.predicates}), what="shared predicates")
        message = f"there is no shared predicate '{name}', in '{entry.pattern}'"
        yield TmdError(message, location=atom.location, hint=hint, code="unknown-predicate")
    elif all(len(predicate.terms) != len(atom.terms) for predicate in known):
        wanted = " ".join((known[0].name, *known[0].terms))
        message = f"'{name}' is declared as ({wanted}), in '{entry.pattern}'"
        yield TmdError(message, location=atom.location, code="wrong-arity")
