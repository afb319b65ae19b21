"""Verbs and their goals: those that have none, and those that have one although they stand for another verb."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path

from tmd.check.lexicon_goals import Written
from tmd.diagnostics import TmdError
from tmd.goals.sources.table import family
from tmd.language.lexicon.lexicon import Lexicon, section
from tmd.pddl.reading.syntax import read_text

_PARTICLE_WITHIN = 4
"""A particle stands at most that many words behind its verb."""
_A_VERB = 2
"""So sure must a word be a verb (:meth:`tmd.language.lexicon.lexicon.Lexicon.verb`)."""
_POLITE = ("lead_verbs", "let_verbs", "modals", "adverbs")
"""The sections of words that only lead to what is asked for: *please*, *I need you to*."""


def check_goal_verbs(
    path: Path, lexicon: Lexicon, actions: Collection[str], segments: Iterable[str]
) -> Iterator[TmdError]:
    """Notes on the verbs of a lexicon that declares goals.

    Args:
        path: The lexicon's file.
        lexicon: What it says.
        actions: The names of the domain's actions.
        segments: The pieces of its demonstrations' texts that were carried out one after another.
    """
    if not lexicon.goals:
        return
    written = Written(path)
    yield from _standing_for_another(lexicon, written)
    verbs = dict.fromkeys((name for action in actions for name in _verb_of_action(action, lexicon)), "an action")
    for text in segments:
        for verb in _first_verb(text, lexicon):
            verbs.setdefault(verb, "a demonstration")
    for verb, where in sorted(verbs.items()):
        if not _has_goal(verb, lexicon):
            message = f"no goal says what '{verb}' means, which {where} speaks of"
            hint = f"write '- {verb} X: (…)' under goals, or '{verb}: OTHER' under verb_synonyms"
            yield written.error(written.in_section("goals"), message, hint, "no-goal")


def segments_of(path: Path) -> list[str]:
    """The pieces of a corpus' texts that have instructions, as far as it can be read."""
    found: list[str] = []
    try:
        lines = read_text(path).splitlines()
    except TmdError:
        return []
    for line in lines:
        try:
            segments = json.loads(line)["segments"]
            found += [str(segment["text"]) for segment in segments if segment["instructions"]]
        except (ValueError, KeyError, TypeError, RecursionError):
            continue
    return found


def _standing_for_another(lexicon: Lexicon, written: Written) -> Iterator[TmdError]:
    """Verbs with a row of their own that share the templates of another verb."""
    told: set[str] = set()
    for entry in lexicon.goals:
        for verb in entry.pattern.partition(" ")[0].split("|"):
            other = lexicon.canonical_verb(verb)
            if other != verb and verb not in told:
                told.add(verb)
                message = f"'{verb}' has a goal of its own, and stands for '{other}' as well"
                hint = f"its own goals are tried before those of '{other}'; remove one of the two if they mean the same"
                yield written.error(written.in_pattern(entry, verb), message, hint, "synonym-with-goal")


def _verb_of_action(name: str, lexicon: Lexicon) -> Iterator[str]:
    """What an action's name says as a verb: itself with its particle, or its first word."""
    stem, _, rest = name.partition("_")
    if not _is_verb(stem, lexicon):
        return
    yield f"{stem}_{rest}" if rest and lexicon.particle(stem, rest) is not None else stem


def _first_verb(text: str, lexicon: Lexicon) -> Iterator[str]:
    """The verb that a piece of a text begins with, if it begins with one."""
    words = text.lower().replace(",", " ").replace(".", " ").split()
    found = lexicon.verb(words[0]) if words else None
    if found is None or found[2] < _A_VERB or found[1] != "base" or any(found[0] in section(s) for s in _POLITE):
        return
    stem = found[0]
    near = words[1 : 1 + _PARTICLE_WITHIN]
    yield next((f"{stem}_{word}" for word in near if lexicon.particle(stem, word)), stem)


def _is_verb(word: str, lexicon: Lexicon) -> bool:
    found = lexicon.verb(word)
    return found is not None and found[0] == word and found[2] >= _A_VERB


def _has_goal(verb: str, lexicon: Lexicon) -> bool:
    """Whether a row is for a verb, for its verb without a particle, or for one that means the same."""
    plain = verb.partition("_")[0]
    own = {verb, plain, lexicon.canonical_verb(verb), lexicon.canonical_verb(plain)}
    return bool(lexicon.goal_verbs & (own | {other for one in own for other in family(one)}))
