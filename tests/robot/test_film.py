"""Films: a short run is filmed once; the file, the captions and the angles are looked at."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from numpy.typing import NDArray

pytest.importorskip("pybullet", reason="needs the extra robot")
pytest.importorskip("PIL", reason="needs the extra robot")
pytest.importorskip("imageio_ffmpeg", reason="needs the extra robot")

from tmd.diagnostics import MissingToolError, OutputError, TmdError
from tmd.files import draft_of
from tmd.pddl.model import GroundAtom, Instruction
from tmd.pddl.plan_file import parse_instruction
from tmd.robot.monitor.listeners import Order, Recorder, Title
from tmd.robot.session import SimulationSession
from tmd.robot.skills.results import ExecutedStep, Execution, SkillStatus
from tmd.robot.video.camera import Camera
from tmd.robot.video.captions import Caption, caption_height, filmstrip, under
from tmd.robot.video.film import Film, MovieFile, open_movie
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.pddl.model import State

SIZE, FPS = (160, 120), 2
PLAN = ("find(cup1)", "moveto(cup1)", "grasp(cup1)")
CORNER = str(Path(__file__).parents[1] / "cli" / "corner.yaml")
Pixels = NDArray[np.uint8]


@dataclass(frozen=True)
class Run:
    """The files and the end of a filmed run."""

    film: Path
    strip: Path
    execution: Execution
    pictures: int
    poses: list[tuple[float, ...]]


def frames(path: Path) -> list[Pixels]:
    """All pictures of a film."""
    import imageio.v3 as iio

    return [np.asarray(frame)[..., :3] for frame in iio.imiter(path)]


def stage(*, pictures: bool = True) -> SimulationSession:
    _, world = Roots().world(CORNER)
    environment, folder = Roots().room(CORNER)
    return SimulationSession(environment, folder, world.task.problem, kinematic=True, pictures=pictures)


def orders() -> list[Order]:
    return [Order(parse_instruction(text), 0, index == 0, "Take the cup") for index, text in enumerate(PLAN)]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("film")
    path, strip = folder / "run.mp4", folder / "run.png"
    with stage() as ready, open_movie(path, SIZE, FPS) as movie:
        film = Film(ready.cell, ready.skills, movie=movie, strip=True)
        film.open("3 instructions", "Take the cup")
        execution = ready.execute(orders(), [film])
        film.close(execution)
        film.write_strip(strip)
        poses = [ready.sim.pose(body).position for body in ready.cell.scene.bodies.values()]
    return Run(path, strip, execution, movie.pictures, poses)


def test_the_film_has_every_picture(run: Run) -> None:
    seen = frames(run.film)
    assert run.execution.status is SkillStatus.DONE
    assert len(seen) == run.pictures > 20
    assert seen[0].shape == (SIZE[1] + caption_height(SIZE[0]), SIZE[0], 3)
    assert [path.name for path in sorted(run.film.parent.iterdir())] == ["run.mp4", "run.png"]


def test_the_pictures_show_something_that_moves(run: Run) -> None:
    pictures = [frame[: SIZE[1]].astype(float) for frame in frames(run.film)]
    assert all(picture.std() > 20 for picture in pictures)
    assert np.abs(pictures[-1] - pictures[0]).mean() > 10


def test_the_camera_does_not_jump(run: Run) -> None:
    """From one picture to the next less changes than from the first to the last."""
    pictures = [frame[: SIZE[1]].astype(float) for frame in frames(run.film)]
    steps = [np.abs(b - a).mean() for a, b in pairwise(pictures)]
    assert np.median(steps) < np.abs(pictures[-1] - pictures[0]).mean() / 2


def test_the_strip_has_a_picture_for_each_instruction_but_a_look_before_a_drive(run: Run) -> None:
    from PIL import Image

    sheet = np.asarray(Image.open(run.strip).convert("RGB"))
    tile = np.array([300 + caption_height(400), 400]) + 10
    assert sheet.shape == (tile[0] + 10, 2 * tile[1] + 10, 3)  # 2 pictures of 3 instructions


def test_a_door_is_shown_from_where_its_inside_is_seen(tmp_path: Path) -> None:
    """Its outside, which is as near, may not stand for what is behind it."""
    file = tmp_path / "open.yaml"
    file.write_text(
        "name: open\ndomain: kitchen\nobjects:\n  cupboard1: {class: cupboard, parts: {door: {opened: true}}}\n"
    )
    (environment, folder), (_, world) = Roots().room(str(file)), Roots().world(str(file))
    with SimulationSession(environment, folder, world.task.problem, kinematic=True) as ready:
        camera, cell = Camera(ready.cell), ready.cell
        camera.follow(["cupboard1_door"], wide=False)
        ((whole, region), *_) = cell.scene.regions("cupboard1", "in")
        inside = cell.scene.frame(whole, region.link).apply(
            [(a + b) / 2 for a, b in zip(region.low, region.high, strict=True)]
        )
        hit = cell.sim.ray(camera.view.eye, inside)
        assert hit is None or np.linalg.norm(np.subtract(hit.position, inside)) < 0.12


def test_a_button_is_shown_from_where_it_is_seen(tmp_path: Path) -> None:
    """The appliance that it is on may not stand for it, even where the camera begins behind that."""
    file = tmp_path / "hot.yaml"
    file.write_text("name: hot\ndomain: kitchen\nobjects:\n  microwave1: {class: push_button_microwave}\n")
    (environment, folder), (_, world) = Roots().room(str(file)), Roots().world(str(file))
    with SimulationSession(environment, folder, world.task.problem, kinematic=True) as ready:
        camera, cell = Camera(ready.cell), ready.cell
        name = next(n for n in cell.scene.names() if n.endswith("button"))
        front = cell.front("microwave1")
        assert front is not None
        for turn in (front, front + math.pi / 2, front + math.pi):
            camera.view = replace(camera.view, turn=turn)
            camera.follow([name], wide=False)
            button = cell.scene.handle(name)
            assert button is not None
            hit = cell.sim.ray(camera.view.eye, button.grasp.position)
            assert hit is None or math.dist(hit.position, button.grasp.position) < 0.07


def test_what_is_filled_is_shown_as_well() -> None:
    with stage() as ready:
        film = Film(ready.cell, ready.skills, strip=True)
        for instruction in map(parse_instruction, ("find(cup1)", "wait()")):
            film._camera._names = ()
            film.begin(Title(instruction, 1, 1, False, None), [GroundAtom("contains", ("cup1", "water"))])
            assert film._camera._names == ("cup1",)


def test_a_film_does_not_change_the_run(run: Run) -> None:
    with stage(pictures=False) as ready:
        execution = ready.execute(orders())
        poses = [ready.sim.pose(body).position for body in ready.cell.scene.bodies.values()]
    assert execution == run.execution
    assert poses == run.poses


def test_the_cup_is_seen_from_the_best_angle() -> None:
    """The thing that the camera looks at stands in the middle of the picture: repainted, it changes there."""
    with stage() as ready:
        from tmd.robot.video.camera import FOV, Camera

        camera = Camera(ready.cell)
        camera.follow(["cup1"], wide=False)
        view = camera.best()
        before = ready.sim.picture(view.eye, view.target, *SIZE, fov=FOV, shadow=False).astype(int)
        ready.sim.colour(ready.cell.scene.bodies["cup1"], -1, (0.0, 1.0, 0.0, 1.0))
        after = ready.sim.picture(view.eye, view.target, *SIZE, fov=FOV, shadow=False).astype(int)
    changed = np.argwhere(np.abs(after - before).sum(axis=2) > 60)
    assert len(changed) > 10
    middle = np.array([SIZE[1], SIZE[0]]) / 2
    assert np.all(np.abs(changed.mean(axis=0) - middle) < middle / 3)


# files


def noise(seed: int, count: int = 6) -> Iterator[Pixels]:
    """Pictures of which only a part changes."""
    rng = np.random.default_rng(seed)
    picture = np.full((48, 64, 3), 90, np.uint8)
    for index in range(count):
        picture = picture.copy()
        picture[8 + index : 24 + index, 16:40] = rng.integers(0, 4, 3) * 80
        yield picture


@pytest.mark.parametrize("name", ["out.mp4", "out.gif"])
def test_pictures_come_back(tmp_path: Path, name: str) -> None:
    given = list(noise(1))
    with MovieFile(tmp_path / name, (64, 48), 10) as movie:
        for picture in given:
            movie.add(picture)
    found = frames(tmp_path / name)
    assert len(found) == len(given)
    for one, other in zip(given, found, strict=True):
        assert np.abs(one.astype(int) - other).mean() < 6
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_gif_lets_a_picture_stay(tmp_path: Path) -> None:
    from PIL import Image

    with MovieFile(tmp_path / "out.gif", (64, 48), 10) as movie:
        for picture in noise(2, 2):
            movie.add(picture, 5)
            movie.add(picture, 2)
    with Image.open(tmp_path / "out.gif") as gif:
        assert (gif.n_frames, gif.info["duration"]) == (2, 700)


@pytest.mark.parametrize("name", ["out.mp4", "out.gif"])
def test_an_interrupted_film_is_readable(tmp_path: Path, name: str) -> None:
    with pytest.raises(KeyboardInterrupt), MovieFile(tmp_path / name, (64, 48), 10) as movie:
        for picture in noise(3):
            movie.add(picture)
        raise KeyboardInterrupt
    assert len(frames(tmp_path / name)) == 6


@pytest.mark.parametrize("name", ["out.mp4", "out.gif"])
def test_a_film_without_pictures_leaves_nothing(tmp_path: Path, name: str) -> None:
    with MovieFile(tmp_path / name, (64, 48), 10):
        pass
    assert not list(tmp_path.iterdir())


def test_the_draft_of_a_run_that_was_killed_is_removed(tmp_path: Path) -> None:
    left = draft_of(tmp_path / "out.mp4")
    left = left.with_name(left.name.replace(str(os.getpid()), str(2**22 + 1)))  # beyond the highest process number
    left.write_bytes(b"cut off")
    with MovieFile(tmp_path / "out.mp4", (64, 48), 10) as movie:
        for picture in noise(4):
            movie.add(picture)
    assert [path.name for path in tmp_path.iterdir()] == ["out.mp4"]


def test_what_cannot_be_written_is_refused_at_once(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match=r"none/out\.gif cannot be written: No such directory"):
        MovieFile(tmp_path / "none" / "out.gif", (64, 48), 10)
    (tmp_path / "out.gif").mkdir()
    with pytest.raises(OutputError, match="Is a directory"):
        MovieFile(tmp_path / "out.gif", (64, 48), 10)
    with pytest.raises(TmdError, match=r"films are \.mp4 or \.gif"):
        open_movie(tmp_path / "out.avi")


def test_no_ffmpeg(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(MissingToolError, match="imageio-ffmpeg"):
        open_movie(tmp_path / "out.mp4")
    assert not list(tmp_path.iterdir())


# captions


def words(caption: Caption, width: int = 640) -> Pixels:
    return under(np.zeros((8, width, 3), np.uint8), caption)[8:]


@pytest.mark.parametrize("width", [160, 480, 640, 1280])
def test_nothing_is_written_over_the_edge(width: int) -> None:
    """However long the words are, the last columns and rows stay empty."""
    facts = tuple((f"(a_rather_long_predicate pr2 some_object{n} another_object{n})", "missing") for n in range(9))
    caption = Caption("keep" * 60, "12/34", "said " * 80, facts, "measured " * 90, "mismatch")
    pixels = words(caption, width)
    edge = width // 100
    assert pixels.shape == (caption_height(width), width, 3)
    for border in (pixels[:, :edge], pixels[:, -edge:], pixels[-edge:], pixels[:edge]):
        assert len(np.unique(border.reshape(-1, 3), axis=0)) == 1


def test_marks_differ() -> None:
    marks = [
        words(Caption("a", facts=(("(b)", mark),)))
        for mark in ("expected", "measured", "inferred", "assumed", "missing")
    ]
    assert not np.array_equal(marks[0], marks[1])
    assert not np.array_equal(marks[1], marks[2])


def test_a_sheet_has_at_most_four_columns() -> None:
    tile = np.zeros((20, 30, 3), np.uint8)
    assert filmstrip([tile] * 18).size == (4 * 40 + 10, 5 * 30 + 10)
    assert filmstrip([tile]).size == (50, 40)


# the record


class Told:
    """Writes down what it is told."""

    def __init__(self) -> None:
        self.begun: list[str] = []
        self.ended: list[str] = []

    def begin(self, title: Title, expected: Sequence[GroundAtom]) -> None:
        self.begun.append(_name(title))

    def end(self, title: Title, step: ExecutedStep) -> None:
        self.ended.append(_name(title))


def _name(title: Title) -> str:
    return f"{title.instruction.name} {'repair ' * title.repair}{title.number}"


def test_steps_have_their_place_in_the_plan() -> None:
    """What is put in has the place before which it is put, and at the end that of the last instruction."""
    listener = Told()
    recorder = Recorder([Order(Instruction(name)) for name in "abc"], [listener])
    nothing: State = frozenset()
    for name, place, repair in (("a", 0, False), ("r", 1, True), ("c", 2, False), ("s", 3, True)):
        recorder.begin(Instruction(name), (), place, repair)
        recorder.end(ExecutedStep(Instruction(name), repair, "", "", (), (), 0, 0, nothing))
    assert listener.ended == ["a 1", "r repair 2", "c 3", "s repair 3"]
    assert listener.begun == listener.ended


@pytest.fixture(scope="module")
def ready() -> Iterator[SimulationSession]:
    """A stage on which nothing is done."""
    with stage(pictures=False) as made:
        yield made


def test_a_strip_of_nothing_is_not_written(ready: SimulationSession, tmp_path: Path) -> None:
    Film(ready.cell, ready.skills, strip=True).write_strip(tmp_path / "none.png")
    assert not list(tmp_path.iterdir())


def test_a_caption_counts_tries_and_what_was_done(ready: SimulationSession, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of two instructions the first is done at its second try, and then the run stops."""
    cup = parse_instruction("find(cup1)")
    nothing: State = frozenset()
    told: list[Caption] = []
    film = Film(ready.cell, ready.skills)
    monkeypatch.setattr(film, "_hold", lambda seconds: told.append(film._caption))
    for failure in ("it broke", ""):
        title = Title(cup, 1, 2, False, None)
        film.begin(title, [])
        film.end(title, ExecutedStep(cup, False, failure, "", (), (), 0, 0, nothing))
    film.close(Execution(SkillStatus.STOPPED, "that was all", (), 1, nothing))
    assert [caption.number for caption in told] == ["1/2", "1/2, try 2", ""]
    assert told[-1].said == "1 of 2 instructions went as predicted; repairs of the plan: 1"
