"""A trajectory as one number: every joint position and body pose at every tick, to the bit."""

from __future__ import annotations

import hashlib
import struct

from tmd.robot.sim.simulator import Simulator


class Trace:
    """Digests a simulation while it runs: ``sim.add_watcher(Trace())``.

    Two runs have the same digest when, at each tick, all bodies were at the same poses with the same velocities and
    all joints at the same positions with the same velocities.
    """

    def __init__(self) -> None:
        self._hash = hashlib.blake2b(digest_size=16)

    def __call__(self, sim: Simulator) -> None:
        """Take in the world as it is now."""
        for body in sim.bodies():
            pose, linear, angular = sim.motion(body)
            self._take([*pose.position, *pose.orientation, *linear, *angular])
            moving = [joint.index for joint in sim.joints(body).values() if joint.kind != "fixed"]
            if moving:
                positions, velocities = sim.joint_states(body, moving)
                self._take([*positions, *velocities])

    def _take(self, numbers: list[float]) -> None:
        self._hash.update(struct.pack(f"<{len(numbers)}d", *numbers))

    def digest(self) -> str:
        """The digest so far, in hexadecimal."""
        return self._hash.hexdigest()
