from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.diagnostics import TmdError
from tmd.inference.energy import (
    FIXED,
    NAMES,
    Weights,
    format_weights,
    meaning,
    named_weights,
    parse_weights,
    read_weights,
    title,
)


@given(st.dictionaries(st.sampled_from(NAMES), st.floats(allow_nan=False, allow_infinity=False)))
def test_writing_and_reading_gives_the_same_weights(values: dict[str, float]) -> None:
    weights = parse_weights(format_weights(Weights(values)))
    assert all(weights[name] == values.get(name, 0.0) for name in NAMES)


@pytest.mark.parametrize("name", ["paper_extended", "nearest"])
def test_the_bundled_weights_can_be_read(name: str) -> None:
    assert named_weights(name)["environment_distance"] > 0


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("environment_distance", "a name and a number"),
        ("trimmin 1", "no factor 'trimmin'"),
        ("clause_distance one", "not a number"),
        ("clause_distance nan", "not finite"),
        ("environment_distance 2", "already"),
    ],
)
def test_a_wrong_line_is_reported_with_its_number(line: str, message: str) -> None:
    with pytest.raises(TmdError) as caught:
        parse_weights(f"# weights\nenvironment_distance 1\n{line}\n", "w.txt")
    assert message in caught.value.message
    assert str(caught.value.location) == "w.txt:3:1"


def test_unknown_names_and_missing_files_are_reported(tmp_path: Path) -> None:
    with pytest.raises(TmdError, match="goalz") as caught:
        named_weights("goalz")
    assert "goals" in (caught.value.hint or "")
    with pytest.raises(TmdError, match="cannot be read"):
        read_weights(tmp_path / "none.txt")


@pytest.mark.parametrize(("old", "new"), [("original", "paper"), ("hand_set", "paper_extended"), ("stating", "goals")])
def test_an_old_name_is_refused_with_the_new_one(old: str, new: str) -> None:
    with pytest.raises(TmdError, match=f"^the weights '{old}' are now called '{new}'$"):
        named_weights(old)


def test_a_factor_by_its_old_name_is_refused_with_the_new_one() -> None:
    with pytest.raises(TmdError, match=r"the factor 'dscpl' is now called 'description_length'$") as caught:
        parse_weights("clause_distance 1\ndscpl 2\n", "w.txt")
    assert str(caught.value.location) == "w.txt:2:1"
    with pytest.raises(TmdError, match=r"^the factor 'latent_inpr' is now called 'latent_instruction_prior'$"):
        Weights({"latent_inpr": 1.0})


def test_titles_are_the_names_in_words() -> None:
    assert title("description_length") == "description length"
    assert title("reading_prior") == "prior of the reading"
    assert all(meaning(name) for name in (*NAMES, *FIXED))
