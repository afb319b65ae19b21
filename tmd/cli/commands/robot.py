"""``tmd run`` and ``tmd scene``: a simulated PR2 in an environment, to carry out a plan, or to be looked at."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tmd.cli.options import (
    PATH,
    Asked,
    ReadingOptions,
    asked_options,
    learned_option,
    name_list,
    overwrite_option,
    place_options,
    reading_options,
    robot_options,
    seed_option,
)
from tmd.cli.output import emit
from tmd.diagnostics import ExitCode
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.robot.skills.reachability_report import ReachabilityEntry, Stance
    from tmd.world.environment import Environment
    from tmd.world.folder import DomainFolder


def _ending(*suffixes: str) -> Callable[[click.Context, click.Parameter, Path | None], Path | None]:
    """Return a callback of an option for a file of a kind that its suffix tells."""

    def check(ctx: click.Context, param: click.Parameter, value: Path | None) -> Path | None:
        if value is not None and value.suffix not in suffixes:
            raise click.BadParameter(f"'{value}' does not end in {' or '.join(suffixes)}", ctx, param)
        return value

    return check


@click.command("run", short_help="Let a simulated PR2 carry out a request, and check each step.")
@asked_options
@click.option("--plan", "plan_file", type=PATH, metavar="FILE", help="Carry out this plan, not a text.")
@click.option("--goal", metavar="CONDITION", help="Find a plan for this PDDL condition, such as (on a b).")
@learned_option
@reading_options
@click.option("--planner", metavar="NAME", help="Planner for gaps and replanning; in-process by default.")
@click.option("--repairs", type=click.IntRange(0), default=6, show_default=True, help="Maximum number of replannings.")
@click.option("--kinematic", is_flag=True, help="Kinematic mode: no physics; faster, less realistic.")
@seed_option
@robot_options
@click.option("--gui", is_flag=True, help="Show the run in a window.")
@click.option("--video", type=PATH, callback=_ending(".mp4", ".gif"), metavar="FILE", help="Film: out.mp4 or out.gif.")
@click.option("--strip", type=PATH, callback=_ending(".png"), metavar="FILE", help="A picture for each instruction.")
@click.option(
    "--explain", type=PATH, callback=_ending(".html"), metavar="FILE", help="A page of rejected ways: out.html."
)
@click.option("--log", type=PATH, metavar="FILE", help="Write every step to a JSON Lines file.")
@click.option(
    "--trajectory",
    type=PATH,
    callback=_ending(".jsonl", ".mcap"),
    metavar="FILE",
    help="Record joints, base and things: out.jsonl or out.mcap (ROS 2).",
)
@click.option("--json", "as_json", is_flag=True, help="Print the whole record as JSON.")
@click.pass_obj
def run(
    roots: Roots,
    /,
    asked: Asked,
    plan_file: Path | None,
    goal: str | None,
    learned: Path | None,
    reading: ReadingOptions,
    planner: str | None,
    model: dict[str, Any],
    log: Path | None,
    as_json: bool,
    **settings: Any,  # noqa: ANN401 - fields of PlanRunner
) -> ExitCode:
    """Carry out REQUEST in ENVIRONMENT, in simulation.

    A text is grounded as by "tmd ground", a goal is planned for as by "tmd plan". A PR2 does one instruction after the
    other; after each, the state is read back from the simulation and compared with what PDDL predicts. Where the two
    differ, the executor replans.

    Ends with 12 where a text gives no plan, with 10 where it is proven that no plan reaches the goal, and with 14
    where the robot stopped before everything was done.
    """
    environment, domain, spoken = asked.environment, asked.domain, asked.spoken
    if sum(map(bool, (spoken, plan_file, goal is not None))) != 1:
        raise click.UsageError("give one of REQUEST, --text, --text-file, --plan and --goal")

    from tmd.cli.grounding import answer
    from tmd.cli.plans import orders_of_file, orders_of_goal, orders_of_text
    from tmd.cli.run_report import RunLog, RunReport, without_plan
    from tmd.files import check_writable
    from tmd.planning.backends import IN_PROCESS
    from tmd.robot.skills.results import SkillStatus
    from tmd.robot_trials.plan_runner import PlanRunner
    from tmd.world.corpus import is_environment_file

    request = spoken.request() if spoken else ""
    room, folder = roots.room(environment, domain)
    if log is not None:
        check_writable(log)
    corpus, world = roots.world(environment, domain)
    problem = world.task.problem
    runner = PlanRunner(room, folder, problem, planner=planner or IN_PROCESS, **model, **settings)
    with ExitStack() as stack:
        stack.enter_context(runner)  # before what takes long: whether films can be made is known at once
        if plan_file is not None:
            orders = orders_of_file(plan_file, problem)
        elif goal is not None:
            orders = orders_of_goal(goal, problem, planner)
        else:
            found = answer(corpus, world, environment, text=request, reading=reading, learned=learned, planner=planner)
            orders = orders_of_text(found)
        for line in orders.remarks:
            emit(line, error=True)
        file = environment if is_environment_file(environment) else None
        record = runner.request(orders.orders, request or None, environment_file=file, **orders.given)
        if orders.code:
            if as_json:
                emit(without_plan(record, orders))
            return orders.code
        journal = stack.enter_context(RunLog(log)) if log else None
        report = RunReport(record, orders.orders, journal, as_json=as_json)
        ran = runner.run(orders.orders, report.prepare, report.heading, request)
        report.log_ending(ran.execution, ran.sim_steps)
    report.print_ending(ran.execution, ran.sim_steps)
    return ExitCode.NOT_EXECUTED if ran.execution.status is SkillStatus.STOPPED else ExitCode.OK


@click.command("scene", short_help="Show an environment as the robot's room.")
@place_options
@click.option("--reach", is_flag=True, help="Print a base pose for grasping every object.")
@seed_option
@robot_options
@click.option("--picture", type=PATH, callback=_ending(".png"), metavar="FILE", help="A picture of the room: out.png.")
@click.option("--export", type=PATH, metavar="DIR", help="Write the room for other simulators.")
@click.option(
    "--format", "formats", callback=name_list("urdf", "mjcf"), metavar="A,B|all", help="urdf (default), mjcf."
)
@overwrite_option
@click.pass_obj
def scene(
    roots: Roots,
    place: tuple[str, str | None],
    reach: bool,
    seed: int,
    model: dict[str, Any],
    picture: Path | None,
    export: Path | None,
    formats: tuple[str, ...] | None,
    overwrite: bool,
) -> None:
    """Build the room of ENVIRONMENT, put a PR2 into it, and say what stands where.

    With --export the room is written as URDF or MJCF, its meshes beside it, without the robot.
    """
    if export is None and (formats or overwrite):
        raise click.UsageError("--format and --overwrite are for --export")

    from tmd.robot.pr2.urdf import packaged_robot
    from tmd.robot.skills.reachability_report import survey_scene

    urdf = model["urdf"] if model["robot"] is None else packaged_robot(model["robot"])
    room, folder = roots.room(*place)
    found = survey_scene(room, folder, reach=reach, seed=seed, urdf=urdf, picture=picture)
    stances = found.stances if reach else None
    written = _exported(room, folder, export, formats, overwrite) if export is not None else []
    emit(_text(found.name, found.entries, stances))
    emit("".join(f"{path}\n" for path in written))


def _exported(
    room: Environment, folder: DomainFolder, directory: Path, formats: tuple[str, ...] | None, overwrite: bool
) -> list[Path]:
    """Write the files of a scene, and return their paths without those of the meshes."""
    from tmd.export.directory import check_directory, write_directory
    from tmd.export.scene_files import FORMATS, scene_files

    check_directory(directory, overwrite=overwrite)
    files = scene_files(room, folder, formats or FORMATS[:1])
    write_directory(directory, files, overwrite=overwrite)
    return [directory / path for path in files if "/" not in path]


def _text(name: str, entries: Sequence[ReachabilityEntry], stances: Mapping[str, Stance | None] | None) -> str:
    items = sum(entry.item for entry in entries)
    lines = [f"{name}: {len(entries) - items} pieces of furniture, {items} things to carry"]
    width = max((len(entry.name) for entry in entries), default=0)
    wide = max((len(entry.kind) for entry in entries), default=0)
    for entry in entries:
        place = f"{entry.place[1]} {entry.place[0]}" if entry.place else ""
        x, y, z = entry.position
        line = f"  {entry.name:<{width}}  {entry.kind:<{wide}}  at {x:5.2f} {y:5.2f} {z:5.2f}  {place}"
        if stances is not None:
            found = stances[entry.name]
            line += f"{', ' if place else ''}{found or 'out of reach as it stands now'}"
        lines.append(line.rstrip())
    return "\n".join(lines) + "\n"
