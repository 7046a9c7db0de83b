"""Lasers that say whether they emit."""

from __future__ import annotations

from pico.drivers.driven import Emitting
from pico.drivers.protocols import Laser
from pico.model.instruments.kind import InstrumentKind


async def _reads(laser: Laser) -> str:
    return {True: "emits", False: "does not emit", None: "emission unknown"}[await laser.emitting()]


KIND = InstrumentKind(
    name="laser", about="a laser that is switched, and says whether it emits",
    protocol=Laser, reads=_reads, usual={"emission": "emission"}, datatypes=("bool",),
    drives=lambda point: Emitting(point.instrument),
)  # fmt: skip
