"""Where pictures of a film go: an MP4, by OpenCV, or a GIF. Playable however early it ends."""

from __future__ import annotations

import errno
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from pico.diagnostics import PicoError, error
from pico.disk import refusing

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Image = NDArray[np.uint8]

KINDS = (".mp4", ".gif")


class MovieWriter(Protocol):
    """A film that is being written: pictures (height, width, 3), sRGB, all of one size."""

    def add(self, picture: Image) -> None: ...

    def close(self) -> None: ...


def require_kind(path: Path) -> None:
    """Raise PicoError where a film can't be written to `path`."""
    if path.suffix.lower() not in KINDS:
        text = f"{path.name} is no film: its name ends neither in .mp4 nor in .gif"
        raise PicoError(error("film-kind", text, hint=f"`--record {path.stem or 'film'}.mp4`"))
    if not path.parent.is_dir():
        raise PicoError(error("unwritable", f"cannot write the film {path}: there is no folder {path.parent}"))


def open_movie(path: Path, fps: float, size: tuple[int, int]) -> MovieWriter:
    """Return a new film of `fps` pictures a second, `size` (width, height) [pixels].

    It and its `close` raise PicoError or OSError where it can't be written.
    """
    from pico.drawing.film.gif import GifWriter

    return GifWriter(path, fps) if path.suffix.lower() == ".gif" else Mp4Writer(path, fps, size)


class Mp4Writer:
    """An MPEG-4 film, written picture by picture."""

    def __init__(self, path: Path, fps: float, size: tuple[int, int]) -> None:
        import cv2

        self._path, self._count = path, 0
        self._writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"mp4v"), fps, size)
        if not self._writer.isOpened():
            hint = "a film as .gif needs no codec"
            no_codec = PicoError(error("unwritable", f"cannot write the film {path}", hint=hint))
            raise refusing(path.parent) or no_codec

    def add(self, picture: Image) -> None:
        import numpy as np

        self._count += 1
        self._writer.write(np.ascontiguousarray(picture[:, :, ::-1]))

    def close(self) -> None:
        """End the file, and see that it is whole: OpenCV does not say what a disk did not take."""
        import cv2

        self._writer.release()
        if self._count and cv2.VideoCapture(str(self._path)).get(cv2.CAP_PROP_FRAME_COUNT) != self._count:
            raise refusing(self._path.parent) or OSError(errno.EIO, "")
