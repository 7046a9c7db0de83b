"""Safety inputs: doors, curtains, emergency stops, keys, interlocks."""

from __future__ import annotations

from pico.drivers.protocols import SafetyInput
from pico.model.instruments.kind import InstrumentKind


async def _reads(read: SafetyInput) -> str:
    return {True: "safe", False: "NOT safe", None: "unknown: not safe"}[(await read.read()).safe]


KIND = InstrumentKind(
    name="safety input", about="a door, a curtain, an emergency stop, a key or an interlock", protocol=SafetyInput,
    reads=_reads, role="safety input", datatypes=(),
)  # fmt: skip
