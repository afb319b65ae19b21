"""Whether what a run says is true, by what :mod:`experiments.execution.recorder` saw and by nothing else.

The rules are those of somebody who stands in the room. They are written down here a second time, on purpose: where the
monitor and the judge share a mistake, that is not found.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from math import degrees, hypot, pi

import numpy as np

from experiments.execution.recorder import Array, Frame, Recorder, Step
from tmd.pddl.model import GroundAtom, State
from tmd.robot.sim.simulator import STEPS_PER_SECOND
from tmd.robot.skills.results import Execution, SkillStatus

UPRIGHT = 15.0
"""Degrees that what stands may lean."""
OPEN, SHUT = 0.6, 0.05
"""Shares of its way from which a joint is open, and up to which it is shut."""
REACH = 1.1 + 0.05
SPILLS = 20.0
"""Degrees up to which anything may lean without losing what is in it, whatever its shape."""
HEATED = 1.9
"""Seconds that something must have stood where it gets hot."""
PRESSED = 0.5
BESIDE = 0.006
"""Metres beside an opening at which what falls still gets in: the edge that it leaves over is as thick as a wall."""


@dataclass
class Verdict:
    """What came of the claims of a run.

    Attributes:
        true: How many were found to be true.
        unjudged: How many nothing here can tell about.
        false: The others, each with the reason.
    """

    true: int = 0
    unjudged: int = 0
    false: list[str] = field(default_factory=list)

    def add(self, claim: str, found: str | None) -> None:
        """``found``: why it is false; empty where it is true; None where it cannot be told."""
        if found is None:
            self.unjudged += 1
        elif found:
            self.false.append(f"{claim}: {found}")
        else:
            self.true += 1


class Judge:
    """Judges the claims of one run.

    Args:
        recorder: What it recorded.
    """

    def __init__(self, recorder: Recorder) -> None:
        self._seen = recorder
        self._parts = {
            scene_name: recorder.session.cell.scene.where(scene_name)
            for scene_name in recorder.session.cell.scene.names()
        }

    def judge(self, execution: Execution) -> Verdict:
        """All effects of all instructions, and what is said to hold at the end."""
        verdict = Verdict()
        for index, step in enumerate(self._seen.steps):
            for effect in step.told.effects:
                claim = f"{step.title.number}. {step.told.instruction}: {effect} ({effect.basis})"
                verdict.add(claim, self._judged(effect.atom, step, index, effect.holds, step.told.state))
        if execution.status is not SkillStatus.STOPPED and self._seen.steps:
            self._end(verdict, execution)
        return verdict

    def _end(self, verdict: Verdict, execution: Execution) -> None:
        """What is said to be so at the end is so, and stays so for a second."""
        sim = self._seen.session.sim
        last = self._seen.steps[-1]
        before = self._seen.frame(sim.ticks)
        sim.step(STEPS_PER_SECOND)
        now = self._seen.look(last.title, last.told)
        after = self._seen.frame(sim.ticks)
        told = {effect.atom for step in self._seen.steps for effect in step.told.effects}
        for atom in sorted(told & execution.state):
            if atom.predicate == "near":
                continue
            claim = f"end: {atom}"
            found = self._judged(atom, now, len(self._seen.steps), True, execution.state)
            if not found and atom.predicate == "at":
                found = self._at_rest(atom.args[0], before, after)
            verdict.add(claim, found)

    def _at_rest(self, item: str, before: Frame, after: Frame) -> str:
        moved = float(np.linalg.norm(after.places[item][0] - before.places[item][0]))
        turned = degrees(abs(after.tilt(item) - before.tilt(item)))
        return f"it moves by {moved:.3f} m and {turned:.0f} degrees" if moved > 0.01 or turned > 5 else ""

    def _judged(self, atom: GroundAtom, step: Step, index: int, holds: bool, state: State) -> str | None:
        match atom.predicate:
            case "holding":
                return self._holding(atom.args[1], step, holds)
            case "one_hand_used" | "both_hands_used":
                count = len(step.frames[-1].held)
                return "" if (count == (1 if atom.predicate == "one_hand_used" else 2)) is holds else f"{count} held"
            case "at":
                return self._at(*atom.args, step, holds)
            case "opened":
                return self._opened(atom.args[0], step, holds)
            case "set_to":
                return self._set_to(*atom.args, step, holds)
            case "near":
                return self._near(atom.args[1], step) if holds else None
            case "contains" | "filled":
                return self._contents(atom.args[0], step, index) if holds else None
            case "hot":
                return self._hot(atom.args[0], step, index, state) if holds else None
            case "active":
                return self._switched(step) if index < len(self._seen.steps) else None
        return None

    # hands, places, joints

    def _holding(self, item: str, step: Step, holds: bool) -> str:
        tied = item in step.frames[-1].held
        if not holds:
            return "it is still tied to the hand" if tied else ""
        away = step.hands[item]
        return "" if tied and away < 0.005 else f"it is {100 * away:.1f} cm from the hand{'' if tied else ', untied'}"

    def _carriers(self, item: str, step: Step) -> set[str]:
        """The objects that touch an item, themselves or by what is under it."""
        found, waiting = set(), [item]
        while waiting:
            for name, _ in step.touching.get(waiting.pop(), ()):
                if name not in found and name != item:
                    found.add(name)
                    waiting += [name] if name in self._seen.items else []
        return found

    def _at(self, item: str, thing: str, relation: str, step: Step, holds: bool) -> str:
        whole, part = ("floor", "") if thing == "floor" else self._parts[thing]
        touches = whole in self._carriers(item, step)
        if not holds:
            return (
                "it still stands there"
                if touches and item not in step.frames[-1].held and self._over(item, whole, part, relation, step) == ""
                else ""
            )
        if item in step.frames[-1].held:
            return "it is in a hand"
        if not touches:
            return f"it touches {', '.join(sorted(self._carriers(item, step))) or 'nothing'}"
        beside = self._over(item, whole, part, relation, step)
        if beside:
            return beside
        return self._lies(item, thing, step)

    def _over(self, item: str, whole: str, part: str, relation: str, step: Step) -> str:
        """Whether the middle of an item is above or within what it should be on or in; empty if so."""
        if whole == "floor":
            return ""
        middle = self._middle(item, step)
        boxes = [box for (name, link), box in step.boxes.items() if name == whole and self._of(whole, part, link)]
        if not boxes:
            boxes = [box for (name, _), box in step.boxes.items() if name == whole]
        low, high = np.min([b[0] for b in boxes], axis=0), np.max([b[1] for b in boxes], axis=0)
        if relation == "next_to":
            low, high = low - 0.1, high + 0.1
        slack = 0.03
        if part:  # a niche or a plate: what can be touched of it is small
            low, high = low - np.array([0.1, 0.1, 0.5]), high + np.array([0.1, 0.1, 0.3])
        if np.any(middle[:2] < low[:2] - slack) or np.any(middle[:2] > high[:2] + slack):
            return f"its middle is beside {whole}{'_' * bool(part)}{part}"
        top = high[2] + (0.15 if relation != "in" else 0.2)
        if not low[2] - slack <= middle[2] <= top:
            return f"its middle is {middle[2]:.2f} m up, and that reaches from {low[2]:.2f} to {high[2]:.2f}"
        return ""

    def _of(self, whole: str, part: str, link: int) -> bool:
        """Whether a link is of a part; of the whole all are."""
        if not part:
            return True
        model = self._seen.models[whole]
        return any(owner == part and self._seen.link(whole, name) == link for name, owner in model.link_parts.items())

    def _middle(self, item: str, step: Step) -> Array:
        boxes = [box for (name, _), box in step.boxes.items() if name == item]
        low, high = np.min([b[0] for b in boxes], axis=0), np.max([b[1] for b in boxes], axis=0)
        found: Array = (low + high) / 2
        return found

    def _lies(self, item: str, thing: str, step: Step) -> str:
        """Whether what should stand leans: what has a rim, and what is much taller than wide."""
        model = self._seen.models[item]
        deep, wide, tall = (b - a for a, b in zip(model.low, model.high, strict=True))
        stands = model.opening is not None or tall > 1.2 * max(deep, wide)
        heap = thing != "floor" and any(region.heap for region in self._seen.models[self._parts[thing][0]].regions)
        lean = degrees(step.frames[-1].tilt(item))
        return f"it leans by {lean:.0f} degrees" if stands and not heap and thing != "floor" and lean > UPRIGHT else ""

    def _way(self, name: str, step: Step) -> tuple[float, str] | None:
        """How far a joint is on its way from shut to open, and what kind it is."""
        whole, part = self._parts[name]
        grip = next((g for g in self._seen.models[whole].grips if g.part == part), None)
        if grip is None:
            return None
        at = step.frames[-1].joints.get((self._seen.bodies[whole], self._seen.link(whole, grip.link)))
        return None if at is None else ((at - grip.closed) / (grip.open - grip.closed), grip.kind)

    def _opened(self, name: str, step: Step, holds: bool) -> str | None:
        found = self._way(name, step)
        if found is None or found[1] in ("knob", "button"):
            return None
        right = found[0] >= OPEN - 0.005 if holds else found[0] <= SHUT + 0.005
        return "" if right else f"it is {100 * found[0]:.0f} % open"

    def _set_to(self, name: str, setting: str, step: Step, holds: bool) -> str | None:
        whole, part = self._parts[name]
        grip = next((g for g in self._seen.models[whole].grips if g.part == part and g.settings), None)
        if grip is None:
            return None
        at = step.frames[-1].joints[self._seen.bodies[whole], self._seen.link(whole, grip.link)]
        nearest = min(grip.settings, key=lambda pair: abs(pair[1] - at))[0]
        return "" if (nearest == setting) is holds else f"its angle is {degrees(at):.0f} degrees, nearest to {nearest}"

    def _near(self, name: str, step: Step) -> str:
        whole = self._parts[name][0] if name != "floor" else "floor"
        if whole in step.frames[-1].held or whole == "floor":
            return ""
        seen = {whole}
        while whole in self._seen.items and (under := sorted(self._carriers(whole, step) - seen)):
            boxes = [box for (other, _), box in step.boxes.items() if other == whole]
            if self._away(boxes, step) <= REACH:
                return ""
            whole = under[0]
            seen.add(whole)
        away = self._away([box for (other, _), box in step.boxes.items() if other == whole], step)
        return "" if away <= REACH else f"it is {away:.2f} m away"

    def _away(self, boxes: Iterable[tuple[Array, Array]], step: Step) -> float:
        base = np.array(step.base)
        return min(
            float(np.linalg.norm(np.maximum(np.maximum(low[:2] - base, base - high[:2]), 0.0))) for low, high in boxes
        )

    # contents and heat

    def _contents(self, item: str, step: Step, index: int) -> str | None:
        """What is in a thing got there, and is still in it."""
        if item not in self._seen.items:
            return None
        model = self._seen.models[item]
        spoon = model.opening is None
        got = index if index < len(self._seen.steps) else self._got(item)
        if got is None:
            return None
        filled = self._seen.steps[got]
        waited = filled.told.instruction.name == "wait"
        if not waited and not self._came_in(item, filled):
            return "nothing was tipped over it, and no stream ran into it"
        frames = [frame for later in self._seen.steps[got + 1 : index + 1] for frame in later.frames]
        frames = frames or [filled.frames[-1]]
        if self._sealed(item, step):
            return ""
        limit = SPILLS if spoon or model.opening is None else max(degrees(model.opening.spills_from), SPILLS)
        lean = max(degrees(frame.tilt(item)) for frame in frames)
        poured = any(self._over_rim(item, frame) for frame in frames if degrees(frame.tilt(item)) > limit)
        return f"it leaned by {lean:.0f} degrees since" if lean > limit + 1 and not poured else ""

    def _got(self, item: str) -> int | None:
        """The number of the instruction that filled a thing last."""
        for number in range(len(self._seen.steps) - 1, -1, -1):
            for effect in self._seen.steps[number].told.effects:
                if effect.atom.predicate in ("contains", "filled") and effect.atom.args[0] == item and effect.holds:
                    return number
        return None

    def _sealed(self, item: str, step: Step) -> bool:
        found = self._way(item, step)
        return found is not None and found[1] == "lid" and found[0] <= SHUT

    def _came_in(self, item: str, step: Step) -> bool:
        return self._tipped_in(item, step) or any(
            self._runs_in(item, frame) or self._dipped(item, frame) for frame in step.frames
        )

    def _rim(self, item: str, frame: Frame) -> tuple[Array, float]:
        """The middle and the radius of the opening of a vessel; of a spoon, of its head."""
        model = self._seen.models[item]
        if model.opening is not None:
            return frame.point(item, model.opening.centre), model.opening.radius
        return frame.point(item, ((model.low[0] + 0.02), 0.0, model.high[2])), 0.03

    def _runs_in(self, item: str, frame: Frame) -> bool:
        """Whether straight below a spout there is the opening."""
        middle, radius = self._rim(item, frame)
        for whole, body in self._seen.bodies.items():
            for _, at in sorted(self._seen.models[whole].spouts.items()):
                position, turn = self._seen.place(whole)
                mouth = position + turn @ np.array(at)
                if mouth[2] > middle[2] and hypot(*(mouth - middle)[:2]) <= radius and body is not None:
                    return degrees(frame.tilt(item)) <= UPRIGHT
        return False

    def _tipped_in(self, item: str, step: Step) -> bool:
        """Whether something that was tipped over the opening lost what is in it there.

        It is lost from the angle of spilling on: over the opening then, and up to where it is tipped most. What comes
        out of a packet does so at its lowest end, wherever it was carried before.
        """
        for other in sorted({name for frame in step.frames for name in frame.held} - {item}):
            opening = self._seen.models[other].opening
            spills = SPILLS if opening is None else max(degrees(opening.spills_from), SPILLS)
            tipped = [frame for frame in step.frames if other in frame.held and degrees(frame.tilt(other)) >= spills]
            most = max(range(len(tipped)), key=lambda number: tipped[number].tilt(other), default=-1)
            over = [self._held_over(other, item, frame) for frame in tipped[: most + 1]]
            if over and (any(over) if opening is None else all(over)):
                return True
        return False

    def _held_over(self, other: str, item: str, frame: Frame) -> bool:
        """Whether the lowest end of one thing is over the opening of another; a spoon's may be below its rim."""
        middle, radius = self._rim(item, frame)
        below = 0.06 if self._seen.models[other].opening is None else 0.005
        return any(
            hypot(*(end - middle)[:2]) <= radius + BESIDE and end[2] > middle[2] - below
            for end in self._ends(other, frame)
        )

    def _dipped(self, item: str, frame: Frame) -> bool:
        """Whether the head of a spoon is below the rim of something."""
        if item not in frame.held:
            return False
        head = self._ends(item, frame)[0]
        for source in self._seen.items:
            if source != item and self._seen.models[source].opening is not None:
                rim, wide = self._rim(source, frame)
                if hypot(*(head - rim)[:2]) <= wide + 0.005 and rim[2] - 0.1 < head[2] < rim[2]:
                    return True
        return False

    def _over_rim(self, item: str, frame: Frame) -> bool:
        """Whether the lowest end of a thing is over the opening of another, or over a basin."""
        end = self._ends(item, frame)[0]
        for other in self._seen.items:
            if other != item and self._seen.models[other].opening is not None:
                rim, wide = self._rim(other, frame)
                if hypot(*(end - rim)[:2]) <= wide + BESIDE:
                    return True
        return any(self._seen.models[whole].spouts and self._within(whole, end) for whole in self._seen.bodies)

    def _within(self, whole: str, point: Array) -> bool:
        position, turn = self._seen.place(whole)
        x, y, _ = turn.T @ (point - position)
        return any(
            region.relation == "in" and region.low[0] <= x <= region.high[0] and region.low[1] <= y <= region.high[1]
            for region in self._seen.models[whole].regions
        )

    def _ends(self, item: str, frame: Frame) -> list[Array]:
        """Where contents may leave a thing: the lowest point of its rim, the head of a spoon, the ends of a packet."""
        model = self._seen.models[item]
        if model.opening is not None:
            x, y, z = model.opening.centre
            out = model.opening.radius + 0.005
            around = [(x + out * np.cos(a), y + out * np.sin(a), z) for a in np.linspace(0, 2 * pi, 32)]
            return [min((frame.point(item, each) for each in around), key=lambda point: float(point[2]))]
        if model.contents:
            return [frame.point(item, (model.low[0] + 0.02, 0.0, model.low[2]))]
        low, high = model.low, model.high
        middle = [(a + b) / 2 for a, b in zip(low, high, strict=True)]
        ends = [(low[0] + 0.015, middle[1], middle[2]), (high[0] - 0.015, middle[1], middle[2])]
        ends += [(middle[0], middle[1], low[2]), (middle[0], middle[1], high[2])]
        return [frame.point(item, each) for each in ends]

    def _hot(self, item: str, step: Step, index: int, state: State) -> str | None:
        """Hot things stood on what is lit, or got something hot."""
        got = index if index < len(self._seen.steps) else None
        if got is None or item not in self._seen.items:
            return None
        filled = self._seen.steps[got]
        if filled.told.instruction.name != "wait":
            return "" if self._came_in(item, filled) else "nothing hot came into it"
        lit = {self._parts[a.args[0]][0] for a in state if a.predicate == "active" and a.args[0] in self._parts}
        if not self._carriers(item, step) & lit:
            return "it stands on nothing that is lit"
        seconds = (filled.frames[-1].tick - filled.frames[0].tick) / STEPS_PER_SECOND
        return "" if seconds >= HEATED else f"for {seconds:.1f} s only"

    def _switched(self, step: Step) -> str:
        """Whether a knob, a button or a door moved in this instruction."""
        for key, (low, high) in self._seen.moving.items():
            values = [frame.joints[key] for frame in step.frames]
            if (max(values) - min(values)) / (high - low) >= (PRESSED if high - low < 0.05 else 0.15):
                return ""
        return "no knob, button or door moved"


def summary(recorder: Recorder) -> Sequence[str]:
    """The worst of a run, for people."""
    worst = recorder.worst
    return [
        f"{kind} {getattr(worst, kind):.3f}: {worst.where[kind]}"
        for kind in ("jump", "depth", "overrun")
        if kind in worst.where
    ]
