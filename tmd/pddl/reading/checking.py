"""Checks of the meaning of a domain or problem: every fault at once, each with its place and a hint.

Found are names that are declared twice or not at all, wrong numbers and types of arguments, free variables, and
features that are used without their requirement. :mod:`tmd.pddl.reading.reader` checks the syntax.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice, takewhile

from tmd.diagnostics import Edit, Location, TmdError
from tmd.pddl.derived import strata
from tmd.pddl.model import (
    MOST_LEVELS,
    OBJECT,
    TOTAL_COST,
    TRUE,
    ActionSchema,
    Atom,
    Axiom,
    Domain,
    Effect,
    Equals,
    Exists,
    Forall,
    Formula,
    Imply,
    Not,
    Or,
    Predicate,
    Problem,
    TypeDeclaration,
    TypedName,
    TypeHierarchy,
    keyword,
    parts_of,
    walk,
)
from tmd.pddl.reading.formulas import BARE
from tmd.pddl.reading.missing_types import apart, narrowest, typed, types_needed
from tmd.pddl.reading.syntax import NO_BLANKS, Source, Word, nearest, shifted

# Of a declaration that a hint proposes.
_LONGEST_HINT = 150

MOST_FAULTS = 250
"""Number of faults after which the rest of a problem is not checked: their places and hints take time."""


def check_domain(domain: Domain, source: Source | None = None) -> list[TmdError]:
    """Return every fault of ``domain``, in order of appearance; empty where there is none.

    The faults carry their source lines where ``source``, the text that was read, is given.
    """
    check = _Check(domain, domain.constants, source)
    check.declarations()
    check.axioms()
    for action in domain.actions:
        check.action(action)
    check.types_missing()
    check.predicates_missing()
    check.faults.extend(missing_requirements(domain, None, check.source))
    return _in_order(check.faults, source)


def check_problem(problem: Problem, source: Source | None = None) -> list[TmdError]:
    """Return the faults of ``problem`` itself (its domain is taken as checked), as :func:`check_domain` lists them.

    Of a hopeless problem they are the first ones only, some :data:`MOST_FAULTS`.
    """
    check = _Check(problem.domain, problem.all_objects(), source)
    check.objects(problem)
    for atom in sorted(problem.init | problem.init_denied):
        if len(check.faults) > MOST_FAULTS:
            break
        place = problem.init_locations.get(atom)
        check.atom(Atom(atom.predicate, atom.args, place), {}, check.predicates, "predicate")
        if atom in problem.init and place is not None:
            check.underived(Atom(atom.predicate, atom.args, place), "at the start")
    check.values(problem)
    check.formula(problem.goal, {})
    check.types_of_objects_missing()
    check.predicates_of_problem_missing()
    check.faults.extend(missing_requirements(problem.domain, problem, check.source))
    return _in_order(check.faults, source)


def check_condition(
    condition: Formula, variables: Iterable[str], domain: Domain, source: Source | None = None
) -> list[TmdError]:
    """Return every fault of a condition over ``variables``, which may be of any type.

    An argument of a wider type than the predicate takes is accepted: the condition may hold of some of its objects.
    """
    check = _Overlapping(domain, domain.constants, source)
    check.formula(condition, dict.fromkeys(variables, ()))
    return _in_order(check.faults, source)


def _in_order(faults: list[TmdError], source: Source | None) -> list[TmdError]:
    """Sort faults by place; those without one come last, as they were found."""
    for fault in faults:
        fault.source = source.line(fault.location) if source else None
    placed = sorted((f for f in faults if f.location), key=lambda f: f.location or Location("", 0, 0))
    return placed + [f for f in faults if not f.location]


class _Check:
    """Names in scope, and the faults found so far."""

    def __init__(self, domain: Domain, objects: Sequence[TypedName], source: Source | None = None) -> None:
        self.domain = domain
        self.source = source or Source("", ())
        self.hierarchy = TypeHierarchy(domain.types)
        self.predicates = {p.name: p for p in domain.predicates}
        self.functions = {f.name: f for f in domain.functions}
        self.derived = {axiom.head.predicate for axiom in domain.derived}
        self.declared = objects
        self.known_objects: dict[str, tuple[str, ...] | None] = {}
        for o in objects:  # of one that is declared twice, the type is not known
            clear = len(o.types) == 1 and self.known_objects.get(o.name, o.types) == o.types
            self.known_objects[o.name] = o.types if clear else None
        self.ambiguous = {p.name for p in domain.predicates if self.predicates[p.name] != p}
        """The predicates that are declared twice, with different parameters."""
        self.of_problem: Problem | None = None
        self.faults: list[TmdError] = []
        self.cyclic: set[str] = set()
        self.two_of_one_name = False
        self.action_checked: ActionSchema | None = None
        self.first: dict[object, tuple[TmdError, str, int]] = {}
        """The first fault of each name, its message, and the number of times that it stands elsewhere."""
        self.used: dict[str, tuple[str, Location | None]] = {}
        """Predicates where the domain declares none at all, as they should be declared, and their places."""
        self.unbound: dict[str, tuple[tuple[str, ...], Location | None]] = {}
        """The variables of the action without parameters that is checked, with the types that they should have."""
        self.undeclared: dict[str, Location | None] = {}
        """Types where the domain declares none at all."""
        self.deepest_type: str | None = None
        """The first type with too many ancestors, which is reported once."""

    def fault(
        self,
        message: str,
        location: Location | None,
        hint: str | None,
        code: str,
        edits: Sequence[Edit] = (),
        slip: object = None,
    ) -> None:
        """Add a fault at ``location``; others of the same ``slip`` are counted with it (:meth:`again`)."""
        found = TmdError(message, location=location, hint=hint, code=code, edits=edits)
        self.faults.append(found)
        if slip is not None:
            self.first[slip] = found, message, 0

    def again(self, slip: object, location: Location | None, edits: Sequence[Edit] = ()) -> bool:
        """Return whether this slip has been reported, and count it."""
        if slip not in self.first:
            return False
        found, message, times = self.first[slip]
        if location and found.location and location < found.location:
            found.location = location
        found.edits += tuple(edits)
        self.first[slip] = found, message, times + 1
        found.message = f"{message} (and {times + 1} more time{'s' if times else ''})"
        return True

    def declarations(self) -> None:
        """Check types, constants, predicates and functions."""
        domain = self.domain
        for what in ("type", "predicate", "function", "action", "constant"):
            self.unique(getattr(domain, f"{what}s"), what)
        for declared in domain.types:
            self.type_known(declared.parent, declared.location)
            self.no_cycle(declared.name, declared.location)
        for constant in domain.constants:
            self.one_type(constant, "constant")
        for signature in (*domain.predicates, *domain.functions):
            self.parameters(signature.parameters, {})
        for signature in domain.functions:
            if signature.name == TOTAL_COST and signature.parameters:
                self.fault(
                    f"{TOTAL_COST} has no parameters", signature.location, f"write ({TOTAL_COST})", "wrong-arity"
                )

    def unique(self, declared: Iterable[TypeDeclaration | TypedName | Predicate | ActionSchema], what: str) -> None:
        seen: dict[str, TypeDeclaration | TypedName | Predicate | ActionSchema] = {}
        for item in declared:
            if item.name in seen:
                message, same = f'{what} "{item.name}" is declared twice', item == seen[item.name]
                hint = "remove one of them" if same else "rename one of them"
                end = self.end(item) if same else None
                edits = (
                    [self.source.removal(item.location, end)] if item.location and end and self.source.line(end) else []
                )
                self.fault(message, item.location, hint, "duplicate-name", edits)
            seen.setdefault(item.name, item)

    def end(self, item: TypeDeclaration | TypedName | Predicate | ActionSchema) -> Location | None:
        """Return the place behind a declaration that begins with itself: a name in a list, or a predicate."""
        if isinstance(item, TypedName) and item.location is not None:
            return shifted(item.location, len(item.name))
        depth = 0
        for token, place in self.source.tokens(item.location) if isinstance(item, Predicate) else ():
            depth += {"(": 1, ")": -1}.get(token, 0)
            if not depth:
                return shifted(place, 1)
        return None

    def type_known(self, name: str, location: Location | None) -> None:
        """Check that a type is declared; ``location`` is that of the name with this type."""
        if self.hierarchy.known(name):
            return
        place = self.source.type_of(location, name)
        if not self.domain.types:
            self.undeclared.setdefault(name, place)
        elif not self.again(("type", name), place):
            names = [OBJECT, *self.hierarchy.parents]
            hint, edits = nearest(name, names, what="types"), []
            if not (hint and hint.startswith("did")):
                hint = _or_cure(hint, f'add "{name}" to (:types ...) of the domain')
                edits = [] if self.of_problem else [self.source.declaration(":types", name)]
            self.fault(f'unknown type "{name}"', place, hint, "unknown-type", edits, slip=("type", name))

    def types_missing(self) -> None:
        """Report that the domain uses types and declares none."""
        if self.undeclared:
            names = " ".join(self.undeclared)
            place = min(filter(None, self.undeclared.values()), default=None)
            hint, edits = f"add (:types {names})", [self.source.declaration(":types", names)]
            self.fault(f"the domain has no (:types ...) for {names}", place, hint, "missing-section", edits)

    def predicates_missing(self) -> None:
        """Report that the domain uses predicates and declares none."""
        if self.used:
            declared, place = " ".join(shown for shown, _ in self.used.values()), next(iter(self.used.values()))[1]
            shown = declared if len(declared) < _LONGEST_HINT else f"{declared[:_LONGEST_HINT]}..."
            edits = [self.source.declaration(":predicates", declared)]
            message = f"the domain has no (:predicates ...) for {', '.join(self.used)}"
            self.fault(message, place, f"add (:predicates {shown})", "missing-section", edits)

    def predicates_of_problem_missing(self) -> None:
        """Report that the problem uses predicates, and its domain neither declares nor uses any."""
        used_there = any(isinstance(part, Atom) for part in walk((self.domain.actions, self.domain.derived)))
        if self.used and not used_there:
            names, place = (
                ", ".join(self.used),
                min(filter(None, (place for _, place in self.used.values())), default=None),
            )
            message = f"the domain has no (:predicates ...), and its problem uses {names}"
            self.fault(message, place, "declare them in the domain", "unknown-predicate")

    def types_of_objects_missing(self) -> None:
        """Report that the problem uses types, and neither its domain nor the predicates in it do."""
        typed = _Check(self.domain, self.domain.constants)
        typed.declarations()
        names = [name for name in self.undeclared if name not in typed.undeclared]
        if names and not typed.undeclared:
            message = f"the domain has no (:types ...), and its problem uses {', '.join(names)}"
            hint = f"add (:types {' '.join(names)}) to the domain, or leave the types out here"
            self.fault(message, self.undeclared[names[0]], hint, "unknown-type")

    def no_cycle(self, name: str, location: Location | None) -> None:
        chain = self.hierarchy.ancestors(name)
        *cycle, _ = chain
        if cycle and self.hierarchy.parents.get(cycle[-1]) == name:
            if name not in self.cyclic:
                self.cyclic.update(cycle)
                self.cycle(name, cycle, location)
        elif len(chain) >= MOST_LEVELS and self.deepest_type is None:
            self.deepest_type = name
            message = f'the type "{name}" has {MOST_LEVELS} ancestors or more'
            self.fault(message, location, "declare fewer levels of types", "nested-too-deeply")

    def cycle(self, name: str, cycle: Sequence[str], location: Location | None) -> None:
        """Report a type that is its own ancestor.

        Where it is its own parent, it stands in the list that "- type" ends, perhaps lines below.
        """
        dash = self.dash(location)
        listed = [t for t in self.domain.types if t.parent == name and self.dash(t.location) == dash]
        if len(cycle) > 1 or location is None or dash is None:
            hint = f"{' < '.join((*cycle, name))}: give one of them another parent"
            self.fault(f'type "{name}" is its own ancestor', location, hint, "type-cycle")
        elif len(listed) == 1:
            message, hint = f'type "{name}" is its own parent', f"write {name} - {OBJECT}"
            parent = self.source.type_of(location, name) or location
            self.fault(message, location, hint, "type-cycle", [Edit(parent, shifted(parent, len(name)), OBJECT)])
        else:
            names = ", ".join(t.name for t in listed)
            message = f'"- {name}" in line {dash.line} is the parent of {names}, so of "{name}" itself'
            hint = f'end the types that are not of "{name}" with "- {OBJECT}", and "{name}" too'
            self.fault(
                message, location, hint, "type-cycle", list(apart(self.domain, name, location, listed, self.source))
            )

    def dash(self, location: Location | None) -> Location | None:
        """Return the place of the next dash in the list in which a typed name stands."""
        return next((place for token, place in self.source.tokens(location) if token in ("-", ")")), None)

    def one_type(self, declared: TypedName, what: str) -> None:
        for name in declared.types:
            self.type_known(name, declared.location)
        if len(declared.types) > 1:
            self.fault(
                f'{what} "{declared.name}" must have one type, "either" belongs to parameters',
                declared.location,
                "declare a common parent type",
                "not-supported",
            )

    def parameters(
        self, parameters: Sequence[TypedName], scope: Mapping[str, tuple[str, ...]]
    ) -> dict[str, tuple[str, ...]]:
        """Check ``parameters``, and return ``scope`` extended by them."""
        inner = dict(scope)
        for parameter in parameters:
            for name in parameter.types:
                self.type_known(name, parameter.location)
            if parameter.name in inner:
                message = f'variable "{parameter.name}" is declared twice'
                self.fault(message, parameter.location, "rename one of them", "duplicate-name")
            inner[parameter.name] = parameter.types if parameter.name not in inner else ()
        return inner

    def action(self, action: ActionSchema) -> None:
        scope = self.parameters(action.parameters, {})
        self.unbound.clear()
        self.two_of_one_name = len(scope) < len(action.parameters)
        self.action_checked = action
        self.formula(action.precondition, scope)
        for effect in action.effects:
            self.effect(effect, scope)
        if isinstance(action.cost, Atom):
            self.atom(action.cost, scope, self.functions, "function")
        if action.cost is not None and TOTAL_COST not in self.functions:
            place = action.cost.location if isinstance(action.cost, Atom) else action.location
            hint = f"declare (:functions ({TOTAL_COST}) - number)"
            if not self.again(TOTAL_COST, place):
                edits = [self.source.declaration(":functions", f"({TOTAL_COST}) - number")]
                self.fault(f'unknown function "{TOTAL_COST}"', place, hint, "unknown-function", edits, TOTAL_COST)

        self.parameters_missing(action)

    def parameters_missing(self, action: ActionSchema) -> None:
        """Report the variables of an action without any parameters."""
        if not self.unbound:
            return
        typed = " ".join(TypedName(name, kinds).typed() for name, (kinds, _) in self.unbound.items())
        place = min(filter(None, (place for _, place in self.unbound.values())), default=action.location)
        edits: list[Edit] = []
        if action.location is not None:
            end = shifted(action.location, len(action.name))
            behind = list(islice(self.source.tokens(end), 3))
            if [token.lower() for token, _ in behind] == [":parameters", "(", ")"]:
                edits = [Edit(behind[2][1], behind[2][1], typed)]
            elif len(behind) > 1 and behind[0][0].lower() == ":parameters" and behind[1][0] != "(":
                end = shifted(behind[0][1], len(":parameters"))
                edits = [Edit(end, end, f" ({typed})")]
            elif behind and behind[0][0].lower() != ":parameters":
                edits = [Edit(end, end, f" :parameters ({typed})")]
        message = f'action "{action.name}" has no parameters for {", ".join(self.unbound)}'
        self.fault(message, place, f"write :parameters ({typed})", "free-variable", edits)

    def effect(self, effect: Effect, scope: Mapping[str, tuple[str, ...]]) -> None:
        inner = self.parameters(effect.parameters, scope)
        self.formula(effect.condition, inner)
        self.atom(effect.atom, inner, self.predicates, "predicate")
        self.underived(effect.atom, "by an effect")

    def axioms(self) -> None:
        """Check the axioms, and that nothing follows from its own negation."""
        for axiom in self.domain.derived:
            scope = self.parameters(axiom.parameters, {})
            self.atom(axiom.head, scope, self.predicates, "predicate")
            self.formula(axiom.condition, scope)
        if strata(self.domain.derived) is None:
            first = self.domain.derived[0]
            message = f'"{first.head.predicate}" or another derived predicate follows from its own negation'
            hint = "what a condition negates must be derived without what it helps to derive"
            self.fault(message, first.location, hint, "wrongly-derived")

    def underived(self, atom: Atom, when: str) -> None:
        """Check that an atom that is made true or false is not derived."""
        if atom.predicate in self.derived:
            message, slip = (
                f'"{atom.predicate}" is derived, so it cannot be made true or false {when}',
                ("derived", atom.predicate),
            )
            hint = "remove this, or the (:derived ...) of the predicate"
            if not self.again(slip, atom.location):
                self.fault(message, atom.location, hint, "wrongly-derived", slip=slip)

    def formula(self, formula: Formula, scope: Mapping[str, tuple[str, ...]]) -> None:
        if isinstance(formula, Atom):
            self.atom(formula, scope, self.predicates, "predicate")
        elif isinstance(formula, Equals):
            for number, term in enumerate((formula.left, formula.right), start=1):
                self.term(term, scope, formula.location, number)
        else:
            inner = self.parameters(formula.parameters, scope) if isinstance(formula, Forall | Exists) else scope
            for part in parts_of(formula):
                self.formula(part, inner)

    def atom(
        self, atom: Atom, scope: Mapping[str, tuple[str, ...]], signatures: Mapping[str, Predicate], what: str
    ) -> None:
        """Check predicate or function, number of arguments, and the type of each."""
        signature = signatures.get(atom.predicate)
        if signature is None:
            self.unknown(atom, scope, list(signatures), what)
            return
        if atom.predicate in self.ambiguous:
            return
        shown = f"({' '.join((signature.name, *(p.name for p in signature.parameters)))})"
        if len(atom.terms) != len(signature.parameters):
            slip = "arity", atom.predicate, len(atom.terms)
            message = f"takes {len(signature.parameters)} argument(s), found {len(atom.terms)}"
            if not self.again(slip, atom.location):
                message = f'{what} "{atom.predicate}" {message}'
                self.fault(message, atom.location, f"declared as {shown}", "wrong-arity", slip=slip)
            return
        types = [
            self.term(term, scope, atom.location, number, signature.parameters[number - 1].types)
            for number, term in enumerate(atom.terms, start=1)
        ]
        wrong = [n for n, given in enumerate(types) if not self.may_fit(signature.parameters[n], given)]
        swapped = self.swapped(signature, types, wrong)
        if swapped:
            one, other = swapped
            terms = list(atom.terms)
            terms[one], terms[other] = terms[other], terms[one]
            message = f'the arguments "{atom.terms[one]}" and "{atom.terms[other]}" of {shown} are swapped'
            hint = f"write ({' '.join((atom.predicate, *terms))})"
            self.fault(message, self.source.word(atom.location, one + 1), hint, "wrong-type")
            return
        for number in wrong:
            term, parameter, given = atom.terms[number], signature.parameters[number], types[number] or ()
            place = self.source.word(atom.location, number + 1)
            misfit = "wrong", term, given, parameter.types, self.action_checked
            needed = f"{parameter.name} of {shown} needs {_either(parameter.types)}"
            if not self.again(misfit, place):
                message = f'"{term}" is of type {_either(given)}, {needed}'
                self.fault(message, place, self.typed_far_below(term), "wrong-type", slip=misfit)

    def unknown(self, atom: Atom, scope: Mapping[str, tuple[str, ...]], known: Sequence[str], what: str) -> None:
        """Report an undeclared predicate or function, and check its arguments."""
        if self.with_blank(atom, known, what):
            return
        types = [self.term(term, scope, atom.location, number) for number, term in enumerate(atom.terms, start=1)]
        place, slip = self.source.word(atom.location, 0), (what, atom.predicate)
        if self.again(slip, place):
            return
        if atom.predicate in ("true", "nil"):
            edits = [Edit(place, shifted(place, len(atom.predicate)), "and")] if place and not atom.terms else []
            self.fault(f'"({atom.predicate})" is not PDDL', place, "write (and)", "other-notation", edits, slip)
            return
        names = (term if term.startswith("?") else f"?x{number}" for number, term in enumerate(atom.terms, start=1))
        typed_names = (TypedName(name, given or ()).typed() for name, given in zip(names, types, strict=True))
        declared = f"({' '.join((atom.predicate, *typed_names))})"
        if what == "predicate" and not self.domain.predicates and ":predicates" not in self.source.sections:
            self.used.setdefault(atom.predicate, (declared, place))
            return
        hint = _or_cure(nearest(atom.predicate, known, what=f"{what}s"), f"declare {declared} under (:{what}s ...)")
        hint = self.of_action(atom.predicate) or hint
        self.fault(f'unknown {what} "{atom.predicate}"', place, hint, f"unknown-{what}", slip=slip)

    def with_blank(self, atom: Atom, known: Sequence[str], what: str) -> bool:
        """Return whether the name of an atom has a blank, which is reported."""
        joined = f"{atom.predicate}-{atom.terms[0]}" if atom.terms else ""
        if joined not in known:
            return False
        start, end = (self.source.word(atom.location, number) for number in (0, 1))
        edits = [Edit(shifted(start, len(atom.predicate)), end, "-")] if start and end else []
        message = NO_BLANKS.format(joined)
        if message in self.source.once:
            self.source.once[message].edits += tuple(edits)
        elif not self.again((what, joined), start, edits):
            self.fault(message, start, f"write {joined}", "bad-name", edits, (what, joined))
        return True

    def of_action(self, name: str) -> str | None:
        """Return the hint for an action that stands where a predicate should."""
        action = next((a for a in self.domain.actions if a.name == name), None)
        if action is None:
            return None
        made = next((f", such as ({e.atom.predicate} ...)" for e in action.effects if e.positive), "")
        return f"this is an action: write what holds after it{made}"

    def typed_far_below(self, name: str) -> str | None:
        """Return a hint where the type of an object stands in a line below it: that of a list which it ends."""
        declared = next((o for o in self.declared if o.name == name), None)
        place = declared.location if declared else None
        dash = self.dash(place)
        if declared is None or place is None or dash is None or dash.line == place.line:
            return None
        kind = declared.types[0]
        return f'"- {kind}" in line {dash.line} is the type of all names above it: give line {place.line} its own'

    def may_fit(self, parameter: TypedName, given: Sequence[str] | None) -> bool:
        """Return whether a term of the types ``given`` fits ``parameter``; unknown types are reported elsewhere."""
        above = self.hierarchy.ancestors
        named = (*(given or ()), *parameter.types)
        known = given is not None and all(self.hierarchy.known(a) for t in named for a in above(t))
        return given is None or not known or self.fits(parameter.types, given)

    def swapped(
        self, signature: Predicate, types: Sequence[Sequence[str] | None], wrong: Sequence[int]
    ) -> tuple[int, int] | None:
        """Return the two places that must change their arguments for all of them to fit, one of ``wrong`` first."""
        if not wrong or None in types:
            return None
        for one in wrong:
            for other in range(len(types)):
                changed = list(types)
                changed[one], changed[other] = changed[other], changed[one]
                if other != one and all(map(self.may_fit, signature.parameters, changed)):
                    return min(one, other), max(one, other)
        return None

    def fits(self, wanted: Sequence[str], given: Sequence[str]) -> bool:
        """Return whether an argument of the types ``given`` may stand where ``wanted`` is asked for."""
        return self.hierarchy.accepts(wanted, given)

    def term(
        self,
        term: str,
        scope: Mapping[str, tuple[str, ...]],
        location: Location | None,
        number: int,
        wanted: Sequence[str] = (),
    ) -> tuple[str, ...] | None:
        """Return the types of ``term``, the word ``number`` of a group; ``None`` where it is not declared (a fault).

        ``wanted`` are the types that it should have.
        """
        if term.startswith("?"):
            if term not in scope and not self.two_of_one_name:  # else it is what one of the two should be called
                self.free(term, scope, self.source.word(location, number), wanted)
            return scope.get(term)
        if term in self.known_objects:
            return self.known_objects[term]
        place, variable = self.source.word(location, number), f"?{term}"
        slip = "object", term, variable in scope and self.action_checked
        edits = [Edit(place, place, "?")] if place and variable in scope else []
        if place and edits and BARE in self.source.once:
            self.source.fault_once(BARE, place, None, "bad-name", edits)
            return scope[variable]
        if not self.again(slip, place, edits):
            hint = nearest(term, list(self.known_objects), what="objects")
            if variable in scope:
                hint = f'did you mean "{variable}"?'
            else:
                where = ":objects" if self.of_problem else ":constants"
                hidden = self.source.hidden(where, term)
                cure = f'declare "{TypedName(term, tuple(wanted)).typed()}" under ({where} ...)'
                hint = (
                    _or_cure(hint, cure) if hidden is None else f'";" in line {hidden} begins a comment, and hides it'
                )
            self.fault(f'unknown object "{term}"', place, hint, "unknown-object", edits, slip)
        return None

    def free(
        self, term: str, scope: Mapping[str, tuple[str, ...]], place: Location | None, wanted: Sequence[str]
    ) -> None:
        """Report a variable that nothing binds."""
        slip = "variable", term, self.action_checked
        if self.again(slip, place):
            return
        hint = nearest(term, list(scope), what="variables here")
        bound = _bound_in(self.action_checked, term)
        if bound is not None:
            hint = f"it is bound only in {bound}: make it a parameter"
        elif self.action_checked and not self.action_checked.parameters and not scope:
            if not self.unbound.get(term, ((), None))[0]:
                self.unbound[term] = tuple(wanted), place
            return
        elif self.of_problem:
            hint = f"bind it: (exists ({TypedName(term, tuple(wanted)).typed()}) ...), or name an object"
        elif self.action_checked:
            hint = _or_cure(hint, f"add {TypedName(term, tuple(wanted)).typed()} to :parameters")
        self.fault(f'free variable "{term}"', place, hint, "free-variable", slip=slip)

    def objects(self, problem: Problem) -> None:
        """Check the problem's objects. A constant may be listed again with the same type."""
        self.of_problem = problem
        self.unique(problem.objects, "object")
        if self.types_first(problem):
            return
        self.untyped(problem)
        constants = {c.name: c.types for c in problem.domain.constants}
        for declared in problem.objects:
            self.one_type(declared, "object")
            if constants.get(declared.name, declared.types) != declared.types:
                message = f'"{declared.name}" is a constant of another type'
                self.fault(message, declared.location, "remove it here, or rename the object", "duplicate-name")
                self.known_objects[declared.name] = None

    def types_first(self, problem: Problem) -> bool:
        """Return whether types stand before their objects, ``cart - k1 k2``, which is reported."""
        turned = [o for o in problem.objects if self.hierarchy.known(o.name) and not self.hierarchy.known(o.types[0])]
        if not turned or self.domain.name == "" or not self.domain.types:
            return False
        names = {word.text for word in self.source.sections[":objects"].parts if isinstance(word, Word)}
        self.known_objects.update(dict.fromkeys(names))
        message = "the type stands behind the names of its objects"
        self.fault(message, turned[0].location, f"write {turned[0].types[0]} - {turned[0].name}", "unknown-type")
        return True

    def untyped(self, problem: Problem) -> None:
        """Report several objects that have no type and need one, with the types that their uses tell."""
        plain = [o for o in problem.objects if o.types == (OBJECT,) and o.location is not None]
        needed = types_needed(problem) if plain else {}
        wrong = [o for o in plain if needed.get(o.name)]
        if len(wrong) < 2:
            return
        kinds = {o.name: narrowest(needed[o.name], self.hierarchy) for o in wrong}
        names = ", ".join(o.name for o in wrong[:8]) + (f" and {len(wrong) - 8} more" if len(wrong) > 8 else "")
        run = list(takewhile(lambda o: kinds[o.name] == kinds[wrong[0].name], wrong[:8]))
        hint = f"write {' '.join(o.name for o in run)} - {kinds[wrong[0].name] or 'type'}"
        message = f"these objects have no type, and need one: {names}"
        edits = list(typed(plain, kinds)) if all(kinds.values()) else []
        self.fault(message, wrong[0].location, hint, "wrong-type", edits)
        self.known_objects.update(dict.fromkeys((o.name for o in wrong), None))

    def values(self, problem: Problem) -> None:
        """Check the values of cost functions, and that there is a cost to minimise."""
        for function in sorted(problem.function_values):
            place = problem.init_locations.get(function)
            self.atom(Atom(function.predicate, function.args, place), {}, self.functions, "function")
        if problem.minimize_cost and TOTAL_COST not in self.functions:
            message = f'the metric needs the function "{TOTAL_COST}"'
            place = problem.metric_location or problem.location
            hint = f"declare (:functions ({TOTAL_COST}) - number) in the domain"
            self.fault(message, place, hint, "unknown-function")


