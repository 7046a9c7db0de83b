"""A film as GIF, by Pillow: its colors are those of all pictures, each of which holds only what differs from the one
before."""

from __future__ import annotations

import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Image = NDArray[np.uint8]

_COLORS = 255
_SAMPLED, _MOST = 4_000, 1_000_000
"""Pixels of a picture, and of a film, that decide which colors there are."""
_CLEAR_PIXEL = 255  # the index of "as before"


class GifWriter:
    """A GIF that plays on and on. Pictures are kept packed until it is closed, for only then are its colors known."""

    def __init__(self, path: Path, fps: float) -> None:
        import tempfile

        self._fps, self._lengths = fps, list[int]()
        self._shape: tuple[int, ...] = ()
        self._sample: list[Any] = []
        self._before: Any = None
        self._file = path.open("wb")
        self._kept = tempfile.TemporaryFile(dir=path.parent)  # noqa: SIM115  closed with the film

    def add(self, picture: Image) -> None:
        """Take the next picture (height, width, 3), sRGB."""
        import numpy as np

        left, top, right, bottom = _changed(self._before, picture)
        part = picture[top:bottom, left:right]
        self._sample.append(_some(part.reshape(-1, 3), _SAMPLED))
        packed = zlib.compress(np.ascontiguousarray(picture).tobytes(), 1)
        self._lengths.append(self._kept.write(packed))
        self._shape, self._before = picture.shape, picture.copy()

    def close(self) -> None:
        """Write the file, and end it."""
        import numpy as np
        from PIL import GifImagePlugin, Image

        with self._file, self._kept:
            if not self._lengths:
                return
            seen = _some(np.concatenate(self._sample), _MOST)
            colors = Image.fromarray(seen[None]).quantize(_COLORS, kmeans=1)
            self._file.writelines(
                GifImagePlugin.getheader(
                    colors.resize((self._shape[1], self._shape[0])), info={"loop": 0, "optimize": False}
                )[0]
            )
            self._kept.seek(0)
            before = None
            for number, length in enumerate(self._lengths, 1):
                picture = np.frombuffer(zlib.decompress(self._kept.read(length)), np.uint8).reshape(self._shape)
                now = np.asarray(Image.fromarray(picture).quantize(palette=colors, dither=Image.Dither.NONE))
                self._file.writelines(self._frame(before, now, number))
                before = now
            self._file.write(b";")

    def _frame(self, before: Any, now: Any, number: int) -> list[bytes]:
        import numpy as np
        from PIL import GifImagePlugin, Image

        left, top, right, bottom = _changed(before, now)
        part = now[top:bottom, left:right]
        if before is not None:
            part = np.where(part == before[top:bottom, left:right], np.uint8(_CLEAR_PIXEL), part)
        lasts = round(100 * number / self._fps) - round(100 * (number - 1) / self._fps)  # 1/100 s
        image = Image.fromarray(part)
        return GifImagePlugin.getdata(image, (left, top), duration=10 * lasts, transparency=_CLEAR_PIXEL, disposal=1)


def _some(pixels: Image, most: int) -> Image:
    """About `most` of pixels (n, 3), evenly; all where they are fewer."""
    return pixels[:: max(1, len(pixels) // most)]


def _changed(before: Any, now: Any) -> tuple[int, int, int, int]:
    """The rectangle (left, top, right, bottom) of pixels that differ, at least one pixel."""
    import numpy as np

    if before is None:
        return 0, 0, now.shape[1], now.shape[0]
    differs = (before != now).reshape(*now.shape[:2], -1).any(axis=2)
    rows, columns = np.nonzero(differs.any(axis=1))[0], np.nonzero(differs.any(axis=0))[0]
    if not len(rows):
        return 0, 0, 1, 1
    return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1
