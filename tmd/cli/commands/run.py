"""``tmd run``: a text, a goal or a plan that a simulated PR2 carries out, with every step checked."""

from __future__ import annotations

import os
from contextlib import ExitStack
from pathlib import Path

import click

from tmd.cli.inputs.grounding import environment_file
from tmd.cli.inputs.options import (
    ReadingOptions,
    environment_domain_option,
    learned_option,
    reading_options,
    robot_options,
    said,
    text_options,
)
from tmd.cli.output import emit, emit_json
from tmd.diagnostics import ExitCode, TmdError
from tmd.world.roots import Roots


class _File(click.Path):
    """A file to be written, of a kind that its suffix tells."""

    def __init__(self, *suffixes: str) -> None:
        super().__init__(path_type=Path)
        self._suffixes = suffixes

    def convert(self, value: str | os.PathLike[str], param: click.Parameter | None, ctx: click.Context | None) -> Path:
        path = Path(value)
        if path.suffix not in self._suffixes:
            self.fail(f"'{path}' does not end in {' or '.join(self._suffixes)}", param, ctx)
        return path


def _size(ctx: click.Context, param: click.Parameter, value: str | None) -> tuple[int, int] | None:
    """Width and height in pixels, even numbers: films need them so."""
    if value is None:
        return None
    width, _, height = value.partition("x")
    if not (width.isdigit() and height.isdigit()):
        raise click.BadParameter(f"'{value}' is not WxH, as in 960x720", ctx, param)
    found = int(width), int(height)
    if any(pixels % 2 or not 80 <= pixels <= 4096 for pixels in found):
        raise click.BadParameter(f"'{value}': width and height must be even numbers from 80 to 4096", ctx, param)
    return found


@click.command("run", short_help="Let a simulated PR2 carry out what was said, and check every step.")
@click.option(
    "--environment", required=True, metavar="FILE|NAME", help="An environment (YAML), or the name of a bundled one."
)
@text_options
@click.option(
    "--plan", "plan_file", type=click.Path(path_type=Path), metavar="FILE", help="Carry out this plan, not a text."
)
@click.option("--goal", metavar="CONDITION", help="Find a plan for this PDDL condition, such as (on a b).")
@environment_domain_option
@learned_option
@reading_options
@click.option("--planner", metavar="NAME", help="Planner for gaps and replanning; in-process by default.")
@click.option("--repairs", type=click.IntRange(0), default=6, show_default=True, help="Maximum number of replannings.")
@click.option("--kinematic", is_flag=True, help="Kinematic mode: no physics; faster, less realistic.")
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True, help="Random seed.")
@robot_options
@click.option("--gui", is_flag=True, help="Show the run in a window.")
@click.option("--video", type=_File(".mp4", ".gif"), metavar="FILE", help="Film the run: out.mp4 or out.gif.")
@click.option("--strip", type=_File(".png"), metavar="FILE", help="One picture for each instruction: out.png.")
@click.option(
    "--size", callback=_size, metavar="WxH", help="Pixels of the pictures of film and strip; 640x480 and 400x300."
)
@click.option("--log", type=click.Path(path_type=Path), metavar="FILE", help="Write every step to a JSON Lines file.")
@click.option(
    "--trajectory",
    type=_File(".jsonl", ".mcap"),
    metavar="FILE",
    help="Record joints, base and things: out.jsonl or out.mcap (ROS 2).",
)
@click.option(
    "--rate",
    type=click.FloatRange(0.1, 240.0),
    metavar="HZ",
    help="Samples a second of simulated time; 10 by default.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the whole record as JSON.")
@click.pass_obj
def command(
    roots: Roots,
    environment: str,
    text: str | None,
    text_file: str | None,
    plan_file: Path | None,
    goal: str | None,
    domain_name: str | None,
    learned: Path | None,
    reading: ReadingOptions,
    planner: str | None,
    repairs: int,
    kinematic: bool,
    seed: int,
    robot: str | None,
    urdf: Path | None,
    gui: bool,
    video: Path | None,
    strip: Path | None,
    size: tuple[int, int] | None,
    log: Path | None,
    trajectory: Path | None,
    rate: float | None,
    as_json: bool,
) -> ExitCode:
    """Carry out what was said, in simulation.

    A text is grounded as by "tmd ground", a goal is planned for as by "tmd plan". A PR2 does one instruction after the
    other; after each, the state is read back from the simulation and compared with what PDDL predicts. Where the two
    differ, the executor replans.

    Ends with 12 where a text gives no plan, with 10 where it is proven that no plan reaches the goal, and with 14
    where the robot stopped before everything was done.
    """
    if sum(given is not None for given in (text, text_file, plan_file, goal)) != 1:
        raise click.UsageError("give one of --text, --text-file, --plan and --goal")
    if rate is not None and trajectory is None:
        raise click.UsageError("--rate is for --trajectory")

    from tmd.cli.inputs.plan import orders_of_file, orders_of_goal, orders_of_text
    from tmd.cli.show.run import RunLog, Telling, without_plan
    from tmd.files import check_writable
    from tmd.language.parser import short_enough
    from tmd.planning.backends import IN_PROCESS
    from tmd.robot.skills.results import SkillStatus
    from tmd.robot_trials.plan_runner import PlanRunner

    spoken = None if plan_file is not None or goal is not None else short_enough(said(text, text_file))
    path = roots.environment(environment, domain_name)
    if path.suffix == ".xml":
        raise TmdError(
            f"{path}: the robot does not act in rooms of VEIL-500: their instructions have no skills",
            hint="tmd scene shows the room",
        )
    room, folder = roots.room(environment, domain_name)
    if log is not None:
        check_writable(log)
    corpus, world = roots.world(environment, domain_name)
    chosen = planner or IN_PROCESS
    runner = PlanRunner(  # entered before what takes long: whether films can be made is known at once
        room, folder, world.task.problem, kinematic=kinematic, seed=seed, planner=chosen, repairs=repairs,
        video=video, strip=strip, size=size, trajectory=trajectory, rate=rate, robot=robot, urdf=urdf, gui=gui,
    )  # fmt: skip
    with ExitStack() as stack:
        stack.enter_context(runner)
        if plan_file is not None:
            orders = orders_of_file(plan_file, world)
        elif goal is not None:
            orders = orders_of_goal(goal, world, planner)
        else:
            orders = orders_of_text(spoken or "", corpus, world, environment, chosen, reading, learned)
        for line in orders.remarks:
            emit(line, error=True)
        file, goal_given = environment_file(environment), {} if goal is None else {"goal": goal}
        asked = runner.request(orders.orders, spoken, environment_file=file, grounding=orders.grounding, **goal_given)
        if orders.status:
            if as_json:
                emit_json(without_plan(asked, orders))
            return orders.code
        journal = stack.enter_context(RunLog(log)) if log else None
        told = Telling(asked, orders.orders, journal, as_json=as_json)
        run = runner.run(orders.orders, told.prepare, told.heading, spoken or "")
        told.log_ending(run.execution, run.sim_steps)
    told.print_ending(run.execution, run.sim_steps)
    return ExitCode.NOT_EXECUTED if run.execution.status is SkillStatus.STOPPED else ExitCode.OK