class _Overlapping(_Check):
    """A check in which an argument fits a parameter if their types overlap."""

    def fits(self, wanted: Sequence[str], given: Sequence[str]) -> bool:
        above = self.hierarchy.ancestors
        return not given or any(w in above(g) or g in above(w) for w in wanted for g in given)


def _or_cure(hint: str | None, cure: str) -> str:
    """Return the hint where it knows what was meant; otherwise the cure first."""
    return hint if hint and hint.startswith("did") else "; ".join(filter(None, (cure, hint)))


def _bound_in(action: ActionSchema | None, variable: str) -> str | None:
    """Return the quantifier of ``action`` that binds a variable, such as "the exists of line 6"."""
    for part in walk((action.precondition, action.effects)) if action else ():
        quantified = part.parameters if isinstance(part, Forall | Exists | Effect) else ()
        for parameter in quantified:
            if parameter.name == variable and parameter.location:
                word = keyword(part) if isinstance(part, Forall | Exists) else "forall"
                return f"the {word} of line {parameter.location.line}"
    return None


def _either(types: Sequence[str]) -> str:
    return f'"{types[0]}"' if len(types) == 1 else f"either {' '.join(types)}"


_QUANTIFIED = (":existential-preconditions", ":universal-preconditions")
_IMPLIED = {
    ":domain-axioms": (":derived-predicates",),
    ":fluents": (":action-costs",),
    ":numeric-fluents": (":action-costs",),
    ":quantified-preconditions": _QUANTIFIED,
    ":adl": (
        ":typing",
        ":negative-preconditions",
        ":disjunctive-preconditions",
        ":equality",
        ":quantified-preconditions",
        ":conditional-effects",
        *_QUANTIFIED,
    ),
}

