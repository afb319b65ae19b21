"""``robot/`` of ``tmd experiment``: trials of predictions on the robot, or the reason why there are none."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from tmd.json_record import JsonRecord
from tmd.records.run import RanStep


class TrialRequest(JsonRecord):
    """Request that decides the outcome of a trial; ``id`` is null where no prediction can be executed."""

    environment: str
    model: str
    id: str | int | None
    text: str
    plan: tuple[str, ...]
    mode: Literal["kinematic", "physics"]
    seed: int
    version: str


class Trial(JsonRecord):
    """A plan that a robot was given, and what came of it."""

    WHAT = "a trial of tmd experiment"
    REMAKE = "remove that file, and let the robot act again: --step robot"

    asked: TrialRequest
    status: Literal["done", "recovered", "stopped", "no_plan", "no_scene"] = Field(
        description="How it ended; no_plan and no_scene did not begin."
    )
    reason: str = ""
    repairs: int = 0
    seconds: float = Field(default=0.0, description="Simulated; 0 without physics.")
    steps: tuple[RanStep, ...] = ()
    film: str | None = Field(default=None, description="The file of the film beside the record.")
    strip: str | None = Field(default=None, description="The file of the filmstrip.")
    poster: str | None = Field(default=None, description="The file of the film's last picture.")


class Skip(JsonRecord):
    """Reason why there are no trials."""

    WHAT = "the reason why there are no trials"
    REMAKE = Trial.REMAKE

    reason: str
