"""A grounded text as lines for people, as ``tmd ground`` prints it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import zip_longest

from tmd.goals.wording import folded, shortened
from tmd.grounded import Grounded
from tmd.inference.energy import title
from tmd.inference.ranking import RankedPlan
from tmd.json_record import rounded
from tmd.language.clause import Clause, Condition, Mood, Parsed, Quantifier, print_clause
from tmd.pddl.model import Problem
from tmd.pddl.validator import Verdict
from tmd.pddl.writer import format_formula
from tmd.readers.interface import Question, Usage
from tmd.view.goals import ShownGoal, in_words
from tmd.view.grounding_record import option_texts

_MOODS = {Mood.AVOID: "not to be done", Mood.KEEP: "to be kept"}


def parsed_text(parsed: Parsed) -> str:
    """Return the clauses, numbered from 1, the constraints, and what was skipped."""
    lines = ["clauses"] if parsed.clauses else ["no clause"]
    lines += [f"  {number}. {_clause_text(clause)}" for number, clause in enumerate(parsed.clauses, start=1)]
    if parsed.constraints:
        lines.append("constraints")
        lines += [f"  {_MOODS.get(c.mood, 'to be kept')}: {_noted(c, _notes(c))}" for c in parsed.constraints]
    if parsed.skipped:
        lines.append("skipped")
        lines += [f'  "{_flat(piece.text)}": {piece.reason}' for piece in parsed.skipped]
    return "\n".join(lines) + "\n"


def _clause_text(clause: Clause) -> str:
    mood = [_MOODS[clause.mood]] if clause.mood in _MOODS else []
    return _noted(clause, [*mood, *_notes(clause)])


def _noted(clause: Clause, notes: list[str]) -> str:
    return print_clause(clause) + (f"   {'; '.join(notes)}" if notes else "")


def _notes(clause: Clause) -> list[str]:
    """Return further parts of a clause: antecedents of pronouns, the result, conditions and the like."""
    return [
        *(f"{name} = {' + '.join(clause.meant(name))}" for name in clause.antecedents if name),
        *(f"no {name}" for name, phrase in clause.phrases.items() if phrase.quantifier is Quantifier.NONE),
        *([f"state: {clause.result}"] if clause.result else []),
        *(["or"] if clause.alternative else []),
        *(["otherwise"] if clause.otherwise else []),
        *(_condition_text(condition) for condition in clause.conditions),
        *_as_written(clause),
    ]


def _condition_text(condition: Condition) -> str:
    """Return a condition as written, and as it was read."""
    read = " and ".join(_within(clause) for clause in condition.clauses)
    return f"{_flat(condition.text)}: {'not ' if condition.negated else ''}{read or 'not understood'}"


def _within(clause: Clause) -> str:
    """Return a clause of a condition, with its notes inside the brackets."""
    return "; ".join([print_clause(clause).removesuffix(")"), *_notes(clause)]) + ")"


def _as_written(clause: Clause) -> Iterator[str]:
    """Yield conditions and the like that were not read any further."""
    read = {_flat(condition.text).lower() for condition in clause.conditions}
    purpose = any(condition.word == "to" for condition in clause.conditions)
    for word in ("condition", "duration", "purpose", "setting"):
        value = getattr(clause, word)
        if value and _flat(value).lower() not in read and not (purpose and word == "purpose"):
            yield f"{word}: {_flat(value)}"


def _flat(text: str) -> str:
    return " ".join(text.split())


def _goals_text(plan: RankedPlan, clauses: Sequence[Clause], problem: Problem, *, verbose: bool) -> str:
    """Return the goals of a plan's steps in words and as PDDL, and their sources; empty if the model has no goals."""
    if not plan.goals:
        return ""
    lines = ["goals"]
    for shown in in_words(plan.goals, problem):
        already = " (already so)" if shown.asked and shown.goal.already else ""
        lines.append(f"  {shown.goal.clause + 1}. {_of_part(shown, clauses)}{shown.told}{already}")
        lines += [f"     {line}" for line in _below(shown, verbose=verbose)]
    return "\n".join(lines) + "\n"


def _of_part(shown: ShownGoal, clauses: Sequence[Clause]) -> str:
    """Return the text of a step that is only a part of its clause: *when you have taken the cup*."""
    clause = clauses[shown.goal.clause] if shown.goal.clause < len(clauses) else None
    whole = "" if clause is None else " ".join(clause.text.split())
    return "" if shown.goal.text == whole else f'"{shown.goal.text}": '


