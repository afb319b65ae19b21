"""``skills.yaml`` of a domain: which skill does which action, and which sensor sees which predicate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

from pydantic import BaseModel, ConfigDict, Field

from tmd.diagnostics import TmdError
from tmd.pddl.model import Domain, Instruction
from tmd.pddl.reading.syntax import Report, nearest
from tmd.world.folder import DomainFolder
from tmd.world.yaml_positions import YamlSource

SkillName: TypeAlias = Literal[
    "look", "drive", "pick", "drop", "place", "open", "close", "push", "rotate", "dip", "tip", "squeeze", "wait"
]
Sensor: TypeAlias = Literal["held", "one_hand", "two_hands", "support", "joint", "setting"]
Confirmation: TypeAlias = Literal["reach"]

# Number of arguments of a predicate for each sensor.
_ARITY = {"held": 2, "one_hand": 1, "two_hands": 1, "support": 3, "joint": 1, "setting": 2, "reach": 2}
# Roles that a skill needs; other skills need an object.
_NEEDS: dict[str, tuple[str, ...]] = {
    "place": ("object", "target", "relation"),
    "rotate": ("object", "setting"),
    "dip": ("object", "target"),
    "tip": ("object", "target"),
    "squeeze": ("object", "target"),
    "wait": (),
}
_ROLES = ("object", "target", "relation", "setting")


class SkillEntry(BaseModel):
    """One action's skill; each role is a parameter of the action (without its ``?``) or a constant of the domain."""

    model_config = ConfigDict(defer_build=True, extra="forbid")
    skill: SkillName
    object: str | None = None
    target: str | None = None
    relation: str | None = None
    setting: str | None = None
    seconds: float = 2.0
    # read by tmd.world.costs as well
    cost: int = Field(default=1, strict=True, ge=0)


class Exposure(BaseModel):
    """A fact that follows from another one (predicate ``to``) about the same thing, after some seconds."""

    model_config = ConfigDict(defer_build=True, extra="forbid", frozen=True)
    to: str
    seconds: float = 2.0


Rule: TypeAlias = Literal["event", "contents"] | Exposure


class SkillsFile(BaseModel):
    """The whole of ``skills.yaml``."""

    model_config = ConfigDict(defer_build=True, extra="forbid")
    skills: dict[str, SkillEntry]
    seen: dict[str, Sensor] = {}
    confirmed: dict[str, Confirmation] = {}
    derived: list[str] = []
    inferred: dict[str, Rule] = {}
    signs: list[str] = []
    contents: str | None = None


@dataclass(frozen=True, slots=True)
class SkillTask:
    """The task of a skill: the thing, its target and relation (``on``, ``in``, ``next_to``), a knob's setting, time."""

    skill: SkillName
    object: str = ""
    target: str = ""
    relation: str = ""
    setting: str = ""
    seconds: float = 2.0


@dataclass(frozen=True, slots=True)
class Skills:
    """``skills.yaml``, checked against its domain."""

    entries: Mapping[str, SkillEntry]
    seen: Mapping[str, Sensor]
    confirmed: Mapping[str, Confirmation]
    derived: frozenset[str]
    inferred: Mapping[str, Rule]
    signs: tuple[str, ...]
    contents: str | None
    domain: Domain

    def task(self, instruction: Instruction) -> SkillTask:
        """Return the task of an instruction.

        Raises:
            TmdError: ``skills.yaml`` has no skill for it.
        """
        entry = self.entries.get(instruction.name)
        if entry is None:
            raise TmdError(f"skills.yaml has no skill for '{instruction.name}'")
        parameters = next(a.parameters for a in self.domain.actions if a.name == instruction.name)
        given = dict(zip((p.name.removeprefix("?") for p in parameters), instruction.args, strict=True))
        roles = {role: given.get(said, said) for role in _ROLES if (said := getattr(entry, role)) is not None}
        return SkillTask(entry.skill, **roles, seconds=entry.seconds)


# Sensors of predicates with usual names, in a domain without ``skills.yaml``.
_USUAL: Mapping[str, Sensor | Confirmation] = {
    "holding": "held", "at": "support", "opened": "joint", "set_to": "setting", "near": "reach",
}  # fmt: skip


