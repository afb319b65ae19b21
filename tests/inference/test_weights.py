from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.diagnostics import TmdError
from tmd.inference.energy import NAMES, Weights, format_weights, named_weights, parse_weights, read_weights


@given(st.dictionaries(st.sampled_from(NAMES), st.floats(allow_nan=False, allow_infinity=False)))
def test_writing_and_reading_gives_the_same_weights(values: dict[str, float]) -> None:
    weights = parse_weights(format_weights(Weights(values)))
    assert all(weights[name] == values.get(name, 0.0) for name in NAMES)


@pytest.mark.parametrize("name", ["paper_extended", "nearest"])
def test_the_bundled_weights_can_be_read(name: str) -> None:
    assert named_weights(name)["env"] > 0


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("env", "a name and a number"),
        ("enw 1", "no factor 'enw'"),
        ("nl one", "not a number"),
        ("nl nan", "not finite"),
        ("env 2", "already"),
    ],
)
def test_a_wrong_line_is_reported_with_its_number(line: str, message: str) -> None:
    with pytest.raises(TmdError) as caught:
        parse_weights(f"# weights\nenv 1\n{line}\n", "w.txt")
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
