"""Print the exact-clause accuracy of the clause parser: ``python -m experiments.language.accuracy [--show SPLIT]``.

VEIL-500 is read from the directory in the environment variable VEIL500_DIR, if it is set. ``--show tune`` lists the
clauses that differ; ``--show held_out`` lists nothing, since looking at them would spend them.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

from experiments.language.gold import Item, key, own_items, score, second_items, veil_items
from tmd.language import parse, print_clause

HELD_OUT = "held_out"


def _sets() -> Iterator[tuple[str, list[Item]]]:
    yield "own", own_items()
    yield "second", second_items()
    directory = os.environ.get("VEIL500_DIR")
    if directory:
        yield "veil", veil_items(Path(directory))


def _show(item: Item) -> None:
    gold, found = item.clauses, parse(item.text).clauses
    if [key(c) for c in gold] == [key(c) for c in found]:
        return
    found_keys, gold_keys = {key(c) for c in found}, {key(c) for c in gold}
    print(f"\n{item.name}: {' '.join(item.text.split())}")
    for clause in gold:
        if key(clause) not in found_keys:
            print("  gold ", print_clause(clause))
    for clause in found:
        if key(clause) not in gold_keys:
            print("  found", print_clause(clause))


def main(arguments: list[str]) -> None:
    """Print the table, or the differences of one split."""
    show = arguments[1] if arguments[:1] == ["--show"] and arguments[1:] else ""
    if show == HELD_OUT:
        print("the held-out texts are scored, never shown")
        show = ""
    print("set    split      exact      share   95 % Wilson")
    for name, items in _sets():
        for split in dict.fromkeys(i.split for i in items):
            part = [i for i in items if i.split == split]
            result = score(part)
            low, high = result.wilson()
            print(
                f"{name:6} {split:9} {result.right:4}/{result.total:<4} {result.share():8.1%}   {low:.1%} - {high:.1%}"
            )
            for item in part if split == show else ():
                _show(item)


if __name__ == "__main__":
    main(sys.argv[1:])
