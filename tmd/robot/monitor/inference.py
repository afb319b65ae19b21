"""What follows from what was measured, by a rule: contents, heat, and what buttons and knobs bring about.

Nothing here has physics of its own, and nothing is taken from PDDL alone. Contents come in where the mouth of what is
tipped is over a rim, or where a stream runs into a rim, and are gone where the vessel leaned so far that they reach
its rim. Heat comes of standing on what is lit for long enough. A lamp is lit when the button was seen to go down that
controls it. What no rule covers is assumed, and is told as that.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import StrEnum
from math import degrees
from typing import Protocol

from tmd.pddl.model import GroundAtom, Instruction, State
from tmd.robot.skills.skill_file import Exposure, Skills


class Basis(StrEnum):
    """What an effect is known by."""

    MEASURED = "measured"
    """A sensor of the simulation shows it."""
    INFERRED = "inferred"
    """It follows from what was measured, by a rule that is told with it."""
    ASSUMED = "assumed"
    """PDDL says so, and nothing speaks against it."""


@dataclass(frozen=True, slots=True)
class KnownEffect:
    """A fact that an instruction changed as PDDL predicts.

    Attributes:
        atom: The fact.
        holds: Whether it came to hold; else it ended.
        basis: What that is known by.
        how: The numbers, or the rule.
    """

    atom: GroundAtom
    holds: bool
    basis: Basis
    how: str

    def __str__(self) -> str:
        return f"{'' if self.holds else 'not '}{self.atom}"


class ContentSenses(Protocol):
    """What has to be measured of things that hold something."""

    def seconds(self) -> float:
        """Simulated seconds since the beginning."""
        ...

    def leant(self, item: str) -> tuple[float, float] | None:
        """How far a vessel leaned at most since :meth:`reset_leant`, and from which angle on it spills, in radians.

        None for what cannot spill: it is closed, or holds nothing.
        """
        ...

    def reset_leant(self) -> None:
        """Forget how far vessels leaned."""
        ...

    def stream(self, item: str) -> tuple[bool, str] | None:
        """Whether the stream of an outlet runs into a vessel where it stands, with the numbers.

        None where there is no outlet.
        """
        ...


_POURING = ("tip", "squeeze", "dip")
"""Skills that fail where the contents do not get over the rim."""


@dataclass
class InferredFacts:
    """What became of the facts that no sensor sees.

    Attributes:
        state: The facts.
        known: For those that changed as PDDL says, basis and rule.
        against: For those that PDDL predicts and that are not so, what was measured.
    """

    state: set[GroundAtom]
    known: dict[GroundAtom, tuple[Basis, str]] = field(default_factory=dict)
    against: dict[GroundAtom, str] = field(default_factory=dict)


class FactInference:
    """Applies the rules of ``inferred`` in ``skills.yaml``.

    Args:
        skills: Which rule holds for which predicate.
    """

    def __init__(self, skills: Skills) -> None:
        self._skills = skills
        self._contents = {name for name, rule in skills.inferred.items() if rule == "contents"}
        self._exposed: dict[GroundAtom, float] = {}

    def after(
        self,
        senses: ContentSenses,
        before: State,
        predicted: State,
        instruction: Instruction,
        evidence: str,
        *,
        happened: bool,
    ) -> InferredFacts:
        """The facts after an instruction.

        Args:
            senses: The simulation.
            before: Those that were observed before it.
            predicted: Those of PDDL.
            instruction: What was done.
            evidence: What showed that the skill's event happened.
            happened: Whether it did; otherwise nothing came of it.
        """
        found = InferredFacts(set(predicted if happened else before))
        if happened:
            task = self._skills.task(instruction)
            for atom in sorted(predicted ^ before):
                self._judge(senses, found, atom, before, task.skill, evidence, holds=atom in predicted)
        self._spill(senses, found)
        senses.reset_leant()
        return found

    def observed(self, senses: ContentSenses, state: State) -> None:
        """Take note of since when what is exposed to something is so."""
        watched = {rule.to for rule in self._skills.inferred.values() if isinstance(rule, Exposure)}
        now = senses.seconds()
        self._exposed = {a: self._exposed.get(a, now) for a in state if a.predicate in watched}

    def _judge(
        self,
        senses: ContentSenses,
        found: InferredFacts,
        atom: GroundAtom,
        before: State,
        skill: str,
        evidence: str,
        *,
        holds: bool,
    ) -> None:
        rule = self._skills.inferred.get(atom.predicate)
        if rule is None:
            return
        told = (Basis.INFERRED, evidence)
        if rule == "event" or skill in _POURING:
            found.known[atom] = told
        elif isinstance(rule, Exposure) and skill == "wait":
            self._expose(senses, found, atom, rule, holds=holds)
        elif holds and skill != "wait":
            self._run_in(senses, found, atom, before)
        elif not holds and skill != "wait":
            found.known[atom] = told

    def _expose(
        self, senses: ContentSenses, found: InferredFacts, atom: GroundAtom, rule: Exposure, *, holds: bool
    ) -> None:
        """What stood on what is lit, and for long enough, is hot."""
        if not holds:
            return
        cause = GroundAtom(rule.to, atom.args)
        since = self._exposed.get(cause)
        passed = 0.0 if since is None else senses.seconds() - since
        if passed >= rule.seconds - 0.01:
            found.known[atom] = Basis.INFERRED, f"{cause} for {passed:.1f} s, {rule.seconds:g} s are enough"
            return
        found.state.discard(atom)
        found.against[atom] = f"{cause} was so for {passed:.1f} s only, and {rule.seconds:g} s are needed"

    def _run_in(self, senses: ContentSenses, found: InferredFacts, atom: GroundAtom, before: State) -> None:
        """What an outlet gives is in a vessel that its stream runs into."""
        measured = senses.stream(atom.args[0])
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

    def _spill(self, senses: ContentSenses, found: InferredFacts) -> None:
        """What leaned too far is empty."""
        for item in sorted({atom.args[0] for atom in found.state if atom.predicate in self._contents}):
            lean = senses.leant(item)
            if lean is None or lean[0] <= lean[1]:
                continue
            told = f"{item} leaned by {degrees(lean[0]):.0f} degrees, and spills from {degrees(lean[1]):.0f}"
            for atom in _held_in(found.state, item, self._skills):
                found.state.discard(atom)
                found.known.pop(atom, None)
                found.against[atom] = told


def _held_in(state: Iterable[GroundAtom], item: str, skills: Skills) -> list[GroundAtom]:
    """The facts about what is in a thing: what it contains, and its heat."""
    rules = {p for p, rule in skills.inferred.items() if rule == "contents" or isinstance(rule, Exposure)}
    return sorted(atom for atom in state if atom.predicate in rules and atom.args[0] == item)
