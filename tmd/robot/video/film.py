"""A film of a run, and a sheet with one picture for each instruction."""

from __future__ import annotations

import importlib.util
import math
from collections import Counter
from collections.abc import Generator, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from tmd.diagnostics import MissingToolError, OutputError, TmdError, install_extra
from tmd.files import check_writable, draft_of, remove_leftovers
from tmd.pddl.model import GroundAtom
from tmd.robot.assets.features import robot_colour
from tmd.robot.monitor.listeners import Title
from tmd.robot.session import TICK
from tmd.robot.sim.simulator import STEPS_PER_SECOND, Simulator
from tmd.robot.skills.results import ExecutedStep, Execution, SkillStatus
from tmd.robot.skills.robot_context import Cell
from tmd.robot.skills.skill_file import Skills
from tmd.robot.video.camera import FOV, Camera, View
from tmd.robot.video.captions import Caption, Mark, Pixels, caption_height, filmstrip, pillow, under, write_picture

if TYPE_CHECKING:
    from PIL.Image import Image


PICTURE = (640, 480)
GIF_PICTURE = (480, 360)
FPS = {".mp4": 15, ".gif": 10}
# Seconds for which the checked facts of an instruction are shown.
_SHOWN = 0.8
_FAILURE_SHOWN = 2.0
_OPENING, _ENDING = 1.5, 2.5
# Width and height of the pictures of a strip, without their captions.
TILE = (400, 300)
# Radians beside the middle of a close picture within which the robot's own head, nearer than that, is left out.
_HEAD = 0.35
# Skills that are seen from afar.
_FAR = ("look", "drive")
# Frames of a film for which a picture stays while no hand is at the thing.
_PAUSE = 3


def open_movie(
    path: Path, picture: tuple[int, int] | None = None, fps: int | None = None, *, small: bool = False
) -> MovieFile:
    """Open a file for a film with captions, of a kind that the suffix gives.

    ``picture`` is the size of the pictures without their captions, even numbers; the kind's usual size and ``fps`` are
    taken without them. The pauses of a GIF are hundredths of seconds.

    Raises:
        MissingToolError: A package that writes films of this kind is not installed.
        OutputError: It cannot be written there.
        TmdError: The suffix is not that of a known kind of film.
    """
    width, height = picture or (GIF_PICTURE if path.suffix == ".gif" else PICTURE)
    return MovieFile(path, (width, height + caption_height(width)), fps or FPS.get(path.suffix, 1), small=small)


