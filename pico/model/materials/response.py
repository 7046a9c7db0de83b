"""How detectors respond by wavelength: typical curves of their materials.

Points are of the kind that makers print for uncoated parts of each material; between them it is linear. A single part
differs by 10 % and more near the ends: a curve tells ratios and where a detector is blind, and is no calibration.
"""

from __future__ import annotations

from bisect import bisect
from collections.abc import Mapping

Curve = tuple[tuple[float, float], ...]
"""Wavelength [nm] and quantum efficiency, in rising order."""
CURVES: Mapping[str, Curve] = {
    "silicon": (
        (190, 0.0), (200, 0.35), (300, 0.45), (350, 0.5), (400, 0.62), (450, 0.72), (500, 0.78), (600, 0.83),
        (700, 0.86), (800, 0.88), (900, 0.88), (950, 0.87), (1000, 0.72), (1050, 0.42), (1100, 0.14), (1150, 0.02),
        (1200, 0.0),
    ),
    "cmos": (
        (300, 0.0), (350, 0.1), (400, 0.45), (450, 0.6), (500, 0.67), (550, 0.68), (600, 0.63), (650, 0.56),
        (700, 0.46), (750, 0.36), (800, 0.27), (850, 0.19), (900, 0.12), (950, 0.07), (1000, 0.03), (1050, 0.01),
        (1100, 0.0),
    ),
    "InGaAs": (
        (750, 0.0), (800, 0.12), (850, 0.25), (900, 0.5), (950, 0.65), (1000, 0.72), (1100, 0.78), (1300, 0.84),
        (1500, 0.86), (1600, 0.83), (1650, 0.6), (1700, 0.12), (1750, 0.01), (1800, 0.0),
    ),
    "germanium": (
        (700, 0.0), (800, 0.4), (1000, 0.55), (1200, 0.62), (1400, 0.68), (1500, 0.68), (1550, 0.62), (1600, 0.35),
        (1700, 0.12), (1800, 0.02), (1850, 0.0),
    ),
}  # fmt: skip
"""Photon detectors by material; `cmos` is the thin silicon of a camera."""
THERMAL = "thermal"
"""A head that is warmed: it reads the same per watt at any wavelength that its `shortest` and `longest` allow."""
SENSORS = (*CURVES, THERMAL)
BLIND = 0.005
"""The quantum efficiency from which a detector sees a wavelength."""


def quantum_efficiency(sensor: str, wavelength: float) -> float:
    """Return the typical quantum efficiency of a material at a wavelength [nm]: 1 of a thermal or an unknown one."""
    curve = CURVES.get(sensor)
    if curve is None:
        return 1.0
    after = bisect(curve, (wavelength, 2.0))
    if after in (0, len(curve)):
        return 0.0
    (low, a), (high, b) = curve[after - 1 : after + 1]
    return a + (b - a) * (wavelength - low) / (high - low)


def blind(sensor: str, wavelength: float) -> bool:
    """Return whether a detector of a material sees nothing of a wavelength [nm]."""
    return quantum_efficiency(sensor, wavelength) < BLIND


def ratio(sensor: str, wavelength: float, reference: float) -> float:
    """Return the signal per watt at a wavelength to that at a `reference` [nm]; 0 if it is blind at either. Of an
    unknown material each photon gives as much."""
    if blind(sensor, wavelength) or blind(sensor, reference):
        return 0.0
    if sensor == THERMAL:
        return 1.0
    efficiency = quantum_efficiency(sensor, wavelength) / quantum_efficiency(sensor, reference)
    return efficiency * wavelength / reference
