"""Learning from a domain's demonstrations while more of them are saved.

A demonstration that was just saved is in the library at once; the policy and the meanings of verbs, which take longer,
are learned in the background. A text that is grounded meanwhile is grounded with the knowledge of its beginning, all of
one piece. At the end the knowledge is that of ``tmd ground`` for the same files.
"""

from __future__ import annotations

import multiprocessing
import os
import threading
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache, partial
from multiprocessing.process import BaseProcess
from pathlib import Path

from tmd.diagnostics import TmdError
from tmd.ground import Ask, ground
from tmd.grounded import Grounded
from tmd.knowledge import Knowledge, digest, known
from tmd.library.library import learn
from tmd.readers.interface import Reader
from tmd.readers.llm.client import URL, ModelSettings
from tmd.readers.llm.reader import llm_reader
from tmd.studio.demonstrations.alignment import Habits
from tmd.world.corpus import Corpus
from tmd.world.demonstration import Demonstration
from tmd.world.folder import DomainFolder
from tmd.world.world import World

# Niceness of the process that learns (POSIX): the studio's own goes first.
_NICE = 10
# Maximum number of language-model readers that are kept.
_READERS = 8
# The key for servers that the environment does not name.
_NO_KEY = "none"


def _study(folder: Path, directory: Path, root: Path | None) -> None:
    """Learn in a process of its own; what is learned is kept in the user's cache."""
    os.nice(_NICE)
    with suppress(TmdError):  # the studio finds the same error when it looks for the result
        known(Corpus(DomainFolder(folder), directory), root, lambda share: None)


class Teacher:
    """Knowledge learned in one domain. Threads may share it.

    ``root`` is where ``tmd learn --out`` keeps what it learns; beside the demonstrations where none is given. What was
    saved there and still holds is taken, else everything is learned now.

    Attributes:
        knowledge: The current knowledge.
        habits: The instructions carried out for each verb, for proposals of clauses.
        learning: Whether the files teach more than is known, and that is being learned.
        error: Why learning failed the last time; ``None`` if it did not.

    Raises:
        TmdError: A demonstration is wrong.
    """

    def __init__(self, corpus: Corpus, root: Path | None = None) -> None:
        self.corpus = corpus
        self._root = root
        self._digest = digest(corpus)
        self.knowledge = known(corpus, root)
        self.habits = Habits.of(self.knowledge.library)
        self._guard = threading.RLock()
        self.learning = False
        self.error: Exception | None = None
        self._thread: threading.Thread | None = None
        self._process: BaseProcess | None = None
        self._closed = False
        self._readers = lru_cache(maxsize=_READERS)(partial(llm_reader, corpus))

    def learn_one(self, demonstration: Demonstration | None = None) -> None:
        """Take up the demonstrations as the files have them now, among them one that was just saved.

        The library is then that of ``tmd learn`` for the same files. The policy and the meanings of verbs stay as they
        are until :meth:`retrain` is done.

        It is what :meth:`tmd.studio.demonstrations.demo_store.Archive.save` returned.

        Raises:
            TmdError: A file of demonstrations is wrong, or the demonstration is in none. What was known stays.
        """
        with self._guard:
            made_from = digest(self.corpus)
            self.corpus.reread()
            found = self.corpus.demonstrations()
            if demonstration is not None and demonstration not in found:
                raise TmdError(f"'{demonstration.id}' is not among the demonstrations", hint="save it first")
            library = learn(found, self.corpus.world, self.corpus.lexicon)
            self.habits = Habits.of(library)
            self.knowledge = replace(self.knowledge, library=library)
            self._digest = made_from

    def retrain(self) -> None:
        """Learn everything from all demonstrations, in the background, as ``tmd ground`` does.

        What is learned is used as soon as it is there, and kept where ``tmd ground`` finds it. If demonstrations come
        meanwhile, it is learned once more.
        """
        with self._guard:
            if not self.learning:
                self.learning, self.error = True, None
                self._thread = threading.Thread(target=self._train, daemon=True)
                self._thread.start()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait for the end of learning, at most so many seconds; return whether it came.

        Raises:
            TmdError: Learning failed.
            OSError: A file could not be read.
        """
        if self._thread is not None:
            self._thread.join(timeout)
        if self.error is not None:
            raise self.error
        return not self.learning

    def _train(self) -> None:
        """Learn, and use what was learned, until the files teach nothing more."""
        try:
            while self.learning:
                made_from = digest(self.corpus)
                self._become(self._trained(), made_from)
        except (TmdError, OSError) as error:
            with self._guard:
                self.error, self.learning = error, False

    def _trained(self) -> Knowledge:
        corpus = self.corpus
        arguments = corpus.folder.path, corpus.directory, self._root
        with self._guard:
            if self._closed:
                raise TmdError("learning was stopped; what was known before is used")
            process = multiprocessing.get_context("spawn").Process(target=_study, args=arguments, daemon=True)
            process.start()
            self._process = process
        process.join()
        if process.exitcode:
            why = "was stopped" if self._closed else "ended before it was done"
            raise TmdError(f"learning {why}; what was known before is used", hint="save something to learn again")
        return known(Corpus(corpus.folder, corpus.directory), self._root, lambda share: None)

    def _become(self, trained: Knowledge, made_from: str) -> None:
        """Use what was learned from the files of a digest; they may teach more by now."""
        with self._guard:
            if digest(self.corpus) != self._digest:
                self.learn_one()
            self.knowledge = Knowledge(self.knowledge.library, trained.reward, goals=trained.goals)
            self.learning = made_from != self._digest  # nobody may see meanwhile that nothing is being learned

    def model_reader(self, model: str, url: str, *, verify: bool) -> Reader:
        """Return the reader that asks a language model; the same one for the same settings.

        Where ``model`` or ``url`` is empty, that of the environment variable is taken. With ``verify`` the model is
        asked once more whether the plan does what was asked.

        Raises:
            ModelError: There is no model, or no key for a server that needs one.
            TmdError: A file of sentence tests is wrong.
        """
        # a visitor may name any server: the key goes only to the one that the environment variable names
        trusted = url in ("", os.environ.get(URL, "").strip())
        settings = ModelSettings(model or None, url or None, key=None if trusted else _NO_KEY)
        return self._readers(settings, verify=verify)

    def ground(
        self, text: str, world: World, top: int = 1, *, reader: Reader | None = None, ask: Ask | None = None
    ) -> Grounded:
        """Ground a text with the current knowledge, as ``tmd ground`` does with its usual options.

        Changes that others made to the files are taken up first, and learned in the background.

        ``reader`` is the offline reader of grammar and lexicon by default. ``ask`` answers a question of the reader;
        without it the likeliest option is taken.

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
        """End learning that is under way: what was learned so far is lost, and what was known before stays."""
        with self._guard:
            self._closed = True
            if self._process is not None:
                self._process.terminate()
        if self._thread is not None:
            self._thread.join()
