"""Reasons why a clause has no goal, in the words of the user and of the domain."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from tmd.goals.clause_goal import words
from tmd.goals.grounder import Grounder
from tmd.goals.sources.table import GoalRow, atoms_in, split_predicate, subformulas
from tmd.goals.words import family, table
from tmd.pddl.model import (
    ActionSchema,
    Atom,
    Exists,
    Forall,
    Formula,
    GroundAtom,
    Not,
    Or,
    conjuncts,
    universe,
)
from tmd.pddl.semantics import holds
from tmd.pddl.task import Task

_SHOWN = 3
"""At most so many verbs or forms are named."""
DOER = "a plan chooses who does it"
_OF_TYPE = "is not of the class"


def nearest_verbs(verb: str, known: Collection[str]) -> list[str]:
    """Return the known verbs that are nearest to ``verb`` in meaning: those of the families of its family."""
    near = family(verb)
    further = (other for one in near for other in family(one))
    return [name for name in dict.fromkeys((*near, *further)) if name in known and name != verb][:_SHOWN]


def forms(rows: Sequence[GoalRow], verb: str) -> str:
    """Return how a verb can be said, by the slots of its rows: ``'switch X to C' or 'switch X'``."""
    told = [row for row in rows if row.noun not in table("nouns")["oneself"]] or rows
    said = dict.fromkeys(" ".join((words(verb), *row.pattern.split()[1:])) for row in told)
    return " or ".join(f"'{form}'" for form in list(said)[:_SHOWN])


def placed(row: GoalRow) -> str:
    """Return a row's pattern and where it comes from."""
    return f"{row.pattern} ({row.location or row.evidence or row.source})"


def why_impossible(condition: Formula, binding: Mapping[str, str], grounder: Grounder) -> str:
    """Return the first fact that can never hold, with what forbids it."""
    wanted = (
        GroundAtom(split_predicate(atom.predicate)[0], tuple(binding.get(term, term) for term in atom.terms))
        for atom in atoms_in(condition)
    )
    closed = [atom for atom in wanted if not any(a.startswith("?") for a in atom.args)]
    if isinstance(condition, Not) and closed and not grounder.can_hold(closed[0]):
        return f"{_fact(Atom(closed[0].predicate, closed[0].args), {}, so=False)} anyway"
    reasons = [why_never(atom, grounder.task) for atom in closed if not grounder.can_hold(atom)]
    # a broken condition says more than that something is of another type
    broken = [reason for reason in reasons if _OF_TYPE not in reason]
    return next(iter((*broken, *reasons)), "nothing here can bring that about")


def why_never(atom: GroundAtom, task: Task) -> str:
    """Return what forbids that ``atom`` ever becomes true: the broken condition of the action that comes nearest."""
    changing = {one.predicate for one in task.atoms}
    objects = universe(task.problem)
    wrong_kind: str | None = None
    for action, binding in _makers(atom, task):
        wrong = [p for p in action.parameters if p.name in binding and not objects.is_a(binding[p.name], p.types)]
        if wrong:
            kinds = " or ".join(map(words, wrong[0].types))
            wrong_kind = wrong_kind or f"{binding[wrong[0].name]} {_OF_TYPE} '{kinds}', as '{words(action.name)}' needs"
            continue
        for part in conjuncts(action.precondition):
            if _is_settled(part, binding, changing) and not holds(part, task.problem.init, objects, binding):
                return f"'{words(action.name)}' is ruled out, since {_contrary(part, binding)}"
    return wrong_kind or f"no action brings about that {_fact(Atom(atom.predicate, atom.args), {}, so=True)}"


def _makers(atom: GroundAtom, task: Task) -> Iterator[tuple[ActionSchema, dict[str, str]]]:
    """Yield the actions that make atoms like ``atom`` true, with what its arguments bind."""
    for action in task.problem.domain.actions:
        for effect in action.effects:
            if not effect.positive or effect.atom.predicate != atom.predicate or effect.parameters:
                continue
            pairs = list(zip(effect.atom.terms, atom.args, strict=True))
            if all(term == arg for term, arg in pairs if not term.startswith("?")):
                yield action, {term: arg for term, arg in pairs if term.startswith("?")}


def _is_settled(part: Formula, binding: Mapping[str, str], changing: set[str]) -> bool:
    """Return whether the truth of a part of a precondition never changes and depends on bound variables only."""
    atoms = list(atoms_in(part))
    inner = {p.name for f, _ in subformulas(part) if isinstance(f, Forall | Exists) for p in f.parameters}
    variables = {t for a in atoms for t in a.terms if t.startswith("?")}
    return not {a.predicate for a in atoms} & changing and variables <= set(binding) | inner


def _contrary(part: Formula, binding: Mapping[str, str]) -> str:
    """Return what is so where a part of a precondition is not: *glass1 is not heatproof*."""
    parts = part.parts if isinstance(part, Or) else (part,)
    facts = [inner for inner in parts if next(atoms_in(inner), None) is not None]
    return " and ".join(_fact(inner, binding, so=False) for inner in facts) or "it is about one thing only"


def _fact(formula: Formula, binding: Mapping[str, str], *, so: bool) -> str:
    if isinstance(formula, Not):
        return _fact(formula.part, binding, so=not so)
    atom = next(atoms_in(formula))
    thing, *others = (binding.get(term, term) for term in atom.terms) if atom.terms else ("it",)
    said = words(" ".join((atom.predicate, *others)))
    return f"{thing} is '{said}'" if so else f"{thing} is not '{said}'"
