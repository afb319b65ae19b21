"""One lost parenthesis in each domain of a folder: is it told in the right action, and by the right hint?

``python -m experiments.checkers.parentheses FOLDER ...`` takes every domain below the folders that has an action with
a precondition and no fault of form, drops one ``)`` of the precondition of its middle action, and checks it. The place
is right where the first error stands in that action; the hint is right where it names no line, or one of that action.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from tmd.check.pddl_file import check_domain_text
from tmd.diagnostics import TmdError
from tmd.pddl.reading.syntax import Group, Node, parse, read_text, split_lines
from tmd.world.problem_domain import kind_and_name


def groups_in(node: Node) -> Iterator[Group]:
    """``node`` and the groups within it, where it is a group."""
    if isinstance(node, Group):
        yield node
        for part in node.parts:
            yield from groups_in(part)


def broken(text: str) -> tuple[str, int, int] | None:
    """``text`` without one ``)``, and the first and last line of its action; ``None`` where it has none."""
    try:
        document = parse(text, "")
    except TmdError:
        return None
    if not document.groups:
        return None
    actions = [part for part in document.groups[0].parts if isinstance(part, Group) and part.head == ":action"]
    if not actions:
        return None
    action = actions[len(actions) // 2]
    for keyword, part in zip(action.parts, action.parts[1:], strict=False):
        if isinstance(keyword, Group) or keyword.text != ":precondition":
            continue
        inner = list(groups_in(part))
        if len(inner) > 1:
            end = inner[len(inner) // 2].end
            lines = list(split_lines(text))
            line = lines[end.line - 1]
            lines[end.line - 1] = line[: end.column - 1] + line[end.column :]
            return "\n".join(lines), action.location.line, action.end.line
    return None


def main() -> int:
    """Print a line for each domain that is told wrongly, and the counts."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="+", type=Path, metavar="FOLDER")
    tried = placed = hinted = several = 0
    seen: set[str] = set()
    for file in sorted(path for folder in parser.parse_args().folders for path in folder.rglob("*.pddl")):
        try:
            text = read_text(file)
        except TmdError:
            continue
        made = broken(text) if kind_and_name(text)[0] == "domain" and text not in seen else None
        seen.add(text)
        if made is None:
            continue
        tried += 1
        faults = [f for f in check_domain_text(made[0], str(file)).faults if f.location and f.code != "odd-name"]
        parentheses = [f for f in faults if f.code in ("unclosed-parenthesis", "extra-parenthesis")]
        first = min(parentheses, key=lambda f: f.location.line if f.location else 0, default=None)
        inside = first is not None and first.location is not None and made[1] <= first.location.line <= made[2]
        named = [int(line) for line in re.findall(r"in line (\d+)", first.hint or "")] if first else []
        right = inside and all(made[1] <= line <= made[2] for line in named)
        placed += inside
        hinted += right
        several += len(parentheses) > 1
        if not right:
            told = f"{first.location}: {first.message}; {first.hint}" if first else "nothing"
            print(f"{file}:{made[1]}-{made[2]}: {told}")
    print(f"{tried} domains: place right {placed}, hint right {hinted}, more than one message {several}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
