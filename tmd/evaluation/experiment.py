"""A run: every model on every fold, into a directory that holds all that is needed to do it again.

``config.json`` what was asked for, ``parts/`` one file for each model and fold as soon as it is done,
``predictions.jsonl`` and ``metrics.json`` what came out, ``report.html`` the page, ``log.txt`` what happened.
A run that was stopped goes on where it was; what is finished is never done again. Same configuration, data and
version: the same bytes (but for the log).
"""

from __future__ import annotations

import json
import logging
import subprocess
import zlib
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from tmd import __version__
from tmd.atomic import write_text
from tmd.errors import OutputError, TmdError
from tmd.evaluation.dataset import BundledData, Dataset, Example, VeilDataset
from tmd.evaluation.folds import Fold, given_fold, halves, pairs
from tmd.evaluation.models import make_model
from tmd.evaluation.prediction import Prediction
from tmd.evaluation.summary import summarise
from tmd.pddl.model import Instruction

BUNDLED = "bundled"
VEIL500 = "veil500"
DEFAULT_MODELS = ("empty", "chance", "nearest", "hand_set")
_DIGITS = 6
"""Scores are rounded for the files, so that the last bit of a float shows nowhere."""


@dataclass(frozen=True, slots=True)
class ExperimentConfig:
    """What a run is to do.

    Attributes:
        task: A task of the data, or ``all``.
        out: The run's directory.
        data: ``bundled`` or ``veil500``.
        veil500: Where VEIL-500 is.
        train_environments: Environment numbers to train in; ``None`` leaves it to the folds.
        test_environments: Environment numbers to test in; likewise.
        models: The rows.
        jobs: How many processes.
        seed: Of everything random.
        domain: The domain of the bundled data.
        domains: The directory of all domains, if not the usual one.
        problems: The directory of all problems, if not the usual one.
    """

    task: str
    out: Path
    data: str = BUNDLED
    veil500: Path | None = None
    train_environments: tuple[int, ...] | None = None
    test_environments: tuple[int, ...] | None = None
    models: tuple[str, ...] = DEFAULT_MODELS
    jobs: int = 1
    seed: int = 0
    domain: str = "kitchen"
    domains: Path | None = None
    problems: Path | None = None

    def identity(self, fingerprint: str) -> dict[str, Any]:
        """What decides the outcome: everything but the place and the number of processes."""
        said = {k: list(v) if isinstance(v, tuple) else v for k, v in asdict(self).items()}
        for name in ("out", "jobs", "veil500", "domains", "problems"):
            del said[name]
        return said | {"fingerprint": fingerprint, "version": __version__}


@dataclass(frozen=True, slots=True)
class _Part:
    """One model on one fold."""

    model: str
    fold: int
    file: Path


Progress = Callable[[int, int], None]
"""Called with the number of parts done and of all parts."""


def run(config: ExperimentConfig, progress: Progress | None = None) -> dict[str, Any]:
    """Do the run, or what is left of it, and return its metrics.

    Raises:
        TmdError: The configuration, the data or the directory cannot be used.
    """
    for model in config.models:
        make_model(model)
    data = _data(config)
    folds = _folds(config, data)
    log = _open(config, data)
    parts = [
        _Part(model, number, config.out / "parts" / f"{model}-{fold.name}.jsonl")
        for model in config.models
        for number, fold in enumerate(folds)
    ]
    waiting = [part for part in parts if not part.file.is_file()]
    log.info("parts: %d, to do: %d", len(parts), len(waiting))
    done = len(parts) - len(waiting)
    if progress:
        progress(done, len(parts))
    for part in _in_parallel(config, waiting):
        done += 1
        log.info("done: %s fold %s", part.model, folds[part.fold].name)
        if progress:
            progress(done, len(parts))
    predictions = [line for part in parts for line in _read_part(part)]
    metrics = summarise(predictions, config.models) | {
        "config": config.identity(data.fingerprint()),
        "folds": {f.name: {"train": len(f.train), "test": len(f.test)} for f in folds},
    }
    _write_jsonl(config.out / "predictions.jsonl", predictions)
    write_text(config.out / "metrics.json", json.dumps(metrics, indent=2) + "\n")
    log.info("finished")
    return metrics


