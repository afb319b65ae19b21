"""``tmd test``: sentence tests of a domain's author: does each request end in what was asked?"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tmd.cli.inputs.grounding import learned_option
from tmd.cli.output import emit, emit_json
from tmd.diagnostics import ExitCode, TmdError
from tmd.inference.config import DEFAULT
from tmd.veil.roots import Roots

if TYPE_CHECKING:
    from tmd.evaluation.sentence_tests import SentenceResult, SentenceTest


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
@learned_option
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.pass_obj
def command(
    roots: Roots,
    domain: str | None,
    cases: tuple[Path, ...],
    model_name: str,
    guess: bool,
    learned: Path | None,
    as_json: bool,
) -> ExitCode:
    """Run the sentence tests of a domain, or those of a file.

    A test is a line of JSON: {"id", "domain", "environment", "text", "goal"}; the goal is a PDDL condition that must
    hold at the end of the first plan, or null where the request must be refused. Ends with 1 where a test fails.
    """
    from tmd.evaluation.sentence_tests import report

    results = list(_run(roots, _tests(roots, domain, cases), model_name, guess, learned))
    if as_json:
        emit_json(report(results).to_value())
    else:
        emit(_text(results))
    return ExitCode.OK if all(result.outcome.passed for result in results) else ExitCode.TESTS_FAILED


def _tests(roots: Roots, domain: str | None, cases: Sequence[Path]) -> list[SentenceTest]:
    from tmd.evaluation.sentence_tests import domain_sentences, read_sentences

    if bool(domain) == bool(cases):
        raise TmdError("name a domain, or files with --cases", hint="tmd test kitchen")
    if domain:
        return domain_sentences(roots.corpus(roots.folder(domain)).directory)
    return [test for path in cases for test in read_sentences(path)]


def _run(
    roots: Roots, tests: Sequence[SentenceTest], model: str, guess: bool, learned: Path | None
) -> Iterator[SentenceResult]:
    from tmd.domain_kit import DomainKit

    kits: dict[str, DomainKit] = {}
    for test in tests:
        if test.domain not in kits:
            kits[test.domain] = DomainKit(roots.corpus(roots.folder(test.domain)), learned)
        yield from kits[test.domain].run_sentence_tests([test], model=model, guess=guess)


def _text(results: Sequence[SentenceResult]) -> str:
    """Every failure, then the counts, by kind where the tests have kinds."""
    from tmd.evaluation.sentence_tests import summary

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
    kinds = sorted({kind for result in results for kind in result.test.kinds})
    for kind in kinds:
        own = [result for result in results if kind in result.test.kinds]
        lines.append(f"{kind}: {sum(r.outcome.passed for r in own)} of {len(own)}")
    counts = summary(results)
    doable = counts.n - counts.impossible
    lines.append(
        f"{counts.right} of {doable} right, {counts.wrong} wrong ({counts.wrong_warned} with a warning), "
        f"{counts.refused} refused; {counts.impossible_refused} of {counts.impossible} impossible ones refused"
    )
    return "\n".join(lines) + "\n"
