"""Execute the gold demonstrations of a domain in simulation, and count what came of it.

    python -m experiments.execution --out runs/execution
    python -m experiments.execution --out runs/execution --physics --each 1
    python -m experiments.execution --out runs/execution --faults all --every 5
    python -m experiments.execution --out runs/execution --report
    python -m experiments.execution --out runs/execution --page docs/results/robot.md

Each run is a line of DIR/runs.jsonl, written when the run ends. What is there already is not done again, so an
experiment that was interrupted goes on where it was; remove the file to begin again.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from experiments.execution.cases import ALL, ONE, demonstrations, goals, plans, requests, with_faults
from experiments.execution.record import FAILED, Case, Record, append, read
from experiments.execution.report import report
from experiments.execution.run import corpus, planned, run, skills_of
from tmd.diagnostics import ExitCode, TmdError
from tmd.files import make_directory, write_text
from tmd.pddl.reading.syntax import read_text
from tmd.robot.monitor.executor import MOST_REPAIRS

OPENING, CLOSING = "<!-- tables -->", "<!-- end of tables -->"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run what is missing and print the tables; the exit code."""
    asked = _parser().parse_args(arguments)
    try:
        if not asked.report and asked.page is None:
            _execute(asked)
        records = read(asked.out)
        if not records:
            raise TmdError(f"there are no runs in {asked.out}")
        if asked.page is not None:
            _put(asked.page, report(records, markdown=True))
            return ExitCode.OK
    except TmdError as error:
        print(f"error: {error}", file=sys.stderr)
        return ExitCode.BAD_INPUT
    except KeyboardInterrupt:
        print("stopped; the same command goes on from here", file=sys.stderr)
        return ExitCode.INTERRUPTED
    print(report(records, markdown=asked.report))
    return ExitCode.INTERNAL if any(record.status == FAILED for record in records) else ExitCode.OK


def _parser() -> argparse.ArgumentParser:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(
        prog="python -m experiments.execution",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("--out", type=Path, required=True, metavar="DIR", help="where the runs are written")
    add("--domain", default="kitchen", help="default: kitchen")
    add("--tasks", type=_names, default=(), metavar="A,B", help="only demonstrations of these tasks")
    add("--environments", type=_names, default=(), metavar="A,B", help="only these environments")
    add("--every", type=_positive, default=1, metavar="N", help="only each Nth demonstration")
    add("--each", type=_positive, metavar="N", help="at most N demonstrations of one task in one environment")
    add("--plan", action="append", default=[], metavar="ENV=FILE", help="this plan; may be given more than once")
    add("--goals", type=Path, metavar="FILE", help="these goals instead: JSON Lines with name, environment and goal")
    add("--requests", type=Path, nargs="+", metavar="FILE", help="plans of sentence tests instead, drawn by the seed")
    add("--draw", type=_positive, default=60, metavar="N", help="so many requests; default 60")
    add("--physics", action="store_true", help="under physics, not kinematically")
    add("--faults", type=_names, default=(), metavar="KIND", help=f"inject faults: kinds, '{ALL}', or '{ONE}' a run")
    add("--seed", type=int, default=0, metavar="S", help="of everything random; 0, the default: exact places")
    add(
        "--repairs",
        type=int,
        default=MOST_REPAIRS,
        metavar="N",
        help=f"maximum number of times the executor replans; default {MOST_REPAIRS}",
    )
    add("--twice", action="store_true", help="run each two times, and compare the trajectories to the byte")
    add("--jobs", type=_positive, default=1, metavar="N", help="so many processes")
    add("--report", action="store_true", help="run nothing; print the tables of DIR as Markdown")
    add("--page", type=Path, metavar="FILE", help="run nothing; put the tables of DIR into this page")
    return parser


def _execute(asked: argparse.Namespace) -> None:
    """Run the cases that are not done yet."""
    found = corpus(asked.domain)
    blank = Case("", asked.domain, "", "", (), (), asked.physics, "", asked.seed, asked.repairs, asked.twice)
    chosen = {"tasks": asked.tasks, "environments": asked.environments, "every": asked.every, "each": asked.each}
    if asked.goals is not None:
        cases = goals(asked.goals, blank)[:: asked.every]
    elif asked.requests is not None:
        cases = requests(asked.requests, asked.draw, blank)
    else:
        cases = list(plans(found, blank, asked.plan)) or demonstrations(found, blank, **chosen)
    if asked.faults:
        cases = with_faults([planned(case) for case in cases], asked.faults, skills_of(asked.domain))
    directory = make_directory(asked.out)
    done = {record.key for record in read(directory)}
    waiting = [case for case in cases if case.key not in done]
    print(f"{len(cases)} runs, {len(cases) - len(waiting)} of them done before", file=sys.stderr)
    from joblib import Parallel, delayed

    runs = Parallel(n_jobs=asked.jobs, batch_size=1, return_as="generator_unordered")(
        delayed(run)(case) for case in waiting
    )
    for number, record in enumerate(runs, start=1):
        append(directory, record)
        print(f"{number}/{len(waiting)} {_line(record)}", file=sys.stderr, flush=True)


def _put(page: Path, tables: str) -> None:
    """Put tables between the marks of a page."""
    text = read_text(page)
    before, opening, rest = text.partition(OPENING)
    _, closing, after = rest.partition(CLOSING)
    if not opening or not closing:
        raise TmdError(f"{page} has no place for tables", hint=f"write the lines {OPENING} and {CLOSING} into it")
    write_text(page, f"{before}{opening}\n\n{tables}\n\n{closing}{after}")


def _line(record: Record) -> str:
    said = " ".join(filter(None, (record.mode, record.fault, record.status)))
    false = f", {len(record.false)} false" if record.false else ""
    return f"{record.name} {said}{false}, {record.cpu:.1f} s{': ' * bool(record.reason)}{record.reason}"


def _names(text: str) -> tuple[str, ...]:
    return tuple(name.strip() for name in text.split(",") if name.strip())


def _positive(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text} is less than 1")
    return number


if __name__ == "__main__":
    sys.exit(main())
