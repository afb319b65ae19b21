"""What a robot did with predictions of a run: ``robot/`` in its directory.

``ENVIRONMENT.json`` is one trial, with its film and its filmstrip beside it; ``skipped.json`` says why there are none.
"""

from __future__ import annotations

from base64 import b64encode
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError

from tmd.diagnostics import TmdError

FOLDER = "robot"
SKIPPED = "skipped.json"
_Kind = TypeVar("_Kind", bound=BaseModel)


class _Record(BaseModel):
    """Part of a file. What a later version adds is passed over."""

    model_config = ConfigDict(frozen=True, extra="ignore")


class TrialStep(_Record):
    """One instruction: ``outcome`` is ``ok``, ``failed`` or ``mismatch``; ``said`` what was measured.

    ``confirmed`` are the effects that were seen.
    """

    instruction: str
    repair: bool
    outcome: Literal["ok", "failed", "mismatch"]
    said: str
    confirmed: list[str] = []


class TrialRequest(_Record):
    """What decides the outcome of a trial.

    Attributes:
        environment: Where.
        model: The row that predicted the plan.
        id: The example that it was predicted for; ``None`` where no prediction can be executed.
        text: What was said.
        plan: The prediction.
        mode: ``kinematic`` or ``physics``.
        seed: Random seed.
        version: Of tmd.
    """

    environment: str
    model: str
    id: str | int | None
    text: str
    plan: list[str]
    mode: Literal["kinematic", "physics"]
    seed: int
    version: str


class Trial(_Record):
    """A plan that a robot was given, and what came of it.

    Attributes:
        asked: What was to be done.
        status: How it ended; ``no_plan`` and ``no_scene`` did not begin.
        reason: Why it stopped or did not begin; empty otherwise.
        repairs: How often the plan was mended.
        seconds: Simulated; 0 without physics.
        steps: What was done.
        film: The file of the film beside the record, if there is one.
        strip: The file of the filmstrip.
    """

    asked: TrialRequest
    status: Literal["done", "recovered", "stopped", "no_plan", "no_scene"]
    reason: str = ""
    repairs: int = 0
    seconds: float = 0.0
    steps: list[TrialStep] = []
    film: str | None = None
    strip: str | None = None


class Skip(_Record):
    """Why there are no trials."""

    reason: str


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
    """The trials in a run's directory; ``None`` where nobody asked for any.

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
    return Trials(folder, found, "" if found else _read(Skip, skip).reason)


def read_trial(path: Path) -> Trial:
    """One record.

    Raises:
        TmdError: It is damaged, or cannot be read.
    """
    return _read(Trial, path)


_MEDIA = {".mp4": "video/mp4", ".gif": "image/gif", ".png": "image/png"}


def films(trials: Trials | None) -> dict[str, str]:
    """Films and filmstrips by file name, as ``data:`` addresses: a page with them still loads nothing."""
    names = [name for trial in (trials.found if trials else ()) for name in (trial.film, trial.strip) if name]
    found = {}
    for name in names:
        path = trials.directory / Path(name).name if trials else Path(name)
        if path.suffix in _MEDIA and path.is_file():
            found[name] = f"data:{_MEDIA[path.suffix]};base64,{b64encode(path.read_bytes()).decode()}"
    return found


def _read(kind: type[_Kind], path: Path) -> _Kind:
    try:
        return kind.model_validate_json(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise TmdError(f"{path} cannot be read: {error.strerror}") from None
    except (ValidationError, UnicodeDecodeError):
        raise TmdError(f"{path}: damaged", hint="remove that file, and let the robot act again: --step robot") from None
