"""What a calibration says of axes and detectors, and how each of its results came about."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from typing import Literal

from pico.model.instruments.conversion import Conversion
from pico.model.quantities import convert
from pico.model.record import record

Evidence = Literal["simulated", "emulated", "measured"]
"""From what a result was found: the simulator, emulated devices, or the devices of a real bench."""

ACCEPTED: Mapping[str, Evidence] = {"sim": "simulated", "emulated": "emulated", "hardware": "measured"}
"""The evidence that each bench accepts of a calibration."""


@record
class Provenance:
    """How one result of a calibration came about."""

    bench: str
    """The bench on which it was found: `sim`, `emulated`, `hardware`."""
    evidence: Evidence
    """From what it was found."""
    serials: Mapping[str, str] = field(default_factory=dict)
    """The serial number of each device that was read, by device; without those that have none."""
    at: str = ""
    """When it was found (ISO 8601, UTC)."""
    by: str = ""
    """The person who made the calibration."""
    procedure: str = ""
    """The procedure and its version, such as `intrinsics/1`."""
    residual: float | None = None
    """What is left of the readings that were fitted, root mean square, in `unit`."""
    held_out: float | None = None
    """The same of readings that the fit did not use."""
    unit: str = ""
    """The unit of both residuals."""
    uncertainty: Mapping[str, float] = field(default_factory=dict)
    """One standard deviation of each number that was found, its unit in the name (`zero_deg`)."""


@record
class AxisZero:
    """How the value of an axis follows from what its device reads: by `direction` times what the lab's `map` makes of
    the device's number, plus `zero`, in the tunable's unit."""

    direction: Literal[1, -1]
    zero: float
    sigma: float
    """One standard deviation of `zero`."""

    def corrects(self, conversion: Conversion) -> Conversion:
        """Return a conversion with direction and zero put right."""
        wired = conversion.wired
        zero = float(convert(f"{self.zero!r} {conversion.unit}", wired.unit)) if wired.unit else self.zero
        offset = wired.offset * self.direction + zero
        return replace(conversion, wired=replace(wired, scale=wired.scale * self.direction, offset=offset))

    def nominal(self, value: float) -> float:
        """Return what the lab's `map` alone makes of the device's number, for the `value` of the tunable."""
        return self.direction * (value - self.zero)


@record
class DarkLevel:
    """What a detector reads without light."""

    level: float
    """The mean [counts of a camera, unit of a meter]."""
    sigma: float
    """One standard deviation of `level`."""
    noise: float
    """One standard deviation of a single reading (of a camera: of a pixel)."""
    unit: str = ""
    exposure: float | None = None
    """The exposure of the camera [ms]; None for a meter."""
