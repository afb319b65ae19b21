"""The states that a plan or a demonstration goes through, and how each of them looks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from threading import Lock

from tmd.pddl.model import Instruction, State
from tmd.pddl.task import Bits
from tmd.robot.video.symbolic_renderer import Picture
from tmd.studio.environment_view import Setting

# Drawing is quick, and who draws keeps notes in what all visitors of a setting share.
_DRAWING = Lock()


class Reel:
    """A sequence of states, the first one that of the environment.

    Args:
        setting: The environment.

    Attributes:
        states: As bits of the environment's task; never empty.
    """

    def __init__(self, setting: Setting) -> None:
        self.setting = setting
        self.states: tuple[Bits, ...] = (setting.world.task.init,)
        self._pictures: list[Picture] = [] if setting.look is None else [setting.look.first]

    def become(self, states: Sequence[Bits]) -> None:
        """Hold other states; what is drawn of the same beginning stays."""
        same = 0
        while same < min(len(states), len(self.states)) and states[same] == self.states[same]:
            same += 1
        self.states = tuple(states)
        del self._pictures[max(same, 1) :]

    def follow(self, plan: Iterable[Instruction]) -> None:
        """Hold the states that the instructions of a plan lead through; each of them must apply."""
        task = self.setting.world.task
        states = [task.init]
        for instruction in plan:
            states.append(task.by_instruction[instruction].apply(states[-1]))
        self.become(states)

    def facts(self, step: int) -> State:
        """Return the facts after a number of steps."""
        return self.setting.world.task.decode(self.states[step])

    def picture(self, step: int) -> Picture | None:
        """Return the picture after a number of steps; ``None`` where there is nothing to see."""
        look = self.setting.look
        if look is None:
            return None
        with _DRAWING:
            while len(self._pictures) <= step:
                facts = self.facts(len(self._pictures))
                self._pictures.append(look.still.draw(facts, self._pictures[-1]))
        return self._pictures[step]
