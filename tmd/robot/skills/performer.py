"""The link from instructions to skills: ``skills.yaml`` names the skill of an action."""

from __future__ import annotations

from collections.abc import Collection, Hashable
from contextlib import suppress

from tmd.pddl.model import GroundAtom, Instruction
from tmd.robot.monitor.observation import REACH
from tmd.robot.parameters import INSTRUCTION_TIME
from tmd.robot.sim.pose import Pose
from tmd.robot.skills import articulated, navigate_and_look, pick_and_place, pour_and_dip
from tmd.robot.skills.results import SkillError, SkillPhase
from tmd.robot.skills.robot_context import Cell
from tmd.robot.skills.skill_file import Skills, SkillTask


class RobotPerformer:
    """A robot that carries out instructions, by the skills of the domain."""

    def __init__(self, cell: Cell, skills: Skills) -> None:
        self.cell = cell
        self.skills = skills

    @property
    def clock(self) -> int:
        """Steps and ticks so far."""
        return self.cell.sim.ticks

    def situation(self) -> Hashable:
        """Return poses to the centimetre, joints to a tenth of their way."""
        cell = self.cell
        poses = [cell.sim.pose(cell.scene.bodies[item]) for item in cell.scene.items()]
        held = tuple(sorted((side, item, _rounded(cell.in_tool(side, item))) for side, item in cell.in_hand.items()))
        loose = tuple(
            _rounded(pose)
            for item, pose in zip(cell.scene.items(), poses, strict=True)
            if item not in cell.in_hand.values()
        )
        joints = tuple(round(10 * cell.way(name)) for name in cell.scene.names() if cell.has_joint(name))
        return held, loose, joints

    def idle(self, instruction: Instruction) -> bool:
        """See :class:`tmd.robot.monitor.executor.Performer`."""
        return self.skills.task(instruction).skill in ("look", "drive", "wait")

    def perform(self, instruction: Instruction, gains: Collection[GroundAtom], attempt: int) -> str:
        """Carry it out; see :class:`tmd.robot.monitor.executor.Performer`."""
        task = self.skills.task(instruction)
        self.cell.until = self.cell.sim.work + 1e6 * INSTRUCTION_TIME
        try:
            said = self._do(task, gains, attempt)
        except SkillError as error:
            if error.stage in (SkillPhase.STANCE, SkillPhase.PATH, SkillPhase.TIME):
                self._remember(task)
            raise
        self._stay_near(task)
        if task.skill == "push":
            seen = {p for p, sensor in self.skills.seen.items() if sensor == "joint"}
            springs = sorted(a.args[0] for a in gains if a.predicate in seen and a.args[0] != task.object)
            for name in springs:
                navigate_and_look.step_back(self.cell, name)
                self.cell.spring(name)
                self.cell.moment()
        return said

    def _stay_near(self, task: SkillTask) -> None:
        """Go back to what was worked at from so far away, or after so many steps back, that it is not near."""
        if task.skill in ("close", "open", "rotate", "push") and self.cell.reach(task.object) > REACH:
            with suppress(SkillError):
                navigate_and_look.drive(self.cell, task.object, 0)

    def _remember(self, task: SkillTask) -> None:
        """Remember the poses and grips of things with which something could not be done.

        They are put down elsewhere and held in another way, if there is one, when they are taken again.
        """
        cell = self.cell
        if task.skill in ("look", "drive"):
            return
        for name in (task.object, task.target):
            item = cell.whole(name) if name else ""
            if not cell.scene.is_item(item):
                continue
            side = cell.side_of(item)
            if side is None:
                cell.unfit_spots.setdefault(item, []).append(cell.sim.pose(cell.scene.bodies[item]))
            else:
                cell.unfit_grips.setdefault(item, []).append(cell.in_tool(side, item).inverse())

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
                wet = any(self.skills.inferred.get(a.predicate) == "contents" and a.args[0] == name for a in gains)
                return pick_and_place.place(cell, name, task.target, task.relation, attempt, filled=wet)
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
        seen = {p for p, sensor in self.skills.seen.items() if sensor == "support"}
        for atom in sorted(gains):
            if atom.predicate in seen and atom.args[0] == item:
                return atom.args[1]
        raise SkillError(SkillPhase.PRECONDITION, f"there is nothing that {item} could land on")


def _rounded(pose: Pose) -> tuple[int, ...]:
    """Return a pose to the centimetre and a twentieth of a quaternion, whose sign says nothing."""
    sign = 1 if next((value for value in reversed(pose.orientation) if abs(value) > 0.025), 1) > 0 else -1
    return (*(round(100 * value) for value in pose.position), *(round(20 * sign * value) for value in pose.orientation))
