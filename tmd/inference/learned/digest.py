"""What something was learned from, as a checksum.

In it are the files of the domain, its environments and demonstrations, and the program itself: another reader of
sentences makes other templates of the same demonstrations.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path

from tmd.veil.corpus import Corpus

_ROOT = Path(__file__).resolve().parents[2]
_PACKAGES = ("pddl", "world", "language", "veil", "goals", "inference/policy", "inference/learned")
"""The packages whose code decides what is learned from a demonstration."""
_DOMAIN = ("domain.pddl", "objects.yaml", "lexicon.yaml")


def digest(corpus: Corpus) -> str:
    """The checksum; the same wherever the folders lie."""
    found = hashlib.sha256(_program().encode())
    for name, path in _files(corpus):
        content = path.read_bytes()
        found.update(f"{name} {len(content)}\n".encode())
        found.update(content)
    return found.hexdigest()


def _files(corpus: Corpus) -> Iterator[tuple[str, Path]]:
    for name in _DOMAIN:
        path = corpus.folder.path / name
        if path.is_file():
            yield name, path
    for pattern in ("environments/*.yaml", "environments/*.pddl", "*/demonstrations.jsonl"):
        for path in sorted(corpus.directory.glob(pattern)):
            yield path.relative_to(corpus.directory).as_posix(), path


@lru_cache(maxsize=1)
def _program() -> str:
    """Of the code and the word lists of the packages below."""
    found = hashlib.sha256()
    for package in _PACKAGES:
        for path in sorted((_ROOT / package).rglob("*")):
            if path.is_file() and path.suffix != ".pyc":
                content = path.read_bytes()
                found.update(f"{path.relative_to(_ROOT).as_posix()} {len(content)}\n".encode())
                found.update(content)
    return found.hexdigest()
