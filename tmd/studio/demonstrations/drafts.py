"""What was demonstrated or corrected and not saved yet: a small file for each visitor, written after each action.

A draft lies in a directory of its user, not of the corpus, so that it is kept where the corpus cannot be written. Who
works on it holds a lock that ends with the process: after a crash a draft is nobody's, and is offered again.
"""

from __future__ import annotations

import json
import os
import re
import secrets
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar
from zlib import crc32

from tmd.diagnostics import TmdError
from tmd.files import make_directory, write_text
from tmd.language.lexicon.lexicon import Lexicon
from tmd.lock import Lock, try_lock
from tmd.pddl.plan_file import parse_instruction
from tmd.studio.demonstrations.alignment import NO_HABITS, Habits
from tmd.studio.demonstrations.correction import Correction
from tmd.studio.demonstrations.session import DemonstratedStep, Session
from tmd.veil.corpus import Corpus
from tmd.veil.world import World

VARIABLE = "TMD_STUDIO_STATE"
"""The environment variable that names the directory of all drafts."""
_FORM = 1
"""The number of this form of draft."""
_VISITOR = re.compile(r"[A-Za-z0-9_-]{1,64}")
_LARGEST = 1_000_000
"""Bytes that no draft has."""
_Kept = TypeVar("_Kept")


def place(corpus: Corpus) -> Path:
    """The directory for the drafts of a domain's studio.

    It is below ``$TMD_STUDIO_STATE``, or ``$XDG_STATE_HOME/tmd/studio``, or ``~/.local/state/tmd/studio``. Each corpus
    has its own.
    """
    given = os.environ.get(VARIABLE)
    state = os.environ.get("XDG_STATE_HOME")
    home = Path(state) if state else Path.home() / ".local" / "state"
    root = Path(given) if given else home / "tmd" / "studio"
    mark = crc32(str(corpus.directory.resolve()).encode())
    return root / f"{corpus.folder.name}-{mark:08x}"


@dataclass(frozen=True, slots=True)
class Draft:
    """A session as it is kept.

    Attributes:
        visitor: Whose it is.
        environment: The name of its environment.
        task: The task it would be saved under.
        text: What was to be done.
        instructions: What was done.
        marks: The steps whose clause the person chose: the step's number, from 1, and the clause's, from 0.
        proposed: The plan that is corrected, each instruction with its clause; ``None`` where there is none.
    """

    visitor: str
    environment: str
    task: str
    text: str
    instructions: tuple[str, ...]
    marks: tuple[tuple[int, int], ...] = ()
    proposed: tuple[tuple[str, int], ...] | None = None

    def resume(self, world: World, lexicon: Lexicon | None = None, habits: Habits = NO_HABITS) -> Session:
        """The session again. Steps can be undone one by one; what had been undone is forgotten.

        Raises:
            TmdError: The environment has changed, so that an instruction does not apply any more.
        """
        proposed = self.proposed
        return Session(
            world,
            self.text,
            lexicon,
            instructions=map(parse_instruction, self.instructions),
            pins=dict(self.marks),
            proposed=None if proposed is None else _steps(proposed),
            habits=habits,
        )


@dataclass(frozen=True, slots=True)
class CorrectionDraft:
    """A correction as it is kept, while it is not done.

    Attributes:
        environment: The name of its environment.
        text: What was said.
        proposed: The plan that is corrected, each instruction with its clause.
        steps: What it was made, in the same form.
        goal: What must hold at the end, as it was typed.
    """

    environment: str
    text: str
    proposed: tuple[tuple[str, int], ...]
    steps: tuple[tuple[str, int], ...]
    goal: str = ""

    def resume(self, world: World, lexicon: Lexicon | None = None) -> Correction:
        """The correction again; undo leads to the plan that was proposed.

        Raises:
            TmdError: The environment has changed, so that it has no such instruction any more.
        """
        return Correction(world, self.text, _steps(self.proposed), lexicon, _steps(self.steps))


@dataclass(frozen=True, slots=True)
class Offered:
    """The drafts that nobody works on, the newest first; and what is wrong with those that cannot be read."""

    drafts: tuple[Draft, ...]
    complaints: tuple[str, ...]


