"""The prompt of a request: the domain, the environment and the rules, as text.

The words are in ``prompt.txt``; this module fills them in.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from itertools import islice, pairwise
from string import Template

from tmd import diagnostics
from tmd.goals.tables import declared_entries
from tmd.language.lexicon.lexicon import Declared, Lexicon
from tmd.pddl.model import ActionSchema, Domain, GroundAtom, Instruction, TypedName, hierarchy, predicates_of
from tmd.pddl.task import Bits
from tmd.pddl.writer import format_effect, format_formula
from tmd.world.sentence_file import SentenceTest
from tmd.world.world import World, run

_SECTION = re.compile(r"^\[(\w+)\]\n", re.MULTILINE)
_WORD = re.compile(r"[^\W\d_]+(?:['\u2019-][^\W\d_]+)*|\d+")
# Larger environments are cut to the objects that the request may concern.
_MOST_OBJECTS = 120
_MOST_ROWS = 12
# Characters after which a row or an example is left out: nobody learns from it.
_LONGEST_ROW = 300
# Maximum number of characters of all rows together.
_MOST_OF_ROWS = 1_400
_FEWEST_EXAMPLES, _MOST_EXAMPLES = 2, 4
# Beyond this length a prompt has the fewest examples.
_MOST_CHARACTERS = 20_000
_EXAMPLES = "Requests in other environments, with what holds when all of their steps are done there:"


@dataclass(frozen=True, slots=True)
class Prompt:
    """The messages of a first question, and what to tell the user about it.

    Attributes:
        system: Rules and domain: the same for all requests of a domain.
        domain: The part of ``system`` about the domain alone.
        environment: The part of ``user`` about the environment alone.
    """

    system: str
    user: str
    domain: str
    environment: str
    notes: tuple[str, ...] = ()


@cache
def sections() -> Mapping[str, str]:
    """Return the sections of ``prompt.txt`` by name."""
    text = resources.files("tmd.readers.llm").joinpath("prompt.txt").read_text(encoding="utf-8")
    _, *parts = _SECTION.split(text)
    return {name: body.strip() for name, body in zip(parts[::2], parts[1::2], strict=True)}


def filled(section: str, **values: str) -> str:
    """Return a section with its names filled in."""
    return Template(sections()[section]).substitute(values)


def prompt_for(request: str, world: World, state: Bits, lexicon: Lexicon, examples: Sequence[SentenceTest]) -> Prompt:
    """Return the prompt for a request that is made in ``state``.

    ``examples`` are sentence tests of the domain; those in the same environment, or without a goal, are not shown.
    """
    domain = world.task.problem.domain
    shown = _shown(request, world, state)
    described = filled(
        "domain",
        domain=domain.name,
        predicates="\n".join(_predicates(domain, {atom.predicate for atom in world.task.static})),
        actions="\n".join(map(_action, domain.actions)),
    )
    system = f"{sections()['system']}\n\n{described}"
    near = list(_chosen(request, world.name, examples))
    parts = {
        "request": one_line(request),
        "environment": world.name,
        "objects": "\n".join(_objects(world, shown)),
        "facts": "\n".join(_facts(world, state, shown)),
        "vocabulary": _lines("Words of this domain:", _vocabulary(request, domain, lexicon)),
    }
    for count in range(_MOST_EXAMPLES, _FEWEST_EXAMPLES - 1, -1):
        user = filled("environment", **parts, examples=_lines(_EXAMPLES, near[:count]))
        if len(system) + len(user) <= _MOST_CHARACTERS:
            break
    alone = user[: user.rindex("<request>")].strip()
    hidden = len(world.profiles.objects) - len(shown)
    notes = (f"the language model was shown {len(shown)} of {len(shown) + hidden} objects",) if hidden else ()
    if hidden:
        user = f"Only objects that the request may concern are shown; {hidden} others are left out.\n\n{user}"
    return Prompt(system, user, described, alone, notes)


def one_line(text: str) -> str:
    """Return a text on one line, without control characters and without what looks like the end of a request."""
    return re.sub(r"</?\s*request\s*>", " ", diagnostics.one_line(text), flags=re.IGNORECASE)


def changes(world: World, plan: Sequence[Instruction]) -> tuple[str, str]:
    """Return the facts that a plan makes true and false, as text."""
    task = world.task
    end = run(world, task.init, plan)
    added, deleted = task.names(end & ~task.init), task.names(task.init & ~end)
    return tuple("; ".join(map(str, atoms)) or "nothing" for atoms in (added, deleted))  # type: ignore[return-value]


# ---------------------------------------------------------------------- the domain


def _predicates(domain: Domain, static: set[str]) -> Iterable[str]:
    """Yield a line for each predicate that may hold in the environment, or that an action shown in full names."""
    changing = {effect.atom.predicate for action in domain.actions for effect in action.effects}
    changing |= {axiom.head.predicate for axiom in domain.derived}
    named = {name for a in domain.actions if not a.comment for name in predicates_of(a.precondition)}
    for predicate in domain.predicates:
        if predicate.name not in changing | static | named:
            continue
        mark = "" if predicate.name in changing else "*"
        comment = f" ; {one_line(predicate.comment)}" if predicate.comment else ""
        yield f"({' '.join([predicate.name, _typed(predicate.parameters)]).strip()}){mark}{comment}"


def _action(action: ActionSchema) -> str:
    """Return an action with its comment, or in full where it has none."""
    head = f"({' '.join([action.name, _typed(action.parameters)]).strip()})"
    if action.comment:
        return f"{head} ; {one_line(action.comment)}"
    needs = format_formula(action.precondition)
    effects = " ".join(" ".join(format_effect(effect).split()) for effect in action.effects)
    return f"{head} needs {needs} makes {effects}"


def _typed(parameters: Sequence[TypedName]) -> str:
    return " ".join(f"{p.name} - {'|'.join(p.types)}" if p.types != ("object",) else p.name for p in parameters)


# ---------------------------------------------------------------------- the environment


def _objects(world: World, shown: set[str]) -> Iterable[str]:
    """Yield a line for each type: its supertypes, and the objects of just that type."""
    problem = world.task.problem
    types = hierarchy(problem.domain)
    constants = set(world.profiles.constants)
    by_type: dict[str, list[str]] = {}
    for thing in problem.all_objects():
        if thing.name in shown or thing.name in constants:
            by_type.setdefault(thing.types[0], []).append(thing.name)
    for name, members in by_type.items():
        line = " < ".join(t for t in types.ancestors(name) if t != "object" or name == "object")
        yield f"{line}: {' '.join(members)}"


def _facts(world: World, state: Bits, shown: set[str]) -> Iterable[str]:
    """Yield a line for each predicate, with the arguments of its true atoms.

    Predicates that hold of nearly everything with itself, such as *belongs to the same thing*, are left out.
    """
    task = world.task
    known = shown | set(world.profiles.constants)
    atoms = [a for a in (*sorted(task.static), *task.names(state)) if known.issuperset(a.args)]
    loops = Counter(a.predicate for a in task.static if len(a.args) == 2 and a.args[0] == a.args[1])
    reflexive = {name for name, count in loops.items() if 2 * count > len(world.profiles.objects)}
    by_predicate: dict[str, list[GroundAtom]] = {}
    for atom in atoms:
        if atom.predicate not in reflexive:
            by_predicate.setdefault(atom.predicate, []).append(atom)
    order = {p.name: place for place, p in enumerate(task.problem.domain.predicates)}
    for name in sorted(by_predicate, key=lambda name: order.get(name, len(order))):
        yield _fact_line(name, [atom.args for atom in by_predicate[name]])


def _fact_line(name: str, arguments: Sequence[tuple[str, ...]]) -> str:
    """Return the true atoms of one predicate on a line; a first argument that all share stands before the colon."""
    firsts = {args[0] for args in arguments if len(args) > 1}
    if len(firsts) == 1 and len(arguments) > 4:
        name, arguments = f"{name} {firsts.pop()}", [args[1:] for args in arguments]
    joint = " " if all(len(args) == 1 for args in arguments) else "; "
    return f"{name}: {joint.join(map(' '.join, arguments))}".rstrip(": ")


def _shown(request: str, world: World, state: Bits) -> set[str]:
    """Return the objects that a prompt shows: all, or in a large environment those that the request may concern.

    First what its nouns may name, then parts and what is linked to them, then where things are, then the rest.
    """
    objects = world.profiles.objects
    if len(objects) <= _MOST_OBJECTS:
        return set(objects)
    own = set(objects)
    order: dict[str, None] = {}

    def take(names: Iterable[str]) -> None:
        order.update((name, None) for name in names if name in own)

    words = _words(request)
    for noun in (*("_".join(pair) for pair in pairwise(words)), *words):
        take(match.name for match in world.mentions.of(noun, state))
    profiles = world.profiles
    for name in list(order):
        take((*profiles.unit(name), *(part for _, part in profiles.parts.get(name, ()))))
    atoms = world.task.names(state)
    named = set(order)
    for (tail, head), predicates in sorted(profiles.links.items()):
        if {tail, head} & named and predicates:
            take((tail, head))
    for atom in atoms:
        if named.intersection(atom.args):
            take(atom.args)
    seen: set[str] = set()
    for name in objects:  # one of each kind, so that the model knows what there is
        kind = world.mentions.kinds[name]
        if kind not in seen:
            seen.add(kind)
            take([name])
    take(objects)
    return set(list(order)[:_MOST_OBJECTS])


# ---------------------------------------------------------------------- words and examples


def _words(text: str) -> list[str]:
    return [word.lower() for word in _WORD.findall(text)]


def _vocabulary(request: str, domain: Domain, lexicon: Lexicon) -> Iterable[str]:
    """Yield how this domain means words of the request: verbs, nouns, adjectives and groups."""
    words = _words(request)
    declared, attributes = declared_entries(lexicon, domain)
    rows = _verb_rows(words, lexicon, declared)
    if rows:
        yield (
            "Verbs. (was f) means that f held when the step began, (first f) that it held before the request. "
            "Do not write was or first in a goal; name the objects instead."
        )
        yield from rows
    nouns = list(_noun_senses(words, domain, lexicon))
    if nouns:
        yield from ("Nouns, the likeliest sense first.", *nouns)
    adjectives = [f"  {r.pattern}: {' '.join(r.condition.split())}" for r in attributes if r.pattern in words]
    if adjectives:
        yield from ("Adjectives.", *adjectives)


def _verb_rows(words: Sequence[str], lexicon: Lexicon, declared: Sequence[Declared]) -> list[str]:
    """Return the goal rows of the verbs among words, without long ones."""
    known = [found[0] for word in words if (found := lexicon.verb(word)) is not None]
    stems = {*known, *map(lexicon.canonical_verb, known)}
    rows = [
        f"  {row.pattern}: {' '.join(row.condition.split())}"
        for row in declared
        if " ".join(row.condition.split()) != "(and)"
        and any(verb.split("_")[0] in stems for verb in row.pattern.split()[0].split("|"))
    ]
    short = [row for row in rows if len(row) <= _LONGEST_ROW][:_MOST_ROWS]
    while sum(map(len, short)) > _MOST_OF_ROWS:
        short.remove(max(short, key=len))
    return short


def _noun_senses(words: Sequence[str], domain: Domain, lexicon: Lexicon) -> Iterable[str]:
    """Yield the senses of nouns among words that are more than the word itself."""
    names = {t.name for t in domain.types} | {c.name for c in domain.constants}
    pairs = ("_".join(pair) for pair in pairwise(words))
    for noun in dict.fromkeys((*pairs, *words, *(word.removesuffix("s") for word in words))):
        senses = lexicon.nouns.get(noun, ())
        if noun in lexicon.groups:
            yield f"  {noun}: all of {', '.join(lexicon.groups[noun])}"
        elif set(senses) - {noun}:
            yield f"  {noun}: {', '.join([s for s in senses if s in names] or senses)}"


def _chosen(request: str, environment: str, examples: Sequence[SentenceTest]) -> Iterable[str]:
    """Yield the examples of other environments that share most words with a request, never the request itself."""
    own = set(_words(request))
    others = [e for e in examples if e.environment != environment and set(_words(e.text)) != own]
    near = sorted(others, key=lambda e: (-len(own.intersection(_words(e.text))), len(e.text), e.text))
    short = (e for e in near if e.goal is not None and len(e.goal) <= _LONGEST_ROW)
    for example in islice(short, _MOST_EXAMPLES):
        yield f"  {one_line(example.text)} => {example.goal}"


def _lines(heading: str, lines: Iterable[str]) -> str:
    found = list(lines)
    return "\n".join(["", heading, *found, ""]) if found else ""
