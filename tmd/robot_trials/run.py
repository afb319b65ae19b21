"""All trials of a run: what is done is kept, what is left is done, and where none can be made it says why."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing, suppress
from importlib.util import find_spec
from pathlib import Path
from typing import Literal

from tmd import __version__
from tmd.diagnostics import MissingToolError, OutputError, TmdError
from tmd.evaluation.runs.backends import in_processes
from tmd.evaluation.runs.config import BUNDLED, ExperimentConfig
from tmd.evaluation.runs.finished_run import read_run
from tmd.evaluation.runs.trial_records import FOLDER, SKIPPED, Trials, read_trial, read_trials
from tmd.files import make_directory, write_text
from tmd.records.trial import Skip, Trial, TrialRequest
from tmd.robot.skills.skill_file import load_skills
from tmd.robot_trials.choice import TrialChoice, choices
from tmd.robot_trials.perform import Job, perform
from tmd.world.folder import DomainFolder, find_domain, find_root

Mode = Literal["kinematic", "physics"]
Progress = Callable[[int, int], None]


def run_trials(config: ExperimentConfig, mode: Mode, progress: Progress | None = None) -> Trials:
    """Let the robot carry out one prediction for each environment of a finished run.

    Args:
        config: The run.
        mode: How the robot moves.
        progress: Is told the number of trials done and of all trials.

    Returns:
        What came of it; where no trial could be made, why.

    Raises:
        OutputError: The run's directory cannot be written.
        WorkerLostError: A process that simulated was killed.
        TmdError: The directory holds no finished run.
    """
    folder = make_directory(config.out / FOLDER)
    reason = _hindrance(config)
    if not reason:
        (folder / SKIPPED).unlink(missing_ok=True)
        with suppress(OSError):
            for draft in folder.glob("*.unfinished.*"):
                draft.unlink()
        try:
            _perform_all(config, mode, folder, progress)
        except MissingToolError as error:
            reason = f"{error.message}: {error.hint}"
    if reason:
        write_text(folder / SKIPPED, Skip(reason=reason).model_dump_json() + "\n")
    return read_trials(config.out) or Trials(folder)


def _hindrance(config: ExperimentConfig) -> str:
    """Why no trial can be made here; empty where they can."""
    if config.data != BUNDLED:
        return "the actions of VEIL-500 have no skills: the robot acts in bundled environments only"
    if find_spec("pybullet") is None:
        return "pybullet is not installed: pip install 'tmd[robot]' with CPython 3.11"
    try:
        load_skills(find_domain(config.domain, config.domains))
    except TmdError as error:
        return error.message
    return ""


def _perform_all(config: ExperimentConfig, mode: Mode, folder: Path, progress: Progress | None) -> None:
    domain = find_domain(config.domain, config.domains)
    problems = find_root("problems", config.problems) / config.domain
    chosen = choices(read_run(config.out))
    asked = [_asked(choice, config, mode) for choice in chosen]
    _forget_others(folder, {each.environment for each in asked})
    left = [pair for pair in zip(chosen, asked, strict=True) if not _is_done(folder, pair[1])]
    done = len(chosen) - len(left)
    if progress:
        progress(done, len(chosen))
    jobs = []
    for choice, each in left:
        if choice.line is None:
            _without_plan(folder, each)
            done += 1
        else:
            jobs.append((Job(each, choice.line, _absolute(domain), problems.resolve(), folder.resolve()),))
    with closing(in_processes(perform, jobs, config.jobs)) as ended:
        for _ in ended:
            done += 1
            if progress:
                progress(done, len(chosen))


def _absolute(domain: DomainFolder) -> Path:
    """Other processes may work elsewhere."""
    return domain.path.resolve()


def _asked(choice: TrialChoice, config: ExperimentConfig, mode: Mode) -> TrialRequest:
    line = choice.line
    return TrialRequest(
        environment=choice.environment,
        model=choice.model,
        id=None if line is None else line.id,
        text="" if line is None else line.text,
        plan=() if line is None else line.predicted,
        mode=mode,
        seed=config.seed,
        version=__version__,
    )


def _is_done(folder: Path, asked: TrialRequest) -> bool:
    """Whether the same trial was made before, and its films are there."""
    path = folder / f"{asked.environment}.json"
    if not path.is_file():
        return False
    try:
        trial = read_trial(path)
    except TmdError:
        return False
    films = [name for name in (trial.film, trial.strip) if name is not None]
    return trial.asked == asked and all((folder / name).is_file() for name in films)


def _forget_others(folder: Path, environments: set[str]) -> None:
    """Trials in environments that this run does not test in are not its own."""
    for path in folder.glob("*.json"):
        if path.stem not in environments:
            try:
                path.unlink()
            except OSError as error:
                raise OutputError(f"{path} cannot be removed: {error.strerror}") from None


def _without_plan(folder: Path, asked: TrialRequest) -> None:
    reason = f"no prediction of {asked.model} can be executed there under PDDL"
    text = Trial(asked=asked, status="no_plan", reason=reason).model_dump_json(indent=2)
    write_text(folder / f"{asked.environment}.json", text + "\n")
