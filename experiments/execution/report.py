"""Tables of what was executed: in a terminal, and as Markdown for ``docs/results/robot.md``."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from statistics import median

from experiments.execution.record import FAILED, Record, TimedStep

Rows = list[list[str]]

_NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
_SLOWEST = 10
_EXAMPLES = 3
_FAILURES_ON_PAGE = 5
_FAILURES_IN_TERMINAL = 20


def report(records: Sequence[Record], *, markdown: bool) -> str:
    """Return all tables of some runs.

    Args:
        records: The runs.
        markdown: Return tables for a page, with fewer failures and without the slowest instructions; otherwise columns
            for a terminal.
    """
    failures = _FAILURES_ON_PAGE if markdown else _FAILURES_IN_TERMINAL
    shown = _markdown if markdown else _columns
    parts = []
    for mode in sorted({record.mode for record in records}):
        plain = [r for r in records if r.mode == mode and not r.fault]
        hurt = [r for r in records if r.mode == mode and r.fault]
        for title, head, rows in (
            (f"Executed, {mode}", _EXECUTED, executed(plain)),
            (f"With faults injected, {mode}", _INJECTED, injected(hurt)),
            (f"What was claimed, {mode}", _JUDGED, judged([*plain, *hurt])),
            (f"Failures, {mode}", _FAILURES, failed(plain)[:failures]),
            (f"Failures with faults injected, {mode}", _FAILURES, failed(hurt)[:failures]),
            (f"Slowest instructions, {mode}", _SLOW, [] if markdown else slowest(plain)),
        ):
            if rows:
                parts.append(f"{'### ' * markdown}{title}\n\n{shown(head, rows)}")
    repeated = [record.repeated for record in records if record.repeated is not None]
    if repeated:
        parts.append(f"The same trajectory to the byte in a second run: {sum(repeated)} of {len(repeated)} runs.")
    return "\n\n".join(parts)


_EXECUTED = ["task", "runs", "to the end", "recovered", "stopped", "end state", "median s", "most s"]


def executed(records: Sequence[Record]) -> Rows:
    """A row for each task, and one for all: to the end means with every postcondition confirmed."""
    groups: dict[str, list[Record]] = defaultdict(list)
    for record in records:
        groups[record.task].append(record)
    rows = [[task, *_counts(found)] for task, found in sorted(groups.items())]
    return [*rows, ["all", *_counts(records)]] if len(rows) > 1 else rows


def _counts(records: Sequence[Record]) -> list[str]:
    finished = [record for record in records if record.status in ("done", "recovered")]
    seconds = [record.seconds for record in records]
    return [
        str(len(records)),
        f"{len(finished)} ({len(finished) / len(records):.0%})",
        str(sum(record.status == "recovered" for record in records)),
        str(len(records) - len(finished)),
        str(sum(not record.goal for record in finished)),
        f"{median(seconds):.1f}",
        f"{max(seconds):.1f}",
    ]


_JUDGED = ["runs", "claims", "true", "not judged", "false", "measured", "inferred", "assumed", "simulated s / CPU s"]


def judged(records: Sequence[Record]) -> Rows:
    """How many claims the judge found to be true, and by what the effects are known; then each false claim."""
    if not records:
        return []
    true, unjudged = sum(r.judged for r in records), sum(r.unjudged for r in records)
    false = [f"{record.name}: {claim}" for record in records for claim in record.false]
    known = [sum(record.known.get(basis, 0) for record in records) for basis in ("measured", "inferred", "assumed")]
    rates = [record.simulated / record.cpu for record in records if record.cpu and record.status == "done"]
    counts = [len(records), true + unjudged + len(false), true, unjudged, len(false), *known]
    row = [*map(str, counts), f"{median(rates):.1f}" if rates else ""]
    return [row, *([claim, *[""] * (len(row) - 1)] for claim in false)]


_INJECTED = ["fault", "runs", "happened", "seen", "recovered", "stopped, seen", "unseen", "claimed falsely"]


def injected(records: Sequence[Record]) -> Rows:
    """A row for each kind of fault; shares are of the runs in which it happened."""
    groups: dict[str, list[Record]] = defaultdict(list)
    for record in records:
        groups[record.fault].append(record)
    rows = [[kind, *_outcomes(found)] for kind, found in sorted(groups.items())]
    return [*rows, ["all", *_outcomes(records)]] if len(rows) > 1 else rows


def _outcomes(records: Sequence[Record]) -> list[str]:
    happened = [record for record in records if record.faults]
    aware = [record for record in happened if seen(record)]
    recovered = [record for record in aware if record.status == "recovered" and not record.goal]
    return [
        str(len(records)),
        str(len(happened)),
        str(len(aware)),
        f"{len(recovered)} ({len(recovered) / max(1, len(happened)):.0%})",
        str(sum(record.status == "stopped" for record in aware)),
        str(len(happened) - len(aware)),
        str(sum(claimed_falsely(record) for record in happened)),
    ]


def seen(record: Record) -> bool:
    """Whether the monitor noticed something from the instruction on in which the (first) fault came about."""
    if not record.faults:
        return False
    first = min(happening.tick for happening in record.faults)
    return any(step.outcome != "ok" and step.end >= first for step in record.steps)


def claimed_falsely(record: Record) -> bool:
    """Whether success was claimed although the fault went unseen, or the end state does not hold."""
    return record.status in ("done", "recovered") and (bool(record.goal) or (bool(record.faults) and not seen(record)))


_FAILURES = ["skill", "what went wrong", "times", "runs", "ended", "for example"]


@dataclass
class _Failure:
    times: int = 0
    runs: set[str] = field(default_factory=set)
    ended: int = 0


def failed(records: Iterable[Record]) -> Rows:
    """What went wrong, by skill and reason with numbers masked; those that ended most runs first."""
    found: dict[tuple[str, str], _Failure] = defaultdict(_Failure)
    for record in records:
        if record.status == FAILED:
            failure = found["program", masked(record.reason)]
            failure.times, failure.ended = failure.times + 1, failure.ended + 1
            failure.runs.add(record.name)
        wrong = [step for step in record.steps if step.outcome != "ok"]
        for step in wrong:
            failure = found[step.skill, trouble(step)]
            failure.times += 1
            failure.runs.add(record.name)
            failure.ended += record.status == "stopped" and step is wrong[-1]
    ordered = sorted(found.items(), key=lambda pair: (-pair[1].ended, -pair[1].times, pair[0]))
    return [
        [skill, text, str(f.times), str(len(f.runs)), str(f.ended), " ".join(sorted(f.runs)[:_EXAMPLES])]
        for (skill, text), f in ordered
    ]


def trouble(step: TimedStep) -> str:
    """What went wrong in a step, with its numbers masked."""
    return masked(step.failure or f"mismatch: {step.mismatches[0]}")


def masked(text: str) -> str:
    """``text`` with ``#`` for each number, so that texts which differ only in numbers count as one."""
    return re.sub(r"#(?: #)+", "#", _NUMBER.sub("#", text))


_SLOW = ["skill", "instructions", "median s", "most s", "slowest"]


def slowest(records: Iterable[Record]) -> Rows:
    """Seconds of wall-clock time by skill, the slowest first."""
    found: dict[str, list[tuple[float, str]]] = defaultdict(list)
    for record in records:
        for step in record.steps:
            found[step.skill].append((step.took, f"{step.instruction} in {record.name}"))
    rows = []
    for skill, times in sorted(found.items(), key=lambda pair: -max(pair[1])[0])[:_SLOWEST]:
        worst, name = max(times)
        rows.append([skill, str(len(times)), f"{median(t for t, _ in times):.1f}", f"{worst:.1f}", name])
    return rows


def _columns(head: Sequence[str], rows: Rows) -> str:
    widths = [max(len(row[i]) for row in [head, *rows]) for i in range(len(head))]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in [head, *rows]
    )


def _markdown(head: Sequence[str], rows: Rows) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)
