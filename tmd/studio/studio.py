"""State shared by all visitors: the domain, its environments, the robot's figure, and the teacher."""

from __future__ import annotations

from contextlib import suppress
from functools import cache
from pathlib import Path
from threading import RLock

from tmd.diagnostics import MissingToolError, TmdError
from tmd.pddl.reading.syntax import nearest, read_text
from tmd.studio.demonstrations.clause_spans import clean
from tmd.studio.demonstrations.demo_store import Archive
from tmd.studio.demonstrations.drafts import Drafts, place
from tmd.studio.demonstrations.session import EditedSteps, Session
from tmd.studio.environment_view import Setting, open_setting
from tmd.studio.teaching import Teacher
from tmd.studio.view3d.meshes import Figure
from tmd.studio.view3d.performance import RobotRun
from tmd.world.corpus import Corpus
from tmd.world.demonstration import Demonstration


class Studio:
    """A domain, opened for visitors; its methods may be called from any thread.

    ``start`` is the environment that visitors come to first, or its file, which need not be among those of the domain;
    the first one by default.

    Attributes:
        archive: Where demonstrations are saved.
        drafts: What was not saved yet.
        runs: The last run of the robot in each window.

    Raises:
        TmdError: There is no such environment, or it is wrong.
    """

    def __init__(self, corpus: Corpus, teacher: Teacher, start: str | Path | None = None) -> None:
        self.corpus = corpus
        self.teacher = teacher
        self.archive = Archive(corpus)
        self.drafts = Drafts(place(corpus))
        self.runs: dict[str, RobotRun] = {}
        self._texts = example_texts(corpus)
        self._lock = RLock()
        self._settings: dict[str, Setting] = {}
        self._extra: dict[str, Path] = {}
        if isinstance(start, Path) and start.parent == corpus.directory / "environments":
            start = start.stem
        elif isinstance(start, Path):
            name = corpus.read(start).name
            self._extra[name], start = start, name
        names = self.environments()
        if not names:
            raise TmdError(
                f"there are no environments in {corpus.directory / 'environments'}",
                hint="write one, or copy a bundled one",
            )
        if start is not None and start not in names:
            raise TmdError(f"there is no environment '{start}'", hint=nearest(start, names))
        self.start = start or names[0]

    def environments(self) -> list[str]:
        """Return the names of the environments, sorted."""
        return sorted({*self.corpus.environments(), *self._extra})

    def setting(self, name: str) -> Setting:
        """Return an environment, made ready once.

        Raises:
            TmdError: There is none, or it is wrong.
        """
        with self._lock:
            if name not in self._settings:
                place = self._extra.get(name, name)
                self._settings[name] = open_setting(self.corpus, self.corpus.world(place), self.corpus.file(place))
            return self._settings[name]

    def figure(self) -> Figure | None:
        """Return the robot; ``None`` where its model is not installed."""
        with self._lock:
            return _figure()

    def session(self, setting: Setting, text: str) -> Session:
        """Return a demonstration of a text, at its beginning.

        Raises:
            TmdError: The text is empty or too long, or what is shown here cannot be saved.
        """
        self.archive.refuse(setting.world)
        return Session(setting.world, text, self.corpus.lexicon, habits=self.teacher.habits)

    def save(self, session: EditedSteps, task: str, goal: str | None = None) -> Demonstration:
        """Save a demonstration: the next text is grounded with it, and the rest is learned in the background.

        ``task`` is what it is an example of, ``goal`` the goal of the text, as a closed PDDL condition; not recorded by
        default.

        Raises:
            TmdError: It cannot be saved; nothing is written.
        """
        saved = self.archive.save(session, task, goal=goal)
        self.teacher.learn_one(saved)
        self.teacher.retrain()
        return saved

    def corrected(self, text: str, environment: str) -> Demonstration | None:
        """Return the last correction of a plan for a text in an environment."""
        found = [each for each in self.corpus.demonstrations() if each.proposed is not None]
        return next((each for each in reversed(found) if (each.text, each.environment) == (text, environment)), None)

    def examples(self, name: str) -> list[str]:
        """Return the example texts of an environment."""
        return self._texts.get(name, [])

    def warm(self) -> None:
        """Ground a text, so that what is compiled and looked up once is there when the first visitor asks."""
        texts = self.examples(self.start)
        with suppress(TmdError):
            self.figure()
            if texts:
                self.teacher.ground(texts[0], self.setting(self.start).world, top=1)


def example_texts(corpus: Corpus) -> dict[str, list[str]]:
    """Return the texts of a domain by environment: always the same, in the same order.

    First come those of demonstrations, by task: the first of each task in the environment, so each can be carried out
    there. Then come those of ``pNN-*.nl``, whose names end with the environment.

    Raises:
        TmdError: One of the files is wrong.
    """
    found: dict[str, dict[str, str]] = {name: {} for name in corpus.environments()}
    for each in corpus.demonstrations():
        if each.environment in found:
            found[each.environment].setdefault(each.task, each.text)
    for path in sorted(corpus.directory.glob("*.nl")):
        environment = path.stem.rpartition("-")[2]
        if environment in found:
            found[environment][f"~{path.stem}"] = clean(read_text(path))
    return {name: list(dict.fromkeys(text for _, text in sorted(texts.items()))) for name, texts in found.items()}


@cache
def _figure() -> Figure | None:
    try:
        return Figure()
    except MissingToolError:
        return None
