"""A recorded run of the robot, for ``tmd run`` and programs: the simulation, its films, and its record."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from tmd import __version__
from tmd.diagnostics import TmdError
from tmd.export.trajectory import DEFAULT_RATE, SUFFIXES, open_trajectory, recorders
from tmd.files import check_writable, write_text
from tmd.pddl.model import GroundAtom, Problem
from tmd.planning.backends import IN_PROCESS
from tmd.records.run import OrderRecord, RanStep, RunRequest
from tmd.robot.monitor.executor import MOST_REPAIRS
from tmd.robot.monitor.listeners import Listener, Order, Title
from tmd.robot.pr2.urdf import packaged_robot
from tmd.robot.run_plan import Filming, PlanRun, Prepare, run_plan
from tmd.robot.session import SimulationSession
from tmd.robot.skills.results import ExecutedStep
from tmd.robot.video.captions import pillow
from tmd.robot.video.film import open_movie
from tmd.robot.video.rejected_ways import RejectedWays
from tmd.view.markup import rejected_page
from tmd.world.environment import Environment
from tmd.world.folder import DomainFolder


class StepRecorder:
    """A listener that keeps the record of each step."""

    def __init__(self) -> None:
        self.steps: list[RanStep] = []

    def begin(self, title: Title, expected: Sequence[GroundAtom]) -> None:
        """Do nothing when an instruction begins."""

    def end(self, title: Title, step: ExecutedStep) -> None:
        """Record an instruction that is over."""
        self.steps.append(RanStep.of(title, step))


@dataclass
class PlanRunner:
    """A simulated robot that carries out one plan; a context that opens the files of the run and closes them.

    The fields are an environment, its domain, the environment as PDDL, and arguments of
    :meth:`tmd.domain_kit.DomainKit.run_plan`.
    """

    room: Environment
    folder: DomainFolder
    problem: Problem
    kinematic: bool = False
    seed: int = 0
    planner: str = IN_PROCESS
    repairs: int = MOST_REPAIRS
    video: Path | None = None
    strip: Path | None = None
    trajectory: Path | None = None
    explain: Path | None = None
    rate: float | None = None
    robot: str | None = None
    urdf: Path | None = None
    gui: bool = False

    def __enter__(self) -> Self:
        for output in filter(None, (self.video, self.strip, self.trajectory, self.explain)):
            check_writable(output)
        if self.trajectory is not None and self.trajectory.suffix not in SUFFIXES:
            raise TmdError(f"{self.trajectory}: a trajectory ends in one of {', '.join(SUFFIXES)}")
        if self.robot is not None:
            self.urdf = packaged_robot(self.robot)
        if self.strip is not None or self.explain is not None:
            pillow()
        self._stack = ExitStack()
        self._recording = self._stack.enter_context(open_trajectory(self.trajectory)) if self.trajectory else None
        self._movie = self._stack.enter_context(open_movie(self.video)) if self.video else None
        return self

    def __exit__(self, *error: Any) -> None:  # noqa: ANN401 - as contexts have it
        self._stack.__exit__(*error)

    def request(self, orders: Sequence[Order], text: str | None, **more: Any) -> RunRequest:  # noqa: ANN401 - fields
        """Return the beginning of the record of a run of ``orders``; ``more`` are its other fields."""
        return RunRequest(
            text=text,
            domain=self.folder.name,
            environment=self.room.name,
            mode="kinematic" if self.kinematic else "physics",
            seed=self.seed,
            planner=self.planner,
            plan=tuple(map(OrderRecord.of, orders)),
            version=__version__,
            strip=self.strip.name if self.strip else None,
            **more,
        )

    def run(self, orders: Sequence[Order], prepare: Prepare, heading: str, text: str = "") -> PlanRun:
        """Carry out a plan.

        Raises:
            TmdError: The domain has no skills or no shapes, or the scene cannot be built.
        """
        recording, rate, filmed = self._recording, self.rate or DEFAULT_RATE, self._movie or self.strip
        explained: list[RejectedWays] = []

        def listeners(session: SimulationSession) -> Sequence[Listener]:
            explained.extend([RejectedWays(session)] if self.explain is not None else [])
            return (*prepare(session), *recorders(session, recording, rate), *explained)

        try:
            return run_plan(
                self.room,
                self.folder,
                self.problem,
                orders,
                prepare=listeners,
                filming=Filming(heading, text, self._movie, self.strip) if filmed else None,
                planner=self.planner,
                repairs=self.repairs,
                kinematic=self.kinematic,
                seed=self.seed,
                urdf=self.urdf,
                gui=self.gui,
                pictures=self.explain is not None,
            )
        finally:
            for explanation in explained:
                assert self.explain is not None
                write_text(self.explain, rejected_page(heading, explanation.failures))
