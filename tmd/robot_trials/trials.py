"""Trials: the selection of predictions of a run, their execution by the robot, and their records."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing, nullcontext, suppress
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Literal, get_args

from tmd import __version__
from tmd.diagnostics import MissingToolError, OptionError, OutputError, TmdError, install_extra
from tmd.evaluation.report.report import write_report
from tmd.evaluation.runs.backends import in_processes
from tmd.evaluation.runs.config import BUNDLED, ExperimentConfig
from tmd.evaluation.runs.experiment import Progress
from tmd.evaluation.runs.finished_run import FOLDER, SKIPPED, Run, Trials, read_run, read_trial, read_trials
from tmd.evaluation.summary import EMPTY
from tmd.files import make_directory, write_text
from tmd.inference.config import DEFAULT
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.reading.syntax import nearest
from tmd.records.prediction import PredictionRecord
from tmd.records.trial import Skip, Trial, TrialRequest
from tmd.robot.monitor.listeners import Order
from tmd.robot.run_plan import Filming, run_plan
from tmd.robot.sim.simulator import STEPS_PER_SECOND
from tmd.robot.skills.skill_file import load_skills
from tmd.robot.video.film import MovieFile, open_movie
from tmd.robot_trials.plan_runner import StepRecorder
from tmd.world.corpus import Corpus
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder, find_domain, find_roots


@dataclass(frozen=True, slots=True)
class TrialChoice:
    """A prediction of a row to carry out in an environment; ``line`` is ``None`` if none is executable under PDDL."""

    environment: str
    model: str
    line: PredictionRecord | None


def choices(run: Run) -> list[TrialChoice]:
    """Return one choice for each tested environment, in the order of the run.

    The row is the model that ships, so that the films show what users get; in a run without it, the row with the
    greatest END on average, in a tie the last. Of its predictions in an environment the first is taken that can be
    executed under PDDL, and that reaches its goal if one does.
    """
    rows = [name for name in run.metrics.models if name != EMPTY]
    if not rows:
        return []
    best = DEFAULT if DEFAULT in rows else max(reversed(rows), key=lambda name: run.metrics.models[name].average.END)
    lines = run.of(best)
    found = []
    for where in sorted({line.environment for line in lines}):
        working = [line for line in lines if line.environment == where and line.executable and line.predicted]
        first = next((line for line in working if line.success), next(iter(working), None))
        found.append(TrialChoice(where, best, first))
    return found


PICTURE = (400, 300)
# Small films: they stand in a page.
FPS = 5


@dataclass(frozen=True, slots=True)
class Job:
    """One trial that is to be made; it can be sent to another process.

    Attributes:
        line: The prediction; ``None`` if none is executable under PDDL.
    """

    asked: TrialRequest
    line: PredictionRecord | None
    domain: Path
    problems: Path
    out: Path

    @property
    def record(self) -> Path:
        """The file of the record."""
        return self.out / f"{self.asked.environment}.json"


def perform(job: Job) -> None:
    """Make a trial, and write its record last.

    Raises:
        MissingToolError: The simulator is not installed.
        OutputError: It cannot be written.
    """
    if job.line is None:
        reason = f"no prediction of {job.asked.model} can be executed there under PDDL"
        trial = Trial(asked=job.asked, status="no_plan", reason=reason)
    else:
        try:
            trial = _carried_out(job, orders_of(job.line))
        except (MissingToolError, OutputError):
            raise
        except TmdError as error:
            trial = Trial(asked=job.asked, status="no_scene", reason=str(error))
    write_text(job.record, trial.model_dump_json(indent=2) + "\n")


def _carried_out(job: Job, orders: Sequence[Order]) -> Trial:
    corpus = Corpus(DomainFolder(job.domain), job.problems)
    where = job.asked.environment
    environment = load_environment(corpus.directory / "environments" / f"{where}.yaml")
    problem = corpus.world(where).task.problem
    kinematic = job.asked.mode == "kinematic"
    notes = StepRecorder()
    movie, strip = _movie(job), job.out / f"{where}.png"
    heading = f"{where}: {len(orders)} instructions of {job.asked.model}"
    with movie or nullcontext():
        run = run_plan(
            environment, corpus.folder, problem, orders, prepare=lambda _: (notes,), kinematic=kinematic,
            seed=job.asked.seed, filming=Filming(heading, job.asked.text, movie, strip) if movie is not None else None,
        )  # fmt: skip
    poster = job.out / f"{where}.jpg"
    if movie is not None and movie.pictures:
        movie.write_poster(poster)
    execution, seconds = run.execution, round(run.sim_steps / STEPS_PER_SECOND, 2)
    return Trial(
        asked=job.asked,
        status=execution.status.value,
        reason=execution.reason,
        repairs=execution.repairs,
        seconds=0.0 if kinematic else seconds,
        steps=tuple(notes.steps),
        film=None if movie is None else movie.path.name,
        strip=None if movie is None else strip.name,
        poster=poster.name if movie is not None and movie.pictures else None,
    )


def _movie(job: Job) -> MovieFile | None:
    """Open the film's file: MP4, without ffmpeg a GIF, and None if pictures cannot be made at all."""
    for suffix in (".mp4", ".gif"):
        try:
            return open_movie(job.out / f"{job.asked.environment}{suffix}", PICTURE, FPS, small=True)
        except MissingToolError:
            continue
    return None


