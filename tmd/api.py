"""What ``import tmd`` offers to programs: domains, texts, plans, and the way to other tools and back.

Names are found on the package itself (``tmd.load_domain``) and imported when they are first used.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path

from tmd.diagnostics import TmdError
from tmd.export.from_unified import from_unified_planning
from tmd.export.planned_problem import planned
from tmd.export.strips import restored
from tmd.export.unified import plan_from_unified_planning, plan_to_unified_planning, to_unified_planning
from tmd.ground import ground as ground_text
from tmd.grounded import Grounded
from tmd.inference.config import DEFAULT, preset
from tmd.inference.learned.store import Knowledge, known
from tmd.language.parser import ClauseParser, parse
from tmd.pddl.model import Instruction, Problem
from tmd.pddl.plan_file import read_plan as read_plan_file
from tmd.pddl.reading.reader import read_domain, read_problem, with_goal
from tmd.pddl.validator import Verdict, validate
from tmd.planning.backends import AUTO, IN_PROCESS, solve
from tmd.planning.result import Filled, Unreachable
from tmd.veil.corpus import Corpus
from tmd.veil.world import World, make_world
from tmd.world.compile import compile_problem
from tmd.world.environment import load_environment
from tmd.world.folder import find_domain, find_root

__all__ = [
    "DomainKit",
    "Grounded",
    "Instruction",
    "NoPlanError",
    "Problem",
    "TmdError",
    "Verdict",
    "export_plan",
    "find_plan",
    "from_unified_planning",
    "load_domain",
    "load_problem",
    "plan_from_unified_planning",
    "plan_to_unified_planning",
    "read_plan",
    "to_unified_planning",
    "validate",
    "with_goal",
]


class NoPlanError(TmdError):
    """No plan was found.

    Attributes:
        proven: Whether it is proven that there is none; otherwise the planner gave up.
    """

    def __init__(self, message: str, *, proven: bool) -> None:
        super().__init__(message)
        self.proven = proven


class DomainKit:
    """A domain folder with its environments, and with what its demonstrations teach.

    Make it with :func:`load_domain`.
    """

    def __init__(self, corpus: Corpus, learned: Path | None = None) -> None:
        self._corpus = corpus
        self._learned = learned

    @property
    def name(self) -> str:
        """The name of the domain."""
        return self._corpus.folder.name

    def environments(self) -> list[str]:
        """The names of its bundled environments, sorted."""
        return self._corpus.environments()

    def problem(self, environment: str | Path, goal: str | None = None) -> Problem:
        """An environment as a PDDL problem.

        Args:
            environment: The name of a bundled environment, or an environment file (YAML).
            goal: A condition, such as ``(contains cup1 water)``; without it the goal is empty.

        Raises:
            TmdError: There is no such environment, or it or the goal is wrong.
        """
        problem = self._world(environment).task.problem
        return problem if goal is None else with_goal(problem, goal, "goal")

    def ground(
        self,
        text: str,
        environment: str | Path,
        *,
        top: int = 1,
        planner: str = IN_PROCESS,
        model: str = DEFAULT,
        guess: bool = False,
        parser: ClauseParser | None = None,
    ) -> Grounded:
        """Ground a text in an environment, as ``tmd ground`` does.

        Args:
            text: What the person said.
            environment: The name of a bundled environment, or an environment file (YAML).
            top: How many distinct plans are wanted.
            planner: Which planner fills in what was left unsaid.
            model: What is minimised; the models are those of ``tmd ground --model``.
            guess: Whether a plan may be made where what was said is not understood or cannot be done.
            parser: What reads the text in place of the built-in parser.

        Returns:
            The clauses that were understood, the plans (cheapest first) and what the validator says of each.

        Raises:
            TmdError: There is no such environment, planner or model, or a file of the domain is wrong.
        """
        return ground_text(
            text,
            self._world(environment),
            self._knowledge.library,
            reward=self._knowledge.reward,
            goals=self._knowledge.goals,
            config=replace(preset(model), guess=guess),
            planner=planner,
            top=top,
            parser=parser or parse,
        )

    @cached_property
    def _knowledge(self) -> Knowledge:
        """What the demonstrations teach, asked for once."""
        return known(self._corpus, self._learned)

    def _world(self, environment: str | Path) -> World:
        path = Path(environment)
        if path.suffix not in (".yaml", ".yml"):
            return self._corpus.world(str(environment))
        read = load_environment(path)
        return make_world(read.name, compile_problem(read, self._corpus.folder), self._corpus.lexicon)


def load_domain(
    name: str,
    *,
    domains: str | Path | None = None,
    problems: str | Path | None = None,
    learned: str | Path | None = None,
) -> DomainKit:
    """The domain of that name.

    Args:
        name: A bundled domain, or one in ``domains``.
        domains: The directory of all domains; ``./domains`` or the packaged one by default.
        problems: The directory of all problems; ``./problems`` or the packaged one by default.
        learned: Where ``tmd learn --out`` saved; ``$TMD_LEARNED``, or else beside the demonstrations, by default. What
            is not saved is learned when a text is first grounded, and kept in the user's cache directory.

    Raises:
        TmdError: There is none.
    """
    folder = find_domain(name, None if domains is None else Path(domains))
    root = find_root("problems", None if problems is None else Path(problems))
    saved = learned if learned is not None else os.environ.get("TMD_LEARNED")
    return DomainKit(Corpus(folder, root / folder.name), Path(saved) if saved else None)


def load_problem(problem: str | Path, domain: str | Path) -> Problem:
    """A PDDL problem.

    Args:
        problem: Its file.
        domain: The PDDL file of its domain, or the name of a bundled domain.

    Raises:
        TmdError: A file is missing or wrong.
    """
    path = Path(domain)
    return read_problem(problem, read_domain(path) if path.is_file() else find_domain(str(domain)).domain)


def find_plan(problem: Problem, *, planner: str = AUTO) -> tuple[Instruction, ...]:
    """A plan for ``problem``, as ``tmd plan`` finds it.

    Raises:
        NoPlanError: There is none, or none was found.
        TmdError: There is no such planner, or it refuses the problem.
    """
    answer = solve(problem, planner)
    if isinstance(answer, Filled):
        return answer.plan
    if isinstance(answer, Unreachable):
        raise NoPlanError(f"there is no plan: {answer.reason}", proven=True)
    raise NoPlanError(f"the planner gave up at {answer.limit}; nothing is proven", proven=False)


def read_plan(path: str | Path, problem: Problem | None = None) -> tuple[Instruction, ...]:
    """The plan in a file: of the planning competitions, or with times, as VAL, POPF and PlanSys2 have them.

    Args:
        path: The file.
        problem: Where the plan is for plan-resolved STRIPS: the problem that was exported.

    Raises:
        TmdError: The file cannot be read, or a line of it is not an instruction.
    """
    plan = read_plan_file(path).instructions
    return plan if problem is None else restored(problem, plan)


def export_plan(
    problem: Problem,
    plan: Iterable[Instruction],
    directory: str | Path,
    formats: Sequence[str] = ("adl",),
    *,
    overwrite: bool = False,
) -> list[Path]:
    """Write a problem and a plan for other tools, as ``tmd export`` does.

    Args:
        problem: The problem.
        plan: A plan that works.
        directory: Where to; a directory that is empty or not there.
        formats: One format fills the directory, several a directory each.
        overwrite: Whether the directory may hold files.

    Returns:
        The files that were written.

    Raises:
        TmdError: There is no such format, the plan does not work, or the directory cannot be written.
    """
    from tmd.export.directory import write_directory
    from tmd.export.formats import chosen_files

    target = Path(directory)
    files = chosen_files(planned(problem, plan), formats)
    flat = {path: data for written in files.values() for path, data in written.items()}
    write_directory(target, flat, overwrite=overwrite)
    return [target / path for path in flat]
