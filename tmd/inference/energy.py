"""The energy of a choice: every factor with its weight (section VI), and the counts that the factors read.

Summed over the choices it is the paper's Γ.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from pathlib import Path
from weakref import WeakKeyDictionary

from tmd.diagnostics import Location, TmdError
from tmd.inference.config import AKIN
from tmd.library.library import Library
from tmd.library.template import Instantiation, Template
from tmd.pddl.model import Instruction
from tmd.pddl.reading.syntax import nearest, read_text
from tmd.pddl.task import Bits
from tmd.world.verb_clause import VerbClause
from tmd.world.world import Profile, World, differences

# Added to every count, so that nothing has probability zero (Laplace).
SMOOTHING = 1.0

StateName = tuple[str, ...]


class Frequencies(Counter[str]):
    """Counts of things of one kind, with smoothed probabilities."""

    def surprise(self, name: str) -> float:
        """Return -log P(name); all unseen names share one smoothed count."""
        kinds = len(self) + 1
        return -math.log((self[name] + SMOOTHING) / (self.total() + SMOOTHING * kinds))


class EndStates(Counter[tuple[str, StateName, bool]]):
    """P(obj, s, v): how often an object of a class was in a state when a clause that speaks of it had been done."""

    def add(self, kind: str, profile: Profile) -> None:
        """Count the states of one object."""
        self.update((kind, state, value) for state, value in profile.items())

    def probability(self, kind: str, state: StateName, value: bool) -> float:
        """Return the smoothed probability of ``value``; a half where nothing is known."""
        own = self.get((kind, state, value), 0) + SMOOTHING
        other = self.get((kind, state, not value), 0) + SMOOTHING
        return own / (own + other)

    def mean(self, objects: Iterable[tuple[str, Profile]]) -> float | None:
        """Return the mean probability over all states of objects (kind and profile); ``None`` for no state."""
        found = [self.probability(kind, state, value) for kind, profile in objects for state, value in profile.items()]
        return math.fsum(found) / len(found) if found else None


@dataclass(slots=True)
class Statistics:
    """All tables.

    Attributes:
        instructions: How often each instruction occurs.
        parameters: For each parameter of each instruction, the classes of its objects.
        ends: P(obj, s, v) for the objects that clauses of a verb speak of.
        all_ends: The same for all verbs, for every object that was used: for latent instructions.
    """

    instructions: Frequencies = field(default_factory=Frequencies)
    parameters: dict[tuple[str, int], Frequencies] = field(default_factory=dict)
    ends: dict[str, EndStates] = field(default_factory=dict)
    all_ends: EndStates = field(default_factory=EndStates)

    def surprise(self, instruction: Instruction, kinds: Sequence[str]) -> tuple[float, float]:
        """Return -log P of the instruction, and the mean -log P of the classes of its arguments."""
        own = self.instructions.surprise(instruction.name)
        tables = (self.parameters.get((instruction.name, i), _NOTHING) for i in range(len(kinds)))
        each = [table.surprise(kind) for table, kind in zip(tables, kinds, strict=True)]
        return own, math.fsum(each) / len(each) if each else 0.0


_NOTHING = Frequencies()


_COUNTED: WeakKeyDictionary[Library, tuple[int, Statistics]] = WeakKeyDictionary()


def count(library: Library) -> Statistics:
    """Count the templates of a library; the tables are remembered until it has more templates."""
    known = _COUNTED.get(library)
    if known is not None and known[0] == len(library):
        return known[1]
    found = Statistics()
    for verb in library.verbs():
        for template in library.templates(verb):
            _count_template(verb, template, found)
    _COUNTED[library] = len(library), found
    return found


def _count_template(verb: str, template: Template, found: Statistics) -> None:
    for instruction in template.instructions:
        found.instructions[instruction.name] += 1
        for position, argument in enumerate(instruction.args):
            table = found.parameters.setdefault((instruction.name, position), Frequencies())
            table[template.classes.get(argument, argument)] += 1
    ends = found.ends.setdefault(verb, EndStates())
    for kind, profile in template.subjects:
        ends.add(kind, profile)
    for variable, profile in template.ends.items():
        found.all_ends.add(template.classes[variable], profile)


def kind_of(name: str, world: World) -> str:
    """Return the kind of an object, its class as a rule; a constant is its own."""
    if name in world.profiles.constants:
        return name
    return world.mentions.kinds.get(name, name)


# The factors with their explanations: the more of one, the dearer the plan.
_MEANINGS = {
    "environment_distance": "How much the things here were in other states than the things in the demonstration.",
    "clause_distance": "How many of the things that the clause names are not those that the demonstration's clause "
    "named.",
    "parameter_similarity": "How many things of the demonstration something else stands in for.",
    "parameter_cardinality": "Whether the clause names more things, or fewer, than the demonstration's clause.",
    "description_length": "How long the steps are to write down: one for each, and one for each thing in it.",
    "instruction_prior": "How rare the steps' actions are in the demonstrations.",
    "parameter_prior": "How rare such things are in such steps in the demonstrations.",
    "trimming": "How many steps of the demonstration are left out, squared.",
    "inconsistent_end": "How unlike what this verb usually leaves behind the state at the end is.",
    "objects_not_touched": "How many of the things that the clause names no step touches.",
    "language_model": "How unlikely a person is to have said just this of what is done.",
    "policy_proposal": "What a choice costs that the policy proposed and no demonstration showed.",
    "changes_not_asked_for": "How much is otherwise at the end that nobody asked for.",
    "reading_prior": "How unlikely the reader thinks it that this goal is meant (-log P).",
    "latent_description_length": "How long the steps are to write down that the planner puts in.",
    "latent_instruction_prior": "How rare the actions are that the planner puts in.",
    "latent_parameter_prior": "How rare such things are in the steps that the planner puts in.",
    "latent_inconsistent_end": "How unlike what is usual the state is that the steps which the planner puts in leave "
    "behind.",
    "expected_loss": "How far the plan is on average from what people may do, in steps and in what they change, in "
    "percent.",
}
FIXED = ("reading_prior",)
"""The factors whose weights are set by hand: no demonstration says how a request was misread."""
OURS = ("objects_not_touched", "language_model", "policy_proposal", "changes_not_asked_for")
"""Those of them that are not in the paper."""
NAMES = tuple(name for name in _MEANINGS if name not in (*FIXED, "expected_loss"))
"""The factors whose weights are learned. Δ_jmp is not among them: its weight is infinite (section VI-F)."""
# Titles that are more than the name in words.
_TITLES = {"language_model": "language model (-log P)", "reading_prior": "prior of the reading"}


def title(name: str) -> str:
    """Return the words for a factor, where files and JSON have its name."""
    return _TITLES.get(name, name.replace("_", " "))


def meaning(name: str) -> str:
    """Explain a factor in a sentence; empty where it is not known."""
    return _MEANINGS.get(name, "")


# Former names of factors, without the prefix of latent ones.
_OLD_NAMES = {
    "env": "environment_distance",
    "nl": "clause_distance",
    "sim": "parameter_similarity",
    "pcc": "parameter_cardinality",
    "dscpl": "description_length",
    "inpr": "instruction_prior",
    "para": "parameter_prior",
    "trim": "trimming",
    "cons": "inconsistent_end",
    "cover": "objects_not_touched",
    "words": "language_model",
    "generated": "policy_proposal",
    "unasked": "changes_not_asked_for",
    "prior": "reading_prior",
}
_LATENT = "latent_"
_RENAMED = {"original": "paper", "hand_set": "paper_extended", "generating": "policy", "stating": "goals"}


@dataclass(frozen=True, slots=True)
class Weights:
    """A number for each of :data:`NAMES` and :data:`FIXED`; a factor without one weighs nothing."""

    values: Mapping[str, float]

    def __post_init__(self) -> None:
        for name in self.values:
            _refuse_old_name(name)

    def __getitem__(self, name: str) -> float:
        return self.values.get(name, 0.0)

    def __iter__(self) -> Iterator[str]:
        return iter(NAMES)


def _refuse_old_name(name: str, place: Location | None = None, line: str | None = None) -> None:
    """Raise TmdError for a former name of a factor."""
    new = _OLD_NAMES.get(name.removeprefix(_LATENT))
    if new is not None:
        new = f"{_LATENT}{new}" if name.startswith(_LATENT) else new
        raise TmdError(f"the factor '{name}' is now called '{new}'", location=place, source=line)


def parse_weights(text: str, file: str = "<text>") -> Weights:
    """Read weights: ``name value`` a line, ``#`` begins a comment.

    Raises:
        TmdError: A line is malformed, a name is unknown or given twice, or a value is not a finite number.
    """
    values: dict[str, float] = {}
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.split("#", 1)[0].split()
        place = Location(file, number, 1)
        if not words:
            continue
        if len(words) != 2:
            raise TmdError("a line of weights is a name and a number", location=place, source=line)
        name, value = words
        _refuse_old_name(name, place, line)
        if name not in (*NAMES, *FIXED):
            hint = nearest(name, (*NAMES, *FIXED))
            raise TmdError(f"there is no factor '{name}'", location=place, source=line, hint=hint)
        if name in values:
            raise TmdError(f"'{name}' has a weight already", location=place, source=line)
        try:
            values[name] = float(value)
        except ValueError:
            raise TmdError(f"'{value}' is not a number", location=place, source=line) from None
        if not math.isfinite(values[name]):
            raise TmdError(f"the weight of '{name}' is not finite", location=place, source=line)
    return Weights(values)


def read_weights(path: Path) -> Weights:
    """Return the weights in a file.

    Raises:
        TmdError: As :func:`parse_weights`, or the file cannot be read.
    """
    found = parse_weights(read_text(path), str(path))
    if not found:
        raise TmdError(f"{path} has no weights", hint="write the name of a factor and a number on a line")
    return found


def named_weights(name: str) -> Weights:
    """Return the weights that come with the package: those of a preset (:mod:`tmd.inference.config`), or ``nearest``.

    Raises:
        TmdError: There are none of that name.
    """
    if name in _RENAMED:
        raise TmdError(f"the weights '{name}' are now called '{_RENAMED[name]}'")
    folder = resources.files("tmd.inference") / "data"
    known = sorted(f.name.removesuffix(".txt") for f in folder.iterdir() if f.name.endswith(".txt"))
    if name not in known:
        raise TmdError(f"there are no weights '{name}'", hint=nearest(name, known))
    return parse_weights((folder / f"{name}.txt").read_text(encoding="utf-8"), f"{name}.txt")


def format_weights(weights: Weights) -> str:
    """Return the text of a weights file; reading it gives the same weights."""
    return "".join(f"{name} {weights[name]!r}\n" for name in (*NAMES, *FIXED))


def environment_distance(instantiation: Instantiation) -> float:
    """Return the environmental distance: the mean share of states in which ξ(z) and ξ_s(z) differ.

    Δ_env = 1/|Z| Σ_z 1/|T(z)| Σ_t 1(ξ(z)[t] ≠ ξ_s(z)[t]); 0 for a template without variables.
    """
    variables = instantiation.grounding
    if not variables:
        return 0.0
    before = instantiation.template.profiles
    return sum(differences(before[z], instantiation.profiles[z]) for z in variables) / len(variables)


def clause_distance(template_clause: VerbClause, clause: VerbClause, *, akin: float = AKIN) -> float:
    """Return the natural-language distance: 1 - |obj(C_s) ∩ obj(C_i)| / |obj(C_s) ∪ obj(C_i)|.

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
    """Return whether one noun is the other with a modifier: *ice cream* and *vanilla ice cream*."""
    return one.endswith(f"_{other}") or other.endswith(f"_{one}")


