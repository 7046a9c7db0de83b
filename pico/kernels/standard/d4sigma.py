"""The widths of a beam: second moments as ISO 11146 has them, see `pico.kernels.spot`."""

from __future__ import annotations

from collections.abc import Mapping

from pico.kernels.frame import Frame
from pico.kernels.kernel import Declaration, Result

KERNEL = Declaration(
    version="2", takes="image", units={"major": "um", "minor": "um", "angle": "deg", "ellipticity": "1"}
)


def apply(given: Frame, parameters: Mapping[str, float]) -> Result:
    """Return the widths (four standard deviations) along the principal axes [um], the angle of the major one [deg]
    counter-clockwise from x, -90 to 90, and the ellipticity, minor to major. Above 0.87 ISO calls a beam round, and the
    angle means little: its uncertainty says so. Light is summed over each pixel, which adds 1/12 px^2 to variances."""
    import numpy as np

    from pico.kernels.ellipse import ellipse
    from pico.kernels.spot import spot

    beam = spot(given, iterated=True)
    if isinstance(beam, str):
        return Result(unknown=beam)
    axes = ellipse(beam.moments[2:], beam.covariance[3:, 3:])
    scale = np.array([4 * given.pixel_size, 4 * given.pixel_size, 1.0])
    major, minor, angle = (axes.values * scale).tolist()
    s_major, s_minor, s_angle = (axes.sigma * scale).tolist()
    ratio = minor / major
    return Result(
        {"major": major, "minor": minor, "angle": angle, "ellipticity": ratio},
        {
            "major": s_major,
            "minor": s_minor,
            "angle": s_angle,
            "ellipticity": ratio * axes.ratio_sigma,
        },
    )
