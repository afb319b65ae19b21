"""Subjects of pages read from files: a grounded text, a run, a plan, a demonstration."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tmd import __version__
from tmd.diagnostics import ExitCode, Location, OptionError, TmdError
from tmd.export.record import parse_record
from tmd.export.strips import restored
from tmd.files import read_bytes
from tmd.grounded import why_refused
from tmd.json_record import json_value
from tmd.language import parse
from tmd.language.clause import Clause
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.model import Problem
from tmd.pddl.plan_file import Plan, parse_plan
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.reading.syntax import nearest, read_standard_input, read_text
from tmd.pddl.validator import Verdict
from tmd.records.grounding import GroundingRecord
from tmd.records.plan import FORMAT
from tmd.records.run import RunRecord, RunRequest, read_log
from tmd.view.meaning import Meaning, after, meaning
from tmd.view.pictures import Strip, read_strip
from tmd.view.run_record import Ran, ran, ran_events
from tmd.view.subject import PlannedStep, Said, Subject, grounded_subject, title_of
from tmd.world.corpus import Corpus
from tmd.world.demonstration import Demonstration, Segment, read_demonstration
from tmd.world.roots import Roots
from tmd.world.world import World


def demonstrated_subject(
    demonstration: Demonstration, world: World, lexicon: Lexicon, made: Iterable[tuple[str, str]] = ()
) -> Subject:
    """Return a demonstration, with its text parsed, its instructions by segment, and its goal if it has one.

    Raises:
        TmdError: The goal is not a condition of the environment.
    """
    problem = world.task.problem
    parsed = parse(demonstration.text, lexicon)
    steps = [
        PlannedStep(instruction, f"segment {number}", " ".join(demonstration.text[part.start : part.end].split()))
        for number, part in enumerate(demonstration.segments, start=1)
        for instruction in part.instructions
    ]
    return Subject(
        f"{demonstration.id}: a demonstration in {demonstration.environment}",
        problem if demonstration.goal is None else with_goal(problem, demonstration.goal, "goal"),
        tuple(steps),
        Said(parsed, tuple(_meanings(parsed.clauses, demonstration.segments, world))),
        made=(
            *made,
            ("task", demonstration.task),
            ("stated end", " ".join(demonstration.end_state) or "none"),
            ("goal", demonstration.goal or "none"),
        ),
    )


def _meanings(clauses: Iterable[Clause], segments: Iterable[Segment], world: World) -> Iterable[Meaning]:
    """Yield the meanings of each clause's nouns among the objects used for the segment that it is in."""
    states = [(world.task.init, Segment(0, 0, ()))]
    for segment in segments:
        states.append((states[-1][0], segment))
        states.append((after(segment.instructions, world, states[-1][0]), Segment(segment.end, segment.end, ())))
    for clause in clauses:
        state, segment = next((s for s in reversed(states) if s[1].start <= clause.span.start), states[0])
        yield meaning(clause, segment.instructions, world, state)


# Standard input or output.
STANDARD = "-"


@dataclass(frozen=True, slots=True)
class ViewRequest:
    """The options that say what a file is and where it belongs."""

    source: str
    environment: str | None = None
    domain: str | None = None
    problem: Path | None = None
    demonstration: str | None = None
    strip: Path | None = None

    @property
    def name(self) -> str:
        """The file as messages name it."""
        return "standard input" if self.source == STANDARD else self.source

    @property
    def path(self) -> Path:
        """The file."""
        return Path(self.source)


@dataclass(frozen=True, slots=True)
class FoundSubject:
    """Subject of a page, and its circumstances.

    Attributes:
        subject: The subject of the page.
        beside: The default file of the page.
        remarks: Lines for standard error.
        locations: Where the steps of a plan file stand.
        of_text: Whether there is a text that should have a plan.
        asks: Whether the text has a question that was not answered.
    """

    subject: Subject
    beside: Path
    remarks: tuple[str, ...] = ()
    locations: tuple[Location, ...] = ()
    of_text: bool = False
    asks: bool = False

    def ending(self, verdict: Verdict) -> ExitCode:
        """Return the exit code, given the validator's verdict on the plan."""
        if self.of_text and not (self.subject.steps or self.subject.plans):
            return ExitCode.NOT_GROUNDED
        if self.asks:
            return ExitCode.QUESTION
        return ExitCode.OK if verdict.valid else ExitCode.INVALID_PLAN

    def complaint(self, verdict: Verdict) -> str:
        """Return why the plan does not work, for standard error; empty where it does, or where there is none."""
        if verdict.valid or not self.subject.steps:
            return ""
        place = f"{self.locations[verdict.step - 1]}: " if verdict.step and self.locations else ""
        return f"invalid: {place}{verdict.reason}\n"


