"""Relations between things at the start: VEIL-500 gives positions only.

``literal`` is the rule of the released code, which measures in the plane of width and *height* and so puts a
kettle on a burner that it is far from. Scores that are to be compared need it. ``honest`` looks at the
positions as a person would; it is for planning.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple, TypeAlias

from tmd.datasets.veil500.environment import KITCHEN, VeilEnvironment, VeilObject
from tmd.diagnostics import TmdError

RelationRule: TypeAlias = Literal["literal", "honest"]
"""How the relations at the start are found."""

LITERAL_REACH = 25.0
"""The literal rule places a thing on the nearest support if it is nearer than this."""


class VeilRelation(NamedTuple):
    """``thing`` is ``on`` or ``in`` ``place`` (PDDL constants), all by VEIL name."""

    thing: str
    kind: str
    place: str


class _Support(NamedTuple):
    """The space of things on furniture: at most ``radius`` away seen from above, between two heights over it."""

    name: str
    radius: float
    low: float
    high: float


_SUPPORTS = (
    _Support("CoffeeTable", 23, 8, 11),
    _Support("SnackTable", 13, 11, 19),
    _Support("Studytable", 15, 11, 13),
    _Support("TvTable", 36, 5, 7),
    _Support("Loveseat", 22, 1, 9),
    _Support("Armchair", 12, 1, 9),
    _Support("Shelf_1", 23, 1, 19),
    _Support("Shelf_2", 40, 1, 19),
)
"""By class or by name. Positions are of centres, so each kind of furniture has its own heights."""

_BAG_HIGH = 23.0
"""A bag of chips stands higher above a coffee table than other things do."""

_SLACK = 0.5
"""The limits above are rounded; half a unit (1 cm) takes the rounding back."""

_FLOOR = -23.0
"""Below this height a thing of the living room lies on the floor."""

_ON_FLOOR = frozenset({"GarbageBag", "GarbageBin"})
"""Classes whose centre is high although they stand on the floor."""


def initial_relations(environment: VeilEnvironment, rule: RelationRule = "literal") -> tuple[VeilRelation, ...]:
    """Return the relations at the start, in file order of the things.

    Raises:
        TmdError: The rule has another name.
    """
    if rule == "literal":
        return _literal(environment)
    if rule == "honest":
        if environment.world != KITCHEN:
            return _living_room(environment)[0]
        found = (_in_kitchen(thing, environment) for thing in _graspable(environment))
        return tuple(relation for relation in found if relation is not None)
    raise TmdError(f"no rule '{rule}' for relations", hint="choose literal or honest")


def unsupported(environment: VeilEnvironment) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the honest rule's leftovers: things on the floor, and things whose support cannot be told."""
    return ((), ()) if environment.world == KITCHEN else _living_room(environment)[1:]


def _graspable(environment: VeilEnvironment) -> list[VeilObject]:
    return [thing for thing in environment.objects if "IsGraspable" in thing.affordances]


def _literal(environment: VeilEnvironment) -> tuple[VeilRelation, ...]:
    places = [
        place
        for place in environment.objects
        if place.affordances & {"IsPlaceableOn", "IsPlaceableIn"} and not place.name.startswith(("Microwave", "Sink"))
    ]
    found = []
    for thing in _graspable(environment):
        distances = [
            math.hypot(thing.position.x - place.position.x, thing.position.y - place.position.y) for place in places
        ]
        if distances and min(distances) < LITERAL_REACH:
            place = places[distances.index(min(distances))]
            kind = "on" if "IsPlaceableOn" in place.affordances else "in"
            found.append(VeilRelation(thing.name, kind, place.name))
    return tuple(found)


def _plan(a: VeilObject, b: VeilObject) -> float:
    """Return the distance seen from above."""
    return math.hypot(a.position.x - b.position.x, a.position.z - b.position.z)


def _in_kitchen(thing: VeilObject, environment: VeilEnvironment) -> VeilRelation | None:
    named = environment.by_name
    fridge, door, sink = named.get("Fridge"), named.get("MicrowaveDoor"), named.get("Sink")
    if fridge is not None:
        offset = abs(thing.position.x - fridge.position.x), abs(thing.position.z - fridge.position.z)
        if max(offset) <= 25:
            return VeilRelation(thing.name, "in", fridge.name)
    if door is not None and "Microwave" in named and math.dist(thing.position, door.position) < 8:
        return VeilRelation(thing.name, "in", "Microwave")
    for fire in environment.objects:
        if fire.kind == "StoveFire" and _plan(thing, fire) < 8:
            return VeilRelation(thing.name, "on", fire.name)
    if sink is not None and _plan(thing, sink) < 12:
        return VeilRelation(thing.name, "on", sink.name)
    counters = [place for place in environment.objects if place.kind == "Counter"]
    if not counters:
        return None
    return VeilRelation(thing.name, "on", min(counters, key=lambda counter: _plan(thing, counter)).name)


def _living_room(
    environment: VeilEnvironment,
) -> tuple[tuple[VeilRelation, ...], tuple[str, ...], tuple[str, ...]]:
    found: list[VeilRelation] = []
    floor: list[str] = []
    unknown: list[str] = []
    for thing in _graspable(environment):
        places = [place for place in environment.objects if place is not thing and _rests(thing, place)]
        if places:
            nearest = min(places, key=lambda place: _plan(thing, place))
            found.append(VeilRelation(thing.name, "on", nearest.name))
        elif thing.position.y < _FLOOR or thing.kind in _ON_FLOOR:
            floor.append(thing.name)
        else:
            unknown.append(thing.name)
    return tuple(found), tuple(floor), tuple(unknown)


def _rests(thing: VeilObject, place: VeilObject) -> bool:
    """Return whether a thing of the living room stands on a piece of furniture, judged by positions."""
    for support in _SUPPORTS:
        if support.name in (place.kind, place.name):
            above = thing.position.y - place.position.y
            high = _BAG_HIGH if support.name == "CoffeeTable" and thing.kind == "BagOfChips" else support.high
            near = _plan(thing, place) <= support.radius + _SLACK
            return near and support.low - _SLACK <= above <= high + _SLACK
    return False
