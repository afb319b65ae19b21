"""``tmd parse``, ``tmd ground`` and ``tmd test``: requests to clauses and to plans, and tests of both."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tmd.cli.errors import fault_of
from tmd.cli.options import (
    MAX_CHARACTERS,
    OUTPUT,
    PATH,
    STANDARD,
    Asked,
    GivenText,
    ReadingOptions,
    asked_options,
    gathered,
    grounding_options,
    json_option,
    learned_option,
    reading_options,
    request_options,
)
from tmd.cli.output import emit
from tmd.diagnostics import ExitCode, TmdError
from tmd.inference.config import DEFAULT
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.cli.grounding import Answer
    from tmd.evaluation.sentence_tests import SentenceResult
    from tmd.world.sentence_file import SentenceTest


@click.command("parse", short_help="Split a text into verb clauses.")
@request_options
@click.option("--domain", "domain_name", metavar="NAME|FILE", help="Use the words of this domain as well.")
@json_option
@click.pass_obj
def parse(roots: Roots, spoken: GivenText, domain_name: str | None, as_json: bool) -> None:
    """Split a text into verb clauses, and show what no clause accounts for."""
    from tmd.language import parse
    from tmd.records.clauses import ParsedRecord
    from tmd.view.answer_text import parsed_text

    parsed = parse(spoken.read(), roots.folder(domain_name).lexicon if domain_name else None)
    emit(ParsedRecord.of(parsed).to_value() if as_json else parsed_text(parsed))


@dataclass(frozen=True, slots=True)
class _Shown:
    """The options that say what of an answer is printed."""

    verbose: bool
    energies: bool
    brief: bool
    goal_only: bool
    as_json: bool

    def value(self, found: Answer) -> object:
        """Return the answer as a text or as JSON."""
        from tmd.cli.grounding import whole_goal_text
        from tmd.view.answer_text import brief_text, grounded_text

        if self.as_json:
            return (found.record.goal_only() if self.goal_only else found.record).to_value()
        if self.goal_only:
            return whole_goal_text(found.grounded)
        if self.brief:
            return brief_text(found.grounded)
        return grounded_text(found.grounded, energies=self.energies, verbose=self.verbose)


@click.command("ground", short_help="Ground a request in an environment: ranked, validated plans.")
@asked_options
@grounding_options
@reading_options
@click.option("--ask", is_flag=True, help="Ask on the terminal which of several readings is meant.")
@click.option("--show-prompt", is_flag=True, help="Print the prompt for the language model, and send nothing.")
@click.option(*OUTPUT, type=PATH, metavar="FILE", help="Write the answer to this file.")
@gathered(
    "shown",
    _Shown,
    click.option("-v", "--verbose", is_flag=True, help="Print whole goals, rows that did not fit, effort of a model."),
    click.option("--energies", is_flag=True, help="Print the energy of each plan by factor."),
    click.option("-q", "--brief", is_flag=True, help="Print nothing but the instructions, a plan on a line."),
    click.option("--goal-only", is_flag=True, help="Print a PDDL problem with the goal of the request, and no plan."),
    json_option,
)
@click.pass_obj
def ground(
    roots: Roots,
    asked: Asked,
    options: dict[str, Any],
    reading: ReadingOptions,
    ask: bool,
    show_prompt: bool,
    output: Path | None,
    shown: _Shown,
) -> ExitCode:
    """Ground REQUEST in ENVIRONMENT, or in the PDDL files DOMAIN and PROBLEM: print ranked, validated plans.

    With - as REQUEST every line of standard input is one, and a line is printed for each plan.

    The demonstrations of the domain are learned from once; `tmd list` names the bundled environments. Ends with 12
    where no plan was found, and with 15 where two readings of the request differ and nobody chose one; the plan is then
    for the first one that has a plan.
    """
    from tmd.cli.grounding import answer, ask_on_terminal
    from tmd.inference.config import preset
    from tmd.view.answer_text import remarks

    if shown.goal_only and not preset(options["model"]).goals:
        raise click.UsageError(f"the model {options['model']} knows no goals: leave --model out")
    if ask and asked.spoken.from_input:
        raise click.UsageError("--ask reads answers from standard input, so the text cannot come from there")
    lines = asked.spoken.argument == STANDARD
    if lines and (show_prompt or (shown.goal_only and not shown.as_json)):
        raise click.UsageError("--show-prompt, and --goal-only without --json, are for one request")
    request = "" if lines else asked.spoken.request()
    if show_prompt:
        emit(_prompt(roots, asked, request, reading))
        return ExitCode.OK
    corpus, world = roots.world(asked.environment, asked.domain)
    asking = partial(ask_on_terminal, world.task.problem) if ask else None
    ground = partial(answer, corpus, world, asked.environment, reading=reading, ask=asking, **options)
    if lines:
        return _ground_lines(ground, replace(shown, brief=True), output)
    found = ground(text=request)
    emit(shown.value(found), output)
    for line in remarks(found.grounded, verbose=shown.verbose):
        emit(line, error=True)
    return found.code


def _prompt(roots: Roots, asked: Asked, request: str, reading: ReadingOptions) -> str:
    settings = reading.settings()
    if settings is None:
        raise click.UsageError("--show-prompt is for --reader llm")
    from tmd.readers.llm.reader import llm_reader

    corpus, world = roots.world(asked.environment, asked.domain)
    prompt = llm_reader(corpus, settings).prompt(request, world, world.task.init)
    return f"{prompt.system}\n\n{prompt.user}\n"


def _ground_lines(ground: Callable[..., Answer], shown: _Shown, output: Path | None) -> ExitCode:
    """Ground each line of standard input, and print a line for it; return the first code other than 0."""
    from tmd.view.answer_text import remarks

    code, kept = ExitCode.OK, []
    for number, line in enumerate(iter(lambda: sys.stdin.buffer.readline(4 * MAX_CHARACTERS), b""), start=1):
        if not line.strip():
            continue
        value: object
        try:
            request = line.decode("utf-8", "surrogateescape").removeprefix("\ufeff").strip()
            found = ground(text=GivenText(request, None).request())
            value, ended, told = shown.value(found), found.code, remarks(found.grounded, verbose=shown.verbose)
        except (TmdError, RecursionError) as error:
            fault = fault_of(error, "tmd ground")
            value, ended = fault.json() if shown.as_json else "no plan\n", fault.code
            told = fault.text().splitlines(keepends=True)
        kept.append(value if isinstance(value, str) else json.dumps(value, ensure_ascii=False) + "\n")
        if output is None:
            emit(kept.pop())
        emit("".join(f"line {number}: {remark}" for remark in told), error=True)
        code = code or ended
    if output is not None:
        emit("".join(kept), output)
    return code


@click.command("test", short_help="Run sentence tests: requests with expected goals.")
@click.argument("domain", metavar="[DOMAIN]", required=False)
@click.argument("problem", metavar="[PROBLEM]", required=False)
@click.option(
    "--cases",
    type=PATH,
    multiple=True,
    metavar="FILE",
    help="Sentence tests to run instead of *.sentences.jsonl beside the problems of DOMAIN.",
)
@click.option("--model", "model_name", default=DEFAULT, show_default=True, metavar="NAME", help="The model.")
@click.option("--guess", is_flag=True, help="Plan also for a request that is not understood or cannot be done.")
@reading_options
@click.option("--jobs", type=click.IntRange(1, 64), default=1, show_default=True, help="Processes.")
@learned_option
@json_option
@click.pass_obj
def test(
    roots: Roots,
    domain: str | None,
    problem: str | None,
    cases: tuple[Path, ...],
    model_name: str,
    guess: bool,
    reading: ReadingOptions,
    jobs: int,
    learned: Path | None,
    as_json: bool,
) -> ExitCode:
    """Run the sentence tests of a domain, or those of a file; with the PDDL files DOMAIN and PROBLEM all of them there.

    A test is a line of JSON: {"id", "domain", "environment", "text", "goal"}; the goal is a PDDL condition that must
    hold at the end of the first plan, or null where the request must be refused. Ends with 1 where a test fails.
    """
    from tmd.evaluation.sentence_tests import report

    tests = _tests_of_files(domain, problem, cases) if domain and problem else _tests(roots, domain, cases)
    how = {"reader": reading.reader, "llm": reading.settings(), "verify": reading.verify}
    found = _run(roots, tests, learned, {"model": model_name, "guess": guess, "jobs": jobs, **how})
    emit(report(found, reading.reader).to_value() if as_json else _text(found))
    return ExitCode.OK if all(result.outcome.passed for result in found) else ExitCode.TESTS_FAILED


def _tests(roots: Roots, domain: str | None, cases: Sequence[Path]) -> list[SentenceTest]:
    from tmd.world.sentence_file import domain_sentences, read_sentences

    if bool(domain) == bool(cases):
        raise TmdError("name a domain, or files with --cases", hint="tmd test kitchen")
    if domain:
        return domain_sentences(roots.corpus(roots.folder(domain)).directory)
    return [test for path in cases for test in read_sentences(path)]


def _tests_of_files(domain: str, problem: str, cases: Sequence[Path]) -> list[SentenceTest]:
    """Return the tests of files, or those beside a problem, in this domain and problem."""
    from tmd.world.sentence_file import domain_sentences, read_sentences

    found = [t for path in cases for t in read_sentences(path)] if cases else domain_sentences(Path(problem).parent)
    return [test.model_copy(update={"domain": domain, "environment": problem}) for test in found]


def _run(
    roots: Roots, tests: Sequence[SentenceTest], learned: Path | None, options: Mapping[str, Any]
) -> list[SentenceResult]:
    """Run the tests, domain after domain."""
    from tmd.domain_kit import DomainKit

    found: list[SentenceResult] = []
    for domain in dict.fromkeys(test.domain for test in tests):
        kit = DomainKit(roots.corpus(roots.folder(domain)), learned)
        found += kit.run_sentence_tests([test for test in tests if test.domain == domain], **options)
    return found


def _text(results: Sequence[SentenceResult]) -> str:
    """Return every failure, then the counts, by kind where the tests have kinds."""
    from tmd.evaluation.sentence_tests import by_kind

    lines = []
    for result in results:
        if not result.outcome.passed:
            lines.append(
                f"{result.test.id}: {result.outcome.value.replace('_', ' ')}: {' '.join(result.test.text.split())}"
            )
            lines.append(f"    {result.reason}")
            lines += [f"    goal: {goal}" for goal in result.goals]
            if result.plan:
                lines.append(f"    plan: {' '.join(result.plan)}")
            lines += [f"    warning: {warning}" for warning in result.warnings]
    for kind, own in by_kind(results).items():
        lines.append(f"{kind}: {sum(result.outcome.passed for result in own)} of {len(own)}")
    lines.append(_total(results))
    return "\n".join(lines) + "\n"


def _total(results: Sequence[SentenceResult]) -> str:
    """Return the counts on one line."""
    from tmd.evaluation.sentence_tests import summary

    counts = summary(results)
    return (
        f"{counts.right} of {counts.n - counts.impossible} right, "
        f"{counts.wrong} wrong ({counts.wrong_warned} with a warning), {counts.refused} refused; "
        f"{counts.impossible_refused} of {counts.impossible} impossible ones refused"
    )
