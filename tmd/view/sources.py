"""Subjects of pages read from files: a grounded text, a run, a plan."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tmd.diagnostics import ExitCode, Location, OptionError, TmdError
from tmd.files import read_bytes
from tmd.grounded import why_refused
from tmd.inference.ranking import RejectedProposal
from tmd.json_record import json_value
from tmd.language import parse
from tmd.pddl.plan_file import parse_plan
from tmd.pddl.reading.syntax import read_standard_input, read_text
from tmd.pddl.validator import Verdict
from tmd.records.grounding import GroundingRecord
from tmd.records.run import EndEvent, RanStep, RunRecord, RunRequest, StepEvent, read_log
from tmd.view.subject import PlannedStep, Ran, Said, Subject, grounded_subject, title_of
from tmd.world.corpus import Corpus
from tmd.world.roots import Roots
from tmd.world.world import World

# The lines of a file that are not blank, with their numbers.
Lines = Sequence[tuple[int, str]]
_KINDS = "give what tmd ground --json or tmd run --json printed, a log of tmd run, or a plan file"


# Standard input or output.
STANDARD = "-"
_PNG = b"\x89PNG\r\n\x1a\n"


@dataclass(frozen=True, slots=True)
class ViewRequest:
    """The options that say what a file is and where it belongs."""

    source: str
    environment: str | None = None
    domain: str | None = None
    problem: Path | None = None

    @property
    def name(self) -> str:
        """The file as messages name it."""
        return "standard input" if self.source == STANDARD else self.source

    @property
    def path(self) -> Path:
        """The file."""
        return Path(self.source)

    def only(self, *meant: str) -> None:
        """Refuse options other than ``meant``, for which a kind of file has no use.

        Raises:
            OptionError: One of them was given.
        """
        for name in ("problem", "environment", "domain"):
            if name not in meant and getattr(self, name) is not None:
                raise OptionError(f"--{name} has no meaning for {self.name}", hint="leave it out")


@dataclass(frozen=True, slots=True)
class FoundSubject:
    """Subject of a page, and its circumstances. ``of_text``: there is a text, or a problem, that should have a plan."""

    subject: Subject
    remarks: tuple[str, ...] = ()
    locations: tuple[Location, ...] = ()
    of_text: bool = False

    def ending(self, verdict: Verdict) -> ExitCode:
        """Return the exit code, given the validator's verdict on the plan."""
        if self.of_text and not self.subject.planned:
            return ExitCode.NOT_GROUNDED
        return ExitCode.OK if verdict.valid else ExitCode.INVALID_PLAN

    def complaint(self, verdict: Verdict) -> str:
        """Return why the plan does not work, for standard error; empty where it does, or where there is none."""
        if verdict.valid or not self.subject.steps:
            return ""
        place = f"{self.locations[verdict.step - 1]}: " if verdict.step and self.locations else ""
        return f"invalid: {place}{verdict.reason}\n"


def made_rows(values: Mapping[str, object]) -> tuple[tuple[str, str], ...]:
    """Return the settings as names and values, without those that are ``None``."""
    return tuple((name.replace("_", " "), str(value)) for name, value in values.items() if value is not None)


def subject_of_file(roots: Roots, asked: ViewRequest) -> FoundSubject:
    """Read a file, whose content says what kind of file it is.

    Raises:
        TmdError: It is of no kind that is known, or something in it or around it is wrong.
        OptionError: An option has no meaning for this kind.
    """
    if asked.problem == asked.path:
        return _planned(roots, asked)
    if asked.source != STANDARD and asked.path.is_dir():
        raise TmdError(f"{asked.source} is a directory", hint=_KINDS.replace("give", "give a file:", 1))
    text = read_standard_input() if asked.source == STANDARD else read_text(asked.path)
    lines = [(number, line) for number, line in enumerate(text.splitlines(), start=1) if line.strip()]
    if not lines:
        raise TmdError(f"{asked.name} is empty", hint=_KINDS)
    of_json = lines[0][1].lstrip().startswith("{")
    return _of_json(roots, asked, text, lines) if of_json else _plan_found(roots, asked, text)


def _planned(roots: Roots, asked: ViewRequest) -> FoundSubject:
    """Return a problem with a plan that is found for it, or without steps where none is found."""
    from tmd.planning.backends import solve
    from tmd.planning.result import Solved

    problem = roots.problem(asked.path, asked.domain)
    answer = solve(problem)
    solved = isinstance(answer, Solved)
    steps = tuple(PlannedStep(instruction) for instruction in answer.plan) if isinstance(answer, Solved) else ()
    remarks = () if solved else (f"warning: {asked.name}: no plan was found; the page shows the initial state\n",)
    where = {"problem": asked.problem, "domain": problem.domain.name}
    title = f"{asked.path.name}: {'a plan in ' if solved else ''}{problem.name}"
    refused = "" if solved else "none was found"
    subject = Subject(title, problem, steps, made=made_rows(where), refused=refused)
    return FoundSubject(subject, remarks, of_text=not solved)


def _of_json(roots: Roots, asked: ViewRequest, text: str, lines: Lines) -> FoundSubject:
    try:
        first = _object(asked, lines[0][1])  # of JSON Lines, or all on one line
    except TmdError:
        first = _object(asked, text)
    if "event" in first or ("mode" in first and "steps" in first):
        asked.only("environment", "domain")
        run, done = _run(asked, first, lines)
        return _record_found(asked, run, _scene(roots, asked, run.domain, run.environment, run.environment_file), done)
    if "plans" in first and "environment" in first:
        asked.only("environment", "domain")
        told = GroundingRecord.from_value(first, asked.name)
        return _record_found(asked, told, _scene(roots, asked, told.domain, told.environment, told.environment_file))
    if isinstance(first.get("error"), dict):
        raise TmdError(
            f"{asked.name} is an error that tmd printed, no plan: {first['error'].get('message')}", hint=_KINDS
        )
    if asked.environment is not None or asked.problem is not None:
        return _plan_found(roots, asked, text)
    raise TmdError(f"{asked.name} is JSON of no kind that can be shown", hint=_KINDS)


