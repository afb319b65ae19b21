"""What a domain's demonstrations teach, while more of them come.

A demonstration that was just saved is in the library at once; the policy and what verbs mean, which take longer, are
learned again when somebody asks for it. Whoever grounds a text meanwhile has what was known when they began, all of one
piece.
"""

from __future__ import annotations

import threading
from dataclasses import replace
from pathlib import Path

from tmd.diagnostics import TmdError
from tmd.ground import ground
from tmd.grounded import Grounded
from tmd.inference.learned import Knowledge, known
from tmd.studio.demonstrations.alignment import Habits
from tmd.studio.learning.training import Trained, Training
from tmd.veil.corpus import Corpus
from tmd.veil.demonstration import Demonstration
from tmd.veil.library import Library, learn, teach
from tmd.veil.world import World


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
