"""Print how often each rule of :mod:`tmd.goals.preferences` finds what is meant, and the odds that this gives.

Usage: ``python -m experiments.language.decisions [--cases FILE...]``. By default the sentence tests of the bundled
domains are run. Each test is grounded with the likeliest readings, and once more for each rule that decided between two
readings, with the other one. A rule is right where only its reading ends in the goal, and wrong where only the other
one does. Its odds are (right + 1) / (wrong + 1).
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from math import log
from pathlib import Path
from unittest.mock import patch

import tmd
from tmd.evaluation.sentence_tests import SentenceResult
from tmd.goals.clause_goal import Decisions
from tmd.goals.preferences import ODDS
from tmd.world.folder import find_roots
from tmd.world.sentence_file import SUFFIX, SentenceTest, domain_sentences, read_sentences

_CERTAIN = 100.0


@contextmanager
def _odds(changed: str = "") -> Iterator[set[str]]:
    """Take the likeliest reading everywhere, but where one rule decides; yield the rules that had a choice."""
    met: set[str] = set()
    taken = Decisions.taken

    def noted(decisions: Decisions, kind: str, noun: str, count: int) -> int:
        if count > 1:
            met.add(kind)
        return taken(decisions, kind, noun, count)

    odds = {name: _CERTAIN if name != changed else -_CERTAIN for name in ODDS}
    with patch.dict(ODDS, odds), patch.object(Decisions, "taken", noted):
        yield met


def _goals(result: SentenceResult) -> tuple[str, ...]:
    return result.goals or (result.reason,)


def decisions(tests: Sequence[SentenceTest]) -> dict[str, Counter[str]]:
    """Return for each rule on how many tests it changed the goals, and was right or wrong where one reading was."""
    found: dict[str, Counter[str]] = {name: Counter() for name in ODDS}
    kits = {name: tmd.load_domain(name) for name in dict.fromkeys(test.domain for test in tests)}
    for number, test in enumerate(tests, 1):
        with _odds() as met:
            (likeliest,) = kits[test.domain].run_sentence_tests([test])
        for name in sorted(met):
            with _odds(name):
                (other,) = kits[test.domain].run_sentence_tests([test])
            if _goals(other) != _goals(likeliest):
                passed = likeliest.outcome.passed, other.outcome.passed
                found[name]["changed"] += 1
                found[name]["right"] += passed == (True, False)
                found[name]["wrong"] += passed == (False, True)
        print(f"\r{number}/{len(tests)}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", nargs="+", type=Path, default=[], metavar="FILE", help="files of sentence tests")
    arguments = parser.parse_args()
    tests = [test for path in arguments.cases for test in read_sentences(path)]
    if not tests:
        folders = sorted(path.parent for path in find_roots("problems")[0].glob(f"*/*{SUFFIX}"))
        tests = [test for folder in dict.fromkeys(folders) for test in domain_sentences(folder)]
    print(f"{'rule':<18}{'changed':>8}{'right':>7}{'wrong':>7}{'odds (ln)':>11}{'used':>7}")
    for name, counts in decisions(tests).items():
        odds = log((counts["right"] + 1) / (counts["wrong"] + 1))
        print(
            f"{name:<18}{counts['changed']:>8}{counts['right']:>7}{counts['wrong']:>7}{odds:>11.1f}{ODDS[name]:>7.1f}"
        )


if __name__ == "__main__":
    main()
