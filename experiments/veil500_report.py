"""Counts of what a copy of VEIL-500 holds and what is dropped: ``python -m experiments.veil500_report VEIL500``."""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from tmd.datasets.veil500.compile import compile_environment
from tmd.datasets.veil500.data import Point, VeilData, load
from tmd.datasets.veil500.forms import mentioned, veil_domain
from tmd.datasets.veil500.relations import initial_relations, unsupported
from tmd.pddl.forced_execution import ForcedExecution

_WORD = re.compile(r"[a-z0-9']+")


@dataclass(frozen=True, slots=True)
class DataReport:
    """Counts, by section, and remarks that a reader should know.

    Attributes:
        directory: What was checked.
        counts: Section to name to number.
        remarks: One line each; empty for a copy without surprises.
    """

    directory: str
    counts: Mapping[str, Mapping[str, int]]
    remarks: tuple[str, ...] = field(default=())

    def text(self) -> str:
        """Return the report for people."""
        lines = [f"VEIL-500 in {self.directory}"]
        for section, numbers in self.counts.items():
            lines += ["", section]
            width = max((len(name) for name in numbers), default=0)
            lines += [f"  {name:<{width}}  {number:>6}" for name, number in numbers.items()]
        if self.remarks:
            lines += ["", "remarks", *(f"  {remark}" for remark in self.remarks)]
        return "\n".join(lines) + "\n"


def check_veil500(directory: str | Path) -> DataReport:
    """Read a copy of the data set and report everything found and dropped.

    Raises:
        DataError: It cannot be read; see :func:`tmd.datasets.veil500.data.load`.
    """
    data = load(directory)
    counts = {
        "demonstrations": {"points": len(data.points), **_by(data, lambda p: p.world)},
        "by environment": _by(data, lambda p: f"{p.world} {p.environment}"),
        "by objective": _by(data, lambda p: p.objective),
        "texts": _texts(data),
        "actions": _actions(data),
        "verbs": _verbs(data),
        "execution under the literal rules": _execution(data),
        "environments": _environments(data),
        "objects at the start": _placement(data),
    }
    return DataReport(str(directory), counts, _remarks(data))


def words(text: str) -> tuple[str, ...]:
    """Return the words of a text in lower case: what texts are compared by."""
    return tuple(_WORD.findall(text.lower()))


def unknown_objects(data: VeilData) -> list[tuple[Point, str]]:
    """Return every mention of an object that the environment of its demonstration does not have."""
    names = {key: frozenset(environment.names) for key, environment in data.environments.items()}
    return [
        (point, name)
        for point in data.points
        for instruction in point.instructions
        for name in mentioned(instruction)
        if name not in names[point.key]
    ]


def unknown_forms(data: VeilData) -> list[tuple[Point, str]]:
    """Return every action whose verb and number of arguments no rule has."""
    arity = {action.name: len(action.parameters) for action in veil_domain("literal").actions}
    return [
        (point, str(instruction))
        for point in data.points
        for instruction in point.instructions
        if arity.get(instruction.name) != len(instruction.args)
    ]


def _by(data: VeilData, name: Callable[[Point], str]) -> dict[str, int]:
    return dict(sorted(Counter(name(point) for point in data.points).items()))


def _texts(data: VeilData) -> dict[str, int]:
    texts = Counter(words(point.text) for point in data.points)
    places = Counter((point.key, words(point.text)) for point in data.points)
    segments = [segment for point in data.points for segment in point.segments]
    return {
        "distinct": len(texts),
        "occurring once": sum(n == 1 for n in texts.values()),
        "same text in the same environment, groups": sum(n > 1 for n in places.values()),
        "same text in the same environment, points": sum(n for n in places.values() if n > 1),
        "distinct words": len({word for text in texts for word in text}),
        "texts with line breaks": sum("\n" in point.raw or "\r" in point.raw for point in data.points),
        "texts with repeated runs removed": sum(point.repeats_removed > 0 for point in data.points),
        "repeated runs removed": sum(point.repeats_removed for point in data.points),
        "texts without separators": sum("|" not in point.raw for point in data.points),
        "segments": len(segments),
        "segments with words, as written": sum(bool(words(part)) for p in data.points for part in p.raw.split("|")),
        "segments with words, cleaned": sum(segment.has_words for segment in segments),
    }


