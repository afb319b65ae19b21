"""The presets: one definition of each model, with weights, and clear about names that are no more."""

from __future__ import annotations

import pytest

from tmd.diagnostics import TmdError
from tmd.goals.tables import SOURCES
from tmd.inference.config import DEFAULT, PAPER, PRESETS, preset
from tmd.inference.energy import OURS, named_weights


def test_each_preset_has_weights_and_the_first_is_the_default() -> None:
    assert next(iter(PRESETS)) == DEFAULT
    for name, config in PRESETS.items():
        assert config is preset(name)
        assert any(value for value in named_weights(config.weights).values.values())


def test_meaning_comes_from_all_sources() -> None:
    assert PRESETS[DEFAULT].sources == SOURCES


def test_the_paper_has_nothing_of_ours() -> None:
    assert not (PAPER.extended or PAPER.policy or PAPER.goals)
    assert PAPER.akin == 0
    assert not any(named_weights(PAPER.weights)[name] for name in OURS)


@pytest.mark.parametrize(
    ("old", "new"), [("stating", "goals"), ("generating", "policy"), ("extended", "paper_extended")]
)
def test_an_old_name_is_refused_with_the_new_one(old: str, new: str) -> None:
    with pytest.raises(TmdError, match=f"^the model '{old}' is now called '{new}'$"):
        preset(old)


def test_an_unknown_name_is_refused_with_one_like_it() -> None:
    with pytest.raises(TmdError) as caught:
        preset("papper")
    assert "paper" in (caught.value.hint or "")
