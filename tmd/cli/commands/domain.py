"""``tmd list``, ``new``, ``learn``, ``check``, ``fmt`` and ``compile``: commands for authors of domains."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tmd.cli.errors import fault_of, pointed
from tmd.cli.options import OUTPUT, PATH, VARIABLE, json_option, seed_option
from tmd.cli.output import emit
from tmd.diagnostics import ExitCode, OutputError, TmdError, one_line
from tmd.inference.config import PRESETS
from tmd.world.folder import known_domains
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.check.diagnostic import Diagnostic
    from tmd.check.report import CheckReport
    from tmd.evaluation.learn import LearnedDomain
    from tmd.world.corpus import Corpus
    from tmd.world.scaffold import Scaffold


@click.command("list", short_help="List domains, environments, tasks, models and planners.")
@click.pass_obj
def list_domains(roots: Roots) -> None:
    """List the domains, each with its environments, and the tasks of its demonstrations; then models and planners."""
    from tmd.evaluation.models.model import MODELS
    from tmd.planning.backends import PLANNERS

    for name in known_domains(roots.domains):
        corpus = roots.corpus(roots.folder(name))
        environments, tasks = corpus.environments(), corpus.tasks()
        lines = [name, *(["  environments: " + ", ".join(environments)] if environments else [])]
        lines += ["  tasks: " + ", ".join(tasks)] if tasks else []
        emit("\n".join(lines) + "\n")
    emit(f"models: {', '.join(PRESETS)}\nmodels of experiments: {', '.join(MODELS)}\nplanners: {', '.join(PLANNERS)}\n")


@click.command("new", short_help="Begin a domain of your own: a small one that works.")
@click.argument("domain", metavar="DOMAIN")
@click.option(
    "--from",
    "start",
    default="graph",
    show_default=True,
    metavar="plain|graph|FILE.pddl",
    help="Begin with plain PDDL, with classes of things that have parts, or with your domain.",
)
@click.option("--empty", is_flag=True, help="Begin with a frame: one predicate, one action, no environment.")
@click.pass_obj
def new(roots: Roots, domain: str, start: str, empty: bool) -> None:
    """Begin the domain DOMAIN.

    Writes domains/DOMAIN and problems/DOMAIN here (--domains and --problems say where else): a domain with a lexicon,
    two environments, a problem, three demonstrations and three sentence tests. Of a FILE.pddl, it writes the domain
    and the lexicon that its actions give. Nothing is overwritten.
    """
    from tmd.api import new_domain

    if empty and start != "graph":
        raise click.UsageError("give one of --from and --empty")
    start = "empty" if empty else start
    made = new_domain(domain, start, domains=roots.domains or "domains", problems=roots.problems or "problems")
    emit(_next_steps(domain, start, made) if made.task else _first_steps(domain, made))


def _first_steps(domain: str, made: Scaffold) -> str:
    """Return what to do with a domain that has no environment."""
    lines = [
        *(path.as_posix() for path in made.files),
        "",
        "try next:",
        f"  tmd check {made.folder.as_posix()}",
        f"  tmd check --explain put {domain}",
        f"then write an environment, {made.problems.as_posix()}/environments/{domain}1.pddl, a PDDL problem, and",
        f'  tmd ground {domain}1 "..."',
    ]
    return "\n".join(lines) + "\n"


def _next_steps(domain: str, start: str, made: Scaffold) -> str:
    place = made.environments[-1]
    said = "Put the red block on the green block." if start == "plain" else "Put the key on the table."
    problem = next(path for path in made.files if path.suffix == ".pddl" and path.parent == made.problems)
    compiled = [f"  tmd compile {domain}"] if start == "graph" else []
    lines = [
        *(path.as_posix() for path in made.files),
        "",
        "try next:",
        *compiled,
        f"  tmd check {made.folder.as_posix()} {made.problems.as_posix()}",
        f"  tmd plan {domain} {problem.as_posix()}",
        f'  tmd ground {place} "{said}"',
        f"  tmd test {domain}",
        f"  tmd learn {domain}",
    ]
    return "\n".join(lines) + "\n"


@click.command("learn", short_help="Learn a domain's library, policy and weights from its demonstrations.")
@click.argument("domain", metavar="DOMAIN")
@click.option(
    *OUTPUT,
    "out",
    type=PATH,
    metavar="DIR",
    envvar=VARIABLE,
    help=f"Save in DIR/DOMAIN, for `tmd ground --learned DIR`; ${VARIABLE}, or learned/ beside the demonstrations.",
)
@click.option("--no-weights", is_flag=True, help="Learn no weights, which takes by far the longest.")
@seed_option
@click.pass_obj
def learn(roots: Roots, domain: str, out: Path | None, no_weights: bool, seed: int) -> None:
    """Learn from the demonstrations of DOMAIN, and save it.

    `tmd ground` uses what was saved for as long as the domain, its environments and demonstrations, and tmd itself, are
    what it was learned from; otherwise it learns again each time. The weights are used when asked for:
    `tmd ground --weights learned`.
    """
    from tmd.evaluation.learn import learn_domain

    if not no_weights and sys.stderr.isatty():
        emit("the weights take a while to learn; --no-weights leaves them out\n", error=True)
    corpus = roots.corpus(roots.folder(domain))
    emit(_learned_text(corpus, learn_domain(corpus, out, weights=not no_weights, seed=seed)))


def _learned_text(corpus: Corpus, found: LearnedDomain) -> str:
    library, reward = found.knowledge.library, found.knowledge.reward
    counts = {verb: len(library.templates(verb)) for verb in library.verbs()}
    width = max(map(len, counts), default=0)
    demonstrations = corpus.demonstrations()
    places = sorted({demonstration.environment for demonstration in demonstrations})
    lines = [
        f"{corpus.folder.name}: {len(demonstrations)} demonstrations in {', '.join(places)}",
        f"{sum(counts.values())} templates",
        *(f"  {verb:<{width}}  {counts[verb]:>4}" for verb in sorted(counts, key=lambda verb: (-counts[verb], verb))),
    ]
    if library.unaligned:
        lines.append(f"{len(library.unaligned)} pieces of text with instructions, but without a verb, taught nothing")
    if reward:
        lines.append(f"policy: mean ln P of what was shown {reward.before:.4f} before, {reward.after:.4f} after")
    losses = [point["loss"] for point in found.tuned.curve] if found.tuned else []
    if losses:
        lines.append(f"weights: mean loss of the plans chosen {losses[0]:.4f} before, {min(losses):.4f} after")
    return "\n".join([*lines, f"saved in {found.directory}"]) + "\n"


@click.command("check", short_help="Find faults in domains, problems and their files.")
@click.argument("paths", metavar="PATH...", nargs=-1)
@click.option("--domain", metavar="NAME|FILE", help="The domain of the problems; otherwise it is looked for.")
@click.option("--strict", is_flag=True, help="Treat warnings as errors.")
@click.option("--fix", is_flag=True, help="Apply safe fixes, then check again.")
@click.option("--explain", metavar="VERB", help="Print all that is known of a verb, in the domains that are named.")
@json_option
@click.pass_obj
def check(
    roots: Roots,
    paths: tuple[str, ...],
    domain: str | None,
    strict: bool,
    fix: bool,
    explain: str | None,
    as_json: bool,
) -> ExitCode:
    """Check files and folders, and report every problem with its place and a hint.

    PATH is a file, a folder, or the name of a bundled domain. Ends with 0 where there are no errors, 13 otherwise.
    With --explain nothing is checked; PATH is then the name of a domain, and may be missing.
    """
    if explain is not None:
        if any((domain, strict, fix, as_json)):
            raise click.UsageError("--explain takes domains only")
        from tmd.check.explain import explain as explained

        emit(explained(explain, [roots.corpus(roots.folder(name)) for name in paths]))
        return ExitCode.OK
    if not paths:
        raise click.UsageError("Missing argument 'PATH...'.")
    given = roots.pddl_file(domain) if domain else None
    chosen = [roots.path(path) for path in paths]
    from tmd.check.report import check_paths

    report = check_paths(chosen, domain=given, domains=roots.domains, problems=roots.problems, fix=fix)
    if not report.files:
        where = ", ".join(map(str, paths))
        raise TmdError(
            f"there is nothing to check in {where}", hint="name files of a domain or a problem, or their folder"
        )
    return _print_report(report, strict=strict, as_json=as_json)


def _print_report(report: CheckReport, *, strict: bool, as_json: bool) -> ExitCode:
    """Print what was found; return how the program ends."""
    from tmd.check.diagnostic import Severity

    count = report.counts
    errors, warnings = count[Severity.ERROR], count[Severity.WARNING]
    if as_json:
        emit(_all_json(report))
    else:
        emit("".join(map(_text, report.diagnostics)))
        emit("".join(f"{file}: fixed\n" for file in report.fixed))
        emit(f"{len(report.files)} file(s) checked: {errors} error(s), {warnings} warning(s)\n")
    return ExitCode.FAULTS_FOUND if errors or (strict and warnings) else ExitCode.OK


def _all_json(report: CheckReport) -> dict[str, object]:
    return {
        "files": len(report.files),
        **{f"{severity}s": number for severity, number in report.counts.items()},
        "fixed": [str(file) for file in report.fixed],
        "diagnostics": [_json(diagnostic) for diagnostic in report.diagnostics],
    }


def _text(diagnostic: Diagnostic) -> str:
    head = f"{diagnostic.location}: {diagnostic.severity}[{diagnostic.code}]: {one_line(diagnostic.message)}"
    lines = [head]
    if diagnostic.source is not None:
        lines += pointed(diagnostic.source, diagnostic.location.column)
    if diagnostic.hint:
        lines.append(f"  hint: {one_line(diagnostic.hint)}")
    return "\n".join(lines) + "\n"


def _json(diagnostic: Diagnostic) -> dict[str, object]:
    place = diagnostic.location
    return {
        "file": place.file,
        "line": place.line,
        "column": place.column,
        "severity": str(diagnostic.severity),
        "code": diagnostic.code,
        "message": one_line(diagnostic.message),
        "hint": one_line(diagnostic.hint) if diagnostic.hint else None,
    }


@click.command("fmt", short_help="Format PDDL files.")
@click.argument("paths", metavar="PATH...", nargs=-1, required=True)
@click.option("--check", "only_check", is_flag=True, help="Write nothing; exit with 13 if a file would be reformatted.")
@click.pass_obj
def fmt(roots: Roots, paths: tuple[str, ...], only_check: bool) -> ExitCode:
    """Format files, or all PDDL files of folders; comments and line breaks stay.

    A file with unbalanced parentheses is left as it is and reported; then this ends with 31.
    """
    from tmd.check.checker import files_of
    from tmd.format.files import SUFFIX, format_file

    changed = 0
    failed: list[TmdError] = []
    files = [file for name in paths for file in files_of(roots.path(name)) if file.suffix == SUFFIX]
    for file in files:
        try:
            if format_file(file, write=not only_check):
                changed += 1
                emit(f"{file}: {'would be reformatted' if only_check else 'reformatted'}\n")
        except OutputError:
            raise
        except TmdError as error:
            failed.append(error)
    for fault in failed:
        emit(fault_of(fault).text(), error=True)
    emit(f"{len(files)} file(s): {changed} {'to change' if only_check else 'changed'}, {len(failed)} failed\n")
    if failed:
        return ExitCode.BAD_INPUT
    return ExitCode.FAULTS_FOUND if only_check and changed else ExitCode.OK


@click.command("compile", short_help="Compile object graphs to PDDL.")
@click.argument("what", metavar="DOMAIN|ENVIRONMENT.yaml")
@click.option(*OUTPUT, type=PATH, metavar="FILE", help="Write the PDDL problem to this file.")
@click.option("--goal", metavar="CONDITION", help='The goal of the PDDL problem, such as "(hot pot1)".')
@click.pass_obj
def compile(roots: Roots, what: str, output: Path | None, goal: str | None) -> None:
    """Compile a domain folder to its domain.pddl, or an environment to a PDDL problem.

    The domain.pddl is written into the folder, the problem to standard output.
    """
    if Path(what).suffix in (".yaml", ".yml"):
        _environment(roots, Path(what), output, goal)
        return
    if output or goal:
        raise click.UsageError("--output and --goal are for environments")

    from tmd.world.compile import update_domain

    folder = roots.sources(what)
    emit(f"{folder.path / 'domain.pddl'} {'written' if update_domain(folder) else 'was up to date'}\n")


def _environment(roots: Roots, path: Path, output: Path | None, goal: str | None) -> None:
    from tmd.pddl.reading.reader import with_goal
    from tmd.pddl.writer import format_problem
    from tmd.world.compile import compile_problem
    from tmd.world.environment import load_environment

    environment = load_environment(path)
    problem = compile_problem(environment, roots.folder(environment.domain))
    emit(format_problem(with_goal(problem, goal) if goal else problem), output)
