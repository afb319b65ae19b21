"""Loading the VEIL-500 data set from a directory the user has; none of it is part of this project.

The set is free for academic and research use with citation; see ``docs/veil500.md``. Anything that is odd but
usable is kept and counted by ``experiments/veil500_report.py``; anything that cannot be used is a
:class:`~tmd.diagnostics.DataError` that says where.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from tmd.datasets.veil500.environment import (
    FOLDERS,
    KITCHEN,
    LIVING_ROOM,
    VeilEnvironment,
    VeilObjectClass,
    read_classes,
    read_environment,
)
from tmd.datasets.veil500.forms import from_veil
from tmd.datasets.veil500.xml import Element, read_xml
from tmd.diagnostics import DataError
from tmd.pddl.model import Instruction

SHORTEST_REPEAT = 3
"""A repeated run counts as a slip from this many words on."""

_NOT_WORD = re.compile(r"[^a-z0-9']+")
_WORD = re.compile(r"[A-Za-z0-9]")


@dataclass(frozen=True, slots=True)
class VeilSegment:
    """A piece of a text: ``text == cleaned[start:end]``; it may be empty or hold only a full stop."""

    text: str
    start: int
    end: int

    @property
    def has_words(self) -> bool:
        """Return whether there is a word in it."""
        return bool(_WORD.search(self.text))


@dataclass(frozen=True, slots=True)
class CleanText:
    """A cleaned text with its segments, and how many repeated runs were deleted."""

    text: str
    segments: tuple[VeilSegment, ...]
    repeats_removed: int


def clean(raw: str) -> CleanText:
    """Collapse white space, delete repeated runs, take out the separators and remember where they stood."""
    words = [(word, number) for number, part in enumerate(raw.split("|")) for word in part.split()]
    count = raw.count("|") + 1
    removed = 0
    while (found := _repeat([word for word, _ in words])) is not None:
        start, length = found
        del words[start + length : start + 2 * length]
        removed += 1
    text = ""
    segments = []
    for number in range(count):
        piece = " ".join(word for word, n in words if n == number)
        if piece and text:
            text += " "
        segments.append(VeilSegment(piece, len(text), len(text) + len(piece)))
        text += piece
    return CleanText(text, tuple(segments), removed)


def _repeat(words: list[str]) -> tuple[int, int] | None:
    """Return start and length of the first and longest run that stands twice in a row, if any.

    The second copy must not begin a new sentence: people repeat sentences, the segmenter repeats inside one.
    """
    keys = [_NOT_WORD.sub("", word.lower()) or word for word in words]
    for start in range(len(keys)):
        for length in range((len(keys) - start) // 2, SHORTEST_REPEAT - 1, -1):
            middle = start + length
            if keys[start:middle] == keys[middle : middle + length] and not words[middle - 1].endswith("."):
                return start, length
    return None


DATA = "data.xml"
CLASSES = "Objects.xml"
ENVIRONMENTS = "Environments"

_LABEL = re.compile(r"(kitchen|living_room)_scenario_environment_number_?(\d+)\Z")
_OBJECTIVE_FILLER = re.compile(r"^(making|make|prepare room for)\s+|\bthe\s+", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class VeilGroup:
    """Actions between two marks, and the text segments (by index) they belong to."""

    segments: tuple[int, ...]
    instructions: tuple[Instruction, ...]


@dataclass(frozen=True, slots=True)
class Point:
    """One demonstration: a text and what a person did for it in an environment.

    Attributes:
        index: Its place in ``data.xml``, from 0.
        world: ``kitchen`` or ``living_room``.
        task: The objective as a slug: ``ramen``, ``clean_room`` …
        segments: Its segments, in order; empty ones are kept, since groups are aligned by number.
        groups: The actions, aligned.
        repeats_removed: How many repeated runs of words were deleted from the text.
    """

    index: int
    world: str
    environment: int
    objective: str
    task: str
    raw: str
    text: str
    segments: tuple[VeilSegment, ...]
    groups: tuple[VeilGroup, ...]
    repeats_removed: int = 0
    line: int = 0

    @property
    def instructions(self) -> tuple[Instruction, ...]:
        """All actions in order."""
        return tuple(instruction for group in self.groups for instruction in group.instructions)

    @property
    def key(self) -> tuple[str, int]:
        """The key of its environment in :attr:`VeilData.environments`."""
        return self.world, self.environment


@dataclass(frozen=True, slots=True)
class VeilData:
    """The data set: demonstrations, environments by (world, file number), and object classes."""

    directory: Path
    points: tuple[Point, ...]
    environments: dict[tuple[str, int], VeilEnvironment]
    classes: dict[str, VeilObjectClass]

    def environment_of(self, point: Point) -> VeilEnvironment:
        """Return the environment that a demonstration was made in."""
        return self.environments[point.key]


def load(directory: str | Path) -> VeilData:
    """Read the data set; every environment file is read.

    Raises:
        DataError: A file is missing, truncated or of another kind, or a point's environment has no file.
    """
    root = Path(directory)
    if not root.is_dir():
        raise DataError(
            f"{root} is not a directory",
            hint="give the directory of VEIL-500: it holds data.xml, Objects.xml and Environments/",
        )
    data = root / DATA
    tree = read_xml(data, "root")
    classes = read_classes(root / CLASSES)
    environments = _environments(root, classes)
    points = tuple(_point(index, element) for index, element in enumerate(tree.all("point")))
    if not points:
        raise DataError("no <point> in the file", location=tree.location, hint="copy data.xml again")
    for point, element in zip(points, tree.all("point"), strict=True):
        if point.key not in environments:
            path = environment_path(root, *point.key)
            raise DataError(
                f"point {point.index} was made in {point.world} {point.environment}, and {path} is missing",
                location=element.location,
                hint="copy that file from the release, or take the point out of data.xml",
            )
    return VeilData(root, points, environments, classes)


def environment_path(root: Path, world: str, number: int) -> Path:
    """Return the file of an environment."""
    folder = FOLDERS[world]
    return root / ENVIRONMENTS / folder / f"{folder}{number}.xml"


def _environments(root: Path, classes: dict[str, VeilObjectClass]) -> dict[tuple[str, int], VeilEnvironment]:
    found = {}
    for world, folder in FOLDERS.items():
        numbered = []
        for path in (root / ENVIRONMENTS / folder).glob(f"{folder}*.xml"):
            digits = path.stem.removeprefix(folder)
            if digits.isdecimal():
                numbered.append((int(digits), path))
        for number, path in sorted(numbered):
            found[world, number] = read_environment(path, world, number, classes)
    if not found:
        raise DataError(
            f"no environment below {root / ENVIRONMENTS}",
            hint="it should hold kitchen/kitchen1.xml, livingRoom/livingRoom1.xml …",
        )
    return found


def _point(index: int, element: Element) -> Point:
    world, number = _environment(element.need("environment"))
    objective = element.need("objective").text.strip()
    raw = element.need("text").text
    text = clean(raw)
    groups = _groups(element.need("action_sequence"), len(text.segments))
    return Point(
        index,
        world,
        number,
        objective,
        task_slug(objective),
        raw,
        text.text,
        text.segments,
        groups,
        text.repeats_removed,
        element.location.line,
    )


def _environment(element: Element) -> tuple[str, int]:
    """Return world and file number. The exporter counted living rooms backwards: label N is file 10 - N."""
    label = element.text.strip()
    match = _LABEL.match(label)
    if match:
        world, number = match[1], int(match[2])
        if world == KITCHEN and 1 <= number <= 10:
            return KITCHEN, number
        if world == LIVING_ROOM and 0 <= number <= 9:
            return LIVING_ROOM, 10 - number
    raise DataError(
        f"'{label}' names no environment",
        location=element.location,
        hint="labels are kitchen_scenario_environment_numberN (1..10) and living_room_… (0..9)",
    )


def task_slug(objective: str) -> str:
    """Return a short name: ``Making Ramen`` is ``ramen``, ``Prepare Room for Game Night`` is ``game_night``."""
    words = _OBJECTIVE_FILLER.sub("", objective.strip())
    return re.sub(r"[^a-z0-9]+", "_", words.lower()).strip("_")


def _groups(sequence: Element, segments: int) -> tuple[VeilGroup, ...]:
    """Return the actions, split at the marks. The last group belongs to all segments that are left."""
    runs: list[list[Instruction]] = [[]]
    for child in sequence.children:
        if child.tag == "change_of_alignment":
            runs.append([])
        elif child.tag == "action":
            runs[-1].append(from_veil(child.text, child.location))
        else:
            raise DataError(
                f"<{child.tag}> in an action sequence", location=child.location, hint="<action> was expected"
            )
    last = len(runs) - 1
    return tuple(
        VeilGroup(tuple(range(min(i, segments), segments if i == last else min(i + 1, segments))), tuple(run))
        for i, run in enumerate(runs)
    )
