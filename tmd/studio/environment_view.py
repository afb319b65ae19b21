"""An environment made ready for visitors: its world, its shapes, and the states that a plan leads through."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from threading import Lock

from tmd.diagnostics import TmdError
from tmd.goals.wording import Wording
from tmd.pddl.model import GroundAtom, Instruction, State
from tmd.pddl.task import Bits, Operator
from tmd.robot.scene.furniture_layout import build_room
from tmd.robot.skills.skill_file import visible
from tmd.robot.video.symbolic_renderer import Picture, Still
from tmd.studio.view3d.meshes import MeshPiece, pieces
from tmd.view.panels import require_object
from tmd.world.corpus import Corpus
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder
from tmd.world.world import World

# Drawing is quick, and who draws keeps notes in what all visitors of a setting share.
_DRAWING = Lock()


@dataclass(frozen=True, slots=True)
class Look:
    """Shapes and colours of an environment.

    Attributes:
        still: Draws its states.
        first: How it looks at the start.
        room: The floor and the walls.
    """

    still: Still
    first: Picture
    room: tuple[MeshPiece, ...]
    objects: dict[str, tuple[MeshPiece, ...]]


@dataclass(frozen=True)
class Setting:
    """An environment, ready. Nothing in it changes: threads may share it.

    Attributes:
        look: What there is to see; ``None`` where nothing is.
        blind: Why nothing is.
    """

    world: World
    path: Path
    look: Look | None = None
    blind: str = ""

    @property
    def name(self) -> str:
        """The environment's name."""
        return self.world.name

    def names(self) -> list[str]:
        """Return the objects that can be pointed at, without their parts, sorted."""
        if self.look is not None:
            return sorted(self.look.still.blueprints)
        return sorted(name for name in self.world.objects.types_of if name not in self.world.profiles.wholes)

    @cached_property
    def wording(self) -> Wording:
        """Its words for facts and instructions."""
        return Wording(self.world.task.problem)

    def offers(self, name: str | None) -> list[Operator]:
        """Return the ground actions that mention an object or its parts, or no object at all, such as ``wait()``.

        What can never be done is not among them.

        The object's own instructions come before those of its parts; without a ``name`` there are none.

        Raises:
            TmdError: There is no such object.
        """
        if name is not None:
            require_object(name, self.world)
        names = {name, *(part for _, part in self.world.profiles.parts.get(name or "", ()))}
        found = [o for o in self.world.task.operators if not (args := o.instruction.args) or names & set(args)]
        return sorted(found, key=lambda o: (name not in o.instruction.args, o.instruction))


class Reel:
    """A sequence of states, the first one that of the environment.

    The instructions of ``plan`` lead through further states; each of them must apply.

    Attributes:
        states: As bits of the environment's task; never empty.
    """

    def __init__(self, setting: Setting, plan: Iterable[Instruction] = ()) -> None:
        self.setting = setting
        self.states: tuple[Bits, ...] = tuple(setting.world.task.trace(setting.world.task.init, plan))
        self._pictures: list[Picture] = [] if setting.look is None else [setting.look.first]

    def become(self, states: Sequence[Bits]) -> None:
        """Hold other states; what is drawn of the same beginning stays."""
        same = 0
        while same < min(len(states), len(self.states)) and states[same] == self.states[same]:
            same += 1
        self.states = tuple(states)
        del self._pictures[max(same, 1) :]

    def facts(self, step: int) -> State:
        """Return the facts after a number of steps."""
        return self.setting.world.task.decode(self.states[step])

    def changes(self, step: int) -> tuple[list[GroundAtom], list[GroundAtom]]:
        """Return the facts that a step made true, and those that it made false, sorted; none for the beginning."""
        before, after = self.states[max(step - 1, 0)], self.states[step]
        names = self.setting.world.task.names
        return names(after & ~before), names(before & ~after)

    def picture(self, step: int) -> Picture | None:
        """Return the picture after a number of steps; ``None`` where there is nothing to see."""
        look = self.setting.look
        if look is None:
            return None
        with _DRAWING:
            while len(self._pictures) <= step:
                facts = self.facts(len(self._pictures))
                self._pictures.append(look.still.draw(facts, self._pictures[-1]))
        return self._pictures[step]


def open_setting(corpus: Corpus, world: World, path: Path) -> Setting:
    """Make an environment ready.

    Raises:
        TmdError: The environment is wrong. Where only its shapes are, there is nothing to see, and it says why.
    """
    if path.suffix != ".yaml":
        return Setting(world, path, blind="A PDDL problem has no places: it is drawn as a graph.")
    try:
        return Setting(world, path, _look(corpus.folder, world, path))
    except TmdError as error:
        return Setting(world, path, blind=f"This environment is drawn as a graph: {error.message}.")


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
