"""What a domain's demonstrations teach is learned once: kept in the user's cache, wherever that can be."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

import pytest

import tmd
from tmd import knowledge
from tmd.files import cache_directory
from tmd.knowledge import Knowledge, known, place, save, study
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).parents[2]
NAME = "02_table"
SAID = "Put the book on the table."


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache directory of the user."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "tmd" / "learned" / NAME


@pytest.fixture
def table(tmp_path: Path) -> Callable[[], Corpus]:
    """A copy of a small domain, opened again at each call."""
    for kind in ("domains", "problems"):
        shutil.copytree(ROOT / kind / NAME, tmp_path / kind / NAME, ignore=shutil.ignore_patterns("learned"))
    return lambda: Corpus(DomainFolder(tmp_path / "domains" / NAME), tmp_path / "problems" / NAME)


@pytest.fixture
def studied(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The domains that were learned, in order."""
    found: list[str] = []

    def counted(corpus: Corpus, tell: Callable[[float], None] | None = None) -> Knowledge:
        found.append(corpus.folder.name)
        return study(corpus, tell)

    monkeypatch.setattr(knowledge, "study", counted)
    return found


def same(one: Knowledge, other: Knowledge) -> bool:
    """Whether both know the same templates and the same policy."""
    assert one.reward is not None
    assert other.reward is not None
    templates = [[asdict(t) for verb in k.library.verbs() for t in k.library.templates(verb)] for k in (one, other)]
    return templates[0] == templates[1] and one.reward.theta.tolist() == other.reward.theta.tolist()


def test_what_was_learned_once_is_not_learned_again(
    table: Callable[[], Corpus], cache: Path, studied: list[str]
) -> None:
    first, again = known(table()), known(table())
    assert studied == [NAME]
    assert same(first, again)
    assert len(list(cache.iterdir())) == 1


def test_what_tmd_learn_saved_goes_before_the_cache(
    table: Callable[[], Corpus], cache: Path, studied: list[str], tmp_path: Path
) -> None:
    corpus = table()
    save(study(corpus), corpus, place(corpus, tmp_path / "saved"))
    known(table(), tmp_path / "saved")
    assert not studied
    assert not cache.exists()


def test_what_is_damaged_in_the_cache_is_learned_again(
    table: Callable[[], Corpus], cache: Path, studied: list[str]
) -> None:
    known(table())
    (kept,) = cache.iterdir()
    (kept / "library.json").write_text("{")
    known(table())
    known(table())
    assert studied == [NAME] * 2


def test_only_what_was_used_last_stays(table: Callable[[], Corpus], cache: Path, studied: list[str]) -> None:
    lexicon = table().folder.path / "lexicon.yaml"
    original = lexicon.read_text()
    for number in range(4):
        lexicon.write_text(original + "\n" * number)
        known(table())
    assert len(list(cache.iterdir())) == 3
    known(table())  # the last one is still there
    assert len(studied) == 4
    lexicon.write_text(original)  # the first one is not
    known(table())
    assert len(studied) == 5
    assert len(list(cache.iterdir())) == 3


@pytest.mark.parametrize("kind", ["a file", "read-only", "no home"])
def test_without_a_place_for_it_it_is_learned_all_the_same(
    kind: str, table: Callable[[], Corpus], studied: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if kind == "a file":
        (tmp_path / "file").write_text("")
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    elif kind == "read-only":
        monkeypatch.setenv("XDG_CACHE_HOME", "/proc")
    else:
        monkeypatch.delenv("XDG_CACHE_HOME")
        monkeypatch.setenv("HOME", str(tmp_path / "nowhere"))
        assert cache_directory("learned") is None
    assert len(known(table()).library)
    assert len(known(table()).library)
    assert studied == [NAME] * 2
    assert not (tmp_path / "nowhere").exists()


def test_the_cache_is_where_the_platform_has_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    for relative in ("", "caches"):
        monkeypatch.setenv("XDG_CACHE_HOME", relative)
        assert cache_directory("learned") == tmp_path / ".cache" / "tmd" / "learned"
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "caches"))
    assert cache_directory("learned") == tmp_path / "caches" / "tmd" / "learned"


def test_a_kit_asks_once_what_its_domain_teaches(
    table: Callable[[], Corpus], cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []

    def counted(corpus: Corpus, root: Path | None = None) -> Knowledge:
        asked.append(corpus.folder.name)
        return known(corpus, root)

    monkeypatch.setattr("tmd.domain_kit.known", counted)
    table()
    kit = tmd.load_domain(NAME, domains=tmp_path / "domains", problems=tmp_path / "problems")
    plans = [kit.ground(SAID, "corner1").plans[0].instructions for _ in range(3)]
    assert plans[0] == plans[1] == plans[2] != ()
    assert asked == [NAME]


WRONG = {
    "a template without variables": ("library.json", b'"variables":{"', b'"variables":{},"was":{"'),
    "a number for a class": ("library.json", b'"source":"', b'"source":1,"was":"'),
    "a profile that is none": ("library.json", b'"profiles":[', b'"profiles":[["at"],'),
    "a policy of words": ("policy.json", b'"longest":', b'"longest":"9","was":'),
    "an action that is none": ("policy.json", b'"needs":', b'"needs":[["keep",0,["fly"]]],"was":'),
    "no number": ("policy.json", b'"before":', b'"before":1e999,"was":'),
    "weights that overflow": ("policy.bin", b"", b""),
}


@pytest.mark.parametrize("kind", WRONG)
def test_wrong_contents_are_not_used_though_their_checksums_fit(
    kind: str, table: Callable[[], Corpus], cache: Path, studied: list[str]
) -> None:
    first = known(table())
    (kept,) = cache.iterdir()
    name, right, wrong = WRONG[kind]
    content = (kept / name).read_bytes()
    assert right in content
    changed = content.replace(right, wrong, 1) if right else content[:-8] + b"\xff" * 6 + b"\xef\x7f"
    (kept / name).write_bytes(changed)
    manifest = kept / "learned.json"
    sums = [hashlib.sha256(part).hexdigest() for part in (content, changed)]
    assert sums[0] in manifest.read_text()
    manifest.write_text(manifest.read_text().replace(*sums))
    assert same(known(table()), first)
    assert studied == [NAME] * 2
