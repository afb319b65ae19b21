"""Results of skills and of whole plans."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from tmd.pddl.model import GroundAtom, Instruction, State
from tmd.short_repr import short_repr


class SkillPhase(StrEnum):
    """The phase of a skill in which something failed."""

    # The start of the skill is not as required.
    PRECONDITION = "precondition"
    # No place to stand, and no posture of the arm, reaches what is wanted.
    STANCE = "stance"
    # There is no way there without touching something.
    PATH = "path"
    # The robot did not get to where it should, within its steps.
    EXECUTION = "execution"
    # The gripper is where it should be and touches nothing.
    CONTACT = "contact"
    # Everything was done, and the thing did not move as it should.
    EFFECT = "effect"
    # It would have taken longer than an instruction may.
    TIME = "time"


class SkillError(Exception):
    """Failure of a skill at a stage, with the reason and its numbers."""

    def __init__(self, stage: SkillPhase, reason: str) -> None:
        super().__init__(f"{stage}: {reason}")
        self.stage = stage
        self.reason = reason


class Basis(StrEnum):
    """The basis of an effect."""

    # A sensor of the simulation shows it.
    MEASURED = "measured"
    # It follows from measurements, by a rule that is given with it.
    INFERRED = "inferred"
    # PDDL says so, and nothing speaks against it.
    ASSUMED = "assumed"


@dataclass(frozen=True, slots=True)
class KnownEffect:
    """A fact that an instruction changed as PDDL predicts; ``how`` gives the numbers, or the rule."""

    atom: GroundAtom
    holds: bool
    basis: Basis
    how: str

    def __str__(self) -> str:
        return f"{'' if self.holds else 'not '}{self.atom}"


@dataclass(frozen=True, slots=True)
class Mismatch:
    """A fact that is not as PDDL predicted: whether it should hold, and what the simulation shows."""

    atom: GroundAtom
    expected: bool
    measured: str

    def __str__(self) -> str:
        return f"{'' if self.expected else 'not '}{self.atom} was expected, but {self.measured}"


@short_repr(lambda step: f"{step.instruction}: {step.failure or step.evidence}")
@dataclass(frozen=True, slots=True)
class ExecutedStep:
    """One instruction, as it went.

    Attributes:
        repair: Whether the monitor put it in.
        failure: The reason of the skill's failure, with its stage; empty without one.
        evidence: Shows that the skill's event happened.
        effects: The changes as predicted, each with its basis.
        mismatches: The facts that are not as predicted.
        begin: The simulation's step at the start.
        end: And at the end.
        state: As observed then.
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
    """The end of an execution."""

    # Every instruction was done, and every effect on what the plan names is as predicted.
    DONE = "done"
    # Something was not as predicted, the executor replanned if needed, and all that the plan is for holds.
    RECOVERED = "recovered"
    # It could not be done; the reason says why.
    STOPPED = "stopped"


@short_repr(lambda run: f"{run.status}, {len(run.steps)} step(s) {run.reason}".strip())
@dataclass(frozen=True, slots=True)
class Execution:
    """A plan, as it went.

    Attributes:
        reason: Of a stop; else empty.
        steps: One for each instruction that was tried, in order.
        repairs: Number of replannings.
        state: The last observed state.
        lasting: Differences at the end from the plan's final state that are no aim of the plan.
    """

    status: SkillStatus
    reason: str
    steps: tuple[ExecutedStep, ...]
    repairs: int
    state: State
    lasting: tuple[Mismatch, ...] = ()
