"""A run: every model on every fold, into a directory that holds all that is needed to do it again.

A run that was stopped goes on where it was; what is finished is never done again. Same configuration, data and
version: the same bytes (but for log, date and run time), however the work was shared out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import replace

from tmd.diagnostics import TmdError
from tmd.evaluation.models.model import make_model
from tmd.evaluation.models.template_file import FILE as TEMPLATES
from tmd.evaluation.models.template_file import load_templates
from tmd.evaluation.report.report import write_report
from tmd.evaluation.runs.backends import outcomes
from tmd.evaluation.runs.config import DEFAULT_MODELS, ExperimentConfig
from tmd.evaluation.runs.dataset import open_dataset
from tmd.evaluation.runs.folds import Fold, folds_of
from tmd.evaluation.runs.jobs import units_of
from tmd.evaluation.runs.provenance import recorded
from tmd.evaluation.runs.run_directory import RunDirectory
from tmd.evaluation.summary import summarise
from tmd.records.metrics import FoldSizes, Metrics

Progress = Callable[[int, int], None]
"""Called with the number of parts done and of all parts."""


def run_experiment(
    config: ExperimentConfig, *, collect_only: bool = False, progress: Progress | None = None
) -> Metrics:
    """Train, predict and score, or what is left of it, and write the report.

    With ``collect_only`` nothing is trained: everything is recomputed from finished parts.

    Returns:
        The contents of ``metrics.json``; ``report.html`` is beside it in ``config.out``.

    Raises:
        TmdError: The configuration, the data, the directory or the cluster cannot be used, or parts are missing.
    """
    metrics = run(config, progress, collect_only=collect_only)
    write_report(config.out)
    return metrics


def run(config: ExperimentConfig, progress: Progress | None = None, *, collect_only: bool = False) -> Metrics:
    """Do the run as :func:`run_experiment`, without the report."""
    for model in config.models:
        make_model(model)
    data = open_dataset(config)
    # *Predefined Templates* only where somebody has written some for the domain
    written = (data.folder.path / TEMPLATES).is_file()
    usual = tuple(model for model in DEFAULT_MODELS if written or model != "templates")
    config = replace(config, models=config.models or usual)
    if "templates" in config.models:
        load_templates(data.folder)  # a fault in them is reported before anything is done
    directory, folds = RunDirectory(config.out, config.identity(data.fingerprint())), folds_of(config, data)
    with directory.entered():
        if not collect_only:
            _work(config, folds, directory, progress)
        return _collect(config, folds, directory)


def _work(config: ExperimentConfig, folds: Sequence[Fold], directory: RunDirectory, progress: Progress | None) -> None:
    """Do the units that are not done."""
    units, by_name = units_of(config.models, folds), {fold.name: fold for fold in folds}
    left = [unit for unit in (directory.left_of(unit, by_name) for unit in units) if unit is not None]
    parts = sum(len(unit.folds) for unit in units)
    done = parts - sum(len(unit.folds) for unit in left)
    directory.log.info("parts: %d, to do: %d", parts, parts - done)
    if progress:
        progress(done, parts)
    if left:
        with (
            recorded(config),
            closing(outcomes(config, left, directory.fits, directory.identity["fingerprint"])) as ended,
        ):
            for outcome in ended:
                directory.keep(outcome)
                done += len(outcome.parts)
                if progress:
                    progress(done, parts)


def _collect(config: ExperimentConfig, folds: Sequence[Fold], directory: RunDirectory) -> Metrics:
    found = [directory.part(model, fold) for model in config.models for fold in folds]
    missing = sum(lines is None for lines in found)
    if missing:
        raise TmdError(
            f"{config.out}: {missing} of {len(found)} parts are not done",
            hint="give the same command without --step to do them",
        )
    predictions = [line for lines in found for line in lines or ()]
    sizes = {f.name: FoldSizes(train=len(f.train), test=len(f.test), training_set=f.training_set) for f in folds}
    means = summarise([dict(prediction) for prediction in predictions], config.models)
    metrics = Metrics.model_validate({**means, "config": directory.identity, "folds": sizes})
    directory.finish(predictions, metrics)
    return metrics
