"""The formats by name, and the files that each of them consists of."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias

from tmd.diagnostics import TmdError
from tmd.export.planned_problem import Planned
from tmd.export.strips import Strips
from tmd.pddl.plan_file import format_plan
from tmd.pddl.reading.syntax import nearest
from tmd.pddl.writer import format_domain, format_problem

# File names with contents.
Texts: TypeAlias = Mapping[str, str]


def _adl(source: Planned) -> Texts:
    domain, problem = format_domain(source.portable.domain), format_problem(source.portable)
    return {"domain.pddl": domain, "problem.pddl": problem, **_ipc(source)}


def _ipc(source: Planned) -> Texts:
    return {"plan.plan": format_plan(source.plan, source.cost, unit=not source.problem.minimize_cost)}


def _strips(source: Planned) -> Texts:
    from tmd.export.strips import strips

    found = strips(source)
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
        "domain.pddl": format_durative_domain(source.portable.domain),
        "problem.pddl": format_durative_problem(source.portable),
        "plan.plan": format_temporal(source.plan),
    }


def _plansys2(source: Planned) -> Texts:
    from tmd.export.durative import format_durative_domain, format_durative_problem, format_popf
    from tmd.export.strips import strips

    found = strips(source, typed=True)
    domain = format_durative_domain(found.problem.domain)
    return {
        "domain.pddl": _with_origins(domain, found, "durative-action"),
        "problem.pddl": format_durative_problem(found.problem),
        "plan.plan": format_popf(found.plan),
    }


def _tree(source: Planned) -> Texts:
    from tmd.export.behavior_tree import format_tree

    return {"tree.xml": format_tree(source)}


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
}


def chosen_files(source: Planned, names: Sequence[str]) -> dict[str, bytes]:
    """Return the files of each format by path, in a directory each if there are several formats.

    Raises:
        TmdError: There is no such format, or one cannot say the problem.
    """
    wanted = {name: _format(name) for name in names}
    return {
        f"{name}/{path}" if len(wanted) > 1 else path: text.encode("utf-8")
        for name, make in wanted.items()
        for path, text in make(source).items()
    }


def _format(name: str) -> Callable[[Planned], Texts]:
    if name not in FORMATS:
        hint = nearest(name, list(FORMATS)) or f"there are {', '.join(FORMATS)}"
        raise TmdError(f"there is no format '{name}'", hint=hint)
    return FORMATS[name]
