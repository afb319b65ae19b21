"""Instructions for an object, and the reasons why some of them do not apply now."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tmd.pddl.model import Instruction, State
from tmd.pddl.task import Bits, Operator
from tmd.studio.object_info import require_object
from tmd.view.wording import Wording
from tmd.world.world import World


@dataclass(frozen=True, slots=True)
class Offer:
    """Instruction; ``why`` is empty where it applies, and otherwise names an unmet or an opposing condition."""

    instruction: Instruction
    why: str = ""

    @property
    def applies(self) -> bool:
        """Return whether it can be carried out in the state that was asked about."""
        return not self.why


@dataclass(frozen=True, slots=True)
class ActionGroup:
    """The instructions of one action, those that apply first."""

    action: str
    offers: tuple[Offer, ...]

    @property
    def applies(self) -> bool:
        """Return whether one of them does."""
        return self.offers[0].applies


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
        self._without: list[Operator] = []
        for operator in world.task.operators:
            for name in dict.fromkeys(operator.instruction.args):
                self._by_object.setdefault(name, []).append(operator)
            if not operator.instruction.args:
                self._without.append(operator)

    def of(self, name: str, state: Bits, *, parts: bool = False) -> tuple[ActionGroup, ...]:
        """Return every instruction that mentions the object ``name``, by action: first those that apply, then by name.

        Args:
            name: The object.
            state: What is the case, as bits of the environment's task.
            parts: Whether what mentions one of its parts is wanted as well.

        Raises:
            TmdError: There is no such object.
        """
        require_object(name, self.world)
        names = [name, *(part for _, part in self.world.profiles.parts.get(name, ()) if parts)]
        return self._groups((o for n in names for o in self._by_object.get(n, ())), state)

    def anywhere(self, state: Bits) -> tuple[ActionGroup, ...]:
        """Return the instructions that mention no object, such as ``wait()``."""
        return self._groups(self._without, state)

    def _groups(self, operators: Iterable[Operator], state: Bits) -> tuple[ActionGroup, ...]:
        found: dict[str, dict[Instruction, Offer]] = {}
        decoded = self.world.task.decode(state)
        for operator in operators:
            own = found.setdefault(operator.instruction.name, {})
            own[operator.instruction] = self._offer(operator, state, decoded)
        groups = [ActionGroup(action, tuple(sorted(own.values(), key=_order))) for action, own in found.items()]
        return tuple(sorted(groups, key=lambda group: (not group.applies, group.action)))

    def _offer(self, operator: Operator, state: Bits, decoded: State) -> Offer:
        if operator.applicable(state):
            return Offer(operator.instruction)
        return Offer(operator.instruction, self.wording.broken(operator.instruction, decoded))


def _order(offer: Offer) -> tuple[bool, Instruction]:
    return not offer.applies, offer.instruction
