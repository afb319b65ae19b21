"""What came of a skill, and of a whole plan."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from tmd.pddl.model import Instruction, State
from tmd.robot.monitor.inference import KnownEffect
from tmd.robot.monitor.observation import Mismatch


class SkillPhase(StrEnum):
    """Where in a skill something failed."""

    PRECONDITION = "precondition"
    """What the skill starts from is not there."""
    STANCE = "stance"
    """No place to stand, and no posture of the arm, reaches what is wanted."""
    PATH = "path"
    """There is no way there without touching something."""
    EXECUTION = "execution"
    """The robot did not get to where it should, within its steps."""
    CONTACT = "contact"
    """The gripper is where it should be and touches nothing."""
    EFFECT = "effect"
    """Everything was done, and the thing did not move as it should."""
    TIME = "time"
    """It would have taken longer than an instruction may."""


class SkillError(Exception):
    """A skill could not be done.

    Args:
        stage: Where it failed.
        reason: Why, with the numbers.
    """

    def __init__(self, stage: SkillPhase, reason: str) -> None:
        super().__init__(f"{stage}: {reason}")
        self.stage = stage
        self.reason = reason


@dataclass(frozen=True, slots=True)
class ExecutedStep:
    """One instruction, as it went.

    Attributes:
        instruction: What was done.
        repair: Whether the monitor put it in.
        failure: Why the skill failed, with its stage; empty where it did not.
        evidence: What showed that the skill's event happened.
        effects: What changed as predicted, each with what it is known by.
        mismatches: The facts that are not as predicted.
        begin: The simulation's step at the start.
        end: And at the end.
        state: What was observed then.
    """

    instruction: Instruction
    repair: bool
    failure: str
    evidence: str
    effects: tuple[KnownEffect, ...]
    mismatches: tuple[Mismatch, ...]
    begin: int
    end: int
    state: State


class SkillStatus(StrEnum):
    """How an execution ended."""

    DONE = "done"
    """Every instruction was done, and every effect is as predicted."""
    RECOVERED = "recovered"
    """Something was not as predicted, the executor replanned if needed, and all that the plan is for holds."""
    STOPPED = "stopped"
    """It could not be done; the reason says why."""


@dataclass(frozen=True, slots=True)
class Execution:
    """A plan, as it went.

    Attributes:
        status: How it ended.
        reason: Why it stopped; empty where it did not.
        steps: One for each instruction that was tried, in order.
        repairs: How often the executor replanned.
        state: The last state that was observed.
        lasting: What is otherwise at the end than the plan would have left it, and no aim of the plan.
    """

    status: SkillStatus
    reason: str
    steps: tuple[ExecutedStep, ...]
    repairs: int
    state: State
    lasting: tuple[Mismatch, ...] = ()
