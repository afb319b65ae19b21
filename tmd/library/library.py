"""The library of templates, and how a corpus of demonstrations fills it (section V)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from weakref import WeakKeyDictionary

from tmd.language import parse
from tmd.language.clause import Clause
from tmd.language.lexicon.lexicon import Lexicon
from tmd.library.clause_alignment import split
from tmd.library.template import Template, generalise
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.short_repr import short_repr
from tmd.world.demonstration import Demonstration, Segment
from tmd.world.verb_clause import VerbClause
from tmd.world.world import Profile, World, run

# Texts whose clauses are kept: more than a corpus has.
_TEXTS = 1_000


@short_repr(lambda library: f"of {len(library.verbs())} verbs")
@dataclass(slots=True, eq=False, weakref_slot=True)
class Library:
    """Templates by verb. Verbs that the lexicon calls synonyms share their templates. Each is itself only.

    Attributes:
        unaligned: Segments with instructions in which no verb clause was found, as (demonstration, text).
    """

    lexicon: Lexicon
    unaligned: list[tuple[str, str]] = field(default_factory=list)
    _by_verb: dict[str, list[Template]] = field(default_factory=dict)
    _alike: dict[str, list[list[Template]]] = field(default_factory=dict, repr=False)
    _distinct: WeakKeyDictionary[World, dict[str, tuple[Template, ...]]] = field(
        default_factory=WeakKeyDictionary, repr=False
    )

    def add(self, template: Template) -> None:
        """Take up one template."""
        verb = self.lexicon.canonical_verb(template.clause.verb)
        self._by_verb.setdefault(verb, []).append(template)
        self._alike.pop(verb, None)
        self._distinct.clear()

    def propose(self, clause: VerbClause) -> Sequence[Template]:
        """D^(i): every template whose verb is the clause's, in the order of the corpus."""
        return self._by_verb.get(self.lexicon.canonical_verb(clause.verb), ())

    def distinct(self, clause: VerbClause, world: World) -> Sequence[Template]:
        """Return the templates of :meth:`propose` without those that propose in ``world`` the same as an earlier one.

        A large library shows the same again and again, with things of other names in other places. What that costs is
        paid once for a library and an environment.
        """
        return self._distinct_of(self.lexicon.canonical_verb(clause.verb), world)

    def _distinct_of(self, verb: str, world: World) -> tuple[Template, ...]:
        known = self._distinct.setdefault(world, {})
        if verb not in known:
            if verb not in self._alike:
                self._alike[verb] = _grouped(self._by_verb.get(verb, ()))
            here = frozenset(world.profiles.objects)
            order = {id(template): place for place, template in enumerate(self._by_verb.get(verb, ()))}
            firsts: list[Template] = []
            for group in self._alike[verb]:
                # that a thing is here under the very name that it had there counts for a template
                named: dict[tuple[str | None, ...], Template] = {}
                for template in group:
                    named.setdefault(tuple(n if n in here else None for n in template.grounding.values()), template)
                firsts += named.values()
            known[verb] = tuple(sorted(firsts, key=lambda template: order[id(template)]))
        return known[verb]

    def filtered(self, keep: Callable[[Template], bool]) -> Library:
        """Return a library of the templates for which ``keep`` is true."""
        found = Library(self.lexicon)
        for verb in self._by_verb:
            for template in self._by_verb[verb]:
                if keep(template):
                    found.add(template)
        return found

    def templates(self, verb: str) -> Sequence[Template]:
        """Return the templates of a canonical verb."""
        return self._by_verb.get(verb, ())

    def verbs(self) -> list[str]:
        """Return the verbs there are templates for, sorted."""
        return sorted(self._by_verb)

    def __len__(self) -> int:
        return sum(map(len, self._by_verb.values()))


class WholeLibrary(Library):
    """A library that proposes all its templates for every clause, for models without language."""

    def propose(self, clause: VerbClause) -> Sequence[Template]:
        """Return every template, verb by verb."""
        return [template for verb in self.verbs() for template in self.templates(verb)]

    def distinct(self, clause: VerbClause, world: World) -> Sequence[Template]:
        """Return the same without repetitions."""
        return [template for verb in self.verbs() for template in self._distinct_of(verb, world)]


def _grouped(templates: Iterable[Template]) -> list[list[Template]]:
    """Return templates that are alike but for who made them, where, and what the things were called there."""
    numbers: dict[tuple[object, ...], int] = {}
    profiles: dict[int, int] = {}
    clauses: dict[int, tuple[object, ...]] = {}

    def number(profile: Profile) -> int:
        if id(profile) not in profiles:  # templates share their profiles: each is looked through once
            profiles[id(profile)] = numbers.setdefault(tuple(profile.items()), len(numbers))
        return profiles[id(profile)]

    groups: dict[tuple[object, ...], list[Template]] = {}
    for template in templates:
        clause = template.clause
        if id(clause) not in clauses:
            clauses[id(clause)] = (clause.verb, clause.resolved(), *clause.resolved_relations())
        key = (
            clauses[id(clause)],
            template.instructions,
            tuple(template.classes.items()),
            tuple(template.wanted.items()),
            tuple(number(profile) for profile in template.profiles.values()),
            tuple(sorted((pair, tuple(sorted(names))) for pair, names in template.links.items())),
            tuple(template.mentions.items()),
        )
        groups.setdefault(key, []).append(template)
    return list(groups.values())


