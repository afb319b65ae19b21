"""Film files, written picture by picture.

A film is written to a draft beside its file, and takes the file's name when it is closed, also after an error. If the
whole process is killed, the draft is of no use; the next film of that name removes it.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Generator
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from tmd.diagnostics import MissingToolError, OutputError, TmdError, install_extra
from tmd.files import check_writable, draft_of, remove_leftovers
from tmd.robot.video.captions import Pixels, pillow, write_picture

if TYPE_CHECKING:
    from PIL.Image import Image

SUFFIXES = (".mp4", ".gif")
_COLOURS = 128


class MovieFile:
    """A film that is being written, with pictures of a size in pixels (even numbers), ``fps`` of them a second.

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
