"""Facts, conditions and broken preconditions in plain words: those of the comments beside the domain's predicates.

``(near ?r - robot ?x - thing)  ; x is within reach`` turns ``(near pr2 mug1)`` into *mug1 is within reach*. Where
a comment does not mention all arguments of a fact, the fact is given as it is written in PDDL.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from textwrap import shorten

from tmd.goals.words import table, words_of
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
# Maximum number of things that are all named where all of them are meant.
_ALL = 6
# Maximum number of characters of a goal as it is shown.
_LONGEST = 200
_AND, _OR, _IT = "and", "or", "it"


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

        Common parts are said once: *cup1 and mug1 are in sink1*. Of many alternatives the first three are named: *mug1
        is on counter1, counter2, table1 or 4 others*. An atom without words is given as it is written, without
        brackets; a condition with variables, as it is written in PDDL.
        """
        return str(self._parts(condition))

    def goal(self, condition: Formula) -> str:
        """Return ``condition`` in at most 200 characters: what is too much is counted."""
        return self._parts(condition).within(_LONGEST)

    def _parts(self, condition: Formula) -> _Parts:
        match _factored(condition):
            case And(parts):
                return _Parts(_merged(self._all(parts), _AND), _AND) if parts else _Parts(("nothing",))
            case Or(parts) as either:
                return self._alternatives(either.parts) if parts else _Parts(("never",))
            case other:
                return _Parts((self._one(other),))

    def _one(self, part: Formula) -> str:
        """Return an atom, its denial, or what is given in PDDL."""
        match part:
            case Atom(predicate, terms):
                return self._told(predicate, terms) or " ".join((predicate, *terms))
            case Not(Atom(predicate, terms)):
                told = self._told(predicate, terms)
                return _denied(told) if told else f"not: {' '.join((predicate, *terms))}"
            case Not(inner):
                return f"not: {self._inner(inner)}"
            case And() | Or():
                return self._inner(part)
            case _:
                return format_formula(part)

    def _all(self, parts: Sequence[Formula]) -> list[str]:
        """Return each part in words; those that differ in one argument only are said together."""
        found: dict[str, None] = {}
        left = list(dict.fromkeys(parts))
        while left:
            first = left.pop(0)
            atoms = [first, *(part for part in left if _place(first, part) is not None)]
            together = next(
                (
                    (alike, words)
                    for place in dict.fromkeys(_place(first, part) for part in atoms[1:])
                    if len(alike := [first, *(part for part in atoms[1:] if _place(first, part) == place)]) > 1
                    and (words := self._together(alike, place or 0))
                ),
                ([first], self._inner(first)),
            )
            left = [part for part in left if part not in together[0]]
            found[together[1]] = None
        return list(found)

    def _together(self, parts: Sequence[Formula], place: int) -> str:
        """Return facts, or denials, that differ at one place as one sentence; empty where they cannot be one."""
        atoms = [atom for part in parts if isinstance(atom := part.part if isinstance(part, Not) else part, Atom)]
        names, args = [atom.terms[place] for atom in atoms], list(atoms[0].terms)
        denied = isinstance(parts[0], Not)
        args[place] = listed = _listed(names, _OR if denied else _AND)
        told = self._told(atoms[0].predicate, args)
        if listed not in told:
            return ""
        if denied:
            return _plural(_opposite(told), listed, _listed(names, _AND)) or _denied(told)
        if told.startswith(f"{listed} "):
            return _plural(told, listed, listed)
        follows = told.partition(listed)[2].split()[:1]
        return "" if set(follows) & set(table("denied_verbs")) else told

    def _alternatives(self, parts: Sequence[Formula]) -> _Parts:
        if among := self._among(parts):
            return _Parts((among,))
        if found := _same_of_each(parts, self._constants):
            names, template = found
            inner = self._parts(template)
            return _Parts(inner.parts, inner.word, f"for {_listed(names, _OR)}: ")
        return _Parts(tuple(_few(_merged([self._inner(part) for part in parts], _OR))), _OR)

    def _inner(self, part: Formula) -> str:
        """Return a part of a condition in words, in brackets where it needs them."""
        if not isinstance(part, And | Or):
            return self._one(part)
        told = self._parts(part)
        return f"({told})" if len(told.parts) > 1 or told.start else str(told)

    def _among(self, parts: Sequence[Formula]) -> str:
        """Return alternatives that differ in one argument only, as one sentence; empty where they do not."""
        atoms = [part for part in parts if isinstance(part, Atom)]
        places = {_place(atoms[0], atom) for atom in atoms[1:]} if atoms else set()
        if len(atoms) < max(len(parts), 2) or len(places) != 1 or (place := places.pop()) is None:
            return ""
        args = list(atoms[0].terms)
        args[place] = either = _listed([atom.terms[place] for atom in atoms], _OR)
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
            case Forall() | Exists():
                return self._quantified_wish(part, state, binding)
            case Atom():
                return f"needs: {self.fact(instantiate(part, binding))}"
            case Not(Atom() as atom):
                return f"not while {self.fact(instantiate(atom, binding))}"
            case _:
                return self._as_written(part, binding)

    def _quantified_wish(self, part: Forall | Exists, state: State, binding: Binding) -> str:
        """Return the change for the first object that fails, or for the one that needs least."""
        choices = bindings(part.parameters, self._objects, binding)
        if isinstance(part, Forall):
            return self._wish(part.part, state, next(b for b in choices if not self._holds(part.part, state, b)))
        nearest = max(choices, key=lambda b: self._held(part.part, state, b), default=None)
        return self._wish(part.part, state, nearest) if nearest is not None else self._as_written(part, binding)

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
        """Return the comment of a predicate with ``args`` in it; empty where it does not speak of all of them.

        Kinds of things before the thing are left out: *the door, drawer or lid x is open*.
        """
        predicate = self._predicates.get(name)
        if predicate is None or len(args) != len(predicate.parameters):
            return ""
        comment = re.split(r"[:;(]", predicate.comment)[0].strip()
        names = [parameter.name.removeprefix("?") for parameter in predicate.parameters]
        kinds = re.match(rf"the (?:[\w ]+, )*[\w ]+,? or \w+ (?={_word(*names).pattern} )", comment) if names else None
        return self._filled(comment[kinds.end() :] if kinds else comment, predicate.parameters, args)

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


