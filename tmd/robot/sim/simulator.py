"""One pybullet world: the only class that knows how pybullet is called.

Metres, kilograms, radians, seconds; the floor is z = 0 and z is up. A *body* is a number that :meth:`Simulator.load`
gives, a *link* is the number of the joint that carries it, and −1 is the root. Poses are those of the frames in the
URDF, never those of the centres of mass, which pybullet gives by default for the root.

The world is deterministic: the same calls in the same order give the same floats on one machine.
"""

from __future__ import annotations

import ctypes
import importlib
import importlib.util
import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from tmd.diagnostics import MissingToolError, TmdError, install_extra
from tmd.robot.sim.pose import Pose, Vector


@dataclass(frozen=True, slots=True)
class Joint:
    """A joint and the link it carries.

    Attributes:
        index: Its number, also that of its link.
        kind: ``revolute`` (continuous ones too), ``prismatic`` or ``fixed``; ``other`` for the rest.
    """

    index: int
    name: str
    kind: str
    link_name: str


STEPS_PER_SECOND = 240
ITERATIONS = 50
GRAVITY = 9.81
# Microseconds of a step, about.
_STEP_WORK = 500
# Asked for a distance of 0, Bullet uses other algorithms, which find nothing between most bodies that overlap (metres).
_LEAST_DISTANCE = 1e-6
# Bullet's number for all links of a body.
_ALL = -2
# Approximate cost of a distance query, in microseconds.
_QUERY_WORK = 18
# Maximum force of a weld or a pin, in newtons: more than any item weighs, and less than what tears furniture.
WELD_FORCE = 500.0


@dataclass(frozen=True, slots=True)
class Contact:
    """A link near another body, and the distance between the surfaces (negative: they overlap)."""

    link: int
    distance: float


@dataclass(frozen=True, slots=True)
class Hit:
    """First surface on a ray."""

    body: int
    position: Vector


