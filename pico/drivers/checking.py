"""Whether instruments answer, who they are and what they read; nothing moves, and no light is let out."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import field, replace

from pico.diagnostics import Diagnostic, PicoError
from pico.drivers.protocols import Identity, Instrument, Readable
from pico.drivers.registry import Buses, driver
from pico.model.instruments.kinds import kind_of
from pico.model.instruments.readout import Readout
from pico.model.record import record
from pico.model.wiring import DeviceEntry


@record
class Answer:
    """What a device answered: who it is, and what it reads in words; None and '' where it did not, for the reason in
    `diagnostics`. `readouts`: what it reads of each property, with the replies, where that was asked."""

    identity: Identity | None = None
    reads: str = ""
    readouts: Mapping[str, Readout] = field(default_factory=dict)
    diagnostics: tuple[Diagnostic, ...] = ()


async def checked(entries: Mapping[str, DeviceEntry], *, properties: bool = False) -> dict[str, Answer]:
    """Return the answers of devices, asked all at once; never raises PicoError for what one of them does.
    `properties`: with what each reads of its properties."""
    buses = Buses()
    try:
        answers = await asyncio.gather(*(_answer(buses, name, entry, properties) for name, entry in entries.items()))
    finally:
        await buses.close()
    return dict(zip(entries, answers, strict=True))


def anybody(entries: Mapping[str, DeviceEntry]) -> dict[str, DeviceEntry]:
    """Return the entries without the identities that they want."""
    return {name: replace(entry, identity={}) for name, entry in entries.items()}


async def _answer(buses: Buses, name: str, entry: DeviceEntry, properties: bool) -> Answer:
    identity, reads = None, ""
    found: Mapping[str, Readout] = {}
    try:
        kind = driver(entry.driver).kind
        instrument = buses.opened(name, entry)
        identity = await instrument.connect()
        if properties and isinstance(instrument, Readable):
            found = await instrument.readouts()
        else:
            reads = await reading(kind, instrument)
        await instrument.close()
    except PicoError as exc:
        return Answer(identity=identity, diagnostics=tuple(exc.diagnostics))
    return Answer(identity=identity, reads=reads, readouts=found)


async def reading(kind: str, instrument: Instrument) -> str:
    """Return in words what an instrument that is connected reads; raises PicoError."""
    return await kind_of(kind).reads(instrument)