def _below(shown: ShownGoal, *, verbose: bool) -> list[str]:
    """Return the goal as PDDL with its source, and what was not taken into account; all of it if ``verbose``."""
    goal = shown.goal
    if goal.formula is None or not shown.asked:
        return []
    pddl = format_formula(goal.formula) if verbose else shortened(format_formula(folded(goal.formula)))
    source = f"   {goal.origin}" if goal.source else ""
    others = [f"not taken: {format_formula(other.formula)}   {other.why}" for other in goal.others if verbose]
    if shown.rivals and not verbose:
        further = f", or {len(shown.rivals) - 1} more" if len(shown.rivals) > 1 else ""
        others = [f"taken so, not: {shortened(shown.rivals[0])}{further}"]
    more = f"   ({len(goal.others)} not taken: --verbose)" if goal.others and not verbose else ""
    return [f"{pddl}{source}{more}", *([f"note: {goal.note}"] if goal.note else []), *others]


def remarks(grounded: Grounded, *, verbose: bool = False) -> list[str]:
    """Return lines for standard error: warnings, a question, the model's effort, and why there is no plan."""
    lines = [f"warning: {warning}\n" for warning in grounded.warnings]
    if grounded.question is not None:
        lines.append(f"question: {_question_text(grounded.question, grounded.world.task.problem)}\n")
    if verbose and grounded.usage is not None:
        thoughts = grounded.usage.thoughts
        lines += [f"{usage_text(grounded.usage)}\n", *([f"thoughts: {thoughts}\n"] if thoughts else [])]
    lines += [f"no plan: {grounded.reason}\n"] if grounded.reason else []
    tried = grounded.refused[1].rows if verbose and grounded.refused is not None else ()
    return [*lines, *(f"  {row}\n" for row in tried)]


def _question_text(question: Question, problem: Problem) -> str:
    """Return a question on one line; the options before the one that was taken cannot be done."""
    marks = [" (no plan)"] * question.taken + [" (taken)"]
    options = [
        f"{number}. {text}{mark}"
        for number, (text, mark) in enumerate(zip_longest(option_texts(question, problem), marks, fillvalue=""), 1)
    ]
    return f"{question.text} {' '.join(options)}; choose with --ask"


def usage_text(usage: Usage) -> str:
    """Return the effort of a language model on one line."""
    replies = len(usage.digests)
    return (
        f"model {usage.model}: {replies} {'reply' if replies == 1 else 'replies'} ({usage.cached} cached), "
        f"{usage.prompt_tokens} + {usage.completion_tokens} tokens, {usage.seconds:.1f} s, "
        f"{usage.corrections} correction{'' if usage.corrections == 1 else 's'}"
    )


def brief_text(grounded: Grounded) -> str:
    """Return the plans, a line each."""
    if grounded.reason:
        return "no plan\n"
    return "".join(f"{' '.join(map(str, plan.instructions)) or 'nothing to do'}\n" for plan in grounded.plans)


def grounded_text(grounded: Grounded, *, energies: bool = False, verbose: bool = False) -> str:
    """Return clauses, skipped pieces and goals, then each plan and why it is not first.

    ``energies`` gives those of the plans, by factor; ``verbose`` writes goals at full length, and those that were not
    taken.
    """
    parts = [parsed_text(grounded.parsed)]
    told: list[str] = []
    for number, (plan, verdict) in enumerate(zip(grounded.plans, grounded.verdicts, strict=True), start=1):
        goals = _goals_text(plan, grounded.parsed.clauses, grounded.world.task.problem, verbose=verbose)
        parts += [goals] if goals and goals not in told[-1:] else []
        told.append(goals)
        parts.append(_plan_text(number, plan, verdict, energies=energies))
    return "\n".join(parts)


def _plan_text(number: int, plan: RankedPlan, verdict: Verdict, *, energies: bool) -> str:
    valid = "valid" if verdict.valid else f"invalid: {verdict.reason}"
    steps = f"{len(plan.steps)} step{'' if len(plan.steps) == 1 else 's'}"
    energy = f"energy {plan.energy:.4f}, " if energies else ""
    lines = [f"plan {number}: {energy}{steps}, {valid}"]
    if plan.why:
        lines.append(f"  not first: {plan.why}")
    width = max((len(str(step.instruction)) for step in plan.steps), default=0)
    for place, step in enumerate(plan.steps, start=1):
        origin = f"clause {step.clause + 1}{', latent' if step.latent else ''}"
        lines.append(f"  {place:>3}. {step.instruction!s:<{width}}  {origin}")
    if energies:
        factors = ", ".join(f"{title(name)} {value:.4f}" for name, value in plan.factors.items() if rounded(value))
        lines.append(f"  energy by factor: {factors or 'nothing'}")
    return "\n".join(lines) + "\n"
