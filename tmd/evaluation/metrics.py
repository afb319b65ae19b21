"""IED, END and EED as the released VEIL-500 code computes them, for any PDDL domain, and success.

These three are per demonstration, from 0 to 100, higher is better; a result is the plain mean over
demonstrations.

* **IED** (instruction edit distance) compares the sequences as words.
* **END** (end state) compares what two sequences change between the first and the last state.
* **EED** (environment edit distance, equation 5 of RSS 2014) aligns the states after each instruction,
  looking only at objects that the recorded sequence names. An empty prediction scores about 35, so print that
  floor beside it. **EED-trim** first drops states that look like the one before, which takes most of the
  floor away.

Where a demonstration has a goal, a fourth comes first, which looks at no recorded sequence:

* **success**: whether the goal holds in the last state of the prediction, the one that END looks at.

Sequences are executed by force (:mod:`tmd.pddl.forced_execution`): preconditions are not read. Report
the share of executable predictions beside END.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, fields
from itertools import pairwise
from typing import TypeAlias

from rapidfuzz.distance import Levenshtein

from tmd.pddl.forced_execution import ForcedExecution
from tmd.pddl.model import Formula, GroundAtom, Instruction, Problem, universe
from tmd.pddl.semantics import holds
from tmd.pddl.task import Bits, Task

EPSILON = 0.001
"""Keeps the released code's quotients defined; it shows in the third digit, so it is kept."""

ROBOT = "robot"
"""Atoms with an argument of this type are about the robot: EED does not look at them, END does."""

Mentions: TypeAlias = Callable[[Instruction], Iterable[str]]
"""Which objects an instruction names."""


def arguments(instruction: Instruction) -> tuple[str, ...]:
    """Return all arguments: what an instruction names unless a data set says otherwise."""
    return instruction.args


@dataclass(frozen=True, slots=True)
class Scores:
    """The scores of one prediction, or means of them. ``executable`` is 100 or 0 for one prediction."""

    ied: float
    end: float
    eed: float
    eed_trim: float
    executable: float


def ied(predicted: Sequence[Instruction | str], recorded: Sequence[Instruction | str]) -> float:
    """Instruction edit distance: 100 (1 - Levenshtein / (longer length + epsilon)); both empty is 100.

    A token is a whole instruction; two are equal if all words are, whatever their case. How RSS 2014
    normalised is not printed there; this is the released code's way.
    """
    a, b = [_token(i) for i in predicted], [_token(i) for i in recorded]
    if not a and not b:
        return 100.0
    return 100 * (1 - levenshtein(a, b) / (max(len(a), len(b)) + EPSILON))


def _token(instruction: Instruction | str) -> tuple[str, ...]:
    words = instruction.split() if isinstance(instruction, str) else (instruction.name, *instruction.args)
    return tuple(word.lower() for word in words)


def levenshtein(a: Sequence[Hashable], b: Sequence[Hashable]) -> int:
    """Return the fewest insertions, deletions and substitutions that turn ``a`` into ``b``."""
    codes = {token: number for number, token in enumerate(dict.fromkeys((*a, *b)))}  # not their hashes, which may meet
    return Levenshtein.distance([codes[token] for token in a], [codes[token] for token in b])


def end(predicted: Bits, recorded: Bits) -> float:
    """Return the Jaccard index of two sets of changed atoms: both empty is 100, one empty is 0.

    The changes are those between the first and the last state. Seen from the same first state, an atom that changed can
    have only one new value, so the atom says all.
    """
    if not predicted and not recorded:
        return 100.0
    return 100 * (predicted & recorded).bit_count() / ((predicted | recorded).bit_count() + EPSILON)


def eed(predicted: Sequence[Hashable], recorded: Sequence[Hashable]) -> float:
    """Environment edit distance: the share of recorded states that meet an equal predicted one, in order.

    Both sequences begin with the first state and hold one more for each instruction, cut down to what
    :func:`visible` leaves. A predicted state may meet several recorded ones.
    """
    return 100 * (1 - _unmet(predicted, recorded) / len(recorded))


def eed_trim(predicted: Sequence[Hashable], recorded: Sequence[Hashable]) -> float:
    """EED of the changes only: the first state, and states equal to the one kept before, are dropped first.

    It is 100 where the recorded sequence changes nothing that is looked at.
    """
    gold = _trimmed(recorded)
    return 100 * (1 - _unmet(_trimmed(predicted), gold) / len(gold)) if gold else 100.0