# The lines of a file that are not blank, with their numbers.
Lines = Sequence[tuple[int, str]]


def made_rows(values: Mapping[str, object]) -> tuple[tuple[str, str], ...]:
    """Return the settings as names and values, without those that are ``None``."""
    return tuple((name.replace("_", " "), str(value)) for name, value in values.items() if value is not None)


def grounding_found(roots: Roots, asked: ViewRequest, value: Mapping[str, Any]) -> FoundSubject:
    """Read a record of ``tmd ground --json``.

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
    """Read a record of ``tmd run --json``, or a log of ``tmd run``.

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
    names = ("version", "planner", "mode", "seed")
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
    """Return a run of a plan file."""
    said = None if told.text is None else Said(parse(told.text, corpus.lexicon))
    what = "A plan that the robot carried out" if told.text is None else told.text
    steps = tuple(PlannedStep(order.instruction) for order in told.plan)
    title = title_of(what, world.name)
    return Subject(title, world.task.problem, steps, said, ran=done, strip=strip, made=rows)


def _strip(asked: ViewRequest, recorded: str | None, count: int) -> Strip | None:
    """Return the filmstrip of a run: the one that was named, else what lies beside the log."""
    if asked.strip is not None:
        found = _picture(asked.strip, count)
        if found is None:
            raise TmdError(f"{asked.strip} is not a PNG picture", hint="give what tmd run --strip wrote")
        return found
    if asked.source == STANDARD:
        return None
    names = [Path(recorded).name] if recorded else []
    paths = [asked.path.parent / name for name in names] + [asked.path.with_suffix(".png")]
    path = next((path for path in paths if path.is_file()), None)
    return None if path is None else _picture(path, count)


def _picture(path: Path, count: int) -> Strip | None:
    try:
        return read_strip(read_bytes(path), count)
    except OSError as error:
        raise TmdError(f"{path} cannot be read: {error.strerror}", hint="give what tmd run --strip wrote") from None


def demonstration_found(roots: Roots, asked: ViewRequest, lines: Lines) -> FoundSubject:
    """Read one demonstration of a corpus.

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
    """Return an identifier as the name of a file."""
    return "".join(c if c.isalnum() or c in "-_." else "_" for c in text).lstrip(".")[:100] or "demonstration"


def _bundled_beside(asked: ViewRequest, environment: str) -> str | None:
    """Return the environment's file near the corpus: ``<domain>/environments/`` beside ``<domain>/<task>/``."""
    directory = asked.path.resolve().parent.parent / "environments"
    paths = [directory / f"{Path(environment).name}{suffix}" for suffix in (".yaml", ".pddl")]
    found = next((str(path) for path in paths if path.is_file()), None)
    return None if asked.source == STANDARD else found


def _scene(
    roots: Roots, asked: ViewRequest, domain: str | None, environment: str, file: str | None
) -> tuple[Corpus, World]:
    """Return the environment: the one that was named now, else the file that was named then, else the bundled one."""
    if asked.environment is not None:
        return roots.world(asked.environment, asked.domain or _domain_of(asked.environment, domain))
    if file is not None:
        paths = [Path(file), asked.path.parent / Path(file).name]
        path = next((path for path in paths if path.is_file()), None)
        if path is None:
            raise TmdError(f"the environment {file} is not there any more", hint="give it with --environment FILE")
        return roots.world(str(path), asked.domain or _domain_of(str(path), domain))
    return roots.world(environment, asked.domain or domain)


def _domain_of(environment: str, recorded: str | None) -> str | None:
    """Return the domain that was recorded, for an environment that does not say its own."""
    return recorded if environment.endswith(".pddl") else None


def _beside(asked: ViewRequest) -> Path:
    return asked.path.with_suffix(".html")


# Plans with more steps are refused: such a page cannot be read.
MAX_STEPS = 10_000
_KINDS = "what tmd ground --json or tmd run --json printed, a log of tmd run, a plan file, or demonstrations"