def whole(library: Library) -> WholeLibrary:
    """Return the same templates, proposed for anything."""
    found = WholeLibrary(library.lexicon)
    for verb in library.verbs():
        for template in library.templates(verb):
            found.add(template)
    return found


def learn(demonstrations: Iterable[Demonstration], world_of: Callable[[str], World], lexicon: Lexicon) -> Library:
    """Build the library of a corpus."""
    library = Library(lexicon)
    for demonstration in demonstrations:
        world = world_of(demonstration.environment)
        for lesson in lessons(demonstration, world, lexicon):
            if lesson.clause is None:
                library.unaligned.append((demonstration.id, lesson.text))
                continue
            library.add(
                generalise(
                    demonstration.id,
                    lesson.clause,
                    demonstration.environment,
                    lesson.instructions,
                    lesson.states,
                    world.profiles,
                    world.mentions,
                )
            )
    return library


@dataclass(frozen=True, slots=True)
class Lesson:
    """The instructions for one clause of a demonstration.

    Attributes:
        clause: The clause; ``None`` where none was found for the text.
        instructions: What was done, without detours; at least one instruction.
        states: The states before and after.
    """

    clause: Clause | None
    text: str
    instructions: tuple[Instruction, ...]
    states: tuple[Bits, Bits]


def lessons(demonstration: Demonstration, world: World, lexicon: Lexicon) -> Iterator[Lesson]:
    """Yield the lessons of a demonstration, clause by clause, in order."""
    state = world.task.init
    for clauses, segments in align(_clauses(demonstration.text, lexicon), demonstration.segments):
        instructions = tuple(i for segment in segments for i in segment.instructions)
        text = demonstration.text[segments[0].start : segments[-1].end]
        parts = split(clauses, instructions, world.profiles, world.mentions, state) if clauses else [instructions]
        owners: Sequence[Clause | None] = clauses or [None]
        for clause, own in zip(owners, parts, strict=True):
            if own:
                end = run(world, state, own)
                useful = tidy(own, world, state)
                if useful:
                    yield Lesson(clause, text, useful, (state, end))
                state = end


# Library, goals and policy are learned from the same texts, one after the other.
@lru_cache(maxsize=_TEXTS)
def _clauses(text: str, lexicon: Lexicon) -> tuple[Clause, ...]:
    return parse(text, lexicon).clauses


def align(clauses: Sequence[Clause], segments: Sequence[Segment]) -> list[tuple[list[Clause], list[Segment]]]:
    """Return the segments in their order, each with the clauses that have most of their words there.

    A segment without a clause joins its neighbour if the neighbour's clause begins or ends in it: in *when it
    boils, add the ramen* the waiting serves the adding. Otherwise it stands alone, with no clause.
    """
    owners: list[list[Clause]] = [[] for _ in segments]
    for clause in clauses:
        overlaps = [_overlap(clause, segment) for segment in segments]
        if overlaps and max(overlaps) > 0:
            owners[overlaps.index(max(overlaps))].append(clause)
    joined = [_neighbour(index, owners, segments) for index in range(len(segments))]
    grouped: list[tuple[list[Clause], list[Segment]]] = []
    for owner, segment in zip(joined, segments, strict=True):
        if grouped and owner and grouped[-1][0] is owner:
            grouped[-1][1].append(segment)
        else:
            grouped.append((owner, [segment]))
    return grouped


def _neighbour(index: int, owners: Sequence[list[Clause]], segments: Sequence[Segment]) -> list[Clause]:
    """Return the clauses of a segment: its own, or those of a neighbour that reach into it."""
    if owners[index]:
        return owners[index]
    for near, nearest in ((index + 1, 0), (index - 1, -1)):
        if 0 <= near < len(segments) and owners[near] and _touches(owners[near][nearest], segments[index]):
            return owners[near]
    return []


def _overlap(clause: Clause, segment: Segment) -> int:
    """Return how many characters of a clause are in a segment, without its condition, duration and purpose."""
    start, end = max(clause.span.start, segment.start), min(clause.span.end, segment.end)
    count = max(0, end - start)
    for aside in (clause.condition, clause.duration, clause.purpose):
        if aside is not None and aside in clause.text:
            begins = clause.span.start + clause.text.index(aside)
            count -= max(0, min(begins + len(aside), end) - max(begins, start))
    return count


def _touches(clause: Clause, segment: Segment) -> bool:
    return clause.span.start < segment.end and segment.start < clause.span.end


def tidy(instructions: Sequence[Instruction], world: World, state: Bits) -> tuple[Instruction, ...]:
    """Return the instructions without detours, begun in ``state``; one that can never apply here stays."""
    kept: list[Instruction] = []
    states = [state]
    for instruction in instructions:
        operator = world.task.by_instruction.get(instruction)
        after = operator.apply(states[-1]) if operator is not None else states[-1]
        if operator is None or not instruction.args:
            kept.append(instruction)
            states.append(after)
            continue
        if after in states:
            back = states.index(after)
            del kept[back:], states[back + 1 :]
        else:
            kept.append(instruction)
            states.append(after)
    return tuple(kept)