def orders_of(line: PredictionRecord) -> list[Order]:
    """Return a prediction as orders; if the model worked by clauses, with the words that each instruction is for."""
    if not line.whole:
        return [Order(parse_instruction(text)) for text in line.predicted]
    return [
        Order(parse_instruction(text), number, latent, " ".join(clause.text.split()))
        for number, clause in enumerate(line.clauses)
        for latent, texts in ((True, clause.latent), (False, clause.said))
        for text in texts
    ]


Mode = Literal["kinematic", "physics"]


def carry_out_predictions(config: ExperimentConfig, mode: Mode, *, progress: Progress | None = None) -> Trials:
    """Let a simulated PR2 carry out one prediction for each environment of a finished run, and add it to the report.

    Args:
        config: The run.
        mode: Motion of the robot, ``kinematic`` or ``physics``.
        progress: Called with the number of trials done and of all trials.

    Returns:
        The trials, or the reason why none could be made.

    Raises:
        OutputError: The run's directory cannot be written.
        WorkerLostError: A process that simulated was killed.
        OptionError: There is no such motion.
        TmdError: The directory does not hold a finished run.
    """
    if mode not in get_args(Mode):
        raise OptionError(f"there is no mode '{mode}'", hint=nearest(mode, get_args(Mode), what="modes"))
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
    trials = read_trials(config.out) or Trials(folder)
    write_report(config.out)
    return trials


def _hindrance(config: ExperimentConfig) -> str:
    """Return the reason why no trial can be made here; empty without one."""
    if config.data != BUNDLED:
        return "the actions of VEIL-500 have no skills: the robot acts in bundled environments only"
    if find_spec("pybullet") is None:
        return f"pybullet is not installed: {install_extra('robot')}"
    try:
        load_skills(find_domain(config.domain, config.domains))
    except TmdError as error:
        return error.message
    return ""


def _perform_all(config: ExperimentConfig, mode: Mode, folder: Path, progress: Progress | None) -> None:
    # absolute paths, since other processes may work elsewhere
    domain = find_domain(config.domain, config.domains).path.resolve()
    problems = (find_roots("problems", config.problems)[0] / config.domain).resolve()
    chosen = choices(read_run(config.out))
    jobs = [Job(_asked(each, config, mode), each.line, domain, problems, folder.resolve()) for each in chosen]
    for path in folder.glob("*.json"):  # of environments that this run does not test in
        if path.stem not in {job.asked.environment for job in jobs}:
            remove_file(path)
    left = [(job,) for job in jobs if not _is_done(job)]
    tell = progress or (lambda done, of: None)
    done = len(jobs) - len(left)
    tell(done, len(jobs))
    with closing(in_processes(perform, left, config.jobs)) as ended:
        for number, _ in enumerate(ended, done + 1):
            tell(number, len(jobs))


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


def _is_done(job: Job) -> bool:
    """Return whether the same trial was made before, and its films are there."""
    if not job.record.is_file():
        return False
    try:
        trial = read_trial(job.record)
    except TmdError:
        return False
    films = [name for name in (trial.film, trial.strip) if name is not None]
    return trial.asked == job.asked and all((job.out / name).is_file() for name in films)


def remove_file(path: Path) -> None:
    """Remove a file of a run.

    Raises:
        OutputError: It cannot be removed.
    """
    try:
        path.unlink()
    except OSError as error:
        message = f"{path} cannot be removed: {error.strerror}"
        raise OutputError(message, hint="name a directory you may write to") from None