class Simulator:
    """A world with gravity, empty at first, with bodies that move, meet and are held.

    ``gui`` opens a window, for which a display is needed. ``pictures`` lets EGL draw if it starts, which must be known
    before anything is loaded; without it, pictures are drawn by pybullet's own slower renderer.

    Attributes:
        client: The number of pybullet's connection, for direct calls.
        steps: Physics steps so far.
        ticks: Steps and kinematic ticks so far, that is calls of the watchers.
        work: Approximate microseconds of computing on one core so far, counted and not measured: the same calls give
            the same number on every machine.
        renderer: ``window``, ``egl`` or ``tiny``.

    Raises:
        MissingToolError: pybullet is not installed, or a window was asked for and cannot be opened.
    """

    def __init__(self, *, gui: bool = False, pictures: bool = False) -> None:
        bullet = pybullet()
        if gui and not window_opens():
            raise MissingToolError(
                "no window can be opened: there is no display, or it has no OpenGL",
                hint="leave --gui out and ask for a film with --video FILE.mp4",
            )
        self.steps = 0
        self.ticks = 0
        self.work = 0
        self._watchers: list[Callable[[Any], None]] = []
        with quiet():
            # passes the number of the connection to every call
            self._bullet: Any = bullet_client(bullet.GUI if gui else bullet.DIRECT)
            self.client: int = self._bullet._client
            self.renderer = "window" if gui else "egl" if pictures and egl_starts() else "tiny"
            if self.renderer == "egl":
                spec = importlib.util.find_spec("eglRenderer")
                assert spec is not None  # the probe found it
                self._bullet.loadPlugin(spec.origin, "_eglRendererPlugin")
        if gui:
            self._bullet.configureDebugVisualizer(bullet.COV_ENABLE_GUI, 0)
        self._bullet.setGravity(0, 0, -GRAVITY)
        self._bullet.setPhysicsEngineParameter(
            fixedTimeStep=1 / STEPS_PER_SECOND, numSolverIterations=ITERATIONS, deterministicOverlappingPairs=1
        )
        self._inertial: dict[int, Pose] = {}
        self._sleepers: set[int] = set()
        self._names: dict[int, dict[str, Joint]] = {}
        self._solid: dict[int, list[int]] = {}
        self._joined: dict[int, tuple[int, int]] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the world; nothing else can be called afterwards, except this."""
        if self.client >= 0:
            with quiet():
                self._bullet.disconnect()
            self.client = -1

    # time

    def add_watcher(self, watcher: Callable[[Self], None]) -> None:
        """Call ``watcher(self)`` after every step and tick."""
        self._watchers.append(watcher)

    def remove_watcher(self, watcher: Callable[[Self], None]) -> None:
        """Stop calling a watcher."""
        self._watchers.remove(watcher)

    def step(self, count: int = 1) -> None:
        """Let ``count`` 240ths of a second pass."""
        for _ in range(count):
            self._bullet.stepSimulation()
            self.steps += 1
            self.work += _STEP_WORK
            self.tick()

    def tick(self) -> None:
        """Call the watchers without letting time pass: something was moved kinematically."""
        self.ticks += 1
        for watcher in tuple(self._watchers):
            watcher(self)

    # pictures

    def picture(
        self,
        eye: Sequence[float],
        target: Sequence[float],
        width: int,
        height: int,
        *,
        fov: float = 60.0,
        shadow: bool = True,
    ) -> NDArray[np.uint8]:
        """Return the picture of a camera, z up: (height, width, 3), RGB; ``fov`` is vertical, in degrees."""
        bullet = self._bullet
        view = bullet.computeViewMatrix(eye, target, (0, 0, 1))
        projection = bullet.computeProjectionMatrixFOV(fov, width / height, 0.05, 30.0)
        with quiet():  # EGL says hello at the first picture
            image = bullet.getCameraImage(
                width,
                height,
                view,
                projection,
                shadow=int(shadow),
                lightDirection=(2.0, -3.0, 6.0),
                lightAmbientCoeff=0.55,
                lightDiffuseCoeff=0.5,
                lightSpecularCoeff=0.05,
                renderer=bullet.ER_TINY_RENDERER if self.renderer == "tiny" else bullet.ER_BULLET_HARDWARE_OPENGL,
                flags=bullet.ER_NO_SEGMENTATION_MASK,
            )
        pixels = np.asarray(image[2], dtype=np.uint8).reshape(height, width, 4)
        return np.ascontiguousarray(pixels[:, :, :3])

    # bodies

    def load(self, urdf: Path, pose: Pose, *, fixed: bool, own_inertia: bool = False, sleeps: bool = True) -> int:
        """Load a URDF and return its body.

        Args:
            urdf: The file; meshes beside it or with absolute paths.
            pose: Of the root's frame in the world.
            fixed: The root is fixed to the world.
            own_inertia: Take the inertia tensors of the file; else they are computed from the collision shapes.
            sleeps: After two seconds at rest, leave it out of the computation until something that moves touches it: a
                room at rest costs next to nothing.

        Raises:
            TmdError: pybullet cannot read the file.
        """
        bullet = self._bullet
        flags = bullet.URDF_ENABLE_CACHED_GRAPHICS_SHAPES
        flags |= bullet.URDF_USE_INERTIA_FROM_FILE if own_inertia else 0
        flags |= bullet.URDF_ENABLE_SLEEPING if sleeps else 0
        try:
            with quiet():
                body: int = bullet.loadURDF(str(urdf), pose.position, pose.orientation, useFixedBase=fixed, flags=flags)
        except bullet.error as error:
            raise TmdError(
                f"{urdf}: the simulator cannot read this as URDF", hint="see that its meshes exist"
            ) from error
        if sleeps:
            self._sleepers.add(body)
        info = bullet.getDynamicsInfo(body, -1)
        self._inertial[body] = Pose(info[3], info[4])
        # the root's frame is meant, whatever the file says about its centre of mass
        self.set_pose(body, pose)
        return body

    def bodies(self) -> list[int]:
        """Return all bodies, in the order of loading."""
        return sorted(self._inertial)

    def joints(self, body: int) -> dict[str, Joint]:
        """Return the joints of a body by name, in their order."""
        if body not in self._names:
            bullet = self._bullet
            kinds = {
                bullet.JOINT_REVOLUTE: "revolute",
                bullet.JOINT_PRISMATIC: "prismatic",
                bullet.JOINT_FIXED: "fixed",
            }
            found = {}
            for index in range(bullet.getNumJoints(body)):
                info = bullet.getJointInfo(body, index)
                name = info[1].decode()
                kind = kinds.get(info[2], "other")
                found[name] = Joint(index, name, kind, info[12].decode())
            self._names[body] = found
        return self._names[body]

    def pose(self, body: int, link: int = -1) -> Pose:
        """Return the frame of a link in the world."""
        bullet = self._bullet
        if link == -1:
            position, orientation = bullet.getBasePositionAndOrientation(body)
            return Pose(position, orientation) * self._inertial[body].inverse()
        state = bullet.getLinkState(body, link, computeForwardKinematics=1)
        return Pose(state[4], state[5])

    def set_pose(self, body: int, pose: Pose) -> None:
        """Put the root's frame there, at rest, for set-up, kinematic motion and faults.

        Things on top of it do not notice by themselves: see :meth:`wake`.
        """
        self.wake(body)
        mass = pose * self._inertial[body]
        self._bullet.resetBasePositionAndOrientation(body, mass.position, mass.orientation)
        self._bullet.resetBaseVelocity(body, (0, 0, 0), (0, 0, 0))

    def wake(self, body: int | None = None) -> None:
        """Let a body, or every body, notice changes under it during its sleep."""
        for each in sorted(self._sleepers if body is None else self._sleepers & {body}):
            state = self._bullet.ACTIVATION_STATE_WAKE_UP
            self._bullet.changeDynamics(each, -1, activationState=state)

    def motion(self, body: int) -> tuple[Pose, Vector, Vector]:
        """Return the exact state of a root, for :meth:`set_motion`: frame of its mass, linear and angular velocity."""
        position, orientation = self._bullet.getBasePositionAndOrientation(body)
        linear, angular = self._bullet.getBaseVelocity(body)
        return Pose(position, orientation), linear, angular

    def set_motion(self, body: int, motion: tuple[Pose, Vector, Vector]) -> None:
        """Restore the state of :meth:`motion`, to the bit."""
        pose, linear, angular = motion
        self._bullet.resetBasePositionAndOrientation(body, pose.position, pose.orientation)
        self._bullet.resetBaseVelocity(body, linear, angular)

    def extents(self, body: int, link: int | None = None) -> tuple[Vector, Vector]:
        """Return an axis-parallel box around the collision shapes of one link, or of all links.

        It is an upper bound: if the frame of the mass is turned against the shape, it is a little too large.
        """
        if link is not None:
            lower, upper = self._bullet.getAABB(body, link)
            return lower, upper
        boxes = [self.extents(body, each) for each in self.solid_links(body)]
        if not boxes:
            return (position := self.pose(body).position), position
        corners = np.array(boxes)
        low, high = corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)
        return (float(low[0]), float(low[1]), float(low[2])), (float(high[0]), float(high[1]), float(high[2]))

    def solid_links(self, body: int) -> list[int]:
        """Return the links that have a collision shape, the root first."""
        if body not in self._solid:
            links = range(-1, self._bullet.getNumJoints(body))
            self._solid[body] = [link for link in links if self._bullet.getCollisionShapeData(body, link)]
        return self._solid[body]

    # joints

    def _index(self, body: int, joint: int | str) -> int:
        return joint if isinstance(joint, int) else self.joints(body)[joint].index

    def joint_position(self, body: int, joint: int | str) -> float:
        """Return the position in radians or metres."""
        state = self._bullet.getJointState(body, self._index(body, joint))
        return float(state[0])

    def joint_states(self, body: int, joints: Sequence[int]) -> tuple[list[float], list[float]]:
        """Return positions and velocities of several joints."""
        states = self._bullet.getJointStates(body, joints)
        return [state[0] for state in states], [state[1] for state in states]

    def set_joint(self, body: int, joint: int | str, position: float) -> None:
        """Put a joint there, at rest: never while physics runs."""
        self.wake(body)
        self._bullet.resetJointState(body, self._index(body, joint), position, 0.0)

    def set_joints(
        self, body: int, joints: Sequence[int], positions: Sequence[float], velocities: Sequence[float] | None = None
    ) -> None:
        """Put several joints there at once: never while physics runs."""
        speeds = [0.0] * len(joints) if velocities is None else velocities
        self._bullet.resetJointStatesMultiDof(
            body, joints, [[position] for position in positions], [[speed] for speed in speeds]
        )

    def drive_joint(
        self, body: int, joint: int | str, target: float, force: float, velocity: float | None = None
    ) -> None:
        """Let the joint's motor go to ``target`` and stay there, with at most ``force`` (N or N·m) and ``velocity``."""
        self.wake(body)
        limit = {} if velocity is None else {"maxVelocity": velocity}
        self._bullet.setJointMotorControl2(
            body, self._index(body, joint), self._bullet.POSITION_CONTROL, targetPosition=target, force=force, **limit
        )

    def drive_joints(
        self,
        body: int,
        joints: Sequence[int],
        targets: Sequence[float],
        velocities: Sequence[float],
        forces: Sequence[float],
        gain: float,
    ) -> None:
        """Let several motors follow a trajectory, given by positions and velocities for now.

        ``gain`` is the share of a position error that a motor removes in one step.
        """
        self._bullet.setJointMotorControlArray(
            body,
            joints,
            self._bullet.POSITION_CONTROL,
            targetPositions=targets,
            targetVelocities=velocities,
            forces=forces,
            positionGains=[gain] * len(joints),
            velocityGains=[1.0] * len(joints),
        )

    def brake_joint(self, body: int, joint: int | str, force: float) -> None:
        """Switch the joint's motor off, with ``force`` (N or N·m) of friction left; 0 lets it swing."""
        self.wake(body)
        self._bullet.setJointMotorControl2(
            body, self._index(body, joint), self._bullet.VELOCITY_CONTROL, targetVelocity=0.0, force=force
        )

    # constraints

    def weld(self, body: int, link: int, other: int) -> int:
        """Fix the root of ``other`` to a link as the two are now; return a handle for :meth:`unweld`."""
        held = self._mass_frame(body, link).inverse() * self._mass_frame(other, -1)
        return self._constrain(body, link, other, -1, self._bullet.JOINT_FIXED, held, Pose((0.0, 0.0, 0.0)), WELD_FORCE)

    def pin(self, body: int, link: int, other: int, other_link: int, point: Vector, force: float = WELD_FORCE) -> int:
        """Hold two links together at a point of the world, free to turn: a hand at a handle."""
        here = Pose(point)
        mine, theirs = (self._mass_frame(b, k).inverse() * here for b, k in ((body, link), (other, other_link)))
        return self._constrain(body, link, other, other_link, self._bullet.JOINT_POINT2POINT, mine, theirs, force)

    def unweld(self, handle: int) -> None:
        """Undo a weld or a pin."""
        for body in self._joined.pop(handle):
            self.wake(body)  # what hung asleep falls now
        self._bullet.removeConstraint(handle)

    def _constrain(
        self, body: int, link: int, other: int, other_link: int, kind: int, mine: Pose, theirs: Pose, force: float
    ) -> int:
        handle: int = self._bullet.createConstraint(
            body, link, other, other_link, kind, (0, 0, 0),
            mine.position, theirs.position, mine.orientation, theirs.orientation)  # fmt: skip
        self._bullet.changeConstraint(handle, maxForce=force)
        self._joined[handle] = body, other
        return handle

    def _mass_frame(self, body: int, link: int) -> Pose:
        """Return the frame at the centre of mass, in which constraints are given."""
        if link == -1:
            return Pose(*self._bullet.getBasePositionAndOrientation(body))
        state = self._bullet.getLinkState(body, link, computeForwardKinematics=1)
        return Pose(state[0], state[1])

    # what touches, what is near, what is seen

    def closest(
        self, body: int, other: int, distance: float, link: int | None = None, other_link: int | None = None
    ) -> list[Contact]:
        """Return the links of ``body`` that are at most ``distance`` from another body; with 0: that touch it.

        No step is needed.
        """
        one, two = (_ALL if each is None else each for each in (link, other_link))
        self.work += _QUERY_WORK
        points = self._bullet.getClosestPoints(body, other, max(distance, _LEAST_DISTANCE), one, two)
        return [Contact(point[3] if point[1] == body else point[4], point[8]) for point in points or ()]

    def ray(self, start: Sequence[float], end: Sequence[float]) -> Hit | None:
        """Return the first surface on a straight line."""
        body, _, _, position, _ = self._bullet.rayTest(start, end)[0]
        return None if body < 0 else Hit(body, position)

    def colour(self, body: int, link: int, rgba: Sequence[float]) -> None:
        """Paint a link; each value in [0, 1]."""
        self._bullet.changeVisualShape(body, link, rgbaColor=rgba)


