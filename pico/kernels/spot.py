"""Where the beam is on a picture, and its first and second moments as ISO 11146 has them. Needs numpy and OpenCV at its
top: kernels import it inside their functions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pico.kernels import cut
from pico.kernels.background import Plane, bend, outside, plane, with_misfit
from pico.kernels.beside import light_beside
from pico.kernels.frame import Frame
from pico.kernels.moments import Array, Box, above_plane, bent, coarser, covariance, finer, within
from pico.kernels.rounding import change, rounding
from pico.kernels.start import FINE, Start, found
from pico.kernels.stripes import Stripes

_REGION = 3.0
"""Widths that the region of integration measures: ISO 11146-1, 7.2."""
_ROUNDS = 20
_AT_LAST = 4
"""Rounds over means of blocks, then over the pixels themselves, at most."""
_INSIDE = 0.6
"""Widths (D4sigma) that the middle of a beam must keep from the edges of the frame. A Gaussian beam nearer to one has
lost more than 0.8 % of its light, and 3 % of its width."""
_ALIKE = 0.01
"""Standard deviations of the beam by which a region may still move when it counts as settled."""
_FEW = 12.0
"""Width [px] below which that is why moments do not settle."""
NARROWEST = 2.5
"""Width (D4sigma) [px] below which pixels are too few to tell a beam's width."""
_WIDENED = 0.1
"""The share by which light beside a beam may change its variances before its widths are unknown."""
_NOISY = 0.05
"""The share of its variances by which noise alone may change those of a beam that has a region of integration."""
_REGION_NOISE = 12**3 / math.sqrt(80) / (2 * math.pi)
"""Of a square of twelve standard deviations: the root of the sum of x^4, by light and variance of a Gaussian."""
_ADRIFT = "the region of integration does not settle: the background is not flat, or the beam is not alone"


@dataclass(frozen=True, eq=False)
class Spot:
    """A beam on a frame. `total` [count]; `moments`: column and row of its middle [px], variances along the columns,
    along the rows, and across [px^2]; `covariance` (6, 6) of total and moments; the `box` integrated over; the
    `background`, and the `stripes` beside it."""

    total: float
    moments: Array
    covariance: Array
    box: Box
    background: Plane
    stripes: Stripes | None

    def behind(self, rows: slice = slice(None), columns: slice = slice(None)) -> NDArray[np.float32]:
        """Return the background at each pixel of the frame (h, w), or of a part of it [count]."""
        flat = self.background.over(rows, columns)
        return flat if self.stripes is None else flat + self.stripes.over(rows, columns)


def spot(frame: Frame, iterated: bool = False) -> Spot | str:
    """Return the beam's moments over a region of three widths, above a plane fitted to what lies outside; negative
    residuals stay. Why there are none, else.

    The region is about the beam's middle. Its widths are those that the beam's bright part tells; `iterated`: those
    that come out of the moments in it, as ISO 11146 has it, which a halo lets grow until nothing is known.
    """
    start = found(frame)
    if isinstance(start, str):
        return start
    held = None if iterated else start.moments[2:]
    region = _region(start, held, frame.dark_variance)
    if isinstance(region, str):
        return region
    total, moments, box, behind = region
    about = _in_blocks(box, start.by)
    by = light_beside(start.coarse, start.by, about, behind, total, moments)
    if iterated and (why := _no_width(start, moments, by)):
        return why
    mask = outside(start.coarse.shape, about)
    curved = bend(behind, start.coarse, mask, start.by)
    behind = with_misfit(behind, start.coarse, mask, start.by)
    own = covariance(
        start.part(*within(box)), frame.electrons_per_count, box, start.shape, behind, start.stripes, total, moments
    )
    lost = cut.change(start.shape, total, moments)
    own += np.outer(by, by) + np.outer(lost, lost)
    if curved is not None:
        off = bent(curved, box, start.shape, total, moments)
        own += np.outer(off, off)
    if low := rounding(frame, behind, start.stripes, moments[:2], 6 * np.sqrt(moments[2:4])):
        own += change(low, total, moments)
    return Spot(total, moments, own, box, behind, start.stripes)


def _region(start: Start, held: Array | None, least: float) -> tuple[float, Array, Box, Plane] | str:
    """Find the region over the pixels themselves: total and moments in it, the region and the plane; why there is
    none."""
    settled = _settled(start, held, least)
    if isinstance(settled, str):
        return settled
    moments, behind = settled
    shape = start.shape
    box, tried = _box(moments, held, shape), list[Box]()
    for _ in range(_ROUNDS if start.width < FINE else _AT_LAST):
        total, moments = above_plane(start.part(*within(box)), box, shape, behind)
        if not _sane(total, moments, shape):
            return _adrift(start)
        tried.append(box)
        box, before = _box(moments, held, shape), box
        if _moved(box, before) <= 1 + _ALIKE * math.sqrt(moments[2:4].max()) or box in tried:
            break
    else:
        return _adrift(start)
    widths = moments[2:] if held is None else held
    if why := leaving(np.concatenate([moments[:2], widths]), shape):
        return why if held is not None or leaving(start.moments, shape) else _widened(start.moments, moments)
    return total, moments, before, behind