# Needs :negative-preconditions to the letter. Most domains do without, so its lack is not a fault; we write it.
_OTHER_NOT = '"not" around something else than an atom'

# A requirement, the feature that needs it, and where that stands.
_Use = tuple[str, str, Location | None]


def missing_requirements(domain: Domain, problem: Problem | None, source: Source) -> list[TmdError]:
    """Return a fault for each requirement that is used and not declared, at its first use.

    Without ``problem`` the domain is checked; with it, the problem, which inherits the requirements of its domain.
    Those that the domain lacks itself are not repeated.
    """
    of_the_domain = {name for name, _, _ in _undeclared(domain, None)} if problem else set[str]()
    missing = [use for use in _undeclared(domain, problem) if use[0] not in of_the_domain]
    names = sorted({name for name, _, _ in missing})
    strips = () if problem or ":requirements" in source.sections else (":strips",)
    edits = [source.declaration(":requirements", " ".join((*strips, *names)))]  # all of them, with each fault
    return [
        TmdError(
            f"{feature} needs {name}",
            location=place,
            hint=f"add {name} to (:requirements ...)",
            code="missing-requirement",
            edits=edits,
        )
        for name, feature, place in missing
    ]


def undeclared_requirements(problem: Problem) -> tuple[str, ...]:
    """Return the requirements that ``problem`` uses and neither it nor its domain declares."""
    return tuple(name for name, _, _ in _undeclared(problem.domain, problem))


