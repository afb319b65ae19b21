"""The unit of work: one model trained on one training set, and tested on all folds that share it.

Random numbers are drawn for (seed, model, training set) when a model is fitted and for (seed, model, example) when it
predicts, so the outcome does not depend on which process does what, nor on what else it does.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from tmd.diagnostics import ExitCode, TmdError
from tmd.evaluation.models.model import Model, make_model
from tmd.evaluation.models.paper_models import Crf
from tmd.evaluation.models.prediction import Prediction
from tmd.evaluation.runs.config import ExperimentConfig
from tmd.evaluation.runs.dataset import Dataset, Example, open_dataset
from tmd.evaluation.runs.folds import Fold, folds_of
from tmd.files import make_directory, try_lock, write_text
from tmd.json_record import DIGITS
from tmd.language.clause import Span
from tmd.language.syntax.tokens import Kind, tokenise
from tmd.pddl.model import Instruction
from tmd.records.fit import CurvePoint, Fit, WorldFit
from tmd.records.prediction import PredictedClause, PredictionRecord, SegmentRecord
from tmd.world.demonstration import Segment

_ENDS = frozenset(".!?…")
_CLOSING = frozenset("\"')]\u201d\u2019\u00bb")
_KEY = zlib.crc32(b"drop-sentences")


def sentences(text: str) -> tuple[Span, ...]:
    """Return the spans of the sentences of a text; together they are the whole text.

    A sentence ends with a full stop, a question or an exclamation mark, as the clause parser sees them ("2.5" has
    none), or with the line; marks and quotes that close it, and blanks, belong to it. A piece without a word is
    part of the sentence before it.
    """
    tokens = tokenise(text)
    ends = {token.span.end for token in tokens if token.kind is Kind.STOP and _ENDS & set(token.text)}
    ends |= {i + 1 for i, sign in enumerate(text) if sign == "\n"}
    words = [token.span.start for token in tokens if token.kind in (Kind.WORD, Kind.NUM)]
    found: list[Span] = []
    for end in sorted(ends | {len(text)}):
        start = found[-1].end if found else 0
        while end < len(text) and (text[end] in _CLOSING or text[end].isspace()):
            end += 1
        if end <= start:
            continue
        if found and not any(start <= word < end for word in words):
            found[-1] = Span(found[-1].start, end)
        else:
            found.append(Span(start, end))
    return tuple(found)


def leave_out(example: Example, probability: float, seed: int) -> Example:
    """Return the example with each sentence of its text left out with some probability, but never all of them.

    What is drawn depends on the seed and the example's id only, so all models read the same text; a sentence that is
    left out at one probability is left out at every higher one. Of the sentences, the one with the largest draw stays.
    Segments keep their instructions, and point to what is left of their words. ``probability`` is in [0, 1), ``seed``
    that of the run.
    """
    text = example.demonstration.text
    spans = sentences(text)
    if probability == 0 or len(spans) < 2:
        return example
    draws = np.random.default_rng([seed, _KEY, zlib.crc32(str(example.id).encode())]).random(len(spans))
    most = int(np.argmax(draws))
    kept = [span for i, span in enumerate(spans) if draws[i] >= probability or i == most]
    if len(kept) == len(spans):
        return example
    left = "".join(text[span.start : span.end] for span in kept).rstrip()

    def moved(place: int) -> int:
        before = sum(min(span.end, max(place, span.start)) - span.start for span in kept)
        return min(before, len(left))

    segments = tuple(Segment(moved(s.start), moved(s.end), s.instructions) for s in example.demonstration.segments)
    return replace(example, demonstration=replace(example.demonstration, text=left, segments=segments))


GO_ON = "what is done is kept: the same command goes on from there"
"""The hint where a run ends early."""
_PREDICT = zlib.crc32(b"predict")


class WorkerLostError(TmdError):
    """A process that did a unit is gone, mostly because memory ran out."""

    exit_code = ExitCode.GAVE_UP


@dataclass(frozen=True, slots=True)
class EvaluationJob:
    """One unit of work. ``saved`` is what was learned when it was done before, if it was."""

    model: str
    training_set: str
    folds: tuple[str, ...]
    saved: Mapping[str, WorldFit] | None = None

    @property
    def name(self) -> str:
        """Unique in a run."""
        return f"{self.model}-{self.training_set}"


@dataclass(frozen=True, slots=True)
class JobOutcome:
    """The outcome of a unit.

    Attributes:
        parts: For each fold the text of its file: a line for each prediction.
        fit: The text of the file on what was learned; ``None`` for a model that learns no weights.
    """

    unit: EvaluationJob
    parts: dict[str, str]
    fit: str | None


def units_of(models: Sequence[str], folds: Sequence[Fold]) -> list[EvaluationJob]:
    """Return all units of a run, always in the same order."""
    sets: dict[str, list[str]] = {}
    for fold in folds:
        sets.setdefault(fold.training_set, []).append(fold.name)
    return [
        EvaluationJob(model, training_set, tuple(names)) for model in models for training_set, names in sets.items()
    ]


def do(config: ExperimentConfig, unit: EvaluationJob, fits: Path | None) -> JobOutcome:
    """Train, predict, score.

    What is learned is written into ``fits`` as soon as it is; ``None`` where there is no such directory at hand.
    """
    data = open_dataset(config)
    folds = {fold.name: fold for fold in folds_of(config, data)}
    model, fit = _fitted(config, unit, folds[unit.folds[0]], data, fits)
    return JobOutcome(unit, {name: _tested(config, unit, model, folds[name], data) for name in unit.folds}, fit)


def _fitted(
    config: ExperimentConfig, unit: EvaluationJob, fold: Fold, data: Dataset, fits: Path | None
) -> tuple[Model, str | None]:
    """Return the model, learned or restored, and the text of its file in ``fits/``."""
    model = make_model(unit.model)
    if unit.saved is not None and isinstance(model, Crf):
        return model.restore(fold.train, data, unit.saved), None
    random = np.random.default_rng([config.seed, _key(unit.model), _key(unit.training_set)])
    with _journal(model, unit, fits):
        model = model.fit(fold.train, data, random)
    text = fit_text(unit.model, fold, model)
    if text is not None and fits is not None:
        write_text(make_directory(fits) / f"{unit.name}.json", text)
    return model, text


@contextmanager
def _journal(model: Model, unit: EvaluationJob, fits: Path | None) -> Iterator[None]:
    """Give the model its journal, unless another process works on the same unit and has it."""
    if fits is None or not isinstance(model, Crf):
        yield
        return
    path = make_directory(fits) / f"{unit.name}.journal.jsonl"
    lock = try_lock(path.with_suffix(".lock"))
    model.journal = path if lock is not None else None
    try:
        yield
    finally:
        if lock is not None:
            lock.release()


def journal_files(fits: Path, unit: EvaluationJob) -> tuple[Path, ...]:
    """Return the files that a finished unit no longer needs."""
    journal = fits / f"{unit.name}.journal.jsonl"
    return journal, journal.with_suffix(".lock")


def fit_text(model_name: str, fold: Fold, model: Model) -> str | None:
    """Return the learned weights of a model as JSON; ``None`` for a model that learned none."""
    if not isinstance(model, Crf) or not model.learned_:
        return None
    worlds = {
        world: WorldFit(
            weights={name: learned.weights[name] for name in learned.weights},
            curve=tuple(map(CurvePoint.model_validate, learned.curve)),
        )
        for world, learned in sorted(model.learned_.items())
    }
    places = sorted({(e.world, e.number, e.environment) for e in fold.train})
    said = Fit(model=model_name, trained_in=tuple(name for _, _, name in places), worlds=worlds)
    return json.dumps(said.to_value(), ensure_ascii=False, indent=2) + "\n"


def _tested(config: ExperimentConfig, unit: EvaluationJob, model: Model, fold: Fold, data: Dataset) -> str:
    """Return the lines on one fold."""
    done = []
    for example in fold.test:
        read = leave_out(example, config.drop_sentences, config.seed)
        random = np.random.default_rng([config.seed, _PREDICT, _key(unit.model), _key(str(example.id))])
        done.append((example, read.demonstration.text, model.predict(read, data, random)))
    for environment in sorted({example.environment for example in fold.test}):
        own = [prediction.instructions for example, _, prediction in done if example.environment == environment]
        data.scorer(environment).prepare(own)
    return "".join(
        _record(data, example, read, prediction, unit.model, fold.name).to_line() for example, read, prediction in done
    )


def _key(name: str) -> int:
    """Return a number for a name, the same on every machine."""
    return zlib.crc32(name.encode())


def _record(
    data: Dataset, example: Example, read: str, prediction: Prediction, model: str, fold: str
) -> PredictionRecord:
    """Return the record of one prediction; ``read`` is the text that the model read."""

    def written(instructions: Iterable[Instruction]) -> tuple[str, ...]:
        return tuple(data.written(example.environment, instructions))

    scorer = data.scorer(example.environment)
    scores = scorer.score(prediction.instructions, example.gold)
    whole = example.demonstration.text
    return PredictionRecord(
        id=example.id,
        task=example.task,
        environment=example.environment,
        model=model,
        fold=fold,
        text=read,
        predicted=written(prediction.instructions),
        gold=written(example.gold),
        executable=scores.executable == 100.0,
        success=None if example.goal is None else scorer.reaches(prediction.instructions, example.goal),
        IED=round(scores.ied, DIGITS),
        END=round(scores.end, DIGITS),
        EED=round(scores.eed, DIGITS),
        EED_trim=round(scores.eed_trim, DIGITS),
        clauses=tuple(
            PredictedClause.copied(
                served,
                latent=written(served.latent),
                said=written(served.said),
                factors={name: round(value, DIGITS) for name, value in served.factors.items()},
            )
            for served in prediction.served
        ),
        segments=tuple(
            SegmentRecord(text=whole[s.start : s.end], instructions=written(s.instructions))
            for s in example.demonstration.segments
        ),
    )
