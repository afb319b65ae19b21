"""Learning from a domain's demonstrations while more of them are saved.

A demonstration that was just saved is in the library at once; the policy and the meanings of verbs, which take longer,
are learned in the background. A text that is grounded meanwhile is grounded with the knowledge of its beginning, all of
one piece. At the end the knowledge is that of ``tmd ground`` for the same files.
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

from tmd.diagnostics import TmdError
from tmd.goals.sources.table import GoalTable
from tmd.ground import Ask, ground
from tmd.grounded import Grounded
from tmd.inference.policy.model import Reward
from tmd.knowledge import Knowledge, digest, known
from tmd.library.library import Library, learn, teach
from tmd.readers.interface import Reader
from tmd.readers.llm.client import URL, ModelSettings
from tmd.readers.llm.reader import llm_reader
from tmd.studio.demonstrations.alignment import Habits
from tmd.world.corpus import Corpus
from tmd.world.demonstration import Demonstration
from tmd.world.folder import DomainFolder
from tmd.world.world import World

# Share of the work that is learning, roughly; the rest is saving.
_SHARE = 0.95
# Niceness of the process that learns (POSIX): the studio's own goes first.
_NICE = 10
# Maximum number of language-model readers that are kept.
_READERS = 8
# The key for servers that the environment does not name.
_NO_KEY = "none"


@dataclass(frozen=True, slots=True)
class Trained:
    """Result of learning: the digest of its files, the policy, and the meanings of verbs."""

    made_from: str
    reward: Reward | None
    goals: GoalTable | None


class Training:
    """Learning under way. Threads may share it.

    Args:
        corpus: The demonstrations.
        root: The directory of what is learned; beside the demonstrations where none is given.
        finish: Called in a separate thread with the result, before :meth:`wait` returns; ``None`` if it failed.

    Attributes:
        share: Share of the work that is done, roughly, from 0 to 1.
        trained: The result, once it is done.
        error: The reason, if it failed; nothing was changed then.
    """

    def __init__(self, corpus: Corpus, root: Path | None, finish: Callable[[Trained | None], None]) -> None:
        context = multiprocessing.get_context("spawn")
        self._mine, theirs = context.Pipe()
        arguments = (theirs, corpus.folder.path, corpus.directory, root)
        self._process = context.Process(target=_work, args=arguments, daemon=True)
        self._finish = finish
        self.share = 0.0
        self.error: TmdError | None = None
        self.trained: Trained | None = None
        self._stopped = False
        self._process.start()
        theirs.close()
        self._thread = threading.Thread(target=self._listen, daemon=True)
        self._thread.start()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait for the end, at most so many seconds; return whether it came.

        Raises:
            TmdError: Learning failed.
        """
        self._thread.join(timeout)
        if self.error is not None:
            raise self.error
        return not self._thread.is_alive()

    def stop(self) -> None:
        """End it, if it goes on: what was learned so far is lost, and what was known before stays."""
        if not self._thread.is_alive():
            return
        self._stopped = True
        self._process.terminate()
        self._thread.join()

    def _listen(self) -> None:
        try:
            while self.trained is None:
                value = self._mine.recv()
                if isinstance(value, float):
                    self.share = value
                elif isinstance(value, Trained):
                    self._finish(value)
                    self.trained, self.share = value, 1.0
                else:
                    raise TmdError(value)
        except (EOFError, OSError):
            why = "was stopped" if self._stopped else "ended before it was done"
            self.error = TmdError(f"learning {why}; what was known before is used", hint="train again")
        except TmdError as error:
            self.error = error
        finally:
            if self.error is not None:
                self._finish(None)
            self._process.join()
            self._mine.close()


def _work(connection: Connection, folder: Path, directory: Path, root: Path | None) -> None:
    """Learn in a process, and send the progress and the result."""

    def tell(share: float) -> None:
        connection.send(_SHARE * share)

    os.nice(_NICE)
    try:
        corpus = Corpus(DomainFolder(folder), directory)
        made_from = digest(corpus)
        knowledge = known(corpus, root, tell)
        connection.send(Trained(made_from, knowledge.reward, knowledge.goals))
    except TmdError as error:
        with suppress(BrokenPipeError):
            connection.send(str(error))
    except BrokenPipeError:
        return  # the studio has ended


