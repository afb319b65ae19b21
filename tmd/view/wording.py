"""Facts, conditions and broken preconditions in plain words: those of the comments beside the domain's predicates.

``(near ?r - robot ?x - thing)  ; x is within reach`` turns ``(near pr2 mug1)`` into *mug1 is within reach*. Where
a comment does not mention all arguments of a fact, the fact is given as it is written in PDDL.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from textwrap import shorten

from tmd.pddl.model import (
    And,
    Atom,
    Equals,
    Exists,
    Forall,
    Formula,
    GroundAtom,
    Instruction,
    Not,
    Or,
    Problem,
    State,
    TypedName,
    conjuncts,
    universe,
)
from tmd.pddl.semantics import Binding, bind, bindings, holds, instantiate, schema_of
from tmd.pddl.writer import format_formula

# Names of parameters that are words of a sentence as well: a comment on one of them is not trusted.
_WORDS = frozenset({"a", "i"})
# Maximum number of alternatives that are named; the others are counted.
_SHOWN = 3
# Maximum number of characters of a goal as it is shown.
_LONGEST = 200


class Wording:
    """The words of one problem. It keeps nothing but what it was made from: threads may share it.

    Args:
        problem: The environment.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        domain = problem.domain
        self._objects = universe(problem)
        self._constants = frozenset(constant.name for constant in domain.constants)
        self._actions = {action.name: action for action in domain.actions}
        self._predicates = {predicate.name: predicate for predicate in domain.predicates}
        self._changing = frozenset(effect.atom.predicate for action in domain.actions for effect in action.effects)

    def fact(self, atom: GroundAtom) -> str:
        """Return ``atom`` in words, without full stop: *mug1 is on counter1*."""
        return self._told(atom.predicate, atom.args) or str(atom)

    def instruction(self, instruction: Instruction) -> str:
        """Return an instruction in words of the comment above the action: *Go and stand before pot1*; else its name.

        The first sentence of the comment is cut after the last parameter that it mentions.
        """
        action = self._actions.get(instruction.name)
        plain = " ".join((instruction.name.replace("_", " "), ", ".join(instruction.args))).strip()
        if action is None or len(instruction.args) != len(action.parameters):
            return plain
        sentence = re.split(r"[.:;(]", action.comment)[0].strip()
        names = [_word(parameter.name.removeprefix("?")) for parameter in action.parameters]
        spoken = [name for name in names if name.search(sentence)]
        ends = [*(found.start() for found in re.finditer(", ", sentence)), len(sentence)]
        short = next(sentence[:end] for end in ends if all(name.search(sentence, 0, end) for name in spoken))
        return self._filled(short, action.parameters, instruction.args) or plain

    def by_words(self, instructions: Iterable[Instruction]) -> dict[str, Instruction]:
        """Return instructions by their words; where two have the same words, PDDL follows them."""
        told: dict[str, list[Instruction]] = {}
        for instruction in instructions:
            told.setdefault(self.instruction(instruction), []).append(instruction)
        return {
            words if len(alike) == 1 else f"{words}: {instruction}": instruction
            for words, alike in told.items()
            for instruction in alike
        }

    def condition(self, condition: Formula) -> str:
        """Return ``condition`` in words, without full stop: *there is some water in cup1, and cup1 is hot*.

        Of many alternatives the first three are named: *mug1 is on counter1, counter2, table1 or 4 others*. An atom
        without words is given as it is written, without brackets; a condition with variables, as it is written in PDDL.
        """
        match condition:
            case Atom(predicate, terms):
                return self._told(predicate, terms) or " ".join((predicate, *terms))
            case Not(part):
                return f"not: {self._inner(part)}"
            case And(parts):
                return ", and ".join(self._all(parts)) or "nothing"
            case Or(parts):
                return self._among(parts) or ", or ".join(_few([self._inner(part) for part in parts])) or "never"
            case _:
                return format_formula(condition)

    def _all(self, parts: Sequence[Formula]) -> Iterable[str]:
        """Return each part in words; denials of one predicate are joined: *not: there is some milk or tea in cup1*."""
        denied: dict[str, list[Formula]] = {}
        for part in parts:
            if isinstance(part, Not) and isinstance(part.part, Atom):
                denied.setdefault(part.part.predicate, []).append(part.part)
        together: dict[Formula, str] = {
            Not(atom): told for atoms in denied.values() if (told := self._among(atoms)) for atom in atoms
        }
        return dict.fromkeys(f"not: {together[part]}" if part in together else self._inner(part) for part in parts)

    def _inner(self, part: Formula) -> str:
        """Return a part of a condition in words, in brackets where it needs them."""
        told = self.condition(part)
        return f"({told})" if isinstance(part, And | Or) and ", " in told else told

    def _among(self, parts: Sequence[Formula]) -> str:
        """Return alternatives that differ in one argument only, as one sentence; empty where they do not."""
        atoms = [part for part in parts if isinstance(part, Atom)]
        if len(atoms) < max(len(parts), 2) or len({(atom.predicate, len(atom.terms)) for atom in atoms}) > 1:
            return ""
        columns = list(zip(*(atom.terms for atom in atoms), strict=True))
        differing = [place for place, terms in enumerate(columns) if len(set(terms)) > 1]
        if len(differing) != 1:
            return ""
        args = list(atoms[0].terms)
        args[differing[0]] = either = _either(columns[differing[0]])
        told = self._told(atoms[0].predicate, args)
        return told if either in told else ""

    def broken(self, instruction: Instruction, state: State) -> str:
        """Return the first part of the instruction's precondition that fails in ``state``; empty if all hold.

        Returns:
            *needs: mug1 is within reach* where something is missing, *not while both hands hold something* where
            something is in the way.

        Raises:
            TmdError: Unknown action or object, wrong number or type of arguments.
        """
        binding = bind(self.problem, instruction)
        precondition = schema_of(self.problem, instruction).precondition
        return "" if self._holds(precondition, state, binding) else self._wish(precondition, state, binding)

    def _holds(self, part: Formula, state: State, binding: Binding) -> bool:
        return holds(part, state, self._objects, binding)

    def _wish(self, part: Formula, state: State, binding: Binding) -> str:
        """Return the change that would make ``part``, which is false, hold."""
        match part:
            case And(parts):
                return self._wish(next(p for p in parts if not self._holds(p, state, binding)), state, binding)
            case Or(parts):
                able = [inner for inner in parts if self._changeable(inner)] or list(parts)
                return ", or ".join(dict.fromkeys(self._wish(inner, state, binding) for inner in able))
            case Forall(parameters, inner):
                choices = bindings(parameters, self._objects, binding)
                return self._wish(inner, state, next(b for b in choices if not self._holds(inner, state, b)))
            case Exists(parameters, inner):
                choices = bindings(parameters, self._objects, binding)
                nearest = max(choices, key=lambda b: self._held(inner, state, b), default=None)
                return self._wish(inner, state, nearest) if nearest is not None else self._as_written(part, binding)
            case Atom():
                return f"needs: {self.fact(instantiate(part, binding))}"
            case Not(Atom() as atom):
                return f"not while {self.fact(instantiate(atom, binding))}"
            case _:
                return self._as_written(part, binding)

    def _held(self, part: Formula, state: State, binding: Binding) -> int:
        """Count the conjuncts of ``part`` that hold."""
        return sum(self._holds(inner, state, binding) for inner in conjuncts(part))

    def _as_written(self, part: Formula, binding: Binding) -> str:
        return f"needs: {format_formula(part, binding)}"

    def _changeable(self, part: Formula) -> bool:
        """Return whether some instruction can change what ``part`` says."""
        inner = part.part if isinstance(part, Not) else part
        return inner.predicate in self._changing if isinstance(inner, Atom) else not isinstance(inner, Equals)

    def _told(self, name: str, args: Sequence[str]) -> str:
        """Return the comment of a predicate with ``args`` in it; empty where it does not speak of all of them."""
        predicate = self._predicates.get(name)
        if predicate is None or len(args) != len(predicate.parameters):
            return ""
        return self._filled(re.split(r"[:;(]", predicate.comment)[0].strip(), predicate.parameters, args)

    def _filled(self, comment: str, parameters: Sequence[TypedName], args: Sequence[str]) -> str:
        """Return a comment with ``args`` for parameters; empty where it does not mention all that are not constants."""
        names = [parameter.name.removeprefix("?") for parameter in parameters]
        if not comment or _WORDS & set(names):
            return ""
        for parameter, argument in zip(parameters, args, strict=True):
            comment = _chosen(comment, argument, self._objects.of(parameter.types))
        found = dict(zip(names, args, strict=True))
        silent = [name for name in names if not _word(name).search(comment)]
        if any(found[name] not in self._constants for name in silent):
            return ""
        return _word(*names).sub(lambda m: found[m["name"]], comment) if names else comment


