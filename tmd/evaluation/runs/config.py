"""The configuration of a run, and the part of it that decides the outcome."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tmd import __version__
from tmd.diagnostics import OptionError
from tmd.pddl.reading.syntax import nearest
from tmd.short_repr import short_repr

BUNDLED = "bundled"
VEIL500 = "veil500"
JOBLIB = "joblib"
DASK = "dask"
DEFAULT_MODELS = (
    *("empty", "chance", "templates", "tree", "no_nl", "nearest", "no_domain", "no_latent", "full"),
    *("paper", "policy", "goals"),
)
"""Table II, and what is measured beside it."""
_DECISIVE = (
    *("task", "data", "domain", "train_tasks", "train_environments", "test_environments"),
    *("drop_sentences", "models", "seed"),
)
"""The settings that decide the outcome of a run."""


@short_repr(lambda config: f"{config.task} in {config.out}")
@dataclass(frozen=True, slots=True)
class ExperimentConfig:
    """The configuration of a run.

    Attributes:
        task: A task of the data, or ``all``.
        out: The run's directory; a text does as well.
        data: ``bundled`` or ``veil500``.
        train_tasks: Tasks to train on; ``None`` leaves it to the protocol of the data.
        train_environments: Environment numbers to train in; ``None`` leaves it to the folds.
        test_environments: Environment numbers to test in; likewise.
        drop_sentences: With what probability each sentence of a test text is left out, in [0, 1).
        models: The rows; the usual ones where none is named.
        domains: The directory of all domains, if not the usual one.
        problems: The directory of all problems, if not the usual one.
        backend: ``joblib``, processes on this machine, or ``dask``, a cluster.
        jobs: How many processes on this machine.
    """

    task: str
    out: Path
    data: str = BUNDLED
    veil500: Path | None = None
    train_tasks: tuple[str, ...] | None = None
    train_environments: tuple[int, ...] | None = None
    test_environments: tuple[int, ...] | None = None
    drop_sentences: float = 0.0
    models: tuple[str, ...] = ()
    seed: int = 0
    domain: str = "kitchen"
    domains: Path | None = None
    problems: Path | None = None
    backend: str = JOBLIB
    scheduler: str | None = None
    jobs: int = 1

    def __post_init__(self) -> None:
        """Take the run's directory as a text as well.

        Raises:
            OptionError: There are no such data, or there is no such backend.
        """
        object.__setattr__(self, "out", Path(self.out))
        for what, name, known in (("data", self.data, (BUNDLED, VEIL500)), ("backend", self.backend, (JOBLIB, DASK))):
            if name not in known:
                raise OptionError(f"{what} is '{name}'", hint=nearest(name, known, what="names"))

    def identity(self, fingerprint: str) -> dict[str, Any]:
        """Return the settings that decide the outcome, without directories and the distribution of the work."""
        values = {name: getattr(self, name) for name in _DECISIVE}
        listed = {name: list(value) if isinstance(value, tuple) else value for name, value in values.items()}
        return {**listed, "fingerprint": fingerprint, "version": __version__}
