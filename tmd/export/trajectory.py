"""Recordings of runs as files: JSON Lines, and MCAP for ROS 2.

=========== ==============================================================================================
``.jsonl``  one object a line (:mod:`tmd.records.trajectory`)
``.mcap``   ROS 2 messages (``sensor_msgs/JointState``, ``tf2_msgs/TFMessage``, ``std_msgs/String``) in CDR
=========== ==============================================================================================
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from math import cos, sin
from pathlib import Path
from types import TracebackType
from typing import IO, Any, Self

from tmd.diagnostics import MissingToolError, OutputError, install_extra
from tmd.files import writing
from tmd.records.trajectory import SampleLine, SceneLine, pose_record
from tmd.robot.pr2.kinematics import Array, Link, Tree, motion
from tmd.robot.session import SimulationSession
from tmd.robot.sim.pose import Pose
from tmd.robot.state_recorder import Recorded, Sample, StateRecorder

SUFFIXES = (".jsonl", ".mcap")
DEFAULT_RATE = 10.0
# Frames, by the names that ROS has for them.
WORLD, BASE = "map", "base_footprint"
_HEADER = (
    "std_msgs/Header header\n", "=" * 80 + "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n",
    "=" * 80 + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n",
)  # fmt: skip
_JOINT_STATE = (
    _HEADER[0] + "string[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n" + "".join(_HEADER[1:])
)
_TF = (
    "geometry_msgs/TransformStamped[] transforms\n"
    + "=" * 80 + "\nMSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\n"
    "geometry_msgs/Transform transform\n"
    + "=" * 80 + "\nMSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\n"
    "geometry_msgs/Quaternion rotation\n"
    + "=" * 80 + "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
    + "=" * 80 + "\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
    + "".join(_HEADER[1:])
)  # fmt: skip
_STRING = "string data\n"
# What rosbag2 writes of a latched topic: keep the last message, reliable, transient local.
_QOS = "offered_qos_profiles"
_FOREVER = "{sec: 9223372036, nsec: 854775807}"
_LATCHED = (
    f"- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n  deadline: {_FOREVER}\n  lifespan: {_FOREVER}\n"
    f"  liveliness: 1\n  liveliness_lease_duration: {_FOREVER}\n  avoid_ros_namespace_conventions: false\n"
)


def open_trajectory(path: Path) -> TrajectoryFile:
    """Return a file for a recording; its suffix says of what kind.

    Raises:
        MissingToolError: What writes it is not installed.
    """
    return _Mcap(path) if path.suffix == ".mcap" else TrajectoryFile(path)


def recorders(session: SimulationSession, file: TrajectoryFile | None, rate: float) -> tuple[StateRecorder, ...]:
    """Return the recorder of a run into a file; none without a file."""
    return () if file is None else (StateRecorder(session, rate, file),)


class TrajectoryFile:
    """A recording that grows, as JSON Lines; a context that ends it. The file is made when the run begins."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._file: IO[Any] | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._file is None:
            return
        try:
            with writing(self._path):
                self._finish()
                self._file.close()
        except OutputError:
            if not isinstance(error, Exception):
                raise
        finally:
            self._file = None

    def open(self, what: Recorded) -> None:
        """Begin the recording.

        Raises:
            OutputError: It cannot be written.
        """
        with writing(self._path):
            self._file = self._make()
            self._begin(what)

    def write(self, sample: Sample) -> None:
        """Write the next sample.

        Raises:
            OutputError: It cannot be written.
        """
        with writing(self._path):
            self._add(sample)

    def _make(self) -> IO[Any]:
        return self._path.open("w", encoding="utf-8", newline="")

    @property
    def _out(self) -> IO[Any]:
        assert self._file is not None, "open() comes first"
        return self._file

    def _begin(self, what: Recorded) -> None:
        """Write the beginning, before the first sample."""
        self._out.write(SceneLine.of(what).to_line())

    def _add(self, sample: Sample) -> None:
        self._out.write(SampleLine.of(sample).to_line())

    def _finish(self) -> None:
        """Write the end, after the last sample."""


