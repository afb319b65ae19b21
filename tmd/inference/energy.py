"""The energy of a choice: every factor with its weight (section VI). Summed over the choices it is the paper's Γ."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from tmd.inference import factors
from tmd.inference.config import AKIN
from tmd.inference.learning.statistics import EndStates, Statistics, kind_of
from tmd.inference.weights import Weights
from tmd.language.clause import Clause
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.veil.instantiate import Instantiation
from tmd.veil.world import World

Factors = dict[str, float]
"""Factors by name, not yet multiplied by their weights."""


class Energy:
    """The factors of one environment under given weights.

    Args:
        weights: What each factor counts for.
        statistics: The tables of the training data.
        world: The environment.
        akin: As for :func:`~tmd.inference.factors.delta_nl`.
    """

    def __init__(self, weights: Weights, statistics: Statistics, world: World, *, akin: float = AKIN) -> None:
        self.weights = weights
        self.statistics = statistics
        self.world = world
        self.akin = akin
        self._surprises: dict[Instruction, tuple[float, float]] = {}

    def of_template(self, instantiation: Instantiation, clause: Clause) -> Factors:
        """The factors of ψ_i that do not depend on how much of the template is kept."""
        template = instantiation.template.clause
        return {
            "env": factors.delta_env(instantiation),
            "nl": factors.delta_nl(template, clause, akin=self.akin),
            "sim": factors.delta_sim(instantiation),
            "pcc": factors.delta_pcc(template, clause),
        }

    def of_sequence(self, kept: Sequence[Instruction], whole: int, names: Sequence[str]) -> Factors:
        """The factors of ψ_i that depend on the instructions that are kept; ``names`` is what the clause speaks of."""
        used = {unit for i in kept for argument in i.args for unit in self.world.profiles.unit(argument)}
        inpr, para = self._prior(kept)
        return {
            "dscpl": factors.delta_dscpl(kept),
            "inpr": inpr,
            "para": para,
            "trim": factors.delta_trim(len(kept), whole),
            "cover": factors.delta_cover(names, used),
        }

    def of_end(self, verb: str, names: Sequence[str], end: Bits) -> Factors:
        """ψ'_i: whether the clause's objects end as they usually do when its verb has been done."""
        table = self.statistics.ends.get(self.world.mentions.lexicon.canonical_verb(verb))
        return {"cons": self._inconsistency(table, names, end) if table is not None else 0.0}

    def of_latent(self, plan: Sequence[Instruction], end: Bits) -> Factors:
        """ψ_il and ψ'_il, for the instructions that were left unsaid; nothing where none are needed."""
        if not plan:
            return {}
        inpr, para = self._prior(plan)
        used = dict.fromkeys(a for i in plan for a in i.args if a not in self.world.profiles.constants)
        return {
            "latent_dscpl": factors.delta_dscpl(plan),
            "latent_inpr": inpr,
            "latent_para": para,
            "latent_cons": self._inconsistency(self.statistics.all_ends, list(used), end),
        }

    def least_more(self) -> float:
        """The least that end and latent factors can add to a candidate: they are never negative but by weight."""
        if any(self.weights[name] < 0 for name in ("latent_dscpl", "latent_inpr", "latent_para")):
            return -math.inf
        return min(0.0, self.weights["cons"]) + min(0.0, self.weights["latent_cons"])

    def weigh(self, values: Mapping[str, float]) -> Factors:
        """Each factor multiplied by its weight."""
        return {name: self.weights[name] * value for name, value in values.items()}

    def total(self, values: Mapping[str, float]) -> float:
        """The weighed factors, summed."""
        return sum(self.weigh(values).values())

    def _prior(self, instructions: Sequence[Instruction]) -> tuple[float, float]:
        """Δ_inpr and Δ_para: the mean surprise of the instructions, and of the classes of their arguments."""
        if not instructions:
            return 0.0, 0.0
        found = [self._surprise(instruction) for instruction in instructions]
        count = len(found)
        return math.fsum(own for own, _ in found) / count, math.fsum(args for _, args in found) / count

    def _surprise(self, instruction: Instruction) -> tuple[float, float]:
        if instruction not in self._surprises:
            kinds = [kind_of(argument, self.world) for argument in instruction.args]
            self._surprises[instruction] = self.statistics.surprise(instruction, kinds)
        return self._surprises[instruction]

    def _inconsistency(self, table: EndStates, names: Sequence[str], end: Bits) -> float:
        """Δ_cons: one minus the mean probability of the objects' states; 0 for no object."""
        objects = [(kind_of(name, self.world), self.world.profiles.of(name, end)) for name in names]
        probability = table.mean(objects)
        return 1 - probability if probability is not None else 0.0
