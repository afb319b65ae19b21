"""A problem of unified-planning as one of ours: the way back from :mod:`tmd.export.to_unified`."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from typing import Any, TypeAlias

from tmd.diagnostics import TmdError
from tmd.pddl.model import (
    OBJECT,
    TOTAL_COST,
    TRUE,
    ActionSchema,
    And,
    Atom,
    Domain,
    Effect,
    Equals,
    Exists,
    Forall,
    Formula,
    GroundAtom,
    Imply,
    Not,
    Or,
    Predicate,
    Problem,
    TypeDeclaration,
    TypedName,
)
from tmd.pddl.reading.checking import check_problem, used_requirements

# Something of unified-planning, which ships no types.
_Outside: TypeAlias = Any
_NAME = re.compile(r"[a-z][a-z0-9_-]*")


def from_unified_planning(problem: _Outside, *, domain: str | None = None) -> Problem:
    """Return a ``unified_planning.model.Problem`` as one of ours.

    Names are taken over in lower case. Objects that an action names become constants.

    Args:
        problem: A classical problem: fluents are true or false, effects may be conditional and universal, and
            ``MinimizeActionCosts`` may be minimised.
        domain: The name of the domain, which unified-planning does not know; the problem's own name by default.

    Raises:
        TmdError: The problem has what we do not support, or a name that PDDL does not allow.
    """
    return _Reader(problem, domain).problem()


class _Reader:
    def __init__(self, problem: _Outside, domain: str | None) -> None:
        self.source = problem
        self.domain_name = _named(domain or problem.name or "problem")
        self.mentioned: set[str] = set()
        self.costs = self.action_costs()

    def problem(self) -> Problem:
        self.refuse_the_unsupported()
        numeric = [f for f in self.source.fluents if not f.type.is_bool_type()]
        actions = tuple(self.action(action) for action in self.source.actions)
        objects = [TypedName(_named(o.name), (_type(o.type),)) for o in self.source.all_objects]
        domain = Domain(
            self.domain_name,
            (),
            tuple(TypeDeclaration(_type(t), _type(t.father)) for t in self.source.user_types if _type(t) != OBJECT),
            tuple(o for o in objects if o.name in self.mentioned),
            tuple(_signature(f) for f in self.source.fluents if f.type.is_bool_type()),
            (*([Predicate(TOTAL_COST)] if self.costs is not None else []), *map(_signature, numeric)),
            actions,
        )
        values = self.source.initial_values.items()
        found = Problem(
            _named(self.source.name or "problem"),
            domain,
            tuple(o for o in objects if o.name not in self.mentioned),
            frozenset(self.ground(f) for f, value in values if value.is_bool_constant() and value.is_true()),
            And(tuple(self.formula(goal) for goal in self.source.goals)),
            {self.ground(f): _integer(value) for f, value in values if not value.is_bool_constant()},
            self.costs is not None,
        )
        return self.checked(found)

    def checked(self, found: Problem) -> Problem:
        requirements = used_requirements(found.domain, found)
        complete = replace(found, domain=replace(found.domain, requirements=requirements))
        for fault in check_problem(complete):
            raise fault
        return complete

    def refuse_the_unsupported(self) -> None:
        source = self.source
        for what, there in (
            ("durative actions", any(source.durative_actions)),
            ("timed effects", source.timed_effects),
            ("timed goals", source.timed_goals),
            ("trajectory constraints", source.trajectory_constraints),
            ("processes", source.processes),
            ("events", source.events),
        ):
            if there:
                raise TmdError(f"the problem '{source.name}' has {what}, which are not supported")

    def action_costs(self) -> dict[str, _Outside] | None:
        metrics = self.source.quality_metrics
        if not metrics or type(metrics[0]).__name__ == "MinimizeSequentialPlanLength":
            return None
        if len(metrics) > 1 or type(metrics[0]).__name__ != "MinimizeActionCosts":
            raise TmdError(f"the metric {type(metrics[0]).__name__} is not supported", hint="use MinimizeActionCosts")
        chosen = metrics[0]
        return {a.name: chosen.get_action_cost(a) for a in self.source.actions}

    def action(self, action: _Outside) -> ActionSchema:
        needs = tuple(self.formula(part) for part in action.preconditions)
        return ActionSchema(
            _named(action.name),
            tuple(_parameter(p) for p in action.parameters),
            needs[0] if len(needs) == 1 else And(needs),
            tuple(self.effect(effect) for effect in action.effects),
            self.cost(action),
        )

    def cost(self, action: _Outside) -> int | Atom | None:
        cost = (self.costs or {}).get(action.name)
        if cost is None:
            return None
        return self.atom(cost) if cost.is_fluent_exp() else _integer(cost)

    def effect(self, effect: _Outside) -> Effect:
        if not effect.is_assignment() or not effect.value.is_bool_constant():
            raise TmdError(f"the effect {effect} is not supported", hint="effects set a fluent to true or false")
        condition = self.formula(effect.condition) if effect.is_conditional() else TRUE
        parameters = tuple(_parameter(v) for v in effect.forall)
        return Effect(self.atom(effect.fluent), effect.value.is_true(), condition, parameters)

    def formula(self, node: _Outside) -> Formula:
        if node.is_fluent_exp():
            return self.atom(node)
        if node.is_bool_constant():
            return TRUE if node.is_true() else Or()
        if node.is_equals():
            return Equals(self.term(node.arg(0)), self.term(node.arg(1)))
        if node.is_forall() or node.is_exists():
            kind = Forall if node.is_forall() else Exists
            return kind(tuple(_parameter(v) for v in node.variables()), self.formula(node.arg(0)))
        return self.connective(node)

    def connective(self, node: _Outside) -> Formula:
        if not (node.is_not() or node.is_and() or node.is_or() or node.is_implies() or node.is_iff()):
            raise TmdError(f"the condition {node} is not supported", hint="conditions are of predicates and =")
        parts = tuple(self.formula(part) for part in node.args)
        if node.is_not():
            return Not(parts[0])
        if node.is_implies():
            return Imply(parts[0], parts[1])
        if node.is_iff():
            return And((Imply(parts[0], parts[1]), Imply(parts[1], parts[0])))
        return And(parts) if node.is_and() else Or(parts)

    def atom(self, node: _Outside) -> Atom:
        return Atom(_named(node.fluent().name), tuple(self.term(a) for a in node.args))

    def ground(self, node: _Outside) -> GroundAtom:
        return GroundAtom(_named(node.fluent().name), tuple(_named(a.object().name) for a in node.args))

    def term(self, node: _Outside) -> str:
        if node.is_parameter_exp():
            return f"?{_named(node.parameter().name)}"
        if node.is_variable_exp():
            return f"?{_named(node.variable().name)}"
        if node.is_object_exp():
            name = _named(node.object().name)
            self.mentioned.add(name)
            return name
        raise TmdError(f"the term {node} is not supported", hint="terms are parameters, variables and objects")


def _named(name: str) -> str:
    plain = name.lower()
    if not _NAME.fullmatch(plain):
        raise TmdError(f"'{name}' is not a name in PDDL", hint="names have letters, digits, _ and -, a letter first")
    return plain


def _type(usertype: _Outside) -> str:
    return OBJECT if usertype is None else _named(usertype.name)


def _parameter(parameter: _Outside) -> TypedName:
    return TypedName(f"?{_named(parameter.name)}", (_type(parameter.type),))


def _signature(fluent: _Outside) -> Predicate:
    return Predicate(_named(fluent.name), _signature_parameters(fluent.signature))


def _signature_parameters(parameters: Iterable[_Outside]) -> tuple[TypedName, ...]:
    return tuple(_parameter(p) for p in parameters)


def _integer(value: _Outside) -> int:
    number = value.constant_value() if value.is_constant() else None
    if number is None or number != int(number):
        raise TmdError(f"the value {value} is not supported", hint="costs are whole numbers")
    return int(number)
