"""Meanings of base lexicons in one domain: shared predicates replaced by those of the domain, and rows that apply.

A base lexicon is written once for many domains. Its rows speak of *shared predicates*, which it declares with the
conditions that may say the same in a domain::

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
from dataclasses import dataclass, field, replace

from tmd.diagnostics import Location, TmdError
from tmd.goals.sources.table import (
    FIRST,
    MARK,
    RELATION,
    WAS,
    GoalRow,
    read_pattern,
    read_row,
    read_row_condition,
    slot_types,
)
from tmd.language.lexicon.lexicon import Base, Declared, Lexicon, SharedPredicate
from tmd.pddl.model import Domain, Formula, hierarchy
from tmd.pddl.reading.checking import check_condition
from tmd.pddl.reading.formulas import read_condition
from tmd.pddl.reading.syntax import Group, Node, Source, Word, nearest, parse, read_text, split_lines
from tmd.pddl.writer import format_formula

_OPERATORS = frozenset({"and", "or", "not", "imply", "=", WAS, FIRST})
_QUANTIFIERS = ("forall", "exists")


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


@dataclass(frozen=True, slots=True)
class SharedMeanings:
    """The meanings that base lexicons add in one domain.

    Attributes:
        rows: The rows that apply, over the predicates of the domain.
        attributes: The adjectives that apply.
        left_out: Everything else, with reasons.
    """

    rows: tuple[GoalRow, ...] = ()
    attributes: Mapping[str, Formula] = field(default_factory=dict)
    left_out: tuple[LeftOut, ...] = ()


def shared_meanings(
    lexicon: Lexicon, domain: Domain, own: Sequence[GoalRow], adjectives: Collection[str]
) -> SharedMeanings:
    """Return what base lexicons add to the meanings that a lexicon declares itself.

    Args:
        lexicon: The lexicon.
        domain: Its domain.
        own: The rows that it declares itself; a row of a base lexicon for the same pattern is left out.
        adjectives: The adjectives that it declares itself.

    Raises:
        TmdError: A base lexicon has a fault, or the lexicon maps a predicate to what the domain does not have.
    """
    for fault in faults_of(lexicon, domain):
        raise fault
    translation = _Translation(lexicon.base, domain)
    rows, added, unused = list(own), [], []
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
        if condition is None or entry.pattern in adjectives:
            unused.append(LeftOut(entry, reason or f"the adjective '{entry.pattern}' is declared already"))
        else:
            meant.setdefault(entry.pattern, condition)
    return SharedMeanings(tuple(added), meant, tuple(unused))


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
        left = slot_types(one.condition, first.variable, domain)
        right = slot_types(other.condition, second.variable, domain)
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
        self._fit: dict[tuple[SharedPredicate, Declared], bool] = {}

    def rows(self, entry: Declared) -> tuple[list[GoalRow], str]:
        """Return a row in the predicates of the domain, or the reason why there is none.

        Where it applies with some prepositions only, there is a row for each of them.
        """
        try:
            return [self._row(entry)], ""
        except TmdError as error:
            reason = error.message
        found = []
        for one in _with_one_preposition(entry):
            try:
                found.append(self._row(one))
            except TmdError:
                continue
        return found, reason

    def adjective(self, entry: Declared) -> tuple[Formula | None, str]:
        """Return the condition of an adjective in the predicates of the domain, or the reason why there is none."""
        try:
            return read_row_condition(self._translated(entry), {"?x"}, self._domain), ""
        except TmdError as error:
            return None, error.message

    def _row(self, entry: Declared) -> GoalRow:
        return read_row(self._translated(entry), self._domain)

    def _translated(self, entry: Declared) -> Declared:
        """Return an entry over the predicates of the domain.

        Raises:
            TmdError: The domain has nothing for one of the shared predicates or types.
        """
        document = parse(entry.condition, "")
        return replace(entry, condition=_text(self._node(document.groups[0])))

    def _node(self, node: Node) -> Node:
        if isinstance(node, Word):
            return node
        if node.head in _OPERATORS:
            return replace(node, parts=(node.parts[0], *(self._node(part) for part in node.parts[1:])))
        if node.head in _QUANTIFIERS:
            typed, *rest = node.parts[1:]
            parts = (node.parts[0], self._typed(typed), *(self._node(part) for part in rest))
            return replace(node, parts=parts)
        return self._shared(node)

    def _with_types(self, node: Node) -> Node:
        """Replace the types of all quantifiers of a condition."""
        if isinstance(node, Word):
            return node
        parts = [self._with_types(part) for part in node.parts]
        if node.head in _QUANTIFIERS and len(parts) > 1:
            parts[1] = self._typed(parts[1])
        return replace(node, parts=tuple(parts))

    def _typed(self, node: Node) -> Node:
        """Replace the types of a list of variables."""
        if isinstance(node, Word):
            return node
        parts = []
        for before, part in zip((None, *node.parts), node.parts, strict=False):
            of_type = isinstance(before, Word) and before.text == "-" and isinstance(part, Word)
            parts.append(replace(part, text=self._type(part.text)) if of_type and isinstance(part, Word) else part)
        return replace(node, parts=tuple(parts))

    def _type(self, name: str) -> str:
        found = self._types.get(name, name)
        if found is None:
            kinds = ", ".join(self._base.types[name])
            raise TmdError(f"this domain has no type for '{name}' ({kinds})")
        return found

    def _shared(self, node: Group) -> Node:
        """Replace an atom over a shared predicate by the first of its conditions that the domain has."""
        arguments = tuple(part.text for part in node.parts[1:] if isinstance(part, Word))
        tried: list[SharedPredicate] = []
        for predicate in self._base.predicates:
            if predicate.name != node.head or not _matches(predicate, arguments):
                continue
            if any(_shadows(other, predicate) for other in tried):
                continue
            for form in predicate.forms:
                if self._has(predicate, form):
                    return self._with_types(_substituted(predicate, form, arguments))
            tried.append(predicate)
        conditions = " | ".join(" ".join(form.condition.split()) for predicate in tried for form in predicate.forms)
        raise TmdError(f"this domain has nothing for ({node.head} {' '.join(arguments)}): {conditions or 'none'}")

    def _has(self, predicate: SharedPredicate, form: Declared) -> bool:
        """Return whether the domain has the predicate of a shared condition, with arguments of its types."""
        if (predicate, form) not in self._fit:
            variables = {term for term in predicate.terms if term.startswith("?")}
            try:
                node = self._with_types(parse(form.condition, "").groups[0])
                formula = read_condition(_present(node), Source("", ()))
                self._fit[predicate, form] = not check_condition(formula, variables, self._domain)
            except TmdError:
                self._fit[predicate, form] = False
        return self._fit[predicate, form]


def _present(node: Node) -> Node:
    """Return a condition without ``was`` and ``first``."""
    if isinstance(node, Word):
        return node
    if node.head in (WAS, FIRST) and len(node.parts) == 2:
        return _present(node.parts[1])
    return replace(node, parts=tuple(_present(part) for part in node.parts))


def _shadows(first: SharedPredicate, second: SharedPredicate) -> bool:
    """Return whether ``first`` is declared for the same arguments in a file nearer to the domain, and replaces it."""
    places = first.location, second.location
    other = places[0] is not None and places[1] is not None and places[0].file != places[1].file
    same = [a if not a.startswith("?") else "?" for a in first.terms] == [
        b if not b.startswith("?") else "?" for b in second.terms
    ]
    return other and same


def _matches(predicate: SharedPredicate, arguments: Sequence[str]) -> bool:
    """Return whether a shared predicate is declared for arguments: names must agree, variables match anything."""
    if len(predicate.terms) != len(arguments):
        return False
    return all(term.startswith("?") or term == said for term, said in zip(predicate.terms, arguments, strict=True))


def _substituted(predicate: SharedPredicate, form: Declared, arguments: Sequence[str]) -> Node:
    """Return a condition with its variables replaced; those that it binds itself get names of their own."""
    given = dict(zip(predicate.terms, arguments, strict=True))

    def changed(node: Node) -> Node:
        if isinstance(node, Group):
            return replace(node, parts=tuple(changed(part) for part in node.parts))
        if node.text.startswith("?"):
            return replace(node, text=given.get(node.text, f"{node.text}_{predicate.name}"))
        return node

    return changed(parse(form.condition, "").groups[0])


def _with_one_preposition(entry: Declared) -> Iterator[Declared]:
    """Yield a row for each preposition that ``?rel`` may be in it."""
    words = entry.pattern.split()
    for place, word in enumerate(words):
        names = word.split("|")
        if place > 0 and word.islower() and len(names) > 1 and RELATION in entry.condition:
            for name in names:
                pattern = " ".join((*words[:place], name, *words[place + 1 :]))
                yield replace(entry, pattern=pattern, condition=entry.condition.replace(RELATION, name))


def _text(node: Node) -> str:
    if isinstance(node, Word):
        return node.text
    return f"({' '.join(_text(part) for part in node.parts)})"


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
    return found


def _of(place: Location | None, lexicon: Lexicon) -> bool:
    return place is not None and place.file == lexicon.source


def _predicate_faults(
    predicate: SharedPredicate, lexicon: Lexicon, domain: Domain | None, names: Sequence[str]
) -> Iterator[TmdError]:
    """Yield what is wrong with a shared predicate.

    In a domain those of its own lexicon must be of an included one, and their conditions of the domain.
    """
    if domain is not None and _of(predicate.location, lexicon):
        if predicate.name not in names:
            hint = nearest(predicate.name, sorted(set(names)), what="shared predicates")
            message = f"no base lexicon that is included has a predicate '{predicate.name}'"
            yield _fault(message, predicate.location, hint, "unknown-predicate")
        for form in predicate.forms:
            yield from _syntax_faults(form) or _domain_faults(predicate, form, domain)
        return
    for form in predicate.forms:
        yield from _syntax_faults(form)


def _domain_faults(predicate: SharedPredicate, form: Declared, domain: Domain) -> list[TmdError]:
    """Return what a condition that a lexicon gives for a shared predicate says that its domain does not have."""
    document = parse(form.condition, "")
    formula = read_condition(_present(document.groups[0]), document.source)
    variables = {term for term in predicate.terms if term.startswith("?")}
    found = check_condition(formula, variables, domain, document.source)
    return [_fault(error.message, _within(form, error.location), error.hint, error.code) for error in found]


def _type_faults(lexicon: Lexicon, domain: Domain) -> Iterator[TmdError]:
    """Yield the types that a lexicon itself gives for one of the shared rows, and that its domain does not have."""
    kinds = hierarchy(domain)
    for name, meant in lexicon.base.types.items():
        place = lexicon.places.get(("types", name))
        if _of(place, lexicon) and not any(kinds.known(kind) for kind in meant):
            hint = nearest(meant[0], sorted(kinds.parents), what="types") if meant else None
            yield _fault(f"the domain has no type '{', '.join(meant)}'", place, hint, "unknown-type")


def _syntax_faults(entry: Declared) -> list[TmdError]:
    """Return what keeps a condition from being one, whatever the domain."""
    try:
        document = parse(entry.condition, "")
        if len(document.groups) == 1:
            read_condition(_present(document.groups[0]), document.source)
            return []
        hint = "write (and (…) (…)) for several"
        return [_fault("a goal is one condition", entry.location, hint, "bad-goal")]
    except TmdError as error:
        return [_fault(error.message, _within(entry, error.location), error.hint, error.code)]


def _entry_faults(entry: Declared, base: Base, *, is_row: bool) -> Iterator[TmdError]:
    """Yield what is wrong with a row or an adjective of a base lexicon, whatever the domain."""
    try:
        free = _slots(entry) if is_row else frozenset({"?x"})
    except TmdError as error:
        yield _fault(error.message, error.location, error.hint, error.code)
        return
    told = _syntax_faults(entry)
    if told:
        yield from told
        return
    for node, bound in _atoms(parse(entry.condition, "").groups[0], free):
        arguments = [part.text for part in node.parts[1:] if isinstance(part, Word)]
        place = _within(entry, node.location)
        if node.head != "=":
            yield from _atom_faults(entry, node.head, arguments, place, base)
        for term in arguments:
            if term.startswith("?") and term not in bound:
                hint = f"the slots here: {', '.join(sorted(bound)) or 'none'}"
                yield _fault(f"no slot is called {term}, in '{entry.pattern}'", place, hint, "free-variable")


def _slots(entry: Declared) -> frozenset[str]:
    """Return the variables that the pattern of a row binds.

    Raises:
        TmdError: It is not a pattern.
    """
    slots = read_pattern(entry)[2]
    related = {RELATION} if any(slot.prepositions for slot in slots) else set()
    return frozenset({*(slot.variable for slot in slots), *related})


def _atom_faults(
    entry: Declared, name: str, arguments: Sequence[str], place: Location | None, base: Base
) -> Iterator[TmdError]:
    """Yield what is wrong with an atom of a row: it must be one of the shared predicates."""
    known = [predicate for predicate in base.predicates if predicate.name == name]
    if not known:
        hint = nearest(name, sorted({predicate.name for predicate in base.predicates}), what="shared predicates")
        message = f"there is no shared predicate '{name}', in '{entry.pattern}'"
        yield _fault(message, place, hint, "unknown-predicate")
    elif all(len(predicate.terms) != len(arguments) for predicate in known):
        wanted = " ".join((known[0].name, *known[0].terms))
        yield _fault(f"'{name}' is declared as ({wanted}), in '{entry.pattern}'", place, None, "wrong-arity")


def _atoms(node: Node, bound: frozenset[str]) -> Iterator[tuple[Group, frozenset[str]]]:
    """Yield the atoms of a condition, each with the variables that are bound there."""
    if isinstance(node, Word):
        return
    if node.head in _QUANTIFIERS:
        typed = node.parts[1] if len(node.parts) > 1 else None
        words = typed.parts if isinstance(typed, Group) else ()
        inner = bound | {word.text for word in words if isinstance(word, Word) and word.text.startswith("?")}
        for part in node.parts[2:]:
            yield from _atoms(part, inner)
    elif node.head in _OPERATORS and node.head != "=":
        for part in node.parts[1:]:
            yield from _atoms(part, bound)
    else:
        yield node, bound


def _within(entry: Declared, place: Location | None) -> Location | None:
    """Return the place of a part of a condition; where YAML folded its lines, that of the condition."""
    begin = entry.location
    if begin is None or place is None or place.line > 1:
        return begin
    return replace(begin, column=begin.column + place.column - 1)


def _fault(message: str, place: Location | None, hint: str | None, code: str) -> TmdError:
    source = None
    if place is not None:
        lines = split_lines(read_text(place.file))
        source = lines[place.line - 1] if place.line <= len(lines) else None
    return TmdError(message, location=place, hint=hint, source=source, code=code or "bad-goal")