def parameter_similarity(instantiation: Instantiation) -> float:
    """Return the parameter similarity cost: the share of variables whose object is not that of the sample."""
    variables = instantiation.grounding
    if not variables:
        return 0.0
    before = instantiation.template.grounding
    return sum(before[z] != name for z, name in variables.items()) / len(variables)


def parameter_cardinality(template_clause: VerbClause, clause: VerbClause) -> float:
    """Return the parameter cardinality cost: 1 where the clauses speak of different numbers of objects."""
    return float(len(clause.resolved()) != len(template_clause.resolved()))


def description_length(instructions: Sequence[Instruction]) -> float:
    """Return the description length: the sum over the instructions of the number of arguments plus one."""
    return float(sum(1 + len(instruction.args) for instruction in instructions))


def trimming(kept: int, whole: int) -> float:
    """Return the trimming cost: (|I_s| - |I_i|)²."""
    return float((whole - kept) ** 2)


def objects_not_touched(names: Collection[str], used: Collection[str]) -> float:
    """Return the share of the objects that the clause speaks of (``names``) which the instructions do not touch.

    Not in the paper. Δ_nl compares the clause with the template's clause, not with what is done: this keeps *take
    the bowl* from being served by what somebody did for *get it boiling*. 0 where the clause speaks of no object.
    """
    return sum(name not in used for name in names) / len(names) if names else 0.0


