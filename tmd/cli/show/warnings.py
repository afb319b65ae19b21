"""What to tell people about a text that was grounded in part, or not at all."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches

from tmd.ground import Grounded
from tmd.view.goals import why_refused

_VERBS = 8
"""How many verbs are named instead of an unknown one."""
_SHOWN = 3
"""How many different reasons are told."""


def remarks(grounded: Grounded, warned: Sequence[str]) -> list[str]:
    """Lines for standard error: what `warnings` told, and why there is no plan if there is none."""
    lines = [f"warning: {warning}\n" for warning in warned]
    if not any(verdict.valid for verdict in grounded.verdicts):
        lines.append(f"no plan: {_why(grounded)}\n")
    return lines


def warnings(
    grounded: Grounded, unknown: Sequence[str], verbs: Sequence[str], likened: Mapping[str, Sequence[str]]
) -> list[str]:
    """What was said and could not be used, or only by a guess: each once.

    Args:
        grounded: What came out.
        unknown: Nouns that name nothing here.
        verbs: The verbs that there are demonstrations of, the most frequent first.
        likened: Nouns that were taken for things of another name that mean something alike.
    """
    if grounded.goal_directed:
        told = [*warnings_of(grounded), *(_likened(likened) if grounded.plans else ())]
    else:
        told = [
            *(f"no demonstration has the verb '{_plain(verb)}' ({_other(verb, verbs)})" for verb in grounded.unseen),
            *(
                f"nothing here is called '{_plain(noun)}'; what a plan does instead is a guess, so read it first"
                for noun in unknown
            ),
            *_likened(likened),
        ]
    return list(dict.fromkeys(told))


def _likened(likened: Mapping[str, Sequence[str]]) -> Iterator[str]:
    """What nouns were taken for that name nothing here."""
    for noun, names in likened.items():
        taken = ", ".join(names[:_SHOWN]) + (" or others" if len(names) > _SHOWN else "")
        yield f"nothing here is called '{_plain(noun)}'; by likeness of meaning it was taken for {taken}"


def warnings_of(grounded: Grounded) -> list[str]:
    """What a plan with goals comes with: what was left out of account, and what was only guessed."""
    lines = [
        f'clause {goal.clause + 1}, "{goal.text}": {goal.note}'
        for plan in grounded.plans[:1]
        for goal in plan.goals
        if goal.note and (goal.formula is None or not goal.already)
    ]
    lines += [
        f'"{" ".join(piece.text.split())}" was skipped: {piece.reason}'
        for piece in grounded.parsed.skipped
        if grounded.plans
    ]
    return list(dict.fromkeys(lines))


def refusal(grounded: Grounded) -> str:
    """Why there is no plan for what was said; empty where it was not refused."""
    if grounded.refused is None:
        return ""
    clause, refused = grounded.refused
    return why_refused(clause, refused.message, refused.hint)


def _why(grounded: Grounded) -> str:
    parsed = grounded.parsed
    if grounded.refused is not None:
        return refusal(grounded)
    if not parsed.clauses:
        reasons = dict.fromkeys(piece.reason for piece in parsed.skipped)
        said = f" ({'; '.join(list(reasons)[:_SHOWN])})" if reasons else ""
        return f"the text has no instruction{said}; say what is to be done: take the cup"
    if {clause.verb for clause in parsed.clauses} <= set(grounded.unseen):
        return "no demonstration has any of its verbs; use other words, or add demonstrations"
    clause = max((refusal.clause for refusal in grounded.refusals), default=0)
    text = " ".join(parsed.clauses[clause].text.split())
    return f'clause {clause + 1}, "{text}", cannot be done here: {_reasons(grounded, clause)}'


def _reasons(grounded: Grounded, clause: int) -> str:
    """Why the templates for a clause were refused: the most frequent reasons first."""
    counts: dict[str, int] = {}
    for refusal in grounded.refusals:
        if refusal.clause == clause:
            counts[refusal.reason] = counts.get(refusal.reason, 0) + 1
    told = sorted(counts, key=lambda reason: (-counts[reason], reason))
    more = f"; and {len(told) - _SHOWN} other reasons" if len(told) > _SHOWN else ""
    return "; ".join(told[:_SHOWN]) + more


def _other(verb: str, verbs: Sequence[str]) -> str:
    """A verb to use instead."""
    if not verbs:
        return "the domain has no demonstrations"
    close = get_close_matches(verb, verbs, n=1)
    return f"did you mean '{_plain(close[0])}'?" if close else f"say {', '.join(map(_plain, verbs[:_VERBS]))} …"


def _plain(name: str) -> str:
    return name.replace("_", " ")
