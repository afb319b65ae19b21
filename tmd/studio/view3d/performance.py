"""The simulated robot carries a plan out, under physics, and a visitor watches."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from threading import Event
from typing import TYPE_CHECKING

from tmd.inference.ranking import RankedPlan
from tmd.pddl.model import GroundAtom
from tmd.robot.monitor.listeners import Order, Title
from tmd.robot.run_plan import run_plan
from tmd.robot.session import SimulationSession
from tmd.studio.environment_view import Look, Setting
from tmd.studio.view3d.meshes import Figure
from tmd.studio.view3d.scenery import Scenery
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder

if TYPE_CHECKING:
    from tmd.robot.sim.simulator import Simulator
    from tmd.robot.skills.results import ExecutedStep

# Physics steps from one picture to the next: 15 a simulated second.
EVERY = 16


class _StoppedError(Exception):
    """The visitor stopped the run."""


@dataclass(slots=True)
class _Audience:
    """A visitor who watches a running simulation until ``ended`` is set; ``begun`` is called with each instruction."""

    session: SimulationSession
    scenery: Scenery
    look: Look
    figure: Figure
    ended: Event
    begun: Callable[[Title], None]
    ticks: int = 0

    def __call__(self, sim: Simulator) -> None:
        """Show every 16th step of the simulation."""
        if self.ended.is_set():
            raise _StoppedError
        self.ticks += 1
        if self.ticks % EVERY == 0:
            self.show()

    def show(self) -> None:
        """Show where everything is now."""
        scene, sim = self.session.cell.scene, self.session.sim
        objects = {name: sim.pose(scene.bodies[name]) for name in scene.blueprints}
        links = {
            (name, link): objects[name].inverse() * sim.pose(scene.bodies[name], scene.link(name, link))
            for name, blueprint in scene.blueprints.items()
            for link, each in blueprint.model.links.items()
            if each.kind in ("revolute", "prismatic")
        }
        self.scenery.move(objects, links, self.figure.links(self.session.cell.robot.positions()))

    def begin(self, title: Title, expected: Sequence[GroundAtom]) -> None:
        """Announce an instruction."""
        self.begun(title)

    def end(self, title: Title, step: ExecutedStep) -> None:
        """Show the colours that an instruction changed."""
        for place, colour in self.look.still.colours(step.state).items():
            self.scenery.paint(place, colour)


def perform(
    setting: Setting,
    folder: DomainFolder,
    plan: RankedPlan,
    scenery: Scenery,
    figure: Figure,
    ended: Event,
    begun: Callable[[Title], None],
) -> str:
    """Let the simulated robot carry out a plan, and show it.

    Args:
        setting: Where.
        folder: The domain.
        plan: The plan.
        scenery: The visitor's view.
        figure: The robot.
        ended: Set to stop the run.
        begun: Called with each instruction that begins.

    Returns:
        How it ended, in words.

    Raises:
        MissingToolError: The simulator is not installed.
        TmdError: The domain has no skills, or no shapes.
    """
    look = setting.look
    if look is None:
        return setting.blind
    orders = [Order(step.instruction, step.clause, step.latent) for step in plan.steps]

    def watched(session: SimulationSession) -> tuple[_Audience]:
        audience = _Audience(session, scenery, look, figure, ended, begun)
        audience.show()
        session.sim.add_watcher(audience)
        return (audience,)

    try:
        environment, problem = load_environment(setting.path), setting.world.task.problem
        execution = run_plan(environment, folder, problem, orders, prepare=watched).execution
    except _StoppedError:
        return "Stopped."
    reason = f": {execution.reason}" if execution.reason else ""
    return f"The robot's run ended: {execution.status}{reason}."
