"""A film as GIF, by Pillow, written picture by picture: each holds only what differs from the one before."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Image = NDArray[np.uint8]

_COLORS = 255
_CLEAR_PIXEL = 255  # the index of "as before"


class GifWriter:
    """A GIF that plays on and on. Its colors are those of the first picture; it can be played once it is closed."""

    def __init__(self, path: Path, fps: float) -> None:
        self._fps, self._count = fps, 0
        self._before: Any = None
        self._colors: Any = None
        self._file = path.open("wb")

    def add(self, picture: Image) -> None:
        """Write the next picture (height, width, 3), sRGB."""
        import numpy as np
        from PIL import GifImagePlugin, Image

        image = Image.fromarray(picture)
        if self._colors is None:
            self._colors = image.quantize(_COLORS, kmeans=1)
            self._file.writelines(GifImagePlugin.getheader(self._colors, info={"loop": 0, "optimize": False})[0])
        now = np.asarray(image.quantize(palette=self._colors, dither=Image.Dither.NONE))
        left, top, right, bottom = _changed(self._before, now)
        part = now[top:bottom, left:right]
        if self._before is not None:
            part = np.where(part == self._before[top:bottom, left:right], np.uint8(_CLEAR_PIXEL), part)
        self._count += 1
        lasts = round(100 * self._count / self._fps) - round(100 * (self._count - 1) / self._fps)  # 1/100 s
        data = GifImagePlugin.getdata(
            Image.fromarray(part), (left, top), duration=10 * lasts, transparency=_CLEAR_PIXEL, disposal=1
        )
        self._file.writelines(data)
        self._before = now

    def close(self) -> None:
        """End the file."""
        with self._file:
            self._file.write(b";")


def _changed(before: Any, now: Any) -> tuple[int, int, int, int]:
    """The rectangle (left, top, right, bottom) of pixels that differ, at least one pixel."""
    import numpy as np

    if before is None:
        return 0, 0, now.shape[1], now.shape[0]
    rows, columns = np.nonzero((before != now).any(axis=1))[0], np.nonzero((before != now).any(axis=0))[0]
    if not len(rows):
        return 0, 0, 1, 1
    return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1
