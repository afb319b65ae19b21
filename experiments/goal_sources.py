"""What each source of goals, and each part of what clauses carry, adds: ``python experiments/goal_sources.py FILE …``.

Runs sentence tests (``*.sentences.jsonl``; by default those of the kitchen and the living room, every fourth) with the
model that ships, with one source of goals only, and without quantifiers, negation or conditions, and prints a table.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from tmd.evaluation.sentence_tests import Outcome, judge, summary
from tmd.goals.reading.goal_reader import GoalReader
from tmd.goals.sources.table import ACTIONS, DECLARED, LEARNED
from tmd.goals.tables import goal_tables
from tmd.ground import infer, restored_of
from tmd.grounded import Grounded
from tmd.inference.config import DEFAULT, PRESETS, InferenceConfig
from tmd.inference.energy import Energy, count, named_weights
from tmd.inference.policy.model import Policy
from tmd.knowledge import Knowledge, known
from tmd.language import parse
from tmd.language.clause import Clause, Mood, Parsed
from tmd.pddl.validator import validate
from tmd.planning.backends import IN_PROCESS, TaskPlanners, make
from tmd.readers.rules import RuleDialogue
from tmd.world.corpus import Corpus
from tmd.world.folder import find_domain, find_problems
from tmd.world.sentence_file import SentenceTest, read_sentences

SHARE = 4
"""Of the bundled tests every so many-th is run."""
BUNDLED = ("kitchen", "living_room")


def _without_quantifiers(parsed: Parsed) -> Parsed:
    """Clauses whose noun phrases say nothing of how many, which, or of what kind."""
    return replace(parsed, clauses=tuple(replace(clause, phrases={}) for clause in parsed.clauses))


def _without_negation(parsed: Parsed) -> Parsed:
    """Clauses without prohibitions; what is to be left as it is becomes an instruction."""
    clauses = tuple(replace(clause, mood=Mood.DO) for clause in parsed.clauses)
    return replace(parsed, clauses=clauses, constraints=())


def _without_conditions(parsed: Parsed) -> Parsed:
    """Clauses that are done whatever is so, in the order of the text."""

    def plain(clause: Clause) -> Clause:
        return replace(clause, conditions=(), otherwise=False)

    return replace(parsed, clauses=tuple(map(plain, parsed.clauses)))


def _as_it_is(parsed: Parsed) -> Parsed:
    return parsed


SHIPPED = PRESETS[DEFAULT]
ROWS: dict[str, tuple[InferenceConfig, Callable[[Parsed], Parsed]]] = {
    "all sources": (SHIPPED, _as_it_is),
    "declared only": (replace(SHIPPED, sources=(DECLARED,)), _as_it_is),
    "learned only": (replace(SHIPPED, sources=(LEARNED,)), _as_it_is),
    "actions only": (replace(SHIPPED, sources=(ACTIONS,)), _as_it_is),
    "no quantifiers": (SHIPPED, _without_quantifiers),
    "no negation": (SHIPPED, _without_negation),
    "no conditions": (SHIPPED, _without_conditions),
}


class Domain:
    """A domain with what its demonstrations teach."""

    def __init__(self, name: str) -> None:
        folder = find_domain(name)
        self.corpus = Corpus(folder, find_problems(name))
        self.knowledge: Knowledge = known(self.corpus)

    def ground(self, test: SentenceTest, config: InferenceConfig, change: Callable[[Parsed], Parsed]) -> Grounded:
        """The text of a test, with its clauses changed."""
        world, library = self.corpus.world(test.environment), self.knowledge.library
        parsed = change(parse(test.text, self.corpus.lexicon))
        energy = Energy(named_weights(config.weights), count(library), world, akin=config.akin)
        policy = Policy(self.knowledge.reward, world) if self.knowledge.reward is not None else None
        planners = TaskPlanners(world.task, make(IN_PROCESS, world.task, cap=config.cap), IN_PROCESS, config.cap)
        goals = self.knowledge.goals
        tables = goal_tables(library.lexicon, world.task.problem.domain, goals, config.sources)
        dialogue = RuleDialogue(parsed, GoalReader(world, tables, library.lexicon), world.task.init)
        restored = restored_of(world, library, goals, config)
        found = infer(dialogue, world, library, energy, planners, config, policy=policy, restored=restored)
        verdicts = tuple(validate(world.task.problem, plan.instructions) for plan in found.plans)
        plans = found.plans if parsed.clauses else ()
        return Grounded(
            dialogue, plans, verdicts[: len(plans)], found.rejected, (), world, library, config, found.refused
        )


def main(paths: Sequence[Path]) -> None:
    """Print one line for each row."""
    tests = [test for path in paths for test in read_sentences(path)]
    if not tests:
        own = [find_problems(name) / "requests.sentences.jsonl" for name in BUNDLED]
        tests = [test for path in own for test in read_sentences(path)[::SHARE]]
    domains = {name: Domain(name) for name in dict.fromkeys(test.domain for test in tests)}
    print(f"{len(tests)} requests\n{'':16} right  wrong  refused  impossible refused")
    for name, (config, change) in ROWS.items():
        results = []
        for test in tests:
            domain = domains[test.domain]
            problem = domain.corpus.world(test.environment).task.problem
            results.append(judge(test, domain.ground(test, config, change), problem))
        counts = summary(results)
        assert sum(r.outcome is Outcome.RIGHT for r in results) == counts.right
        print(
            f"{name:16} {counts.right:5}  {counts.wrong:5}  {counts.refused:7}  "
            f"{counts.impossible_refused} of {counts.impossible}",
            flush=True,
        )


if __name__ == "__main__":
    main([Path(argument) for argument in sys.argv[1:]])
