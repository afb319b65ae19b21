"""Laying out files in place."""

from __future__ import annotations

from pathlib import Path

from tmd.files import write_text
from tmd.pddl.reading.syntax import read_text

# The files that can be laid out.
SUFFIXES = (".pddl", ".yaml", ".yml")


def format_file(path: str | Path, *, write: bool = True) -> bool:
    """Lay out a PDDL or YAML file; comments and line breaks stay.

    Args:
        path: The file.
        write: Whether to write it.

    Returns:
        Whether the file changes.

    Raises:
        TmdError: It cannot be read or written, or has a fault that makes laying it out impossible.
    """
    file = Path(path)
    raw = read_text(file)
    text = _laid_out(raw, file)
    if text == raw and not _has_marks(file):
        return False
    if write:
        write_text(file, text)
    return True


def _laid_out(text: str, file: Path) -> str:
    if file.suffix == ".pddl":
        from tmd.format.pddl_layout import format_pddl

        return format_pddl(text, str(file))
    from tmd.format.yaml_layout import format_yaml

    return format_yaml(text, str(file))


def _has_marks(file: Path) -> bool:
    """Return whether the file begins with a byte order mark or has Windows line ends, which reading hides."""
    data = file.read_bytes()
    return data.startswith(b"\xef\xbb\xbf") or b"\r" in data
