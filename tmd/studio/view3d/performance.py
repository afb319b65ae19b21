"""The simulated robot carries a plan out, under physics; its run is recorded, so that visitors can look back."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from threading import Event
from typing import TYPE_CHECKING

from tmd.diagnostics import TmdError
from tmd.inference.ranking import RankedPlan
from tmd.pddl.model import GroundAtom, Instruction
from tmd.robot.monitor.listeners import Order, Title
from tmd.robot.run_plan import run_plan
from tmd.robot.session import SimulationSession
from tmd.robot.sim.pose import Pose
from tmd.robot.sim.simulator import STEPS_PER_SECOND
from tmd.robot.video.symbolic_renderer import Colour
from tmd.studio.environment_view import Reel, Setting
from tmd.view.panels import StepLine
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder

if TYPE_CHECKING:
    from tmd.robot.sim.simulator import Simulator
    from tmd.robot.skills.results import ExecutedStep

# Moments of a simulated second.
RATE = 8


@dataclass(frozen=True, slots=True)
class Moment:
    """Poses at one moment of a run.

    Attributes:
        objects: Of the objects, in the world.
        links: Of the links of objects, in the frames of their objects.
        joints: The positions of the robot's joints.
        colours: Of the links that show a state or a content, by object and link.
        step: The number of instructions that were done before.
    """

    objects: Mapping[str, Pose]
    links: Mapping[tuple[str, str], Pose]
    joints: Mapping[str, float]
    colours: Mapping[tuple[str, str], Colour]
    step: int


class _StoppedError(Exception):
    """The visitor stopped the run."""


class RobotRun(Reel):
    """The robot's run of a plan: the observed states, and the moments in between.

    Attributes:
        planned: The plan.
        done: The instructions that were done, each with its clause, *repair* for what the monitor put in.
        faults: What was not as predicted, by the number of the instruction.
        now: The instruction that is being done; ``None`` between two of them.
        left: The steps of the plan that are still to be done.
        moments: The poses, in order; empty until the simulation is there.
        ended: Set to stop the run.
        over: How it ended, in words; empty while it goes on.
    """

    def __init__(self, setting: Setting, plan: RankedPlan) -> None:
        super().__init__(setting)
        self._orders = [Order(step.instruction, step.clause, step.latent) for step in plan.steps]
        self._lines = plan_lines(plan)
        self.planned = plan.instructions
        self.done: list[StepLine] = []
        self.faults: dict[int, list[str]] = {}
        self.now: Title | None = None
        self.left = list(self._lines)
        self.moments: list[Moment] = []
        self.ended = Event()
        self.over = ""

    @property
    def lines(self) -> list[StepLine]:
        """The instructions that were done, and those that are still to be done."""
        return [*self.done, *self.left]

    @property
    def instructions(self) -> list[Instruction]:
        """The same, without their purposes."""
        return [line.instruction for line in self.lines]

    def after(self, step: int) -> int:
        """Return the number of the moment when so many instructions were done."""
        return next((n for n, moment in enumerate(self.moments) if moment.step >= step), max(len(self.moments) - 1, 0))

    def carry_out(self, folder: DomainFolder, moved: Callable[[], None], advanced: Callable[[], None]) -> None:
        """Let the simulated robot carry out the plan.

        Args:
            folder: The domain.
            moved: Called after each moment.
            advanced: Called when an instruction begins or ends, and at the end of the run.

        Raises:
            MissingToolError: The simulator is not installed.
            TmdError: The domain has no skills, or no shapes.
        """

        def watched(session: SimulationSession) -> tuple[_Witness]:
            witness = _Witness(self, session, moved, advanced)
            witness.look()
            session.sim.add_watcher(witness)
            return (witness,)

        try:
            environment, problem = load_environment(self.setting.path), self.setting.world.task.problem
            execution = run_plan(environment, folder, problem, self._orders, prepare=watched).execution
            reason = f": {execution.reason}" if execution.reason else ""
            self.over = f"The robot's run ended: {execution.status}{reason}."
        except _StoppedError:
            self.over = f"The robot was stopped, {len(self.done)} of {len(self._orders)} steps done."
        except TmdError as error:
            self.over = f"The robot cannot do it: {error.message}."
            raise
        finally:
            self.over = self.over or "The robot's run broke off."
            self.now, self.left = None, []
            self.ended.set()
            advanced()

    def begin(self, title: Title) -> None:
        """Take up the beginning of an instruction."""
        self.now = title
        rest = self._lines[title.number - 1 :]
        self.left = [StepLine(title.instruction, "repair"), *rest] if title.repair else rest

    def end(self, step: ExecutedStep) -> None:
        """Take up its result, and the state that was observed."""
        self.done.append(self.left.pop(0))
        self.now = None
        wrong = [step.failure] if step.failure else [str(mismatch) for mismatch in step.mismatches]
        if wrong:
            self.faults[len(self.done)] = [f"✗ {each}" for each in wrong]
        self.states = (*self.states, self.setting.world.task.encode(step.state))


def plan_lines(plan: RankedPlan) -> list[StepLine]:
    """Return the steps of a plan, each with its clause."""
    return [
        StepLine(each.instruction, f"clause {each.clause + 1}" + (", unsaid" if each.latent else ""), each.latent)
        for each in plan.steps
    ]


class _Witness:
    """Records a simulation, and tells of it."""

    def __init__(
        self, run: RobotRun, session: SimulationSession, moved: Callable[[], None], advanced: Callable[[], None]
    ) -> None:
        assert run.setting.look is not None
        self._run, self._session, self._moved, self._advanced = run, session, moved, advanced
        self._still = run.setting.look.still
        self._colours = self._still.colours(run.facts(0))
        self._ticks = 0

    def __call__(self, sim: Simulator) -> None:
        """Record every so many steps of the simulation."""
        if self._run.ended.is_set():
            raise _StoppedError
        self._ticks += 1
        if self._ticks % (STEPS_PER_SECOND // RATE) == 0:
            self.look()

    def look(self) -> None:
        """Record where everything is now."""
        scene, sim = self._session.cell.scene, self._session.sim
        objects = {name: sim.pose(scene.bodies[name]) for name in scene.blueprints}
        links = {
            (name, link): objects[name].inverse() * sim.pose(scene.bodies[name], scene.link(name, link))
            for name, blueprint in scene.blueprints.items()
            for link, each in blueprint.model.links.items()
            if each.kind in ("revolute", "prismatic")
        }
        joints = self._session.cell.robot.positions()
        self._run.moments.append(Moment(objects, links, joints, self._colours, len(self._run.done)))
        self._moved()

    def begin(self, title: Title, expected: Sequence[GroundAtom]) -> None:
        """Announce an instruction."""
        self._run.begin(title)
        self._advanced()

    def end(self, title: Title, step: ExecutedStep) -> None:
        """Take up the state that an instruction led to."""
        self._run.end(step)
        self._colours = self._still.colours(step.state)
        self.look()
        self._advanced()
