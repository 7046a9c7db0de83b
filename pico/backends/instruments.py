"""The instruments of a lab: which there are, whether they answer, and who they are; also those that are emulated."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from pico.diagnostics import Diagnostic, PicoError, did_you_mean, error
from pico.drivers.checking import Answer, anybody, checked
from pico.drivers.registry import driver, driver_of, known_driver, missing
from pico.emulators.behind import Alone
from pico.emulators.registry import EmulatedBench
from pico.manifest.load import find_lab, load_folder
from pico.model.record import record
from pico.model.setup import Setup
from pico.model.wiring import DeviceEntry

_HINT = "add a file with `kind: Devices` and `devices:`; docs/how-to/hardware.md has one"


@record
class InstrumentRow:
    """A device of a lab: whose it is, how it is reached, how far its driver was tried, and what it answered, where it
    was asked. `install`: what its driver needs and is not installed."""

    name: str
    of: str
    kind: str
    driver: str
    maturity: str
    address: str
    install: str = ""
    answer: Answer | None = None


def instruments(folder: Path, names: Sequence[str] = ()) -> dict[str, DeviceEntry]:
    """Return the devices of the lab that `folder` lies in, all or those of these names; raises PicoError for what is
    wrong with its manifests, where it has none, and for a name that there is not."""
    return named(bench_of(folder), names)


def bench_of(folder: Path) -> Setup:
    """Return the bench of the lab that `folder` lies in; raises PicoError for what is wrong with its manifests."""
    setup, _ = load_folder(find_lab(folder)).require()
    return setup


def named(setup: Setup, names: Sequence[str] = ()) -> dict[str, DeviceEntry]:
    """Return the devices of a bench, all or those of these names; raises PicoError for a name that there is not, and
    for a bench without devices."""
    known = setup.wiring.devices if setup.wiring else {}
    if not known:
        raise PicoError(error("no-devices", f"the lab {setup.lab.name} has no devices", hint=_HINT))
    if unknown := [name for name in names if name not in known]:
        raise PicoError(
            [
                error("unknown-device", f"there is no device `{n[:40]}`", hint=did_you_mean(n[:40], known))
                for n in unknown
            ]
        )
    return {name: entry for name, entry in known.items() if not names or name in names}


def listed(entries: dict[str, DeviceEntry], answers: dict[str, Answer] | None = None) -> list[InstrumentRow]:
    """Return a row a device."""
    return [_row(name, entry, (answers or {}).get(name)) for name, entry in entries.items()]


def _row(name: str, entry: DeviceEntry, answer: Answer | None) -> InstrumentRow:
    try:
        found = driver(entry.driver)
    except PicoError as exc:
        absent = exc.diagnostics[0].code == "driver"
        return InstrumentRow(
            name=name, of=entry.of or name, kind="unknown", driver=entry.driver,
            maturity="not installed" if absent else "broken", address=_address(entry),
            install=f"pip install {entry.package}" if absent and entry.package else "", answer=answer,
        )  # fmt: skip
    tried = f"{found.maturity}, {found.tried}" if found.tried else found.maturity
    return InstrumentRow(
        name=name, of=entry.of or name, kind=found.kind, driver=entry.driver, maturity=tried, address=_address(entry),
        install=missing(found), answer=answer,
    )  # fmt: skip


def _address(entry: DeviceEntry) -> str:
    return " ".join(f"{key}={value}" for key, value in entry.address.items())


def asked(
    entries: dict[str, DeviceEntry], *, emulate: bool = False, whoever: bool = False, properties: bool = False
) -> list[InstrumentRow]:
    """Return a row a device with what it answers, or, with `emulate`, what its emulator does, behind which there is
    nothing and it is dark; `whoever`: also where another one answers than the lab says; `properties`: with what it
    reads of each. One without emulator is left out, and has that as its answer."""
    wanted = anybody(entries) if whoever else entries
    if not emulate:
        return listed(entries, asyncio.run(checked(wanted, properties=properties)))
    import numpy as np

    dark = np.zeros((480, 640), np.uint8)
    bench = EmulatedBench(emulated(entries), lambda name, entry: Alone({"frame": dark}))
    try:
        there = bench.entries
        answers = asyncio.run(checked(anybody(there) if whoever else there, properties=properties))
        lacking = {name: Answer(diagnostics=why) for name, why in {**unreachable(entries), **bench.failed}.items()}
        return listed({**entries, **there}, {**answers, **lacking})
    finally:
        bench.close()


def emulated(entries: dict[str, DeviceEntry]) -> dict[str, DeviceEntry]:
    """Return the entries with the emulator that their driver names, if they name none; without those of `unreachable`,
    for an emulator needs a driver that checks what it is told."""
    found = {n: (e, known_driver(e.driver)) for n, e in entries.items()}
    return {n: e if e.emulator else replace(e, emulator=about.emulator) for n, (e, about) in found.items() if about}


def unreachable(entries: dict[str, DeviceEntry]) -> dict[str, tuple[Diagnostic, ...]]:
    """Return the devices whose driver is not installed, or is broken, with what is wrong."""
    found: dict[str, tuple[Diagnostic, ...]] = {}
    for name, entry in entries.items():
        try:
            driver_of(entry)
        except PicoError as exc:
            found[name] = tuple(replace(one, address=name) for one in exc.diagnostics)
    return found
