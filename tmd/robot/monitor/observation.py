"""The symbolic state, read back from the simulation.

A fact is *seen* (a sensor measures it), *derived* (the rules of ``objects.yaml`` follow it from what is seen),
*inferred* (by a rule, see :class:`FactInference`) or *assumed*: it changes as PDDL says, and only when the skill's own
event was seen in the simulation. What PDDL says is asked of the state that was observed before, not of the one that
was predicted. What should stand and has fallen over is not at its place.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from math import degrees
from typing import TYPE_CHECKING

from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import GroundAtom, Instruction, Problem, State, universe
from tmd.pddl.semantics import apply
from tmd.pddl.task import Operator, Task
from tmd.robot.skills.results import Basis, KnownEffect
from tmd.robot.skills.results import Mismatch as Mismatch
from tmd.robot.skills.skill_file import Exposure, Skills
from tmd.world.compile import derive, derive_rules
from tmd.world.folder import DomainFolder

if TYPE_CHECKING:
    from tmd.robot.skills.robot_context import Cell


# Metres within which things are near.
REACH = 1.1


class Observer:
    """Reads states of a simulation back; ``skills`` gives the sensor of each predicate."""

    def __init__(self, problem: Problem, folder: DomainFolder, skills: Skills, senses: Cell) -> None:
        self.problem = problem
        self.folder = folder
        self.skills = skills
        self.senses = senses
        self._universe = universe(problem)
        declared = {p.name: p.parameters for p in problem.domain.predicates}
        self._robots = {
            predicate: self._universe.of(declared[predicate][0].types)
            for predicate, sensor in skills.seen.items()
            if sensor in ("held", "one_hand", "two_hands")
        }

        self._task, self._rules = self._ground()
        self._inference = FactInference(skills, senses)
        self._inferred = InferredFacts(set())

    def _ground(self) -> tuple[Task, list[Operator]]:
        """Instantiate the rules of the derived predicates, on bit sets."""
        domain = self.problem.domain
        rules = [
            replace(schema, name=f"{schema.name}_{number}")
            for number, schema in enumerate(derive_rules(self.folder) if self.skills.derived else ())
            if any(effect.atom.predicate in self.skills.derived for effect in schema.effects)
        ]
        task = ground(replace(self.problem, domain=replace(domain, actions=(*domain.actions, *rules))))
        known = [task.by_instruction.get(Instruction(rule.name)) for rule in rules]
        return task, [operator for operator in known if operator is not None]

    def after(self, before: State, instruction: Instruction, *, happened: bool, evidence: str = "") -> State:
        """Return the state after an instruction, from the state that was observed ``before`` it.

        Unless the skill's event was seen to have ``happened``, facts without a sensor stay as they were.
        """
        predicted = apply(instruction, before, self.problem)
        inferred = self._inference.after(before, predicted, instruction, evidence, happened=happened)
        found = self._now(inferred, before, predicted if happened else before)
        self._inferred = inferred
        return found

    def now(self, kept: State) -> State:
        """Return the state now, with invisible facts as in ``kept``."""
        self._inferred = InferredFacts(set(kept))
        return self._now(self._inferred, kept, kept)

    def _now(self, inferred: InferredFacts, before: State, jointless: State) -> State:
        """Return the state now; facts left open by a joint are as before, those without a joint as ``jointless``."""
        kept = inferred.state
        told = {a for a in kept if a.predicate not in self.skills.seen and a.predicate not in self.skills.derived}
        state = self._with_derived(frozenset(told | self._seen(before, jointless)))
        state -= self._toppled(state)
        self._inference.observed(state)
        return state

    def _toppled(self, state: State) -> set[GroundAtom]:
        places = [a for a in state if self.skills.seen.get(a.predicate) == "support"]
        return {a for a in places if self.senses.fallen(a.args[0])}

    def _with_derived(self, found: State) -> State:
        if not self.skills.derived:
            return found
        bits = self._task.encode(found)
        if any(a not in self._task.index and a not in self._task.static for a in found):
            followed = derive(self.problem, self.folder, found)  # a fact that no instruction brings about
        else:
            for operator in self._rules:
                bits = operator.apply(bits)
            followed = self._task.decode(bits)
        return found | {a for a in followed if a.predicate in self.skills.derived}

    def effects(self, before: State, predicted: State, observed: State) -> list[KnownEffect]:
        """Return the changes of an instruction as predicted, sorted, each with its basis.

        Things that the robot is no longer near to are left out.
        """
        found = []
        for atom in sorted(predicted ^ before):
            holds = atom in predicted
            if holds is not (atom in observed) or (not holds and atom.predicate in self.skills.confirmed):
                continue
            found.append(KnownEffect(atom, holds, *self._known_by(atom)))
        return found

    def _known_by(self, atom: GroundAtom) -> tuple[Basis, str]:
        sensor = self.skills.seen.get(atom.predicate) or self.skills.confirmed.get(atom.predicate)
        if sensor == "setting" and not self.senses.has_joint(atom.args[0]):
            sensor = None  # a channel: there is no joint
        if sensor is not None:
            return Basis.MEASURED, self.senses.measured(atom, sensor)
        if atom.predicate in self.skills.derived:
            return Basis.INFERRED, "by the rules of objects.yaml from what was measured"
        return self._inferred.known.get(atom, (Basis.ASSUMED, "PDDL says so"))

    def mismatches(self, predicted: State, observed: State) -> list[Mismatch]:
        """Return the differences, and the unconfirmed facts; sorted."""
        found = []
        for atom in sorted(predicted ^ observed):
            expected = atom in predicted
            sensor = self.skills.seen.get(atom.predicate, "")
            found.append(Mismatch(atom, expected, self._measured(atom, sensor, atom in observed)))
        for atom in sorted(predicted & observed):
            if self.skills.confirmed.get(atom.predicate) == "reach" and self.senses.reach(atom.args[-1]) > REACH:
                found.append(Mismatch(atom, True, self.senses.measured(atom, "reach")))
        return found

    def lasting(self, end: State, observed: State, *, odd: bool = False) -> list[Mismatch]:
        """Return the differences of things, joints and contents from ``end``, and joints between open and shut; sorted.

        With ``odd``, only what is neither open nor shut, has fallen over or is nowhere.
        """
        seen = {p for p, sensor in self.skills.seen.items() if sensor in ("support", "joint", "setting")}
        told = seen | {p for p, rule in self.skills.inferred.items() if rule == "contents"}
        found: list[Mismatch] = []
        if not odd:
            differing = sorted(a for a in end ^ observed if a.predicate in told)
            for atom in differing:
                measured = self._measured(atom, self.skills.seen.get(atom.predicate, ""), atom in observed)
                found.append(Mismatch(atom, atom in end, measured))
        known = {each.atom for each in found}
        for predicate, sensor in sorted(self.skills.seen.items()):
            for name in self._names(self._declared(predicate)) if sensor in ("joint", "support") else ():
                if sensor == "joint":
                    wrong = self.senses.ajar(name)
                    atom = GroundAtom(predicate, (name,))
                else:
                    wrong = self.senses.fallen(name)
                    atom = GroundAtom(predicate, (name, *(self.senses.support(name) or ("", ""))))
                if wrong and atom not in known:
                    found.append(Mismatch(atom, atom in end, self.senses.measured(atom, sensor)))
        return found

    def _declared(self, predicate: str) -> tuple[str, ...]:
        declared = next(p for p in self.problem.domain.predicates if p.name == predicate)
        return tuple(declared.parameters[0].types)

    def _measured(self, atom: GroundAtom, sensor: str, holds: bool) -> str:
        if sensor:
            return self.senses.measured(atom, sensor)
        if atom in self._inferred.against:
            return self._inferred.against[atom]
        if atom.predicate in self.skills.derived:
            return f"what is seen gives {'' if holds else 'not '}{atom}"
        return f"nothing was seen that would {'end' if holds else 'bring about'} it"

    def _seen(self, before: State, jointless: State) -> set[GroundAtom]:
        found: set[GroundAtom] = set()
        held = self.senses.held()
        for predicate, sensor in self.skills.seen.items():
            match sensor:
                case "held":
                    found.update(GroundAtom(predicate, (r, x)) for r in self._robots[predicate] for x in held)
                case "one_hand" | "two_hands":
                    if len(held) == (1 if sensor == "one_hand" else 2):
                        found.update(GroundAtom(predicate, (r,)) for r in self._robots[predicate])
                case _:
                    found |= self._of_things(predicate, sensor, before, jointless, held)
        return found

    def _of_things(
        self, predicate: str, sensor: str, before: State, jointless: State, held: Sequence[str]
    ) -> set[GroundAtom]:
        found: set[GroundAtom] = set()
        with_joint, without = ([a for a in state if a.predicate == predicate] for state in (before, jointless))
        for name in self._names(self._declared(predicate)):
            if sensor == "support":
                place = None if name in held else self.senses.support(name)
                found |= {GroundAtom(predicate, (name, *place))} if place else set()
                continue
            usual = {a for a in (with_joint if self.senses.has_joint(name) else without) if a.args[0] == name}
            if sensor == "joint":
                is_open = self.senses.is_open(name)
                found |= usual if is_open is None else {GroundAtom(predicate, (name,))} if is_open else set()
            else:
                setting = self.senses.setting(name)
                found |= usual if setting is None else {GroundAtom(predicate, (name, setting))}
        return found

    def _names(self, types: Iterable[str]) -> tuple[str, ...]:
        return tuple(self._universe.of(tuple(types)))


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
    """The rules of ``inferred`` in ``skills.yaml``, applied to the simulation.

    Nothing here has physics of its own, and nothing is taken from PDDL alone. Contents come in if the mouth of what is
    tipped is over a rim, or a stream runs into a rim, and are gone if the vessel leaned so far that they reach its rim.
    Heat comes of standing on something lit for long enough. A lamp is lit when its button was seen to go down. A fact
    without a rule is assumed, and marked so.
    """

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
