"""Checking the words of a domain: verbs that nothing serves, nouns that lead nowhere."""

from __future__ import annotations

import json
import re
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path

from tmd.diagnostics import Location, TmdError
from tmd.language.lexicon.file import read_lexicon
from tmd.language.lexicon.lexicon import verb_candidates
from tmd.pddl.reading.syntax import nearest, read_text

_WORD = re.compile(r"[a-z]+")
_PARTICLE_WITHIN = 5
"""A particle stands at most that many words behind its verb."""


def check_lexicon(path: Path, actions: Collection[str], names: Collection[str], texts: Iterable[str]) -> list[TmdError]:
    """What is odd about a lexicon.

    Args:
        path: The file.
        actions: The names of the domain's actions.
        names: What nouns may lead to: classes, parts, substances, objects. Empty where that is not known.
        texts: The texts of the domain's demonstrations.

    Raises:
        TmdError: The file is not a lexicon.
    """
    lexicon = read_lexicon(path)
    source = _Lines(path)
    found = []
    for noun, targets in sorted(lexicon.nouns.items()):
        for target in targets:
            if names and target not in names:
                hint = nearest(target, sorted(names))
                message = f"'{noun}' leads to '{target}', which is no class, part, substance or object of the domain"
                found.append(source.error(noun, target, message, hint, "unknown-target"))
    served = _Served(texts, actions)
    verbs = {verb: verb for verb in lexicon.verbs} | dict(lexicon.phrasal) | dict(lexicon.verb_synonyms)
    # one word of several that stand for the same verb is enough: its template serves all of them
    meant = lexicon.goal_verbs
    shown = {
        serving for verb, serving in verbs.items() if {verb, serving} & meant or verb in served or serving in served
    }
    for verb, serving in sorted(verbs.items()) if served.texts else ():
        if serving not in shown:
            message = f"no demonstration, no action and no goal serves the verb '{verb}'"
            if serving != verb:
                message += f", nor '{serving}', which it stands for"
            hint = "add a demonstration or a goal of it, let it stand for a verb that has one, or remove it"
            found.append(source.error(verb, verb, message, hint, "unserved-verb"))
    return found


def texts_of(path: Path) -> list[str]:
    """The texts of a corpus, as far as it can be read."""
    texts = []
    try:
        lines = read_text(path).splitlines()
    except TmdError:
        return []
    for line in lines:
        try:
            said = json.loads(line)
        except (json.JSONDecodeError, RecursionError):
            continue
        if isinstance(said, dict) and isinstance(said.get("text"), str):
            texts.append(said["text"])
    return texts


class _Served:
    """The verbs that texts or actions have; a stem that a word may be a form of counts."""

    def __init__(self, texts: Iterable[str], actions: Collection[str]) -> None:
        self.texts = [_WORD.findall(text.lower()) for text in texts]
        self._actions = frozenset(actions)
        words = {word for text in self.texts for word in text}
        self._stems = {word: frozenset((word, *(stem for stem, _ in verb_candidates(word)))) for word in words}
        self._all = frozenset(stem for stems in self._stems.values() for stem in stems)

    def __contains__(self, verb: str) -> bool:
        if verb in self._actions or verb.replace("_", "") in self._actions:
            return True
        stem, *particles = verb.split("_")
        if not particles:
            return stem in self._all
        return any(self._has(text, stem, particles[0]) for text in self.texts)

    def _has(self, text: list[str], stem: str, particle: str) -> bool:
        return any(
            stem in self._stems[word] and particle in text[place + 1 : place + 1 + _PARTICLE_WITHIN]
            for place, word in enumerate(text)
        )


class _Lines:
    """The lines of a lexicon, to find a key in it."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.lines = read_text(path).splitlines()

    def error(self, key: str, word: str, message: str, hint: str | None, code: str) -> TmdError:
        for number, line in self._lines_with(key):
            column = line.find(word, line.find(key) + (len(key) if word != key else 0))
            place = Location(str(self.path), number, max(column, 0) + 1)
            return TmdError(message, location=place, hint=hint, source=line, code=code)
        return TmdError(message, location=Location(str(self.path), 1, 1), hint=hint, code=code)

    def _lines_with(self, key: str) -> Iterator[tuple[int, str]]:
        word = re.compile(rf"(?<![\w]){re.escape(key)}(?![\w])")
        for number, line in enumerate(self.lines, start=1):
            if word.search(line.partition("#")[0]):
                yield number, line
