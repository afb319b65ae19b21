"""Laying out files in place."""

from __future__ import annotations

from pathlib import Path

from tmd.diagnostics import TmdError
from tmd.files import write_text
from tmd.format.pddl_layout import format_pddl
from tmd.pddl.reading.syntax import read_text

# The files that can be laid out.
SUFFIX = ".pddl"


def format_file(path: str | Path, *, write: bool = True) -> bool:
    """Lay out a PDDL file; comments and line breaks stay.

    Args:
        path: The file.
        write: Whether to write it.

    Returns:
        Whether the file changes.

    Raises:
        TmdError: It is not PDDL, cannot be read or written, or has a fault that makes laying it out impossible.
    """
    file = Path(path)
    if file.suffix != SUFFIX:
        raise TmdError(f"{file}: only PDDL is laid out", hint=f"its name ends in {SUFFIX}")
    raw = read_text(file)
    text = format_pddl(raw, str(file))
    if text == raw and not _has_marks(file):
        return False
    if write:
        write_text(file, text)
    return True


def _has_marks(file: Path) -> bool:
    """Return whether the file begins with a byte order mark or has Windows line ends, which reading hides."""
    data = file.read_bytes()
    return data.startswith(b"\xef\xbb\xbf") or b"\r" in data
