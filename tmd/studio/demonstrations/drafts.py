"""Unsaved demonstrations and corrections: a small file for each visitor, written after each action.

Drafts lie in a directory of the user, not of the corpus, so that they are kept where the corpus cannot be written. A
visitor holds a lock that ends with the process: after a crash the same visitor can come back to the draft.
"""

from __future__ import annotations

import os
import re
import secrets
import threading
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Annotated, ClassVar, Literal, TypeAlias, TypeVar
from zlib import crc32

from filelock import FileLock
from pydantic import AfterValidator

from tmd.diagnostics import TmdError
from tmd.files import make_directory, try_lock, write_text
from tmd.json_record import JsonRecord
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.plan_file import parse_instruction
from tmd.studio.demonstrations.alignment import NO_HABITS, Habits
from tmd.studio.demonstrations.correction import Correction
from tmd.studio.demonstrations.session import DemonstratedStep, Session
from tmd.world.corpus import Corpus
from tmd.world.world import World

# The environment variable that names the directory of all drafts.
VARIABLE = "TMD_STUDIO_STATE"
_VISITOR = re.compile(r"[A-Za-z0-9_-]{1,64}")


def place(corpus: Corpus) -> Path:
    """Return the directory for the drafts of a domain's studio.

    It is below ``$TMD_STUDIO_STATE``, or ``$XDG_STATE_HOME/tmd/studio``, or ``~/.local/state/tmd/studio``. Each corpus
    has its own.
    """
    given = os.environ.get(VARIABLE)
    state = os.environ.get("XDG_STATE_HOME")
    home = Path(state) if state else Path.home() / ".local" / "state"
    root = Path(given) if given else home / "tmd" / "studio"
    mark = crc32(str(corpus.directory.resolve()).encode())
    return root / f"{corpus.folder.name}-{mark:08x}"


def _checked(line: str) -> str:
    return str(parse_instruction(line))


_Line: TypeAlias = Annotated[str, AfterValidator(_checked)]
# An instruction with its clause.
_Step: TypeAlias = tuple[_Line, int]


class _Kept(JsonRecord):
    WHAT = "a draft of this version"
    REMAKE = "begin again"
    SUFFIX: ClassVar[str]

    draft: Literal[1]
    environment: str


class Draft(_Kept):
    """A demonstration that is not saved.

    Attributes:
        task: The task it would be saved under.
        marks: The steps whose clause the person chose: the step's number, from 1, and the clause's, from 0.
    """

    SUFFIX = ".json"

    task: str
    text: str
    instructions: tuple[_Line, ...]
    marks: tuple[tuple[int, int], ...]

    @staticmethod
    def of(session: Session, task: str) -> Draft:
        """Return the draft of a session."""
        return Draft(
            draft=1,
            environment=session.world.name,
            task=task,
            text=session.text,
            instructions=tuple(map(str, session.instructions)),
            marks=tuple(session.pins.items()),
        )

    def resume(self, world: World, lexicon: Lexicon | None = None, habits: Habits = NO_HABITS) -> Session:
        """Return the session. Its steps can be undone one by one.

        Raises:
            TmdError: The environment has changed, so that an instruction does not apply any more.
        """
        return Session(
            world,
            self.text,
            lexicon,
            instructions=map(parse_instruction, self.instructions),
            pins=dict(self.marks),
            habits=habits,
        )


class CorrectionDraft(_Kept):
    """A correction that is not done.

    Attributes:
        proposed: The plan that is corrected.
        steps: The plan as it is now.
        goal: The condition on the end, as it was typed.
    """

    SUFFIX = ".correction.json"

    text: str
    proposed: tuple[_Step, ...]
    steps: tuple[_Step, ...]
    goal: str

    @staticmethod
    def of(correction: Correction, goal: str) -> CorrectionDraft:
        """Return the draft of a correction."""
        return CorrectionDraft(
            draft=1,
            environment=correction.world.name,
            text=correction.text,
            proposed=_pairs(correction.proposed),
            steps=_pairs(correction.steps),
            goal=goal,
        )

    def resume(self, world: World, lexicon: Lexicon | None = None) -> Correction:
        """Return the correction; undo leads to the plan that was proposed.

        Raises:
            TmdError: The environment has changed, so that it has no such instruction any more.
        """
        return Correction(world, self.text, _steps(self.proposed), lexicon, _steps(self.steps))


