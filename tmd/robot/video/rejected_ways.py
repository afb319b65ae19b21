"""The ways that a robot rejected: what it tried in vain for each failed instruction, with pictures."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from math import degrees

from tmd.pddl.model import GroundAtom
from tmd.robot.assets.features import robot_colour
from tmd.robot.monitor.listeners import Title
from tmd.robot.pr2.urdf import BASE_JOINTS, TORSO
from tmd.robot.session import SimulationSession
from tmd.robot.sim.pose import Pose
from tmd.robot.skills.results import ExecutedStep
from tmd.robot.video.camera import FOV, Camera

_PICTURE = (400, 300)
# Pictures of one instruction: neighbours look alike.
_MOST = 12


@dataclass(frozen=True, slots=True)
class _Way:
    """A rejected way: what was where, what it met there, and its picture, a JPEG file in base 64."""

    what: str
    place: str
    met: tuple[str, ...]
    picture: str


@dataclass(frozen=True, slots=True)
class FailedStep:
    """A failed instruction, with its rejected ways, and the number of those without a picture."""

    title: Title
    reason: str
    ways: tuple[_Way, ...]
    more: int


class RejectedWays:
    """A listener that takes pictures of rejected ways as they are rejected."""

    def __init__(self, session: SimulationSession) -> None:
        self._cell, self._skills = session.cell, session.skills
        self._camera = Camera(session.cell)
        self._names: list[str] = []
        self._ways: dict[tuple[str, str, frozenset[str]], _Way] = {}
        self._more = 0
        self.failures: list[FailedStep] = []
        session.cell.rejected = self._reject

    def begin(self, title: Title, expected: Sequence[GroundAtom]) -> None:
        """Begin an instruction, of which nothing was rejected yet."""
        task, known = self._skills.task(title.instruction), self._cell.scene.names()
        self._names = [name for name in (task.object, task.target) if name in known]
        self._ways, self._more = {}, 0

    def end(self, title: Title, step: ExecutedStep) -> None:
        """Keep what was rejected if the instruction failed."""
        if step.failure:
            self.failures.append(FailedStep(title, step.failure, tuple(self._ways.values()), self._more))

    def _reject(
        self, what: str, met: frozenset[str], positions: Mapping[str, float], hand: tuple[str, Pose] | None
    ) -> None:
        key = what, self._place(positions, hand), met
        if key in self._ways:
            return
        if len(self._ways) == _MOST:
            self._more += 1
            return
        with self._floating(*hand) if hand else self._cell.robot.as_if(positions):
            self._camera.follow(self._names, wide=BASE_JOINTS[0] in positions)
            self._ways[key] = _Way(*key[:2], tuple(sorted(met)), self._picture())

    def _place(self, positions: Mapping[str, float], hand: tuple[str, Pose] | None) -> str:
        if hand is not None:
            side, tool = hand
            return f"{side} hand at {' '.join(f'{value:z.2f}' for value in tool.position)}"
        base = [positions.get(joint) for joint in BASE_JOINTS]
        x, y, heading = (here if at is None else at for at, here in zip(base, self._cell.robot.base(), strict=True))
        torso = positions.get(TORSO, self._cell.robot.torso())
        return f"from {x:z.2f} {y:z.2f}, facing {degrees(heading):z.0f}°, torso at {torso:.2f} m"

    def _picture(self) -> str:
        from PIL import Image

        view, sim, stored = self._camera.view, self._cell.sim, BytesIO()
        pixels = sim.picture(view.eye, view.target, *_PICTURE, fov=FOV, shadow=sim.renderer != "tiny")
        Image.fromarray(pixels).save(stored, "JPEG", quality=80)
        return b64encode(stored.getvalue()).decode()

    @contextmanager
    def _floating(self, side: str, tool: Pose) -> Iterator[None]:
        """Show nothing of the robot but a hand at a pose, with what it holds."""
        robot, sim = self._cell.robot, self._cell.sim
        hand = set(robot.tree.below(f"{side[0]}_wrist_roll_link"))
        hidden = [name for name in robot.index if name not in hand]
        moved = [(robot.body, sim.pose(robot.body))]
        moved += [(held.body, sim.pose(held.body)) for held in robot.helds() if held.side == side]
        motions = [(body, sim.motion(body)) for body, _ in moved]
        shift = tool * robot.tool(side).inverse()
        try:
            for body, pose in moved:
                sim.set_pose(body, shift * pose)
            for name in hidden:
                sim.colour(robot.body, robot.index[name], (0.0, 0.0, 0.0, 0.0))
            yield
        finally:
            for name in hidden:
                sim.colour(robot.body, robot.index[name], robot_colour(name))
            for body, motion in motions:
                sim.set_motion(body, motion)
