"""The driver of ``tmd run``, robot trials, the studio and the benchmarks: a plan carried out in simulation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from tmd.pddl.model import Problem
from tmd.planning.backends import IN_PROCESS
from tmd.robot.monitor.executor import MOST_REPAIRS
from tmd.robot.monitor.listeners import Listener, Order
from tmd.robot.session import SimulationSession
from tmd.robot.skills.results import Execution
from tmd.robot.video.film import Film, MovieFile
from tmd.world.environment import Environment
from tmd.world.folder import DomainFolder

# Receives the simulation before the first instruction, and returns listeners of the run.
Prepare = Callable[[SimulationSession], Sequence[Listener]]


@dataclass(frozen=True, slots=True)
class Filming:
    """Title and request of a film or strip, and their files, if any."""

    heading: str
    text: str = ""
    movie: MovieFile | None = None
    strip: Path | None = None


@dataclass(frozen=True, slots=True)
class PlanRun:
    """The execution of a plan, and the steps of the physics since the scene was made."""

    execution: Execution
    sim_steps: int


def run_plan(
    environment: Environment,
    folder: DomainFolder,
    problem: Problem,
    orders: Sequence[Order],
    *,
    prepare: Prepare | None = None,
    filming: Filming | None = None,
    planner: str = IN_PROCESS,
    repairs: int = MOST_REPAIRS,
    kinematic: bool = False,
    seed: int = 0,
    urdf: Path | None = None,
    gui: bool = False,
    pictures: bool = False,
) -> PlanRun:
    """Carry out a plan in a new simulation, each effect checked.

    ``prepare`` receives the simulation and returns listeners of the run. ``repairs`` is the maximum number of
    replannings by ``planner``. The other arguments are those of :class:`tmd.robot.session.SimulationSession`. The strip
    is written even if an error ends the run.

    Raises:
        MissingToolError: A package that simulates or films is not installed.
        TmdError: The domain has no skills or no shapes, the scene cannot be built, or ``urdf`` is not a PR2.
    """
    with ExitStack() as stack:
        session = stack.enter_context(
            SimulationSession(
                environment, folder, problem, kinematic=kinematic, seed=seed, urdf=urdf, gui=gui,
                pictures=pictures or filming is not None,
            )
        )  # fmt: skip
        listeners = list(prepare(session)) if prepare is not None else []
        film = None
        if filming is not None:
            film = Film(session.cell, session.skills, movie=filming.movie, strip=filming.strip is not None)
            if filming.strip is not None:
                stack.callback(film.write_strip, filming.strip)
            film.open(filming.heading, filming.text)
            listeners.append(film)
        execution = session.execute(orders, listeners, planner=planner, repairs=repairs)
        if film is not None:
            film.close(execution)
        return PlanRun(execution, session.sim.steps)
