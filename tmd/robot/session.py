"""A simulation that is ready for a plan: the room, the robot in it, and the observer of the plan."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Self

import numpy as np

from tmd.pddl.model import Problem, State
from tmd.planning.backends import IN_PROCESS
from tmd.robot.monitor.executor import MOST_REPAIRS, Executor, Performer
from tmd.robot.monitor.listeners import Listener, Order, Recorder
from tmd.robot.monitor.observation import Observer
from tmd.robot.scene.scene import Scene
from tmd.robot.sim.simulator import STEPS_PER_SECOND, Simulator
from tmd.robot.skills.performer import RobotPerformer
from tmd.robot.skills.results import ExecutedStep, Execution
from tmd.robot.skills.robot_context import make_cell
from tmd.robot.skills.skill_file import load_skills
from tmd.world.environment import Environment
from tmd.world.folder import DomainFolder

# Seconds that a kinematic tick is shown for: it is a stride of a few centimetres. Drawing takes most of the time of a
# film, and with these there are as many pictures as under physics.
TICK = 1 / 30


class SimulationSession:
    """An environment, with its PDDL problem, and a PR2 in it.

    With seed 0 all things are exactly at their places; other seeds move them by millimetres. ``kinematic`` sets joints
    along their paths instead of driving motors. ``urdf`` is another PR2 than the packaged one. ``gui`` opens a window
    and goes no faster than real time. ``pictures`` announces that pictures will be taken.

    Raises:
        MissingToolError: pybullet or the robot's model is not installed, or no window can be opened.
        TmdError: The domain has no skills or no shapes, the scene cannot be built, or ``urdf`` is not a PR2.
    """

    def __init__(
        self,
        environment: Environment,
        folder: DomainFolder,
        problem: Problem,
        *,
        kinematic: bool = False,
        seed: int = 0,
        urdf: Path | None = None,
        gui: bool = False,
        pictures: bool = False,
    ) -> None:
        self.problem = problem
        self.skills = load_skills(folder)
        self.sim = Simulator(gui=gui, pictures=pictures)
        try:
            scene = Scene(self.sim, environment, folder, rng=np.random.default_rng(seed) if seed else None)
            self.cell = make_cell(self.sim, scene, seed=seed, kinematic=kinematic, urdf=urdf)
            self._observer = Observer(problem, folder, self.skills, self.cell)
        except BaseException:
            self.sim.close()
            raise
        if gui:
            self.sim.add_watcher(_Pace(self.sim))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.sim.close()

    def execute(
        self,
        orders: Sequence[Order],
        listeners: Sequence[Listener] = (),
        *,
        planner: str = IN_PROCESS,
        repairs: int = MOST_REPAIRS,
        wrap: Callable[[RobotPerformer], Performer] | None = None,
    ) -> Execution:
        """Carry out a plan, with its events sent to listeners.

        ``repairs`` is the maximum number of replannings. ``wrap`` makes another performer of the robot, for experiments
        that inject faults.
        """
        robot = RobotPerformer(self.cell, self.skills)
        performer: Performer = robot if wrap is None else wrap(robot)
        recorder = Recorder(orders, listeners)

        def watch(step: ExecutedStep) -> None:
            self._show(step.state)
            recorder.end(step)

        executor = Executor(
            self.problem, self._observer, performer, planner=planner, most_repairs=repairs,
            begin=recorder.begin, watch=watch,
        )  # fmt: skip
        return executor.execute([order.instruction for order in orders])

    def _show(self, state: State) -> None:
        scene, skills = self.cell.scene, self.skills
        contents: dict[str, list[str]] = {}
        for atom in sorted(state):
            if atom.predicate == skills.contents and len(atom.args) == 2:
                contents.setdefault(atom.args[0], []).append(atom.args[1])
        for name in scene.items():
            scene.show(name, contents.get(name, ()))
        for predicate in skills.signs:
            shown = {atom.args[0] for atom in state if atom.predicate == predicate}
            for name in scene.names():
                scene.sign(name, predicate, name in shown)


class _Pace:
    """Limits a simulation to real time."""

    def __init__(self, sim: Simulator) -> None:
        self._steps, self._due = sim.steps, time.monotonic()

    def __call__(self, sim: Simulator) -> None:
        self._due += 1 / STEPS_PER_SECOND if sim.steps > self._steps else TICK
        self._steps = sim.steps
        ahead = self._due - time.monotonic()
        if ahead > 0:
            time.sleep(ahead)
        else:
            self._due = time.monotonic()  # what took long is not made up for