def _few(told: Sequence[str], most: int = _SHOWN) -> list[str]:
    """Return the first of several, and how many others there are; all of them if they are few."""
    rest = len(told) - _SHOWN if len(told) > most else 0
    return [*(told[:_SHOWN] if rest else told), *([f"{rest} other{'s' if rest > 1 else ''}"] if rest > 0 else [])]


def _listed(names: Sequence[str], word: str) -> str:
    """Return names in a list: *counter1, counter2 or table1*."""
    *most, last = _few(list(dict.fromkeys(names)), _SHOWN if word == _OR else _ALL)
    return f"{', '.join(most)} {word} {last}" if most else last


@dataclass(frozen=True, slots=True)
class _Parts:
    """Parts of a sentence that a word joins, after the start of the sentence."""

    parts: Sequence[str]
    word: str = ""
    start: str = ""

    def __str__(self) -> str:
        return self.start + f", {self.word} ".join(self.parts)

    def within(self, most: int) -> str:
        """Return as many parts as fit, and the number of the others."""
        told = str(self)
        for kept in range(len(self.parts) - 1, 0, -1):
            if len(told) <= most:
                break
            told = f"{_Parts(self.parts[:kept], self.word, self.start)}, {self.word} {len(self.parts) - kept} more"
        return shorten(told, most, placeholder=" …")


def _factored(formula: Formula) -> Formula:
    """Return a condition without nested conjunctions, and with what all alternatives need said once."""
    match formula:
        case And(parts):
            return _both([part for inner in parts for part in conjuncts(_factored(inner))])
        case Or((part,)):
            return _factored(part)
        case Or(parts):
            return _with_common_needs(formula, [conjuncts(_factored(part)) for part in parts])
        case _:
            return formula


def _with_common_needs(formula: Or, needs: Sequence[Sequence[Formula]]) -> Formula:
    """Return alternatives with what all of them need before them; as they are where there is no such thing."""
    common = [need for need in next(iter(needs), ()) if all(need in others for others in needs)]
    rests = [[need for need in own if need not in common] for own in needs]
    return And((*common, Or(tuple(map(_both, rests))))) if common and all(rests) else formula


def _both(parts: Iterable[Formula]) -> Formula:
    """Return a conjunction; its only part where there is one."""
    told = tuple(dict.fromkeys(parts))
    return told[0] if len(told) == 1 else And(told)


def _place(a: Formula, b: Formula) -> int | None:
    """Return the only argument in which two facts, or two denials, differ."""
    if isinstance(a, Not) and isinstance(b, Not):
        return _place(a.part, b.part)
    if not (isinstance(a, Atom) and isinstance(b, Atom)) or a.predicate != b.predicate or len(a.terms) != len(b.terms):
        return None
    places = [place for place, pair in enumerate(zip(a.terms, b.terms, strict=True)) if len(set(pair)) > 1]
    return places[0] if len(places) == 1 else None


def _same_of_each(parts: Sequence[Formula], constants: frozenset[str]) -> tuple[list[str], Formula] | None:
    """Return things of which the same is asked, and what: *it* is the thing. ``None`` where that is not so."""
    names = [[name for name in dict.fromkeys(names_in(part)) if name not in constants] for part in parts]
    for first in names[0]:
        template = _renamed(parts[0], first)
        pairs = zip(parts, names, strict=True)
        each = [next((name for name in own if _renamed(part, name) == template), "") for part, own in pairs]
        if all(each) and len(set(each)) == len(parts) > 1 and template != parts[0]:
            return each, template
    return None


