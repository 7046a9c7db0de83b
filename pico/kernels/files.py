"""Pictures of a beam from disk, as frames: TIFF, PNG, PGM and NPY of 8 to 16 bits, in one channel."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pico.diagnostics import PicoError, error
from pico.kernels.frame import Frame

if TYPE_CHECKING:
    from numpy.typing import NDArray

SUFFIXES = (".tif", ".tiff", ".png", ".pgm", ".npy")
_NUMBER = re.compile(r"(?:(?<![A-Za-z0-9])[-+])?\d+(?:\.\d+)?")
_WELL = 1e4
"""Electrons at full scale, if the noise of a picture does not tell them."""
_LARGEST = 200e6
"""Bytes that are read of a file at most."""


def pictures(patterns: Sequence[str]) -> tuple[Path, ...]:
    """Return the files that names and patterns (`scan/*.png`) mean, each once; raises PicoError for one without
    files."""
    found: list[Path] = []
    for pattern in patterns:
        path = Path(pattern)
        some = [path] if path.exists() or not set(pattern) & set("*?[") else _matching(path)
        if not some:
            raise PicoError(
                error("picture-file", f"no file matches {pattern}", hint="quote a pattern: --image 'z*.png'")
            )
        found += [one for one in some if one not in found]
    return tuple(found)


def _matching(pattern: Path) -> list[Path]:
    start = Path(pattern.anchor) if pattern.is_absolute() else Path()
    return sorted(start.glob(str(pattern.relative_to(pattern.anchor))))


def read_picture(path: Path) -> NDArray[Any]:
    """Return the pixels (h, w) of a file; raises PicoError for what is no picture in one channel."""
    import numpy as np

    if path.suffix.lower() not in SUFFIXES:
        formats = "TIFF, PNG, PGM and NPY keep what a camera counted"
        raise _refused(path, f"{path.name} is of none of the formats that PICO reads", f"convert it: {formats}")
    try:
        if path.stat().st_size > _LARGEST:
            raise _refused(path, f"{path.name} has more than {_LARGEST / 1e6:g} MB", "cut out the beam")
        data = path.read_bytes()
    except OSError as exc:
        raise _refused(path, f"{path} cannot be read: {exc.strerror}", "") from None
    pixels = _array(path) if path.suffix.lower() == ".npy" else _decoded(path, data)
    if pixels.ndim == 3 and all(np.array_equal(pixels[..., 0], pixels[..., n]) for n in range(1, pixels.shape[2])):
        pixels = pixels[..., 0]
    if pixels.ndim != 2:
        hint = "save one channel of it: colors of a sensor differ in gain"
        raise _refused(path, f"{path.name} has {pixels.shape} numbers, not one for each pixel", hint)
    if pixels.dtype.kind not in "buif" or pixels.dtype.itemsize > 8:
        raise _refused(path, f"{path.name} has numbers of type {pixels.dtype}", "save it as 8 or 16 bits")
    return pixels


def _array(path: Path) -> NDArray[Any]:
    import numpy as np

    try:
        found: NDArray[Any] = np.load(path, allow_pickle=False)
    except (ValueError, EOFError, OSError) as exc:
        raise _refused(path, f"{path.name} is no array of NumPy: {exc}", "write it with `numpy.save`") from None
    return found


def _decoded(path: Path, data: bytes) -> NDArray[Any]:
    import cv2
    import numpy as np

    found = None
    if data:
        try:
            found = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
        except cv2.error:
            found = None
    if found is None:
        raise _refused(path, f"{path.name} is damaged, or of a kind that cannot be decoded", "save it anew, or as NPY")
    return found


def _refused(path: Path, text: str, hint: str) -> PicoError:
    return PicoError(error("picture-file", text, hint=hint, address=str(path)))


def frame_from(
    pixels: NDArray[Any], pixel_size: float = 1.0, black_level: float | None = None, full_scale: float | None = None
) -> Frame:
    """Return a picture (h, w) as a frame; its own noise tells electrons a count and the noise of dark pixels.

    `pixel_size` [um]; `black_level` [count], 0 if unknown; `full_scale` [count], else that of the fewest bits that hold
    the brightest pixel. Raises ValueError for too small a picture.
    """
    black, full = black_level or 0.0, full_scale or _full_scale(pixels)
    plain = Frame(pixels, pixel_size=pixel_size, black_level=black, full_scale=full)
    electrons, dark = _noise(pixels, black, full)
    return Frame(
        plain.pixels, pixel_size=pixel_size, black_level=black, full_scale=full, electrons_per_count=electrons,
        read_noise=dark * electrons,
    )  # fmt: skip


def _full_scale(pixels: NDArray[Any]) -> float:
    """What a full pixel reads: of 8, 10, 12, 14 or 16 bits, which may stand at the upper end of 16."""
    import numpy as np

    if pixels.dtype.kind not in "ui":
        return max(float(np.nanmax(pixels)) * 2, 1.0)  # numbers that were worked on: nothing is full
    used = int(np.bitwise_or.reduce(pixels, axis=None))
    low = (used & -used).bit_length() - 1 if used else 0
    if pixels.dtype.itemsize > 1 and low and used >> 15 == 1:
        return float((1 << 16) - (1 << low))
    return float(next((2**n - 1 for n in (8, 10, 12, 14, 16) if used < 2**n), 2**32 - 1))


def _noise(pixels: NDArray[Any], black: float, full: float) -> tuple[float, float]:
    """Electrons a count, and one standard deviation of a dark pixel [count]: variance against light, by the differences
    of four neighbors each, in which slopes, columns and rows cancel."""
    import numpy as np

    h, w = (n // 2 * 2 for n in pixels.shape)
    a, b, c, d = (pixels[i:h:2, j:w:2].astype(np.float32) for i in (0, 1) for j in (0, 1))
    mixed, light = ((a - b) - (c - d)).ravel() / 2, (a + b + c + d).ravel() / 4 - black
    order = np.argsort(light, kind="stable")
    steps = np.array_split(order, 40) + np.array_split(order[-len(order) // 20 :], 10)
    points = []
    for some in steps:
        values = mixed[some]
        for _ in range(3):
            values = values[np.abs(values) <= 4 * max(float(values.std()), 1e-6)]
        points.append((float(light[some].mean()), float(values.var())))
    levels, variances = np.array(points).T
    dark = float(np.median(variances[:20]))
    bright = levels > levels[:20].mean() + 0.05 * full
    slope = float(np.median((variances[bright] - dark) / (levels[bright] - levels[0]))) if bright.any() else 0.0
    electrons = 1 / slope if slope > 1e-9 else max(_WELL / full, 1e-6)
    own = max(dark - max(float(levels[0]), 0.0) / electrons, 0.0)
    return electrons, float(np.sqrt(max(own - (1 / 12 if pixels.dtype.kind != "f" else 0.0), 0.0)))


def places_of(files: Sequence[Path]) -> tuple[float, ...]:
    """Return where along the beam pictures were taken [mm], by the one number that differs in their names; raises
    PicoError if there is none, or several."""
    rows = [_NUMBER.findall(path.stem) for path in files]
    alike = {len(row) for row in rows}
    varying = [i for i in range(len(rows[0])) if len({row[i] for row in rows}) > 1] if len(alike) == 1 else []
    if len(varying) != 1 or len({row[varying[0]] for row in rows}) != len(files):
        text = f"the names of {len(files)} pictures do not tell where each was taken"
        hint = "give the places in mm in the order of the pictures: --at 100 --at 120 ..."
        raise PicoError(error("picture-file", text, hint=hint))
    return tuple(float(row[varying[0]]) for row in rows)