class Drafts:
    """The drafts of a studio. Threads may share it, and several studios the directory.

    Args:
        directory: Where they are; see :func:`place`.
    """

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        self._held: dict[str, Lock] = {}
        self._guard = threading.RLock()

    def enter(self, visitor: str | None = None) -> str:
        """Somebody came: their draft is theirs until they leave or the process ends.

        Args:
            visitor: Letters, digits, ``_`` and ``-``, at most 64; a name that nobody has, where none is given.

        Returns:
            The visitor's name.

        Raises:
            TmdError: Somebody is here by that name, or it cannot be one.
            OutputError: The directory cannot be written to.
        """
        name = visitor or secrets.token_hex(8)
        with self._guard:
            if name in self._held:
                raise TmdError(f"'{name}' is here already", hint="close the other window first")
            self._held[name] = self._lock(name)
        return name

    def leave(self, visitor: str) -> None:
        """Somebody went; their draft, if there is one, is offered again."""
        with self._guard:
            lock = self._held.pop(visitor, None)
            if lock is not None:
                lock.release(remove=not self.kept(visitor))

    def keep(self, visitor: str, session: Session, task: str) -> None:
        """Write down what ``session`` is now. The whole file is replaced.

        Raises:
            TmdError: The visitor did not enter.
            OutputError: It cannot be written; the draft of the action before is still there.
        """
        self._write(visitor, self._file(visitor), _to_json(session, task))

    def keep_correction(self, visitor: str, correction: Correction, goal: str = "") -> None:
        """Write down what a correction is now, and what must hold at its end; errors as those of :meth:`keep`."""
        content = {
            "draft": _FORM,
            "environment": correction.world.name,
            "text": correction.text,
            "proposed": _pairs(correction.proposed),
            "steps": _pairs(correction.steps),
            "goal": goal,
        }
        self._write(visitor, self._correction_file(visitor), content)

    def _write(self, visitor: str, file: Path, content: Mapping[str, Any]) -> None:
        with self._guard:
            if visitor not in self._held:
                raise TmdError(f"'{visitor}' is not here", hint="enter first")
            write_text(file, json.dumps(content, ensure_ascii=False) + "\n")

    def discard(self, visitor: str) -> None:
        """Forget a visitor's draft: it was saved, or is not wanted.

        Raises:
            TmdError: The visitor did not enter.
        """
        self._forget(visitor, self._file(visitor))

    def discard_correction(self, visitor: str) -> None:
        """Forget a visitor's correction: it is done, or not wanted; errors as those of :meth:`discard`."""
        self._forget(visitor, self._correction_file(visitor))

    def _forget(self, visitor: str, file: Path) -> None:
        with self._guard:
            if visitor not in self._held:
                raise TmdError(f"'{visitor}' is not here", hint="enter first")
            with suppress(OSError):
                file.unlink(missing_ok=True)

    def kept(self, visitor: str) -> bool:
        """Whether something is kept by that name; nothing is by one that nobody can have."""
        if not _VISITOR.fullmatch(visitor):
            return False
        return self._file(visitor).exists() or self._correction_file(visitor).exists()

    def of(self, visitor: str) -> Draft | None:
        """The draft of somebody who entered, if there is one; a damaged one is set aside.

        Raises:
            TmdError: It was damaged; tells where it is now.
        """
        return self._found(self._file(visitor), _read)

    def correction_of(self, visitor: str) -> CorrectionDraft | None:
        """The correction of somebody who entered, if there is one; a damaged one is set aside.

        Raises:
            TmdError: It was damaged; tells where it is now.
        """
        return self._found(self._correction_file(visitor), _read_correction)

    def _found(self, file: Path, read: Callable[[Path], _Kept]) -> _Kept | None:
        with self._guard:
            if not file.exists():
                return None
            try:
                return read(file)
            except (OSError, ValueError, TypeError, KeyError, RecursionError, TmdError) as error:
                raise TmdError(self._set_aside(file, error)) from None

    def offered(self) -> Offered:
        """The drafts that nobody works on. Damaged ones are set aside and told of, once."""
        found: list[tuple[int, Draft]] = []
        complaints: list[str] = []
        with self._guard:
            for file in sorted(self.directory.glob("*.json")):
                lock = None if file.stem in self._held or not _VISITOR.fullmatch(file.stem) else self._try(file.stem)
                if lock is None:
                    continue
                try:
                    draft = self.of(file.stem)
                    if draft is not None:
                        found.append((file.stat().st_mtime_ns, draft))
                except (OSError, TmdError) as error:
                    complaints.append(str(error))
                lock.release(remove=not file.exists())
        found.sort(key=lambda pair: (-pair[0], pair[1].visitor))
        return Offered(tuple(draft for _, draft in found), tuple(complaints))

    def take(self, visitor: str, draft: Draft) -> Draft:
        """Make an offered draft the visitor's own.

        Raises:
            TmdError: Somebody else took it first, or it is gone; or the visitor did not enter.
            OutputError: The directory cannot be written to.
        """
        with self._guard:
            if visitor not in self._held:
                raise TmdError(f"'{visitor}' is not here", hint="enter first")
            lock = self._lock(draft.visitor) if draft.visitor not in self._held else None
            if lock is None:
                raise TmdError("somebody else works on this draft now", hint="choose another")
            try:
                found = self.of(draft.visitor)
                if found is None:
                    raise TmdError("this draft is gone", hint="choose another")
                self._file(draft.visitor).replace(self._file(visitor))
            finally:
                lock.release(remove=not self._file(draft.visitor).exists())
            return replace(found, visitor=visitor)

    def _file(self, visitor: str) -> Path:
        if not _VISITOR.fullmatch(visitor):
            raise TmdError("this cannot be the name of a visitor", hint="use letters, digits, _ and -, at most 64")
        return self.directory / f"{visitor}.json"

    def _correction_file(self, visitor: str) -> Path:
        return self._file(visitor).with_suffix(".correction.json")

    def _try(self, visitor: str) -> Lock | None:
        return try_lock(self._file(visitor).with_suffix(".lock"))

    def _lock(self, visitor: str) -> Lock:
        file = self._file(visitor)
        make_directory(self.directory)
        lock = try_lock(file.with_suffix(".lock"))
        if lock is None:
            raise TmdError(f"'{visitor}' is here already", hint="close the other window first")
        return lock

    def _set_aside(self, file: Path, error: Exception) -> str:
        """Rename a damaged draft; what to tell of it."""
        number = 1
        while (aside := file.with_name(f"{file.name}.damaged-{number}")).exists():
            number += 1
        reason = f"the draft of '{file.stem}' is damaged ({' '.join(str(error).split())[:200]})"
        try:
            file.replace(aside)
        except OSError:
            return f"{reason}, and {file} cannot be moved"
        return f"{reason}; it is kept as {aside}"


