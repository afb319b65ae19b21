"""The instructions of one environment by object."""

from __future__ import annotations

from tmd.goals.wording import Wording
from tmd.pddl.task import Operator
from tmd.view.panels import require_object
from tmd.world.world import World


class Offers:
    """The instructions of one environment by object. Nothing in it changes: threads may share it.

    Args:
        world: The environment. Offered are the ground actions of its task; what can never be done in it is not among
            them.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        self.wording = Wording(world.task.problem)
        self._by_object: dict[str, list[Operator]] = {}
        for operator in world.task.operators:
            for name in dict.fromkeys(operator.instruction.args or ("",)):
                self._by_object.setdefault(name, []).append(operator)

    def of(self, name: str | None) -> list[Operator]:
        """Return the instructions that mention an object or its parts, or no object at all, such as ``wait()``.

        Args:
            name: The object, whose own instructions come before those of its parts; ``None`` for none.

        Raises:
            TmdError: There is no such object.
        """
        names = [""]
        if name is not None:
            require_object(name, self.world)
            names += [name, *(part for _, part in self.world.profiles.parts.get(name, ()))]
        found = {o.instruction: o for each in names for o in self._by_object.get(each, ())}
        return [found[instruction] for instruction in sorted(found, key=lambda i: (name not in i.args, i))]
