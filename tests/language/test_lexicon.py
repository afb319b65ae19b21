"""Domain lexicons, their errors, and the vendored WordNet files."""

from pathlib import Path

import pytest

from experiments.language import rebuild
from tmd.diagnostics import TmdError
from tmd.language.lexicon.file import read_lexicon
from tmd.language.lexicon.lexicon import builtin, data_text, section, singular

DICT = Path("/usr/share/wordnet")


def write(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "lexicon.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_full_file(tmp_path: Path) -> None:
    path = write(
        tmp_path,
        "verbs: [plonk]\nphrasal:\n  fire_up: turn_on\n  buzz_in:\nnouns:\n  pot: [Kettle, Mug]\n  movie: Cd\n"
        "verb_synonyms:\n  heat_up: heat\n",
    )
    lexicon = read_lexicon(path)
    assert lexicon.verbs == {"plonk"}
    assert lexicon.phrasal == {"fire_up": "turn_on", "buzz_in": "buzz_in"}
    assert lexicon.nouns == {"pot": ("Kettle", "Mug"), "movie": ("Cd",)}
    assert [lexicon.canonical_verb(v) for v in ("heat_up", "fire_up", "take")] == ["heat", "turn_on", "take"]
    assert lexicon.verb("plonked") == ("plonk", "ed", 3)


def test_an_empty_file_is_an_empty_lexicon(tmp_path: Path) -> None:
    assert read_lexicon(write(tmp_path, "# nothing yet\nverbs:\n")).verbs == frozenset()


@pytest.mark.parametrize(
    ("text", "line", "column", "message", "hint"),
    [
        ("verbs: [a\n", 2, 1, "not YAML", None),
        ("verb: [take]\n", 1, 1, "unknown key 'verb'", "did you mean 'verbs'?"),
        ("verbs: take\n", 1, 8, "expected a list", None),
        ("verbs: [Take]\n", 1, 9, "'Take' is not a name", None),
        ("verbs: [[a]]\n", 1, 9, "expected a name", None),
        ("nouns:\n  pot: {a: b}\n", 2, 8, "expected a list", None),
        ("nouns: [pot]\n", 1, 8, "expected 'name: value' pairs", None),
        ("nouns:\n  pot: a\n  pot: b\n", 3, 3, "the key 'pot' stands here twice", None),
        ("{{verbs}}: 1\n", 1, 1, "a mapping cannot be a key", None),
        ("verbs: &a [take]\nnouns: *a\n", 2, 8, "aliases are not accepted", "write the value out"),
        ("phrasal:\n  fire: heat\n", 2, 3, "'fire' has no particle", None),
        ("verb_synonyms: {a: b, b: c}\n", 1, 17, "'a' stands for 'b'", "write 'a: c'"),
        ("- verbs\n", 1, 1, "expected 'name: value' pairs", None),
    ],
)
def test_faults_have_a_place(tmp_path: Path, text: str, line: int, column: int, message: str, hint: str | None) -> None:
    with pytest.raises(TmdError) as caught:
        read_lexicon(write(tmp_path, text))
    error = caught.value
    assert error.location is not None
    assert (error.location.line, error.location.column) == (line, column)
    assert message in error.message
    assert hint is None or error.hint == hint


def test_a_missing_and_a_binary_file(tmp_path: Path) -> None:
    with pytest.raises(TmdError, match="cannot read the lexicon"):
        read_lexicon(tmp_path / "none.yaml")
    path = tmp_path / "bad.yaml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(TmdError, match="not UTF-8"):
        read_lexicon(path)


@pytest.mark.parametrize(
    ("form", "stem"),
    [
        ("takes", "take"),
        ("taking", "take"),
        ("took", "take"),
        ("stirred", "stir"),
        ("filling", "fill"),
        ("placed", "place"),
        ("dries", "dry"),
        ("pushes", "push"),
        ("switched", "switch"),
        ("put", "put"),
    ],
)
def test_verbs_are_stemmed(form: str, stem: str) -> None:
    found = builtin().verb(form)
    assert found is not None
    assert found[0] == stem


@pytest.mark.parametrize(
    ("plural", "one"),
    [
        ("shelves", "shelf"),
        ("dishes", "dish"),
        ("berries", "berry"),
        ("boxes", "box"),
        ("raspberry_syrups", "raspberry_syrup"),
        ("plates", "plate"),
    ],
)
def test_singular(plural: str, one: str) -> None:
    assert singular(plural) == one == singular(one)


@pytest.mark.parametrize("word", ["glass", "scissors", "gas", "bus"])
def test_no_plurals(word: str) -> None:
    assert singular(word) == word


@pytest.mark.parametrize(
    ("word", "meant"),
    [("microwav", "microwave"), ("glas", "glass"), ("ligth", "light"), ("soapy", None), ("xqzw", None), ("cup", None)],
)
def test_typos(word: str, meant: str | None) -> None:
    assert builtin().correct(word) == meant


def test_every_phrasal_verb_of_the_own_list_is_made_of_known_words() -> None:
    for entry in sorted(section("phrasal")):
        verb, _, particle = entry.rstrip("!").partition("_")
        assert builtin().verb(verb) or not particle, entry
        assert not particle or particle in section("particles") | section("adverbs") | section("prepositions"), entry


@pytest.mark.skipif(not DICT.exists(), reason="WordNet's dict files (Debian package wordnet-base) are not here")
def test_the_vendored_files_are_what_the_script_makes(tmp_path: Path) -> None:
    rebuild.rebuild(DICT, tmp_path)
    assert (tmp_path / "wordnet_verbs.txt").read_text(encoding="utf-8") == data_text("wordnet_verbs.txt")
    for name in ("wordnet_nouns.txt.gz", "wordnet_words.txt.gz"):
        assert (tmp_path / name).read_bytes()[4:8] == b"\0\0\0\0", "a time stamp would change the bytes"
    assert "\n".join(rebuild.noun_lines(DICT)) + "\n" == data_text("wordnet_nouns.txt.gz")
    assert "\n".join(rebuild.word_lines(DICT)) + "\n" == data_text("wordnet_words.txt.gz")


def test_the_licence_is_there() -> None:
    assert "Princeton University" in data_text("LICENSE-WORDNET")


def test_a_slip_of_a_plural_stays_plural() -> None:
    lexicon = read_lexicon(None, ["glass", "wrapper"])
    assert lexicon.correct("glases") == "glasses"
    assert lexicon.correct("wrapers") == "wrappers"