class Teacher:
    """Knowledge learned in one domain. Threads may share it.

    Args:
        corpus: The domain's environments and demonstrations.
        root: Where ``tmd learn --out`` keeps what it learns; beside the demonstrations where none is given. What was
            saved there and still holds is taken, else everything is learned now.

    Attributes:
        knowledge: The current knowledge.
        habits: The instructions carried out for each verb, for proposals of clauses.
        training: The last :meth:`retrain`, if there was one.
        learning: Whether the files teach more than is known, and that is being learned.

    Raises:
        TmdError: A demonstration is wrong.
    """

    def __init__(self, corpus: Corpus, root: Path | None = None) -> None:
        self.corpus = corpus
        self._root = root
        self._digest = digest(corpus)
        self.knowledge = known(corpus, root)
        self._learned_from = tuple(corpus.demonstrations())
        self.habits = Habits.of(self.knowledge.library)
        self._guard = threading.RLock()
        self.training: Training | None = None
        self.learning = False
        self._readers: dict[tuple[ModelSettings, bool], Reader] = {}

    def learn_one(self, demonstration: Demonstration | None = None) -> None:
        """Take up the demonstrations as the files have them now, among them one that was just saved.

        The library is then that of ``tmd learn`` for the same files. The policy and the meanings of verbs stay as they
        are until :meth:`retrain` is done.

        Args:
            demonstration: The return value of :meth:`tmd.studio.demonstrations.demo_store.Archive.save`.

        Raises:
            TmdError: A file of demonstrations is wrong, or the demonstration is in none. What was known stays.
        """
        with self._guard:
            made_from = digest(self.corpus)
            self.corpus.reread()
            found = tuple(self.corpus.demonstrations())
            if demonstration is not None and demonstration not in found:
                raise TmdError(f"'{demonstration.id}' is not among the demonstrations", hint="save it first")
            library = self._library(found)
            self.habits = Habits.of(library)
            self.knowledge = replace(self.knowledge, library=library)
            self._learned_from, self._digest = found, made_from

    def retrain(self) -> Training:
        """Learn everything from all demonstrations, in a separate process, as ``tmd ground`` does.

        What is learned is used as soon as it is there, and kept where ``tmd ground`` finds it. Where learning is under
        way already, that goes on; if demonstrations came meanwhile, it begins once more at its end.
        """
        with self._guard:
            if self.training is None or not self.learning:
                return self._train()
            return self.training

    def _train(self) -> Training:
        self.learning = True
        self.training = Training(self.corpus, self._root, self._become)
        return self.training

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
        # a visitor may name any server: the key goes only to the one that the environment variable names
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
        """Ground a text with the current knowledge, as ``tmd ground`` does with its usual options.

        Changes that others made to the files are taken up first, and learned in the background.

        Args:
            text: The request.
            world: The environment.
            top: The number of distinct plans.
            reader: The reader; by default the offline reader of grammar and lexicon.
            ask: Answers a question of the reader; without it the likeliest option is taken.

        Raises:
            TmdError: A file of demonstrations is wrong, or the reader cannot work.
        """
        with self._guard:
            if digest(self.corpus) != self._digest:
                self.learn_one()
                self.retrain()
            now = self.knowledge
        return ground(text, world, now.library, reward=now.reward, goals=now.goals, top=top, reader=reader, ask=ask)

    def close(self) -> None:
        """End what is under way."""
        if self.training is not None:
            self.training.stop()

    def _library(self, found: tuple[Demonstration, ...]) -> Library:
        """Return the library of ``found``, learning only new ones if none was removed and each id is unique."""
        corpus, before = self.corpus, set(self._learned_from)
        order = {demonstration.id: number for number, demonstration in enumerate(found)}
        if len(order) < len(found) or not before <= set(found):
            return learn(found, corpus.world, corpus.lexicon)
        new = [teach(d, corpus.world(d.environment), corpus.lexicon) for d in found if d not in before]
        return self.knowledge.library.extended(new, order)

    def _become(self, trained: Trained | None) -> None:
        """Use what was learned; the library may know more by now, and then it is learned once more."""
        with self._guard:
            if trained is not None:
                self.learn_one()
                self.knowledge = Knowledge(self.knowledge.library, trained.reward, goals=trained.goals)
                if trained.made_from != self._digest:
                    self._train()  # nobody may see meanwhile that nothing is being learned
                    return
            self.learning = False
