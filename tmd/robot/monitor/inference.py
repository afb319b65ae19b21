"""Facts that follow from measurements by rules: contents, heat, and the effects of buttons and knobs.

Nothing here has physics of its own, and nothing is taken from PDDL alone. Contents come in if the mouth of what is
tipped is over a rim, or a stream runs into a rim, and are gone if the vessel leaned so far that they reach its rim.
Heat comes of standing on something lit for long enough. A lamp is lit when its button was seen to go down. A fact
without a rule is assumed, and marked so.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import degrees
from typing import TYPE_CHECKING

from tmd.pddl.model import GroundAtom, Instruction, State
from tmd.robot.skills.results import Basis as Basis
from tmd.robot.skills.results import KnownEffect as KnownEffect
from tmd.robot.skills.skill_file import Exposure, Skills

if TYPE_CHECKING:
    from tmd.robot.skills.robot_context import Cell


# Skills that fail where the contents do not get over the rim.
_POURING = ("tip", "squeeze", "dip")


@dataclass
class InferredFacts:
    """The facts that no sensor sees.

    Attributes:
        state: The facts.
        known: Basis and rule of those that changed as PDDL says.
        against: The measurements against those that PDDL predicts and that do not hold.
    """

    state: set[GroundAtom]
    known: dict[GroundAtom, tuple[Basis, str]] = field(default_factory=dict)
    against: dict[GroundAtom, str] = field(default_factory=dict)


class FactInference:
    """The rules of ``inferred`` in ``skills.yaml``, applied to the simulation."""

    def __init__(self, skills: Skills, senses: Cell) -> None:
        self._skills, self._senses = skills, senses
        self._contents = {name for name, rule in skills.inferred.items() if rule == "contents"}
        self._about_contents = {
            name for name, rule in skills.inferred.items() if rule == "contents" or isinstance(rule, Exposure)
        }
        self._exposed: dict[GroundAtom, float] = {}

    def after(
        self, before: State, predicted: State, instruction: Instruction, evidence: str, *, happened: bool
    ) -> InferredFacts:
        """Return the facts after an instruction, from those observed before it and those predicted by PDDL.

        Unless the skill's event ``happened``, of which ``evidence`` tells, the instruction had no effect.
        """
        found = InferredFacts(set(predicted if happened else before))
        if happened:
            task = self._skills.task(instruction)
            for atom in sorted(predicted ^ before):
                self._judge(found, atom, before, task.skill, evidence, holds=atom in predicted)
        self._spill(found)
        self._senses.reset_leant()
        return found

    def observed(self, state: State) -> None:
        """Record since when things are exposed to something."""
        watched = {rule.to for rule in self._skills.inferred.values() if isinstance(rule, Exposure)}
        now = self._senses.seconds()
        self._exposed = {a: self._exposed.get(a, now) for a in state if a.predicate in watched}

    def _judge(
        self, found: InferredFacts, atom: GroundAtom, before: State, skill: str, evidence: str, *, holds: bool
    ) -> None:
        rule = self._skills.inferred.get(atom.predicate)
        if rule is None:
            return
        told = (Basis.INFERRED, evidence)
        if rule == "event" or skill in _POURING:
            found.known[atom] = told
        elif isinstance(rule, Exposure) and skill == "wait":
            if holds:
                self._expose(found, atom, rule)
        elif holds and skill != "wait":
            self._run_in(found, atom, before)
        elif skill != "wait":
            found.known[atom] = told

    def _expose(self, found: InferredFacts, atom: GroundAtom, rule: Exposure) -> None:
        """Infer heat of what stood on something lit for long enough."""
        cause = GroundAtom(rule.to, atom.args)
        since = self._exposed.get(cause)
        passed = 0.0 if since is None else self._senses.seconds() - since
        if passed >= rule.seconds - 0.01:
            found.known[atom] = Basis.INFERRED, f"{cause} for {passed:.1f} s, {rule.seconds:g} s are enough"
            return
        found.state.discard(atom)
        found.against[atom] = f"{cause} was so for {passed:.1f} s only, and {rule.seconds:g} s are needed"

    def _run_in(self, found: InferredFacts, atom: GroundAtom, before: State) -> None:
        """Infer contents of a vessel that a stream runs into."""
        measured = self._senses.stream(atom.args[0])
        if measured is None:
            return
        runs_in, told = measured
        if runs_in:
            found.known[atom] = Basis.INFERRED, told
            return
        found.state.discard(atom)
        found.against[atom] = told
        if not any(a.predicate in self._contents and a.args[0] == atom.args[0] for a in before):
            return
        # what is in it already stays as it was
        found.state |= {a for a in before if a.predicate in self._skills.inferred and a.args[0] == atom.args[0]}

    def _spill(self, found: InferredFacts) -> None:
        """Empty vessels that leaned too far."""
        for item in sorted({atom.args[0] for atom in found.state if atom.predicate in self._contents}):
            lean = self._senses.leant(item)
            if lean is None or lean[0] <= lean[1]:
                continue
            told = f"{item} leaned by {degrees(lean[0]):.0f} degrees, and spills from {degrees(lean[1]):.0f}"
            for atom in sorted(a for a in found.state if a.predicate in self._about_contents and a.args[0] == item):
                found.state.discard(atom)
                found.known.pop(atom, None)
                found.against[atom] = told
