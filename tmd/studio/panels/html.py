"""The HTML that the studio's panels show; whatever people typed is escaped.

Colours are those of Okabe and Ito, which colour-blind people tell apart; nothing is told by colour alone.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from html import escape

from tmd.pddl.model import GroundAtom, Instruction, Problem, State
from tmd.pddl.semantics import holds
from tmd.studio.applicable_actions import ActionGroup
from tmd.studio.object_info import About
from tmd.view.goals import ShownGoal

MOST = 30
"""Maximum number of reasons listed why instructions do not apply."""
_NAMED = 6
"""How many instructions are named for each."""

STYLE = """<style>
.tmd-panel{font-size:.85rem;line-height:1.45;overflow-wrap:anywhere;padding:0 .75rem}
.tmd ol{margin:.2rem 0;padding-left:1.9rem}.tmd ul{margin:.2rem 0;padding-left:1.2rem}
.tmd .now{background:#56b4e9;color:#000;border-radius:.2rem;padding:0 .25rem;font-weight:600}
.tmd .latent{font-style:italic}.tmd .broken{text-decoration:underline wavy #d55e00}
.tmd .tag{font-size:.72rem;border:1px solid currentColor;border-radius:.6rem;padding:0 .35rem;margin-left:.35rem;
white-space:nowrap}
.tmd .plus{color:var(--tmd-added,#00664b);font-weight:600}.tmd .minus{color:var(--tmd-removed,#a34700);font-weight:600}
.tmd [data-step]{cursor:pointer}.tmd [data-step]:hover{text-decoration:underline}
.tmd .said{margin:.1rem 0;opacity:.75}.tmd .folded{list-style:none;opacity:.75}
.tmd h4{margin:.5rem 0 .15rem;font-size:.85rem}.tmd p{margin:.25rem 0}.tmd .quiet{opacity:.75}
.tmd .notice{border-left:.3rem solid #0072b2;padding:.2rem .5rem;margin:.3rem 0}
.tmd .fault{border-left:.3rem solid #d55e00;padding:.2rem .5rem;margin:.3rem 0}
.tmd svg{max-width:100%;height:auto}.tmd table{border-collapse:collapse}.tmd td,.tmd th{padding:.05rem .35rem}
.tmd .numbers td,.tmd .numbers thead th{text-align:right;font-variant-numeric:tabular-nums}
.tmd .numbers tbody th{text-align:left;font-weight:400}.tmd .numbers tr{border-bottom:1px solid #bbb}
@media (max-width:36em){.mantine-Paper-root[style*="20em"],.mantine-Paper-root[style*="20em"] div[style*="20em"]
{width:100vw!important}}
.tmd .outcome{font-weight:600}.tmd .doubts{border-left:.3rem solid #e69f00;padding-left:1.4rem!important}
.tmd .sides td{font-size:.78rem;border-bottom:1px solid #bbb;overflow-wrap:anywhere;width:50%}
.tmd .goals{list-style:none;padding-left:.2rem}
.tmd summary{cursor:pointer;margin-top:.4rem}
</style>"""


def fragment(content: str) -> str:
    """Content with the studio's style."""
    return f'{STYLE}<div class="tmd tmd-panel">{content}</div>'


def notice(message: str, hint: str | None = None, *, fault: bool = False) -> str:
    """A message to the visitor, read out by screen readers."""
    kind, word = ("fault", "Not done: ") if fault else ("notice", "")
    more = f"<br><span class='quiet'>{escape(hint)}</span>" if hint else ""
    return fragment(f'<div class="{kind}" role="status" aria-live="polite">{word}{escape(message)}{more}</div>')


def step_list(
    lines: Iterable[tuple[str, str, bool]],
    current: int,
    gains: Sequence[str] = (),
    faults: Mapping[int, Sequence[str]] | None = None,
    *,
    of: str = "",
    folded: Collection[int] = (),
    draggable: bool = False,
    words: Sequence[str] = (),
) -> str:
    """Numbered steps.

    Args:
        lines: The instruction, what it is for, whether the person left it unsaid.
        current: The step that was taken last, from 1; 0 is the beginning.
        gains: What it changed, as HTML; shown below it.
        faults: What is wrong with steps, by number.
        of: The panel whose steps they are; a click on one is told to it.
        folded: The numbers of steps that are not listed, but counted.
        draggable: Whether a step can be dragged to the place of another.
        words: What each step does in words, which is what is listed; its instruction shows on hover, and below the
            step that was taken last.
    """
    rows: list[str] = []
    hidden = 0
    for number, (instruction, purpose, latent) in enumerate(lines, start=1):
        if number in folded and number != current and not (faults or {}).get(number):
            hidden += 1
            continue
        rows += [_hidden(hidden)] if hidden else []
        hidden = 0
        said, pddl = (words[number - 1] if number <= len(words) else ""), escape(instruction)
        name = escape(said) or pddl
        if latent:
            name = f'<span class="latent">{name}</span>'
        if number == current:
            name = f'<span class="now" aria-current="step">▸ {name}</span>'
        wrong = (faults or {}).get(number, ())
        if wrong:
            name = f'<span class="broken">{name}</span>'
        notes = [*(escape(fault) for fault in wrong), *(gains if number == current else ())]
        below = f"<p class='said'><code>{pddl}</code></p>" if said and number == current else ""
        below += f"<ul>{''.join(f'<li>{note}</li>' for note in notes)}</ul>" if notes else ""
        drag = ' draggable="true"' if draggable else ""
        step = f'data-step="{number}" tabindex="0" role="link" title="{pddl}"{drag}'
        rows.append(
            f'<li value="{number}"><span {step}>{name}</span><span class="tag">{escape(purpose)}</span>{below}</li>'
        )
    rows += [_hidden(hidden)] if hidden else []
    return fragment(f"<ol data-list='{of}'>{''.join(rows)}</ol>" if rows else "<p>No steps yet.</p>")


def _hidden(count: int) -> str:
    return f'<li class="folded">… {count} step{"" if count == 1 else "s"} to find things and to get there</li>'


def judgement(outcome: str, lines: Iterable[str]) -> str:
    """What a plan is good for, and what is doubtful about it."""
    rows = "".join(f"<li>{escape(line)}</li>" for line in lines)
    doubtful = f'<ul class="doubts" aria-label="doubts">{rows}</ul>' if rows else ""
    return fragment(f'<p class="outcome">{escape(outcome)}</p>{doubtful}')


def goal_list(goals: Iterable[ShownGoal], state: State, problem: Problem) -> str:
    """What the steps of a text ask for, with a tick at each goal that holds in ``state``."""
    rows = []
    for shown in goals:
        formula = shown.goal.formula
        true = formula is not None and shown.asked and holds(formula, state, problem)
        sign = ("✓" if true else "○") if shown.asked else shown.sign
        so = '<span class="tag">already so</span>' if shown.asked and shown.goal.already else ""
        words = f'<span class="plus">{sign}</span> {escape(shown.told)}'
        rows.append(f'<li>{words}<span class="tag">clause {shown.goal.clause + 1}</span>{so}</li>')
    return fragment(f'<ul class="goals">{"".join(rows)}</ul>') if rows else ""


def changed(
    added: Iterable[GroundAtom], removed: Iterable[GroundAtom], said: Callable[[GroundAtom], str] = str
) -> list[str]:
    """Facts that came and went, as HTML with a sign and a colour; ``said`` tells them in words, PDDL is on hover."""

    def told(atom: GroundAtom) -> str:
        return f'<span title="{escape(str(atom))}">{escape(said(atom))}</span>'

    plus = [f'<span class="plus">+ {told(atom)}</span>' for atom in added]
    return plus + [f'<span class="minus">− {told(atom)}</span>' for atom in removed]


def object_facts(known: About, said: Callable[[GroundAtom], str]) -> str:
    """An object in words: what it is, what is so of it, what it is to others, what controls what.

    Args:
        known: What there is to know of it.
        said: A fact in words.
    """
    of = f" of {escape(known.whole)}" if known.whole else ""
    parts = f"<p>Parts: {escape(', '.join(known.parts))}</p>" if known.parts else ""
    blocks = [
        f"<h4>{title}</h4><ul>{''.join(f'<li>{escape(said(atom))}</li>' for atom in atoms)}</ul>"
        for title, atoms in (
            ("States", known.states),
            ("Relations", known.relations),
            ("What controls what", known.edges),
            ("Always so", known.traits),
        )
        if atoms
    ]
    return f"<h4>{escape(known.name)}: {escape(known.kind or 'object')}{of}</h4>{parts}{''.join(blocks)}"


def refused(groups: Iterable[ActionGroup], said: Callable[[Instruction], str] = str) -> str:
    """Instructions that do not apply, by what they lack: the reason that most of them share first.

    Args:
        groups: The instructions.
        said: An instruction in words; PDDL is on hover.
    """
    reasons: dict[str, list[Instruction]] = {}
    for group in groups:
        for offer in group.offers:
            if not offer.applies:
                reasons.setdefault(offer.why, []).append(offer.instruction)
    lines = [
        f'<li>✗ {escape(why)}<br><small class="quiet">{_some(instructions, said)}</small></li>'
        for why, instructions in sorted(reasons.items(), key=lambda item: (-len(item[1]), item[0]))
    ]
    more = f"<p>… and {len(lines) - MOST} more reasons.</p>" if len(lines) > MOST else ""
    return f"<ul>{''.join(lines[:MOST])}</ul>{more}" if lines else "<p>Nothing is out of reach.</p>"


def _some(instructions: Sequence[Instruction], said: Callable[[Instruction], str]) -> str:
    rest = len(instructions) - _NAMED
    named = [f'<span title="{escape(str(each))}">{escape(said(each))}</span>' for each in instructions[:_NAMED]]
    return "; ".join(named) + (f"; and {rest} more" if rest > 0 else "")
