"""A robot in a scene, and the signs of a state."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tmd.pddl.model import State
from tmd.robot.pr2.pr2 import Pr2
from tmd.robot.scene.scene import Scene
from tmd.robot.sim.simulator import Simulator
from tmd.robot.skills.robot_context import Cell
from tmd.robot.skills.skill_file import Skills


def show_state(scene: Scene, skills: Skills, state: State) -> None:
    """Show the contents and signs of ``state``."""
    contents: dict[str, list[str]] = {}
    for atom in sorted(state):
        if atom.predicate == skills.contents and len(atom.args) == 2:
            contents.setdefault(atom.args[0], []).append(atom.args[1])
    for name in scene.items():
        scene.show(name, contents.get(name, ()))
    for predicate in skills.signs:
        shown = {atom.args[0] for atom in state if atom.predicate == predicate}
        for name in scene.names():
            scene.sign(name, predicate, name in shown)


def make_cell(sim: Simulator, scene: Scene, *, seed: int, kinematic: bool, urdf: Path | None = None) -> Cell:
    """Put a robot, the packaged PR2 or that of ``urdf``, in the middle of a scene.

    Raises:
        MissingToolError: The robot's model is not installed.
        TmdError: ``urdf`` is not a PR2.
    """
    rng = np.random.default_rng(seed)
    robot = Pr2(sim, urdf=urdf, kinematic=kinematic, rng=rng)
    return Cell(sim, robot, scene, rng)
