"""The factors of the energy, under the paper's names (section VI-A). Each is a cost: smaller is better."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from tmd.inference.config import AKIN
from tmd.language.clause import Clause
from tmd.pddl.model import Instruction
from tmd.veil.instantiate import Instantiation
from tmd.veil.profiles import differences


def delta_env(instantiation: Instantiation) -> float:
    """Environmental distance: the mean share of states in which ξ(z) and ξ_s(z) differ.

    Δ_env = 1/|Z| Σ_z 1/|T(z)| Σ_t 1(ξ(z)[t] ≠ ξ_s(z)[t]); 0 for a template without variables.
    """
    variables = instantiation.grounding
    if not variables:
        return 0.0
    before = instantiation.template.profiles
    return sum(differences(before[z], instantiation.profiles[z]) for z in variables) / len(variables)


def delta_nl(template_clause: Clause, clause: Clause, *, akin: float = AKIN) -> float:
    """Natural-language distance: 1 - |obj(C_s) ∩ obj(C_i)| / |obj(C_s) ∪ obj(C_i)|.

    The paper prints the Jaccard index itself, which is a similarity; a cost needs its complement. Two clauses
    without objects are alike. Nouns of which one is the other with a modifier (*syrup*, *raspberry syrup*) count
    ``akin`` of a noun that both have; with 0 the index is the paper's.
    """
    ours, theirs = list(dict.fromkeys(clause.resolved())), list(dict.fromkeys(template_clause.resolved()))
    shared = [noun for noun in ours if noun in theirs]
    left = [noun for noun in theirs if noun not in shared]
    common = float(len(shared))
    for noun in ours:
        other = next((o for o in left if noun not in shared and akin_nouns(noun, o)), None)
        if other is not None:
            left.remove(other)
            common += akin
    union = len(ours) + len(theirs) - common
    return 1 - common / union if union else 0.0


def akin_nouns(one: str, other: str) -> bool:
    """Whether one noun is the other with a modifier: *ice cream* and *vanilla ice cream*."""
    return one.endswith(f"_{other}") or other.endswith(f"_{one}")


def delta_sim(instantiation: Instantiation) -> float:
    """Parameter similarity cost: the share of variables that stand for another object than in the sample."""
    variables = instantiation.grounding
    if not variables:
        return 0.0
    before = instantiation.template.grounding
    return sum(before[z] != name for z, name in variables.items()) / len(variables)


def delta_pcc(template_clause: Clause, clause: Clause) -> float:
    """Parameter cardinality cost: 1 where the clauses speak of different numbers of objects."""
    return float(len(clause.resolved()) != len(template_clause.resolved()))


def delta_dscpl(instructions: Sequence[Instruction]) -> float:
    """Description length: the sum over the instructions of the number of arguments plus one."""
    return float(sum(1 + len(instruction.args) for instruction in instructions))


def delta_trim(kept: int, whole: int) -> float:
    """Trimming cost: (|I_s| - |I_i|)²."""
    return float((whole - kept) ** 2)


def delta_cover(names: Collection[str], used: Collection[str]) -> float:
    """The share of the objects that the clause speaks of (``names``) which the instructions do not touch.

    Not in the paper. Δ_nl compares the clause with the template's clause, not with what is done: this keeps *take
    the bowl* from being served by what somebody did for *get it boiling*. 0 where the clause speaks of no object.
    """
    return sum(name not in used for name in names) / len(names) if names else 0.0