class Film:
    """Takes the pictures of a run as simulated time goes by, and listens to its events.

    ``movie`` is the film, from :func:`open_movie`; with None there is only the filmstrip, which is made with ``strip``.
    """

    def __init__(
        self,
        cell: Cell,
        skills: Skills,
        *,
        movie: MovieFile | None = None,
        strip: bool = False,
    ) -> None:
        pillow()
        self._cell = cell
        self._skills = skills
        self._movie = movie
        self._strip = strip
        self._tiles: list[Pixels] = []
        self._camera = Camera(cell)
        self._caption = Caption("")
        self._last: Pixels | None = None
        self._tries: Counter[int] = Counter()
        self._done: set[int] = set()
        self._ran: list[ExecutedStep] = []
        self._of = 0
        self._event: Pixels | None = None
        self._expected: Sequence[GroundAtom] = ()
        self._looked_for = ""
        if strip:
            cell.moment = self._take_event
        if movie is not None:
            width, height = movie.size
            self._size = width, height - caption_height(width)
            self._fps = movie.fps
            self._time, self._shot = 0.0, 0.0
            self._steps, self._ticks = cell.sim.steps, cell.sim.ticks
            cell.sim.add_watcher(self._watch)

    def open(self, title: str, said: str) -> None:
        """Begin with the room and the request."""
        self._caption = Caption(title, note=said)
        self._hold(_OPENING)

    def begin(self, title: Title, expected: Sequence[GroundAtom]) -> None:
        """Turn the camera to an instruction."""
        self._of = title.of
        self._event, self._expected = None, expected
        if not title.repair:
            self._tries[title.number] += 1
        task = self._skills.task(title.instruction)
        names = self._cell.scene.names()
        filled = [atom.args[0] for atom in expected if atom.predicate == self._skills.contents]
        shown = [name for name in (task.object, task.target, *filled) if name in names]
        self._camera.follow(shown, wide=task.skill in _FAR)
        self._caption = Caption(
            str(title.instruction),
            self._number(title),
            _said(title),
            tuple((str(atom), "expected") for atom in expected),
        )

    def end(self, title: Title, step: ExecutedStep) -> None:
        """Mark the facts, and hold the picture for a moment."""
        badge = "failed" if step.failure else "mismatch" if step.mismatches else "ok"
        measured = "; ".join(m.measured for m in step.mismatches)
        note = step.failure or measured or step.evidence
        self._ran.append(step)
        if badge == "ok" and not title.repair:
            self._done.add(title.number)
        number = self._number(title)
        self._caption = Caption(str(title.instruction), number, _said(title), _marked(step), note, badge)
        self._hold(_SHOWN if badge == "ok" else _FAILURE_SHOWN)
        if self._strip:
            self._add_tile(title, step, well=badge == "ok")

    def _add_tile(self, title: Title, step: ExecutedStep, *, well: bool) -> None:
        """Add a picture to the strip: the button while it is down, not the arm when it is tucked.

        What goes out is shown afterwards.
        """
        out = any(not each.holds and each.atom.predicate in self._skills.signs for each in step.effects)
        seen = self._event if well and not out else None
        picture = self._picture(self._camera.best(), TILE) if seen is None else seen
        task = self._skills.task(title.instruction)
        if task.skill == "drive" and task.object == self._looked_for:
            self._tiles.pop()  # the way to what was looked for shows it as well
        self._looked_for = task.object if task.skill == "look" and well else ""
        self._tiles.append(under(picture, self._caption))

    def close(self, execution: Execution) -> None:
        """Finish with the result."""
        repairs = f"; repairs of the plan: {execution.repairs}" if execution.repairs else ""
        badge = "stopped" if execution.status is SkillStatus.STOPPED else ""
        lasting = "; ".join(f"left otherwise than planned: {each}" for each in execution.lasting)
        effects = Counter(effect.basis.value for each in self._ran for effect in each.effects)
        known = ", ".join(f"{count} {basis}" for basis, count in sorted(effects.items(), key=lambda pair: -pair[1]))
        note = execution.reason or lasting or f"Every effect is as predicted: {known}."
        title = {"done": "Done", "recovered": "Recovered", "stopped": "Stopped"}[execution.status]
        self._caption = Caption(
            title,
            said=f"{len(self._done)} of {self._of} instructions went as predicted{repairs}",
            note=note,
            badge=badge,
        )
        self._hold(_ENDING)

    def _take_event(self) -> None:
        """Take the picture with what the instruction brings about: it is used only if that is so in the end."""
        scene = self._cell.scene
        signs = [atom for atom in self._expected if atom.predicate in self._skills.signs]
        gains = [atom.args for atom in self._expected if atom.predicate == self._skills.contents]
        before = {name: scene.shown(name) for name, _ in gains}
        for atom in signs:
            scene.sign(atom.args[0], atom.predicate, True)
        for name, shown in before.items():
            scene.show(name, (*shown, *(what for where, what in gains if where == name)))
        self._event = self._picture(self._camera.best(), TILE)
        for atom in signs:
            scene.sign(atom.args[0], atom.predicate, False)
        for name, shown in before.items():
            scene.show(name, shown)

    def _number(self, title: Title) -> str:
        """Return its place in the plan, and the number of the try after the first."""
        if title.repair:
            return "repair"
        tries = self._tries[title.number]
        return f"{title.number}/{title.of}{f', try {tries}' if tries > 1 else ''}"

    def write_strip(self, path: Path) -> None:
        """Write the filmstrip of the steps so far, if there are any.

        Raises:
            OutputError: It cannot be written.
        """
        if not self._tiles:
            return
        from PIL import Image

        # a third of the bytes; by octree, because a median cut loses small things of a rare colour: the water in a pot
        few = filmstrip(self._tiles).quantize(256, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
        write_picture(path, few, "PNG", optimize=True)

    def _watch(self, sim: Simulator) -> None:
        stepped = sim.steps - self._steps
        ticked = sim.ticks - self._ticks - stepped
        self._steps, self._ticks = sim.steps, sim.ticks
        self._time += stepped / STEPS_PER_SECOND + ticked * TICK
        if self._time >= self._shot - 1e-9:
            self._shot += 1 / self._fps
            if self._last is None or self._camera.at_work() or round(self._shot * self._fps) % _PAUSE == 0:
                self._last = self._picture(self._camera.view, self._size)
            assert self._movie is not None
            self._movie.add(under(self._last, self._caption))

    def _hold(self, seconds: float) -> None:
        if self._movie is None:
            return
        if self._last is None:
            self._last = self._picture(self._camera.view, self._size)
        self._movie.add(under(self._last, self._caption), round(seconds * self._fps))

    def _picture(self, view: View, size: tuple[int, int]) -> Pixels:
        sim = self._cell.sim
        with self._without_head(view):
            return sim.picture(view.eye, view.target, *size, fov=FOV, shadow=sim.renderer != "tiny")

    @contextmanager
    def _without_head(self, view: View) -> Iterator[None]:
        """Hide the robot's head if it is between the camera and its target."""
        robot, sim = self._cell.robot, self._cell.sim
        hidden: list[str] = []
        if not self._camera.wide and _before(view, robot.eye().position):
            hidden = [name for name in robot.tree.below("head_pan_link") if name in robot.index]
        for name in hidden:
            sim.colour(robot.body, robot.index[name], (0.0, 0.0, 0.0, 0.0))
        try:
            yield
        finally:
            for name in hidden:
                sim.colour(robot.body, robot.index[name], robot_colour(name))


def _before(view: View, point: Sequence[float]) -> bool:
    """Return whether a point is near the line of sight, and nearer than the target."""
    eye = np.array(view.eye)
    ahead, there = np.array(view.target) - eye, np.array(point) - eye
    far, near = float(np.linalg.norm(ahead)), float(np.linalg.norm(there))
    if near < 1e-6 or near > far:
        return False
    return math.acos(max(-1.0, min(1.0, float(ahead @ there) / (far * near)))) < _HEAD + math.atan(0.2 / near)


def _marked(step: ExecutedStep) -> tuple[tuple[str, Mark], ...]:
    """Return the facts of a caption; what is missing goes first, because there is room for a few only."""
    missing: list[tuple[str, Mark]] = [(f"{'' if m.expected else 'not '}{m.atom}", "missing") for m in step.mismatches]
    effects = sorted(step.effects, key=lambda effect: not effect.holds)
    return (*missing, *((str(effect), effect.basis.value) for effect in effects))


def _said(title: Title) -> str:
    if title.repair:
        return f"put in before instruction {title.number} of the plan"
    order = title.order
    if order is None or order.clause is None:
        return ""
    return f"clause {order.clause + 1}{', latent, for' if order.latent else ':'} “{order.text}”"


SUFFIXES = (".mp4", ".gif")
_COLOURS = 128


class MovieFile:
    """A film that is being written, with pictures of a size in pixels (even numbers), ``fps`` of them a second.

    It is a draft beside its file, and takes the file's name when it is closed, also after an error. If the whole
    process is killed, the draft is of no use; the next film of that name removes it.

    ``small`` spares bytes rather than detail: an MP4 is a third as large.

    Attributes:
        pictures: The number of pictures so far.
        last: The last of them; ``None`` without one.

    Raises:
        MissingToolError: A package that writes films of this kind is not installed.
        OutputError: It cannot be written there.
        TmdError: The suffix is not that of a known kind of film.
    """

    def __init__(self, path: Path, size: tuple[int, int], fps: int, *, small: bool = False) -> None:
        self.path = path
        self.size = size
        self.fps = fps
        self.pictures = 0
        self.last: Pixels | None = None
        if path.suffix not in SUFFIXES:
            raise TmdError(f"{path}: films are .mp4 or .gif files", hint=f"call it {path.stem}.mp4")
        check_writable(path)  # now, not after the first minute
        pillow()
        remove_leftovers(path)
        self._draft = draft_of(path)
        self._writer: _Mp4 | _Gif | None = (
            _Gif(self._draft, fps) if path.suffix == ".gif" else _Mp4(self._draft, size, fps, small=small)
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        try:
            self.close()
        except OutputError:
            if error is None:
                raise

    def add(self, picture: Pixels, times: int = 1) -> None:
        """Show a picture for so many frames.

        Raises:
            OutputError: It cannot be written.
        """
        assert self._writer is not None
        try:
            self._writer.add(picture, times)
        except OSError as error:
            raise self._error(error) from error
        self.pictures += times
        self.last = picture

    def write_poster(self, path: Path) -> None:
        """Save the last picture, for pages to show before the film plays.

        Raises:
            OutputError: It cannot be written.
        """
        if self.last is None:
            return
        from PIL import Image

        write_picture(path, Image.fromarray(self.last), "JPEG", quality=80)

    def close(self) -> None:
        """Finish the film and give it its name; a film without pictures leaves nothing.

        Raises:
            OutputError: It cannot be written.
        """
        if self._writer is None:
            return
        writer, self._writer = self._writer, None
        try:
            writer.close()
            if self.pictures:
                self._draft.replace(self.path)
        except OSError as error:
            raise self._error(error) from error
        finally:
            self._draft.unlink(missing_ok=True)

    def _error(self, error: OSError) -> OutputError:
        said = error.strerror or (str(error).strip().splitlines() or ["no reason"])[0]
        reason = "ffmpeg ended before the film did" if "FFMPEG" in str(error) else said
        return OutputError(
            f"{self.path} cannot be written: {reason}",
            hint="check that the directory exists, that you may write there and that the disk has room",
        )


class _Mp4:
    """H.264 by the ffmpeg that imageio-ffmpeg brings."""

    def __init__(self, path: Path, size: tuple[int, int], fps: int, *, small: bool) -> None:
        if importlib.util.find_spec("imageio_ffmpeg") is None:
            raise MissingToolError(
                "MP4 films need the package imageio-ffmpeg, which is not installed",
                hint=f"{install_extra('robot')}, or ask for a GIF: --video out.gif",
            )
        import imageio_ffmpeg

        try:
            imageio_ffmpeg.get_ffmpeg_exe()
        except RuntimeError as error:
            raise MissingToolError(
                "there is no ffmpeg: the package imageio-ffmpeg came without one for this machine",
                hint="install ffmpeg, or ask for a GIF: --video out.gif",
            ) from error
        self._frames: Generator[Any, bytes | None, None] = imageio_ffmpeg.write_frames(
            f"file:{path}",  # else "-y x.mp4" would be an option, and "concat:x.mp4" a protocol
            size,
            fps=fps,
            codec="libx264",
            quality=None,
            macro_block_size=2,
            ffmpeg_log_level="quiet",
            output_params=[
                *("-crf", "30" if small else "23", "-preset", "veryfast", "-threads", "1"),
                *("-g", str((8 if small else 2) * fps)),
                *("-movflags", "+faststart", "-f", "mp4"),
            ],
        )
        self._frames.send(None)

    def add(self, picture: Pixels, times: int) -> None:
        data = picture.tobytes()
        for _ in range(times):
            self._frames.send(data)

    def close(self) -> None:
        self._frames.close()


class _Gif:
    """Kept until it is closed: Pillow then stores of each picture the box that has changed."""

    def __init__(self, path: Path, fps: int) -> None:
        self._path = path
        self._pause = 10 * round(100 / fps)
        self._images: list[Image] = []
        self._pauses: list[int] = []

    def add(self, picture: Pixels, times: int) -> None:
        from PIL import Image

        self._images.append(Image.fromarray(picture).quantize(_COLOURS, dither=Image.Dither.NONE))
        self._pauses.append(self._pause * times)

    def close(self) -> None:
        if self._images:
            first, *rest = self._images
            first.save(self._path, "GIF", save_all=True, append_images=rest, duration=self._pauses, loop=0)