def _no_width(start: Start, moments: Array, by: Array) -> str:
    """Why second moments are none of the beam's; `by`: what light beside it changes of them; empty if they are."""
    if min(moments[2:4]) < (NARROWEST / 4) ** 2:
        return too_narrow(moments)
    return _widened(start.moments, moments) if (by[3:5] > _WIDENED * moments[2:4]).any() else ""


def _noise(start: Start) -> float:
    """The share of a beam's variances that noise makes by itself over a region of three widths."""
    column, row = (int(at) for at in start.moments[:2])
    across, down = (max(1, int(math.sqrt(v) / 2)) for v in start.moments[2:4])
    rows = slice(max(row - down, 0), max(row + down + 1, 1))
    columns = slice(max(column - across, 0), max(column + across + 1, 1))
    peak = max(float((start.part(rows, columns) - start.background.over(rows, columns)).mean()), 1e-9)
    deviation = math.sqrt(start.background.variance / math.sqrt(float(start.moments[2] * start.moments[3])))
    return _REGION_NOISE * deviation / peak


def _adrift(start: Start) -> str:
    """Why no region of integration is found about a beam."""
    if start.width >= _FEW and _noise(start) > _NOISY:
        text = "the beam is dim: noise outweighs its second moments over a region of three widths"
        return f"{text}; `gaussian_fit` measures it, or expose for longer"
    if start.width < _FEW:
        text = f"the beam is only {start.width:.2g} px wide: noise outweighs the second moments of so few pixels"
        return f"{text}; `gaussian_fit` measures beams from {NARROWEST:g} px on"
    return _ADRIFT


def _widened(bright: Array, moments: Array) -> str:
    """That light beside a beam widens it."""
    own, all_of_it = (" x ".join(f"{4 * math.sqrt(v):.4g}" for v in one[2:4]) for one in (bright, moments))
    text = f"light beside the beam (a streak, a halo, a second beam) or an uneven background widens it: {all_of_it} px"
    return f"{text} by second moments, {own} px by its bright part; the region of integration does not settle"


def _in_blocks(box: Box, by: int) -> Box:
    """The blocks that a box touches."""
    return box[0] // by, -(-box[1] // by), box[2] // by, -(-box[3] // by)


def too_narrow(moments: Array) -> str:
    """Return that a beam of such moments has too few pixels."""
    width = 4 * math.sqrt(max(float(min(moments[2:4])), 0))
    return f"the beam is only {width:.2g} px wide, too few pixels to tell its width: {NARROWEST:g} px is the least"


def leaving(moments: Array, shape: tuple[int, ...]) -> str:
    """Return that the beam leaves the frame, where it does."""
    for middle, variance, size, ends in (
        (moments[0], moments[2], shape[1], ("left", "right")),
        (moments[1], moments[3], shape[0], ("top", "bottom")),
    ):
        reach = _INSIDE * 4 * math.sqrt(variance)
        for gap, end in ((middle + 0.5, ends[0]), (size - 0.5 - middle, ends[1])):
            if gap < reach:
                text = f"the spot leaves the frame at the {end}: of what is seen of it the middle is {gap:.4g} px"
                return f"{text} from there, and it reaches {reach:.4g} px"
    return ""


def _settled(start: Start, held: Array | None, least: float) -> tuple[Array, Plane] | str:
    """Find the region over the means of blocks; the moments there in pixels of the frame, and the plane."""
    coarse, by, behind = start.coarse, start.by, start.background
    if by > 1 and start.width < FINE:
        about = _in_blocks(_box(start.moments, None, start.shape), by)
        return start.moments, plane(coarse, outside(coarse.shape, about), by, start.shape, least)
    moments, blocks = coarser(start.moments, by), (start.shape[0] / by, start.shape[1] / by)
    widths = None if held is None else moments[2:]
    box = _box(moments, widths, coarse.shape)
    for _ in range(_ROUNDS):
        behind = plane(coarse, outside(coarse.shape, box), by, start.shape, least)
        total, moments = above_plane(coarse[within(box)], box, blocks, behind)
        if not _sane(total, moments, coarse.shape):
            return _adrift(start)
        box, before = _box(moments, widths, coarse.shape), box
        if _moved(box, before) <= 1:
            return finer(moments, by), behind
    return _adrift(start)


def _moved(a: Box, b: Box) -> int:
    return max(abs(one - other) for one, other in zip(a, b, strict=True))


def _sane(total: float, moments: Array, shape: tuple[int, ...]) -> bool:
    """Whether it may be a beam: light, a middle inside the frame, widths above zero and not beyond the frame's."""
    if not (total > 0 and np.isfinite(moments).all()):
        return False
    column, row, across, down, both = moments
    inside = -0.5 <= column <= shape[1] - 0.5 and -0.5 <= row <= shape[0] - 0.5
    return bool(
        inside and 0 < across < shape[1] ** 2 / 12 and 0 < down < shape[0] ** 2 / 12 and both**2 < across * down
    )


def _box(moments: Array, held: Array | None, shape: tuple[int, ...]) -> Box:
    """The region of integration: `_REGION` widths (4 standard deviations) in all, 5 px at least, inside the picture."""
    variances = moments[2:4] if held is None else held[:2]
    across, down = (max(2.5, _REGION * 2 * math.sqrt(v)) for v in variances)
    column, row = moments[:2]
    top, left = max(0, math.floor(row - down)), max(0, math.floor(column - across))
    return top, min(shape[0], math.ceil(row + down) + 1), left, min(shape[1], math.ceil(column + across) + 1)
