"""A demonstration as the subject of a page: what a person did for each piece of the text."""

from __future__ import annotations

from collections.abc import Iterable

from tmd.language import parse
from tmd.language.clause import Clause
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.reading.reader import with_goal
from tmd.veil.demonstration import Demonstration, Segment
from tmd.veil.world import World
from tmd.view.subject import PlannedStep, Said, Subject
from tmd.view.text.meaning import Meaning, after, meaning


def demonstrated_subject(
    demonstration: Demonstration, world: World, lexicon: Lexicon, made: Iterable[tuple[str, str]] = ()
) -> Subject:
    """A demonstration, with its text parsed, its instructions by segment, and its goal if it has one.

    Raises:
        TmdError: The goal is not a condition of the environment.
    """
    problem = world.task.problem
    parsed = parse(demonstration.text, lexicon)
    steps = [
        PlannedStep(instruction, f"segment {number}", " ".join(demonstration.text[part.start : part.end].split()))
        for number, part in enumerate(demonstration.segments, start=1)
        for instruction in part.instructions
    ]
    return Subject(
        f"{demonstration.id}: a demonstration in {demonstration.environment}",
        problem if demonstration.goal is None else with_goal(problem, demonstration.goal, "goal"),
        tuple(steps),
        Said(parsed, tuple(_meanings(parsed.clauses, demonstration.segments, world))),
        made=(
            *made,
            ("task", demonstration.task),
            ("stated end", " ".join(demonstration.end_state) or "none"),
            ("goal", demonstration.goal or "none"),
        ),
    )


def _meanings(clauses: Iterable[Clause], segments: Iterable[Segment], world: World) -> Iterable[Meaning]:
    """What each clause's nouns mean, among what was used for the segment that it stands in."""
    states = [(world.task.init, Segment(0, 0, ()))]
    for segment in segments:
        states.append((states[-1][0], segment))
        states.append((after(segment.instructions, world, states[-1][0]), Segment(segment.end, segment.end, ())))
    for clause in clauses:
        state, segment = next((s for s in reversed(states) if s[1].start <= clause.span.start), states[0])
        yield meaning(clause, segment.instructions, world, state)
