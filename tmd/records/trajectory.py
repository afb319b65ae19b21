"""The lines of ``tmd run --trajectory FILE.jsonl``: what the robot's joints, its base and the things did."""

from __future__ import annotations

from typing import Literal, TypeAlias

from pydantic import Field

from tmd.json_record import JsonRecord, Rounded, rounded
from tmd.robot.sim.pose import Pose
from tmd.robot.state_recorder import Recorded, Sample

# Position x, y, z and unit quaternion x, y, z, w.
PoseRecord: TypeAlias = tuple[float, float, float, float, float, float, float]


def pose_record(pose: Pose) -> PoseRecord:
    """Return a pose in seven rounded numbers."""
    (x, y, z), (qx, qy, qz, qw) = pose.position, pose.orientation
    return rounded(x), rounded(y), rounded(z), rounded(qx), rounded(qy), rounded(qz), rounded(qw)


class _TrajectoryLine(JsonRecord):
    """A line of a trajectory; its kind stands first."""

    WHAT = "a line of a trajectory of tmd run"
    REMAKE = "make it again with tmd run --trajectory"

    event: str


class SceneLine(_TrajectoryLine):
    """The first line: where the furniture stands, which does not move."""

    event: Literal["scene"]
    environment: str
    rate: float = Field(description="Samples a second of simulated time.")
    fixtures: dict[str, PoseRecord] = Field(description="Position x, y, z in metres, quaternion x, y, z, w.")

    @classmethod
    def of(cls, what: Recorded) -> SceneLine:
        """Return the line of a recording that begins."""
        poses = {name: pose_record(pose) for name, pose in what.fixtures.items()}
        return cls(event="scene", environment=what.environment, rate=what.rate, fixtures=poses)


class SampleLine(_TrajectoryLine):
    """The scene at one moment."""

    event: Literal["sample"]
    time: Rounded = Field(description="Seconds of simulated time.")
    number: int = Field(description="The place in the plan of the instruction that is being done, from 1; 0: none.")
    instruction: str
    base: tuple[Rounded, Rounded, Rounded] = Field(description="x, y in metres, theta in radians.")
    joints: dict[str, Rounded] = Field(description="Of the robot: radians or metres.")
    objects: dict[str, PoseRecord] = Field(description="Position x, y, z in metres, quaternion x, y, z, w.")
    object_joints: dict[str, Rounded] = Field(description="Of doors, drawers, lids, knobs, buttons: radians or metres.")

    @classmethod
    def of(cls, sample: Sample) -> SampleLine:
        """Return the line of a sample."""
        poses = {name: pose_record(pose) for name, pose in sample.objects.items()}
        return cls.copied(sample, event="sample", objects=poses)


TrajectoryLine: TypeAlias = SceneLine | SampleLine
