"""Groundings, runs and demonstrations as what ``tmd view`` shows."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from tmd import __version__
from tmd.cli.inputs.view import STANDARD, FoundSubject, ViewRequest
from tmd.diagnostics import Location, TmdError
from tmd.language import parse
from tmd.pddl.model import Instruction
from tmd.pddl.reading.syntax import nearest
from tmd.veil.corpus import Corpus
from tmd.veil.demonstration import Demonstration, read_demonstration
from tmd.veil.roots import Roots
from tmd.veil.world import World
from tmd.view.demonstrated import demonstrated_subject
from tmd.view.grounding_record import GroundingRecord, read_grounding
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
    try:
        record = read_grounding(value)
    except ValidationError as error:
        raise _damaged(asked, "tmd ground --json", error) from None
    corpus, world = _scene(roots, asked, record.domain, record.environment, record.environment_file)
    rows = made_rows({**record.made_with, "domain": corpus.folder.name, "environment": world.name})
    return FoundSubject(_grounding_subject(record, world, rows), _beside(asked), of_text=True)


def _grounding_subject(
    record: GroundingRecord,
    world: World,
    rows: Sequence[tuple[str, str]],
    done: Ran | None = None,
    strip: Strip | None = None,
) -> Subject:
    return grounded_subject(
        title_of(record.parsed.text, world.name),
        world,
        record.parsed,
        record.plans,
        record.refusals,
        unseen=record.unseen,
        unknown=record.unknown,
        made=rows,
        ran=done,
        strip=strip,
        refused=record.refused,
    )


def run_found(roots: Roots, asked: ViewRequest, first: Mapping[str, Any], lines: Lines) -> FoundSubject:
    """What ``tmd run --json`` printed, or a log of ``tmd run``.

    Raises:
        TmdError: It is damaged, or its environment or filmstrip is not there.
    """
    try:
        done = ran_events(_events(asked, lines)) if "event" in first else ran(first)
        record = read_grounding(first["grounding"]) if first.get("grounding") else None
        environment, domain = str(first["environment"]), str(first["domain"])
        plan = [Instruction(str(step["action"]), tuple(map(str, step["args"]))) for step in first["plan"]]
    except (ValidationError, KeyError, TypeError) as error:
        raise _damaged(asked, "tmd run", error) from None
    corpus, world = _scene(roots, asked, domain, environment, first.get("environment_file"))
    strip = _strip(asked, first.get("strip"), len(done.steps))
    names = ("version", "planner", "mode", "seed", "fault")
    made = {name: first.get(name) for name in names} | {"domain": corpus.folder.name, "environment": world.name}
    if record is not None:
        rows = made_rows({**record.made_with, **made})
        subject = _grounding_subject(record, world, rows, done, strip)
    else:
        subject = _run_subject(plan, first.get("text"), corpus, world, made_rows(made), done, strip)
    return FoundSubject(subject, _beside(asked), of_text=subject.said is not None)


def _run_subject(
    plan: Sequence[Instruction],
    text: object,
    corpus: Corpus,
    world: World,
    rows: tuple[tuple[str, str], ...],
    done: Ran,
    strip: Strip | None,
) -> Subject:
    """A run of a plan file, or of a text of which no more is known than the plan."""
    said = Said(parse(text, corpus.lexicon)) if isinstance(text, str) else None
    title = title_of(text, world.name) if isinstance(text, str) else f"A plan that the robot carried out ({world.name})"
    steps = tuple(map(PlannedStep, plan))
    return Subject(title, world.task.problem, steps, said, ran=done, strip=strip, made=rows)


def _events(asked: ViewRequest, lines: Lines) -> list[Mapping[str, Any]]:
    """The lines of a log; the last one may be cut off where the run was killed."""
    found: list[Mapping[str, Any]] = []
    for number, line in lines:
        try:
            event = json.loads(line)
        except (ValueError, RecursionError):
            event = None
        if not isinstance(event, dict):
            if number == lines[-1][0]:
                break
            raise TmdError("this line of the log is not a JSON object", location=Location(asked.name, number, 1))
        found.append(event)
    if found[0].get("event") != "plan":
        raise TmdError(f"{asked.name} does not begin with a plan", hint="give a whole log of tmd run")
    return found


def _strip(asked: ViewRequest, recorded: object, count: int) -> Strip | None:
    """The filmstrip of a run: the one that was named, else what lies beside the log."""
    if asked.strip is not None:
        found = _picture(asked.strip, count)
        if found is None:
            raise TmdError(f"{asked.strip} is not a PNG picture", hint="give what tmd run --strip wrote")
        return found
    if asked.source == STANDARD:
        return None
    names = [Path(recorded).name] if isinstance(recorded, str) and recorded else []
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
    roots: Roots, asked: ViewRequest, domain: str | None, environment: str, file: object
) -> tuple[Corpus, World]:
    """The environment: the one that was named now, else the file that was named then, else the bundled one."""
    if asked.environment is not None:
        return roots.world(asked.environment, asked.domain or _domain_of(asked.environment, domain))
    if isinstance(file, str):
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


def _damaged(asked: ViewRequest, what: str, error: Exception) -> TmdError:
    """The first thing that is wrong, in one line."""
    hint = f"make it anew with {what}"
    if not isinstance(error, ValidationError):
        return TmdError(f"{asked.name} is not what {what} prints: {type(error).__name__} {error}", hint=hint)
    first = error.errors(include_url=False, include_input=False)[0]
    place = ".".join(map(str, first["loc"]))
    message = " ".join(str(first["msg"]).removeprefix("Value error, ").split())
    return TmdError(f"{asked.name} is not what {what} prints: {f'{place}: ' if place else ''}{message}", hint=hint)