_Form = TypeVar("_Form", Draft, CorrectionDraft)


class Drafts:
    """The drafts of a studio. Threads may share it, and several studios the directory.

    They lie in ``directory``; see :func:`place`.
    """

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        self._held: dict[str, FileLock] = {}
        self._guard = threading.RLock()

    def enter(self, visitor: str | None = None) -> str:
        """Hold the drafts of a visitor until :meth:`leave`, or the end of the process.

        The name has letters, digits, ``_`` and ``-``, at most 64; by default it is one that nobody has.

        Returns:
            The visitor's name.

        Raises:
            TmdError: A visitor of that name is here, or it cannot be one.
            OutputError: The directory cannot be written to.
        """
        name = visitor or secrets.token_hex(8)
        with self._guard:
            file = self._file(name, ".lock")
            make_directory(self.directory)
            lock = None if name in self._held else try_lock(file)
            if lock is None:
                raise TmdError(f"'{name}' is here already", hint="close the other window first")
            self._held[name] = lock
        return name

    def leave(self, visitor: str) -> None:
        """Release the drafts of a visitor."""
        with self._guard:
            lock = self._held.pop(visitor, None)
            if lock is not None:
                if not self.kept(visitor):
                    with suppress(OSError):
                        self._file(visitor, ".lock").unlink()
                lock.release()

    def keep(self, visitor: str, draft: Draft | CorrectionDraft) -> None:
        """Write a draft, in place of the visitor's last one of the same form.

        Raises:
            TmdError: The visitor did not enter.
            OutputError: It cannot be written; the draft of the action before is still there.
        """
        with self._guard:
            self._require(visitor)
            write_text(self._file(visitor, draft.SUFFIX), draft.to_line())

    def discard(self, visitor: str, form: type[Draft | CorrectionDraft]) -> None:
        """Remove a visitor's draft.

        Raises:
            TmdError: The visitor did not enter.
        """
        with self._guard, suppress(OSError):
            self._require(visitor)
            self._file(visitor, form.SUFFIX).unlink(missing_ok=True)

    def kept(self, visitor: str) -> bool:
        """Return whether a visitor of that name has a draft."""
        if not _VISITOR.fullmatch(visitor):
            return False
        return any(self._file(visitor, form.SUFFIX).exists() for form in (Draft, CorrectionDraft))

    def of(self, visitor: str, form: type[_Form]) -> _Form | None:
        """Return the draft of a visitor, if there is one; a damaged one is set aside.

        Raises:
            TmdError: It was damaged; the message names its new place.
        """
        file = self._file(visitor, form.SUFFIX)
        with self._guard:
            if not file.exists():
                return None
            try:
                return form.from_text(file.read_text(encoding="utf-8"), file.name)
            except (OSError, ValueError, TmdError) as error:
                raise TmdError(_set_aside(file, error)) from None

    def _require(self, visitor: str) -> None:
        if visitor not in self._held:
            raise TmdError(f"'{visitor}' is not here", hint="enter first")

    def _file(self, visitor: str, suffix: str) -> Path:
        if not _VISITOR.fullmatch(visitor):
            raise TmdError("this cannot be the name of a visitor", hint="use letters, digits, _ and -, at most 64")
        return self.directory / f"{visitor}{suffix}"


def _set_aside(file: Path, error: Exception) -> str:
    """Rename a damaged draft, and return a message about it."""
    aside = file.with_name(f"{file.name}.damaged-{secrets.token_hex(4)}")
    reason = f"the draft of '{file.name.partition('.')[0]}' is damaged ({' '.join(str(error).split())[:200]})"
    with suppress(OSError):
        file.replace(aside)
        return f"{reason}; it is kept as {aside}"
    return f"{reason}, and {file} cannot be moved"


def _pairs(steps: Iterable[DemonstratedStep]) -> tuple[_Step, ...]:
    return tuple((str(step.instruction), step.clause) for step in steps)


def _steps(pairs: Sequence[_Step]) -> tuple[DemonstratedStep, ...]:
    return tuple(DemonstratedStep(parse_instruction(line), clause) for line, clause in pairs)
