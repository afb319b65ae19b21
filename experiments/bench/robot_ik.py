"""The PR2: inverse kinematics, planning and physics.

``python experiments/bench/robot_ik.py``: both solvers on the same reachable poses; the own RRT-connect on queries
around a shelf, and OMPL's on the same where ``ompl`` is installed (``pip install ompl``); physics steps a second.
"""

from __future__ import annotations

import importlib.util
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from tmd.robot.parameters import ARM_MOTION
from tmd.robot.pr2.arm_motion import STRIDES
from tmd.robot.pr2.collision import CollisionChecker
from tmd.robot.pr2.kinematics import Array, Tree
from tmd.robot.pr2.pr2 import Pr2
from tmd.robot.pr2.rrt import plan
from tmd.robot.pr2.urdf import TUCKED, prepare
from tmd.robot.sim.pose import Pose
from tmd.robot.sim.simulator import Simulator

POSES = 200
QUERIES = 20
SHELF = """<robot name="shelf"><link name="shelf"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size="0.4 1.6 0.03"/></geometry></collision></link></robot>"""


def main() -> None:
    """Print what is measured."""
    inverse_kinematics()
    with tempfile.TemporaryDirectory() as folder, Simulator() as sim:
        path = Path(folder) / "shelf.urdf"
        path.write_text(SHELF)
        for height in (0.5, 0.85, 1.2):
            sim.load(path, Pose((0.75, 0.0, height)), fixed=True)
        robot = Pr2(sim, rng=np.random.default_rng(0))
        planning(robot)
        physics(robot)


def inverse_kinematics() -> None:
    """Success within the limits, solutions and milliseconds a pose."""
    from tmd.robot.pr2.ik import ArmKinematics

    arm = ArmKinematics(Tree(prepare().root), "right")
    rng = np.random.default_rng(0)
    lower, upper = np.where(np.isinf(arm.lower), -np.pi, arm.lower), np.where(np.isinf(arm.upper), np.pi, arm.upper)
    targets = [
        Pose.from_matrix(arm.tool(0.15, row[None])[0]) for row in rng.uniform(lower + 0.02, upper - 0.02, (POSES, 7))
    ]
    print(f"{'solver':24} {'solved':>8} {'solutions':>10} {'ms':>8}")
    for name, arm.closed_form in (("closed form, 96 pans", True), ("damped least squares", False)):
        start = time.perf_counter()
        found = [len(arm.solve(target, 0.15, (0.0,) * 7)) for target in targets]
        spent = (time.perf_counter() - start) / POSES * 1e3
        print(f"{name:24} {np.mean(np.array(found) > 0):8.1%} {np.mean(found):10.1f} {spent:8.2f}")


def planning(robot: Pr2) -> None:
    """Median and worst seconds a query, and how many were solved; the straight line is never free."""
    rng = np.random.default_rng(1)
    kinematics, start = robot.arm_kinematics["right"], np.array(TUCKED["right"])
    lower = np.where(np.isinf(kinematics.lower), start - np.pi, kinematics.lower)
    upper = np.where(np.isinf(kinematics.upper), start + np.pi, kinematics.upper)
    with CollisionChecker(robot, robot.arm_joints["right"], arm="right", margin=ARM_MOTION.clearance) as checker:
        queries: list[Array] = []
        while len(queries) < QUERIES:
            x, y, z = rng.uniform((0.5, -0.6, 0.55), (0.75, 0.1, 1.15))
            for row in robot.solve("right", Pose((float(x), float(y), float(z))))[:10]:
                line = np.linspace(TUCKED["right"], row, 60)
                if checker.free(np.array([row])) and not checker.free(line):
                    queries.append(np.array(row))
                    break

        def own(goal: Array, seed: int) -> bool:
            draws = np.random.default_rng(seed)
            return plan(start, goal, checker.free, lambda: draws.uniform(lower, upper), STRIDES, budget=300) is not None

        report("own RRT-connect", own, queries)
        if importlib.util.find_spec("ompl") is not None:
            report("OMPL RRT-connect", ompl_planner(checker, start, lower, upper), queries)


def ompl_planner(checker: CollisionChecker, start: Array, lower: Array, upper: Array) -> Callable[[Array, int], bool]:
    """OMPL on the same space and collision check, ten seconds at most."""
    from ompl import base, geometric, util

    util.noOutputHandler()
    space = base.RealVectorStateSpace(len(start))
    bounds = base.RealVectorBounds(len(start))
    for index, (low, high) in enumerate(zip(lower / STRIDES, upper / STRIDES, strict=True)):
        bounds.setLow(index, float(low) - 1)
        bounds.setHigh(index, float(high) + 1)
    space.setBounds(bounds)

    def solve(goal: Array, seed: int) -> bool:
        setup = geometric.SimpleSetup(space)
        setup.setStateValidityChecker(
            lambda state: checker.free(np.array([[state[index] for index in range(len(start))]]) * STRIDES)
        )
        setup.getSpaceInformation().setStateValidityCheckingResolution(1 / space.getMaximumExtent())
        ends = []
        for row in (start, goal):
            state = space.allocState()
            for index, value in enumerate(row / STRIDES):
                state[index] = float(value)
            ends.append(state)
        setup.setStartAndGoalStates(*ends)
        planner = geometric.RRTConnect(setup.getSpaceInformation())
        planner.setRange(10.0)
        setup.setPlanner(planner)
        return bool(setup.solve(10.0)) and setup.haveExactSolutionPath()

    return solve


def report(name: str, solve: Callable[[Array, int], bool], queries: list[Array]) -> None:
    """Time every query once."""
    spent, solved = [], 0
    for seed, goal in enumerate(queries):
        begin = time.perf_counter()
        solved += solve(goal, seed)
        spent.append(time.perf_counter() - begin)
    print(f"{name:24} {solved}/{len(queries)} solved, median {np.median(spent):.3f} s, worst {max(spent):.3f} s")


def physics(robot: Pr2) -> None:
    """Steps a second while the robot stands, and while it drives."""
    for name, move in (
        ("standing", lambda: robot.sim.step(480)),
        ("driving", lambda: robot.drive([(-1.0, 0.0, 0.0), (-1.0, 1.0, 1.0)])),
    ):
        before, begin = robot.sim.steps, time.perf_counter()
        move()
        rate = (robot.sim.steps - before) / (time.perf_counter() - begin)
        print(f"physics, {name:15} {rate:.0f} steps/s, {rate / 240:.1f} times real time")


if __name__ == "__main__":
    main()
