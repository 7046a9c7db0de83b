"""Where the brightest spot of a picture is, roughly, and the picture without its stripes. Needs numpy and OpenCV at its
top: kernels import it inside their functions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from pico.kernels.background import Plane, binning, corners, outside, plane, with_misfit
from pico.kernels.defects import median
from pico.kernels.frame import Frame
from pico.kernels.moments import Array, finer, moments_of, sums
from pico.kernels.stripes import Stripes, stripes, without

_SIGNIFICANT = 3.0
"""Standard deviations of a block that the brightest place must exceed to be light."""
_START = 0.2
"""The share of the brightest place above which a beam is followed at first."""
_CUT = 1 / (1 - math.log(1 / _START) * _START / (1 - _START))
"""By how much the variances of a Gaussian are larger than those of its part above `_START` of its peak."""
FINE = 48.0
"""Width (D4sigma) [px] below which a beam is found in the pixels themselves, not in means of blocks."""
_HALF, _FAR_SMALLER = 0.5, 3.0
"""The share of the frame beyond which a bright part may be one of the background; how much smaller a beam then is."""
_RIM = 0.15
"""The share of each side of the frame that is its rim."""
DARK = "there is no light above the background"


@dataclass(frozen=True, eq=False)
class Start:
    """Where the beam is roughly: `moments` as those of `Spot`; the `stripes` of the `frame`, the means of its blocks of
    `by` pixels without them, and their plane."""

    moments: Array
    frame: Frame
    stripes: Stripes | None
    coarse: NDArray[np.float32]
    by: int
    background: Plane

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of the frame."""
        return _shape(self.frame)

    def part(self, rows: slice, columns: slice) -> NDArray[np.float32]:
        """Return a part of the frame's signal without its stripes [count]."""
        return without(self.frame, self.stripes, rows, columns)

    @property
    def width(self) -> float:
        """The lesser width along the columns or the rows (D4sigma) [px]."""
        return 4 * math.sqrt(float(self.moments[2:4].min()))


def found(frame: Frame) -> Start | str:
    """Return where the brightest spot is; why there is none."""
    if why := frame.refusal:
        return why
    by = binning(frame.pixels.shape)
    coarse = frame.means(by)
    start = _started(frame, coarse, by, None)
    if isinstance(start, str):
        return f"{start}, but for {frame.remark}" if frame.remark else start
    beside = stripes(frame, start.background, start.moments)
    return start if beside is None else _started(frame, coarse - beside.means(by), by, beside)


def _shape(frame: Frame) -> tuple[int, int]:
    return frame.pixels.shape[0], frame.pixels.shape[1]


def is_dark(why: str) -> bool:
    """Whether a spot is unknown for want of light."""
    return why.startswith(DARK)


def without_light(frame: Frame) -> tuple[float, float]:
    """Return the sum of a picture without a spot and its standard deviation [count]: over the middle of the frame,
    above a plane through the rim around it."""
    by = binning(frame.pixels.shape)
    coarse = frame.means(by)
    h, w = coarse.shape
    top, left = round(_RIM * h), round(_RIM * w)
    box = (top, h - top, left, w - left)
    rim = outside((h, w), box)
    behind = with_misfit(plane(coarse, rim, by, _shape(frame), frame.dark_variance), coarse, rim, by)
    inside = slice(top, h - top), slice(left, w - left)
    above = coarse[inside] - behind.means(by, *inside)
    follow = above.size * by**2 * np.array([1.0, 0.0, 0.0])  # the middle of the middle is that of the plane
    variance = behind.variance * above.size * by**2 + follow @ behind.covariance @ follow
    return float(above.sum(dtype=np.float64)) * by**2, math.sqrt(variance)


def _started(frame: Frame, coarse: NDArray[np.float32], by: int, beside: Stripes | None) -> Start | str:
    """Find the brightest place over the means of blocks of `by` pixels, without the stripes."""
    behind = plane(coarse, corners(coarse.shape), by, _shape(frame), frame.dark_variance)
    above = coarse - behind.means(by)
    moments = _bright(above, math.sqrt(behind.variance) / by)
    if moments is None or (4 * np.sqrt(moments[2:4]) > _HALF * np.array(coarse.shape[::-1])).any():
        moments = _without_stripes(above, moments)
    if moments is None:
        return DARK
    moments = finer(moments, by)
    if by > 1 and 4 * math.sqrt(moments[2:4].min()) < FINE:
        moments = _in_pixels(frame, beside, moments, behind, by)
    return Start(moments, frame, beside, coarse, by, behind)


def _without_stripes(above: NDArray[np.float32], moments: Array | None) -> Array | None:
    """The moments of the brightest place once columns and rows are brought to one level, if it is far smaller than that
    of `moments`, which may be a half of a sensor with two taps; `moments` otherwise."""
    level = above - median(above, 0)
    level -= median(level, 1)[:, None]
    there = _bright(level, 1.4826 * float(median(np.abs(level))))
    if there is None or (moments is not None and (there[2:4] > moments[2:4] / _FAR_SMALLER**2).all()):
        return moments
    return there


def _in_pixels(frame: Frame, beside: Stripes | None, moments: Array, behind: Plane, by: int) -> Array:
    """The moments of a small bright place, over the pixels about it."""
    across, down = (4 * by + 4 * math.sqrt(v) for v in moments[2:4])
    top, left = max(0, int(moments[1] - down)), max(0, int(moments[0] - across))
    rows, columns = slice(top, int(moments[1] + down) + 2), slice(left, int(moments[0] + across) + 2)
    above = without(frame, beside, rows, columns) - behind.over(rows, columns)
    there = _bright(above, math.sqrt(behind.variance))
    if there is None:
        return moments
    there[:2] += left, top
    return there


def _bright(above: NDArray[np.float32], noise: float) -> Array | None:
    """The moments of the brightest place of a picture (h, w) above its background; None if noise makes one as bright.
    `noise`: one standard deviation of a pixel [count]."""
    smooth = cv2.blur(above, (3, 3))
    top = float(smooth.max())
    if top < _SIGNIFICANT * noise or top <= 0:
        return None
    own = np.where(smooth > max(_START * top, 2 * noise), above, np.float32(0))
    total, moments = moments_of(sums(own.astype(np.float64), (0, 0)))
    if total <= 0:
        return None
    moments[2:] = np.maximum(moments[2:] * _CUT, [0.1, 0.1, -np.inf])
    return moments
