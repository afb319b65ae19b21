"""The names of ``import tmd``: all that the commands do, and the way to other tools and back.

Names are found on the package itself (``tmd.load_domain``) and imported when they are first used.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tmd.diagnostics import OptionError, TmdError
from tmd.domain_kit import DomainKit
from tmd.export.end_goal import asked_problem
from tmd.export.pddl_package import from_pddl, to_pddl
from tmd.export.planned_problem import planned
from tmd.export.unified import (
    from_unified_planning,
    plan_from_unified_planning,
    plan_to_unified_planning,
    to_unified_planning,
)
from tmd.grounded import Grounded
from tmd.language.parser import parse
from tmd.pddl.model import Instruction, Problem
from tmd.pddl.plan_file import read_plan as read_plan_file
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.validator import Verdict, validate
from tmd.pddl.writer import format_domain, format_problem
from tmd.planning.backends import AUTO, TIME_LIMIT, solve
from tmd.planning.result import Solved, Unreachable
from tmd.view import notebook as _notebook  # noqa: F401 - registers what notebooks show
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.check.report import CheckReport as CheckReport
    from tmd.evaluation.runs.config import ExperimentConfig as ExperimentConfig
    from tmd.evaluation.runs.experiment import run_experiment as run_experiment
    from tmd.format.files import format_file as format_file
    from tmd.readers.llm.client import ModelError as ModelError
    from tmd.readers.llm.client import ModelSettings as ModelSettings
    from tmd.records.run import RecordedRun as RecordedRun
    from tmd.records.run import RunRecord as RunRecord
    from tmd.robot_trials.trials import carry_out_predictions as carry_out_predictions
    from tmd.view.answer_text import grounded_text as grounded_text
    from tmd.world.scaffold import Scaffold
    from tmd.world.sentence_file import read_sentences as read_sentences

# What takes long to import, or belongs to few, with the modules that are imported when it is first used.
_LATER = {
    "CheckReport": "tmd.check.report",
    "ExperimentConfig": "tmd.evaluation.runs.config",
    "ModelError": "tmd.readers.llm.client",
    "ModelSettings": "tmd.readers.llm.client",
    "RecordedRun": "tmd.records.run",
    "RunRecord": "tmd.records.run",
    "carry_out_predictions": "tmd.robot_trials.trials",
    "format_file": "tmd.format.files",
    "grounded_text": "tmd.view.answer_text",
    "read_sentences": "tmd.world.sentence_file",
    "run_experiment": "tmd.evaluation.runs.experiment",
}

__all__ = [
    "CheckReport",
    "DomainKit",
    "ExperimentConfig",
    "Grounded",
    "Instruction",
    "ModelError",
    "ModelSettings",
    "NoPlanError",
    "Problem",
    "RecordedRun",
    "RunRecord",
    "TmdError",
    "Verdict",
    "asked_problem",
    "carry_out_predictions",
    "check_files",
    "compile_domain",
    "export_plan",
    "file_page",
    "find_plan",
    "format_domain",
    "format_file",
    "format_problem",
    "from_pddl",
    "from_unified_planning",
    "grounded_page",
    "grounded_text",
    "load_domain",
    "load_problem",
    "new_domain",
    "parse",
    "plan_from_unified_planning",
    "plan_page",
    "plan_to_unified_planning",
    "read_plan",
    "read_sentences",
    "run_experiment",
    "to_pddl",
    "to_unified_planning",
    "validate",
    "with_goal",
]


def __getattr__(name: str) -> Any:  # noqa: ANN401 - whatever stands in the module
    """Return a name of :data:`_LATER`, imported now."""
    if name in _LATER:
        return getattr(import_module(_LATER[name]), name)
    raise AttributeError(f"module 'tmd.api' has no attribute '{name}'")


class NoPlanError(TmdError):
    """No plan was found.

    Attributes:
        proven: Whether it is proven that there is none; otherwise the planner gave up.
    """

    def __init__(self, message: str, *, proven: bool) -> None:
        super().__init__(message)
        self.proven = proven


def load_domain(
    name: str,
    *,
    domains: str | Path | None = None,
    problems: str | Path | None = None,
    learned: str | Path | None = None,
) -> DomainKit:
    """Return the domain of that name.

    Args:
        name: A bundled domain, or one in ``domains``.
        domains: The directory of all domains; ``./domains`` or the packaged one by default.
        problems: The directory of all problems; ``./problems`` or the packaged one by default.
        learned: Where ``tmd learn --out`` saved; ``$TMD_LEARNED``, or else beside the demonstrations, by default. What
            is not saved is learned when a text is first grounded, and kept in the user's cache directory.

    Raises:
        TmdError: There is none.
    """
    roots = _roots(domains, problems)
    saved = learned if learned is not None else os.environ.get("TMD_LEARNED")
    return DomainKit(roots.corpus(roots.folder(name)), Path(saved) if saved else None)


def new_domain(
    name: str, start: str = "graph", *, domains: str | Path = "domains", problems: str | Path = "problems"
) -> Scaffold:
    """Begin a domain of your own, a small one that works, as ``tmd new`` does.

    Args:
        name: The domain.
        start: Begin with ``plain`` PDDL, with a ``graph``: classes of things that have parts, ``empty``, or with the
            PDDL domain in a file, whose actions give the lexicon.
        domains: Its folder is made in this directory.
        problems: The folder of its environments, problems and demonstrations is made in this directory.

    Returns:
        What was made.

    Raises:
        TmdError: The name cannot be one, something is there already, or it cannot be written.
    """
    from tmd.world.scaffold import scaffold

    given = None
    if start.endswith(".pddl"):
        from tmd.goals.written_rows import lexicon_of_actions
        from tmd.pddl.reading.reader import read_domain
        from tmd.pddl.reading.syntax import read_text

        given = read_text(start), lexicon_of_actions(read_domain(start))
    return scaffold(name, start if given is None else "empty", Path(domains), Path(problems), given)


def compile_domain(name: str, *, domains: str | Path | None = None, write: bool = True) -> bool:
    """Compile a domain with object graphs to its ``domain.pddl``, as ``tmd compile`` does.

    Args:
        name: The domain, or its folder.
        domains: The directory of all domains; ``./domains`` or the packaged one by default.
        write: Whether to write the file.

    Returns:
        Whether the file was not there, or was another.

    Raises:
        TmdError: A source is missing or wrong, with its place.
    """
    from tmd.world.compile import update_domain

    return update_domain(_roots(domains, None).sources(name), write=write)


def check_files(
    *paths: str | Path,
    domain: str | None = None,
    domains: str | Path | None = None,
    problems: str | Path | None = None,
    fix: bool = False,
) -> CheckReport:
    """Find everything that is wrong with domains, problems and their files, as ``tmd check`` does.

    Args:
        paths: Files, folders, or names of bundled domains.
        domain: The domain of the problems; otherwise it is looked for.
        domains: The directory of all domains; ``./domains`` or the packaged one by default.
        problems: The directory of all problems; ``./problems`` or the packaged one by default.
        fix: Whether to fix what can be fixed without knowing what the author meant.

    Returns:
        ``.diagnostics``, each with ``.location``, ``.severity``, ``.code``, ``.message`` and ``.hint``; ``.counts``.

    Raises:
        TmdError: There is nothing at a path, or a file cannot be fixed.
    """
    from tmd.check.report import check_paths

    roots = _roots(domains, problems)
    given = roots.pddl_file(domain) if domain else None
    chosen = [roots.path(str(path)) for path in paths]
    return check_paths(chosen, domain=given, domains=roots.domains, problems=roots.problems, fix=fix)


def _roots(domains: str | Path | None, problems: str | Path | None) -> Roots:
    return Roots(None if domains is None else Path(domains), None if problems is None else Path(problems))


def load_problem(problem: str | Path, domain: str | Path | None = None) -> Problem:
    """Return a PDDL problem.

    Args:
        problem: Its file.
        domain: The PDDL file of its domain, its folder, or the name of a bundled domain; by default ``domain.pddl``
            beside the problem, or else the domain that the problem names.

    Raises:
        TmdError: A file is missing or wrong.
    """
    return Roots().problem(Path(problem), None if domain is None else str(domain))


def find_plan(
    problem: Problem,
    *,
    planner: str = AUTO,
    optimal: bool = False,
    time_limit: float = TIME_LIMIT,
    memory_limit: int | None = None,
) -> tuple[Instruction, ...]:
    """Return a plan for ``problem``, as ``tmd plan`` finds it.

    Args:
        problem: The problem.
        planner: The planner, as ``tmd plan --planner`` takes it.
        optimal: Whether only a plan counts that is proven to be optimal.
        time_limit: Seconds after which the planner is stopped.
        memory_limit: Bytes that it may take; most of what the machine has by default.

    Raises:
        NoPlanError: There is none, or none was found.
        OptionError: It is not a problem, or there is no time for it.
        TmdError: There is no such planner, or it refuses the problem.
    """
    if not isinstance(problem, Problem):
        hint = "kit.problem(environment, goal=...) or tmd.load_problem(file) makes one"
        raise OptionError(f"this is a {type(problem).__name__}, not a problem", hint=hint)
    if time_limit <= 0:
        raise OptionError(f"the time limit is {time_limit:g} s", hint="give more than 0")
    answer = solve(problem, planner, optimal=optimal, seconds=time_limit, memory=memory_limit)
    if isinstance(answer, Solved):
        return answer.plan
    if isinstance(answer, Unreachable):
        raise NoPlanError(f"there is no plan: {answer.reason}", proven=True)
    raise NoPlanError(f"the planner gave up at {answer.limit}; nothing is proven", proven=False)


def read_plan(path: str | Path, problem: Problem | None = None) -> tuple[Instruction, ...]:
    """Return the plan in a file: a plan file, or the output of a planner, a planning service or a language model.

    Args:
        path: The file.
        problem: The problem that it is for. Without it, only steps in parentheses on lines of their own are found.

    Raises:
        TmdError: The file cannot be read, or a line of it is not an instruction.
    """
    return read_plan_file(path, problem).instructions


def export_plan(
    problem: Problem,
    plan: Iterable[Instruction],
    directory: str | Path,
    formats: str | Sequence[str] = ("adl",),
    *,
    overwrite: bool = False,
) -> list[Path]:
    """Write a problem and a plan for other tools, as ``tmd export`` does.

    Args:
        problem: The problem.
        plan: A plan that works.
        directory: Where to; a directory that is empty or not there.
        formats: One format, which fills the directory, or several, a directory each.
        overwrite: Whether the directory may hold files.

    Returns:
        The files that were written.

    Raises:
        TmdError: There is no such format, the plan does not work, a format cannot say the problem (nothing is written
            then), or the directory cannot be written.
    """
    from tmd.export.directory import write_directory
    from tmd.export.formats import chosen_files

    target = Path(directory)
    written = chosen_files(planned(problem, plan), [formats] if isinstance(formats, str) else formats)
    for failure in written.failures.values():
        raise failure
    flat = {path: data for files in written.files.values() for path, data in files.items()}
    write_directory(target, flat, overwrite=overwrite)
    return [target / path for path in flat]


def plan_page(problem: Problem, plan: Iterable[Instruction]) -> str:
    """Return a self-contained HTML page of a plan: every step with what it changes, as ``tmd view PLAN`` writes it."""
    from tmd.view.page import render
    from tmd.view.subject import PlannedStep, Subject

    return render(Subject(f"A plan in {problem.name}", problem, tuple(map(PlannedStep, plan)))).html


def file_page(
    path: str | Path,
    *,
    environment: str | Path | None = None,
    problem: str | Path | None = None,
    domain: str | None = None,
    domains: str | Path | None = None,
    problems: str | Path | None = None,
) -> str:
    """Return a self-contained HTML page of what a file holds, as ``tmd view FILE`` writes it.

    Args:
        path: What ``tmd ground --json`` or ``tmd run --json`` printed, a log of ``tmd run``, or a plan file.
        environment: Where: for a plan file, or instead of what the file names.
        problem: Of a plan file: its PDDL problem.
        domain: The domain; otherwise the environment's or problem's own.
        domains: The directory of all domains; ``./domains`` or the packaged one by default.
        problems: The directory of all problems; ``./problems`` or the packaged one by default.

    Raises:
        TmdError: The file is of no kind that is known, or something in it or around it is wrong.
    """
    from tmd.view.page import render
    from tmd.view.sources import ViewRequest, subject_of_file

    place = None if environment is None else str(environment)
    asked = ViewRequest(str(path), place, domain, None if problem is None else Path(problem))
    return render(subject_of_file(_roots(domains, problems), asked).subject).html


def grounded_page(grounded: Grounded) -> str:
    """Return an HTML page of a text: clauses, goals, plan and candidates."""
    from tmd.view.page import render
    from tmd.view.subject import text_subject

    return render(text_subject(grounded)).html
