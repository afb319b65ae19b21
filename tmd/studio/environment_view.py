"""An environment made ready for visitors: its world, its lexicon, and what there is to see of it."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

from tmd.diagnostics import TmdError
from tmd.robot.assets.room import build_room
from tmd.robot.skills.skill_file import visible
from tmd.robot.video.symbolic_renderer import Picture, Still
from tmd.studio.view3d.meshes import MeshPiece, pieces
from tmd.world.corpus import Corpus
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder
from tmd.world.world import World


@dataclass(frozen=True, slots=True)
class Look:
    """Shapes and colours of an environment.

    Attributes:
        still: Draws its states.
        first: How it looks at the start.
        room: The floor and the walls.
        objects: The pieces of each object.
    """

    still: Still
    first: Picture
    room: tuple[MeshPiece, ...]
    objects: dict[str, tuple[MeshPiece, ...]]


@dataclass(frozen=True, slots=True)
class Setting:
    """An environment, ready.

    Attributes:
        world: The environment, ground.
        path: Its file.
        look: What there is to see; ``None`` where nothing is.
        blind: Why nothing is.
    """

    world: World
    path: Path
    look: Look | None
    blind: str = ""

    @property
    def name(self) -> str:
        """The environment's name."""
        return self.world.name

    def names(self) -> list[str]:
        """Return the objects that can be pointed at, without their parts, sorted."""
        if self.look is not None:
            return sorted(self.look.still.blueprints)
        parts = {part for known in self.world.profiles.parts.values() for _, part in known}
        return sorted(name for name in self.world.objects.types_of if name not in parts)


def open_setting(corpus: Corpus, world: World, path: Path) -> Setting:
    """Make an environment ready.

    Raises:
        TmdError: The environment is wrong. Where only its shapes are, there is nothing to see, and it says why.
    """
    if path.suffix != ".yaml":
        return Setting(world, path, None, "A PDDL problem does not say where things stand: there is no picture of it.")
    try:
        return Setting(world, path, _look(corpus.folder, world, path))
    except TmdError as error:
        return Setting(world, path, None, f"There is no picture of this environment: {error.message}.")


def _look(folder: DomainFolder, world: World, path: Path) -> Look:
    still = Still(load_environment(path), folder, visible(folder))
    objects = {}
    known: dict[str, tuple[MeshPiece, ...]] = {}
    for name, blueprint in still.blueprints.items():
        if blueprint.class_name not in known:
            model = blueprint.model
            apart = {*model.contents, *(lamp.link for lamp in model.lamps)}
            known[blueprint.class_name] = tuple(pieces(ET.fromstring(blueprint.urdf), apart))
        objects[name] = known[blueprint.class_name]
    room = tuple(pieces(ET.fromstring(build_room(still.room))))
    return Look(still, still.first(world.task.problem.init), room, objects)
