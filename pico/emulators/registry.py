"""Emulators by name, from the entry points `pico.emulators`; and a whole bench of them, with the addresses swapped."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import cache
from importlib.metadata import EntryPoint

from pico.diagnostics import PicoError, did_you_mean, error
from pico.emulators.behind import Behind, Emulator, Running
from pico.model.wiring import DeviceEntry
from pico.plug_ins.calling import Interface, guarded, having, instance, loaded
from pico.plug_ins.known import entries, own_module, plug_in

GROUP = "pico.emulators"


@cache
def known() -> Mapping[str, EntryPoint]:
    """Return the emulators that are installed, by name; imports none."""
    return entries(GROUP)


INTERFACE = Interface(GROUP, {"": instance(Emulator)})


def emulator(name: str) -> Emulator:
    """Return an emulator; raises PicoError for a name that there is not, and for a plug-in that is broken."""
    if name not in known():
        raise PicoError(error("emulator", f"there is no emulator `{name[:40]}`", hint=did_you_mean(name[:40], known())))
    found: Emulator = loaded(INTERFACE, known()[name])
    one = plug_in(GROUP, known()[name])
    return (
        found
        if own_module(one.module)
        else replace(found, started=guarded(one, found.started, having("address", "close"), what="started"))
    )


class EmulatedBench:
    """Emulators of a bench's devices, running; `entries` are the devices with the addresses that lead to them."""

    def __init__(self, devices: Mapping[str, DeviceEntry], behind: Callable[[str, DeviceEntry], Behind]) -> None:
        """Start one for each link; raises PicoError, with none left running, for a device that has no emulator."""
        self._running: list[Running] = []
        self.entries: dict[str, DeviceEntry] = {}
        try:
            for name, together in _links(devices).items():
                started = emulator(name[0]).started({n: (entry, behind(n, entry)) for n, entry in together.items()})
                self._running.append(started)
                for n, entry in together.items():
                    who = {key: said for key, said in getattr(started, "identity", {}).items() if key in entry.identity}
                    address = {**entry.address, **started.address}
                    self.entries[n] = replace(entry, address=address, identity={**entry.identity, **who})
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """End all of them."""
        for running in self._running:
            with suppress(Exception):
                running.close()
        self._running.clear()


def _links(devices: Mapping[str, DeviceEntry]) -> dict[tuple[str, ...], dict[str, DeviceEntry]]:
    """Return the devices by emulator and by what of their addresses is one link."""
    links: dict[tuple[str, ...], dict[str, DeviceEntry]] = {}
    for name, entry in devices.items():
        if not entry.emulator:
            text = f"{name} has no emulator"
            raise PicoError(error("emulator", text, hint="name one by `emulator:` of the device", address=name))
        parts = (str(entry.address.get(part, "")) for part in emulator(entry.emulator).bus)
        links.setdefault((entry.emulator, *parts), {})[name] = entry
    return links
