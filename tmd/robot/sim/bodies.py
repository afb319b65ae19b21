"""The bodies of a pybullet world: loading them, where they are, what joints they have."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from pathlib import Path

import numpy as np

from tmd.diagnostics import TmdError
from tmd.robot.sim.engine import Engine
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.sim.rendering import quiet


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint and the link it carries.

    Attributes:
        index: Its number, also that of its link.
        name: Its name.
        kind: ``revolute`` (continuous ones too), ``prismatic`` or ``fixed``; ``other`` for the rest.
        lower: Least position; −inf without limits.
        upper: Greatest position; inf without limits.
        axis: In the frame of the joint.
        link_name: The name of the link.
    """

    index: int
    name: str
    kind: str
    lower: float
    upper: float
    axis: Vector
    link_name: str


class Bodies(Engine):
    """A world with bodies; the arguments are those of :class:`tmd.robot.sim.engine.Engine`."""

    def __init__(self, *, gui: bool = False, pictures: bool = False) -> None:
        super().__init__(gui=gui, pictures=pictures)
        self._inertial: dict[int, Pose] = {}
        self._sleepers: set[int] = set()
        self._names: dict[int, dict[str, Joint]] = {}

    def load(
        self,
        urdf: Path,
        pose: Pose,
        *,
        fixed: bool,
        own_inertia: bool = False,
        sleeps: bool = True,
    ) -> int:
        """Load a URDF.

        Args:
            urdf: The file; meshes beside it or with absolute paths.
            pose: Of the root's frame in the world.
            fixed: The root is fixed to the world.
            own_inertia: Take the inertia tensors of the file; else they are computed from the collision shapes.
            sleeps: When it has been at rest for two seconds, leave it out of the computation until something that
                moves touches it: a room at rest costs next to nothing.

        Returns:
            The body.

        Raises:
            TmdError: pybullet cannot read the file.
        """
        bullet = self._bullet
        flags = bullet.URDF_ENABLE_CACHED_GRAPHICS_SHAPES
        flags |= bullet.URDF_USE_INERTIA_FROM_FILE if own_inertia else 0
        flags |= bullet.URDF_ENABLE_SLEEPING if sleeps else 0
        try:
            with quiet():
                body: int = bullet.loadURDF(
                    str(urdf),
                    pose.position,
                    pose.orientation,
                    useFixedBase=fixed,
                    flags=flags,
                    physicsClientId=self._client,
                )
        except bullet.error as error:
            raise TmdError(
                f"{urdf}: the simulator cannot read this as URDF", hint="see that its meshes exist"
            ) from error
        if sleeps:
            self._sleepers.add(body)
        info = bullet.getDynamicsInfo(body, -1, physicsClientId=self._client)
        self._inertial[body] = Pose(info[3], info[4])
        # the root's frame is meant, whatever the file says about its centre of mass
        self.set_pose(body, pose)
        return body

    def remove(self, body: int) -> None:
        """Take a body out of the world."""
        self.wake()
        self._bullet.removeBody(body, physicsClientId=self._client)
        self._inertial.pop(body, None)
        self._sleepers.discard(body)
        self._names.pop(body, None)

    def bodies(self) -> list[int]:
        """All bodies, in the order they were loaded in."""
        return sorted(self._inertial)

    def joints(self, body: int) -> dict[str, Joint]:
        """The joints of a body by name, in their order."""
        if body not in self._names:
            bullet = self._bullet
            kinds = {
                bullet.JOINT_REVOLUTE: "revolute",
                bullet.JOINT_PRISMATIC: "prismatic",
                bullet.JOINT_FIXED: "fixed",
            }
            found = {}
            for index in range(bullet.getNumJoints(body, physicsClientId=self._client)):
                info = bullet.getJointInfo(body, index, physicsClientId=self._client)
                lower, upper = (-inf, inf) if info[8] > info[9] else (info[8], info[9])
                name = info[1].decode()
                kind = kinds.get(info[2], "other")
                turned = bullet.getDynamicsInfo(body, index, physicsClientId=self._client)[4]
                axis = Pose((0.0, 0.0, 0.0), turned).rotate(info[13])  # given in the frame of the mass
                found[name] = Joint(index, name, kind, lower, upper, axis, info[12].decode())
            self._names[body] = found
        return self._names[body]

    def pose(self, body: int, link: int = -1) -> Pose:
        """The frame of a link in the world."""
        bullet = self._bullet
        if link == -1:
            position, orientation = bullet.getBasePositionAndOrientation(body, physicsClientId=self._client)
            return Pose(position, orientation) * self._inertial[body].inverse()
        state = bullet.getLinkState(body, link, computeForwardKinematics=1, physicsClientId=self._client)
        return Pose(state[4], state[5])

    def set_pose(self, body: int, pose: Pose) -> None:
        """Put the root's frame there, at rest: for setting up, for kinematic motion and for faults.

        What stood on it does not notice by itself: :meth:`wake`.
        """
        self.wake(body)
        mass = pose * self._inertial[body]
        self._bullet.resetBasePositionAndOrientation(
            body, mass.position, mass.orientation, physicsClientId=self._client
        )
        self._bullet.resetBaseVelocity(body, (0, 0, 0), (0, 0, 0), physicsClientId=self._client)

    def wake(self, body: int | None = None) -> None:
        """Let a body, or every body, notice what changed under it while it slept."""
        for each in sorted(self._sleepers if body is None else self._sleepers & {body}):
            state = self._bullet.ACTIVATION_STATE_WAKE_UP
            self._bullet.changeDynamics(each, -1, activationState=state, physicsClientId=self._client)

    def motion(self, body: int) -> tuple[Pose, Vector, Vector]:
        """The exact state of a root, for :meth:`set_motion`: the frame of its mass, its velocity, its turning."""
        position, orientation = self._bullet.getBasePositionAndOrientation(body, physicsClientId=self._client)
        linear, angular = self._bullet.getBaseVelocity(body, physicsClientId=self._client)
        return Pose(position, orientation), linear, angular

    def set_motion(self, body: int, motion: tuple[Pose, Vector, Vector]) -> None:
        """Put a root back as :meth:`motion` found it, to the bit."""
        pose, linear, angular = motion
        self._bullet.resetBasePositionAndOrientation(
            body, pose.position, pose.orientation, physicsClientId=self._client
        )
        self._bullet.resetBaseVelocity(body, linear, angular, physicsClientId=self._client)

    def extents(self, body: int, link: int | None = None) -> tuple[Vector, Vector]:
        """A box, parallel to the world's axes, around the collision shapes of one link, or of all links.

        It is a bound: where the frame of the mass is turned against the shape, it is a little too large.
        """
        if link is not None:
            lower, upper = self._bullet.getAABB(body, link, physicsClientId=self._client)
            return lower, upper
        boxes = [self.extents(body, each) for each in self.solid_links(body)]
        if not boxes:
            return (position := self.pose(body).position), position
        corners = np.array(boxes)
        low, high = corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)
        return (float(low[0]), float(low[1]), float(low[2])), (float(high[0]), float(high[1]), float(high[2]))

    def solid_links(self, body: int) -> list[int]:
        """The links that have a collision shape, the root first."""
        bullet = self._bullet
        links = range(-1, bullet.getNumJoints(body, physicsClientId=self._client))
        return [link for link in links if bullet.getCollisionShapeData(body, link, physicsClientId=self._client)]
