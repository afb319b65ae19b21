"""The library of templates, and how a corpus of demonstrations fills it (section V)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

from tmd.language import parse
from tmd.language.clause import Clause
from tmd.language.lexicon import Lexicon
from tmd.pddl.model import Instruction
from tmd.veil.demonstration import Demonstration, Segment
from tmd.veil.template import Template, generalise
from tmd.veil.world import World


@dataclass(slots=True)
class Library:
    """Templates by verb. Verbs that the lexicon calls synonyms share their templates.

    Attributes:
        lexicon: The words of the domain.
        unaligned: Segments with instructions in which no verb clause was found, as (demonstration, text).
    """

    lexicon: Lexicon
    unaligned: list[tuple[str, str]] = field(default_factory=list)
    _by_verb: dict[str, list[Template]] = field(default_factory=dict)

    def add(self, template: Template) -> None:
        """Take up one template."""
        self._by_verb.setdefault(self.lexicon.canonical_verb(template.clause.verb), []).append(template)

    def propose(self, clause: Clause) -> Sequence[Template]:
        """D^(i): every template whose verb is the clause's, in the order of the corpus."""
        return self._by_verb.get(self.lexicon.canonical_verb(clause.verb), ())

    def verbs(self) -> list[str]:
        """The verbs there are templates for, sorted."""
        return sorted(self._by_verb)

    def __len__(self) -> int:
        return sum(map(len, self._by_verb.values()))


def learn(demonstrations: Iterable[Demonstration], world_of: Callable[[str], World], lexicon: Lexicon) -> Library:
    """Build the library of a corpus.

    Args:
        demonstrations: The corpus.
        world_of: The world of an environment, by the environment's name.
        lexicon: The words of the domain.
    """
    library = Library(lexicon)
    for demonstration in demonstrations:
        world = world_of(demonstration.environment)
        clauses = align(parse(demonstration.text, lexicon).clauses, demonstration.segments)
        state = world.task.init
        for segment, clause in zip(demonstration.segments, clauses, strict=True):
            if segment.instructions and clause is None:
                library.unaligned.append((demonstration.id, demonstration.text[segment.start : segment.end]))
            elif segment.instructions and clause is not None:
                library.add(
                    generalise(
                        demonstration.id,
                        clause,
                        demonstration.environment,
                        segment.instructions,
                        state,
                        world.profiles,
                        world.mentions,
                    )
                )
            state = run(world, state, segment.instructions)
    return library


def align(clauses: Sequence[Clause], segments: Sequence[Segment]) -> list[Clause | None]:
    """For each segment the first clause that lies in it more than in any other; ``None`` where there is none."""
    found: list[Clause | None] = [None] * len(segments)
    for clause in clauses:
        overlaps = [min(clause.span.end, segment.end) - max(clause.span.start, segment.start) for segment in segments]
        if overlaps and max(overlaps) > 0:
            best = overlaps.index(max(overlaps))
            found[best] = found[best] or clause
    return found


def run(world: World, state: int, instructions: Iterable[Instruction]) -> int:
    """The state after ``instructions``; one that can never apply here changes nothing."""
    for instruction in instructions:
        operator = world.task.by_instruction.get(instruction)
        if operator is not None:
            state = operator.apply(state)
    return state
