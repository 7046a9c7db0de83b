"""What a kernel is given: a picture with what is known of its camera, or a row of readings."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


PLATEAU, CLIFF, FINE = 100, 8, 1000.0
"""How many pixels that read the same, above so many counts that hardly any reads, are full below full scale; and the
least full scale [count] at which noise tells equal pixels from full ones."""
_STUCK = 0.1
"""The share of full scale by which a full pixel must exceed its neighbors to be a defect, not light."""


_STRIP = 64
"""Rows at a time that stay in the cache of a processor."""
Places = tuple["NDArray[np.intp]", "NDArray[np.intp]"]
"""Rows and columns of pixels."""


def full_pixels(pixels: NDArray[Any], full_scale: float) -> tuple[int, float]:
    """Return how many pixels of a picture are saturated, and what these read [count].

    A full pixel that stands out from all of its neighbors is a defect and does not count. The level is full scale, or
    less if the pixels overflow before the converter does, as those of a camera whose gain fell. Shot noise makes no
    such plateau.
    """
    import numpy as np

    top = float(pixels.max())
    if top >= full_scale:
        _, stuck = _full(pixels, full_scale)
        return int((~stuck).sum()), full_scale
    if pixels.dtype.kind in "ui" and full_scale >= FINE and top > full_scale / 4:
        same = int(np.count_nonzero(pixels == int(top)))
        if same >= PLATEAU and same > 3 * (int(np.count_nonzero(pixels >= int(top) - CLIFF)) - same):
            return same, top
    return 0, top


def saturated(pixels: NDArray[Any], full_scale: float) -> str:
    """Return how many pixels of a picture are saturated, in words; empty if none is."""
    full, level = full_pixels(pixels, full_scale)
    return f"{full} of {pixels.size} pixels read {level:g}" if full else ""


def _full(pixels: NDArray[Any], full_scale: float) -> tuple[Places, NDArray[Any]]:
    """Which pixels are full, and whether each of them stands out from its neighbors, none of which is full."""
    import numpy as np

    from pico.kernels.defects import lone

    least = math.ceil(full_scale) if pixels.dtype.kind in "ui" else full_scale  # a float would turn all into floats
    full = pixels >= least
    rows, columns = np.divmod(np.flatnonzero(full), pixels.shape[1])
    stuck = lone(pixels, (rows, columns), _STUCK * full_scale)
    for at in np.flatnonzero(stuck):
        row, column = rows[at], columns[at]
        stuck[at] = full[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2].sum() == 1
    return (rows, columns), stuck


@dataclass(frozen=True, eq=False)
class Frame:
    """A picture as a camera gave it.

    `pixels`: (h, w), any real dtype, row 0 at the top [count]. `pixel_size` [um], `exposure` [ms], `gain` [dB: 20 dB
    are ten times the counts]. `full_scale`: what a saturated pixel reads [count]. `black_level`: what a pixel reads
    without light [count]; or `dark`, a picture (h, w) of that at the same exposure, in its stead, with its own
    uncertainty a pixel, `dark_noise` [count]. `electrons_per_count` at this gain. `read_noise` [electrons].
    """

    pixels: NDArray[Any]
    pixel_size: float = 3.45
    exposure: float = 1.0
    gain: float = 0.0
    full_scale: float = 4095.0
    black_level: float = 0.0
    dark: NDArray[Any] | None = None
    dark_noise: float = 0.0
    electrons_per_count: float = 1.0
    read_noise: float = 0.0

    def __post_init__(self) -> None:
        if self.pixels.ndim != 2 or min(self.pixels.shape) < 8 or self.pixels.dtype.kind not in "buif":
            raise ValueError(f"a frame has 8 x 8 real pixels or more, not {self.pixels.shape} of {self.pixels.dtype}")
        if self.dark is not None and self.dark.shape != self.pixels.shape:
            raise ValueError(f"the dark frame is {self.dark.shape}, the frame {self.pixels.shape}")
        if min(self.pixel_size, self.exposure, self.electrons_per_count) <= 0 or self.read_noise < 0:
            raise ValueError("pixel size, exposure and electrons a count are above zero, noise is not below it")

    @cached_property
    def signal(self) -> NDArray[np.float32]:
        """The pixels above black [count], (h, w); a defective one reads what its neighbors do. Not to be written to."""
        above = self.part(slice(None), slice(None))
        above.flags.writeable = False
        return above

    @cached_property
    def plain(self) -> NDArray[Any]:
        """The pixels in one of the types that OpenCV knows: 8 or 16 bits without a sign, or float32."""
        import numpy as np

        if self.pixels.dtype in (np.uint8, np.uint16, np.float32):
            return np.ascontiguousarray(self.pixels)
        return self.pixels.astype(np.uint8 if self.pixels.dtype.kind == "b" else np.float32)

    def part(self, rows: slice, columns: slice) -> NDArray[np.float32]:
        """Return a part of the signal [count], without the cost of the whole."""
        above = self.above(rows, columns)
        top, left = rows.indices(self.pixels.shape[0])[0], columns.indices(self.pixels.shape[1])[0]
        (down, right), values = self.repairs
        down, right = down - top, right - left
        here = (down >= 0) & (down < above.shape[0]) & (right >= 0) & (right < above.shape[1])
        above[down[here], right[here]] = values[here]
        return above

    def means(self, by: int) -> NDArray[np.float32]:
        """Return the means of the signal over blocks of `by` x `by` pixels [count]; what is left over at the right and
        below is dropped."""
        import cv2
        import numpy as np

        h, w = (n // by for n in self.pixels.shape)
        if by == 1:
            return self.part(slice(None), slice(None))
        out = np.empty((h, w), np.float32)
        each = max(1, _STRIP // by)
        strip = np.empty((each * by, w * by), np.float32)
        for first in range(0, h, each):  # a strip stays in the cache of the processor
            last = min(first + each, h)
            some, here = strip[: (last - first) * by], (slice(first * by, last * by), slice(0, w * by))
            np.copyto(some, self.plain[here])
            if self.dark is not None:
                some -= self.dark[here]
            cv2.resize(some, (w, last - first), dst=out[first:last], interpolation=cv2.INTER_AREA)
        if self.dark is None:
            out -= np.float32(self.black_level)
        (rows, columns), values = self.repairs
        seen = (rows < h * by) & (columns < w * by)
        rows, columns = rows[seen], columns[seen]
        np.add.at(out, (rows // by, columns // by), (values[seen] - self.above(rows, columns)) / by**2)
        return out

    @cached_property
    def repairs(self) -> tuple[Places, NDArray[np.float32]]:
        """Defective pixels, and the signal that their neighbors have in the middle [count]."""
        import numpy as np

        from pico.kernels.defects import replacements

        values = replacements(self.pixels, self.defects, self.dark) - (self.black_level if self.dark is None else 0)
        return self.defects, values.astype(np.float32)

    def above(self, rows: Any, columns: Any) -> NDArray[np.float32]:
        """Return some pixels above black [count], as they were read."""
        import numpy as np

        above: NDArray[np.float32] = self.pixels[rows, columns].astype(np.float32)
        above -= np.float32(self.black_level) if self.dark is None else self.dark[rows, columns].astype(np.float32)
        return above

    @cached_property
    def defects(self) -> Places:
        """Rows and columns of single pixels that are stuck, hot or dead: they differ from all their neighbors as no
        light of 3 px or more does."""
        import numpy as np

        from pico.kernels.defects import defects, median

        dark = self.black_level if self.dark is None else float(median(self.dark[::8, ::8]))
        rows, columns = defects(self.plain, self.dark_variance, self.electrons_per_count, dark)
        if self.pixels.max() >= self.full_scale:
            full, stuck = _full(self.pixels, self.full_scale)
            both = np.unique(np.stack([np.append(rows, full[0][stuck]), np.append(columns, full[1][stuck])]), axis=1)
            rows, columns = both[0], both[1]
        return rows, columns

    @property
    def dark_variance(self) -> float:
        """The variance of a pixel without light [count^2]: read noise, rounding to whole counts, the dark frame's."""
        rounding = 0.0 if self.pixels.dtype.kind == "f" else 1 / 12
        return (self.read_noise / self.electrons_per_count) ** 2 + rounding + self.dark_noise**2

    @property
    def saturated(self) -> int:
        """How many pixels are full."""
        return full_pixels(self.pixels, self.full_scale)[0]

    @property
    def refusal(self) -> str:
        """Why nothing can be said of the light in this picture; empty if something can be."""
        import numpy as np

        if self.pixels.dtype.kind == "f" and not np.isfinite(self.pixels).all():
            return "some pixels are no numbers"
        return saturated(self.pixels, self.full_scale)

    @property
    def remark(self) -> str:
        """Which pixels were left out, in words; empty if none was."""
        if not len(self.defects[0]):
            return ""
        count, at = len(self.defects[0]), ", ".join(f"({c}, {r})" for r, c in list(zip(*self.defects, strict=True))[:3])
        more = ", ..." if count > 3 else ""
        return f"{count} defective pixel{'s' * (count > 1)} left out, at column and row {at}{more}"

    def at(self, column: float, row: float) -> tuple[float, float]:
        """Return a place in pixels (0, 0 is the middle of the pixel at the top left) as x, y [um] from the middle of
        the sensor, x to the right, y up."""
        h, w = self.pixels.shape
        return (column - (w - 1) / 2) * self.pixel_size, ((h - 1) / 2 - row) * self.pixel_size


@dataclass(frozen=True)
class Readings:
    """Numbers that were read one after the other, in any one unit: `values`, one standard deviation each, and `angles`
    [deg], `names` of the settings or `places` along a beam [mm] that they were read at."""

    values: tuple[float, ...]
    sigma: tuple[float, ...]
    names: tuple[str, ...] = ()
    angles: tuple[float, ...] = ()
    places: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if any(len(row) not in (0, len(self.values)) for row in (self.names, self.angles, self.places, self.sigma)):
            raise ValueError("readings have as many sigmas, names, angles and places as values")
