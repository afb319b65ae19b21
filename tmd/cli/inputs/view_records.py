"""Groundings, runs and demonstrations as what ``tmd view`` shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tmd import __version__
from tmd.cli.inputs.view import STANDARD, FoundSubject, ViewRequest
from tmd.diagnostics import TmdError
from tmd.grounded import why_refused
from tmd.language import parse
from tmd.pddl.reading.syntax import nearest
from tmd.records.grounding import GroundingRecord
from tmd.records.run import RunRecord, RunRequest, read_log
from tmd.veil.corpus import Corpus
from tmd.veil.demonstration import Demonstration, read_demonstration
from tmd.veil.roots import Roots
from tmd.veil.world import World
from tmd.view.demonstrated import demonstrated_subject
from tmd.view.pictures import Strip, read_strip
from tmd.view.run_record import Ran, ran, ran_events
from tmd.view.subject import PlannedStep, Said, Subject, grounded_subject, title_of

Lines = Sequence[tuple[int, str]]
"""The lines of a file that are not blank, with their numbers."""


def made_rows(values: Mapping[str, object]) -> tuple[tuple[str, str], ...]:
    """What decides the outcome, as names and values; what was left open is left out."""
    return tuple((name.replace("_", " "), str(value)) for name, value in values.items() if value is not None)


def grounding_found(roots: Roots, asked: ViewRequest, value: Mapping[str, Any]) -> FoundSubject:
    """What ``tmd ground --json`` printed.

    Raises:
        TmdError: It is damaged, or its environment is not there.
    """
    record = GroundingRecord.from_value(value, asked.name)
    corpus, world = _scene(roots, asked, record.domain, record.environment, record.environment_file)
    rows = made_rows({**dict(record.made_with), "domain": corpus.folder.name, "environment": world.name})
    return FoundSubject(_grounding_subject(record, world, rows), _beside(asked), of_text=True)


def _grounding_subject(
    record: GroundingRecord,
    world: World,
    rows: Sequence[tuple[str, str]],
    done: Ran | None = None,
    strip: Strip | None = None,
) -> Subject:
    refused = record.refused
    return grounded_subject(
        title_of(record.text, world.name),
        world,
        record.parsed(record.text),
        record.ranked(),
        record.refused_templates(),
        unseen=record.unseen_verbs,
        unknown=record.unknown_nouns,
        made=rows,
        ran=done,
        strip=strip,
        refused="" if refused is None else why_refused(refused.clause, refused.message, refused.hint),
    )


def run_found(roots: Roots, asked: ViewRequest, first: Mapping[str, Any], lines: Lines) -> FoundSubject:
    """What ``tmd run --json`` printed, or a log of ``tmd run``.

    Raises:
        TmdError: It is damaged, or its environment or filmstrip is not there.
    """
    told: RunRequest
    if "event" in first:
        told, events = read_log(lines, asked.name)
        done = ran_events(events)
    else:
        told = record = RunRecord.from_value(first, asked.name)
        done = ran(record)
    corpus, world = _scene(roots, asked, told.domain, told.environment, told.environment_file)
    strip = _strip(asked, told.strip, len(done.steps))
    names = ("version", "planner", "mode", "seed", "fault")
    made = {name: getattr(told, name) for name in names} | {"domain": corpus.folder.name, "environment": world.name}
    if told.grounding is not None:
        rows = made_rows({**dict(told.grounding.made_with), **made})
        subject = _grounding_subject(told.grounding, world, rows, done, strip)
    else:
        subject = _run_subject(told, corpus, world, made_rows(made), done, strip)
    return FoundSubject(subject, _beside(asked), of_text=subject.said is not None)


def _run_subject(
    told: RunRequest, corpus: Corpus, world: World, rows: tuple[tuple[str, str], ...], done: Ran, strip: Strip | None
) -> Subject:
    """A run of a plan file."""
    said = None if told.text is None else Said(parse(told.text, corpus.lexicon))
    what = "A plan that the robot carried out" if told.text is None else told.text
    steps = tuple(PlannedStep(order.instruction) for order in told.plan)
    title = title_of(what, world.name)
    return Subject(title, world.task.problem, steps, said, ran=done, strip=strip, made=rows)


def _strip(asked: ViewRequest, recorded: str | None, count: int) -> Strip | None:
    """The filmstrip of a run: the one that was named, else what lies beside the log."""
    if asked.strip is not None:
        found = _picture(asked.strip, count)
        if found is None:
            raise TmdError(f"{asked.strip} is not a PNG picture", hint="give what tmd run --strip wrote")
        return found
    if asked.source == STANDARD:
        return None
    names = [Path(recorded).name] if recorded else []
    paths = [asked.path.with_name(name) for name in names] + [asked.path.with_suffix(".png")]
    path = next((path for path in paths if path.is_file()), None)
    return None if path is None else _picture(path, count)


def _picture(path: Path, count: int) -> Strip | None:
    try:
        return read_strip(path.read_bytes(), count)
    except OSError as error:
        raise TmdError(f"{path} cannot be read: {error.strerror}", hint="give what tmd run --strip wrote") from None


def demonstration_found(roots: Roots, asked: ViewRequest, lines: Lines) -> FoundSubject:
    """One demonstration of a corpus.

    Raises:
        TmdError: There is none of that name, a line is wrong, or the environment is not there.
    """
    read = [read_demonstration(Path(asked.name), number, line) for number, line in lines]
    chosen = _chosen(asked, read)
    corpus, world = _scene(roots, asked, None, chosen.environment, _bundled_beside(asked, chosen.environment))
    where = {"version": __version__, "domain": corpus.folder.name, "environment": world.name, "file": asked.path.name}
    subject = demonstrated_subject(chosen, world, corpus.lexicon, made_rows(where))
    return FoundSubject(subject, asked.path.with_name(f"{_file_name(chosen.id)}.html"))


def _chosen(asked: ViewRequest, read: Sequence[Demonstration]) -> Demonstration:
    ids = [demonstration.id for demonstration in read]
    if asked.demonstration is None and len(read) == 1:
        return read[0]
    if asked.demonstration is None:
        raise TmdError(f"{asked.name} has {len(read)} demonstrations", hint=f"give --id, such as --id {ids[0]}")
    if asked.demonstration not in ids:
        hint = nearest(asked.demonstration, ids, what="demonstrations")
        raise TmdError(f"{asked.name} has no demonstration '{asked.demonstration}'", hint=hint)
    return read[ids.index(asked.demonstration)]


def _file_name(text: str) -> str:
    """An identifier as the name of a file."""
    return "".join(c if c.isalnum() or c in "-_." else "_" for c in text).lstrip(".")[:100] or "demonstration"


def _bundled_beside(asked: ViewRequest, environment: str) -> str | None:
    """The environment in the same problems as the corpus: ``<domain>/environments/`` beside ``<domain>/<task>/``."""
    directory = asked.path.resolve().parent.parent / "environments"
    paths = [directory / f"{Path(environment).name}{suffix}" for suffix in (".yaml", ".pddl")]
    found = next((str(path) for path in paths if path.is_file()), None)
    return None if asked.source == STANDARD else found


def _scene(
    roots: Roots, asked: ViewRequest, domain: str | None, environment: str, file: str | None
) -> tuple[Corpus, World]:
    """The environment: the one that was named now, else the file that was named then, else the bundled one."""
    if asked.environment is not None:
        return roots.world(asked.environment, asked.domain or _domain_of(asked.environment, domain))
    if file is not None:
        paths = [Path(file), asked.path.with_name(Path(file).name)]
        path = next((path for path in paths if path.is_file()), None)
        if path is None:
            raise TmdError(f"the environment {file} is not there any more", hint="give it with --environment FILE")
        return roots.world(str(path), asked.domain or _domain_of(str(path), domain))
    return roots.world(environment, asked.domain or domain)


def _domain_of(environment: str, recorded: str | None) -> str | None:
    """The domain that was recorded, for an environment that does not say its own."""
    return recorded if environment.endswith(".pddl") else None


def _beside(asked: ViewRequest) -> Path:
    return asked.path.with_suffix(".html")