def names_in(part: Formula) -> Iterator[str]:
    """Yield the names in a condition without variables."""
    match part:
        case Atom(_, terms):
            yield from terms
        case Not(inner):
            yield from names_in(inner)
        case And(parts) | Or(parts):
            for inner in parts:
                yield from names_in(inner)


def _renamed(part: Formula, name: str) -> Formula:
    match part:
        case Atom(predicate, terms):
            return Atom(predicate, tuple(_IT if term == name else term for term in terms))
        case Not(inner):
            return Not(_renamed(inner, name))
        case And(parts):
            return And(tuple(_renamed(inner, name) for inner in parts))
        case Or(parts):
            return Or(tuple(_renamed(inner, name) for inner in parts))
        case _:
            return part


def _denied(told: str) -> str:
    """Return the contrary of a sentence: *the door is closed*, *cup1 is not in sink1*, *there is nothing in cup1*."""
    if opposite := _opposite(told):
        return opposite
    for word, (contrary, *_) in table("denied_amounts").items():
        if found := _whole(word).search(told):
            return f"{told[: found.start()]}{contrary}{told[found.end() :]}"
    verbs = _verbs(told)
    if not verbs or (len(verbs) > 1 and ", " in told[verbs[0].end() :]):
        return f"not: {told}"
    verb = verbs[-1 if told.partition(" ")[0] in words_of("clause_subjects") else 0]
    return f"{told[: verb.start()]}{' '.join(table('denied_verbs')[verb[0]])}{told[verb.end() :]}"


def _verbs(told: str) -> list[re.Match[str]]:
    """Return the verbs of a sentence, in order."""
    found = (match for verb in table("denied_verbs") for match in _whole(verb).finditer(told))
    return sorted(found, key=re.Match.start)


def _opposite(told: str) -> str:
    """Return a sentence with the antonym of its last word, where there is one: *fridge1_door is closed*."""
    head, _, last = told.rpartition(" ")
    antonyms = table("antonyms").get(last, ())
    return f"{head} {antonyms[0]}" if antonyms and head.rpartition(" ")[2] in table("denied_verbs") else ""


def _plural(told: str, subject: str, listed: str) -> str:
    """Return a sentence about several things, ``listed``, instead of one, ``subject``; empty where it cannot be one."""
    for verb, (plural, *_) in table("plurals").items():
        if told.startswith(f"{subject} {verb} "):
            return f"{listed} {plural} {told.removeprefix(f'{subject} {verb} ')}"
    return ""


def _merged(told: Sequence[str], word: str) -> list[str]:
    """Return sentences, those that begin with the same subject and verb as one: *cup1 is in sink1 or in a hand*."""
    heads: dict[str, list[str]] = {}
    for sentence in told:
        head, tail = _divided(sentence, word)
        heads.setdefault(head or sentence, []).append(tail)
    return [_one_sentence(head, tails, word) for head, tails in heads.items()]


def _divided(sentence: str, word: str) -> tuple[str, str]:
    """Return a sentence up to its verb, with *not* where all of it is denied, and what follows; empty where unclear."""
    if sentence.startswith("("):
        return "", ""
    verbs = _verbs(sentence)
    if len(verbs) != 1:
        return "", ""
    end = verbs[0].end()
    end += len(" not") if word == _AND and sentence[end:].startswith(" not ") else 0
    return sentence[:end], sentence[end:].strip()


def _one_sentence(head: str, tails: Sequence[str], word: str) -> str:
    if len(tails) == 1:
        return f"{head} {tails[0]}".strip()
    joint = _OR if word == _AND and head.endswith(" not") else word
    *most, last = _few(tails) if word == _OR else tails
    plain = not any(separator in tail for tail in tails for separator in (", ", " or ", " and "))
    return f"{head} {', '.join(most)} {joint} {last}" if plain else f"{head} {', '.join(most)}, {joint} {last}"


def _whole(word: str) -> re.Pattern[str]:
    return re.compile(rf"(?<![\w'-]){re.escape(word)}(?![\w-])")


def _chosen(comment: str, argument: str, others: Iterable[str]) -> str:
    """Return ``comment`` with a list of alternatives (*on, in or next to*) cut down to ``argument``, if it is one."""
    plain = argument.replace("_", " ")
    one = "|".join(sorted((re.escape(name.replace("_", " ")) for name in others), key=len, reverse=True))
    if not one:
        return comment
    listed = re.compile(rf"\b(?:{one})(?:(?:, | or |, or )(?:{one}))+\b")
    return listed.sub(lambda m: plain if plain in re.split(r", or |, | or ", m[0]) else m[0], comment)