def _trimmed(states: Sequence[Hashable]) -> list[Hashable]:
    return [after for before, after in pairwise(states) if after != before]


def _unmet(predicted: Sequence[Hashable], recorded: Sequence[Hashable]) -> int:
    """Return the recursion T of equation 5, from the back: how many recorded states meet no equal predicted one."""
    n = len(predicted)
    below = [0] * (n + 1)
    for i in range(len(recorded) - 1, -1, -1):
        state = recorded[i]
        row = [0] * n + [len(recorded) - i]
        for j in range(n - 1, -1, -1):
            row[j] = min((state != predicted[j]) + below[j], row[j + 1])
        below = row
    return below[0]


def cover_of(
    recorded: Iterable[Instruction], problem: Problem, mentions: Mentions = arguments
) -> frozenset[str] | None:
    """Return the objects that a sequence names, constants of the domain (relation words, say) left out.

    ``None`` means that it names one that does not exist: then no two states count as equal.
    """
    constants = {constant.name for constant in problem.domain.constants}
    named = {name for instruction in recorded for name in mentions(instruction)} - constants
    return frozenset(named) if named <= {o.name for o in problem.objects} else None


def visible(task: Task, problem: Problem, cover: AbstractSet[str]) -> Bits:
    """Return the atoms that EED looks at: about objects of the cover only, and not about the robot."""
    known = universe(problem)
    constants = {constant.name for constant in problem.domain.constants}

    def looked_at(atom: GroundAtom) -> bool:
        about = set(atom.args) - constants
        return bool(about) and about <= cover and not any(known.is_a(arg, (ROBOT,)) for arg in atom.args)

    return task.where(looked_at)


class Scorer:
    """All metrics in one environment; many predictions for the same recorded sequences are quick.

    ``mentions`` tells which objects an instruction names, for EED's cover; ``absent`` are the types of things that do
    not exist and still choose a rule by their name (VEIL-500 has some).
    """

    def __init__(
        self, problem: Problem, mentions: Mentions = arguments, absent: Mapping[str, str] | None = None
    ) -> None:
        self.problem = problem
        self.mentions = mentions
        self.simulator = ForcedExecution(problem, absent=absent)
        self._task: Task | None = None
        self._covers: dict[tuple[Instruction, ...], Bits | None] = {}

    def prepare(self, sequences: Iterable[Iterable[Instruction]]) -> None:
        """Ground what these sequences need at once; without it each new instruction costs a grounding."""
        self.simulator.prepare({instruction for sequence in sequences for instruction in sequence})

    def score(self, predicted: Sequence[Instruction], recorded: Sequence[Instruction]) -> Scores:
        """Return the scores of one prediction."""
        self.prepare((predicted, recorded))
        p, r = self.simulator.run(predicted), self.simulator.run(recorded)
        mine, gold = self.changed(predicted), self.changed(recorded)
        seen = self._visible(r.task, recorded)
        if seen is None:
            lost = len(recorded) > 0
            similar = (0.0, 0.0) if lost else (100.0, 100.0)
        else:
            a, b = [s & seen for s in p.states], [s & seen for s in r.states]
            similar = eed(a, b), eed_trim(a, b)
        return Scores(ied(predicted, recorded), end(mine, gold), *similar, executable=100.0 * p.executable)

    def changed(self, sequence: Sequence[Instruction]) -> Bits:
        """Return the atoms that a sequence changes, which END compares, as bits of the current task.

        A sequence with an instruction that was not prepared makes another task, with other bits.
        """
        states = self.simulator.run(sequence).states
        return states[0] ^ states[-1]

    def reaches(self, predicted: Sequence[Instruction], goal: Formula) -> bool:
        """Return whether ``goal`` holds in the state that END looks at, the last one of forced execution."""
        done = self.simulator.run(predicted)
        return holds(goal, done.task.decode(done.states[-1]), self.problem)

    def _visible(self, task: Task, recorded: Sequence[Instruction]) -> Bits | None:
        if task is not self._task:
            self._task = task
            self._covers.clear()
        key = tuple(recorded)
        if key not in self._covers:
            cover = cover_of(recorded, self.problem, self.mentions)
            self._covers[key] = None if cover is None else visible(task, self.problem, cover)
        return self._covers[key]


def mean(scores: Sequence[Scores]) -> Scores:
    """Return the plain mean of each score; zeros for none."""
    count = max(len(scores), 1)
    return Scores(*(sum(getattr(s, field.name) for s in scores) / count for field in fields(Scores)))
