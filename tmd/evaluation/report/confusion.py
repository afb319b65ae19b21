"""Errors of predictions by the verb of the clause, and by instruction."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from tmd.records.prediction import PredictedClause, PredictionRecord, SegmentRecord
from tmd.view.alignment import Mark, align, name

# Stands for the verb where people did something for words in which no clause was found.
NO_CLAUSE = "(no clause)"
# Stands for the instruction that is not there, on either side.
NOTHING = "(nothing)"


@dataclass(slots=True)
class VerbErrors:
    """Errors in the clauses of one verb.

    Attributes:
        verb: The verb.
        clauses: How many clauses have it.
        scores: The IED of each clause, 0 to 100; clauses for which nothing was done and nothing predicted count 100.
        matched: Steps that are as the person's.
        missed: Names of recorded instructions that were not predicted, with how often.
        superfluous: Names of predicted instructions without a counterpart, with their counts.
        arguments: Names of instructions that were predicted with other arguments, with how often.
        substituted: Recorded and predicted name of aligned steps that differ, with their counts.
    """

    verb: str
    clauses: int = 0
    scores: list[float] = field(default_factory=list)
    matched: int = 0
    missed: Counter[str] = field(default_factory=Counter)
    superfluous: Counter[str] = field(default_factory=Counter)
    arguments: Counter[str] = field(default_factory=Counter)
    substituted: Counter[tuple[str, str]] = field(default_factory=Counter)

    @property
    def ied(self) -> float:
        """The mean IED of the clauses."""
        return sum(self.scores) / len(self.scores) if self.scores else 0.0

    @property
    def recorded(self) -> int:
        """Number of steps that the person did for them."""
        return self.matched + self.missed.total() + self.arguments.total() + self.substituted.total()


@dataclass(slots=True)
class _Share:
    """Share of an alignment that belongs to one clause."""

    steps: list[tuple[Mark, str, str]] = field(default_factory=list)

    def ied(self) -> float:
        predicted = sum(mark is not Mark.MISSING for mark, _, _ in self.steps)
        recorded = sum(mark is not Mark.SUPERFLUOUS for mark, _, _ in self.steps)
        wrong = sum(mark is not Mark.MATCH for mark, _, _ in self.steps)
        return 100.0 * (1 - min(1.0, wrong / max(predicted, recorded, 1)))


def by_verb(lines: Iterable[PredictionRecord]) -> list[VerbErrors]:
    """Return the verbs, most frequent first.

    A clause belongs to the segment of the text that it shares most characters with. What was predicted for the
    clauses of a segment, one after the other, is aligned with what the person did for the segment. A predicted step
    counts for the clause it was predicted for, a missed one for the clause of the step before it in the alignment
    (the first clause at the beginning). So each step counts once. Nothing is found where no prediction
    tells of any clause.
    """
    found: dict[str, VerbErrors] = {}
    told = list(lines)
    if not any(line.clauses for line in told):
        return []
    for line in told:
        homes = belonging(line.text, line.clauses, line.segments)
        for number, segment in enumerate(line.segments):
            own = [clause for clause, home in zip(line.clauses, homes, strict=True) if home == number]
            _count(found, own, segment.instructions)
        for clause, home in zip(line.clauses, homes, strict=True):
            if home is None:
                _count(found, [clause], [])
    return sorted(found.values(), key=lambda v: (-v.clauses, v.verb))


def _count(found: dict[str, VerbErrors], clauses: Sequence[PredictedClause], recorded: Sequence[str]) -> None:
    """Add what became of the clauses of one segment."""
    predicted = [step for clause in clauses for step in clause.steps]
    owner = [n for n, clause in enumerate(clauses) for _ in clause.steps]
    shares = [_Share() for _ in clauses] or [_Share()]
    current = 0
    for step in align(predicted, recorded):
        if step.predicted is not None:
            current = owner[step.predicted]
        mine = NOTHING if step.predicted is None else name(predicted[step.predicted])
        gold = NOTHING if step.gold is None else name(recorded[step.gold])
        shares[current].steps.append((step.mark, gold, mine))
    if not clauses and not shares[0].steps:
        return
    verbs = [clause.verb for clause in clauses] or [NO_CLAUSE]
    for verb, share in zip(verbs, shares, strict=True):
        errors = found.setdefault(verb, VerbErrors(verb))
        errors.clauses += len(clauses) > 0
        errors.scores.append(share.ied())
        for mark, gold, mine in share.steps:
            if mark is Mark.MATCH:
                errors.matched += 1
            elif mark is Mark.MISSING:
                errors.missed[gold] += 1
            elif mark is Mark.SUPERFLUOUS:
                errors.superfluous[mine] += 1
            elif gold == mine:
                errors.arguments[gold] += 1
            else:
                errors.substituted[gold, mine] += 1


def belonging(text: str, clauses: Sequence[PredictedClause], segments: Sequence[SegmentRecord]) -> list[int | None]:
    """Return for each clause the number of the segment that shares most characters with it; ``None`` for no overlap.

    Both are found by their words, one after the other, since both are in the order of the text.
    """
    places = _places(text, [segment.text for segment in segments], overlap=False)
    found: list[int | None] = []
    for own in _places(text, [clause.text for clause in clauses], overlap=True):
        shared = [len(range(max(own.start, p.start), min(own.stop, p.stop))) for p in places]
        found.append(shared.index(max(shared)) if any(shared) else None)
    return found


def _places(text: str, pieces: Sequence[str], *, overlap: bool) -> list[range]:
    """Return the range of each piece in the text; an empty one where it is not found, or is empty."""
    found = []
    start = 0
    for piece in pieces:
        at = text.find(piece, start) if piece else -1
        if at < 0:
            found.append(range(0))
            continue
        found.append(range(at, at + len(piece)))
        start = at if overlap else at + len(piece)
    return found


def by_instruction(lines: Iterable[PredictionRecord]) -> Counter[tuple[str, str]]:
    """Count the pairs of recorded and predicted instructions that are aligned, by name.

    The whole sequences are aligned, as IED does. A substitution by the same instruction with other arguments has
    the same name twice, as a match has; :data:`NOTHING` stands where one is missing or superfluous.
    """
    found: Counter[tuple[str, str]] = Counter()
    for line in lines:
        for step in align(line.predicted, line.gold):
            gold = NOTHING if step.gold is None else name(line.gold[step.gold])
            mine = NOTHING if step.predicted is None else name(line.predicted[step.predicted])
            found[gold, mine] += 1
    return found
