"""Pages on single predictions: ``pages/`` in a run's directory, to which the report links."""

from __future__ import annotations

import re
from pathlib import Path
from zlib import crc32

FOLDER = "pages"


def page_name(model: str, example: str | int) -> str:
    """The file of the page on a prediction: it can stand in an address as it is, and no other prediction has it."""
    plain = f"{model}-{example}"
    safe = re.sub(r"[^A-Za-z0-9_.-]", "_", plain)[:120]
    return f"{safe}.html" if safe == plain else f"{safe}-{crc32(plain.encode('utf-8', 'replace')):08x}.html"


def linked_pages(run: Path) -> frozenset[str]:
    """The pages that are there, by file name."""
    return frozenset(path.name for path in (run / FOLDER).glob("*.html"))
