"""How well the studio proposes which clause a step serves: ``python -m experiments.studio.alignment``.

The bundled demonstrations say for each piece of text what was done. A proposal agrees where its clause is one of those
that stand in the step's piece. What is known of verbs is learned from the demonstrations of the other environments, or,
where a domain has but one, from the other demonstrations. Steps of pieces without a clause are left out and counted.

``while demonstrating`` looks at the newest step only, after each step; ``in the end`` at all steps, after the last.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from tmd.language import parse
from tmd.language.clause import Clause
from tmd.library.clause_alignment import speaks_of, split
from tmd.library.library import align, learn
from tmd.pddl.model import Instruction
from tmd.studio.demonstrations.alignment import NO_HABITS, Habits, propose
from tmd.studio.demonstrations.clause_spans import cut
from tmd.world.corpus import Corpus
from tmd.world.demonstration import Demonstration
from tmd.world.folder import find_domain, find_problems
from tmd.world.world import World

DOMAINS = ("kitchen", "living_room", "lab_bench", "01_blocks", "02_table", "03_drawer", "04_tea")


@dataclass(frozen=True, slots=True)
class Case:
    """A demonstration: its clauses, its steps, and for each step the clauses of the piece it was given for."""

    domain: str
    world: World
    clauses: tuple[Clause, ...]
    instructions: tuple[Instruction, ...]
    gold: tuple[frozenset[int], ...]
    habits: Habits


Rule = Callable[[Case, Sequence[Instruction]], Sequence[int]]


def cases(domain: str) -> Iterator[Case]:
    """The demonstrations of a domain in which a clause was understood."""
    corpus = Corpus(find_domain(domain), find_problems(domain))
    demonstrations = corpus.demonstrations()
    several = len({d.environment for d in demonstrations}) > 1
    groups: dict[str, list[Demonstration]] = {}
    for demonstration in demonstrations:
        groups.setdefault(demonstration.environment if several else demonstration.id, []).append(demonstration)
    for own in groups.values():
        others = [d for d in demonstrations if d not in own]
        habits = Habits.of(learn(others, corpus.world, corpus.lexicon))
        for demonstration in own:
            found = _case(domain, corpus, demonstration, habits)
            if found is not None:
                yield found


def _case(domain: str, corpus: Corpus, demonstration: Demonstration, habits: Habits) -> Case | None:
    clauses = tuple(p.clause for p in cut(demonstration.text, corpus.lexicon) if p.clause is not None)
    if not clauses:
        return None
    gold: list[frozenset[int]] = []
    for served, segments in align(parse(demonstration.text, corpus.lexicon).clauses, demonstration.segments):
        spans = {clause.span for clause in served}
        numbers = frozenset(number for number, clause in enumerate(clauses) if clause.span in spans)
        gold += [numbers] * sum(len(segment.instructions) for segment in segments)
    world = corpus.world(demonstration.environment)
    return Case(domain, world, clauses, demonstration.instructions, tuple(gold), habits)


def first(case: Case, done: Sequence[Instruction]) -> Sequence[int]:
    """All steps serve the first clause: the floor."""
    return [0] * len(done)


def even(case: Case, done: Sequence[Instruction]) -> Sequence[int]:
    """Each clause gets as many steps."""
    return [min(step * len(case.clauses) // len(done), len(case.clauses) - 1) for step in range(len(done))]


def touched(case: Case, done: Sequence[Instruction]) -> Sequence[int]:
    """The next clause begins where something is touched of which it alone speaks."""
    said = [speaks_of(clause, case.world.mentions, case.world.task.init) for clause in case.clauses]
    found, now = [], 0
    for instruction in done:
        names = {n for name in instruction.args for n in case.world.profiles.unit(name)}
        if now + 1 < len(said) and (names & said[now + 1].keys()) - said[now].keys():
            now += 1
        found.append(now)
    return found


def objects(case: Case, done: Sequence[Instruction]) -> Sequence[int]:
    """What divides pieces of several clauses when a library is learned: objects only."""
    profiles, mentions = case.world.profiles, case.world.mentions
    parts = split(case.clauses, done, profiles, mentions, case.world.task.init)
    return [number for number, part in enumerate(parts) for _ in part]


def studio(case: Case, done: Sequence[Instruction]) -> Sequence[int]:
    """What the studio proposes."""
    return propose(case.clauses, done, case.world, {}, case.habits)


def unlearned(case: Case, done: Sequence[Instruction]) -> Sequence[int]:
    """What it proposes in a domain without demonstrations."""
    return propose(case.clauses, done, case.world, {}, NO_HABITS)


RULES: Mapping[str, Rule] = {
    "all to the first clause": first,
    "as many for each": even,
    "next clause when its object is touched": touched,
    "objects (tmd.library.clause_alignment)": objects,
    "studio, nothing learned": unlearned,
    "studio": studio,
}


def in_the_end(rule: Rule, found: Sequence[Case]) -> str:
    """The share of steps that agree, and of demonstrations in which all do."""
    right = total = whole = 0
    for case in found:
        pairs = [(a, b) for a, b in zip(rule(case, case.instructions), case.gold, strict=True) if b]
        agreed = sum(a in b for a, b in pairs)
        right, total, whole = right + agreed, total + len(pairs), whole + (agreed == len(pairs))
    return f"{right / total:6.1%} {whole / len(found):6.1%}"


def while_demonstrating(rule: Rule, found: Sequence[Case]) -> str:
    """The share of steps for which the proposal agrees when they have just been made."""
    right = total = 0
    for case in found:
        for step, gold in enumerate(case.gold, start=1):
            if gold:
                right, total = right + (rule(case, case.instructions[:step])[-1] in gold), total + 1
    return f"{right / total:6.1%}"


def main() -> None:
    """Print one line for each rule, and for the studio's one for each domain."""
    by_domain = {domain: list(cases(domain)) for domain in DOMAINS}
    found = [case for own in by_domain.values() for case in own]
    steps = sum(bool(gold) for case in found for gold in case.gold)
    left_out = sum(not gold for case in found for gold in case.gold)
    print(f"{len(found)} demonstrations, {steps} steps; {left_out} more in pieces without a clause")
    print(f"{'rule':40} in the end  whole  while demonstrating")
    for name, rule in RULES.items():
        print(f"{name:40}     {in_the_end(rule, found)}               {while_demonstrating(rule, found)}")
    for domain, own in by_domain.items():
        print(f"  studio, {domain:30}     {in_the_end(studio, own)}               {while_demonstrating(studio, own)}")
    longest = max(found, key=lambda case: len(case.instructions) * len(case.clauses))
    start = time.perf_counter()
    studio(longest, longest.instructions)
    took = (time.perf_counter() - start) * 1e3
    print(f"{len(longest.instructions)} steps, {len(longest.clauses)} clauses: {took:.1f} ms")


if __name__ == "__main__":
    main()
