"""Writing PDDL that every reader takes: flat typed ADL.

Each effect stands by itself, ``(forall (...) (when condition literal))``, so no reader can mistake a ``when``
within a ``when``. An empty precondition is ``(and)``. Parent types stand before their children. The comment
of a predicate stands beside it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby
from typing import get_args

from tmd.pddl.model import (
    OBJECT,
    TOTAL_COST,
    TRUE,
    ActionSchema,
    And,
    Atom,
    Axiom,
    Domain,
    Effect,
    Equals,
    Exists,
    Forall,
    Formula,
    GroundAtom,
    Instruction,
    Predicate,
    Problem,
    TypedName,
    keyword,
    parents_first,
    parts_of,
)
from tmd.short_repr import short_repr

_WIDTH = 100


def format_domain(domain: Domain) -> str:
    """Format ``domain`` as text; reading it gives an equal domain."""
    typed = bool(domain.types)
    sections = [f"(define (domain {domain.name})"]
    if domain.requirements:
        sections.append(f"  (:requirements {' '.join(domain.requirements)})")
    if domain.types:
        sections.append(_section("types", [f"{t.name} - {t.parent}" for t in parents_first(domain.types)]))
    if domain.constants:
        sections.append(_section("constants", _listed(domain.constants, typed)))
    if domain.predicates:
        sections.append(_section("predicates", _predicates(domain.predicates, typed)))
    if domain.functions:
        sections.append(_section("functions", [f"{_signature(f, typed)} - number" for f in domain.functions]))
    sections.extend(_axiom(axiom, typed) for axiom in domain.derived)
    sections.extend(_action(action, typed) for action in domain.actions)
    return "\n\n".join(sections) + "\n)\n"


def format_problem(problem: Problem) -> str:
    """Format ``problem`` as text; reading it with the same domain gives an equal problem."""
    typed = bool(problem.domain.types)
    sections = [f"(define (problem {problem.name})\n  (:domain {problem.domain.name})"]
    if problem.requirements:
        sections.append(f"  (:requirements {' '.join(problem.requirements)})")
    if problem.objects:
        sections.append(_section("objects", _listed(problem.objects, typed)))
    derived = {axiom.head.predicate for axiom in problem.domain.derived}
    init = [str(atom) for atom in sorted(problem.init) if atom.predicate not in derived]
    if any(f.name == TOTAL_COST for f in problem.domain.functions):
        init.append(f"(= ({TOTAL_COST}) 0)")
    init.extend(f"(= {function} {value})" for function, value in sorted(problem.function_values.items()))
    sections.append(_section("init", init))
    sections.append(f"  (:goal {_laid_out(problem.goal, 8, typed)})")
    if problem.minimize_cost:
        sections.append(f"  (:metric minimize ({TOTAL_COST}))")
    return "\n\n".join(sections) + "\n)\n"


def format_formula(formula: Formula, binding: Mapping[str, str] | None = None, *, typed: bool = False) -> str:
    """Format ``formula`` on one line, with the variables of ``binding`` replaced.

    ``typed`` writes the type ``object`` as well, which VAL insists on in domains with types.
    """
    bound = binding or {}
    match formula:
        case Atom():
            return str(GroundAtom(formula.predicate, tuple(bound.get(t, t) for t in formula.terms)))
        case Equals(left, right):
            return f"(= {bound.get(left, left)} {bound.get(right, right)})"
        case Forall(parameters, part) | Exists(parameters, part):
            own = {p.name for p in parameters}
            inner = {name: value for name, value in bound.items() if name not in own}
            words = [f"({_typed(parameters, typed)})", format_formula(part, inner, typed=typed)]
        case _:
            words = [format_formula(part, bound, typed=typed) for part in parts_of(formula)]
    return f"({' '.join((keyword(formula), *words))})"


def format_effect(effect: Effect, *, typed: bool = False) -> str:
    """Format ``effect`` on one line; ``typed`` as for :func:`format_formula`."""
    text = format_formula(effect.atom)
    if not effect.positive:
        text = f"(not {text})"
    if effect.condition != TRUE:
        text = f"(when {format_formula(effect.condition, typed=typed)} {text})"
    if effect.parameters:
        text = f"(forall ({_typed(effect.parameters, typed)}) {text})"
    return text


def _section(name: str, lines: Iterable[str]) -> str:
    return "\n".join([f"  (:{name}", *(f"    {line}" for line in lines), "  )"])


def _typed(names: Sequence[TypedName], typed: bool) -> str:
    return " ".join(_listed(names, typed))


def _listed(names: Sequence[TypedName], typed: bool) -> list[str]:
    """Format names with their types. Where no type is declared, none is written, so STRIPS stays STRIPS."""
    if not typed and all(name.types == (OBJECT,) for name in names):
        return [" ".join(name.name for name in names)]
    listed = []
    for types, run in groupby(names, key=lambda name: name.types):
        either = types[0] if len(types) == 1 else f"(either {' '.join(types)})"
        listed.append(f"{' '.join(name.name for name in run)} - {either}")
    return listed


def _signature(predicate: Predicate, typed: bool) -> str:
    parameters = _typed(predicate.parameters, typed)
    return f"({predicate.name} {parameters})" if parameters else f"({predicate.name})"


def _predicates(predicates: Sequence[Predicate], typed: bool) -> list[str]:
    signatures = [_signature(p, typed) for p in predicates]
    width = max(len(s) for s in signatures)
    return [
        f"{signature:<{width}} ; {p.comment}" if p.comment else signature
        for signature, p in zip(signatures, predicates, strict=True)
    ]


def _axiom(axiom: Axiom, typed: bool) -> str:
    head = " ".join((axiom.head.predicate, _typed(axiom.parameters, typed))).rstrip()
    return f"  (:derived ({head})\n    {_laid_out(axiom.condition, 4, typed)})"


def _action(action: ActionSchema, typed: bool) -> str:
    effects = [format_effect(e, typed=typed) for e in action.effects]
    if action.cost is not None:
        amount = format_formula(action.cost) if isinstance(action.cost, Atom) else str(action.cost)
        effects.append(f"(increase ({TOTAL_COST}) {amount})")
    lines = [
        f"  (:action {action.name}",
        f"    :parameters ({_typed(action.parameters, typed)})",
        f"    :precondition {_laid_out(action.precondition, 6, typed)}",
        f"    :effect {in_lines('and', effects, 6)})",
    ]
    return "\n".join(lines)


def _laid_out(formula: Formula, indent: int, typed: bool) -> str:
    """Return ``formula``; a conjunction that is too long for one line gets a line for each part."""
    line = format_formula(formula, typed=typed)
    if len(line) + indent <= _WIDTH or not isinstance(formula, And):
        return line
    return in_lines("and", [format_formula(p, typed=typed) for p in formula.parts], indent)


def in_lines(word: str, parts: Sequence[str], indent: int) -> str:
    """Return a group of ``parts`` behind ``word``, each on a line."""
    if not parts:
        return f"({word})"
    pad = "\n" + " " * indent
    return f"({word}{pad}{pad.join(parts)})"


# formulas are of a lower module, which cannot write them
for _kind in get_args(Formula):
    short_repr(format_formula)(_kind)


def format_plan(instructions: Iterable[Instruction], cost: int | None = None, *, unit: bool = True) -> str:
    """Return the text of a plan file.

    ``cost`` is the number of instructions where it is ``None``; ``unit`` is what the last line says: each costs 1.
    """
    lines = [instruction.pddl() for instruction in instructions]
    total = len(lines) if cost is None else cost
    lines.append(f"; cost = {total} ({'unit' if unit else 'general'} cost)")
    return "\n".join(lines) + "\n"
