"""Shutters with a sensor of their own."""

from __future__ import annotations

from pico.drivers.driven import Shut
from pico.drivers.protocols import Shutter
from pico.model.instruments.kind import InstrumentKind


async def _reads(shutter: Shutter) -> str:
    return {True: "open", False: "closed", None: "unknown"}[await shutter.is_open()]


KIND = InstrumentKind(
    name="shutter", about="a shutter with a sensor of its own",
    protocol=Shutter, reads=_reads, usual={"shutter": "open"}, datatypes=("choice",),
    drives=lambda point: Shut(point.instrument),
)  # fmt: skip
