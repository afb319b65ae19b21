"""The driver of ``tmd experiment``: a whole experiment, from its configuration to the pages."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path

from tmd.diagnostics import MissingToolError, TmdError, install_extra
from tmd.evaluation.report.page import FOLDER, linked_pages, page_name
from tmd.evaluation.report.predictions import best_and_worst
from tmd.evaluation.report.report import write_report
from tmd.evaluation.runs.config import BUNDLED, ExperimentConfig
from tmd.evaluation.runs.experiment import Progress, collect, run
from tmd.evaluation.runs.finished_run import Run, Trials, read_run, read_trials
from tmd.evaluation.summary import EMPTY
from tmd.files import make_directory, write_text
from tmd.inference.ranking import Choice, PlanStep, RankedPlan
from tmd.language import parse
from tmd.pddl.plan_file import parse_instruction
from tmd.records.metrics import Metrics
from tmd.records.prediction import PredictionRecord
from tmd.records.trial import Trial
from tmd.robot_trials.trials import Mode, remove_file, run_trials
from tmd.view.page import render
from tmd.view.pictures import Strip, read_strip
from tmd.view.subject import PlannedStep, Ran, Said, Subject, grounded_subject
from tmd.world.corpus import Corpus
from tmd.world.folder import find_domain, find_root


def write_pages(config: ExperimentConfig, *, carried_out: bool = False) -> int:
    """Write the pages of a finished run on the bundled data, and return their number.

    Instructions of VEIL-500 are in a notation of its own, and its texts may not be passed on: it gets no pages. A
    prediction without a page (its environment is gone, say) is left out.

    Args:
        config: The run.
        carried_out: Write the pages of those predictions only that a robot carried out, and leave the others alone;
            otherwise all, and pages that the report no longer links are removed.

    Raises:
        OutputError: The run's directory cannot be written.
        TmdError: The directory does not hold a finished run.
    """
    if config.data != BUNDLED:
        return 0
    run, trials = read_run(config.out), read_trials(config.out)
    folder = find_domain(config.domain, config.domains)
    corpus = Corpus(folder, find_root("problems", config.problems) / config.domain)
    pages: dict[str, str] = {}
    for line in _tried(run, trials) if carried_out else _shown(run, trials):
        with suppress(TmdError):
            pages[page_name(line.model, line.id)] = render(_subject(line, corpus, run, trials)).html
    directory = make_directory(config.out / FOLDER)
    for name, html in pages.items():
        write_text(directory / name, html)
    if not carried_out:
        for name in sorted(linked_pages(config.out) - pages.keys()):
            remove_file(directory / name)
    return len(pages)


def _shown(run: Run, trials: Trials | None) -> Iterator[PredictionRecord]:
    """Yield the predictions that the report shows, and those that were carried out."""
    for model in run.metrics.models:
        if model != EMPTY:
            best, worst = best_and_worst(run.of(model))
            yield from (item.line for item in (*best, *worst))
    yield from _tried(run, trials)


def _tried(run: Run, trials: Trials | None) -> Iterator[PredictionRecord]:
    """Yield the predictions that were carried out."""
    found = trials.found if trials else ()
    yield from (line for line in run.lines if any(_is_of(trial, line) for trial in found))


def _subject(line: PredictionRecord, corpus: Corpus, run: Run, trials: Trials | None) -> Subject:
    world = corpus.world(line.environment)
    parsed = parse(line.text, corpus.lexicon)
    instructions = [parse_instruction(text) for text in line.predicted]
    title = f"{line.id}, predicted by {line.model}"
    made = _made(line, run)
    trial = next((t for t in (trials.found if trials else ()) if _is_of(t, line)), None)
    ran = None if trial is None else Ran(trial.status, trial.reason, trial.repairs, trial.seconds, trial.steps)
    strip = None if trial is None or trials is None else _strip(trials.directory, trial)
    plan = _ranked(line)
    if plan is not None and len(plan.choices) == len(parsed.clauses):
        return grounded_subject(title, world, parsed, [plan], made=made, ran=ran, strip=strip)
    steps = tuple(map(PlannedStep, instructions))  # the row does not work by clauses
    return Subject(title, world.task.problem, steps, Said(parsed), ran=ran, strip=strip, made=tuple(made))


def _ranked(line: PredictionRecord) -> RankedPlan | None:
    """Return the prediction by clauses; None if its steps are not those of the clauses."""
    if not line.whole:
        return None
    choices = []
    for number, clause in enumerate(line.clauses):
        texts = [(text, True) for text in clause.latent] + [(text, False) for text in clause.said]
        steps = tuple(PlanStep(parse_instruction(text), number, latent) for text, latent in texts)
        choices.append(Choice(clause.source, steps, clause.factors, {}))
    return RankedPlan(tuple(choices), 0)


def _made(line: PredictionRecord, run: Run) -> list[tuple[str, str]]:
    config = run.metrics.config
    told = [(name, str(config[name])) for name in ("version", "domain", "seed", "fingerprint") if name in config]
    own = ("model", "fold", "task", "environment", "id")
    return told + [(name, str(getattr(line, name))) for name in own]


def _is_of(trial: Trial, line: PredictionRecord) -> bool:
    asked = trial.asked
    return (asked.model, str(asked.id), asked.plan) == (line.model, str(line.id), line.predicted)


def _strip(directory: Path, trial: Trial) -> Strip | None:
    if trial.strip is None:
        return None
    path = directory / Path(trial.strip).name
    return read_strip(path.read_bytes(), len(trial.steps)) if path.is_file() else None


def run_experiment(
    config: ExperimentConfig, *, collect_only: bool = False, progress: Progress | None = None
) -> Metrics:
    """Train, predict and score, or what is left of it, and write the report.

    Args:
        config: The run.
        collect_only: Train nothing: recompute everything from finished parts.
        progress: Called with the number of parts done and of all parts.

    Returns:
        The contents of ``metrics.json``; ``report.html`` is beside it in ``config.out``.

    Raises:
        MissingToolError: matplotlib is not installed; nothing was done.
        TmdError: The configuration, the data, the directory or the cluster cannot be used, or parts are missing.
    """
    if find_spec("matplotlib") is None:
        hint = install_extra("report")
        raise MissingToolError("the charts of the report need the package matplotlib", hint=hint)
    metrics = collect(config) if collect_only else run(config, progress)
    write_pages(config)
    write_report(config.out)
    return metrics


def carry_out_predictions(config: ExperimentConfig, mode: Mode, *, progress: Progress | None = None) -> Trials:
    """Let a simulated PR2 carry out one prediction for each environment of a finished run, and add it to the report.

    Args:
        config: The run.
        mode: Motion of the robot, ``kinematic`` or ``physics``.
        progress: Called with the number of trials done and of all trials.

    Returns:
        The trials, or the reason why none could be made.

    Raises:
        OutputError: The run's directory cannot be written.
        WorkerLostError: A process that simulated was killed.
        TmdError: The directory does not hold a finished run.
    """
    trials = run_trials(config, mode, progress)
    write_pages(config, carried_out=True)
    write_report(config.out)
    return trials
