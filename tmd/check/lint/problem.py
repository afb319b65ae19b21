"""What is allowed in a problem and hardly ever meant: goals that hold already, or that nothing reaches."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tmd.check.lint.reachable import Possible, possible
from tmd.diagnostics import TmdError
from tmd.pddl.model import Atom, Domain, GroundAtom, Not, Problem, conjuncts
from tmd.pddl.reading.syntax import Source


def lint_problem(problem: Problem, source: Source) -> list[TmdError]:
    """The warnings for a problem that has no faults."""
    found = possible(problem)
    return [*_unreachable_goals(found, source), *_goal_holds(problem, source)]


def _unreachable_goals(found: Possible, source: Source) -> Iterator[TmdError]:
    changed = {effect.atom.predicate for action in found.problem.domain.actions for effect in action.effects}
    for part in conjuncts(found.problem.goal):
        if isinstance(part, Atom):
            atom = GroundAtom(part.predicate, part.terms)
            if not found.reaches(atom):
                why = "no action adds it" if atom.predicate in changed else f'no action changes "{atom.predicate}"'
                yield source.error(
                    f"the goal {atom} cannot be reached: it does not hold at the start, and {why}",
                    part.location,
                    "look at the effects of the actions, at the types of the objects, and at :init",
                    "unreachable-goal",
                )
        elif isinstance(part, Not) and isinstance(part.part, Atom):
            atom = GroundAtom(part.part.predicate, part.part.terms)
            if atom in found.problem.init and not _may_be_deleted(found, atom):
                yield source.error(
                    f"the goal (not {atom}) cannot be reached: it holds at the start, and no action deletes it",
                    part.location,
                    "look at the effects of the actions",
                    "unreachable-goal",
                )


def _may_be_deleted(found: Possible, atom: GroundAtom) -> bool:
    names = {
        effect.atom.predicate
        for action in found.problem.domain.actions
        if action.name in found.actions
        for effect in action.effects
        if not effect.positive
    }
    return atom.predicate in names


def _goal_holds(problem: Problem, source: Source) -> Iterator[TmdError]:
    parts = conjuncts(problem.goal)
    literals = [part.part if isinstance(part, Not) else part for part in parts]
    if parts and all(isinstance(literal, Atom) for literal in literals):
        holds = (
            (GroundAtom(atom.predicate, atom.terms) in problem.init) != isinstance(part, Not)
            for part, atom in zip(parts, literals, strict=True)
            if isinstance(atom, Atom)
        )
        if all(holds):
            yield source.error(
                "the goal holds at the start: the empty plan reaches it",
                getattr(parts[0], "location", None) or problem.location,
                "change the goal or :init",
                "goal-holds",
            )


def lint_together(domain: Domain, problems: Iterable[Problem], source: Source) -> list[TmdError]:
    """What of ``domain`` plays no part in any of the ``problems``: actions that never apply, and why."""
    known = [possible(problem) for problem in problems]
    if not known:
        return []
    every = "in this problem" if len(known) == 1 else f"in none of the {len(known)} problems"
    found: list[TmdError] = []
    told: set[str] = set()
    for action in domain.actions:
        lacks = [p.blocked.get(action.name) for p in known]
        if any(lack is None for lack in lacks):
            continue
        lack = lacks[0]
        if isinstance(lack, Atom) and not _ever_holds(lack.predicate, known):
            if lack.predicate not in told:
                told.add(lack.predicate)
                hint = f'add "{lack.predicate}" to an effect or to :init'
                message = f'nothing makes "{lack.predicate}" true {every}, and action "{action.name}" needs it'
                message = message.replace("true in none", "true, in none")
                found.append(source.error(message, lack.location or action.location, hint, "never-produced"))
        elif isinstance(lack, Atom):
            atom = " ".join((lack.predicate, *lack.terms))
            message = f'action "{action.name}" can never apply {every}: ({atom}) never holds'
            hint = "look at the types and constants here and in :init"
            found.append(source.error(message, lack.location or action.location, hint, "never-applies"))
        elif lack not in told:
            told.add(str(lack))
            message = f'no object is of type "{lack}" {every}, so action "{action.name}" never applies'
            found.append(
                source.error(message, action.location, f'declare an object of type "{lack}"', "type-without-objects")
            )
    return found


def _ever_holds(predicate: str, known: list[Possible]) -> bool:
    return any(predicate in p.adding or any(atom.predicate == predicate for atom in p.problem.init) for p in known)