def _open(config: ExperimentConfig, data: Dataset) -> logging.Logger:
    """Make or enter the run's directory; refuse one that holds another run."""
    said = config.identity(data.fingerprint())
    path = config.out / "config.json"
    try:
        (config.out / "parts").mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{config.out}: cannot be made: {error.strerror}") from None
    text = json.dumps(said, indent=2) + "\n"
    if path.is_file() and path.read_text(encoding="utf-8") != text:
        raise OutputError(f"{config.out} holds another run", hint="give another --out, or remove that directory")
    write_text(path, text)
    log = logging.getLogger(f"tmd.experiment.{config.out}")
    log.setLevel(logging.INFO)
    log.propagate = False
    for handler in list(log.handlers):
        log.removeHandler(handler)
        handler.close()
    handler = logging.FileHandler(config.out / "log.txt", encoding="utf-8")
    handler.setFormatter(logging.Formatter("%(asctime)s %(message)s"))
    log.addHandler(handler)
    log.info("revision: %s", _revision())
    return log


def _revision() -> str:
    """The revision of the checkout, if this is one."""
    here = Path(__file__).resolve().parent
    try:
        found = subprocess.run(
            ["git", "describe", "--always", "--dirty"], cwd=here, capture_output=True, text=True, timeout=10
        )
    except (OSError, subprocess.TimeoutExpired):
        return "unknown"
    return found.stdout.strip() or "unknown"


@lru_cache(maxsize=2)
def _data(config: ExperimentConfig) -> Dataset:
    """The data, read once in each process."""
    if config.data == VEIL500:
        if config.veil500 is None:
            raise TmdError("VEIL-500 is not part of tmd", hint="say where it is: --veil500 DIR or VEIL500_DIR")
        return VeilDataset(config.veil500, config.task)
    return BundledData(config.task, config.domain, config.domains, config.problems)


def _folds(config: ExperimentConfig, data: Dataset) -> list[Fold]:
    if config.train_environments is not None or config.test_environments is not None:
        return given_fold(data.examples, config.train_environments, config.test_environments)
    return pairs(data.examples) if config.data == VEIL500 else halves(data.examples)


def _in_parallel(config: ExperimentConfig, parts: Sequence[_Part]) -> Iterable[_Part]:
    """Do the parts, in as many processes as were asked for; each is yielded when its file is there."""
    from joblib import Parallel, delayed

    if config.jobs == 1:
        for part in parts:
            yield _do(config, part)
        return
    workers = Parallel(n_jobs=config.jobs, return_as="generator_unordered")
    yield from workers(delayed(_do)(config, part) for part in parts)


def _do(config: ExperimentConfig, part: _Part) -> _Part:
    """Train, predict, score, write."""
    data = _data(config)
    fold = _folds(config, data)[part.fold]
    random = np.random.default_rng([config.seed, part.fold, zlib.crc32(part.model.encode())])
    model = make_model(part.model).fit(fold.train, data, random)
    predictions = [(example, model.predict(example, data, random)) for example in fold.test]
    for environment in sorted({example.environment for example in fold.test}):
        own = [p.instructions for e, p in predictions if e.environment == environment]
        data.scorer(environment).prepare(own)
    lines = [_line(data, example, prediction, part.model, fold.name) for example, prediction in predictions]
    _write_jsonl(part.file, lines)
    return part


def _line(data: Dataset, example: Example, prediction: Prediction, model: str, fold: str) -> dict[str, Any]:
    """What is kept of one prediction: a line of ``predictions.jsonl``."""

    def written(instructions: Iterable[Instruction]) -> list[str]:
        return data.written(example.environment, instructions)

    scores = data.scorer(example.environment).score(prediction.instructions, example.gold)
    said = example.demonstration.text
    return {
        "id": example.id,
        "task": example.task,
        "environment": example.environment,
        "model": model,
        "fold": fold,
        "text": said,
        "predicted": written(prediction.instructions),
        "gold": written(example.gold),
        "executable": scores.executable == 100.0,
        "IED": round(scores.ied, _DIGITS),
        "END": round(scores.end, _DIGITS),
        "EED": round(scores.eed, _DIGITS),
        "EED_trim": round(scores.eed_trim, _DIGITS),
        "clauses": [
            {
                "text": served.text,
                "verb": served.verb,
                "latent": written(served.latent),
                "said": written(served.said),
                "source": served.source,
                "factors": {name: round(value, _DIGITS) for name, value in served.factors.items()},
            }
            for served in prediction.served
        ],
        "segments": [
            {"text": said[segment.start : segment.end], "instructions": written(segment.instructions)}
            for segment in example.demonstration.segments
        ],
    }


def _write_jsonl(path: Path, lines: Iterable[dict[str, Any]]) -> None:
    write_text(path, "".join(json.dumps(line, ensure_ascii=False) + "\n" for line in lines))


def _read_part(part: _Part) -> list[dict[str, Any]]:
    try:
        return [json.loads(line) for line in part.file.read_text(encoding="utf-8").splitlines()]
    except (OSError, ValueError):
        raise OutputError(f"{part.file}: damaged", hint="remove it and run again") from None
