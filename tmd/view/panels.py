"""The HTML of the studio's panels, made by ``studio.html.j2``, which escapes all text.

Colours are those of Okabe and Ito, which colour-blind people can tell apart; each has a sign or a word beside it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from tmd.diagnostics import TmdError
from tmd.pddl.model import GroundAtom, Instruction, Problem, State
from tmd.pddl.reading.syntax import nearest
from tmd.pddl.semantics import holds
from tmd.pddl.task import Bits
from tmd.readers.interface import Usage
from tmd.view.goals import ShownGoal
from tmd.view.markup import data, macro
from tmd.view.subject import PlannedStep
from tmd.world.world import PART_OF, World

_TEMPLATE = "studio.html.j2"


def fragment(content: str) -> str:
    """Put the studio's style before content."""
    return f'<style>\n{data("studio.css")}</style><div class="tmd tmd-panel">{content}</div>'


def notice(message: str, hint: str | None = None, *, fault: bool = False) -> str:
    """Render a message to the visitor, read out by screen readers."""
    return fragment(macro(_TEMPLATE, "notice", message, hint, fault))


def step_list(
    steps: Iterable[PlannedStep],
    current: int,
    gains: Sequence[str] = (),
    faults: Mapping[int, Sequence[str]] | None = None,
    *,
    in_words: Callable[[Instruction], str] = str,
    of: str = "",
) -> str:
    """Render numbered steps in words; the instruction shows on hover, and below the step that was taken last.

    The step ``current`` was taken last, from 1; 0 is the beginning. ``gains`` are the facts that it changed, as HTML;
    ``faults`` those of steps, by number. ``in_words`` puts an instruction into words. The panel ``of`` the steps is
    sent each click on one.
    """
    wrong = faults or {}
    rows = [
        (number, step, in_words(step.instruction), wrong.get(number, ()), gains if number == current else ())
        for number, step in enumerate(steps, start=1)
    ]
    return fragment(macro(_TEMPLATE, "step_list", rows, current, of))


def judgement(outcome: str, lines: Iterable[str]) -> str:
    """Render the outcome of a plan, and the doubts about it."""
    return fragment(macro(_TEMPLATE, "judgement", outcome, list(lines)))


def goal_list(goals: Iterable[ShownGoal], state: State, problem: Problem) -> str:
    """Render the goals of a text, with a tick at each that holds in ``state``; empty without goals."""
    rows = []
    for shown in goals:
        formula = shown.goal.formula
        true = formula is not None and shown.asked and holds(formula, state, problem)
        rows.append((("✓" if true else "○") if shown.asked else shown.sign, shown))
    return fragment(macro(_TEMPLATE, "goal_list", rows)) if rows else ""


def rejected_ways(failures: Sequence[object]) -> str:
    """Render what a robot tried in vain, :class:`tmd.robot.video.rejected_ways.FailedStep` each; scrolls by itself."""
    return f'<div class="vain">{macro(_TEMPLATE, "rejected_ways", failures)}</div>'


def changed(
    added: Iterable[GroundAtom], removed: Iterable[GroundAtom], in_words: Callable[[GroundAtom], str] = str
) -> list[str]:
    """Render each fact that came or went with a sign and a colour; PDDL shows on hover."""
    signed = [*(("+", atom) for atom in added), *(("−", atom) for atom in removed)]
    return [macro(_TEMPLATE, "changed_fact", sign, atom, in_words(atom)) for sign, atom in signed]


def object_facts(name: str, world: World, state: Bits, in_words: Callable[[GroundAtom], str]) -> str:
    """Render an object: its class, its parts, and the facts about it by heading."""
    profiles, kind = world.profiles, world.mentions.kinds.get(name, "object")
    parts = [part for _, part in profiles.parts.get(name, ())]
    found = about(name, world, state)
    return macro(_TEMPLATE, "object_facts", name, kind, profiles.wholes.get(name), parts, found, in_words)


def effort(usage: Usage | None) -> str:
    """Render the effort of a language model; empty where none was asked."""
    return "" if usage is None else macro(_TEMPLATE, "effort", usage)


def about(name: str, world: World, state: Bits) -> dict[str, list[GroundAtom]]:
    """Return the facts about ``name`` in ``state`` by heading, each sorted.

    States are those of it alone (*mug1 is hot*), relations those of it and another object (*mug1 is on counter1*), and
    the rest never changes (*stove1_knob1 controls stove1_burner1*); edges that hold both ways add nothing, and are left
    out.

    Raises:
        TmdError: There is no such object.
    """
    require_object(name, world)
    static, constants = world.task.static, world.profiles.constants

    def shared(atom: GroundAtom) -> bool:
        return any(argument != name and argument not in constants for argument in atom.args)

    now = [atom for atom in world.task.names(state) if name in atom.args]
    always = [atom for atom in sorted(static) if name in atom.args and atom.predicate != PART_OF and shared(atom)]
    return {
        "States": [atom for atom in now if not shared(atom)],
        "Relations": [atom for atom in now if shared(atom)],
        "What controls what": [atom for atom in always if atom._replace(args=atom.args[::-1]) not in static],
    }


def require_object(name: str, world: World) -> None:
    """Make sure that an environment has an object.

    Raises:
        TmdError: It has none of that name.
    """
    known = world.objects.types_of
    if name not in known:
        raise TmdError(f"there is no object '{name}'", hint=nearest(name, list(known), what="objects"))
