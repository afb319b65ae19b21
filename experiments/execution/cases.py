"""Which runs are asked for: demonstrations, plans or requests, in which environments, with which faults."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from experiments.execution.faults import InjectedFault, opportunities
from experiments.execution.record import Case
from tmd.diagnostics import TmdError
from tmd.domain_kit import DomainKit
from tmd.evaluation.sentence_tests import judge
from tmd.pddl.plan_file import parse_instruction, read_plan
from tmd.pddl.reading.syntax import read_text
from tmd.records.sentence_test import Outcome
from tmd.robot.skills.skill_file import Skills
from tmd.world.corpus import Corpus
from tmd.world.roots import Roots
from tmd.world.sentence_file import read_sentences

ALL, ONE = "all", "one"


def demonstrations(
    corpus: Corpus, blank: Case, *, tasks: Collection[str], environments: Collection[str], every: int, each: int | None
) -> list[Case]:
    """A case for each demonstration.

    Args:
        corpus: The domain's.
        blank: The case that is filled in.
        tasks: Only these; all where there are none.
        environments: Only these; all where there are none.
        every: Of what is left, each so-manieth.
        each: At most so many of one task in one environment.

    Raises:
        TmdError: There is no such task or environment.
    """
    for name in environments:
        if name not in corpus.environments():
            raise TmdError(f"there is no environment '{name}' in {corpus.directory}")
    found = [d for task in tasks or corpus.tasks() for d in corpus.demonstrations(task)]
    found = [d for d in found if not environments or d.environment in environments][::every]
    counted: Counter[tuple[str, str]] = Counter()
    cases = []
    for d in found:
        counted[d.task, d.environment] += 1
        if each is None or counted[d.task, d.environment] <= each:
            plan = tuple(map(str, d.instructions))
            cases.append(
                replace(
                    blank, name=d.id, task=d.task, environment=d.environment, plan=plan, end_state=tuple(d.end_state)
                )
            )
    return cases


def plans(corpus: Corpus, blank: Case, given: Iterable[str]) -> Iterator[Case]:
    """A case for each ``ENVIRONMENT=FILE``.

    Raises:
        TmdError: It is not of this form, there is no such environment, or the file is no plan.
    """
    for text in given:
        environment, _, file = text.partition("=")
        if not file or environment not in corpus.environments():
            raise TmdError(
                f"'{text}' is not ENVIRONMENT=FILE", hint=f"environments: {', '.join(corpus.environments())}"
            )
        plan = tuple(map(str, read_plan(Path(file)).instructions))
        yield replace(blank, name=Path(file).stem, task="plan", environment=environment, plan=plan)


def goals(file: Path, blank: Case) -> list[Case]:
    """A case for each line of a file with goals; its environments are bundled ones, or files beside it.

    Raises:
        TmdError: The file cannot be read.
    """
    found = []
    for line in read_text(file).splitlines():
        said = json.loads(line)
        beside = file.parent / said["environment"]
        where = str(beside) if beside.suffix == ".yaml" else said["environment"]
        found.append(replace(blank, name=said["name"], task="goals", environment=where, goal=said["goal"]))
    return found


def requests(files: Iterable[Path], count: int, blank: Case) -> list[Case]:
    """Some cases, drawn by the seed of ``blank``: plans of sentence tests that end in what is asked.

    Tests of domains without skills are left out.

    Raises:
        TmdError: A file cannot be read, or is wrong.
    """
    roots = Roots()
    tests = [t for file in files for t in read_sentences(file) if t.goal is not None]
    folders = {name: roots.folder(name) for name in {t.domain for t in tests}}
    kits = {n: DomainKit(roots.corpus(f)) for n, f in folders.items() if (f.path / "skills.yaml").is_file()}
    tests = [t for t in tests if t.domain in kits]
    found: list[Case] = []
    for number in np.random.default_rng(blank.seed).permutation(len(tests)):
        test = tests[int(number)]
        grounded = kits[test.domain].ground(test.text, test.environment)
        result = judge(test, grounded, grounded.world.task.problem)
        if result.outcome is Outcome.RIGHT and result.plan:
            plan = next(
                tuple(map(str, p.instructions))
                for p, v in zip(grounded.plans, grounded.verdicts, strict=True)
                if v.valid
            )
            case = replace(blank, name=test.id, domain=test.domain, task="requests", environment=test.environment)
            found.append(replace(case, plan=plan, end_state=(test.goal or "",)))
        if len(found) == count:
            break
    return found


def with_faults(cases: Sequence[Case], kinds: Sequence[str], skills: Skills) -> list[Case]:
    """The cases with faults: of each kind that can come about in the plan, or of one that the seed chooses.

    Raises:
        TmdError: There is no such kind.
    """
    known = [kind.value for kind in InjectedFault]
    if wrong := [kind for kind in kinds if kind not in (*known, ALL, ONE)]:
        raise TmdError(f"there is no fault '{wrong[0]}'", hint=f"faults: {', '.join((*known, ALL, ONE))}")
    found = []
    for number, case in enumerate(cases):
        plan = [parse_instruction(text) for text in case.plan]
        asked = known if ALL in kinds or ONE in kinds else kinds
        possible = [kind for kind in asked if opportunities(InjectedFault(kind), plan, skills)]
        if ONE in kinds and possible:
            drawn = np.random.default_rng([case.seed, number]).integers(len(possible))
            possible = [possible[int(drawn)]]
        found += [replace(case, fault=kind) for kind in possible]
    return found
