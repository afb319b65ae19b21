"""Instructions to skills: what an instruction is for is in ``skills.yaml``, how it is done in the skills."""

from __future__ import annotations

from collections.abc import Collection

from tmd.pddl.model import GroundAtom, Instruction
from tmd.robot.skills import articulated, navigate_and_look, pick_and_place, pour_and_dip
from tmd.robot.skills.results import SkillError, SkillPhase
from tmd.robot.skills.robot_context import Cell
from tmd.robot.skills.skill_file import Skills, SkillTask


class RobotPerformer:
    """A robot that does instructions.

    Args:
        cell: Robot and scene.
        skills: Which skill does which action.
    """

    def __init__(self, cell: Cell, skills: Skills) -> None:
        self.cell = cell
        self.skills = skills

    @property
    def clock(self) -> int:
        """Steps and ticks so far."""
        return self.cell.sim.ticks

    def perform(self, instruction: Instruction, gains: Collection[GroundAtom], attempt: int) -> str:
        """Do it; see :class:`tmd.robot.monitor.executor.Performer`."""
        task = self.skills.task(instruction)
        said = self._do(task, gains, attempt)
        if task.skill == "push":
            seen = {p for p, sensor in self.skills.seen.items() if sensor == "joint"}
            springs = sorted(a.args[0] for a in gains if a.predicate in seen and a.args[0] != task.object)
            for name in springs:
                navigate_and_look.step_back(self.cell, name)
                self.cell.spring(name)
        return said

    def _do(self, task: SkillTask, gains: Collection[GroundAtom], attempt: int) -> str:
        cell, name = self.cell, task.object
        match task.skill:
            case "look":
                return navigate_and_look.look(cell, name)
            case "drive":
                return navigate_and_look.drive(cell, name, attempt)
            case "wait":
                return navigate_and_look.wait(cell, task.seconds)
            case "pick":
                return pick_and_place.pick(cell, name, attempt)
            case "place":
                return pick_and_place.place(cell, name, task.target, task.relation, attempt)
            case "drop":
                return pick_and_place.drop(cell, name, self._below(name, gains), attempt)
            case "open" | "close":
                return articulated.swing(cell, name, attempt, opened=task.skill == "open")
            case "push":
                return articulated.push(cell, name, attempt)
            case "rotate":
                return articulated.rotate(cell, name, task.setting, attempt)
            case "dip":
                return pour_and_dip.dip(cell, name, task.target, attempt)
            case "tip" | "squeeze":
                return pour_and_dip.tip(cell, name, task.target, attempt, squeezed=task.skill == "squeeze")

    def _below(self, item: str, gains: Collection[GroundAtom]) -> str:
        """What an item lands on when it is let go of."""
        seen = {p for p, sensor in self.skills.seen.items() if sensor == "support"}
        for atom in sorted(gains):
            if atom.predicate in seen and atom.args[0] == item:
                return atom.args[1]
        raise SkillError(SkillPhase.PRECONDITION, f"there is nothing that {item} could land on")
