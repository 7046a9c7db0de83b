"""GIF89a, written picture by picture: each holds only what differs from the one before.

The format is that of the GIF89a specification (CompuServe, 1990), with its variable-length LZW codes.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Image = NDArray[np.uint8]

_COLORS = 255
_CLEAR_PIXEL = 255  # the index of "as before"
_BITS = 6  # of each channel by which a pixel's color is looked up
_MOST_CODES = 4096


class GifReel:
    """A GIF that plays on and on. Its colors are those of the first picture; it can be played once it is closed."""

    def __init__(self, path: Path, fps: float) -> None:
        self._fps, self._count = fps, 0
        self._before: NDArray[np.uint8] | None = None
        self._palette: Any = None
        self._table: Any = None
        self._file = path.open("wb")

    def add(self, picture: Image) -> None:
        """Write the next picture (height, width, 3), sRGB."""
        import numpy as np

        if self._before is None:
            self._begin(picture)
        r, g, b = (picture[:, :, i].astype(np.int32) >> (8 - _BITS) for i in range(3))
        now = np.asarray(self._table[(r << 2 * _BITS) | (g << _BITS) | b], np.uint8)
        left, top, right, bottom = _changed(self._before, now)
        part = now[top:bottom, left:right].copy()
        if self._before is not None:
            part[part == self._before[top:bottom, left:right]] = _CLEAR_PIXEL
        self._block(part, left, top)
        self._before = now

    def close(self) -> None:
        """End the file."""
        with self._file:
            self._file.write(b";")

    def _begin(self, picture: Image) -> None:
        self._palette = _palette(picture)
        self._table = _nearest(self._palette)
        height, width = picture.shape[:2]
        self._file.write(b"GIF89a" + struct.pack("<HHBBB", width, height, 0xF7, 0, 0))
        self._file.write(self._palette.tobytes() + bytes(3 * (256 - _COLORS)))
        self._file.write(b"\x21\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00")  # again and again

    def _block(self, part: Any, left: int, top: int) -> None:
        """Write a picture's rectangle; its time in hundredths of a second, so that rounding does not add up."""
        self._count += 1
        lasts = round(100 * self._count / self._fps) - round(100 * (self._count - 1) / self._fps)
        self._file.write(b"\x21\xf9\x04" + struct.pack("<BHBB", 0x05, lasts, _CLEAR_PIXEL, 0))
        self._file.write(b"\x2c" + struct.pack("<HHHHB", left, top, part.shape[1], part.shape[0], 0))
        self._file.write(b"\x08")
        data = compressed(part.tobytes())
        for start in range(0, len(data), 255):
            chunk = data[start : start + 255]
            self._file.write(bytes((len(chunk),)) + chunk)
        self._file.write(b"\x00")


def compressed(pixels: bytes) -> bytes:
    """Return the LZW codes of `pixels`, of eight bits each."""
    out, buffer, filled = bytearray(), 256, 9  # begins with the clear code
    codes: dict[int, int] = {}
    size, new, prefix = 9, 258, pixels[0]
    for byte in pixels[1:]:
        key = prefix << 8 | byte
        known = codes.get(key)
        if known is not None:
            prefix = known
            continue
        buffer |= prefix << filled
        filled += size
        if new < _MOST_CODES:
            codes[key] = new
            size += new == 1 << size
            new += 1
        else:
            buffer |= 256 << filled
            filled += size
            codes, size, new = {}, 9, 258
        if filled > 256:
            whole = filled // 8
            out += (buffer & (1 << 8 * whole) - 1).to_bytes(whole, "little")
            buffer, filled = buffer >> 8 * whole, filled - 8 * whole
        prefix = byte
    buffer |= prefix << filled
    filled += size
    size += new == 1 << size and size < 12
    buffer |= 257 << filled
    return bytes(out + buffer.to_bytes((filled + size + 7) // 8, "little"))


def _changed(before: Any, now: Any) -> tuple[int, int, int, int]:
    """The rectangle (left, top, right, bottom) of pixels that differ, at least one pixel."""
    import numpy as np

    if before is None:
        return 0, 0, now.shape[1], now.shape[0]
    rows, columns = np.nonzero((before != now).any(axis=1))[0], np.nonzero((before != now).any(axis=0))[0]
    if not len(rows):
        return 0, 0, 1, 1
    return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1


def _palette(picture: Image) -> Any:
    """The colors (255, 3) that lie nearest to the picture's: the rare ones count as well as the frequent ones."""
    import cv2
    import numpy as np

    cells, counts = np.unique(picture.reshape(-1, 3) >> 2, axis=0, return_counts=True)
    weight = np.maximum(1, np.round(counts**0.5)).astype(int)
    colors = np.repeat(cells.astype(np.float32) * 4 + 2, np.minimum(weight, 16), axis=0)
    if len(cells) <= _COLORS:
        found = np.vstack([cells * 4 + 2, np.zeros((_COLORS - len(cells), 3))])
        return np.clip(found, 0, 255).astype(np.uint8)
    criteria = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 8, 1.0)
    cv2.setRNGSeed(1)
    _, _, found = cv2.kmeans(colors, _COLORS, None, criteria, 1, cv2.KMEANS_RANDOM_CENTERS)  # type: ignore[call-overload]
    return np.clip(np.round(found), 0, 255).astype(np.uint8)


def _nearest(palette: Any) -> Any:
    """The index of the nearest color for each cell of color space, (2**18,)."""
    import numpy as np

    side = np.arange(1 << _BITS, dtype=np.float32) * (256 >> _BITS) + (128 >> _BITS)
    found = np.empty((1 << _BITS,) * 3, np.uint8)
    colors = palette.astype(np.float32)
    square = (colors**2).sum(axis=1)
    grid = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
    for i, red in enumerate(side):
        cells = np.column_stack((np.full(len(grid), red, np.float32), grid))
        found[i] = np.argmin(square - 2 * (cells @ colors.T), axis=1).reshape(found.shape[1:])
    return found.reshape(-1)
