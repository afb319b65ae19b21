"""A pybullet world before anything is in it: the connection, its clock, its camera."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from tmd.diagnostics import MissingToolError
from tmd.robot.sim.rendering import bullet_client, egl_starts, pybullet, quiet, window_opens

STEPS_PER_SECOND = 240
ITERATIONS = 50
GRAVITY = 9.81
# Microseconds of a step, about.
_STEP_WORK = 500


class Engine:
    """A world with gravity, empty at first.

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
