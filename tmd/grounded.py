"""The result of grounding: plans, and warnings about words that could not be used."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING

from tmd.diagnostics import MissingToolError, Refusal, install_extra
from tmd.inference.config import InferenceConfig
from tmd.inference.energy import title
from tmd.inference.ranking import RankedPlan, RejectedProposal
from tmd.language.clause import Parsed
from tmd.language.lexicon.nouns import WORDNET
from tmd.library.library import Library
from tmd.pddl.validator import Verdict
from tmd.readers.interface import Dialogue, Question, Usage
from tmd.short_repr import short_repr
from tmd.world.world import World

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame

# Maximum number of verbs that are suggested for an unknown one.
_VERBS = 8
# Maximum number of different reasons that are shown.
_SHOWN = 3


@short_repr(lambda g: f"{g.parsed.text!r} in {g.world.name}: {g.reason or f'{len(g.plans)} plan(s)'}")
@dataclass(frozen=True, slots=True)
class Grounded:
    """A grounded request.

    Attributes:
        plans: The plans, cheapest first; empty where nothing could be grounded.
        rejected: Proposals that cannot be executed here, and why.
        unseen: The verbs that no demonstration has, in order of mention.
        refused: Why there is no plan, after the index of the clause that it is about; ``None`` for the whole request.
        question: A question to the user that was not answered; the plans are for the option that it says was taken.
    """

    dialogue: Dialogue
    plans: tuple[RankedPlan, ...]
    verdicts: tuple[Verdict, ...]
    rejected: tuple[RejectedProposal, ...]
    unseen: tuple[str, ...]
    world: World
    library: Library
    config: InferenceConfig
    refused: tuple[int | None, Refusal] | None = None
    question: Question | None = None

    @property
    def parsed(self) -> Parsed:
        """The clauses, and the pieces of text that none of them covers."""
        return self.dialogue.parsed

    @property
    def usage(self) -> Usage | None:
        """The effort of the language model; ``None`` where none was asked."""
        return self.dialogue.usage

    @property
    def unknown(self) -> tuple[str, ...]:
        """The nouns that name neither an object of the environment nor a substance of its domain."""
        mentions, substances = self.world.mentions, set(self.world.profiles.constants)
        unknown: dict[str, None] = {}
        for noun in self._nouns():
            readings = {noun, noun.rpartition("_")[2], *mentions.lexicon.nouns.get(noun, ())}
            if not mentions.of(noun, self.world.task.init) and not readings & substances:
                unknown[noun] = None
        return tuple(unknown)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The words that could not be used, or only by a guess, and what else to know of the reading; a line each."""
        guessed = [*self._likened()] if self.config.guess or not self.config.goals else []
        if self.refused is not None or (self.config.goals and self.plans):
            lines = [*self._left_out(), *(guessed if self.plans else ())]
        else:
            lines = [
                *(f"no demonstration has the verb '{_plain(verb)}' ({self._other(verb)})" for verb in self.unseen),
                *(
                    f"nothing here is called '{_plain(noun)}'; what a plan does instead is a guess, so read it first"
                    for noun in self.unknown
                ),
                *guessed,
            ]
        asked = [f"{q.text} Option {q.taken + 1} is taken."] if (q := self.question) is not None else []
        return tuple(dict.fromkeys((*self.dialogue.notes, *asked, *lines)))

    @property
    def reason(self) -> str:
        """The reason why there is no plan, in a line; empty where there is one that works."""
        if any(verdict.valid for verdict in self.verdicts):
            return ""
        parsed = self.parsed
        if self.refused is not None:
            return self.refusal
        if not parsed.clauses:
            reasons = dict.fromkeys(piece.reason for piece in parsed.skipped)
            said = f" ({'; '.join(list(reasons)[:_SHOWN])})" if reasons else ""
            return f"the text has no instruction{said}; say what is to be done: take the cup"
        if {clause.verb for clause in parsed.clauses} <= set(self.unseen):
            return "no demonstration has any of its verbs; use other words, or add demonstrations"
        clause = max((each.clause for each in self.rejected), default=0)
        text = " ".join(parsed.clauses[clause].text.split())
        return f'clause {clause + 1}, "{text}", cannot be done here: {self._reasons(clause)}'

    @property
    def refusal(self) -> str:
        """The reason of the refusal; empty where there is none."""
        if self.refused is None:
            return ""
        clause, refused = self.refused
        return why_refused(clause, refused.message, refused.hint)

    def to_frame(self) -> DataFrame:
        """Return the plans as rows of a pandas table, cheapest first: energy, its factors, number of steps, validity.

        Raises:
            MissingToolError: pandas is not installed.
        """
        try:
            from pandas import DataFrame, RangeIndex
        except ImportError:
            raise MissingToolError("pandas is not installed", hint=install_extra("notebook")) from None
        factors = self._factors()
        rows = [
            {"energy": plan.energy, **{title(name): plan.factors.get(name, 0.0) for name in factors}}
            | {"steps": len(plan.steps), "valid": verdict.valid}
            for plan, verdict in zip(self.plans, self.verdicts, strict=True)
        ]
        return DataFrame(rows, index=RangeIndex(1, len(rows) + 1, name="plan"))

    def plot(self) -> Axes:
        """Draw the energies of the plans as bars, a colour for each factor that is not 0 everywhere.

        Raises:
            MissingToolError: pandas or matplotlib is not installed.
        """
        try:
            from matplotlib import pyplot
        except ImportError:
            raise MissingToolError("matplotlib is not installed", hint=install_extra("notebook")) from None
        shown = self.to_frame()
        names = [title(name) for name in self._factors() if shown[title(name)].any()]
        _, axes = pyplot.subplots(figsize=(8, 1.5 + len(shown) / 2), layout="constrained")
        if names:
            shown[names].plot.barh(stacked=True, ax=axes, xlabel="energy")
            axes.legend(loc="upper left", bbox_to_anchor=(1, 1))
            axes.invert_yaxis()
        return axes

    def _factors(self) -> list[str]:
        """Return the factors of all plans, in order."""
        return list(dict.fromkeys(name for plan in self.plans for name in plan.factors))

    def _nouns(self) -> Iterator[str]:
        return (noun for clause in self.parsed.clauses for noun in clause.resolved())

    def _likened(self) -> Iterator[str]:
        """Yield warnings about nouns that only WordNet relates to something here."""
        for noun in dict.fromkeys(self._nouns()):
            matches = self.world.mentions.of(noun, self.world.task.init)
            if matches and all(match.how == WORDNET for match in matches):
                names = [match.name for match in matches]
                taken = ", ".join(names[:_SHOWN]) + (" or others" if len(names) > _SHOWN else "")
                yield f"nothing here is called '{_plain(noun)}'; by likeness of meaning it was taken for {taken}"

    def _left_out(self) -> Iterator[str]:
        """Yield warnings about parts of the request that the best plan ignores or guesses."""
        for plan in self.plans[:1]:
            for goal in plan.goals:
                if goal.note and (goal.formula is None or not goal.already):
                    yield f'clause {goal.clause + 1}, "{goal.text}": {goal.note}'
            for piece in self.parsed.skipped:
                yield f'"{" ".join(piece.text.split())}" was skipped: {piece.reason}'

    def _reasons(self, clause: int) -> str:
        """Return why the templates for a clause were rejected: the most frequent reasons first."""
        counts: dict[str, int] = {}
        for each in self.rejected:
            if each.clause == clause:
                counts[each.reason] = counts.get(each.reason, 0) + 1
        reasons = sorted(counts, key=lambda reason: (-counts[reason], reason))
        more = f"; and {len(reasons) - _SHOWN} other reasons" if len(reasons) > _SHOWN else ""
        return "; ".join(reasons[:_SHOWN]) + more

    def _other(self, verb: str) -> str:
        """Return a verb to use instead: one that is written alike, or else the most frequent ones."""
        verbs = sorted(self.library.verbs(), key=lambda known: (-len(self.library.templates(known)), known))
        if not verbs:
            return "the domain has no demonstrations"
        close = get_close_matches(verb, verbs, n=1)
        return f"did you mean '{_plain(close[0])}'?" if close else f"say {', '.join(map(_plain, verbs[:_VERBS]))} …"


def why_refused(clause: int | None, message: str, hint: str | None) -> str:
    """Return why there is no plan: *clause 1: nothing here is called 'zebra' (name a thing …)*."""
    place = "" if clause is None else f"clause {clause + 1}: "
    return f"{place}{message}" + (f" ({hint})" if hint else "")


def _plain(name: str) -> str:
    return name.replace("_", " ")
