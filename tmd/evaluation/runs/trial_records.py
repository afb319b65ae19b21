"""The records of robot trials: ``robot/`` in the directory of a run.

``ENVIRONMENT.json`` is one trial, with its film and its filmstrip beside it; ``skipped.json`` says why there are none.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from tmd.pddl.reading.syntax import read_text
from tmd.records.trial import Skip, Trial

FOLDER = "robot"
SKIPPED = "skipped.json"


@dataclass(frozen=True, slots=True)
class Trials:
    """All trials of a run, or why there are none.

    Attributes:
        directory: Where they lie.
        found: By environment.
        skipped: Why there are none.
    """

    directory: Path
    found: tuple[Trial, ...] = ()
    skipped: str = ""


def read_trials(run: Path) -> Trials | None:
    """Return the trials in a run's directory; ``None`` where nobody asked for any.

    Raises:
        TmdError: A record is damaged.
    """
    folder = run / FOLDER
    if not folder.is_dir():
        return None
    files = sorted(path for path in folder.glob("*.json") if path.name != SKIPPED)
    found = tuple(read_trial(path) for path in files)
    skip = folder / SKIPPED
    if not found and not skip.is_file():
        return None
    return Trials(folder, found, "" if found else Skip.from_text(read_text(skip), str(skip)).reason)


def read_trial(path: Path) -> Trial:
    """Return one record.

    Raises:
        TmdError: It is damaged, or cannot be read.
    """
    return Trial.from_text(read_text(path), str(path))


_MEDIA = frozenset({".mp4", ".gif", ".png", ".jpg"})


def films(trials: Trials | None) -> dict[str, str]:
    """Return films, posters and filmstrips by file name, as addresses relative to the run's directory."""
    found = trials.found if trials else ()
    names = [name for trial in found for name in (trial.film, trial.strip, trial.poster)]
    return {
        name: f"{trials.directory.name}/{quote(Path(name).name)}"
        for name in filter(None, names)
        if trials and Path(name).suffix in _MEDIA and (trials.directory / Path(name).name).is_file()
    }
