"""One trial: a robot carries out a prediction in a new simulation, and is filmed."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path

from tmd.diagnostics import MissingToolError, OutputError, TmdError
from tmd.files import write_text
from tmd.pddl.model import GroundAtom
from tmd.pddl.plan_file import parse_instruction
from tmd.records.prediction import PredictionRecord
from tmd.records.run import RanStep
from tmd.records.trial import Trial, TrialRequest
from tmd.robot.monitor.listeners import Order, Title
from tmd.robot.run_plan import Filming, run_plan
from tmd.robot.sim.engine import STEPS_PER_SECOND
from tmd.robot.skills.results import ExecutedStep
from tmd.robot.video.film import open_movie
from tmd.robot.video.movie_file import MovieFile
from tmd.veil.corpus import Corpus
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder

PICTURE = (400, 300)
FPS = 5
"""Small films: they stand in a page."""


@dataclass(frozen=True, slots=True)
class Job:
    """One trial that is to be made; it can be sent to another process.

    Attributes:
        asked: What is to be done.
        line: The prediction.
        domain: The domain's folder.
        problems: The directory of its problems.
        out: Where record and films go.
    """

    asked: TrialRequest
    line: PredictionRecord
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
        MissingToolError: What simulates is not installed.
        OutputError: It cannot be written.
    """
    try:
        trial = _carried_out(job)
    except (MissingToolError, OutputError):
        raise
    except TmdError as error:
        trial = Trial(asked=job.asked, status="no_scene", reason=str(error))
    write_text(job.record, trial.model_dump_json(indent=2) + "\n")


def _carried_out(job: Job) -> Trial:
    corpus = Corpus(DomainFolder(job.domain), job.problems)
    where = job.asked.environment
    environment = load_environment(corpus.directory / "environments" / f"{where}.yaml")
    problem = corpus.world(where).task.problem
    kinematic = job.asked.mode == "kinematic"
    orders = orders_of(job.line)
    notes = _Notes()
    movie, strip = _movie(job), job.out / f"{where}.png"
    heading = f"{where}: {len(orders)} instructions of {job.asked.model}"
    with movie or nullcontext():
        run = run_plan(
            environment, corpus.folder, problem, orders, prepare=lambda _: (notes,), kinematic=kinematic,
            seed=job.asked.seed, filming=Filming(heading, job.asked.text, movie, strip) if movie is not None else None,
        )  # fmt: skip
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
    )


def _movie(job: Job) -> MovieFile | None:
    """The film's file: MP4, where there is no ffmpeg a GIF, and none where pictures cannot be made at all."""
    for suffix in (".mp4", ".gif"):
        try:
            return open_movie(job.out / f"{job.asked.environment}{suffix}", PICTURE, FPS, small=True)
        except MissingToolError:
            continue
    return None


def orders_of(line: PredictionRecord) -> list[Order]:
    """A prediction as orders; where the model worked by clauses, with the words that each instruction is for."""
    if not line.whole:
        return [Order(parse_instruction(text)) for text in line.predicted]
    return [
        Order(parse_instruction(text), number, latent, " ".join(clause.text.split()))
        for number, clause in enumerate(line.clauses)
        for latent, texts in ((True, clause.latent), (False, clause.said))
        for text in texts
    ]


class _Notes:
    """Writes down each step."""

    def __init__(self) -> None:
        self.steps: list[RanStep] = []

    def begin(self, title: Title, expected: Sequence[GroundAtom]) -> None:
        """An instruction begins."""

    def end(self, title: Title, step: ExecutedStep) -> None:
        """It is over."""
        self.steps.append(RanStep.of(title, step))
