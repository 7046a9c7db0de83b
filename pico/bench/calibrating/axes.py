"""The step `axes`: direction and zero of mounts that turn, by their scales, which a person reads."""

from __future__ import annotations

from typing import Any

from pico.bench.calibrating.at_table import AtTable
from pico.bench.calibrating.pictured import readings_drawn
from pico.diagnostics import PicoError, error
from pico.model.calibration.axis_zero import zero_of
from pico.model.calibration.results import AxisZero, Provenance
from pico.model.quantities import convert

PROCEDURE = "axes/1"
SHARES = (0.03, 0.17, 0.29, 0.44, 0.58, 0.71, 0.9)
"""At which shares of its range an axis is read: no two are symmetric."""


def axis(at: AtTable, address: str) -> tuple[AxisZero, Provenance, str]:
    """Find direction and zero of the axis `address`: how, and in words. Light is off meanwhile. Raises PicoError."""
    component, _, name = address.partition(".")
    tunable = at.device.setup.type_of(component).tunables[name]
    full = float(convert("360 deg", tunable.unit))
    low, high = tunable.range or (0.0, full)
    at.require_dark("an axis that turns")
    nominal, read = at.wait(_read(at, address, [low + share * (min(high, low + full) - low) for share in SHARES]))
    found = zero_of(address, nominal, read, tunable.period or full, at.hands.step)
    fitted = [found.axis.direction * value + found.axis.zero for value in nominal]
    shown = [value + full * round((line - value) / full) for value, line in zip(read, fitted, strict=True)]
    readings_drawn(nominal, shown, fitted, at.pictures / f"axes-{address}.png")
    unit = tunable.unit
    how = at.provenance(
        PROCEDURE, at.devices_of(component), residual=found.residual, held_out=found.held_out, unit=unit,
        uncertainty={f"zero_{unit}": found.axis.sigma},
    )  # fmt: skip
    way = "" if found.axis.direction > 0 else ", and turns the other way than the lab has it"
    zero = f"zero at {found.axis.zero:.2f} ± {found.axis.sigma:.2f} {unit}"
    said = f"{address}: {zero}{way}; {found.residual:.2g} {unit} are left"
    return found.axis, how, said


async def _read(at: AtTable, address: str, values: list[float]) -> tuple[list[float], list[float]]:
    """Bring an axis to some values as its device has them, and have its scale read at each: by the lab's map alone, and
    as read."""
    import asyncio

    lease = await at.edge.acquire("pico calibrate")
    try:
        bench: Any = await at.device.links.instruments()
        driven, before = bench.tunables[address], bench.axes.get(address)
        if (await driven.read()).value is None:
            await driven.home()
        nominal, read = list[float](), list[float]()
        for i, value in enumerate(values):
            if at.edge.custody.halted:
                raise PicoError(error("stopped", f"the bench was stopped while {address} turned"))
            at.require_dark("an axis that turns")
            there = float(await driven.set(value))
            nominal.append(there if before is None else before.nominal(there))
            text = f"{address}, reading {i + 1} of {len(values)}: what does its scale show?"
            unit = at.device.setup.type_of(address.partition(".")[0]).tunables[address.partition(".")[2]].unit
            read.append(await asyncio.to_thread(at.hands.read, address, unit, text))
        return nominal, read
    finally:
        await at.edge.release(lease)