Factors = dict[str, float]
"""Factors by name, not yet multiplied by their weights."""


class Energy:
    """The factors of one environment under given weights. ``akin`` is as for :func:`clause_distance`."""

    def __init__(self, weights: Weights, statistics: Statistics, world: World, *, akin: float = AKIN) -> None:
        self.weights = weights
        self.statistics = statistics
        self.world = world
        self.akin = akin
        self._surprise = cache(self._surprise_here)

    def of_template(self, instantiation: Instantiation, clause: VerbClause) -> Factors:
        """Return the factors of ψ_i that do not depend on how much of the template is kept."""
        template = instantiation.template.clause
        return {
            "environment_distance": environment_distance(instantiation),
            "clause_distance": clause_distance(template, clause, akin=self.akin),
            "parameter_similarity": parameter_similarity(instantiation),
            "parameter_cardinality": parameter_cardinality(template, clause),
        }

    def of_sequence(self, kept: Sequence[Instruction], whole: int, names: Sequence[str]) -> Factors:
        """Return the factors of ψ_i that depend on the kept instructions; ``names`` are the clause's objects."""
        used = {unit for i in kept for argument in i.args for unit in self.world.profiles.unit(argument)}
        own, arguments = self._prior(kept)
        return {
            "description_length": description_length(kept),
            "instruction_prior": own,
            "parameter_prior": arguments,
            "trimming": trimming(len(kept), whole),
            "objects_not_touched": objects_not_touched(names, used),
        }

    def of_end(self, verb: str, names: Sequence[str], end: Bits) -> Factors:
        """Return ψ'_i: whether the clause's objects end as they usually do when its verb has been done."""
        table = self.statistics.ends.get(self.world.mentions.lexicon.canonical_verb(verb))
        return {"inconsistent_end": self._inconsistency(table, names, end) if table is not None else 0.0}

    def of_latent(self, plan: Sequence[Instruction], end: Bits) -> Factors:
        """Return ψ_il and ψ'_il, for the instructions that were left unsaid; nothing where none are needed."""
        if not plan:
            return {}
        own, arguments = self._prior(plan)
        used = dict.fromkeys(a for i in plan for a in i.args if a not in self.world.profiles.constants)
        return {
            "latent_description_length": description_length(plan),
            "latent_instruction_prior": own,
            "latent_parameter_prior": arguments,
            "latent_inconsistent_end": self._inconsistency(self.statistics.all_ends, list(used), end),
        }

    def least_more(self) -> float:
        """Return the least that end and latent factors can add to a candidate, negative only by weights."""
        if any(
            self.weights[name] < 0
            for name in ("latent_description_length", "latent_instruction_prior", "latent_parameter_prior")
        ):
            return -math.inf
        return min(0.0, self.weights["inconsistent_end"]) + min(0.0, self.weights["latent_inconsistent_end"])

    def weigh(self, values: Mapping[str, float]) -> Factors:
        """Return each factor multiplied by its weight."""
        return {name: self.weights[name] * value for name, value in values.items()}

    def total(self, values: Mapping[str, float]) -> float:
        """Return the weighed factors, summed."""
        return sum(self.weigh(values).values())

    def _prior(self, instructions: Sequence[Instruction]) -> tuple[float, float]:
        """Return Δ_inpr and Δ_para: the mean surprise of the instructions, and of the classes of their arguments."""
        if not instructions:
            return 0.0, 0.0
        found = [self._surprise(instruction) for instruction in instructions]
        count = len(found)
        return math.fsum(own for own, _ in found) / count, math.fsum(args for _, args in found) / count

    def _surprise_here(self, instruction: Instruction) -> tuple[float, float]:
        return self.statistics.surprise(instruction, [kind_of(argument, self.world) for argument in instruction.args])

    def _inconsistency(self, table: EndStates, names: Sequence[str], end: Bits) -> float:
        """Return Δ_cons: one minus the mean probability of the objects' states; 0 for no object."""
        objects = [(kind_of(name, self.world), self.world.profiles.of(name, end)) for name in names]
        probability = table.mean(objects)
        return 1 - probability if probability is not None else 0.0
