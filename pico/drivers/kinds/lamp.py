"""Lamps of the room or the bench."""

from __future__ import annotations

from pico.drivers.driven import Lit
from pico.drivers.protocols import Lamp
from pico.model.instruments.kind import InstrumentKind


async def _reads(lamp: Lamp) -> str:
    return ""  # it tells nothing of itself


KIND = InstrumentKind(
    name="lamp", about="a lamp, which tells nothing of itself", protocol=Lamp, reads=_reads,
    usual={"illumination": "on"}, datatypes=("bool",),
    drives=lambda point: Lit(point.instrument, point.memory, point.address),
)  # fmt: skip
