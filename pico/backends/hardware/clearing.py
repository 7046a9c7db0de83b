"""The faults of a bench's devices: which there are, and clearing one once a person was at the table."""

from __future__ import annotations

import asyncio

from pico.backends.hardware.instruments import Instruments
from pico.diagnostics import Diagnostic, PicoError, error, warning
from pico.drivers.protocols import Faulting
from pico.model.instruments.fault import DeviceFault, fault_diagnostic


def faulting(bench: Instruments) -> dict[str, Faulting]:
    """Return the instruments that come to faults, by device; none of a driver that can't be had, which is said
    elsewhere."""
    return {n: one for n, one in bench.all.items() if isinstance(one, Faulting) and n not in bench.lacking}


async def faults_of(bench: Instruments) -> tuple[DeviceFault, ...]:
    """Return the faults of all devices. A device that can't be asked while another one has a fault may be behind that
    one; if none has a fault, raises PicoError for those that can't be asked."""
    asked = faulting(bench)
    found = await asyncio.gather(*(one.faults() for one in asked.values()), return_exceptions=True)
    lost: list[Diagnostic] = []
    for said in found:
        if isinstance(said, PicoError):
            lost += said.diagnostics
        elif isinstance(said, BaseException):
            raise said
    faults = tuple(fault for said in found if isinstance(said, tuple) for fault in said)
    if lost and not faults:
        raise PicoError(lost)
    return faults


async def clear(bench: Instruments, device: str) -> None:
    """Clear the faults of a device for a person who was at the table, and get it ready if it is an arm, so that what it
    was told is read back; moves nothing. Raises PicoError naming what is still to be done."""
    one = faulting(bench).get(device)
    if one is None:
        known = ", ".join(sorted(faulting(bench))) or "none"
        text = f"{device[:40]} is no device that keeps faults"
        raise PicoError(error("unknown-device", text, hint=f"devices that do: {known}"))
    await one.clear(by_person=True)
    for arm in bench.arms.values():
        if arm is bench.all[device]:
            await arm.ready()


async def fault_warnings(bench: Instruments, robots: list[str]) -> tuple[Diagnostic, ...]:
    """Return the faults of some robots' arms as warnings, for who only looks."""
    found: list[Diagnostic] = []
    for robot in robots:
        arm = bench.arms[robot]
        if isinstance(arm, Faulting):
            said = [fault_diagnostic(fault) for fault in await arm.faults()]
            found += [warning(d.code, d.summary, detail=d.detail, hint=d.hint, address=d.address) for d in said]
    return tuple(found)