class _Mcap(TrajectoryFile):
    """Joint states, transforms, instructions and the robot's description as ROS 2 topics, from time 0 on."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        try:
            from mcap_ros2.writer import Writer
        except ImportError as error:
            hint = f"{install_extra('ros')}, or ask for a .jsonl file"
            raise MissingToolError("MCAP files need the package mcap-ros2-support", hint=hint) from error
        self._kind: Any = Writer
        self._said: tuple[int, str] | None = None

    def _make(self) -> IO[Any]:
        return self._path.open("wb")

    def _begin(self, what: Recorded) -> None:
        self._writer = self._kind(self._out)
        self._joints = self._writer.register_msgdef("sensor_msgs/msg/JointState", _JOINT_STATE)
        self._tf = self._writer.register_msgdef("tf2_msgs/msg/TFMessage", _TF)
        self._string = self._writer.register_msgdef("std_msgs/msg/String", _STRING)
        self._latch("/robot_description", self._string)
        self._latch("/tf_static", self._tf)
        urdf = what.robot.read_text(encoding="utf-8")
        self._send("/robot_description", self._string, {"data": urdf}, 0.0)
        frames = [_transform(0.0, name, pose) for name, pose in what.fixtures.items()]
        self._links, still = _links(ET.fromstring(urdf))
        frames += [_transform(0.0, name, Pose.from_matrix(frame), parent) for name, (parent, frame) in still.items()]
        self._send("/tf_static", self._tf, {"transforms": frames}, 0.0)

    def _latch(self, topic: str, schema: Any) -> None:  # noqa: ANN401 - theirs
        """Let players publish ``topic`` so that those who subscribe later get its message as well."""
        # the writer of messages has no argument for what a channel is described with
        channel = self._writer._writer.register_channel(topic, "cdr", schema.id, metadata={_QOS: _LATCHED})
        self._writer._channel_ids[topic] = channel

    def _add(self, sample: Sample) -> None:
        time = sample.time
        if self._said != (sample.number, sample.instruction):
            self._said = (sample.number, sample.instruction)
            self._send("/instruction", self._string, {"data": sample.instruction}, time)
        state = _joint_state(time, sample.joints, sample.velocities)
        self._send("/joint_states", self._joints, state, time)
        things = _joint_state(time, sample.object_joints, {})
        self._send("/object_joint_states", self._joints, things, time)
        frames = [_transform(time, BASE, _base(sample))]
        frames += [_transform(time, name, pose) for name, pose in sample.objects.items()]
        for link, leader, factor, shift in self._links:
            frame = link.origin @ motion(link, factor * sample.joints.get(leader, 0.0) + shift)
            frames.append(_transform(time, link.name, Pose.from_matrix(frame), link.parent))
        self._send("/tf", self._tf, {"transforms": frames}, time)

    def _send(self, topic: str, schema: Any, message: Mapping[str, object], time: float) -> None:  # noqa: ANN401 - theirs
        stamp = round(time * 1e9)
        self._writer.write_message(topic, schema, message, log_time=stamp, publish_time=stamp)

    def _finish(self) -> None:
        self._writer.finish()


def _joint_state(time: float, positions: Mapping[str, float], velocities: Mapping[str, float]) -> dict[str, object]:
    return {
        "header": {"stamp": _stamp(time), "frame_id": ""},
        "name": list(positions),
        "position": list(positions.values()),
        "velocity": [velocities[name] for name in positions] if velocities else [],
        "effort": [],
    }


def _links(robot: ET.Element) -> tuple[list[tuple[Link, str, float, float]], dict[str, tuple[str, Array]]]:
    """Return the links on joints that move, and those on fixed joints with their parents and frames.

    Each of the first has the joint that moves it, and factor and shift from the position there: of a joint that
    mimics another one, these are the other's.
    """
    moving, still = [], {}
    mimics = {joint.get("name"): mimic for joint in robot.findall("joint") for mimic in joint.findall("mimic")}
    for link in Tree(robot).links.values():
        if link.kind in ("revolute", "continuous", "prismatic"):
            of = mimics.get(link.joint, ET.Element("mimic", joint=link.joint)).attrib
            moving.append((link, of["joint"], float(of.get("multiplier", 1)), float(of.get("offset", 0))))
        else:
            still[link.name] = link.parent, link.origin
    return moving, still


def _transform(time: float, name: str, pose: Pose, parent: str = WORLD) -> dict[str, object]:
    x, y, z, qx, qy, qz, qw = pose_record(pose)
    return {
        "header": {"stamp": _stamp(time), "frame_id": parent},
        "child_frame_id": name,
        "transform": {"translation": {"x": x, "y": y, "z": z}, "rotation": {"x": qx, "y": qy, "z": qz, "w": qw}},
    }


def _base(sample: Sample) -> Pose:
    x, y, theta = sample.base
    return Pose((x, y, 0.0), (0.0, 0.0, sin(theta / 2), cos(theta / 2)))


def _stamp(time: float) -> dict[str, int]:
    whole, rest = divmod(round(time * 1e9), 1_000_000_000)
    return {"sec": whole, "nanosec": rest}