def _object(asked: ViewRequest, text: str) -> dict[str, Any]:
    """Return the JSON object in a text."""
    value: dict[str, Any] = json_value(text, asked.name, hint=_KINDS)
    return value


def _record_found(
    asked: ViewRequest, told: RunRequest | GroundingRecord, scene: tuple[Corpus, World], done: Ran | None = None
) -> FoundSubject:
    """Return the subject of a record: a grounded text, a run of one, or a run of a plan file."""
    corpus, world = scene
    record = told if isinstance(told, GroundingRecord) else told.grounding
    made: dict[str, object] = {} if record is None else dict(record.made_with)
    strip = ""
    if isinstance(told, RunRequest):
        made |= {name: getattr(told, name) for name in ("version", "planner", "mode", "seed")}
        strip = _strip(asked, told.strip)
    rows = made_rows({**made, "domain": corpus.folder.name, "environment": world.name})
    if record is not None:
        refused = record.refused
        subject = grounded_subject(
            title_of(record.text, world.name),
            world,
            record.parsed(record.text),
            record.ranked(),
            tuple(RejectedProposal(r.clause, r.source, r.reason) for r in record.refusals),
            unseen=record.unseen_verbs,
            unknown=record.unknown_nouns,
            made=rows,
            ran=done,
            strip=strip,
            refused="" if refused is None else why_refused(refused.clause, refused.message, refused.hint),
        )
    else:
        assert isinstance(told, RunRequest)
        said = None if told.text is None else Said(parse(told.text, corpus.lexicon))
        title = title_of("A plan that the robot carried out" if told.text is None else told.text, world.name)
        steps = tuple(PlannedStep(order.instruction) for order in told.plan)
        subject = Subject(title, world.task.problem, steps, said, ran=done, strip=strip, made=rows)
    return FoundSubject(subject, of_text=subject.said is not None)


def _run(asked: ViewRequest, first: Mapping[str, Any], lines: Lines) -> tuple[RunRequest, Ran]:
    """Read a record of ``tmd run --json``, or a log of ``tmd run``; that of a run that was killed has no end."""
    if "event" not in first:
        record = RunRecord.from_value(first, asked.name)
        return record, _ended(record, record.steps)
    told, events = read_log(lines, asked.name)
    steps = tuple(event for event in events if isinstance(event, StepEvent))
    end = next((event for event in reversed(events) if isinstance(event, EndEvent)), None)
    return told, Ran("unfinished", steps=steps) if end is None else _ended(end, steps)


def _ended(end: RunRecord | EndEvent, steps: tuple[RanStep, ...]) -> Ran:
    return Ran(end.status, end.reason or "", end.repairs, end.seconds, steps)


def _strip(asked: ViewRequest, recorded: str | None) -> str:
    """Return the filmstrip that lies beside the log of a run as a ``data:`` address; empty for none."""
    if asked.source == STANDARD:
        return ""
    for name in filter(None, (recorded and Path(recorded).name, asked.path.with_suffix(".png").name)):
        with suppress(OSError):
            found = read_bytes(asked.path.parent / name)
            return f"data:image/png;base64,{b64encode(found).decode()}" if found.startswith(_PNG) else ""
    return ""


def _scene(
    roots: Roots, asked: ViewRequest, domain: str | None, environment: str, file: str | None
) -> tuple[Corpus, World]:
    """Return the environment: the one that was named now, else the file that was named then, else the bundled one."""
    place = asked.environment
    if place is None and file is not None:
        paths = [Path(file), asked.path.parent / Path(file).name]
        place = next((str(path) for path in paths if path.is_file()), None)
        if place is None:
            raise TmdError(f"the environment {file} is not there any more", hint="give it with --environment FILE")
    if place is None:
        return roots.world(environment, asked.domain or domain)
    if asked.domain is not None or not place.endswith(".pddl"):
        return roots.world(place, asked.domain)
    return roots.recorded(place, domain)  # an environment in PDDL does not name its domain


_WHERE = "a plan file does not say where it belongs: --problem p.pddl, or --environment kitchen1"


def _plan_found(roots: Roots, asked: ViewRequest, text: str) -> FoundSubject:
    """Return a plan file, in a problem or an environment."""
    asked.only("problem", "environment", "domain")
    if (asked.problem is None) == (asked.environment is None):
        raise OptionError(f"for the plan {asked.name} give one of --problem and --environment", hint=_WHERE)
    if asked.problem is not None:
        problem = roots.problem(asked.problem, asked.domain)
    else:
        problem = roots.world(asked.environment or "", asked.domain)[1].task.problem
    plan = parse_plan(text, asked.name, problem)
    if not plan.instructions:
        raise TmdError(f"{asked.name}: the plan has no instructions", hint="write one (name argument ...) a line")
    where = {"problem": asked.problem, "environment": asked.environment or problem.name, "domain": problem.domain.name}
    steps = tuple(PlannedStep(instruction) for instruction in plan.instructions)
    subject = Subject(f"{asked.path.name}: a plan in {problem.name}", problem, steps, made=made_rows(where))
    return FoundSubject(subject, tuple(f"warning: {warning}\n" for warning in plan.warnings), plan.locations)