def _undeclared(domain: Domain, problem: Problem | None) -> list[_Use]:
    declared = set(domain.requirements) | set(problem.requirements if problem else ())
    for name in tuple(declared):
        declared.update(_IMPLIED.get(name, ()))
    first: dict[str, _Use] = {}
    for use in _problem_uses(problem) if problem else _domain_uses(domain):
        if use[1] == _OTHER_NOT:
            continue
        before = first.get(use[0])
        if before is None or (use[2] and before[2] and use[2] < before[2]):
            first[use[0]] = use
    return [use for use in first.values() if use[0] not in declared]


def used_requirements(domain: Domain, problem: Problem | None = None) -> tuple[str, ...]:
    """Return the requirements that ``domain`` (and ``problem``) use, each once, in the usual order."""
    used = {requirement for requirement, _, _ in _domain_uses(domain)}
    if problem:
        used |= {requirement for requirement, _, _ in _problem_uses(problem)}
    others = (":conditional-effects", ":action-costs", ":derived-predicates")
    usual = (":typing", *_IMPLIED[":adl"][1:4], *_QUANTIFIED, *others)
    return (":strips", *(name for name in usual if name in used))


def _domain_uses(domain: Domain) -> Iterator[_Use]:
    yield from _uses(domain)
    for function in domain.functions:
        yield ":action-costs", f'the function "{function.name}"', function.location