def _actions(data: VeilData) -> dict[str, int]:
    lengths = [len(point.instructions) for point in data.points]
    groups = [group for point in data.points for group in point.groups]
    actions = Counter(i for point in data.points for i in point.instructions)
    return {
        "actions": sum(lengths),
        "distinct": len(actions),
        "occurring once": sum(n == 1 for n in actions.values()),
        "objects named": len({name for instruction in actions for name in mentioned(instruction)}),
        "longest sequence": max(lengths),
        "points without actions": sum(n == 0 for n in lengths),
        "points with one action": sum(n == 1 for n in lengths),
        "groups": len(groups),
        "empty groups": sum(not group.instructions for group in groups),
        "points with one group": sum(len(point.groups) == 1 for point in data.points),
        "last groups with several segments": sum(len(p.groups[-1].segments) > 1 for p in data.points),
        "mentions of unknown objects": len(unknown_objects(data)),
        "actions of unknown form": len(unknown_forms(data)),
    }


def _verbs(data: VeilData) -> dict[str, int]:
    verbs = Counter(i.name for point in data.points for i in point.instructions)
    return dict(sorted(verbs.items(), key=lambda item: (-item[1], item[0])))


def _execution(data: VeilData) -> dict[str, int]:
    """Execute the demonstrations by force, and count those that can be executed and the steps that cannot."""
    executable = failing = 0
    for key, environment in data.environments.items():
        recorded = [point.instructions for point in data.points if point.key == key]
        instructions = [instruction for sequence in recorded for instruction in sequence]
        simulator = ForcedExecution(compile_environment(environment), instructions)
        failures = [simulator.run(sequence).failures for sequence in recorded]
        executable += sum(not failed for failed in failures)
        failing += sum(map(len, failures))
    return {"points executable": executable, "steps not executable": failing}


def _environments(data: VeilData) -> dict[str, int]:
    environments = data.environments.values()
    dropped = Counter(state for environment in environments for _, state in environment.dropped)
    things = [thing for environment in environments for thing in environment.objects]
    return {
        "environments": len(data.environments),
        "classes": len(data.classes),
        "objects": len(things),
        "objects of a class that is not declared": sum(t.kind not in data.classes for t in things),
        "objects described twice, the first kept": sum(len(e.repeated) for e in environments),
        "placeholder positions, taken from the whole": sum(bool(t.placeholder and t.parent) for t in things),
        "placeholder positions left": sum(t.placeholder and not t.parent for t in things),
        "states dropped, not declared by the class": sum(dropped.values()),
        **{f"dropped {state}": number for state, number in sorted(dropped.items())},
    }


def _placement(data: VeilData) -> dict[str, int]:
    environments = data.environments.values()
    leftovers = [unsupported(environment) for environment in environments]
    return {
        "relations, literal rule": sum(len(initial_relations(e, "literal")) for e in environments),
        "relations, honest rule": sum(len(initial_relations(e, "honest")) for e in environments),
        "on the floor": sum(len(floor) for floor, _ in leftovers),
        "place unknown": sum(len(unknown) for _, unknown in leftovers),
    }


def _remarks(data: VeilData) -> tuple[str, ...]:
    """Return one line for each thing that could not be used as it stands."""
    remarks = [
        f"point {point.index} (line {point.line}): no object '{name}' in {point.world} {point.environment}"
        for point, name in unknown_objects(data)
    ]
    remarks += [
        f"point {point.index} (line {point.line}): no rule for {form}; it will do nothing"
        for point, form in unknown_forms(data)
    ]
    return tuple(remarks)


if __name__ == "__main__":
    print(check_veil500(sys.argv[1]).text(), end="")
