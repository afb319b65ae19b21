"""The formats by name, and the files that each of them consists of."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from tmd.diagnostics import TmdError
from tmd.export.names import Renames
from tmd.export.planned_problem import Planned
from tmd.export.strips import Strips
from tmd.pddl.reading.syntax import nearest
from tmd.pddl.writer import format_domain, format_plan, format_problem

# File names with contents.
Files: TypeAlias = Mapping[str, bytes]
Texts: TypeAlias = Mapping[str, str]


def _adl(source: Planned) -> Texts:
    found = source.accepted
    return {
        "domain.pddl": format_domain(found.portable.domain),
        "problem.pddl": format_problem(found.portable),
        **_ipc(found),
    }


def _ipc(source: Planned) -> Texts:
    return {"plan.plan": format_plan(source.plan, source.cost, unit=not source.problem.minimize_cost)}


def _strips(source: Planned) -> Texts:
    from tmd.export.strips import strips

    found = strips(source.accepted)
    steps = "".join(f"; {found.instructions[step.name].pddl()}\n{step.pddl()}\n" for step in found.plan)
    return {
        "domain.pddl": _with_origins(format_domain(found.problem.domain), found),
        "problem.pddl": format_problem(found.problem),
        "plan.plan": f"{steps}; cost = {len(found.plan)} (unit cost)\n",
    }


def _with_origins(text: str, found: Strips, keyword: str = "action") -> str:
    """Return the text of a domain with the instruction before each action that was made of it."""
    for action in found.problem.domain.actions:
        head = f"  (:{keyword} {action.name}\n"
        text = text.replace(head, f"  ; {found.instructions[action.name].pddl()}\n{head}")
    return text


def _durative(source: Planned) -> Texts:
    from tmd.export.durative import format_durative_domain, format_durative_problem, format_temporal

    return {
        "domain.pddl": format_durative_domain(source.accepted.portable.domain),
        "problem.pddl": format_durative_problem(source.accepted.portable),
        "plan.plan": format_temporal(source.accepted.plan),
    }


def _plansys2(source: Planned) -> Texts:
    from tmd.export.durative import format_durative_domain, format_durative_problem, format_popf
    from tmd.export.strips import strips

    found = strips(source.accepted, typed=True)
    domain = format_durative_domain(found.problem.domain)
    return {
        "domain.pddl": _with_origins(domain, found, "durative-action"),
        "problem.pddl": format_durative_problem(found.problem),
        "plan.plan": format_popf(found.plan),
    }


def _tree(source: Planned) -> Texts:
    from tmd.export.behavior_tree import format_tree

    return {"tree.xml": format_tree(source)}


def _sas(source: Planned) -> Texts:
    from tmd.planning.fast_downward import translated

    return {"output.sas": translated(source.problem), "sas_plan": _ipc(source)["plan.plan"]}


# Formats in which names keep: programs read the plan beside the problem as it is, or have no such rules.
_UNCHANGED = frozenset({"ipc", "bt", "sas"})
# What is written where no format is asked for.
DEFAULT = "adl"

# Every format by its name, in the order in which they are documented: it makes the texts of its files.
FORMATS: Mapping[str, Callable[[Planned], Texts]] = {
    "adl": _adl,
    "ipc": _ipc,
    "strips": _strips,
    "durative": _durative,
    "plansys2": _plansys2,
    "bt": _tree,
    "sas": _sas,
}


@dataclass(frozen=True, slots=True)
class ChosenFiles:
    """Result of an export.

    Attributes:
        files: The files of each format that could be written, by path within one directory.
        failures: Why each other one could not.
        renames: The names that other tools refuse, by the kind of what they name, with those that were written.
    """

    files: Mapping[str, Files]
    failures: Mapping[str, TmdError]
    renames: Renames


def chosen_files(source: Planned, names: Sequence[str]) -> ChosenFiles:
    """Return the files of each format, in a directory each if there are several; failures do not stop the others.

    Raises:
        TmdError: There is no such format.
    """
    wanted = {name: _format(name) for name in names}
    files: dict[str, Files] = {}
    failures: dict[str, TmdError] = {}
    for name, make in wanted.items():
        prefix = f"{name}/" if len(wanted) > 1 else ""
        try:
            files[name] = {prefix + path: text.encode("utf-8") for path, text in make(source).items()}
        except TmdError as error:
            failures[name] = error
    return ChosenFiles(files, failures, source.renames if files.keys() - _UNCHANGED else {})


def _format(name: str) -> Callable[[Planned], Texts]:
    if name not in FORMATS:
        hint = nearest(name, list(FORMATS)) or f"there are {', '.join(FORMATS)}"
        raise TmdError(f"there is no format '{name}'", hint=hint)
    return FORMATS[name]
