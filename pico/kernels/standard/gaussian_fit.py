"""A Gaussian beam on a flat background, fitted by least squares: hardier than moments where the background is not flat,
and biased where the beam is not Gaussian."""

from __future__ import annotations

from collections.abc import Mapping

from pico.kernels.frame import Frame
from pico.kernels.kernel import Declaration, Result

KERNEL = Declaration(
    version="2",
    takes="image",
    units={"x": "um", "y": "um", "major": "um", "minor": "um", "angle": "deg", "peak": "count"},
)


def apply(given: Frame, parameters: Mapping[str, float]) -> Result:
    """Return middle, widths (D4sigma, those of 1/e^2) along the axes [um], angle of the major one [deg,
    counter-clockwise from x], and peak above the background [count]."""
    import numpy as np

    from pico.kernels.ellipse import ellipse
    from pico.kernels.gaussian import fitted
    from pico.kernels.spot import leaving, too_narrow

    fit = fitted(given)
    if isinstance(fit, str):
        return Result(unknown=fit)
    h, w = given.pixels.shape
    column, row, *_ = fit.values[1:]
    if not (-0.5 <= column <= w - 0.5 and -0.5 <= row <= h - 0.5):
        return Result(unknown=leaving(fit.values[1:], (h, w)) or "the fit lies outside of the frame")
    if fit.narrow:
        return Result(unknown=too_narrow(fit.values[1:]))
    axes = ellipse(fit.values[3:], fit.covariance[3:6, 3:6])
    scale = np.array([4 * given.pixel_size, 4 * given.pixel_size, 1.0])
    spread = np.sqrt(np.diag(fit.covariance)[:3]).tolist()
    middle = [s * given.pixel_size for s in spread[1:]]
    values = [*given.at(float(column), float(row)), *(axes.values * scale).tolist(), float(fit.values[0])]
    sigmas = [*middle, *(axes.sigma * scale).tolist(), spread[0]]
    return Result(dict(zip(KERNEL.units, values, strict=True)), dict(zip(KERNEL.units, sigmas, strict=True)))
