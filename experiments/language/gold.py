"""The gold clauses of tests/language/gold, and how a parse is scored against them.

``own.yaml`` holds invented texts with clauses in the paper's notation, and so does ``second_author.yaml``, by
somebody who has not seen the parser. ``veil500.jsonl`` holds no text: for a
point (0-based, in the order of VEIL-500's data.xml) it names tokens of the point's text by index. The tokens are
the matches of :data:`TOKEN` in the text as it stands in the file, counted from 0. A clause is ``verb`` (token
indexes of verb and particle), ``objects`` (a list of token indexes each) and ``relations``: token indexes of the
preposition (``null`` for the unwritten "to" of "bring me a cup"), index into ``objects`` of the source (``null``
if elided) and of the target. ``stem`` overrides the verb where the token is inflected or misspelt.
"""

from __future__ import annotations

import json
import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from tmd.language import Clause, Relation, parse, read_clause
from tmd.language.lexicon.lexicon import singular

TOKEN = re.compile(r"[^\W\d_]+(?:'[^\W\d_]+)?|\d+|[^\w\s]|_")
GOLD = Path(__file__).resolve().parents[2] / "tests" / "language" / "gold"
_SPELLING = {"in_to": "into", "on_to": "onto"}


class Item(NamedTuple):
    """A text and the clauses it should give."""

    name: str
    split: str
    text: str
    clauses: tuple[Clause, ...]


class Score(NamedTuple):
    """Clauses that are exactly right, with the Wilson interval of the share."""

    right: int
    total: int

    def share(self) -> float:
        """Return the share of right clauses."""
        return self.right / self.total if self.total else 0.0

    def wilson(self, z: float = 1.96) -> tuple[float, float]:
        """Return the 95 % Wilson interval."""
        n, p = self.total, self.share()
        middle, width = p + z * z / (2 * n), z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
        return (middle - width) / (1 + z * z / n), (middle + width) / (1 + z * z / n)


def own_items() -> list[Item]:
    """Read the invented items of the author of the rules."""
    return _invented("own", "own.yaml")


def second_items() -> list[Item]:
    """Read the invented items of the second author."""
    return _invented("second", "second_author.yaml")


def _invented(name: str, file: str) -> list[Item]:
    raw = yaml.safe_load((GOLD / file).read_text(encoding="utf-8"))
    return [
        Item(f"{name} {n}", r["split"], r["text"], tuple(read_clause(c) for c in r["clauses"]))
        for n, r in enumerate(raw)
    ]


def veil_items(directory: Path, file: str = "veil500.jsonl") -> list[Item]:
    """Read the items that point into VEIL-500's ``data.xml``."""
    points = ET.parse(directory / "data.xml").getroot().findall("point")
    texts = [p.findtext("text") or "" for p in points]
    return list(_veil(texts, (GOLD / file).read_text(encoding="utf-8").splitlines()))


def _veil(texts: Sequence[str], lines: Sequence[str]) -> Iterator[Item]:
    for line in lines:
        raw = json.loads(line)
        text = texts[raw["point"]]
        tokens = [m.group().lower() for m in TOKEN.finditer(text)]
        clauses = tuple(_clause(c, tokens) for c in raw["clauses"])
        yield Item(f"point {raw['point']}", raw["split"], text, clauses)


def _clause(raw: dict[str, Any], tokens: list[str]) -> Clause:
    def words(indexes: list[int]) -> str:
        parts = (tokens[i].partition("'")[0] for i in indexes)
        return "_".join(part for part in parts if part.isalnum())

    objects = tuple(singular(words(o)) for o in raw["objects"])
    relations = []
    for indexes, source, target in raw["relations"]:
        name = "to" if indexes is None else words(indexes)
        name = _SPELLING.get(name, name)
        relations.append(Relation(name, None if source is None else objects[source], objects[target]))
    return Clause(raw.get("stem") or words(raw["verb"]), objects, tuple(relations))


def key(clause: Clause) -> tuple[str, frozenset[str], frozenset[Relation]]:
    """Return what has to agree: verb with particle, all objects in full, all relation triples."""
    return clause.verb, frozenset(clause.objects), frozenset(clause.relations)


def right(item: Item) -> tuple[int, int]:
    """Return (gold clauses found exactly and in order, clauses of which the parse has too many)."""
    gold, found = [key(c) for c in item.clauses], [key(c) for c in parse(item.text).clauses]
    best = [[0] * (len(found) + 1) for _ in range(len(gold) + 1)]
    for g in range(len(gold)):
        for f in range(len(found)):
            best[g + 1][f + 1] = best[g][f] + 1 if gold[g] == found[f] else max(best[g][f + 1], best[g + 1][f])
    return best[-1][-1], max(0, len(found) - len(gold))


def score(items: Sequence[Item]) -> Score:
    """Return the exact-clause accuracy: superfluous clauses count as wrong ones."""
    counts = [right(item) for item in items]
    return Score(sum(c for c, _ in counts), sum(len(i.clauses) for i in items) + sum(extra for _, extra in counts))
