"""The simulated robot carries a plan out, under physics; its run is recorded, so that visitors can look back."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from threading import Event

from tmd.diagnostics import TmdError
from tmd.inference.ranking import RankedPlan
from tmd.pddl.model import GroundAtom
from tmd.robot.monitor.listeners import Order, Title
from tmd.robot.run_plan import run_plan
from tmd.robot.session import SimulationSession
from tmd.robot.sim.pose import Pose
from tmd.robot.sim.simulator import STEPS_PER_SECOND, Simulator
from tmd.robot.skills.results import ExecutedStep, SkillStatus
from tmd.robot.video.rejected_ways import FailedStep, RejectedWays
from tmd.robot.video.symbolic_renderer import Colour
from tmd.studio.environment_view import Reel, Setting
from tmd.view.subject import PlannedStep, planned_steps
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder

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

    The environment must have shapes. ``moved`` is called after each moment, ``advanced`` when an instruction begins or
    ends, and at the end of the run.

    Attributes:
        done: The instructions that were done, each with its clause, *repair* for what the monitor put in.
        faults: What was not as predicted, by the number of the instruction.
        now: The instruction that is being done; ``None`` between two of them.
        left: The steps of the plan that are still to be done.
        moments: The poses, in order; empty until the simulation is there.
        ended: Set to stop the run.
        over: How it ended, in words; empty while it goes on.
        failed: Whether the robot could not do it.
        rejected: The instructions that failed, with the ways that were tried in vain.
    """

    def __init__(
        self, setting: Setting, plan: RankedPlan, moved: Callable[[], None], advanced: Callable[[], None]
    ) -> None:
        super().__init__(setting)
        assert setting.look is not None
        self._still = setting.look.still
        self._orders = [Order(step.instruction, step.clause, step.latent) for step in plan.steps]
        self._lines = planned_steps(plan)
        self._moved, self._advanced = moved, advanced
        self._colours = self._still.colours(self.facts(0))
        self._session: SimulationSession | None = None
        self._ticks = 0
        self.planned = plan.instructions
        self.done: list[PlannedStep] = []
        self.faults: dict[int, list[str]] = {}
        self.now: Title | None = None
        self.left = list(self._lines)
        self.moments: list[Moment] = []
        self.ended = Event()
        self.over = ""
        self.failed = False
        self.rejected: list[FailedStep] = []

    @property
    def lines(self) -> list[PlannedStep]:
        """The instructions that were done, and those that are still to be done."""
        return [*self.done, *self.left]

    def after(self, step: int) -> int:
        """Return the number of the moment when so many instructions were done."""
        return next((n for n, moment in enumerate(self.moments) if moment.step >= step), max(len(self.moments) - 1, 0))

    def carry_out(self, folder: DomainFolder) -> None:
        """Let the simulated robot carry out the plan.

        Raises:
            MissingToolError: The simulator is not installed.
            TmdError: The domain has no skills, or no shapes.
        """
        try:
            environment, problem = load_environment(self.setting.path), self.setting.world.task.problem
            ran = run_plan(environment, folder, problem, self._orders, prepare=self._prepare, pictures=True)
            execution = ran.execution
            self.failed = execution.status is SkillStatus.STOPPED
            reason = f": {execution.reason}" if execution.reason else ""
            self.over = (
                f"the robot stopped{reason}." if self.failed else f"The robot's run ended: {execution.status}{reason}."
            )
        except _StoppedError:
            self.over = f"The robot was stopped, {len(self.done)} of {len(self._orders)} steps done."
        except TmdError as error:
            self.over, self.failed = f"The robot cannot do it: {error.message}.", True
            raise
        finally:
            self.over = self.over or "The robot's run broke off."
            self.now, self.left, self._session = None, [], None
            self.ended.set()
            self._advanced()

    def _prepare(self, session: SimulationSession) -> tuple[RobotRun, RejectedWays]:
        self._session, rejected = session, RejectedWays(session)
        self.rejected = rejected.failures
        self._look()
        session.sim.add_watcher(self._watch)
        return self, rejected

    def _watch(self, sim: Simulator) -> None:
        """Record every so many steps of the simulation."""
        if self.ended.is_set():
            raise _StoppedError
        self._ticks += 1
        if self._ticks % (STEPS_PER_SECOND // RATE) == 0:
            self._look()

    def _look(self) -> None:
        """Record where everything is now."""
        assert self._session is not None
        scene, sim, robot = self._session.cell.scene, self._session.sim, self._session.cell.robot
        objects = {name: sim.pose(scene.bodies[name]) for name in scene.blueprints}
        links = {
            (name, link): objects[name].inverse() * sim.pose(scene.bodies[name], scene.link(name, link))
            for name, blueprint in scene.blueprints.items()
            for link, each in blueprint.model.links.items()
            if each.kind in ("revolute", "prismatic")
        }
        self.moments.append(Moment(objects, links, robot.positions(), self._colours, len(self.done)))
        self._moved()

    def begin(self, title: Title, expected: Sequence[GroundAtom]) -> None:
        """Take up the beginning of an instruction."""
        self.now = title
        rest = self._lines[title.number - 1 :]
        self.left = [PlannedStep(title.instruction, "repair"), *rest] if title.repair else rest
        self._advanced()

    def end(self, title: Title, step: ExecutedStep) -> None:
        """Take up its result, and the state that was observed."""
        self.done.append(self.left.pop(0))
        self.now = None
        wrong = [step.failure] if step.failure else [str(mismatch) for mismatch in step.mismatches]
        if wrong:
            self.faults[len(self.done)] = [f"✗ {each}" for each in wrong]
        self.states = (*self.states, self.setting.world.task.encode(step.state))
        self._colours = self._still.colours(step.state)
        self._look()
        self._advanced()
