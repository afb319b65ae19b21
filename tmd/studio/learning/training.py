"""Learning everything again from all demonstrations, in a process of its own: the studio stays quick meanwhile."""

from __future__ import annotations

import multiprocessing
import threading
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from tmd.diagnostics import TmdError
from tmd.goals.sources.table import GoalTable
from tmd.inference.learned import Knowledge, digest, place, reward_from_json, reward_to_json, save, study, weights_bytes
from tmd.inference.policy import Reward
from tmd.veil.corpus import Corpus
from tmd.world.folder import DomainFolder

_SHARE = 0.95
"""The share of the work that learning is, roughly; the rest is saving."""


@dataclass(frozen=True, slots=True)
class Trained:
    """What came of it.

    Attributes:
        demonstrations: How many were learned from.
        reward: What the policy was learned to be.
        goals: What verbs were learned to mean.
        saved: The directory in which ``tmd ground`` finds it; ``None`` where it could not be written to.
        remark: Why not, in one line; empty where it was saved.
    """

    demonstrations: int
    reward: Reward | None
    goals: GoalTable | None
    saved: Path | None
    remark: str = ""


class Training:
    """Learning under way. Threads may share it.

    Args:
        corpus: The demonstrations.
        root: Where what is learned is kept; beside the demonstrations where none is given.
        finish: Called in a thread of its own with what came of it, before :meth:`wait` returns; not if it failed.
    """

    def __init__(self, corpus: Corpus, root: Path | None, finish: Callable[[Trained], None]) -> None:
        context = multiprocessing.get_context("spawn")
        self._mine, theirs = context.Pipe()
        arguments = (theirs, corpus.folder.path, corpus.directory, root)
        self._process = context.Process(target=_work, args=arguments, daemon=True)
        self._finish = finish
        self._share = 0.0
        self._error: TmdError | None = None
        self._trained: Trained | None = None
        self._stopped = False
        self._process.start()
        theirs.close()
        self._thread = threading.Thread(target=self._listen, daemon=True)
        self._thread.start()

    @property
    def share(self) -> float:
        """How much of the work is done, roughly, from 0 to 1."""
        return self._share

    @property
    def running(self) -> bool:
        """Whether it goes on."""
        return self._thread.is_alive()

    @property
    def trained(self) -> Trained | None:
        """What came of it, once it is done."""
        return self._trained

    @property
    def error(self) -> TmdError | None:
        """Why it failed, if it did; nothing was changed then."""
        return self._error

    def wait(self, timeout: float | None = None) -> bool:
        """Wait for the end, at most so many seconds; whether it came.

        Raises:
            TmdError: Learning failed.
        """
        self._thread.join(timeout)
        if self._error is not None:
            raise self._error
        return not self.running

    def stop(self) -> None:
        """End it; what was learned so far is lost, what was known before stays."""
        self._stopped = True
        self._process.terminate()
        self._thread.join()

    def _listen(self) -> None:
        try:
            while True:
                kind, value = self._mine.recv()
                if kind == "share":
                    self._share = value
                    continue
                if kind == "error":
                    self._error = TmdError(value)
                else:
                    trained = _unpacked(value)
                    self._finish(trained)
                    self._trained = trained
                    self._share = 1.0
                break
        except (EOFError, OSError):
            why = "was stopped" if self._stopped else "ended before it was done"
            self._error = TmdError(f"learning {why}; what was known before is used", hint="train again")
        except TmdError as error:
            self._error = error
        finally:
            self._process.join()
            self._mine.close()


def _work(connection: Connection, folder: Path, directory: Path, root: Path | None) -> None:
    """What the process does."""

    def tell(share: float) -> None:
        connection.send(("share", _SHARE * share))

    try:
        corpus = Corpus(DomainFolder(folder), directory)
        made_from = digest(corpus)
        knowledge = study(corpus, tell)
        connection.send(
            ("done", _packed(len(corpus.demonstrations()), knowledge, _saved(knowledge, corpus, root, made_from)))
        )
    except TmdError as error:
        connection.send(("error", str(error)))


def _saved(knowledge: Knowledge, corpus: Corpus, root: Path | None, made_from: str) -> tuple[Path, str]:
    """Where it was saved, and why it was not if so."""
    target = place(corpus, root)
    try:
        save(knowledge, corpus, target, made_from)
    except TmdError as error:
        return target, str(error)
    return target, ""


def _packed(count: int, knowledge: Knowledge, saved: tuple[Path, str]) -> tuple[Any, ...]:
    reward = knowledge.reward
    return count, reward and (reward_to_json(reward), weights_bytes(reward)), knowledge.goals, *saved


def _unpacked(data: tuple[Any, ...]) -> Trained:
    count, reward, goals, target, remark = data
    return Trained(count, reward and reward_from_json(*reward), goals, None if remark else target, remark)
