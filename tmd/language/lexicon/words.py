"""Word lists by section (``data/words.txt``), and word forms: singular nouns, verb stems, positive adjectives."""

from __future__ import annotations

import gzip
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from importlib.resources import files


def data_text(name: str) -> str:
    """Return a data file of the language package as text; ``.gz`` is unpacked."""
    raw = (files("tmd.language") / "data" / name).read_bytes()
    return (gzip.decompress(raw) if name.endswith(".gz") else raw).decode("utf-8")


@cache
def sections() -> Mapping[str, tuple[str, ...]]:
    """Return every section of ``data/words.txt`` in the order of the file."""
    found: dict[str, list[str]] = {}
    current: list[str] = []
    for line in data_text("words.txt").splitlines():
        if line.startswith("["):
            current = found.setdefault(line.strip("[]"), [])
        elif not line.startswith("#"):
            current.extend(line.split())
    return {name: tuple(words) for name, words in found.items()}


@cache
def section(name: str) -> frozenset[str]:
    """Return one section of ``data/words.txt``."""
    return frozenset(sections()[name])


@cache
def phrases(name: str) -> Mapping[str, tuple[tuple[str, ...], ...]]:
    """Return a section of several-word entries by first word, longest first."""
    table: dict[str, list[tuple[str, ...]]] = {}
    for entry in sections()[name]:
        words = tuple(entry.split("_"))
        table.setdefault(words[0], []).append(words)
    return {first: tuple(sorted(entries, key=lambda e: (-len(e), e))) for first, entries in table.items()}


@cache
def slips() -> Mapping[str, str]:
    """Return the slips that no likeness finds, with the words they stand for."""
    return dict(entry.split("=") for entry in sections()["slips"])


_IRREGULAR = {
    "knives": "knife", "shelves": "shelf", "loaves": "loaf", "leaves": "leaf", "halves": "half", "dishes": "dish",
    "glasses": "glass", "children": "child", "people": "people", "men": "man", "women": "woman", "feet": "foot",
    "teeth": "tooth", "mice": "mouse", "geese": "goose", "movies": "movie", "cookies": "cookie", "pies": "pie",
    "ties": "tie", "brownies": "brownie", "smoothies": "smoothie", "veggies": "veggie", "potatoes": "potato",
    "tomatoes": "tomato", "mangoes": "mango", "heroes": "hero", "axes": "axe", "shoes": "shoe", "canoes": "canoe",
    "buses": "bus", "lenses": "lens", "batteries": "battery", "hoodies": "hoodie", "calories": "calorie",
    "quiches": "quiche", "canvases": "canvas", "dominoes": "domino",
}  # fmt: skip
_VOWELS = "aeiou"


def singular(noun: str) -> str:
    """Return the singular of the last part of a noun: ``raspberry_syrups`` gives ``raspberry_syrup``."""
    front, joint, head = noun.rpartition("_")
    return front + joint + _singular(head)


def _singular(word: str) -> str:
    if word in _IRREGULAR:
        return _IRREGULAR[word]
    if word.endswith(("shelves", "knives", "wives", "scarves", "loaves", "wolves", "thieves")):
        return word[:-4] + "ife" if word.endswith("ives") else word[:-3] + "f"
    if word in section("invariant") or len(word) < 3 or not word.endswith("s") or word.endswith(("ss", "us", "is")):
        return word
    if word.endswith("ies") and len(word) > 4:
        return word[:-3] + "y"
    if word.endswith(("sses", "shes", "ches", "xes", "zzes")):
        return word[:-2]
    return word[:-1]


def positive(word: str) -> str:
    """Return the adjective of a superlative: ``biggest`` gives ``big``; other words stay."""
    if not word.endswith("est") or len(word) < 6:
        return word
    root = word[:-3]
    if root.endswith("i"):
        return root[:-1] + "y"
    if root[-1] == root[-2]:
        return root[:-1] if root[-1] not in "ls" else root
    return root


def comparative_root(word: str) -> tuple[str, ...]:
    """Return the adjectives that a comparative may come from: ``louder`` gives ``loud`` and ``loude``."""
    if not word.endswith("er") or len(word) < 5:
        return ()
    root = word[:-2]
    undoubled = (root[:-1],) if root[-1] == root[-2] else ()
    return (f"{root[:-1]}y",) if root.endswith("i") else (root, f"{root}e", *undoubled)


def verb_candidates(word: str) -> Iterator[tuple[str, str]]:
    """Yield (stem, form) guesses for a regular verb form, best first."""
    yield word, "base"
    if word.endswith("ies") and len(word) > 4:
        yield word[:-3] + "y", "s"
    if word.endswith("es"):
        yield word[:-2], "s"
    if word.endswith("s") and not word.endswith("ss"):
        yield word[:-1], "s"
    for ending, form in (("ing", "ing"), ("ed", "ed")):
        if word.endswith(ending) and len(word) > len(ending) + 2:
            root = word[: -len(ending)]
            if form == "ed" and root.endswith("i"):
                yield root[:-1] + "y", form
            if root[-1] == root[-2] and root[-1] not in _VOWELS + "ls":
                yield root[:-1], form
            yield root + "e", form
            yield root, form
            if root[-1] == root[-2]:
                yield root[:-1], form


def verb_stem(word: str, known: Callable[[str], bool], irregular: dict[str, str]) -> tuple[str, str] | None:
    """Return (stem, form) of a word if it is a form of a known verb."""
    if known(word):
        return word, "base"
    if word in irregular:
        return irregular[word], "ing" if word.endswith("ing") else "ed"
    for stem, form in verb_candidates(word):
        # "bathing" is of "bathe", "heating" of "heat": the bare root wins where both are verbs
        if form in ("ed", "ing") and stem.endswith("e") and known(stem[:-1]) and not _wants_e(stem[:-1]):
            return stem[:-1], form
        if known(stem):
            return stem, form
    return None


def _wants_e(root: str) -> bool:
    """Tell whether a root with one vowel and one consonant at the end needs its e ("plac", "us")."""
    return len(root) < 4 and root[-1] not in _VOWELS
