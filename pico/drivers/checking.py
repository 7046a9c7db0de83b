"""Whether instruments answer, who they are and what they read; nothing moves, and no light is let out."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import field, replace
from typing import Any

from pico.diagnostics import Diagnostic, PicoError
from pico.drivers.driver import Kind
from pico.drivers.protocols import Identity, Instrument, Readable
from pico.drivers.registry import Buses, driver
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


async def reading(kind: Kind, instrument: Instrument) -> str:
    """Return in words what an instrument that is connected reads; raises PicoError."""
    return await _READ[kind](instrument)


async def _axis(axis: Any) -> str:
    at = await axis.position()
    return "to be homed first" if at is None else f"at {at:.6g}"


async def _meter(meter: Any) -> str:
    found = await meter.power()
    if found.value is None:
        return f"unknown: {found.why}"
    return f"{found.value:.4g} {found.unit}" + (f" ± {found.sigma:.2g} {found.unit}" if found.sigma is not None else "")


async def _laser(laser: Any) -> str:
    return {True: "emits", False: "does not emit", None: "emission unknown"}[await laser.emitting()]


async def _shutter(shutter: Any) -> str:
    return {True: "open", False: "closed", None: "unknown"}[await shutter.is_open()]


async def _safety(read: Any) -> str:
    return {True: "safe", False: "NOT safe", None: "unknown: not safe"}[(await read.read()).safe]


async def _arm(arm: Any) -> str:
    state = await arm.state()
    said = f"{'enabled' if state.enabled else 'not enabled'}, heard of {state.age:.1f} s ago"
    return said + (", moving" if state.moving else "") + (f", fault {state.fault}" if state.fault else "")


async def _gripper(gripper: Any) -> str:
    grip = await gripper.grip()
    return f"{grip.width:.1f} mm open" + (", holds something" if grip.holds else "")


async def _camera(camera: Any) -> str:
    rows, columns = (await camera.grab()).shape[:2]
    return f"{columns} x {rows} pixels"


async def _nothing(instrument: Instrument) -> str:
    return ""


_READ: Mapping[Kind, Callable[[Any], Awaitable[str]]] = {
    "arm": _arm, "gripper": _gripper, "axis": _axis, "camera": _camera, "depth camera": _camera,
    "power meter": _meter, "laser": _laser, "shutter": _shutter, "lamp": _nothing, "safety input": _safety,
}  # fmt: skip
