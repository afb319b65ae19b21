"""Print on how many texts by other people each row of the language data fires, and which rows fire on too few.

Usage: ``VEIL500_DIR=… python -m experiments.language.coverage --texts FILE... [--min 2]``. A file has one JSON object
with a ``text`` on each line, or a list of them under ``items``; its ``domain``, where it says one, gives the words of
the domain. Of VEIL-500, which is read where ``VEIL500_DIR`` names it, environments 1 to 8 count.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path

from tmd.language.lexicon.file import read_lexicon
from tmd.language.lexicon.lexicon import Lexicon, builtin
from tmd.language.parser import parse
from tmd.language.syntax.phrases import builtin_rows
from tmd.language.syntax.tagger import classes
from tmd.world.roots import Roots

_LAST_ENVIRONMENT = 8
"""Later ones are for testing."""


def texts_of(files: Sequence[Path], veil: Path | None) -> list[tuple[str, str]]:
    """Return the distinct texts, each with the name of its domain, or an empty one."""
    found = {text: domain for text, domain in (*_of_files(files), *(_of_veil(veil) if veil else ()))}
    return list(found.items())


def _of_files(files: Sequence[Path]) -> Iterator[tuple[str, str]]:
    for file in files:
        content = file.read_text(encoding="utf-8")
        items = [json.loads(line) for line in content.splitlines()] if file.suffix == ".jsonl" else json.loads(content)
        for item in items["items"] if isinstance(items, dict) else items:
            yield item["text"], item.get("domain", "")


def _of_veil(directory: Path) -> Iterator[tuple[str, str]]:
    for point in ET.parse(directory / "data.xml").getroot().findall("point"):
        environment = re.fullmatch(r"(kitchen)?.*?(\d+)", point.findtext("environment") or "")
        if environment and int(environment[2]) <= _LAST_ENVIRONMENT:
            yield point.findtext("text") or "", "kitchen" if environment[1] else "living_room"


@cache
def _lexicon(domain: str) -> Lexicon:
    if not domain:
        return builtin()
    folder = Roots().folder(domain)
    return read_lexicon(folder.lexicon_path, folder.kinds)


def coverage(texts: Iterable[tuple[str, str]]) -> dict[str, int]:
    """Return for each row on how many texts it fires."""
    counts: Counter[str] = Counter()
    for text, domain in texts:
        trace: list[str] = []
        parse(text, _lexicon(domain), trace)
        counts.update(set(trace))
    names = [row.id for row in classes().rows] + [row.id for row in builtin_rows()]
    return {name: counts[name] for name in names}


def main() -> None:
    """Print the counts, the rarest last."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--texts", nargs="+", type=Path, default=[], metavar="FILE", help="texts by other people")
    parser.add_argument("--min", type=int, default=2, help="a row that fires on fewer texts is listed")
    arguments = parser.parse_args()
    directory = os.environ.get("VEIL500_DIR")
    texts = texts_of(arguments.texts, Path(directory) if directory else None)
    counts = coverage(texts)
    for name, count in sorted(counts.items(), key=lambda row: (-row[1], row[0])):
        print(f"{count:>6}  {name}")
    rare = [name for name, count in counts.items() if count < arguments.min]
    print(f"{len(texts)} texts, {len(counts)} rows; on fewer than {arguments.min} texts: {', '.join(rare) or 'none'}")


if __name__ == "__main__":
    main()
