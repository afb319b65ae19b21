"""Store of demonstrations: a line of ``<problems>/<domain>/<task>/demonstrations.jsonl`` for each finished session.

The file is replaced as a whole, by one thread or process at a time. Before anything is written the demonstration is
played, and its line is read back.
"""

from __future__ import annotations

import re
from pathlib import Path

from tmd.diagnostics import TmdError
from tmd.files import locked, make_directory, write_bytes
from tmd.pddl.model import GroundAtom
from tmd.pddl.task import Bits
from tmd.studio.demonstrations.session import EditedSteps
from tmd.world.corpus import Corpus, check_executable, final_state
from tmd.world.demonstration import (
    Demonstration,
    check_goal,
    demonstration_line,
    read_demonstration,
    read_demonstrations,
)
from tmd.world.world import World

# The task of demonstrations for which none was named.
SHOWN = "shown"
FILE = "demonstrations.jsonl"
_LOCK = f".{FILE}.lock"
# Seconds that a writer waits for another.
_WAIT = 10.0
_NAME = re.compile(r"[a-z][a-z0-9_]{0,59}")
_NUMBER = re.compile(r"[0-9]{1,9}")
_TAKEN = frozenset({"environments", "learned"})
# Characters of a name that are shown.
_LONGEST = 200


class Archive:
    """Store of the demonstrations of one domain. Threads may share it.

    A writer gives up after it waited ``wait`` seconds for another.
    """

    def __init__(self, corpus: Corpus, *, wait: float = _WAIT) -> None:
        self.corpus = corpus
        self.wait = wait

    def file(self, task: str) -> Path:
        """Return the corpus of a task.

        Raises:
            TmdError: The task cannot have that name.
        """
        if not _NAME.fullmatch(task) or task in _TAKEN:
            hint = "a name begins with a lower-case letter and has lower-case letters, digits and _, at most 60"
            raise TmdError(f"a task cannot be called {task[:_LONGEST]!r}", hint=hint)
        return self.corpus.directory / task / FILE

    def refuse(self, world: World) -> None:
        """Make sure that what is shown in ``world`` could be saved: everybody must find the environment again.

        Raises:
            TmdError: The domain does not have it.
        """
        directory = self.corpus.directory / "environments"
        if world.name not in self.corpus.environments():
            raise TmdError(
                f"'{world.name}' is not an environment in {directory}, so nothing that is shown in it can be saved",
                hint="copy its file there, and begin again",
            )
        if self.corpus.world(world.name).task.problem != world.task.problem:
            raise TmdError(
                f"'{world.name}' is not the environment of that name in {directory}",
                hint="give it another name, and copy its file there",
            )

    def save(self, session: EditedSteps, task: str = SHOWN, *, goal: str | None = None) -> Demonstration:
        """Append a demonstration to the file of its task.

        ``session`` is the demonstration, or the correction: all its steps, wherever it is looked at. ``task`` is what
        it is an example of, ``goal`` the goal of the text, as a closed PDDL condition; not recorded by default.

        Returns:
            The demonstration as the file has it now.

        Raises:
            TmdError: There are no steps and no plan that is corrected, the task cannot have that name, the environment
                is none of the domain's, the file holds a line that is not a demonstration, the goal is not a condition
                of the environment or does not hold at the end. Nothing was written.
            OutputError: The file cannot be written. It is as it was.
        """
        file = self.file(task)
        segments = session.segments()
        if not session.steps and not session.proposed:  # that nothing is to be done is a correction as well
            raise TmdError("nothing was demonstrated yet", hint="carry out at least one instruction")
        self.refuse(session.world)
        make_directory(file.parent)
        with locked(file.with_name(_LOCK), wait=self.wait):
            before = read_demonstrations(file) if file.exists() else []
            name = _next_id(f"{task}-{session.world.name}", before)
            ends = _end_state(session)
            proposed = None if session.proposed is None else tuple(step.instruction for step in session.proposed)
            where, text = session.world.name, session.text
            found = Demonstration(name, task, where, text, segments, ends, proposed, goal=goal)
            line = demonstration_line(found)
            self._check(found, line, file, len(before) + 1)
            old = file.read_bytes() if file.exists() else b""
            gap = b"" if not old or old.endswith(b"\n") else b"\n"
            write_bytes(file, old + gap + line.encode() + b"\n")
            return read_demonstrations(file)[-1]

    def _check(self, found: Demonstration, line: str, file: Path, number: int) -> None:
        """Check that a demonstration reads back as it is, is executable, and reaches its goal.

        Raises:
            TmdError: It is not.
        """
        if read_demonstration(file, number, line) != found:
            raise TmdError(f"'{found.id}' would be read as something else, so it was not written")
        world = self.corpus.world(found.environment)
        check_executable(found, world)
        check_goal(found, world.task.problem, final_state(found, world))


def _end_state(session: EditedSteps) -> tuple[str, ...]:
    """Return the facts that changed, without those whose first argument is a constant, such as the robot."""
    world, init = session.world, session.world.task.init
    end = world.task.trace(init, session.instructions)[-1]

    def own(bits: Bits) -> list[GroundAtom]:
        return [a for a in world.task.names(bits) if a.args and a.args[0] not in world.profiles.constants]

    return (*map(str, own(end & ~init)), *(f"(not {atom})" for atom in own(init & ~end)))


def _next_id(stem: str, before: list[Demonstration]) -> str:
    """Return the stem with the number after the highest that is used."""
    used = [d.id.removeprefix(f"{stem}-") for d in before if d.id.startswith(f"{stem}-")]
    highest = max((int(number) for number in used if _NUMBER.fullmatch(number)), default=0)
    return f"{stem}-{highest + 1:02d}"
