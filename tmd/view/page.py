"""The page on a plan: one file that loads nothing, with a few lines of script that it does not need."""

from __future__ import annotations

import re
from base64 import b64encode
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import sha256

from tmd import __version__
from tmd.language.clause import Clause, print_clause
from tmd.pddl.validator import Verdict, validate
from tmd.pddl.writer import format_formula
from tmd.records.run import MARKS, RanStep
from tmd.view.candidates import candidates
from tmd.view.clauses import lit_sentence
from tmd.view.goals import ShownGoal, followed, outcome
from tmd.view.markup import data, style, templates
from tmd.view.pictures import Strip, Tile
from tmd.view.run_record import Ran
from tmd.view.steps import ShownStep, shown_steps
from tmd.view.subject import Said, Subject
from tmd.view.wording import Wording

# A plan with more steps than this has them folded.
FEW = 60
# Characters that a text may have, and a page may not.
_UNFIT = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f\ud800-\udfff]")


@dataclass(frozen=True, slots=True)
class Page:
    """A page, and whether what it shows works.

    Attributes:
        html: The page.
        verdict: What the validator says of the plan.
    """

    html: str
    verdict: Verdict


@dataclass(frozen=True, slots=True)
class _Seen:
    """Executed step of a robot, with its picture."""

    step: RanStep
    picture: str


@dataclass(frozen=True, slots=True)
class _ClauseRow:
    number: int
    notation: str
    meant: tuple[tuple[str, str, str], ...]
    notes: tuple[str, ...]
    unseen: bool


def render(subject: Subject) -> Page:
    """Write the page; the same subject gives the same page."""
    steps, verdict = shown_steps(subject.problem, subject.steps)
    goals = followed(subject.goals, subject.problem, [step.instruction for step in subject.steps])
    script = data("page.js")
    said = subject.said
    wording = Wording(subject.problem)
    html = (
        templates()
        .get_template("page.html.j2")
        .render(
            subject=subject,
            verdict=verdict,
            outcome=outcome(verdict, goals, subject.problem.goal),
            goals=goals,
            doubts=subject.doubts,
            in_words=wording.fact,
            done=wording.instruction,
            ticks=_ticks(goals),
            marks=MARKS,
            pddl=format_formula,
            steps=steps,
            folded=len(steps) > FEW,
            undrawn=next((step.number for step in steps if step.reached and not step.drawn), None),
            sentence="" if said is None else lit_sentence(said.parsed, said.meant, said.unseen),
            clauses=[] if said is None else _clause_rows(said),
            candidates=_candidates(subject, verdict),
            seen=_seen(subject, steps),
            version=__version__,
            style=style() + data("page.css"),
            script=script,
            digest=b64encode(sha256(script.encode()).digest()).decode(),
        )
    )
    return Page(_UNFIT.sub("\N{REPLACEMENT CHARACTER}", html), verdict)


def _ticks(goals: Sequence[ShownGoal]) -> dict[int, list[tuple[str, str]]]:
    """Map steps to a sign and the words of each goal that holds, or ends, after them."""
    found: defaultdict[int, list[tuple[str, str]]] = defaultdict(list)
    for shown in goals:
        if shown.since:
            found[shown.since].append(("✓", shown.words))
        if shown.until:
            found[shown.until].append(("no longer", shown.words))
    return found


def _candidates(subject: Subject, verdict: Verdict) -> str:
    """Return the table of all plans; the first is the one that is shown."""
    if not subject.plans and not subject.refusals:
        return ""
    others = [validate(subject.problem, plan.instructions).reason for plan in subject.plans[1:]]
    return candidates(subject.plans, [verdict.reason, *others], subject.refusals)


def _clause_rows(said: Said) -> list[_ClauseRow]:
    rows = []
    for number, clause in enumerate(said.parsed.clauses):
        meant = {} if said.meant is None else said.meant[number]
        told = tuple((name, _reading(clause, name), ", ".join(objects)) for name, objects in meant.items())
        rows.append(_ClauseRow(number + 1, print_clause(clause), told, _notes(clause), clause.verb in said.unseen))
    return rows


def _reading(clause: Clause, name: str) -> str:
    """Return the reading of a pronoun, or of an object that was left out."""
    read = clause.meant(name)
    return "" if read == (name,) else " + ".join(read)


def _notes(clause: Clause) -> tuple[str, ...]:
    said = (("condition", clause.condition), ("duration", clause.duration), ("purpose", clause.purpose))
    quantities = [f"{count} {name}" for name, count in clause.quantities.items()]
    return (*quantities, *(f"{word}: {' '.join(value.split())}" for word, value in said if value))


def _seen(subject: Subject, steps: list[ShownStep]) -> dict[int, list[_Seen]]:
    """Map each step of the plan to the executed steps of the robot for it."""
    if subject.ran is None:
        return {}
    ran: Ran = subject.ran
    strip = subject.strip
    return {
        step.number: [_Seen(done, _picture(strip, place)) for place, done in ran.of(step.number, len(steps))]
        for step in steps
    }


def _picture(strip: Strip | None, place: int) -> str:
    """Return the style that shows one picture of the sheet at any size; empty where there is none."""
    if strip is None or place >= len(strip.tiles):
        return ""
    tile: Tile = strip.tiles[place]
    across, down = strip.width - strip.tile_width, strip.height - strip.tile_height
    size = f"{100 * strip.width / strip.tile_width:.4f}% {100 * strip.height / strip.tile_height:.4f}%"
    return (
        f"aspect-ratio:{strip.tile_width}/{strip.tile_height};background-size:{size};"
        f"background-position:{100 * tile.x / across:.4f}% {100 * tile.y / down:.4f}%"
    )
