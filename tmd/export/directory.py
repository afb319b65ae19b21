"""Writing a directory of files, whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from shutil import rmtree

from tmd.diagnostics import OutputError
from tmd.files import draft_of, real, remove_leftovers, write_bytes


def check_directory(directory: Path, *, overwrite: bool = False) -> None:
    """Refuse a directory that cannot be written, before any work is done for it.

    Raises:
        OutputError: It is not a directory, holds other files, or may not be written to.
    """
    reason, hint = "", "name a directory that does not exist yet"
    try:
        if directory.exists() and not directory.is_dir():
            reason = "it is not a directory"
        elif directory.is_dir() and any(directory.iterdir()) and not overwrite:
            reason, hint = "it is not empty", "name another directory, or give --overwrite"
        elif not _first_above(directory).is_dir():
            reason = f"{_first_above(directory)} is not a directory"
        elif not os.access(_first_above(directory), os.W_OK | os.X_OK):
            reason, hint = "permission denied", "name a directory that you may write to"
    except OSError as error:
        reason = error.strerror or str(error)
    if reason:
        raise OutputError(f"{directory} cannot be written: {reason}", hint=hint)


def _first_above(path: Path) -> Path:
    """Return ``path``, or the nearest directory above it that is there."""
    whole = path.absolute()
    return next(found for found in (whole, *whole.parents) if found.exists())


def write_directory(directory: Path, files: Mapping[str, bytes], *, overwrite: bool = False) -> None:
    """Write ``files`` into ``directory``, which becomes what they are in one step where it was empty or not there.

    Paths have ``/`` between their parts. With ``overwrite`` the directory may hold other files; those stay, and those
    of the same name are replaced, each of them whole.

    Raises:
        OutputError: It cannot be written.
    """
    check_directory(directory, overwrite=overwrite)
    try:
        if overwrite and directory.is_dir() and any(directory.iterdir()):
            _replace_files(directory, files)
        else:
            _appear(directory, files)
    except OSError as error:
        raise OutputError(
            f"{directory} cannot be written: {error.strerror or error}", hint="name a directory you may write to"
        ) from error


def _replace_files(directory: Path, files: Mapping[str, bytes]) -> None:
    for name, data in files.items():
        target = directory / name
        target.parent.mkdir(parents=True, exist_ok=True)
        write_bytes(target, data)


def _appear(directory: Path, files: Mapping[str, bytes]) -> None:
    """Write everything beside ``directory`` and rename it; an empty directory is replaced by that."""
    target = real(directory)
    above = [parent for parent in target.parents if not parent.exists()]
    target.parent.mkdir(parents=True, exist_ok=True)
    remove_leftovers(target)
    draft = draft_of(target)
    rmtree(draft, ignore_errors=True)  # of an earlier process with the number of this one, as containers have it
    draft.mkdir()
    try:
        try:
            _replace_files(draft, files)
        except OutputError as error:  # of the directory that was asked for, not of the draft
            raise OutputError(error.message.replace(str(draft), str(directory)), hint=error.hint) from error
        draft.replace(target)
    except BaseException:
        rmtree(draft, ignore_errors=True)
        for parent in above:
            with suppress(OSError):
                parent.rmdir()
        raise