def _problem_uses(problem: Problem) -> Iterator[_Use]:
    yield from _uses((problem.objects, problem.goal))
    if problem.minimize_cost:
        yield ":action-costs", "the metric", problem.metric_location or problem.location


def _uses(whole: object) -> Iterator[_Use]:
    """Yield the requirements that parts of a domain or problem need."""
    for part in walk(whole):
        match part:
            case TypeDeclaration():
                yield ":typing", f'the type "{part.name}"', part.location
            case TypedName() if part.types != (OBJECT,):
                yield ":typing", f'the type of "{part.name}"', part.location
            case Axiom():
                yield ":derived-predicates", '":derived"', part.location
            case ActionSchema(cost=int() | Atom() as cost):
                yield ":action-costs", '"increase"', cost.location if isinstance(cost, Atom) else part.location
            case Effect():
                if part.parameters:
                    yield ":conditional-effects", '"forall" in an effect', part.location
                if part.condition != TRUE:
                    yield ":conditional-effects", '"when"', part.location
            case Equals():
                yield ":equality", '"="', part.location
            case Not(inner):
                yield ":negative-preconditions", '"not"' if isinstance(inner, Atom) else _OTHER_NOT, part.location
                if not isinstance(inner, Atom | Equals):
                    yield ":disjunctive-preconditions", '"not" around a compound condition', part.location
            case Or() | Imply():
                yield ":disjunctive-preconditions", f'"{keyword(part)}"', part.location
            case Forall() | Exists():
                kind = "universal" if isinstance(part, Forall) else "existential"
                yield f":{kind}-preconditions", f'"{keyword(part)}"', part.location
