"""How much of a spot's light a Gaussian mode would take, such as that of a fiber. The phase of the light is not seen:
it is taken to be the mode's. A tilt or a curvature makes it less, so this is the most that there can be."""

from __future__ import annotations

from collections.abc import Mapping

from pico.kernels.frame import Frame
from pico.kernels.kernel import Declaration, Parameter, Result

KERNEL = Declaration(
    version="2",
    takes="image",
    units={"overlap": "1"},
    parameters={"radius": Parameter("um", least=0.0), "x": Parameter("um", 0.0), "y": Parameter("um", 0.0)},
)


def apply(given: Frame, parameters: Mapping[str, float]) -> Result:
    """Return (sum a g)^2 / (sum a^2 sum g^2), 0 to 1: a the root of the light of each pixel, g the field of a mode
    of 1/e^2 `radius` about `x`, `y` [um]. Pixels that read below the background have a negative root: noise that is as
    often above as below adds nothing then."""
    import numpy as np

    from pico.kernels.spot import spot

    beam = spot(given)
    if isinstance(beam, str):
        return Result(unknown=beam)
    top, bottom, left, right = beam.box
    h, w = given.pixels.shape
    rows, columns = slice(top, bottom), slice(left, right)
    light = (given.part(rows, columns) - beam.behind(rows, columns)).astype(np.float64)
    x = (np.arange(left, right) - (w - 1) / 2) * given.pixel_size - parameters["x"]
    y = ((h - 1) / 2 - np.arange(top, bottom)) * given.pixel_size - parameters["y"]
    mode = np.exp(-((y / parameters["radius"]) ** 2))[:, None] * np.exp(-((x / parameters["radius"]) ** 2))
    root = np.sign(light) * np.sqrt(np.abs(light))
    # The whole mode, also where it reaches out of the region: its integral is pi r^2 / 2.
    whole = np.pi * (parameters["radius"] / given.pixel_size) ** 2 / 2
    met, total = float((root * mode).sum()), float(light.sum())
    whole = max(whole, float((mode**2).sum()))
    if met <= 0:
        return Result({"overlap": 0.0}, {"overlap": beam.covariance[0, 0] ** 0.5 / total})
    overlap = met**2 / (total * whole)
    variance = np.maximum(light, 0) / given.electrons_per_count + beam.background.variance
    floor = np.maximum(np.abs(root), beam.background.variance**0.25)
    # The root of noisy light reads low by v / (8 s^1.5), which shows where the beam is weak.
    low = 2 * overlap / met * float((mode * variance / (8 * floor**3)).sum())
    follow = mode * met / (floor * total * whole) - overlap / total
    return Result(
        {"overlap": min(overlap, 1.0)}, {"overlap": float(np.hypot(low, np.sqrt((follow**2 * variance).sum())))}
    )
