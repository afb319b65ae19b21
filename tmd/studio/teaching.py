"""What a domain's demonstrations teach, while more of them come.

A demonstration that was just saved is in the library at once; the policy and what verbs mean, which take longer, are
learned in the background. Whoever grounds a text meanwhile has what was known when they began, all of one piece; at
the end it is what ``tmd ground`` has of the same files.
"""

from __future__ import annotations

import multiprocessing
import os
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from tmd.diagnostics import TmdError
from tmd.goals.sources.table import GoalTable
from tmd.ground import Ask, ground
from tmd.grounded import Grounded
from tmd.inference.policy.model import Reward
from tmd.knowledge import (
    Knowledge,
    digest,
    known,
    reward_from_json,
    reward_to_json,
    weights_bytes,
)
from tmd.readers.interface import Reader
from tmd.readers.llm.client import URL, ModelSettings
from tmd.readers.llm.reader import llm_reader
from tmd.studio.demonstrations.alignment import Habits
from tmd.veil.corpus import Corpus
from tmd.veil.demonstration import Demonstration
from tmd.veil.library import Library, learn, teach
from tmd.veil.world import World
from tmd.world.folder import DomainFolder

_SHARE = 0.95
"""The share of the work that learning is, roughly; the rest is saving."""
_NICE = 10
"""How much the process that learns stands back behind the studio's own (POSIX)."""
_READERS = 8
"""Maximum number of language-model readers that are kept."""
_NO_KEY = "none"
"""The key for servers that the environment does not name."""


@dataclass(frozen=True, slots=True)
class Trained:
    """What came of it.

    Attributes:
        made_from: The digest of the files that it was learned from.
        demonstrations: How many were learned from.
        reward: What the policy was learned to be.
        goals: What verbs were learned to mean.
    """

    made_from: str
    demonstrations: int
    reward: Reward | None
    goals: GoalTable | None


class Training:
    """Learning under way. Threads may share it.

    Args:
        corpus: The demonstrations.
        root: Where what is learned is kept; beside the demonstrations where none is given.
        finish: Called in a thread of its own with what came of it, before :meth:`wait` returns; ``None`` if it failed.
    """

    def __init__(self, corpus: Corpus, root: Path | None, finish: Callable[[Trained | None], None]) -> None:
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
            if self._error is not None:
                self._finish(None)
            self._process.join()
            self._mine.close()


def _work(connection: Connection, folder: Path, directory: Path, root: Path | None) -> None:
    """What the process does."""

    def tell(share: float) -> None:
        connection.send(("share", _SHARE * share))

    os.nice(_NICE)
    try:
        corpus = Corpus(DomainFolder(folder), directory)
        made_from = digest(corpus)
        knowledge = known(corpus, root, tell)
        connection.send(("done", _packed(made_from, len(corpus.demonstrations()), knowledge)))
    except TmdError as error:
        with suppress(BrokenPipeError):
            connection.send(("error", str(error)))
    except BrokenPipeError:
        return  # the studio has ended: nobody wants it any more


def _packed(made_from: str, count: int, knowledge: Knowledge) -> tuple[Any, ...]:
    reward = knowledge.reward
    return made_from, count, reward and (reward_to_json(reward), weights_bytes(reward)), knowledge.goals


