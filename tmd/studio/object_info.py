"""Facts about one object: its parts, its states, and the edges of its object graph."""

from __future__ import annotations

from tmd.diagnostics import TmdError
from tmd.pddl.model import GroundAtom
from tmd.pddl.reading.syntax import nearest
from tmd.pddl.task import Bits
from tmd.world.world import PART_OF, World


def about(name: str, world: World, state: Bits) -> dict[str, list[GroundAtom]]:
    """Return the facts about ``name`` in ``state`` by heading, each sorted.

    States are those of it alone (*mug1 is hot*), relations those of it and another object (*mug1 is on counter1*), and
    the rest never changes (*stove1_knob1 controls stove1_burner1*); edges that hold both ways add nothing, and are left
    out.

    Raises:
        TmdError: There is no such object.
    """
    require_object(name, world)
    static, constants = world.task.static, world.profiles.constants

    def shared(atom: GroundAtom) -> bool:
        return any(argument != name and argument not in constants for argument in atom.args)

    now = [atom for atom in world.task.names(state) if name in atom.args]
    always = [atom for atom in sorted(static) if name in atom.args and atom.predicate != PART_OF and shared(atom)]
    return {
        "States": [atom for atom in now if not shared(atom)],
        "Relations": [atom for atom in now if shared(atom)],
        "What controls what": [atom for atom in always if atom._replace(args=atom.args[::-1]) not in static],
    }


def require_object(name: str, world: World) -> None:
    """Make sure that an environment has an object.

    Raises:
        TmdError: It has none of that name.
    """
    known = world.objects.types_of
    if name not in known:
        raise TmdError(f"there is no object '{name}'", hint=nearest(name, list(known), what="objects"))
