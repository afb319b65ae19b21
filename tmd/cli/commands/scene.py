"""``tmd scene``: an environment as the robot's room, to be looked at."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tmd.cli.inputs.options import environment_domain_option, json_option, overwrite_option, robot_options
from tmd.cli.output import emit, emit_json
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from collections.abc import Mapping

    from tmd.robot.skills.reachability_report import ReachabilityEntry, Stance
    from tmd.world.environment import Environment
    from tmd.world.folder import DomainFolder


@click.command("scene", short_help="Show an environment as the robot's room.")
@click.option(
    "--environment",
    required=True,
    metavar="FILE|NAME",
    help="An environment (YAML), the name of a bundled one, or a room of VEIL-500 (XML).",
)
@environment_domain_option
@click.option("--reach", is_flag=True, help="Print a base pose for grasping every object.")
@click.option(
    "--seed", type=click.IntRange(0), default=0, show_default=True, help="Seed for placement jitter; 0 disables it."
)
@robot_options
@click.option("--picture", type=click.Path(path_type=Path), metavar="FILE", help="A picture of the room: out.png.")
@click.option("--export", type=click.Path(path_type=Path), metavar="DIR", help="Write the room for other simulators.")
@click.option("--format", "formats", multiple=True, metavar="A,B|all", help="urdf (default), mjcf.")
@overwrite_option
@json_option
@click.pass_obj
def command(
    roots: Roots,
    environment: str,
    domain_name: str | None,
    reach: bool,
    seed: int,
    robot: str | None,
    urdf: Path | None,
    picture: Path | None,
    export: Path | None,
    formats: Sequence[str],
    overwrite: bool,
    as_json: bool,
) -> None:
    """Build the room of an environment, put a PR2 into it, and say what stands where.

    With --export the room is written as URDF or MJCF, its meshes beside it, without the robot.
    """
    if export is None and (formats or overwrite):
        raise click.UsageError("--format and --overwrite are for --export")
    if picture is not None and picture.suffix != ".png":
        raise click.UsageError(f"--picture: '{picture}' does not end in .png")

    from tmd.robot.pr2.urdf import packaged_robot
    from tmd.robot.skills.reachability_report import survey_scene

    model = urdf if robot is None else packaged_robot(robot)
    room, folder, remarks = _read(roots, environment, domain_name)
    for remark in remarks:
        emit(f"note: {remark}\n", error=True)
    found = survey_scene(room, folder, reach=reach, seed=seed, urdf=model, picture=picture)
    stances = found.stances if reach else None
    written = _exported(room, folder, export, formats, overwrite) if export is not None else []
    if as_json:
        emit_json({"environment": found.name, "objects": [_json(entry, stances) for entry in found.entries]})
    else:
        emit(_text(found.name, found.entries, stances))
        emit("".join(f"{path}\n" for path in written))


def _exported(
    room: Environment, folder: DomainFolder, directory: Path, formats: Sequence[str], overwrite: bool
) -> list[Path]:
    """Write the files of a scene; their paths, but for the meshes."""
    from tmd.export.directory import check_directory, write_directory
    from tmd.export.scene_files import FORMATS, scene_files

    check_directory(directory, overwrite=overwrite)
    names = tuple(dict.fromkeys(name.strip() for text in formats or FORMATS[:1] for name in text.split(",")))
    files = scene_files(room, folder, FORMATS if names == ("all",) else names)
    write_directory(directory, files, overwrite=overwrite)
    return [directory / path for path in files if "/" not in path]


def _read(roots: Roots, name: str, domain: str | None) -> tuple[Environment, DomainFolder, tuple[str, ...]]:
    path = roots.environment(name, domain)
    if path.suffix == ".xml":
        from tmd.datasets.veil500.scene import read_room, scene_of

        veil = scene_of(read_room(path))
        return veil.environment, veil.folder, veil.remarks
    return *roots.room(name, domain), ()


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


def _json(entry: ReachabilityEntry, stances: Mapping[str, Stance | None] | None) -> dict[str, object]:
    found: dict[str, object] = {
        "name": entry.name,
        "kind": entry.kind,
        "item": entry.item,
        "position": [round(value, 3) for value in entry.position],
        "at": {"thing": entry.place[0], "relation": entry.place[1]} if entry.place else None,
    }
    if stances is not None:
        where = stances[entry.name]
        found["stance"] = where and {"base": [round(value, 3) for value in where.base], "hand": where.side or None}
    return found
