"""``tmd test``: sentence tests of a domain's author: does each request end in what was asked?"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tmd.cli.inputs.options import ReadingOptions, json_option, learned_option, reading_options
from tmd.cli.output import emit, emit_json
from tmd.diagnostics import ExitCode, TmdError
from tmd.inference.config import DEFAULT
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.evaluation.sentence_tests import SentenceResult
    from tmd.world.sentence_file import SentenceTest


@click.command("test", short_help="Run sentence tests: does each request end in what was asked?")
@click.argument("domain", metavar="[DOMAIN]", required=False)
@click.option(
    "--cases",
    type=click.Path(path_type=Path),
    multiple=True,
    metavar="FILE",
    help="Sentence tests to run instead of *.sentences.jsonl beside the problems of DOMAIN.",
)
@click.option("--model", "model_name", default=DEFAULT, show_default=True, metavar="NAME", help="The model.")
@click.option("--guess", is_flag=True, help="Plan even where what was said is not understood or cannot be done.")
@reading_options
@click.option("--compare", metavar="A,B", help="Run the tests with two readers, and compare them: rules,llm.")
@click.option("--jobs", type=click.IntRange(1, 64), default=1, show_default=True, help="Processes.")
@learned_option
@json_option
@click.pass_obj
def command(
    roots: Roots,
    domain: str | None,
    cases: tuple[Path, ...],
    model_name: str,
    guess: bool,
    reading: ReadingOptions,
    compare: str | None,
    jobs: int,
    learned: Path | None,
    as_json: bool,
) -> ExitCode:
    """Run the sentence tests of a domain, or those of a file.

    A test is a line of JSON: {"id", "domain", "environment", "text", "goal"}; the goal is a PDDL condition that must
    hold at the end of the first plan, or null where the request must be refused. Ends with 1 where a test fails.
    """
    from tmd.evaluation.sentence_tests import compared, report

    tests = _tests(roots, domain, cases)
    options = {
        "model": model_name, "guess": guess, "reader": reading.reader, "llm": reading.settings(),
        "verify": reading.verify, "jobs": jobs,
    }  # fmt: skip
    if compare is not None:
        readers = _two_readers(compare)
        model = {"reader": "llm", "llm": reading.model_settings()}
        rules = {"reader": "rules", "llm": None, "verify": False}
        found = [_run(roots, tests, learned, {**options, **(model if r == "llm" else rules)}) for r in readers]
        comparison = compared(found[0], found[1], readers)
        if as_json:
            emit_json(comparison.to_value())
        else:
            emit(_side_by_side(found, readers, comparison.p))
        return ExitCode.OK if all(r.outcome.passed for results in found for r in results) else ExitCode.TESTS_FAILED
    results = _run(roots, tests, learned, options)
    if as_json:
        emit_json(report(results, reading.reader).to_value())
    else:
        emit(_text(results))
    return ExitCode.OK if all(result.outcome.passed for result in results) else ExitCode.TESTS_FAILED


def _tests(roots: Roots, domain: str | None, cases: Sequence[Path]) -> list[SentenceTest]:
    from tmd.world.sentence_file import domain_sentences, read_sentences

    if bool(domain) == bool(cases):
        raise TmdError("name a domain, or files with --cases", hint="tmd test kitchen")
    if domain:
        return domain_sentences(roots.corpus(roots.folder(domain)).directory)
    return [test for path in cases for test in read_sentences(path)]


def _two_readers(given: str) -> tuple[str, str]:
    names = tuple(name.strip() for name in given.split(","))
    if len(names) != 2 or set(names) - {"rules", "llm"}:
        raise click.UsageError("--compare takes two readers: rules,llm")
    return names[0], names[1]


def _run(
    roots: Roots, tests: Sequence[SentenceTest], learned: Path | None, options: Mapping[str, Any]
) -> list[SentenceResult]:
    """Run the tests, domain after domain; the results are in the order of the tests."""
    from tmd.domain_kit import DomainKit

    found: dict[int, SentenceResult] = {}
    for domain in dict.fromkeys(test.domain for test in tests):
        own = [number for number, test in enumerate(tests) if test.domain == domain]
        kit = DomainKit(roots.corpus(roots.folder(domain)), learned)
        results = kit.run_sentence_tests([tests[number] for number in own], **options)
        found.update(zip(own, results, strict=True))
    return [found[number] for number in range(len(tests))]


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
        lines.append(f"{kind}: {_passed(own)} of {len(own)}")
    lines.append(_total(results))
    return "\n".join(lines) + "\n"


def _passed(results: Sequence[SentenceResult]) -> int:
    return sum(result.outcome.passed for result in results)


def _total(results: Sequence[SentenceResult]) -> str:
    """Return the counts on one line, with the effort of the language model where one was asked."""
    from tmd.evaluation.sentence_tests import summary

    counts = summary(results)
    line = (
        f"{counts.right} of {counts.n - counts.impossible} right, "
        f"{counts.wrong} wrong ({counts.wrong_warned} with a warning), {counts.refused} refused; "
        f"{counts.impossible_refused} of {counts.impossible} impossible ones refused"
    )
    if "seconds" not in counts.model_fields_set:
        return line
    return (
        f"{line}; {counts.prompt_tokens} + {counts.completion_tokens} tokens, {counts.seconds:.1f} s, "
        f"{counts.cached} cached, {counts.corrections} corrected"
    )


def _side_by_side(found: Sequence[Sequence[SentenceResult]], readers: tuple[str, str], p: float) -> str:
    """Return the tests that the readers pass, kind by kind, and the test of the difference."""
    from tmd.evaluation.sentence_tests import by_kind

    first, second = found
    width = max((len(kind) for kind in by_kind(first)), default=3)
    lines = [f"{'':{width}}  {readers[0]:>6}  {readers[1]:>6}  of"]
    others = by_kind(second)
    for kind, own in (*by_kind(first).items(), ("all", first)):
        theirs = others.get(kind, second)
        lines.append(f"{kind:{width}}  {_passed(own):>6}  {_passed(theirs):>6}  {len(own)}")
    lines += [f"{reader}: {_total(results)}" for reader, results in zip(readers, found, strict=True)]
    one, other = (sum(a.outcome.passed and not b.outcome.passed for a, b in zip(x, y, strict=True))
                  for x, y in ((first, second), (second, first)))  # fmt: skip
    lines.append(f"only {readers[0]}: {one}, only {readers[1]}: {other}; McNemar's exact test: p = {p:.4g}")
    return "\n".join(lines) + "\n"