def subject_of_file(roots: Roots, asked: ViewRequest) -> FoundSubject:
    """Read a file, whose content says what kind of file it is.

    Raises:
        TmdError: It is of no kind that is known, or something in it or around it is wrong.
        OptionError: An option has no meaning for this kind.
    """
    if asked.source != STANDARD and asked.path.is_dir():
        raise TmdError(f"{asked.source} is a directory", hint=f"give a file: {_KINDS}")
    text = _read(asked)
    found = _of_text(roots, asked, text)
    if len(found.subject.steps) > MAX_STEPS:
        raise TmdError(
            f"{asked.name}: the plan has {len(found.subject.steps):,} steps; at most {MAX_STEPS:,} are shown",
            hint="cut the plan",
        )
    return found


def _read(asked: ViewRequest) -> str:
    return read_standard_input() if asked.source == STANDARD else read_text(asked.path)


def _of_text(roots: Roots, asked: ViewRequest, text: str) -> FoundSubject:
    lines = [(number, line) for number, line in enumerate(text.splitlines(), start=1) if line.strip()]
    if not lines:
        raise TmdError(f"{asked.name} is empty", hint=f"give {_KINDS}")
    if not lines[0][1].lstrip().startswith(("{", "[")):
        _only(asked, "problem", "environment", "domain")
        return _plan_found(roots, asked, text)
    try:
        first = _object(asked, lines[0][1])  # of JSON Lines, or all on one line
    except TmdError:
        first = _object(asked, text)
    return _of_json(roots, asked, first, lines)


def _of_json(roots: Roots, asked: ViewRequest, first: dict[str, Any], lines: list[tuple[int, str]]) -> FoundSubject:
    if "segments" in first:
        _only(asked, "demonstration", "environment", "domain")
        return demonstration_found(roots, asked, lines)
    if first.get("format") == FORMAT:
        _only(asked)
        planned = parse_record("\n".join(line for _, line in lines), asked.name)
        return _plan_of(asked, planned.problem, Plan(planned.plan))
    if "event" in first or ("mode" in first and "steps" in first):
        _only(asked, "environment", "domain", "strip")
        return run_found(roots, asked, first, lines)
    if "plans" in first:
        _only(asked, "environment", "domain")
        return grounding_found(roots, asked, first)
    if isinstance(first.get("error"), dict):
        raise TmdError(
            f"{asked.name} is an error that tmd printed, no plan: {first['error'].get('message')}",
            hint=f"give {_KINDS}",
        )
    raise TmdError(f"{asked.name} is JSON of no kind that can be shown", hint=f"give {_KINDS}")


def _only(asked: ViewRequest, *meant: str) -> None:
    """Refuse options that this kind of file has no use for."""
    names = {"problem": "--problem", "environment": "--environment", "domain": "--domain"}
    names |= {"demonstration": "--id", "strip": "--strip"}
    for field, option in names.items():
        if field not in meant and getattr(asked, field) is not None:
            raise OptionError(f"{option} has no meaning for {asked.name}", hint="leave it out")


def _object(asked: ViewRequest, text: str) -> dict[str, Any]:
    """Return the JSON object in a text."""
    value = json_value(text, asked.name, hint=f"give {_KINDS}")
    if not isinstance(value, dict):
        raise TmdError(f"{asked.name} is JSON, but no object", hint=f"give {_KINDS}")
    return value


_WHERE = "a plan file does not say where it belongs: --problem p.pddl, or --environment kitchen1"


def _plan_found(roots: Roots, asked: ViewRequest, text: str) -> FoundSubject:
    """Return a plan file, in a problem or an environment."""
    if (asked.problem is None) == (asked.environment is None):
        raise OptionError(f"for the plan {asked.name} give one of --problem and --environment", hint=_WHERE)
    plan = parse_plan(text, asked.name)
    if not plan.instructions:
        raise TmdError(f"{asked.name}: the plan has no instructions", hint="write one (name argument ...) a line")
    if asked.problem is not None:
        problem = roots.problem(asked.problem, asked.domain)
    else:
        problem = roots.world(asked.environment or "", asked.domain)[1].task.problem
    return _plan_of(asked, problem, plan)


def _plan_of(asked: ViewRequest, problem: Problem, plan: Plan) -> FoundSubject:
    where = {"problem": asked.problem, "environment": asked.environment or problem.name, "domain": problem.domain.name}
    steps = tuple(PlannedStep(instruction) for instruction in restored(problem, plan.instructions))
    subject = Subject(f"{asked.path.name}: a plan in {problem.name}", problem, steps, made=made_rows(where))
    told = f"warning: {plan.overlap}: instructions overlap in time; they are taken one after the other\n"
    return FoundSubject(subject, asked.path.with_suffix(".html"), (told,) if plan.overlap else (), plan.locations)
