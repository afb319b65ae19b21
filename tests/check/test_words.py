"""A lexicon's verbs: which of them nothing serves."""

from __future__ import annotations

from pathlib import Path

import pytest

from tmd.check.lexicon import check_lexicon
from tmd.language.lexicon.file import read_lexicon

LEXICON = """\
verbs: [heat]
verb_synonyms:
  warm: heat
  nuke: heat
  seize: take
"""
NUKE, SEIZE = ("nuke", "heat", "warm"), ("seize",)


@pytest.mark.parametrize(
    ("text", "actions", "unserved"),
    [
        ("Nuke the soup.", (), SEIZE),
        ("Warming the soup is enough.", (), SEIZE),
        ("Heat it.", (), SEIZE),
        ("Take the soup.", (), NUKE),
        ("Look at it.", ("heat",), SEIZE),
        ("Look at it.", (), NUKE + SEIZE),
    ],
)
def test_one_word_of_those_that_mean_the_same_serves_all(
    tmp_path: Path, text: str, actions: tuple[str, ...], unserved: tuple[str, ...]
) -> None:
    path = tmp_path / "lexicon.yaml"
    path.write_text(LEXICON)
    lexicon = read_lexicon(path)
    found = check_lexicon(path, lexicon, lexicon.goal_verbs, actions, (), [text])
    assert {fault.code for fault in found} == {"unserved-verb"}
    assert sorted(fault.message.split("'")[1] for fault in found) == sorted(unserved)
