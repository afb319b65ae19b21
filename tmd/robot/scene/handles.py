"""Handles, lids, knobs and buttons in their current poses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tmd.robot.assets.features import Grip
from tmd.robot.scene.catalogue import FLOOR, Catalogue
from tmd.robot.scene.inventory import Inventory
from tmd.robot.sim.pose import Pose, Vector


@dataclass(frozen=True, slots=True)
class Handle:
    """The place to work a joint at, in its current pose.

    Attributes:
        kind: ``door``, ``flap`` (a door without a handle: pushed), ``drawer``, ``lid``, ``slide`` (a curtain), ``knob``
            or ``button``.
        index: The joint's number, also that of the link that moves.
        grasp: The tool in the world with the fingers at the handle. Of a button and a flap: the closed tips touch it.
        opening: Gap of the fingers before they close; 0 means closed.
        origin: A point of the joint's axis in the world.
        axis: The joint's axis in the world: of turning, or of sliding.
        turns: Whether it turns (radians) or slides (metres).
        closed: Position when closed, off or not pressed.
        open: Position when open or pressed.
        settings: Of a knob: the position of each setting.
    """

    kind: str
    body: int
    joint: str
    index: int
    grasp: Pose
    opening: float
    origin: Vector
    axis: Vector
    turns: bool
    closed: float
    open: float
    settings: Mapping[str, float]


def grip_of(things: Catalogue, whole: str, part: str) -> Grip | None:
    """Return the grip of a part in the frame of its link; None if it has none."""
    return next((g for g in things.blueprints[whole].model.grips if g.part == part), None)


def handle_of(things: Inventory, name: str) -> Handle | None:
    """Return the current handle of an object or part; None if it has none."""
    whole, part = things.where(name)
    grip = grip_of(things, whole, part) if whole != FLOOR else None
    if grip is None:
        return None
    link, frame = things.blueprints[whole].model.links[grip.link], things.frame(whole, grip.link)
    return Handle(
        grip.kind,
        things.bodies[whole],
        grip.link,
        things.link(whole, grip.link),
        frame * grip.tool.pose(),
        grip.opening,
        frame.position,
        frame.rotate(link.axis),
        link.kind == "revolute",
        grip.closed,
        grip.open,
        dict(grip.settings),
    )