def _to_json(session: Session, task: str) -> dict[str, Any]:
    proposed = session.proposed
    return {
        "draft": _FORM,
        "environment": session.world.name,
        "task": task,
        "text": session.text,
        "instructions": [str(instruction) for instruction in session.instructions],
        "marks": [list(pair) for pair in session.pins.items()],
        "proposed": None if proposed is None else _pairs(proposed),
    }


def _pairs(steps: Iterable[DemonstratedStep]) -> list[list[str | int]]:
    return [[str(step.instruction), step.clause] for step in steps]


def _steps(pairs: Iterable[tuple[str, int]]) -> tuple[DemonstratedStep, ...]:
    return tuple(DemonstratedStep(parse_instruction(instruction), clause) for instruction, clause in pairs)


def _loaded(file: Path) -> dict[str, Any]:
    if file.stat().st_size > _LARGEST:
        raise ValueError("it is too large")
    data = json.loads(file.read_bytes())
    if not isinstance(data, dict) or data["draft"] != _FORM:
        raise ValueError("it is not a draft of this version")
    return data


def _read(file: Path) -> Draft:
    """The draft in ``file``.

    Raises:
        OSError, ValueError, TypeError, KeyError, RecursionError, TmdError: It is none.
    """
    data = _loaded(file)
    proposed = data["proposed"]
    environment, task, text = texts = [data[key] for key in ("environment", "task", "text")]
    found = Draft(
        file.stem,
        environment,
        task,
        text,
        tuple(data["instructions"]),
        tuple((step, clause) for step, clause in data["marks"]),
        None if proposed is None else tuple((instruction, clause) for instruction, clause in proposed),
    )
    lines = [*found.instructions, *(instruction for instruction, _ in found.proposed or ())]
    numbers = [n for pair in found.marks for n in pair] + [clause for _, clause in found.proposed or ()]
    _check(texts, lines, numbers)
    return found


def _read_correction(file: Path) -> CorrectionDraft:
    """The correction in ``file``; errors as those of :func:`_read`."""
    data = _loaded(file)
    environment, text, goal = texts = [data[key] for key in ("environment", "text", "goal")]
    proposed, steps = (tuple((line, clause) for line, clause in data[key]) for key in ("proposed", "steps"))
    _check(texts, [line for line, _ in proposed + steps], [clause for _, clause in proposed + steps])
    return CorrectionDraft(environment, text, proposed, steps, goal)


def _check(texts: Iterable[object], lines: Sequence[str], numbers: Iterable[object]) -> None:
    if not all(isinstance(said, str) for said in [*texts, *lines]) or not all(isinstance(n, int) for n in numbers):
        raise TypeError("a value is of the wrong kind")
    for line in lines:
        parse_instruction(line)
