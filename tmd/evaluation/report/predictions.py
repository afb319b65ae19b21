"""The predictions of a model as a report shows them: the best and the worst, and errors by verb and by instruction."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from tmd.records.prediction import PredictedClause, PredictionRecord, SegmentRecord
from tmd.view.alignment import AlignedStep, Mark, align, name

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
    shares: list[list[tuple[Mark, str, str]]] = [[] for _ in clauses] or [[]]
    current = 0
    for step in align(predicted, recorded):
        if step.predicted is not None:
            current = owner[step.predicted]
        shares[current].append((step.mark, *_names(step, predicted, recorded)))
    if not clauses and not shares[0]:
        return
    verbs = [clause.verb for clause in clauses] or [NO_CLAUSE]
    for verb, share in zip(verbs, shares, strict=True):
        errors = found.setdefault(verb, VerbErrors(verb))
        errors.clauses += len(clauses) > 0
        errors.scores.append(_ied([mark for mark, _, _ in share]))
        for mark, gold, mine in share:
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


def _names(step: AlignedStep, predicted: Sequence[str], recorded: Sequence[str]) -> tuple[str, str]:
    """Return the names of the recorded and of the predicted instruction of a step of an alignment."""
    gold = NOTHING if step.gold is None else name(recorded[step.gold])
    return gold, NOTHING if step.predicted is None else name(predicted[step.predicted])


def _ied(marks: Sequence[Mark]) -> float:
    """Return the IED of the share of an alignment that belongs to one clause."""
    predicted, recorded = len(marks) - marks.count(Mark.MISSING), len(marks) - marks.count(Mark.SUPERFLUOUS)
    wrong = len(marks) - marks.count(Mark.MATCH)
    return 100.0 * (1 - min(1.0, wrong / max(predicted, recorded, 1)))


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
            found[_names(step, line.predicted, line.gold)] += 1
    return found


# How many of the best, and how many of the worst.
SHOWN = 10
# Each mark has a sign, so that nothing hangs on colour.
SYMBOLS = {Mark.MATCH: "✓", Mark.SUBSTITUTED: "≠", Mark.MISSING: "−", Mark.SUPERFLUOUS: "+"}


@dataclass(frozen=True, slots=True)
class ExampleStep:
    """Line of an alignment as it is shown.

    Attributes:
        mark: The kind of the step.
        symbol: Its sign.
        predicted: The predicted instruction, empty if one is missing.
        gold: The recorded instruction, empty if the predicted one is superfluous.
        clause: The number of the clause it was predicted for, from 1; ``None`` where it is not known.
        latent: Whether it was left unsaid.
    """

    mark: Mark
    symbol: str
    predicted: str
    gold: str
    clause: int | None
    latent: bool


@dataclass(frozen=True, slots=True)
class ShownPrediction:
    """Prediction as it is shown, aligned with the recorded instructions; ``longest`` is its largest weighed factor."""

    line: PredictionRecord
    steps: tuple[ExampleStep, ...]
    longest: float


def best_and_worst(
    lines: Sequence[PredictionRecord], count: int = SHOWN
) -> tuple[list[ShownPrediction], list[ShownPrediction]]:
    """Return the best by success, IED, END and EED, best first; and of the others the worst, worst first.

    What has no goal stands between what reached its goal and what did not.
    """
    order = sorted(lines, key=_rank)
    best, rest = order[:count], order[count:]
    return [shown(line) for line in best], [shown(line) for line in reversed(rest[-count:])]


def _rank(line: PredictionRecord) -> tuple[int, float, float, float, str, str]:
    success = {True: 0, None: 1, False: 2}[line.success]
    return success, -line.IED, -line.END, -line.EED, line.environment, str(line.id)


def shown(line: PredictionRecord) -> ShownPrediction:
    """Return a prediction as it is shown."""
    origins = [
        (number, latent)
        for number, clause in enumerate(line.clauses, 1)
        for steps, latent in ((clause.latent, True), (clause.said, False))
        for _ in steps
    ]
    whole = line.whole
    steps = []
    for step in align(line.predicted, line.gold):
        origin = origins[step.predicted] if whole and step.predicted is not None else (None, False)
        predicted = "" if step.predicted is None else line.predicted[step.predicted]
        gold = "" if step.gold is None else line.gold[step.gold]
        steps.append(ExampleStep(step.mark, SYMBOLS[step.mark], predicted, gold, *origin))
    longest = max((abs(value) for clause in line.clauses for value in clause.factors.values()), default=0.0)
    return ShownPrediction(line, tuple(steps), longest)
