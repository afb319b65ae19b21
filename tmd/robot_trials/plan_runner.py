"""A recorded run of the robot, for ``tmd run`` and programs: the simulation, its films, and its record."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from tmd import __version__
from tmd.diagnostics import TmdError
from tmd.export.trajectory import DEFAULT_RATE, SUFFIXES, TrajectoryFile, open_trajectory, recorders
from tmd.files import check_writable
from tmd.pddl.model import GroundAtom, Problem
from tmd.planning.backends import IN_PROCESS
from tmd.records.run import OrderRecord, RanStep, RunRequest
from tmd.robot.monitor.executor import MOST_REPAIRS
from tmd.robot.monitor.listeners import Order, Title
from tmd.robot.pr2.urdf import packaged_robot
from tmd.robot.run_plan import Filming, PlanRun, Prepare, run_plan
from tmd.robot.skills.results import ExecutedStep
from tmd.robot.video.captions import pillow
from tmd.robot.video.film import TILE, open_movie
from tmd.robot.video.movie_file import MovieFile
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


class PlanRunner:
    """A simulated robot that carries out one plan; a context that opens the files of the run and closes them.

    Args:
        room: The environment.
        folder: Its domain, with shapes and skills.
        problem: The environment as PDDL.
        kinematic: Set joints along their paths instead of driving motors.
        seed: Random seed; 0 leaves all things exactly where they are said to be.
        planner: Replans where the observed state is not the predicted one.
        repairs: Maximum number of replannings.
        video: Film file, MP4 or GIF.
        strip: PNG file for a sheet with one picture for each instruction.
        size: Width and height of the pictures of film and sheet, in pixels.
        trajectory: Recording of joints, base and things: a .jsonl or .mcap (ROS 2) file.
        rate: Its samples per second of simulated time.
        robot: ``pr2`` or ``tiago_pro``.
        urdf: Another PR2 or TIAGo Pro, where ``robot`` is not given.
        gui: Open a window, and go no faster than real time.

    Raises:
        MissingToolError: A package that simulates or films is not installed.
        OutputError: A file cannot be written.
        TmdError: There is no such robot, or no such kind of film or recording.
    """

    def __init__(
        self,
        room: Environment,
        folder: DomainFolder,
        problem: Problem,
        *,
        kinematic: bool = False,
        seed: int = 0,
        planner: str = IN_PROCESS,
        repairs: int = MOST_REPAIRS,
        video: Path | None = None,
        strip: Path | None = None,
        size: tuple[int, int] | None = None,
        trajectory: Path | None = None,
        rate: float | None = None,
        robot: str | None = None,
        urdf: Path | None = None,
        gui: bool = False,
    ) -> None:
        for output in filter(None, (video, strip, trajectory)):
            check_writable(output)
        if trajectory is not None and trajectory.suffix not in SUFFIXES:
            raise TmdError(f"{trajectory}: a trajectory ends in one of {', '.join(SUFFIXES)}")
        self._room, self._folder, self._problem = room, folder, problem
        self._files = video, strip, trajectory
        self._size, self._rate = size, rate or DEFAULT_RATE
        self._settings: dict[str, Any] = {"kinematic": kinematic, "seed": seed, "planner": planner}
        model = urdf if robot is None else packaged_robot(robot)
        self._driver: dict[str, Any] = {"repairs": repairs, "urdf": model, "gui": gui}
        self._movie: MovieFile | None = None
        self._recording: TrajectoryFile | None = None
        self._stack = ExitStack()

    def __enter__(self) -> Self:
        video, strip, trajectory = self._files
        if strip is not None:
            pillow()
        if video is not None:
            self._movie = self._stack.enter_context(open_movie(video, self._size))
        if trajectory is not None:
            self._recording = self._stack.enter_context(open_trajectory(trajectory))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stack.__exit__(kind, error, trace)

    def request(self, orders: Sequence[Order], text: str | None, **more: Any) -> RunRequest:  # noqa: ANN401 - fields
        """Return the beginning of the record of a run of ``orders``; ``more`` are its other fields."""
        room, folder = self._room, self._folder
        strip = self._files[1]
        return RunRequest(
            text=text,
            domain=folder.name,
            environment=room.name,
            mode="kinematic" if self._settings["kinematic"] else "physics",
            seed=self._settings["seed"],
            planner=self._settings["planner"],
            plan=tuple(map(OrderRecord.of, orders)),
            version=__version__,
            strip=strip.name if strip else None,
            **more,
        )

    def run(self, orders: Sequence[Order], prepare: Prepare, heading: str, text: str = "") -> PlanRun:
        """Carry out a plan.

        Args:
            orders: The plan.
            prepare: Is given the simulation, and returns the listeners.
            heading: Title of film and sheet.
            text: The request.

        Raises:
            TmdError: The domain has no skills or no shapes, or the scene cannot be built.
        """
        strip, movie = self._files[1], self._movie
        return run_plan(
            self._room,
            self._folder,
            self._problem,
            orders,
            prepare=lambda session: (*prepare(session), *recorders(session, self._recording, self._rate)),
            filming=Filming(heading, text, movie, strip, self._size or TILE) if movie or strip else None,
            **self._settings,
            **self._driver,
        )