def visible(folder: DomainFolder) -> Skills:
    """Return the visible predicates of a domain: by ``skills.yaml`` or, without one, by the usual names.

    Raises:
        TmdError: There is a file, and it is wrong.
    """
    if (folder.path / "skills.yaml").is_file():
        return load_skills(folder)
    arities = {predicate.name: len(predicate.parameters) for predicate in folder.domain.predicates}
    usual = {name: sense for name, sense in _USUAL.items() if arities.get(name) == _ARITY[sense]}
    seen: dict[str, Sensor] = {name: sense for name, sense in usual.items() if sense != "reach"}
    confirmed: dict[str, Confirmation] = {name: sense for name, sense in usual.items() if sense == "reach"}
    signs = tuple(name for name in ("active", "hot") if arities.get(name) == 1)
    contents = "contains" if arities.get("contains") == 2 else None
    return Skills({}, seen, confirmed, frozenset(), {}, signs, contents, folder.domain)


def load_skills(folder: DomainFolder, report: Report | None = None) -> Skills:
    """Load the skills of a domain; ``report`` takes the faults of the file.

    Raises:
        TmdError: The file is missing, or does not fit the domain; with the place.
    """
    path = folder.path / "skills.yaml"
    if not path.is_file():
        raise TmdError(
            f"domain '{folder.name}' has no skills.yaml, so the robot cannot act in it",
            hint=f"write {path}; domains/kitchen/skills.yaml shows how",
        )
    source = YamlSource(path, report)
    said = source.load(SkillsFile)
    domain = folder.domain
    for name, entry in said.skills.items():
        source.recover(None, _check_entry, source, domain, name, entry)
    for action in domain.actions:
        if action.name not in said.skills:
            message = f"no skill for the action '{action.name}' of the domain"
            source.fault(source.error(("skills",), message, f"add {action.name}: {{skill: …}}", "missing-skill"))
    arities = {p.name: len(p.parameters) for p in domain.predicates}
    for section, sensors in (("seen", said.seen), ("confirmed", said.confirmed)):
        for predicate, sensor in sensors.items():
            source.recover(None, _check_predicate, source, (section, predicate), predicate, arities)
            if arities.get(predicate, _ARITY[sensor]) != _ARITY[sensor]:
                message = (
                    f"'{sensor}' sees predicates of {_ARITY[sensor]} arguments, '{predicate}' has {arities[predicate]}"
                )
                source.fault(source.error((section, predicate), message, None, "wrong-arity"))
    for section in ("derived", "signs"):
        for index, predicate in enumerate(getattr(said, section)):
            source.recover(None, _check_predicate, source, (section, index), predicate, arities)
    for predicate, rule in said.inferred.items():
        source.recover(None, _check_predicate, source, ("inferred", predicate), predicate, arities)
        if isinstance(rule, Exposure):
            source.recover(None, _check_predicate, source, ("inferred", predicate, "to"), rule.to, arities)
    if said.contents is not None:
        _check_predicate(source, ("contents",), said.contents, arities)
    derived, signs = frozenset(said.derived), tuple(said.signs)
    return Skills(said.skills, said.seen, said.confirmed, derived, said.inferred, signs, said.contents, domain)


def _check_entry(source: YamlSource, domain: Domain, name: str, entry: SkillEntry) -> None:
    action = next((a for a in domain.actions if a.name == name), None)
    if action is None:
        hint = nearest(name, [a.name for a in domain.actions])
        raise source.error(("skills", name), f"the domain has no action '{name}'", hint, "unknown-action")
    for role in _NEEDS.get(entry.skill, ("object",)):
        if getattr(entry, role) is None:
            message = f"the skill '{entry.skill}' must be told its {role}"
            raise source.error(("skills", name), message, None, "missing-role")
    known = [p.name.removeprefix("?") for p in action.parameters] + [c.name for c in domain.constants]
    for role in _ROLES:
        said = getattr(entry, role)
        if said is not None and said not in known:
            message = f"'{said}' is neither a parameter of '{name}' nor a constant of the domain"
            raise source.error(("skills", name, role), message, nearest(said, known), "unknown-object")


def _check_predicate(
    source: YamlSource, path: tuple[str | int, ...], predicate: str, arities: Mapping[str, int]
) -> None:
    if predicate not in arities:
        hint = nearest(predicate, sorted(arities))
        raise source.error(path, f"the domain has no predicate '{predicate}'", hint, "unknown-predicate")
