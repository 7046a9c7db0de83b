"""Motorized axes, in mm or deg."""

from __future__ import annotations

from pico.drivers.driven import Motorized
from pico.drivers.protocols import Axis
from pico.model.instruments.kind import InstrumentKind


async def _reads(axis: Axis) -> str:
    at = await axis.position()
    return "to be homed first" if at is None else f"at {at:.6g}"


KIND = InstrumentKind(
    name="axis", about="a motorized axis that drives to numbers", protocol=Axis, reads=_reads, datatypes=("float",),
    drives=lambda point: Motorized(point.instrument, point.conversion),
)  # fmt: skip
