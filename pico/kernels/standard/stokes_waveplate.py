"""The Stokes parameters of light, from its powers behind a quarter-wave plate that turns and a fixed analyzer at 0 deg.

With the fast axis at t and a retardance d, c = cos d (Goldstein, Polarized Light, the rotating-retarder polarimeter):
2 I = S0 + S1 (cos^2 2t + c sin^2 2t) + S2 (1 - c) sin 2t cos 2t + S3 sin d sin 2t, in the signs of
`pico.optics.polarization`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from pico.kernels.frame import Readings
from pico.kernels.kernel import Declaration, Parameter, Result

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

KERNEL = Declaration(
    version="1",
    takes="readings",
    units={"s1": "1", "s2": "1", "s3": "1", "polarization": "1", "retardance": "deg"},
    parameters={"retardance": Parameter("deg", 0.0, least=-1.0)},
)
_FITTED = (60.0, 120.0)
"""Between which a plate's retardance is looked for [deg]."""
_STEP = 0.5


def apply(given: Readings, parameters: Mapping[str, float]) -> Result:
    """Return S1 to S3 in units of S0, the degree of polarization, and the retardance [deg]: that which is told; without
    it (0) that at which the light is fully polarized, for powers of one beam can't tell the two apart."""
    import numpy as np

    if len(given.angles) < 5 or len({round(a % 180, 6) for a in given.angles}) < 5:
        return Result(unknown="expected readings at five angles of the plate or more, not 180 deg apart")
    turned = np.radians(np.array(given.angles))
    values = np.array(given.values)
    found = _solved(turned, values, parameters["retardance"])
    if isinstance(found, str):
        return Result(unknown=found)
    spread = np.zeros(5)
    for i, sigma in enumerate(given.sigma):
        step = max(abs(sigma), 1e-9 * abs(values).max())
        moved = [
            _solved(turned, values + sign * step * np.eye(len(values))[i], parameters["retardance"]) for sign in (1, -1)
        ]
        if isinstance(moved[0], str) or isinstance(moved[1], str):
            return Result(unknown="the readings are too uncertain to tell the retardance")
        spread += ((moved[0] - moved[1]) / (2 * step) * sigma) ** 2
    names = tuple(KERNEL.units)
    return Result(
        dict(zip(names, found.tolist(), strict=True)), dict(zip(names, np.sqrt(spread).tolist(), strict=True))
    )


def _harmonics(turned: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """The constant, and what goes as sin 2t, cos 4t and sin 4t, by least squares."""
    import numpy as np

    basis = np.stack([np.ones_like(turned), np.sin(2 * turned), np.cos(4 * turned), np.sin(4 * turned)], axis=1)
    found: NDArray[np.float64] = np.linalg.lstsq(basis, values, rcond=None)[0].astype(np.float64)
    return found


def _stokes(harmonics: NDArray[np.float64], retardance: float) -> tuple[float, float, float, float]:
    """S0 to S3 of what is left of the formula above once its squares are written as cos 4t and sin 4t."""
    c, s = math.cos(math.radians(retardance)), math.sin(math.radians(retardance))
    constant, twice, cos, sin = harmonics.tolist()
    s1 = 4 * cos / (1 - c)
    return 2 * constant - s1 * (1 + c) / 2, s1, 4 * sin / (1 - c), 2 * twice / s


def _excess(harmonics: NDArray[np.float64], retardance: float) -> float:
    """By how much the squared degree of polarization is above 1."""
    s0, *rest = _stokes(harmonics, retardance)
    return sum(s**2 for s in rest) / s0**2 - 1 if s0 > 0 else math.nan


def _solved(turned: NDArray[np.float64], values: NDArray[np.float64], told: float) -> NDArray[np.float64] | str:
    import numpy as np

    harmonics = _harmonics(turned, values)
    retardance = told or _fitted(harmonics)
    if retardance is None:
        return f"no retardance from {_FITTED[0]:g} to {_FITTED[1]:g} deg makes the light fully polarized: tell it"
    s0, *rest = _stokes(harmonics, retardance)
    if s0 <= 0:
        return "there is no light"
    found = np.array(rest) / s0
    return np.array([*found, float(np.linalg.norm(found)), retardance])


def _fitted(harmonics: NDArray[np.float64]) -> float | None:
    """The retardance nearest to 90 deg at which the light is fully polarized; None without one."""
    count = round((_FITTED[1] - _FITTED[0]) / _STEP)
    grid = [_FITTED[0] + i * _STEP for i in range(count + 1)]
    over = [_excess(harmonics, d) for d in grid]
    changes = [i for i in range(count) if over[i] * over[i + 1] <= 0]
    if not changes:
        return None
    i = min(changes, key=lambda i: abs(grid[i] - 90))
    low, high, below = grid[i], grid[i + 1], over[i]
    for _ in range(50):
        middle = (low + high) / 2
        here = _excess(harmonics, middle)
        low, high, below = (middle, high, here) if here * below > 0 else (low, middle, below)
    return (low + high) / 2
