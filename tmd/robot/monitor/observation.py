"""The symbolic state, read back from the simulation.

A fact is *seen* (a sensor measures it), *derived* (the rules of ``objects.yaml`` follow it from what is seen),
*inferred* (see :mod:`tmd.robot.monitor.inference`) or *assumed*: it changes as PDDL says, and only when the skill's own
event was seen in the simulation. What PDDL says is asked of the state that was observed before, not of the one that
was predicted. What should stand and has fallen over is not at its place.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import GroundAtom, Instruction, Problem, State, universe
from tmd.pddl.semantics import apply
from tmd.pddl.task import Operator, Task
from tmd.robot.monitor.inference import FactInference, InferredFacts
from tmd.robot.skills.results import Basis, KnownEffect
from tmd.robot.skills.results import Mismatch as Mismatch
from tmd.robot.skills.skill_file import Skills
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