def folded(formula: Formula) -> Formula:
    """Return a condition for people, with the first three alternatives of many and the number of the others."""
    match formula:
        case Or(parts):
            rest = len(parts) - _SHOWN
            return Or((*map(folded, parts[:_SHOWN]), *([Atom("...", (f"{rest} more",))] if rest > 0 else [])))
        case And(parts):
            return And(tuple(map(folded, parts)))
        case _:
            return formula


def shortened(text: str) -> str:
    """Return a goal in words or as PDDL on one line of at most 200 characters."""
    return shorten(text, _LONGEST, placeholder=" …")


def _word(*names: str) -> re.Pattern[str]:
    """Return a pattern of any of ``names`` as a whole word, as it is declared (``?x``) or without the question mark."""
    return re.compile(rf"(?<![\w'?-])\??(?P<name>{'|'.join(map(re.escape, names))})(?![\w-])")


def _few(told: Sequence[str]) -> list[str]:
    """Return the first of several, and how many others there are."""
    rest = len(told) - _SHOWN
    return [*told[:_SHOWN], *([f"{rest} other{'s' if rest > 1 else ''}"] if rest > 0 else [])]


def _either(names: Sequence[str]) -> str:
    """Return alternatives: *counter1, counter2 or table1*."""
    *most, last = _few(names)
    return f"{', '.join(most)} or {last}" if most else last


def _chosen(comment: str, argument: str, others: Iterable[str]) -> str:
    """Return ``comment`` with a list of alternatives (*on, in or next to*) cut down to ``argument``, if it is one."""
    plain = argument.replace("_", " ")
    one = "|".join(sorted((re.escape(name.replace("_", " ")) for name in others), key=len, reverse=True))
    if not one:
        return comment
    listed = re.compile(rf"\b(?:{one})(?:(?:, | or |, or )(?:{one}))+\b")
    return listed.sub(lambda m: plain if plain in re.split(r", or |, | or ", m[0]) else m[0], comment)
