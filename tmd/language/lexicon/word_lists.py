"""The word lists of ``data/words.txt`` by section, and the data files of the language package as text."""

from __future__ import annotations

import gzip
from collections.abc import Mapping
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
