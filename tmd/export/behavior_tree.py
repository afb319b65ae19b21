"""A plan as a behaviour tree for BehaviorTree.CPP 4.

The tree is a sequence with a sequence for each instruction: a condition (what the instruction needs), the action, a
condition (what it changes); at the end the goal is checked. A robot that executes it therefore stops
where the world is not as the plan has it. Conditions are ground PDDL literals, joined by ``;`` as lists of ports
are in BehaviorTree.CPP: ``near pr2 cup1;not hidden cup1``.

The nodes to be written in C++ are one action for each instruction name, with one port for each parameter, and the
condition ``Holds``, with the port ``literals``. They are declared in ``TreeNodesModel``, which the editor Groot reads.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence

from tmd.export.planned_problem import Planned
from tmd.export.strips import Checked, checked_steps
from tmd.pddl.model import ActionSchema, GroundAtom
from tmd.pddl.semantics import schema_of

# The node that checks literals; it has the port ``literals``.
CONDITION = "Holds"
_TREE = "MainTree"
# Attributes that mean something else in BehaviorTree.CPP; it refuses ports of these names in any case.
_RESERVED = {"id", "name"}


def format_tree(source: Planned) -> str:
    """Return the XML of the tree.

    Raises:
        TmdError: The problem cannot be ground.
    """
    steps, goal = checked_steps(source)
    root = ET.Element("root", BTCPP_format="4", main_tree_to_execute=_TREE)
    tree = ET.SubElement(root, "BehaviorTree", ID=_TREE)
    top = ET.SubElement(tree, "Sequence", name=source.problem.name)
    for number, step in enumerate(steps, start=1):
        _step(top, number, step, source)
    if goal:
        _holds(top, "the goal", goal)
    if not len(top):
        ET.SubElement(top, "AlwaysSuccess")  # a sequence of nothing is refused
    root.append(_models(source))
    ET.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ET.tostring(root, encoding="unicode")}\n'


def _step(top: ET.Element, number: int, step: Checked, source: Planned) -> None:
    instruction = step.instruction
    sequence = ET.SubElement(top, "Sequence", name=f"{number} {instruction}")
    if step.before:
        _holds(sequence, "before", step.before)
    ports = _ports(schema_of(source.problem, instruction))
    ET.SubElement(sequence, "Action", {"ID": instruction.name, **dict(zip(ports, instruction.args, strict=True))})
    if step.after:
        _holds(sequence, "after", step.after)


def _holds(parent: ET.Element, name: str, literals: Iterable[tuple[GroundAtom, bool]]) -> None:
    text = ";".join(_literal(atom, positive) for atom, positive in literals)
    ET.SubElement(parent, "Condition", ID=CONDITION, name=name, literals=text)


def _literal(atom: GroundAtom, positive: bool) -> str:
    words = " ".join((atom.predicate, *atom.args))
    return words if positive else f"not {words}"


def _ports(action: ActionSchema) -> list[str]:
    """Return the port of each parameter: its name, with ``_`` after names that BehaviorTree.CPP reserves."""
    names = [p.name.removeprefix("?") for p in action.parameters]
    return [f"{name}_" if name in _RESERVED else f"p{name}" if not name[0].isalpha() else name for name in names]


def _models(source: Planned) -> ET.Element:
    models = ET.Element("TreeNodesModel")
    used = {instruction.name for instruction in source.plan}
    for action in source.problem.domain.actions:
        if action.name in used:
            _model(models, "Action", action.name, _ports(action))
    _model(models, "Condition", CONDITION, ["literals"])
    return models


def _model(models: ET.Element, kind: str, identifier: str, ports: Sequence[str]) -> None:
    model = ET.SubElement(models, kind, ID=identifier)
    for port in ports:
        ET.SubElement(model, "input_port", name=port, type="std::string")
