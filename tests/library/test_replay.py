"""A demonstration that cannot be executed (any more) is named: file, line, step, and what is broken."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tmd.diagnostics import TmdError
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).parents[2]


@pytest.fixture
def corpus(tmp_path: Path) -> Corpus:
    shutil.copytree(ROOT / "problems" / "kitchen", tmp_path / "kitchen")
    return Corpus(DomainFolder(ROOT / "domains" / "kitchen"), tmp_path / "kitchen")


@pytest.mark.parametrize(
    ("was", "is_now", "said", "at", "hint"),
    [
        ('"grasp(pot1)"', '"release(pot1)"', r"segment 1, step 3, release\(pot1\): .* does not hold", "release", "fix"),
        ('"grasp(pot1)"', '"grsp(pot1)"', 'step 3, grsp.*unknown action "grsp"', "grsp", 'did you mean "grasp"?'),
        ('"grasp(pot1)"', '"grasp(pott1)"', 'step 3, grasp.*: unknown object "pott1"', "pott1", 'did you mean "pot1"?'),
        ('"grasp(pot1)"', '"grasp(stove1)"', 'step 3, grasp.*: "stove1" is of type', "stove1)", "fix"),
    ],
)
def test_the_step_and_its_place_are_named(corpus: Corpus, was: str, is_now: str, said: str, at: str, hint: str) -> None:
    file = corpus.directory / "ramen" / "demonstrations.jsonl"
    first, rest = file.read_text(encoding="utf-8").split("\n", 1)
    assert was in first
    wrong = first.replace(was, is_now, 1)
    file.write_text(wrong + "\n" + rest, encoding="utf-8")
    with pytest.raises(TmdError, match=said) as caught:
        corpus.demonstrations("ramen")
    assert caught.value.location is not None
    assert (caught.value.location.file, caught.value.location.line) == (str(file), 1)
    assert caught.value.location.column == wrong.index(at) + 1
    assert caught.value.hint is not None and hint in caught.value.hint


def test_an_environment_that_changed_is_found_by_its_demonstrations(corpus: Corpus) -> None:
    place = corpus.directory / "environments" / "kitchen1.yaml"
    text = place.read_text(encoding="utf-8")
    place.write_text(text.replace("ramen1", "ramen9"), encoding="utf-8")
    with pytest.raises(TmdError, match=r"cannot be executed in kitchen1: segment 5, step \d+, \w+\(.*ramen1"):
        corpus.demonstrations("ramen")


def test_the_bundled_demonstrations_can_be_executed(corpus: Corpus) -> None:
    assert len(corpus.demonstrations("ramen")) == 50
