"""The tasks that are trained together (section VII).

"…the first two tasks trained together and then the next two tasks trained together." The file
``problems/<domain>/protocol.yaml`` says so for a domain::

    trained_together:
      - [boiling_water, coffee]
      - [affogato, ramen]

A task that stands in no group, or has no such file, is trained with all tasks.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from pydantic import BaseModel, ConfigDict

from tmd.diagnostics import TmdError
from tmd.pddl.reading.syntax import nearest
from tmd.world.yaml_positions import YamlSource

FILE = "protocol.yaml"


class ProtocolFile(BaseModel):
    """The whole of a protocol file."""

    model_config = ConfigDict(extra="forbid")
    trained_together: list[list[str]] = []


@dataclass(frozen=True, slots=True)
class TrainingGroup:
    """Tasks that are tested with the same training tasks.

    Attributes:
        tested: The tasks that are tested, sorted.
        trained: The tasks that are trained on, sorted.
    """

    tested: tuple[str, ...]
    trained: tuple[str, ...]


def read_protocol(path: Path, tasks: Collection[str]) -> tuple[frozenset[str], ...]:
    """Return the groups of tasks in a protocol file; none where there is no file.

    Args:
        path: The file.
        tasks: The tasks that there are.

    Raises:
        TmdError: The file is wrong, names a task that is not there, or names one twice.
    """
    if not path.is_file():
        return ()
    source = YamlSource(path)
    groups = source.load(ProtocolFile).trained_together
    seen: set[str] = set()
    for i, group in enumerate(groups):
        for j, task in enumerate(group):
            place = ("trained_together", i, j)
            if task not in tasks:
                raise source.error(place, f"there is no task '{task}'", nearest(task, sorted(tasks)))
            if task in seen:
                raise source.error(place, f"the task '{task}' stands here twice")
            seen.add(task)
    return tuple(frozenset(group) for group in groups if group)


def training_groups(
    tested: Iterable[str],
    trained_with: Callable[[str], frozenset[str]],
    train_tasks: Sequence[str] | None,
    tasks: Collection[str],
) -> list[TrainingGroup]:
    """Return the tested tasks, put together by what they are trained on, in the order of their first tasks.

    Args:
        tested: The tasks that are tested.
        trained_with: What the protocol trains a task with.
        train_tasks: What to train on instead.
        tasks: The tasks that there are.

    Raises:
        TmdError: There is no such training task.
    """
    for task in train_tasks or ():
        if task not in tasks:
            raise TmdError(f"--train-tasks: there is no task '{task}'", hint=nearest(task, sorted(tasks)))
    found: dict[frozenset[str], list[str]] = {}
    for task in sorted(set(tested)):
        trained = frozenset(train_tasks) if train_tasks is not None else trained_with(task)
        found.setdefault(trained, []).append(task)
    return [TrainingGroup(tuple(own), tuple(sorted(trained))) for trained, own in found.items()]
