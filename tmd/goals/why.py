"""Why a condition can never hold in an environment: what PDDL asks for and the things there do not have."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from tmd.goals.grounder import Grounder
from tmd.goals.sources.table import split_predicate
from tmd.pddl.formulas import conjuncts
from tmd.pddl.hierarchy import universe
from tmd.pddl.model import And, Atom, Exists, Forall, Formula, GroundAtom, Imply, Not, Or
from tmd.pddl.semantics import holds
from tmd.pddl.task import Task
from tmd.pddl.writer import format_formula

_OF_TYPE = "it is not of the type"


def why_impossible(condition: Formula, binding: Mapping[str, str], task: Task, grounder: Grounder) -> str:
    """The first fact that can never hold, with what forbids it."""
    reasons = [why_never(atom, task) for atom in _wanted(condition, binding) if not grounder.can_hold(atom)]
    # a broken condition says more than that something is of another type
    broken = [reason for reason in reasons if _OF_TYPE not in reason]
    return next(iter((*broken, *reasons)), "no plan can bring that about")


def why_never(atom: GroundAtom, task: Task) -> str:
    """What forbids that ``atom`` ever becomes true: the broken condition of the action that comes nearest to it."""
    problem = task.problem
    changing = {atom.predicate for atom in task.atoms}
    objects = universe(problem)
    wrong_kind: str | None = None
    for action in problem.domain.actions:
        for effect in action.effects:
            if not effect.positive or effect.atom.predicate != atom.predicate or effect.parameters:
                continue
            binding = {t: a for t, a in zip(effect.atom.terms, atom.args, strict=True) if t.startswith("?")}
            if any(t != a for t, a in zip(effect.atom.terms, atom.args, strict=True) if not t.startswith("?")):
                continue
            wrong = [p for p in action.parameters if p.name in binding and not objects.is_a(binding[p.name], p.types)]
            if wrong:
                wanted = " or ".join(wrong[0].types)
                wrong_kind = wrong_kind or f"{action.name} takes no {binding[wrong[0].name]}: {_OF_TYPE} {wanted}"
                continue
            for part in conjuncts(action.precondition):
                names = {a.predicate for a in _atoms(part)}
                variables = {t for a in _atoms(part) for t in a.terms if t.startswith("?")}
                if names & changing or not variables <= set(binding) | _quantified(part):
                    continue
                if not holds(part, problem.init, objects, binding):
                    return f"{action.name} needs {_said(part, binding)}"
    return wrong_kind or f"no action makes {atom} true"


def _said(part: Formula, binding: Mapping[str, str]) -> str:
    text = format_formula(part)
    for variable, name in sorted(binding.items(), key=lambda pair: -len(pair[0])):
        text = text.replace(variable, name)
    return " ".join(text.split())


def _wanted(condition: Formula, binding: Mapping[str, str]) -> Iterator[GroundAtom]:
    """The ground atoms of a condition whose variables are bound."""
    for atom in _atoms(condition):
        args = tuple(binding.get(term, term) for term in atom.terms)
        if not any(a.startswith("?") for a in args):
            yield GroundAtom(split_predicate(atom.predicate)[0], args)


def _atoms(formula: Formula) -> Iterator[Atom]:
    match formula:
        case Atom():
            yield formula
        case Not(part) | Forall(_, part) | Exists(_, part):
            yield from _atoms(part)
        case And(parts) | Or(parts):
            for part in parts:
                yield from _atoms(part)
        case Imply(left, right):
            yield from _atoms(left)
            yield from _atoms(right)


def _quantified(formula: Formula) -> set[str]:
    match formula:
        case Forall(parameters, part) | Exists(parameters, part):
            return {p.name for p in parameters} | _quantified(part)
        case Not(part):
            return _quantified(part)
        case And(parts) | Or(parts):
            return set().union(*(_quantified(part) for part in parts))
        case Imply(left, right):
            return _quantified(left) | _quantified(right)
    return set()
