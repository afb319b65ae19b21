"""PAL's TIAGo Pro for the skills of the PR2: two arms of seven joints, parallel grippers, a lift, a mecanum base.

The skills know a robot by the names of the PR2's links and joints. :func:`adapt` gives a parsed TIAGo Pro these names
where the two have the same (:data:`OWN_JOINTS` leads back), and the frames that are meant by them: a tool frame between
the finger tips, a head that tilts about y. The grippers of PAL are closed at the greatest position and driven by a
linkage of six joints; here 0 is closed, as of the PR2, and each joint is driven by itself to the same angle.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET

import numpy as np

from tmd.robot.pr2.kinematics import origin, set_origin
from tmd.robot.sim.pose import Pose
from tmd.robot.sim.urdf_files import end_of

# Radians that the fingers turn from open to closed.
CLOSED = 0.8028514559173916
# Metres between the frames of the finger tips when their surfaces would meet: they come to 8 mm of each other.
TIP_OFFSET = 0.023
# Metres from the palm's frame to the tool's. The finger tips then reach 1 mm (open) to 18 mm (closed) beyond it, for
# they swing forward as they close: a hand comes as near to the table as the PR2's, which reaches 18 mm.
TOOL_AHEAD = 0.158
# The camera, in the frame of head_tilt_link.
EYE = (0.06, 0.0, 0.168)
# Above the base, 0.27 m to the front and 0.37 m to the sides at most, the hands look ahead. The best of 200 000 random
# postures, by how far they reach beyond the base and its height, that touch nothing.
TUCKED: dict[str, tuple[float, ...]] = {
    "right": (-0.637, -2.299, 2.491, -2.296, 2.943, 0.958, -2.004),
    "left": (0.637, -2.299, -2.491, -2.296, -2.943, 0.958, 2.004),
}
_ARM = (
    "shoulder_pan", "shoulder_lift", "upper_arm_roll", "elbow_flex", "forearm_roll", "wrist_flex", "wrist_roll",
)  # fmt: skip
_SIDES = ("right", "left")


def _names() -> dict[str, str]:
    """Return the names of joints and links here, by their own."""
    found = {
        "head_1_joint": "head_pan_joint", "head_1_link": "head_pan_link",
        "head_2_joint": "head_tilt_joint", "head_2_link": "head_tilt_link",
    }  # fmt: skip
    for side in _SIDES:
        s = side[0]
        for number, name in enumerate(_ARM, start=1):
            found[f"arm_{side}_{number}_joint"] = f"{s}_{name}_joint"
            found[f"arm_{side}_{number}_link"] = f"{s}_{name}_link"
        found[f"gripper_{side}_base_link"] = f"{s}_gripper_palm_link"
        for theirs, ours in (("right", "l"), ("left", "r")):  # seen from the palm
            for kind, part in (("inner_finger", "finger"), ("fingertip", "finger_tip")):
                for what in ("joint", "link"):
                    found[f"gripper_{side}_{kind}_{theirs}_{what}"] = f"{s}_gripper_{ours}_{part}_{what}"
            found[f"gripper_{side}_outer_finger_{theirs}_link"] = f"{s}_gripper_{ours}_outer_finger_link"
        found[f"gripper_{side}_finger_joint"] = f"{s}_gripper_r_outer_finger_joint"
        found[f"gripper_{side}_outer_finger_right_joint"] = f"{s}_gripper_l_outer_finger_joint"
    return found


NAMES = _names()


def _own_joints() -> dict[str, tuple[str, float, float]]:
    found = {}
    for theirs, ours in NAMES.items():
        if theirs.endswith("_joint"):
            tip, finger = "fingertip" in theirs, "finger" in theirs
            sign = -1.0 if (finger and not tip) or theirs == "head_2_joint" else 1.0
            found[ours] = (theirs, sign, (-CLOSED if tip else CLOSED) if finger else 0.0)
    return found


# By the names of the skills: the robot's own name of a joint, and sign and shift from a position here to one there.
OWN_JOINTS = _own_joints()
# Finger joints besides the four of the PR2.
COUPLED = ("gripper_l_outer_finger_joint", "gripper_r_outer_finger_joint")


def missing_joints(root: ET.Element) -> list[str] | None:
    """Return the joints of a TIAGo Pro that a parsed URDF lacks; ``None`` if it lacks the arms: it is another robot."""
    joints = {joint.get("name") for joint in root.findall("joint")}
    wanted = [name for name in NAMES if name.endswith("_joint")]
    if not joints.issuperset(name for name in wanted if name.startswith("arm_")) or "torso_lift_joint" not in joints:
        return None
    return [name for name in wanted if name not in joints]


def never_checked(root: ET.Element) -> set[tuple[str, str]]:
    """Return pairs of links that need no check, by the names of the skills.

    These are pairs joined by one joint or by fixed ones, those of one hand, and the shoulders beside the column, whose
    convex hull they are in when the lift is low. There is no SRDF of this robot in the package.
    """
    parents = {end_of(joint, "child"): (end_of(joint, "parent"), joint.get("type")) for joint in root.findall("joint")}
    carrier = {}
    for link in [each.get("name", "") for each in root.findall("link")]:
        top = link
        while top in parents and parents[top][1] == "fixed":
            top = parents[top][0]
        carrier[link] = top
    joined = {(carrier[child], carrier[parent]) for child, (parent, kind) in parents.items() if kind != "fixed"}
    near = {(a, b) for a in carrier for b in carrier if carrier[a] == carrier[b] or (carrier[a], carrier[b]) in joined}
    hands = {(a, b) for s in "rl" for a in carrier for b in carrier if a[:9] == b[:9] == f"{s}_gripper"}
    return near | hands | {(f"{s}_shoulder_pan_link", "torso_base_link") for s in "rl"}


def adapt(root: ET.Element) -> None:
    """Give a parsed TIAGo Pro the names and frames of the skills, in place."""
    joints = {joint.get("name", ""): joint for joint in root.findall("joint")}
    for name, joint in joints.items():
        if "wheel" in name:
            joint.set("type", "fixed")  # the base has joints of its own
        for mimic in joint.findall("mimic"):
            joint.remove(mimic)
    for link in root.findall("link"):
        if link.get("name", "").startswith(("wheel_", "suspension_")):
            for solid in link.findall("collision"):
                link.remove(solid)  # they touch the floor: the base is carried by its joints
    for side in _SIDES:
        for finger in ("inner_finger_left", "inner_finger_right", "finger", "outer_finger_right"):
            _reverse(joints[f"gripper_{side}_{finger}_joint"], CLOSED, -1.0)
        for finger in ("left", "right"):
            _reverse(joints[f"gripper_{side}_fingertip_{finger}_joint"], -CLOSED, 1.0)
    _head(root, joints)
    for each in (*root.findall("link"), *root.findall("joint")):
        each.set("name", NAMES.get(each.get("name", ""), each.get("name", "")))
    for joint in joints.values():
        for end in ("parent", "child"):
            found = _child(joint, end)
            found.set("link", NAMES.get(found.get("link", ""), found.get("link", "")))
    for side in _SIDES:
        frame, palm = f"{side[0]}_gripper_tool_frame", f"{side[0]}_gripper_palm_link"
        ET.SubElement(root, "link", name=frame)
        joint = ET.SubElement(root, "joint", name=f"{side[0]}_gripper_tool_joint", type="fixed")
        ET.SubElement(joint, "parent", link=palm)
        ET.SubElement(joint, "child", link=frame)
        # out of the palm is its z; the fingers open along its y
        ET.SubElement(joint, "origin", xyz=f"0 0 {TOOL_AHEAD}", rpy=f"0 {-math.pi / 2} 0")


def _child(element: ET.Element, tag: str) -> ET.Element:
    found = element.find(tag)
    assert found is not None
    return found


def _reverse(joint: ET.Element, zero: float, sign: float) -> None:
    """Let a finger joint be 0 where it is at ``zero`` now, and count from there to where the hand is open."""
    place = origin(joint.find("origin")) @ Pose.about((0.0, 0.0, 1.0), zero).homogeneous()
    set_origin(joint, place)
    axis, limit = _child(joint, "axis"), _child(joint, "limit")
    axis.set("xyz", f"0 0 {sign:g}")
    limit.set("lower", "0")
    limit.set("upper", repr(CLOSED))


def _head(root: ET.Element, joints: dict[str, ET.Element]) -> None:
    """Let the head pan on the lift, and tilt down about its y."""
    pan, tilt = joints["head_1_joint"], joints["head_2_joint"]
    neck = origin(joints["torso_head_joint"].find("origin"))
    set_origin(pan, neck @ origin(pan.find("origin")))
    _child(pan, "parent").set("link", "torso_lift_link")
    place = origin(tilt.find("origin"))
    turned = np.eye(4)
    turned[:3, :3] = place[:3, :3]
    place[:3, :3] = np.eye(3)
    set_origin(tilt, place)
    _child(tilt, "axis").set("xyz", "0 1 0")
    limit = _child(tilt, "limit")
    lower, upper = float(limit.get("lower", "0")), float(limit.get("upper", "0"))
    limit.set("lower", repr(-upper))
    limit.set("upper", repr(-lower))
    for link in root.findall("link"):
        if link.get("name") == "head_2_link":
            for each in (*link.findall("visual"), *link.findall("collision"), *link.findall("inertial")):
                set_origin(each, turned @ origin(each.find("origin")))
    for joint in root.findall("joint"):
        if end_of(joint, "parent") == "head_2_link":
            set_origin(joint, turned @ origin(joint.find("origin")))