def _unpacked(data: tuple[Any, ...]) -> Trained:
    made_from, count, reward, goals = data
    return Trained(made_from, count, reward and reward_from_json(*reward), goals)


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
        self._digest = digest(corpus)
        self._knowledge = known(corpus, root)
        self._learned_from = tuple(corpus.demonstrations())
        self._habits = Habits.of(self._knowledge.library)
        self._guard = threading.RLock()
        self._training: Training | None = None
        self._learning = False
        self._readers: dict[tuple[ModelSettings, bool], Reader] = {}

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

        The library is then what ``tmd learn`` makes of the same files. The policy, and what verbs mean, stay as they
        are until :meth:`retrain` is done.

        Args:
            demonstration: As :meth:`tmd.studio.demonstrations.demo_store.Archive.save` gave it back.

        Returns:
            What is known now.

        Raises:
            TmdError: A file of demonstrations is wrong, or the demonstration is in none. What was known stays.
        """
        with self._guard:
            self._take_up(demonstration)
            return self._knowledge

    def retrain(self) -> Training:
        """Learn everything from all demonstrations, in a process of its own, as ``tmd ground`` does when it is asked.

        What is learned is used as soon as it is there, and kept where ``tmd ground`` finds it. Where learning is under
        way already, that goes on; if demonstrations came meanwhile, it begins once more at its end.
        """
        with self._guard:
            if self._training is None or not self._learning:
                self._learning = True
                self._training = Training(self.corpus, self._root, self._become)
            return self._training

    @property
    def learning(self) -> bool:
        """Whether what is known is not yet all that the files teach: it is being learned."""
        return self._learning

    def model_reader(self, model: str, url: str, *, verify: bool) -> Reader:
        """Return the reader that asks a language model; the same one for the same settings.

        Args:
            model: The name of the model; that of the environment variable where it is empty.
            url: The address of the server; likewise.
            verify: Whether the model is asked once more whether a plan does what was asked.

        Raises:
            ModelError: There is no model, or no key for a server that needs one.
            TmdError: A file of sentence tests is wrong.
        """
        # whoever sees the page may name any server: the key goes only to the one that the environment names
        trusted = url in ("", os.environ.get(URL, "").strip())
        settings = ModelSettings(model or None, url or None, key=None if trusted else _NO_KEY)
        with self._guard:
            found = self._readers.pop((settings, verify), None) or llm_reader(self.corpus, settings, verify=verify)
            self._readers[settings, verify] = found
            if len(self._readers) > _READERS:
                del self._readers[next(iter(self._readers))]
            return found

    def ground(
        self, text: str, world: World, top: int = 1, *, reader: Reader | None = None, ask: Ask | None = None
    ) -> Grounded:
        """Ground a text with what is known now, as ``tmd ground`` does with its usual options.

        What others did to the files since is taken up first, and learned in the background.

        Args:
            text: What is to be done.
            world: The environment.
            top: The number of distinct plans.
            reader: The reader; by default the offline reader of grammar and lexicon.
            ask: Answers a question of the reader; without it the likeliest option is taken.

        Raises:
            TmdError: A file of demonstrations is wrong, or the reader cannot work.
        """
        with self._guard:
            if digest(self.corpus) != self._digest:
                self._take_up()
                self.retrain()
            now = self._knowledge
        return ground(text, world, now.library, reward=now.reward, goals=now.goals, top=top, reader=reader, ask=ask)

    def close(self) -> None:
        """End what is under way."""
        training = self._training
        if training is not None and training.running:
            training.stop()

    def _library(self, found: tuple[Demonstration, ...]) -> Library:
        """What ``found`` teaches: only what is new is learned, where nothing went and each id stands for one."""
        corpus, before = self.corpus, set(self._learned_from)
        order = {demonstration.id: number for number, demonstration in enumerate(found)}
        if len(order) < len(found) or not before <= set(found):
            return learn(found, corpus.world, corpus.lexicon)
        new = [teach(d, corpus.world(d.environment), corpus.lexicon) for d in found if d not in before]
        return self._knowledge.library.extended(new, order)

    def _take_up(self, wanted: Demonstration | None = None) -> None:
        """Have a library of the files as they are now; ``wanted`` must be in them."""
        made_from = digest(self.corpus)
        self.corpus.reread()
        found = tuple(self.corpus.demonstrations())
        if wanted is not None and wanted not in found:
            raise TmdError(f"'{wanted.id}' is not among the demonstrations", hint="save it first")
        library = self._library(found)
        self._habits = Habits.of(library)
        self._knowledge = replace(self._knowledge, library=library)
        self._learned_from, self._digest = found, made_from

    def _become(self, trained: Trained | None) -> None:
        """Use what was learned; the library may know more by now, and then it is learned once more."""
        with self._guard:
            self._learning = False
            if trained is None:
                return
            self._take_up()
            self._knowledge = Knowledge(self._knowledge.library, trained.reward, goals=trained.goals)
            if trained.made_from != self._digest:
                self.retrain()
