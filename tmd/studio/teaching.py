"""What a domain's demonstrations teach, while more of them come.

A demonstration that was just saved is in the library at once; the policy and what verbs mean, which take longer, are
learned again when somebody asks for it. Whoever grounds a text meanwhile has what was known when they began, all of one
piece.
"""

from __future__ import annotations

import multiprocessing
import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from tmd.diagnostics import TmdError
from tmd.goals.sources.table import GoalTable
from tmd.ground import ground
from tmd.grounded import Grounded
from tmd.inference.learned import (
    Knowledge,
    digest,
    known,
    place,
    reward_from_json,
    reward_to_json,
    save,
    study,
    weights_bytes,
)
from tmd.inference.policy import Reward
from tmd.studio.demonstrations.alignment import Habits
from tmd.veil.corpus import Corpus
from tmd.veil.demonstration import Demonstration
from tmd.veil.library import Library, learn, teach
from tmd.veil.world import World
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


class Teacher:
    """What is known of one domain. Threads may share it.

    Args:
        corpus: The domain's environments and demonstrations.
        root: Where ``tmd learn --out`` keeps what it learns; beside the demonstrations where none is given. What was
            saved there and still holds is taken, else everything is learned now.

    Raises:
        TmdError: A demonstration is wrong.
    """

    def __init__(self, corpus: Corpus, root: Path | None = None) -> None:
        self.corpus = corpus
        self._root = root
        self._knowledge = known(corpus, root)
        self._learned_from = tuple(corpus.demonstrations())
        self._habits = Habits.of(self._knowledge.library)
        self._guard = threading.RLock()
        self._training: Training | None = None

    @property
    def knowledge(self) -> Knowledge:
        """What is known now."""
        return self._knowledge

    @property
    def habits(self) -> Habits:
        """What was done for each verb, for proposals of clauses."""
        return self._habits

    @property
    def training(self) -> Training | None:
        """The last :meth:`retrain`, if there was one."""
        return self._training

    def learn_one(self, demonstration: Demonstration) -> Knowledge:
        """Take up a demonstration that was just saved, and any that others have saved since.

        The library is then what ``tmd learn`` makes of the same files. The policy stays as it is.

        Args:
            demonstration: As :meth:`tmd.studio.demonstrations.demo_store.Archive.save` gave it back.

        Returns:
            What is known now.

        Raises:
            TmdError: A file of demonstrations is wrong, or the demonstration is in none. What was known stays.
        """
        with self._guard:
            self.corpus.reread()
            found = tuple(self.corpus.demonstrations())
            if demonstration not in found:
                raise TmdError(f"'{demonstration.id}' is not among the demonstrations", hint="save it first")
            library = self._library(found)
            self._habits = Habits.of(library)
            self._knowledge = replace(self._knowledge, library=library)
            self._learned_from = found
            return self._knowledge

    def retrain(self) -> Training:
        """Learn everything from all demonstrations, in a process of its own, as ``tmd learn --no-weights`` does.

        What is learned is used as soon as it is there, and saved for ``tmd ground`` where that can be written to.

        Raises:
            TmdError: It is under way already.
        """
        with self._guard:
            if self._training is not None and self._training.running:
                raise TmdError("learning is under way already", hint="wait for its end")
            self._training = Training(self.corpus, self._root, self._become)
            return self._training

    def ground(self, text: str, world: World, top: int = 1) -> Grounded:
        """Ground a text with what is known now, as ``tmd ground`` does with its usual options."""
        now = self._knowledge
        return ground(text, world, now.library, reward=now.reward, goals=now.goals, top=top)

    def close(self) -> None:
        """End what is under way."""
        if self._training is not None and self._training.running:
            self._training.stop()

    def _library(self, found: tuple[Demonstration, ...]) -> Library:
        """What ``found`` teaches: only what is new is learned, where nothing went and each id stands for one."""
        corpus, before = self.corpus, set(self._learned_from)
        order = {demonstration.id: number for number, demonstration in enumerate(found)}
        if len(order) < len(found) or not before <= set(found):
            return learn(found, corpus.world, corpus.lexicon)
        new = [teach(d, corpus.world(d.environment), corpus.lexicon) for d in found if d not in before]
        return self._knowledge.library.extended(new, order)

    def _become(self, trained: Trained) -> None:
        """Use a policy that was learned; the library may know more by now."""
        with self._guard:
            self.corpus.reread()
            found = tuple(self.corpus.demonstrations())
            library = self._library(found)
            self._habits = Habits.of(library)
            self._knowledge = Knowledge(library, trained.reward, goals=trained.goals)
            self._learned_from = found