_EGL = """
import importlib.util, pybullet as p
p.connect(p.DIRECT)
plugin = p.loadPlugin(importlib.util.find_spec("eglRenderer").origin, "_eglRendererPlugin")
assert plugin >= 0
p.getCameraImage(16, 16, renderer=p.ER_BULLET_HARDWARE_OPENGL)
"""
_WINDOW = "import pybullet as p; assert p.connect(p.GUI) >= 0"
_PATIENCE = 60.0


@cache
def pybullet() -> Any:  # noqa: ANN401 - it has no types
    """Import the module ``pybullet``.

    Raises:
        MissingToolError: It is not installed.
    """
    try:
        with quiet():
            return importlib.import_module("pybullet")
    except ImportError as error:
        raise MissingToolError("the simulator pybullet is not installed", hint=install_extra("robot")) from error


def bullet_client(mode: int) -> Any:  # noqa: ANN401 - it has no types
    """Connect to a new world. The client makes each of pybullet's functions its own once, not at every call."""
    base: Any = importlib.import_module("pybullet_utils.bullet_client").BulletClient

    def bound(self: Any, name: str) -> Any:  # noqa: ANN401 - it has no types
        return self.__dict__.setdefault(name, base.__getattr__(self, name))

    return type("Client", (base,), {"__getattr__": bound})(mode)


@contextmanager
def quiet() -> Iterator[None]:
    """Discard the output of C code: standard output is for results, standard error for the program's messages."""
    sys.stdout.flush()
    sys.stderr.flush()
    library = ctypes.CDLL(None)
    library.fflush(None)
    kept = [os.dup(stream) for stream in (1, 2)]
    sink = os.open(os.devnull, os.O_WRONLY)
    try:
        for stream in (1, 2):
            os.dup2(sink, stream)
        yield
    finally:
        library.fflush(None)  # what C still buffers would come out later
        for stream, copy in zip((1, 2), kept, strict=True):
            os.dup2(copy, stream)
            os.close(copy)
        os.close(sink)


@cache
def egl_starts() -> bool:
    """Return whether EGL can draw; tried in another process, which the plugin ends if it cannot start."""
    return importlib.util.find_spec("eglRenderer") is not None and _succeeds(_EGL)


@cache
def window_opens() -> bool:
    """Return whether pybullet can open its window; tried in another process, which may end without a display."""
    return _succeeds(_WINDOW)


def _succeeds(code: str) -> bool:
    try:
        run = subprocess.run([sys.executable, "-c", code], capture_output=True, timeout=_PATIENCE, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return run.returncode == 0
