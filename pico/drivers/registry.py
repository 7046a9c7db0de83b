"""Drivers by name, from the entry points `pico.drivers`: names are read without importing any, a driver is imported
when it is opened, and its vendor's library when its link is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from importlib import import_module
from importlib.metadata import EntryPoint
from importlib.util import find_spec
from typing import Any, cast

from pico.diagnostics import PicoError, did_you_mean, error
from pico.drivers.bus import Bus
from pico.drivers.driver import Driver
from pico.drivers.protocols import Instrument
from pico.model.instruments.kinds import kind_of
from pico.model.wiring import DeviceEntry
from pico.plug_ins.calling import Interface, guarded, guarded_object, having, instance, loaded
from pico.plug_ins.faults import CODE
from pico.plug_ins.known import entries, own_module, plug_in

GROUP = "pico.drivers"


@cache
def known() -> Mapping[str, EntryPoint]:
    """Return the drivers that are installed, by name; imports none."""
    return entries(GROUP)


INTERFACE = Interface(GROUP, {"": instance(Driver)})


_INSTALL = "install the package that brings it"


def known_driver(name: str) -> Driver | None:
    """Return a driver; None for one that is not installed, or is broken."""
    try:
        return driver(name)
    except PicoError:
        return None


def driver(name: str) -> Driver:
    """Return a driver, without its vendor's library; raises PicoError for a name that there is not (code `driver`), and
    for a plug-in that is broken, or of a kind that there is not (code `plugin`)."""
    if name not in known():
        near = did_you_mean(name[:40], known())
        hint = f"{near} Or {_INSTALL}" if near else _INSTALL
        raise PicoError(error("driver", f"there is no driver `{name[:40]}`", hint=hint))
    found: Driver = loaded(INTERFACE, known()[name])
    return _guarded(found, name)


def driver_of(entry: DeviceEntry) -> Driver:
    """Return the driver of a device; raises PicoError as `driver`, with the package that the lab names for it."""
    try:
        return driver(entry.driver)
    except PicoError as exc:
        (one,) = exc.diagnostics
        if not entry.package or one.code != "driver":
            raise
        hint = one.hint.replace(_INSTALL, f"`pip install {entry.package}`")
        raise PicoError(replace(one, hint=hint)) from exc


def _guarded(found: Driver, name: str) -> Driver:
    """Return a driver whose instruments raise PicoError only, whatever a plug-in's do."""
    one = plug_in(GROUP, known()[name])
    if own_module(one.module):
        return found

    try:
        methods = kind_of(found.kind).methods
    except PicoError as exc:
        text = f"{one.title} is wrong: {exc.diagnostics[0].summary}"
        raise PicoError([replace(exc.diagnostics[0], code=CODE, summary=text)]) from exc
    make = guarded(one, found.made, having(*methods), what="made")

    def made(device: str, entry: DeviceEntry, bus: Bus[Any]) -> Instrument:
        return cast(Instrument, guarded_object(one, make(device, entry, bus)))

    return replace(found, made=made)


def missing(found: Driver) -> str:
    """Return how to install what a driver needs and is not installed; '' where all is there."""
    if found.needs is None:
        return ""
    module, extra = found.needs
    return "" if find_spec(module.partition(".")[0]) else f"pip install 'pico-lab[{extra}]'"


class Buses:
    """The links of a bench: devices whose addresses lead over the same one share it, and its thread."""

    def __init__(self) -> None:
        self._buses: dict[tuple[object, ...], Bus[Any]] = {}

    def opened(self, name: str, entry: DeviceEntry) -> Instrument:
        """Return the instrument of an entry; nothing of it is asked yet: `connect` does that. Raises PicoError where
        there is no such driver, what it needs is not installed, or the entry does not go with it."""
        found = driver_of(entry)
        if install := missing(found):
            module = found.needs[0] if found.needs else ""
            text = f"{name} needs `{module}`, which is not installed"
            raise PicoError(error("missing-extra", text, hint=install, address=name))
        require_fit(name, entry, found)
        if found.needs:  # seconds of some libraries, which are no answer's delay
            _imported(name, found)
        link = found.link or f"{entry.driver} of {name}"
        key = (link, *(str(entry.address.get(part, "")) for part in found.bus))
        if key not in self._buses:
            self._buses[key] = Bus(lambda: found.opened(entry), found.closed, found.alive)
        return found.made(name, entry, self._buses[key])

    async def close(self) -> None:
        """Close every link."""
        for bus in self._buses.values():
            await bus.close()


def _imported(name: str, found: Driver) -> None:
    """Import what a driver needs; raises PicoError where that lacks something itself, as a library of the system."""
    module, extra = found.needs or ("", "")
    try:
        found.load() if found.load else import_module(module)
    except ImportError as exc:
        text = f"{name} needs `{module}`, which can't be imported: {exc}"
        hint = f"install what it lacks, or `pip install 'pico-lab[{extra}]'` again"
        raise PicoError(error("missing-extra", text, hint=hint, address=name)) from exc


def require_fit(name: str, entry: DeviceEntry, found: Driver) -> None:
    """Raise PicoError for all that an entry says and its driver does not take, and for what it lacks."""
    wrong = [
        error("device", f"{name}: {one.text} ({one.key})", hint=one.hint, address=name)
        for one in found.complaints(entry)
    ]
    if wrong:
        raise PicoError(wrong)
