"""The widths of a spot along its principal axes, after ISO 11146: four standard deviations of its irradiance."""

from __future__ import annotations

import math

from pico.kernels.frame import Frame, Result

VERSION, TAKES = "1", "frame"
GIVES = {"major": "um", "minor": "um", "mean": "um", "ellipticity": "", "angle": "deg"}


def run(frame: Frame) -> Result:
    """Return the widths [um]: the larger one, with its `angle` from the right, counter-clockwise in the picture [deg],
    the smaller one, and their root mean square; `ellipticity`: the smaller over the larger (above 0.87 counts as
    round)."""
    from pico.kernels import moments

    spot = moments.find(frame)
    if isinstance(spot, Result):
        return spot
    middle, half = (spot.xx + spot.yy) / 2, math.hypot((spot.xx - spot.yy) / 2, spot.xy)
    if middle <= half:
        return Result(unknown="no light: what stands out of the noise is no spot")
    angle = math.degrees(0.5 * math.atan2(-2 * spot.xy, spot.xx - spot.yy))  # rows run down
    _, _, vx, vy, _ = moments.variances(frame, spot)
    c2 = math.cos(math.radians(angle)) ** 2
    along = c2**2 * vx + (1 - c2) ** 2 * vy + 2 * c2 * (1 - c2) * (vx + vy) / 2
    across = (1 - c2) ** 2 * vx + c2**2 * vy + 2 * c2 * (1 - c2) * (vx + vy) / 2
    major, minor = 4 * math.sqrt(middle + half), 4 * math.sqrt(middle - half)
    # d(4 sqrt(m)) = 8 dm / (4 sqrt(m))
    one, two = 8 * math.sqrt(along) / major, 8 * math.sqrt(across) / minor
    mean, ratio = math.sqrt((major**2 + minor**2) / 2), minor / major
    spread = math.hypot(one * major, two * minor) / (2 * mean)
    turn = math.degrees(math.sqrt((vx + vy) / 4) / max(2 * half, math.sqrt((vx + vy) / 4)))
    size = frame.pixel_size
    return Result(
        {"major": major * size, "minor": minor * size, "mean": mean * size, "ellipticity": ratio, "angle": angle},
        {
            "major": one * size, "minor": two * size, "mean": spread * size,
            "ellipticity": ratio * math.hypot(one / major, two / minor), "angle": turn,
        },
        GIVES,
    )  # fmt: skip
